//! `--colours`: the pens in whose colours a photograph is drawn.

use super::arguments::{ListOptions, PictureOptions};
use super::failure::Failure;
use super::messages::warning;
use super::output;
use super::pen_file::{PenEntry, read_pens};
use crate::colour::{
    ColourPen, KnownPen, Lab, Opacity, Overlap, Overprint, Paper, PenSet, PensError, Separator, Settings, choose, drawing_order,
    known_pens, on_screen,
};
use crate::drawing::{Colour, Drawing, Ink, Layer, Mixing, Page};
use crate::plot::Nibs;
use crate::raster::Raster;
use crate::source::Portrait;
use serde_json::json;

/// The pens, in the order in which they are drawn: light ones first.
pub(super) struct Palette {
    pens: PenSet,
    /// Where the machine holds each.
    numbers: Vec<u32>,
    /// What each is printed with.
    inks: Vec<Ink>,
    paper: Colour,
    separator: Separator,
    /// What was chosen, if not all pens.
    pub choice: Option<String>,
}

/// Styles whose marks are long lines or smudges, which do not share their place: each pen draws for itself, and its marks cross those
/// of the others by chance.
pub(super) const APART: [&str; 2] = ["engrave", "charcoal"];
/// How many pens draw for themselves at the same time: parts of each have to wait for one another. More only take memory.
pub(super) const AT_ONCE: usize = 2;

impl Palette {
    /// Reads and checks the pens; none if the photograph is not drawn in colours. `light` is the photograph, linear sRGB, for which
    /// pens are chosen if not all are taken.
    pub(super) fn read(
        options: &PictureOptions,
        light: impl FnOnce() -> Result<Raster<[f32; 3]>, Failure>,
    ) -> Result<Option<Self>, Failure> {
        let Some(file) = &options.colours else { return Ok(None) };
        let mut entries = read_pens(file, &output::read_settings(file)?)?;
        check_overprints(file, &entries)?;
        let about = |problem: &dyn std::fmt::Display| Failure::Work(format!("{file}: {problem}"));
        let paper = Paper::new(options.paper);
        let mut pens: Vec<ColourPen> =
            entries.iter().map(|entry| pen_of(entry, paper).map_err(|why| about(&why))).collect::<Result<_, _>>()?;
        let overlap = if APART.contains(&options.style.as_str()) { Overlap::Random } else { Settings::default().overlap };
        let settings =
            Settings { black: options.black_pen, overlap, simplify: options.colours_simplify as f32, ..Settings::default() };
        let mut choice = None;
        if let Some(count) = options.choose.map(usize::from).filter(|count| *count < pens.len()) {
            let chosen = choose(&pens, paper, &settings, &light()?, count).map_err(|error| about(&error))?;
            let of = pens.len();
            (entries, pens) =
                entries.into_iter().zip(pens).enumerate().filter(|(i, _)| chosen.contains(i)).map(|(_, pen)| pen).unzip();
            // What was measured with all pens says nothing of some.
            entries.iter_mut().for_each(|entry| entry.over_all = None);
            choice = Some(format!("{count} of {of} pens chosen: {}", names(&pens)));
        }
        let order = drawing_order(&pens);
        let numbers = numbers(order.iter().map(|pen| &entries[*pen]));
        let inks = order.iter().map(|pen| entries[*pen].ink(shown_colour(&pens[*pen], paper))).collect();
        let measured = overprints(&order, &entries);
        for told in unused_overprints(&order, &entries) {
            warning!("{file}: {told}");
        }
        let pens = order.into_iter().map(|pen| pens[pen].clone()).collect();
        let pens = PenSet::new(pens, paper, measured).map_err(|error| match error {
            PensError::TooMany(_) => about(&format!("{error}: --choose 4")),
            error => about(&error),
        })?;
        for told in pens.warnings() {
            warning!("{file}: {told}");
        }
        let separator = Separator::new(&pens, &settings).map_err(|error| about(&error))?;
        Ok(Some(Self { pens, numbers, inks, paper: options.paper, separator, choice }))
    }

    /// How much of the paper each pen covers, 0 to 1, on the portrait's grid.
    pub(super) fn separate(&self, portrait: &Portrait) -> Vec<Raster<f32>> {
        self.separator.separate(&portrait.subject_light()).coverages
    }

