//! The values of a style's parameters for one drawing.

use super::Need;
use super::need::all_text;
use super::parameter::{Kind, Parameter, ParameterError};
use super::places::Places;
use crate::geometry::parse_length;
use crate::source::Portrait;
use std::collections::BTreeMap;

/// A parameter's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Number(f64),
    Word(&'static str),
    Places(Places),
}

/// All parameters of one style with their values.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    values: BTreeMap<&'static str, Value>,
}

impl Settings {
    /// Resolves the user's values (later ones win) and the defaults.
    pub fn resolve(style: &str, parameters: &'static [Parameter], given: &[(String, String)]) -> Result<Self, ParameterError> {
        let mut values = BTreeMap::new();
        for (key, text) in given {
            let parameter = parameters.iter().find(|p| p.name == key).ok_or_else(|| unknown(style, parameters, key))?;
            values.insert(parameter.name, parse(parameter, text)?);
        }
        let pitch = parameters.iter().find(|p| p.name == "pitch").map_or(1.0, |p| {
            match (values.get("pitch"), p.kind.default_number(1.0)) {
                (Some(Value::Number(pitch)), _) => *pitch,
                (_, default) => default.unwrap_or(1.0),
            }
        });
        for parameter in parameters {
            values.entry(parameter.name).or_insert_with(|| parameter.kind.clamped_default(pitch));
        }
        Ok(Self { values })
    }

    /// One sentence per parameter that differs from its default but has no effect on this portrait, with the conditions it lacks. A
    /// value equal to the default is never reported, even if a recipe spells it out.
    pub fn idle(&self, parameters: &[Parameter], portrait: &Portrait) -> Vec<String> {
        let pitch = self.pitch().unwrap_or(1.0);
        let is_set = |parameter: &&Parameter| {
            self.values.get(parameter.name).is_some_and(|value| *value != parameter.kind.default_value(pitch))
        };
        parameters
            .iter()
            .filter(is_set)
            .filter_map(|parameter| {
                let missing: Vec<Need> = parameter.needs.iter().filter(|need| !need.is_met(self, portrait)).copied().collect();
                let value = self.entries().find(|(name, _)| *name == parameter.name)?.1;
                (!missing.is_empty())
                    .then(|| format!("{}={value} has no effect here: it needs {}", parameter.name, all_text(&missing)))
            })
            .collect()
    }

    /// The distance between neighbouring marks in millimetres, in styles that have one.
    pub fn pitch(&self) -> Option<f64> {
        match self.values.get("pitch") {
            Some(Value::Number(pitch)) => Some(*pitch),
            _ => None,
        }
    }

    /// A length in millimetres, a number or a count.
    ///
    /// # Panics
    /// If the style has no such parameter, which is a bug in the style.
    pub fn number(&self, name: &str) -> f64 {
        let Some(Value::Number(number)) = self.values.get(name) else { self.has_no(name, "number") };
        *number
    }

    /// A choice.
    ///
    /// # Panics
    /// If the style has no such choice, which is a bug in the style.
    pub fn word(&self, name: &str) -> &'static str {
        let Some(Value::Word(word)) = self.values.get(name) else { self.has_no(name, "choice") };
        word
    }

    /// Places in the picture.
    ///
    /// # Panics
    /// If the style has no such parameter, which is a bug in the style.
    pub fn places(&self, name: &str) -> Places {
        let Some(Value::Places(places)) = self.values.get(name) else { self.has_no(name, "set of places") };
        *places
    }

    /// A style asks only for parameters that it declares; its tests read all of them.
    fn has_no(&self, name: &str, kind: &str) -> ! {
        panic!("{name} is not a {kind} of this style: {:?}", self.values.get(name))
    }

    /// `KEY=VALUE` for every parameter that differs from its default; the same parameters come of it.
    pub fn changed(&self, parameters: &[Parameter]) -> Vec<String> {
        let usual_pitch = parameters.iter().find(|p| p.name == "pitch").and_then(|p| p.kind.default_number(1.0));
        let pitch = self.pitch().or(usual_pitch).unwrap_or(1.0);
        let default = |name: &str| parameters.iter().find(|p| p.name == name).map(|p| p.kind.clamped_default(pitch));
        let is_changed = |(name, value): &(&&str, &Value)| default(name).as_ref() != Some(*value);
        let exact = |value: &Value| if let Value::Number(number) = value { number.to_string() } else { value.text() };
        self.values.iter().filter(is_changed).map(|(name, value)| format!("{name}={}", exact(value))).collect()
    }

    /// Every key with its value in the form that `--set` accepts.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, String)> {
        self.values.iter().map(|(name, value)| (*name, value.text()))
    }
}

impl Value {
    /// In the form that `--set` accepts.
    fn text(&self) -> String {
        match self {
            Self::Number(number) => format!("{}", (number * 1e6).round() / 1e6),
            Self::Word(word) => (*word).to_owned(),
            Self::Places(places) => places.text(),
        }
    }
}

impl Kind {
    fn default_value(&self, pitch: f64) -> Value {
        match self {
            Self::Choice(words) => Value::Word(words[0]),
            Self::Places { .. } => Value::Places(Places { percent: [(0.0, 0.0); Places::MOST], count: 0 }),
            kind => Value::Number(kind.default_number(pitch).unwrap_or(0.0)),
        }
    }

