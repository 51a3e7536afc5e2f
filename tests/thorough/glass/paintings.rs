//! Paintings in colours and with one pen.

use super::*;

mod ciede2000 {
    /// CIE L*a*b* under D65 of linear sRGB.
    pub fn lab([r, g, b]: [f64; 3]) -> [f64; 3] {
        let x = (0.412_456_4 * r + 0.357_576_1 * g + 0.180_437_5 * b) / 0.950_47;
        let y = 0.212_672_9 * r + 0.715_152_2 * g + 0.072_175 * b;
        let z = (0.019_333_9 * r + 0.119_192 * g + 0.950_304_1 * b) / 1.088_83;
        let f = |t: f64| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
        [116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z))]
    }

    /// Sharma, Wu and Dalal 2005.
    pub fn difference(one: [f64; 3], two: [f64; 3]) -> f64 {
        let [l1, a1, b1] = one;
        let [l2, a2, b2] = two;
        let seventh = |c: f64| (c.powi(7) / (c.powi(7) + 25.0_f64.powi(7))).sqrt();
        let g = 0.5 * (1.0 - seventh(0.5 * (a1.hypot(b1) + a2.hypot(b2))));
        let (a1, a2) = ((1.0 + g) * a1, (1.0 + g) * a2);
        let (c1, c2) = (a1.hypot(b1), a2.hypot(b2));
        let hue = |a: f64, b: f64| if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a).to_degrees().rem_euclid(360.0) };
        let (h1, h2) = (hue(a1, b1), hue(a2, b2));
        let is_grey = c1 * c2 == 0.0;
        let turn = if is_grey { 0.0 } else { (h2 - h1 + 180.0).rem_euclid(360.0) - 180.0 };
        let (dl, dc) = (l2 - l1, c2 - c1);
        let dh = 2.0 * (c1 * c2).sqrt() * (0.5 * turn).to_radians().sin();
        let (l, c) = (0.5 * (l1 + l2), 0.5 * (c1 + c2));
        let h = if is_grey {
            h1 + h2
        } else if (h1 - h2).abs() <= 180.0 {
            0.5 * (h1 + h2)
        } else if h1 + h2 < 360.0 {
            0.5 * (h1 + h2 + 360.0)
        } else {
            0.5 * (h1 + h2 - 360.0)
        };
        let cos = |degrees: f64| degrees.to_radians().cos();
        let t = 1.0 - 0.17 * cos(h - 30.0) + 0.24 * cos(2.0 * h) + 0.32 * cos(3.0 * h + 6.0) - 0.2 * cos(4.0 * h - 63.0);
        let sl = 1.0 + 0.015 * (l - 50.0).powi(2) / (20.0 + (l - 50.0).powi(2)).sqrt();
        let (sc, sh) = (1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
        let rotation = -2.0 * seventh(c) * (60.0 * (-((h - 275.0) / 25.0).powi(2)).exp()).to_radians().sin();
        let (l, c, h) = (dl / sl, dc / sc, dh / sh);
        (l * l + c * c + h * h + rotation * c * h).sqrt()
    }

    #[test]
    fn published_pairs() {
        for (one, two, expected) in [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, -1.0, 2.0], [50.0, 0.0, 0.0], 2.3669),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0011], 7.2195),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
            ([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514], 0.9082),
        ] {
            assert!((difference(one, two) - expected).abs() < 1e-4, "{}", difference(one, two));
        }
    }
}

/// The painting as resvg prints it: planes of encoded colour at the portrait's resolution.
fn colour_planes(svg: &str, columns: usize, rows: usize) -> Vec<Raster<f32>> {
    let tree = resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default()).unwrap();
    let mut pixmap = resvg::tiny_skia::Pixmap::new(3 * columns as u32, 3 * rows as u32).unwrap();
    pixmap.fill(resvg::tiny_skia::Color::WHITE);
    let scale = |count: usize, length: f32| 3.0 * count as f32 / length;
    let transform =
        resvg::tiny_skia::Transform::from_scale(scale(columns, tree.size().width()), scale(rows, tree.size().height()));
    resvg::render(&tree, transform, &mut pixmap.as_mut());
    let channel = |of: fn(&resvg::tiny_skia::PremultipliedColorU8) -> u8| {
        let fine = Raster::from_vec(3 * columns, 3 * rows, pixmap.pixels().iter().map(|p| f32::from(of(p)) / 255.0).collect());
        Raster::from_fn(columns, rows, |x, y| (0..9).map(|i| fine.get(3 * x + i % 3, 3 * y + i / 3)).sum::<f32>() / 9.0)
    };
    vec![channel(|p| p.red()), channel(|p| p.green()), channel(|p| p.blue())]
}

