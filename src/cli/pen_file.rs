//! The file of `--pens`: one table per pen.

use super::arguments::NIBS;
use super::failure::Failure;
use super::words::line_of;
use crate::colour::{Opacity, known_pen_named};
use crate::drawing::{Colour, Ink};
use crate::geometry::parse_length;
use toml::de::{DeTable, DeValue};

/// A working example with every key explained; `drypoint profiles --pens-example` prints it.
pub(super) const EXAMPLE: &str = r##"# Pens for drypoint: one table for each.
#
# A table is named after the layer that its pen draws, or after the pen's number ([1], [2], ...). A layer that no table
# names goes, colour by colour, to the pen of the nearest colour here. Every key may be left out.

[black]
colour = "black"    # a CSS colour, for the nearest one and for previews
width = "0.3mm"     # of the nib: mm, cm, in or pt
slot = 1            # where the machine holds it, or when it is put in: 1 first

[red]
colour = "#cc0000"
width = "0.5mm"
slot = 2
speed = 30          # mm/s with the pen down; without it the machine's, or --speed
# like = "Pigma Micron 05 red" # width and estimated colour of a common pen; `drypoint pens` lists them
# lab = [45, 62, 40] # its colour on the paper as measured, L*a*b* (D65), instead of `colour`, for --colours
# ink = "spot:Warm Red" # its name for the press: a plate of its own in PDF; or "k", the black plate
# over = { black = [12, 3, 1] } # what it looks like drawn over other pens of this file, L*a*b*, for --colours
# over_all = [9, 2, 1] # what it looks like over all other pens of this file together, for --colours
# opaque = true     # covers what lies below, as a white gel pen does, for --colours
# dwell = 0.1       # seconds that a touch rests beyond the time that the pen takes to come down (G-code)
# offset = [0, 0]   # how far its ink lies off, in mm along the machine's x and y: see docs/calibration.md
"##;

/// The keys of a pen and the values that each takes.
const KEYS: [(&str, &str); 12] = [
    ("width", "a length from 0.01 to 20 mm, such as \"0.3mm\" or 0.3"),
    ("slot", "a whole number from 1, such as 2"),
    ("colour", "a CSS colour, such as \"navy\" or \"#1f77b4\""),
    ("speed", "mm/s above 0, such as 30"),
    ("dwell", "seconds from 0 to 60, such as 0.1"),
    ("like", "the name of a pen that `drypoint pens` lists, such as \"fine-liner cyan\""),
    ("lab", "three numbers: L* from 0 to 100, a* and b*, such as [45, 62, 40]"),
    ("over", "other pens and what it looks like over each, L* from 0 to 100, a* and b*, such as { yellow = [52, 61, 38] }"),
    ("over_all", "its look over all other pens: L* from 0 to 100, a* and b*, such as [14, 3, 2]"),
    ("ink", "\"k\", the black plate, or \"spot:NAME\", a plate of that name; a colour goes into colour"),
    ("opaque", "true or false"),
    ("offset", "two numbers in mm, along x and along y, such as [0.1, 0]"),
];

/// One pen.
#[derive(Debug, Default)]
pub(super) struct PenEntry {
    /// The layer's name, or the pen's number.
    pub key: String,
    pub width: Option<f64>,
    pub slot: Option<u32>,
    pub colour: Option<Colour>,
    /// L\*a\*b\* under D65.
    pub lab: Option<[f64; 3]>,
    /// Its colour, L\*a\*b\*, over other pens, by their keys.
    pub over: Vec<(String, [f64; 3])>,
    /// Its colour, L\*a\*b\*, over all other pens together.
    pub over_all: Option<[f64; 3]>,
    /// The plate that a press prints it with; none for a colour.
    pub plate: Option<Ink>,
    /// Covers what lies below.
    pub is_opaque: bool,
    pub speed: Option<f64>,
    pub dwell: Option<f64>,
    pub offset: Option<[f64; 2]>,
}

impl PenEntry {
    /// What its layer is printed with, where it looks like `shown`.
    pub(super) fn ink(&self, shown: Colour) -> Ink {
        match &self.plate {
            Some(Ink::Spot { name, .. }) => Ink::Spot { name: name.clone(), shown },
            Some(black) => black.clone(),
            None => Ink::Colour(shown),
        }
    }
}

