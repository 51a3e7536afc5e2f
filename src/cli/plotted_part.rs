//! What of an SVG is plotted, and where on its sheet.

use super::arguments::{PlotFit, PlotOptions};
use super::failure::Failure;
use super::layout;
use super::placing::{Turning, requested_move};
use crate::drawing::{Drawing, Mark, Page};
use crate::geometry::{Affine, Rect};
use crate::plot::{Hides, InkModel};
use crate::read::Imported;

/// Which marks hide others: with ink, other colours; with lines, every fill.
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

/// Counts fills as dropped: the `lines` model does not draw them.
pub(super) fn count_fills(imported: &mut Imported) {
    let fills = imported.layers.iter().flat_map(|l| &l.layer.marks).filter(|m| !matches!(m, Mark::Stroke(_))).count();
    imported.dropped.add("fills", fills);
}

/// Turns, scales and moves the drawing on its sheet; also returns the turning.
pub(super) fn place(
    drawing: &Drawing,
    options: &PlotOptions,
    reach: impl Fn(&Page) -> Option<Rect>,
) -> Result<(Drawing, Turning), Failure> {
    if options.fit == PlotFit::Page && options.placing.at.is_some() {
        return Err(Failure::Usage("--fit page sets the position, which --at would change; leave one of them out".to_owned()));
    }
    let sheet = options.page.as_deref().map(layout::sheet).transpose()?;
    let turning = Turning::asked(&options.placing, || fits_only_turned(drawing, sheet));
    let turned = turning.turned(drawing.clone());
    let page = sheet.map_or(turned.page, |(width, height)| Page { width, height, ..turned.page });
    let scaled = options.scale.map_or_else(|| turned.clone(), |scale| turned.transformed(Affine::scale(scale)));
    let Some(bounds) = scaled.bounding_box() else { return Ok((Drawing { page, ..scaled }, turning)) };
    let reach = reach(&page);
    let matrix = if options.fit == PlotFit::Page {
        filling(bounds, free_of(&page, options.margin, reach)?)
    } else {
        Affine::translate(requested_move(&options.placing, bounds, &page, reach))
    };
    let moved = if matrix == Affine::IDENTITY { scaled } else { scaled.transformed(matrix) };
    Ok((Drawing { page, ..moved }, turning))
}

/// The part of a page inside the margin and the machine's reach.
fn free_of(page: &Page, margin: f64, reach: Option<Rect>) -> Result<Rect, Failure> {
    let free = page.rect().inset(-margin);
    let free = reach.map_or(free, |reach| free.intersect(reach));
    if free.width() > 0.0 && free.height() > 0.0 {
        return Ok(free);
    }
    Err(Failure::Usage(format!("a margin of {margin} mm leaves nothing of the page; make it smaller")))
}

/// The transform that fits a box into the middle of another, keeping its proportions.
fn filling(bounds: Rect, frame: Rect) -> Affine {
    let factor = (frame.width() / bounds.width().max(1e-6)).min(frame.height() / bounds.height().max(1e-6));
    Affine::translate(frame.center().to_vec2()) * Affine::scale(factor) * Affine::translate(-bounds.center().to_vec2())
}

/// True if the drawing's page fits the sheet only after a quarter turn.
fn fits_only_turned(drawing: &Drawing, sheet: Option<(f64, f64)>) -> bool {
    let Page { width, height, .. } = drawing.page;
    let fits = |w: f64, h: f64| sheet.is_none_or(|(sw, sh)| w <= sw + 0.5 && h <= sh + 0.5);
    !fits(width, height) && fits(height, width)
}
