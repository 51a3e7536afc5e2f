//! GRBL's own settings (`$$`), compared with the profile by which a file was made.

use crate::plot::Profile;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The machine's settings by number.
pub type Settings = BTreeMap<u32, f64>;

/// A setting that differs from what the profile assumes.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Its number, as in `$110`.
    pub setting: u32,
    /// What it sets, with its unit.
    pub what: &'static str,
    /// The machine's value.
    pub machine: f64,
    /// The profile's value.
    pub profile: f64,
    /// What the difference does to a plot.
    pub effect: &'static str,
}

/// What the settings of an axis set, and what a difference does.
const STEPS: [&str; 3] = ["steps per mm of x", "steps per mm of y", "steps per mm of z"];
const RATES: [&str; 3] = ["greatest rate of x, mm/min", "greatest rate of y, mm/min", "greatest rate of z, mm/min"];
const ACCELERATIONS: [&str; 3] = ["acceleration of x, mm/s2", "acceleration of y, mm/s2", "acceleration of z, mm/s2"];

/// Settings with the profile's value of each; those that the profile does not know are left out.
fn assumed(profile: &Profile) -> Vec<(u32, &'static str, f64, &'static str)> {
    let motion = &profile.motion;
    let mut list = Vec::new();
    let mut add = |first: u32, what: [&'static str; 3], values: [f64; 3], effect: &'static str| {
        let settings = (first..).zip(what).zip(values).take(axes(profile));
        list.extend(settings.map(|((setting, what), value)| (setting, what, value, effect)));
    };
    if let Some(steps) = motion.planner.steps_per_mm {
        add(100, STEPS, steps, "the drawing comes out in another size, unless the motors differ too");
    }
    add(110, RATES, motion.axis_speeds().map(|speed| 60.0 * speed), "the time told is wrong");
    add(120, ACCELERATIONS, motion.axis_accelerations(motion.acceleration), "the time told is wrong");
    if let Some(deviation) = motion.junction_deviation {
        list.push((11, "junction deviation, mm", deviation, "corners are faster or slower than told"));
    }
    list.push((32, "laser mode", 0.0, "the servo moves while the pen travels: set $32=0"));
    list
}

/// The z axis counts only where it lifts the pen.
fn axes(profile: &Profile) -> usize {
    if profile.height().is_some() { 3 } else { 2 }
}

/// Settings that differ from the profile's by more than a thousandth; those that the machine does not report are left out.
pub fn differences(settings: &Settings, profile: &Profile) -> Vec<Difference> {
    let differ = |(setting, what, wanted, effect): (u32, &'static str, f64, &'static str)| {
        let machine = *settings.get(&setting)?;
        let differs = (machine - wanted).abs() > 1e-3 * wanted.abs().max(1e-3);
        differs.then_some(Difference { setting, what, machine, profile: wanted, effect })
    };
    assumed(profile).into_iter().filter_map(differ).chain(shorter_travels(settings, profile)).collect()
}

/// Axes that reach less far on the machine than in the profile; to reach farther does no harm.
fn shorter_travels(settings: &Settings, profile: &Profile) -> Vec<Difference> {
    let Some(area) = &profile.area else { return Vec::new() };
    let axes = [(130, "travel of x, mm", area.x), (131, "travel of y, mm", area.y)];
    let shorter = axes.into_iter().filter_map(|(setting, what, [from, to])| {
        let (machine, reach) = (*settings.get(&setting)?, (to - from) / profile.units_per_mm);
        let effect = "a drawing that fills the profile's area runs into the end of the axis";
        (machine < reach - 0.5).then_some(Difference { setting, what, machine, profile: reach, effect })
    });
    shorter.collect()
}

/// The machine's reach along x and y in millimetres (`$130`, `$131`), if soft limits (`$20`) enforce it.
pub fn enforced_reach(settings: &Settings) -> Option<[f64; 2]> {
    let is_enforced = settings.get(&20).is_some_and(|value| *value != 0.0);
    is_enforced.then(|| Some([*settings.get(&130)?, *settings.get(&131)?])).flatten()
}

/// A profile that extends another with the machine's own settings, as TOML.
pub fn adopted(settings: &Settings, profile: &Profile) -> String {
    let value = |number: u32| settings.get(&number).copied();
    let all = |first: u32| Some([value(first)?, value(first + 1)?, value(first + 2)?]);
    let list = |values: [f64; 3]| format!("[{}, {}, {}]", values[0], values[1], values[2]);
    let mut text = format!("extends = \"{}\"\nname = \"{}-adopted\"\n", profile.name, profile.name);
    if let (Some(x), Some(y)) = (value(130), value(131)) {
        let _ = write!(text, "\n# $130 and $131.\n[area]\nx = [0, {x}]\ny = [0, {y}]\n");
    }
    text += "\n[motion]\n";
    if let Some([x, y, _]) = all(110) {
        let _ = write!(text, "# $110 and $111, the greater one.\ntravel_speed = {:.3}\n", x.max(y) / 60.0);
    }
    if let Some([x, y, _]) = all(120) {
        let _ = write!(text, "# $120 and $121, the smaller one.\nacceleration = {}\n", x.min(y));
    }
    if let Some(deviation) = value(11) {
        let _ = write!(text, "# $11.\njunction_deviation = {deviation}\n");
    }
    text += "\n[motion.planner]\n";
    if let Some(rates) = all(110) {
        let _ = write!(text, "# $110 to $112.\naxis_speed = {}\n", list(rates.map(|rate| (rate / 60.0 * 1e3).round() / 1e3)));
    }
    if let Some(accelerations) = all(120) {
        let _ = write!(text, "# $120 to $122.\naxis_acceleration = {}\n", list(accelerations));
    }
    if let Some(steps) = all(100) {
        let _ = write!(text, "# $100 to $102.\nsteps_per_mm = {}\n", list(steps));
    }
    if let Some(tolerance) = value(12) {
        let _ = write!(text, "# $12.\narc_tolerance = {tolerance}\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> Settings {
        let usual = [(11, 0.01), (12, 0.002), (20, 1.0), (32, 0.0), (100, 80.0), (101, 80.0), (102, 400.0)];
        let rates =
            [(110, 6000.0), (111, 6000.0), (112, 500.0), (120, 250.0), (121, 250.0), (122, 250.0), (130, 300.0), (131, 400.0)];
        usual.into_iter().chain(rates).collect()
    }

    #[test]
    fn what_differs_is_named() {
        let profile = Profile::built_in("grbl-servo").unwrap();
        assert_eq!(differences(&settings(), &profile), []);
        let mut other = settings();
        other.extend([(32, 1.0), (101, 100.0), (110, 3000.0)]);
        let found: Vec<u32> = differences(&other, &profile).iter().map(|difference| difference.setting).collect();
        assert_eq!(found, [101, 110, 32]);
        assert_eq!(enforced_reach(&settings()), Some([300.0, 400.0]));
        other.extend([(130, 200.0), (131, 900.0)]);
        let last = differences(&other, &profile).pop().unwrap();
        assert_eq!((last.setting, last.machine), (130, 200.0));
    }

    #[test]
    fn an_adopted_profile_no_longer_differs() {
        let mut own = settings();
        own.extend([(101, 100.0), (110, 3000.0), (121, 180.0)]);
        let profile = Profile::built_in("grbl-servo").unwrap();
        let adopted = Profile::parse("adopted.toml", &adopted(&own, &profile)).unwrap();
        assert_eq!(differences(&own, &adopted), []);
        assert_eq!(adopted.motion.planner.steps_per_mm, Some([80.0, 100.0, 400.0]));
    }
}
