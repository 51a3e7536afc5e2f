//! `--pens`: what is in each holder, and which layer or colour it draws.
//!
//! ```toml
//! [dots]              # a layer's name, or its pen's number
//! width = "0.3mm"     # of the nib
//! slot = 2            # where the machine holds it
//! colour = "navy"     # for previews; layers that no entry names go to the entry of the nearest colour
//! speed = 30          # mm/s
//! dwell = 0.1         # seconds that a touch rests
//! offset = [0.1, 0]   # how far its ink lies off, mm along the machine's axes
//! ```

use super::failure::Failure;
use super::output;
use crate::drawing::{Colour, Drawing, Ink, Layer, Mark, Painted};
use crate::geometry::parse_length;
use crate::plot::{Nibs, PenChange, PenSlot, Profile};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};

/// Colours that a user can be asked to change pens for; more is a picture that was meant for a screen.
const MOST_CHANGES: u32 = 12;

/// What `--pens` says, and what holds for pens that it does not name.
#[derive(Debug)]
pub(super) struct PenSet {
    entries: Vec<Entry>,
    nibs: Nibs,
    dwell: BTreeMap<u32, f64>,
}

#[derive(Debug)]
struct Entry {
    key: String,
    pen: Pen,
    width: Option<f64>,
    colour: Option<Colour>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Pen {
    width: Option<toml::Value>,
    slot: Option<u32>,
    colour: Option<String>,
    speed: Option<f64>,
    dwell: Option<f64>,
    offset: Option<[f64; 2]>,
}

impl Entry {
    fn read(file: &str, key: String, pen: Pen) -> Result<Self, Failure> {
        let refuse = |what: &str| Failure::Work(format!("{file}: [{key}] {what}"));
        let width = match &pen.width {
            None => None,
            Some(toml::Value::String(text)) => Some(parse_length(text).map_err(|error| refuse(&error.to_string()))?),
            Some(value) => {
                Some(value.as_float().or(value.as_integer().map(|n| n as f64)).ok_or_else(|| refuse("width must be a length"))?)
            }
        };
        if width.is_some_and(|mm| !(0.01..=100.0).contains(&mm)) {
            return Err(refuse("width must be from 0.01 to 100 mm"));
        }
        let colour = pen.colour.as_deref().map(str::parse).transpose();
        let colour = colour.map_err(|error: crate::drawing::ColourError| refuse(&format!("colour: {error}")))?;
        if pen.slot == Some(0) || pen.speed.is_some_and(|v| !v.is_finite() || v <= 0.0) {
            return Err(refuse("slot and speed must be above 0"));
        }
        if pen.dwell.is_some_and(|s| !(0.0..=60.0).contains(&s)) {
            return Err(refuse("dwell must be from 0 to 60 seconds"));
        }
        if pen.offset.is_some() && pen.slot.is_none() && key.parse::<u32>().is_err() {
            return Err(refuse("needs a slot for its offset"));
        }
        Ok(Self { key, pen, width, colour })
    }

    fn is_for(&self, layer: &Layer) -> bool {
        self.key == layer.name || self.key == layer.pen.to_string()
    }

