//! Detection in photographs: faces in the right place, people without the background, and nothing where there is nobody.
#![cfg(feature = "see")]

use crate::common;

use common::sample;
use drypoint::geometry::Point;
use drypoint::interrupt::{Interrupt, Interrupted};
use drypoint::raster::Raster;
use drypoint::see::{SeeError, Sight, look};
use drypoint::source::{Limits, Photograph};
use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use std::io::Cursor;

/// The samples with a person, and the positions of the pupils in pixels, the person's right one first: read off the pictures by
/// eye, enlarged six times.
const PUPILS: [(&str, [(f64, f64); 2]); 5] = [
    ("astronaut.jpg", [(203.0, 101.2), (246.3, 103.3)]),
    ("grace-hopper.jpg", [(220.8, 190.0), (305.8, 186.3)]),
    ("bust-light.png", [(221.0, 277.0), (344.5, 280.0)]),
    ("bust-brown.png", [(221.0, 277.0), (344.5, 280.0)]),
    ("bust-dark.png", [(221.0, 277.0), (344.5, 280.0)]),
];
/// Largest error of a pupil, in distances between the eyes.
const NEAR: f64 = 0.04;

fn seen(bytes: &[u8]) -> Sight {
    look(&Photograph::decode(bytes, Limits::default()).unwrap(), &Interrupt::never()).unwrap()
}

fn picture(name: &str) -> RgbImage {
    image::load_from_memory(&sample(name)).unwrap().to_rgb8()
}

