//! `drypoint batch`: every picture is told, none stops the others, and a second run finishes what the first did not.
#![cfg(feature = "cli")]

use crate::common::{png_of_light, sample};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// Options of a picture that takes a fraction of a second.
const SMALL: [&str; 3] = ["--size=20x20mm", "--sight=none", "--quiet"];

/// Two photographs in folders and two files that are none.
fn with_photographs() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("in/far")).unwrap();
    let slope = |dark: f64| png_of_light(120, 120, move |x, y| dark + 0.4 * f64::from(x + y) / 240.0);
    let files =
        [("in/a.png", slope(0.1)), ("in/far/b.png", slope(0.3)), ("in/text.jpg", b"words".to_vec()), ("in/none.png", vec![])];
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.current_dir(folder).env("XDG_CONFIG_HOME", folder.join("config")).arg("batch").args(arguments).args(SMALL);
    command
}

/// The lines by the pictures' names, the exit status and what was said.
fn batch(folder: &Path, arguments: &[&str]) -> (BTreeMap<String, Value>, i32, String) {
    let output = command(folder, arguments).output().unwrap();
    let lines = String::from_utf8(output.stdout).unwrap();
    let lines = lines.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let named = lines.map(|line| (line["name"].as_str().unwrap().to_owned(), line)).collect();
    (named, output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

fn statuses(lines: &BTreeMap<String, Value>) -> Vec<(&str, &str)> {
    lines.iter().map(|(name, line)| (name.as_str(), line["status"].as_str().unwrap())).collect()
}

/// All files below a folder but records, with their bytes.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            found.extend(files(&entry.path()).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            found.insert(name, fs::read(entry.path()).unwrap());
        }
    }
    found.retain(|name, _| !name.contains(".drypoint/"));
    found
}

#[test]
fn every_picture_is_told_and_drawn_as_draw_does() {
    let folder = with_photographs();
    let (lines, status, said) = batch(folder.path(), &["in", "-o", "out/{name}.svg", "--results", "all.jsonl"]);
    assert_eq!(statuses(&lines), [("a", "done"), ("far/b", "done"), ("none", "failed"), ("text", "failed")]);
    assert_eq!((status, said.lines().count()), (3, 1), "{said}");
    assert!(lines["text"]["reason"].as_str().unwrap().contains("not in a known image format"));
    assert_eq!(fs::read_to_string(folder.path().join("all.jsonl")).unwrap().lines().count(), 4);
    let drawn = Command::new(env!("CARGO_BIN_EXE_drypoint"))
        .current_dir(folder.path())
        .args(["draw", "in/far/b.png", "-o", "out/far/alone.svg"])
        .args(SMALL)
        .status();
    assert!(drawn.unwrap().success());
    let out = files(&folder.path().join("out"));
    assert_eq!(out.keys().collect::<Vec<_>>(), ["a.svg", "far/alone.svg", "far/b.svg"]);
    assert_eq!(out["far/b.svg"], out["far/alone.svg"]);
    assert_eq!(lines["far/b"]["sha256"], drypoint::source::sha256(&out["far/b.svg"]));
    assert_eq!(lines["far/b"]["bytes"], out["far/b.svg"].len());
}

#[test]
fn what_has_not_changed_is_skipped_by_its_content() {
    let folder = with_photographs();
    let mask = |light: f64| fs::write(folder.path().join("a-mask.png"), png_of_light(120, 120, |_, _| light)).unwrap();
    mask(1.0);
    let drawn = |extra: &[&str]| {
        let arguments = [&["in/a.png", "-o", "{name}.svg", "--mask", "subject={name}-mask.png"], extra].concat();
        let (lines, status, said) = batch(folder.path(), &arguments);
        assert_eq!(status, 0, "{said}");
        lines["a"]["status"].as_str().unwrap().to_owned()
    };
    assert_eq!(drawn(&[]), "done");
    assert_eq!(drawn(&["--jobs=1", "--threads=2", "--max-memory=64MB"]), "skipped");
    assert_eq!(drawn(&["--seed=1"]), "done");
    assert_eq!(drawn(&[]), "done");
    let photograph = fs::read(folder.path().join("in/a.png")).unwrap();
    fs::write(folder.path().join("in/a.png"), &photograph).unwrap();
    assert_eq!(drawn(&[]), "skipped", "the same bytes at another time");
    mask(0.9);
    assert_eq!(drawn(&[]), "done", "another mask");
    fs::write(folder.path().join("a.svg"), "spoilt").unwrap();
    assert_eq!(drawn(&[]), "done", "another output");
    fs::write(folder.path().join(".drypoint/a.svg.json"), "{").unwrap();
    assert_eq!(drawn(&[]), "done", "a broken record");
    assert_eq!(drawn(&[]), "skipped");
}

