//! Every command of the README and of `docs/` works when run as written, by the whole program.
#![cfg(all(feature = "cli", feature = "drive", feature = "see", feature = "studio"))]

use rayon::prelude::*;
use std::fs;
use std::path::Path;
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The indented commands of a page, with lines joined and comments removed.
fn commands(page: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join(page)).unwrap().replace("\\\n", " ");
    let indented = text.lines().filter_map(|line| line.strip_prefix("    "));
    let ours = indented.filter(|line| line.starts_with("drypoint ") || line.contains("| drypoint "));
    ours.map(|line| line.split(" # ").next().unwrap_or(line).trim().to_owned()).collect()
}

/// A folder with every file that the pages name.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    // Head and shoulders, broader than high: the same box then holds a smaller drawing, and sixty are made.
    let broad = |sample: &str, name: &str| {
        let picture = image::open(root().join("samples").join(sample)).unwrap();
        let (width, height) = (picture.width(), picture.width() * 3 / 5);
        picture.crop_imm(0, picture.height() / 20, width, height).save(folder.path().join(name)).unwrap();
    };
    for name in ["portrait.jpg", "photo.jpg"] {
        broad("grace-hopper.jpg", name);
    }
    for name in ["mask.png", "eyes.png", "hair.png", "face.png", "mine.png"] {
        broad("grace-hopper-subject.png", name);
    }
    broad("grace-hopper-depth.png", "depth.png");
    broad("astronaut-cutout.png", "cutout.png");
    let pens = "[blue]\ncolour = \"#1f5fa8\"\n[orange]\ncolour = \"#f08020\"\n[black]\ncolour = \"#202020\"\n";
    fs::write(folder.path().join("pens.toml"), pens).unwrap();
    fs::create_dir(folder.path().join("photos")).unwrap();
    fs::copy(folder.path().join("photo.jpg"), folder.path().join("photos/one.jpg")).unwrap();
    let anything = root().join("tests/data/foreign/inkscape.svg");
    fs::copy(anything, folder.path().join("anything.svg")).unwrap();
    fs::write(folder.path().join("my-plotter.toml"), "extends = \"grbl-servo\"\nname = \"my-plotter\"\nscale_x = 1.002\n")
        .unwrap();
    std::os::unix::fs::symlink(root().join("samples"), folder.path().join("samples")).unwrap();
    folder
}

fn run(folder: &Path, command: &str) -> Result<(), String> {
    let program = Path::new(env!("CARGO_BIN_EXE_drypoint")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let output =
        Command::new("bash").current_dir(folder).env("PATH", path).args(["-eo", "pipefail", "-c", command]).output().unwrap();
    // `head` stops reading early, which is what that recipe is about.
    if output.status.success() { Ok(()) } else { Err(format!("{command}\n{}", String::from_utf8_lossy(&output.stderr))) }
}

#[test]
fn every_command_of_the_pages_runs_as_written() {
    let pages = ["README.md", "docs/first-plot.md", "docs/calibration.md", "docs/gallery.md", "docs/scenes.md"];
    let all: Vec<String> = pages.into_iter().flat_map(commands).collect();
    assert!(all.len() > 30, "{all:?}");
    // Commands that read another command's file run after it.
    let folder = folder();
    let later = ["drypoint resume", "drypoint inspect", "drypoint redo", "drypoint sheet", "drypoint draw portrait.toml"];
    let is_second = |command: &&String| later.iter().any(|start| command.starts_with(start));
    let (second, first): (Vec<&String>, Vec<&String>) = all.iter().partition(is_second);
    let mut failures: Vec<String> = first.par_iter().filter_map(|command| run(folder.path(), command).err()).collect();
    failures.extend(second.iter().filter_map(|command| run(folder.path(), command).err()));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_schema_that_ships_is_the_programs() {
    let output = Command::new(env!("CARGO_BIN_EXE_drypoint")).arg("schema").output().unwrap();
    let shown = String::from_utf8(output.stdout).unwrap();
    let path = root().join("docs/scene.schema.json");
    if std::env::var_os("DRYPOINT_REFRESH").is_some() {
        fs::write(&path, &shown).unwrap();
    }
    assert_eq!(fs::read_to_string(path).unwrap(), shown, "DRYPOINT_REFRESH=1 writes it anew");
}
