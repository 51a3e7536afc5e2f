//! The terminal while a machine draws: a line of progress, keys, and JSON lines for other programs.

use super::super::arguments::SendOptions;
use super::super::claims;
use super::super::failure::Failure;
use super::super::messages::say;
use super::keys::{Keys, pause_is_asked_for};
use crate::drive::{DriveError, Ending, Happening, Onlooker, Progress, SpeedChange, Wish};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};
use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::time::Instant;

/// Steps of the bar.
const STEPS: u64 = 1000;

/// A time to the second, such as `2 h 05 min`, `7 min 30 s`.
pub(super) fn lasting(seconds: f64) -> String {
    let seconds = seconds.round() as u64;
    match (seconds / 3600, seconds / 60 % 60, seconds % 60) {
        (0, 0, seconds) => format!("{seconds} s"),
        (0, minutes, seconds) => format!("{minutes} min {seconds:02} s"),
        (hours, minutes, _) => format!("{hours} h {minutes:02} min"),
    }
}

pub(super) struct Terminal {
    keys: Option<Keys>,
    bar: ProgressBar,
    status: Option<Box<dyn Write>>,
    begun: Instant,
    is_waiting: bool,
    is_quiet: bool,
}

impl Terminal {
    pub fn new(options: &SendOptions, keys: Option<Keys>) -> Result<Self, Failure> {
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("[{bar:30}] {msg}") {
            bar.set_style(style.progress_chars("=> "));
        }
        if !options.quiet && io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        let status: Option<Box<dyn Write>> = match options.status.as_deref() {
            None => None,
            Some("-") => Some(Box::new(io::stdout())),
            Some(name) => {
                claims::check_not_input(name)?;
                Some(Box::new(File::create(name).map_err(Failure::writing(name))?))
            }
        };
        Ok(Self { keys, bar, status, begun: Instant::now(), is_waiting: false, is_quiet: options.quiet })
    }

    fn tell(&mut self, text: &str) {
        self.bar.suspend(|| say!("{text}"));
    }

    /// A line for other programs; a reader that is gone does not stop the machine.
    fn write_status(&mut self, mut value: Value) {
        if let Some(out) = &mut self.status {
            value["seconds"] = json!((10.0 * self.begun.elapsed().as_secs_f64()).round() / 10.0);
            let _ = writeln!(out, "{value}").and_then(|()| out.flush());
        }
    }

    fn show(&mut self, progress: &Progress) {
        self.bar.set_position((progress.fraction * STEPS as f64) as u64);
        let pen = progress.pen;
        self.bar.set_message(format!(
            "{:.1} %, {} left, path {} of {}, pen {pen}",
            100.0 * progress.fraction,
            lasting(progress.seconds_left),
            (progress.paths + 1).min(progress.paths_in_all),
            progress.paths_in_all
        ));
        self.write_status(json!({
            "state": if self.is_waiting { "waiting" } else { "drawing" },
            "fraction": progress.fraction,
            "seconds_left": progress.seconds_left,
            "paths": progress.paths,
            "paths_in_all": progress.paths_in_all,
            "pen": pen,
            "at": progress.at,
        }));
    }

    /// Ends the line of progress.
    pub fn finish(&mut self, ending: &Result<Ending, DriveError>) {
        self.bar.finish_and_clear();
        self.keys = None;
        let state = match ending {
            Ok(Ending::Done) => "done",
            Ok(Ending::Stopped) => "stopped",
            Err(_) => "failed",
        };
        let fault = ending.as_ref().err().map(ToString::to_string);
        self.write_status(json!({ "state": state, "fault": fault }));
        if matches!(ending, Ok(Ending::Done)) && !self.is_quiet {
            say!("drawn in {}", lasting(self.begun.elapsed().as_secs_f64()));
        }
    }
}

impl Onlooker for Terminal {
    fn wish(&mut self) -> Option<Wish> {
        let toggled = if self.is_waiting { Wish::Resume } else { Wish::Pause };
        if pause_is_asked_for() {
            return Some(toggled);
        }
        self.keys.as_ref()?;
        match Keys::pressed()? {
            b' ' => Some(toggled),
            b'\n' | b'\r' if self.is_waiting => Some(Wish::Resume),
            b'q' => Some(Wish::Stop),
            b'+' => Some(Wish::Speed(SpeedChange::Faster)),
            b'-' => Some(Wish::Speed(SpeedChange::Slower)),
            b'=' => Some(Wish::Speed(SpeedChange::Usual)),
            b'[' => Some(Wish::Press(-1)),
            b']' => Some(Wish::Press(1)),
            _ => None,
        }
    }

    fn happens(&mut self, happening: &Happening<'_>) {
        match happening {
            Happening::Progress(progress) => self.show(progress),
            Happening::Pausing => {
                self.is_waiting = true;
                self.tell("pausing at the end of the path; space goes on");
            }
            Happening::Paused => {
                self.write_status(json!({ "state": "paused" }));
                self.tell("paused with the pen up; space goes on, q ends");
            }
            Happening::PenWanted { number, name, parked: [x, y] } => {
                self.is_waiting = true;
                self.write_status(json!({ "state": "pen wanted", "pen": number, "name": name }));
                self.tell(&format!("put in {name}, parked at x {x:.1} y {y:.1}; Enter goes on, q ends"));
            }
            Happening::InkWanted => {
                self.is_waiting = true;
                self.write_status(json!({ "state": "ink wanted" }));
                self.tell("fill or dip the pen, which is up; Enter goes on, q ends");
            }
            Happening::Resumed => {
                self.is_waiting = false;
                self.write_status(json!({ "state": "drawing" }));
            }
            Happening::Said(text) => self.tell(&format!("the machine says: {text}")),
        }
    }
}
