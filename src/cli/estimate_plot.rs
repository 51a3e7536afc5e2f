//! `plot --dry-run`: an estimate of an SVG's plot, without the search for short travel. Large marks are all plotted. If there are
//! many small marks, only those in some windows are plotted, and stand for the others.
//!
//! ```text
//!   +---+---+---+---+
//!   | # | # | # | # |     windows in the middle of cells all over the drawing, as large as the work allows
//!   +---+---+---+---+
//!   | # | # | # | # |
//!   +---+---+---+---+
//! ```

use super::advice;
use super::affordable;
use super::amounts::PlotAmounts;
use super::arguments::PlotOptions;
use super::estimate::quickly;
use super::failure::Failure;
use super::interruption::interrupt;
use super::job;
use super::layout::reach_of;
use super::messages::{self, say, warning};
use super::output;
use super::pens::PenSet;
use super::plotted_part::{choose_layers, count_fills, hides, place};
use super::toolpaths::{self, LONG_HOURS, duration};
use crate::drawing::{Dot, Layer, Mark};
use crate::geometry::{Affine, Point, Rect};
use crate::plot::{InkModel, Plot, Profile, Toolpath, lower, occluded_where};
use crate::read::{Dropped, Imported};
use serde_json::json;

/// Maximum number of strokes plotted, as lines and with their ink.
const MOST_LINES: f64 = 40_000.0;
const MOST_INKED: f64 = 6000.0;
/// The same if fragments of marks join those of their neighbours: then the windows have margins. On five paintings of 40 to 60 mm the
/// estimated time is 0.80 to 1.20 of the true one; with 6000 it is 0.9 to 1.4.
const MOST_JOINED: f64 = 12_000.0;
/// Extra work of a mark when hidden parts are cut out of it, in strokes.
const CUT_WORK: f64 = 5.0;
/// Work of a filled area, in strokes; half as much again is added per nib width across it. With a nib of 0.3 mm, discs of 0.6 mm
/// take a millisecond, discs ten times as large fifteen.
const AREA_WORK: f64 = 6.0;
/// Maximum number of cells per side.
const CELLS: usize = 4;
/// Margin of a window, in median mark lengths, if fragments of marks join those of their neighbours. Without a margin the estimated
/// time is twice too long; with 1 the windows are too small to be representative (1.1 to 1.5 of the true time).
const MARGIN: f64 = 0.5;
/// Minimum side of a window as a fraction of its side with margins. Below that, fewer and larger windows are used.
const LEAST_INSIDE: f64 = 0.6;
/// A mark is large if it is longer than this fraction of the drawing's longer side.
const LARGE: f64 = 1.0 / 8.0;

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
    let strata = strata(imported, options, model)?;
    let share = strata.iter().map(|stratum| 1.0 / stratum.weight).fold(1.0, f64::min);
    for stratum in &strata {
        let amounts = plotted(imported, stratum, options, model, profile, pens)?.scaled(stratum.weight);
        told = Some(told.map_or_else(|| amounts.clone(), |told| told.and(&amounts)));
    }
    let told = told.filter(|told| told.ordered.total.paths > 0).ok_or_else(|| {
        let advice = if model == InkModel::Lines { "; fills are drawn with --ink-model ink" } else { "" };
        Failure::Work(format!("{shown}: there is nothing to draw{advice}"))
    })?;
    warn(&told, options, &dropped);
    report(&told, options, &dropped, share, shown)
}

/// Warns of a long plot, of a limit that is not kept and of what is left out.
fn warn(told: &PlotAmounts, options: &PlotOptions, dropped: &Dropped) {
    if let Some(seconds) = told.ordered.total.seconds.filter(|seconds| *seconds > LONG_HOURS * 3600.0) {
        warning!("this plot will take about {}", duration(seconds));
    }
    if let Some(limit) = options.max_time
        && let Some(seconds) = told.ordered.total.seconds.filter(|seconds| *seconds > limit)
    {
        warning!(
            "about {}, longer than --max-time {}; without --dry-run a smaller size is chosen",
            duration(seconds),
            duration(limit)
        );
    }
    if !dropped.is_empty() {
        warning!("left out or drawn otherwise: {}", dropped.summary());
    }
}

