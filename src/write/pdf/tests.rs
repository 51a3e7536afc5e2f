use super::*;
use crate::drawing::{Area, Dot, Ink, Layer, Mark, Mixing, Page, Stroke};
use crate::geometry::{BezPath, Point};

fn written(drawing: &Drawing, seconds: Option<u64>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let head = SvgHead { title: "A & B".into(), description: "a test".into(), recipe: "{\"seed\":1}".into() };
    write_pdf(drawing, &head, seconds, &mut bytes).unwrap();
    bytes
}

fn drawing(ink: Ink) -> Drawing {
    let mut layer = Layer::new("dots", 1);
    layer.ink = ink;
    layer.marks.push(Mark::Dot(Dot::circle(Point::new(1.5, 2.25), 0.123_45)));
    layer.marks.push(Mark::Stroke(Stroke::even(BezPath::from_svg("M0,0 L10,0 C10,1 9,2 8,2").unwrap(), 0.3)));
    layer.marks.push(Mark::Area(Area { outline: BezPath::from_svg("M0,0 Q3,0 3,3 Z").unwrap(), colour: Some(Colour::WHITE) }));
    Drawing { page: Page::new(90.0, 120.0), layers: vec![layer] }
}

fn content_of(drawing: &Drawing) -> String {
    Content::of(drawing, &Inks::of(&drawing.layers), POINTS_PER_MM).pieces.concat()
}

#[test]
fn the_content_is_short_and_in_black_only() {
    let text = content_of(&drawing(Ink::Black));
    assert!(text.contains("0 g 0 G\nq .1235 0 0 .1235 1.5 2.25 cm 1 0 m"), "{text}");
    assert!(text.contains(".3 w 1 J 0 0 m 10 0 l 10 1 9 2 8 2 c S\n"), "{text}");
    assert!(text.contains("1 g 1 G\n0 0 m 2 0 3 1 3 3 c h f"), "{text}");
    assert!(!text.contains("rg") && !text.contains("gs"));
}

#[test]
fn a_spot_ink_prints_over_unless_its_layer_is_opaque() {
    let mut spot = drawing(Ink::Spot { name: "PANTONE 286 C".into(), shown: Colour::BLACK });
    let text = content_of(&spot);
    assert!(text.contains("/O gs /S0 cs 1 scn /S0 CS 1 SCN") && text.contains("/K gs 1 g"), "{text}");
    spot.layers[0].mixing = Mixing::Paint;
    assert!(!content_of(&spot).contains("/O gs"));
    let bytes = String::from_utf8_lossy(&written(&spot, None)).into_owned();
    assert!(bytes.contains("/Separation /PANTONE#20286#20C /DeviceGray"), "{bytes}");
}

#[test]
fn a_duotone_has_two_plates_that_overprint_and_a_colour_of_its_own() {
    let warm = Ink::Spot { name: "Warm Red".into(), shown: Colour { r: 255, g: 51, b: 51 } };
    let mut duotone = drawing(warm);
    duotone.layers.extend(drawing(Ink::Black).layers);
    let text = content_of(&duotone);
    assert!(text.contains("/O gs /S0 cs 1 scn /S0 CS 1 SCN") && text.contains("/O gs 0 g 0 G"), "{text}");
    let bytes = String::from_utf8_lossy(&written(&duotone, None)).into_owned();
    assert!(bytes.contains("/Separation /Warm#20Red /DeviceRGB") && bytes.contains("/C1 [1 0.2 0.2]"), "{bytes}");
    assert!(!bytes.contains("/Group"));
}

#[test]
fn colours_are_multiplied_layer_by_layer() {
    let colour = |r, g, b| Ink::Colour(Colour { r, g, b });
    let mut inks = drawing(colour(0, 160, 220));
    assert!(!String::from_utf8_lossy(&written(&inks, None)).contains("/Group"), "one ink has nothing to mix with");
    inks.layers.extend(drawing(colour(240, 220, 0)).layers);
    let text = content_of(&inks);
    assert!(text.contains("/M gs /G0 Do") && text.contains("/M gs /G1 Do") && !text.contains("rg"), "{text}");
    let bytes = String::from_utf8_lossy(&written(&inks, None)).into_owned();
    assert!(bytes.contains("/BM /Multiply") && bytes.matches("/Subtype /Form").count() == 2, "{bytes}");
    inks.layers[1].mixing = Mixing::Paint;
    assert!(content_of(&inks).contains("/L1 BDC\nq\n.9412 .8627 0 rg"));
}

#[test]
fn the_head_is_in_the_file_and_no_clock() {
    let bytes = String::from_utf8_lossy(&written(&drawing(Ink::Black), None)).into_owned();
    assert!(
        bytes.contains("/MediaBox [0 0 255.1181 340.15747]") && bytes.contains("/TrimBox [0 0 255.1181 340.15747]"),
        "{bytes}"
    );
    assert!(bytes.contains("{\"seed\":1}</drypoint:recipe>") && bytes.contains("A &amp; B"));
    assert!(!bytes.contains("CreationDate") && !bytes.contains("CreateDate"));
    let dated = String::from_utf8_lossy(&written(&drawing(Ink::Black), Some(951_827_696))).into_owned();
    assert!(dated.contains("(D:20000229123456Z)") && dated.contains("2000-02-29T12:34:56Z"), "{dated}");
}

#[test]
fn a_very_large_sheet_has_larger_units() {
    let mut large = drawing(Ink::Black);
    large.page = Page::new(8000.0, 10_000.0);
    let bytes = String::from_utf8_lossy(&written(&large, None)).into_owned();
    assert!(bytes.contains("/UserUnit 2"), "{bytes}");
}

#[test]
fn the_unit_disc_has_the_area_of_a_disc() {
    let k = 0.551_785;
    let quarter = kurbo::CubicBez::new((1.0, 0.0), (1.0, k), (k, 1.0), (0.0, 1.0));
    let area = 4.0 * kurbo::ParamCurveArea::signed_area(&quarter);
    assert!((area / std::f64::consts::PI - 1.0).abs() < 1e-5, "{area}");
}
