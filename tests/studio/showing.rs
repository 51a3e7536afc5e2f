//! What the page shows is what the command makes.

use crate::asking::{Studio, folder, small};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// Runs a command as the page gives it.
fn typed(folder: &Path, command: &str) {
    let words: Vec<&str> = command.split(' ').collect();
    assert_eq!(words[0], "drypoint");
    let status = Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(&words[1..]).arg("-q").status();
    assert!(status.unwrap().success(), "{command}");
}

/// Changes of a recipe, spread over styles and options by a simple generator.
fn recipe(number: u64) -> Value {
    let pick = |salt: u64, count: u64| (number.wrapping_mul(2_654_435_761).wrapping_add(salt * 40_503) >> 7) % count;
    let styles = ["hedcut", "grid", "engrave", "charcoal", "glass"];
    json!([
        { "path": ["style"], "value": styles[pick(1, 5) as usize] },
        { "path": ["size"], "value": format!("{}x{}mm", 14 + pick(2, 8), 18 + pick(3, 8)) },
        { "path": ["set", "pitch"], "value": 0.5 + pick(4, 60) as f64 / 100.0 },
        { "path": ["gamma"], "value": 0.7 + pick(5, 8) as f64 / 10.0 },
        { "path": ["seed"], "value": pick(6, 100) },
        { "path": ["mirror"], "value": pick(7, 2) == 0 },
        { "path": ["background"], "value": if pick(8, 3) == 0 { json!("keep") } else { Value::Null } },
    ])
}

#[test]
fn exports_are_the_copied_command_byte_for_byte() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    let endings = [("svg", None), ("pdf", None), ("hpgl", Some("hp7475a")), ("gcode", Some("grbl-servo")), ("json", None)];
    for number in 0..10 {
        studio.change(&format!("recipe {number}"), &recipe(number)).accepted();
        let (ending, profile) = endings[number as usize % endings.len()];
        let file = format!("export.{ending}");
        let told = studio.post("/api/export", &json!({ "file": file, "profile": profile })).accepted();
        let exported = fs::read(folder.path().join(&file)).unwrap();
        assert_eq!(told["bytes"], exported.len());
        let query = profile.map(|profile| format!("&profile={profile}")).unwrap_or_default();
        let downloaded = studio.get(&format!("/api/export?file={file}{query}")).body;
        assert!(downloaded == exported, "recipe {number}: the download differs");
        assert_eq!(studio.get("/api/scene").accepted()["command"], told["command"]);
        fs::remove_file(folder.path().join(&file)).unwrap();
        typed(folder.path(), told["command"].as_str().unwrap());
        assert!(fs::read(folder.path().join(&file)).unwrap() == exported, "recipe {number}: the command makes something else");
    }
}

#[test]
fn the_drawing_shown_is_the_command_s_and_lies_where_it_says() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    studio.change("size", &small()).accepted();
    let shown = studio.drawn().unwrap();
    typed(folder.path(), "drypoint draw portrait.toml -o drawn.json");
    let drawn: Value = serde_json::from_slice(&fs::read(folder.path().join("drawn.json")).unwrap()).unwrap();
    assert_eq!(shown["marks"], drawn);
    assert_eq!(shown["quality"], "full");
    let pixels = &studio.get("/api/scene").accepted()["photograph"];
    let place = &shown["placement"];
    assert_eq!((&place["pixels"][0], &place["pixels"][1]), (&pixels["width"], &pixels["height"]));
    let number = |i: usize| place["to_sheet"][i].as_f64().unwrap();
    let (width, height) = (place["pixels"][0].as_f64().unwrap(), place["pixels"][1].as_f64().unwrap());
    let corner = [number(0) * width + number(2) * height + number(4), number(1) * width + number(3) * height + number(5)];
    let page = [0, 1].map(|i| drawn["page_mm"][i].as_f64().unwrap());
    assert!((corner[0] - page[0]).abs() < 0.01 && (corner[1] - page[1]).abs() < 0.01, "{corner:?} of {page:?}");
    let jpeg = studio.get("/api/photograph?long=200").body;
    let picture = image::load_from_memory(&jpeg).unwrap();
    assert_eq!(picture.width().max(picture.height()), 200);
}

#[test]
fn a_newer_change_ends_the_older_drawing() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    // The sight of the photograph first, so that changes find a drawing on its way.
    studio.events(|name, _| name == "started");
    let mut waits = Vec::new();
    for i in 0..10 {
        let begun = Instant::now();
        let change = json!([{ "path": ["set", "pitch"], "value": 0.4 + f64::from(i) / 50.0 }]);
        let revision = studio.change("pitch", &change).accepted()["revision"].clone();
        studio.events(|name, data| ["started", "finished"].contains(&name) && data["revision"] == revision);
        waits.push(begun.elapsed());
        std::thread::sleep(std::time::Duration::from_millis(60));
    }
    println!("from a change to the new drawing's start: {waits:?}");
    // Older drawings are never shown as the present one.
    let drawn = studio.drawn().unwrap();
    assert_eq!(drawn["revision"], studio.get("/api/scene").accepted()["revision"]);
}

#[test]
fn faults_of_a_recipe_are_told_in_the_command_s_words() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    studio.change("style", &json!([{ "path": ["style"], "value": "hedcat" }])).accepted();
    assert!(studio.drawn().unwrap_err().contains("there is no style 'hedcat'"));
    studio.change("style", &json!([{ "path": ["style"], "value": null }, { "path": ["size"], "value": "20x25mm" }])).accepted();
    assert!(studio.drawn().is_ok());
    let plot = studio.get("/api/plot?profile=grbl-servo").accepted();
    assert!(plot["seconds"].as_f64().unwrap() > 1.0 && !plot["marks"]["layers"].as_array().unwrap().is_empty());
    let stages = studio.get("/api/stages").accepted()["stages"].as_array().unwrap().clone();
    assert!(
        stages.iter().any(|stage| stage["name"] == "tone") && stages.iter().any(|stage| stage["name"] == "drawing"),
        "{stages:?}"
    );
    assert_eq!(stages.last().unwrap()["name"], "tone error");
    let picture = studio.get(&format!("/api/stage/{}", stages[0]["file"].as_str().unwrap()));
    // Made once for each state of the scene.
    let revision = |answer: Value| answer["revision"].clone();
    assert_eq!(revision(studio.get("/api/stages").accepted()), revision(studio.get("/api/scene").accepted()));
    assert!(picture.status == 200 && picture.body.starts_with(b"\x89PNG"));
    let thumbnail = studio.get("/api/thumbnail/wsj-column");
    assert!(thumbnail.status == 200 && thumbnail.body.starts_with(b"<svg"), "{}", String::from_utf8_lossy(&thumbnail.body));
    assert!(studio.get("/api/thumbnail/none-such").refusal().contains("none-such"));
    let tables = studio.get("/api/start").accepted();
    assert_eq!(tables["styles"].as_array().unwrap().len(), 5);
    assert!(tables["styles"][0]["parameters"].as_array().unwrap().len() > 5);
    assert!(!tables["presets"].as_array().unwrap().is_empty() && !tables["profiles"].as_array().unwrap().is_empty());
}
