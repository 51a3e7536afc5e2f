//! `drypoint redo`: the recipe inside a drawing, as a command line.

use super::document::{Document, Entry, MASK, PHOTOGRAPH, REGION, names_file, with_mask};
use super::origin::Origin;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::read::{Budget, read_svg_within};
use crate::source::sha256;
use serde_json::Value;
use std::path::Path;

/// Maximum size of a drawing's file in bytes.
const MOST_BYTES: u64 = 1 << 30;
/// Maximum size of a photograph's file in bytes, as much as decoding accepts.
const MOST_PHOTOGRAPH: u64 = 1 << 30;
/// Work for reading the drawing, in millions of steps.
const WORK: f64 = 100.0;

/// The options with which a drawing was made; its photograph and masks lie beside it or in the current folder.
pub(super) fn document(drawing: &str) -> Result<Document, Failure> {
    let bytes = output::read(drawing, MOST_BYTES, "")?;
    let text = recipe_text(&bytes).ok_or_else(|| {
        Failure::Work(format!(
            "{drawing} holds no recipe: it is no SVG or PDF that `drypoint draw` wrote; draw it from its photograph"
        ))
    })?;
    let recipe: Value =
        serde_json::from_str(&text).map_err(|error| Failure::Work(format!("the recipe in {drawing} cannot be read: {error}")))?;
    if recipe["command"] != "draw" || !recipe["options"].is_object() {
        let version = recipe["drypoint"].as_str().unwrap_or("an older one");
        return Err(Failure::Work(format!(
            "{drawing}: its recipe, by drypoint {version}, cannot be drawn again; draw it from its photograph"
        )));
    }
    Reader { drawing, recipe: &recipe, document: Document::default() }.read()
}

/// The recipe's text in an SVG, plain or compressed, or in a PDF's metadata.
fn recipe_text(bytes: &[u8]) -> Option<String> {
    if bytes.starts_with(b"%PDF") {
        let (from, to) = (b"<drypoint:recipe>", b"</drypoint:recipe>");
        let start = find(bytes, from)? + from.len();
        let text = String::from_utf8(bytes[start..start + find(&bytes[start..], to)?].to_vec()).ok()?;
        return Some(text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"));
    }
    read_svg_within(bytes, &mut Budget::of_millions(WORK)).ok()?.recipe
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    bytes.windows(what.len()).position(|window| window == what)
}

/// The name of the new drawing if none is given: beside the old one, marked.
pub(super) fn usual_output(drawing: &str) -> String {
    let path = Path::new(drawing);
    let part = |part: Option<&std::ffi::OsStr>| part.map(|text| text.to_string_lossy().into_owned()).unwrap_or_default();
    path.with_file_name(format!("{}-redone.{}", part(path.file_stem()), part(path.extension()))).to_string_lossy().into_owned()
}

struct Reader<'a> {
    drawing: &'a str,
    recipe: &'a Value,
    document: Document,
}

impl Reader<'_> {
    fn read(mut self) -> Result<Document, Failure> {
        let recipe = self.recipe;
        let source = self.file(&recipe["source"], "photograph")?;
        self.add(PHOTOGRAPH, Some(source));
        let options = recipe["options"].as_object().into_iter().flatten();
        for (option, value) in options {
            let values: Vec<&str> = match value {
                Value::Array(values) => values.iter().filter_map(Value::as_str).collect(),
                Value::String(text) => vec![text],
                _ => {
                    self.add(option, None);
                    continue;
                }
            };
            for value in values {
                let value = self.value(option, value)?;
                self.add(option, Some(value));
            }
        }
        Ok(self.document)
    }

    fn add(&mut self, option: &str, value: Option<String>) {
        self.document.entries.push(Entry { option: option.to_owned(), value, place: format!("the recipe in {}", self.drawing) });
    }

    /// An option's value, with files where they are now.
    fn value(&mut self, option: &str, value: &str) -> Result<String, Failure> {
        match option {
            MASK => {
                let (role, _) = value.split_once('=').unwrap_or((value, ""));
                Ok(format!("{role}={}", self.file(&self.recipe["masks"][role], &format!("mask {role}"))?))
            }
            "depth" => self.file(&self.recipe["depth"], "depth map"),
            _ if names_file(option, value) => self.near(value, option),
            REGION => {
                let mut missing = None;
                let found =
                    with_mask(value, |file| self.near(file, "region's mask").map_err(|failure| missing = Some(failure)).ok());
                found.ok_or_else(|| missing.unwrap_or(Failure::Interrupted))
            }
            _ => Ok(value.to_owned()),
        }
    }

    /// The path of a file of the recipe, unchanged since.
    fn file(&mut self, source: &Value, what: &str) -> Result<String, Failure> {
        let name = source["file"].as_str().unwrap_or_default();
        if name.is_empty() || name == "-" {
            return Err(Failure::Work(format!(
                "{}: its {what} came from stdin and is not kept; use `drypoint draw`",
                self.drawing
            )));
        }
        let path = self.near(name, what)?;
        let found = sha256(&output::read(&path, MOST_PHOTOGRAPH, "")?);
        let kept = source["sha256"].as_str().unwrap_or_default();
        if !kept.is_empty() && kept != found {
            return Err(Failure::Work(format!(
                "{path} is not the {what} of {}: its sha256 was {kept} and is {found}; put the former file back, or draw the new one \
                 with `drypoint draw`",
                self.drawing
            )));
        }
        Ok(path)
    }

    /// A file beside the drawing, else in the current folder.
    fn near(&mut self, name: &str, what: &str) -> Result<String, Failure> {
        let beside = Path::new(self.drawing).with_file_name(name);
        let path = [beside.as_path(), Path::new(name)].into_iter().find(|path| path.exists()).ok_or_else(|| {
            Failure::Work(format!("{}: its {what}, {name}, is neither beside it nor in this folder; put it there", self.drawing))
        })?;
        let path = path.to_string_lossy().into_owned();
        self.document.origins.push(Origin { path: path.clone(), place: format!("the recipe in {}", self.drawing) });
        Ok(path)
    }
}
