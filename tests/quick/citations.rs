//! Comments and parameters cite only sections, figures and equations that exist in the cited works.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// A work's contents: its numbered sections (including chapters), the last figure of each chapter (chapter 0 is the whole work),
/// the last equation, and its appendices.
struct Work {
    author: &'static str,
    sections: &'static [&'static str],
    figures: &'static [(u32, u32)],
    equations: &'static [(u32, u32)],
    appendices: &'static str,
}

const WORKS: &[Work] = &[
    Work {
        author: "Bruehl",
        sections: &[
            "0.1.1", "1", "1.1", "1.2", "1.3", "1.4", "1.4.1", "1.4.2", "1.4.3", "2", "2.1", "2.1.1", "2.2", "3", "3.1", "3.1.1",
            "3.1.2", "3.2", "3.3", "3.3.1", "3.3.2", "3.4", "4", "4.1", "4.2", "4.2.1", "4.2.2", "4.3", "4.3.1", "4.3.2", "4.4",
            "4.5",
        ],
        figures: &[(1, 19), (2, 8), (3, 12), (4, 16)],
        equations: &[],
        appendices: "ABC",
    },
    Work {
        author: "Galarza",
        sections: &[
            "1", "1.1", "1.2", "2", "2.1", "2.1.1", "2.1.2", "2.2", "2.2.1", "2.2.2", "2.3", "3", "3.1", "3.2", "3.3", "3.3.1",
            "3.4", "3.5", "3.5.1", "3.6", "3.7", "4", "4.1", "4.2", "4.2.1", "4.2.2", "4.2.3", "4.2.4", "4.3", "4.3.1", "4.3.2",
            "4.3.3", "4.4", "5", "5.1", "5.2",
        ],
        figures: &[(2, 9), (4, 14), (5, 2)],
        equations: &[(3, 12)],
        appendices: "",
    },
    Work {
        author: "Papari",
        sections: &["7", "7.1", "7.2", "7.2.1", "7.2.2", "7.3", "7.3.1", "7.3.2", "7.4", "7.5", "7.6"],
        figures: &[(7, 19)],
        equations: &[(7, 22)],
        appendices: "AB",
    },
    Work {
        author: "Son",
        sections: &[
            "1", "2", "2.1", "2.2", "2.3", "3", "4", "4.1", "4.2", "5", "5.1", "5.2", "6", "6.1", "6.2", "6.3", "6.4", "7",
            "7.1", "7.2", "7.3", "8",
        ],
        figures: &[(0, 15)],
        equations: &[],
        appendices: "AB",
    },
    Work {
        author: "Wong",
        sections: &[
            "1", "1.1", "1.2", "2", "2.1", "2.1.1", "2.1.2", "2.1.3", "2.2", "2.2.1", "2.2.2", "2.2.3", "3", "3.1", "3.1.1",
            "3.1.2", "3.1.3", "3.1.4", "3.1.5", "3.2", "4", "4.1", "4.2", "4.3", "4.4", "4.5", "5", "5.1", "5.2", "6", "6.1",
            "6.1.1", "6.2", "6.3", "6.3.1", "6.3.2", "6.3.3", "6.3.4", "6.3.5", "7", "8",
        ],
        figures: &[(2, 14), (3, 15), (4, 10), (5, 4), (6, 15), (7, 10)],
        equations: &[],
        appendices: "",
    },
];

/// The work that a style's files follow if they name none.
const STYLES: &[(&str, &str)] =
    &[("hedcut", "Bruehl"), ("grid", "Son"), ("engrave", "Galarza"), ("charcoal", "Wong"), ("glass", "Papari")];

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// The prose of a file: its comments with line ends removed.
fn prose(text: &str) -> String {
    let comments =
        text.lines().filter_map(|line| line.trim_start().strip_prefix("//")).map(|line| line.trim_start_matches(['/', '!']));
    comments.map(str::trim).collect::<Vec<_>>().join(" ")
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    Section,
    Figure,
    Equation,
}

