//! The scene file: read, changed key by key with its comments kept, and written.

use super::error::StudioError;
use super::folder;
use serde::Deserialize;
use serde_json::Value as Json;
use std::path::{Path, PathBuf};
use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, Value};

/// Bytes of a scene; larger files are none.
const MOST_BYTES: usize = 1 << 20;

/// A change of one key.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Change {
    /// Keys from the top; a number is the place in an array of tables.
    path: Vec<Step>,
    /// The value; null takes the key out, so that its default holds.
    value: Json,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Step {
    Place(usize),
    Key(String),
}

impl Change {
    /// Names the file of a mask.
    pub(super) fn of_mask(role: &str, value: Json) -> Self {
        Self { path: vec![Step::Key("mask".to_owned()), Step::Key(role.to_owned())], value }
    }

    /// Sets a key at the top.
    pub(super) fn of_key(key: &str, value: Json) -> Self {
        Self { path: vec![Step::Key(key.to_owned())], value }
    }
}

/// The scene as it stands in its file.
#[derive(Clone, Debug)]
pub(super) struct Document {
    pub file: PathBuf,
    text: String,
    parsed: DocumentMut,
}

impl Document {
    /// Reads a scene's file.
    pub(super) fn read(file: &Path) -> Result<Self, StudioError> {
        let bytes = std::fs::read(file).map_err(StudioError::about(file))?;
        Self::of(file, &String::from_utf8_lossy(&bytes))
    }

    /// The scene with this text.
    pub(super) fn of(file: &Path, text: &str) -> Result<Self, StudioError> {
        let document = Self { file: file.to_owned(), text: text.to_owned(), parsed: parse(file, text)? };
        folder::check_names(&document.parsed, document.folder())?;
        Ok(document)
    }

