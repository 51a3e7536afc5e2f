//! A profile's text: files merged key by key, with the place of each key.
//!
//! ```text
//! extends = "hp7475a"        the built-in file's keys first, then this file's, then the overrides
//! [motion]
//! draw_speed = 200           replaces that one key
//! [[paper]]
//! name = "a4"                changes the sheet of this name, or adds one
//! zero = [10.5, 206]
//! ```

use super::error::{KeyPlace, ProfileError};
use crate::plot::language::Language;
use std::fmt::Write as _;
use toml::de::{DeTable, DeValue};

/// Lists whose members are identified by one of their keys, so that a single member can be changed.
const NAMED_LISTS: [(&str, &str); 2] = [("paper", "name"), ("pen", "slot")];

/// Keys and values in order of first appearance.
#[derive(Debug, Default)]
pub(super) struct Document {
    entries: Vec<Entry>,
    /// The language that was chosen, whose table is the profile's dialect.
    language: Option<Language>,
}

#[derive(Clone, Debug)]
struct Entry {
    /// The key's parts, such as `motion`, `draw_speed` or `paper`, `a4`, `zero`.
    path: Vec<String>,
    value: toml::Value,
    place: KeyPlace,
}

impl Document {
    /// Merges one file into the document and returns the name of the profile that it extends.
    pub(super) fn read(&mut self, file: &str, text: &str) -> Result<Option<String>, ProfileError> {
        let syntax = |span: Option<std::ops::Range<usize>>, message: String| {
            let line = span.map_or(1, |span| line_of(text, span.start));
            ProfileError::Syntax { place: KeyPlace::Line { file: file.to_owned(), line }, message }
        };
        let spans = DeTable::parse(text).map_err(|error| syntax(error.span(), error.message().to_owned()))?;
        let values: toml::Table =
            toml::from_str(text).map_err(|error: toml::de::Error| syntax(error.span(), error.message().to_owned()))?;
        let extends = match values.get("extends") {
            None => None,
            Some(toml::Value::String(name)) => Some(name.clone()),
            Some(_) => return Err(syntax(None, "extends must be the name of a built-in profile".to_owned())),
        };
        let mut found = Vec::new();
        Reader { file, text, found: &mut found }.table(&[], spans.get_ref(), &values);
        found.into_iter().filter(|entry| entry.path != ["extends"]).for_each(|entry| self.set(entry));
        Ok(extends)
    }

    /// Sets one key, such as `motion.draw_speed` or `paper.a4.zero`. A value that is not valid TOML is taken as a string.
    pub(super) fn set_option(&mut self, key: &str, value: &str) {
        let path: Vec<String> = key.split('.').map(str::to_owned).collect();
        let value = toml::from_str::<toml::Table>(&format!("v = {value}"))
            .ok()
            .and_then(|mut table| table.remove("v"))
            .unwrap_or_else(|| toml::Value::String(value.to_owned()));
        if let [list, member, _, ..] = &path[..]
            && let Some((_, name)) = NAMED_LISTS.iter().find(|(known, _)| known == list)
        {
            let told = member.parse().map_or_else(|_| toml::Value::String(member.clone()), toml::Value::Integer);
            self.set(Entry { path: vec![list.clone(), member.clone(), (*name).to_owned()], value: told, place: KeyPlace::Set });
        }
        self.set(Entry { path, value, place: KeyPlace::Set });
    }

    /// Keeps the table of the profile's language alone: a profile may extend one that speaks another.
    pub(super) fn choose_language(&mut self, name: &str) -> Result<(), ProfileError> {
        let names = || Language::ALL.map(Language::key);
        let Some(i) = self.entries.iter().position(|entry| entry.path == ["language"]) else {
            let message = format!("language is missing; it is one of {}", names().join(", "));
            return Err(ProfileError::Syntax { place: KeyPlace::File(name.to_owned()), message });
        };
        let entry = self.entries.remove(i);
        let wanted = entry.value.as_str().unwrap_or_default();
        let Some(language) = Language::ALL.into_iter().find(|language| language.key() == wanted) else {
            let message = format!("language: {} is none of {}", entry.value, names().join(", "));
            return Err(ProfileError::Syntax { place: entry.place, message });
        };
        self.entries.retain(|entry| entry.path[0] == language.key() || !names().contains(&entry.path[0].as_str()));
        if !self.entries.iter().any(|entry| entry.path[0] == language.key()) {
            let (key, place) = (language.key().to_owned(), KeyPlace::File(name.to_owned()));
            return Err(ProfileError::Value { place, problem: format!("is missing, and the language is {key}"), key });
        }
        self.language = Some(language);
        Ok(())
    }

    /// Sets a key, replacing the same key, everything below it and every key above it.
    fn set(&mut self, entry: Entry) {
        if let Some(same) = self.entries.iter_mut().find(|known| known.path == entry.path) {
            *same = entry;
            return;
        }
        let is_above = |above: &[String], below: &[String]| below.len() > above.len() && below[..above.len()] == *above;
        self.entries.retain(|known| !is_above(&entry.path, &known.path) && !is_above(&known.path, &entry.path));
        self.entries.push(entry);
    }

