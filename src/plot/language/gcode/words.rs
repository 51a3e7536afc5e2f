//! The words of a line of G-code.

/// True if a line is a controller's named command, such as `SET_SERVO`, which is not made of words.
pub(crate) fn is_named(code: &str) -> bool {
    code.len() > 2 && code.bytes().take(2).all(|byte| byte.is_ascii_alphabetic())
}

/// Letters with their numbers, separated by spaces or not, without comments; a letter without a number is left out. A named command
/// has none.
pub(crate) fn words(line: &str) -> Vec<(char, f64)> {
    let code = line.split(['(', ';', '%']).next().unwrap_or("").trim().to_ascii_uppercase();
    if is_named(&code) {
        return Vec::new();
    }
    let word = |(i, letter): (usize, char)| {
        let rest = code[i + 1..].trim_start();
        let end = rest.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c))).unwrap_or(rest.len());
        Some((letter, rest[..end].parse().ok()?))
    };
    code.char_indices().filter(|(_, c)| c.is_ascii_alphabetic()).filter_map(word).collect()
}

/// The number after a letter.
pub(crate) fn word(line: &str, letter: char) -> Option<f64> {
    words(line).into_iter().find(|word| word.0 == letter).map(|word| word.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_with_and_without_spaces() {
        let expected = [('G', 1.0), ('X', -0.5), ('F', 300.0)];
        assert_eq!(words("G1 X-.5 F300 (down Z9)"), expected);
        assert_eq!(words("g1x-.5f300;Z9"), expected);
        assert_eq!((word("M3 S700", 'S'), word("M3 S700", 'Z')), (Some(700.0), None));
        assert_eq!(words("SET_SERVO SERVO=pen ANGLE=20"), []);
        assert_eq!(words(""), []);
    }
}
