//! What a test does to the machine by hand, and sees of it.

use super::{Firmware, Pen};

impl Firmware {
    /// Hangs the pen on the z axis, 2 mm above the paper.
    pub fn hang_pen(&mut self) {
        self.pen = Pen::Height(1.0);
        self.work[2] = -2.0;
        self.program.reset_place(self.place().map(|v| v as f32));
    }

    /// The value of the servo.
    pub fn servo(&self) -> f32 {
        self.last_spindle
    }

    /// Puts the servo there, as an earlier program did.
    pub fn set_servo(&mut self, value: f32) {
        self.program.line(&format!("M3 S{value}"));
        while self.program.next_pending().is_some() {}
        (self.last_spindle, self.was_down) = (value, value > 500.0);
    }

    /// Changes a `$` setting in its reports.
    pub fn set(&mut self, number: &str, value: &str) {
        self.reported
            .iter_mut()
            .filter(|setting| setting.0.to_string() == number)
            .for_each(|setting| value.clone_into(&mut setting.1));
    }

    /// It stops itself.
    pub fn alarm(&mut self, code: u32) {
        self.is_alarmed = true;
        self.say(&format!("ALARM:{code}"));
    }

    /// True if nothing is left to do but half a line.
    pub fn waits_for_line(&self) -> bool {
        self.is_idle() && !self.buffer.contains(&b'\n')
    }

    /// True if the pen is down.
    pub fn is_pen_down(&self) -> bool {
        match self.pen {
            Pen::Servo(above) => self.last_spindle > above,
            Pen::Height(below) => self.place()[2] < below,
        }
    }

    /// True if nothing is left to do.
    pub fn is_done(&self) -> bool {
        self.is_idle() && self.buffer.is_empty()
    }
}
