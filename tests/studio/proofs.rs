//! Coarse drawings from small copies of a photograph lie where those of the photograph itself do.

use crate::asking::sample;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Draws `large.jpg` coarsely.
fn drafted(folder: &Path, proofs: Option<&Path>, options: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let words = ["draw", "large.jpg", "-o", "out.json", "--draft", "--sight", "none", "-q"];
    command.current_dir(folder).args(words).args(options).envs(proofs.map(|folder| ("DRYPOINT_PROOFS", folder)));
    command.output().unwrap()
}

/// The report of a coarse drawing of a part of `large.jpg`, which reaches its lower border.
fn report(folder: &Path, proofs: Option<&Path>) -> Value {
    let output = drafted(folder, proofs, &["--json", "--crop", "300,200,900,880", "--size", "60x55mm"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn enlarged(file: &Path, name: &str) {
    let picture = image::open(sample(name)).unwrap();
    picture.resize_exact(1920, 1080, image::imageops::FilterType::Triangle).to_rgb8().save(file).unwrap();
}

#[test]
fn a_copy_is_drawn_where_its_photograph_would_be() {
    let folder = tempfile::tempdir().unwrap();
    let proofs = folder.path().join("proofs");
    fs::create_dir(&proofs).unwrap();
    enlarged(&folder.path().join("large.jpg"), "astronaut.jpg");
    let own = report(folder.path(), None);
    let copies = || fs::read_dir(&proofs).unwrap().count();
    for _ in 0..2 {
        let small = report(folder.path(), Some(&proofs));
        assert_eq!(small["picture"]["pixels"], own["picture"]["pixels"]);
        for (key, within) in [("to_sheet", 0.05), ("box", 0.05)] {
            let numbers = |report: &Value| report["picture"][key].as_array().unwrap().clone();
            for (small, own) in numbers(&small).iter().zip(&numbers(&own)) {
                let off = (small.as_f64().unwrap() - own.as_f64().unwrap()).abs();
                assert!(off < within, "{key}: {small} and {own}");
            }
        }
        let ink = |report: &Value| report["layers"][0]["ink_mm2"].as_f64().unwrap();
        assert!((ink(&small) / ink(&own) - 1.0).abs() < 0.05, "{} and {}", ink(&small), ink(&own));
        assert_eq!(copies(), 1, "the copy is made once");
    }
    enlarged(&folder.path().join("large.jpg"), "grace-hopper.jpg");
    report(folder.path(), Some(&proofs));
    assert_eq!(copies(), 2, "another photograph under the same name has a copy of its own");
}

#[test]
fn masks_of_full_size_fit_a_copy() {
    let folder = tempfile::tempdir().unwrap();
    let proofs = folder.path().join("proofs");
    fs::create_dir(&proofs).unwrap();
    enlarged(&folder.path().join("large.jpg"), "astronaut.jpg");
    image::GrayImage::from_pixel(1920, 1080, image::Luma([255])).save(folder.path().join("white.png")).unwrap();
    for role in ["subject", "edges", "highlights", "directions"] {
        let mask = format!("{role}=white.png");
        let output = drafted(folder.path(), Some(&proofs), &["--style", "grid", "--mask", &mask]);
        let said = String::from_utf8_lossy(&output.stderr);
        // All of it a highlight: nothing is left to draw, which is said.
        assert!(output.status.success() || (role == "highlights" && said.contains("white all over")), "{role}: {said}");
    }
}
