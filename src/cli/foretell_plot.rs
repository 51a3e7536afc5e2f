//! `plot --dry-run`: the plot of an SVG without the search for a short way. What is large is plotted as it is; of many small marks those
//! in some windows are, and stand for the others.
//!
//! ```text
//!   +---+---+---+---+
//!   | # | # | # | # |     the windows lie in the middle of cells all over the drawing, as large as the work allows
//!   +---+---+---+---+
//!   | # | # | # | # |
//!   +---+---+---+---+
//! ```

use super::amounts::PlotAmounts;
use super::arguments::PlotOptions;
use super::failure::Failure;
use super::foretell::quickly;
use super::interruption::interrupt;
use super::messages::{say, warning};
use super::output;
use super::pens::PenSet;
use super::plot::{choose_layers, count_fills, hides, place, reach_of};
use super::toolpaths::{self, LONG_HOURS, duration};
use crate::drawing::{Layer, Mark, Painted, Stroke, Width};
use crate::geometry::{BezPath, Point, Rect};
use crate::plot::{InkModel, Profile, lower, occluded};
use crate::read::Imported;
use kurbo::Shape;
use serde_json::json;

/// Marks that are plotted at most: as lines, with their ink, and where what is hidden is cut away.
const MOST_LINES: usize = 40_000;
const MOST_INKED: usize = 6000;
const MOST_OCCLUDED: usize = 700;
/// Cells a side.
const CELLS: f64 = 4.0;
/// Share of the drawing's longer side from which a mark is large.
const LARGE: f64 = 1.0 / 8.0;
/// How much wider than a window that is where marks may hide what lies in it.
const COVER_REACH: f64 = 1.5;

/// Reports the estimate and writes nothing.
pub(super) fn dry_run(
    imported: &Imported,
    options: &PlotOptions,
    model: InkModel,
    profile: Option<&Profile>,
    pens: &mut PenSet,
    shown: &str,
) -> Result<(), Failure> {
    let mut dropped = imported.dropped.clone();
    if model == InkModel::Lines {
        let mut counted = imported.clone();
        choose_layers(&mut counted, &options.layers)?;
        count_fills(&mut counted);
        dropped = counted.dropped;
    }
    let mut told: Option<PlotAmounts> = None;
    let strata = strata(imported, most(options, model));
    let share = strata.iter().map(|stratum| 1.0 / stratum.weight).fold(1.0, f64::min);
    for stratum in &strata {
        let amounts = plotted(imported, stratum, options, model, profile, pens)?.scaled(stratum.weight);
        told = Some(told.map_or_else(|| amounts.clone(), |told| told.and(&amounts)));
    }
    let told = told.filter(|told| told.ordered.total.paths > 0).ok_or_else(|| {
        let advice = if model == InkModel::Lines { "; fills are drawn with --ink-model ink" } else { "" };
        Failure::Work(format!("{shown}: there is nothing to draw{advice}"))
    })?;
    if let Some(seconds) = told.ordered.total.seconds.filter(|seconds| *seconds > LONG_HOURS * 3600.0) {
        warning!("this plot will take about {}", duration(seconds));
    }
    if options.reporting.json {
        let mut value = json!(told.ordered);
        value["dropped"] = json!(dropped);
        value["estimate"] = json!({ "share_plotted": share });
        return output::print_json(&value);
    }
    if !options.reporting.quiet {
        say!("{shown}: about {}", toolpaths::summary(&told.ordered));
        let part = if share < 1.0 {
            format!("estimated from {:.1} % of its small marks, to about 10 %; ", 100.0 * share)
        } else {
            String::new()
        };
        say!("{part}not searched for the shortest way; nothing is written");
    }
    Ok(())
}

fn most(options: &PlotOptions, model: InkModel) -> usize {
    match model {
        _ if options.occlude => MOST_OCCLUDED,
        InkModel::Ink => MOST_INKED,
        InkModel::Lines => MOST_LINES,
    }
}

/// Marks of a drawing that are plotted together, and how many each of them stands for.
struct Stratum {
    bounds: Rect,
    kind: Kind,
    weight: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    All,
    Large,
    /// Small ones in windows that take this share of a cell's side.
    Windows(f64),
}

