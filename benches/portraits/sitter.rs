//! The people: photographs and what was detected in them.

use drypoint::geometry::Point;
use drypoint::interrupt::Interrupt;
use drypoint::raster::{Raster, filled_polygon};
use drypoint::see::{Sight, look};
use drypoint::source::{Crop, Landmarks, Limits, Photograph, lab, outlines, srgb_to_linear};
use std::path::{Path, PathBuf};

/// The portraits among the samples.
const SAMPLES: [&str; 5] = ["astronaut.jpg", "bust-brown.png", "bust-dark.png", "bust-light.png", "grace-hopper.jpg"];

/// One portrait.
pub struct Sitter {
    pub name: String,
    pub path: PathBuf,
    pub photograph: Photograph,
    pub sight: Sight,
    /// Median L* of the skin within the outline of the face.
    skin_lightness: f64,
}

/// Complexion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skin {
    /// 1 to 4 on the scale of Monk; a median L* of 60 and more.
    Light,
    /// 5 and 6.
    Brown,
    /// 7 to 10; a median L* below 45.
    Dark,
}

/// Complexions of the sixteen portraits on the scale of Monk (1 to 10), judged by eye without knowledge of any measurement. Their median L*
/// tells the light of the picture as much as the skin: it calls 10 and 13, pale and in shade, dark.
const MONK: [(&str, u8); 16] = [
    ("01", 7),
    ("02", 6),
    ("03", 7),
    ("04", 6),
    ("05", 5),
    ("06", 6),
    ("07", 6),
    ("08", 3),
    ("09", 6),
    ("10", 4),
    ("11", 5),
    ("12", 4),
    ("13", 2),
    ("14", 2),
    ("15", 3),
    ("16", 5),
];

impl Sitter {
    /// The largest face.
    pub fn face(&self) -> &Landmarks {
        &self.sight.faces[0].landmarks
    }

    /// By eye where it was judged, else by the median L*.
    pub fn skin(&self) -> Skin {
        match MONK.iter().find(|(name, _)| *name == self.name) {
            Some((_, 1..=4)) => return Skin::Light,
            Some((_, 5 | 6)) => return Skin::Brown,
            Some(_) => return Skin::Dark,
            None => {}
        }
        match self.skin_lightness {
            light if light >= 60.0 => Skin::Light,
            dark if dark < 45.0 => Skin::Dark,
            _ => Skin::Brown,
        }
    }
}

/// The files of a folder, or the samples.
pub fn photographs(folder: Option<&Path>) -> Vec<PathBuf> {
    let Some(folder) = folder else {
        return SAMPLES.iter().map(|name| Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(name)).collect();
    };
    let is_photograph =
        |path: &PathBuf| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("jpg") || end.eq_ignore_ascii_case("png"));
    let entries = std::fs::read_dir(folder).expect("the folder can be read");
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).filter(is_photograph).collect();
    paths.sort();
    paths
}

/// Those with a face, and the names of the others.
pub fn seen(paths: &[PathBuf]) -> (Vec<Sitter>, Vec<String>) {
    let (mut sitters, mut faceless) = (Vec::new(), Vec::new());
    for path in paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let bytes = std::fs::read(path).expect("the photograph can be read");
        let photograph = Photograph::decode(&bytes, Limits::default()).expect("it is a photograph");
        let sight = look(&photograph, &Interrupt::never()).expect("it can be looked at");
        if sight.faces.is_empty() {
            faceless.push(name);
        } else {
            let skin_lightness = skin_lightness(&photograph, &sight);
            sitters.push(Sitter { name, path: path.clone(), photograph, sight, skin_lightness });
        }
    }
    (sitters, faceless)
}

fn skin_lightness(photograph: &Photograph, sight: &Sight) -> f64 {
    let skin = &sight.regions.as_ref().expect("there is a face").skin;
    let pixels = photograph.encoded(Crop::all(photograph), skin.width(), skin.height()).expect("it was decoded");
    let scale = skin.width() as f64 / f64::from(sight.width);
    let oval: Vec<Point> =
        sight.faces[0].landmarks.line(&outlines::OVAL).iter().map(|p| (p.to_vec2() * scale).to_point()).collect();
    let inside = inside(&oval, skin.width(), skin.height());
    let lightness = |rgb: [u8; 3]| f64::from(lab(rgb.map(|v| srgb_to_linear(f32::from(v) / 255.0)))[0]);
    let places = pixels.pixels().iter().zip(skin.pixels()).zip(inside.pixels());
    median(places.filter(|((_, skin), inside)| **skin > 127 && **inside == 1).map(|((rgb, _), _)| lightness(*rgb)).collect())
}

/// The pixels inside an outline.
pub fn inside(outline: &[Point], width: usize, height: usize) -> Raster<u8> {
    let corners: Vec<[f64; 2]> = outline.iter().map(|p| [p.x, p.y]).collect();
    filled_polygon(width, height, &corners)
}

/// The median; NaN for an empty list.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        odd if odd % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}
