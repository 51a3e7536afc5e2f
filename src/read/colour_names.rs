//! Replaces CSS colour words that usvg does not know.

use std::borrow::Cow;

/// A colour name of CSS Color 4, and a keyword that is case-insensitive in CSS; each with its replacement.
const WORDS: [(&str, &str); 2] = [("rebeccapurple", "#663399"), ("currentcolor", "currentColor")];
/// Attributes whose value is a colour.
const PROPERTIES: [&str; 6] = ["fill", "stroke", "color", "stop-color", "flood-color", "lighting-color"];

/// The text with these words replaced where they are values: after the colon of a declaration, as the value of an attribute or
/// entity, or as the fallback after a reference.
pub(super) fn with_known_colours(text: &str) -> Cow<'_, str> {
    let mut out = String::new();
    let mut at = 0;
    for (start, word, known) in found(text) {
        let end = start + word.len();
        let goes_on = text[end..].starts_with(|c: char| c.is_alphanumeric() || c == '-' || c == '_');
        if goes_on || !is_value(text[..start].trim_end()) {
            continue;
        }
        out.push_str(&text[at..start]);
        out.push_str(known);
        at = end;
    }
    if at == 0 { Cow::Borrowed(text) } else { Cow::Owned(out + &text[at..]) }
}

/// The positions of the words, case-insensitive, with each word and its replacement.
fn found(text: &str) -> impl Iterator<Item = (usize, &'static str, &'static str)> + '_ {
    let bytes = text.as_bytes();
    let at = move |start: usize| {
        let is_there =
            |word: &str| bytes.get(start..start + word.len()).is_some_and(|part| part.eq_ignore_ascii_case(word.as_bytes()));
        WORDS.iter().find(|(word, known)| is_there(word) && !bytes[start..].starts_with(known.as_bytes()))
    };
    let first = bytes.iter().enumerate().filter(|(_, byte)| matches!(byte, b'r' | b'R' | b'c' | b'C'));
    first.filter_map(move |(start, _)| at(start).map(|(word, known)| (start, *word, *known)))
}

fn is_value(before: &str) -> bool {
    match before.chars().next_back() {
        Some(':' | ')') => true,
        Some('"' | '\'') => {
            let before = before[..before.len() - 1].trim_end();
            let Some(name) = before.strip_suffix('=') else { return !before.ends_with('>') };
            PROPERTIES
                .iter()
                .any(|property| name.trim_end().strip_suffix(property).is_some_and(|rest| rest.ends_with(char::is_whitespace)))
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_replaced_where_they_are_values() {
        for (given, known) in [
            ("<path fill='RebeccaPurple'/>", "<path fill='#663399'/>"),
            ("<path stroke = \"currentcolor\"/>", "<path stroke = \"currentColor\"/>"),
            ("<g style='stroke: rebeccapurple; fill:currentcolor'/>", "<g style='stroke: #663399; fill:currentColor'/>"),
            ("<style>.a{fill:rebeccapurple}</style>", "<style>.a{fill:#663399}</style>"),
            ("<!ENTITY c 'rebeccapurple'>", "<!ENTITY c '#663399'>"),
            ("<path fill='url(#a) rebeccapurple'/>", "<path fill='url(#a) #663399'/>"),
        ] {
            assert_eq!(with_known_colours(given), known);
        }
        for kept in [
            "<g id='rebeccapurple' class='currentcolor' label='rebeccapurple'/>",
            "<path fill='rebeccapurplish' stroke='currentColor'/>",
            "<style>.rebeccapurple{}</style><text>rebeccapurple</text>",
            "\u{e4}\u{20ac}C",
        ] {
            assert!(matches!(with_known_colours(kept), Cow::Borrowed(_)), "{kept}");
        }
    }
}
