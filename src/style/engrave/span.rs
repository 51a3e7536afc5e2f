//! A piece of a line inside its region.

/// A piece of a line inside its region, by position along it; whether each end is cut by the border, and the length left free between
/// each end and the border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub from: f64,
    pub to: f64,
    pub is_cut: [bool; 2],
    pub lacking: [f64; 2],
}
