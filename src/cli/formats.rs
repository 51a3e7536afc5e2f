//! Formats of files: their endings, and whether a machine reads them or a printer.

use super::arguments::Format;
use super::failure::Failure;
use super::output;
use crate::plot::{Language, Profile};
use crate::press::PrintFormat;
use clap::ValueEnum;
use std::path::Path;

impl Format {
    /// The machines' language that it is, if it is one.
    pub(super) const fn language(self) -> Option<Language> {
        match self {
            Self::Svg => Some(Language::Svg),
            Self::Hpgl => Some(Language::Hpgl),
            Self::Gcode => Some(Language::Gcode),
            Self::Pdf | Self::Inkml | Self::Json => None,
        }
    }

    /// Whether it holds tool paths.
    pub(super) const fn holds_toolpaths(self) -> bool {
        match self {
            Self::Svg | Self::Hpgl | Self::Gcode | Self::Json => true,
            Self::Pdf | Self::Inkml => false,
        }
    }

    /// The format of a drawing that is no machine's.
    pub(super) fn of_print(self) -> Result<PrintFormat, Failure> {
        match self {
            Self::Svg => Ok(PrintFormat::Svg),
            Self::Pdf => Ok(PrintFormat::Pdf { seconds: output::source_date()? }),
            Self::Inkml => Ok(PrintFormat::Inkml),
            Self::Json => Ok(PrintFormat::Json),
            Self::Hpgl | Self::Gcode => Err(needs_profile()),
        }
    }

    /// Endings of its files' names, the usual one first.
    const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Pdf => &["pdf"],
            Self::Inkml => &["inkml"],
            Self::Json => &["json"],
            Self::Svg => Language::Svg.extensions(),
            Self::Hpgl => Language::Hpgl.extensions(),
            Self::Gcode => Language::Gcode.extensions(),
        }
    }

    /// Its word after `--format`.
    fn word(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

/// The format of an output file.
pub(super) fn format_of(name: &str, format: Option<Format>) -> Result<Format, Failure> {
    if let Some(format) = format {
        return Ok(format);
    }
    let extension = Path::new(name).extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    let all = Format::value_variants();
    if let Some(format) = all.iter().find(|format| format.extensions().contains(&extension.as_str())) {
        return Ok(*format);
    }
    Err(Failure::Usage(if name == "-" {
        format!("with -o - give the format: --format {}", listed(all.iter().map(|format| format.word())))
    } else {
        let endings = all.iter().flat_map(|format| format.extensions()).map(|extension| format!(".{extension}"));
        format!("the format of {name} is not known from its extension; use {}, or --format", listed(endings))
    }))
}

/// Such as `a, b or c`.
fn listed(words: impl Iterator<Item = String>) -> String {
    let words: Vec<String> = words.collect();
    match &words[..] {
        [all @ .., last] if !all.is_empty() => format!("{} or {last}", all.join(", ")),
        _ => words.concat(),
    }
}

fn needs_profile() -> Failure {
    Failure::Usage("HP-GL and G-code need --profile; `drypoint profiles` lists the plotters".to_owned())
}

/// Refuses a format that the profile's machine does not read.
pub(super) fn check_language(format: Format, profile: Option<&Profile>) -> Result<(), Failure> {
    let unfit = |why: &str| Err(Failure::Usage(why.to_owned()));
    let wanted = match (format, profile.is_some()) {
        (Format::Svg | Format::Json, _) | (Format::Inkml | Format::Pdf, false) => return Ok(()),
        (Format::Inkml, true) => {
            return unfit("InkML holds a drawing's strokes, not a machine's tool paths; leave out --profile");
        }
        (Format::Pdf, true) => {
            return unfit("PDF is for print, not for a plotter; leave out --profile, or write the plotter's format");
        }
        (Format::Hpgl, _) => Language::Hpgl,
        (Format::Gcode, _) => Language::Gcode,
    };
    match profile {
        None => Err(needs_profile()),
        Some(profile) if profile.language() == wanted => Ok(()),
        Some(profile) => {
            let right = listed(profile.language().extensions().iter().map(|extension| format!(".{extension}")));
            Err(Failure::Usage(format!("{} reads another language than this file's format; write {right}", profile.name)))
        }
    }
}
