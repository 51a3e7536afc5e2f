//! One nib lays down the requested ink, and no more.

use crate::common;
use crate::machine_file;

use common::{Sheet, mean_in, rendered, sample, svg_of, wedge, wedge_patches};
use drypoint::drawing::{Area, Colour, Dot, Drawing, Ends, Layer, Mark, Page, Stroke, Width};
use drypoint::field::nearest_seed;
use drypoint::geometry::{BezPath, Point, Rect};
use drypoint::interrupt::Interrupt;
use drypoint::plot::{InkModel, Nibs, Toolpath, coverage, lower};
use drypoint::raster::Raster;
use drypoint::source::{MaskRole, ToneTarget};
use machine_file::picture as plot_svg;
use proptest::prelude::*;

const PIXELS_PER_MM: f64 = 40.0;
const NIBS: [f64; 4] = [0.1, 0.3, 0.5, 0.8];

/// Every sample photograph, with the size of its test sheet in millimetres, its pitch and other settings.
type Sample = (&'static str, (f64, f64), &'static [(&'static str, &'static str)]);
const SAMPLES: [Sample; 9] = [
    ("astronaut.jpg", (50.0, 50.0), &[("pitch", "1.2")]),
    ("astronaut-cutout.png", (50.0, 50.0), &[("pitch", "1.0")]),
    ("grace-hopper.jpg", (60.0, 70.3), &[("pitch", "1.2"), ("outline_width", "1mm")]),
    ("chelsea.png", (75.0, 49.889), &[("pitch", "1.6"), ("blob", "0.5")]),
    ("coffee.png", (60.0, 40.0), &[("pitch", "1.0")]),
    ("raccoon.jpg", (60.0, 45.0), &[("pitch", "1.4")]),
    ("bust-light.png", (45.0, 60.0), &[("pitch", "0.9")]),
    ("bust-brown.png", (45.0, 60.0), &[("pitch", "1.2")]),
    ("bust-dark.png", (45.0, 60.0), &[("pitch", "1.0"), ("blob", "0.4")]),
];

/// The drawing for a nib. A net of holes with threads thinner than the nib is not a wide mark, so darks stay dots there.
fn drawing_for(nib: f64, (name, mm, set): Sample) -> Drawing {
    let pitch: f64 = set[0].1.parse().unwrap();
    if nib > 0.6 * pitch {
        let dots = [set, &[("reversed_from", "1")]].concat();
        return drawn(name, mm, &dots);
    }
    drawn(name, mm, set)
}

fn drawing_of((name, mm, set): Sample) -> Drawing {
    drawn(name, mm, set)
}

fn drawn(name: &str, mm: (f64, f64), set: &[(&str, &str)]) -> Drawing {
    let photo = sample(name);
    let mask = sample("grace-hopper-subject.png");
    let masks: &[(MaskRole, &[u8])] = if name.starts_with("grace") { &[(MaskRole::Subject, &mask)] } else { &[] };
    Sheet { set, masks, ..Sheet::new(&photo, mm) }.draw()
}

/// Marked pixels of what resvg prints.
fn ink(svg: &str) -> Raster<u8> {
    rendered(svg, PIXELS_PER_MM).map(|white| u8::from(white < 0.5))
}

/// Pixels within `radius` of a marked one.
fn grown(marked: &Raster<u8>, radius: f64) -> Raster<u8> {
    let Some(nearest) = nearest_seed(marked) else { return marked.clone() };
    let width = marked.width();
    Raster::from_fn(width, marked.height(), |x, y| {
        let seed = nearest.get(x, y) as usize;
        let (dx, dy) = ((seed % width) as f64 - x as f64, (seed / width) as f64 - y as f64);
        u8::from(dx.hypot(dy) <= radius)
    })
}

/// The ink that a disc of this radius can cover without leaving it.
fn opened(marked: &Raster<u8>, radius: f64) -> Raster<u8> {
    let eroded = grown(&marked.map(|v| 1 - v), radius).map(|v| 1 - v);
    grown(&eroded, radius)
}

fn marked(raster: &Raster<u8>) -> f64 {
    raster.pixels().iter().filter(|v| **v != 0).count() as f64
}

fn common_pixels(a: &Raster<u8>, b: &Raster<u8>) -> f64 {
    a.pixels().iter().zip(b.pixels()).filter(|(a, b)| **a != 0 && **b != 0).count() as f64
}

