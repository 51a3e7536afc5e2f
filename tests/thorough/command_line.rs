//! The command line's contract: exit status, messages, complete files or none, the same bytes on any number of threads.
#![cfg(feature = "cli")]

use crate::common;

use assert_cmd::Command;
use common::{png_of_light, sample, skip};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn drypoint() -> Command {
    Command::new(env!("CARGO_BIN_EXE_drypoint"))
}

/// A folder with a small valid photograph.
fn folder() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let photo = folder.path().join("photo.png");
    fs::write(&photo, png_of_light(48, 64, |x, y| f64::from(x + y) / 112.0)).unwrap();
    (folder, photo)
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Runs a command that must fail with one line that contains `words`, and must leave no new file.
fn refuses(folder: &Path, status: i32, words: &str, arguments: &[&str]) {
    let before = fs::read_dir(folder).unwrap().count();
    let output = drypoint().current_dir(folder).args(arguments).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {message}");
    assert!(message.contains(words), "{arguments:?}: {message}");
    assert!(!message.contains("panicked"), "{message}");
    assert!(output.stdout.is_empty());
    if status == 1 {
        assert_eq!(message.lines().count(), 1, "one clear message: {message}");
    }
    assert_eq!(fs::read_dir(folder).unwrap().count(), before, "{arguments:?} left a file behind");
}

/// A PNG header of any size, without pixels.
fn png_header(width: u32, height: u32) -> Vec<u8> {
    let mut chunk = b"IHDR".to_vec();
    chunk.extend(width.to_be_bytes());
    chunk.extend(height.to_be_bytes());
    chunk.extend([8, 2, 0, 0, 0]);
    let crc = chunk.iter().fold(!0_u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 != 0 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    });
    let mut bytes = vec![0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a, 0, 0, 0, 13];
    bytes.extend(chunk);
    bytes.extend((!crc).to_be_bytes());
    bytes.extend([0, 0, 0, 0]);
    bytes.extend(b"IDAT");
    bytes
}

#[test]
fn bad_photographs_are_named_and_explained() {
    let (folder, photo) = folder();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let good = fs::read(&photo).unwrap();
    let jpeg = sample("grace-hopper.jpg");
    put("empty.jpg", b"");
    put("text.jpg", b"this is not a photograph at all");
    put("magic.png", &[&[0x89, b'P', b'N', b'X'], &good[4..]].concat());
    put("huge.png", &png_header(65535, 65535));
    put("none.png", &png_header(0, 10));
    for (name, words) in [
        ("empty.jpg", "empty.jpg is empty"),
        ("text.jpg", "is not in a known image format"),
        ("magic.png", "is not in a known image format"),
        ("huge.png", "65535 x 65535 px, beyond the limit of 200 megapixels"),
        ("none.png", "none.png is a PNG image"),
        ("missing.jpg", "missing.jpg does not exist"),
        (".", "is a folder"),
    ] {
        refuses(folder.path(), 1, words, &["draw", name, "-o", "out.svg"]);
    }
    for (extension, whole, cuts) in
        [("png", &good, [20, 60, good.len() / 2, good.len() - 20]), ("jpg", &jpeg, [3, 400, jpeg.len() / 2, jpeg.len() - 2])]
    {
        for cut in cuts {
            let name = format!("cut{cut}.{extension}");
            put(&name, &whole[..cut]);
            refuses(
                folder.path(),
                1,
                &format!("{name} is a {} image", if extension == "png" { "PNG" } else { "JPEG" }),
                &["draw", &name, "-o", "out.svg"],
            );
        }
    }
}

#[test]
fn an_unreadable_photograph_is_named() {
    let (folder, photo) = folder();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o777)).unwrap();
    fs::set_permissions(&photo, fs::Permissions::from_mode(0o000)).unwrap();
    if fs::File::open(&photo).is_err() {
        return refuses(folder.path(), 1, "permission denied", &["draw", "photo.png", "-o", "out.svg"]);
    }
    // Permissions do not bind the superuser, so run as nobody.
    let output = std::process::Command::new("setpriv")
        .args([
            "--reuid=65534",
            "--clear-groups",
            env!("CARGO_BIN_EXE_drypoint"),
            "draw",
            text(&photo),
            "-o",
            "-",
            "--format",
            "svg",
        ])
        .output();
    match output {
        Ok(output) if !String::from_utf8_lossy(&output.stderr).contains("setpriv:") => {
            assert_eq!(output.status.code(), Some(1));
            assert!(String::from_utf8_lossy(&output.stderr).contains("permission denied"), "{output:?}");
        }
        _ => skip("the superuser reads everything, and setpriv is not here to be somebody else"),
    }
}

