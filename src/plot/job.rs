//! The plotting job: what one machine draws, ordered, placed on the machine, checked and timed.
//!
//! ```text
//!   drawing --lower--> tool paths --clip, order, rest, dry--> checked against the machine --> timed, and its ink counted --> Job
//! ```
//!
//! A [`Job`] exists only if these checks passed, and only a job is written for a machine.

use super::extras::{add_registration, add_touch_rests, pause_every};
use super::language::{Orders, write_picture};
use super::preview::{ShownTravel, write_preview};
use super::{
    InkModel, Mounting, MountingError, Nibs, PenChange, Plot, PlotReport, Profile, Sequence, clip_to, coverage, delay_for_drying,
    lower, mount, report,
};
use crate::drawing::Drawing;
use crate::geometry::{Point, Rect};
use crate::interrupt::{Interrupt, Interrupted};
use crate::write::SvgHead;
use std::collections::BTreeMap;
use std::fmt;
use std::io;
use thiserror::Error;

/// Settings of a job besides its drawing and its machine.
#[derive(Clone, Debug, PartialEq)]
pub struct JobOptions {
    /// How the paths are ordered.
    pub sequence: Sequence,
    /// Maximum deviation of flattened curves and fitted arcs from the originals, in millimetres.
    pub tolerance: f64,
    /// How to treat paths that the machine does not reach.
    pub beyond: ReachPolicy,
    /// Marks drawn or traced in addition.
    pub marks: PlacingMarks,
    /// The machine waits for a new pen each time this many millimetres of line are drawn.
    pub pause_every: Option<f64>,
    /// Minimum drying time in seconds before ink may be crossed.
    pub dry_seconds: Option<f64>,
    /// Rest of a touch in seconds by pen number, where it differs from the machine's usual.
    pub dwell: BTreeMap<u32, f64>,
}

impl Default for JobOptions {
    fn default() -> Self {
        Self {
            sequence: Sequence::default(),
            tolerance: 0.02,
            beyond: ReachPolicy::default(),
            marks: PlacingMarks::default(),
            pause_every: None,
            dry_seconds: None,
            dwell: BTreeMap::new(),
        }
    }
}

/// How to treat paths that the machine does not reach or that leave the page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ReachPolicy {
    /// Refuse the job.
    #[default]
    Refuse,
    /// Cut them at the border and count what is lost.
    Clip,
}

/// Marks that help to align paper and pens.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct PlacingMarks {
    /// Trace the drawing's bounding box with the pen up before the first pen draws, then wait.
    pub has_frame: bool,
    /// Draw crosses at the corners with each pen.
    pub has_registration: bool,
}

/// A feature that needs a machine, or a machine that can wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MachineFeature {
    /// Tracing the frame before the first pen draws.
    Frame,
    /// Waiting each time a given length of line is drawn.
    PauseEvery,
    /// Letting ink dry.
    Drying,
    /// Changing the pen, or a layer that requests a pause.
    PenChange,
}

impl fmt::Display for MachineFeature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Frame => "tracing the frame",
            Self::PauseEvery => "pausing after a length of line",
            Self::Drying => "letting ink dry",
            Self::PenChange => "a change of pen",
        })
    }
}

/// Why there is no job.
#[derive(Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum JobError {
    /// The page or the drawing does not fit on the machine.
    #[error(transparent)]
    Misfit(#[from] MountingError),
    /// The feature needs a machine, and none was given.
    #[error("{0} needs a machine; choose a plotter profile")]
    NoMachine(MachineFeature),
    /// The feature needs a pause, and the machine has no command for one.
    #[error("{wish} needs a pause, and {machine} has no pause command")]
    NoPause {
        /// The feature.
        wish: MachineFeature,
        /// The profile's name.
        machine: String,
    },
    /// A layer requests a pause or a delay, which the machine's language does not have.
    #[error("layer '{layer}' asks for a pause or a delay, and {language} has no command for either")]
    NoHandling {
        /// The layer's name.
        layer: String,
        /// The language.
        language: &'static str,
    },
    /// A layer needs a pen that the machine does not hold.
    #[error("layer '{layer}' needs pen {pen}, but {machine} holds only {holds}")]
    NoSuchPen {
        /// The layer's name.
        layer: String,
        /// The pen's number.
        pen: u32,
        /// The profile's name.
        machine: String,
        /// How many pens the machine holds.
        holds: u32,
    },
    /// The machine's own program traces frames.
    #[error("{machine} is driven by its own program, which traces the frame")]
    OwnFrame {
        /// The profile's name.
        machine: String,
    },
    /// Ink has to dry, and the machine's language has no wait command.
    #[error("drying takes {seconds:.0} s of waiting in total, and the machine's language has no wait command")]
    NoWait {
        /// Total waiting time in seconds.
        seconds: f64,
    },
    /// The work was stopped.
    #[error("interrupted")]
    Interrupted,
}

impl From<Interrupted> for JobError {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

/// A checked job.
#[derive(Clone, Debug)]
pub struct Job<'a> {
    plot: Plot,
    machine: Option<(&'a Profile, Mounting)>,
    report: PlotReport,
    unordered: PlotReport,
    cut: Cut,
    home: Point,
    duplicates: usize,
}

/// What clipping removed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cut {
    /// Length of line in millimetres.
    pub length: f64,
    /// Number of touches.
    pub touches: usize,
}

