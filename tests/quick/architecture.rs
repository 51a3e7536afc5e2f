//! Modules use only what the crate's documentation allows; this test reads the code.

use std::fs;
use std::path::{Path, PathBuf};

/// What each module may use besides itself.
const MAY_USE: &[(&str, &[&str])] = &[
    ("raster", &[]),
    ("geometry", &[]),
    ("colour", &["raster", "drawing", "geometry"]),
    ("drawing", &["geometry"]),
    ("source", &["raster", "geometry", "drawing"]),
    ("see", &["source", "field", "raster", "geometry"]),
    ("tone", &["source", "raster", "geometry"]),
    ("field", &["raster", "geometry"]),
    ("order", &["geometry"]),
    ("scene", &["field", "raster", "drawing", "geometry", "source"]),
    ("style", &["field", "order", "raster", "drawing", "geometry", "source"]),
    ("press", &["drawing", "geometry", "plot", "write"]),
    ("plot", &["drawing", "geometry", "order", "read", "write"]),
    ("drive", &["plot", "geometry"]),
    ("write", &["drawing", "geometry"]),
    ("read", &["drawing", "geometry"]),
    ("studio", &[]),
];

/// A file has one idea; longer ones have had two.
const MOST_LINES: usize = 400;

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// Modules named after `crate::` in non-test code.
fn used_modules(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text);
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1).map(str::to_owned).collect::<Vec<_>>())
        .map(|rest| rest.chars().take_while(|c| c.is_ascii_lowercase() || *c == '_').collect())
        .collect()
}

#[test]
fn modules_use_only_what_they_may() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for (module, allowed) in MAY_USE {
        for file in rust_files(&source.join(module)) {
            for used in used_modules(&fs::read_to_string(&file).unwrap()) {
                // The interrupt, the threads and the elementary functions may be used everywhere.
                let is_common = ["interrupt", "parallel", "elementary"].contains(&used.as_str());
                assert!(is_common || used == *module || allowed.contains(&used.as_str()), "{} uses {used}", file.display());
            }
        }
    }
}

#[test]
fn the_check_can_fail() {
    assert_eq!(
        used_modules("use crate::style::{Settings};\n// use crate::write;\n#[cfg(test)]\nmod tests { use crate::cli; }"),
        ["style"]
    );
}

/// The command line and the studio, which runs it, are no part of the library.
fn is_library(file: &Path) -> bool {
    !file.components().any(|part| part.as_os_str() == "cli" || part.as_os_str() == "studio")
}

#[test]
fn only_the_command_line_prints_or_opens_files() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for file in rust_files(&source).into_iter().filter(|file| is_library(file)) {
        let text = fs::read_to_string(&file).unwrap();
        for forbidden in ["println!", "eprintln!", "std::fs", "process::exit"] {
            assert!(!text.contains(forbidden), "{} has {forbidden}", file.display());
        }
    }
}

/// Options belong to the command line: the library says what was wrong and what would be accepted; `cli/remedies.rs` names the
/// option that helps.
#[test]
fn the_library_names_no_options() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let is_option = |line: &str| {
        let starts = line.match_indices("--").map(|(at, _)| &line[at + 2..]);
        starts.filter_map(|rest| rest.chars().next()).any(|c| c.is_ascii_lowercase())
    };
    for file in rust_files(&source).into_iter().filter(|file| is_library(file)) {
        let text = fs::read_to_string(&file).unwrap();
        let named = text.lines().filter(|line| !line.trim_start().starts_with("//")).find(|line| is_option(line));
        assert_eq!(named, None, "{}", file.display());
    }
}

/// The system's sines and logarithms differ in their last bits from machine to machine: `src/elementary.rs` has others.
#[test]
fn elementary_functions_are_not_the_systems() {
    const SYSTEMS: [&str; 17] = [
        ".sin()",
        ".cos()",
        ".tan()",
        ".sin_cos()",
        ".asin()",
        ".acos()",
        ".atan()",
        ".atan2(",
        ".tanh()",
        ".exp()",
        ".ln()",
        ".ln_1p()",
        ".log2()",
        ".log10()",
        ".cbrt()",
        ".powf(",
        "from_angle(",
    ];
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for file in rust_files(&source) {
        let text = fs::read_to_string(&file).unwrap();
        let used = SYSTEMS.iter().find(|name| text.contains(*name));
        assert_eq!(used, None, "{}", file.display());
        // The length of a vector is a root, which is exact.
        let hypot = text.match_indices(".hypot(").find(|(at, name)| !text[at + name.len()..].starts_with(')'));
        assert_eq!(hypot, None, "{}", file.display());
    }
}

/// Names that a module shows: what its `mod.rs` or file declares or passes on, less what is hidden from the documentation.
fn public_names(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut is_hidden = false;
    let statements = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text);
    let mut lines = statements.lines();
    while let Some(line) = lines.next() {
        if line == "#[doc(hidden)]" {
            is_hidden = true;
            continue;
        }
        if let Some(rest) = line.strip_prefix("pub use ") {
            let mut whole = rest.to_owned();
            while !whole.ends_with(';') {
                whole.push_str(lines.next().expect("a use ends"));
            }
            let list = whole.trim_end_matches(';');
            let list = list.split_once('{').map_or_else(|| list.rsplit("::").next().unwrap_or(list), |(_, list)| list);
            let of_list =
                list.trim_end_matches('}').split(',').map(|name| name.trim().to_owned()).filter(|name| !name.is_empty());
            names.extend(of_list.filter(|_| !is_hidden));
        } else if let Some(rest) = line.strip_prefix("pub ") {
            let words: Vec<&str> = rest.split([' ', '(', '<', ':', ';', '{']).collect();
            let kinds = ["fn", "struct", "enum", "trait", "const", "static", "type", "mod"];
            let name = words
                .windows(2)
                .find(|pair| kinds.contains(&pair[0]) && !kinds.contains(&pair[1]))
                .map(|pair| pair[1].to_owned());
            names.extend(name.filter(|_| !is_hidden));
        } else if line.starts_with("#[") || line.starts_with("///") {
            continue;
        }
        is_hidden = false;
    }
    names
}

#[test]
fn the_public_face_is_small() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let crate_file = fs::read_to_string(source.join("lib.rs")).unwrap();
    let mut all = Vec::new();
    for module in public_names(&crate_file) {
        let folder = source.join(&module).join("mod.rs");
        let text = fs::read_to_string(&folder).or_else(|_| fs::read_to_string(source.join(format!("{module}.rs")))).unwrap();
        let names = public_names(&text);
        println!("{module}: {}", names.join(" "));
        all.extend(names);
    }
    assert!(all.len() > 100, "the count reads the code: {}", all.len());
    assert!(all.len() <= 140, "{} public names", all.len());
}

#[test]
fn files_are_short() {
    let folders = ["src", "tests", "benches", "examples"].map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    for file in folders.iter().flat_map(|folder| rust_files(folder)) {
        let lines = fs::read_to_string(&file).unwrap().lines().count();
        assert!(lines <= MOST_LINES, "{}: {lines} lines", file.display());
    }
}
