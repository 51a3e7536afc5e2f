//! `drypoint sheet`: several scenes and drawings on one sheet.

use super::arguments::Spelled;
use super::arguments::{Arguments, Command, Format, SheetOptions};
use super::failure::Failure;
use super::formats;
use super::inking::{inked, uncovered};
use super::interruption::interrupt;
use super::layout::reach_of;
use super::messages::say;
use super::pens::PenSet;
use super::progress::Watcher;
use super::remedies::advised;
use super::scene::{self, Refusal};
use super::threads::limit_threads;
use super::words::{file_name, is_toml};
use super::{affordable, job, layout, output, toolpaths};
use crate::drawing::{Drawing, Page};
use crate::geometry::Rect;
use crate::plot::{InkModel, Job, Profile};
use crate::press::{PrintFormat, PrintJob};
use crate::read::{Budget, read_svg_within};
use crate::scene::{CropMarks, Grid, Piece, SheetError, scale_into};
use crate::style::Observer as _;
use crate::write::SvgHead;
use clap::FromArgMatches;
use serde_json::json;
use std::ffi::OsString;

/// Work for reading each drawing, in millions of steps.
const WORK: f64 = 100.0;

pub(super) fn run(options: &SheetOptions) -> Result<(), Failure> {
    limit_threads(options.threads)?;
    let format = formats::format_of(&options.output, options.format)?;
    let mut profile = options.profile.as_deref().map(|name| toolpaths::profile(name, &options.toolpaths)).transpose()?;
    formats::check_language(format, profile.as_ref())?;
    if profile.is_none() {
        toolpaths::check_machine_options(&options.toolpaths)?;
    }
    let mut pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, profile.as_mut())?;
    toolpaths::check_preview(&options.output, &options.toolpaths)?;
    let watcher = Watcher::new(options.quiet);
    let pieces = pieces(options, &watcher)?;
    let grid = grid(options, &pieces)?;
    tell_smaller(options, &pieces, &grid)?;
    let marks = if options.crop_marks { CropMarks::Corners } else { CropMarks::None };
    let mut drawing = grid.filled(&pieces, marks).map_err(|error| told(&error))?;
    let painting = pens.assign(&mut drawing, profile.as_ref())?;
    let work = Work { options, format, pens: &pens, watcher: &watcher };
    let job = match &profile {
        Some(profile) => Some(work.plotted(&*uncovered(&drawing, &painting)?, profile)?),
        None => work.printed(&drawing).map(|()| None)?,
    };
    watcher.finish();
    if let Some(job) = &job {
        toolpaths::warn(job, Some(""));
    }
    if !options.quiet {
        let Page { width, height, .. } = drawing.page;
        let (columns, rows) = (grid.columns, grid.rows);
        say!("{}: {width:.1} x {height:.1} mm, {} on {columns} x {rows} cells", options.output, drawings(pieces.len()));
        job.iter().for_each(|job| say!("{}", toolpaths::summary(job.report())));
    }
    Ok(())
}

fn drawings(count: usize) -> String {
    super::words::counted(count, "drawing")
}

/// What is done with a filled sheet whose pens are assigned.
struct Work<'a> {
    options: &'a SheetOptions,
    format: Format,
    pens: &'a PenSet,
    watcher: &'a Watcher,
}

impl Work<'_> {
    fn head(&self) -> SvgHead {
        let names: Vec<&str> = self.options.files.iter().map(|file| file_name(file)).collect();
        SvgHead {
            title: format!("A sheet of {}", names.join(", ")),
            description: format!("{} on one sheet.", drawings(names.len())),
            recipe: json!({ "drypoint": env!("CARGO_PKG_VERSION"), "command": "sheet", "files": names }).to_string(),
        }
    }

    fn printed(&self, drawing: &Drawing) -> Result<(), Failure> {
        self.watcher.begin("writing");
        let format: PrintFormat = self.format.of_print()?;
        let job = PrintJob::new(drawing, None, interrupt())?;
        output::write(&self.options.output, |out| job.write(format, &self.head(), out))
    }

    fn plotted<'p>(&self, drawing: &Drawing, profile: &'p Profile) -> Result<Job<'p>, Failure> {
        let toolpaths = &self.options.toolpaths;
        affordable::check_line(drawing, self.pens.nibs(), InkModel::Ink, 1.0)?;
        let job = job::of_drawing(drawing, InkModel::Ink, Some(profile), toolpaths, self.pens, self.watcher)?;
        self.watcher.begin("writing");
        toolpaths::write(&self.options.output, self.format, &job, &self.head())?;
        toolpaths::write_preview_of(&job, toolpaths, None)?;
        Ok(job)
    }
}

