//! The colour sheet: patches of every pen, drawn by the plotter, photographed, and read as the pens' measured colours.
//!
//! ```text
//!   PenSheet::new(page, margin, nibs, darkest) -> marks() -> a drawing -> the plotter -> a photograph
//!   photograph -> corner marks -> perspective -> light on bare paper -> patches / light -> colours relative to paper
//! ```
//!
//! ```text
//! use drypoint::colour::sheet::{Known, PenSheet, Picture, read_sheet};
//! use drypoint::raster::Raster;
//!
//! let nibs = [0.3, 0.3, 0.5];
//! let marks = PenSheet::new([210.0, 297.0], 10.0, &nibs, 2)?.marks();
//! // Plotted, photographed, and then:
//! let reading = read_sheet(Picture::Encoded(photograph), &Known { nibs: &nibs, paper: None, grey: None })?;
//! let inks: Vec<_> = reading.pens.iter().map(|pen| pen.solid.lab).collect();
//! assert!(reading.warnings.is_empty() && inks.len() == nibs.len());
//! ```

mod code;
mod error;
mod grid;
mod lab;
mod layout;
mod reader;

pub use error::SheetError;
pub use layout::{PenSheet, SheetMark, SheetRole, SheetShape};
pub use reader::{
    Known, Measured, PairReading, PenReading, Picture, Quality, RampStep, ReadError, ReadWarning, SheetReading, read_sheet,
    rectified,
};
