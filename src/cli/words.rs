//! Numbers with their nouns, words of switches, names of files.

use std::path::Path;

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

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_stands_alone() {
        assert_eq!([counted(0, "dot"), counted(1, "dot"), counted(2, "dot")], ["0 dots", "1 dot", "2 dots"]);
        assert_eq!([counted(1, "touch"), counted(3, "touch")], ["1 touch", "3 touches"]);
    }
}