#[test]
fn wrong_command_lines_end_with_status_2_and_say_what_works() {
    let (folder, _) = folder();
    for (words, extra) in [
        ("length, 0.1 to 50 mm", &["--set", "pitch=NaN"][..]),
        ("did you mean pitch", &["--set", "pich=1"]),
        ("one of exact, paper", &["--set", "size=big"]),
        ("from 1 mm to 100 m", &["--size", "-10x20"]),
        ("must be above 0", &["--pitch", "-1"]),
        ("must be above 0", &["--pitch", "0"]),
        ("there is no style 'mosaic'; there are hedcut", &["--style", "mosaic"]),
        ("is no sheet; there are a6", &["--page", "a17"]),
        ("must be a number from 0.1 to 10", &["--gamma", "inf"]),
        ("must be below --white", &["--black", "0.9", "--white", "0.2"]),
        ("write it as X,Y,W,H", &["--crop", "1,2"]),
        (
            "--mask nose: hedcut takes subject, detail, hair, clothing, facial-hair, headwear, edges, isophotes, directions, highlights",
            &["--mask", "nose=photo.png"],
        ),
        ("there is no plotter profile 'etch'", &["--profile", "etch"]),
        ("leaves nothing of the sheet", &["--page", "a6", "--margin", "60mm"]),
        ("is not a colour", &["--ink", "purplish"]),
        ("there is no layer 'eyes'; there are dots, outline", &["--layers", "eyes"]),
    ] {
        refuses(folder.path(), 2, words, &[&["draw", "photo.png", "-o", "out.svg"], extra].concat());
    }
    refuses(folder.path(), 2, "the format of out.bmp is not known", &["draw", "photo.png", "-o", "out.bmp"]);
    refuses(folder.path(), 2, "give the format", &["draw", "photo.png", "-o", "-"]);
    refuses(folder.path(), 2, "writes PDF and InkML", &["plot", "drawing.svg", "-o", "out.inkml"]);
    refuses(folder.path(), 2, "need --profile", &["draw", "photo.png", "-o", "out.gcode"]);
    for option in [&["--dry-time", "30"][..], &["--speed", "50"], &["--dwell", "0.1"], &["--frame"], &["--pause-every", "20m"]] {
        let line = [&["draw", "photo.png", "-o", "out.svg"], option].concat();
        refuses(folder.path(), 2, "is for a machine; it needs --profile", &line);
    }
    refuses(folder.path(), 2, "reads another language", &["draw", "photo.png", "-o", "out.gcode", "--profile", "hp7475a"]);
    refuses(folder.path(), 2, "both write to stdout", &["draw", "photo.png", "-o", "-", "--format", "svg", "--json"]);
}

#[test]
fn crops_masks_and_white_pictures_that_cannot_be_drawn() {
    let (folder, _) = folder();
    fs::write(folder.path().join("mask.png"), png_of_light(10, 10, |_, _| 1.0)).unwrap();
    fs::write(folder.path().join("white.png"), png_of_light(48, 64, |_, _| 1.0)).unwrap();
    fs::write(folder.path().join("params.toml"), "pitch = [1]\n").unwrap();
    fs::write(folder.path().join("broken.toml"), "pitch = \n").unwrap();
    let draw = ["draw", "photo.png", "-o", "out.svg"];
    refuses(folder.path(), 1, "has no pixel inside the crop", &[&draw[..], &["--crop", "10,10,0,5"]].concat());
    refuses(folder.path(), 1, "has no pixel inside the crop", &[&draw[..], &["--crop", "200%,0,10,10"]].concat());
    refuses(
        folder.path(),
        1,
        "mask.png is 10 x 10 px, but the photograph is 48 x 64 px",
        &[&draw[..], &["--mask", "subject=mask.png"]].concat(),
    );
    refuses(folder.path(), 1, "there is nothing to draw", &["draw", "white.png", "-o", "out.svg"]);
    refuses(folder.path(), 1, "params.toml, line 1: pitch", &[&draw[..], &["--params", "params.toml"]].concat());
    refuses(folder.path(), 1, "broken.toml", &[&draw[..], &["--params", "broken.toml"]].concat());
    refuses(folder.path(), 1, "working pixels", &[&draw[..], &["--size", "30000x40000mm"]].concat());
}

#[test]
fn outputs_that_cannot_be_written_leave_nothing() {
    let (folder, _) = folder();
    let draw = |out: &'static str| ["draw", "photo.png", "-o", out, "--size", "20x20"];
    refuses(folder.path(), 1, "its folder does not exist", &draw("nowhere/out.svg"));
    fs::create_dir(folder.path().join("dir.svg")).unwrap();
    refuses(folder.path(), 1, "is a folder", &draw("dir.svg"));
    fs::write(folder.path().join("kept.svg"), "kept").unwrap();
    fs::set_permissions(folder.path().join("kept.svg"), fs::Permissions::from_mode(0o444)).unwrap();
    refuses(folder.path(), 1, "permission denied", &draw("kept.svg"));
    assert_eq!(fs::read_to_string(folder.path().join("kept.svg")).unwrap(), "kept");
    if Path::new("/dev/full").exists() {
        refuses(folder.path(), 1, "the disk is full", &[&draw("/dev/full")[..], &["--format", "svg"]].concat());
    }
}

