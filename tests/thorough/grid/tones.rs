//! Tones, tiles and seeds.

use super::*;

const FINE: f64 = 50.0;

/// Twelve patches of 20 x 20 mm, linear luminance 0.05, 0.1, 0.2 ... 0.9, 0.95.
fn tones() -> Vec<f64> {
    let mut tones: Vec<f64> = (1..=9).map(|i| 0.1 * f64::from(i)).collect();
    tones.extend([0.05, 0.95, 0.15]);
    tones
}

fn wedge_errors(set: &[(&str, &str)]) -> Vec<(f64, f64)> {
    let tones = tones();
    let photo = png_of_light(600, 800, |x, y| tones[(x / 200 + 3 * (y / 200)) as usize]);
    let case = Case { style: "grid", photo: &photo, mask: None, detail: None, mm: (60.0, 80.0), tone: ToneTarget::Linear, set };
    let white = rendered(&svg_of(&case.draw().1), FINE);
    (0..12)
        .map(|i| {
            let (x, y) = (20.0 * f64::from(i % 3), 20.0 * f64::from(i / 3));
            let tone = tones[i as usize];
            (tone, mean_in(&white, Rect::new(x + 2.0, y + 2.0, x + 18.0, y + 18.0), FINE) - tone)
        })
        .collect()
}

fn check_wedge(name: &str, set: &[(&str, &str)]) {
    let errors = wedge_errors(set);
    println!("{name}: {}", errors.iter().map(|(t, e)| format!("{t:.2} {e:+.4}")).collect::<Vec<_>>().join(", "));
    assert!(errors.iter().all(|(_, e)| e.abs() <= 0.015), "{name}");
}

#[test]
fn pure_stippling_has_the_tone_of_the_wedge() {
    check_wedge("stippling", &[("pitch", "0.8mm"), ("size_max", "0.8mm")]);
}

#[test]
fn pure_hatching_has_the_tone_of_the_wedge() {
    check_wedge("hatching", &[("pitch", "0.8mm"), ("size_max", "0")]);
}

#[test]
fn hatching_along_has_the_tone_of_the_wedge() {
    check_wedge("hatching along", &[("pitch", "0.8mm"), ("size_max", "0"), ("hatching", "along")]);
}

#[test]
fn mixed_marks_have_the_tone_of_the_wedge() {
    check_wedge("mixed", &[("pitch", "0.8mm")]);
}

#[test]
fn lines_that_close_up_have_the_tone_of_the_wedge() {
    check_wedge("not reversed", &[("pitch", "0.8mm"), ("reversed_from", "1")]);
}

/// A disc of detail of 12 mm in each patch: the tone holds in it, on its border and around it, and it has three times the dots.
#[test]
fn detail_has_three_times_the_dots_and_the_tone_of_the_wedge() {
    let (tones, disc) = (tones(), 6.0);
    let from_middle = |x: f64, y: f64| (x % 20.0 - 10.0).hypot(y % 20.0 - 10.0);
    let photo = png_of_light(600, 800, |x, y| tones[(x / 200 + 3 * (y / 200)) as usize]);
    let detail =
        png_of_light(600, 800, |x, y| if from_middle(f64::from(x) / 10.0, f64::from(y) / 10.0) < disc { 1.0 } else { 0.0 });
    for size_max in ["0.8mm", "0.4mm", "0"] {
        let set = [("pitch", "0.8mm"), ("size_max", size_max)];
        let mut case = Case {
            style: "grid",
            photo: &photo,
            mask: None,
            detail: Some(&detail),
            mm: (60.0, 80.0),
            tone: ToneTarget::Linear,
            set: &set,
        };
        let drawing = case.draw().1;
        let white = rendered(&svg_of(&drawing), FINE);
        let mut worst = [0.0_f64; 3];
        for (i, tone) in tones.iter().enumerate() {
            let (left, top) = (20.0 * (i % 3) as f64, 20.0 * (i / 3) as f64);
            for (zone, (from, to)) in [(0.0, disc - 1.0), (disc - 1.0, disc + 1.5), (disc + 1.5, 9.0)].into_iter().enumerate() {
                let (mut sum, mut count) = (0.0, 0.0);
                for y in 0..(20.0 * FINE) as usize {
                    for x in 0..(20.0 * FINE) as usize {
                        let (px, py) = ((x as f64 + 0.5) / FINE, (y as f64 + 0.5) / FINE);
                        if (from..to).contains(&from_middle(px, py)) {
                            sum += f64::from(white.get((left * FINE) as usize + x, (top * FINE) as usize + y));
                            count += 1.0;
                        }
                    }
                }
                worst[zone] = worst[zone].max((sum / count - tone).abs());
            }
        }
        println!("size_max {size_max}: off by {worst:.4?} at most inside, on the border and outside");
        assert!(worst.iter().all(|off| *off <= 0.015), "size_max {size_max}: {worst:?}");
        let inside = |drawing: &Drawing| {
            dot_centres(drawing).iter().filter(|p| p.y < 40.0 && from_middle(p.x, p.y) < disc - 1.0).count() as f64
        };
        let fine = inside(&drawing);
        case.detail = None;
        let even = inside(&case.draw().1);
        if size_max == "0.8mm" {
            assert!((2.7..3.3).contains(&(fine / even)), "{fine} dots for {even}");
        }
    }
}

