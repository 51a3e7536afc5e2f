//! Reads a scene, a preset or a `--params` file: TOML whose keys are the long options of `draw`.
//!
//! ```toml
//! photograph = "portrait.jpg"   # scenes only; paths are relative to the file
//! style = "hedcut"
//! size = "90x120mm"
//! mirror = true
//!
//! [set]                         # parameters of the style
//! pitch = 0.5
//!
//! [mask]
//! hair = "hair.png"
//!
//! [[region]]                    # see `region`
//! mask = "hair"
//! style = "charcoal"
//! ```

use super::origin::Origin;
use crate::cli::arguments::Arguments;
use crate::cli::failure::Failure;
use crate::cli::words::{inline_table, line_of, nearest, switch_word};
use crate::source::MaskRole;
use clap::{Arg, ArgAction, Command, CommandFactory};
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// The key of the photograph.
pub(super) const PHOTOGRAPH: &str = "photograph";
/// The key of a preset's purpose.
pub(super) const PURPOSE: &str = "purpose";
/// Keys whose values are tables.
pub(super) const SET: &str = "set";
pub(super) const MASK: &str = "mask";
pub(super) const REGION: &str = "region";
/// Options that make no sense in a file.
pub(super) const NOT_IN_FILES: [&str; 7] = ["help", "version", "preset", "params", "save-scene", "quiet", "draft"];
/// Options whose values are paths.
const PATHS: [&str; 9] = [PHOTOGRAPH, MASK, "sight", "depth", "profile", "pens", "colours", "preview", "output"];
/// Those that are written.
const OUTPUTS: [&str; 2] = ["preview", "output"];

/// What a file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// A whole drawing.
    Scene,
    /// Options for any photograph.
    Preset,
    /// A style's parameters, or options for any photograph.
    Params,
    /// A scene or preset whose photograph and purpose are of no interest.
    Recipe,
}

/// One option given by a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    /// The long option, or `photograph`.
    pub option: String,
    /// Its value; a switch has none.
    pub value: Option<String>,
    /// Where it stands.
    pub place: String,
}

impl Entry {
    /// The words of a command line that say the same.
    pub(super) fn word(&self) -> String {
        match &self.value {
            Some(value) => format!("--{}={value}", self.option),
            None => format!("--{}", self.option),
        }
    }

    /// A failure at its place.
    pub(super) fn refuse(&self, problem: &str) -> Failure {
        Failure::Work(format!("{}: {problem}", self.place))
    }
}

/// The options of `draw` that files may hold.
pub(super) fn options() -> Vec<Arg> {
    let command = draw_command();
    let all = command.get_arguments().filter(|arg| arg.get_long().is_some_and(|long| !NOT_IN_FILES.contains(&long)));
    all.cloned().collect()
}

pub(super) fn draw_command() -> Command {
    let mut all = Arguments::command();
    all.build();
    all.find_subcommand("draw").cloned().unwrap_or_default()
}

/// The long name of an option.
pub(super) fn long(option: &Arg) -> &str {
    option.get_long().unwrap_or_default()
}

/// True if it takes no value.
pub(super) fn is_switch(option: &Arg) -> bool {
    matches!(option.get_action(), ArgAction::SetTrue)
}

/// True if it may be given several times, or takes a list.
pub(super) fn is_list(option: &Arg) -> bool {
    matches!(option.get_action(), ArgAction::Append)
}

/// True if an option's value is the path of a file.
pub(in crate::cli) fn names_file(option: &str, value: &str) -> bool {
    PATHS.contains(&option)
        && match option {
            "sight" => value != "none",
            "profile" => !crate::plot::built_in_names().contains(&value),
            _ => value != "-",
        }
}

/// The files and folders that a value of an option names.
pub(in crate::cli) fn named_files(option: &str, value: &str) -> Vec<PathBuf> {
    let path = match option {
        MASK => value.split_once('=').map(|(_, file)| file.to_owned()),
        REGION => inline_table(value).and_then(|keys| match keys.get(MASK) {
            Some(toml::Value::String(mask)) if MaskRole::named(mask).is_none() => Some(mask.clone()),
            _ => None,
        }),
        _ => Some(value.to_owned()).filter(|value| names_file(option, value) && !OUTPUTS.contains(&option)),
    };
    path.into_iter().map(PathBuf::from).collect()
}

/// A file's options and the files that they name.
#[derive(Debug, Default)]
pub(super) struct Document {
    pub entries: Vec<Entry>,
    pub origins: Vec<Origin>,
    /// What a preset is for.
    pub purpose: Option<String>,
}

