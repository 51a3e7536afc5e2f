//! In every output format every curve stays in its mark's box: the box of its centre line, grown by half its greatest width.

use crate::machine_file;

use drypoint::drawing::{Drawing, Ends, Layer, Mark, Page, Stroke, Width};
use drypoint::geometry::{BezPath, Point, Rect, Ring, blob, catmull_rom};
use drypoint::order::{Direction, Effort};
use drypoint::plot::{InkModel, Nibs, Profile, lower, mount, write_inkml};
use drypoint::write::{SvgHead, write_pdf, write_svg};
use kurbo::{PathEl, PathSeg, Shape};
use machine_file::{read_back, written};
use proptest::prelude::*;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use std::io::Read;

/// Tolerance for rounding and flattening, in millimetres.
const ROOM: f64 = 0.012;
const PAGE: Page = Page::new(180.0, 180.0);

/// A stroke of random width through points from a thousandth of a millimetre to twenty millimetres apart, with sharp turns.
fn any_stroke() -> impl Strategy<Value = Mark> {
    let node = (-3.0_f64..1.3, -3.2_f64..3.2, -2.0_f64..0.9);
    (prop::collection::vec(node, 3..9), any::<bool>(), any::<bool>(), 0..3_u8).prop_map(|(nodes, is_closed, is_flat, kind)| {
        let (mut at, mut heading) = (Point::new(90.0, 90.0), 0.0_f64);
        let mut places = vec![at];
        for (leg, turn, _) in &nodes[1..] {
            heading += turn;
            at += kurbo::Vec2::from_angle(heading) * 10.0_f64.powf(*leg);
            places.push(at);
        }
        let curve = if kind == 2 { polyline(&places, is_closed) } else { catmull_rom(&places, is_closed.into()) };
        let count = curve.segments().count() + 1;
        let mut widths: Vec<f64> = nodes.iter().cycle().take(count).map(|(.., width)| 10.0_f64.powf(*width)).collect();
        if is_closed {
            widths[count - 1] = widths[0];
        }
        let width = if kind == 0 { Width::Constant(widths[0].min(3.0)) } else { Width::Along(widths) };
        let stroke = Stroke::even(curve, 0.0).with_width(width).unwrap();
        Mark::Stroke(stroke.with_ends(if is_flat { Ends::Flat } else { Ends::Round }))
    })
}

fn any_blob() -> impl Strategy<Value = Mark> {
    (0.02_f64..3.0, 0.0_f64..1.0, any::<u64>()).prop_map(|(radius, irregularity, seed)| {
        let centre = Point::new(90.0, 90.0);
        let outline = Some(Box::new(blob(centre, radius, irregularity, &mut ChaCha8Rng::seed_from_u64(seed))));
        Mark::Dot(drypoint::drawing::Dot { centre, radius, outline, colour: None })
    })
}

fn polyline(places: &[Point], is_closed: bool) -> BezPath {
    let mut path = BezPath::new();
    path.move_to(places[0]);
    places[1..].iter().for_each(|p| path.line_to(*p));
    if is_closed {
        path.close_path();
    }
    path
}

fn box_of(mark: &Mark) -> Rect {
    match mark {
        Mark::Stroke(stroke) => stroke.curve().bounding_box().inflate(0.5 * stroke.widest(), 0.5 * stroke.widest()),
        Mark::Dot(dot) => dot.path().bounding_box(),
        Mark::Area(area) => area.outline.bounding_box(),
    }
}

fn drawing_of(mark: &Mark) -> Drawing {
    Drawing { page: PAGE, layers: vec![Layer { marks: vec![mark.clone()], ..Layer::new("mark", 1) }] }
}

fn assert_within(what: &str, found: Rect, room: Rect) {
    let room = room.inflate(ROOM, ROOM);
    assert!(room.union(found) == room, "{what}: {found:?} is not in {room:?}");
}