/// The citations in a text: author, kind and number.
fn citations(text: &str, usual: Option<&'static str>) -> Vec<(&'static str, Of, String)> {
    let mut found = Vec::new();
    let (mut author, mut of) = (usual, None);
    let words: Vec<&str> = text.split_whitespace().collect();
    for (i, raw) in words.iter().enumerate() {
        let word = raw.trim_matches(|c: char| !c.is_alphanumeric());
        let named = WORKS.iter().map(|work| work.author).find(|author| *author == word);
        if let Some(named) = named {
            (author, of) = (Some(named), Some(Of::Section));
            continue;
        }
        of = match word.to_lowercase().as_str() {
            "section" | "sections" | "chapter" => Some(Of::Section),
            "figure" | "figures" | "fig" => Some(Of::Figure),
            "equation" | "equations" => Some(Of::Equation),
            "and" | "to" | "et" | "al" => of,
            number if is_number(number) => {
                if let (Some(author), Some(of)) = (author, of) {
                    // Not a year, length or percentage, which would be followed by a unit.
                    let is_quantity =
                        words.get(i + 1).is_some_and(|next| ["px", "mm", "%", "degrees", "iterations"].contains(next));
                    // "Son 4.1, 0 to 4 levels": after a comma only a number with a point is certainly another section.
                    let is_beside = i > 0 && words[i - 1].ends_with(',') && !number.contains('.');
                    if number.len() < 7 && !is_beside && !is_quantity && number.parse::<u32>().ok().is_none_or(|n| n < 100) {
                        found.push((author, of, number.to_owned()));
                    }
                }
                // "Wong 6.3.1, n" and "sections 3.1 and 4": a list continues after commas.
                if raw.ends_with([',', ';', ')', '.', ':']) && !raw.ends_with(',') { None } else { of }
            }
            _ => None,
        };
        // A new clause is about something else.
        if raw.ends_with(['.', ':']) && !is_number(word) && word != "al" {
            author = usual;
        }
    }
    found
}

fn is_number(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit()) && word.chars().all(|c| c.is_ascii_digit() || c == '.')
}

fn exists(work: &Work, of: Of, number: &str) -> bool {
    let in_table = |table: &[(u32, u32)]| {
        let (chapter, last) = number.split_once('.').unwrap_or(("0", number));
        let (chapter, last): (u32, u32) = (chapter.parse().unwrap_or(u32::MAX), last.parse().unwrap_or(u32::MAX));
        table.iter().any(|(known, most)| *known == chapter && last <= *most)
    };
    match of {
        // Papari's parameters cite equations by number alone.
        Of::Section => work.sections.contains(&number) || (work.author == "Papari" && in_table(work.equations)),
        Of::Figure => in_table(work.figures),
        Of::Equation => in_table(work.equations),
    }
}

#[test]
fn what_is_cited_exists() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut wrong, mut seen) = (Vec::new(), BTreeSet::new());
    for file in ["style", "field", "geometry"].iter().flat_map(|room| rust_files(&source.join(room))) {
        let text = fs::read_to_string(&file).unwrap();
        let style =
            STYLES.iter().find(|(style, _)| file.components().any(|part| part.as_os_str() == *style)).map(|(_, author)| *author);
        let own = WORKS
            .iter()
            .map(|work| work.author)
            .find(|author| text.lines().take_while(|l| l.starts_with("//!")).any(|l| l.contains(author)));
        for (author, of, number) in citations(&prose(&text), style.or(own)) {
            let work = WORKS.iter().find(|work| work.author == author).unwrap();
            seen.insert((author, number.clone()));
            if !exists(work, of, &number) {
                wrong.push(format!("{}: {author} has no {of:?} {number}", file.display()));
            }
        }
    }
    let mut of_parameters = 0;
    for style in drypoint::style::STYLES {
        let usual = STYLES.iter().find(|(name, _)| *name == style.name()).map(|(_, author)| *author);
        for parameter in style.parameters() {
            for (author, of, number) in citations(parameter.source, usual) {
                let work = WORKS.iter().find(|work| work.author == author).unwrap();
                of_parameters += 1;
                seen.insert((author, number.clone()));
                if !exists(work, of, &number) {
                    wrong.push(format!("{} {}: {author} has no {of:?} {number}", style.name(), parameter.name));
                }
            }
        }
    }
    assert!(of_parameters > 50, "only {of_parameters} citations of parameters were read");
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(seen.len() > 60, "only {} citations were read", seen.len());
}

#[test]
fn the_check_can_fail() {
    let cited =
        citations("told apart by scale-space filtering (Wong 1999, section 5.3), and drawn (sections 6.2 and 6.3.4)", None);
    let numbers: Vec<&str> = cited.iter().map(|(_, _, number)| number.as_str()).collect();
    assert_eq!(numbers, ["5.3", "6.2", "6.3.4"]);
    assert!(!exists(&WORKS[4], Of::Section, "5.3") && exists(&WORKS[4], Of::Section, "6.3.4"));
    assert!(exists(&WORKS[2], Of::Figure, "7.14") && !exists(&WORKS[2], Of::Figure, "7.20"));
    assert!(WORKS.iter().any(|work| work.appendices.contains('B')));
}
