//! A hedcut is small, and a portrait (Bruehl 2023, section 0.1.1): in a newspaper's column the busts' faces are found where the
//! photographs' are.
#![cfg(all(feature = "cli", feature = "see"))]

#[allow(dead_code)]
#[path = "../../benches/portraits/print.rs"]
mod print;

use crate::common::sample;
use drypoint::interrupt::Interrupt;
use drypoint::see::look;
use drypoint::source::{Landmarks, Limits, Photograph};
use print::{Print, drawn};
use std::path::Path;

/// A newspaper's half column, and the pixels at which it is looked at: 300 to the inch.
const COLUMN_MM: (f64, f64) = (38.0, 50.0);
const PIXELS_PER_MM: f64 = 12.0;
/// Most displacement of the eyes in the mean, as a share of the distance between them.
const MOST: f64 = 0.05;

fn only_face(photograph: &Photograph) -> Landmarks {
    let sight = look(photograph, &Interrupt::never()).unwrap();
    assert_eq!(sight.faces.len(), 1, "one face");
    sight.faces[0].landmarks.clone()
}

#[test]
fn in_a_column_each_bust_is_a_portrait() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["bust-light.png", "bust-brown.png", "bust-dark.png"] {
        let photo = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(name);
        let print = Print::new(&drawn(&photo, &["--preset", "wsj-column"], folder.path()), PIXELS_PER_MM);
        assert!(print.picture.width() <= COLUMN_MM.0 + 0.01 && print.picture.height() <= COLUMN_MM.1 + 0.01, "{name}: small");
        let there = only_face(&Photograph::decode(&sample(name), Limits::default()).unwrap());
        let there = there.placed(|p| print.place(p), print.scale());
        let here = only_face(&print.photograph());
        let irises = there.irises.iter().zip(&here.irises);
        let off = irises.map(|(there, here)| 0.5 * there.centre.distance(here.centre)).sum::<f64>() / there.eye_distance();
        assert!(off < MOST, "{name}: its eyes are {off:.3} of their distance off");
        let width = there.eye_distance() / PIXELS_PER_MM;
        assert!(width > 0.15 * COLUMN_MM.0, "{name}: the head fills the column, eyes {width:.1} mm apart");
    }
}
