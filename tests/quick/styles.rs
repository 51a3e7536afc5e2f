//! What holds for every style, those that are built in and one that is made outside of the crate.

use crate::common;
use crate::custom_style;

use crate::any_style::ink_outline;
use common::{mean_in, png_of_light, rendered, sample, svg_of};
use custom_style::OneLine;
use drypoint::drawing::{Drawing, Page};
use drypoint::geometry::Rect;
use drypoint::source::{Crop, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Observer, Picture, STYLES, Settings, Silent, Style, StyleError};
use drypoint::write::{SvgHead, write_svg};
use kurbo::Shape;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The picture's box on a page that leaves room around it.
const PICTURE: Rect = Rect::new(6.0, 8.0, 31.0, 33.0);
const PIXELS_PER_MM: f64 = 16.0;

/// Built in, and made outside.
fn styles() -> impl Iterator<Item = &'static dyn Style> {
    STYLES.iter().copied().chain([&OneLine as &dyn Style])
}

fn settings(style: &dyn Style, set: &[(&str, &str)]) -> Settings {
    let set: Vec<(String, String)> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    Settings::resolve(style.name(), style.parameters(), &set).unwrap()
}

fn portrait(style: &dyn Style, photo: &[u8], picture: Rect, tone: ToneTarget) -> Portrait {
    let photograph = Photograph::decode(photo, Limits::default()).unwrap();
    let settings = settings(style, &[]);
    let placement = Placement::new(picture, style.resolution(&settings, &[], picture));
    let page = Page::new(picture.x1 + picture.x0, picture.y1 + picture.y0);
    Portrait::new(&photograph, Crop::all(&photograph), page, placement, tone, ToneCurve::default()).unwrap()
}

fn drawn(style: &dyn Style, photo: &[u8], seed: u64) -> Result<Drawing, StyleError> {
    let portrait = portrait(style, photo, PICTURE, ToneTarget::Lightness);
    style.draw(&portrait, &settings(style, &[]), seed, &Silent)
}

fn bytes(drawing: &Drawing) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_svg(drawing, &SvgHead::default(), &mut bytes).unwrap();
    bytes
}

#[test]
fn the_same_bytes_on_one_two_and_seven_threads() {
    let photo = sample("astronaut.jpg");
    for style in styles() {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| bytes(&drawn(style, &photo, 3).unwrap()))
        };
        let one = on(1);
        assert!(one == on(2) && one == on(7), "{}", style.name());
    }
}

#[test]
fn all_ink_lies_in_the_picture_and_a_seed_is_all_that_is_random() {
    let photo = sample("astronaut.jpg");
    let room = PICTURE.inflate(1e-6, 1e-6);
    for style in styles() {
        let drawing = drawn(style, &photo, 1).unwrap();
        assert!(drawing.marks().count() >= 1, "{}", style.name());
        for mark in drawing.marks() {
            let bounds = ink_outline(mark, 1e-3).bounding_box();
            assert!(room.union(bounds) == room, "{}: {bounds:?}", style.name());
        }
        assert_eq!(bytes(&drawing), bytes(&drawn(style, &photo, 1).unwrap()), "{}", style.name());
        assert!(drawn(style, &photo, 2).is_ok(), "{}", style.name());
    }
}

/// Raises its flag at the given step, and notes when.
struct Impatient {
    steps_left: AtomicUsize,
    asked: mpsc::SyncSender<Instant>,
}

impl Observer for Impatient {
    fn begin(&self, _: &str) {
        if self.steps_left.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |left| left.checked_sub(1)) == Ok(1) {
            let _ = self.asked.try_send(Instant::now());
        }
    }
    fn progress(&self, _: f64) {}
    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}
    fn warn(&self, _: &str) {}
    fn is_interrupted(&self) -> bool {
        self.steps_left.load(Ordering::SeqCst) == 0
    }
}

