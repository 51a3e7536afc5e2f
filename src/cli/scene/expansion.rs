//! Puts scenes, presets, `--params` files and recipes into the command line, then parses that.

use super::document::{self, Document, Entry, MASK, PHOTOGRAPH, REGION, Role, SET, is_list, is_switch, long};
use super::origin::Origins;
use super::{presets, redo};
use crate::cli::arguments::Arguments;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::cli::region::region;
use crate::cli::words::is_toml;
use crate::style::{self, Settings};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command, CommandFactory};
use std::collections::HashSet;
use std::error::Error as _;
use std::ffi::OsString;
use std::path::Path;

/// Commands that take scenes and presets.
const COMMANDS: [&str; 5] = ["draw", "stages", "scene", "redo", "batch"];
/// Pairs of options of which a command line's one replaces a file's other.
const RIVALS: [[&str; 2]; 2] = [["center", "at"], ["at", "center"]];

/// Options of presets that do nothing without another.
const NEEDS: [[&str; 2]; 3] = [["max-time", "profile"], ["preview-travel", "preview"], ["depth-far-white", "depth"]];

/// The option of SVG alone, which a drawing's recipe leaves to its other formats.
const EMBED: &str = "embed";

/// Why a command line was refused.
#[derive(Debug)]
pub(in crate::cli) enum Refusal {
    /// By its parser.
    Usage(Box<clap::Error>),
    /// For something in a file.
    File(Failure),
}

impl From<Failure> for Refusal {
    fn from(failure: Failure) -> Self {
        Self::File(failure)
    }
}

impl From<clap::Error> for Refusal {
    fn from(error: clap::Error) -> Self {
        Self::Usage(Box::new(error))
    }
}

/// Parses a command line; options in files count as if they were on it, those on it win.
pub(in crate::cli) fn matches(words: &[OsString]) -> Result<(ArgMatches, Origins), Refusal> {
    let strict = Arguments::command().try_get_matches_from(words);
    let given = match &strict {
        // What is missing may stand in a file.
        Err(error) if error.kind() == ErrorKind::MissingRequiredArgument => {
            Arguments::command().ignore_errors(true).try_get_matches_from(words).ok()
        }
        Err(_) => None,
        Ok(matches) => Some(matches.clone()),
    };
    let plain = || Ok((strict?, Origins::default()));
    let Some((name, given)) = given.as_ref().and_then(ArgMatches::subcommand) else { return plain() };
    if !COMMANDS.contains(&name) {
        return plain();
    }
    let documents = documents(name, given)?;
    if documents.is_empty() {
        return plain();
    }
    let mut all = Arguments::command();
    all.build();
    let command = all.find_subcommand(name).cloned().unwrap_or_default();
    let line = Line::new(name, &command, given, documents);
    line.parsed()
}

/// The files that a command line names, those that win last.
fn documents(name: &str, given: &ArgMatches) -> Result<Vec<Document>, Failure> {
    let mut documents = Vec::new();
    if let Some(preset) = given.try_get_one::<String>("preset").ok().flatten() {
        documents.push(presets::find(preset)?);
    }
    if let Some(recipe) = given.try_get_one::<std::path::PathBuf>("recipe").ok().flatten() {
        let name = recipe.to_string_lossy();
        documents.push(document::read(&name, &output::read_settings(&name)?, Role::Recipe)?);
    }
    let photo = given.try_get_one::<String>("photo").ok().flatten();
    match photo {
        Some(drawing) if name == "redo" => documents.push(redo::document(drawing)?),
        Some(scene) if is_toml(scene) && name != "batch" => {
            documents.push(document::read(scene, &output::read_settings(scene)?, Role::Scene)?);
        }
        _ => {}
    }
    if let Some(params) = given.try_get_one::<std::path::PathBuf>("params").ok().flatten() {
        let name = params.to_string_lossy();
        documents.push(document::read(&name, &output::read_settings(&name)?, Role::Params)?);
    }
    Ok(documents)
}

/// A command line in the making.
struct Line<'a> {
    name: &'a str,
    command: &'a Command,
    given: &'a ArgMatches,
    /// What files add to it.
    entries: Vec<Entry>,
    origins: Origins,
}