/// A ramp of 200 mm; the tone error must not jump from one strip of two pitches to the next.
#[test]
fn the_change_from_dots_to_lines_is_no_step() {
    let photo = png_of_light(1600, 160, |x, _| f64::from(x) / 1600.0);
    let set = [("pitch", "0.8mm"), ("isophotes", "0"), ("lines", "off")];
    let case =
        Case { style: "grid", photo: &photo, mask: None, detail: None, mm: (160.0, 16.0), tone: ToneTarget::Linear, set: &set };
    let white = rendered(&svg_of(&case.draw().1), FINE);
    let strip = 3.2;
    let errors: Vec<f64> = (1..49)
        .map(|i| {
            let x = strip * f64::from(i);
            mean_in(&white, Rect::new(x, 1.6, x + strip, 14.4), FINE) - (x + 0.5 * strip) / 160.0
        })
        .collect();
    let worst = errors.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    println!("ramp: errors {errors:.4?}, greatest step {worst:.4}");
    assert!(worst <= 0.02, "{worst}");
}

#[test]
fn tiles_do_not_overlap_and_carry_colours() {
    let photo = sample("coffee.png");
    let set = [("primitive", "tile"), ("pitch", "2mm")];
    let case =
        Case { style: "grid", photo: &photo, mask: None, detail: None, mm: (90.0, 60.0), tone: ToneTarget::Lightness, set: &set };
    let (_, drawing, _) = case.draw();
    let tiles: Vec<_> =
        drawing.layers[0].marks.iter().filter_map(|m| if let Mark::Area(area) = m { Some(area) } else { None }).collect();
    assert!(tiles.len() > 1000, "{}", tiles.len());
    assert!(tiles.iter().all(|tile| tile.colour.is_some()));
    let sum: f64 = tiles.iter().map(|tile| kurbo_area(&tile.outline)).sum();
    assert!(sum < 90.0 * 60.0 && sum > 0.6 * 90.0 * 60.0, "{sum} mm2 of 5400");
}

fn kurbo_area(outline: &drypoint::geometry::BezPath) -> f64 {
    flatten(outline, 0.01).iter().map(|(points, _)| drypoint::geometry::polygon_area(points).abs()).sum()
}

#[test]
fn seeds_differ_and_repeat() {
    let photo = png_of_light(90, 90, |x, y| f64::from(x + y) / 180.0);
    let style = find("grid").unwrap();
    let case =
        Case { style: "grid", photo: &photo, mask: None, detail: None, mm: (20.0, 20.0), tone: ToneTarget::Lightness, set: &[] };
    let (portrait, first, _) = case.draw();
    let settings = Settings::resolve("grid", style.parameters(), &[]).unwrap();
    let draw = |seed| svg_of(&style.draw(&portrait, &settings, seed, &drypoint::style::Silent).unwrap());
    assert_eq!(svg_of(&first), draw(0));
    assert_ne!(draw(1), draw(2));
}
