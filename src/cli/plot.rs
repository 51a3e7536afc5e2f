//! `drypoint plot`: turns any SVG into ordered tool paths.

use super::arguments::{Format, PlotOptions};
use super::draw_report::seconds_of_steps;
use super::failure::Failure;
use super::formats;
use super::interruption::interrupt;
use super::label_speeds::fit_to_machine;
use super::layer_files::split_by_layer;
use super::layout::reach_of;
use super::messages::{self, say, warning};
use super::pens::PenSet;
use super::plotted_part::{choose_layers, count_fills, hides, place};
use super::progress::Watcher;
use super::remedies::advised;
use super::scale_to_time::{Trials, scaled_to};
use super::threads::limit_threads;
use super::{advice, affordable, estimate_plot, job, output, toolpaths};
use crate::drawing::{Drawing, Mark};
use crate::plot::{Hides, InkModel, Job, Profile, TooMuch, check_work, occluded};
use crate::read::{Budget, Imported, read_svg_within};
use crate::style::Observer as _;
use crate::write::SvgHead;
use serde_json::json;

/// Advice for a file that exceeds the work limit.
pub(super) const MORE_WORK: &str = "; --most-work raises it";

pub(super) fn run(options: &PlotOptions) -> Result<(), Failure> {
    let format = formats::format_of(&options.output, options.format)?;
    if !format.holds_toolpaths() {
        let message = "plot writes tool paths, as .svg, .json or for a machine; `drypoint draw` writes PDF and InkML";
        return Err(Failure::Usage(message.to_owned()));
    }
    if options.reporting.json && options.output == "-" {
        return Err(Failure::Usage("--json and -o - would both write to stdout".to_owned()));
    }
    let mut profile = options.profile.as_deref().map(|name| toolpaths::profile(name, &options.toolpaths)).transpose()?;
    formats::check_language(format, profile.as_ref())?;
    let mut pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, profile.as_mut())?;
    limit_threads(options.threads)?;
    let shown = if options.drawing == "-" { "stdin" } else { &options.drawing };
    let watcher = Watcher::new(options.reporting.quiet);
    watcher.begin("reading");
    let mut imported = imported(options, shown)?;
    toolpaths::check_preview(&options.output, &options.toolpaths)?;
    if let Some(profile) = &profile {
        fit_to_machine(&mut imported, profile);
    }
    let model = ink_model(options, &imported);
    let hides = options.occlude.then(|| hides(model));
    // Pens are assigned only when all marks are known; the default nib is good enough to estimate the work.
    check_work(&imported.drawing(), model, pens.nibs(), hides, interrupt()).map_err(|error| too_much(shown, &error))?;
    if options.dry_run {
        return estimate_plot::dry_run(&imported, options, model, profile.as_ref(), &mut pens, shown);
    }
    if let Some(hides) = hides {
        leave_out_hidden(&mut imported, hides)?;
    }
    choose_layers(&mut imported, &options.layers)?;
    if model == InkModel::Lines {
        count_fills(&mut imported);
    }
    let (mut drawing, turning) = place(&imported.drawing(), options, reach_of(profile.as_ref()))?;
    if is_blank(&drawing, model) {
        return Err(nothing_to_draw(shown, &imported, model));
    }
    pens.assign(&mut drawing, profile.as_ref())?;
    affordable::check_line(&drawing, pens.nibs(), model, 1.0)?;
    let work = Work { options, format, model, profile: profile.as_ref(), pens: &pens, watcher: &watcher };
    let (scale, jobs) = work.plotted(drawing, shown).map_err(|failure| advice::for_plot(failure, options, turning.degrees))?;
    let seconds = watcher.finish();
    jobs.iter().for_each(|(_, job)| toolpaths::warn(job, Some("")));
    if !imported.dropped.is_empty() {
        warning!("left out or drawn otherwise: {}", imported.dropped.summary());
    }
    report(options, &imported, &jobs, scale, &seconds)
}

/// The drawing that the file holds.
fn imported(options: &PlotOptions, shown: &str) -> Result<Imported, Failure> {
    let mut budget = Budget::of_millions(options.most_work);
    let bytes = output::read(&options.drawing, budget.most_bytes(), MORE_WORK)?;
    read_svg_within(&bytes, &mut budget).map_err(|error| {
        let other = if image::guess_format(&bytes).is_ok() { "; a photograph is drawn with `drypoint draw`" } else { "" };
        Failure::about(shown)(&format_args!("{}{other}", advised(&error)))
    })
}