/// A drawing's marks that are as wide as the nib somewhere, or all others.
fn only(drawing: &Drawing, nib: f64, wide: bool) -> Drawing {
    let is_wide = |mark: &Mark| match mark {
        Mark::Dot(dot) => dot.radius >= 0.5 * nib,
        Mark::Stroke(stroke) => stroke.widest() >= nib,
        Mark::Area(_) => true,
    };
    let mut part = drawing.clone();
    part.layers.iter_mut().for_each(|layer| layer.marks.retain(|mark| is_wide(mark) == wide));
    part
}

/// Covered and spilt fractions of the marks that are at least a nib wide.
fn measure(drawing: &Drawing, nib: f64) -> Option<(f64, f64)> {
    let wide = only(drawing, nib, true);
    if wide.marks().count() < 20 {
        return None;
    }
    let asked = ink(&svg_of(&wide));
    let laid = ink(&plot_svg(&lower(&wide, InkModel::Ink, &Nibs::all(nib), 0.01, &Interrupt::never()).unwrap()));
    let reachable = opened(&asked, 0.5 * nib * PIXELS_PER_MM);
    let spilt = common_pixels(&laid, &asked.map(|v| 1 - v));
    Some((common_pixels(&reachable, &laid) / marked(&reachable), spilt / marked(&asked)))
}

/// Both drawings of each sample, each measured once: with darks as dots where the nib is too wide for a net, and as they are.
#[test]
fn the_nib_covers_what_it_can_reach_nets_finer_than_itself_too_and_spills_little() {
    for sample in SAMPLES {
        let whole = drawing_of(sample);
        for nib in NIBS {
            let dots = drawing_for(nib, sample);
            let drawings = if dots == whole { vec![&whole] } else { vec![&whole, &dots] };
            for drawing in drawings {
                let Some((covered, spilt)) = measure(drawing, nib) else { continue };
                println!("{}, nib {nib}: covered {covered:.4}, spilt {spilt:.4}", sample.0);
                assert!(covered >= 0.985, "{}, nib {nib}: covered {covered}", sample.0);
                assert!(spilt <= 0.03, "{}, nib {nib}: spilt {spilt}", sample.0);
            }
        }
    }
}

/// Marks narrower than the nib keep the mean tone in windows of three pitches (of the thinned marks, if the nib is large: a
/// window must hold several touches).
#[test]
fn marks_narrower_than_the_nib_keep_the_tone() {
    for sample in SAMPLES {
        let drawing = drawing_of(sample);
        let pitch: f64 = sample.2[0].1.parse().unwrap();
        for nib in NIBS {
            let thin = only(&drawing, nib, false);
            if thin.marks().count() < 20 {
                continue;
            }
            let asked = rendered(&svg_of(&thin), 12.0);
            let laid =
                rendered(&plot_svg(&lower(&thin, InkModel::Ink, &Nibs::all(nib), 0.01, &Interrupt::never()).unwrap()), 12.0);
            let window = 3.0 * pitch;
            let (mut sum, mut count, mut signed) = (0.0, 0.0, 0.0);
            let (columns, rows) = ((thin.page.width / window) as usize, (thin.page.height / window) as usize);
            for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
                let (x, y) = (column as f64 * window, row as f64 * window);
                let rect = Rect::new(x, y, x + window, y + window);
                let error = mean_in(&laid, rect, 12.0) - mean_in(&asked, rect, 12.0);
                sum += error.abs();
                signed += error;
                count += 1.0;
            }
            println!("{}, nib {nib}: mean {:.4}, bias {:+.4} in {count} windows", sample.0, sum / count, signed / count);
            assert!(sum / count <= 0.03, "{}, nib {nib}: {}", sample.0, sum / count);
        }
    }
}

#[test]
fn a_lowered_wedge_keeps_its_tones() {
    let photo = wedge();
    let drawing = Sheet { tone: ToneTarget::Linear, set: &[("highlights", "off")], ..Sheet::new(&photo, (60.0, 60.0)) }.draw();
    let printed =
        rendered(&plot_svg(&lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.01, &Interrupt::never()).unwrap()), PIXELS_PER_MM);
    for (rect, tone) in wedge_patches() {
        let found = mean_in(&printed, rect, PIXELS_PER_MM);
        println!("tone {tone:.1}: {:+.4}", found - tone);
        assert!((found - tone).abs() <= 0.025, "{tone}: {found}");
    }
}

