//! The tone made for faces, measured by the ink of real drawings of all samples, analysed as `draw` does.
#![cfg(feature = "see")]

use crate::common;
use crate::seeing::seen_sample;

use common::sample;
use drypoint::drawing::Page;
use drypoint::geometry::{Point, Rect};
use drypoint::raster::{Raster, filled_polygon};
use drypoint::see::Sight;
use drypoint::source::{Crop, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget, outlines};
use drypoint::tone::portrait_tone;

/// A portrait 400 pixels wide with everything found in it.
fn portrait(name: &'static str) -> (Portrait, &'static Sight) {
    let photograph = Photograph::decode(&sample(name), Limits::default()).unwrap();
    let sight = seen_sample(name);
    let (width, height) = (80.0, 80.0 * f64::from(photograph.height()) / f64::from(photograph.width()));
    let placement = Placement::new(Rect::new(0.0, 0.0, width, height), 5.0);
    let crop = Crop::all(&photograph);
    let page = Page::new(width, height);
    let mut portrait = Portrait::new(&photograph, crop, page, placement, ToneTarget::Lightness, ToneCurve::default()).unwrap();
    for (role, mask) in sight.masks() {
        portrait.add_mask(role, &Photograph::from_grey(mask), &photograph, crop).unwrap();
    }
    let faces: Vec<_> = sight.faces.iter().map(|face| face.landmarks.clone()).collect();
    portrait.add_faces(&faces, &photograph, crop).unwrap();
    (portrait, sight)
}

/// Values inside the outline of the largest face, ascending.
fn in_face(portrait: &Portrait, values: &Raster<f32>) -> Vec<f32> {
    let oval: Vec<[f64; 2]> = portrait.faces[0].line(&outlines::OVAL).iter().map(|p| [p.x, p.y]).collect();
    let inside = filled_polygon(values.width(), values.height(), &oval);
    let mut inside: Vec<f32> =
        values.pixels().iter().zip(inside.pixels()).filter(|(_, inside)| **inside == 1).map(|(v, _)| *v).collect();
    inside.sort_unstable_by(f32::total_cmp);
    inside
}

fn share(values: &[f32], is_so: impl Fn(f32) -> bool) -> f64 {
    values.iter().filter(|v| is_so(**v)).count() as f64 / values.len() as f64
}

#[test]
fn faces_take_the_whole_range_and_darker_skin_stays_darker() {
    let mut medians = Vec::new();
    for name in ["bust-dark.png", "bust-brown.png", "bust-light.png", "grace-hopper.jpg", "astronaut.jpg"] {
        let (portrait, _) = portrait(name);
        let tone = portrait_tone(&portrait, 1.0).unwrap();
        let values = in_face(&portrait, &tone);
        let (bare, black) = (share(&values, |v| v > 0.95), share(&values, |v| v < 0.15));
        let median = values[values.len() / 2];
        println!("{name}: median {median:.3}, bare {bare:.3}, black {black:.3}");
        assert!((0.02..=0.25).contains(&bare), "{name}: {bare} of the face is bare");
        assert!(black <= 0.08, "{name}: {black} of the face is black");
        medians.push(median);
    }
    assert!(medians[0] < medians[1] && medians[1] < medians[2], "{medians:?}");
}

#[test]
fn without_strength_and_beyond_the_people_it_is_the_lightness() {
    let (portrait, _) = portrait("grace-hopper.jpg");
    let none = portrait_tone(&portrait, 0.0).unwrap();
    let off = none.zip_map(&portrait.lightness, |a, b| (a - b).abs());
    assert!(off.pixels().iter().all(|v| *v < 0.02));
    let tone = portrait_tone(&portrait, 1.0).unwrap();
    let beyond = portrait
        .subject
        .zip_map(&tone.zip_map(&portrait.lightness, |a, b| (a - b).abs()), |s, off| if s < 0.02 { off } else { 0.0 });
    let worst = beyond.pixels().iter().copied().fold(0.0, f32::max);
    println!("beyond the people the tone is off by {worst} at most");
    let mean: f32 = beyond.pixels().iter().sum::<f32>() / beyond.pixels().len() as f32;
    assert!(mean < 0.002, "{mean}");
}

#[test]
fn no_face_no_tone_and_the_crop_keeps_only_faces_in_it() {
    let photograph = Photograph::decode(&sample("grace-hopper.jpg"), Limits::default()).unwrap();
    let sight = seen_sample("grace-hopper.jpg");
    let crop = Crop { x: 0.0, y: 400.0, width: 512.0, height: 200.0 };
    let placement = Placement::new(Rect::new(0.0, 0.0, 51.2, 20.0), 5.0);
    let mut below =
        Portrait::new(&photograph, crop, Page::new(51.2, 20.0), placement, ToneTarget::Lightness, ToneCurve::default()).unwrap();
    below.add_faces(&[sight.faces[0].landmarks.clone()], &photograph, crop).unwrap();
    assert!(below.faces.is_empty() && portrait_tone(&below, 1.0).is_none());
}

#[test]
fn faces_lie_on_the_working_grid() {
    let (portrait, sight) = portrait("grace-hopper.jpg");
    let scale = 400.0 / f64::from(sight.width);
    let (there, here) = (sight.faces[0].landmarks.point(1), portrait.faces[0].point(1));
    // A whole number of rows stretches the grid by up to half a row.
    assert!((Point::new(there.x * scale, there.y * scale) - here).hypot() < 0.5);
    assert!((sight.faces[0].landmarks.width() * scale - portrait.faces[0].width()).abs() < 0.2);
    assert!(portrait.masks.contains_key(&MaskRole::Detail));
}
