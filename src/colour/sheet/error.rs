//! Why there is no sheet, or why a picture of one cannot be read.

use thiserror::Error;

/// Why a sheet cannot be laid out.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SheetError {
    /// No pens, too many, or the darkest is not among them.
    #[error("the colour sheet takes 1 to {most} pens, one of which draws its marks, not {given}; leave some out")]
    PenCount {
        /// Number of pens given.
        given: usize,
        /// Most pens on a sheet.
        most: usize,
    },
    /// A nib that nothing can be drawn with.
    #[error("a nib of {nib} mm cannot draw the colour sheet; give its width, {least} to {most} mm")]
    Nib {
        /// Its width in millimetres.
        nib: f64,
        /// Least width in millimetres.
        least: f64,
        /// Largest width in millimetres.
        most: f64,
    },
    /// The sheet does not fit onto the page.
    #[error(
        "the colour sheet needs {:.0} x {:.0} mm with this margin and a nib of {broadest} mm, but the page has {:.0} x {:.0} mm; take a larger page or leave out the broadest pen",
        needed[0], needed[1], page[0], page[1]
    )]
    PageTooSmall {
        /// Width and height of the page in millimetres.
        page: [f64; 2],
        /// Width and height that an upright page needs, in millimetres.
        needed: [f64; 2],
        /// The broadest nib in millimetres.
        broadest: f64,
    },
}