fn nothing_to_draw(shown: &str, imported: &Imported, model: InkModel) -> Failure {
    let dropped = &imported.dropped;
    let dropped = if dropped.is_empty() { String::new() } else { format!(" (left out: {})", dropped.summary()) };
    let advice = if model == InkModel::Lines { "; fills are drawn with --ink-model ink" } else { "" };
    Failure::Work(format!("{shown}: there is nothing to draw{dropped}{advice}"))
}

/// Files and their jobs.
type Written<'a> = Vec<(String, Job<'a>)>;

/// What is done with a drawing whose pens are assigned.
struct Work<'a> {
    options: &'a PlotOptions,
    format: Format,
    model: InkModel,
    profile: Option<&'a Profile>,
    pens: &'a PenSet,
    watcher: &'a Watcher,
}

impl<'a> Work<'a> {
    /// Scales the drawing to the time that there is, and writes its files.
    fn plotted(&self, mut drawing: Drawing, shown: &str) -> Result<(Option<f64>, Written<'a>), Failure> {
        let mut scale = None;
        if let (Some(limit), Some(profile)) = (self.options.max_time, self.profile) {
            self.watcher.begin("trials");
            let trials = Trials { limit, model: self.model, profile, pens: self.pens, options: self.options };
            let scaled = scaled_to(&drawing, &trials)?;
            (drawing, scale) = (scaled.drawing, Some(scaled.scale));
        }
        let name = std::path::Path::new(shown).file_name().and_then(|n| n.to_str()).unwrap_or(shown);
        let recipe = json!({ "drypoint": env!("CARGO_PKG_VERSION"), "command": "plot", "pen_mm": self.options.pen });
        let head = SvgHead {
            title: format!("Tool paths of {name}"),
            description: "Tool paths in drawing order; each line is one nib wide.".to_owned(),
            recipe: recipe.to_string(),
        };
        let toolpaths = &self.options.toolpaths;
        let files = split_by_layer(&drawing, &self.options.output);
        toolpaths::check_layer_files(&files, toolpaths)?;
        let mut jobs = Vec::new();
        for file in files {
            let job = job::of_drawing(&file.drawing, self.model, self.profile, toolpaths, self.pens, self.watcher)?;
            self.watcher.begin("writing");
            toolpaths::write(&file.name, self.format, &job, &head)?;
            toolpaths::write_preview_of(&job, toolpaths, Some(&file.layer))?;
            jobs.push((file.name, job));
        }
        Ok((scale, jobs))
    }
}

fn report(
    options: &PlotOptions,
    imported: &Imported,
    jobs: &[(String, Job<'_>)],
    scale: Option<f64>,
    seconds: &[(String, f64)],
) -> Result<(), Failure> {
    if options.reporting.json {
        let mut value = json!(toolpaths::combined_report(jobs.iter().map(|(_, job)| job)));
        value["files"] = json!(jobs.iter().map(|(name, _)| name).collect::<Vec<_>>());
        value["dropped"] = json!(imported.dropped);
        value["duplicates"] = json!(jobs.iter().map(|(_, job)| job.duplicates()).sum::<usize>());
        if let Some(scale) = scale {
            value["scale"] = json!(scale);
        }
        value["seconds"] = json!(seconds_of_steps(seconds));
        value["warnings"] = json!(messages::warnings());
        return output::print_json(&value);
    }
    for (name, job) in jobs.iter().filter(|_| !options.reporting.quiet) {
        say!("{name}: {}", toolpaths::summary(job.report()));
        toolpaths::pen_lines(job).iter().for_each(|line| say!("{line}"));
    }
    Ok(())
}

/// True if a drawing has no marks that would be drawn.
fn is_blank(drawing: &Drawing, model: InkModel) -> bool {
    !drawing.marks().any(|mark| model == InkModel::Ink || matches!(mark, Mark::Stroke(_)))
}

fn ink_model(options: &PlotOptions, imported: &Imported) -> InkModel {
    match options.ink_model {
        _ if imported.is_toolpaths => InkModel::Lines,
        Some(asked) => asked,
        None if imported.recipe.is_some() => InkModel::Ink,
        None => InkModel::Lines,
    }
}

fn too_much(shown: &str, error: &TooMuch) -> Failure {
    match error {
        TooMuch::Interrupted => Failure::Interrupted,
        _ => Failure::Work(format!("{shown}: {}", advised(error))),
    }
}

/// Removes what later marks in the painting order hide.
fn leave_out_hidden(imported: &mut Imported, hides: Hides) -> Result<(), Failure> {
    let seen = occluded(&imported.drawing(), &imported.painting, hides, interrupt())?;
    for (layer, seen) in imported.layers.iter_mut().zip(seen.layers) {
        layer.layer = seen;
    }
    Ok(())
}
