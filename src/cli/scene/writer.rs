//! `drypoint scene` and `--save-scene`: a command line as a scene.

use super::document::{MASK, PHOTOGRAPH, REGION, SET, draw_command, is_list, is_switch, long, names_file};
use super::spelled::is_drawn;
use crate::cli::arguments::{DrawOptions, Spelled};
use crate::cli::failure::Failure;
use crate::cli::messages::say;
use crate::cli::output;
use crate::cli::words::inline_table;
use crate::style::{self, DefaultLength, Kind, Parameter};
use clap::Arg;
use std::fmt::Write;
use std::path::Path;

/// The parameter that is an option too.
const PITCH: &str = "pitch";
/// Width of the comments.
const COLUMNS: usize = 100;

/// Writes the scene of a command line with every default spelled out.
pub(in crate::cli) fn run(options: &DrawOptions) -> Result<(), Failure> {
    let photo = &options.picture.photo;
    if photo == "-" {
        return Err(Failure::Usage("a scene names its photograph; give it as a file, not as -".to_owned()));
    }
    super::super::masks::photograph(photo)?;
    let scene = Scene { options, folder: folder_of(&options.output) };
    output::write(&options.output, |out| out.write_all(scene.full().as_bytes()))?;
    if !options.reporting.quiet && options.output != "-" {
        say!("{}: `drypoint draw {} -o OUT` draws it", options.output, options.output);
    }
    Ok(())
}

/// Writes what a command line amounts to.
pub(in crate::cli) fn save(options: &DrawOptions, file: &str) -> Result<(), Failure> {
    let scene = Scene { options, folder: folder_of(file) };
    output::write(file, |out| out.write_all(scene.short().as_bytes()))
}

fn folder_of(file: &str) -> &Path {
    if file == "-" { Path::new("") } else { Path::new(file).parent().unwrap_or(Path::new("")) }
}

/// Appends the lines of `[set]` for the parameters given.
type WriteSet<'a> = dyn Fn(&mut String, &[(&str, &str)]) + 'a;

struct Scene<'a> {
    options: &'a DrawOptions,
    /// The scene's own folder, to which its paths are relative.
    folder: &'a Path,
}

