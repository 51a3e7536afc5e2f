//! Estimated depth: close to the busts' true depth, smooth, heads and bodies in the right order, nothing outside the people.
#![cfg(feature = "see")]

use crate::common;
use crate::seeing::{seen, seen_sample};

use common::sample;
use drypoint::raster::{Raster, gaussian_blur};
use drypoint::see::Sight;
use image::{DynamicImage, ImageFormat, RgbImage};
use std::io::Cursor;

const PEOPLE: [&str; 5] = ["astronaut.jpg", "grace-hopper.jpg", "bust-light.png", "bust-brown.png", "bust-dark.png"];

fn depth_of(sight: &Sight) -> &Raster<u16> {
    sight.depth.as_ref().unwrap()
}

/// Nearness 0 to 1 at a landmark of the first face, offset by widths of the face to the right and down.
fn nearness(sight: &Sight, point: usize, right: f64, down: f64) -> f64 {
    let depth = depth_of(sight);
    let landmarks = &sight.faces[0].landmarks;
    let (p, width) = (landmarks.point(point), landmarks.width());
    let (x_step, y_step) = (f64::from(sight.width) / depth.width() as f64, f64::from(sight.height) / depth.height() as f64);
    let (x, y) = ((p.x + right * width) / x_step, (p.y + down * width) / y_step);
    f64::from(depth.clamped(x as isize, y as isize)) / 65535.0
}

fn grey(name: &str) -> Raster<f32> {
    let picture = image::load_from_memory(&sample(name)).unwrap().to_luma16();
    let (width, height) = picture.dimensions();
    Raster::from_fn(width as usize, height as usize, |x, y| f32::from(picture.get_pixel(x as u32, y as u32)[0]) / 65535.0)
}

/// Normals of a surface of heights in pixels.
fn normal(heights: &Raster<f32>, x: usize, y: usize) -> [f64; 3] {
    let (x, y) = (x as isize, y as isize);
    let right = f64::from(heights.clamped(x + 1, y) - heights.clamped(x - 1, y)) / 2.0;
    let down = f64::from(heights.clamped(x, y + 1) - heights.clamped(x, y - 1)) / 2.0;
    let length = (right * right + down * down + 1.0).sqrt();
    [-right / length, -down / length, 1.0 / length]
}

/// Mean angle in degrees between the normals of two surfaces inside a region, and between the first's normals and a plane's.
fn angles(truth: &Raster<f32>, found: &Raster<f32>, region: &Raster<f32>) -> [f64; 2] {
    let places: Vec<(usize, usize)> = (12..truth.height() - 12)
        .flat_map(|y| (12..truth.width() - 12).map(move |x| (x, y)))
        // At least a dozen pixels inside.
        .filter(|&(x, y)| {
            [(12, 12), (0, 12), (24, 12), (12, 0), (12, 24)].iter().all(|(i, j)| region.get(x + i - 12, y + j - 12) > 0.5)
        })
        .collect();
    let spread = |heights: &Raster<f32>| {
        let values = || places.iter().map(|&(x, y)| f64::from(heights.get(x, y)));
        let mean = values().sum::<f64>() / places.len() as f64;
        (values().map(|v| (v - mean).powi(2)).sum::<f64>() / places.len() as f64).sqrt()
    };
    // Scaled to the same spread; the true head is about as deep as 0.6 of the picture's height for a nearness of 1.
    let deep = 480.0;
    let scale = (spread(truth) / spread(found)) as f32;
    let smooth = |heights: &Raster<f32>, scale: f32| gaussian_blur(&heights.map(|v| deep * scale * v), 1.0);
    let (truth, found) = (smooth(truth, 1.0), smooth(found, scale));
    let angle = |a: [f64; 3], b: [f64; 3]| (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).clamp(-1.0, 1.0).acos().to_degrees();
    let mean = |of: &dyn Fn(usize, usize) -> f64| places.iter().map(|&(x, y)| of(x, y)).sum::<f64>() / places.len() as f64;
    [mean(&|x, y| angle(normal(&truth, x, y), normal(&found, x, y))), mean(&|x, y| angle(normal(&truth, x, y), [0.0, 0.0, 1.0]))]
}

/// Faces within 22 degrees, where a plane is off by 39; clothing within 19, where a plane is off by 36; for every skin.
#[test]
fn the_busts_have_their_own_form() {
    let truth = grey("bust-depth.png");
    for name in ["bust-light.png", "bust-brown.png", "bust-dark.png"] {
        let sight = seen_sample(name);
        let found = depth_of(sight).map(|v| f32::from(v) / 65535.0);
        for (region, most) in [("bust-mask-face.png", 22.0), ("bust-mask-clothing.png", 19.0)] {
            let [off, plane] = angles(&truth, &found, &grey(region));
            println!("{name}, {region}: normals off by {off:.1} degrees, a plane's by {plane:.1}");
            assert!(off <= most && off < 0.6 * plane, "{name}, {region}: {off} of {plane}");
        }
    }
}

