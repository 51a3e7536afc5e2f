//! G-code as motion: modal absolute moves, and the pen by the profile's own commands.

use super::Strokes;
use crate::geometry::Point;
use thiserror::Error;

/// Motion in machine units (millimetres).
pub type GcodeMotion = Strokes;

/// Why a file could not be read.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum GcodeError {
    /// A word that is not a letter and a number.
    #[error("line {line}: '{word}' is not a G-code word")]
    Word {
        /// Line, from 1.
        line: usize,
        /// The word.
        word: String,
    },
    /// A mode that is not read.
    #[error("line {line}: {word} is not understood here; drypoint reads absolute moves in millimetres")]
    Mode {
        /// Line, from 1.
        line: usize,
        /// The word.
        word: String,
    },
}

/// Reads `G0 G1` moves in absolute millimetres; a line equal to `pen_up` or `pen_down` moves the pen, `M0` pauses, a comment
/// `pen N:` tells which pen is in the holder.
pub fn read_gcode(text: &str, pen_up: &str, pen_down: &str) -> Result<GcodeMotion, GcodeError> {
    let mut motion = Strokes { ends_up: true, ..Strokes::default() };
    let (mut at, mut pen, mut is_down) = (Point::ORIGIN, 1, false);
    for (i, raw) in text.lines().enumerate() {
        let comment = raw.find('(').map_or("", |start| raw[start + 1..].trim_end_matches(')'));
        if let Some(number) = comment.strip_prefix("pen ").and_then(|rest| rest.split(':').next()).and_then(|n| n.parse().ok()) {
            pen = number;
        }
        let line = raw.split(['(', ';']).next().unwrap_or("").trim();
        if line == pen_up {
            is_down = false;
        } else if line == pen_down {
            if !is_down {
                motion.paths.push((pen, vec![at]));
            }
            is_down = true;
        } else if line == "M0" {
            motion.pauses += 1;
        } else if let Some(to) = target(line, at, i + 1)? {
            at = to;
            motion.visited.push(at);
            if is_down && let Some((_, path)) = motion.paths.last_mut() {
                path.push(at);
            }
        }
    }
    motion.ends_up = !is_down;
    Ok(motion)
}

/// Where a line moves to, if it moves.
fn target(line: &str, at: Point, number: usize) -> Result<Option<Point>, GcodeError> {
    let (mut to, mut moves) = (at, false);
    for word in line.split_whitespace() {
        let (letter, value) = word.split_at(word.chars().next().map_or(0, char::len_utf8));
        let value: f64 = value.parse().map_err(|_| GcodeError::Word { line: number, word: word.to_owned() })?;
        match letter {
            "X" => (to.x, moves) = (value, true),
            "Y" => (to.y, moves) = (value, true),
            "G" if [2.0, 3.0, 20.0, 91.0, 28.0].contains(&value) => {
                return Err(GcodeError::Mode { line: number, word: word.to_owned() });
            }
            // Time and other settings carry letters of their own.
            "P" if line.starts_with("G4") => {}
            _ => {}
        }
    }
    Ok(moves.then_some(to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_touches_and_pauses() {
        let text = "(drypoint)\nG21\nG90\nM3 S300\nG4 P.15\nG0 X1 Y2\nM3 S700\nG4 P.2\nG1 X3 Y4 F3000\nG1 X5\nM3 S300\n(pen 2: x)\nM0\nG0 X9 Y9\nM3 S700\nM3 S300\n";
        let motion = read_gcode(text, "M3 S300", "M3 S700").unwrap();
        assert_eq!(motion.paths[0], (1, vec![Point::new(1.0, 2.0), Point::new(3.0, 4.0), Point::new(5.0, 4.0)]));
        assert_eq!(motion.paths[1], (2, vec![Point::new(9.0, 9.0)]));
        assert_eq!(motion.pauses, 1);
        assert!(motion.ends_up);
    }

    #[test]
    fn faults_are_named() {
        assert_eq!(read_gcode("G21\nG0 Xa\n", "", ""), Err(GcodeError::Word { line: 2, word: "Xa".into() }));
        assert!(matches!(read_gcode("G20\n", "M3 S1", "M3 S2"), Err(GcodeError::Mode { line: 1, .. })));
    }
}
