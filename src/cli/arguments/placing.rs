//! Options for the position of a drawing on its sheet.

use super::choices::Rotate;
use super::values::place;
use clap::Args;

/// Position of a drawing: mirrored first, then turned, then moved.
#[derive(Args, Clone, Debug, Default)]
pub(in crate::cli) struct PlacingOptions {
    /// Centre on the sheet, or as near to the centre as the machine reaches.
    #[arg(long, conflicts_with = "at")]
    pub center: bool,
    /// Turn clockwise by degrees; sizes refer to the upright picture.
    #[arg(long, value_enum, allow_negative_numbers = true, default_value_t = Rotate::None)]
    pub rotate: Rotate,
    /// Mirror left to right, before turning.
    #[arg(long)]
    pub mirror: bool,
    /// Position of the upper left corner of the picture's box (with `plot`: of the drawing's box), from the sheet's upper left
    /// corner, such as 20,35mm.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub at: Option<(f64, f64)>,
}
