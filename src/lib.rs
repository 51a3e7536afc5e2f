//! **drypoint** turns a photograph into vector stroke art and takes it to ink.
//!
//! ```text
//! bytes --source--> Portrait --style--> Drawing --plot--> Plot --write--> SVG | HP-GL | G-code
//!                      |  ^                 \---press-------write--> SVG | PDF (print)
//!                      raster, field                          ^--read-- SVG
//! ```
//!
//! | module | in | out |
//! |---|---|---|
//! | [`source`] | bytes of an image | [`source::Portrait`]: light, tone, masks at a style's working resolution |
//! | [`see`] | a photograph | [`see::Sight`]: faces, their points, the person without the background, its regions, depth |
//! | [`tone`] | a portrait with faces | the target tone for its ink |
//! | [`raster`] | rasters | rasters: filters without other dependencies |
//! | [`field`] | rasters, curves | edges, isophotes, distances, lanes, Voronoi cells, traced lines |
//! | [`style`] | a portrait, parameters, a seed | [`drawing::Drawing`] |
//! | [`scene`] | masks, drawings in several styles | which point belongs to which region; the drawings confined to them |
//! | `colour` | a photograph's light, pens | the coverage of each pen, and the pen of each mark |
//! | [`drawing`] | | the stroke model: page, layers, dots, strokes, areas |
//! | [`geometry`] | | curves, clipping, areas, lengths |
//! | [`order`] | ends of paths, stops | the order with the least way between them |
//! | [`press`] | a drawing, a press's dot gain and smallest mark | the drawing to print, compensated to keep the tone |
//! | [`plot`] | a drawing, a machine's profile | [`plot::Job`]: ordered tool paths, checked; the machine's file, read back and resumed |
//! | [`mod@write`] | a drawing | bytes |
//! | `drive` (cargo feature) | a machine's file, a port | a drawing in ink, and a journal of it |
//! | [`read`] | SVG | a drawing |
//! | `cli` (cargo feature) | arguments | the only module that uses files, stdout and exit codes |
//! | [`mod@interrupt`] | | a request to stop, checked by all long loops |
//!
//! What is marked `#[doc(hidden)]` is for this crate's own tests and benches, and may change at any time.
//!
//! The page is in millimetres, x right, y down, from the sheet's upper left corner; pixels exist only left of [`style`]. Tone is
//! the fraction of paper left white. The same input, options and seed give the same bytes on any number of threads.
//!
//! ```
//! use drypoint::{source::*, style, geometry::Rect, drawing::Page};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let mut png = std::io::Cursor::new(Vec::new());
//! # image::DynamicImage::ImageLuma8(image::GrayImage::from_fn(40, 40, |x, _| image::Luma([x as u8 * 5])))
//! #     .write_to(&mut png, image::ImageFormat::Png)?;
//! # let bytes = png.into_inner();
//! let photograph = Photograph::decode(&bytes, Limits::default())?;
//! let hedcut = style::find("hedcut").ok_or("no such style")?;
//! let settings = style::Settings::resolve("hedcut", hedcut.parameters(), &[("pitch".into(), "1mm".into())])?;
//! let placement = Placement::new(Rect::new(0.0, 0.0, 30.0, 30.0), hedcut.pixels_per_mm(&settings, &[]));
//! let portrait = Portrait::new(
//!     &photograph, Crop::all(&photograph), Page::new(30.0, 30.0), placement, ToneTarget::Lightness, ToneCurve::default(),
//! )?;
//! let drawing = hedcut.draw(&portrait, &settings, 0, &style::Silent)?;
//! assert!(drawing.layers[0].ink_mm2() > 100.0);
//! # Ok(())
//! # }
//! ```

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod colour;
pub mod drawing;
#[cfg(feature = "drive")]
pub mod drive;
pub(crate) mod elementary;
pub mod field;
pub mod geometry;
pub mod interrupt;
pub mod order;
mod parallel;
pub mod plot;
pub mod press;
pub mod raster;
pub mod read;
pub mod scene;
pub mod see;
pub mod source;
#[cfg(feature = "studio")]
#[doc(hidden)]
pub mod studio;
pub mod style;
pub mod tone;
pub mod write;
