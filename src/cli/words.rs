//! Words: numbers with their nouns, switches, names of files, texts of TOML.

use std::path::Path;

/// Likeness from which an unknown word is taken for a slip of a known one.
const LIKENESS: f64 = 0.7;

/// A count with its noun, such as `1 path`, `2 paths`, `0 touches`.
pub(super) fn counted(count: usize, noun: &str) -> String {
    let ending = match noun {
        _ if count == 1 => "",
        _ if noun.ends_with("ch") || noun.ends_with('s') => "es",
        _ => "s",
    };
    format!("{count} {noun}{ending}")
}

/// The word of a style's switch.
pub(super) const fn switch_word(is_on: bool) -> &'static str {
    if is_on { "on" } else { "off" }
}

/// The last component of a path: recipes must not reveal folders of this machine.
pub(super) fn file_name(name: &str) -> &str {
    Path::new(name).file_name().and_then(|n| n.to_str()).unwrap_or(name)
}

/// The known word that a wrong one is most like, if it is like any.
pub(super) fn nearest<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = |name: &str| strsim::jaro_winkler(word, name);
    known.filter(|name| likeness(name) >= LIKENESS).max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
}

/// The line of a text on which a byte stands, from 1.
pub(super) fn line_of(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|b| *b == b'\n').count()
}

/// The keys in the inside of an inline table of TOML; none if it is not one.
pub(super) fn inline_table(text: &str) -> Option<toml::Table> {
    let mut table: toml::Table = format!("r = {{ {text} }}").parse().ok()?;
    match table.remove("r") {
        Some(toml::Value::Table(keys)) if table.is_empty() => Some(keys),
        _ => None,
    }
}

/// True for the name of a TOML file: a scene or a preset.
pub(super) fn is_toml(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_stands_alone() {
        assert_eq!([counted(0, "dot"), counted(1, "dot"), counted(2, "dot")], ["0 dots", "1 dot", "2 dots"]);
        assert_eq!([counted(1, "touch"), counted(3, "touch")], ["1 touch", "3 touches"]);
    }
}