impl<'a> Line<'a> {
    fn new(name: &'a str, command: &'a Command, given: &'a ArgMatches, documents: Vec<Document>) -> Self {
        let mut line = Self { name, command, given, entries: Vec::new(), origins: Origins::default() };
        for Document { entries, origins, .. } in documents {
            line.override_by(&entries);
            line.entries.extend(entries);
            line.origins.0.extend(origins);
        }
        let (own, style) = (line.own_entries(), line.own("style"));
        if style.is_some() && line.entries.iter().any(|entry| entry.option == "style" && entry.value != style) {
            line.entries.retain(|entry| entry.option != SET);
        }
        line.override_by(&own);
        let is_given = |option: &str| own.iter().chain(&line.entries).any(|entry| entry.option == option);
        let idle: Vec<&str> = NEEDS.iter().filter(|[_, needed]| !is_given(needed)).map(|[option, _]| *option).collect();
        line.entries.retain(|entry| {
            if idle.contains(&entry.option.as_str()) {
                return false;
            }
            let is_known = command.get_arguments().any(|arg| long(arg) == entry.option);
            is_known || entry.option == PHOTOGRAPH
        });
        if !line.writes_svg() {
            line.entries.retain(|entry| entry.option != EMBED);
        }
        let named: HashSet<String> = line.entries.iter().filter_map(|entry| entry.value.clone()).collect();
        let is_kept = |path: &str| named.iter().any(|value| value.ends_with(path) || value.contains(&format!("\"{path}\"")));
        line.origins.0.retain(|origin| is_kept(&origin.path));
        line
    }

    /// The value of an option on the command line itself.
    fn own(&self, id: &str) -> Option<String> {
        let is_own = self.given.try_contains_id(id).is_ok() && self.given.value_source(id) == Some(ValueSource::CommandLine);
        if is_own { self.given.get_raw(id)?.next().map(|value| value.to_string_lossy().into_owned()) } else { None }
    }

    /// True if the output is an SVG, or the drawing's own format where none is named.
    fn writes_svg(&self) -> bool {
        let output = self.own("output").or_else(|| self.own("photo")).unwrap_or_default();
        self.own("format").is_none_or(|format| format == "svg")
            && Path::new(&output)
                .extension()
                .is_none_or(|ending| ["svg", "svgz", "toml"].iter().any(|svg| ending.eq_ignore_ascii_case(svg)))
    }

    /// Removes what options with a higher rank replace.
    fn override_by(&mut self, winners: &[Entry]) {
        let has = |option: &str| winners.iter().any(|entry| entry.option == option);
        let role = |entry: &Entry| entry.value.as_deref().and_then(|value| Some(value.split_once('=')?.0.to_owned()));
        self.entries.retain(|entry| match entry.option.as_str() {
            SET => !(has("pitch") && role(entry).as_deref() == Some("pitch")),
            MASK => !winners.iter().any(|winner| winner.option == MASK && role(winner) == role(entry)),
            option => !has(option) && !RIVALS.iter().any(|[mine, other]| *mine == option && has(other)),
        });
    }

    /// The command line's own options.
    fn own_entries(&self) -> Vec<Entry> {
        let entry = |arg: &Arg, value: Option<String>| Entry {
            option: long(arg).to_owned(),
            value,
            place: "the command line".to_owned(),
        };
        let mut entries = Vec::new();
        for arg in self.command.get_arguments().filter(|arg| !arg.is_positional()) {
            let id = arg.get_id().as_str();
            let is_own = self.given.try_contains_id(id).is_ok() && self.given.value_source(id) == Some(ValueSource::CommandLine);
            if !is_own || matches!(id, "preset" | "params" | "recipe") {
                continue;
            }
            let values: Vec<String> =
                self.given.get_raw(id).into_iter().flatten().map(|value| value.to_string_lossy().into_owned()).collect();
            match arg.get_value_delimiter() {
                _ if is_switch(arg) => entries.push(entry(arg, None)),
                Some(comma) => entries.push(entry(arg, Some(values.join(&comma.to_string())))),
                None => entries.extend(values.into_iter().map(|value| entry(arg, Some(value)))),
            }
        }
        entries
    }

