//! The two motors that lift an `AxiDraw`'s pen (evil-mad/axidraw 3.9, `axidraw_conf.py` and `pen_handling.py`).

use crate::plot::{Dialect, PenLift, Profile};

/// How the board moves the pen.
pub(super) struct Servo {
    /// Positions of 0 and 100 percent, in units of 83 ns.
    pub range: [f64; 2],
    /// The pin of port B at which it is plugged in.
    pub pin: u32,
    /// Channels among which the board deals out its signal, 3 ms for each (`SC,8`).
    pub channels: u32,
    /// Seconds in which it moves from one height to the other, up and down: less than the profile waits.
    pub seconds: [f64; 2],
}

const STANDARD: Servo = Servo { range: [9855.0, 27_831.0], pin: 1, channels: 8, seconds: [0.12, 0.19] };
const BRUSHLESS: Servo = Servo { range: [5400.0, 12_600.0], pin: 2, channels: 1, seconds: [0.05, 0.055] };

impl Servo {
    pub(super) const fn of(lift: PenLift) -> &'static Self {
        match lift {
            PenLift::Servo => &STANDARD,
            PenLift::Brushless => &BRUSHLESS,
        }
    }

    /// A machine's.
    pub(super) const fn of_machine(profile: &Profile) -> &'static Self {
        match &profile.dialect {
            Dialect::Svg(svg) => Self::of(svg.pen_lift),
            _ => &STANDARD,
        }
    }

    /// The rate is added once in so many seconds (`SC,11` and `SC,12`).
    pub(super) fn period(&self) -> f64 {
        0.003 * f64::from(self.channels)
    }
}