impl<'a> Job<'a> {
    /// Builds the job of a drawing: lowers it to tool paths, then continues as [`Job::of_paths`]. `begin` is called with each
    /// step's name as it begins: `lowering`, `ordering`, `coverage`. For opaque paint, hidden parts must have been removed
    /// ([`occluded`](super::occluded)).
    ///
    /// ```
    /// use drypoint::drawing::{Dot, Drawing, Layer, Mark, Page};
    /// use drypoint::geometry::Point;
    /// use drypoint::interrupt::Interrupt;
    /// use drypoint::plot::{InkModel, Job, JobOptions, Nibs, Profile};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut layer = Layer::new("dots", 1);
    /// layer.marks.push(Mark::Dot(Dot::circle(Point::new(20.0, 20.0), 1.5)));
    /// let drawing = Drawing { page: Page::new(40.0, 40.0), layers: vec![layer] };
    /// let machine = Profile::built_in("grbl-servo")?;
    /// let options = JobOptions::default();
    /// let job =
    ///     Job::of_drawing(&drawing, InkModel::Ink, &Nibs::all(0.3), Some(&machine), &options, &|_| {}, &Interrupt::never())?;
    /// assert!(job.report().total.seconds.is_some_and(|seconds| seconds > 1.0));
    /// # Ok(())
    /// # }
    /// ```
    pub fn of_drawing(
        drawing: &Drawing,
        model: InkModel,
        nibs: &Nibs,
        machine: Option<&'a Profile>,
        options: &JobOptions,
        begin: &dyn Fn(&str),
        interrupt: &Interrupt,
    ) -> Result<Self, JobError> {
        begin("lowering");
        let plot = lower(drawing, model, nibs, options.tolerance, interrupt)?;
        begin("ordering");
        let mut job = Self::of_paths(plot, machine, options, interrupt)?;
        if model == InkModel::Ink {
            begin("coverage");
            job.report.add_coverage(&coverage(drawing, &job.plot, nibs, interrupt)?);
        }
        Ok(job)
    }

    /// Builds the job of tool paths: clips them, places them on the machine, checks and orders them, and adds rests, pauses and
    /// times.
    pub fn of_paths(
        mut plot: Plot,
        machine: Option<&'a Profile>,
        options: &JobOptions,
        interrupt: &Interrupt,
    ) -> Result<Self, JobError> {
        without_machine(machine, options)?;
        plot.pens.retain(|pen| !pen.paths.is_empty());
        let mut machine = machine.map(|profile| Ok::<_, JobError>((profile, mount(profile, &plot.page)?))).transpose()?;
        let drawable = machine.as_ref().map_or(plot.page.rect(), |(_, mounting)| mounting.drawable(&plot.page));
        let mut cut = Cut::default();
        if options.beyond == ReachPolicy::Clip {
            (cut.length, cut.touches) = clip_to(&mut plot, drawable);
            plot.pens.retain(|pen| !pen.paths.is_empty());
        }
        if let Some((profile, mounting)) = &mut machine {
            mounting.tolerance = options.tolerance;
            mounting.frame = if options.marks.has_frame { bounds_of(&plot) } else { None };
            check_pens(&plot, profile, options)?;
            mounting.check(profile, &plot)?;
        }
        let home = home_of(machine.as_ref().map(|(_, mounting)| mounting), &plot);
        let timed = machine.as_ref().map(|(profile, mounting)| (*profile, mounting));
        let unordered = report(&plot, home, timed, None, interrupt)?;
        let before: Vec<f64> = unordered.pens.iter().map(|pen| pen.pen_up_mm).collect();
        let duplicates = plot.put_in_order(home, &options.sequence, interrupt)?;
        if options.marks.has_registration {
            add_registration(&mut plot, drawable);
        }
        rest_and_dry(&mut plot, timed.map(|(profile, _)| profile), options, home, interrupt)?;
        let report = report(&plot, home, timed, Some(&before), interrupt)?;
        if let Some(length) = options.pause_every {
            pause_every(&mut plot, length);
        }
        Ok(Self { plot, machine, report, unordered, cut, home, duplicates })
    }

    /// Writes it in its machine's language or, without a machine, its tool paths as SVG. `head` stands in SVG only.
    pub fn write(&self, head: &SvgHead, mut out: impl io::Write) -> io::Result<()> {
        let Some((profile, mounting)) = &self.machine else { return write_picture(&self.plot, head, &mut out) };
        profile.speech().write(&Orders { plot: &self.plot, profile, mounting, head }, &mut out)
    }

    /// Writes its tool paths as SVG, lines as wide as each pen's nib, whatever its machine reads.
    pub fn write_picture(&self, head: &SvgHead, mut out: impl io::Write) -> io::Result<()> {
        write_picture(&self.plot, head, &mut out)
    }