    /// Its slot, where that does not depend on the layer.
    fn slot(&self) -> Option<u32> {
        self.pen.slot.or_else(|| self.key.parse().ok())
    }
}

impl PenSet {
    /// Reads `--pens`; `usual` is the nib of pens that it does not name. Calibrated offsets go into the profile.
    pub(super) fn read(file: Option<&str>, usual: f64, profile: Option<&mut Profile>) -> Result<Self, Failure> {
        let mut set = Self { entries: Vec::new(), nibs: Nibs::all(usual), dwell: BTreeMap::new() };
        set.nibs.swell = profile.as_ref().and_then(|profile| profile.swell.clone());
        let Some(file) = file else { return Ok(set) };
        let text = String::from_utf8(output::read(file)?).map_err(|_| Failure::Work(format!("{file} is not UTF-8 text")))?;
        let table: BTreeMap<String, Pen> = toml::from_str(&text).map_err(|error: toml::de::Error| {
            let line = error.span().map_or(1, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
            Failure::Work(format!("{file}, line {line}: {}", error.message()))
        })?;
        set.entries = table.into_iter().map(|(key, pen)| Entry::read(file, key, pen)).collect::<Result<_, _>>()?;
        if let Some(profile) = profile {
            for entry in &set.entries {
                if let (Some(offset), Some(slot)) = (entry.pen.offset, entry.slot()) {
                    let pen_life = profile.life_of(slot);
                    profile.pen.retain(|pen| pen.slot != slot);
                    profile.pen.push(PenSlot { slot, offset, pen_life });
                }
            }
        }
        Ok(set)
    }

    /// Gives every layer its pen: by name or number, else by the nearest colour; refuses more colours than there are pens. Returns the
    /// marks in the order in which they were painted before they were sorted by pens.
    pub(super) fn assign(&mut self, drawing: &mut Drawing, profile: Option<&Profile>) -> Result<Vec<Painted>, Failure> {
        let painting = self.sort_by_colour(drawing);
        for entry in &self.entries {
            let layers = drawing.layers.iter_mut().filter(|layer| entry.is_for(layer));
            for layer in layers.collect::<Vec<_>>() {
                entry.give(layer, profile)?;
                if let Some(seconds) = entry.pen.dwell {
                    self.dwell.insert(layer.pen, seconds);
                }
                let Some(width) = entry.width else { continue };
                if self.nibs.by_pen.insert(layer.pen, width).is_some_and(|other| other != width) {
                    return Err(Failure::Usage(format!("--pens gives pen {} two widths", layer.pen)));
                }
            }
        }
        if let Some(profile) = profile {
            refuse_colours(drawing, profile, self.entries.is_empty())?;
        }
        Ok(painting)
    }

    /// Nibs by pen; a pen of which only the slot was told has the usual one.
    pub(super) const fn nibs(&self) -> &Nibs {
        &self.nibs
    }

    /// How long touches of a pen rest, where it was told.
    pub(super) fn dwell(&self, pen: u32) -> Option<f64> {
        self.dwell.get(&pen).copied()
    }

    /// Marks of layers that no entry names go to layers of the nearest colour's entry. Returns the order in which they were painted.
    fn sort_by_colour(&self, drawing: &mut Drawing) -> Vec<Painted> {
        let palette: Vec<(&Entry, Colour)> = self.entries.iter().filter_map(|entry| Some((entry, entry.colour?))).collect();
        if palette.is_empty() {
            return drawing.painting_order();
        }
        let mut sorted: Vec<Layer> = Vec::new();
        let mut painting = Vec::new();
        for layer in std::mem::take(&mut drawing.layers) {
            if self.entries.iter().any(|entry| entry.is_for(&layer)) {
                painting.extend((0..layer.marks.len()).map(|mark| Painted::Mark { layer: sorted.len(), mark }));
                sorted.push(layer);
                continue;
            }
            for mark in &layer.marks {
                let colour = mark.colour().unwrap_or(layer.ink.colour());
                let nearest =
                    palette.iter().enumerate().min_by(|(_, a), (_, b)| colour.difference(a.1).total_cmp(&colour.difference(b.1)));
                let Some((i, (entry, ink))) = nearest else { continue };
                let number = entry.slot().unwrap_or(i as u32 + 1);
                let at = sorted.iter().position(|known| known.name == entry.key).unwrap_or_else(|| {
                    let empty = Layer {
                        marks: Vec::new(),
                        ink: Ink::Colour(*ink),
                        pen: number,
                        name: entry.key.clone(),
                        ..layer.clone()
                    };
                    sorted.push(empty);
                    sorted.len() - 1
                });
                painting.push(Painted::Mark { layer: at, mark: sorted[at].marks.len() });
                sorted[at].marks.push(in_layer_s_ink(mark));
            }
        }
        drawing.layers = sorted;
        painting
    }
}

impl Entry {
    fn give(&self, layer: &mut Layer, profile: Option<&Profile>) -> Result<(), Failure> {
        layer.pen = self.pen.slot.unwrap_or(layer.pen);
        if let Some(colour) = self.colour {
            layer.ink = Ink::Colour(colour);
            layer.marks = layer.marks.iter().map(in_layer_s_ink).collect();
        }
        if let (Some(speed), Some(profile)) = (self.pen.speed, profile) {
            let percent = 100.0 * speed / profile.motion.draw_speed;
            if !(1.0..=200.0).contains(&percent) {
                return Err(Failure::Usage(format!(
                    "--pens gives '{}' {speed} mm/s, and the machine draws at {} mm/s: it must be from 1 to 200 % of that; see --speed",
                    self.key, profile.motion.draw_speed
                )));
            }
            layer.handling.speed_percent = Some(percent);
        }
        Ok(())
    }
}

/// A mark without a colour of its own.
fn in_layer_s_ink(mark: &Mark) -> Mark {
    let mut mark = mark.clone();
    match &mut mark {
        Mark::Dot(dot) => dot.colour = None,
        Mark::Stroke(stroke) => stroke.colour = None,
        Mark::Area(area) => area.colour = None,
    }
    mark
}

/// More colours than pens are never drawn with one pen in silence.
fn refuse_colours(drawing: &Drawing, profile: &Profile, are_unmapped: bool) -> Result<(), Failure> {
    let most = match profile.pens.change {
        PenChange::Machine => profile.pens.count,
        PenChange::Pause => profile.pens.count.max(MOST_CHANGES),
    };
    let of = |layer: &Layer| layer.marks.iter().map(|mark| mark.colour().unwrap_or(layer.ink.colour())).collect::<BTreeSet<_>>();
    let colours: BTreeSet<Colour> = drawing.layers.iter().flat_map(of).collect();
    if are_unmapped && colours.len() as u32 > most {
        return Err(Failure::Work(format!(
            "the drawing has {} colours, and {} holds {}: map them with --pens FILE, where each goes to the pen of the nearest colour",
            colours.len(),
            profile.name,
            if profile.pens.count == 1 { "1 pen".to_owned() } else { format!("{} pens", profile.pens.count) }
        )));
    }
    for layer in &drawing.layers {
        let count = of(layer).len();
        if count > 1 {
            eprintln!(
                "drypoint: warning: layer '{}' has {count} colours and is drawn with pen {}; --pens maps colours to pens",
                layer.name, layer.pen
            );
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Dot, Page};
    use crate::geometry::Point;

    #[test]
    fn marks_sorted_by_pens_keep_their_painting_order() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "[blue]\ncolour = \"blue\"\nslot = 1\n[red]\ncolour = \"red\"\nslot = 2\n").unwrap();
        let mut pens = PenSet::read(file.path().to_str(), 0.3, None).unwrap();
        let mut layer = Layer::new("strokes", 1);
        for colour in ["#1010f0", "#f01010", "#2020ff", "#ff3030"] {
            let dot = Dot { colour: Some(colour.parse().unwrap()), ..Dot::circle(Point::new(5.0, 5.0), 2.0) };
            layer.marks.push(Mark::Dot(dot));
        }
        let mut drawing = Drawing { page: Page::new(10.0, 10.0), layers: vec![layer] };
        let painting = pens.assign(&mut drawing, None).unwrap();
        let mark = |layer, mark| Painted::Mark { layer, mark };
        assert_eq!(painting, [mark(0, 0), mark(1, 0), mark(0, 1), mark(1, 1)]);
        assert_eq!(drawing.layers.iter().map(|layer| layer.pen).collect::<Vec<_>>(), [1, 2]);
    }
}
