//! SVG as a drawing: usvg resolves the geometry; one pass over the XML finds the layers and kinds of marks.

use super::Dropped;
use super::budget::Budget;
use super::census::spend_parsing;
use super::clip_paths::FARTHEST;
use super::colour_names::with_known_colours;
use super::curves::MM_PER_PX;
use super::error::SvgError;
use super::expansion::spend_expansion;
use super::imported::ImportedLayer;
use super::importer::{Importer, Place};
use super::layers::{DEEPEST, LabelSpeeds, outline, with_ids};
use super::text::text_of;
use crate::drawing::{Drawing, Page, Painted};
use std::borrow::Cow;
use std::cell::Cell;
use std::panic::AssertUnwindSafe;

/// Minimum side of a sheet, in millimetres: files are written in thousandths, and a narrower sheet would be written as zero.
const NARROWEST: f64 = 0.0006;

/// An SVG as a drawing, and what was not read.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Its sheet.
    pub page: Page,
    /// Layers in painting order.
    pub layers: Vec<ImportedLayer>,
    /// Its marks from bottom to top, with the white areas between them.
    pub painting: Vec<Painted>,
    /// What was not read, by kind.
    pub dropped: Dropped,
    /// The recipe, if drypoint wrote the file.
    pub recipe: Option<String>,
    /// The meaning of its labels' speeds, if drypoint wrote them for a plotter.
    pub speeds: Option<LabelSpeeds>,
    /// True if it holds tool paths that drypoint wrote, which are never lowered again.
    pub is_toolpaths: bool,
}

impl Imported {
    /// The marks as a drawing.
    pub fn drawing(&self) -> Drawing {
        Drawing { page: self.page, layers: self.layers.iter().map(|l| l.layer.clone()).collect() }
    }
}

/// Reads an SVG. Layers are Inkscape's, with the conventions of their labels; marks outside them get one layer per colour.
///
/// ```
/// let svg = br#"<svg xmlns="http://www.w3.org/2000/svg" width="50mm" height="50mm" viewBox="0 0 50 50"><path d="M5,5H45" stroke="red"/></svg>"#;
/// let imported = drypoint::read::read_svg(svg)?;
/// assert!((imported.page.width - 50.0).abs() < 1e-4);
/// assert_eq!(imported.drawing().marks().count(), 1);
/// # Ok::<(), drypoint::read::SvgError>(())
/// ```
pub fn read_svg(bytes: &[u8]) -> Result<Imported, SvgError> {
    read_svg_within(bytes, &mut Budget::default())
}

/// [`read_svg`] with a given work limit.
pub fn read_svg_within(bytes: &[u8], budget: &mut Budget) -> Result<Imported, SvgError> {
    let given = text_of(bytes, budget)?;
    spend_parsing(&given, budget)?;
    let given = with_known_colours(&given);
    let document = parsed(&given)?;
    let outline = outline(&document).ok_or(SvgError::TooDeep(DEEPEST))?;
    let elements = spend_expansion(&document, budget)?;
    let (outline, tree) = match with_ids(&given, &document) {
        Cow::Borrowed(_) => (outline, tree_of(&document, elements)?),
        Cow::Owned(text) => {
            drop(outline);
            let document = parsed(&text)?;
            (super::layers::outline(&document).ok_or(SvgError::TooDeep(DEEPEST))?, tree_of(&document, elements)?)
        }
    };
    let page = Page::new(f64::from(tree.size().width()) * MM_PER_PX, f64::from(tree.size().height()) * MM_PER_PX);
    if page.width.max(page.height) > FARTHEST || page.width.min(page.height) < NARROWEST {
        return Err(SvgError::Page(page.width, page.height));
    }
    let mut importer = Importer::new(&outline, budget);
    importer.group(tree.root(), Place::TOP, &[])?;
    let is_toolpaths = importer.is_toolpaths;
    let (layers, painting, dropped) = importer.finish();
    Ok(Imported { page, layers, painting, dropped, recipe: outline.recipe.clone(), speeds: outline.speeds.clone(), is_toolpaths })
}

fn parsed(text: &str) -> Result<roxmltree::Document<'_>, SvgError> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    Ok(roxmltree::Document::parse_with_options(text, options)?)
}

/// usvg's tree. Images are counted from the XML: none is decoded, and no file beside this one is opened.
fn tree_of(document: &roxmltree::Document<'_>, elements: f64) -> Result<usvg::Tree, SvgError> {
    let none = usvg::ImageHrefResolver { resolve_data: Box::new(|_, _, _| None), resolve_string: Box::new(|_, _| None) };
    let options = usvg::Options { image_href_resolver: none, ..usvg::Options::default() };
    PARSES.set(true);
    // usvg panics on some boxes that rounding makes empty, such as a pattern of width 1e-45 (0.49, `bbox_transform`).
    let parsed = std::panic::catch_unwind(AssertUnwindSafe(|| usvg::Tree::from_xmltree(document, &options)));
    PARSES.set(false);
    let Ok(parsed) = parsed else { return Err(SvgError::Boxes) };
    parsed.map_err(|error| match error {
        usvg::Error::ParsingFailed(roxmltree::Error::NodesLimitReached) => SvgError::Elements(elements),
        other => SvgError::Svg(other),
    })
}

