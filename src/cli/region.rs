//! `--region`: a part of the picture in a style of its own.

use super::words::{inline_table, nearest, switch_word};
use crate::drawing::Ink;
use crate::geometry::parse_length;
use crate::scene::Border;

/// The keys of a region and what each takes.
pub(super) const KEYS: [(&str, &str); 10] = [
    ("mask", "the part: a role that is found or given by --mask, such as \"hair\", or a file, white inside"),
    ("style", "its style, the drawing's own if it is left out"),
    ("set", "parameters of its style, such as { pitch = 0.5 }"),
    ("pen", "the number of its pen, from 1"),
    ("ink", "a CSS colour, k or spot:NAME"),
    ("seed", "where its random choices start"),
    ("gap", "bare paper on its side of its border, a length"),
    ("fade", "the band in which its marks thin out towards its border, a length"),
    ("flow", "\"across\" if marks follow lines on both sides of its border, \"inside\" if only those of the region"),
    ("name", "the first part of its layers' names"),
];
/// The widest gap or fade in millimetres.
const WIDEST: f64 = 100.0;

/// Which lines steer a region's marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    /// Those on both sides of its border, and the border.
    Across,
    /// Its own.
    Inside,
}

/// One region as given.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RegionOption {
    pub mask: String,
    pub style: Option<String>,
    pub set: Vec<(String, String)>,
    pub pen: Option<u32>,
    pub ink: Option<Ink>,
    pub seed: Option<u64>,
    pub border: Border,
    pub flow: Flow,
    pub name: Option<String>,
}

/// Reads the inside of an inline table of TOML, such as `mask = "hair", style = "charcoal"`.
pub(super) fn region(text: &str) -> Result<RegionOption, String> {
    let keys =
        inline_table(text).ok_or_else(|| "write it as mask=\"hair\", style=\"charcoal\", set={ pitch = 0.5 }".to_owned())?;
    let mut region = RegionOption {
        mask: String::new(),
        style: None,
        set: Vec::new(),
        pen: None,
        ink: None,
        seed: None,
        border: Border::Butt,
        flow: Flow::Across,
        name: None,
    };
    for (key, value) in &keys {
        region.give(key, value)?;
    }
    if region.mask.is_empty() {
        return Err("mask is missing: the role or the file of the region".to_owned());
    }
    Ok(region)
}

impl RegionOption {
    fn give(&mut self, key: &str, value: &toml::Value) -> Result<(), String> {
        let meaning = KEYS.iter().find(|(known, _)| *known == key).map(|(_, meaning)| *meaning);
        let Some(meaning) = meaning else {
            let known: Vec<&str> = KEYS.iter().map(|(known, _)| *known).collect();
            let near = nearest(key, known.iter().copied());
            let near = near.map(|near| format!(" (did you mean {near}?)")).unwrap_or_default();
            return Err(format!("a region has no key '{key}'{near}; its keys are {}", known.join(", ")));
        };
        let refuse = || format!("{key} is not {value}, but {meaning}");
        let text = || value.as_str().map(str::to_owned).filter(|text| !text.is_empty()).ok_or_else(refuse);
        match key {
            "mask" => self.mask = text()?,
            "style" => self.style = Some(text()?),
            "name" => self.name = Some(text()?),
            "ink" => self.ink = Some(text()?.parse().map_err(|_| refuse())?),
            "flow" => {
                self.flow = match value.as_str() {
                    Some("across") => Flow::Across,
                    Some("inside") => Flow::Inside,
                    _ => return Err(refuse()),
                }
            }
            "pen" => {
                let pen = value.as_integer().and_then(|n| u32::try_from(n).ok()).filter(|pen| (1..=1000).contains(pen));
                self.pen = Some(pen.ok_or_else(refuse)?);
            }
            "seed" => self.seed = Some(value.as_integer().and_then(|n| u64::try_from(n).ok()).ok_or_else(refuse)?),
            "set" => {
                for (name, value) in value.as_table().ok_or_else(refuse)? {
                    self.set.push((name.clone(), parameter_text(value).ok_or_else(refuse)?));
                }
            }
            _ => {
                if self.border != Border::Butt {
                    return Err("a border has a gap or a fade, not both".to_owned());
                }
                let mm = length(value).filter(|mm| (0.0..=WIDEST).contains(mm)).ok_or_else(refuse)?;
                self.border = if key == "gap" { Border::Gap(mm) } else { Border::Fade(mm) };
            }
        }
        Ok(())
    }
}

/// A parameter's value as `--set` takes it.
fn parameter_text(value: &toml::Value) -> Option<String> {
    match value {
        toml::Value::String(text) => Some(text.clone()),
        toml::Value::Integer(number) => Some(number.to_string()),
        toml::Value::Float(number) => Some(number.to_string()),
        toml::Value::Boolean(is_on) => Some(switch_word(*is_on).to_owned()),
        _ => None,
    }
}

fn length(value: &toml::Value) -> Option<f64> {
    match value {
        toml::Value::String(text) => parse_length(text).ok(),
        toml::Value::Integer(number) => Some(*number as f64),
        toml::Value::Float(number) => Some(*number),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_read_with_all_their_keys() {
        let text = "mask = \"hair\", style = \"charcoal\", set = { pitch = 0.5, paper = true }, pen = 2, ink = \"navy\", seed = 3, gap = \"0.2cm\", flow = \"inside\"";
        let found = region(text).unwrap();
        assert_eq!((found.mask.as_str(), found.pen, found.seed, found.border), ("hair", Some(2), Some(3), Border::Gap(2.0)));
        assert_eq!(found.flow, Flow::Inside);
        assert_eq!(found.set, [("paper".to_owned(), "on".to_owned()), ("pitch".to_owned(), "0.5".to_owned())]);
    }

    #[test]
    fn faults_say_what_is_meant() {
        let told = |text: &str| region(text).unwrap_err();
        assert!(told("stile = \"x\"").contains("did you mean style?"));
        assert!(told("style = \"grid\"").contains("mask is missing"));
        assert!(told("mask = \"hair\", gap = 1, fade = 1").contains("not both"));
        assert!(told("mask = \"hair\", flow = \"stop\"").contains("flow is not"));
        assert!(told("mask = \"hair\", gap = -1").contains("gap is not -1"));
        assert!(told("hair").contains("write it as"));
    }
}
