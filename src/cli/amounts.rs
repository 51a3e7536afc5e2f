//! Amounts of a drawing and its plot, as numbers that can be scaled and combined.

use crate::drawing::Drawing;
use crate::plot::{PenReport, PlotReport};

/// Marks and ink per layer, and the plot's report.
#[derive(Clone, Debug)]
pub(super) struct Amounts {
    pub layers: Vec<LayerAmounts>,
    pub plot: Option<PlotAmounts>,
}

/// Amounts of one layer.
#[derive(Clone, Debug)]
pub(super) struct LayerAmounts {
    pub name: String,
    pub pen: u32,
    pub ink: String,
    /// Numbers of dots, strokes and areas.
    pub counts: [f64; 3],
    pub ink_mm2: f64,
}

/// A plot's report after ordering and before.
#[derive(Clone, Debug)]
pub(super) struct PlotAmounts {
    pub ordered: PlotReport,
    pub before: PlotReport,
}

impl Amounts {
    pub(super) fn of(drawing: &Drawing, plot: Option<PlotAmounts>) -> Self {
        let layers = drawing.layers.iter().zip(drawing.ink_mm2()).map(|(layer, ink_mm2)| LayerAmounts {
            name: layer.name.clone(),
            pen: layer.pen,
            ink: layer.ink.to_string(),
            counts: layer.counts().map(|count| count as f64),
            ink_mm2,
        });
        Self { layers: layers.collect(), plot }
    }

    /// Combines every amount with the other's as `f(one, other)`. If the other has no such layer or pen, both arguments are this one's.
    pub(super) fn with(&self, other: &Self, f: &impl Fn(f64, f64) -> f64) -> Self {
        let layers = self.layers.iter().map(|layer| {
            let twin = other.layers.iter().find(|other| other.name == layer.name).unwrap_or(layer);
            LayerAmounts {
                counts: [0, 1, 2].map(|i| f(layer.counts[i], twin.counts[i])),
                ink_mm2: f(layer.ink_mm2, twin.ink_mm2),
                ..layer.clone()
            }
        });
        let plot = self.plot.as_ref().map(|plot| plot.with(other.plot.as_ref().unwrap_or(plot), f));
        Self { layers: layers.collect(), plot }
    }

    /// All amounts times `factor`, except `fixed` seconds of each pen.
    pub(super) fn scaled(&self, factor: f64, fixed: f64) -> Self {
        let mut scaled = self.with(self, &|amount, _| amount * factor);
        if let Some(plot) = &mut scaled.plot {
            plot.add_seconds(fixed * (1.0 - factor));
        }
        scaled
    }

    /// Numbers of dots, strokes and areas over all layers.
    pub(super) fn counts(&self) -> [f64; 3] {
        self.layers.iter().fold([0.0; 3], |sum, layer| [0, 1, 2].map(|i| sum[i] + layer.counts[i]))
    }

    /// Plotting time in seconds; 0 without a machine.
    pub(super) fn plot_seconds(&self) -> f64 {
        self.plot.as_ref().and_then(|plot| plot.ordered.total.seconds).unwrap_or(0.0)
    }
}

impl PlotAmounts {
    fn with(&self, other: &Self, f: &impl Fn(f64, f64) -> f64) -> Self {
        Self { ordered: together(&self.ordered, &other.ordered, f), before: together(&self.before, &other.before, f) }
    }

    /// The sum of two plots; pens with the same number are added up.
    pub(super) fn and(&self, other: &Self) -> Self {
        Self { ordered: joined(&self.ordered, &other.ordered), before: joined(&self.before, &other.before) }
    }

    /// All amounts times `factor`.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        self.with(self, &|amount, _| amount * factor)
    }

    fn add_seconds(&mut self, seconds: f64) {
        for report in [&mut self.ordered, &mut self.before] {
            // The fixed time is waiting time: fetching or changing a pen.
            let pens = report.pens.iter_mut().flat_map(|pen| [&mut pen.seconds, &mut pen.waiting_seconds]).flatten();
            pens.for_each(|time| *time = (*time + seconds).max(0.0));
            report.total = total(&report.pens);
        }
    }
}

