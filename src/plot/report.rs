//! Lengths, times and coverage of a plot, per pen and in total.

use super::coverage::Coverage;
use super::profile::Profile;
use super::time::clock;
use super::{Mounting, Plot};
use crate::geometry::Point;
use crate::interrupt::{Interrupt, Interrupted};
use crate::order::{PathEnds, Visit, pen_up_length};
use serde::Serialize;

/// The report of one pen.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PenReport {
    /// The pen's number.
    pub pen: u32,
    /// What it draws.
    pub name: String,
    /// The nib's width in millimetres.
    pub nib_mm: f64,
    /// Pen-down paths.
    pub paths: usize,
    /// Millimetres drawn.
    pub pen_down_mm: f64,
    /// Millimetres travelled with the pen up, from the last pen's end or home.
    pub pen_up_mm: f64,
    /// Pen-up travel before ordering, in millimetres.
    pub pen_up_mm_before: f64,
    /// How often the pen is lifted.
    pub pen_lifts: usize,
    /// Time in seconds, if the machine is known.
    pub seconds: Option<f64>,
    /// Time in seconds during which an axis moves.
    pub motion_seconds: Option<f64>,
    /// Time in seconds during which no axis moves: a servo or a solenoid lifts or lowers the pen, a pen is fetched, or the file
    /// waits.
    pub waiting_seconds: Option<f64>,
    /// Share of the drawing's ink that is laid down, if coverage was measured.
    pub covered_fraction: Option<f64>,
    /// Ink laid down outside the drawing's ink, as a share of the latter.
    pub spill_fraction: Option<f64>,
}

/// The report of all pens.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PlotReport {
    /// One report per pen.
    pub pens: Vec<PenReport>,
    /// The total; its name is `all`.
    pub total: PenReport,
}

/// Measures a plot that starts at `home` on the page. With a machine and its mounting, also the time. `before` is the pen-up
/// travel of each pen before ordering, if known.
pub fn report(
    plot: &Plot,
    home: Point,
    machine: Option<(&Profile, &Mounting)>,
    before: Option<&[f64]>,
    interrupt: &Interrupt,
) -> Result<PlotReport, Interrupted> {
    let clocks = machine.map(|(profile, mounting)| clock(plot, profile, mounting, interrupt)).transpose()?;
    let mut at = home;
    let mut pens = Vec::new();
    for (i, pen) in plot.pens.iter().enumerate() {
        let ends: Vec<PathEnds> = pen.paths.iter().map(super::Toolpath::ends).collect();
        let visits: Vec<Visit> = (0..ends.len()).map(|path| Visit { path, reversed: false }).collect();
        let pen_up_mm = pen_up_length(&ends, &visits, at);
        at = ends.last().map_or(at, |last| last.end);
        pens.push(PenReport {
            pen: pen.number,
            name: pen.name.clone(),
            nib_mm: pen.nib,
            paths: pen.paths.len(),
            pen_down_mm: pen.paths.iter().map(super::Toolpath::length).sum(),
            pen_up_mm,
            pen_up_mm_before: before.and_then(|b| b.get(i).copied()).unwrap_or(pen_up_mm),
            pen_lifts: pen.paths.len(),
            seconds: clocks.as_ref().map(|c| c[i].total()),
            motion_seconds: clocks.as_ref().map(|c| c[i].motion()),
            waiting_seconds: clocks.as_ref().map(|c| c[i].waiting),
            covered_fraction: None,
            spill_fraction: None,
        });
    }
    let total = PenReport {
        pen: 0,
        name: "all".to_owned(),
        nib_mm: pens.first().map_or(0.0, |p| p.nib_mm),
        paths: pens.iter().map(|p| p.paths).sum(),
        pen_down_mm: pens.iter().map(|p| p.pen_down_mm).sum(),
        pen_up_mm: pens.iter().map(|p| p.pen_up_mm).sum(),
        pen_up_mm_before: pens.iter().map(|p| p.pen_up_mm_before).sum(),
        pen_lifts: pens.iter().map(|p| p.pen_lifts).sum(),
        seconds: machine.map(|_| pens.iter().filter_map(|p| p.seconds).sum()),
        motion_seconds: machine.map(|_| pens.iter().filter_map(|p| p.motion_seconds).sum()),
        waiting_seconds: machine.map(|_| pens.iter().filter_map(|p| p.waiting_seconds).sum()),
        covered_fraction: None,
        spill_fraction: None,
    };
    Ok(PlotReport { pens, total })
}

impl PlotReport {
    /// Adds the measured coverage of each pen, in the pens' order.
    pub fn add_coverage(&mut self, measured: &[Coverage]) {
        let mut total = Coverage::default();
        let mut counted = Vec::new();
        for (pen, coverage) in self.pens.iter_mut().zip(measured) {
            pen.covered_fraction = Some(coverage.covered_fraction());
            pen.spill_fraction = Some(coverage.spill_fraction());
            // Pens of one number share their ink.
            if !counted.contains(&pen.pen) {
                counted.push(pen.pen);
                total = total.and(*coverage);
            }
        }
        self.total.covered_fraction = Some(total.covered_fraction());
        self.total.spill_fraction = Some(total.spill_fraction());
    }
}
