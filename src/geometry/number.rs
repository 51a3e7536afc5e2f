//! Numbers in files for machines: finite, and small enough for a controller.

/// Maximum absolute value. Beyond it a controller's single precision is near overflow, and squared lengths overflow.
const GREATEST: f64 = 1e30;

/// Parses a number. `None` if the text is not a number, not finite or beyond 1e30.
pub fn parse_finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.abs() <= GREATEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_finite_is_no_number() {
        assert_eq!((parse_finite("-1.5"), parse_finite("1e9")), (Some(-1.5), Some(1e9)));
        for text in ["nan", "NaN", "-nan", "inf", "-Infinity", "1e999", "-1e999", "1e31", "", "x"] {
            assert_eq!(parse_finite(text), None, "{text}");
        }
    }
}