#[test]
fn links_are_followed_and_modes_kept() {
    let (folder, _) = folder();
    let target = folder.path().join("target.svg");
    fs::write(&target, "old").unwrap();
    fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).unwrap();
    std::os::unix::fs::symlink("target.svg", folder.path().join("link.svg")).unwrap();
    std::os::unix::fs::symlink("later.svg", folder.path().join("dangling.svg")).unwrap();
    for name in ["link.svg", "dangling.svg"] {
        let status = drypoint().current_dir(folder.path()).args(["draw", "photo.png", "-q", "-o", name]).status_code();
        assert_eq!(status, Some(0));
        assert!(fs::symlink_metadata(folder.path().join(name)).unwrap().file_type().is_symlink());
    }
    assert!(fs::read_to_string(&target).unwrap().starts_with("<svg"));
    assert_eq!(fs::metadata(&target).unwrap().permissions().mode() & 0o777, 0o640);
    assert!(fs::read_to_string(folder.path().join("later.svg")).unwrap().starts_with("<svg"));
}

#[test]
fn a_machine_s_sheet_holds_the_picture_without_a_margin_being_asked_for() {
    let (folder, _) = folder();
    let run = |arguments: &[&str]| drypoint().current_dir(folder.path()).args(arguments).output().unwrap();
    let machine = ["-q", "--profile", "hp7475a", "--page", "a4"];
    let drawn = run(&[&["draw", "photo.png", "-o", "a.hpgl", "--pitch", "3"], &machine[..]].concat());
    assert!(drawn.status.success(), "{drawn:?}");
    assert!(run(&["draw", "photo.png", "-q", "-o", "a.svg", "--pitch", "3"]).status.success());
    let plotted = run(&[&["plot", "a.svg", "-o", "b.hpgl", "--fit", "page"], &machine[..]].concat());
    assert!(plotted.status.success(), "{plotted:?}");
}

#[test]
fn pictures_with_hardly_anything_to_draw_are_refused_and_never_panic() {
    let (folder, _) = folder();
    fs::write(folder.path().join("pale.png"), png_of_light(48, 64, |_, _| 0.9)).unwrap();
    refuses(folder.path(), 1, "--set highlights=off", &["draw", "pale.png", "-o", "out.svg"]);
    refuses(folder.path(), 1, "smaller than one dot", &["draw", "photo.png", "-o", "out.svg", "--size", "3x3", "--pitch", "30"]);
}

#[test]
fn a_full_disk_keeps_the_old_file() {
    let (folder, _) = folder();
    let small = folder.path().join("small");
    fs::create_dir(&small).unwrap();
    let mounted = std::process::Command::new("mount").args(["-t", "tmpfs", "-o", "size=16k", "tmpfs", text(&small)]).status();
    if !mounted.is_ok_and(|status| status.success()) {
        return skip("a small tmpfs cannot be mounted here (that takes the superuser)");
    }
    fs::write(small.join("out.svg"), "old").unwrap();
    let output = drypoint().current_dir(folder.path()).args(["draw", "photo.png", "-o", "small/out.svg"]).output().unwrap();
    let left: Vec<_> = fs::read_dir(&small).unwrap().map(|e| e.unwrap().file_name()).collect();
    let old = fs::read_to_string(small.join("out.svg")).unwrap();
    std::process::Command::new("umount").arg(&small).status().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("the disk is full"), "{output:?}");
    assert_eq!((left.len(), old.as_str()), (1, "old"));
}

#[test]
fn bytes_do_not_depend_on_threads_and_differ_by_seed() {
    let (folder, _) = folder();
    let draw = |name: &str, extra: &[&str]| {
        let status = drypoint()
            .current_dir(folder.path())
            .args(["draw", "photo.png", "--size", "60x80mm", "-q", "-o", name])
            .args(extra)
            .status_code();
        assert_eq!(status, Some(0));
        fs::read(folder.path().join(name)).unwrap()
    };
    assert_eq!(draw("a.svg", &["--threads", "1"]), draw("b.svg", &["--threads", "2"]));
    assert_ne!(draw("a.svg", &["--seed", "1"]), draw("b.svg", &["--seed", "2"]));
    let machine = ["--profile", "grbl-servo"];
    assert_eq!(
        draw("a.gcode", &[&machine[..], &["--threads", "1"]].concat()),
        draw("b.gcode", &[&machine[..], &["--threads", "2"]].concat())
    );
}