/// Reads the file's text; `file` is its name in messages.
pub(super) fn read_pens(file: &str, text: &str) -> Result<Vec<PenEntry>, Failure> {
    let syntax = |error: toml::de::Error| {
        let line = error.span().map_or(1, |span| line_of(text, span.start));
        Failure::Work(format!("{file}, line {line}: {}", error.message()))
    };
    let spans = DeTable::parse(text).map_err(syntax)?;
    let values: toml::Table = toml::from_str(text).map_err(syntax)?;
    let reader = Reader { file, text, spans: spans.get_ref() };
    values.iter().map(|(name, value)| reader.pen(name, value)).collect()
}

struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    spans: &'a DeTable<'a>,
}

impl Reader<'_> {
    fn pen(&self, name: &str, value: &toml::Value) -> Result<PenEntry, Failure> {
        let keys = match value {
            toml::Value::Table(keys) => keys,
            toml::Value::Array(_) => {
                return Err(self.refuse(
                    name,
                    None,
                    &format!("'{name}' is a list; each pen is a table of its own, such as [black]"),
                ));
            }
            _ => {
                let problem = format!("'{name}' is outside any pen; put it under a pen's table, such as [black]");
                return Err(self.refuse(name, None, &problem));
            }
        };
        let mut pen = PenEntry { key: name.to_owned(), ..PenEntry::default() };
        for (key, value) in keys {
            self.give(&mut pen, key, value)?;
        }
        if pen.offset.is_some() && pen.slot.is_none() && name.parse::<u32>().is_err() {
            return Err(self.refuse(name, Some("offset"), &format!("[{name}] needs a slot for its offset")));
        }
        Ok(pen)
    }

    fn give(&self, pen: &mut PenEntry, key: &str, value: &toml::Value) -> Result<(), Failure> {
        let key = if key == "color" { "colour" } else { key };
        let Some((_, takes)) = KEYS.iter().find(|(known, _)| *known == key) else {
            return Err(self.unknown(&pen.key, key, value));
        };
        let given = match key {
            "width" => set(&mut pen.width, length(value).filter(|mm| NIBS.contains(mm))),
            "slot" => set(&mut pen.slot, value.as_integer().and_then(|n| u32::try_from(n).ok()).filter(|slot| *slot > 0)),
            "colour" => set(&mut pen.colour, value.as_str().and_then(|text| text.parse().ok())),
            "speed" => set(&mut pen.speed, number(value).filter(|speed| *speed > 0.0)),
            "dwell" => set(&mut pen.dwell, number(value).filter(|seconds| (0.0..=60.0).contains(seconds))),
            "like" => match value.as_str().and_then(known_pen_named) {
                Some(known) => {
                    pen.width.get_or_insert(known.width_mm);
                    pen.colour.get_or_insert(known.colour);
                    pen.is_opaque |= known.opacity == Opacity::Opaque;
                    true
                }
                None => false,
            },
            "lab" => set(&mut pen.lab, triple(value).filter(is_colour)),
            "over" => overprints(value).inspect(|over| pen.over.clone_from(over)).is_some(),
            "over_all" => set(&mut pen.over_all, triple(value).filter(is_colour)),
            "ink" => set(&mut pen.plate, value.as_str().and_then(plate)),
            "opaque" => value.as_bool().inspect(|is_opaque| pen.is_opaque = *is_opaque).is_some(),
            _ => set(&mut pen.offset, pair(value)),
        };
        if given {
            return Ok(());
        }
        let found = match value {
            toml::Value::Table(_) => "a table".to_owned(),
            other => other.to_string(),
        };
        Err(self.refuse(&pen.key, Some(key), &format!("[{}] {key} takes {takes}, not {found}", pen.key)))
    }

    fn unknown(&self, name: &str, key: &str, value: &toml::Value) -> Failure {
        let known = KEYS.map(|(known, _)| known).join(", ");
        let problem = if value.is_table() {
            format!(
                "[{name}.{key}] is a table within a table; name a pen in one word, as in [{key}], or in quotes, as in [\"two words\"]"
            )
        } else {
            format!("[{name}] has no key '{key}'; it takes {known}")
        };
        self.refuse(name, Some(key), &problem)
    }

    /// An error with the line of a pen's table or of one of its keys.
    fn refuse(&self, name: &str, key: Option<&str>, problem: &str) -> Failure {
        let found = self.spans.iter().find(|(known, _)| *known.get_ref() == *name);
        let start = found.map_or(0, |(known, table)| {
            let inner = match (key, table.get_ref()) {
                (Some(key), DeValue::Table(keys)) => keys.keys().find(|known| *known.get_ref() == *key).map(|k| k.span().start),
                _ => None,
            };
            inner.unwrap_or(known.span().start)
        });
        let (file, line) = (self.file, line_of(self.text, start));
        Failure::Work(format!("{file}, line {line}: {problem} (drypoint profiles --pens-example prints a working file)"))
    }
}

