//! Drawing: lines go out as fast as the machine takes them; pauses, stops and changes of pen are handled between.
//!
//! ```text
//!   Sending --pause--> Draining to the path's end --still--> Waiting --resume--> Sending
//!      \--stop--> halted at once, pen lifted, place kept
//!      \--pause line of the file--> Waiting for a pen
//! ```

use super::controller::{Controller, Heard, SpeedChange};
use super::error::DriveError;
use super::journal::Journal;
use super::program::Program;
use super::standing::{Progress, Standing, pressed};
use crate::interrupt::Interrupt;
use crate::plot::Act;
use std::io;
use std::time::{Duration, Instant};

/// What a user wishes while the machine draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wish {
    /// Pause at the end of the path, with the pen up.
    Pause,
    /// Go on.
    Resume,
    /// Stop at once, lift the pen and end.
    Stop,
    /// Draw faster or slower.
    Speed(SpeedChange),
    /// Press the pen harder by steps, or with a negative number more lightly, from the next path on. A step is 0.05 mm of a z axis, or 5
    /// of a servo's thousand.
    Press(i32),
}

/// What happens.
#[derive(Clone, Debug, PartialEq)]
pub enum Happening<'a> {
    /// How far it is; several times a second.
    Progress(Progress),
    /// It will pause at the end of the path.
    Pausing,
    /// It stands still with the pen up.
    Paused,
    /// It waits for another pen.
    PenWanted {
        /// The pen's number.
        number: u32,
        /// Its name, as the file gives it.
        name: &'a str,
        /// Where the carriage is parked, in machine units.
        parked: [f64; 2],
    },
    /// It waits for the user to see to the ink.
    InkWanted,
    /// It goes on.
    Resumed,
    /// The machine said something.
    Said(&'a str),
}

/// Who watches a drawing and may change its course.
pub trait Onlooker {
    /// The next wish, if there is one.
    fn wish(&mut self) -> Option<Wish>;

    /// Something happened.
    fn happens(&mut self, happening: &Happening<'_>);
}

/// How a drawing ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// All is drawn.
    Done,
    /// It was stopped; the pen is up.
    Stopped,
}

/// Waiting for something to be heard.
const LISTENING: Duration = Duration::from_millis(10);
/// Between two questions for the state, while it draws and while it comes to rest.
const ASKING: [Duration; 2] = [Duration::from_millis(200), Duration::from_millis(40)];
/// Between two reports of progress.
const REPORTING: Duration = Duration::from_millis(200);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Sending,
    /// Sends up to a line, then pauses.
    Draining(usize),
    /// Waits for the user.
    Waiting,
}

/// A drawing in progress.
pub struct Session<'a> {
    controller: &'a mut dyn Controller,
    standing: Standing<'a>,
    phase: Phase,
    /// Steps by which the pen is pressed harder.
    press: i32,
    asked: Instant,
    heard: Instant,
    reported: Option<Instant>,
    /// Consecutive reports of standing still since the last line was taken.
    still: u32,
    /// How long the machine may say nothing.
    patience: Duration,
}

impl<'a> Session<'a> {
    /// A drawing that begins.
    pub fn new(controller: &'a mut dyn Controller, program: &'a Program) -> Self {
        let patience = controller.patience() + Duration::from_secs_f64(program.longest_line());
        Self {
            controller,
            standing: Standing::new(program),
            phase: Phase::Sending,
            press: 0,
            asked: Instant::now(),
            heard: Instant::now(),
            reported: None,
            still: 0,
            patience,
        }
    }

    /// Draws until the end, a stop or a fault. After a fault or a stop the machine stands still with the pen up, if it still obeys.
    pub fn run(
        mut self,
        journal: &mut Journal<'_>,
        onlooker: &mut dyn Onlooker,
        interrupt: &Interrupt,
    ) -> Result<Ending, DriveError> {
        loop {
            match self.advance(journal, onlooker, interrupt) {
                Ok(None) => {}
                Ok(Some(ending)) => {
                    // A machine may remember a changed speed for the next drawing.
                    if self.standing.percent != 100 {
                        let _ = self.controller.change_speed(SpeedChange::Usual);
                    }
                    return Ok(ending);
                }
                Err(fault) => return Err(self.broken(fault, journal)),
            }
        }
    }

