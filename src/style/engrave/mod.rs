//! The engraving: parallel lines, bent over the form by depth, that swell in dark tones, cross in the darkest and break into dots in
//! light ones (Galarza 2017).

mod angles;
mod breaks;
mod cost;
mod depths;
mod form;
mod lines;
mod merging;
mod outline;
mod parameters;
mod presence;
mod region_map;
mod regions;
mod relief;
mod rim;
mod span;
mod spans;
mod strokes;
mod tones;
mod widths;

use super::{Cost, Observer, Picture, Request, Settings, Style, StyleCard, StyleError};
use crate::drawing::{Colour, Drawing, Layer, Mark};
use crate::geometry::{Point, Rect};
use crate::parallel::{collected, mapped};
use crate::raster::Raster;
use crate::source::{MaskRole, Portrait, Prepared};
use breaks::LineBreaks;
use lines::{Family, FamilyLayout, Frame};
use parameters::{CARD, EngraveParameters, GroundColour, Look, ToneFrom};
use region_map::{Region, RegionMap};
use relief::Relief;
use tones::Layers;
use widths::{LineReadings, Wanted};

/// An engraving's lines are unbroken from this share of the ink at which they are crossed: at 1 the cuts begin beside the crossings and
/// cloth at half tone is speckled with both.
const WHOLE_LINES: f64 = 0.75;

/// The style.
pub(super) struct Engrave;

impl Style for Engrave {
    fn card(&self) -> &StyleCard {
        &CARD
    }

    fn pixels_per_mm(&self, settings: &Settings, masks: &[MaskRole]) -> f64 {
        EngraveParameters::new(settings).pixels_per_pitch(masks) / settings.number("pitch")
    }

    fn cost(&self, settings: &Settings, picture: Rect, pixels_per_mm: f64) -> Cost {
        cost::cost(&EngraveParameters::new(settings), picture, pixels_per_mm)
    }

    fn prepare(&self, portrait: &mut Portrait, settings: &Settings, seed: u64, observer: &dyn Observer) {
        let request = Request { portrait, settings, seed, observer };
        let drawer = request.drawer(EngraveParameters::new(settings));
        if !drawer.follows_form() {
            portrait.prepared = Prepared::new(drawer.new_relief());
        }
    }

    fn sketch(&self, request: &Request<'_>) -> Result<Drawing, StyleError> {
        request.drawer(EngraveParameters::new(request.settings)).draw()
    }
}

type Drawer<'a> = super::Drawer<'a, EngraveParameters>;

/// Marks of the lines and of the cross lines.
type Marks = [Vec<Mark>; 2];