thread_local! {
    static PARSES: Cell<bool> = const { Cell::new(false) };
}

/// True while this thread is in usvg, whose panics are errors of the file.
#[cfg(feature = "cli")]
pub(crate) fn is_parsing() -> bool {
    PARSES.get()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Mark;

    fn read(body: &str) -> Imported {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
             xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='100mm' height='100mm' viewBox='0 0 100 100'>{body}</svg>"
        );
        read_svg(text.as_bytes()).unwrap()
    }

    #[test]
    fn a_pattern_that_rounding_makes_empty_is_an_error_of_the_file() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9' width='9mm' height='9mm'><pattern id='p' width='1e-45' \
                   height='1'><path d='M0 0h1'/></pattern><rect x='5' width='3' height='2' fill='url(#p)'/></svg>";
        assert!(matches!(read_svg(svg.as_bytes()), Err(SvgError::Boxes)), "{:?}", read_svg(svg.as_bytes()));
    }

    fn length(imported: &Imported) -> f64 {
        imported.drawing().marks().map(|m| if let Mark::Stroke(s) = m { s.length() } else { 0.0 }).sum()
    }

    #[test]
    fn layers_by_label_and_the_skipped_one() {
        let imported = read(
            "<g id='a' inkscape:groupmode='layer' inkscape:label='3 red'><path d='M0 0H10' stroke='red' fill='none'/></g>\
             <g id='b' inkscape:groupmode='layer' inkscape:label='% notes'><path d='M0 0H10' stroke='red'/></g>\
             <g id='c' inkscape:groupmode='layer' inkscape:label='hidden' style='display:none'><path d='M0 0H10' stroke='red'/></g>",
        );
        assert_eq!(imported.layers.len(), 1);
        assert_eq!((imported.layers[0].layer.pen, imported.layers[0].layer.name.as_str()), (3, "red"));
        assert_eq!(imported.layers[0].counts(), [0, 1, 0]);
    }

    #[test]
    fn layers_without_ids_and_layers_within_layers() {
        let imported = read(
            "<g inkscape:groupmode='layer' inkscape:label='2 red'><path d='M0 0H10' stroke='red'/>\
             <g inkscape:groupmode='layer' inkscape:label='% guide'><path d='M0 0H10' stroke='red'/></g>\
             <g inkscape:groupmode='layer' inkscape:label='4 inner'><path d='M0 0H10' stroke='red'/></g>\
             <g inkscape:groupmode='layer' inkscape:label='part'><path d='M0 5H10' stroke='red'/></g></g>\
             <g inkscape:groupmode='layer' inkscape:label='%skipped'><path d='M0 0H10' stroke='red'/></g>",
        );
        let layers: Vec<(u32, &str, usize)> =
            imported.layers.iter().map(|l| (l.layer.pen, l.layer.name.as_str(), l.layer.marks.len())).collect();
        assert_eq!(layers, [(2, "red", 2), (4, "inner", 1)]);
    }

    #[test]
    fn what_would_never_end_is_left_out_and_counted() {
        let dashed = read("<path d='M0 0H100' stroke='black' stroke-dasharray='1e-6 1e-6'/>");
        assert_eq!((dashed.layers[0].counts()[1], dashed.dropped.is_empty()), (1, false));
        let far = read("<path d='M0 0C1e30 1e30 2 2 3 3' stroke='black'/><path d='M0 0H1' stroke='black'/>");
        assert_eq!((far.layers[0].counts()[1], far.dropped.of("path beyond 100 m")), (1, 1));
        assert!(read("<g opacity='0'><path d='M0 0H10' stroke='black'/></g>").layers.is_empty());
    }

    #[test]
    fn colours_are_layers_where_there_are_none() {
        let imported = read("<path d='M0 0H10' stroke='red'/><path d='M0 5H10' stroke='blue'/><path d='M0 9H10' stroke='red'/>");
        let names: Vec<&str> = imported.layers.iter().map(|l| l.layer.name.as_str()).collect();
        assert_eq!(names, ["#ff0000", "#0000ff"]);
    }

    #[test]
    fn transforms_units_uses_and_dashes() {
        let imported = read(
            "<defs><path id='p' d='M0 0H10'/></defs><g transform='translate(5 5) scale(2)'><use xlink:href='#p' stroke='black' stroke-width='0.5'/></g>",
        );
        assert!((length(&imported) - 20.0).abs() < 1e-3);
        let Mark::Stroke(stroke) = &imported.layers[0].layer.marks[0] else { panic!() };
        assert!((stroke.widest() - 1.0).abs() < 1e-4);
        let dashed = read("<path d='M0 50H100' stroke='black' stroke-dasharray='10 10'/>");
        assert_eq!(dashed.layers[0].counts(), [0, 5, 0]);
        assert!((length(&dashed) - 50.0).abs() < 1e-3);
    }

    #[test]
    fn clip_paths_are_honoured() {
        let imported = read(
            "<clipPath id='c'><circle cx='50' cy='50' r='20'/></clipPath><g clip-path='url(#c)'><path d='M0 50H100' stroke='black'/></g>",
        );
        assert!((length(&imported) - 40.0).abs() < 0.02, "{}", length(&imported));
    }

    #[test]
    fn what_cannot_be_drawn_is_counted() {
        let imported = read(
            "<rect width='100' height='100' fill='white'/><text x='5' y='5'>hello</text>\
             <linearGradient id='g'><stop offset='0' stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient>\
             <rect width='10' height='10' fill='url(#g)'/><path d='M0 0H10' stroke='black'/>\
             <image width='10' height='10' xlink:href='data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=='/>",
        );
        assert_eq!(imported.dropped.of("white fill"), 1);
        assert_eq!(imported.dropped.of("text"), 1);
        assert_eq!(imported.dropped.of("gradient fill"), 1);
        assert_eq!(imported.dropped.of("image"), 1);
        assert_eq!(imported.layers.len(), 1);
    }

    #[test]
    fn colours_of_css_4_are_read() {
        let imported = read(
            "<path d='M0 0H10' stroke='rebeccapurple'/><g color='rebeccapurple'><path d='M0 9H10' style='stroke:currentcolor'/></g>",
        );
        assert_eq!(imported.layers.len(), 1);
        assert_eq!(imported.layers[0].layer.name, "#663399");
    }

    #[test]
    fn a_clip_path_of_any_size_clips_to_what_it_covers() {
        for shape in [
            "<circle r='1e15'/>",
            "<rect x='-1e20' y='-1e20' width='2e20' height='2e20'/>",
            "<rect x='-1e33' y='-1e33' width='2e33' height='2e33'/>",
            "<ellipse rx='1e9' ry='1e20'/>",
        ] {
            let imported =
                read(&format!("<clipPath id='c'>{shape}</clipPath><path clip-path='url(#c)' d='M0 50H100' stroke='black'/>"));
            assert!((length(&imported) - 100.0).abs() < 1e-3, "{shape}: {}", length(&imported));
        }
        let half = read(
            "<clipPath id='c'><rect x='50' y='-1e20' width='1e20' height='2e20'/></clipPath><path clip-path='url(#c)' d='M0 50H100' stroke='black'/>",
        );
        assert!((length(&half) - 50.0).abs() < 1e-3, "{}", length(&half));
    }

    #[test]
    fn a_clip_path_beyond_all_numbers_is_counted() {
        let far = "<clipPath id='c'><circle r='10'/></clipPath><g transform='scale(1e30)'><path clip-path='url(#c)' d='M0 0H50' stroke='black'/></g>";
        let endless = format!(
            "{}<path d='M0 0H1' stroke='black'/>{}",
            "<svg width='100' height='100' viewBox='0 0 1 1'>".repeat(100),
            "</svg>".repeat(100)
        );
        for body in [far, &endless] {
            let imported = read(&format!("{body}<path d='M0 0H10' stroke='black'/>"));
            assert!((length(&imported) - 10.0).abs() < 1e-3);
            assert!(!imported.dropped.is_empty(), "{body}");
        }
    }

    #[test]
    fn a_path_on_the_border_of_its_clip_is_whole() {
        for size in [1.0, 9.7, 33.3, 80.0] {
            for (unit, scale) in [("", 1.0), ("mm", 96.0 / 25.4), ("in", 96.0), ("px", 1.0)] {
                let frame = format!(
                    "<svg x='10' y='10' width='{size}{unit}' height='{size}{unit}'><rect width='{size}{unit}' height='{size}{unit}' fill='none' stroke='black'/></svg>"
                );
                let (imported, side) = (read(&frame), size * scale);
                assert!((length(&imported) / (4.0 * side) - 1.0).abs() < 1e-3, "{size}{unit}: {}", length(&imported));
            }
            let circle = format!("<circle cx='50' cy='50' r='{size}'");
            let imported =
                read(&format!("<clipPath id='c'>{circle}/></clipPath>{circle} fill='none' stroke='black' clip-path='url(#c)'/>"));
            let round = 2.0 * std::f64::consts::PI * size;
            assert!((length(&imported) / round - 1.0).abs() < 2e-3, "circle of {size}: {} of {round}", length(&imported));
        }
    }

    #[test]
    fn faults_are_named() {
        assert!(read_svg(b"\xff\x00").unwrap_err().to_string().contains("UTF-8"));
        let endless = b"<svg xmlns='http://www.w3.org/2000/svg' width='1e30mm' height='1mm'><path d='M0 0H9'/></svg>";
        assert!(read_svg(endless).unwrap_err().to_string().contains("100 m"));
        assert!(read_svg(b"<svg").is_err());
        assert!(read_svg(b"<html/>").is_err());
    }
}
