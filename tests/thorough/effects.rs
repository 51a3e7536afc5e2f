//! Each parameter of each style has an effect; where it cannot, a warning says so and names what would enable it.

use crate::any_style;
use crate::common;

use any_style::Order;
use common::{png_of_light, sample};
use drypoint::drawing::Drawing;
use drypoint::source::MaskRole;
use drypoint::style::{Kind, Need, Parameter, find};
use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Mutex;

/// A style and the input to try it on.
struct Trial {
    style: &'static str,
    photo: Vec<u8>,
    mm: (f64, f64),
    /// Set throughout, to keep the drawing fast.
    set: &'static [(&'static str, &'static str)],
    /// Masks and a depth map, passed if a parameter needs them.
    masks: Vec<(MaskRole, Vec<u8>)>,
    depth: Vec<u8>,
    /// Drawings without a parameter's own value, which most parameters are compared with.
    plain: Mutex<HashMap<String, Option<Drawing>>>,
}

/// Settings, masks and depth that meet a parameter's needs, or break one.
#[derive(Clone, Debug, Default)]
struct Given {
    set: Vec<(String, String)>,
    masks: Vec<MaskRole>,
    has_depth: bool,
    has_face: bool,
}

impl Trial {
    fn parameters(&self) -> &'static [Parameter] {
        find(self.style).unwrap().parameters()
    }

    fn kind(&self, name: &str) -> Kind {
        self.parameters().iter().find(|p| p.name == name).unwrap_or_else(|| panic!("{} has no {name}", self.style)).kind
    }

    fn draw(&self, given: &Given, own: &[(&str, &str)]) -> (Option<Drawing>, String) {
        let mut order = Order::new(self.style, &self.photo, self.mm, self.set);
        order.set.extend(given.set.iter().cloned());
        order.set.extend(own.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())));
        order.masks = self
            .masks
            .iter()
            .filter(|(role, _)| *role == MaskRole::Subject || given.masks.contains(role))
            .map(|(r, bytes)| (*r, &bytes[..]))
            .collect();
        order.depth = given.has_depth.then_some(&self.depth);
        order.faces = if given.has_face { vec![common::plain_face(120.0, 110.0, 90.0)] } else { Vec::new() };
        let (drawing, warnings) = order.try_draw();
        (drawing.ok(), warnings)
    }

    /// The drawing without a value of the parameter's own.
    fn plain(&self, given: &Given) -> Option<Drawing> {
        let key = format!("{given:?}");
        if let Some(known) = self.plain.lock().unwrap().get(&key) {
            return known.clone();
        }
        let drawing = self.draw(given, &[]).0;
        self.plain.lock().unwrap().insert(key, drawing.clone());
        drawing
    }

    fn meet(&self, need: &Need, given: &mut Given) {
        let mut set = |name: &str, value: String| given.set.push((name.to_owned(), value));
        match need {
            Need::Word(name, words) => set(name, words[0].to_owned()),
            Need::Above(name, least) => {
                // Keep the default if it suffices.
                if self.kind(name).default_number(0.6).is_none_or(|default| default <= *least) {
                    set(name, (least + 2.0).to_string());
                }
            }
            Need::BelowPitches(name, most) => set(name, (0.5 * most * 0.6).to_string()),
            Need::Nonzero(name) => set(name, "2".to_owned()),
            Need::Zero(name) => set(name, "0".to_owned()),
            Need::With(role) => given.masks.push(*role),
            Need::Without(role) => given.masks.retain(|mask| mask != role),
            Need::WithoutDepth | Need::WithoutGivenDepth => given.has_depth = false,
            Need::WithGivenDepth => given.has_depth = true,
            Need::WithFace => given.has_face = true,
            Need::WithoutFace => given.has_face = false,
            Need::AnyOf(lists) => lists[0].iter().for_each(|need| self.meet(need, given)),
        }
    }

    fn break_(&self, need: &Need, given: &mut Given) {
        let mut set = |name: &str, value: String| given.set.push((name.to_owned(), value));
        match need {
            Need::Word(name, words) => {
                let Kind::Choice(all) = self.kind(name) else { panic!("{name} is no choice") };
                let other = all.iter().find(|word| !words.contains(word)).expect("a word that does not do");
                set(name, (*other).to_owned());
            }
            Need::Above(name, least) => set(name, least.to_string()),
            Need::BelowPitches(name, most) => set(name, (1.1 * most * 0.6).to_string()),
            Need::Nonzero(name) => set(name, "0".to_owned()),
            Need::Zero(name) => set(name, "0.7".to_owned()),
            Need::With(role) => given.masks.retain(|mask| mask != role),
            Need::Without(role) => given.masks.push(*role),
            Need::WithoutDepth | Need::WithoutGivenDepth => given.has_depth = true,
            Need::WithGivenDepth => given.has_depth = false,
            Need::WithFace => given.has_face = false,
            Need::WithoutFace => given.has_face = true,
            Need::AnyOf(lists) => lists.iter().for_each(|all| self.break_(&all[0], given)),
        }
    }

    /// Parameters that should have an effect and have none.
    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for parameter in self.parameters() {
            let mut on = Given::default();
            parameter.needs.iter().for_each(|need| self.meet(need, &mut on));
            let plain = self.plain(&on);
            let has_effect = |value: &String| {
                let (drawing, warnings) = self.draw(&on, &[(parameter.name, value)]);
                let is_idle = warnings.contains(&format!("{}=", parameter.name));
                if is_idle {
                    println!("{} {}={value}: {warnings}", self.style, parameter.name);
                }
                drawing != plain && !is_idle
            };
            let candidates = candidates(parameter);
            if !candidates.iter().any(has_effect) {
                faults.push(format!("{} {} changes nothing with {:?}", self.style, parameter.name, on.set));
            }
            for need in parameter.needs {
                let mut off = on.clone();
                self.break_(need, &mut off);
                let value = &candidates[0];
                let (drawing, warnings) = self.draw(&off, &[(parameter.name, value)]);
                let says = |text: &str| warnings.contains(text);
                if !says(&format!("{}=", parameter.name)) || !says(&need.text()) {
                    faults.push(format!("{} {}={value} without {}: {warnings}", self.style, parameter.name, need.text()));
                } else if drawing != self.plain(&off) {
                    faults.push(format!("{} {}={value} has an effect without {}", self.style, parameter.name, need.text()));
                }
            }
        }
        faults
    }
}

