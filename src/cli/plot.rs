//! `drypoint plot`: any SVG to ordered tool paths.

use super::arguments::{Format, InkModelOption, PlotFit, PlotOptions, Rotate};
pub(super) use super::draw::reach_of;
use super::draw::{limit_threads, split_by_layer};
use super::failure::Failure;
use super::pens::PenSet;
use super::{affordable, foretell_plot, layout, output, toolpaths};
use crate::drawing::{Drawing, Mark, Page};
use crate::geometry::{Affine, Rect};
use crate::plot::{Hides, InkModel, coverage, lower, occluded};
use crate::read::{Imported, read_svg};
use crate::write::SvgHead;
use serde_json::json;

pub(super) fn run(options: &PlotOptions) -> Result<(), Failure> {
    let format = toolpaths::format_of(&options.output, options.format)?;
    if format == Format::Pdf {
        return Err(Failure::Usage("plot writes tool paths, as .svg or for a machine; `drypoint draw` writes PDF".to_owned()));
    }
    if options.reporting.json && options.output == "-" {
        return Err(Failure::Usage("--json and -o - would both write to stdout".to_owned()));
    }
    let mut profile = options.profile.as_deref().map(|name| toolpaths::profile(name, &options.toolpaths)).transpose()?;
    toolpaths::check_language(format, profile.as_ref())?;
    toolpaths::check_preview(&options.output, &options.toolpaths)?;
    let mut pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, profile.as_mut())?;
    limit_threads(options.threads)?;
    let shown = if options.drawing == "-" { "stdin" } else { &options.drawing };
    let mut imported = read_svg(&output::read(&options.drawing)?).map_err(|error| Failure::about(shown)(&error))?;
    let model = ink_model(options, &imported);
    if options.dry_run {
        return foretell_plot::dry_run(&imported, options, model, profile.as_ref(), &mut pens, shown);
    }
    if options.occlude {
        leave_out_hidden(&mut imported, model);
    }
    choose_layers(&mut imported, &options.layers)?;
    if model == InkModel::Lines {
        count_fills(&mut imported);
    }
    let mut drawing = place(&imported.drawing(), options, reach_of(profile.as_ref()))?;
    if is_blank(&drawing, model) {
        let dropped =
            if imported.dropped.is_empty() { String::new() } else { format!(" (left out: {})", imported.dropped.summary()) };
        let advice = if model == InkModel::Lines { "; fills are drawn with --ink-model ink" } else { "" };
        return Err(Failure::Work(format!("{shown}: there is nothing to draw{dropped}{advice}")));
    }
    pens.assign(&mut drawing, profile.as_ref())?;
    affordable::check_line(&drawing, pens.nibs(), model, 1.0)?;
    let head = SvgHead {
        title: format!("Tool paths of {}", std::path::Path::new(shown).file_name().and_then(|n| n.to_str()).unwrap_or(shown)),
        description: "Tool paths in drawing order; each line is one nib wide.".to_owned(),
        recipe: json!({ "drypoint": env!("CARGO_PKG_VERSION"), "command": "plot", "pen_mm": options.pen }).to_string(),
    };
    let mut plots = Vec::new();
    for (name, drawing) in split_by_layer(&drawing, &options.output) {
        let plot = lower(&drawing, model, pens.nibs(), options.toolpaths.tolerance);
        let mut prepared = toolpaths::prepare(plot, profile.as_ref(), &options.toolpaths, &pens)?;
        if model == InkModel::Ink {
            prepared.report.add_coverage(&coverage(&drawing, &prepared.plot, pens.nibs()));
        }
        toolpaths::write(&name, format, &prepared, profile.as_ref(), &head)?;
        toolpaths::write_preview_of(&prepared, &options.toolpaths, drawing.layers.first().map(|layer| layer.name.as_str()))?;
        toolpaths::warn(&prepared, profile.as_ref(), Some(""));
        plots.push((name, prepared));
    }
    if !imported.dropped.is_empty() {
        eprintln!("drypoint: warning: left out or drawn otherwise: {}", imported.dropped.summary());
    }
    if options.reporting.json {
        let mut value = plots.first().map_or_else(|| json!({}), |(_, prepared)| json!(prepared.report));
        value["dropped"] = json!(imported.dropped);
        value["duplicates"] = json!(plots.iter().map(|(_, prepared)| prepared.duplicates).sum::<usize>());
        return output::print_json(&value);
    }
    for (name, prepared) in plots.iter().filter(|_| !options.reporting.quiet) {
        eprintln!("{name}: {}", toolpaths::summary(&prepared.report));
        toolpaths::pen_lines(prepared).iter().for_each(|line| eprintln!("{line}"));
    }
    Ok(())
}

/// Whether nothing of a drawing would be drawn.
fn is_blank(drawing: &Drawing, model: InkModel) -> bool {
    !drawing.marks().any(|mark| model == InkModel::Ink || matches!(mark, Mark::Stroke(_)))
}

