//! Why an SVG could not be read.

use super::budget::TooMuchWork;
use thiserror::Error;

/// Error of reading an SVG.
#[derive(Debug, Error)]
pub enum SvgError {
    /// Not text.
    #[error("is not an SVG: it is neither UTF-8 nor UTF-16 text")]
    NotText,
    /// Broken gzip.
    #[error("is not an SVG: it begins as gzip (.svgz) but cannot be decompressed")]
    Packed,
    /// Groups nested too deep; holds the limit.
    #[error("cannot be used as an SVG: its groups are nested more than {0} deep, uses and references included")]
    TooDeep(usize),
    /// Entities nested too deep.
    #[error("cannot be used as an SVG: its entities are nested more than 10 deep")]
    Entities,
    /// An element that is drawn within itself.
    #[error("cannot be used as an SVG: '{0}' refers back to itself, directly or through other elements")]
    Circle(String),
    /// More elements than usvg accepts.
    #[error(
        "cannot be used as an SVG: it has {0} elements with all uses expanded, and at most 1000000 can be read; join paths into one"
    )]
    Elements(f64),
    /// Broken XML.
    #[error("is not an SVG: {0}")]
    Xml(#[from] roxmltree::Error),
    /// Not SVG, or beyond usvg's limits.
    #[error("cannot be used as an SVG: {0}")]
    Svg(#[from] usvg::Error),
    /// Boxes that rounding makes empty or endless, which usvg cannot use.
    #[error(
        "cannot be used as an SVG: a pattern, mask or filter is too small or too large; give it a width and height near its object's"
    )]
    Boxes,
    /// Page size out of range; holds width and height in millimetres.
    #[error(
        "cannot be used as an SVG: its page is {0} x {1} mm, and sides must be from 0.001 mm to 100 m; change its width and height"
    )]
    Page(f64, f64),
    /// More work than the limit.
    #[error("cannot be used as an SVG: it {0}")]
    Work(#[from] TooMuchWork),
}
