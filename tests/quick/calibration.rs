//! The test sheet of every machine: inside sheet and machine, exact where it is measured, and read back as requested. Also a plot
//! limited to a time.
#![cfg(feature = "cli")]

use crate::common;
use crate::machine_file;

use assert_cmd::Command;
use common::png_of_light;
use drypoint::geometry::Point;
use drypoint::plot::{
    Calibration, Language, Mounting, Profile, Toolpath, built_in_names, calibration_page, calibration_sheet, mount,
};
use drypoint::read::read_svg;
use machine_file::{read_back as motion, written};
use std::fs;

const NIB: f64 = 0.3;

fn sheet_of(profile: &Profile, nib: f64, pens: u32) -> (Mounting, Calibration) {
    let page = calibration_page(profile);
    let mounting = mount(profile, &page).unwrap();
    let sheet = calibration_sheet(profile, page, mounting.drawable(&page), nib, pens);
    (mounting, sheet.unwrap_or_else(|error| panic!("{}: {error}", profile.name)))
}

fn profiles() -> impl Iterator<Item = Profile> {
    built_in_names().into_iter().map(|name| Profile::built_in(name).unwrap())
}

fn ends(path: &[Point]) -> (Point, Point) {
    (path[0], path[path.len() - 1])
}

#[test]
fn every_machine_s_sheet_lies_inside_and_its_square_is_exact() {
    for profile in profiles() {
        let (mounting, sheet) = sheet_of(&profile, NIB, profile.pens.count);
        mounting.check(&profile, &sheet.plot).unwrap();
        let drawable = mounting.drawable(&sheet.plot.page);
        let points = || sheet.plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(Toolpath::points);
        let (reach, square) = (drawable.inset(-0.5 * NIB), sheet.square.inflate(1e-9, 1e-9));
        assert!(points().all(|p| reach.contains(*p) && square.contains(*p)), "{}", profile.name);
        let has_room = drawable.width().min(drawable.height()) >= 103.0;
        println!("{}: {:?}, square {:.0} mm", profile.name, sheet.plot.page, sheet.square.width());
        assert!(!has_room || (sheet.square.width() - 100.0).abs() < 1e-9, "{}", profile.name);
        let frame = sheet.plot.pens[0].paths[0].points();
        for leg in frame.windows(2) {
            assert!((leg[0].distance(leg[1]) - sheet.square.width()).abs() < 1e-9, "{}", profile.name);
        }
        assert_eq!((frame.len(), frame[0]), (5, frame[4]), "{}", profile.name);
    }
}

#[test]
fn rungs_of_the_ladder_have_the_spacings_that_their_labels_say() {
    for nib in [0.1, NIB, 0.5, 0.8] {
        let profile = Profile::built_in("grbl-servo").unwrap();
        let (_, sheet) = sheet_of(&profile, nib, 1);
        // Six parallel lines of 5 mm per rung; no other horizontal two-point line on the sheet is 5 mm long.
        let is_rung = |p: &&[Point]| p.len() == 2 && p[0].y == p[1].y && ((p[1].x - p[0].x) - 5.0).abs() < 1e-9;
        let lines: Vec<&[Point]> = sheet.plot.pens[0].paths.iter().map(Toolpath::points).filter(is_rung).collect();
        assert_eq!(lines.len(), 12 * 6, "{nib}");
        for (rung, tenths) in lines.chunks(6).zip(5..) {
            for pair in rung.windows(2) {
                assert!((pair[1][0].y - pair[0][0].y - nib * f64::from(tenths) / 10.0).abs() < 1e-9, "{nib} {tenths}");
            }
        }
    }
}

#[test]
fn every_machine_s_file_reads_back_as_it_was_asked() {
    for profile in profiles() {
        let (mounting, sheet) = sheet_of(&profile, NIB, profile.pens.count);
        let text = written(&sheet.plot, &profile).unwrap();
        assert_eq!(text, written(&sheet_of(&profile, NIB, profile.pens.count).1.plot, &profile).unwrap(), "not the same bytes");
        let asked: Vec<(u32, &[Point])> =
            sheet.plot.pens.iter().flat_map(|pen| pen.paths.iter().map(|path| (pen.number, path.points()))).collect();
        if profile.language() == Language::Svg {
            let read = read_svg(text.as_bytes()).unwrap();
            let marks: usize = read.layers.iter().map(|layer| layer.layer.marks.len()).sum();
            assert_eq!(marks, asked.len(), "{}", profile.name);
            continue;
        }
        let motion = motion(&text, &profile);
        assert!(motion.ends_up, "{}", profile.name);
        assert_eq!(motion.paths.len(), asked.len(), "{}", profile.name);
        for ((number, path), (pen, drawn)) in asked.into_iter().zip(&motion.paths) {
            let near = 0.03 * profile.units_per_mm;
            let (from, to) = ends(path);
            let (start, end) = ends(drawn);
            assert_eq!(number, *pen, "{}", profile.name);
            assert!(mounting.place(number, from).distance(start) <= near, "{}: {path:?} {drawn:?}", profile.name);
            assert!(mounting.place(number, to).distance(end) <= near, "{}: {path:?} {drawn:?}", profile.name);
        }
        let limits = mounting.limits.inflate(1e-9, 1e-9);
        assert!(motion.visited.iter().all(|p| limits.contains(*p)), "{}", profile.name);
    }
}

