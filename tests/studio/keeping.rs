//! The scene is the only truth: it is written at once, undone, followed, and never broken.

use crate::asking::{Studio, folder, small};
use serde_json::{Value, json};
use std::fs;
use std::time::{Duration, Instant};

fn pitch(value: f64) -> Value {
    json!([{ "path": ["set", "pitch"], "value": value }])
}

#[test]
fn a_hundred_steps_are_undone_and_made_again() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    let text = |state: &Value| state["toml"].as_str().unwrap().to_owned();
    let mut texts = vec![text(&studio.get("/api/scene").accepted())];
    for i in 0..120 {
        texts.push(text(&studio.change(&format!("step {i}"), &pitch(0.5 + f64::from(i) / 100.0)).accepted()));
    }
    for before in texts.iter().rev().skip(1) {
        assert_eq!(text(&studio.post("/api/undo", &json!(null)).accepted()), *before);
    }
    assert_eq!(studio.post("/api/undo", &json!(null)).accepted()["undo"], 0);
    for after in &texts[1..] {
        assert_eq!(text(&studio.post("/api/redo", &json!(null)).accepted()), *after);
    }
    assert_eq!(fs::read_to_string(folder.path().join("portrait.toml")).unwrap(), texts[120]);
}

#[test]
fn two_pages_and_an_editor_do_not_fight() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    std::thread::scope(|scope| {
        for page in ["pitch", "blob"] {
            let studio = &studio;
            scope.spawn(move || {
                for i in 0..40 {
                    let change = json!([{ "path": ["set", page], "value": 0.3 + f64::from(i) / 100.0 }]);
                    studio.change(page, &change).accepted();
                }
            });
        }
    });
    assert_eq!(studio.get("/api/scene").accepted()["values"]["set"], json!({ "pitch": 0.69, "blob": 0.69 }));
    let file = folder.path().join("portrait.toml");
    let edited = fs::read_to_string(&file).unwrap().replace("photograph", "# by hand\nstyle = \"grid\"\nphotograph");
    fs::write(&file, &edited).unwrap();
    let until = |wanted: &dyn Fn(&Value) -> bool| {
        let begun = Instant::now();
        while !wanted(&studio.get("/api/scene").accepted()) {
            assert!(begun.elapsed() < Duration::from_secs(20), "the file is not followed");
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    until(&|state| state["values"]["style"] == "grid");
    // A comment made by hand outlives a change on the page, and the edit can be undone.
    assert!(studio.change("pitch", &pitch(1.0)).accepted()["toml"].as_str().unwrap().starts_with("# by hand"));
    studio.post("/api/undo", &json!(null)).accepted();
    assert!(!studio.post("/api/undo", &json!(null)).accepted()["toml"].as_str().unwrap().contains("by hand"));
    fs::write(&file, "photograph = ").unwrap();
    until(&|state| state["error"].as_str().is_some_and(|error| error.contains("portrait.toml")));
    fs::write(&file, &edited).unwrap();
    until(&|state| state["error"].is_null() && state["values"]["style"] == "grid");
}

#[test]
fn painted_masks_belong_to_the_scene_and_are_undone() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    studio.change("size", &small()).accepted();
    let before = studio.drawn().unwrap();
    let found = studio.get("/api/mask/subject").body;
    assert!(found.starts_with(b"\x89PNG"));
    // Half the person is painted away.
    let mut mask = image::load_from_memory(&found).unwrap().to_luma8();
    let (width, height) = mask.dimensions();
    for (x, y) in (0..width / 2).flat_map(|x| (0..height).map(move |y| (x, y))) {
        mask.put_pixel(x, y, image::Luma([0]));
    }
    let mut painted = std::io::Cursor::new(Vec::new());
    mask.write_to(&mut painted, image::ImageFormat::Png).unwrap();
    let state = studio.ask("PUT", "/api/mask/subject", painted.get_ref()).accepted();
    assert_eq!(state["values"]["sight"], "portrait-sight");
    assert_eq!(studio.get("/api/mask/subject").body, *painted.get_ref());
    let roles = studio.get("/api/masks").accepted();
    assert_eq!(roles["size"], json!([width, height]));
    let subject = roles["roles"].as_array().unwrap().iter().find(|role| role["role"] == "subject").unwrap().clone();
    assert_eq!(subject["is_painted"], true);
    let after = studio.drawn().unwrap();
    let marks = |drawing: &Value| {
        let layers = drawing["marks"]["layers"].as_array().unwrap();
        layers.iter().map(|layer| layer["dots"].as_array().unwrap().len()).sum::<usize>()
    };
    assert!(marks(&after) * 4 < marks(&before) * 3, "{} and {}", marks(&after), marks(&before));
    assert!(studio.post("/api/undo", &json!(null)).accepted()["values"].get("sight").is_none());
    assert_eq!(studio.drawn().unwrap()["marks"], before["marks"]);
    studio.post("/api/redo", &json!(null)).accepted();
    assert_eq!(studio.get("/api/mask/subject").body, *painted.get_ref());
    let state = studio.ask("PUT", "/api/mask/edges", painted.get_ref()).accepted();
    assert_eq!(state["values"]["mask"], json!({ "edges": "portrait-edges.png" }));
    assert_eq!(studio.get("/api/mask/edges").body, *painted.get_ref());
    assert!(studio.post("/api/undo", &json!(null)).accepted()["values"].get("mask").is_none());
    assert!(!folder.path().join("portrait-edges.png").exists() && studio.get("/api/mask/edges").status == 404);
    studio.post("/api/redo", &json!(null)).accepted();
    assert!(studio.ask("DELETE", "/api/mask/edges", &[]).accepted()["values"].get("mask").is_none());
    studio.ask("DELETE", "/api/mask/subject", &[]).accepted();
    assert_eq!(studio.get("/api/mask/subject").body, found);
}

/// Killed at fifty moments: what was answered is in the file, which is never broken.
#[test]
fn a_kill_loses_nothing_that_was_answered() {
    let folder = folder();
    let file = folder.path().join("portrait.toml");
    for round in 0..50_u64 {
        let studio = Studio::open(folder.path(), Some("portrait.jpg"));
        let end = Duration::from_micros(round * 1777 % 40_000);
        let begun = Instant::now();
        let (mut answered, mut asked) = (None, 0.0);
        while begun.elapsed() < end {
            asked = 0.3 + (begun.elapsed().as_micros() % 1000) as f64 / 1000.0;
            studio.change("pitch", &pitch(asked)).accepted();
            answered = Some(asked);
        }
        studio.kill();
        let text = fs::read_to_string(&file).unwrap();
        let scene: toml::Table = text.parse().unwrap_or_else(|error| panic!("{error}: {text}"));
        if let Some(answered) = answered {
            assert_eq!(scene["set"]["pitch"].as_float(), Some(answered), "asked {asked}");
        }
    }
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "{left:?}");
}
