//! Masks drawn as shapes: an SVG in the photograph's pixels, the inside of its shapes white.

use crate::drawing::{Mark, Painted};
use crate::geometry::{BezPath, Point, Region};
use crate::raster::Raster;
use crate::read::{Imported, SvgError, read_svg};
use crate::source::{Photograph, sha256};

/// The most pixels of a mask's longer side, and of a millimetre of its page: four for each pixel of the photograph.
const LONGEST: f64 = 4000.0;
const FINEST: f64 = 15.0;
/// How far outlines may be off, in pixels of the mask.
const TOLERANCE: f64 = 0.2;

/// Whether a file's first bytes are those of an SVG.
pub(super) fn is_svg(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(1000)];
    let text = String::from_utf8_lossy(start);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    text.starts_with("<svg") || (text.starts_with('<') && text.contains("<svg"))
}

/// The mask of an SVG's shapes, whatever their colour; white shapes take away from those below them.
pub(super) fn vector_mask(bytes: &[u8]) -> Result<Photograph, SvgError> {
    let imported = read_svg(bytes)?;
    let page = imported.page;
    let pixels_per_mm = (LONGEST / page.width.max(page.height)).min(FINEST);
    let [columns, rows] = [page.width, page.height].map(|side| (side * pixels_per_mm).round().max(1.0) as usize);
    let mask = drawn(&imported, columns, rows, pixels_per_mm);
    let mut photograph = Photograph::from_grey(&mask);
    photograph.info.format = "SVG";
    photograph.info.sha256 = sha256(bytes);
    Ok(photograph)
}

/// 255 inside the shapes, 0 elsewhere, in painting order.
fn drawn(imported: &Imported, columns: usize, rows: usize, pixels_per_mm: f64) -> Raster<u8> {
    let mut mask = Raster::filled(columns, rows, 0_u8);
    for painted in &imported.painting {
        let (outline, value) = match painted {
            Painted::Mark { layer, mark } => (outline(&imported.layers[*layer].layer.marks[*mark], pixels_per_mm), 255),
            Painted::White(outline) => (outline.clone(), 0),
        };
        paint(&mut mask, &outline, pixels_per_mm, value);
    }
    mask
}

fn outline(mark: &Mark, pixels_per_mm: f64) -> BezPath {
    match mark {
        Mark::Dot(dot) => dot.path(),
        Mark::Stroke(stroke) => stroke.ink_outline(TOLERANCE / pixels_per_mm),
        Mark::Area(area) => area.outline.clone(),
    }
}

fn paint(mask: &mut Raster<u8>, outline: &BezPath, pixels_per_mm: f64, value: u8) {
    let inside = Region::new(outline, TOLERANCE / pixels_per_mm);
    let row_of = |y: usize| (y as f64 + 0.5) / pixels_per_mm;
    let end = mask.width() as f64 / pixels_per_mm;
    for y in 0..mask.height() {
        let line = [Point::new(0.0, row_of(y)), Point::new(end, row_of(y))];
        for piece in inside.inside_of_line(&line) {
            let column = |at: f64| ((at * end * pixels_per_mm - 0.5).ceil().max(0.0) as usize).min(mask.width());
            let (Some((_, from)), Some((_, to))) = (piece.first(), piece.last()) else { continue };
            for x in column(*from)..column(*to) {
                mask.set(x, y, value);
            }
        }
    }
}