    /// The place of a key or of one below it, if given.
    pub(super) fn place_of(&self, key: &str) -> Option<KeyPlace> {
        let parts: Vec<&str> = key.split('.').collect();
        let begins = |entry: &&Entry| entry.path.len() >= parts.len() && entry.path.iter().zip(&parts).all(|(a, b)| a == b);
        self.entries.iter().rfind(begins).map(|entry| entry.place.clone())
    }

    /// Deserializes the document. Errors name the place of the key that caused them.
    pub(super) fn resolve<T: serde::de::DeserializeOwned>(&self, name: &str) -> Result<T, ProfileError> {
        let (text, owners) = self.flat();
        toml::from_str(&text).map_err(|error| {
            let line = error.span().map_or(usize::MAX, |span| line_of(&text, span.start) - 1);
            match owners.get(line).and_then(|owner| self.entries.get(*owner)) {
                Some(entry) if !error.message().starts_with("missing field") => {
                    let key = entry.path.join(".");
                    ProfileError::Syntax { place: entry.place.clone(), message: format!("{key}: {}", error.message()) }
                }
                Some(entry) => {
                    let within = entry.path[..entry.path.len() - 1].join(".");
                    ProfileError::Syntax { place: entry.place.clone(), message: format!("{within}: {}", error.message()) }
                }
                None => ProfileError::Syntax { place: KeyPlace::File(name.to_owned()), message: error.message().to_owned() },
            }
        })
    }

    /// The document as TOML with one key per line, and for each line the index of its entry: single keys first, then tables, then
    /// list members.
    fn flat(&self) -> (String, Vec<usize>) {
        let mut sections: Vec<(Vec<String>, Vec<usize>)> = vec![(Vec::new(), Vec::new())];
        for (i, entry) in self.entries.iter().enumerate() {
            let header = entry.path[..entry.path.len() - 1].to_vec();
            match sections.iter_mut().find(|(known, _)| *known == header) {
                Some((_, members)) => members.push(i),
                None => sections.push((header, vec![i])),
            }
        }
        let (mut text, mut owners) = (String::new(), Vec::new());
        for (header, members) in &sections {
            let owner = members.first().copied().unwrap_or(usize::MAX);
            let mut begin = text.len();
            match &header[..] {
                [] => {}
                [list, _] if is_named_list(list) => {
                    let _ = writeln!(text, "[[{list}]]");
                }
                parts => {
                    let is_dialect = self.language.is_some_and(|language| language.key() == parts[0]);
                    let path = is_dialect.then(|| "dialect".to_owned()).into_iter().chain(parts.iter().map(|part| quoted(part)));
                    let _ = writeln!(text, "[{}]", path.collect::<Vec<_>>().join("."));
                }
            }
            let mut owe = |text: &str, owner: usize, begin: &mut usize| {
                owners.extend(std::iter::repeat_n(owner, text[*begin..].matches('\n').count()));
                *begin = text.len();
            };
            owe(&text, owner, &mut begin);
            for &i in members {
                let entry = &self.entries[i];
                let _ = writeln!(text, "{} = {}", quoted(&entry.path[entry.path.len() - 1]), entry.value);
                owe(&text, i, &mut begin);
            }
        }
        (text, owners)
    }
}

fn is_named_list(name: &str) -> bool {
    NAMED_LISTS.iter().any(|(known, _)| *known == name)
}

fn quoted(key: &str) -> String {
    let is_bare = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if is_bare { key.to_owned() } else { toml::Value::String(key.to_owned()).to_string() }
}

fn line_of(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|b| *b == b'\n').count()
}

/// Walks a file's values and their places side by side.
struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    found: &'a mut Vec<Entry>,
}

impl Reader<'_> {
    fn table(&mut self, path: &[String], spans: &DeTable<'_>, values: &toml::Table) {
        let mut keys: Vec<_> = spans.iter().collect();
        keys.sort_by_key(|(key, _)| key.span().start);
        for (key, spanned) in keys {
            let name = key.get_ref().to_string();
            let Some(value) = values.get(&name) else { continue };
            let below = [path, std::slice::from_ref(&name)].concat();
            match (spanned.get_ref(), value) {
                (DeValue::Table(spans), toml::Value::Table(values)) => self.table(&below, spans, values),
                (DeValue::Array(spans), toml::Value::Array(values)) if path.is_empty() && is_named_list(&name) => {
                    self.list(&name, spans, values);
                }
                _ => {
                    let line = line_of(self.text, key.span().start);
                    let place = KeyPlace::Line { file: self.file.to_owned(), line };
                    self.found.push(Entry { path: below, value: value.clone(), place });
                }
            }
        }
    }

    fn list(&mut self, name: &str, spans: &toml::de::DeArray<'_>, values: &[toml::Value]) {
        let told_by = NAMED_LISTS.iter().find(|(known, _)| *known == name).map_or("name", |(_, key)| key);
        for (i, (spanned, value)) in spans.iter().zip(values).enumerate() {
            if let (DeValue::Table(spans), toml::Value::Table(values)) = (spanned.get_ref(), value) {
                let member = match values.get(told_by) {
                    Some(toml::Value::String(text)) => text.clone(),
                    Some(other) => other.to_string(),
                    None => format!("number {}", i + 1),
                };
                self.table(&[name.to_owned(), member], spans, values);
            }
        }
    }
}
