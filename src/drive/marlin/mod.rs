//! Marlin, and Klipper through its virtual serial port: numbered lines with checksums, `ok`, `busy`, and lines sent again.
//!
//! `N12 G1 X3*91`: the number counts up by one, the checksum is all bytes before the star, exclusive-or. After `Resend: 12` everything from
//! line 12 on is sent again. Positions come from `M114`, which Marlin answers after the lines before it.

mod reply;

use super::controller::{Controller, Heard, SpeedChange};
use super::error::DriveError;
use super::lines::Lines;
use super::port::Port;
use super::program::ProgramLine;
use super::stand::Stand;
use crate::interrupt::Interrupt;
use crate::plot::Act;
use reply::Reply;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Lines on their way: Marlin's queue holds four (`BUFSIZE`), of which one is being read.
const MOST_LINES: usize = 3;
/// Bytes on their way: its serial buffer holds 128 (`RX_BUFFER_SIZE`).
const MOST_BYTES: usize = 120;
/// The number and the checksum of a line take up to so many bytes.
const NUMBERING: usize = 16;
/// The longest line without them: Marlin reads 96 bytes (`MAX_CMD_SIZE`).
const LONGEST_LINE: usize = 80;
/// How long it may say nothing, not even that it is busy.
const PATIENCE: Duration = Duration::from_secs(15);
/// How long what was taken may take to be drawn, without a word: Klipper says nothing meanwhile.
const OLD_WORK: Duration = Duration::from_mins(2);
/// How long it may take from its start to its first answer.
const STARTING: Duration = Duration::from_secs(10);
/// Moves taken and not drawn: the planner's 15 blocks (`BLOCK_BUFFER_SIZE` 16), and the one that is being drawn.
const HIDDEN_MOVES: usize = 16;
/// The same for Klipper, which looks two seconds ahead, whatever the number of moves in them.
const LOOKED_AHEAD: usize = 2000;
/// It has said everything if it says nothing for so long.
const QUIET: Duration = Duration::from_millis(200);
/// Before a line is sent again what is on its way arrives, and is refused too.
const SETTLING: Duration = Duration::from_millis(60);
/// After a stop it throws moves away for a second.
const CLEANING: Duration = Duration::from_millis(1400);
/// Of an answer that does not come for so long after a stop, nothing more is expected: a line in mid-air was lost.
const SILENCE: Duration = Duration::from_secs(4);
/// Answered when everything before it is drawn.
const FINISHED: &str = "M400";
const LISTENING: Duration = Duration::from_millis(20);

/// A conversation with a machine.
pub struct Marlin {
    port: Box<dyn Port>,
    lines: Lines,
    firmware: String,
    /// The number of the next line.
    next: u64,
    /// Lines that are not taken: number, line of the program, text as sent.
    window: VecDeque<(u64, Option<usize>, String)>,
    stand: Option<Stand>,
    /// Percent of the file's speed.
    percent: u32,
    /// True while the answer to the question for the place is awaited: it comes when all before is drawn.
    is_asked: bool,
    /// Demands to send again whose own `ok` is still to come.
    refused: usize,
    /// Lines at the end of the window that are to be sent again, one at a time, and when the next is.
    unsent: usize,
    again_at: Instant,
    /// True if it said that it starts.
    is_restarted: bool,
}

/// The line as it is sent.
fn numbered(number: u64, text: &str) -> String {
    let body = format!("N{number} {text}");
    let checksum = body.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("{body}*{checksum}\n")
}

impl Marlin {
    /// Meets the machine at a port.
    pub fn greet(port: Box<dyn Port>, interrupt: &Interrupt) -> Result<Self, DriveError> {
        let mut marlin = Self {
            port,
            lines: Lines::default(),
            firmware: String::new(),
            next: 1,
            window: VecDeque::new(),
            stand: None,
            percent: 100,
            is_asked: false,
            refused: 0,
            unsent: 0,
            again_at: Instant::now(),
            is_restarted: false,
        };
        // Half a line of an earlier sender ends here; it is refused for its checksum.
        marlin.port.send(b"\n")?;
        marlin.begin_counting()?;
        Controller::ask(&mut marlin, "M115")?;
        // A speed that another program has left.
        Controller::ask(&mut marlin, "M220 S100")?;
        // The place told is that of the last line taken: an earlier drawing comes to its end first.
        marlin.ask_until(FINISHED, OLD_WORK, interrupt)?;
        Controller::ask(&mut marlin, "M114")?;
        if marlin.is_restarted {
            marlin.stand = None;
        }
        Ok(marlin)
    }

