//! Photographs in a few pens, looked at through a simulated microscope: how near their colours come, beside naive CMYK.
#![cfg(feature = "cli")]

use crate::common::sample;
use crate::microscope::{COARSE, FINE, Inked, differences, from_afar, printed};
use crate::photographed::Light;
use drypoint::colour::{ColourPen, Paper, PenSet, Separator, Settings, drawing_order};
use image::imageops::FilterType;
use image::{GrayImage, Luma, RgbImage};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;

const CMYK: &[(&str, &str)] = &[("y", "#f4dc2c"), ("c", "#1b9fd0"), ("m", "#bf3a8f"), ("k", "#38373a")];
/// Pigma Micron, by the library of pens.
const FOUR: &[(&str, &str)] = &[("yellow", "#f9e43b"), ("red", "#f86a68"), ("blue", "#1681d3"), ("black", "#47484d")];
/// Triplus fineliners, likewise.
const EIGHT: &[(&str, &str)] = &[
    ("yellow", "#f3d83a"),
    ("lightblue", "#4fb3de"),
    ("orange", "#ee8c36"),
    ("lightgreen", "#86bd4b"),
    ("magenta", "#c33b87"),
    ("red", "#d33b33"),
    ("blue", "#2957a8"),
    ("black", "#343337"),
];
const SAMPLES: [(&str, u32, u32); 4] =
    [("raccoon.jpg", 64, 48), ("coffee.png", 66, 44), ("chelsea.png", 66, 44), ("astronaut.jpg", 54, 54)];
/// Two of them for each set of pens, an easy and a hard one, when not all are drawn.
const DAILY: [[usize; 2]; 3] = [[0, 3], [1, 2], [0, 2]];
const WIDTH: f64 = 0.3;
const PITCH: f64 = 0.5;
/// Seen from where two dots run together.
const BLUR: f64 = 2.0 * PITCH;
const BORDER: f64 = 3.0;
/// A colour is within the pens' reach if the model comes so near it (CIEDE2000).
const REACHED: f32 = 2.0;
/// By how much pens miss each other, in mm.
const REGISTRATION: f64 = 0.3;

type Pens = &'static [(&'static str, &'static str)];

fn linear(hex: &str) -> [f64; 3] {
    [1, 3, 5].map(|i| linear_of(u8::from_str_radix(&hex[i..i + 2], 16).unwrap()))
}