    /// Writes what the machine will do as an SVG to look at: sheet, reach, ink, start, park and the ways of the raised pen.
    pub fn write_preview(&self, travel: ShownTravel, mut out: impl io::Write) -> io::Result<()> {
        let start = self.mounting().map_or(self.home, |mounting| mounting.to_machine.inverse() * Point::ORIGIN);
        write_preview(&self.plot, self.mounting(), start, travel, &mut out)
    }

    /// Its tool paths in drawing order.
    pub const fn plot(&self) -> &Plot {
        &self.plot
    }

    /// The job's machine.
    pub fn machine(&self) -> Option<&'a Profile> {
        self.machine.as_ref().map(|(profile, _)| *profile)
    }

    /// Where the page lies on the machine.
    pub fn mounting(&self) -> Option<&Mounting> {
        self.machine.as_ref().map(|(_, mounting)| mounting)
    }

    /// Lengths and times of the job as drawn.
    pub const fn report(&self) -> &PlotReport {
        &self.report
    }

    /// Lengths and times before ordering.
    pub const fn unordered(&self) -> &PlotReport {
        &self.unordered
    }

    /// What clipping removed.
    pub const fn cut(&self) -> Cut {
        self.cut
    }

    /// Where the pen starts, in millimetres on the page: machine zero, else the page's upper left corner.
    pub const fn home(&self) -> Point {
        self.home
    }

    /// Number of repeated paths that were dropped.
    pub const fn duplicates(&self) -> usize {
        self.duplicates
    }
}

/// Refuses features that need a machine when there is none.
fn without_machine(machine: Option<&Profile>, options: &JobOptions) -> Result<(), JobError> {
    let wishes = [
        (options.marks.has_frame, MachineFeature::Frame),
        (options.pause_every.is_some(), MachineFeature::PauseEvery),
        (options.dry_seconds.is_some(), MachineFeature::Drying),
    ];
    match wishes.into_iter().find(|(is_asked, _)| *is_asked && machine.is_none()) {
        Some((_, wish)) => Err(JobError::NoMachine(wish)),
        None => Ok(()),
    }
}

/// Adds the rests of touches and the waits for ink to dry before it is crossed.
fn rest_and_dry(
    plot: &mut Plot,
    machine: Option<&Profile>,
    options: &JobOptions,
    home: Point,
    interrupt: &Interrupt,
) -> Result<(), JobError> {
    let usual = machine.map_or(0.0, |profile| profile.motion.touch_seconds);
    add_touch_rests(plot, |pen| options.dwell.get(&pen).copied().unwrap_or(usual));
    let (Some(seconds), Some(profile)) = (options.dry_seconds, machine) else { return Ok(()) };
    let waited = delay_for_drying(plot, seconds, home, &profile.motion, interrupt)?;
    if waited > 0.0 && !profile.speech().can_dwell() {
        return Err(JobError::NoWait { seconds: waited });
    }
    Ok(())
}

fn bounds_of(plot: &Plot) -> Option<Rect> {
    let points = plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(super::Toolpath::points);
    points.map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b))
}

/// Where the pen starts, in millimetres on the page: machine zero clamped to the page; without a machine, the page's upper left
/// corner.
pub fn home_of(mounting: Option<&Mounting>, plot: &Plot) -> Point {
    let zero = mounting.map_or(Point::ORIGIN, |m| m.to_machine.inverse() * Point::ORIGIN);
    Point::new(zero.x.clamp(0.0, plot.page.width), zero.y.clamp(0.0, plot.page.height))
}

/// Checks that the machine holds every pen or can wait for a change, and that it can wait wherever the job needs it to.
fn check_pens(plot: &Plot, profile: &Profile, options: &JobOptions) -> Result<(), JobError> {
    let machine = || profile.name.clone();
    if !profile.speech().has_layer_handling()
        && let Some(pen) = plot.pens.iter().find(|pen| pen.handling.pauses || pen.handling.delay_seconds > 0.0)
    {
        return Err(JobError::NoHandling { layer: pen.name.clone(), language: profile.language().title() });
    }
    if let Some(pen) = plot.pens.iter().find(|pen| pen.number > profile.pens.count)
        && profile.pens.change == PenChange::Machine
    {
        let (layer, holds) = (pen.name.clone(), profile.pens.count);
        return Err(JobError::NoSuchPen { layer, pen: pen.number, machine: machine(), holds });
    }
    if options.marks.has_frame && !profile.speech().traces_frame() {
        return Err(JobError::OwnFrame { machine: machine() });
    }
    if profile.speech().can_pause() {
        return Ok(());
    }
    let changes = plot.pens.windows(2).any(|pair| pair[0].number != pair[1].number);
    let asks_for_pen = plot.pens.iter().any(|pen| pen.handling.pauses) || (changes && profile.pens.change == PenChange::Pause);
    let wishes = [
        (options.marks.has_frame, MachineFeature::Frame),
        (options.pause_every.is_some(), MachineFeature::PauseEvery),
        (asks_for_pen, MachineFeature::PenChange),
    ];
    match wishes.into_iter().find(|(is_asked, _)| *is_asked) {
        Some((_, wish)) => Err(JobError::NoPause { wish, machine: machine() }),
        None => Ok(()),
    }
}