/// Says what the plot will take.
fn report(told: &PlotAmounts, options: &PlotOptions, dropped: &Dropped, share: f64, shown: &str) -> Result<(), Failure> {
    if options.reporting.json {
        let mut value = json!(told.ordered);
        value["dropped"] = json!(dropped);
        value["estimate"] = json!({ "share_plotted": share });
        value["warnings"] = json!(messages::warnings());
        return output::print_json(&value);
    }
    if !options.reporting.quiet {
        say!("{shown}: about {}", toolpaths::summary(&told.ordered));
        let part = if share < 1.0 {
            let accuracy = if options.occlude { "with --occlude within about 30 %" } else { "within about 10 %" };
            format!("estimated from {:.1} % of its small marks, {accuracy}; ", 100.0 * share)
        } else {
            String::new()
        };
        say!("{part}without the search for short travel; nothing is written");
    }
    Ok(())
}

/// Work of a mark, in strokes.
fn work(mark: &Mark, bounds: Rect, options: &PlotOptions, model: InkModel) -> f64 {
    let cut = if options.occlude { CUT_WORK } else { 0.0 };
    cut + match mark {
        Mark::Area(_) if model == InkModel::Ink => {
            AREA_WORK * (1.0 + 0.5 * bounds.width().min(bounds.height()) * options.scale.unwrap_or(1.0) / options.pen)
        }
        _ => 1.0,
    }
}

/// Marks of a drawing that are plotted together, and the number of marks each of them stands for.
#[derive(Clone, Copy)]
struct Stratum {
    bounds: Rect,
    /// The box of the selected layers, by which the drawing is placed.
    placed: Rect,
    kind: Kind,
    weight: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    All,
    Large,
    /// Small ones in windows.
    Windows(Windows),
}

/// Windows in the middle of square-grid cells, as many across as down.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Windows {
    cells: f64,
    /// Side of a window as a fraction of a cell's side.
    side: f64,
    /// Width in millimetres of the border around a window in which marks are plotted but not counted, so that fragments inside can
    /// join them.
    margin: f64,
}

/// All marks as one stratum, or the large marks and windows of the small ones.
fn strata(imported: &Imported, options: &PlotOptions, model: InkModel) -> Result<Vec<Stratum>, Failure> {
    let marks: Vec<(Rect, f64)> = imported
        .layers
        .iter()
        .flat_map(|layer| &layer.layer.marks)
        .map(|mark| (mark.bounding_box(), work(mark, mark.bounding_box(), options, model)))
        .collect();
    let Some(bounds) = marks.iter().map(|mark| mark.0).reduce(|a, b| a.union(b)) else { return Ok(Vec::new()) };
    let mut chosen = imported.clone();
    choose_layers(&mut chosen, &options.layers)?;
    let placed = chosen.drawing().bounding_box().unwrap_or(bounds);
    let all = Stratum { bounds, placed, kind: Kind::All, weight: 1.0 };
    let small: Vec<(Rect, f64)> = marks.iter().copied().filter(|mark| !is_large(mark.0, bounds)).collect();
    let joins = options.occlude && model == InkModel::Ink;
    let most = match model {
        _ if joins => MOST_JOINED,
        InkModel::Lines if !options.occlude => MOST_LINES,
        _ => MOST_INKED,
    };
    let work: f64 = small.iter().map(|mark| mark.1).sum();
    if work <= most {
        return Ok(vec![all]);
    }
    let windows = Stratum { kind: Kind::Windows(windows((most / work).sqrt(), &small, bounds, joins)), ..all };
    let held = small.iter().filter(|mark| windows.holds(mark.0)).count();
    if held == 0 {
        return Ok(vec![all]);
    }
    Ok(vec![Stratum { kind: Kind::Large, ..all }, Stratum { weight: small.len() as f64 / held as f64, ..windows }])
}

/// Windows whose side, with margins, is at most `share` of a cell's side.
fn windows(share: f64, small: &[(Rect, f64)], bounds: Rect, joins: bool) -> Windows {
    if !joins {
        return Windows { cells: CELLS as f64, side: share, margin: 0.0 };
    }
    let mut lengths: Vec<f64> = small.iter().map(|(mark, _)| mark.width().max(mark.height())).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let margin = MARGIN * lengths[lengths.len() / 2];
    let side = |cells: f64| share - 2.0 * margin * cells / bounds.width().max(bounds.height());
    let cells = (2..=CELLS).rev().map(|cells| cells as f64).find(|cells| side(*cells) >= LEAST_INSIDE * share).unwrap_or(2.0);
    Windows { cells, side: side(cells).max(0.4 * share), margin }
}

fn is_large(mark: Rect, bounds: Rect) -> bool {
    mark.width().max(mark.height()) > LARGE * bounds.width().max(bounds.height())
}