    /// Begins to count lines anew, as often as it takes. The place is asked for too: the `ok` after it is known from any other.
    fn begin_counting(&mut self) -> Result<(), DriveError> {
        let begun = Instant::now();
        while begun.elapsed() < STARTING {
            let questions = [numbered(0, "M110 N0"), numbered(1, "M114")].concat();
            self.port.send(questions.as_bytes())?;
            let (asked, mut is_told) = (Instant::now(), false);
            while asked.elapsed() < Duration::from_secs(1) {
                for reply in self.hear(LISTENING)? {
                    match reply {
                        Reply::Place(_) => is_told = true,
                        Reply::Ok if is_told => {
                            self.quiet()?;
                            self.next = 2;
                            return Ok(());
                        }
                        _ => {}
                    }
                }
            }
        }
        Err(DriveError::Silent { seconds: STARTING.as_secs(), expected: "Marlin or Klipper" })
    }

    /// Hears what is still said of earlier attempts, until it is quiet.
    fn quiet(&mut self) -> Result<(), DriveError> {
        let mut heard = Instant::now();
        while heard.elapsed() < QUIET {
            if !self.hear(LISTENING)?.is_empty() {
                heard = Instant::now();
            }
        }
        Ok(())
    }

    /// Hears the answers to all lines on their way and to one more, or until it has said nothing for a while.
    fn hear_out(&mut self) -> Result<(), DriveError> {
        let mut owed = self.window.len() + self.refused + 1;
        let mut heard = Instant::now();
        while owed > 0 && heard.elapsed() < SILENCE {
            for reply in self.hear(LISTENING)? {
                heard = Instant::now();
                owed = owed.saturating_sub(usize::from(reply == Reply::Ok));
            }
        }
        Ok(())
    }

    fn hear(&mut self, wait: Duration) -> Result<Vec<Reply>, DriveError> {
        let lines = self.lines.receive(&mut *self.port, wait)?;
        let replies: Vec<Reply> = lines.iter().flat_map(|line| Reply::all(line)).collect();
        for reply in &replies {
            match reply {
                Reply::Place(at) => self.stand = Some(Stand { at: *at, servo: None }),
                Reply::Firmware(name) => self.firmware.clone_from(name),
                Reply::Start => self.is_restarted = true,
                _ => {}
            }
        }
        Ok(replies)
    }

    fn push(&mut self, line: Option<usize>, text: &str) -> Result<(), DriveError> {
        let sent = numbered(self.next, text);
        if self.unsent > 0 {
            self.unsent += 1;
        } else {
            self.port.send(sent.as_bytes())?;
        }
        self.window.push_back((self.next, line, sent));
        self.next += 1;
        Ok(())
    }

    /// Sends the next line again, if one is owed. They go one at a time: the lines that were on their way behind the one it refused may
    /// still fill its buffer.
    fn send_again(&mut self) -> Result<(), DriveError> {
        if self.unsent > 0 && Instant::now() >= self.again_at {
            let (_, _, text) = &self.window[self.window.len() - self.unsent];
            self.port.send(text.as_bytes())?;
            self.unsent -= 1;
            self.again_at = Instant::now() + PATIENCE;
        }
        Ok(())
    }

    /// The line that an `ok` is for; the next may be sent again.
    fn acknowledged(&mut self) -> Option<(u64, Option<usize>, String)> {
        self.again_at = Instant::now();
        self.unsent = self.unsent.min(self.window.len().saturating_sub(1));
        self.window.pop_front()
    }

    fn understand(&mut self, replies: Vec<Reply>) -> Vec<Heard> {
        let mut heard = Vec::new();
        for reply in replies {
            match reply {
                // The `ok` after a demand to send again acknowledges nothing.
                Reply::Ok if self.refused > 0 => self.refused -= 1,
                Reply::Ok => match self.acknowledged() {
                    Some((_, Some(line), _)) => heard.push(Heard::Taken(line)),
                    Some((_, None, text)) if text.contains(" M114*") => {
                        self.is_asked = false;
                        heard.push(Heard::State { is_still: self.window.is_empty() });
                    }
                    _ => {}
                },
                Reply::Busy => heard.push(Heard::State { is_still: false }),
                Reply::Resend(number) => {
                    self.refused += 1;
                    self.unsent = self.window.iter().filter(|(sent, ..)| *sent >= number).count();
                    self.again_at = Instant::now() + SETTLING;
                }
                // What follows is the demand to send again.
                Reply::Error(text) if is_of_the_line(&text) => {}
                Reply::Error(text) => heard.push(Heard::Failed(text)),
                Reply::Start => heard.push(Heard::Restarted),
                Reply::Other(text) => heard.push(Heard::Said(text)),
                Reply::Place(_) | Reply::Firmware(_) => {}
            }
        }
        heard
    }
}

impl Marlin {
    fn is_klipper(&self) -> bool {
        self.firmware.starts_with("Klipper")
    }

