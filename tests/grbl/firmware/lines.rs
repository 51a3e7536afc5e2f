//! Lines that arrive: taken from the buffer, begun, gone on with.

use super::*;

impl Firmware {
    pub(super) fn take_lines(&mut self) {
        while !self.is_held {
            if self.is_busy {
                if !self.continue_line() {
                    return;
                }
                self.is_busy = false;
                self.say("ok");
            }
            let Some(byte) = self.buffer.pop_front() else { return };
            if byte == b'\n' || byte == b'\r' {
                let text = String::from_utf8_lossy(&std::mem::take(&mut self.line)).into_owned();
                if byte == b'\n' {
                    self.begin_line(&text);
                }
            } else {
                self.line.push(byte);
            }
        }
    }

    pub(super) fn begin_line(&mut self, text: &str) {
        if self.lines > 0 {
            self.starved += self.is_starving;
        }
        self.is_starving = 0.0;
        let code = text.trim();
        if let Some(command) = code.strip_prefix('$') {
            return self.system(command);
        }
        if self.is_alarmed {
            return self.say("error:9");
        }
        if code.len() > 79 {
            return self.say("error:11");
        }
        if let Some(place) = code.strip_prefix("G92 ") {
            for word in place.split_whitespace() {
                let value: f64 = word[1..].parse().unwrap();
                let axis = ["X", "Y", "Z"].iter().position(|letter| word.starts_with(letter)).unwrap();
                self.offset[axis] += self.place()[axis] - value;
            }
            self.offset_told = 0;
            self.program.reset_place(self.place().map(|v| v as f32));
            return self.say("ok");
        }
        if !code.is_empty() && !code.starts_with(['G', 'M', 'X', 'Y', 'Z', 'F', 'S', '(']) || code.contains('$') {
            return self.say("error:1");
        }
        self.lines += 1;
        if self.is_checking {
            return self.say("ok");
        }
        self.program.line(code);
        self.is_busy = true;
    }

    pub(super) fn system(&mut self, command: &str) {
        match command {
            "$" => {
                for (number, value) in self.reported.clone() {
                    self.say(&format!("${number}={value}"));
                }
                self.say("ok");
            }
            "X" => {
                self.is_alarmed = false;
                self.say("ok");
            }
            "H" => {
                self.is_alarmed = false;
                (self.is_homing, self.is_busy) = (true, true);
                self.command = Some(Command::Dwell(HOMING));
            }
            "I" => {
                self.say("[VER:1.1h.20190825:]");
                if self.build == Build::Told {
                    let blocks = self.settings.blocks;
                    self.say(&format!("[OPT:V,{blocks},{LINE_BUFFER}]"));
                }
                self.say("ok");
            }
            "C" => {
                self.is_checking = !self.is_checking;
                self.say(if self.is_checking { "[MSG:Enabled]" } else { "[MSG:Disabled]" });
                self.say("ok");
            }
            jog if jog.starts_with("J=") => {
                let value = |letter: char| {
                    jog.split_whitespace()
                        .find_map(|word| word.trim_start_matches("J=").strip_prefix(letter)?.parse::<f64>().ok())
                };
                let at = self.stepper.at;
                let target = [at[0] + value('X').unwrap_or(0.0), at[1] + value('Y').unwrap_or(0.0), at[2]];
                self.planner.add(target.map(|v| v as f32), value('F'), &mut self.stepper);
                let zero = self.zero();
                self.program.reset_place(std::array::from_fn(|axis| (target[axis] - zero[axis]) as f32));
                self.say("ok");
            }
            _ => self.say("error:3"),
        }
    }

    /// Goes on with the line; true if it is done.
    pub(super) fn continue_line(&mut self) -> bool {
        if let Some(until) = self.dwells_until {
            if self.now < until {
                return false;
            }
            self.dwells_until = None;
            self.command = None;
            self.is_homing = false;
        }
        loop {
            let Some(command) = self.command.take().or_else(|| self.program.next()) else {
                self.follow_spindle();
                return true;
            };
            let is_still = self.planner.is_empty() && self.stepper.running().is_none();
            match command {
                Command::Line { target, rate } if self.planner.free() > 0 => {
                    let zero = self.zero();
                    let target = std::array::from_fn(|axis| target[axis] + zero[axis] as f32);
                    self.planner.add(target, rate, &mut self.stepper);
                }
                Command::Synchronize if is_still => {}
                Command::Dwell(seconds) if is_still => {
                    let ticks = f64::from((seconds / DWELL_STEP - 1e-4).ceil());
                    self.dwells_until = Some(self.now + ticks * f64::from(DWELL_STEP));
                    self.command = Some(command);
                    return false;
                }
                waiting => {
                    self.command = Some(waiting);
                    return false;
                }
            }
        }
    }
}