trait StatusCode {
    fn status_code(&mut self) -> Option<i32>;
}

impl StatusCode for Command {
    fn status_code(&mut self) -> Option<i32> {
        self.output().unwrap().status.code()
    }
}

#[test]
fn stdin_stdout_json_and_dry_run() {
    let (folder, photo) = folder();
    let piped =
        drypoint().args(["draw", "-", "-o", "-", "--format", "svg"]).write_stdin(fs::read(&photo).unwrap()).output().unwrap();
    assert!(piped.status.success() && piped.stdout.starts_with(b"<svg"));
    let output = drypoint()
        .current_dir(folder.path())
        .args(["draw", "photo.png", "-o", "x.gcode", "--profile", "grbl-servo", "--json", "--dry-run"])
        .output()
        .unwrap();
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["layers"][0]["name"], "dots");
    assert!(value["layers"][0]["dots"].as_u64().unwrap() > 1000);
    assert!(value["total"]["seconds"].as_f64().unwrap() > 100.0);
    assert!(value["total"]["pen_up_mm"].as_f64() < value["total"]["pen_up_mm_before"].as_f64());
    assert!(!folder.path().join("x.gcode").exists());
}

#[test]
fn one_file_for_each_layer() {
    let (folder, _) = folder();
    let status = drypoint().current_dir(folder.path()).args(["draw", "photo.png", "-q", "-o", "x-{layer}.svg"]).status_code();
    assert_eq!(status, Some(0));
    assert!(folder.path().join("x-dots.svg").exists() && folder.path().join("x-outline.svg").exists());
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let (_folder, photo) = folder();
    let command = format!(
        "{} draw {} -o - --format svg -q | head -c 10 >/dev/null; echo ${{PIPESTATUS[0]}}",
        env!("CARGO_BIN_EXE_drypoint"),
        text(&photo)
    );
    let output = std::process::Command::new("bash").args(["-c", &command]).output().unwrap();
    assert_eq!((String::from_utf8_lossy(&output.stdout).trim(), output.stderr.len()), ("0", 0), "{output:?}");
}

#[test]
fn an_interrupt_ends_with_130_and_leaves_nothing() {
    let (folder, _) = folder();
    fs::write(folder.path().join("photo.jpg"), sample("astronaut.jpg")).unwrap();
    let before = fs::read_dir(folder.path()).unwrap().count();
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"))
        .current_dir(folder.path())
        .args(["draw", "photo.jpg", "-q", "-o", "out.svg", "--pitch", "0.2"])
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(700));
    let sent = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before);
}

#[test]
fn every_stage_is_written_numbered_and_named() {
    let (folder, _) = folder();
    let status = drypoint().current_dir(folder.path()).args(["stages", "photo.png", "-q", "-o", "stages"]).status_code();
    assert_eq!(status, Some(0));
    let mut names: Vec<String> =
        fs::read_dir(folder.path().join("stages")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    for step in
        ["tone", "coherent-lines", "smoothed", "posterised", "features", "lanes", "seeds", "relaxed", "highlights", "drawing"]
    {
        assert!(names.iter().any(|name| name.contains(step)), "{step}: {names:?}");
    }
    assert!(names[0].starts_with("01-"));
}

#[test]
fn lists_help_and_completions() {
    for (arguments, words) in [
        (&["styles"][..], "hedcut"),
        (&["styles", "hedcut"], "flow_reach"),
        (&["styles", "hedcut", "--json"], "\"parameters\""),
        (&["profiles"], "hp7475a"),
        (&["profiles", "grbl-servo"], "units_per_mm"),
        (&["completions", "bash"], "drypoint"),
        (&["man"], ".TH drypoint"),
        (&["draw", "--help"], "--mask <ROLE=FILE>"),
    ] {
        let output = drypoint().args(arguments).output().unwrap();
        assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains(words), "{arguments:?}");
    }
    refuses(tempfile::tempdir().unwrap().path(), 2, "there is no style 'x'", &["styles", "x"]);
}

#[test]
fn each_manual_page_gets_a_file_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    drypoint().current_dir(folder.path()).args(["man", "-o", "man/pages"]).assert().success();
    let pages = [("drypoint.1", "drypoint"), ("drypoint-draw.1", "drypoint-draw"), ("drypoint-send.1", "drypoint-send")];
    let count = if cfg!(feature = "drive") { pages.len() } else { 2 };
    for (file, title) in &pages[..count] {
        let page = std::fs::read_to_string(folder.path().join("man/pages").join(file)).unwrap();
        let version = format!(".TH {title} 1  \"drypoint {}\"", env!("CARGO_PKG_VERSION"));
        assert!(page.matches(".TH ").count() == 1 && page.contains(&version), "{file}: {}", &page[..200]);
    }
}
