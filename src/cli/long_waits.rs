//! Warnings before a long drawing or a long plot, with advice that makes it shorter.

use super::affordable::memory;
use super::arguments::DrawOptions;
use super::estimate::{Care, DrawingEstimate, Estimator, Plan};
use super::failure::Failure;
use super::messages::{say, warning};
use super::pens::PenSet;
use super::task::Task;
use super::toolpaths::{LONG_HOURS, duration};
use crate::elementary::Elementary as _;
use crate::geometry::Rect;
use crate::plot::Profile;

/// Plotting time that the advised pitch or size aims for, in seconds.
const USUAL_LIMIT: f64 = 2.0 * 3600.0;
/// Seconds of work below which drawing a picture is as quick as estimating it.
const AT_ONCE: f64 = 0.1;
/// Drawing time above which it is announced, in seconds.
const LONG_WORK: f64 = 60.0;

/// Announces a long drawing, and with a machine warns of a long plot. Returns true if it warned of the plot.
pub(super) fn warn_if_long(
    task: &Task<'_>,
    options: &DrawOptions,
    profile: Option<&Profile>,
    pens: &mut PenSet,
) -> Result<bool, Failure> {
    let cost = task.cost(&task.manner.settings, task.layout.picture);
    let tell = |wait: f64| {
        if wait > LONG_WORK && !options.reporting.quiet {
            say!("drypoint: the drawing takes about {} and {} of memory", duration(wait), memory(cost.bytes));
        }
    };
    let wait = cost.seconds / rayon::current_num_threads() as f64;
    if profile.is_none() {
        tell(wait);
        return Ok(false);
    }
    let mut teller = Estimator { task, options, profile, pens };
    let plan = Plan::of(task);
    if teller.side_within(&plan, AT_ONCE) >= 1.0 {
        return Ok(false);
    }
    match estimate_if_long(&mut teller, &plan, &tell) {
        Ok(Some(foretold)) => {
            warn(&mut teller, &foretold);
            Ok(true)
        }
        Err(Failure::Interrupted) => Err(Failure::Interrupted),
        // The drawing itself will report the error.
        Ok(None) | Err(_) => Ok(false),
    }
}

/// The estimate of a plot, if it takes long.
fn estimate_if_long(teller: &mut Estimator<'_>, plan: &Plan, tell: &dyn Fn(f64)) -> Result<Option<DrawingEstimate>, Failure> {
    let quick = teller.foretell(plan, Care::Quick)?;
    tell(quick.work_seconds);
    if quick.amounts.plot_seconds() < 0.7 * LONG_HOURS * 3600.0 {
        return Ok(None);
    }
    let careful = teller.foretell(plan, Care::Careful)?;
    Ok((careful.amounts.plot_seconds() > LONG_HOURS * 3600.0).then_some(careful))
}

/// Warns of a long plot, with advice.
pub(super) fn warn(teller: &mut Estimator<'_>, foretold: &DrawingEstimate) {
    let seconds = foretold.amounts.plot_seconds();
    if seconds > LONG_HOURS * 3600.0 {
        let advice = advice(teller, foretold);
        warning!("this plot will take about {}{advice}", duration(seconds));
    }
}

/// The pitch that takes two hours; if that pitch would be too coarse for the picture, the size.
fn advice(teller: &mut Estimator<'_>, foretold: &DrawingEstimate) -> String {
    let usual = format!("about {}", duration(USUAL_LIMIT));
    let shortened = Shortened { times: foretold.amounts.plot_seconds() / USUAL_LIMIT, quick: foretold.quick_seconds };
    if let Some(pitch) = shortened.pitch(teller) {
        return format!("; --pitch {pitch:.2}mm would take {usual}, and --max-time 2h chooses it");
    }
    match shortened.size(teller) {
        Some(size) => format!("; {size} would take {usual}"),
        None => "; a smaller --size on the same --page makes it shorter".to_owned(),
    }
}

/// The size, on the same sheet, whose plot takes `limit` seconds, as options.
pub(super) fn smaller_size(teller: &mut Estimator<'_>, seconds: f64, limit: f64) -> Option<String> {
    let quick = quick(teller, &Plan::of(teller.task))?;
    Shortened { times: seconds / limit, quick }.size(teller)
}

/// A plot to be shortened. Quick estimates are only compared with each other.
struct Shortened {
    /// Its time divided by the time wanted.
    times: f64,
    /// Its quick estimate in seconds.
    quick: f64,
}

impl Shortened {
    /// The pitch that reaches the time wanted, unless it is too coarse for the picture.
    fn pitch(&self, teller: &mut Estimator<'_>) -> Option<f64> {
        let (pitch, most) = (teller.task.manner.settings.pitch()?, teller.task.largest_useful_pitch());
        let guess = pitch * self.times.sqrt();
        if guess > most {
            return None;
        }
        let plan = Plan { settings: teller.task.settings_at(guess)?, picture: teller.task.layout.picture };
        let power = (self.quick / quick(teller, &plan)?).logarithm() / (guess / pitch).logarithm();
        let wanted = (pitch * self.times.power(1.0 / power) * 100.0).ceil() / 100.0;
        (power > 0.2 && wanted <= most).then_some(wanted)
    }

    /// The size that reaches the time wanted, on the same sheet.
    fn size(&self, teller: &mut Estimator<'_>) -> Option<String> {
        let picture = teller.task.layout.picture;
        let guess = 1.0 / self.times.sqrt();
        let smaller = Rect::from_center_size(picture.center(), picture.size() * guess);
        let pitch = finer_pitch(teller.task, smaller.width().min(smaller.height()));
        let settings = pitch.map_or_else(|| Some(teller.task.manner.settings.clone()), |pitch| teller.task.settings_at(pitch))?;
        let after = quick(teller, &Plan { settings, picture: smaller })?;
        // Small pictures take more time per area.
        let side = guess * (self.quick / after / self.times).sqrt().min(1.0);
        let (width, height) = ((picture.width() * side).floor(), (picture.height() * side).floor());
        let pitch =
            finer_pitch(teller.task, width.min(height)).map_or_else(String::new, |pitch| format!(" --pitch {pitch:.2}mm"));
        let page = teller.options.picture.page.clone().unwrap_or_else(|| {
            let (width, height) = teller.task.layout.sheet();
            format!("{}x{}mm", round(width), round(height))
        });
        (width.min(height) >= 1.0).then(|| format!("--size {width}x{height}mm{pitch} --page {page}"))
    }
}

/// The pitch for a picture with this short side, if its own pitch is too coarse for it.
fn finer_pitch(task: &Task<'_>, short: f64) -> Option<f64> {
    let share = short / task.smallest_useful_side();
    (share < 1.0).then(|| Some((task.manner.settings.pitch()? * share * 100.0).floor() / 100.0)).flatten()
}

fn quick(teller: &mut Estimator<'_>, plan: &Plan) -> Option<f64> {
    teller.foretell(plan, Care::Quick).ok().map(|foretold| foretold.amounts.plot_seconds()).filter(|seconds| *seconds > 0.0)
}

fn round(mm: f64) -> f64 {
    (mm * 100.0).round() / 100.0
}
