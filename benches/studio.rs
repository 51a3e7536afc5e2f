//! How soon the studio shows what was asked for: `cargo bench --bench studio`. Wants two quiet processors; times are the server's, to
//! the moment at which the page may fetch the drawing.

#[allow(dead_code)]
#[path = "../tests/studio/asking.rs"]
mod asking;

use asking::{Studio, sample};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Changes of a slider that are timed.
const CHANGES: usize = 20;

fn main() {
    let folder = tempfile::tempdir().unwrap();
    twelve_megapixels(&folder.path().join("large.jpg"));
    fs::copy(sample("grace-hopper.jpg"), folder.path().join("portrait.jpg")).unwrap();
    first_drawing(folder.path(), "large.jpg");
    first_drawing(folder.path(), "portrait.jpg");
    slider(folder.path(), "large.jpg");
    slider(folder.path(), "portrait.jpg");
    full(folder.path(), "portrait.jpg");
}

/// The astronaut enlarged to 3464 x 3464 pixels.
fn twelve_megapixels(file: &Path) {
    let picture = image::open(sample("astronaut.jpg")).unwrap();
    picture.resize_exact(3464, 3464, image::imageops::FilterType::CatmullRom).to_rgb8().save(file).unwrap();
}

/// From the command to the first drawing.
fn first_drawing(folder: &Path, photograph: &str) {
    let begun = Instant::now();
    let studio = Studio::open(folder, Some(photograph));
    let listening = begun.elapsed();
    studio.events(|name, data| name == "finished" && data["quality"] == "coarse");
    println!("{photograph}: the page is served after {listening:.2?}, the first drawing is there after {:.2?}", begun.elapsed());
}

/// From a change to the new drawing's start, and to the coarse drawing.
fn slider(folder: &Path, photograph: &str) {
    let studio = Studio::open(folder, Some(photograph));
    studio.events(|name, data| name == "finished" && data["quality"] == "full");
    let (mut started, mut coarse) = (Vec::new(), Vec::new());
    let heard = std::sync::Mutex::new(Vec::<(String, u64, Instant)>::new());
    let last = 2 + CHANGES as u64;
    std::thread::scope(|scope| {
        scope.spawn(|| {
            studio.events(|name, data| {
                let revision = data["revision"].as_u64().unwrap_or_default();
                heard.lock().unwrap().push((name.to_owned(), revision, Instant::now()));
                revision >= last && name == "finished"
            });
        });
        std::thread::sleep(Duration::from_millis(200));
        let when = |event: &str, revision: u64| {
            let heard = heard.lock().unwrap();
            heard.iter().find(|(name, of, _)| name == event && *of == revision).map(|(_, _, moment)| *moment)
        };
        let wait_for = |event: &str, revision: u64| loop {
            match when(event, revision) {
                Some(moment) => return moment,
                None => std::thread::sleep(Duration::from_millis(1)),
            }
        };
        for i in 0..=CHANGES {
            let change = json!([{ "path": ["gamma"], "value": 1.0 + i as f64 / 100.0 }]);
            let begun = Instant::now();
            let revision = studio.change("gamma", &change).accepted()["revision"].as_u64().unwrap();
            started.push(wait_for("started", revision) - begun);
            coarse.push(wait_for("finished", revision) - begun);
            // The next change finds the full drawing on its way.
            std::thread::sleep(Duration::from_millis(100));
        }
    });
    let [started, coarse] = [started, coarse].map(spread);
    println!("{photograph}: a change ends the old drawing and begins the new after {started}; coarse after {coarse}");
}

fn spread(mut times: Vec<Duration>) -> String {
    times.sort();
    let milliseconds = |time: Duration| time.as_secs_f64() * 1000.0;
    let (middle, late) = (milliseconds(times[times.len() / 2]), milliseconds(times[times.len() * 19 / 20]));
    format!("{middle:.0} ms in the middle, {late:.0} ms at the 95th percentile")
}

/// The full drawing against the command's own time.
fn full(folder: &Path, photograph: &str) {
    let scene = Path::new(photograph).with_extension("toml");
    let shortest = |run: &dyn Fn() -> Duration| (0..5).map(|_| run()).min().unwrap();
    let command = shortest(&|| {
        let begun = Instant::now();
        let words = ["draw", &scene.to_string_lossy(), "-o", "command.json", "-q"];
        let status = Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(words).status();
        assert!(status.unwrap().success());
        begun.elapsed()
    });
    let studio = Studio::open(folder, Some(photograph));
    studio.drawn().unwrap();
    let mut gamma = 1.0;
    let mut seconds = Vec::new();
    for _ in 0..5 {
        gamma += 0.01;
        studio.change("gamma", &json!([{ "path": ["gamma"], "value": gamma }])).accepted();
        let drawing: Value = studio.drawn().unwrap();
        seconds.push(drawing["seconds"].as_f64().unwrap());
    }
    let least = seconds.into_iter().fold(f64::INFINITY, f64::min);
    println!(
        "{photograph}: in full {least:.2} s, the command {:.2} s: {:.2} times",
        command.as_secs_f64(),
        least / command.as_secs_f64()
    );
}
