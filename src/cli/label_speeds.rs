//! `+S` in a layer's label is a percentage of one machine's greatest speed; on another it is brought to the same speed.

use super::messages::warning;
use crate::plot::Profile;
use crate::read::{Imported, LabelSpeeds};

/// Percent of a machine's drawing speed that a label may ask for where it is a percentage of that.
const MOST_PERCENT: f64 = 200.0;

/// Brings the speeds that a drawing's layers ask for to a machine.
///
/// What drypoint wrote for a plotter says for which: a layer with that machine's usual speed gets this one's, and one with a speed of
/// its own keeps it in mm/s. In other files a plotter whose own program reads the label takes it as this program does, and for the
/// rest it is a percentage of the drawing speed.
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
            warning!("layer '{layer}' asks for {asked:.0} mm/s with its +S, and {name} draws it at {fastest:.0}, its most");
        }
        layer.layer.handling.speed_percent = Some(100.0 * asked.min(fastest) / profile.motion.draw_speed);
    }
}

/// Whether a layer has the speed that all layers had on the machine that the file was written for, and this is another one.
fn is_usual(speeds: &LabelSpeeds, percent: f64, profile: &Profile) -> bool {
    speeds.machine != profile.name && (percent - speeds.usual_percent).abs() < 0.5
}