    /// Says a line and waits until it is taken, while the machine says something at least so often; an interrupt ends the waiting only.
    fn ask_until(&mut self, text: &str, silence: Duration, interrupt: &Interrupt) -> Result<(), DriveError> {
        self.push(None, text)?;
        let mut heard = Instant::now();
        while !self.window.is_empty() {
            interrupt.check()?;
            self.send_again()?;
            let replies = self.hear(LISTENING)?;
            if !replies.is_empty() {
                heard = Instant::now();
            }
            for heard in self.understand(replies) {
                match heard {
                    Heard::Failed(text) => return Err(DriveError::Failed(text)),
                    Heard::Restarted => return Err(DriveError::Restarted),
                    _ => {}
                }
            }
            if heard.elapsed() > silence {
                return Err(DriveError::Silent { seconds: silence.as_secs(), expected: "Marlin or Klipper" });
            }
        }
        Ok(())
    }
}

/// True for a fault of the transmission, after which the machine asks for the line again.
fn is_of_the_line(text: &str) -> bool {
    let text = text.to_ascii_lowercase();
    ["checksum", "line number", "last line"].iter().any(|word| text.contains(word))
}

impl Controller for Marlin {
    fn longest_line(&self) -> usize {
        LONGEST_LINE
    }

    fn has_room(&self, text: &str) -> bool {
        let bytes: usize = self.window.iter().map(|(_, _, sent)| sent.len()).sum();
        self.unsent == 0 && self.window.len() < MOST_LINES && bytes + text.len() + NUMBERING <= MOST_BYTES
    }

    fn send(&mut self, line: usize, text: &str) -> Result<(), DriveError> {
        self.push(Some(line), text)
    }

    fn listen(&mut self, wait: Duration) -> Result<Vec<Heard>, DriveError> {
        self.send_again()?;
        let replies = self.hear(wait)?;
        Ok(self.understand(replies))
    }

    fn outstanding(&self) -> Option<usize> {
        self.window.iter().find_map(|(_, line, _)| *line)
    }

    fn ask_state(&mut self) -> Result<(), DriveError> {
        // While lines stream, their own answers say that it is there; M400 answers when all is drawn.
        if self.window.is_empty() && !self.is_asked {
            self.is_asked = true;
            self.push(None, FINISHED)?;
            self.push(None, "M114")?;
        }
        Ok(())
    }

    fn stand(&self) -> Option<Stand> {
        self.stand
    }

    fn answers_in_turn(&self) -> bool {
        true
    }

    fn proves(&self, line: &ProgramLine) -> bool {
        // Klipper answers a wait when it has planned it.
        line.text == FINISHED || matches!(line.act, Act::Wait(_)) && !self.is_klipper()
    }

    fn checkpoint(&self) -> Option<&'static str> {
        self.is_klipper().then_some(FINISHED)
    }

    fn hidden_moves(&self) -> usize {
        if self.is_klipper() { LOOKED_AHEAD } else { HIDDEN_MOVES }
    }

    fn patience(&self) -> Duration {
        PATIENCE
    }

    fn halt(&mut self) -> Result<Option<Stand>, DriveError> {
        // M410 stops the motors at once and forgets what is planned; an emergency parser takes it out of turn, and then once more in turn.
        self.port.send(b"M410\n")?;
        self.hear_out()?;
        self.window.clear();
        (self.is_asked, self.refused, self.unsent, self.stand) = (false, 0, 0, None);
        // For a second it throws away every move.
        let begun = Instant::now();
        while begun.elapsed() < CLEANING {
            self.hear(LISTENING)?;
        }
        self.begin_counting()?;
        self.ask("M114")?;
        Ok(self.stand)
    }

    fn change_speed(&mut self, change: SpeedChange) -> Result<Option<u32>, DriveError> {
        self.percent = change.of(self.percent);
        self.push(None, &format!("M220 S{}", self.percent))?;
        Ok(Some(self.percent))
    }

    fn ask(&mut self, text: &str) -> Result<(), DriveError> {
        self.ask_until(text, PATIENCE, &Interrupt::never())
    }

    fn await_rest(&mut self, most: Duration, interrupt: &Interrupt) -> Result<(), DriveError> {
        self.ask_until(FINISHED, most, interrupt)
    }

    fn travel(&mut self, [x, y]: [f64; 2], rate: f64, interrupt: &Interrupt) -> Result<(), DriveError> {
        self.ask(&format!("G0 X{x:.3} Y{y:.3} F{rate:.0}"))?;
        self.wait_until_still(OLD_WORK, interrupt)
    }

    fn set_zero(&mut self) -> Result<(), DriveError> {
        self.ask("G92 X0 Y0")?;
        self.ask("M114")
    }

    fn name(&self) -> &str {
        if self.firmware.is_empty() { "Marlin" } else { &self.firmware }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_numbered_and_checked() {
        // The example of the documentation: N123 M115 has the checksum of its bytes.
        assert_eq!(numbered(3, "T0"), "N3 T0*57\n");
        assert_eq!(numbered(4, "G92 E0"), "N4 G92 E0*67\n");
    }
}
