//! HP-GL as motion: the subset that plotter programs write.

use super::Strokes;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2, arc_points, flatten_arc, parse_finite};
use crate::read::{Budget, PATH, POINT, TooMuchWork};
use std::ops::Range;
use thiserror::Error;

/// Why a file could not be read.
#[derive(Debug, Error, PartialEq)]
pub enum HpglError {
    /// An instruction that is not two letters and numbers.
    #[error("byte {at}: '{text}' is not an HP-GL instruction")]
    Instruction {
        /// Byte offset of the instruction.
        at: usize,
        /// The text found there.
        text: String,
    },
    /// A number that is NaN, infinite, or too large for any machine.
    #[error("byte {at}: '{number}' is not a finite number; write a number up to 1e30")]
    NotFinite {
        /// Byte offset of the instruction.
        at: usize,
        /// The text found there.
        number: String,
    },
    /// More moves than can be held.
    #[error("byte {at}: the file {work}")]
    Work {
        /// Byte offset of the instruction.
        at: usize,
        /// The work counted and the limit.
        #[source]
        work: TooMuchWork,
    },
    /// An odd number of coordinates.
    #[error("byte {at}: odd number of coordinates in '{text}'; write x,y pairs")]
    OddCoordinates {
        /// Byte offset of the instruction.
        at: usize,
        /// The instruction.
        text: String,
    },
}

/// Flattening tolerance of arcs, in plotter units.
const ARC_TOLERANCE: f64 = 0.1;

/// Starts an escape sequence, which is for the interface and not the plotter.
const ESCAPE: char = '\u{1b}';

/// Reads `IN SP VS FS PU PD PA PR PE AA AR PS` and skips other instructions' effects; escape sequences are passed over.
pub(super) fn read(text: &str, budget: &mut Budget) -> Result<Strokes, HpglError> {
    budget.text(text.len() as f64).map_err(|work| HpglError::Work { at: 0, work })?;
    let mut reader = Reader::new(budget);
    for (bytes, instruction) in instructions(text) {
        reader.execute(instruction, bytes.start)?;
    }
    reader.motion.ends_up = !reader.is_down;
    Ok(reader.motion)
}

/// The instructions of a file, each with its bytes and whatever ends it; escape sequences are passed over.
pub(super) fn instructions(text: &str) -> impl Iterator<Item = (Range<usize>, &str)> {
    let separates = |c: char| c == ';' || c.is_whitespace();
    let mut left = text.trim_start_matches(separates);
    std::iter::from_fn(move || {
        while left.starts_with(ESCAPE) {
            left = left[escape_length(left)..].trim_start_matches(separates);
        }
        let start = text.len() - left.len();
        let (instruction, after) = (!left.is_empty()).then(|| left.split_at(length(left)))?;
        left = after.trim_start_matches(separates);
        Some((start..start + instruction.len(), instruction.trim_end_matches(separates)))
    })
}

/// Length in bytes of the first instruction of a text.
fn length(text: &str) -> usize {
    // Packed numbers may contain any printable character except their terminator.
    let is_packed = text.get(..2).is_some_and(|name| name.eq_ignore_ascii_case("PE"));
    let end = if is_packed { text.find(';') } else { text.find([';', '\n', ESCAPE]) };
    end.map_or(text.len(), |end| end + usize::from(!text[end..].starts_with(ESCAPE)))
}

/// Length in bytes of an escape sequence: ESC, a point and a letter; some letters take numbers, which a colon ends.
fn escape_length(text: &str) -> usize {
    let letter: usize = text.chars().take(3).map(char::len_utf8).sum();
    if !text.as_bytes().get(2).is_some_and(|letter| b"@HIMNPQSTY".contains(letter)) {
        return letter;
    }
    let numbers = text[letter..].bytes().take_while(|byte| byte.is_ascii_digit() || b"; ".contains(byte)).count();
    if text[letter + numbers..].starts_with(':') { letter + numbers + 1 } else { letter }
}

pub(super) struct Reader<'a> {
    budget: &'a mut Budget,
    motion: Strokes,
    at: Point,
    pen: u32,
    is_down: bool,
    is_relative: bool,
}

