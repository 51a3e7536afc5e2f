//! `--pens`: the pen in each holder, and the layer or colour that it draws.
//!
//! ```toml
//! [dots]              # a layer's name, or its pen's number
//! width = "0.3mm"     # of the nib
//! slot = 2            # where the machine holds it
//! colour = "navy"     # for previews; layers without an entry go to the entry with the nearest colour
//! speed = 30          # mm/s
//! dwell = 0.1         # seconds that the pen rests on a touch
//! offset = [0.1, 0]   # offset of its ink, mm along the machine's axes
//! ```

use super::failure::Failure;
use super::few_pens::{PenAssignment, fit_to_pens, warn_of_colours};
use super::messages::warning_line;
use super::output;
use super::pen_file::{PenEntry, read_pens};
use crate::drawing::{Colour, Drawing, Layer, Mark, Painted};
use crate::plot::{Nibs, PenSlot, Profile};
use std::collections::BTreeMap;

/// The entries of `--pens`, and defaults for all other pens.
#[derive(Debug)]
pub(super) struct PenSet {
    entries: Vec<PenEntry>,
    nibs: Nibs,
    dwell: BTreeMap<u32, f64>,
}

impl PenEntry {
    fn is_for(&self, layer: &Layer) -> bool {
        self.key == layer.name || self.key == layer.pen.to_string()
    }

    /// Its slot, if that does not depend on the layer.
    pub(super) fn fixed_slot(&self) -> Option<u32> {
        self.slot.or_else(|| self.key.parse().ok())
    }
}

impl PenSet {
    /// Reads `--pens`; `usual` is the nib width of other pens. Calibrated offsets are set in the profile.
    pub(super) fn read(file: Option<&str>, usual: f64, profile: Option<&mut Profile>) -> Result<Self, Failure> {
        let mut set = Self { entries: Vec::new(), nibs: Nibs::all(usual), dwell: BTreeMap::new() };
        set.nibs.swell = profile.as_ref().and_then(|profile| profile.swell.clone());
        let Some(file) = file else { return Ok(set) };
        set.entries = read_pens(file, &output::read_settings(file)?)?;
        if let Some(profile) = profile {
            for entry in &set.entries {
                if let (Some(offset), Some(slot)) = (entry.offset, entry.fixed_slot()) {
                    let pen_life = profile.life_of(slot);
                    profile.pen.retain(|pen| pen.slot != slot);
                    profile.pen.push(PenSlot { slot, offset, pen_life });
                }
            }
        }
        Ok(set)
    }

    /// Gives every layer its pen: by name or number, else by the nearest colour; without `--pens`, the machine's pens, with a warning
    /// that names merged colours. Returns the marks in the painting order from before they were sorted by pens.
    pub(super) fn assign(&mut self, drawing: &mut Drawing, profile: Option<&Profile>) -> Result<Vec<Painted>, Failure> {
        let handed = self.assign_pens(drawing, profile)?;
        if profile.is_some() {
            handed.merge_notice.iter().for_each(|notice| warning_line(notice));
            warn_of_colours(drawing);
        }
        Ok(handed.painting)
    }

    /// The same without warnings, for trial drawings.
    pub(super) fn assign_pens(&mut self, drawing: &mut Drawing, profile: Option<&Profile>) -> Result<PenAssignment, Failure> {
        let painting = self.sort_by_colour(drawing);
        for entry in &self.entries {
            let layers = drawing.layers.iter_mut().filter(|layer| entry.is_for(layer));
            for layer in layers.collect::<Vec<_>>() {
                entry.give(layer, profile)?;
                if let Some(seconds) = entry.dwell {
                    self.dwell.insert(layer.pen, seconds);
                }
                let Some(width) = entry.width else { continue };
                if self.nibs.by_pen.insert(layer.pen, width).is_some_and(|other| other != width) {
                    return Err(Failure::Usage(format!("--pens gives pen {} two widths", layer.pen)));
                }
            }
        }
        let fitted = profile.filter(|_| self.entries.is_empty()).and_then(|profile| fit_to_pens(drawing, profile));
        Ok(fitted.unwrap_or(PenAssignment { painting, merge_notice: None }))
    }

    /// Nib widths by pen; the default for pens without a width.
    pub(super) const fn nibs(&self) -> &Nibs {
        &self.nibs
    }

    /// Dwell of touches in seconds, for the pens that have one.
    pub(super) const fn dwell(&self) -> &BTreeMap<u32, f64> {
        &self.dwell
    }

    /// Moves marks of layers without an entry to the layer of the entry with the nearest colour. Returns the painting order.
    fn sort_by_colour(&self, drawing: &mut Drawing) -> Vec<Painted> {
        let palette: Vec<(&PenEntry, Colour)> = self.entries.iter().filter_map(|entry| Some((entry, entry.colour?))).collect();
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
            for mut mark in layer.marks.iter().cloned() {
                let colour = mark.colour().unwrap_or(layer.ink.colour());
                let nearest =
                    palette.iter().enumerate().min_by(|(_, a), (_, b)| colour.difference(a.1).total_cmp(&colour.difference(b.1)));
                let Some((i, (entry, ink))) = nearest else { continue };
                let number = entry.fixed_slot().unwrap_or(i as u32 + 1);
                let at = sorted.iter().position(|known| known.name == entry.key).unwrap_or_else(|| {
                    let empty =
                        Layer { marks: Vec::new(), ink: entry.ink(*ink), pen: number, name: entry.key.clone(), ..layer.clone() };
                    sorted.push(empty);
                    sorted.len() - 1
                });
                painting.push(Painted::Mark { layer: at, mark: sorted[at].marks.len() });
                drop_own_colour(&mut mark);
                sorted[at].marks.push(mark);
            }
        }
        drawing.layers = sorted;
        painting
    }
}

impl PenEntry {
    fn give(&self, layer: &mut Layer, profile: Option<&Profile>) -> Result<(), Failure> {
        layer.pen = self.slot.unwrap_or(layer.pen);
        if self.colour.is_some() || self.plate.is_some() {
            layer.ink = self.ink(self.colour.unwrap_or(layer.ink.colour()));
            layer.marks.iter_mut().for_each(drop_own_colour);
        }
        if let (Some(speed), Some(profile)) = (self.speed, profile) {
            let fastest = profile.motion.fastest_drawing();
            if speed > fastest {
                let (key, name) = (&self.key, &profile.name);
                return Err(Failure::Usage(format!(
                    "--pens gives '{key}' {speed} mm/s, and {name} draws at {fastest} mm/s at most"
                )));
            }
            let percent = 100.0 * speed / profile.motion.draw_speed;
            if !(1.0..=200.0).contains(&percent) {
                return Err(Failure::Usage(format!(
                    "--pens gives '{}' {speed} mm/s, and the machine draws at {} mm/s; it must be from 1 to 200 % of that; see --speed",
                    self.key, profile.motion.draw_speed
                )));
            }
            layer.handling.speed_percent = Some(percent);
        }
        Ok(())
    }
}

/// Takes a mark's own colour away.
pub(super) fn drop_own_colour(mark: &mut Mark) {
    match mark {
        Mark::Dot(dot) => dot.colour = None,
        Mark::Stroke(stroke) => stroke.colour = None,
        Mark::Area(area) => area.colour = None,
    }
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