/// The ink of an SVG's paths and circles.
fn svg_box(drawing: &Drawing) -> Rect {
    let mut bytes = Vec::new();
    write_svg(drawing, &SvgHead::default(), &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let mut ink: Option<Rect> = None;
    for node in document.descendants() {
        let width = || node.ancestors().find_map(|n| n.attribute("stroke-width")).map_or(0.0, |w| w.parse().unwrap());
        let number = |name| node.attribute(name).unwrap().parse::<f64>().unwrap();
        let found = match node.tag_name().name() {
            "path" => {
                let path = BezPath::from_svg(node.attribute("d").unwrap()).unwrap();
                assert_handles(&path);
                let half = 0.5 * width();
                path.bounding_box().inflate(half, half)
            }
            "circle" => kurbo::Circle::new((number("cx"), number("cy")), number("r")).bounding_box(),
            _ => continue,
        };
        ink = Some(ink.map_or(found, |ink| ink.union(found)));
    }
    ink.unwrap()
}

/// No handle is longer than its chord, except by rounding to 0.001 mm.
fn assert_handles(path: &BezPath) {
    for segment in path.segments() {
        if let PathSeg::Cubic(c) = segment {
            let (chord, handle) = (c.p0.distance(c.p3), c.p0.distance(c.p1).max(c.p2.distance(c.p3)));
            assert!(handle <= chord + 0.004, "a handle of {handle} on a chord of {chord}");
        }
    }
}

/// The ink of a PDF's content, in millimetres: its first matrix converts to points.
fn pdf_box(drawing: &Drawing) -> Rect {
    let mut bytes = Vec::new();
    write_pdf(drawing, &SvgHead::default(), None, &mut bytes).unwrap();
    let find = |from: usize, what: &[u8]| bytes[from..].windows(what.len()).position(|w| w == what).map(|at| from + at);
    let (mut at, mut content) = (0, String::new());
    while let Some(start) = find(at, b"stream\n").map(|start| start + 7) {
        let end = find(start, b"endstream").unwrap();
        let mut text = Vec::new();
        if flate2::read::ZlibDecoder::new(&bytes[start..end]).read_to_end(&mut text).is_ok() {
            content.push_str(&String::from_utf8_lossy(&text));
        }
        at = end + 9;
    }
    let (mut path, mut ink, mut half, mut is_first) = (BezPath::new(), None::<Rect>, 0.0, true);
    let (mut matrix, mut numbers) = (kurbo::Affine::IDENTITY, Vec::<f64>::new());
    for word in content.split_whitespace() {
        if let Ok(number) = word.parse::<f64>() {
            numbers.push(number);
            continue;
        }
        let point = |i: usize| matrix * Point::new(numbers[i], numbers[i + 1]);
        match word {
            "cm" if is_first => is_first = false,
            "cm" => matrix = kurbo::Affine::new(numbers[..6].try_into().unwrap()),
            "Q" => matrix = kurbo::Affine::IDENTITY,
            "w" => half = 0.5 * numbers[0],
            "m" => path.move_to(point(0)),
            "l" => path.line_to(point(0)),
            "c" => path.curve_to(point(0), point(2), point(4)),
            "h" => path.close_path(),
            "f" | "S" | "s" => {
                let grown = if word == "f" { 0.0 } else { half };
                let found = path.bounding_box().inflate(grown, grown);
                ink = Some(ink.map_or(found, |ink| ink.union(found)));
                path = BezPath::new();
            }
            _ => {}
        }
        numbers.clear();
    }
    ink.unwrap()
}

/// The ink of an `InkML` file: each vertex with half its brush width at its force.
fn inkml_box(drawing: &Drawing) -> Option<Rect> {
    let mut bytes = Vec::new();
    write_inkml(drawing, "", &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let width_of = |reference: &str| -> f64 {
        let brush = document
            .descendants()
            .find(|n| n.attributes().any(|a| a.name() == "id" && format!("#{}", a.value()) == reference))
            .unwrap();
        brush.children().find(|n| n.attribute("name") == Some("width")).unwrap().attribute("value").unwrap().parse().unwrap()
    };
    let traces = document.descendants().filter(|n| n.has_tag_name(("http://www.w3.org/2003/InkML", "trace")));
    let boxes = traces.flat_map(|trace| {
        let brush = trace.ancestors().find_map(|n| n.attribute("brushRef")).unwrap();
        let width = width_of(brush);
        let vertices: Vec<Rect> = trace
            .text()
            .unwrap()
            .split(',')
            .map(|vertex| {
                let v: Vec<f64> = vertex.split_whitespace().map(|v| v.parse().unwrap()).collect();
                let half = 0.5 * width * v[2] / 1000.0;
                Rect::new(v[0] - half, v[1] - half, v[0] + half, v[1] + half)
            })
            .collect();
        vertices
    });
    boxes.reduce(|a, b| a.union(b))
}

fn path_box(points: impl Iterator<Item = Point>) -> Option<Rect> {
    points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))
}

