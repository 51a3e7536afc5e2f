//! What is written is read back: SVG by usvg and `inspect`, HP-GL and G-code by drypoint's own readers.

use crate::any_style;
use crate::common;
use crate::machine_file;
use crate::rasterised;

use any_style::Order;
use common::{Sheet, sample, svg_of};
use drypoint::drawing::{Drawing, Layer, Mark, Page, Stroke};
use drypoint::geometry::{BezPath, Point, Rect, distance_to_segment};
use drypoint::interrupt::Interrupt;
use drypoint::order::{Direction, Effort};
use drypoint::plot::{InkModel, MountingError, Nibs, Plot, Profile, Strokes, Toolpath, lower, mount};
use drypoint::read::read_svg;
use machine_file::{read_back, written};
use rasterised::{Pixels, rasterised};
use std::sync::Arc;

/// Every photograph in `samples/`, its sheet, and parameters that make each kind of mark.
fn drawings() -> Vec<(&'static str, Arc<Drawing>)> {
    [
        ("astronaut.jpg", (90.0, 90.0), &[][..]),
        ("astronaut-cutout.png", (90.0, 90.0), &[("blob", "0.7")]),
        ("grace-hopper.jpg", (90.0, 105.469), &[]),
        ("chelsea.png", (90.0, 59.867), &[("pitch", "0.9")]),
        ("coffee.png", (90.0, 60.0), &[("blob", "0.3")]),
        ("raccoon.jpg", (90.0, 67.5), &[]),
        ("bust-light.png", (90.0, 120.0), &[("pitch", "0.9")]),
        ("bust-brown.png", (90.0, 120.0), &[("pitch", "0.9")]),
        ("bust-dark.png", (90.0, 120.0), &[]),
    ]
    .into_iter()
    .map(|(name, mm, set)| {
        let photo = sample(name);
        (name, Sheet { set, ..Sheet::new(&photo, mm) }.drawn_once())
    })
    .collect()
}

fn profile(name: &str) -> Profile {
    Profile::built_in(name).unwrap()
}

#[test]
fn svg_reads_back_with_the_same_marks_and_ink() {
    for (name, drawing) in drawings() {
        let imported = read_svg(svg_of(&drawing).as_bytes()).unwrap();
        assert!(imported.dropped.is_empty());
        assert!((imported.page.width - drawing.page.width).abs() < 1e-3);
        // Without the recipe a file counts as foreign; drypoint's own files keep the kinds of marks.
        let own =
            svg_of(&drawing).replace("</title>", "</title><metadata><r:recipe xmlns:r=\"urn:drypoint\">{}</r:recipe></metadata>");
        let imported = read_svg(own.as_bytes()).unwrap();
        for (layer, read) in drawing.layers.iter().zip(&imported.layers) {
            assert_eq!(read.counts(), layer.counts(), "{name}, {}", layer.name);
            let (ink, read_ink) = (layer.ink_mm2(), read.layer.ink_mm2());
            println!("{name}, {}: {ink:.2} mm2, read {read_ink:.2}", layer.name);
            assert!((read_ink / ink - 1.0).abs() <= 0.001, "{name}, {}: {ink} and {read_ink}", layer.name);
        }
    }
}

#[test]
fn svg_keeps_to_its_bytes() {
    for (name, drawing) in drawings() {
        let text = svg_of(&drawing);
        for line in text.lines().filter(|line| line.starts_with("<circle")) {
            assert!(line.len() < 48, "{name}: {line}");
        }
        let inside = text.split("-dots\"").nth(1).unwrap().split("</g>").next().unwrap();
        for line in inside.lines().filter(|line| line.starts_with("<path")) {
            assert!(line.len() < 250, "{name}: {} bytes: {line}", line.len());
        }
    }
}

/// Styles and looks that make each kind of mark, in one colour and in several.
const LOOKS: &[(&str, &[(&str, &str)])] = &[
    ("hedcut", &[]),
    ("hedcut", &[("blob", "0.6"), ("lines", "canny")]),
    ("grid", &[]),
    ("grid", &[("primitive", "tile")]),
    ("engrave", &[]),
    ("engrave", &[("ground", "black"), ("look", "engraving"), ("angle", "20")]),
    ("charcoal", &[]),
    ("glass", &[]),
    ("glass", &[("hairs", "0.6"), ("whirls", "3")]),
    ("glass", &[("colors", "mono")]),
];

/// Pixels per millimetre at which pictures are compared: a dot of 0.3 mm is six across.
const FINE: f64 = 20.0;

#[test]
fn svg_has_the_pixels_of_the_drawing_in_every_style() {
    let photo = sample("grace-hopper.jpg");
    for (style, set) in LOOKS {
        let drawing = Order::new(style, &photo, (32.0, 37.5), set).draw();
        let own = rasterised(&drawing, FINE);
        let (mean, far) = difference(&own, &resvg_pixels(&svg_of(&drawing), FINE));
        println!("{style} {set:?}: mean difference {mean:.5}, {far:.6} of the pixels off by more than a quarter");
        // resvg computes coverage in sixteenths, and files have a resolution of 0.001 mm.
        assert!(mean <= 0.01 && far <= 0.001, "{style} {set:?}: {mean} {far}");
    }
}