#[test]
fn the_report_s_coverage_is_what_is_seen() {
    let drawing = drawing_of(SAMPLES[2]);
    for nib in [0.3, 0.8] {
        let nibs = Nibs::all(nib);
        let plot = lower(&drawing, InkModel::Ink, &nibs, 0.01, &Interrupt::never()).unwrap();
        let reported = coverage(&drawing, &plot, &nibs, &Interrupt::never()).unwrap()[0];
        let (asked, laid) = (ink(&svg_of(&drawing)), ink(&plot_svg(&plot)));
        let covered = common_pixels(&asked, &laid) / marked(&asked);
        let spilt = common_pixels(&laid, &asked.map(|v| 1 - v)) / marked(&asked);
        println!("nib {nib}: {:.4} {:.4}, seen {covered:.4} {spilt:.4}", reported.covered_fraction(), reported.spill_fraction());
        assert!((reported.covered_fraction() - covered).abs() < 0.01 && (reported.spill_fraction() - spilt).abs() < 0.01);
    }
}

/// A coordinate on the page, sometimes exactly equal to another or at the border.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![5 => 0.0..60.0, 1 => Just(30.0), 1 => Just(0.0), 1 => Just(60.0)]
}

fn point() -> impl Strategy<Value = Point> {
    (coordinate(), coordinate()).prop_map(|(x, y)| Point::new(x, y))
}

fn length() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.01..3.0, 1 => Just(0.0), 1 => 3.0..20.0]
}

fn path(points: &[Point], closed: bool) -> BezPath {
    let mut path = BezPath::new();
    path.move_to(points[0]);
    points[1..].iter().for_each(|p| path.line_to(*p));
    if closed {
        path.close_path();
    }
    path
}

fn mark() -> impl Strategy<Value = Mark> {
    let dot = (point(), length()).prop_map(|(centre, radius)| Mark::Dot(Dot::circle(centre, radius)));
    let stroke = (prop::collection::vec(point(), 1..6), length(), any::<bool>(), any::<bool>()).prop_map(
        |(points, width, flat, closed)| {
            let ends = if flat { Ends::Flat } else { Ends::Round };
            Mark::Stroke(Stroke::even(path(&points, closed), width).with_ends(ends))
        },
    );
    let swell = (point(), point(), point(), [0.0..1.0, 0.0..1.0, 0.0..1.0_f64]).prop_map(|(a, b, c, widths)| {
        let mut curve = BezPath::new();
        curve.move_to(a);
        curve.quad_to(b, c);
        curve.line_to(b);
        Mark::Stroke(Stroke::swelling(curve, widths.to_vec()).unwrap())
    });
    let area = prop::collection::vec(point(), 1..8)
        .prop_map(|points| Mark::Area(Area { outline: path(&points, true), colour: Some(Colour::BLACK) }));
    prop_oneof![3 => dot, 3 => stroke, 1 => swell, 2 => area]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Everything drawn lies within half a nib (and the tolerance) of the requested ink's box, and nearly all reachable ink is
    /// laid.
    #[test]
    fn lowering_stays_inside_the_ink(marks in prop::collection::vec(mark(), 0..6), nib in 0.1..1.0_f64) {
        for mark in marks {
            let layer = Layer { marks: vec![mark.clone()], ..Layer::new("x", 1) };
            let drawing = Drawing { page: Page::new(60.0, 60.0), layers: vec![layer] };
            let nibs = Nibs::all(nib);
            let plot = lower(&drawing, InkModel::Ink, &nibs, 0.02, &Interrupt::never()).unwrap();
            let bounds = mark.bounding_box().inflate(0.05, 0.05);
            for point in plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(Toolpath::points) {
                prop_assert!(point.is_finite());
                prop_assert!(bounds.contains(*point), "{point:?} outside {bounds:?} of {mark:?}");
            }
            let fat = match &mark {
                Mark::Dot(dot) => dot.radius >= 0.5 * nib,
                Mark::Stroke(stroke) => matches!(stroke.width(), Width::Constant(width) if *width >= nib),
                Mark::Area(_) => false,
            };
            if fat {
                let measured = coverage(&drawing, &plot, &nibs, &Interrupt::never()).unwrap()[0];
                prop_assert!(measured.covered_fraction() > 0.9, "{measured:?} of {mark:?} with {nib}");
            }
        }
    }

    /// Many marks at once: lowering never panics, on normal and on extreme input.
    #[test]
    fn lowering_takes_anything(marks in prop::collection::vec(mark(), 0..40), scale in prop_oneof![Just(1.0), Just(1e-9), Just(1e4)]) {
        let layer = Layer { marks, ..Layer::new("x", 1) };
        let drawing = Drawing { page: Page::new(60.0, 60.0), layers: vec![layer] };
        let drawing = drawing.transformed(drypoint::geometry::Affine::scale(scale));
        let plot = lower(&drawing, InkModel::Lines, &Nibs::all(0.3), 0.02 * scale.max(1.0), &Interrupt::never()).unwrap();
        prop_assert!(plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(Toolpath::points).all(|p| p.is_finite()));
    }
}
