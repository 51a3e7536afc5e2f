//! Estimates a drawing and its plot before it is drawn. The whole photograph is drawn at the same pitch at two smaller sizes, and
//! the amounts for the full size are extrapolated from how the amounts per area change with the side.
//!
//! ```text
//!   amount per mm2
//!     |o                     a small picture has more outlines and line ends per area; the excess falls about with the root
//!     |   `o                 of the side
//!     |        ` - - - - x
//!     +------------------+- side
//! ```

use super::amounts::{Amounts, PlotAmounts};
use super::arguments::{DrawOptions, Order, ToolpathOptions};
use super::failure::Failure;
use super::inking::{inked, uncovered};
use super::interruption::{interrupt, is_interrupted};
use super::job;
use super::pens::PenSet;
use super::task::{Task, UNKNOWN_PITCH};
use crate::drawing::{Drawing, Mixing, Painted};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect};
use crate::plot::{InkModel, PenPaths, Plot, Profile, Toolpath, lower, mount};
use crate::source::MaskRole;
use crate::source::Placement;
use crate::style::{Observer, Picture, Settings, Silent};
use std::time::{Duration, Instant};

/// Seconds of work for the smaller and for the larger picture; with both, their plots and a third for advice, an estimate takes a
/// second and a half. With 0.15 the astronaut's hair is too small in the larger one to be drawn in strokes, and half as many marks again
/// are told as are drawn; with 0.26 the estimate is no better.
const QUICK_SECONDS: f64 = 0.06;
const CAREFUL_SECONDS: f64 = 0.2;
/// Maximum number of marks plotted in the smaller and in the larger picture. The limits for paint are lower: cutting a stroke by the
/// paint over it takes nearly a millisecond.
const MARKS: [f64; 2] = [2000.0, 8000.0];
const PAINT: [f64; 2] = [100.0, 350.0];
/// Minimum short side of a picture drawn for an estimate, in pitches; with less, no face is left.
const LEAST_PITCHES: f64 = 12.0;
/// Time limit for the larger picture. Only reached on a machine that is busy or much slower than the cost tables assume.
const PATIENCE: Duration = Duration::from_secs(5);
/// Seconds per path for measuring the ink, and for the full search for short travel: together 75 to 160 microseconds on the
/// astronaut in four styles.
const MEASURING: f64 = 5e-5;
const FULL_ORDER: f64 = 8e-5;

/// What to estimate.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub settings: Settings,
    pub picture: Rect,
}

impl Plan {
    pub(super) fn of(task: &Task<'_>) -> Self {
        Self { settings: task.manner.settings.clone(), picture: task.layout.picture }
    }
}

/// Accuracy of an estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Care {
    /// From one small picture: enough to compare two plans.
    Quick,
    /// From two pictures: as accurate as possible.
    Careful,
}

/// An estimate.
pub(super) struct DrawingEstimate {
    pub amounts: Amounts,
    /// Seconds until the file is written, on this machine.
    pub work_seconds: f64,
    /// Fraction of the picture's area drawn for the estimate; with 1 the amounts are exact.
    pub share: f64,
    /// The picture drawn for the estimate.
    pub drawing: Drawing,
    /// Seconds of the plot as a quick estimate has them.
    pub quick_seconds: f64,
}

/// A smaller picture of the photograph.
struct Sample {
    /// Its side as a fraction of the full side.
    side: f64,
    drawing: Drawing,
    painting: Vec<Painted>,
    seconds: f64,
}

/// Makes estimates.
pub(super) struct Estimator<'a> {
    pub task: &'a Task<'a>,
    pub options: &'a DrawOptions,
    pub profile: Option<&'a Profile>,
    pub pens: &'a mut PenSet,
}

