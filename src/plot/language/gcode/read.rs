//! G-code as motion: modal absolute moves; the pen moves by the profile's own commands.

use super::Strokes;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2, arc_points, flatten_arc, parse_finite};
use crate::read::{Budget, PATH, POINT, TooMuchWork};
use thiserror::Error;

/// Why a file could not be read.
#[derive(Debug, Error, PartialEq)]
pub enum GcodeError {
    /// A word that is not a letter and a number.
    #[error("line {line}: '{word}' is not a G-code word (a letter and a number)")]
    Word {
        /// Line, from 1.
        line: usize,
        /// The word.
        word: String,
    },
    /// A number that is NaN, infinite, or too large for any machine.
    #[error("line {line}: '{word}' is not a finite number; write a number up to 1e30")]
    NotFinite {
        /// Line, from 1.
        line: usize,
        /// The word.
        word: String,
    },
    /// A mode that is not supported.
    #[error("line {line}: {word} is not supported; drypoint reads absolute moves in millimetres")]
    Mode {
        /// Line, from 1.
        line: usize,
        /// The word.
        word: String,
    },
    /// More moves than can be held.
    #[error("line {line}: the file {work}")]
    Work {
        /// Line, from 1.
        line: usize,
        /// The work counted and the limit.
        #[source]
        work: TooMuchWork,
    },
}

/// How a file moves its pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PenLift<'a> {
    /// By lines of their own.
    Commands {
        /// Lifts it.
        up: &'a str,
        /// Lowers it.
        down: &'a str,
    },
    /// By the z axis: it is down beyond the middle between two heights.
    Heights {
        /// Above the paper.
        up: f64,
        /// On it.
        down: f64,
    },
}

/// Flattening tolerance of arcs, in millimetres.
const ARC_TOLERANCE: f64 = 0.002;

struct Reader<'a> {
    motion: Strokes,
    budget: &'a mut Budget,
    at: Point,
    pen: u32,
    is_down: bool,
    /// The last of G0 to G3.
    mode: u32,
}

/// Reads absolute moves and arcs in millimetres: lines that equal the pen's commands move it, `M0` and `PAUSE` pause, a comment `pen N:`
/// names the pen in the holder.
pub(super) fn read(text: &str, lift: &PenLift<'_>, budget: &mut Budget) -> Result<Strokes, GcodeError> {
    budget.text(text.len() as f64).map_err(|work| GcodeError::Work { line: 1, work })?;
    let motion = Strokes { ends_up: true, ..Strokes::default() };
    let mut reader = Reader { motion, budget, at: Point::ORIGIN, pen: 1, is_down: false, mode: 0 };
    for (i, raw) in text.lines().enumerate() {
        let comment = raw.find(['(', ';']).map_or("", |start| raw[start + 1..].trim_start().trim_end_matches(')'));
        if let Some(number) = comment.strip_prefix("pen ").and_then(|rest| rest.split(':').next()).and_then(|n| n.parse().ok()) {
            reader.pen = number;
        }
        let line = raw.split(['(', ';', '%']).next().unwrap_or("").trim();
        match lift {
            PenLift::Commands { up, .. } if line == *up => reader.is_down = false,
            PenLift::Commands { down, .. } if line == *down => {
                reader.lower().map_err(|work| GcodeError::Work { line: i + 1, work })?;
            }
            _ if line == "M0" || line == "PAUSE" => reader.motion.pauses += 1,
            _ if line.split_whitespace().next().is_some_and(is_named) => {}
            _ => reader.line(line, i + 1, lift)?,
        }
    }
    reader.motion.ends_up = !reader.is_down;
    Ok(reader.motion)
}

/// True if a word is a controller's named command, such as `SET_SERVO`.
fn is_named(word: &str) -> bool {
    word.len() > 2 && word.bytes().take(2).all(|b| b.is_ascii_alphabetic())
}

/// A line's values for the axes and an arc's centre.
#[derive(Default)]
struct Words {
    x: Option<f64>,
    y: Option<f64>,
    z: Option<f64>,
    i: f64,
    j: f64,
    has_centre: bool,
}

