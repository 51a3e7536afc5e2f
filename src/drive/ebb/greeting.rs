//! Meeting the board: whatever another program has set is set as it is needed here.

use super::servo::Servo;
use super::{DEEPEST, Ebb, LEAST_POWER, PenHeights, has_power};
use crate::drive::controller::Controller;
use crate::drive::error::DriveError;
use crate::drive::lines::Lines;
use crate::drive::port::Port;
use crate::interrupt::Interrupt;
use crate::plot::PenLift;
use std::collections::VecDeque;
use std::time::Duration;

/// How long what an earlier sender has queued may take.
const OLD_WORK: Duration = Duration::from_mins(1);
/// The board has ended its answer to half a command if it says nothing for so long.
const QUIET: Duration = Duration::from_millis(60);
/// The bit of `QG` that tells that the power was lost since it was asked for (firmware 3).
const POWER_LOST: u32 = 0x40;

impl Ebb {
    /// Meets the board at a port. The motors are enabled if they are not, which sets zero where the pen stands.
    pub fn greet(port: Box<dyn Port>, heights: PenHeights, lift: PenLift, interrupt: &Interrupt) -> Result<Self, DriveError> {
        let mut ebb = Self {
            port,
            lines: Lines::default(),
            unread: VecDeque::new(),
            version: String::new(),
            depth: 1,
            window: VecDeque::new(),
            running: VecDeque::new(),
            stand: None,
            pace: 1.0,
            questions: VecDeque::new(),
            is_position_known: true,
            former_depth: None,
            low: 0,
        };
        let major = ebb.read_version()?;
        // Answers with `OK`, and in the syntax of firmware 2.
        ebb.set("CU,1,1")?;
        if major >= 3 {
            ebb.set("CU,10,0")?;
            // Moves enable the motors, and rest does not disable them.
            ebb.say("CU,50,1")?;
            ebb.say("CU,61,0")?;
        }
        ebb.check_power()?;
        ebb.wait_until_still(OLD_WORK, interrupt)?;
        if major >= 3 {
            ebb.deepen_queue()?;
            ebb.check_for_lost_power()?;
        }
        ebb.enable_motors()?;
        ebb.set_servo(heights, Servo::of(lift))?;
        // A press of the button before this moment is forgotten.
        ebb.port.send(b"QB\r")?;
        ebb.acknowledged()?;
        ebb.read_stand()?;
        Ok(ebb)
    }

    /// Asks for the firmware's version, after whatever is still said of half a command; returns its first number.
    fn read_version(&mut self) -> Result<u32, DriveError> {
        self.port.send(b"\r")?;
        loop {
            self.receive(QUIET)?;
            if std::mem::take(&mut self.unread).is_empty() {
                break;
            }
        }
        self.port.send(b"V\r")?;
        let version = self.next_line(|line| line.contains("EBB"))?;
        version.trim_start_matches("V,").clone_into(&mut self.version);
        let number = self.version.rsplit(' ').next().unwrap_or("");
        let mut parts = number.split('.').map(|part| part.parse::<u32>().unwrap_or(0));
        let (major, minor) = (parts.next().unwrap_or(0), parts.next().unwrap_or(0));
        if (major, minor) < (2, 8) {
            return Err(DriveError::Busy(format!(
                "firmware {number}; drypoint needs 2.8 or later, update it with the maker's program"
            )));
        }
        Ok(major)
    }

    /// Sets a mode of answering, which the answer already has.
    fn set(&mut self, text: &str) -> Result<(), DriveError> {
        self.port.send(format!("{text}\r").as_bytes())?;
        self.next_line(|line| line.ends_with("OK") || line == "CU").map(drop)
    }

    fn check_power(&mut self) -> Result<(), DriveError> {
        self.port.send(b"QC\r")?;
        let answer = self.next_line(|line| line.contains(','))?;
        self.acknowledged()?;
        if has_power(&answer) { Ok(()) } else { Err(DriveError::Unpowered) }
    }

    /// Sets the depth of the queue, and remembers what it was.
    fn deepen_queue(&mut self) -> Result<(), DriveError> {
        let mut told = |number: u32| {
            self.port.send(format!("QU,{number}\r").as_bytes())?;
            let answer = self.next_line(|line| line.starts_with("QU,"))?;
            self.acknowledged()?;
            Ok::<usize, DriveError>(answer[3..].trim().parse().unwrap_or(1))
        };
        let (most, former) = (told(2)?, told(3)?);
        self.depth = most.clamp(1, DEEPEST);
        self.former_depth = Some(former);
        self.say(&format!("CU,4,{}", self.depth))
    }

    /// If the power was lost since an earlier session, the count of steps is not true; from now on a loss is remembered.
    fn check_for_lost_power(&mut self) -> Result<(), DriveError> {
        let is_lost = self.general()? & POWER_LOST != 0;
        if is_lost {
            self.say("EM,0,0")?;
        }
        self.say(&format!("CU,60,{LEAST_POWER}"))?;
        self.general().map(drop)
    }

    /// The answer to `QG`, which has no `OK`.
    fn general(&mut self) -> Result<u32, DriveError> {
        self.port.send(b"QG\r")?;
        let answer = self.next_line(|line| line.len() == 2)?;
        Ok(u32::from_str_radix(&answer, 16).unwrap_or(0))
    }

    fn enable_motors(&mut self) -> Result<(), DriveError> {
        self.port.send(b"QE\r")?;
        let motors = self.next_line(|line| line.contains(','))?;
        self.acknowledged()?;
        if !motors.contains("16,16") {
            self.say("EM,1,1")?;
            self.is_position_known = false;
        }
        Ok(())
    }

    /// Heights of the pen, and how fast it goes there.
    fn set_servo(&mut self, heights: PenHeights, servo: &Servo) -> Result<(), DriveError> {
        let [low, high] = servo.range;
        let units = |percent: f64| low + percent / 100.0 * (high - low);
        let range = (units(heights.up) - units(heights.down)).abs();
        let [up, down] = servo.seconds.map(|seconds| (range * servo.period() / seconds).max(1.0));
        let channels = f64::from(servo.channels);
        for (number, value) in [(4, units(heights.up)), (5, units(heights.down)), (8, channels), (11, up), (12, down)] {
            self.say(&format!("SC,{number},{value:.0}"))?;
        }
        Ok(())
    }
}
