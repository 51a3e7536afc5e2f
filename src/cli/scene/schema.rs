//! The JSON schema of scenes and presets, from which editors complete and check.

use super::document::{MASK, PHOTOGRAPH, PURPOSE, REGION, SET, is_list, is_switch, long, options};
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::cli::region::KEYS;
use crate::source::MaskRole;
use crate::style::{Kind, Parameter, STYLES};
use clap::Arg;
use serde_json::{Map, Value, json};

/// Prints the schema.
pub(in crate::cli) fn schema() -> Result<(), Failure> {
    output::print_json(&value())
}

/// The schema (JSON Schema, draft 7, which editors of TOML read).
pub(super) fn value() -> Value {
    let mut properties = Map::new();
    properties
        .insert(PHOTOGRAPH.to_owned(), json!({ "type": "string", "description": "The photograph, relative to this file." }));
    properties.insert(PURPOSE.to_owned(), json!({ "type": "string", "description": "What a preset is for." }));
    for option in options() {
        properties.insert(long(&option).to_owned(), of_option(&option));
    }
    let masks: Map<String, Value> = MaskRole::ALL
        .into_iter()
        .map(|(name, role)| (name.to_owned(), json!({ "type": "string", "description": role.meaning() })))
        .collect();
    let masks =
        json!({ "type": "object", "description": "Masks by role: files.", "additionalProperties": false, "properties": masks });
    properties.insert(MASK.to_owned(), masks);
    properties.insert(SET.to_owned(), parameters());
    properties.insert(REGION.to_owned(), json!({ "type": "array", "items": region() }));
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "A scene or preset of drypoint",
        "type": "object",
        "additionalProperties": false,
        "properties": properties,
    })
}

fn of_option(option: &Arg) -> Value {
    let words: Vec<String> = option.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    let mut value = if is_switch(option) {
        json!({ "type": "boolean" })
    } else if is_list(option) {
        json!({ "type": "array", "items": { "type": ["string", "number"] } })
    } else if words.is_empty() {
        json!({ "type": ["string", "number"] })
    } else {
        json!({ "enum": words })
    };
    value["description"] = json!(option.get_help().map(ToString::to_string).unwrap_or_default());
    if let Some(default) = option.get_default_values().first().filter(|_| !is_switch(option)) {
        value["default"] = json!(default.to_string_lossy());
    }
    value
}

/// The parameters of all styles.
fn parameters() -> Value {
    let mut properties: Map<String, Value> = Map::new();
    for (style, parameter) in STYLES.iter().flat_map(|style| style.parameters().iter().map(|p| (style.name(), p))) {
        let text =
            format!("{style}: {}; {}; default {}", parameter.meaning, parameter.kind.range_text(), parameter.kind.default_text());
        let known = properties
            .get(parameter.name)
            .and_then(|value| value["description"].as_str())
            .map(|known| format!("{known}\n{text}"));
        properties.insert(parameter.name.to_owned(), json!({ "type": types(parameter), "description": known.unwrap_or(text) }));
    }
    json!({ "type": "object", "description": "Parameters of the style.", "additionalProperties": false, "properties": properties })
}

/// Words of a choice may be booleans too, and lengths texts with a unit.
fn types(parameter: &Parameter) -> Value {
    match parameter.kind {
        Kind::Choice(_) => json!(["string", "boolean"]),
        _ => json!(["string", "number", "boolean"]),
    }
}

fn region() -> Value {
    let properties: Map<String, Value> = KEYS
        .iter()
        .map(|(key, meaning)| {
            let kind = if *key == SET {
                parameters()
            } else {
                json!({ "type": ["string", "number", "boolean"], "description": meaning })
            };
            ((*key).to_owned(), kind)
        })
        .collect();
    json!({ "type": "object", "additionalProperties": false, "required": [MASK], "properties": properties })
}
