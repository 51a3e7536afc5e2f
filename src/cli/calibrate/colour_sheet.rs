//! The colour sheet of a box of pens: `drypoint calibrate --colours PENS`.

use super::pen_box::PenBox;
use crate::cli::advice;
use crate::cli::affordable;
use crate::cli::arguments::{CalibrateOptions, Format};
use crate::cli::failure::Failure;
use crate::cli::formats;
use crate::cli::interruption::interrupt;
use crate::cli::layer_files::split_by_layer;
use crate::cli::messages::say;
use crate::cli::palette::shown_colour;
use crate::cli::pens::PenSet;
use crate::cli::progress::Watcher;
use crate::cli::{job, layout, output, toolpaths};
use crate::colour::Opacity;
use crate::colour::sheet::{PenSheet, SheetMark, SheetShape};
use crate::drawing::{Area, Colour, Dot, Drawing, Ink, Layer, Mark, Mixing, Page, Stroke};
use crate::geometry::{BezPath, Point, Rect};
use crate::plot::{InkModel, Job, Profile, mount};
use crate::press::PrintJob;
use crate::style::Observer as _;
use crate::write::SvgHead;
use serde_json::json;

/// Free border in millimetres, where the machine reaches further.
const MARGIN: f64 = 7.0;
/// Sheets tried where none is given: ISO 216 A4 and A5, upright and on their side.
const SHEETS: [(f64, f64); 4] = [(210.0, 297.0), (297.0, 210.0), (148.0, 210.0), (210.0, 148.0)];

pub(super) fn run(options: &CalibrateOptions, file: &str) -> Result<(), Failure> {
    let format = formats::format_of(&options.output, options.format)?;
    let mut profile = options.profile.as_deref().map(|name| toolpaths::profile(name, &options.toolpaths)).transpose()?;
    formats::check_language(format, profile.as_ref())?;
    if profile.is_none() {
        toolpaths::check_machine_options(&options.toolpaths)?;
    }
    let pen_box = PenBox::read(options, file)?;
    let darkest = pen_box.checked()?;
    let mut pens = PenSet::read(Some(file), options.pen, profile.as_mut())?;
    toolpaths::check_preview(&options.output, &options.toolpaths)?;
    let (page, sheet) = laid_out(options, profile.as_ref(), &pen_box, darkest)?;
    let mut drawing = drawing(&pen_box, &sheet.marks(), page);
    pens.assign(&mut drawing, profile.as_ref())?;
    for (layer, pen) in drawing.layers.iter_mut().zip(&pen_box.pens) {
        // As the pens are, not as their `colour` says if there is `lab` too.
        layer.ink = Ink::Colour(shown_colour(&pen.ink, pen_box.paper));
        if profile.is_none() && pen.ink.opacity == Opacity::Opaque {
            layer.mixing = Mixing::Paint;
        }
    }
    if profile.is_some() {
        pen_box.warn_of_order();
    }
    let work = Work { options, format, pens: &pens, watcher: &Watcher::new(options.quiet) };
    let jobs = work.written(&drawing, profile.as_ref()).map_err(advice::for_test_sheet)?;
    work.watcher.finish();
    jobs.iter().for_each(|job| toolpaths::warn(job, Some("")));
    if !options.quiet {
        say!("{}: {:.1} x {:.1} mm; pens on the sheet: {}", options.output, page.width, page.height, pen_box.legend());
        jobs.iter().for_each(|job| say!("{}", toolpaths::summary(job.report())));
        say!("Let it dry, take a picture of it from above in even light, without flash, or scan it, and read that:");
        say!("  drypoint calibrate --colours {file} --read PHOTO -o measured.toml{}", given_again(options));
    }
    Ok(())
}

/// The options that the reader needs too.
fn given_again(options: &CalibrateOptions) -> String {
    const USUAL: f64 = 0.3;
    let pen = if options.pen == USUAL { String::new() } else { format!(" --pen {}mm", options.pen) };
    pen + &options.paper.map_or_else(String::new, |paper| format!(" --paper '{paper}'"))
}

