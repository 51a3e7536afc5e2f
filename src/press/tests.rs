use super::*;
use crate::drawing::{Colour, Ends, Page, Width};
use crate::geometry::{BezPath, Point, blob};
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

fn drawing(marks: Vec<Mark>) -> Drawing {
    let mut layer = Layer::new("marks", 1);
    layer.marks = marks;
    Drawing { page: Page::new(60.0, 60.0), layers: vec![layer] }
}

/// The ink of marks after their borders have moved outwards, by Steiner's formula for straight strokes and dots.
fn printed_ink(drawing: &Drawing, spread: f64) -> f64 {
    let area = |mark: &Mark| match mark {
        Mark::Dot(dot) => spread_dot(dot, spread).radius.powi(2) * std::f64::consts::PI,
        Mark::Stroke(stroke) => {
            let corners = std::f64::consts::PI * spread * spread;
            let ends = if stroke.ends == Ends::Flat { 2.0 * spread * stroke.widest() + corners } else { 0.0 };
            Mark::Stroke(widened(stroke, 2.0 * spread)).area() + ends
        }
        Mark::Area(area) => area::grown(&area.outline, spread).area().abs(),
    };
    drawing.marks().map(area).sum()
}

fn hatch(ends: Ends, width: impl Fn(f64) -> Width) -> Drawing {
    let lines = (0..100).map(|i| {
        let y = 0.5 + 0.5 * f64::from(i);
        let mut curve = BezPath::new();
        curve.move_to((5.0, y));
        curve.line_to((25.0, y));
        curve.line_to((45.0, y));
        Mark::Stroke(Stroke::even(curve, 0.0).with_width(width(y)).unwrap().with_ends(ends))
    });
    drawing(lines.collect())
}

#[test]
fn without_gain_and_limit_nothing_changes() {
    let lines = hatch(Ends::Round, |_| Width::Constant(0.05));
    assert_eq!(Press::new(0.0, 60.0, 0.0).compensated(&lines), lines);
}

#[test]
fn wide_lines_become_thinner_and_print_as_wide() {
    let press = Press::new(0.26, 40.0, 0.0);
    let lines = hatch(Ends::Round, |_| Width::Along(vec![0.1, 0.3, 0.2]));
    let plate = press.compensated(&lines);
    let Mark::Stroke(stroke) = &plate.layers[0].marks[0] else { panic!("a stroke") };
    let Width::Along(widths) = stroke.width() else { panic!("it swells") };
    assert!((widths[1] - (0.3 - 2.0 * press.spread())).abs() < 1e-12);
    let (asked, printed) = (lines.layers[0].ink_mm2(), printed_ink(&plate, press.spread()));
    assert!((printed / asked - 1.0).abs() < 1e-3, "{printed} of {asked}");
}

#[test]
fn thin_lines_become_dashes_with_the_same_ink() {
    for (gain, ends) in [(0.0, Ends::Round), (0.0, Ends::Flat), (0.22, Ends::Round), (0.22, Ends::Flat)] {
        let press = Press::new(gain, 60.0, 0.1);
        for width in [Width::Constant(0.03), Width::Constant(0.08), Width::Along(vec![0.0, 0.2, 0.05])] {
            let lines = hatch(ends, |_| width.clone());
            let plate = press.compensated(&lines);
            assert!(plate.layers[0].marks.len() > 100, "broken");
            for mark in plate.marks() {
                let Mark::Stroke(stroke) = mark else { panic!("a stroke") };
                let thinnest = match stroke.width() {
                    Width::Constant(width) => *width,
                    Width::Along(widths) => widths.iter().copied().fold(1.0, f64::min),
                };
                assert!(thinnest >= 0.1 - 1e-9, "{thinnest}");
            }
            let (asked, printed) = (lines.layers[0].ink_mm2(), printed_ink(&plate, press.spread()));
            assert!((printed / asked - 1.0).abs() < 0.01, "{ends:?} {width:?} {gain}: {printed} of {asked}");
        }
    }
}

#[test]
fn blobs_keep_their_shape_and_small_ones_are_thinned_out() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let blobs: Vec<Mark> = (0..2500)
        .map(|i| {
            let (centre, radius) =
                (Point::new(f64::from(i % 50) + 1.0, f64::from(i / 50) + 1.0), if i % 2 == 0 { 0.3 } else { 0.05 });
            Mark::Dot(Dot { outline: Some(Box::new(blob(centre, radius, 0.7, &mut random))), ..Dot::circle(centre, radius) })
        })
        .collect();
    let asked = drawing(blobs);
    let press = Press::new(0.2, 60.0, 0.12);
    let plate = press.compensated(&asked);
    assert!(plate.marks().all(|mark| (mark.area() / std::f64::consts::PI).sqrt() >= 0.06 - 1e-9));
    let printed = printed_ink(&plate, press.spread());
    assert!((printed / asked.layers[0].ink_mm2() - 1.0).abs() < 0.01, "{printed} of {}", asked.layers[0].ink_mm2());
}

#[test]
fn areas_shrink_and_slivers_become_dots() {
    let outline = |text: &str| Mark::Area(Area { outline: BezPath::from_svg(text).unwrap(), colour: None });
    let mut marks = vec![outline("M5,5 H15 V15 H5 Z M7,7 V13 H13 V7 Z")];
    marks.extend((0..40).map(|i| outline(&format!("M20,{y} h30 v0.04 h-30 z", y = 5 + i))));
    let asked = drawing(marks);
    let press = Press::new(0.26, 40.0, 0.1);
    let plate = press.compensated(&asked);
    assert_eq!(plate.layers[0].counts()[2], 1, "the slivers are gone");
    assert!(plate.layers[0].counts()[0] > 100, "{:?}", plate.layers[0].counts());
    let printed = printed_ink(&plate, press.spread());
    assert!((printed / asked.layers[0].ink_mm2() - 1.0).abs() < 0.01, "{printed} of {}", asked.layers[0].ink_mm2());
}

#[test]
fn holes_in_the_ink_are_made_larger() {
    let white = Dot { colour: Some(Colour::WHITE), ..Dot::circle(Point::new(5.0, 5.0), 0.1) };
    let press = Press::new(0.26, 40.0, 0.3);
    let plate = press.compensated(&drawing(vec![Mark::Dot(white)]));
    let Mark::Dot(dot) = &plate.layers[0].marks[0] else { panic!("a dot") };
    assert!((dot.radius - 0.1 - press.spread()).abs() < 1e-12);
}

#[test]
fn touches_and_empty_strokes_are_dots_and_nothing() {
    let touch = |i: i32| {
        let mut curve = BezPath::new();
        curve.move_to((f64::from(i % 20), f64::from(i / 20)));
        curve.line_to((f64::from(i % 20), f64::from(i / 20)));
        Mark::Stroke(Stroke::even(curve, 0.05))
    };
    let mut marks: Vec<Mark> = (0..400).map(touch).collect();
    marks.push(Mark::Stroke(Stroke::even(BezPath::new(), 0.05)));
    marks.push(Mark::Stroke(Stroke::swelling(BezPath::from_svg("M1,1").unwrap(), vec![0.3]).unwrap()));
    let plate = Press::new(0.0, 60.0, 0.1).compensated(&drawing(marks));
    let [dots, strokes, _] = plate.layers[0].counts();
    assert!((98..=102).contains(&dots) && strokes <= 2, "a quarter of the touches: {dots}, {strokes}");
}