fn ink_model(options: &PlotOptions, imported: &Imported) -> InkModel {
    match options.ink_model {
        _ if imported.is_toolpaths => InkModel::Lines,
        Some(InkModelOption::Ink) => InkModel::Ink,
        None if imported.recipe.is_some() => InkModel::Ink,
        Some(InkModelOption::Lines) | None => InkModel::Lines,
    }
}

/// What the painting order hides is not drawn.
fn leave_out_hidden(imported: &mut Imported, model: InkModel) {
    let seen = occluded(&imported.drawing(), &imported.painting, hides(model));
    for (layer, seen) in imported.layers.iter_mut().zip(seen.layers) {
        layer.layer = seen;
    }
}

/// What hides what: as ink, other colours; as lines, every fill.
pub(super) const fn hides(model: InkModel) -> Hides {
    match model {
        InkModel::Ink => Hides::OtherColours,
        InkModel::Lines => Hides::AllLines,
    }
}

pub(super) fn choose_layers(imported: &mut Imported, wanted: &[String]) -> Result<(), Failure> {
    if wanted.is_empty() {
        return Ok(());
    }
    let names: Vec<String> = imported.layers.iter().map(|l| format!("{} {}", l.layer.pen, l.layer.name)).collect();
    for name in wanted {
        if !imported.layers.iter().any(|l| l.layer.name == *name || l.layer.pen.to_string() == *name) {
            return Err(Failure::Usage(format!("there is no layer '{name}'; there are {}", names.join(", "))));
        }
    }
    imported.layers.retain(|l| wanted.iter().any(|name| l.layer.name == *name || l.layer.pen.to_string() == *name));
    Ok(())
}

/// Under `lines`, fills are not drawn, but not lost in silence either.
pub(super) fn count_fills(imported: &mut Imported) {
    let fills = imported.layers.iter().flat_map(|l| &l.layer.marks).filter(|m| !matches!(m, Mark::Stroke(_))).count();
    imported.dropped.add("fills", fills);
}

/// Turns, scales and moves the drawing on its sheet.
pub(super) fn place(drawing: &Drawing, options: &PlotOptions, reach: impl Fn(&Page) -> Option<Rect>) -> Result<Drawing, Failure> {
    let sheet = options.page.as_deref().map(layout::sheet).transpose()?;
    let turned = turn(drawing, turn_degrees(options.rotate, drawing, sheet));
    let page = sheet.map_or(turned.page, |(width, height)| Page { width, height, ..turned.page });
    let scaled = turned.transformed(Affine::scale(options.scale));
    let Some(bounds) = scaled.bounding_box() else { return Ok(Drawing { page, ..scaled }) };
    let moved = match (options.fit, options.center) {
        (PlotFit::Page, _) => {
            let free = page.rect().inset(-options.margin);
            let frame = reach(&page).map_or(free, |reach| free.intersect(reach));
            if frame.width() <= 0.0 || frame.height() <= 0.0 {
                return Err(Failure::Usage(format!("a margin of {} mm leaves nothing of the page", options.margin)));
            }
            let factor = (frame.width() / bounds.width().max(1e-6)).min(frame.height() / bounds.height().max(1e-6));
            scaled.transformed(centring(bounds, frame, factor))
        }
        (PlotFit::None, true) => scaled.transformed(centring(bounds, page.rect(), 1.0)),
        (PlotFit::None, false) => scaled,
    };
    Ok(Drawing { page, ..moved })
}

fn centring(bounds: Rect, page: Rect, factor: f64) -> Affine {
    Affine::translate(page.center().to_vec2()) * Affine::scale(factor) * Affine::translate(-bounds.center().to_vec2())
}

fn turn_degrees(rotate: Rotate, drawing: &Drawing, sheet: Option<(f64, f64)>) -> u32 {
    match rotate {
        Rotate::None => 0,
        Rotate::Quarter => 90,
        Rotate::Half => 180,
        Rotate::ThreeQuarters => 270,
        Rotate::Auto => {
            let Page { width, height, .. } = drawing.page;
            let fits = |w: f64, h: f64| sheet.is_none_or(|(sw, sh)| w <= sw + 0.5 && h <= sh + 0.5);
            if !fits(width, height) && fits(height, width) { 90 } else { 0 }
        }
    }
}

/// Clockwise by a multiple of 90 degrees; the page turns along.
fn turn(drawing: &Drawing, degrees: u32) -> Drawing {
    let Page { width, height, .. } = drawing.page;
    let (matrix, width, height) = match degrees {
        90 => (Affine::new([0.0, 1.0, -1.0, 0.0, height, 0.0]), height, width),
        180 => (Affine::new([-1.0, 0.0, 0.0, -1.0, width, height]), width, height),
        270 => (Affine::new([0.0, -1.0, 1.0, 0.0, 0.0, width]), height, width),
        _ => (Affine::IDENTITY, width, height),
    };
    let mut turned = drawing.transformed(matrix);
    turned.page = Page { width, height, ..drawing.page };
    turned
}