    /// The default inside the range.
    fn clamped_default(&self, pitch: f64) -> Value {
        match self.default_value(pitch) {
            Value::Number(number) => Value::Number(self.within(number)),
            other => other,
        }
    }

    /// Clamps a number to the range; defaults in pitches need it too.
    fn within(&self, number: f64) -> f64 {
        match *self {
            Self::Length { least, most, .. } | Self::Number { least, most, .. } => number.clamp(least, most),
            Self::Count { least, most, .. } => number.clamp(f64::from(least), f64::from(most)),
            Self::Choice(_) | Self::Places { .. } => number,
        }
    }
}

fn parse(parameter: &Parameter, text: &str) -> Result<Value, ParameterError> {
    let refuse = || ParameterError::Value {
        key: parameter.name.to_owned(),
        value: text.to_owned(),
        expected: parameter.kind.range_text(),
    };
    let within = |number: f64, least: f64, most: f64| {
        (number >= least && number <= most).then_some(Value::Number(number)).ok_or_else(refuse)
    };
    match parameter.kind {
        Kind::Length { least, most, .. } => within(parse_length(text).map_err(|_| refuse())?, least, most),
        Kind::Number { least, most, .. } => within(text.trim().parse().map_err(|_| refuse())?, least, most),
        Kind::Count { least, most, .. } => {
            let count: u32 = text.trim().parse().map_err(|_| refuse())?;
            within(f64::from(count), f64::from(least), f64::from(most))
        }
        Kind::Choice(words) => words.iter().find(|word| **word == text.trim()).map(|word| Value::Word(word)).ok_or_else(refuse),
        Kind::Places { most } => Places::parse(text, most).map(Value::Places).ok_or_else(refuse),
    }
}

fn unknown(style: &str, parameters: &[Parameter], key: &str) -> ParameterError {
    let known: Vec<&str> = parameters.iter().map(|p| p.name).collect();
    let near = known.iter().find(|name| {
        name.contains(key)
            || key.contains(**name)
            || (name.chars().next() == key.chars().next() && name.len().abs_diff(key.len()) < 3)
    });
    ParameterError::Unknown {
        key: key.to_owned(),
        style: style.to_owned(),
        known: known.join(", "),
        hint: near.map(|name| format!("; did you mean {name}?")).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::DefaultLength;

    const PARAMETERS: &[Parameter] = &[
        Parameter {
            name: "pitch",
            kind: Kind::Length { default: DefaultLength::Millimetres(0.6), least: 0.1, most: 20.0 },
            meaning: "",
            source: "",
            needs: &[],
        },
        Parameter {
            name: "reach",
            kind: Kind::Length { default: DefaultLength::Pitches(2.0), least: 0.0, most: 20.0 },
            meaning: "",
            source: "",
            needs: &[],
        },
        Parameter {
            name: "gamma",
            kind: Kind::Number { default: 1.2, least: 0.1, most: 5.0 },
            meaning: "",
            source: "",
            needs: &[],
        },
        Parameter { name: "size", kind: Kind::Choice(&["exact", "paper"]), meaning: "", source: "", needs: &[] },
        Parameter { name: "skin", kind: Kind::Places { most: 2 }, meaning: "", source: "", needs: &[] },
    ];

    fn given(pairs: &[(&str, &str)]) -> Result<Settings, ParameterError> {
        let pairs: Vec<(String, String)> = pairs.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        Settings::resolve("hedcut", PARAMETERS, &pairs)
    }

    #[test]
    fn defaults_follow_the_pitch_and_later_values_win() {
        let settings = given(&[("pitch", "1"), ("pitch", "0.1cm"), ("size", "paper")]).unwrap();
        assert_eq!(settings.number("pitch"), 1.0);
        assert_eq!(settings.number("reach"), 2.0);
        assert_eq!(settings.word("size"), "paper");
    }

    #[test]
    fn a_default_that_follows_the_pitch_stays_in_its_range() {
        let reach = |pitch| given(&[("pitch", pitch)]).unwrap().number("reach");
        assert_eq!((reach("20"), reach("0.1")), (20.0, 0.2));
    }

    #[test]
    fn places_are_read_and_written_alike() {
        let settings = given(&[("skin", "25,40; 75%,12.5")]).unwrap();
        assert_eq!(settings.places("skin").shares().collect::<Vec<_>>(), [(0.25, 0.4), (0.75, 0.125)]);
        assert_eq!(settings.entries().find(|(name, _)| *name == "skin").unwrap().1, "25,40;75,12.5");
        assert_eq!(given(&[]).unwrap().places("skin").shares().count(), 0);
    }

    #[test]
    fn errors_say_what_would_work() {
        for (key, value) in [
            ("pitch", "NaN"),
            ("pitch", "-1"),
            ("gamma", "nan"),
            ("gamma", "inf"),
            ("size", "round"),
            ("pitch", ""),
            ("skin", "1,2;3,4;5,6"),
            ("skin", "1;2"),
            ("skin", "1,101"),
        ] {
            let error = given(&[(key, value)]).unwrap_err();
            assert!(matches!(error, ParameterError::Value { .. }), "{key}={value}: {error}");
        }
        let error = given(&[("pich", "1")]).unwrap_err().to_string();
        assert!(error.contains("did you mean pitch"), "{error}");
    }
}
