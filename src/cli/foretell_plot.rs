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

use super::advice;
use super::affordable;
use super::amounts::PlotAmounts;
use super::arguments::PlotOptions;
use super::failure::Failure;
use super::foretell::quickly;
use super::interruption::interrupt;
use super::job;
use super::messages::{self, say, warning};
use super::output;
use super::pens::PenSet;
use super::plot::{choose_layers, count_fills, hides, place, reach_of};
use super::toolpaths::{self, LONG_HOURS, duration};
use crate::drawing::{Dot, Layer, Mark};
use crate::geometry::{Affine, Point, Rect};
use crate::plot::{InkModel, Plot, Profile, Toolpath, lower, occluded_where};
use crate::read::Imported;
use serde_json::json;

/// Strokes that are plotted at most, as lines and with their ink.
const MOST_LINES: f64 = 40_000.0;
const MOST_INKED: f64 = 6000.0;
/// The same where fragments of marks join those of their neighbours, for the windows have margins. Of five paintings of 40 to 60 mm the time
/// is told at 0.80 to 1.20 of the truth; with 6000 at 0.9 to 1.4.
const MOST_JOINED: f64 = 12_000.0;
/// For how many strokes a mark counts that what hides it is cut out of.
const CUT_WORK: f64 = 5.0;
/// For how many strokes an area counts that is filled, and each nib of its width once more: discs of 0.6 mm and a nib of 0.3 mm take a
/// millisecond, ten times as large ones fifteen.
const AREA_WORK: f64 = 6.0;
/// Cells a side, at most.
const CELLS: usize = 4;
/// Margin of a window in lengths of a usual mark, where fragments of marks join those of their neighbours. Without one the time is told
/// twice too long, with a whole length the windows are too small to stand for the rest (1.1 to 1.5 of the truth).
const MARGIN: f64 = 0.5;
/// Share of a window with its margins that the window itself takes at least, by its side: for larger windows there are fewer.
const LEAST_INSIDE: f64 = 0.6;
/// Share of the drawing's longer side from which a mark is large.
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
    if let Some(seconds) = told.ordered.total.seconds.filter(|seconds| *seconds > LONG_HOURS * 3600.0) {
        warning!("this plot will take about {}", duration(seconds));
    }
    if let Some(limit) = options.max_time
        && let Some(seconds) = told.ordered.total.seconds.filter(|seconds| *seconds > limit)
    {
        warning!(
            "about {}, longer than --max-time {}: without --dry-run a smaller size is sought",
            duration(seconds),
            duration(limit)
        );
    }
    if !dropped.is_empty() {
        warning!("left out or drawn otherwise: {}", dropped.summary());
    }
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
            let accuracy = if options.occlude { "with --occlude to about 30 %" } else { "to about 10 %" };
            format!("estimated from {:.1} % of its small marks, {accuracy}; ", 100.0 * share)
        } else {
            String::new()
        };
        say!("{part}not searched for the shortest way; nothing is written");
    }
    Ok(())
}

/// How many strokes' work a mark is.
fn work(mark: &Mark, bounds: Rect, options: &PlotOptions, model: InkModel) -> f64 {
    let cut = if options.occlude { CUT_WORK } else { 0.0 };
    cut + match mark {
        Mark::Area(_) if model == InkModel::Ink => {
            AREA_WORK * (1.0 + 0.5 * bounds.width().min(bounds.height()) * options.scale.unwrap_or(1.0) / options.pen)
        }
        _ => 1.0,
    }
}

/// Marks of a drawing that are plotted together, and how many each of them stands for.
#[derive(Clone, Copy)]
struct Stratum {
    bounds: Rect,
    /// The box of the layers asked for, which says where the drawing is placed.
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

/// Windows in the middle of cells, as many across as down.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Windows {
    cells: f64,
    /// Share of a cell's side that a window takes.
    side: f64,
    /// Millimetres around a window in which marks are plotted, too, but not counted: what of them joins what is inside is one path with
    /// it.
    margin: f64,
}

/// All marks, or the large ones and windows of the small.
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

