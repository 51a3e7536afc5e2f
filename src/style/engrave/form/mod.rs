//! Lines that follow the form of a face, as engravers of banknotes lay them: one family over the surface, a second and a third across
//! it where it is darker, dots in line where light breaks it.
//!
//! ```text
//!   surfaces     skin, hair, cloth: each has lines of its own, which end at its border
//!   roots        where hair begins among the lines of skin
//!   directions   from the face's mesh, along locks, along folds
//!   families     even lines along the directions, and turned from them
//!   shares       ink of each family for the tone
//!   runs         pieces of lines with their widths
//!   hooks        strokes of coiled hair
//!   tone         widths corrected until the ink drawn is the ink wanted
//! ```

mod contour;
mod correction;
mod families;
mod hooks;
mod ink;
#[cfg(test)]
mod measures;
mod roots;
mod runs;
mod shares;
mod specks;

use super::Drawer;
use super::parameters::Look;
use crate::drawing::{Drawing, Layer, Mark};
use crate::geometry::Rect;
use crate::parallel::collected;
use crate::raster::{Raster, dilate};
use crate::source::Placement;
use crate::style::form::{Directions, Surface};
use crate::style::solids::{Solids, detail_zone};
use crate::style::{Picture, StyleError};
use correction::TONE_ROUNDS;
use families::{Closeness, Extent, FINE, Family};
use runs::{Course, Piece};

/// The turns of the second and the third family in degrees. At -60 the third makes honeycombs with the second.
const TURNS: [f64; 3] = [0.0, 60.0, -37.0];
/// In hair lines cross at half the angle: steeper ones look woven.
const HAIR_TURN: f64 = 0.5;
/// Widths of the lines of mouths, lids and jaws, as shares. A jaw of full width looks like a wire among the fine lines of skin (portraits 10, 12
/// and 13).
const MOUTH: f64 = 0.85;
const LIDS: f64 = 0.8;
const JAW: f64 = 0.5;
/// Lines of hair stand this much closer.
const HAIR_CLOSENESS: f32 = 1.08;
/// How far lines are laid beyond a surface's border, in pitches, so that they are even at it.
const ROOM: f64 = 3.0;
/// Share of a surface from which it has lines.
const LEAST_SHARE: f32 = 0.02;

/// The pieces of the three families.
type Pieces = [Vec<Piece>; 3];

