//! HP-GL act by act: what each instruction makes the machine do, and where it is then.

use super::SPEED_STEP;
use super::read::{Reader, instructions};
use crate::plot::language::{Act, Replayed};
use crate::read::Budget;
use std::borrow::Cow;

/// The acts of a file, each with the instruction that is sent for it: an instruction of several acts is sent with the first that needs it.
/// `rate` is the drawing speed before the first `VS`, and `per_mm` the units per millimetre.
pub(super) fn replay<'a>(text: &'a str, rate: f64, per_mm: f64) -> Vec<Replayed<'a>> {
    let mut budget = Budget::default();
    let mut reader = Reader::new(&mut budget);
    let (mut acts, mut rate) = (Vec::new(), rate);
    for (bytes, instruction) in instructions(text) {
        let (was_down, from) = (reader.is_down(), reader.at());
        let count = reader.visited();
        // A fault was told when the file was read; what cannot be read moves nothing.
        if reader.execute(instruction, bytes.start).is_err() {
            continue;
        }
        let name = instruction.get(..2).unwrap_or("").to_ascii_uppercase();
        let number = instruction.get(2..).and_then(|rest| rest.trim().parse::<f64>().ok());
        let mut add = |text: Cow<'a, str>, act: Act, at: crate::geometry::Point| {
            acts.push(Replayed { text, act, at: [at.x, at.y, 0.0] });
        };
        let whole: Cow<'a, str> = Cow::Owned(format!("{instruction};"));
        let lifts = was_down && !reader.is_down();
        let lowers = !was_down && reader.is_down();
        if lifts {
            add(Cow::Borrowed("PU;"), Act::Lift, from);
        } else if lowers {
            let own = if reader.visited() == count { whole.clone() } else { Cow::Borrowed("") };
            add(own, Act::Lower, from);
        }
        let act = if reader.is_down() { Act::Line(rate) } else { Act::Rapid };
        let places = reader.since(count);
        let parts = parted(instruction, places.len());
        for (i, place) in places.iter().enumerate() {
            let own = match &parts {
                Some(parts) if i % PAIRS == 0 => Cow::Owned(parts[i / PAIRS].clone()),
                None if i == 0 => whole.clone(),
                _ => Cow::Borrowed(""),
            };
            add(own, act, *place);
        }
        match name.as_str() {
            "SP" => add(whole, Act::Pen(number.unwrap_or(0.0) as u32), from),
            "PU" | "PD" => {}
            "VS" => {
                rate = number.map_or(rate, |speed| speed * SPEED_STEP * 60.0 * per_mm);
                add(whole, Act::Mode, from);
            }
            _ if reader.visited() == count && !lifts => add(whole, Act::Mode, from),
            _ => {}
        }
    }
    acts
}

/// Pairs of coordinates in one instruction: small buffers take it, and what is drawn is known more closely.
const PAIRS: usize = 16;

/// A long instruction of moves as several; `None` for any other.
fn parted(instruction: &str, places: usize) -> Option<Vec<String>> {
    let name = instruction.get(..2).filter(|name| ["PU", "PD", "PA", "PR"].contains(&name.to_ascii_uppercase().as_str()))?;
    let numbers: Vec<&str> = instruction[2..].split([',', ' ']).map(str::trim).filter(|number| !number.is_empty()).collect();
    (places > PAIRS && numbers.len() == 2 * places)
        .then(|| numbers.chunks(2 * PAIRS).map(|pairs| format!("{name}{};", pairs.join(","))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_are_parted_into_acts() {
        let acts = replay("IN;PU;PS4;SP1;VS30;PU100,200;PD300,400,500,600;PU10,20;PD;PU0,0;SP0;", 60.0, 40.0);
        let shown: Vec<(&str, Act)> = acts.iter().map(|act| (&*act.text, act.act)).collect();
        let line = Act::Line(30.0 * SPEED_STEP * 60.0 * 40.0);
        let expected = [
            ("IN;", Act::Mode),
            ("PS4;", Act::Mode),
            ("SP1;", Act::Pen(1)),
            ("VS30;", Act::Mode),
            ("PU100,200;", Act::Rapid),
            ("", Act::Lower),
            ("PD300,400,500,600;", line),
            ("", line),
            ("PU;", Act::Lift),
            ("PU10,20;", Act::Rapid),
            ("PD;", Act::Lower),
            ("PU;", Act::Lift),
            ("PU0,0;", Act::Rapid),
            ("SP0;", Act::Pen(0)),
        ];
        assert_eq!(shown, expected);
        assert_eq!(acts[7].at, [500.0, 600.0, 0.0]);
    }

    #[test]
    fn a_long_instruction_is_parted() {
        let numbers: Vec<String> = (0..40).map(|i| format!("{i},{}", 2 * i)).collect();
        let text = format!("SP1;PD{};PU;", numbers.join(","));
        let acts = replay(&text, 60.0, 40.0);
        let texts: Vec<&str> = acts.iter().map(|act| &*act.text).filter(|text| text.starts_with("PD")).collect();
        assert_eq!(texts.len(), 3);
        let joined: Vec<String> = texts.iter().map(|text| text[2..].trim_end_matches(';').to_owned()).collect();
        assert_eq!(joined.join(","), numbers.join(","));
    }
}