#[test]
fn every_style_stops_within_two_seconds_at_every_step() {
    let photo = sample("astronaut.jpg");
    let picture = Rect::new(0.0, 0.0, 60.0, 60.0);
    for style in styles() {
        let portrait = portrait(style, &photo, picture, ToneTarget::Lightness);
        for step in 1..20 {
            let (asked, when) = mpsc::sync_channel(1);
            let observer = Impatient { steps_left: AtomicUsize::new(step), asked };
            let end = style.draw(&portrait, &settings(style, &[]), 0, &observer);
            let Ok(asked) = when.try_recv() else { break };
            let late = asked.elapsed();
            assert!(late < Duration::from_secs(2), "{} at step {step}: {late:?}", style.name());
            assert!(end.is_ok() || end == Err(StyleError::Interrupted), "{}: {end:?}", style.name());
        }
    }
}

#[test]
fn empty_white_black_and_single_pixels_are_drawn_or_told() {
    let flat = |side: u32, light: f64| png_of_light(side, side, |_, _| light);
    for style in styles() {
        let draw = |photo: &[u8]| drawn(style, photo, 0);
        assert!(matches!(draw(&flat(40, 1.0)), Err(StyleError::NothingToDraw(_)) | Ok(_)), "{}: white", style.name());
        for (what, photo) in [("black", flat(40, 0.0)), ("one grey pixel", flat(1, 0.2)), ("one black pixel", flat(1, 0.0))] {
            match draw(&photo) {
                Ok(drawing) => assert!(drawing.ink_mm2().iter().sum::<f64>() > 0.0, "{}: {what}", style.name()),
                Err(StyleError::NothingToDraw(why)) => assert!(!why.is_empty()),
                Err(error) => assert!(matches!(error, StyleError::NothingLeft { .. }), "{}: {what}: {error}", style.name()),
            }
        }
    }
}

#[test]
fn darker_pictures_take_more_ink() {
    for style in styles() {
        let ink = |light: f64| {
            let photo = png_of_light(60, 60, |x, y| light * (0.9 + 0.1 * f64::from((x / 6 + y / 6) % 2)));
            let portrait = portrait(style, &photo, PICTURE, ToneTarget::Linear);
            let drawing = style.draw(&portrait, &settings(style, &[]), 0, &Silent).unwrap();
            1.0 - mean_in(&rendered(&svg_of(&drawing), PIXELS_PER_MM), PICTURE, PIXELS_PER_MM)
        };
        let [dark, middle, light] = [0.2, 0.5, 0.75].map(ink);
        println!("{}: {dark:.3} {middle:.3} {light:.3}", style.name());
        assert!(dark >= middle && middle >= light && dark > 0.0, "{}: {dark} {middle} {light}", style.name());
    }
}

#[test]
fn a_parameter_is_declared_whole() {
    for style in styles() {
        let mut names: Vec<&str> = style.parameters().iter().map(|parameter| parameter.name).collect();
        names.sort_unstable();
        let count = names.len();
        names.dedup();
        assert_eq!(names.len(), count, "{} has a parameter twice", style.name());
        for parameter in style.parameters() {
            let whole = !parameter.meaning.is_empty() && !parameter.kind.range_text().is_empty();
            assert!(whole, "{}: {}", style.name(), parameter.name);
            // What is written into a recipe is read back.
            let settings = settings(style, &[]);
            let text = settings.entries().find(|(name, _)| *name == parameter.name).map(|(_, text)| text).unwrap();
            let again = Settings::resolve(style.name(), style.parameters(), &[(parameter.name.to_owned(), text)]);
            assert!(again.is_ok(), "{}: {}", style.name(), parameter.name);
        }
    }
}

#[test]
fn masks_are_of_known_roles_and_each_once() {
    for style in styles() {
        let roles: &[MaskRole] = style.masks();
        assert!(roles.iter().enumerate().all(|(i, role)| !roles[..i].contains(role)), "{}", style.name());
    }
}