/// The drawings of all files, each as often as wanted.
fn pieces(options: &SheetOptions, watcher: &Watcher) -> Result<Vec<Piece>, Failure> {
    let mut pieces = Vec::new();
    for file in &options.files {
        let piece = if is_toml(file) { of_scene(file, watcher)? } else { of_svg(file, watcher)? };
        pieces.extend(std::iter::repeat_n(piece, usize::from(options.copies)));
    }
    Ok(pieces)
}

/// A scene's drawing and its picture's box.
fn of_scene(file: &str, watcher: &Watcher) -> Result<Piece, Failure> {
    let words = ["drypoint", "draw", file, "-o", "-", "--format", "svg"].map(OsString::from);
    let (matches, origins) = scene::matches(&words).map_err(|refusal| match refusal {
        Refusal::File(failure) => failure,
        Refusal::Usage(error) => Failure::Work(format!("{file}: {}", error.to_string().trim())),
    })?;
    let parsed = Arguments::from_arg_matches(&matches).map_err(|error| Failure::Work(format!("{file}: {error}")))?;
    let Command::Draw(mut options) = parsed.command else { return Err(Failure::Work(format!("{file} is no scene"))) };
    options.spelled = matches.subcommand().map(|(_, given)| Spelled::of(given)).unwrap_or_default();
    let draw = || {
        let task = affordable::task(&options.picture, &options.placing, reach_of(None))?;
        let drawing = inked(task.draw(watcher)?, &task, &options, watcher)?;
        Ok(Piece { drawing, picture: task.layout.placed() })
    };
    draw().map_err(|failure| origins.explain(failure))
}

/// The drawing that an SVG holds, and its page.
fn of_svg(file: &str, watcher: &Watcher) -> Result<Piece, Failure> {
    watcher.begin("reading");
    let mut budget = Budget::of_millions(WORK);
    let bytes = output::read(file, budget.most_bytes(), "")?;
    let imported = read_svg_within(&bytes, &mut budget).map_err(|error| Failure::about(file)(&advised(&error)))?;
    let drawing = imported.drawing();
    if drawing.marks().next().is_none() {
        return Err(Failure::Work(format!("{file}: there is nothing to draw")));
    }
    Ok(Piece { picture: drawing.page.rect(), drawing })
}

/// The cells: as given, else as suits the pictures.
fn grid(options: &SheetOptions, pieces: &[Piece]) -> Result<Grid, Failure> {
    let (width, height) = layout::sheet(&options.page)?;
    let page = Page::new(width, height);
    let largest =
        pieces.iter().fold((1.0_f64, 1.0_f64), |(w, h), piece| (w.max(piece.picture.width()), h.max(piece.picture.height())));
    let (columns, rows) = options.grid.unwrap_or_else(|| Grid::for_count(pieces.len(), page, largest));
    Ok(Grid { page, margin: options.margin, gap: options.gap, columns, rows })
}

/// Tells which pictures are made smaller to fit into their cells.
fn tell_smaller(options: &SheetOptions, pieces: &[Piece], grid: &Grid) -> Result<(), Failure> {
    let cell = grid.cells().map_err(|error| told(&error))?.first().copied().unwrap_or(Rect::ZERO);
    let least = pieces.iter().map(|piece| scale_into(piece.picture, cell)).fold(1.0, f64::min);
    if least < 1.0 && !options.quiet {
        say!(
            "drypoint: drawings larger than a cell of {:.1} x {:.1} mm are scaled down, to {:.0} % at most; a larger --page or fewer cells keep their size",
            cell.width(),
            cell.height(),
            100.0 * least
        );
    }
    Ok(())
}

fn told(error: &SheetError) -> Failure {
    Failure::Usage(match error {
        SheetError::TooMany { .. } => format!("{error}; give a larger --grid, such as --grid 3x4, or several sheets"),
        _ => format!("{error}; choose a larger --page, or a smaller --margin, --gap or --grid"),
    })
}