fn encoded(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn decoded(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

fn colour_error(name: &str, mm: (f64, f64), set: &[(&str, &str)]) -> f64 {
    let photo = sample(name);
    let settings = settings(set);
    let portrait = portrait(&photo, mm, ToneTarget::Lightness, &settings);
    let drawing = find("glass").unwrap().draw(&portrait, &settings, 0, &Silent).unwrap();
    let scale = portrait.placement.mm_per_pixel();
    let planes: Vec<Raster<f32>> = (0..3).map(|i| portrait.light.map(|rgb| encoded(rgb[i]))).collect();
    let smooth = edge_preserving(&planes, (settings.number("smoothing") / scale) as f32, settings.number("sharpness") as f32);
    let painting = colour_planes(&svg_of(&drawing), portrait.placement.columns, portrait.placement.rows);
    // The eye's blur mixes linear light.
    let blur = (settings.number("pitch") / scale) as f32;
    let seen = |planes: &[Raster<f32>]| planes.iter().map(|plane| fast_gaussian(&plane.map(decoded), blur)).collect::<Vec<_>>();
    let (one, two) = (seen(&painting), seen(&smooth));
    let at = |planes: &[Raster<f32>], i: usize| ciede2000::lab([0, 1, 2].map(|c| f64::from(planes[c].pixels()[i])));
    let count = one[0].len();
    (0..count).map(|i| ciede2000::difference(at(&one, i), at(&two, i))).sum::<f64>() / count as f64
}

#[test]
fn paintings_keep_the_colours() {
    for (name, mm) in [
        ("astronaut.jpg", (90.0, 90.0)),
        ("grace-hopper.jpg", (90.0, 105.469)),
        ("chelsea.png", (90.0, 59.867)),
        ("coffee.png", (90.0, 60.0)),
        ("raccoon.jpg", (90.0, 67.5)),
    ] {
        let error = colour_error(name, mm, &[]);
        println!("{name}: mean CIEDE2000 {error:.2}");
        assert!(error <= 3.5, "{name}: {error}");
    }
}

const MONO: &[(&str, &str)] = &[("colors", "mono")];
const FINE: f64 = 30.0;

fn mono_wedge() -> Drawing {
    let photo = wedge();
    let settings = settings(MONO);
    let portrait = portrait(&photo, (WEDGE_MM, WEDGE_MM), ToneTarget::Linear, &settings);
    find("glass").unwrap().draw(&portrait, &settings, 0, &Silent).unwrap()
}

#[test]
fn one_pen_has_the_tone_of_the_wedge() {
    let drawing = mono_wedge();
    let white = rendered(&svg_of(&drawing), FINE);
    let errors: Vec<f64> = wedge_patches().map(|(patch, tone)| mean_in(&white, patch, FINE) - tone).collect();
    println!("wedge, one pen: {errors:.4?}");
    assert!(errors.iter().all(|e| e.abs() <= 0.03), "{errors:?}");
}

#[test]
fn one_pen_s_lines_hardly_overlap() {
    let nib = 0.3;
    for drawing in [mono_wedge(), {
        let settings = settings(MONO);
        let portrait = portrait(&sample("astronaut.jpg"), (90.0, 90.0), ToneTarget::Lightness, &settings);
        find("glass").unwrap().draw(&portrait, &settings, 0, &Silent).unwrap()
    }] {
        let strokes: Vec<&Stroke> =
            drawing.marks().filter_map(|m| if let Mark::Stroke(s) = m { Some(s) } else { None }).collect();
        let mut cells = std::collections::HashMap::<(i64, i64), Vec<(usize, Point)>>::new();
        let cell = |p: Point| ((p.x / nib).floor() as i64, (p.y / nib).floor() as i64);
        for (i, stroke) in strokes.iter().enumerate() {
            for p in stroke.sampled(0.05).0 {
                cells.entry(cell(p)).or_default().push((i, p));
            }
        }
        let mut least = f64::INFINITY;
        for ((x, y), points) in &cells {
            for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
                for (j, q) in cells.get(&(x + dx, y + dy)).into_iter().flatten() {
                    for (_, p) in points.iter().filter(|(i, _)| i != j) {
                        least = least.min(p.distance(*q));
                    }
                }
            }
        }
        println!("{} lines, the nearest two {least:.3} mm apart", strokes.len());
        assert!(least >= 0.5 * nib, "{least}");
    }
}

#[test]
fn paintings_repeat_and_differ_by_seed() {
    let photo = sample("chelsea.png");
    for set in [&[][..], MONO, &[("pattern", "discrete"), ("transform", "nonlinear")][..]] {
        let settings = settings(set);
        let portrait = portrait(&photo, (30.0, 20.0), ToneTarget::Lightness, &settings);
        let draw = |seed| svg_of(&find("glass").unwrap().draw(&portrait, &settings, seed, &Silent).unwrap());
        assert_eq!(draw(1), draw(1));
        assert_ne!(draw(1), draw(2));
    }
}

/// The help's number of strokes is the number drawn.
#[test]
fn the_help_says_how_many_strokes_there_are() {
    let meaning = find("glass").unwrap().parameters().iter().find(|p| p.name == "grain").unwrap().meaning;
    let numbers: Vec<usize> =
        meaning.split(' ').filter(|w| w.contains(',')).filter_map(|w| w.replace(',', "").parse().ok()).collect();
    let [least, most] = numbers[..] else { panic!("two numbers in: {meaning}") };
    for name in ["astronaut.jpg", "chelsea.png", "coffee.png", "bust-light.png"] {
        let settings = settings(&[]);
        let portrait = portrait(&sample(name), (100.0, 100.0), ToneTarget::Lightness, &settings);
        let drawing = find("glass").unwrap().draw(&portrait, &settings, 0, &Silent).unwrap();
        let strokes: usize = drawing.layers.iter().map(|layer| layer.counts()[1]).sum();
        println!("{name}: {strokes} strokes");
        assert!((least..=most).contains(&strokes), "{name}: {strokes}, not {least} to {most}");
        let ink: f64 = drawing.ink_mm2().iter().sum();
        assert!((0.99..1.0001).contains(&(ink / 1e4)), "{name}: paint counts once: {ink} mm2 of 10,000");
    }
}

/// A transform moves the flow under the strokes as it moves points (figure 7.4).
#[test]
fn strokes_follow_a_transform() {
    let photo = sample("coffee.png");
    for (transform, along) in [
        ("rotation", (|v: Vec2| v.turn_90()) as fn(Vec2) -> Vec2),
        ("scaling", |v| v),
        ("hyperbolic", |v| Vec2::new(v.x, -v.y)),
        ("spiral", |v| Vec2::new(v.x - v.y, v.x + v.y)),
        ("translation", |_| Vec2::new(1.0, 0.0)),
    ] {
        for colors in ["photo", "mono"] {
            let settings = settings(&[("transform", transform), ("colors", colors), ("detail", "2")]);
            let portrait = portrait(&photo, (60.0, 60.0), ToneTarget::Lightness, &settings);
            let drawing = find("glass").unwrap().draw(&portrait, &settings, 0, &Silent).unwrap();
            let (mut sum, mut length) = (0.0, 0.0);
            for mark in drawing.marks() {
                let Mark::Stroke(stroke) = mark else { continue };
                if matches!(stroke.ends, drypoint::drawing::Ends::Flat) {
                    continue; // The underpainting has no direction.
                }
                for pair in stroke.sampled(0.5).0.windows(2) {
                    let (way, from) = (pair[1] - pair[0], pair[0].midpoint(pair[1]) - Point::new(30.0, 30.0));
                    if from.hypot() > 4.0 && way.hypot() > 0.0 {
                        sum += way.dot(along(from).normalize()).abs();
                        length += way.hypot();
                    }
                }
            }
            println!("{transform}, {colors}: {:.3} of the length lies along the flow", sum / length);
            assert!(sum > 0.93 * length && length > 500.0, "{transform}, {colors}: {sum} of {length}");
        }
    }
}