/// Pen-down moves in the files for two machines.
fn toolpath_boxes(drawing: &Drawing) -> Vec<Rect> {
    let mut plot = lower(drawing, InkModel::Ink, &Nibs::all(0.3), 0.01, &drypoint::interrupt::Interrupt::never()).unwrap();
    plot.order_paths(Point::ORIGIN, Effort::Fast, Direction::Either, 0.01);
    if plot.pens.iter().all(|pen| pen.paths.is_empty()) {
        return Vec::new();
    }
    let own = plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(|path| path.points().iter().copied());
    let mut boxes: Vec<Rect> = path_box(own).into_iter().collect();
    for machine in ["grbl-servo", "hp7475a"] {
        let profile = Profile::built_in(machine).unwrap();
        let mounting = mount(&profile, &plot.page).unwrap();
        let drawn = read_back(&written(&plot, &profile).unwrap(), &profile);
        let to_page = mounting.to_machine.inverse();
        boxes.extend(path_box(drawn.paths.iter().flat_map(|(_, path)| path).map(|p| to_page * *p)));
    }
    boxes
}

fn check(mark: &Mark) {
    let (room, drawing) = (box_of(mark), drawing_of(mark));
    assert_within("SVG", svg_box(&drawing), room);
    assert_within("PDF", pdf_box(&drawing), room);
    if let Some(ink) = inkml_box(&drawing) {
        // Traces are flattened to 0.02 mm, and brushes that fill a tiny mark have a minimum width.
        assert_within("InkML", ink, room.inflate(0.02, 0.02));
    }
    for ink in toolpath_boxes(&drawing) {
        // Tolerance for a plotter's step and the arcs fitted to the path.
        assert_within("tool paths", ink, room.inflate(0.03, 0.03));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn strokes_stay_in_their_box(mark in any_stroke()) {
        check(&mark);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn blobs_stay_in_their_box(mark in any_blob()) {
        check(&mark);
    }
}

/// A ribbon as glass makes it where the flow whirls: a wide stroke whose line turns within a quarter of its width. Its outline
/// once had a handle of 127 mm on a chord of 1.4 mm.
#[test]
fn a_whirl_s_stroke_throws_no_spike() {
    let places: Vec<Point> = (0..14)
        .map(|i| {
            let angle = f64::from(i) * 0.9;
            Point::new(90.0, 90.0) + kurbo::Vec2::from_angle(angle) * (0.4 + 0.02 * f64::from(i))
        })
        .collect();
    let widths = (0..14).map(|i| 3.0 - 0.1 * f64::from(i)).collect();
    check(&Mark::Stroke(Stroke::swelling(catmull_rom(&places, Ring::Open), widths).unwrap()));
}

/// Paintings of whole photographs, in which spikes were found.
#[test]
fn no_stroke_of_a_painting_leaves_its_box() {
    use drypoint::source::{Crop, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
    use drypoint::style::{Settings, Silent, find};
    let bytes = std::fs::read(format!("{}/samples/bust-light.png", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let photograph = Photograph::decode(&bytes, Limits::default()).unwrap();
    let style = find("glass").unwrap();
    for pitch in ["0.6", "3"] {
        let settings = Settings::resolve("glass", style.parameters(), &[("pitch".to_owned(), pitch.to_owned())]).unwrap();
        let picture = Rect::new(0.0, 0.0, 90.0, 120.0);
        let placement = Placement::new(picture, style.resolution(&settings, &[], picture));
        let (crop, page) = (Crop::all(&photograph), Page::new(90.0, 120.0));
        let portrait = Portrait::new(&photograph, crop, page, placement, ToneTarget::Lightness, ToneCurve::default()).unwrap();
        let drawing = style.draw(&portrait, &settings, 0, &Silent).unwrap();
        for mark in drawing.marks() {
            let Mark::Stroke(stroke) = mark else { continue };
            assert_handles(stroke.curve());
            let outline = stroke.ink_outline(0.002);
            if matches!(stroke.width(), Width::Along(_)) {
                assert_handles(&outline);
            }
            assert_within("painting", outline.bounding_box(), box_of(mark));
            let sum = outline.elements().iter().filter_map(PathEl::end_point).fold(0.0, |sum, p| sum + p.x);
            assert!(sum.is_finite());
        }
    }
}
