//! `drypoint calibrate`: test sheets of a machine and of its pens' colours.
//!
//! ```text
//!   --profile P               the machine's test sheet
//!   --colours PENS            the colour sheet of these pens
//!   --colours PENS --read P   a picture of that sheet -> the pens with their colours as measured
//! ```

mod colour_sheet;
mod machine;
mod measured_file;
mod pen_box;
mod reading;

use super::arguments::CalibrateOptions;
use super::failure::Failure;

pub(super) fn run(options: &CalibrateOptions) -> Result<(), Failure> {
    match (&options.colours, &options.read, &options.profile) {
        (Some(pens), Some(picture), _) => reading::run(options, pens, picture),
        (Some(pens), None, _) => colour_sheet::run(options, pens),
        (None, _, Some(profile)) => machine::run(options, profile),
        (None, _, None) => Err(Failure::Usage("give a machine with --profile, or pens with --colours".to_owned())),
    }
}
