//! Coarse drawings from small copies of a photograph lie where those of the photograph itself do.

use crate::asking::sample;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The report of a coarse drawing of a part of `large.jpg`.
fn report(folder: &Path, proofs: Option<&Path>) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let words = ["draw", "large.jpg", "-o", "out.json", "--draft", "--json", "--sight", "none", "-q"];
    command.current_dir(folder).args(words).args(["--crop", "300,200,1200,1100", "--size", "60x55mm"]);
    command.envs(proofs.map(|folder| ("DRYPOINT_PROOFS", folder)));
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn enlarged(file: &Path, name: &str) {
    let picture = image::open(sample(name)).unwrap();
    picture.resize_exact(2000, 1800, image::imageops::FilterType::Triangle).to_rgb8().save(file).unwrap();
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
        for (key, within) in [("to_sheet", 1e-6), ("box", 1e-6)] {
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
