//! Converts lines of G-code to moves, stops and waits.

use super::{Laser, Settings};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// A straight move to a position in mm, at a rate in mm/min or, without one, as fast as the axes allow.
    Line { target: [f32; 3], rate: Option<f64> },
    /// Waits for the motion to end.
    Synchronize,
    /// Waits for the motion to end, then for a number of seconds.
    Dwell(f32),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MotionMode {
    Rapid,
    Feed,
    Clockwise,
    Anticlockwise,
}

/// The parser's state, and its pending output.
pub struct Program<'a> {
    lines: std::str::Lines<'a>,
    pending: std::collections::VecDeque<Command>,
    mode: MotionMode,
    rate: f64,
    spindle: u32,
    spindle_speed: f32,
    at: [f32; 3],
    arc_tolerance: f64,
    laser: Laser,
}

impl<'a> Program<'a> {
    pub fn new(text: &'a str, settings: &Settings) -> Self {
        Self {
            lines: text.lines(),
            pending: std::collections::VecDeque::new(),
            mode: MotionMode::Rapid,
            rate: 0.0,
            spindle: 5,
            spindle_speed: 0.0,
            at: [0.0; 3],
            arc_tolerance: settings.arc_tolerance,
            laser: settings.laser,
        }
    }

    /// One line in the firmware's order: feed, spindle speed, spindle state, wait, motion, pause.
    pub fn line(&mut self, line: &str) {
        let words = words(line);
        let value = |letter: char| words.iter().find(|w| w.0 == letter).map(|w| w.1);
        if let Some(rate) = value('F') {
            self.rate = f64::from(rate);
        }
        if let Some(speed) = value('S')
            && speed != self.spindle_speed
        {
            if self.spindle != 5 && self.laser == Laser::Off {
                self.pending.push_back(Command::Synchronize);
            }
            self.spindle_speed = speed;
        }
        let (mut dwells, mut pauses) = (false, false);
        for (letter, number) in &words {
            match (letter, number.round() as u32) {
                ('M', state @ 3..=5) if state != self.spindle => {
                    self.spindle = state;
                    self.pending.push_back(Command::Synchronize);
                }
                ('M', 0..=2 | 30) => pauses = true,
                ('G', 0) => self.mode = MotionMode::Rapid,
                ('G', 1) => self.mode = MotionMode::Feed,
                ('G', 2) => self.mode = MotionMode::Clockwise,
                ('G', 3) => self.mode = MotionMode::Anticlockwise,
                ('G', 4) => dwells = true,
                ('G', code) => assert!([17, 21, 90, 94].contains(&code), "the simulation knows no G{code}"),
                _ => {}
            }
        }
        if dwells {
            self.pending.push_back(Command::Dwell(value('P').expect("G4 has P")));
        } else if ['X', 'Y', 'Z'].into_iter().any(|axis| value(axis).is_some()) {
            let from = self.at;
            for (place, axis) in self.at.iter_mut().zip(['X', 'Y', 'Z']) {
                *place = value(axis).unwrap_or(*place);
            }
            self.motion(from, [value('I').unwrap_or(0.0), value('J').unwrap_or(0.0)]);
        }
        if pauses {
            self.pending.push_back(Command::Synchronize);
        }
    }

    /// The spindle's speed.
    pub fn spindle_speed(&self) -> f32 {
        self.spindle_speed
    }

    /// The modes after a reset, at a position.
    pub fn reset(&mut self, at: [f32; 3]) {
        self.pending.clear();
        (self.mode, self.rate, self.spindle, self.spindle_speed, self.at) = (MotionMode::Rapid, 0.0, 5, 0.0, at);
    }

    /// The place where it believes to be.
    pub fn reset_place(&mut self, at: [f32; 3]) {
        self.at = at;
    }

    /// The next of what the lines given so far ask for.
    pub fn next_pending(&mut self) -> Option<Command> {
        self.pending.pop_front()
    }