impl Scene<'_> {
    fn spelled(&self) -> &Spelled {
        &self.options.spelled
    }

    fn short(&self) -> String {
        let mut text = self.head();
        for (option, values) in &self.spelled().0 {
            if ![SET, MASK, REGION].contains(&option.as_str()) {
                text += &self.line(option, values);
            }
        }
        text += &self.tables(&|text, pairs| {
            for (key, value) in pairs {
                let _ = writeln!(text, "{key} = {}", bare(value));
            }
        });
        text
    }

    fn full(&self) -> String {
        let mut text = self.head();
        let command = draw_command();
        for arg in command.get_arguments().filter(|arg| is_drawn(arg) && ![SET, MASK, REGION].contains(&long(arg))) {
            text.push('\n');
            text += &comment(&arg.get_help().map(ToString::to_string).unwrap_or_default());
            text += &self.option(arg);
        }
        text += &self.tables(&|text, pairs| self.parameters(text, pairs));
        text
    }

    fn head(&self) -> String {
        format!(
            "# A scene of drypoint {}. Its keys are the long options of `drypoint draw`; paths are relative to this file.\n\n{PHOTOGRAPH} = {}\n",
            env!("CARGO_PKG_VERSION"),
            quoted(&self.relative(&self.options.picture.photo))
        )
    }

    /// One option: as given, else its default, else a comment.
    fn option(&self, arg: &Arg) -> String {
        let option = long(arg);
        if let Some(values) = self.spelled().get(option) {
            return self.line(option, values);
        }
        let default: Vec<String> = arg.get_default_values().iter().map(|value| value.to_string_lossy().into_owned()).collect();
        match default.first() {
            _ if is_switch(arg) => format!("{option} = false\n"),
            Some(value) => format!("{option} = {}\n", bare(value)),
            None if option == PITCH => self.pitch(),
            None => {
                let form = arg.get_value_names().and_then(|names| names.first()).map_or("", |name| name.as_str());
                format!("# {option} = \"{form}\"\n")
            }
        }
    }

    /// The pitch, as given or the style's own.
    fn pitch(&self) -> String {
        let given = self.spelled().get(SET).unwrap_or_default().iter().rev();
        let given =
            given.filter_map(|pair| pair.split_once('=')).find(|(key, _)| key.trim() == PITCH).map(|(_, value)| value.trim());
        let parameters = style::find(&self.options.picture.style).map(style::Style::parameters).unwrap_or_default();
        let own = parameters.iter().find(|parameter| parameter.name == PITCH).and_then(fixed_default);
        given.map(str::to_owned).or(own).map_or_else(String::new, |pitch| format!("{PITCH} = {}\n", bare(&pitch)))
    }

    fn line(&self, option: &str, values: &[String]) -> String {
        let command = draw_command();
        let arg = command.get_arguments().find(|arg| long(arg) == option);
        if values.is_empty() {
            return format!("{option} = true\n");
        }
        if arg.is_some_and(is_list) {
            let list: Vec<String> = values.iter().map(|value| quoted(value)).collect();
            return format!("{option} = [{}]\n", list.join(", "));
        }
        format!(
            "{option} = {}\n",
            if names_file(option, &values[0]) { quoted(&self.relative(&values[0])) } else { bare(&values[0]) }
        )
    }

    /// The tables `[set]`, `[mask]` and `[[region]]`.
    fn tables(&self, write_set: &WriteSet<'_>) -> String {
        let pairs = |option: &str| -> Vec<(&str, &str)> {
            let values = self.spelled().get(option).unwrap_or_default();
            let mut pairs: Vec<(&str, &str)> = Vec::new();
            for (key, value) in values.iter().filter_map(|value| value.split_once('=')) {
                let (key, value) = (key.trim(), value.trim());
                pairs.retain(|(known, _)| *known != key);
                pairs.push((key, value));
            }
            pairs
        };
        let mut set = String::new();
        write_set(&mut set, &pairs(SET));
        let mut text = if set.is_empty() { String::new() } else { format!("\n[{SET}]\n{set}") };
        let masks = pairs(MASK);
        if !masks.is_empty() {
            let _ = writeln!(text, "\n[{MASK}]");
            masks.iter().for_each(|(role, file)| {
                let _ = writeln!(text, "{role} = {}", quoted(&self.relative(file)));
            });
        }
        for region in self.spelled().get(REGION).unwrap_or_default() {
            let _ = writeln!(text, "\n[[{REGION}]]\n{}", self.region(region));
        }
        text
    }

    /// A `--region` as the lines of its table.
    fn region(&self, text: &str) -> String {
        let table = inline_table(text).unwrap_or_default();
        let lines = table.iter().map(|(key, value)| match value {
            toml::Value::String(file) if key == MASK && crate::source::MaskRole::named(file).is_none() => {
                format!("{key} = {}", quoted(&self.relative(file)))
            }
            toml::Value::Table(inner) => format!("{key} = {{ {} }}", super::document::inline(inner)),
            other => format!("{key} = {other}"),
        });
        lines.collect::<Vec<_>>().join("\n")
    }

    /// All parameters of the style with their meaning.
    fn parameters(&self, text: &mut String, given: &[(&str, &str)]) {
        let Some(style) = style::find(&self.options.picture.style) else { return };
        for parameter in style.parameters().iter().filter(|parameter| parameter.name != PITCH) {
            let needs = parameter.needs_text();
            let needs = if needs.is_empty() { String::new() } else { format!("; needs {needs}") };
            *text += &comment(&format!("{}; {}{needs}", parameter.meaning, parameter.kind.range_text()));
            let value = given.iter().find(|(key, _)| *key == parameter.name).map(|(_, value)| *value);
            let _ = match (value, fixed_default(parameter)) {
                (Some(value), _) => writeln!(text, "{} = {}", parameter.name, bare(value)),
                (None, Some(default)) => writeln!(text, "{} = {}", parameter.name, bare(&default)),
                (None, None) => writeln!(text, "# {} =   # {}", parameter.name, parameter.kind.default_text()),
            };
        }
    }

    /// A path as seen from the scene's folder.
    fn relative(&self, path: &str) -> String {
        if self.folder.as_os_str().is_empty() || Path::new(path).is_absolute() {
            return path.to_owned();
        }
        let absolute = |path: &Path| std::fs::canonicalize(path).ok();
        let (from, to) = (absolute(self.folder), absolute(Path::new(path)));
        let relative = from.zip(to).and_then(|(from, to)| pathdiff::diff_paths(to, from));
        relative.map_or_else(|| path.to_owned(), |relative| relative.to_string_lossy().into_owned())
    }
}

/// The default in the form that `--set` accepts; none if it follows another parameter or there is nothing to write.
fn fixed_default(parameter: &Parameter) -> Option<String> {
    match parameter.kind {
        Kind::Length { default: DefaultLength::Millimetres(mm), .. } => Some(mm.to_string()),
        Kind::Length { .. } | Kind::Places { .. } => None,
        kind => Some(kind.default_text()),
    }
}

/// A value of TOML: a number where the text is one, else a string.
fn bare(text: &str) -> String {
    let is_number = text.parse::<i64>().is_ok_and(|n| n.to_string() == text)
        || text.parse::<f64>().is_ok_and(|n| n.is_finite() && n.to_string() == text);
    if is_number { text.to_owned() } else { quoted(text) }
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// Lines of a comment.
fn comment(text: &str) -> String {
    let mut lines = vec![String::from("#")];
    for word in text.split_whitespace() {
        let line = lines.last_mut().filter(|line| line.len() + word.len() < COLUMNS);
        match line {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(format!("# {word}")),
        }
    }
    lines.join("\n") + "\n"
}
