//! Checks that all numbers sent to a machine are finite.

use crate::geometry::parse_finite;
use crate::plot::language::ResumeError;

/// Refuses G-code with a word such as `Xnan` or `Y1e999`. Comments are skipped; a controller's own commands need not hold
/// numbers.
pub(super) fn check_gcode(text: &str) -> Result<(), ResumeError> {
    for (i, line) in text.lines().enumerate() {
        let code = line.split(['(', ';', '%']).next().unwrap_or("");
        let is_motion = code.trim_start().starts_with(['G', 'g']);
        for word in code.split([' ', '\t', '=']).flat_map(words) {
            let body = word.get(1..).unwrap_or("");
            let is_endless = |text: &str| text.parse::<f64>().is_ok() && parse_finite(text).is_none();
            let is_none = is_motion && !body.is_empty() && body.parse::<f64>().is_err();
            if is_none || is_endless(body) || is_endless(word) {
                return Err(ResumeError::NotFinite { place: format!("line {}", i + 1), number: word.to_owned() });
            }
        }
    }
    Ok(())
}

/// The words of `X1Y-2e3`, each a letter and its number.
fn words(text: &str) -> Vec<&str> {
    let bytes = text.as_bytes();
    let begins = |i: usize| {
        let is_exponent = bytes[i].eq_ignore_ascii_case(&b'e')
            && bytes.get(i + 1).is_some_and(|next| next.is_ascii_digit() || matches!(next, b'+' | b'-'));
        bytes[i].is_ascii_alphabetic() && matches!(bytes[i - 1], b'0'..=b'9' | b'.') && !is_exponent
    };
    let mut starts = vec![0];
    starts.extend((1..bytes.len()).filter(|&i| begins(i)));
    starts.push(bytes.len());
    starts.windows(2).filter_map(|pair| text.get(pair[0]..pair[1])).filter(|word| !word.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_no_numbers_are_named_with_their_line() {
        for word in ["Xnan", "Yinf", "X1e999", "I-inf", "X1Ynan", "Fx"] {
            let refused = check_gcode(&format!("(pen up is M3 S300)\nG1 X1 {word}\n"));
            assert!(matches!(refused, Err(ResumeError::NotFinite { ref place, .. }) if place == "line 2"), "{word}: {refused:?}");
        }
        assert!(check_gcode("M3 Snan\n").is_err() && check_gcode("SET_SERVO SERVO=pen ANGLE=nan\n").is_err());
    }

    #[test]
    fn what_machines_understand_passes() {
        let text = "%\n; nan\n(inf)\nG21\nG1X1Y-2.5F3000\nG28 X Y\nG92 E0\nG1 E1e2\nSET_SERVO SERVO=pen ANGLE=30\nM117 hello there\nG4 P.15\nG38.2\nPAUSE\n";
        assert_eq!(check_gcode(text), Ok(()));
    }
}