impl Windows {
    /// True if a point is in one of the windows or within `margin` millimetres of one.
    fn hold(&self, p: Point, bounds: Rect, margin: f64) -> bool {
        let is_near = |at: f64, low: f64, extent: f64| {
            let off_middle = ((at - low) / extent.max(1e-9) * self.cells).rem_euclid(1.0) - 0.5;
            off_middle.abs() <= 0.5 * self.side + margin * self.cells / extent.max(1e-9)
        };
        is_near(p.x, bounds.x0, bounds.width()) && is_near(p.y, bounds.y0, bounds.height())
    }
}

impl Stratum {
    /// True if a mark with this bounding box belongs to the stratum.
    fn holds(&self, mark: Rect) -> bool {
        match self.kind {
            Kind::All => true,
            Kind::Large => is_large(mark, self.bounds),
            Kind::Windows(windows) => !is_large(mark, self.bounds) && windows.hold(mark.center(), self.bounds, 0.0),
        }
    }

    /// True if a mark with this bounding box is plotted with the stratum, counted or not.
    fn takes(&self, mark: Rect) -> bool {
        match self.kind {
            Kind::Windows(windows) => !is_large(mark, self.bounds) && windows.hold(mark.center(), self.bounds, windows.margin),
            _ => self.holds(mark),
        }
    }

    /// Removes the tool paths whose middle lies in a window's margin; `placing` maps the drawing to its place on the sheet.
    fn keep_inside(&self, plot: &mut Plot, placing: Affine) {
        let Kind::Windows(windows) = self.kind else { return };
        let back = placing.inverse();
        let is_inside = |path: &Toolpath| windows.hold(back * path.points()[path.points().len() / 2], self.bounds, 0.0);
        plot.pens.iter_mut().for_each(|pen| pen.paths.retain(is_inside));
    }

    /// The drawing's marks of this stratum, without their hidden parts.
    fn of(&self, imported: &Imported, options: &PlotOptions, model: InkModel) -> Result<Imported, Failure> {
        let mut part = imported.clone();
        if options.occlude {
            let is_wanted = |layer: usize, mark: usize| self.takes(imported.layers[layer].layer.marks[mark].bounding_box());
            let seen = occluded_where(&imported.drawing(), &imported.painting, hides(model), is_wanted, interrupt())?;
            part.layers.iter_mut().zip(seen.layers).for_each(|(layer, seen)| layer.layer = seen);
        } else {
            part.layers.iter_mut().for_each(|layer| layer.layer.marks.retain(|mark| self.takes(mark.bounding_box())));
        }
        Ok(part)
    }

    /// A layer with three corners of the whole drawing's box: it makes a part be placed as the whole would be.
    fn corners(&self) -> Layer {
        let mut layer = Layer::new("corners", 1);
        layer.marks = self.corner_points().map(|p| Mark::Dot(Dot::circle(p, 0.0))).to_vec();
        layer
    }

    fn corner_points(&self) -> [Point; 3] {
        [self.placed.origin(), Point::new(self.placed.x1, self.placed.y0), Point::new(self.placed.x1, self.placed.y1)]
    }

    /// The transform that took the whole drawing to the place of these corners.
    fn placing(&self, corners: &Layer) -> Affine {
        let frame = |[a, b, c]: [Point; 3]| {
            let (across, down) = (b - a, c - b);
            Affine::new([across.x, across.y, down.x, down.y, a.x, a.y])
        };
        let centre = |mark: &Mark| mark.bounding_box().center();
        match corners.marks.iter().map(centre).collect::<Vec<_>>()[..] {
            [a, b, c] if self.placed.area() > 0.0 => frame([a, b, c]) * frame(self.corner_points()).inverse(),
            _ => Affine::IDENTITY,
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
    let mut drawing = part.drawing();
    drawing.layers.push(stratum.corners());
    let (mut drawing, turning) = place(&drawing, options, reach_of(profile))?;
    let placing = drawing.layers.pop().map_or(Affine::IDENTITY, |corners| stratum.placing(&corners));
    pens.assign_pens(&mut drawing, profile)?;
    affordable::check_line(&drawing, pens.nibs(), model, stratum.weight)?;
    let mut plot = lower(&drawing, model, pens.nibs(), options.toolpaths.tolerance, interrupt())?;
    stratum.keep_inside(&mut plot, placing);
    let clips = options.toolpaths.clip;
    let quick = super::arguments::ToolpathOptions { clip: clips, ..quickly(&options.toolpaths) };
    let job =
        job::of_paths(plot, profile, &quick, pens).map_err(|failure| advice::for_plot(failure, options, turning.degrees))?;
    Ok(PlotAmounts { ordered: job.report().clone(), before: job.unordered().clone() })
}