/// Sets `place` to `value`; returns true if there is a value.
fn set<T>(place: &mut Option<T>, value: Option<T>) -> bool {
    let is_given = value.is_some();
    *place = value;
    is_given
}

fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|n| n as f64)).filter(|number| number.is_finite())
}

fn length(value: &toml::Value) -> Option<f64> {
    value.as_str().map_or_else(|| number(value), |text| parse_length(text).ok())
}

fn plate(text: &str) -> Option<Ink> {
    text.parse().ok().filter(|ink| !matches!(ink, Ink::Colour(_)))
}

fn triple(value: &toml::Value) -> Option<[f64; 3]> {
    match &value.as_array()?[..] {
        [l, a, b] => Some([number(l)?, number(a)?, number(b)?]),
        _ => None,
    }
}

fn is_colour([l, ..]: &[f64; 3]) -> bool {
    (0.0..=100.0).contains(l)
}

/// Other pens, each with a colour.
fn overprints(value: &toml::Value) -> Option<Vec<(String, [f64; 3])>> {
    value.as_table()?.iter().map(|(pen, colour)| Some((pen.clone(), triple(colour).filter(is_colour)?))).collect()
}

fn pair(value: &toml::Value) -> Option<[f64; 2]> {
    match &value.as_array()?[..] {
        [x, y] => Some([number(x)?, number(y)?]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        read_pens("pens.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn the_example_is_read_as_it_stands() {
        let pens = read_pens("example", EXAMPLE).unwrap();
        let told: Vec<_> = pens.iter().map(|pen| (pen.key.as_str(), pen.slot, pen.width, pen.speed)).collect();
        assert_eq!(told, [("black", Some(1), Some(0.3), None), ("red", Some(2), Some(0.5), Some(30.0))]);
        for (key, _) in KEYS {
            assert!(EXAMPLE.contains(&format!("{key} = ")), "{key}");
        }
        // The keys that are commented out work too.
        let whole = EXAMPLE.replace("# dwell", "dwell").replace("# offset", "offset");
        assert_eq!(read_pens("example", &whole).unwrap()[1].dwell, Some(0.1));
    }

    #[test]
    fn a_wrong_file_says_line_key_and_what_it_takes() {
        for (text, said) in [
            ("[a]\nslot = \"two\"\n", "pens.toml, line 2: [a] slot takes a whole number from 1, such as 2, not \"two\""),
            ("[a]\n\nslot = { x = 1 }\n", "line 3: [a] slot takes a whole number from 1, such as 2, not a table"),
            ("[a]\nwidth = \"wide\"\n", "line 2: [a] width takes a length from 0.01 to 20 mm"),
            (
                "[a]\nwidht = 0.3\n",
                "line 2: [a] has no key 'widht'; it takes width, slot, colour, speed, dwell, like, lab, over, over_all, ink, opaque, offset",
            ),
            ("[pen.1]\nwidth = 0.3\n", "line 1: [pen.1] is a table within a table"),
            ("[[pen]]\nwidth = 0.3\n", "line 1: 'pen' is a list"),
            ("slot = 1\n", "line 1: 'slot' is outside any pen"),
            ("[a]\ncolour = \"purplish\"\n", "[a] colour takes a CSS colour"),
            ("[a]\nink = \"red\"\n", "line 2: [a] ink takes \"k\", the black plate, or \"spot:NAME\""),
            ("[a]\nspeed = -1\n", "[a] speed takes mm/s above 0"),
            ("[a]\noffset = [1, 2]\n", "line 2: [a] needs a slot for its offset"),
        ] {
            assert!(message(text).contains(said), "{text}: {}", message(text));
        }
        assert!(message("[a\n").starts_with("pens.toml, line 1: "));
    }
}