impl Drawer<'_> {
    /// The thesis' steps in order.
    fn draw(&self) -> Result<Drawing, StyleError> {
        if self.follows_form() {
            return self.draw_form();
        }
        let relief = self.relief();
        let ink = self.ink(&relief);
        self.observer.picture("tone", &|| Picture::Grey(ink.map(|v| 1.0 - v)));
        if ink.pixels().iter().all(|&v| v <= 0.0) {
            let why = "the picture, or the part inside the subject mask and with a known depth, needs no ink anywhere";
            return Err(StyleError::NothingToDraw(why.to_owned()));
        }
        let layers = tones::layers(&ink, self.parameters.look, self.parameters.threshold);
        self.observer.picture("tone-of-lines", &|| Picture::Grey(layers.lines.map(|v| 1.0 - v)));
        if let Some(cross) = &layers.cross {
            self.observer.picture("tone-of-cross-lines", &|| Picture::Grey(cross.map(|v| 1.0 - v)));
        }
        let ground = self.ground(&relief);
        self.observer.picture("regions", &|| Picture::Labels(ground.labels.clone()));
        self.check()?;
        self.observer.begin("lines");
        let marks = self.all_regions(&ground, &relief, &layers);
        self.check()?;
        let mut drawing = self.drawing(marks);
        if self.parameters.has_outline {
            drawing.layers.push(self.outlines());
        }
        if self.parameters.ground == GroundColour::Black {
            drawing.page.paper = Colour { r: 0, g: 0, b: 0 };
            drawing.layers.iter_mut().flat_map(|layer| &mut layer.marks).for_each(whiten);
        }
        Ok(drawing)
    }

    /// The target ink; on black paper the lines are the light.
    fn ink(&self, relief: &Relief) -> Raster<f32> {
        let tone = if self.parameters.tone_from == ToneFrom::Depth {
            self.lit(relief)
        } else {
            self.portrait.on_white(&self.portrait.tone)
        };
        let ink = if self.parameters.ground == GroundColour::Black { tone } else { tone.map(|t| 1.0 - t) };
        ink.zip_map(&relief.cover, |ink, cover| if cover >= 0.02 { ink } else { 0.0 })
    }

    /// Every region's marks, in the order of the regions.
    fn all_regions(&self, ground: &RegionMap, relief: &Relief, layers: &Layers) -> Marks {
        let regions: Vec<Marks> = mapped(&ground.regions, &|region| self.region(*region, ground, relief, layers));
        let mut all: Marks = [Vec::new(), Vec::new()];
        for marks in regions {
            for (all, marks) in all.iter_mut().zip(marks) {
                all.extend(marks);
            }
        }
        all
    }

    fn region(&self, region: Region, ground: &RegionMap, relief: &Relief, layers: &Layers) -> Marks {
        let bases = |turn| self.bases(region, region.angle + turn, ground, relief);
        let (family, crossing) = rayon::join(
            || bases(0.0).in_full(),
            // Without cross lines only places between its base lines are asked for.
            || {
                if layers.cross.is_some() {
                    bases(self.parameters.cross_angle).in_full()
                } else {
                    bases(self.parameters.cross_angle)
                }
            },
        );
        let wanted = |ink, turn| Wanted { ground, region, turn, ink, width_max: self.parameters.width_max.0 };
        let breaking = self.breaking(ground);
        let lines = || {
            let breaking = LineBreaks { between: &crossing, ..breaking(&crossing) };
            marks(&LineReadings::new(&family, wanted(&layers.lines, 0.0)), &breaking)
        };
        let cross = || {
            layers.cross.as_ref().map_or_else(Vec::new, |ink| {
                let breaking = LineBreaks {
                    cover: Some(&layers.lines),
                    interruption: None,
                    is_staggered: false,
                    period: 1.0,
                    ..breaking(&family)
                };
                marks(&LineReadings::new(&crossing, wanted(ink, self.parameters.cross_angle)), &breaking)
            })
        };
        let (lines, cross) = rayon::join(lines, cross);
        [lines, cross]
    }

    /// The base lines of a region.
    fn bases(&self, region: Region, angle: f64, ground: &RegionMap, relief: &Relief) -> Family {
        let p = &self.parameters;
        let range = [0.0, p.displacement.0];
        let laying = FamilyLayout {
            pitch: p.pitch.0,
            sampling: p.sampling.0,
            min_gap: p.min_gap.0,
            displaced: (range[0].min(range[1]), range[0].max(range[1])),
        };
        let displacement = |place: Point| p.displacement.0 * f64::from(ground.grid.read(&relief.nearness, place));
        Family::new(Frame::new(angle), region.bounds, laying, displacement)
    }

    fn breaking<'b>(&self, ground: &RegionMap) -> impl Fn(&'b Family) -> LineBreaks<'b> {
        let p = &self.parameters;
        let (look, grid) = (p.look, ground.grid);
        let (thinnest, dot_min, threshold) = (p.thinnest.0, p.dot_min.0, p.threshold);
        // Stipples have the same spacing along a line as across.
        let (cut_out, period) = (p.cut_out, if look == Look::Stipple { 1.0 } else { (p.dash / p.pitch).max(0.25) });
        move |between| LineBreaks {
            between,
            period,
            is_staggered: look != Look::Engraving,
            cover: None,
            grid,
            thinnest,
            interruption: (look == Look::Engraving).then_some((WHOLE_LINES * (1.0 - threshold), cut_out)),
            is_stippled: look == Look::Stipple,
            dot_min,
        }
    }

    fn drawing(&self, [lines, cross]: Marks) -> Drawing {
        let mut layers = vec![Layer::new("lines", 1)];
        layers[0].marks = lines;
        if !cross.is_empty() {
            layers.push(Layer::new("cross lines", 1));
            layers[1].marks = cross;
        }
        Drawing { page: self.portrait.page, layers }
    }
}

/// The marks of every line, in order.
fn marks(courses: &LineReadings<'_>, breaking: &LineBreaks<'_>) -> Vec<Mark> {
    let of_line = |k: usize| -> Vec<Mark> {
        let line = &courses.family.lines[k];
        breaking.pieces(courses, k).iter().filter_map(|piece| strokes::mark(courses.family, line, piece)).collect()
    };
    let lines: Vec<Vec<Mark>> = collected(courses.lines.len(), &of_line);
    lines.into_iter().flatten().collect()
}

fn whiten(mark: &mut Mark) {
    match mark {
        Mark::Dot(dot) => dot.colour = Some(Colour::WHITE),
        Mark::Stroke(stroke) => stroke.colour = Some(Colour::WHITE),
        Mark::Area(area) => area.colour = Some(Colour::WHITE),
    }
}