/// The first page that is large enough, with the sheet on it.
fn laid_out(
    options: &CalibrateOptions,
    profile: Option<&Profile>,
    pen_box: &PenBox,
    darkest: usize,
) -> Result<(Page, PenSheet), Failure> {
    let own = profile.iter().flat_map(|profile| &profile.paper).map(|paper| (paper.width, paper.height));
    let sizes: Vec<(f64, f64)> = match &options.page {
        Some(text) => vec![layout::sheet(text)?],
        None => own.chain(SHEETS).collect(),
    };
    let nibs = pen_box.nibs();
    let on = |(width, height): (f64, f64)| {
        let page = Page { paper: options.paper.unwrap_or(Colour::WHITE), ..Page::new(width, height) };
        let drawable = profile.map(|profile| Ok::<Rect, Failure>(mount(profile, &page)?.drawable(&page))).transpose()?;
        let margin = drawable.map_or(MARGIN, |free| MARGIN.max(border(&page, free)));
        let laid = PenSheet::new([width, height], margin, &nibs, darkest);
        Ok((page, laid.map_err(|error| Failure::Work(error.to_string()))?))
    };
    let mut refused = None;
    for size in sizes {
        match on(size) {
            Ok(laid) => return Ok(laid),
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    let refused = refused.unwrap_or_else(|| Failure::Work("the machine has no sheet; choose one with --page".to_owned()));
    Err(advice::for_test_sheet(refused))
}

/// The widest border of the page that the machine does not reach.
fn border(page: &Page, free: Rect) -> f64 {
    [free.x0, free.y0, page.width - free.x1, page.height - free.y1].into_iter().fold(0.0, f64::max)
}

/// A layer for each pen, in the order of the sheet.
fn drawing(pen_box: &PenBox, marks: &[SheetMark], page: Page) -> Drawing {
    let layer = |(i, pen): (usize, &super::pen_box::BoxedPen)| Layer {
        marks: marks.iter().filter(|mark| mark.pen == i).map(|mark| inked(&mark.shape, pen.ink.width_mm)).collect(),
        ..Layer::new(&pen.ink.name, pen.number)
    };
    Drawing { page, layers: pen_box.pens.iter().enumerate().map(layer).collect() }
}

fn inked(shape: &SheetShape, nib: f64) -> Mark {
    match shape {
        SheetShape::Rect(rect) => {
            let corners = [(rect.x0, rect.y0), (rect.x1, rect.y0), (rect.x1, rect.y1), (rect.x0, rect.y1)].map(Point::from);
            Mark::Area(Area { outline: polygon(&corners), colour: None })
        }
        SheetShape::Disc { centre, radius } => Mark::Dot(Dot::circle(*centre, *radius)),
        SheetShape::Ring { centre, outer, inner } => {
            let mut outline = Dot::circle(*centre, *outer).path();
            outline.extend(Dot::circle(*centre, *inner).path().reverse_subpaths());
            Mark::Area(Area { outline, colour: None })
        }
        SheetShape::Line(points) => {
            let mut curve = BezPath::new();
            curve.move_to(points[0]);
            points[1..].iter().for_each(|point| curve.line_to(*point));
            Mark::Stroke(Stroke::even(curve, nib))
        }
    }
}

fn polygon(corners: &[Point]) -> BezPath {
    let mut path = BezPath::new();
    for (i, corner) in corners.iter().enumerate() {
        if i == 0 { path.move_to(*corner) } else { path.line_to(*corner) }
    }
    path.close_path();
    path
}

fn head() -> SvgHead {
    SvgHead {
        title: "Colour sheet".to_owned(),
        description: "Patches of each pen and of pens on one another; docs/colour.md says how they are measured.".to_owned(),
        recipe: json!({ "drypoint": env!("CARGO_PKG_VERSION"), "command": "calibrate" }).to_string(),
    }
}

/// What is done with a sheet whose pens are assigned.
struct Work<'a> {
    options: &'a CalibrateOptions,
    format: Format,
    pens: &'a PenSet,
    watcher: &'a Watcher,
}

impl Work<'_> {
    /// Writes the sheet, or a file for each pen; returns the machine's jobs.
    fn written<'p>(&self, drawing: &Drawing, profile: Option<&'p Profile>) -> Result<Vec<Job<'p>>, Failure> {
        let files = split_by_layer(drawing, &self.options.output);
        toolpaths::check_layer_files(&files, &self.options.toolpaths)?;
        let mut jobs = Vec::new();
        for file in &files {
            match profile {
                Some(profile) => jobs.push(self.plotted(&file.drawing, (&file.name, &file.layer), profile)?),
                None => self.printed(&file.drawing, &file.name)?,
            }
        }
        Ok(jobs)
    }

    fn printed(&self, drawing: &Drawing, name: &str) -> Result<(), Failure> {
        self.watcher.begin("writing");
        let format = self.format.of_print()?;
        let job = PrintJob::new(drawing, None, interrupt())?;
        if self.options.dry_run {
            return Ok(());
        }
        output::write(name, |out| job.write(format, &head(), out))
    }

    fn plotted<'p>(&self, drawing: &Drawing, (name, layer): (&str, &str), profile: &'p Profile) -> Result<Job<'p>, Failure> {
        let toolpaths = &self.options.toolpaths;
        affordable::check_line(drawing, self.pens.nibs(), InkModel::Ink, 1.0)?;
        let job = job::of_drawing(drawing, InkModel::Ink, Some(profile), toolpaths, self.pens, self.watcher)?;
        if !self.options.dry_run {
            self.watcher.begin("writing");
            toolpaths::write(name, self.format, &job, &head())?;
            toolpaths::write_preview_of(&job, toolpaths, Some(layer))?;
        }
        Ok(job)
    }
}