#[test]
fn shards_make_what_one_machine_makes() {
    let folder = tempfile::tempdir().unwrap();
    let photograph = png_of_light(40, 40, |x, _| f64::from(x) / 40.0);
    let lines: Vec<String> = (0..12).map(|i| format!("photo.png\tset-{}/{i}", i % 2)).collect();
    fs::write(folder.path().join("photo.png"), photograph).unwrap();
    fs::write(folder.path().join("list.tsv"), lines.join("\n")).unwrap();
    let (all, status, _) = batch(folder.path(), &["list.tsv", "-o", "all/{name}.svg"]);
    assert_eq!((all.len(), status), (12, 0));
    let mut names = Vec::new();
    for shard in ["1/3", "2/3", "3/3"] {
        let (lines, status, _) = batch(folder.path(), &["list.tsv", "-o", "parts/{name}.svg", "--shard", shard]);
        assert_eq!(status, 0);
        names.extend(lines.into_keys());
    }
    names.sort();
    assert_eq!(names, all.into_keys().collect::<Vec<_>>());
    assert_eq!(files(&folder.path().join("all")), files(&folder.path().join("parts")));
}

#[test]
fn a_scene_tuned_on_one_photograph_is_the_recipe_of_all() {
    let folder = with_photographs();
    fs::write(folder.path().join("tuned.toml"), "photograph = \"gone.jpg\"\nstyle = \"grid\"\n[set]\npitch = 1.5\n").unwrap();
    let (lines, status, said) = batch(folder.path(), &["in/a.png", "-o", "{name}.json", "--recipe", "tuned.toml"]);
    assert_eq!((lines.len(), status), (1, 0), "{said}");
    let drawing: Value = serde_json::from_slice(&fs::read(folder.path().join("a.json")).unwrap()).unwrap();
    let marks = |kind: &str| {
        drawing["layers"].as_array().unwrap().iter().map(|layer| layer[kind].as_array().unwrap().len()).sum::<usize>()
    };
    assert!((50..300).contains(&(marks("dots") + marks("strokes"))), "a pitch of 1.5 mm on 20 x 20 mm");
}

#[test]
fn mistakes_of_the_command_line_draw_nothing() {
    let folder = with_photographs();
    for (arguments, status, told) in [
        (&["in", "-o", "out.svg"][..], 2, "put {name} into -o"),
        (&["in", "-o", "{name}-{layer}.svg"], 2, "one file per picture"),
        (&["in", "-o", "{name}.svg", "--style", "hedkut"], 2, "no style"),
        (&["in", "-o", "{name}.svg", "--set", "pich=2"], 2, "pich"),
        (&["in", "-o", "{name}.gcode"], 2, "--profile"),
        (&["in", "-o", "{name}.svg", "--preview", "one.svg", "--profile", "toy"], 2, "into --preview"),
        (&["in", "-o", "{name}.svg", "--shard", "4/3"], 2, "from 1 to N"),
        (&["in", "-o", "{name}.svg", "--recipe", "gone.toml"], 1, "does not exist"),
        (&["nowhere", "-o", "{name}.svg"], 1, "does not exist"),
    ] {
        let (lines, code, said) = batch(folder.path(), arguments);
        assert!(lines.is_empty() && code == status && said.contains(told), "{arguments:?}: {code} {said}");
    }
    let (lines, status, _) = batch(folder.path(), &["in/a.png", "in/far/../a.png", "-o", "{name}.svg", "--jobs=1"]);
    let reason = lines["a"]["reason"].as_str().unwrap_or_default().to_owned();
    assert!(status == 3 && reason.contains("already the output of another"), "{reason}");
}

