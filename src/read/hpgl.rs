//! HP-GL as motion: the subset that plotter programs write.

use super::Strokes;
use crate::geometry::Point;
use thiserror::Error;

/// Motion in plotter units.
pub type HpglMotion = Strokes;

/// Why a file could not be read.
#[derive(Debug, Error, PartialEq)]
pub enum HpglError {
    /// An instruction that is not two letters and numbers.
    #[error("byte {at}: '{text}' is not an HP-GL instruction")]
    Instruction {
        /// Where it begins.
        at: usize,
        /// What stands there.
        text: String,
    },
    /// An odd number of coordinates.
    #[error("byte {at}: a coordinate has no partner in '{text}'")]
    OddCoordinates {
        /// Where the instruction begins.
        at: usize,
        /// The instruction.
        text: String,
    },
}

/// Reads `IN SP VS FS PU PD PA PR PS` and skips other instructions' effects; escape sequences are passed over.
pub fn read_hpgl(text: &str) -> Result<HpglMotion, HpglError> {
    let mut reader = Reader {
        motion: Strokes { ends_up: true, ..Strokes::default() },
        at: Point::ORIGIN,
        pen: 0,
        is_down: false,
        is_relative: false,
    };
    let mut start = 0;
    for piece in text.split_inclusive([';', '\n']) {
        let instruction = piece.trim_matches(|c: char| c == ';' || c.is_whitespace());
        if !instruction.is_empty() && !instruction.starts_with('\u{1b}') {
            reader.execute(instruction, start)?;
        }
        start += piece.len();
    }
    reader.motion.ends_up = !reader.is_down;
    Ok(reader.motion)
}

struct Reader {
    motion: Strokes,
    at: Point,
    pen: u32,
    is_down: bool,
    is_relative: bool,
}

impl Reader {
    fn execute(&mut self, instruction: &str, start: usize) -> Result<(), HpglError> {
        let refuse = || HpglError::Instruction { at: start, text: instruction.chars().take(20).collect() };
        if instruction.len() < 2 || !instruction.as_bytes()[..2].iter().all(u8::is_ascii_alphabetic) {
            return Err(refuse());
        }
        let (name, parameters) = instruction.split_at(2);
        let numbers: Vec<f64> = parameters
            .split([',', ' '])
            .filter(|number| !number.is_empty())
            .map(|number| number.parse().map_err(|_| refuse()))
            .collect::<Result<_, _>>()?;
        match name.to_ascii_uppercase().as_str() {
            "IN" | "DF" => (self.is_down, self.is_relative) = (false, false),
            "SP" => self.pen = numbers.first().map_or(0, |n| *n as u32),
            "PU" => self.is_down = false,
            "PD" => self.lower(),
            "PA" => self.is_relative = false,
            "PR" => self.is_relative = true,
            _ => return Ok(()),
        }
        if !name.starts_with(['P', 'p']) || matches!(name, "PS") {
            return Ok(());
        }
        if !numbers.len().is_multiple_of(2) {
            return Err(HpglError::OddCoordinates { at: start, text: instruction.chars().take(40).collect() });
        }
        numbers.chunks_exact(2).for_each(|pair| self.move_by_or_to(pair[0], pair[1]));
        Ok(())
    }

    fn lower(&mut self) {
        if !self.is_down {
            self.motion.paths.push((self.pen, vec![self.at]));
        }
        self.is_down = true;
    }

    fn move_by_or_to(&mut self, x: f64, y: f64) {
        self.at = if self.is_relative { self.at + crate::geometry::Vec2::new(x, y) } else { Point::new(x, y) };
        self.motion.visited.push(self.at);
        if self.is_down
            && let Some((_, path)) = self.motion.paths.last_mut()
        {
            path.push(self.at);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_touches_and_pens() {
        let motion = read_hpgl("IN;PU;PS4;SP1;VS30;PU10,20;PD30,40,50,60;PU70,80;PD;SP2;PU;PR;PD1,1;PU;SP0;\n").unwrap();
        assert_eq!(motion.paths.len(), 3);
        assert_eq!(motion.paths[0], (1, vec![Point::new(10.0, 20.0), Point::new(30.0, 40.0), Point::new(50.0, 60.0)]));
        assert_eq!(motion.paths[1], (1, vec![Point::new(70.0, 80.0)]));
        assert_eq!(motion.paths[2], (2, vec![Point::new(70.0, 80.0), Point::new(71.0, 81.0)]));
        assert!(motion.ends_up);
    }

    #[test]
    fn faults_are_named() {
        assert!(matches!(read_hpgl("IN;PU1;"), Err(HpglError::OddCoordinates { at: 3, .. })));
        assert!(matches!(read_hpgl("IN;<svg>"), Err(HpglError::Instruction { at: 3, .. })));
    }
}
