//! `drypoint presets` and `--preset NAME`: options for a purpose, built in or a user's own.

use super::document::{self, Document, Role};
use crate::cli::arguments::ListOptions;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::cli::words::{is_toml, nearest};
use etcetera::BaseStrategy;
use include_dir::{Dir, include_dir};
use serde_json::json;
use std::fmt::Write;
use std::path::PathBuf;

static BUILT_IN: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/src/cli/presets");

/// One preset.
struct Preset {
    name: String,
    /// Its file; for a built-in one, a name for messages.
    file: String,
    text: String,
}

impl Preset {
    fn document(&self) -> Result<Document, Failure> {
        document::read(&self.file, &self.text, Role::Preset)
    }
}

/// The options of a preset: one of the user's own, else a built-in one, else a file.
pub(super) fn find(name: &str) -> Result<Document, Failure> {
    let all = all();
    if let Some(preset) = all.iter().find(|preset| preset.name == name) {
        return preset.document();
    }
    if is_toml(name) {
        return document::read(name, &output::read_settings(name)?, Role::Preset);
    }
    Err(unknown(name, &all))
}

fn unknown(name: &str, all: &[Preset]) -> Failure {
    let near = nearest(name, all.iter().map(|preset| preset.name.as_str()));
    let hint = near.map(|near| format!(" (did you mean {near}?)")).unwrap_or_default();
    let names: Vec<&str> = all.iter().map(|preset| preset.name.as_str()).collect();
    let own = folder().map(|folder| format!(" (your own go into {})", folder.display())).unwrap_or_default();
    Failure::Usage(format!("there is no preset '{name}'{hint}; there are {}{own}", names.join(", ")))
}

/// The folder of a user's own presets.
fn folder() -> Option<PathBuf> {
    etcetera::choose_base_strategy().ok().map(|strategy| strategy.config_dir().join("drypoint").join("presets"))
}

/// A user's own presets, then those built in that they do not replace.
fn all() -> Vec<Preset> {
    let mut all: Vec<Preset> = own();
    for file in BUILT_IN.files() {
        let (Some(name), Some(text)) = (file.path().file_stem().and_then(|name| name.to_str()), file.contents_utf8()) else {
            continue;
        };
        if all.iter().all(|preset| preset.name != name) {
            all.push(Preset { name: name.to_owned(), file: format!("preset {name}"), text: text.to_owned() });
        }
    }
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

fn own() -> Vec<Preset> {
    let Some(files) = folder().and_then(|folder| std::fs::read_dir(folder).ok()) else { return Vec::new() };
    let paths = files.filter_map(|file| Some(file.ok()?.path())).filter(|path| path.extension().is_some_and(|e| e == "toml"));
    let read = |path: PathBuf| {
        let file = path.to_str()?.to_owned();
        let text = output::read_settings(&file).ok()?;
        Some(Preset { name: path.file_stem()?.to_str()?.to_owned(), file, text })
    };
    paths.filter_map(read).collect()
}

/// Lists the presets, or prints one as TOML.
pub(in crate::cli) fn presets(options: &ListOptions) -> Result<(), Failure> {
    let all = all();
    if let Some(name) = &options.name {
        let preset = all.iter().find(|preset| preset.name == *name).ok_or_else(|| unknown(name, &all))?;
        return if options.json {
            output::print_json(&json!({ "name": name, "purpose": preset.document()?.purpose, "toml": preset.text }))
        } else {
            output::to_stdout(preset.text.as_bytes())
        };
    }
    let purposes: Vec<(&str, String)> = all
        .iter()
        .map(|preset| Ok((preset.name.as_str(), preset.document()?.purpose.unwrap_or_default())))
        .collect::<Result<_, Failure>>()?;
    if options.json {
        let list: Vec<_> = purposes.iter().map(|(name, purpose)| json!({ "name": name, "purpose": purpose })).collect();
        return output::print_json(&json!({ "presets": list }));
    }
    let text = purposes.iter().fold(String::new(), |mut text, (name, purpose)| {
        let _ = writeln!(text, "{name:18} {purpose}");
        text
    });
    output::to_stdout(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_preset_reads_and_has_a_purpose() {
        for preset in all() {
            let document = preset.document().unwrap();
            assert!(
                document.purpose.is_some_and(|purpose| purpose.len() < 90) && !document.entries.is_empty(),
                "{}",
                preset.name
            );
        }
        assert!(find("wsj-colum").unwrap_err().to_string().contains("did you mean wsj-column?"));
    }
}