/// Killed at any moment, its files are whole, and the next run makes the rest.
#[cfg(unix)]
#[test]
fn killed_and_run_again_it_makes_the_same() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("face.jpg"), sample("astronaut.jpg")).unwrap();
    let lines: Vec<String> = (0..16).map(|i| format!("face.jpg\t{i}")).collect();
    fs::write(folder.path().join("list.tsv"), lines.join("\n")).unwrap();
    let arguments = |out| ["list.tsv", "-o", out, "--pitch=1.2"];
    let whole = batch(folder.path(), &arguments("whole/{name}.svg"));
    assert_eq!(whole.1, 0, "{}", whole.2);
    let expected = files(&folder.path().join("whole"));
    for (i, signal) in
        [rustix::process::Signal::KILL, rustix::process::Signal::TERM, rustix::process::Signal::INT].into_iter().enumerate()
    {
        let mut child =
            command(folder.path(), &arguments("parts/{name}.svg")).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(120 + 90 * i as u64));
        let number = rustix::process::Pid::from_child(&child);
        let _ = rustix::process::kill_process(number, signal);
        child.wait().unwrap();
        let parts = folder.path().join("parts");
        if parts.exists() {
            let visible = files(&parts).into_iter().filter(|(name, _)| !name.starts_with('.'));
            visible.for_each(|(name, bytes)| assert_eq!(bytes, expected[&name], "{name} after {signal:?}"));
        }
    }
    let (lines, status, said) = batch(folder.path(), &arguments("parts/{name}.svg"));
    assert_eq!((lines.len(), status), (16, 0), "{said}");
    let made: BTreeMap<_, _> =
        files(&folder.path().join("parts")).into_iter().filter(|(name, _)| !name.starts_with('.')).collect();
    assert_eq!(made, expected);
}

/// A picture that is too flat for the box comes first; a link to a device without an end follows.
#[cfg(unix)]
#[test]
fn a_picture_of_no_use_stops_no_other_wherever_it_stands() {
    let folder = with_photographs();
    let here = folder.path();
    fs::write(here.join("in/1 flat.png"), png_of_light(300, 1, |_, _| 0.4)).unwrap();
    std::os::unix::fs::symlink("/dev/zero", here.join("in/2 endless.png")).unwrap();
    fs::write(here.join("in/3 flat.png"), png_of_light(300, 1, |_, _| 0.5)).unwrap();
    fs::write(here.join("list.tsv"), "in/1 flat.png\nin/2 endless.png\nin/3 flat.png\nin/a.png\n").unwrap();
    let (lines, status, said) = batch(here, &["list.tsv", "-o", "out/{name}.svg", "--jobs=1"]);
    assert_eq!(status, 3, "{said}");
    assert_eq!(statuses(&lines).iter().filter(|(_, status)| *status == "done").count(), 1, "{lines:?}");
    assert_eq!(lines.len(), 4, "{lines:?}");
    assert!(lines.values().any(|line| line["reason"].as_str().is_some_and(|reason| reason.contains("no ordinary file"))));
}

/// What a killed process left is swept; what a living one holds stays.
#[cfg(unix)]
#[test]
fn files_of_killed_processes_are_removed() {
    let folder = with_photographs();
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    let old = std::time::SystemTime::now() - Duration::from_mins(1);
    let unfinished = |name: &str| {
        let file = fs::File::create(out.join(name)).unwrap();
        file.set_modified(old).unwrap();
        file
    };
    drop(unfinished(".drypoint-left01"));
    drop(unfinished(".drypoint-notes.txt"));
    let held = unfinished(".drypoint-held01");
    held.lock().unwrap();
    batch(folder.path(), &["in", "-o", "out/{name}.svg"]);
    assert!(!out.join(".drypoint-left01").exists() && out.join(".drypoint-held01").exists());
    assert!(out.join(".drypoint-notes.txt").exists(), "a user's own file");
}