    /// What the command works on, in the order given.
    fn inputs(&self) -> Vec<String> {
        if self.name != "batch" {
            return self.photograph().into_iter().collect();
        }
        self.given.get_raw("photo").into_iter().flatten().map(|input| input.to_string_lossy().into_owned()).collect()
    }

    /// The photograph: on the command line, unless that names a scene or a drawing.
    fn photograph(&self) -> Option<String> {
        let named = self.entries.iter().find(|entry| entry.option == PHOTOGRAPH).and_then(|entry| entry.value.clone());
        named.or_else(|| self.own("photo").filter(|photo| self.name != "redo" && !is_toml(photo)))
    }

    fn words(&self) -> Vec<String> {
        let name = if self.name == "redo" { "draw" } else { self.name };
        let mut words = vec!["drypoint".to_owned(), name.to_owned()];
        words.extend(self.listed(&self.entries));
        let own = self.own_entries();
        words.extend(own.iter().map(Entry::word));
        if self.name == "redo" && !own.iter().any(|entry| entry.option == "output") {
            words.push(format!("--output={}", redo::usual_output(&self.own("photo").unwrap_or_default())));
        }
        words.push("--".to_owned());
        words.extend(self.inputs());
        words
    }

    /// The words of entries from files; lists with a delimiter are one word.
    fn listed(&self, entries: &[Entry]) -> Vec<String> {
        let mut words = Vec::new();
        for arg in self.command.get_arguments() {
            let mine: Vec<&Entry> = entries.iter().filter(|entry| entry.option == long(arg)).collect();
            match arg.get_value_delimiter() {
                Some(comma) if is_list(arg) && !mine.is_empty() => {
                    let values: Vec<&str> = mine.iter().filter_map(|entry| entry.value.as_deref()).collect();
                    words.push(format!("--{}={}", long(arg), values.join(&comma.to_string())));
                }
                _ => words.extend(mine.into_iter().map(Entry::word)),
            }
        }
        words
    }

    fn parsed(self) -> Result<(ArgMatches, Origins), Refusal> {
        if self.inputs().is_empty()
            && let Some(scene) = self.own("photo")
        {
            return Err(Failure::Work(format!("{scene}: {PHOTOGRAPH} is missing; add {PHOTOGRAPH} = \"portrait.jpg\"")).into());
        }
        let matches = Arguments::command().try_get_matches_from(self.words()).map_err(|error| self.culprit(error))?;
        self.check_style(&matches)?;
        self.check_files()?;
        self.check_regions()?;
        Ok((matches, self.origins))
    }

    /// The entry of a file that the parser refuses, if it is one.
    fn culprit(&self, error: clap::Error) -> Refusal {
        for entry in &self.entries {
            let words = ["drypoint", self.name, &entry.word(), "photo", "--output=x"];
            let Err(alone) = Arguments::command().try_get_matches_from(words) else { continue };
            if let (ErrorKind::ValueValidation | ErrorKind::InvalidValue, Some(value)) = (alone.kind(), &entry.value) {
                return entry.refuse(&format!("{} = {value}: {}", entry.option, reason(&alone))).into();
            }
        }
        error.into()
    }

    /// Refuses parameters in files that the style does not have, at their place.
    fn check_style(&self, matches: &ArgMatches) -> Result<(), Failure> {
        let name = matches.subcommand().and_then(|(_, given)| given.get_one::<String>("style").cloned()).unwrap_or_default();
        let Some(style) = style::find(&name) else {
            let entry = self.entries.iter().find(|entry| entry.option == "style");
            let known: Vec<&str> = style::STYLES.iter().map(|style| style.name()).collect();
            return entry
                .map_or(Ok(()), |e| Err(e.refuse(&format!("there is no style '{name}'; there are {}", known.join(", ")))));
        };
        for entry in self.entries.iter().filter(|entry| entry.option == SET) {
            let Some((key, value)) = entry.value.as_deref().and_then(|value| value.split_once('=')) else { continue };
            let pair = (key.trim().to_owned(), value.trim().to_owned());
            Settings::resolve(style.name(), style.parameters(), &[pair]).map_err(|error| entry.refuse(&error.to_string()))?;
        }
        Ok(())
    }

