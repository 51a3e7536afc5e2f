//! The guarantees of painting with continuous Glass patterns.

use crate::common;

use common::{WEDGE_MM, mean_in, rendered, sample, svg_of, wedge, wedge_patches};
use drypoint::drawing::{Colour, Drawing, Layer, Mark, Page, Stroke};
use drypoint::field::{Flow, GlassLevels, RibbonFit, glass_pattern, glass_ribbons, line_integral_convolution};
use drypoint::geometry::{Point, Rect, Ring, Vec2, catmull_rom};
use drypoint::raster::{Raster, edge_preserving, equalised, fast_gaussian, gaussian_gradient, gradient, structure_tensor};
use drypoint::source::{Crop, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Settings, Silent, find};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::FRAC_PI_2;

const SIZE: usize = 128;
const SEEDS: u64 = 5;

fn portrait(photo: &[u8], mm: (f64, f64), tone: ToneTarget, settings: &Settings) -> Portrait {
    let photograph = Photograph::decode(photo, Limits::default()).unwrap();
    let pixels_per_mm = find("glass").unwrap().pixels_per_mm(settings, &[]);
    let placement = Placement::new(Rect::new(0.0, 0.0, mm.0, mm.1), pixels_per_mm);
    let crop = Crop::all(&photograph);
    Portrait::new(&photograph, crop, Page::new(mm.0, mm.1), placement, tone, ToneCurve::default()).unwrap()
}

fn settings(given: &[(&str, &str)]) -> Settings {
    let given: Vec<(String, String)> = given.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    Settings::resolve("glass", find("glass").unwrap().parameters(), &given).unwrap()
}

fn white_noise(width: usize, height: usize, seed: u64) -> Raster<f32> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let data = (0..width * height).map(|_| (0..12).map(|_| random.random::<f32>()).sum::<f32>() - 6.0).collect();
    Raster::from_vec(width, height, data)
}

/// The fields of figures 7.1 to 7.3, of constant norm as in equation 7.10.
fn fields() -> Vec<(&'static str, Flow)> {
    let unit = SIZE as f64 / 5.0;
    let field = |vector: fn(f64, f64) -> (f64, f64)| {
        Flow::from_fn(SIZE, SIZE, move |p| {
            let (x, y) = vector((p.x - SIZE as f64 / 2.0) / unit, (p.y - SIZE as f64 / 2.0) / unit);
            Vec2::new(x, y)
        })
    };
    vec![
        ("rotation", field(|x, y| (-y, x))),
        ("scaling", field(|x, y| (x, y))),
        ("hyperbolic", field(|x, y| (x, -y))),
        ("spiral", field(|x, y| (x - y, x + y))),
        ("translation", field(|_, _| (1.0, 0.0))),
        ("nonlinear", field(|x, y| (y * y - 1.0 + x * y / 3.0, (y * y - 1.0) / 3.0 - x * y))),
    ]
}

/// The short side of the pictures that the paper's values are for (Table 7.1).
const PHOTOGRAPH: usize = 320;

/// The flow of a photograph.
fn photograph_flow(name: &str) -> Flow {
    let photo = sample(name);
    let side = PHOTOGRAPH as f64 * 0.28;
    let lightness = portrait(&photo, (side, side), ToneTarget::Lightness, &settings(&[])).lightness;
    let lightness = Raster::from_fn(PHOTOGRAPH, PHOTOGRAPH, |x, y| lightness.clamped(x as isize, y as isize));
    let smooth = edge_preserving(&[lightness], 1.25, 4.0);
    let slope = gaussian_gradient(&smooth[0], 6.0);
    Flow::steepest(&structure_tensor(std::slice::from_ref(&slope)).unwrap(), &slope).turned(FRAC_PI_2)
}