#[test]
fn machines_get_the_trials_that_they_can_make() {
    let of = |name: &str| sheet_of(&Profile::built_in(name).unwrap(), NIB, 2).1;
    let heights =
        |sheet: &Calibration| sheet.plot.pens.iter().flat_map(|pen| &pen.paths).filter(|p| p.heights().is_some()).count();
    let touches = |sheet: &Calibration| sheet.plot.pens.iter().flat_map(|pen| &pen.paths).filter(|p| p.is_touch()).count();
    assert!(heights(&of("marlin-z")) >= 4 && heights(&of("grbl-servo")) == 0 && heights(&of("hp7475a")) == 0);
    assert_eq!((touches(&of("grbl-servo")), touches(&of("hp7475a")), touches(&of("axidraw-v3"))), (28, 0, 0));
    let profile = Profile::built_in("marlin-z").unwrap();
    let height = profile.height().unwrap();
    // Never lower than the profile lets the pen down, which could bend it.
    for z in of("marlin-z").plot.pens.iter().flat_map(|pen| &pen.paths).filter_map(Toolpath::heights).flatten() {
        assert!(*z >= height.down - 1e-9 && *z < height.up, "{z}");
    }
    let six = sheet_of(&Profile::built_in("hp7475a").unwrap(), NIB, 6).1;
    for number in 2..=6 {
        let cross: usize = six.plot.pens.iter().filter(|pen| pen.number == number).map(|pen| pen.paths.len()).sum();
        assert_eq!(cross, 2, "a cross for pen {number}");
    }
}

#[test]
fn small_machines_get_a_smaller_square_and_tiny_ones_a_refusal() {
    let (_, mini) = sheet_of(&Profile::built_in("axidraw-mini").unwrap(), NIB, 1);
    assert!((70.0..100.0).contains(&mini.square.width()));
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        command.current_dir(folder.path()).args(["calibrate", "--profile", "grbl-servo", "-o", "sheet.gcode"]).args(more);
        let output = command.output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (status, message) = run(&["--set-profile", "area.x=[0,50]"]);
    assert!(status == Some(1) && message.contains("the test sheet needs 72"), "{message}");
    let (status, message) = run(&["--pen", "3mm"]);
    assert!(status == Some(1) && message.contains("thinner --pen"), "{message}");
    assert!(!folder.path().join("sheet.gcode").exists());
    let (status, message) = run(&[]);
    assert!(status == Some(0) && message.contains("a square of 100 mm") && message.contains("scale_x"), "{message}");
    assert!(folder.path().join("sheet.gcode").exists());
}

#[test]
fn a_plot_keeps_to_the_time_it_is_given() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("photo.png"), png_of_light(96, 128, |x, y| f64::from(x + y) / 224.0)).unwrap();
    let draw = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        command.current_dir(folder.path()).args(["draw", "photo.png", "--size", "60x80mm", "--profile", "grbl-servo"]);
        let output = command.args(["-o", "out.gcode", "--json", "--dry-run"]).args(more).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{message}");
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        (value["total"]["seconds"].as_f64().unwrap(), message)
    };
    let (free, _) = draw(&[]);
    let limit = (0.4 * free).round();
    let (kept, message) = draw(&["--max-time", &format!("{limit}s")]);
    println!("{free:.0} s without a limit, {kept:.0} s within {limit:.0} s: {message}");
    assert!(kept <= limit && kept > 0.85 * limit, "{kept} of {limit}");
    assert!(message.contains("pitch ") && message.contains("chosen"), "{message}");
    assert!(draw(&["--max-time", "100h"]).0 == free, "a limit that is kept changes nothing");
}
