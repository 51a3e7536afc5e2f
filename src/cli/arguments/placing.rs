//! Options that say where a drawing lies on its sheet.

use super::choices::Rotate;
use super::values::place;
use clap::Args;

/// Where a drawing lies: mirrored first, then turned, then moved.
#[derive(Args, Clone, Debug, Default)]
pub(in crate::cli) struct PlacingOptions {
    /// To the middle of the sheet, or as near to it as the machine reaches.
    #[arg(long, conflicts_with = "at")]
    pub center: bool,
    /// Turn clockwise by degrees; sizes are told of the upright picture.
    #[arg(long, value_enum, allow_negative_numbers = true, default_value_t = Rotate::None)]
    pub rotate: Rotate,
    /// Mirror, left for right, before it is turned.
    #[arg(long)]
    pub mirror: bool,
    /// Where the upper left corner of the picture's box (of `plot`: of the drawing's) lies, from the sheet's upper left corner, such
    /// as 20,35mm.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub at: Option<(f64, f64)>,
}