/// Values to try, other than the default.
fn candidates(parameter: &Parameter) -> Vec<String> {
    match parameter.kind {
        Kind::Choice(words) => words[1..].iter().map(|word| (*word).to_owned()).collect(),
        Kind::Places { .. } => vec!["40,45;60,45".to_owned()],
        Kind::Count { default, least, most } => [default + 1, default / 2, default * 3]
            .into_iter()
            .filter(|n| *n != default)
            .map(|n| n.clamp(least, most).to_string())
            .collect(),
        Kind::Length { least, most, .. } | Kind::Number { least, most, .. } => {
            let default = parameter.kind.default_number(0.6).unwrap();
            let some = [default * 0.4, default * 2.3, default + 0.3 * (most - default).min(2.0), least];
            some.into_iter().map(|v| v.clamp(least, most)).filter(|v| *v != default).map(|v| v.to_string()).collect()
        }
    }
}

fn png(width: u32, height: u32, colour: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let picture = RgbImage::from_fn(width, height, |x, y| Rgb(colour(x, y)));
    DynamicImage::ImageRgb8(picture).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A colourful ball with spots on a pale ground, in every tone from black to white, with edges faint and strong.
fn still_life() -> Vec<u8> {
    png(240, 240, |x, y| {
        let (dx, dy) = (f64::from(x) - 120.0, f64::from(y) - 120.0);
        let away = dx.hypot(dy) / 80.0;
        let spot = ((f64::from(x) * 0.21).sin() * (f64::from(y) * 0.17).cos()).abs();
        let value = if away < 1.0 {
            (1.0 - away * away).sqrt() * (0.5 - 0.4 * dx / 80.0) + 0.12 * spot
        } else {
            0.75 + 0.05 * (dx * 0.01)
        };
        let band = if (y / 20) % 5 == 0 { 0.55 } else { 1.0 };
        let level = (value * band).clamp(0.0, 1.0);
        [(255.0 * level) as u8, (255.0 * level.powf(1.2)) as u8, (255.0 * level.powf(0.8) * (0.7 + 0.3 * spot)) as u8]
    })
}

fn lines() -> Vec<u8> {
    png_of_light(240, 240, |x, y| f64::from(u8::from((x.abs_diff(80) < 2 && y > 30) || (y.abs_diff(150) < 2 && x > 20))))
}

fn trial(style: &'static str, set: &'static [(&'static str, &'static str)]) -> Trial {
    let scribbles = png(240, 240, |x, y| match (x, y) {
        (20..60, 20..60) => [250, 30, 30],
        (100..140, 100..140) => [30, 60, 250],
        _ => [0, 0, 0],
    });
    let masks = vec![
        (MaskRole::Edges, lines()),
        (MaskRole::Isophotes, lines()),
        (MaskRole::Detail, png_of_light(240, 240, |x, _| f64::from(u8::from(x > 120)))),
        (MaskRole::Scribbles, scribbles),
        (MaskRole::Hair, png_of_light(240, 240, |_, y| f64::from(u8::from(y < 120)))),
        (MaskRole::Clothing, png_of_light(240, 240, |_, y| f64::from(u8::from(y > 180)))),
        (MaskRole::Headwear, png_of_light(240, 240, |x, _| f64::from(u8::from(x > 180)))),
        (MaskRole::FacialHair, png_of_light(240, 240, |_, y| f64::from(u8::from(y > 200)))),
    ];
    let depth = png_of_light(240, 240, |x, y| 0.2 + 0.003 * f64::from(x.min(y)));
    Trial { style, photo: still_life(), mm: (24.0, 24.0), set, masks, depth, plain: Mutex::default() }
}

fn check(trial: &Trial) {
    let faults = trial.faults();
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn every_parameter_of_hedcut() {
    check(&trial("hedcut", &[]));
}

#[test]
fn every_parameter_of_grid() {
    check(&trial("grid", &[]));
}

#[test]
fn every_parameter_of_engrave() {
    check(&trial("engrave", &[]));
}

#[test]
fn every_parameter_of_glass() {
    check(&trial("glass", &[]));
}

#[test]
fn every_parameter_of_charcoal() {
    // Face and hair are needed; coarse grain is fast.
    let (photo, masks) = (sample("bust-light.png"), vec![(MaskRole::Subject, sample("bust-mask-subject.png"))]);
    check(&Trial { photo, mm: (30.0, 40.0), masks, ..trial("charcoal", &[("grain", "2mm")]) });
}

#[test]
fn a_default_that_is_spelled_out_is_no_wish() {
    let photo = still_life();
    let order = Order::new("hedcut", &photo, (20.0, 20.0), &[("edge_blur", "0.24"), ("size_gamma", "1.2")]);
    assert_eq!(order.try_draw().1, "");
}

/// Only the longest edges, whichever detector finds them.
#[test]
fn a_hedcut_s_outline_is_of_the_longest_lines() {
    let photo = sample("grace-hopper.jpg");
    for lines in ["coherent", "canny"] {
        for least in [4.0, 12.0] {
            let set = [("lines", lines), ("outline_length", if least > 5.0 { "12" } else { "4" })];
            let drawing = Order::new("hedcut", &photo, (60.0, 70.312), &set).draw();
            let lengths: Vec<f64> = drawing.layers[1]
                .marks
                .iter()
                .filter_map(|mark| if let drypoint::drawing::Mark::Stroke(stroke) = mark { Some(stroke.length()) } else { None })
                .collect();
            let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
            println!("{lines}, {least}: {} lines, the shortest {shortest:.2} mm", lengths.len());
            // The parts that the picture's border cuts off a line are not counted.
            assert!(!lengths.is_empty() && shortest > least - 1.5, "{lines}: {shortest} of {least}");
        }
    }
}