fn together(one: &PlotReport, other: &PlotReport, f: &impl Fn(f64, f64) -> f64) -> PlotReport {
    let twin = |pen: &PenReport| other.pens.iter().find(|other| other.pen == pen.pen && other.name == pen.name).cloned();
    let pens: Vec<PenReport> =
        one.pens.iter().map(|pen| pen_together(pen, &twin(pen).unwrap_or_else(|| pen.clone()), f)).collect();
    PlotReport { total: total(&pens), pens }
}

fn joined(one: &PlotReport, other: &PlotReport) -> PlotReport {
    let mut pens = one.pens.clone();
    for pen in &other.pens {
        match pens.iter_mut().find(|known| known.pen == pen.pen) {
            Some(known) => *known = pen_together(known, pen, &|a, b| a + b),
            None => pens.push(pen.clone()),
        }
    }
    PlotReport { total: total(&pens), pens }
}

fn pen_together(one: &PenReport, other: &PenReport, f: &impl Fn(f64, f64) -> f64) -> PenReport {
    let count = |one: usize, other: usize| f(one as f64, other as f64).round().max(0.0) as usize;
    let both = |one: Option<f64>, other: Option<f64>| one.zip(other).map(|(one, other)| f(one, other));
    PenReport {
        paths: count(one.paths, other.paths),
        pen_down_mm: f(one.pen_down_mm, other.pen_down_mm),
        pen_up_mm: f(one.pen_up_mm, other.pen_up_mm),
        pen_up_mm_before: f(one.pen_up_mm_before, other.pen_up_mm_before),
        pen_lifts: count(one.pen_lifts, other.pen_lifts),
        seconds: both(one.seconds, other.seconds),
        motion_seconds: both(one.motion_seconds, other.motion_seconds),
        waiting_seconds: both(one.waiting_seconds, other.waiting_seconds),
        ..one.clone()
    }
}

fn total(pens: &[PenReport]) -> PenReport {
    PenReport {
        name: "all".to_owned(),
        nib_mm: pens.first().map_or(0.0, |pen| pen.nib_mm),
        paths: pens.iter().map(|pen| pen.paths).sum(),
        pen_down_mm: pens.iter().map(|pen| pen.pen_down_mm).sum(),
        pen_up_mm: pens.iter().map(|pen| pen.pen_up_mm).sum(),
        pen_up_mm_before: pens.iter().map(|pen| pen.pen_up_mm_before).sum(),
        pen_lifts: pens.iter().map(|pen| pen.pen_lifts).sum(),
        seconds: pens.iter().map(|pen| pen.seconds).sum(),
        motion_seconds: pens.iter().map(|pen| pen.motion_seconds).sum(),
        waiting_seconds: pens.iter().map(|pen| pen.waiting_seconds).sum(),
        ..PenReport::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pen(number: u32, paths: usize, seconds: f64) -> PenReport {
        PenReport { pen: number, paths, seconds: Some(seconds), ..PenReport::default() }
    }

    fn report(pens: Vec<PenReport>) -> PlotAmounts {
        let report = PlotReport { total: total(&pens), pens };
        PlotAmounts { ordered: report.clone(), before: report }
    }

    #[test]
    fn plots_add_up_by_pen() {
        let both = report(vec![pen(1, 10, 5.0)]).and(&report(vec![pen(1, 2, 1.0), pen(2, 3, 4.0)]).scaled(2.0));
        let paths: Vec<(u32, usize)> = both.ordered.pens.iter().map(|pen| (pen.pen, pen.paths)).collect();
        assert_eq!((paths, both.ordered.total.paths, both.ordered.total.seconds), (vec![(1, 14), (2, 6)], 20, Some(15.0)));
    }

    #[test]
    fn what_is_fixed_does_not_grow() {
        let amounts = Amounts { layers: Vec::new(), plot: Some(report(vec![pen(1, 10, 15.0)])) };
        let scaled = amounts.scaled(4.0, 5.0);
        assert_eq!((scaled.plot_seconds(), scaled.plot.unwrap().ordered.total.paths), (45.0, 40));
    }
}
