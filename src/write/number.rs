//! Decimal numbers in their shortest form.

/// Converts a length in millimetres to whole units of 0.001 mm, the grid of files.
pub fn thousandths(mm: f64) -> i64 {
    (mm * 1000.0).round() as i64
}

/// Appends `value` in units of `10^-digits`, without redundant zeros: 1500 thousandths are `1.5`, -20 are `-.02`. Digit by digit: a file has
/// millions of numbers, and a formatter takes longer.
pub fn decimal(out: &mut String, value: i64, digits: u32) {
    if value < 0 {
        out.push('-');
    }
    let scale = 10_u64.pow(digits);
    let (whole, fraction) = (value.unsigned_abs() / scale, value.unsigned_abs() % scale);
    if whole != 0 || fraction == 0 {
        push_digits(out, whole, 1);
    }
    if fraction != 0 {
        let (mut fraction, mut digits) = (fraction, digits as usize);
        while fraction.is_multiple_of(10) {
            (fraction, digits) = (fraction / 10, digits - 1);
        }
        out.push('.');
        push_digits(out, fraction, digits);
    }
}

/// Appends a whole number with at least so many digits.
fn push_digits(out: &mut String, mut value: u64, least: usize) {
    const MOST: usize = 20;
    let mut digits = [b'0'; MOST];
    let mut first = MOST;
    while value > 0 {
        first -= 1;
        digits[first] = b'0' + (value % 10) as u8;
        value /= 10;
    }
    // Digits are text.
    out.push_str(std::str::from_utf8(&digits[first.min(MOST - least)..]).unwrap_or_default());
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