    /// Once around: wishes, lines that go out, what the machine says, the journal.
    fn advance(
        &mut self,
        journal: &mut Journal<'_>,
        onlooker: &mut dyn Onlooker,
        interrupt: &Interrupt,
    ) -> Result<Option<Ending>, DriveError> {
        let mut is_ended = interrupt.is_raised();
        while let Some(wish) = onlooker.wish().filter(|_| !is_ended) {
            is_ended = wish == Wish::Stop;
            self.follow(wish, onlooker)?;
        }
        if is_ended {
            self.halt()?;
            journal.note(self.standing.record())?;
            return Ok(Some(Ending::Stopped));
        }
        self.feed()?;
        self.listen(onlooker)?;
        self.ask()?;
        self.come_to_rest(onlooker);
        self.standing.pass_time(if self.phase == Phase::Waiting { 0 } else { self.standing.percent });
        journal.note(self.standing.record())?;
        self.report(onlooker);
        Ok(self.standing.is_done.then_some(Ending::Done))
    }

    fn follow(&mut self, wish: Wish, onlooker: &mut dyn Onlooker) -> Result<(), DriveError> {
        match (wish, self.phase) {
            (Wish::Pause, Phase::Sending) => {
                self.phase = Phase::Draining(self.standing.end_of_path());
                onlooker.happens(&Happening::Pausing);
            }
            (Wish::Resume, Phase::Draining(_) | Phase::Waiting) => {
                self.phase = Phase::Sending;
                onlooker.happens(&Happening::Resumed);
            }
            (Wish::Speed(change), _) => match self.controller.change_speed(change)? {
                Some(percent) => self.standing.percent = percent,
                None => onlooker.happens(&Happening::Said("its speed cannot be changed while it draws")),
            },
            (Wish::Press(steps), _) => self.press += steps,
            _ => {}
        }
        Ok(())
    }

    /// True if lines wait that may be sent.
    fn has_more(&self) -> bool {
        let Standing { program, next, .. } = self.standing;
        match self.phase {
            Phase::Sending => program.lines.get(next).is_some_and(|line| line.act != Act::Pause),
            Phase::Draining(end) => next < end,
            Phase::Waiting => false,
        }
    }

    /// Sends lines while there is room.
    fn feed(&mut self) -> Result<(), DriveError> {
        let end = match self.phase {
            Phase::Sending => self.standing.program.lines.len(),
            Phase::Draining(end) => end,
            Phase::Waiting => return Ok(()),
        };
        while self.standing.next < end {
            let line = &self.standing.program.lines[self.standing.next];
            if line.act == Act::Pause {
                break;
            }
            let text = pressed(self.standing.program, line, self.press);
            if !text.is_empty() {
                if !self.controller.has_room(&text) {
                    break;
                }
                self.controller.send(self.standing.next, &text)?;
                self.still = 0;
            }
            self.standing.next += 1;
        }
        self.standing.taken = self.controller.outstanding().unwrap_or(self.standing.next);
        Ok(())
    }