/// Reads the text of a file; `file` is its name in messages, and paths in it are relative to its folder.
pub(super) fn read(file: &str, text: &str, role: Role) -> Result<Document, Failure> {
    let syntax = |error: toml::de::Error| {
        let line = error.span().map_or(1, |span| line_of(text, span.start));
        Failure::Work(format!("{file}, line {line}: {}", error.message()))
    };
    let table = DeTable::parse(text).map_err(syntax)?;
    let folder = Path::new(file).parent().map(Path::to_path_buf).unwrap_or_default();
    let mut reader = Reader { file, text, role, folder, options: options(), document: Document::default() };
    for (key, value) in table.get_ref() {
        let place = reader.place(key.span().start);
        reader.key(key.get_ref(), value.get_ref(), &place)?;
    }
    Ok(reader.document)
}

struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    role: Role,
    folder: PathBuf,
    options: Vec<Arg>,
    document: Document,
}

impl Reader<'_> {
    fn place(&self, byte: usize) -> String {
        format!("{}, line {}", self.file, line_of(self.text, byte))
    }

    fn key(&mut self, key: &str, value: &DeValue<'_>, place: &str) -> Result<(), Failure> {
        match (key, value) {
            (PHOTOGRAPH | PURPOSE, _) if self.role == Role::Recipe => Ok(()),
            (PHOTOGRAPH, _) if self.role == Role::Scene => self.add(PHOTOGRAPH, value, place),
            (PURPOSE, _) if self.role == Role::Preset => {
                self.document.purpose = Some(scalar(value).ok_or_else(|| refuse(place, "purpose is a sentence in quotes"))?);
                Ok(())
            }
            (SET | MASK, DeValue::Table(table)) => self.pairs(key, table),
            (REGION, DeValue::Array(_)) => self.regions(value, place),
            (SET | MASK | REGION, _) => {
                let form = if key == REGION { "[[region]] tables" } else { "a table, such as" };
                let example = if key == REGION { String::new() } else { format!(" [{key}]") };
                Err(refuse(place, &format!("{key} is {form}{example}")))
            }
            _ if self.options.iter().any(|option| long(option) == key) => self.add(key, value, place),
            // A file of a style's parameters, without tables.
            _ if self.role == Role::Params => {
                let text = scalar(value)
                    .ok_or_else(|| Failure::Work(format!("{}: {key} is not a string, a number or a boolean", self.file)))?;
                let text = if let DeValue::Boolean(is_on) = value { switch_word(*is_on).to_owned() } else { text };
                self.entry(SET, Some(format!("{key}={text}")), place);
                Ok(())
            }
            _ => Err(self.unknown(key, place)),
        }
    }

    /// The entries of `[set]` or `[mask]`.
    fn pairs(&mut self, option: &str, table: &DeTable<'_>) -> Result<(), Failure> {
        for (key, value) in table {
            let place = self.place(key.span().start);
            let (key, value) = (key.get_ref(), value.get_ref());
            let text = scalar(value)
                .ok_or_else(|| refuse(&place, &format!("{key} in [{option}] is not a string, a number or a boolean")))?;
            let text = if let DeValue::Boolean(is_on) = value { switch_word(*is_on).to_owned() } else { text };
            let text = if option == MASK { self.path(&text, MASK, &place) } else { text };
            self.entry(option, Some(format!("{key}={text}")), &place);
        }
        Ok(())
    }

    /// The `[[region]]` tables, each as the text of one `--region`.
    fn regions(&mut self, list: &DeValue<'_>, place: &str) -> Result<(), Failure> {
        let DeValue::Array(list) = list else { return Ok(()) };
        for region in list {
            let place = self.place(region.span().start);
            let DeValue::Table(table) = region.get_ref() else {
                return Err(refuse(&place, "each region is a [[region]] table"));
            };
            let mut plain: toml::Table = toml::Table::new();
            for (key, value) in table {
                let line = self.place(key.span().start);
                let mut value = plain_value(value.get_ref()).ok_or_else(|| refuse(&line, &format!("{key} cannot be a date")))?;
                let text = value.as_str().unwrap_or_default().to_owned();
                if key.get_ref() == MASK && MaskRole::named(&text).is_none() {
                    value = toml::Value::String(self.path(&text, MASK, &line));
                }
                plain.insert(key.get_ref().to_string(), value);
            }
            self.entry(REGION, Some(inline(&plain)), &place);
        }
        if list.is_empty() {
            return Err(refuse(place, "there is no region in the list"));
        }
        Ok(())
    }

    fn add(&mut self, key: &str, value: &DeValue<'_>, place: &str) -> Result<(), Failure> {
        let option = self.options.iter().find(|option| long(option) == key);
        let is_switch = option.is_some_and(is_switch);
        let is_list = option.is_some_and(is_list);
        match value {
            DeValue::Boolean(true) if is_switch => self.entry(key, None, place),
            DeValue::Boolean(false) if is_switch => {}
            _ if is_switch => return Err(refuse(place, &format!("{key} is true or false"))),
            DeValue::Array(list) if is_list => {
                for value in list {
                    let text = scalar(value.get_ref()).ok_or_else(|| refuse(place, &format!("{key} is a list of texts")))?;
                    self.entry(key, Some(text), place);
                }
            }
            _ => {
                let text = scalar(value).ok_or_else(|| {
                    refuse(
                        place,
                        &format!("{key} is {}", if is_list { "a list of texts" } else { "one value, not a list or table" }),
                    )
                })?;
                let text = self.path(&text, key, place);
                self.entry(key, Some(text), place);
            }
        }
        Ok(())
    }

    fn entry(&mut self, option: &str, value: Option<String>, place: &str) {
        self.document.entries.push(Entry { option: option.to_owned(), value, place: place.to_owned() });
    }

    /// A path relative to the file's folder; names that are no files stay as they are.
    fn path(&mut self, text: &str, key: &str, place: &str) -> String {
        if !names_file(key, text) {
            return text.to_owned();
        }
        let path = self.folder.join(text).to_string_lossy().into_owned();
        if !OUTPUTS.contains(&key) {
            self.document.origins.push(Origin { path: path.clone(), place: place.to_owned() });
        }
        path
    }

    fn unknown(&self, key: &str, place: &str) -> Failure {
        let own = if self.role == Role::Scene { PHOTOGRAPH } else { PURPOSE };
        let known = self.options.iter().map(long).chain([own, SET, MASK, REGION]);
        let near = nearest(key, known);
        let style_key = crate::style::STYLES.iter().find(|style| style.parameters().iter().any(|p| p.name == key));
        refuse(
            place,
            &match (near, style_key) {
                (_, Some(style)) => format!("'{key}' is a parameter of {}: put it under [set]", style.name()),
                (Some(near), None) => format!("there is no key '{key}'; did you mean {near}?"),
                (None, None) => format!("there is no key '{key}'; keys are the long options of `drypoint draw`, without dashes"),
            },
        )
    }
}