    /// An empty layer for each pen.
    pub(super) fn layers(&self) -> Vec<Layer> {
        let layer =
            |((pen, number), ink): ((&ColourPen, &u32), &Ink)| Layer { ink: ink.clone(), ..Layer::new(&pen.name, *number) };
        self.pens.pens().iter().zip(&self.numbers).zip(&self.inks).map(layer).collect()
    }

    /// Gives the pens' layers their inks, which are measured better than the file's `colour` says.
    pub(super) fn ink(&self, drawing: &mut Drawing) {
        for layer in &mut drawing.layers {
            let mut inks = self.pens.pens().iter().zip(&self.inks);
            inks.find(|(pen, _)| pen.name == layer.name).into_iter().for_each(|(_, ink)| layer.ink = ink.clone());
        }
    }

    /// For print: the layers of opaque pens cover what lies below. A plotter draws all ink.
    pub(super) fn cover(&self, drawing: &mut Drawing) {
        let is_opaque = |name: &str| self.pens.pens().iter().any(|pen| pen.name == name && pen.opacity == Opacity::Opaque);
        let layers = drawing.layers.iter_mut().filter(|layer| is_opaque(&layer.name));
        layers.for_each(|layer| layer.mixing = Mixing::Paint);
    }

    /// The drawing of the pens that have anything to draw, on their paper; none if no pen has.
    pub(super) fn drawing(&self, page: Page, mut layers: Vec<Layer>) -> Option<Drawing> {
        layers.retain(|layer| !layer.marks.is_empty());
        let page = Page { paper: self.paper, ..page };
        (!layers.is_empty()).then_some(Drawing { page, layers })
    }

    /// The pen that draws lines: black, or the darkest.
    pub(super) fn line_pen(&self) -> usize {
        let last = self.pens.pens().iter().rposition(|pen| pen.opacity == Opacity::Transparent);
        self.pens.black().or(last).unwrap_or(0)
    }
}

/// What each pen lays down: its ink, the length of line that its nib draws for that, and its share.
pub(super) fn explained(drawing: &Drawing, nibs: &Nibs) -> Vec<String> {
    let inks = drawing.ink_mm2();
    let all: f64 = inks.iter().sum();
    let line = |(layer, ink): (&Layer, &f64)| {
        let (name, nib) = (&layer.name, nibs.of(layer.pen));
        let metres = ink / nib / 1000.0;
        format!(
            "  pen {} {name}: {ink:.0} mm2 of ink, {metres:.1} m of line {nib} mm wide, {:.0} % of the ink",
            layer.pen,
            100.0 * ink / all
        )
    };
    drawing.layers.iter().zip(&inks).map(line).collect()
}

/// The ink's colour in files: a transparent one without the paper, on which it is multiplied.
pub(super) fn shown_colour(pen: &ColourPen, paper: Paper) -> Colour {
    const LEAST: f64 = 0.001;
    let bare = if pen.opacity == Opacity::Opaque { Paper::WHITE } else { paper };
    on_screen([0, 1, 2].map(|i| pen.colour[i] / bare.colour[i].max(LEAST)))
}

fn names(pens: &[ColourPen]) -> String {
    pens.iter().map(|pen| pen.name.as_str()).collect::<Vec<_>>().join(", ")
}

/// The number of each pen: its slot, else the lowest that no slot has taken.
pub(super) fn numbers<'a>(entries: impl Iterator<Item = &'a PenEntry> + Clone) -> Vec<u32> {
    let taken: Vec<u32> = entries.clone().filter_map(PenEntry::fixed_slot).collect();
    let mut free = (1_u32..).filter(|number| !taken.contains(number));
    entries.map(|entry| entry.fixed_slot().or_else(|| free.next()).unwrap_or(1)).collect()
}

/// A pen as an ink on the paper: measured there, or known on white paper, through which a transparent ink shows another one.
pub(super) fn pen_of(entry: &PenEntry, paper: Paper) -> Result<ColourPen, String> {
    const USUAL_WIDTH: f64 = 0.3;
    let width = entry.width.unwrap_or(USUAL_WIDTH);
    let pen = match (entry.lab, entry.colour) {
        (Some([l, a, b]), _) => ColourPen::measured(&entry.key, width, Lab { l, a, b }),
        (None, Some(colour)) if entry.is_opaque => ColourPen::new(&entry.key, width, colour),
        (None, Some(colour)) => {
            let pen = ColourPen::new(&entry.key, width, colour);
            let colour = [0, 1, 2].map(|i| pen.colour[i] * paper.colour[i]);
            ColourPen { colour, ..pen }
        }
        (None, None) => {
            return Err(format!("[{}] needs its colour on this paper: colour = \"#1f77b4\", or lab = [L, a, b]", entry.key));
        }
    };
    Ok(if entry.is_opaque { pen.opaque() } else { pen })
}