/// Windows of which, with their margins, this share of their cells' sides may be plotted.
fn windows(share: f64, small: &[(Rect, f64)], bounds: Rect, joins: bool) -> Windows {
    if !joins {
        return Windows { cells: CELLS as f64, side: share, margin: 0.0 };
    }
    let mut lengths: Vec<f64> = small.iter().map(|(mark, _)| mark.width().max(mark.height())).collect();
    lengths.sort_by(f64::total_cmp);
    let margin = MARGIN * lengths[lengths.len() / 2];
    let side = |cells: f64| share - 2.0 * margin * cells / bounds.width().max(bounds.height());
    let cells = (2..=CELLS).rev().map(|cells| cells as f64).find(|cells| side(*cells) >= LEAST_INSIDE * share).unwrap_or(2.0);
    Windows { cells, side: side(cells).max(0.4 * share), margin }
}

fn is_large(mark: Rect, bounds: Rect) -> bool {
    mark.width().max(mark.height()) > LARGE * bounds.width().max(bounds.height())
}

impl Windows {
    /// Whether a place is in one of the windows, or so many millimetres around.
    fn hold(&self, p: Point, bounds: Rect, margin: f64) -> bool {
        let is_near = |at: f64, low: f64, extent: f64| {
            let off_middle = ((at - low) / extent.max(1e-9) * self.cells).rem_euclid(1.0) - 0.5;
            off_middle.abs() <= 0.5 * self.side + margin * self.cells / extent.max(1e-9)
        };
        is_near(p.x, bounds.x0, bounds.width()) && is_near(p.y, bounds.y0, bounds.height())
    }
}

impl Stratum {
    /// Whether a mark of this box belongs to it.
    fn holds(&self, mark: Rect) -> bool {
        match self.kind {
            Kind::All => true,
            Kind::Large => is_large(mark, self.bounds),
            Kind::Windows(windows) => !is_large(mark, self.bounds) && windows.hold(mark.center(), self.bounds, 0.0),
        }
    }

    /// Whether a mark of this box is plotted with it, counted or not.
    fn takes(&self, mark: Rect) -> bool {
        match self.kind {
            Kind::Windows(windows) => !is_large(mark, self.bounds) && windows.hold(mark.center(), self.bounds, windows.margin),
            _ => self.holds(mark),
        }
    }

    /// Leaves out the tool paths that begin in a window's margin; `placing` is where the drawing went on its sheet.
    fn keep_inside(&self, plot: &mut Plot, placing: Affine) {
        let Kind::Windows(windows) = self.kind else { return };
        let back = placing.inverse();
        let is_inside = |path: &Toolpath| windows.hold(back * path.points[path.points.len() / 2], self.bounds, 0.0);
        plot.pens.iter_mut().for_each(|pen| pen.paths.retain(is_inside));
    }

    /// The drawing's marks of this stratum, what hides them cut away.
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

    /// A layer of three corners of the whole drawing's box: with it a part is placed as the whole is.
    fn corners(&self) -> Layer {
        let mut layer = Layer::new("corners", 1);
        layer.marks = self.corner_points().map(|p| Mark::Dot(Dot::circle(p, 0.0))).to_vec();
        layer
    }

    fn corner_points(&self) -> [Point; 3] {
        [self.placed.origin(), Point::new(self.placed.x1, self.placed.y0), Point::new(self.placed.x1, self.placed.y1)]
    }

    /// Where these corners have taken the whole drawing.
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
    pens.hand_out(&mut drawing, profile)?;
    affordable::check_line(&drawing, pens.nibs(), model, stratum.weight)?;
    let mut plot = lower(&drawing, model, pens.nibs(), options.toolpaths.tolerance, interrupt())?;
    stratum.keep_inside(&mut plot, placing);
    let clips = options.toolpaths.clip;
    let quick = super::arguments::ToolpathOptions { clip: clips, ..quickly(&options.toolpaths) };
    let job =
        job::of_paths(plot, profile, &quick, pens).map_err(|failure| advice::for_plot(failure, options, turning.degrees))?;
    Ok(PlotAmounts { ordered: job.report().clone(), before: job.unordered().clone() })
}
