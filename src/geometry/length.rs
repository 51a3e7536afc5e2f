//! Parses lengths as a user writes them: `12`, `12mm`, `1.2cm`, `0.5in`, `36pt`; sizes as `90x120mm`. For a drawing that is read,
//! pixels are a unit too: `48px`, 96 to the inch as in CSS.

use thiserror::Error;

/// Error of parsing a length or size.
#[derive(Debug, Error, PartialEq)]
pub enum LengthError {
    /// The text does not start with a number.
    #[error("'{0}' is not a length; write a number with mm, cm, in or pt, such as 0.6mm (without a unit it is mm)")]
    NotALength(String),
    /// Pixels where no drawing is read.
    #[error("'{0}' is in pixels, which have no fixed size here; write mm, cm, in or pt (px only where an SVG is read)")]
    Pixels(String),
    /// The number is NaN or infinite.
    #[error("'{0}' is not a finite length")]
    NotFinite(String),
    /// A size without an `x`.
    #[error("'{0}' is not a size; write width x height with a unit, such as 90x120mm")]
    NotASize(String),
}

/// Units and their length in millimetres.
const UNITS: [(&str, f64); 5] = [("mm", 1.0), ("cm", 10.0), ("in", 25.4), ("pt", 25.4 / 72.0), ("px", 25.4 / 96.0)];

/// Parses a length, in millimetres; the default unit is mm. May be negative. Pixels are refused.
///
/// ```
/// use drypoint::geometry::parse_length;
///
/// assert_eq!(parse_length("1in")?, 25.4);
/// assert_eq!(parse_length("0.3")?, 0.3);
/// assert!(parse_length("3px").is_err());
/// # Ok::<(), drypoint::geometry::LengthError>(())
/// ```
pub fn parse_length(text: &str) -> Result<f64, LengthError> {
    let value = parse_drawn_length(text)?;
    if text.trim().ends_with("px") { Err(LengthError::Pixels(text.to_owned())) } else { Ok(value) }
}

/// [`parse_length`] for a drawing that is read, where a pixel is 1/96 inch.
pub fn parse_drawn_length(text: &str) -> Result<f64, LengthError> {
    let trimmed = text.trim();
    let (number, scale) = split_unit(trimmed);
    let value: f64 = number.trim().parse().map_err(|_| LengthError::NotALength(text.to_owned()))?;
    if value.is_finite() { Ok(value * scale) } else { Err(LengthError::NotFinite(text.to_owned())) }
}

/// Parses width and height, in millimetres; a unit at the end applies to both: `90x120`, `9x12cm`, `100mm x 4in`. Pixels are
/// refused.
pub fn parse_size(text: &str) -> Result<(f64, f64), LengthError> {
    let size = parse_drawn_size(text)?;
    if text.contains("px") { Err(LengthError::Pixels(text.to_owned())) } else { Ok(size) }
}

/// [`parse_size`] for a sheet or a drawing that is read, where a pixel is 1/96 inch: `794x1123px`.
pub fn parse_drawn_size(text: &str) -> Result<(f64, f64), LengthError> {
    let (width, height) = halves(text.trim()).ok_or_else(|| LengthError::NotASize(text.to_owned()))?;
    let (_, scale) = split_unit(height.trim());
    let width_has_unit = UNITS.iter().any(|(unit, _)| width.trim().ends_with(unit));
    let width = parse_drawn_length(width)? * if width_has_unit { 1.0 } else { scale };
    Ok((width, parse_drawn_length(height)?))
}

/// The texts around the `x` of a size; the `x` of `px` does not count.
fn halves(text: &str) -> Option<(&str, &str)> {
    let (at, sign) = text.char_indices().find(|&(at, c)| matches!(c, 'x' | 'X' | '\u{d7}') && !text[..at].ends_with('p'))?;
    Some((&text[..at], &text[at + sign.len_utf8()..]))
}

fn split_unit(text: &str) -> (&str, f64) {
    UNITS.iter().find_map(|&(unit, scale)| text.strip_suffix(unit).map(|number| (number, scale))).unwrap_or((text, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units() {
        assert_eq!(parse_length("12"), Ok(12.0));
        assert_eq!(parse_length("-1.5 cm"), Ok(-15.0));
        assert_eq!(parse_length("1in"), Ok(25.4));
        assert!((parse_length("72pt").unwrap() - 25.4).abs() < 1e-12);
        assert!(matches!(parse_length("NaN"), Err(LengthError::NotFinite(_))));
        assert!(matches!(parse_length("wide"), Err(LengthError::NotALength(_))));
    }

    #[test]
    fn pixels_are_a_unit_where_a_drawing_is_read() {
        assert!((parse_drawn_length("96px").unwrap() - 25.4).abs() < 1e-12);
        assert!(matches!(parse_length("96px"), Err(LengthError::Pixels(_))));
        for text in ["96x192px", "96px x 192px", "96px x 2in", "96X192 px"] {
            let (width, height) = parse_drawn_size(text).unwrap();
            assert!((width - 25.4).abs() < 1e-12 && (height - 50.8).abs() < 1e-12, "{text}: {width} x {height}");
            assert!(matches!(parse_size(text), Err(LengthError::Pixels(_))), "{text}");
        }
        assert!(parse_drawn_size("96px").is_err() && parse_drawn_length("px").is_err());
    }

    #[test]
    fn sizes() {
        assert_eq!(parse_size("90x120"), Ok((90.0, 120.0)));
        assert_eq!(parse_size("9x12cm"), Ok((90.0, 120.0)));
        assert_eq!(parse_size("10mm x 1in"), Ok((10.0, 25.4)));
        assert!(matches!(parse_size("90"), Err(LengthError::NotASize(_))));
    }
}
