//! `drypoint see`: finds faces, people and their parts in a photograph.

use super::arguments::SeeOptions;
use super::failure::Failure;
use super::interruption::interrupt;
use super::masks::photograph;
use super::messages::{say, warning};
use super::progress::Watcher;
use super::threads::limit_threads;
use super::words::counted;
use super::{looking, output, proof, sight_folder};
use crate::see::{Sight, look};
use crate::style::Observer as _;

pub(super) fn run(options: &SeeOptions) -> Result<(), Failure> {
    limit_threads(options.threads)?;
    if options.output.as_ref().is_some_and(|folder| folder.as_os_str() == "-") {
        return Err(Failure::Usage("a sight is several files; give a folder with -o, or use --json".to_owned()));
    }
    let photograph = photograph(&options.photo)?;
    for warning in &photograph.info.warnings {
        warning!("{}: {warning}", options.photo);
    }
    let sight = look(&photograph, interrupt()).map_err(|error| looking::failure(&options.photo, error))?;
    if let Some(proofs) = proof::folder() {
        proof::keep(&options.photo, &photograph);
        sight_folder::write_small(&proof::sight(&proofs), &sight, &photograph)?;
        Watcher::new(true).begin("proof");
    }
    if let Some(folder) = &options.output {
        sight_folder::write(folder, &sight, &photograph)?;
    }
    if options.reporting.json {
        return output::print_json(&sight_folder::as_json(&sight, &photograph));
    }
    if let Some(folder) = options.output.as_ref().filter(|_| !options.reporting.quiet) {
        say!("{}: {}", folder.to_string_lossy(), summary(&sight));
    }
    Ok(())
}

/// One line of summary for the user.
fn summary(sight: &Sight) -> String {
    if sight.faces.is_empty() {
        return "no face found, so no subject; sight.json has an empty list".to_owned();
    }
    let scores: Vec<String> = sight.faces.iter().map(|face| format!("{:.2}", face.score)).collect();
    format!("{} found (score {}), and the subject; check overlay.png", counted(sight.faces.len(), "face"), scores.join(", "))
}
