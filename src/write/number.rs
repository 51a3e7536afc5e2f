//! Decimal numbers in their shortest form.

use std::fmt::Write;

/// Converts a length in millimetres to whole units of 0.001 mm, the grid of files.
pub fn thousandths(mm: f64) -> i64 {
    (mm * 1000.0).round() as i64
}

/// Appends `value` in units of `10^-digits`, without redundant zeros: 1500 thousandths are `1.5`, -20 are `-.02`.
pub fn decimal(out: &mut String, value: i64, digits: u32) {
    let scale = 10_i64.pow(digits);
    if value < 0 {
        out.push('-');
    }
    let (whole, fraction) = (value.abs() / scale, value.abs() % scale);
    if whole != 0 || fraction == 0 {
        let _ = write!(out, "{whole}");
    }
    if fraction != 0 {
        let start = out.len();
        let _ = write!(out, ".{fraction:0width$}", width = digits as usize);
        while out.ends_with('0') && out.len() > start {
            out.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn text(value: i64, digits: u32) -> String {
        let mut out = String::new();
        decimal(&mut out, value, digits);
        out
    }

    #[test]
    fn short_forms() {
        assert_eq!(text(1500, 3), "1.5");
        assert_eq!(text(-20, 3), "-.02");
        assert_eq!(text(0, 3), "0");
        assert_eq!(text(100_000, 3), "100");
        assert_eq!(text(1234, 4), ".1234");
    }

    proptest! {
        #[test]
        fn reads_back(value in -10_000_000_i64..10_000_000) {
            let parsed: f64 = text(value, 3).parse().unwrap();
            prop_assert_eq!(thousandths(parsed), value);
        }
    }
}