    /// Refuses two regions of one mask: one would hide the other.
    fn check_regions(&self) -> Result<(), Failure> {
        let regions: Vec<(&Entry, String)> = self
            .entries
            .iter()
            .filter(|entry| entry.option == REGION)
            .filter_map(|entry| Some((entry, region(entry.value.as_deref()?).ok()?.mask)))
            .collect();
        for (i, (entry, mask)) in regions.iter().enumerate() {
            if let Some((first, _)) = regions[..i].iter().find(|(_, other)| other == mask) {
                let problem =
                    format!("this region has the mask {mask}, as that of {}, which it would hide; leave one out", first.place);
                return Err(entry.refuse(&problem));
            }
        }
        Ok(())
    }

    fn check_files(&self) -> Result<(), Failure> {
        let is_missing = |path: &str| path != "-" && !Path::new(path).exists();
        self.origins.0.iter().find(|origin| is_missing(&origin.path)).map_or(Ok(()), |origin| {
            let (path, place) = (&origin.path, &origin.place);
            Err(Failure::Work(format!("{place}: {path} does not exist; paths are relative to the file that names them")))
        })
    }
}

/// What the parser says against a value.
fn reason(error: &clap::Error) -> String {
    if let Some(ContextValue::Strings(values)) = error.get(ContextKind::ValidValue)
        && !values.is_empty()
    {
        return format!("must be one of {}", values.join(", "));
    }
    error.source().map_or_else(|| error.kind().to_string(), ToString::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_the_command_line_win() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("a.toml");
        std::fs::write(folder.path().join("a.jpg"), "").unwrap();
        std::fs::write(
            &scene,
            "photograph = \"a.jpg\"\nstyle = \"grid\"\nmargin = 7\npen = 0.2\ncenter = true\n[set]\npitch = 1\n",
        )
        .unwrap();
        let words = ["drypoint", "draw", scene.to_str().unwrap(), "-o", "x.svg", "--pen", "0.5", "--at", "1,2", "--pitch", "2"];
        let (matches, _) = super::matches(&words.map(OsString::from)).unwrap();
        let (_, draw) = matches.subcommand().unwrap();
        assert_eq!(draw.get_one::<f64>("pen"), Some(&0.5));
        assert_eq!(draw.get_one::<f64>("margin"), Some(&7.0));
        assert_eq!(draw.get_one::<f64>("pitch"), Some(&2.0));
        assert!(!draw.get_flag("center") && draw.get_many::<(String, String)>("set").is_none());
        assert!(draw.get_one::<String>("photo").unwrap().ends_with("a.jpg"));
    }

    #[test]
    fn a_fault_in_a_file_names_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("a.toml");
        std::fs::write(folder.path().join("a.jpg"), "").unwrap();
        let told = |text: &str| {
            std::fs::write(&scene, format!("photograph = \"a.jpg\"\n{text}")).unwrap();
            let words = ["drypoint", "draw", scene.to_str().unwrap(), "-o", "x.svg"];
            match super::matches(&words.map(OsString::from)) {
                Err(Refusal::File(failure)) => failure.to_string(),
                other => panic!("{other:?}"),
            }
        };
        assert!(told("stile = \"grid\"").contains("a.toml, line 2: there is no key 'stile'; did you mean style?"));
        assert!(told("\nmargin = -1").contains("a.toml, line 3: margin = -1: must be from 0"));
        assert!(told("tone = \"dark\"").contains("line 2: tone = dark: must be one of portrait, lightness"));
        assert!(told("[set]\npich = 1").contains("line 3: 'pich' is not a parameter of hedcut"));
        assert!(told("[mask]\nhair = \"no.png\"").contains("line 3: "));
        assert!(told("style = \"gird\"").contains("line 2: there is no style 'gird'"));
        assert!(told("pitch = [1]").contains("line 2: pitch is one value"));
        assert!(told("size_gamma = 1").contains("put it under [set]"));
    }
}
