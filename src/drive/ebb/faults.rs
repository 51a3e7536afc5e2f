//! The board's errors in words, with what to do (command reference, "Returned Errors").

/// Meaning of `!N`.
pub(super) fn error(code: u32) -> &'static str {
    match code {
        0 | 1 => "a move is too fast or too slow for it; check the speeds of the profile",
        2 => "its answers piled up; close other programs that use the port",
        3 => "a command is longer than it can hold; close other programs that use the port",
        4 => "a command lacks a number: it was garbled on its way; check the cable, and use no hub",
        5 => "a command lacks a comma: it was garbled on its way; check the cable, and use no hub",
        6 => "a number is out of range; the firmware may be older than 2.8, update it with the maker's program",
        7 => "a command has too many numbers; the firmware may be older than 2.8, update it with the maker's program",
        8 => "it does not know a command; the firmware may be older than 2.8, update it with the maker's program",
        9 | 10 => "it wants checksums, as another program has set it; switch it off and on",
        _ => "which its manual explains",
    }
}

/// A line such as `!8 Err: Unknown command`, with its meaning.
pub(super) fn told(line: &str) -> String {
    let number: String = line.chars().skip(1).take_while(char::is_ascii_digit).collect();
    format!("{} ({})", line.trim_start_matches('!').trim(), error(number.parse().unwrap_or(0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_of_the_board_has_words_that_help() {
        assert!((0..=10).all(|code| error(code) != error(99) && error(code).len() > 20));
        assert!(told("!8 Err: Unknown command 'XX:5858'").starts_with("8 Err: Unknown command 'XX:5858' (it does not know"));
    }
}