fn refuse(place: &str, problem: &str) -> Failure {
    Failure::Work(format!("{place}: {problem}"))
}

/// A string, a number or a boolean as text.
fn scalar(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) => Some(text.to_string()),
        DeValue::Integer(_) | DeValue::Float(_) | DeValue::Boolean(_) => Some(match plain_value(value)? {
            toml::Value::Integer(number) => number.to_string(),
            toml::Value::Float(number) => number.to_string(),
            other => other.to_string(),
        }),
        _ => None,
    }
}

fn plain_value(value: &DeValue<'_>) -> Option<toml::Value> {
    Some(match value {
        DeValue::String(text) => toml::Value::String(text.to_string()),
        DeValue::Integer(number) => toml::Value::Integer(i64::from_str_radix(number.as_str(), number.radix()).ok()?),
        DeValue::Float(number) => toml::Value::Float(number.as_str().parse().ok()?),
        DeValue::Boolean(is_on) => toml::Value::Boolean(*is_on),
        DeValue::Array(list) => toml::Value::Array(list.iter().map(|v| plain_value(v.get_ref())).collect::<Option<_>>()?),
        DeValue::Table(table) => toml::Value::Table(
            table.iter().map(|(k, v)| Some((k.get_ref().to_string(), plain_value(v.get_ref())?))).collect::<Option<_>>()?,
        ),
        DeValue::Datetime(_) => return None,
    })
}

/// A table as the inside of an inline table.
pub(super) fn inline(table: &toml::Table) -> String {
    let value = |value: &toml::Value| match value {
        toml::Value::Table(inner) => format!("{{ {} }}", inline(inner)),
        other => other.to_string(),
    };
    table.iter().map(|(key, v)| format!("{key} = {}", value(v))).collect::<Vec<_>>().join(", ")
}

/// The keys of a region with another file as its mask; unchanged if its mask is a role, none if the change gives none.
pub(in crate::cli) fn with_mask(text: &str, change: impl FnOnce(&str) -> Option<String>) -> Option<String> {
    let Some(mut keys) = inline_table(text) else { return Some(text.to_owned()) };
    let Some(toml::Value::String(mask)) = keys.get_mut(MASK) else { return Some(text.to_owned()) };
    if MaskRole::named(mask).is_some() {
        return Some(text.to_owned());
    }
    *mask = change(mask)?;
    Some(inline(&keys))
}
