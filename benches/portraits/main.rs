//! Likeness of drawn faces, and their tone: `cargo bench --bench portraits [-- FOLDER [STYLE]]`.
//!
//! Each photograph of a person (those of `samples`, or all JPEG and PNG files of a folder) is drawn in every style by the whole
//! command, with no mask and default settings, and printed by resvg. The face detector that analysed the photograph then analyses
//! the print: how far have eyes, nose and mouth moved? Then the tone of the faces as hedcuts is measured on the print.

mod face_tone;
mod likeness;
mod print;
mod sitter;

use face_tone::FaceTone;
use likeness::Row;
use print::Print;
use sitter::{Sitter, Skin};
use std::path::Path;

/// One way to draw.
struct Way {
    name: &'static str,
    options: &'static [&'static str],
    /// Limit of the median displacement of a feature, in percent of the distance between the eyes.
    limit: f64,
}

/// Portraits are 90 mm wide by default.
const WAYS: [Way; 6] = [
    Way { name: "hedcut", options: &["--style", "hedcut"], limit: 3.0 },
    Way { name: "grid", options: &["--style", "grid"], limit: 3.0 },
    Way { name: "engrave", options: &["--style", "engrave"], limit: 3.0 },
    Way { name: "charcoal", options: &["--style", "charcoal"], limit: 3.0 },
    Way { name: "glass", options: &["--style", "glass"], limit: 3.0 },
    Way { name: "hedcut 38x50", options: &["--crop", "head", "--size", "38x50mm", "--set", "pitch=0.35"], limit: 5.0 },
];
/// Pixels per millimetre of the print for the face detector, which reduces it itself.
const TO_LOOK_AT: f64 = 20.0;
/// Pixels per millimetre at which ink is measured: at half as many resvg is off by 0.018 on small dots.
const TO_WEIGH: f64 = 40.0;

fn main() {
    let mut arguments = std::env::args().skip(1).filter(|argument| !argument.starts_with('-'));
    let (folder, only) = (arguments.next(), arguments.next());
    let paths = sitter::photographs(folder.as_deref().map(Path::new));
    let (sitters, faceless): (Vec<Sitter>, Vec<String>) = sitter::seen(&paths);
    faceless.iter().for_each(|name| println!("{name}: no face found, left out"));
    assert!(!sitters.is_empty(), "there is no portrait to draw");
    let place = tempfile::tempdir().expect("a folder for the drawings");
    let count = |skin: Skin| sitters.iter().filter(|sitter| sitter.skin() == skin).count();
    println!(
        "{} portraits; complexions: {} light, {} brown, {} dark\n",
        sitters.len(),
        count(Skin::Light),
        count(Skin::Brown),
        count(Skin::Dark)
    );
    println!("likeness: medians in % of the distance of the eyes");
    println!(
        "{:14} {:>7} {:>6} {:>6} {:>6}          all three: {:>6} {:>6} {:>6}",
        "", "found", "eyes", "nose", "mouth", "light", "brown", "dark"
    );
    let mut hedcuts = Vec::new();
    for way in WAYS.iter().filter(|way| only.as_ref().is_none_or(|only| only == way.name)) {
        let drawings: Vec<String> = sitters.iter().map(|sitter| print::drawn(&sitter.path, way.options, place.path())).collect();
        let row = |(sitter, svg): (&Sitter, &String)| Row::new(sitter, likeness::likeness(sitter, &Print::new(svg, TO_LOOK_AT)));
        let rows: Vec<Row> = sitters.iter().zip(&drawings).map(row).collect();
        likeness::report(way.name, &rows, way.limit);
        if way.name == "hedcut" {
            hedcuts = drawings;
        }
    }
    if hedcuts.is_empty() {
        return;
    }
    println!("\ntone of faces, hedcut 90 mm wide");
    let weighed = |(sitter, svg): (&Sitter, &String)| face_tone::measured(sitter, &Print::new(svg, TO_WEIGH));
    let tones: Vec<(&str, FaceTone)> = sitters.iter().zip(&hedcuts).map(|pair| (pair.0.name.as_str(), weighed(pair))).collect();
    face_tone::report(&tones);
}

fn kept(is_kept: bool) -> &'static str {
    if is_kept { "kept" } else { "MISSED" }
}