fn png(picture: RgbImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageRgb8(picture).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Errors of the pupils of the first face, in distances between the eyes.
fn error_of_pupils(sight: &Sight, pupils: [Point; 2]) -> f64 {
    let face = &sight.faces[0];
    let distance = (pupils[1] - pupils[0]).hypot();
    face.landmarks.irises.iter().zip(pupils).map(|(iris, pupil)| (iris.centre - pupil).hypot() / distance).fold(0.0, f64::max)
}

#[test]
fn a_face_is_found_with_its_eyes_where_they_are() {
    for (name, pupils) in PUPILS {
        let sight = seen(&sample(name));
        assert_eq!(sight.faces.len(), 1, "{name}");
        let error = error_of_pupils(&sight, pupils.map(Point::from));
        println!("{name}: score {}, pupils off by {:.1} % of their distance", sight.faces[0].score, 100.0 * error);
        assert!(error <= NEAR, "{name}: {error}, {:?}", sight.faces[0].landmarks.irises);
        assert_eq!(sight.faces[0].landmarks.points.len(), 468);
        assert!(sight.faces[0].bounds.contains(sight.faces[0].landmarks.point(1)), "{name}: the nose is in the face");
    }
}

/// In black and white, and toned brown: skin, hair, hat and clothing are found nearly as in colour, and no beard.
#[test]
fn regions_are_found_without_colour() {
    let brown = |light: f32| [light.powf(0.85), light, light.powf(1.3)].map(|v| (255.0 * v).round() as u8);
    for name in ["astronaut.jpg", "grace-hopper.jpg"] {
        let colour = seen(&sample(name)).regions.unwrap();
        let grey = image::DynamicImage::ImageRgb8(picture(name)).to_luma8();
        let tones: [&dyn Fn(u8) -> [u8; 3]; 2] = [&|v| [v; 3], &|v| brown(f32::from(v) / 255.0)];
        for tone in tones {
            let toned = RgbImage::from_fn(grey.width(), grey.height(), |x, y| Rgb(tone(grey.get_pixel(x, y).0[0])));
            let found = seen(&png(toned)).regions.unwrap();
            let alike = |a: &Raster<u8>, b: &Raster<u8>| agreement(a, |x, y| b.get(x as usize, y as usize));
            let shares = [alike(&found.skin, &colour.skin), alike(&found.clothing, &colour.clothing)];
            let hair = |of: &drypoint::see::Regions| of.hair.zip_map(&of.headwear, u8::max);
            println!("{name}: skin and clothing {shares:.2?}, hair and hat {:.2}", alike(&hair(&found), &hair(&colour)));
            assert!(shares.iter().all(|share| *share > 0.8), "{name}: {shares:?}");
            assert!(alike(&hair(&found), &hair(&colour)) > 0.7, "{name}");
            assert!(found.facial_hair.pixels().iter().all(|v| *v < 128), "{name}");
        }
    }
}

/// Intersection over union of a subject and the truth, both thresholded at middle grey.
fn agreement(subject: &Raster<u8>, truth: impl Fn(u32, u32) -> u8) -> f64 {
    let (mut both, mut either) = (0.0, 0.0);
    for (x, y) in (0..subject.height()).flat_map(|y| (0..subject.width()).map(move |x| (x, y))) {
        let (found, is) = (subject.get(x, y) > 127, truth(x as u32, y as u32) > 127);
        both += f64::from(u8::from(found && is));
        either += f64::from(u8::from(found || is));
    }
    both / either
}

#[test]
fn the_subject_is_the_person() {
    let grey = |name: &str| image::load_from_memory(&sample(name)).unwrap().to_luma8();
    let alpha = image::load_from_memory(&sample("astronaut-cutout.png")).unwrap().to_rgba8();
    let (bust, hopper) = (grey("bust-mask-subject.png"), grey("grace-hopper-subject.png"));
    for (name, _) in PUPILS {
        let subject = seen(&sample(name)).subject_at_full_size().unwrap();
        let share = match name {
            "astronaut.jpg" => agreement(&subject, |x, y| alpha.get_pixel(x, y).0[3]),
            "grace-hopper.jpg" => agreement(&subject, |x, y| hopper.get_pixel(x, y).0[0]),
            _ => agreement(&subject, |x, y| bust.get_pixel(x, y).0[0]),
        };
        println!("{name}: {share:.4}");
        assert!(share >= 0.96, "{name}: intersection over union {share}");
    }
}

/// A colour, 0 to 255, as a function of position.
type Ground = fn(f64, f64) -> [f64; 3];

/// Backgrounds that the network takes for people; position from 0 to 1 across and down.
const DECEPTIVE: [(&str, Ground); 3] = [
    ("a flag", |u, v| {
        let is_red = (13.0 * u + 6.0 * v + 0.4 * (13.0 * v).sin()).rem_euclid(2.0) < 1.0;
        if is_red { [176.0, 32.0, 44.0] } else { [226.0, 220.0, 222.0] }
    }),
    ("blurred lights", |u, v| {
        let lights = [(0.1, 0.2), (0.14, 0.45), (0.12, 0.7), (0.9, 0.25), (0.86, 0.5), (0.92, 0.72), (0.3, 0.06), (0.7, 0.08)];
        lights.iter().enumerate().fold([28.0, 44.0, 84.0], |sum, (i, (x, y))| {
            let light = 1.0 / (1.0 + (6.0 * ((u - x).hypot(1.3 * (v - y)) / 0.09 - 1.0)).exp());
            let colour = if i % 2 == 1 { [190.0, 120.0, 60.0] } else { [150.0, 150.0, 140.0] };
            [0, 1, 2].map(|k: usize| sum[k] + light * colour[k])
        })
    }),
    ("a shadow on the wall", |u, v| {
        let shade = 1.0 / (1.0 + (8.0 * (((u - 0.3) / 0.3).hypot((v - 0.36) / 0.34) - 1.0)).exp());
        [1.0, 0.98, 0.95].map(|tint| tint * (225.0 - 200.0 * shade))
    }),
];

#[test]
fn flags_lights_and_shadows_are_no_people() {
    let mask = image::load_from_memory(&sample("bust-mask-subject.png")).unwrap().to_luma8();
    for (name, (what, background)) in
        ["bust-light.png", "bust-brown.png", "bust-dark.png"].into_iter().flat_map(|name| DECEPTIVE.map(|b| (name, b)))
    {
        let bust = picture(name);
        let before = RgbImage::from_fn(bust.width(), bust.height(), |x, y| {
            let (u, v) = (f64::from(x) / f64::from(bust.width()), f64::from(y) / f64::from(bust.height()));
            let (behind, inside) = (background(u, v), f64::from(mask.get_pixel(x, y).0[0]) / 255.0);
            let colour = bust.get_pixel(x, y).0;
            Rgb([0, 1, 2].map(|k: usize| (f64::from(colour[k]) * inside + behind[k] * (1.0 - inside)).round() as u8))
        });
        let share = agreement(&seen(&png(before)).subject_at_full_size().unwrap(), |x, y| mask.get_pixel(x, y).0[0]);
        println!("{name} before {what}: {share:.4}");
        assert!(share >= 0.96, "{name} before {what}: intersection over union {share}");
    }
}

/// A deterministic pseudo-random number from 0 to 1.
fn noise(x: u32, y: u32, seed: u32) -> f64 {
    let mut h = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ seed.wrapping_mul(0xc2b2_ae3d);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    f64::from((h ^ (h >> 15)) >> 8) / f64::from(1 << 24)
}

/// Noise smoothed over `scale` pixels.
fn clouds(x: u32, y: u32, scale: u32, seed: u32) -> f64 {
    let (u, v) = (f64::from(x % scale) / f64::from(scale), f64::from(y % scale) / f64::from(scale));
    let (i, j) = (x / scale, y / scale);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t * t * (3.0 - 2.0 * t);
    let row = |j: u32| mix(noise(i, j, seed), noise(i + 1, j, seed), u);
    mix(row(j), row(j + 1), v)
}

/// Pictures without people: noises, gradients and textures of many scales, in grey, skin colours and others.
fn nothings(count: u32) -> impl Iterator<Item = RgbImage> {
    (0..count).map(|n| {
        let (width, height) = [(320, 240), (240, 320), (640, 480)][(n / 10) as usize % 3];
        let scale = [3, 7, 16, 37, 80][n as usize % 5];
        let colour = [[255.0, 255.0, 255.0], [224.0, 172.0, 140.0], [120.0, 150.0, 90.0], [141.0, 85.0, 60.0]][n as usize % 4];
        RgbImage::from_fn(width, height, |x, y| {
            let (fx, fy) = (f64::from(x), f64::from(y));
            let wave = |v: f64| 0.5 + 0.5 * v.sin();
            let value = match n % 10 {
                0 => noise(x, y, n),
                1 => clouds(x, y, scale, n),
                2 => 0.5 * clouds(x, y, 4 * scale, n) + 0.3 * clouds(x, y, 2 * scale, n) + 0.2 * clouds(x, y, scale, n),
                3 => (fx + fy) / f64::from(width + height),
                4 => (1.0 - (fx / f64::from(width) - 0.5).hypot(fy / f64::from(height) - 0.5) * 1.6).max(0.0),
                5 => wave(fx / f64::from(scale)) * wave(fy / f64::from(scale)),
                6 => f64::from((x / scale + y / scale) % 2),
                7 => wave((fx + 6.0 * clouds(x, y, 40, n) * f64::from(scale)) / f64::from(scale)),
                8 => wave((fx - 100.0).hypot(fy - 120.0) / f64::from(scale)),
                _ => {
                    let (i, j) = (x / (2 * scale), y / (2 * scale));
                    let middle = |k: u32, seed: u32| (f64::from(k) + 0.3 + 0.4 * noise(i, j, seed)) * 2.0 * f64::from(scale);
                    f64::from(u8::from((fx - middle(i, n)).hypot(fy - middle(j, n + 1)) > 0.6 * f64::from(scale)))
                }
            };
            Rgb(colour.map(|c| (c * value).round() as u8))
        })
    })
}

#[test]
fn animals_and_things_have_no_face() {
    for name in ["chelsea.png", "raccoon.jpg", "coffee.png", "bust-mask-hair.png"] {
        let sight = seen(&sample(name));
        assert!(sight.faces.is_empty() && sight.subject.is_none(), "{name}: {:?}", sight.faces[0].bounds);
    }
}

#[test]
fn noises_gradients_and_textures_have_no_face() {
    for (n, picture) in nothings(200).enumerate() {
        let sight = seen(&png(picture));
        assert!(sight.faces.is_empty() && sight.subject.is_none(), "picture {n}: {:?}", sight.faces[0].bounds);
    }
}

/// Maps a point `x`, `y` of the upright picture, given its width and height, to the stored one.
type Place = fn(f64, f64, f64, f64) -> Point;

#[test]
fn a_photograph_on_its_side_is_turned() {
    let upright = picture("grace-hopper.jpg");
    let (width, height) = (f64::from(upright.width()), f64::from(upright.height()));
    let pupils = PUPILS[1].1;
    let subject = seen(&sample("grace-hopper.jpg")).subject_at_full_size().unwrap();
    let turns: [(RgbImage, Place); 3] = [
        (image::imageops::rotate90(&upright), |x, y, _, h| Point::new(h - y, x)),
        (image::imageops::rotate180(&upright), |x, y, w, h| Point::new(w - x, h - y)),
        (image::imageops::rotate270(&upright), |x, y, w, _| Point::new(y, w - x)),
    ];
    for (quarters, (turned, place)) in turns.into_iter().enumerate() {
        let sight = seen(&png(turned));
        assert_eq!(sight.faces.len(), 1, "{} quarters", quarters + 1);
        let error = error_of_pupils(&sight, pupils.map(|(x, y)| place(x, y, width, height)));
        assert!(error <= NEAR, "{} quarters: {error}", quarters + 1);
        let found = sight.subject_at_full_size().unwrap();
        let share = agreement(&found, |x, y| {
            let p = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let back = match quarters {
                0 => (p.1, height - p.0),
                1 => (width - p.0, height - p.1),
                _ => (width - p.1, p.0),
            };
            subject.get(back.0 as usize, back.1 as usize)
        });
        assert!(share > 0.97, "{} quarters: {share}", quarters + 1);
    }
}

#[test]
fn two_people_are_both_subject_with_their_own_points() {
    let (left, right) = (picture("bust-light.png"), picture("bust-dark.png"));
    let both = RgbImage::from_fn(1200, 800, |x, y| *if x < 600 { left.get_pixel(x, y) } else { right.get_pixel(x - 600, y) });
    let sight = seen(&png(both));
    assert_eq!(sight.faces.len(), 2);
    let subject = sight.subject_at_full_size().unwrap();
    for (face, from) in [0.0, 600.0].map(|from| {
        let face = sight.faces.iter().find(|face| (face.bounds.center().x - from - 300.0).abs() < 150.0).unwrap();
        (face, from)
    }) {
        let pupils = PUPILS[2].1.map(|(x, y)| Point::new(x + from, y));
        let distance = (pupils[1] - pupils[0]).hypot();
        assert!(face.landmarks.irises.iter().zip(pupils).all(|(iris, pupil)| (iris.centre - pupil).hypot() <= NEAR * distance));
        assert!(subject.get(from as usize + 280, 350) > 250 && subject.get(from as usize + 300, 700) > 250);
    }
    assert!(subject.get(600, 100) < 5 && subject.get(20, 100) < 5);
}

#[test]
fn a_small_face_in_a_large_photograph_is_found_at_a_second_look() {
    let person = image::imageops::resize(&picture("grace-hopper.jpg"), 307, 360, image::imageops::FilterType::Triangle);
    let wide = RgbImage::from_fn(1800, 1200, |x, y| {
        if (1300..1607).contains(&x) && (700..1060).contains(&y) {
            *person.get_pixel(x - 1300, y - 700)
        } else {
            Rgb([(90.0 + 60.0 * clouds(x, y, 90, 5)) as u8, (110.0 + 50.0 * clouds(x, y, 60, 6)) as u8, 120])
        }
    });
    let sight = seen(&png(wide));
    assert_eq!(sight.faces.len(), 1);
    let pupils = PUPILS[1].1.map(|(x, y)| Point::new(1300.0 + 0.6 * x, 700.0 + 0.6 * y));
    assert!(error_of_pupils(&sight, pupils) <= NEAR, "{:?}", sight.faces[0].landmarks.irises);
}

#[test]
fn what_is_found_does_not_depend_on_threads_and_is_rounded() {
    let on = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| seen(&sample("astronaut.jpg")))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(7));
    let is_sixteenth = |v: f64| (16.0 * v).fract() == 0.0;
    assert!(one.faces[0].landmarks.points.iter().flatten().all(|v| is_sixteenth(*v)));
    assert!(one.faces[0].landmarks.irises.iter().all(|iris| is_sixteenth(iris.centre.x) && is_sixteenth(iris.radius)));
}

#[test]
fn looking_can_be_interrupted() {
    let interrupt = Interrupt::new();
    interrupt.raise();
    let photograph = Photograph::decode(&sample("astronaut.jpg"), Limits::default()).unwrap();
    assert!(matches!(look(&photograph, &interrupt), Err(SeeError::Interrupted(Interrupted))));
}