    /// A scene of a photograph with every default.
    pub(super) fn of_photograph(file: &Path, photograph: &str) -> Result<Self, StudioError> {
        let mut parsed = DocumentMut::new();
        parsed["photograph"] = toml_edit::value(photograph);
        Self::of(file, &parsed.to_string())
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    pub(super) fn folder(&self) -> &Path {
        self.file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
    }

    /// Its name without the folder.
    pub(super) fn name(&self) -> String {
        self.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// A value at the top.
    pub(super) fn string(&self, key: &str) -> Option<&str> {
        self.parsed.get(key)?.as_str()
    }

    /// The file that the scene names for a mask.
    pub(super) fn mask(&self, role: &str) -> Option<&str> {
        self.parsed.get("mask")?.get(role)?.as_str()
    }

    /// All values as JSON.
    pub(super) fn values(&self) -> Json {
        toml::from_str::<Json>(&self.text).unwrap_or(Json::Null)
    }

    /// The scene with these changes, which are made together or not at all.
    pub(super) fn changed(&self, changes: &[Change]) -> Result<Self, StudioError> {
        let mut parsed = self.parsed.clone();
        for change in changes {
            apply(parsed.as_table_mut(), &change.path, &change.value)?;
        }
        Self::of(&self.file, &parsed.to_string())
    }

    pub(super) fn write(&self) -> Result<(), StudioError> {
        folder::write(&self.file, self.text.as_bytes())
    }
}

fn parse(file: &Path, text: &str) -> Result<DocumentMut, StudioError> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    if text.len() > MOST_BYTES {
        return Err(StudioError::Refused(format!("{name} is no scene: it has more than {MOST_BYTES} bytes")));
    }
    text.parse().map_err(|error: toml_edit::TomlError| StudioError::Refused(format!("{name}: {}", one_line(&error.to_string()))))
}

fn one_line(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

fn apply(table: &mut Table, path: &[Step], value: &Json) -> Result<(), StudioError> {
    match path {
        [Step::Key(key)] => {
            if value.is_null() {
                table.remove(key);
            } else {
                set(table, key, item(value)?);
            }
            Ok(())
        }
        [Step::Key(key), Step::Place(place), rest @ ..] => {
            let entry = table.entry(key).or_insert_with(|| Item::ArrayOfTables(toml_edit::ArrayOfTables::new()));
            let none = || StudioError::Refused(format!("the scene has no {key} with number {place}"));
            let tables = entry.as_array_of_tables_mut().ok_or_else(none)?;
            if rest.is_empty() && value.is_null() && *place < tables.len() {
                tables.remove(*place);
                return Ok(());
            }
            apply(tables.get_mut(*place).ok_or_else(none)?, rest, value)
        }
        [Step::Key(key), rest @ ..] => {
            let inner = table.entry(key).or_insert_with(|| Item::Table(Table::new()));
            // `set = { ... }` on one line becomes a table of its own.
            if let Some(inline) = inner.as_inline_table() {
                *inner = Item::Table(inline.clone().into_table());
            }
            let inner_table =
                inner.as_table_mut().ok_or_else(|| StudioError::Refused(format!("{key} in the scene is no table")))?;
            apply(inner_table, rest, value)?;
            if inner_table.is_empty() {
                table.remove(key);
            }
            Ok(())
        }
        _ => Err(StudioError::Refused("a change needs the path of a key".to_owned())),
    }
}

/// Puts an item in place of another, whose comments stay.
fn set(table: &mut Table, key: &str, mut item: Item) {
    if let (Some(Item::Value(before)), Item::Value(after)) = (table.get(key), &mut item) {
        *after.decor_mut() = before.decor().clone();
    }
    table.insert(key, item);
}

fn item(value: &Json) -> Result<Item, StudioError> {
    match value {
        Json::Array(parts) if !parts.is_empty() && parts.iter().all(Json::is_object) => {
            let tables: Result<toml_edit::ArrayOfTables, StudioError> = parts.iter().map(table).collect();
            Ok(Item::ArrayOfTables(tables?))
        }
        Json::Object(_) => Ok(Item::Table(table(value)?)),
        _ => Ok(Item::Value(plain(value)?)),
    }
}

fn table(value: &Json) -> Result<Table, StudioError> {
    let Json::Object(pairs) = value else { return Err(StudioError::Refused("a table is expected".to_owned())) };
    pairs.iter().filter(|(_, value)| !value.is_null()).map(|(key, value)| Ok((key.as_str(), item(value)?))).collect()
}

fn plain(value: &Json) -> Result<Value, StudioError> {
    Ok(match value {
        Json::Bool(truth) => Value::from(*truth),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => Value::from(whole),
            None => Value::from(number.as_f64().unwrap_or_default()),
        },
        Json::String(text) => Value::from(text.as_str()),
        Json::Array(parts) => Value::Array(parts.iter().map(plain).collect::<Result<Array, _>>()?),
        Json::Object(pairs) => {
            let pairs = pairs.iter().filter(|(_, value)| !value.is_null());
            let pairs: Result<InlineTable, _> = pairs.map(|(key, value)| Ok((key.as_str(), plain(value)?))).collect();
            Value::InlineTable(pairs?)
        }
        Json::Null => return Err(StudioError::Refused("null stands only for a whole key".to_owned())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn changed(text: &str, changes: &Json) -> Result<String, StudioError> {
        let changes: Vec<Change> = serde_json::from_value(changes.clone()).unwrap();
        Ok(Document::of(Path::new("/nowhere/a.toml"), text)?.changed(&changes)?.text().to_owned())
    }

    #[test]
    fn keys_are_set_and_taken_out_and_comments_stay() {
        let text = "# mine\nphotograph = \"a.jpg\"\nsize = \"90x120mm\" # the column\n";
        let after =
            changed(text, &json!([{"path": ["size"], "value": "38x50mm"}, {"path": ["set", "pitch"], "value": 0.5}])).unwrap();
        assert_eq!(after, "# mine\nphotograph = \"a.jpg\"\nsize = \"38x50mm\" # the column\n\n[set]\npitch = 0.5\n");
        let before =
            changed(&after, &json!([{"path": ["size"], "value": null}, {"path": ["set", "pitch"], "value": null}])).unwrap();
        assert_eq!(before, "# mine\nphotograph = \"a.jpg\"\n");
    }

    #[test]
    fn regions_are_tables() {
        let text =
            changed("photograph = 'a.jpg'\n", &json!([{"path": ["region"], "value": [{"mask": "hair", "style": "charcoal"}]}]))
                .unwrap();
        assert!(text.contains("[[region]]\nmask = \"hair\"\nstyle = \"charcoal\"\n"), "{text}");
        let text = changed(&text, &json!([{"path": ["region", 0, "set", "pitch"], "value": 0.4}])).unwrap();
        assert!(text.contains("[region.set]\npitch = 0.4\n"), "{text}");
        assert!(changed(&text, &json!([{"path": ["region", 3, "style"], "value": "grid"}])).is_err());
        assert!(!changed(&text, &json!([{"path": ["region", 0], "value": null}])).unwrap().contains("region"));
    }

    #[test]
    fn changes_are_made_together_or_not_at_all() {
        let wrong = json!([{"path": ["size"], "value": "1x1mm"}, {"path": ["photograph"], "value": "/etc/passwd"}]);
        assert!(changed("photograph = 'a.jpg'\n", &wrong).is_err());
        assert!(changed("photograph = ", &json!([])).is_err());
    }
}
