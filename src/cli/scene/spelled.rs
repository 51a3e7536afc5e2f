//! What a command line amounts to: each option of `draw` that differs from its default, as it would be typed.

use super::document::{draw_command, is_switch, long};
use crate::cli::arguments::Spelled;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches};

/// Options that say how to work, not what to draw: they are in no scene and no recipe.
pub(super) const RUN_ONLY: [&str; 17] = [
    "draft",
    "send",
    "yes",
    "help",
    "version",
    "output",
    "format",
    "threads",
    "json",
    "quiet",
    "dry-run",
    "preview",
    "preview-travel",
    "preset",
    "params",
    "save-scene",
    "explain",
];

impl Spelled {
    /// The options that a parsed `draw` or `scene` was given.
    pub(in crate::cli) fn of(given: &ArgMatches) -> Self {
        let command = draw_command();
        let options = command.get_arguments().filter(|arg| is_drawn(arg));
        Self(options.filter_map(|arg| Some((long(arg).to_owned(), values(arg, given)?))).collect())
    }
}

/// True for options that decide what is drawn.
pub(super) fn is_drawn(arg: &Arg) -> bool {
    arg.get_long().is_some_and(|long| !RUN_ONLY.contains(&long))
}

fn values(arg: &Arg, given: &ArgMatches) -> Option<Vec<String>> {
    let id = arg.get_id().as_str();
    let is_given = given.try_contains_id(id).is_ok() && given.value_source(id) == Some(ValueSource::CommandLine);
    if !is_given {
        return None;
    }
    if is_switch(arg) {
        return Some(Vec::new());
    }
    let values: Vec<String> = given.get_raw(id)?.map(|value| value.to_string_lossy().into_owned()).collect();
    let defaults: Vec<String> = arg.get_default_values().iter().map(|value| value.to_string_lossy().into_owned()).collect();
    (values != defaults).then_some(values)
}