/// Nose before cheeks before ears, chin before neck, the skull before its silhouette, the face before the chest.
#[test]
fn heads_and_bodies_are_ordered() {
    for name in PEOPLE {
        let sight = seen_sample(name);
        let at = |point: usize, down: f64| nearness(sight, point, 0.0, down);
        let (nose, chin, forehead) = (at(4, 0.0), at(152, 0.0), at(151, 0.0));
        for (cheek, ear) in [(50, 234), (280, 454)] {
            assert!(nose > at(cheek, 0.0) && at(cheek, 0.0) > at(ear, 0.0), "{name}");
        }
        assert!(nose > 0.95 && nose > forehead && nose > chin, "{name}: {nose} {forehead} {chin}");
        assert!(chin > at(152, 0.25) && at(152, 0.25) > 0.0, "{name}: {chin}, neck {}", at(152, 0.25));
        assert!(chin > at(152, 0.6) && at(152, 0.6) > 0.0, "{name}: {chin}, chest {}", at(152, 0.6));
        // Above the forehead: first hair that is nearly as near, then ever farther.
        assert!(at(10, -0.05) > at(10, -0.2) && at(10, -0.2) > 0.0, "{name}: {} {}", at(10, -0.05), at(10, -0.2));
    }
}

/// Zero exactly outside the subject; the nearest is 65535; no step and no crease inside.
#[test]
fn depth_is_smooth_inside_the_subject_and_nothing_outside() {
    for name in PEOPLE {
        let sight = seen_sample(name);
        let (depth, subject) = (depth_of(sight), sight.subject.as_ref().unwrap());
        assert_eq!((depth.width(), depth.height()), (subject.width(), subject.height()), "{name}");
        for (&nearness, &subject) in depth.pixels().iter().zip(subject.pixels()) {
            assert!(if subject == 0 { nearness == 0 } else { subject < 128 || nearness > 0 }, "{name}: {subject} {nearness}");
        }
        assert_eq!(depth.pixels().iter().max(), Some(&65535), "{name}");
        // Width of the face in pixels of the depth map.
        let width = sight.faces[0].landmarks.width() * depth.width() as f64 / f64::from(sight.width);
        let (mut steepest, mut sharpest) = (0, 0);
        for (y, x) in (1..depth.height() - 1).flat_map(|y| (1..depth.width() - 1).map(move |x| (y, x))) {
            let here = depth.get(x, y);
            for [before, after] in [[depth.get(x - 1, y), depth.get(x + 1, y)], [depth.get(x, y - 1), depth.get(x, y + 1)]] {
                if here > 0 && before > 0 && after > 0 {
                    let [before, here, after] = [before, here, after].map(i32::from);
                    steepest = steepest.max((after - here).abs());
                    sharpest = sharpest.max((before + after - 2 * here).abs());
                }
            }
        }
        let (slope, bend) = (width * f64::from(steepest) / 65535.0, width * width * f64::from(sharpest) / 65535.0);
        println!("{name}: slope {slope:.1} for each width of the face, bend {bend:.0} for each of its squares");
        // 16 portraits: slopes up to 3.7, bends up to 80; a step of a hundredth within one pixel bends by 600.
        assert!(slope < 5.0 && bend < 120.0, "{name}: {slope} {bend}");
    }
}

/// A large face and one of half its size beside it: the larger is nearer, the smaller has its own relief.
#[test]
fn of_two_people_the_larger_face_is_nearer() {
    let bust = image::load_from_memory(&sample("bust-light.png")).unwrap().to_rgb8();
    let small = image::imageops::resize(
        &image::load_from_memory(&sample("bust-dark.png")).unwrap().to_rgb8(),
        360,
        480,
        image::imageops::FilterType::Triangle,
    );
    let mut both = RgbImage::from_pixel(960, 800, *bust.get_pixel(2, 2));
    image::imageops::replace(&mut both, &bust, 0, 0);
    image::imageops::replace(&mut both, &small, 600, 320);
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageRgb8(both).write_to(&mut bytes, ImageFormat::Png).unwrap();
    let sight = seen(&bytes.into_inner());
    assert_eq!(sight.faces.len(), 2);
    let depth = depth_of(&sight);
    let at = |face: usize, point: usize| {
        let p = sight.faces[face].landmarks.point(point);
        let scale = depth.width() as f64 / f64::from(sight.width);
        depth.clamped((p.x * scale) as isize, (p.y * scale) as isize)
    };
    assert!(at(0, 4) > at(1, 4) && at(0, 50) > at(1, 50), "{} {}, {} {}", at(0, 4), at(1, 4), at(0, 50), at(1, 50));
    for face in [0, 1] {
        assert!(at(face, 4) > at(face, 50).max(at(face, 280)), "{face}: {} {}", at(face, 4), at(face, 50));
    }
}

#[test]
fn depth_does_not_depend_on_threads() {
    let on = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| seen(&sample("bust-brown.png")).depth)
    };
    let one = on(1);
    assert!(one.is_some() && one == on(2) && one == on(7));
}

#[test]
fn without_a_face_there_is_no_depth() {
    assert_eq!(seen_sample("coffee.png").depth, None);
}
