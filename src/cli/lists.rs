//! `drypoint styles` and `drypoint profiles`.

use super::arguments::{ListOptions, ProfilesOptions};
use super::failure::Failure;
use super::roles::roles_of;
use super::{output, pen_file};
use crate::plot::{Profile, built_in, built_in_names};
use crate::style::{STYLES, Style, find};
use serde_json::{Value, json};
use std::fmt::Write;

pub(super) fn styles(options: &ListOptions) -> Result<(), Failure> {
    let Some(name) = &options.name else {
        if options.json {
            let list: Vec<Value> = STYLES
                .iter()
                .map(|s| json!({ "name": s.name(), "summary": s.card().summary, "source": s.card().source, "masks": masks_json(*s) }))
                .collect();
            return output::print_json(&json!({ "styles": list }));
        }
        let lines: String =
            STYLES.iter().fold(String::new(), |text, s| text + &format!("{:10} {}\n", s.name(), s.card().summary));
        return output::to_stdout(lines.as_bytes());
    };
    let known: Vec<&str> = STYLES.iter().map(|s| s.name()).collect();
    let style =
        find(name).ok_or_else(|| Failure::Usage(format!("there is no style '{name}'; there are {}", known.join(", "))))?;
    if options.json { output::print_json(&style_json(style)) } else { output::to_stdout(style_text(style).as_bytes()) }
}

fn style_text(style: &dyn Style) -> String {
    let mut text = format!("{}: {}\n{}\n", style.name(), style.card().summary, style.card().source);
    text += "\nmasks (--mask ROLE=FILE)\n";
    for (name, role) in roles_of(style) {
        let _ = writeln!(text, "    {name}: {}", role.meaning());
    }
    if style.card().uses_depth {
        text += "    and a depth map, white near (--depth FILE)\n";
    }
    for p in style.parameters() {
        let source = if p.source.is_empty() { String::new() } else { format!(" [{}]", p.source) };
        let needs = if p.needs.is_empty() { String::new() } else { format!("    takes effect with {}\n", p.needs_text()) };
        let _ = write!(
            text,
            "\n{} ({}; default {})\n    {}{source}\n{needs}",
            p.name,
            p.kind.range_text(),
            p.kind.default_text(),
            p.meaning
        );
    }
    text
}

fn style_json(style: &dyn Style) -> Value {
    let parameters: Vec<Value> = style
        .parameters()
        .iter()
        .map(|p| json!({ "name": p.name, "range": p.kind.range_text(), "default": p.kind.default_text(), "meaning": p.meaning, "source": p.source, "needs": p.needs_text() }))
        .collect();
    json!({
        "name": style.name(),
        "summary": style.card().summary,
        "source": style.card().source,
        "masks": masks_json(style),
        "depth": style.card().uses_depth,
        "parameters": parameters,
    })
}

fn masks_json(style: &dyn Style) -> Value {
    roles_of(style).map(|(name, role)| json!({ "role": name, "meaning": role.meaning() })).collect()
}

pub(super) fn profiles(options: &ProfilesOptions) -> Result<(), Failure> {
    if options.pens_example {
        return output::to_stdout(pen_file::EXAMPLE.as_bytes());
    }
    let options = &options.list;
    if let Some(name) = &options.name {
        let text = built_in(name)?;
        if options.json {
            return output::print_json(&json!({ "name": name, "toml": text }));
        }
        return output::to_stdout(text.as_bytes());
    }
    let all: Vec<Profile> =
        built_in_names().into_iter().map(|name| Profile::parse(name, built_in(name)?)).collect::<Result<_, _>>()?;
    if options.json {
        let list: Vec<Value> =
            all.iter().map(|p| json!({ "name": p.name, "description": p.description, "pens": p.pens.count })).collect();
        return output::print_json(&json!({ "profiles": list }));
    }
    let lines: String = all.iter().fold(String::new(), |text, p| text + &format!("{:14} {}\n", p.name, p.description));
    output::to_stdout(lines.as_bytes())
}