/// Overprints that were measured, of pens in this drawing order: of pairs, and of all pens. Only a pen that
/// is drawn later lies over another.
fn overprints(order: &[usize], entries: &[PenEntry]) -> Vec<Overprint> {
    let colour = |[l, a, b]: [f64; 3]| Lab { l, a, b }.to_rgb();
    let place = |key: &str| order.iter().position(|pen| entries[*pen].key == key);
    let of_pen = |(upper, pen): (usize, &usize)| {
        let over = entries[*pen].over.iter();
        let lower = over.filter_map(move |(key, colour)| Some((place(key).filter(|lower| *lower < upper)?, *colour)));
        lower.map(move |(lower, lab)| Overprint { pens: vec![lower, upper], colour: colour(lab) })
    };
    let last = order.last().filter(|_| order.len() > 2).and_then(|last| entries[*last].over_all);
    let of_all = last.map(|lab| Overprint { pens: (0..order.len()).collect(), colour: colour(lab) });
    order.iter().enumerate().flat_map(of_pen).chain(of_all).collect()
}

/// What was measured of a pen over pens that are drawn after it.
fn unused_overprints(order: &[usize], entries: &[PenEntry]) -> Vec<String> {
    let drawn: Vec<&PenEntry> = order.iter().map(|pen| &entries[*pen]).collect();
    let of_pen = |(i, pen): (usize, &&PenEntry)| {
        let mut later = drawn[i + 1..].iter().map(|later| &later.key);
        let over = later.clone().filter(|later| pen.over.iter().any(|(key, _)| key == *later));
        let pair = |later| format!("[{}] is drawn before [{later}], so its colour over '{later}' is not used", pen.key);
        let all = later.next_back().filter(|_| pen.over_all.is_some());
        let all = all.map(|last| format!("over_all of [{}] is not used, as [{last}] is drawn last; give it there", pen.key));
        over.map(pair).chain(all).collect::<Vec<_>>()
    };
    drawn.iter().enumerate().flat_map(of_pen).collect()
}

/// Refuses an overprint with a pen that is not in the file.
fn check_overprints(file: &str, entries: &[PenEntry]) -> Result<(), Failure> {
    let is_known = |key: &str| entries.iter().any(|entry| entry.key == key);
    let mut pairs = entries.iter().flat_map(|entry| entry.over.iter().map(move |(key, _)| (&entry.key, key)));
    pairs.find(|(_, key)| !is_known(key)).map_or(Ok(()), |(pen, key)| {
        Err(Failure::Work(format!(
            "{file}: [{pen}] has a colour over '{key}', which is no pen of this file; name its table as it stands there"
        )))
    })
}

/// `drypoint pens`: the pens whose colour is known, or those whose name holds a word.
pub(super) fn list(options: &ListOptions) -> Result<(), Failure> {
    let wanted = options.name.as_deref().unwrap_or_default().to_lowercase();
    let name = |pen: &KnownPen| format!("{} {}", pen.maker, pen.name);
    let found: Vec<KnownPen> = known_pens().into_iter().filter(|pen| name(pen).to_lowercase().contains(&wanted)).collect();
    if found.is_empty() {
        return Err(Failure::Usage(format!("no pen's name holds '{wanted}'; `drypoint pens` lists all")));
    }
    if options.json {
        let pen = |pen: &KnownPen| {
            json!({ "maker": pen.maker, "name": pen.name, "width_mm": pen.width_mm, "colour": pen.colour.to_string(),
                "opaque": pen.opacity == Opacity::Opaque, "source": pen.source })
        };
        return output::print_json(&json!({ "pens": found.iter().map(pen).collect::<Vec<_>>() }));
    }
    let line = |pen: &KnownPen| format!("{:40} {} {} mm\n", name(pen), pen.colour, pen.width_mm);
    let note = "Colours are estimates, on white paper; `drypoint pens --json` gives their sources.\n";
    output::to_stdout((found.iter().map(line).collect::<String>() + note).as_bytes())
}