/// The comparison notices a mark that is missing, moved by a tenth of a millimetre or of another colour.
#[test]
fn a_changed_drawing_has_other_pixels() {
    let photo = sample("grace-hopper.jpg");
    let drawing = Order::new("grid", &photo, (32.0, 37.5), &[]).draw();
    let own = rasterised(&drawing, FINE);
    let mut changed = drawing.clone();
    let fewer = changed.layers[0].marks.len() - 5;
    changed.layers[0].marks.truncate(fewer);
    let moved = drawing.transformed(kurbo::Affine::translate((0.1, 0.0)));
    for (what, other) in [("five marks fewer", changed), ("moved", moved)] {
        let (mean, far) = difference(&own, &resvg_pixels(&svg_of(&other), FINE));
        println!("{what}: {mean:.5} {far:.6}");
        assert!(mean > 0.01 || far > 0.001, "{what}: {mean} {far}");
    }
}

fn resvg_pixels(svg: &str, pixels_per_mm: f64) -> Pixels {
    let tree = resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default()).unwrap();
    let scale = (pixels_per_mm * 25.4 / 96.0) as f32;
    let (width, height) = ((tree.size().width() * scale).round() as u32, (tree.size().height() * scale).round() as u32);
    let mut pixmap = resvg::tiny_skia::Pixmap::new(width, height).unwrap();
    pixmap.fill(resvg::tiny_skia::Color::WHITE);
    resvg::render(&tree, resvg::tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let rgb = pixmap.pixels().iter().map(|p| [p.red(), p.green(), p.blue()].map(|v| f32::from(v) / 255.0)).collect();
    Pixels { width: width as usize, height: height as usize, rgb }
}

/// Mean difference of two pictures over all channels, and the fraction of pixels with a channel that differs by more than a
/// quarter.
fn difference(a: &Pixels, b: &Pixels) -> (f64, f64) {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let (mut sum, mut far) = (0.0, 0.0);
    for (a, b) in a.rgb.iter().zip(&b.rgb) {
        let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).collect();
        sum += off.iter().sum::<f64>() / 3.0;
        far += f64::from(u8::from(off.iter().any(|off| *off > 0.25)));
    }
    (sum / a.rgb.len() as f64, far / a.rgb.len() as f64)
}

fn plotted(drawing: &Drawing) -> Plot {
    let mut plot = lower(drawing, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
    plot.order_paths(Point::ORIGIN, Effort::Fast, Direction::Either, 0.05);
    plot
}

fn distance(p: Point, path: &[Point]) -> f64 {
    let to_legs = path.windows(2).map(|w| distance_to_segment(p, w[0], w[1]));
    to_legs.fold(path[0].distance(p), f64::min)
}

/// Each path of the plot was drawn, in order, within `tolerance` millimetres; nothing else was.
fn assert_drawn(name: &str, plot: &Plot, motion: &Strokes, to_page: impl Fn(Point) -> Point, tolerance: f64) {
    let asked: Vec<&Toolpath> = plot.pens.iter().flat_map(|pen| &pen.paths).collect();
    assert_eq!(asked.len(), motion.paths.len(), "{name}");
    for (path, (_, drawn)) in asked.iter().zip(&motion.paths) {
        let drawn: Vec<Point> = drawn.iter().map(|p| to_page(*p)).collect();
        for p in &drawn {
            let near = distance(*p, path.points());
            assert!(near <= tolerance, "{name}: {p:?} was not asked for ({near} mm)");
        }
        for p in path.points() {
            let near = distance(*p, &drawn);
            assert!(near <= tolerance, "{name}: {p:?} is missing ({near} mm)");
        }
    }
    assert!(motion.ends_up, "{name}");
}

fn assert_inside(name: &str, motion: &Strokes, limits: Rect) {
    for p in &motion.visited {
        assert!(p.x >= limits.x0 && p.x <= limits.x1 && p.y >= limits.y0 && p.y <= limits.y1, "{name}: {p:?}");
    }
}

#[test]
fn gcode_and_hpgl_draw_what_was_asked_inside_the_machine() {
    for (name, drawing) in drawings() {
        let plot = plotted(&drawing);
        for machine in ["grbl-servo", "hp7475a"] {
            let profile = profile(machine);
            let mounting = mount(&profile, &plot.page).unwrap();
            mounting.check(&profile, &plot).unwrap();
            let motion = read_back(&written(&plot, &profile).unwrap(), &profile);
            let to_page = mounting.to_machine.inverse();
            assert_drawn(name, &plot, &motion, |p| to_page * p, 0.05);
            assert_inside(name, &motion, mounting.limits);
        }
    }
}

#[test]
fn what_does_not_fit_is_refused_with_its_distance() {
    let page = Page::new(310.0, 100.0);
    let mut layer = Layer::new("line", 1);
    layer.marks.push(Mark::Stroke(Stroke::even(BezPath::from_svg("M5,5 L307.25,50").unwrap(), 0.3)));
    let plot = lower(&Drawing { page, layers: vec![layer] }, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
    let grbl = profile("grbl-servo");
    let error = mount(&grbl, &page).unwrap().check(&grbl, &plot).unwrap_err();
    assert!(matches!(&error, MountingError::OutOfReach { excess, .. } if (excess - 7.25).abs() < 1e-6), "{error}");
    assert!(error.to_string().contains("7.25 mm beyond the upper x limit"), "{error}");
}
