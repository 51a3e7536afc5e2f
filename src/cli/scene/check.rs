//! Whether a scene would be taken, before its files are read.

use super::document::{self, Entry, PHOTOGRAPH, Role, draw_command};

/// What messages call the scene; its reader knows its name.
const NAME: &str = "scene";

/// Why a scene's text would be refused: keys that `draw` does not know, values that it does not take.
pub(in crate::cli) fn check(text: &str) -> Result<(), String> {
    let document = document::read(NAME, text, Role::Scene).map_err(|failure| without_name(&failure.to_string()))?;
    for entry in document.entries.iter().filter(|entry| entry.option != PHOTOGRAPH) {
        check_value(entry)?;
    }
    Ok(())
}

/// One option alone, so that another that it needs is not missed.
fn check_value(entry: &Entry) -> Result<(), String> {
    use clap::error::ErrorKind::{InvalidValue, NoEquals, TooManyValues, UnknownArgument, ValueValidation, WrongNumberOfValues};
    let words = ["draw", "photograph", "--output=drawing.svg"].map(str::to_owned).into_iter().chain([entry.word()]);
    let Err(error) = draw_command().try_get_matches_from(words) else { return Ok(()) };
    if ![InvalidValue, NoEquals, TooManyValues, UnknownArgument, ValueValidation, WrongNumberOfValues].contains(&error.kind()) {
        return Ok(());
    }
    let said = error.to_string();
    let reason = said.lines().next().unwrap_or_default().trim_start_matches("error: ");
    Err(format!("{}: {reason}", without_name(&entry.place)))
}

fn without_name(message: &str) -> String {
    message.replace(&format!("{NAME}, "), "")
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn wrong_keys_and_values_are_told_with_their_line() {
        assert_eq!(check("photograph = 'a.jpg'\nstyle = 'grid'\nsize = '30x40mm'\n[set]\npitch = 0.5\n"), Ok(()));
        let wrong = check("photograph = 'a.jpg'\nstile = 3\n").unwrap_err();
        assert!(wrong.starts_with("line 2: ") && wrong.contains("style"), "{wrong}");
        let wrong = check("size = '30by40'\n").unwrap_err();
        assert!(wrong.starts_with("line 1: ") && wrong.contains("30by40"), "{wrong}");
        assert!(check("photograph = \n").is_err());
        // What needs another option is the drawing's business.
        assert_eq!(check("max-time = '2h'\n"), Ok(()));
    }
}
