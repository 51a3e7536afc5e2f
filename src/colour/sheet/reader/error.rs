//! Why a picture of a sheet cannot be read, and what is doubtful about one that can.

use thiserror::Error;

/// Why a picture of the sheet cannot be read. The caller adds the file's name.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ReadError {
    /// Too few pixels, or a strip.
    #[error(
        "is {width} x {height} px, which is no photograph of a sheet; give one of at least {least} px on each side, 1500 or more if you can"
    )]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Least side in pixels.
        least: usize,
    },
    /// No four marks that belong together.
    #[error(
        "shows no colour sheet; photograph it from above, sharp and in even light, with all four ring marks in the picture and the sheet filling most of it"
    )]
    NoSheet,
    /// Three corner marks without the fourth.
    #[error(
        "shows only three of the sheet's four ring marks; take it again with all corners in the picture, uncovered, sharp and without glare"
    )]
    CutOff,
    /// The marks were found, but not the row of bars between them.
    #[error(
        "shows a colour sheet whose row of bars cannot be read; take it again, sharper, nearer and without glare on the bars"
    )]
    CodeUnreadable,
    /// A mirror image.
    #[error("is a mirror image; turn off mirroring in the camera (selfie mode), or flip the picture")]
    Mirrored,
    /// A sheet of another version of drypoint.
    #[error("shows a colour sheet of another version ({version}); draw a new one with this drypoint")]
    OtherVersion {
        /// Its number.
        version: u32,
    },
    /// A sheet for another set of pens.
    #[error("shows a sheet of {found} pens, but {expected} are given; give the pens that it was drawn with, or draw it anew")]
    WrongPens {
        /// Pens on the sheet.
        found: usize,
        /// Pens given.
        expected: usize,
    },
    /// A cell of the sheet has too few pixels.
    #[error(
        "shows the sheet too small: a patch has {have:.0} px, and {least:.0} are needed; go nearer, or do not scale the picture down"
    )]
    TooSmall {
        /// Pixels of a patch.
        have: f64,
        /// Pixels needed.
        least: f64,
    },
    /// Edges are so soft that patches and paper mix.
    #[error(
        "is blurred: edges on the sheet are {have:.1} mm wide, and {most:.1} mm would do; hold the camera still, focus on the sheet, wipe the lens"
    )]
    Blurred {
        /// Width of an edge in millimetres.
        have: f64,
        /// The most that would do.
        most: f64,
    },
    /// The paper is as bright as the file can tell.
    #[error("is over-exposed: {:.0} % of the bare paper is clipped; take it again one or two steps darker", 100.0 * share)]
    OverExposed {
        /// Share of the paper that is clipped, 0 to 1.
        share: f64,
    },
    /// The paper is too dark to measure ink on it.
    #[error("is too dark: bare paper has a level of {level:.0} of 255; take it again in more light or two steps brighter")]
    UnderExposed {
        /// sRGB level of the paper's brightest channel.
        level: f64,
    },
    /// Light on the sheet changes too abruptly.
    #[error(
        "is lit too unevenly: bare paper differs by {:.0} % from smooth light; keep your shadow and reflections off the sheet, or put it in the shade",
        100.0 * residual
    )]
    UnevenLight {
        /// Robust deviation of the paper's light from the smooth field, relative.
        residual: f64,
    },
}