/// All marks, or the large ones and windows of the small.
fn strata(imported: &Imported, most: usize) -> Vec<Stratum> {
    let boxes: Vec<Rect> = imported.layers.iter().flat_map(|layer| &layer.layer.marks).map(Mark::bounding_box).collect();
    let Some(bounds) = boxes.iter().copied().reduce(|a, b| a.union(b)) else { return Vec::new() };
    let all = Stratum { bounds, kind: Kind::All, weight: 1.0 };
    let small = boxes.iter().filter(|mark| !is_large(**mark, bounds)).count();
    if boxes.len() <= most || small < most {
        return vec![all];
    }
    let windows = Kind::Windows((most as f64 / small as f64).sqrt());
    let mut stratum = Stratum { kind: windows, weight: 1.0, ..all };
    let held = boxes.iter().filter(|mark| stratum.holds(**mark, 1.0)).count();
    if held == 0 {
        return vec![all];
    }
    stratum.weight = small as f64 / held as f64;
    vec![Stratum { kind: Kind::Large, ..all }, stratum]
}

fn is_large(mark: Rect, bounds: Rect) -> bool {
    mark.width().max(mark.height()) > LARGE * bounds.width().max(bounds.height())
}

impl Stratum {
    /// Whether a mark belongs to it, its windows so many times as wide.
    fn holds(&self, mark: Rect, wider: f64) -> bool {
        match self.kind {
            Kind::All => true,
            Kind::Large => is_large(mark, self.bounds),
            Kind::Windows(side) => {
                let off_middle = |at: f64, low: f64, extent: f64| ((at - low) / extent.max(1e-9) * CELLS).fract() - 0.5;
                let p = mark.center();
                let reach = 0.5 * side * wider;
                !is_large(mark, self.bounds)
                    && off_middle(p.x, self.bounds.x0, self.bounds.width()).abs() <= reach
                    && off_middle(p.y, self.bounds.y0, self.bounds.height()).abs() <= reach
            }
        }
    }

    /// The drawing's marks of this stratum, what hides them cut away; two touches at the ends of its box keep its place.
    fn of(&self, imported: &Imported, options: &PlotOptions, model: InkModel) -> Result<Imported, Failure> {
        let mut part = imported.clone();
        if options.occlude {
            let is_near = |painted: &&Painted| match painted {
                Painted::White(outline) => self.kind != Kind::Large || is_large(outline.bounding_box(), self.bounds),
                Painted::Mark { layer, mark } => {
                    let mark = imported.layers[*layer].layer.marks[*mark].bounding_box();
                    is_large(mark, self.bounds) || self.holds(mark, COVER_REACH)
                }
            };
            let painting: Vec<Painted> = imported.painting.iter().filter(is_near).cloned().collect();
            let seen = occluded(&imported.drawing(), &painting, hides(model), interrupt())?;
            for (layer, seen) in part.layers.iter_mut().zip(seen.layers) {
                layer.layer = seen;
            }
        }
        let is_cut = options.occlude && self.kind == Kind::Large;
        for layer in &mut part.layers {
            layer.layer.marks.retain(|mark| is_cut || self.holds(mark.bounding_box(), 1.0));
        }
        if self.kind != Kind::All
            && let Some(first) = part.layers.first_mut()
        {
            self.hold_box(&mut first.layer);
        }
        Ok(part)
    }

    fn hold_box(&self, layer: &mut Layer) {
        for p in [self.bounds.origin(), Point::new(self.bounds.x1, self.bounds.y1)] {
            let mut curve = BezPath::new();
            curve.move_to(p);
            curve.line_to(p);
            layer.marks.push(Mark::Stroke(Stroke::new(curve, Width::Constant(1e-3))));
        }
    }
}

fn plotted(
    imported: &Imported,
    stratum: &Stratum,
    options: &PlotOptions,
    model: InkModel,
    profile: Option<&Profile>,
    pens: &mut PenSet,
) -> Result<PlotAmounts, Failure> {
    let mut part = stratum.of(imported, options, model)?;
    choose_layers(&mut part, &options.layers)?;
    let (mut drawing, _) = place(&part.drawing(), options, reach_of(profile))?;
    pens.hand_out(&mut drawing, profile)?;
    let plot = lower(&drawing, model, pens.nibs(), options.toolpaths.tolerance, interrupt())?;
    let clips = options.toolpaths.clip;
    let quick = super::arguments::ToolpathOptions { clip: clips, ..quickly(&options.toolpaths) };
    let prepared = toolpaths::prepare(plot, profile, &quick, pens)?;
    Ok(PlotAmounts { ordered: prepared.report, before: prepared.unordered })
}