impl Drawer<'_> {
    /// True if the lines follow the form: a face is known, and nothing asks for lines of another kind.
    pub(super) fn follows_form(&self) -> bool {
        !self.portrait.faces.is_empty()
            && self.portrait.scribbles.is_none()
            && !self.portrait.has_given_depth()
            && self.parameters.may_follow_form()
    }

    pub(super) fn draw_form(&self) -> Result<Drawing, StyleError> {
        let detail = detail_zone(self.portrait, self.pitch());
        let firm = self.without_brows(&detail);
        let ink = self.form_ink(&firm);
        self.observer.picture("tone", &|| Picture::Grey(ink.map(|v| 1.0 - v)));
        if ink.pixels().iter().all(|&v| v <= 0.0) {
            let why = "the picture, or the part inside the subject mask, needs no ink anywhere";
            return Err(StyleError::NothingToDraw(why.to_owned()));
        }
        self.observer.begin("directions");
        let surfaces = self.surfaces(&self.portrait.subject);
        let directions = self.directions(&surfaces);
        let ink = self.with_half_tones(&ink, &surfaces.skin, &detail);
        let ink = self.portrait.opened(self.with_locks(&ink, &surfaces.hair, directions.of(Surface::Hair)));
        let solids = Solids::new(self.portrait, &ink, self.pitch());
        let (portrait, pitch) = (self.portrait, self.pitch());
        let solids =
            solids.with_mouths(portrait, pitch, MOUTH).with_lids(portrait, pitch, LIDS).with_jaws(portrait, pitch, JAW).layer();
        self.check()?;
        self.observer.begin("lines");
        let mut pieces: Pieces = Default::default();
        let roots = self.roots(&surfaces, directions.of(Surface::Hair));
        for surface in [Surface::Skin, Surface::Hair, Surface::Cloth] {
            let (region, mut own) = (roots.region_of(surface, &surfaces), roots.ink_of(surface, &ink));
            if surface == Surface::Hair {
                let coils = self.coiled_hair(&self.hair_of_heads(&surfaces.hair));
                pieces[0].extend(self.hooks(&coils, &region, directions.of(surface), &own));
                own = hooks::beneath(&own, &coils);
            }
            let own = self.lines_over(surface, &region, &directions, &detail, &own);
            pieces.iter_mut().zip(own).for_each(|(all, own)| all.extend(own));
            self.check()?;
        }
        specks::without_specks(&mut pieces, self.pitch());
        self.observer.begin("widths");
        for _ in 0..TONE_ROUNDS {
            self.correct(&mut pieces, &ink);
            self.check()?;
        }
        Ok(self.form_drawing(&pieces, solids, &ink))
    }

    /// The pieces of one surface's lines.
    fn lines_over(
        &self,
        surface: Surface,
        share: &Raster<f32>,
        directions: &Directions,
        detail: &Raster<f32>,
        ink: &Raster<f32>,
    ) -> Pieces {
        let turn = |family: usize| TURNS[family].to_radians() * if surface == Surface::Hair { HAIR_TURN } else { 1.0 };
        let shares = match self.parameters.look {
            Look::Hatch => [ink.clone(), ink.map(|_| 0.0), ink.map(|_| 0.0)],
            _ => shares::shares_of(ink, surface, share, self.pitch()),
        };
        let families = self.families_over(surface, share, &shares[2], detail, &|family, extent, closeness| {
            let name = format!("{surface:?} {family}");
            self.even_lines(extent, directions.of(surface), turn(family), closeness, &name)
        });
        let pieces = |family: usize| {
            let Some(own) = &families[family] else { return Vec::new() };
            let course = Course {
                family: own,
                directions: directions.of(surface),
                turn: turn(family),
                ink: &shares[family],
                region: share,
                breaks: if family == 0 { families[1].as_ref() } else { None },
                thinnest: self.parameters.thinnest / self.parameters.pitch,
                dot_min: self.pixels(self.parameters.dot_min),
                pitch: self.pitch(),
                picture: Rect::new(0.0, 0.0, ink.width() as f64, ink.height() as f64),
            };
            course.pieces()
        };
        [pieces(0), pieces(1), pieces(2)]
    }

    /// The families of a surface, each laid where it has ink; the second also breaks the first in the lights.
    fn families_over(
        &self,
        surface: Surface,
        share: &Raster<f32>,
        third: &Raster<f32>,
        detail: &Raster<f32>,
        lay: &(dyn Fn(usize, &Extent, &Closeness<'_>) -> Family + Sync),
    ) -> Vec<Option<Family>> {
        let room = (ROOM * self.pitch()) as usize;
        // Lines run on a little beyond the surface's border, where they are cut.
        let near = dilate(&share.map(|share| u8::from(share > LEAST_SHARE)), room);
        let closer = if surface == Surface::Hair { HAIR_CLOSENESS } else { 1.0 };
        let closeness = |x: usize, y: usize| if near.get(x, y) == 0 { 0.0 } else { closer / (1.0 - FINE * detail.get(x, y)) };
        let extents = [
            Extent::of(share, LEAST_SHARE, room),
            Extent::of(share, LEAST_SHARE, room),
            Extent::of(&third.zip_map(share, f32::min), 0.0, room),
        ];
        collected(3, &|family| extents[family].as_ref().map(|extent| lay(family, extent, &closeness)))
    }

    fn form_drawing(&self, pieces: &Pieces, solids: Layer, ink: &Raster<f32>) -> Drawing {
        let names = ["lines", "cross lines", "third lines"];
        let mut layers: Vec<Layer> = Vec::new();
        for (name, pieces) in names.into_iter().zip(pieces) {
            let mut layer = Layer::new(name, 1);
            layer.marks = marks(pieces.iter(), &self.portrait.placement);
            layers.push(layer);
        }
        layers.push(solids);
        layers.push(self.contour(ink));
        layers.retain(|layer| !layer.marks.is_empty());
        if self.parameters.has_outline {
            layers.push(self.outlines());
        }
        Drawing { page: self.portrait.page, layers }
    }
}

fn marks<'a>(pieces: impl Iterator<Item = &'a Piece>, placement: &Placement) -> Vec<Mark> {
    pieces.filter_map(|piece| piece.mark(placement)).collect()
}