impl Reader<'_> {
    fn line(&mut self, line: &str, number: usize, lift: &PenLift<'_>) -> Result<(), GcodeError> {
        let mut words = Words::default();
        for word in line.split_whitespace() {
            let (letter, value) = word.split_at(word.chars().next().map_or(0, char::len_utf8));
            let refused = || match value.parse::<f64>() {
                Ok(_) => GcodeError::NotFinite { line: number, word: word.to_owned() },
                Err(_) => GcodeError::Word { line: number, word: word.to_owned() },
            };
            let value = parse_finite(value).ok_or_else(refused)?;
            match letter {
                "X" => words.x = Some(value),
                "Y" => words.y = Some(value),
                "Z" => words.z = Some(value),
                "I" => (words.i, words.has_centre) = (value, true),
                "J" => (words.j, words.has_centre) = (value, true),
                "G" if [0.0, 1.0, 2.0, 3.0].contains(&value) => self.mode = value as u32,
                "G" if [20.0, 28.0, 91.0, 92.0].contains(&value) => {
                    return Err(GcodeError::Mode { line: number, word: word.to_owned() });
                }
                "R" => return Err(GcodeError::Mode { line: number, word: word.to_owned() }),
                // Speeds, times and other settings.
                _ => {}
            }
        }
        let too_much = |work| GcodeError::Work { line: number, work };
        if let (PenLift::Heights { up, down }, Some(z)) = (lift, words.z) {
            if (z - down).abs() < (z - up).abs() || (z - down) * (up - down) < 0.0 {
                self.lower().map_err(too_much)?;
            } else {
                self.is_down = false;
            }
        }
        self.go(&words).map_err(too_much)
    }

    fn go(&mut self, words: &Words) -> Result<(), TooMuchWork> {
        if words.x.is_none() && words.y.is_none() {
            return Ok(());
        }
        let to = Point::new(words.x.unwrap_or(self.at.x), words.y.unwrap_or(self.at.y));
        if self.mode < 2 || !words.has_centre {
            self.budget.spend(POINT, "moves")?;
            self.visit(to);
            return Ok(());
        }
        let centre = self.at + Vec2::new(words.i, words.j);
        let (from, end) = (self.at - centre, to - centre);
        let turn = from.cross(end).angle_over(from.dot(end));
        let whole = std::f64::consts::TAU;
        let sweep = match (self.mode, turn) {
            (3, turn) if turn <= 0.0 => turn + whole,
            (2, turn) if turn >= 0.0 => turn - whole,
            (_, turn) => turn,
        };
        self.budget.spend(POINT * arc_points(from.hypot(), sweep, ARC_TOLERANCE), "arcs")?;
        for p in flatten_arc(self.at, to, centre, sweep, ARC_TOLERANCE) {
            self.visit(p);
        }
        Ok(())
    }

    fn visit(&mut self, to: Point) {
        self.at = to;
        self.motion.visit(to, self.is_down);
    }

    fn lower(&mut self) -> Result<(), TooMuchWork> {
        if !self.is_down {
            self.budget.spend(PATH, "paths")?;
            self.motion.paths.push((self.pen, vec![self.at]));
        }
        self.is_down = true;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_gcode(text: &str, up: &str, down: &str) -> Result<Strokes, GcodeError> {
        read(text, &PenLift::Commands { up, down }, &mut Budget::default())
    }

    fn read_gcode_heights(text: &str, up: f64, down: f64) -> Result<Strokes, GcodeError> {
        read(text, &PenLift::Heights { up, down }, &mut Budget::default())
    }

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

    #[test]
    fn numbers_without_end_are_faults() {
        for word in ["Xnan", "X1e999", "Yinf", "I-inf", "Snan", "Z1e31"] {
            let text = format!("G21\nG0 X1\nG1 {word}\n");
            let expected = Err(GcodeError::NotFinite { line: 3, word: word.into() });
            assert_eq!(read_gcode(&text, "M3 S1", "M3 S2"), expected);
            assert!(read_gcode_heights(&text, 2.0, -0.2).is_err(), "{word}");
        }
    }

    #[test]
    fn arcs_are_counted_before_they_are_followed() {
        let text = "G2 X0 Y0 I1e9 J0\n".repeat(40_000);
        let Err(GcodeError::Work { line, work }) = read_gcode(&text, "M3 S1", "M3 S2") else { panic!("it was read") };
        assert!(line < 40_000 && work.what == "arcs" && work.steps > work.most);
    }

    #[test]
    fn heights_and_arcs() {
        let text =
            "%\n; pen 3: brush\nG0 Z2\nG0 X1 Y0 F600\nG1 Z-.2 F60\nG3 X-1 Y0 I-1 J0\nG2 X1 Y0 I1 J0 Z-1\nG0 Z2\nPAUSE\n%\n";
        let motion = read_gcode_heights(text, 2.0, -0.2).unwrap();
        assert_eq!((motion.paths.len(), motion.paths[0].0, motion.pauses, motion.ends_up), (1, 3, 1, true));
        assert!(motion.paths[0].1.iter().all(|p| (p.to_vec2().hypot() - 1.0).abs() < 0.003));
        assert!(motion.paths[0].1.iter().all(|p| p.y >= -1e-9), "G3 over the top, G2 back over it");
    }
}