    fn motion(&mut self, from: [f32; 3], centre: [f32; 2]) {
        match self.mode {
            MotionMode::Rapid => self.pending.push_back(Command::Line { target: self.at, rate: None }),
            MotionMode::Feed => self.pending.push_back(Command::Line { target: self.at, rate: Some(self.rate) }),
            MotionMode::Clockwise | MotionMode::Anticlockwise => self.arc(from, centre),
        }
    }

    /// An arc in x and y as chords that deviate from it by about the tolerance at most.
    fn arc(&mut self, from: [f32; 3], offset: [f32; 2]) {
        let [i, j] = offset;
        let centre = [from[0] + i, from[1] + j];
        let to = [self.at[0] - centre[0], self.at[1] - centre[1]];
        let radius = (i * i + j * j).sqrt();
        let mut turn = (-i * to[1] + j * to[0]).atan2(-i * to[0] - j * to[1]);
        if self.mode == MotionMode::Clockwise && turn >= -5e-7 {
            turn -= std::f32::consts::TAU;
        } else if self.mode == MotionMode::Anticlockwise && turn <= 5e-7 {
            turn += std::f32::consts::TAU;
        }
        let tolerance = self.arc_tolerance as f32;
        let chord = (tolerance * (2.0 * radius - tolerance)).sqrt();
        let chords = ((0.5 * turn * radius).abs() / chord).floor() as u32;
        let rise = self.at[2] - from[2];
        // Each chord is the last one rotated, with sine and cosine to the third order; every thirteenth is computed exactly.
        let angle = turn / chords as f32;
        let (small_sine, small_cosine) = (angle * (1.0 - angle * angle / 6.0), 1.0 - 0.5 * angle * angle);
        let start = [-offset[0], -offset[1]];
        let mut arm = start;
        for n in 1..chords {
            let (sin, cos) = if n % 13 == 0 { (n as f32 * angle).sin_cos() } else { (small_sine, small_cosine) };
            let [x, y] = if n % 13 == 0 { start } else { arm };
            arm = [x * cos - y * sin, x * sin + y * cos];
            let z = from[2] + rise * n as f32 / chords as f32;
            let place = [centre[0] + arm[0], centre[1] + arm[1], z];
            self.pending.push_back(Command::Line { target: place, rate: Some(self.rate) });
        }
        self.pending.push_back(Command::Line { target: self.at, rate: Some(self.rate) });
    }
}

impl Iterator for Program<'_> {
    type Item = Command;

    fn next(&mut self) -> Option<Command> {
        while self.pending.is_empty() {
            let line = self.lines.next()?;
            self.line(line);
        }
        self.pending.pop_front()
    }
}

/// Letters and numbers of a line without its comments.
fn words(line: &str) -> Vec<(char, f32)> {
    let mut code = String::new();
    let mut is_comment = false;
    for c in line.chars().take_while(|c| *c != ';') {
        match c {
            '(' => is_comment = true,
            ')' => is_comment = false,
            _ if !is_comment && !c.is_whitespace() => code.push(c.to_ascii_uppercase()),
            _ => {}
        }
    }
    let starts: Vec<usize> = code.char_indices().filter(|(_, c)| c.is_ascii_alphabetic()).map(|(i, _)| i).collect();
    let ends = starts.iter().skip(1).copied().chain([code.len()]);
    starts.iter().zip(ends).map(|(&start, end)| (code.as_bytes()[start] as char, number(&code[start + 1..end]))).collect()
}

/// A number as the firmware reads it: its digits as an integer, then scaled by hundredths and tenths in single precision.
fn number(text: &str) -> f32 {
    let digits: String = text.chars().filter(char::is_ascii_digit).take(8).collect();
    let mut decimals = text.find('.').map_or(0, |point| text[point + 1..].chars().filter(char::is_ascii_digit).count());
    let mut value = digits.parse::<u32>().unwrap_or(0) as f32;
    while decimals >= 2 {
        value *= 0.01;
        decimals -= 2;
    }
    if decimals == 1 {
        value *= 0.1;
    }
    if text.starts_with('-') { -value } else { value }
}