impl<'a> Reader<'a> {
    /// A machine at its origin with the pen up.
    pub fn new(budget: &'a mut Budget) -> Self {
        let motion = Strokes { ends_up: true, ..Strokes::default() };
        Self { budget, motion, at: Point::ORIGIN, pen: 0, is_down: false, is_relative: false }
    }

    pub fn at(&self) -> Point {
        self.at
    }

    pub fn is_down(&self) -> bool {
        self.is_down
    }

    /// Number of places visited.
    pub fn visited(&self) -> usize {
        self.motion.visited.len()
    }

    /// Places visited after the first `count`.
    pub fn since(&self, count: usize) -> &[Point] {
        &self.motion.visited[count..]
    }
}

impl Reader<'_> {
    pub fn execute(&mut self, instruction: &str, start: usize) -> Result<(), HpglError> {
        let too_much = |work| HpglError::Work { at: start, work };
        let refuse = || HpglError::Instruction { at: start, text: instruction.chars().take(20).collect() };
        if instruction.len() < 2 || !instruction.as_bytes()[..2].iter().all(u8::is_ascii_alphabetic) {
            return Err(refuse());
        }
        let (name, parameters) = instruction.split_at(2);
        let name = name.to_ascii_uppercase();
        if name == "PE" {
            // A pair takes at least two characters.
            self.budget.spend(0.5 * (POINT + PATH) * parameters.len() as f64, "moves").map_err(too_much)?;
            return self.packed(parameters).ok_or_else(refuse);
        }
        let numbers: Vec<f64> = parameters
            .split([',', ' '])
            .filter(|number| !number.is_empty())
            .map(|number| match number.parse::<f64>() {
                Ok(_) => parse_finite(number)
                    .ok_or_else(|| HpglError::NotFinite { at: start, number: number.chars().take(20).collect() }),
                Err(_) => Err(refuse()),
            })
            .collect::<Result<_, _>>()?;
        match name.as_str() {
            "IN" | "DF" => (self.is_down, self.is_relative) = (false, false),
            "SP" => self.pen = numbers.first().map_or(0, |n| *n as u32),
            "PU" => self.is_down = false,
            "PD" => {
                self.budget.spend(PATH, "paths").map_err(too_much)?;
                self.lower();
            }
            "PA" => self.is_relative = false,
            "PR" => self.is_relative = true,
            "AA" | "AR" => return self.arc(&numbers, name == "AR").ok_or_else(refuse)?.map_err(too_much),
            _ => return Ok(()),
        }
        if !matches!(name.as_str(), "PU" | "PD" | "PA" | "PR") {
            return Ok(());
        }
        if !numbers.len().is_multiple_of(2) {
            return Err(HpglError::OddCoordinates { at: start, text: instruction.chars().take(40).collect() });
        }
        self.budget.spend(0.5 * POINT * numbers.len() as f64, "moves").map_err(too_much)?;
        numbers.chunks_exact(2).for_each(|pair| self.move_by_or_to(pair[0], pair[1]));
        Ok(())
    }

    /// Draws an arc given its centre and its sweep in degrees. `None` if parameters are missing.
    fn arc(&mut self, numbers: &[f64], is_relative: bool) -> Option<Result<(), TooMuchWork>> {
        let &[x, y, degrees, ..] = numbers else { return None };
        let centre = if is_relative { self.at + Vec2::new(x, y) } else { Point::new(x, y) };
        let (sin, cos) = degrees.to_radians().sine_and_cosine();
        let spoke = self.at - centre;
        let to = centre + Vec2::new(spoke.x * cos - spoke.y * sin, spoke.x * sin + spoke.y * cos);
        if let Err(work) = self.budget.spend(POINT * arc_points(spoke.hypot(), degrees.to_radians(), ARC_TOLERANCE), "arcs") {
            return Some(Err(work));
        }
        for p in flatten_arc(self.at, to, centre, degrees.to_radians(), ARC_TOLERANCE) {
            self.visit(p);
        }
        Some(Ok(()))
    }

    /// Reads pairs of differences in base 64 or, after a 7, base 32; `<` lifts the pen for one move and `=` makes one absolute.
    fn packed(&mut self, text: &str) -> Option<()> {
        let (mut base, mut value, mut scale) = (64, 0_i64, 1_i64);
        let (mut pair, mut is_up, mut is_absolute) = (Vec::new(), false, false);
        let was_down = self.is_down;
        for c in text.chars().map(u32::from) {
            match c {
                55 => base = 32,
                60 => is_up = true,
                61 => is_absolute = true,
                63..=254 => {
                    let digit = i64::from(c) - 63;
                    let is_last = digit >= if base == 64 { 128 } else { 32 };
                    value = value.checked_add((digit % if base == 64 { 128 } else { 32 }).checked_mul(scale)?)?;
                    scale = scale.checked_mul(base)?;
                    if is_last {
                        pair.push(if value % 2 == 1 { -(value / 2) } else { value / 2 } as f64);
                        (value, scale) = (0, 1);
                    }
                }
                _ if char::from_u32(c).is_some_and(char::is_whitespace) => {}
                _ => return None,
            }
            if let [x, y] = pair[..] {
                if is_up {
                    self.is_down = false;
                } else {
                    self.lower();
                }
                let by = Vec2::new(x, y);
                self.visit(if is_absolute { by.to_point() } else { self.at + by });
                (is_up, is_absolute) = (false, false);
                pair.clear();
            }
        }
        self.is_down = was_down;
        Some(())
    }

    fn lower(&mut self) {
        if !self.is_down {
            self.motion.paths.push((self.pen, vec![self.at]));
        }
        self.is_down = true;
    }

    fn move_by_or_to(&mut self, x: f64, y: f64) {
        self.visit(if self.is_relative { self.at + Vec2::new(x, y) } else { Point::new(x, y) });
    }

    fn visit(&mut self, to: Point) {
        self.at = to;
        self.motion.visit(to, self.is_down);
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in super::super) fn read_hpgl(text: &str) -> Result<Strokes, HpglError> {
        read(text, &mut Budget::default())
    }

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
        assert!(matches!(read_hpgl("IN;F\u{136}=aI;PU1,2;"), Err(HpglError::Instruction { at: 3, .. })));
        assert!(matches!(read_hpgl("IN;P"), Err(HpglError::Instruction { at: 3, .. })));
    }

    #[test]
    fn numbers_without_end_are_faults() {
        for number in ["nan", "inf", "-inf", "1e999"] {
            for instruction in ["PD", "PU0,", "PA5,5,1,", "AA5,5,", "VS"] {
                let refused = read_hpgl(&format!("IN;SP1;{instruction}{number};"));
                assert_eq!(refused, Err(HpglError::NotFinite { at: 7, number: number.into() }), "{instruction}{number}");
            }
        }
    }

    #[test]
    fn arcs_are_counted_before_they_are_followed() {
        let text = format!("IN;SP1;PU0,0;PD;{}", "AA5,5,1e18;".repeat(20_000));
        let Err(HpglError::Work { at, work }) = read_hpgl(&text) else { panic!("it was read") };
        assert!(at == 16 && work.what == "arcs" && work.steps > work.most);
    }

    #[test]
    fn instructions_end_at_semicolons_lines_and_escapes() {
        let text = "\u{1b}.N;19:\u{1b}.N\u{1b}.@;0;in\n PU1,2\u{1b}.E;;PD;\n pe\nab\n;SP0";
        let found: Vec<_> = instructions(text).map(|(bytes, text)| (bytes.len(), text)).collect();
        assert_eq!(found, [(2, "0"), (3, "in"), (5, "PU1,2"), (3, "PD"), (7, "pe\nab"), (3, "SP0")]);
    }

    #[test]
    fn escapes_arcs_and_packed_lines() {
        let text = "\u{1b}.N;19:\u{1b}.I81;;17:IN;SP2;PU10,0;PD;AA0,0,90,5;PU0,0;PD;PE7abab;PU5,5;SP0;";
        let motion = read_hpgl(text).unwrap();
        let quarter = &motion.paths[0].1;
        assert!(quarter[quarter.len() - 1].distance(Point::new(0.0, 10.0)) < 1e-9);
        assert!(quarter.iter().all(|p| (p.to_vec2().hypot() - 10.0).abs() < 0.2));
        assert_eq!(motion.paths[1], (2, vec![Point::ORIGIN, Point::new(1.0, -1.0), Point::new(2.0, -2.0)]));
        assert!(motion.ends_up);
    }
}
