//! What the press adds to the ink is taken off before.

use super::*;

/// A level line from left to right, longer on both sides.
fn longer(line: &BezPath, by: f64) -> BezPath {
    let bounds = line.control_box();
    let mut curve = BezPath::new();
    curve.move_to((bounds.x0 - by, bounds.y0));
    curve.line_to((bounds.x1 + by, bounds.y0));
    curve
}

/// The printed result of a drawing without areas: all borders `spread` further out.
fn pressed(drawing: &Drawing, spread: f64) -> Drawing {
    let mut printed = drawing.clone();
    for mark in printed.layers.iter_mut().flat_map(|layer| &mut layer.marks) {
        match mark {
            Mark::Dot(dot) => dot.radius += spread,
            Mark::Stroke(stroke) => {
                *stroke = stroke.clone().map_widths(|width| width + 2.0 * spread);
                if let (Width::Constant(width), Ends::Flat) = (stroke.width(), stroke.ends) {
                    *stroke = Stroke::even(longer(stroke.curve(), spread), *width).like(stroke);
                }
            }
            Mark::Area(_) => panic!("no areas here"),
        }
    }
    printed
}

/// The tones of a drawing in the patches of the wedge. The resolution shares no factor with the pitches, so that borders fall on
/// all parts of a pixel.
fn tones(drawing: &Drawing) -> Vec<f64> {
    let pixels_per_mm = 61.3;
    let shown = rendered(&svg_of(drawing), pixels_per_mm);
    wedge_patches().map(|(rect, _)| mean_in(&shown, rect, pixels_per_mm)).collect()
}

/// The greatest tone error on the wedge after the press.
fn tone_error(drawing: &Drawing, press: &Press) -> f64 {
    let printed = pressed(drawing, press.spread());
    let errors: Vec<f64> = tones(&printed).iter().zip(wedge_patches()).map(|(shown, (_, tone))| shown - tone).collect();
    println!("  {errors:.4?}");
    errors.into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// With correction tones are kept under each press; without, they are far off under the one that spreads most.
fn assert_tones_are_kept(drawing: &Drawing, presses: &[Press]) {
    for press in presses {
        let error = tone_error(&press.compensated(drawing), press);
        println!("spread {:.4} mm: off by {error:.4}", press.spread());
        assert!(error < 0.01, "{press:?}: {error}");
    }
    let most = presses.iter().max_by(|a, b| a.spread().total_cmp(&b.spread()));
    let uncorrected = most.map_or(0.0, |press| tone_error(drawing, press));
    println!("uncorrected by {uncorrected:.4}");
    assert!(uncorrected > 0.05, "{uncorrected}");
}

#[test]
fn a_stippled_wedge_prints_in_the_tone_that_was_asked_for() {
    let photo = wedge();
    let set: &[(&str, &str)] = &[("pitch", "0.4mm"), ("highlights", "off"), ("reversed_from", "1")];
    let drawing = Sheet { tone: ToneTarget::Linear, set, ..Sheet::new(&photo, (WEDGE_MM, WEDGE_MM)) }.draw();
    let presses =
        [Press::new(0.16, 60.0, 0.0), Press::new(0.22, 60.0, 0.05), Press::new(0.26, 40.0, 0.2), Press::new(0.0, 60.0, 0.25)];
    assert_tones_are_kept(&drawing, &presses);
    let press = Press::new(0.26, 40.0, 0.2);
    assert!(dots(&press.compensated(&drawing)).len() < dots(&drawing).len(), "small dots are thinned out");
}

/// Horizontal lines whose width gives each patch of the wedge its tone.
fn hatched_wedge() -> Drawing {
    let pitch = 0.5;
    let mut layer = Layer::new("lines", 1);
    for row in 0..(WEDGE_MM / pitch) as usize {
        let y = pitch * (row as f64 + 0.5);
        for column in 0..3 {
            let tone = 0.1 * (1 + column + 3 * (y / 20.0) as usize) as f64;
            let mut curve = BezPath::new();
            curve.move_to((20.0 * column as f64, y));
            curve.line_to((20.0 * (column + 1) as f64, y));
            layer.marks.push(Mark::Stroke(Stroke::even(curve, pitch * (1.0 - tone)).with_ends(Ends::Flat)));
        }
    }
    Drawing { page: Page::new(WEDGE_MM, WEDGE_MM), layers: vec![layer] }
}

#[test]
fn a_hatched_wedge_prints_in_the_tone_that_was_asked_for() {
    let drawing = hatched_wedge();
    assert_tones_are_kept(&drawing, &[Press::new(0.22, 60.0, 0.0), Press::new(0.26, 40.0, 0.1), Press::new(0.0, 60.0, 0.12)]);
}

#[test]
fn a_screen_tint_gains_what_the_press_is_described_by() {
    let pitch = 10.0 / 60.0;
    let mut layer = Layer::new("screen", 1);
    for i in 0..30 * 30 {
        let centre = Point::new(pitch * (f64::from(i % 30) + 0.5), pitch * (f64::from(i / 30) + 0.5));
        layer.marks.push(Mark::Dot(Dot::circle(centre, pitch * (0.5 / std::f64::consts::PI).sqrt())));
    }
    let tint = Drawing { page: Page::new(30.0 * pitch, 30.0 * pitch), layers: vec![layer] };
    for gain in [0.13, 0.22, 0.35] {
        let printed = rendered(&svg_of(&pressed(&tint, Press::new(gain, 60.0, 0.0).spread())), 240.0);
        let tone = mean_in(&printed, tint.page.rect(), 240.0);
        assert!((1.0 - tone - 0.5 - gain).abs() < 0.005, "{gain}: {tone}");
    }
}