    fn listen(&mut self, onlooker: &mut dyn Onlooker) -> Result<(), DriveError> {
        let all = self.controller.listen(LISTENING)?;
        if !all.is_empty() {
            self.heard = Instant::now();
        } else if self.heard.elapsed() > self.patience {
            return Err(DriveError::Lost(io::Error::new(io::ErrorKind::TimedOut, "it no longer answers")));
        }
        for heard in all {
            match heard {
                Heard::Taken(line) => {
                    self.still = 0;
                    if self.controller.proves(&self.standing.program.lines[line]) {
                        self.standing.prove(line);
                    } else {
                        self.standing.take(line, self.controller.hidden_moves());
                    }
                }
                Heard::State { is_still } => {
                    self.still = if is_still { self.still + 1 } else { 0 };
                    self.standing.stands(self.controller.stand());
                }
                Heard::Refused { line, code, meaning } => {
                    let line = line.map(|line| &self.standing.program.lines[line]);
                    let (number, text) = line.map_or((0, String::new()), |line| (line.number, line.text.clone()));
                    return Err(DriveError::Refused { number, text, code, meaning });
                }
                Heard::Alarm { code, meaning } => return Err(DriveError::Alarm { code, meaning }),
                Heard::Failed(text) => return Err(DriveError::Failed(text)),
                Heard::Restarted => return Err(DriveError::Restarted),
                Heard::Unpowered => return Err(DriveError::Unpowered),
                // The machine's own button pauses, and goes on.
                Heard::Button if self.phase == Phase::Waiting => self.follow(Wish::Resume, onlooker)?,
                Heard::Button => self.follow(Wish::Pause, onlooker)?,
                Heard::Said(text) => onlooker.happens(&Happening::Said(&text)),
            }
        }
        self.standing.taken = self.controller.outstanding().unwrap_or(self.standing.next);
        Ok(())
    }

    /// Asks for the state now and then, and more often when all is taken. A question that holds up what follows is asked only where
    /// nothing follows.
    fn ask(&mut self) -> Result<(), DriveError> {
        if self.controller.answers_in_turn() && self.has_more() {
            return Ok(());
        }
        let is_ending = self.controller.outstanding().is_none();
        if self.asked.elapsed() >= ASKING[usize::from(is_ending)] {
            self.controller.ask_state()?;
            self.asked = Instant::now();
        }
        Ok(())
    }

    /// When all that may be sent is drawn: the end, a pause, or a change of pen.
    fn come_to_rest(&mut self, onlooker: &mut dyn Onlooker) {
        let is_still = self.controller.outstanding().is_none() && self.still >= 2;
        if !is_still || self.phase == Phase::Waiting {
            return;
        }
        let standing = &mut self.standing;
        standing.drawn = standing.next;
        let lines = &standing.program.lines;
        match lines.get(standing.next) {
            None => standing.is_done = true,
            Some(line) if line.act == Act::Pause => {
                standing.next += 1;
                self.phase = Phase::Waiting;
                if line.name.is_some() {
                    return onlooker.happens(&Happening::InkWanted);
                }
                let named = lines[..standing.next].iter().rev().find_map(|line| Some((line.act, line.name.as_deref()?)));
                let (number, name) = match named {
                    Some((Act::Pen(number), name)) => (number, name),
                    _ => (1, ""),
                };
                let parked = [line.at[0], line.at[1]];
                onlooker.happens(&Happening::PenWanted { number, name, parked });
            }
            Some(_) if matches!(self.phase, Phase::Draining(end) if standing.next >= end) => {
                self.phase = Phase::Waiting;
                onlooker.happens(&Happening::Paused);
            }
            Some(_) => {}
        }
    }

    fn report(&mut self, onlooker: &mut dyn Onlooker) {
        if self.standing.is_done || self.reported.is_none_or(|last| last.elapsed() >= REPORTING) {
            self.reported = Some(Instant::now());
            onlooker.happens(&Happening::Progress(self.standing.progress()));
        }
    }

    /// Stops at once, sets the modes again that a reset takes away, and lifts the pen.
    fn halt(&mut self) -> Result<(), DriveError> {
        self.standing.stand = self.controller.halt()?.or(self.standing.stand);
        for line in self.standing.program.to_lift() {
            self.controller.ask(&line.text)?;
        }
        self.standing.is_stopped = true;
        Ok(())
    }

    /// After a fault: stops and lifts the pen if the machine still obeys; the fault is what is told.
    fn broken(&mut self, fault: DriveError, journal: &mut Journal<'_>) -> DriveError {
        let obeys = !matches!(
            fault,
            DriveError::Lost(_)
                | DriveError::Silent { .. }
                | DriveError::Alarm { .. }
                | DriveError::Restarted
                | DriveError::Unpowered
        );
        if obeys && !self.standing.is_stopped {
            let _ = self.halt();
        }
        let _ = journal.note(self.standing.record());
        fault
    }
}
