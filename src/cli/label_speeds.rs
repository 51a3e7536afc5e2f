//! `+S` in a layer's label is a percentage of one machine's maximum speed; for another machine it is converted to the same speed.

use super::messages::warning;
use crate::plot::Profile;
use crate::read::{Imported, LabelSpeeds};

/// Maximum percentage in a label that is relative to the machine's drawing speed.
const MOST_PERCENT: f64 = 200.0;

/// Converts the speeds in a drawing's layer labels to a machine.
///
/// A file that drypoint wrote for a plotter names that plotter: a layer at its usual speed gets this machine's usual speed, and a layer
/// with its own speed keeps it in mm/s. In other files, a plotter whose own program reads labels interprets them as that program
/// does; for all other plotters the label is a percentage of the drawing speed.
pub(super) fn fit_to_machine(imported: &mut Imported, profile: &Profile) {
    let written = imported.speeds.clone();
    for layer in &mut imported.layers {
        let Some(percent) = layer.layer.handling.speed_percent else { continue };
        let asked = match (&written, profile.speed_of_percent()) {
            (Some(speeds), _) if is_usual(speeds, percent, profile) => {
                layer.layer.handling.speed_percent = None;
                continue;
            }
            (Some(speeds), _) => percent * speeds.percent_mm_s,
            (None, Some(speed)) => percent * speed,
            (None, None) => profile.motion.draw_speed * percent.clamp(1.0, MOST_PERCENT) / 100.0,
        };
        let fastest = profile.motion.fastest_drawing();
        if asked > fastest {
            let (layer, name) = (&layer.layer.name, &profile.name);
            warning!("layer '{layer}' asks for {asked:.0} mm/s with its +S; {name} draws it at {fastest:.0}, its maximum");
        }
        layer.layer.handling.speed_percent = Some(100.0 * asked.min(fastest) / profile.motion.draw_speed);
    }
}

/// True if a layer has the usual speed of the machine that the file was written for, and `profile` is another machine.
fn is_usual(speeds: &LabelSpeeds, percent: f64, profile: &Profile) -> bool {
    speeds.machine != profile.name && (percent - speeds.usual_percent).abs() < 0.5
}
