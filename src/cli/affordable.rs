//! Limits on memory and line length, checked before the work begins.

use super::arguments::{PictureOptions, PlacingOptions};
use super::failure::Failure;
use super::messages::warning_line;
use super::task::Task;
use super::toolpaths::duration;
use crate::drawing::{Drawing, Layer, Mixing, Page};
use crate::geometry::Rect;
use crate::plot::{InkModel, Nibs};

/// Maximum memory of a drawing in bytes: what a machine with 8 GB can spare.
const MOST_BYTES: f64 = 4e9;
/// Maximum line in a plot, in millimetres: a week of drawing at 30 mm/s, and 3 GB of points at the finest tolerance.
const MOST_LINE: f64 = 20e6;
/// How many times the default pitch is taken without being asked for: beyond it the drawing is another one.
const MOST_COARSER: f64 = 1.5;
/// Bisection steps in the search for a pitch or size that fits.
const HALVINGS: usize = 30;

/// The task of a command line, if it does not take too much memory.
pub(super) fn task<'a>(
    options: &'a PictureOptions,
    placing: &PlacingOptions,
    reach: impl Fn(&Page) -> Option<Rect>,
) -> Result<Task<'a>, Failure> {
    let mut task = Task::placed(options, placing, &reach)?;
    // On a machine the layout depends on the pitch; the message then says which one fits.
    if reach(&task.layout.page).is_none() {
        coarsen(&mut task);
    }
    check(&task)?;
    Ok(task)
}

/// On a sheet that is a little too large for the default pitch, takes the pitch that fits.
fn coarsen(task: &mut Task<'_>) {
    let cost = task.cost(&task.manner.settings, task.layout.picture);
    let is_given = task.given().iter().any(|(key, _)| key == "pitch");
    let Some(usual) = task.manner.settings.pitch().filter(|_| cost.bytes > MOST_BYTES && !is_given) else { return };
    let Some(pitch) = pitch_that_fits(task).filter(|pitch| *pitch <= MOST_COARSER * usual) else { return };
    task.set_pitch(pitch);
    warning_line(&format!(
        "the pitch is {pitch:.2} mm instead of {usual:.2} mm, which would take {} of memory on this sheet; --pitch sets another",
        memory(cost.bytes)
    ));
}

/// Refuses a drawing that would take too much memory; the message names a pitch and a size that fit.
fn check(task: &Task<'_>) -> Result<(), Failure> {
    let cost = task.cost(&task.manner.settings, task.layout.picture);
    if cost.bytes <= MOST_BYTES {
        return Ok(());
    }
    let pitch = pitch_that_fits(task).map(|pitch| format!("--pitch {pitch:.2}mm"));
    let fits: Vec<String> = [pitch, size_that_fits(task)].into_iter().flatten().collect();
    let advice = if fits.is_empty() {
        "the photograph and its masks alone exceed that; scale them down first".to_owned()
    } else {
        format!("{} would fit", fits.join(", or "))
    };
    Err(Failure::Work(format!(
        "this drawing would take about {} of memory ({:.1} million working pixels) and {} of work, and drypoint takes at most {}: {advice}",
        memory(cost.bytes),
        cost.pixels / 1e6,
        duration(cost.seconds),
        memory(MOST_BYTES)
    )))
}

/// Refuses ink that would take more line than a plotter can draw, before any line is laid out: a drawing scaled by a thousand, or a
/// poster filled with the finest nib. `times` multiplies the drawing's line.
pub(super) fn check_line(drawing: &Drawing, nibs: &Nibs, model: InkModel, times: f64) -> Result<(), Failure> {
    if model == InkModel::Lines {
        return Ok(());
    }
    let whole = drawing.bounding_box().map_or(0.0, |bounds| bounds.area());
    let of = |layer: &Layer| {
        // Covered paint is not drawn.
        let ink = if layer.mixing == Mixing::Paint { layer.ink_mm2().min(whole) } else { layer.ink_mm2() };
        (ink / nibs.of(layer.pen), nibs.of(layer.pen))
    };
    let lines: Vec<(f64, f64)> = drawing.layers.iter().map(of).collect();
    let line = times * lines.iter().map(|(line, _)| line).sum::<f64>();
    if line <= MOST_LINE {
        return Ok(());
    }
    let nib = lines.iter().max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, nib)| *nib);
    Err(Failure::Work(format!(
        "this plot would take {:.0} km of line with a nib of {nib} mm, and drypoint lays down at most {:.0} km: use a wider --pen, or make the drawing smaller by {:.3}",
        line / 1e6,
        MOST_LINE / 1e6,
        (MOST_LINE / line).sqrt()
    )))
}

/// Formats a number of bytes, such as `2.3 GB` or `80 MB`.
pub(super) fn memory(bytes: f64) -> String {
    if bytes >= 9.5e8 { format!("{:.1} GB", bytes / 1e9) } else { format!("{:.0} MB", (bytes / 1e7).ceil() * 10.0) }
}

/// The smallest larger pitch that fits, in whole hundredths of a millimetre.
fn pitch_that_fits(task: &Task<'_>) -> Option<f64> {
    let fits = |pitch: f64| {
        let settings = task.settings_at(pitch);
        settings.is_some_and(|settings| task.cost(&settings, task.layout.picture).bytes <= MOST_BYTES)
    };
    let (mut low, mut high) = (task.manner.settings.pitch()?, task.largest_useful_pitch());
    if low >= high || !fits(high) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        (low, high) = if fits(middle) { (low, middle) } else { (middle, high) };
    }
    Some((high * 100.0).ceil() / 100.0)
}

/// The largest smaller picture that fits, in whole millimetres, as an option.
fn size_that_fits(task: &Task<'_>) -> Option<String> {
    let picture = task.layout.picture;
    let fits = |share: f64| {
        let smaller = Rect::from_origin_size(picture.origin(), picture.size() * share);
        task.cost(&task.manner.settings, smaller).bytes <= MOST_BYTES
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        (low, high) = if fits(middle) { (middle, high) } else { (low, middle) };
    }
    let (width, height) = ((picture.width() * low).floor(), (picture.height() * low).floor());
    (width >= 1.0 && height >= 1.0).then(|| format!("--size {width}x{height}mm"))
}