fn linear_of(v: u8) -> f64 {
    let v = f64::from(v) / 255.0;
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

fn draw(folder: &Path, arguments: &[&str]) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output = command.current_dir(folder).arg("draw").args(arguments).args(["--sight=none", "-q"]).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// A photograph of the size of its drawing.
struct Subject {
    folder: tempfile::TempDir,
    picture: RgbImage,
    size: String,
    seen: Light,
}

impl Subject {
    fn new((name, width, height): (&str, u32, u32)) -> Self {
        const DOTS: u32 = 8;
        let folder = tempfile::tempdir().unwrap();
        let picture = image::load_from_memory(&sample(name)).unwrap();
        let picture = picture.resize_to_fill(DOTS * width, DOTS * height, FilterType::CatmullRom).to_rgb8();
        picture.save(folder.path().join("photo.png")).unwrap();
        let pixels = picture.pixels().map(|p| p.0.map(|v| linear_of(v) as f32)).collect();
        let light = Light { width: (DOTS * width) as usize, height: (DOTS * height) as usize, pixels };
        let seen = from_afar(&light, DOTS as usize, BLUR);
        Self { folder, picture, size: format!("{width}x{height}mm"), seen }
    }

    fn layers(&self, names: impl Iterator<Item = (String, String)>) -> Vec<(Inked, [f64; 3])> {
        let layer = |(name, ink): (String, String)| {
            let svg = fs::read_to_string(self.folder.path().join(format!("{name}.svg"))).ok()?;
            assert!(svg.contains(&ink), "{name} has no {ink}");
            Some((Inked::of_svg(&svg, &ink), linear(&ink)))
        };
        names.filter_map(layer).collect()
    }

    /// Drawn in pens, one layer a pen.
    fn drawn(&self, style: &str, pens: Pens) -> Vec<(Inked, [f64; 3])> {
        for (name, _) in pens {
            drop(fs::remove_file(self.folder.path().join(format!("{name}.svg"))));
        }
        let table = |(name, ink): &(&str, &str)| format!("[{name}]\ncolour = \"{ink}\"\nwidth = {WIDTH}\n");
        let text = pens.iter().map(table).collect::<Vec<_>>().concat();
        fs::write(self.folder.path().join("pens.toml"), text).unwrap();
        let pitch = PITCH.to_string();
        let how = ["--colours", "pens.toml", "--size", &self.size, "--pitch", &pitch, "--style", style];
        draw(self.folder.path(), &[&["photo.png", "-o", "{layer}.svg"], &how[..]].concat());
        self.layers(
            in_order(pens)
                .into_iter()
                .map(|pen| (pen.name.clone(), pens.iter().find(|(name, _)| *name == pen.name).unwrap().1.to_owned())),
        )
    }

    /// As most programs separate: cyan is what red lacks, grey becomes black, each ink dotted for itself.
    fn naive(&self) -> Vec<(Inked, [f64; 3])> {
        let ink_of = |pixel: [u8; 3], ink: &str| {
            let [r, g, b] = pixel.map(|v| f64::from(v) / 255.0);
            let light = r.max(g).max(b).max(1e-6);
            match ink {
                "c" => 1.0 - r / light,
                "m" => 1.0 - g / light,
                "y" => 1.0 - b / light,
                _ => 1.0 - light,
            }
        };
        for (seed, (name, _)) in CMYK.iter().enumerate() {
            let plate = GrayImage::from_fn(self.picture.width(), self.picture.height(), |x, y| {
                let left = 1.0 - ink_of(self.picture.get_pixel(x, y).0, name);
                let encoded = if left <= 0.003_130_8 { 12.92 * left } else { 1.055 * left.powf(1.0 / 2.4) - 0.055 };
                Luma([(255.0 * encoded).round() as u8])
            });
            plate.save(self.folder.path().join("plate.png")).unwrap();
            let (output, seed, pitch) = (format!("{name}.svg"), seed.to_string(), PITCH.to_string());
            let how = ["--size", &self.size, "--pitch", &pitch, "--tone", "linear", "--seed", &seed, "--set", "highlights=off"];
            draw(self.folder.path(), &[&["plate.png", "-o", &output], &how[..]].concat());
        }
        let black = |name: &str| (name.to_owned(), "#000000".to_owned());
        let plates = self.layers(CMYK.iter().map(|(name, _)| black(name)));
        plates.into_iter().zip(CMYK).map(|((plate, _), (_, ink))| (plate, linear(ink))).collect()
    }

    /// CIEDE2000 within the pens' reach.
    fn differences(&self, layers: &[(Inked, [f64; 3])], reach: &Separator) -> Vec<f64> {
        let layers: Vec<(&Inked, [f64; 3])> = layers.iter().map(|(inked, ink)| (inked, *ink)).collect();
        let seen = from_afar(&printed(&layers), FINE, BLUR);
        let found = differences(&seen, &self.seen, BORDER, |light| reach.error_of(light) <= REACHED);
        assert!(found.len() > 50 * COARSE * COARSE, "hardly any colour can be reached: {}", found.len());
        found
    }
}

fn in_order(pens: Pens) -> Vec<ColourPen> {
    let pens: Vec<ColourPen> = pens.iter().map(|(name, ink)| ColourPen::new(*name, WIDTH, ink.parse().unwrap())).collect();
    drawing_order(&pens).into_iter().map(|pen| pens[pen].clone()).collect()
}

fn reach(pens: Pens) -> Separator {
    Separator::new(&PenSet::new(in_order(pens), Paper::WHITE, Vec::new()).unwrap(), &Settings::default()).unwrap()
}

/// Pens that miss each other by up to so much, each in a direction of its own.
fn moved(layers: &[(Inked, [f64; 3])]) -> Vec<(Inked, [f64; 3])> {
    let place = |i: usize| TAU * (i as f64 / layers.len() as f64 + 0.1);
    let off = 0.5 * REGISTRATION;
    let layer = |(i, (inked, ink)): (usize, &(Inked, [f64; 3]))| (inked.moved(off * place(i).cos(), off * place(i).sin()), *ink);
    layers.iter().enumerate().map(layer).collect()
}

/// Differences of several pictures.
#[derive(Default)]
struct Found(Vec<f64>);

impl Found {
    fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len() as f64
    }

    fn most(&mut self) -> f64 {
        self.0.sort_by(f64::total_cmp);
        self.0[(0.95 * (self.0.len() - 1) as f64) as usize]
    }
}

/// What is accepted of a style: mean and 95 %.
const STYLES: [(&str, f64, f64); 3] = [("hedcut", 3.0, 6.5), ("engrave", 3.0, 6.5), ("grid", 3.0, 6.5)];

/// With `DRYPOINT_MANY` all samples in all pens and styles.
#[test]
fn colours_are_the_photograph_s_and_nearer_than_naive_cmyk() {
    let many = std::env::var_os("DRYPOINT_MANY").is_some();
    let subjects: Vec<Subject> = SAMPLES.into_iter().map(Subject::new).collect();
    let mut hedcut_in_cmyk = 0.0;
    for (set, (name, pens)) in [("CMYK", CMYK), ("four", FOUR), ("eight", EIGHT)].into_iter().enumerate() {
        let reach = reach(pens);
        let shown = || subjects.iter().enumerate().filter(|(i, _)| many || DAILY[set].contains(i)).map(|(_, subject)| subject);
        for (style, mean, most) in if many { &STYLES[..] } else { &STYLES[..1] } {
            let (mut found, mut off) = (Found::default(), Found::default());
            for subject in shown() {
                let layers = subject.drawn(style, pens);
                found.0.extend(subject.differences(&layers, &reach));
                off.0.extend(subject.differences(&moved(&layers), &reach));
            }
            println!("{name} {style}: {:.2}, 95 % within {:.2}; moved {:.2}", found.mean(), found.most(), off.mean());
            assert!(found.mean() <= *mean && found.most() <= *most, "{name} {style}: {:.2}, {:.2}", found.mean(), found.most());
            assert!(off.mean() - found.mean() <= 1.5, "{name} {style}: {:.2} becomes {:.2}", found.mean(), off.mean());
            if (name, *style) == ("CMYK", "hedcut") {
                hedcut_in_cmyk = found.mean();
            }
        }
        if name == "CMYK" {
            let naive = Found(shown().flat_map(|subject| subject.differences(&subject.naive(), &reach)).collect());
            println!("{name} naive: {:.2}", naive.mean());
            assert!(hedcut_in_cmyk <= 0.5 * naive.mean(), "{hedcut_in_cmyk} against {}", naive.mean());
        }
    }
}