impl Estimator<'_> {
    pub(super) fn foretell(&mut self, plan: &Plan, care: Care) -> Result<DrawingEstimate, Failure> {
        let begun = Instant::now();
        let mut sample = self.sample(plan, self.side_within(plan, QUICK_SECONDS), None)?;
        let is_paint = self.profile.is_some() && sample.drawing.layers.iter().any(|layer| layer.mixing == Mixing::Paint);
        let [few, many] = if is_paint { PAINT } else { MARKS };
        // The side at which a picture has this many marks.
        let (side, marks) = (sample.side, sample.drawing.marks().count().max(1) as f64);
        let room = |most: f64| if self.profile.is_some() { side * (most / marks).sqrt() } else { 1.0 };
        let larger = room(many).min(self.side_within(plan, CAREFUL_SECONDS));
        if room(few) < 0.95 * side {
            sample = self.sample(plan, room(few), None)?;
        }
        let first = self.told(plan, &sample)?;
        if care == Care::Quick || larger < 1.2 * sample.side {
            return Ok(first);
        }
        let sample = match self.sample(plan, larger, Some(begun + PATIENCE)) {
            Err(Failure::Interrupted) if !is_interrupted() => return Ok(first),
            drawn => drawn?,
        };
        let second = self.told(plan, &sample)?;
        Ok(DrawingEstimate { amounts: extrapolated(&first, &second), quick_seconds: first.quick_seconds, ..second })
    }

    /// The largest side, as a fraction of the picture's, that takes at most `seconds` of work.
    pub(super) fn side_within(&self, plan: &Plan, seconds: f64) -> f64 {
        let work = |side: f64| self.cost(plan, side);
        if work(1.0) <= 1.5 * seconds {
            return 1.0;
        }
        let short = plan.picture.width().min(plan.picture.height());
        let (mut low, mut high) = ((LEAST_PITCHES * plan.settings.pitch().unwrap_or(UNKNOWN_PITCH) / short).min(1.0), 1.0);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            (low, high) = if work(middle) <= seconds { (middle, high) } else { (low, middle) };
        }
        low
    }

    /// Seconds of work for a picture with this fraction of the side, at the full picture's resolution.
    fn cost(&self, plan: &Plan, side: f64) -> f64 {
        let resolution = self.task.resolution(&plan.settings, plan.picture);
        self.task.manner.style.cost(&plan.settings, smaller(plan.picture, side), resolution).seconds
    }

    fn sample(&mut self, plan: &Plan, side: f64, until: Option<Instant>) -> Result<Sample, Failure> {
        let begun = Instant::now();
        let resolution = self.task.resolution(&plan.settings, plan.picture);
        let placement = Placement::new(smaller(plan.picture, side), resolution);
        let drawing = self.task.draw_in(&plan.settings, placement, &Unseen { until })?;
        let mut drawing = inked(drawing, self.task, self.options, &Silent)?;
        let painting = self.pens.assign_pens(&mut drawing, self.profile)?.painting;
        Ok(Sample { side, drawing, painting, seconds: begun.elapsed().as_secs_f64() })
    }

    /// The full picture's amounts, scaled from a sample by area.
    fn told(&self, plan: &Plan, sample: &Sample) -> Result<DrawingEstimate, Failure> {
        let begun = Instant::now();
        let times = 1.0 / (sample.side * sample.side);
        let plot = self.profile.map(|profile| plotted(sample, profile, &self.options.toolpaths, self.pens)).transpose()?;
        let plotting = begun.elapsed().as_secs_f64() * times;
        let fixed = self.profile.map_or(0.0, |profile| profile.pens.change_seconds);
        let each = MEASURING + if self.options.toolpaths.order == Order::Full { FULL_ORDER } else { 0.0 };
        let amounts = Amounts::of(&sample.drawing, plot).scaled(times, fixed);
        let paths = amounts.plot.as_ref().map_or(0.0, |plot| plot.ordered.total.paths as f64);
        let drawing = sample.seconds * self.cost(plan, 1.0) / self.cost(plan, sample.side);
        Ok(DrawingEstimate {
            quick_seconds: amounts.plot_seconds(),
            amounts,
            work_seconds: drawing + plotting + each * paths,
            share: 1.0 / times,
            drawing: sample.drawing.clone(),
        })
    }
}

/// The picture scaled about its centre.
fn smaller(picture: Rect, side: f64) -> Rect {
    Rect::from_center_size(picture.center(), picture.size() * side)
}

/// The plot of a sample, ordered fast. Parts beyond the machine's reach are clipped.
fn plotted(sample: &Sample, profile: &Profile, options: &ToolpathOptions, pens: &PenSet) -> Result<PlotAmounts, Failure> {
    let plot =
        lower(&*uncovered(&sample.drawing, &sample.painting)?, InkModel::Ink, pens.nibs(), options.tolerance, interrupt())?;
    let job = job::of_paths(plot, Some(profile), &quickly(options), pens)?;
    Ok(PlotAmounts { ordered: job.report().clone(), before: job.unordered().clone() })
}

/// The same options with a fast order, clipping what does not fit.
pub(super) fn quickly(options: &ToolpathOptions) -> ToolpathOptions {
    let order = if options.order == Order::Full { Order::Fast } else { options.order };
    ToolpathOptions { order, clip: true, ..options.clone() }
}

/// Extrapolates the amounts linearly over the inverse root of the side.
fn extrapolated(small: &DrawingEstimate, large: &DrawingEstimate) -> Amounts {
    let over_root = |share: f64| share.power(-0.25);
    let (near, far) = (over_root(large.share), over_root(small.share));
    let reach = (near - 1.0) / (far - near);
    let bounded = |amount: f64, before: f64| (amount - (before - amount) * reach).clamp(0.5 * amount, 1.5 * amount);
    large.amounts.with(&small.amounts, &bounded)
}

impl DrawingEstimate {
    /// Refuses what the drawing itself would be refused for: pens that cannot be assigned, a picture beyond the machine's reach.
    pub(super) fn check(&self, teller: &mut Estimator<'_>) -> Result<(), Failure> {
        teller.pens.assign(&mut self.drawing.clone(), teller.profile)?;
        let Some((profile, drawn)) = teller.profile.zip(self.drawing.bounding_box()) else { return Ok(()) };
        if teller.options.toolpaths.clip {
            return Ok(());
        }
        let (page, picture) = (self.drawing.page, teller.task.layout.placed());
        let place = |p: Point| picture.center() + (p - picture.center()) / self.share.sqrt();
        let nib = teller.pens.nibs().usual;
        let whole =
            Rect::from_points(place(drawn.origin()), place(Point::new(drawn.x1, drawn.y1))).intersect(picture).inset(-0.5 * nib);
        let pen = PenPaths {
            number: 1,
            name: String::new(),
            colour: crate::drawing::Colour::BLACK,
            nib,
            handling: crate::drawing::Handling::default(),
            paths: vec![Toolpath::through(whole.origin(), [Point::new(whole.x1, whole.y1)])],
        };
        Ok(mount(profile, &page)?.check(profile, &Plot { page, pens: vec![pen] })?)
    }
}

/// Observes a sample: shows nothing, stops on an interrupt or at a deadline.
struct Unseen {
    until: Option<Instant>,
}

impl Observer for Unseen {
    fn begin(&self, _: &str) {}
    fn progress(&self, _: f64) {}
    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}
    fn warn(&self, _: &str) {}
    fn want_mask(&self, _: MaskRole, _: &str) {}
    fn is_interrupted(&self) -> bool {
        is_interrupted() || self.until.is_some_and(|until| Instant::now() > until)
    }
}