/// The ribbons in grey, as resvg prints them, at pixel centres (where the raster pattern is sampled too).
fn painted(noise: &Raster<f32>, flow: &Flow, length: f64, pattern: &Raster<f32>, count: usize) -> Raster<f32> {
    let levels = GlassLevels::new(pattern, count);
    let mut layer = Layer::new("strokes", 1);
    for ribbon in glass_ribbons(noise, pattern, flow, length, RibbonFit::Faithful, |height| levels.of(height)) {
        let grey = ((levels.value(&ribbon) + 0.5) * 235.0 + 15.0).round() as u8;
        let mut stroke = Stroke::swelling(catmull_rom(&ribbon.nodes, Ring::Open), ribbon.widths.clone()).unwrap();
        stroke.colour = Some(Colour { r: grey, g: grey, b: grey });
        layer.marks.push(Mark::Stroke(stroke));
    }
    let page = Page { paper: Colour::BLACK, ..Page::new(noise.width() as f64, noise.height() as f64) };
    let fine = rendered(&svg_of(&Drawing { page, layers: vec![layer] }), 3.0);
    Raster::from_fn(noise.width(), noise.height(), |x, y| fine.get(3 * x + 1, 3 * y + 1))
}

fn correlation(a: &Raster<f32>, b: &Raster<f32>) -> f64 {
    let mean = |r: &Raster<f32>| r.pixels().iter().map(|v| f64::from(*v)).sum::<f64>() / r.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.pixels().iter().zip(b.pixels()) {
        let (x, y) = (f64::from(*x) - ma, f64::from(*y) - mb);
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    ab / (aa * bb).sqrt()
}

#[test]
fn ribbons_are_the_pattern() {
    let mut flows = fields();
    flows.push(("astronaut", photograph_flow("astronaut.jpg")));
    flows.push(("raccoon", photograph_flow("raccoon.jpg")));
    let mut missed = Vec::new();
    for (sigma, length) in [(1.2_f32, 18.0), (3.0, 18.0)] {
        for (name, flow) in &flows {
            let mut sums = [0.0; 2];
            let directions = flow.directions();
            // A photograph's area is that of six fields.
            let seeds = if directions.width() > SIZE { 1 } else { SEEDS };
            for seed in 0..seeds {
                let noise = fast_gaussian(&white_noise(directions.width(), directions.height(), seed), sigma);
                let pattern = glass_pattern(&noise, flow, length);
                let equal = equalised(&pattern);
                for (sum, count) in sums.iter_mut().zip([1, 8]) {
                    let ribbons = equalised(&painted(&noise, flow, f64::from(length), &pattern, count));
                    *sum += correlation(&ribbons, &equal) / seeds as f64;
                }
            }
            println!("sigma_z {sigma}, {name}: one ribbon {:.3}, nested {:.3}", sums[0], sums[1]);
            if sums[0] < 0.80 || sums[1] < 0.90 {
                missed.push((sigma, *name, sums));
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}

/// The sum of the slopes' `power`-th powers across the flow divided by that along it, inside the raster: energies for 2, total
/// variations for 1.
fn slope_ratio(raster: &Raster<f32>, flow: &Flow, power: i32) -> f64 {
    let slopes = gradient(raster);
    let (mut along, mut across) = (0.0, 0.0);
    for y in 8..raster.height() - 8 {
        for x in 8..raster.width() - 8 {
            let ([gx, gy], [vx, vy]) = (slopes.get(x, y), flow.directions().get(x, y));
            along += f64::from(gx * vx + gy * vy).abs().powi(power);
            across += f64::from(gy * vx - gx * vy).abs().powi(power);
        }
    }
    across / along
}

/// The median slope across the flow divided by the median slope along it: strokes between their ends.
fn typical_ratio(raster: &Raster<f32>, flow: &Flow) -> f64 {
    let slopes = gradient(raster);
    let (mut alongs, mut acrosses) = (Vec::new(), Vec::new());
    for y in 8..raster.height() - 8 {
        for x in 8..raster.width() - 8 {
            let ([gx, gy], [vx, vy]) = (slopes.get(x, y), flow.directions().get(x, y));
            alongs.push(f64::from(gx * vx + gy * vy).abs());
            acrosses.push(f64::from(gy * vx - gx * vy).abs());
        }
    }
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    median(acrosses) / median(alongs)
}

/// The fraction of slopes along the flow that are almost zero (below a tenth of the mean slope across).
fn flat_share(raster: &Raster<f32>, flow: &Flow) -> f64 {
    let slopes = gradient(raster);
    let (mut alongs, mut across) = (Vec::new(), 0.0);
    for y in 8..raster.height() - 8 {
        for x in 8..raster.width() - 8 {
            let ([gx, gy], [vx, vy]) = (slopes.get(x, y), flow.directions().get(x, y));
            alongs.push(f64::from(gx * vx + gy * vy).abs());
            across += f64::from(gy * vx - gx * vy).abs();
        }
    }
    let least = 0.1 * across / alongs.len() as f64;
    alongs.iter().filter(|v| **v < least).count() as f64 / alongs.len() as f64
}

#[test]
fn ribbons_are_flatter_along_and_sharper_across_than_line_integral_convolution() {
    let (sigma, length) = (3.0, 24.0);
    for (name, flow) in fields() {
        let noise = fast_gaussian(&white_noise(SIZE, SIZE, 7), sigma);
        let pattern = glass_pattern(&noise, &flow, length);
        let ribbons = equalised(&painted(&noise, &flow, f64::from(length), &pattern, 8));
        let lic = equalised(&line_integral_convolution(&noise, &flow, length));
        let pattern = equalised(&pattern);
        let flat = [&pattern, &ribbons, &lic].map(|raster| flat_share(raster, &flow));
        let ratio = |power| [&pattern, &ribbons, &lic].map(|raster| slope_ratio(raster, &flow, power));
        let steady = [&pattern, &ribbons, &lic].map(|raster| typical_ratio(raster, &flow));
        println!("{name}: typical slope across to along: {steady:.2?}");
        assert!(steady[0] > 4.0 * steady[2] && steady[1] > 1.5 * steady[2], "{name}: {steady:?}");
        assert!(flat[0] > 2.0 * flat[2] && flat[1] > 1.5 * flat[2], "{name}: {flat:?}");
        let (variation, energy) = (ratio(1), ratio(2));
        println!(
            "{name}: across to along, of pattern, ribbons and LIC: variation {variation:.2?}, energy {energy:.2?}; flat along: \
             {flat:.3?}"
        );
        // Squared slopes along a stroke come from its two ends, which are as sharp as its sides; in the raster pattern too.
        assert!(variation[0] > variation[2] && variation[1] > variation[2], "{name}: {variation:?}");
    }
}

/// A hill's name and its gradient as a function of position.
type Hill = (&'static str, fn(f64, f64) -> Vec2);

#[test]
fn contours_close() {
    // Hills of several shapes, given by their gradients.
    let hills: [Hill; 3] = [
        ("round", |x, y| Vec2::new(-x, -y)),
        ("long", |x, y| Vec2::new(-x / 9.0, -y)),
        ("cosines", |x, y| Vec2::new(-(x / 20.0).sin() * (y / 20.0).cos(), -(x / 20.0).cos() * (y / 20.0).sin())),
    ];
    for (name, slope) in hills {
        let flow = Flow::from_fn(161, 161, |p| slope(p.x - 80.5, p.y - 80.5)).turned(FRAC_PI_2);
        for start in [10.0, 18.0, 24.0] {
            let from = Point::new(80.5 + start, 80.5);
            let line = flow.streamline(from, 400.0, 0.5);
            let away = line.iter().position(|p| p.distance(from) > 8.0).unwrap();
            let (gap, i) = line[away..]
                .iter()
                .enumerate()
                .map(|(i, p)| (p.distance(from), i))
                .fold((f64::INFINITY, 0), |a, b| if b.0 < a.0 { b } else { a });
            let length = 0.5 * (away + i) as f64;
            println!("{name} from {start}: closes within {gap:.3} px after {length:.0} px");
            assert!(gap <= 0.01 * length + 0.25, "{name}: {gap} after {length}");
        }
    }
}

/// Points where the field makes a full turn, with the sign of the turn (the singular points' index).
fn singular_points(flow: &Flow) -> Vec<(usize, usize, i32)> {
    let directions = flow.directions();
    let angle = |x: usize, y: usize| {
        let [vx, vy] = directions.get(x, y);
        f64::from(vy).atan2(f64::from(vx))
    };
    let mut found = Vec::new();
    for y in 0..directions.height() - 1 {
        for x in 0..directions.width() - 1 {
            let corners = [angle(x, y), angle(x + 1, y), angle(x + 1, y + 1), angle(x, y + 1)];
            let turn: f64 = (0..4)
                .map(|i| {
                    let d = corners[(i + 1) % 4] - corners[i];
                    d - std::f64::consts::TAU * (d / std::f64::consts::TAU).round()
                })
                .sum();
            let index = (turn / std::f64::consts::TAU).round() as i32;
            if index != 0 {
                found.push((x, y, index));
            }
        }
    }
    found
}

/// The flow of smoothed white noise, and the raster whose gradient it is.
fn noise_flow(size: usize, sigma: f32, seed: u64) -> (Raster<f32>, Flow) {
    let smooth = fast_gaussian(&white_noise(size, size, seed), sigma);
    let slope = gradient(&smooth);
    (smooth, Flow::new(&slope).turned(FRAC_PI_2))
}

#[test]
fn whirls_stand_where_the_gradient_vanishes_and_the_hessian_is_definite() {
    let (smooth, flow) = noise_flow(400, 8.0, 1);
    let slope = gradient(&smooth).map(|[x, y]| x.hypot(y));
    let mean = slope.pixels().iter().sum::<f32>() / slope.len() as f32;
    let at = |x: usize, y: usize| f64::from(smooth.get(x, y));
    let (mut whirls, mut saddles, mut wrong) = (0, 0, 0);
    for (x, y, index) in singular_points(&flow).into_iter().filter(|p| p.0 > 8 && p.1 > 8 && p.0 < 390 && p.1 < 390) {
        let xx = at(x + 4, y) + at(x - 4, y) - 2.0 * at(x, y);
        let yy = at(x, y + 4) + at(x, y - 4) - 2.0 * at(x, y);
        let xy = 0.25 * (at(x + 4, y + 4) + at(x - 4, y - 4) - at(x + 4, y - 4) - at(x - 4, y + 4));
        let definite = xx * yy - xy * xy > 0.0;
        assert!(slope.get(x, y) < 0.45 * mean, "the gradient vanishes there");
        if index > 0 {
            whirls += 1;
        } else {
            saddles += 1;
        }
        wrong += i32::from(definite != (index > 0));
    }
    println!("{whirls} whirls, {saddles} saddles, {wrong} with the other sign");
    assert!(whirls > 50 && wrong * 50 <= whirls + saddles, "{wrong} of {whirls} and {saddles}");
}

#[test]
fn whirls_grow_in_proportion_to_sigma() {
    let points: Vec<(f64, f64)> = [4.0_f32, 5.6, 8.0, 11.3, 16.0]
        .into_iter()
        .map(|sigma| {
            let count: usize =
                (0..3).map(|seed| singular_points(&noise_flow(512, sigma, seed).1).iter().filter(|p| p.2 > 0).count()).sum();
            let spacing = (3.0 * 512.0 * 512.0 / count as f64).sqrt();
            println!("sigma {sigma}: whirls {spacing:.1} px apart, {:.2} sigma", spacing / f64::from(sigma));
            (f64::from(sigma).ln(), spacing.ln())
        })
        .collect();
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let slope =
        points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>() / points.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>();
    println!("log-log slope {slope:.3}");
    assert!((slope - 1.0).abs() <= 0.15, "{slope}");
}

/// A plate of discs and stripes of flat greys, and the distance of each pixel from an edge (up to 40).
fn plate(size: usize) -> (Raster<f32>, Raster<f32>) {
    let plate = Raster::from_fn(size, size, |x, y| {
        let (x, y) = (x as f32, y as f32);
        let r = (x - 128.0).hypot(y - 128.0);
        if r < 45.0 {
            0.8
        } else if r < 90.0 {
            0.25
        } else if x + 0.4 * y > 330.0 {
            0.9
        } else if x - 0.7 * y < -40.0 {
            0.1
        } else {
            0.55
        }
    });
    let is_edge = |x: usize, y: usize| {
        let (x, y) = (x as isize, y as isize);
        plate.clamped(x, y) != plate.clamped(x + 1, y) || plate.clamped(x, y) != plate.clamped(x, y + 1)
    };
    let edges: Vec<(usize, usize)> = (0..size * size).map(|i| (i % size, i / size)).filter(|&(x, y)| is_edge(x, y)).collect();
    let distance = Raster::from_fn(size, size, |x, y| {
        edges.iter().map(|e| (e.0 as f32 - x as f32).hypot(e.1 as f32 - y as f32)).fold(40.0, f32::min)
    });
    (plate, distance)
}

/// A plain Gaussian-Kuwahara filter: the mean of the window within 3 sigma with the least deviation.
fn kuwahara(picture: &Raster<f32>, sigma: f32) -> Raster<f32> {
    let mean = fast_gaussian(picture, sigma);
    let squares = fast_gaussian(&picture.map(|v| v * v), sigma);
    let variance = squares.zip_map(&mean, |s, m| s - m * m);
    let reach = (3.0 * sigma) as isize;
    Raster::from_fn(picture.width(), picture.height(), |x, y| {
        let mut best = (f32::INFINITY, 0.0);
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                if dx * dx + dy * dy <= reach * reach {
                    let at = (x as isize + dx, y as isize + dy);
                    let v = variance.clamped(at.0, at.1);
                    if v < best.0 {
                        best = (v, mean.clamped(at.0, at.1));
                    }
                }
            }
        }
        best.1
    })
}

#[test]
fn figure_7_18_remade() {
    let (size, sigma) = (256, 3.0_f32);
    let (clean, distance) = plate(size);
    let noisy = clean.zip_map(&white_noise(size, size, 3), |v, n| v + 0.05 * n);
    let count = distance.pixels().iter().filter(|d| **d < 1.0).count() as f64;
    let measure = |smooth: &Raster<f32>| {
        let (mut far, mut far_count, mut near) = (0.0, 0.0, 0.0);
        for ((s, c), d) in smooth.pixels().iter().zip(clean.pixels()).zip(distance.pixels()) {
            let square = f64::from(s - c).powi(2);
            if *d > 5.0 * sigma {
                far += square;
                far_count += 1.0;
            } else {
                near += square;
            }
        }
        (-10.0 * (far / far_count).log10(), near / count)
    };
    let report = |name: &str, (psnr, edge): (f64, f64)| println!("| {name} | {psnr:.1} | {edge:.4} |");
    let gauss = measure(&edge_preserving(std::slice::from_ref(&noisy), sigma, 0.0)[0]);
    report("0 (Gaussian)", gauss);
    let mut at_four = gauss;
    for q in [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 16.0] {
        let figures = measure(&edge_preserving(std::slice::from_ref(&noisy), sigma, q)[0]);
        report(&q.to_string(), figures);
        if q == 4.0 {
            at_four = figures;
        }
    }
    let hard = measure(&kuwahara(&noisy, sigma));
    report("Gaussian-Kuwahara", hard);
    assert!(gauss.0 - at_four.0 <= 1.0, "noise: {} dB of {}", at_four.0, gauss.0);
    assert!(at_four.1 <= 1.1 * hard.1, "edges: {} of {}", at_four.1, hard.1);
}

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
