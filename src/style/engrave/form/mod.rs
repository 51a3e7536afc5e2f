//! Lines that follow the form of a face, as engravers of banknotes lay them: one family over the surface, a second and a third across
//! it where it is darker, dots in line where light breaks it.
//!
//! ```text
//!   surfaces     skin, hair, beard, cloth: each has lines of its own, which end at its border
//!   roots        where hair begins among the lines of skin
//!   directions   from the face's mesh, along locks, along folds
//!   families     even lines along the directions, and turned from them
//!   shares       ink of each family for the tone
//!   runs         pieces of lines with their widths
//!   hooks        strokes of coiled hair
//!   whiskers     strokes of beards over the lines of skin
//!   tone         widths corrected until the ink drawn is the ink wanted
//! ```

mod catchlights;
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
mod tapered;
mod whiskers;

use super::Drawer;
use super::parameters::Look;
use crate::drawing::{Drawing, Layer, Mark};
use crate::geometry::Rect;
use crate::parallel::{collected, mapped};
use crate::raster::{Raster, dilate, gaussian_blur};
use crate::source::Placement;
use crate::style::ears::beside_faces;
use crate::style::form::{Directions, Surface, Surfaces};
use crate::style::solids::{Solids, detail_zone};
use crate::style::{Picture, StyleError};
use catchlights::open_catchlights;
use correction::TONE_ROUNDS;
use families::{Closeness, Extent, FINE, Family};
use roots::Roots;
use runs::{Course, Piece};
use whiskers::Whiskers;

/// The turns of the second and the third family in degrees. At -60 the third makes honeycombs with the second.
const TURNS: [f64; 3] = [0.0, 60.0, -37.0];
/// In hair lines cross at half the angle: steeper ones look woven.
const HAIR_TURN: f64 = 0.5;
/// Widths of the lines of mouths, lids and jaws, as shares. A jaw of full width looks like a wire among the fine lines of skin
/// (portraits 10, 12 and 13).
const MOUTH: f64 = 0.85;
const LIDS: f64 = 0.8;
const JAW: f64 = 0.5;
/// Lines of hair stand this much closer.
const HAIR_CLOSENESS: f32 = 1.08;
/// How far lines are laid beyond a surface's border, in pitches, so that they are even at it.
const ROOM: f64 = 3.0;
/// Pixels of a picture up to which the lines of all surfaces are made together: one of 90 x 120 mm at the usual pitch has a third of them.
const TOGETHER: usize = 4_000_000;
/// Share of a surface from which it has lines.
const LEAST_SHARE: f32 = 0.02;

/// The pieces of the three families.
type Pieces = [Vec<Piece>; 3];

/// A surface with the ink of each of its families.
struct Ground {
    surface: Surface,
    /// 0 to 1.
    region: Raster<f32>,
    shares: [Raster<f32>; 3],
}

impl Ground {
    /// The angle from the directions to a family's lines, in radians.
    fn turn(&self, family: usize) -> f64 {
        TURNS[family].to_radians() * if self.surface.is_hair() { HAIR_TURN } else { 1.0 }
    }

    /// How much closer its lines stand, where they are finer by `detail`, 0 to 1.
    fn closeness(&self, detail: f32) -> f32 {
        let own = if self.surface.is_hair() { HAIR_CLOSENESS } else { 1.0 };
        own / (1.0 - FINE * detail)
    }

    /// The same where they are finest.
    fn closest(&self, detail: &Raster<f32>) -> f32 {
        /// Share of the region from which lines are seen.
        const SEEN: f32 = 0.3;
        let seen = self.region.pixels().iter().zip(detail.pixels()).filter(|(share, _)| **share > SEEN);
        self.closeness(seen.map(|(_, detail)| *detail).fold(0.0, f32::max))
    }
}

impl Drawer<'_> {
    /// True if the lines follow the form: a face is known, and nothing asks for lines of another kind.
    pub(super) fn follows_form(&self) -> bool {
        !self.portrait.faces.is_empty()
            && self.portrait.scribbles.is_none()
            && !self.portrait.has_given_depth()
            && self.parameters.may_follow_form()
    }

    pub(super) fn draw_form(&self) -> Result<Drawing, StyleError> {
        let ears = beside_faces(self.portrait, self.pitch());
        let detail = detail_zone(self.portrait, self.pitch()).zip_map(&ears, |detail, ear| detail * (1.0 - ear));
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
        let ink = self.portrait.opened(self.with_locks(&ink, &surfaces.hair, &directions.of_all_hair(&surfaces)));
        let ink = self.with_open_tufts(&self.with_hair_tips(&ink, &surfaces.hair), &surfaces.beard);
        self.check()?;
        self.observer.begin("lines");
        // Both at once: solids and contour take one thread.
        let (pieces, [solids, contour]) = rayon::join(
            || self.lines(&surfaces, &directions, &detail, &ink),
            || [self.solids(&ink), self.contour(&ink, &surfaces, &directions)],
        );
        let mut pieces = pieces?;
        specks::without_specks(&mut pieces, self.pitch());
        self.observer.begin("widths");
        for _ in 0..TONE_ROUNDS {
            self.correct(&mut pieces, &ink);
            self.check()?;
        }
        open_catchlights(&mut pieces, &self.portrait.faces, &ink, self.pitch());
        Ok(self.form_drawing(&pieces, [solids, contour]))
    }

    /// Pupils, nostrils and spectacles, and the lines of mouths, lids and jaws.
    fn solids(&self, ink: &Raster<f32>) -> Layer {
        let (portrait, pitch) = (self.portrait, self.pitch());
        let solids = Solids::new(portrait, ink, pitch).with_whole_mouths(portrait, pitch, MOUTH);
        solids.with_lids(portrait, pitch, LIDS).with_jaws(portrait, pitch, JAW).layer()
    }

    /// The pieces of all lines on skin, hair and cloth; in a large picture one after the other, as their rasters together would take twice the
    /// memory.
    fn lines(
        &self,
        surfaces: &Surfaces,
        directions: &Directions,
        detail: &Raster<f32>,
        ink: &Raster<f32>,
    ) -> Result<Pieces, StyleError> {
        let roots = self.roots(surfaces, &directions.of_all_hair(surfaces));
        let whiskers = self.whiskers(surfaces, directions.of(Surface::Beard), ink);
        let on = |surface: &Surface| {
            if *surface == Surface::Beard {
                let hairs = whiskers.as_ref().map(|whiskers| self.hairs(whiskers, directions.of(*surface), ink));
                return Ok([hairs.unwrap_or_default(), Vec::new(), Vec::new()]);
            }
            let (mut first, ground) = self.inked(*surface, surfaces, (&roots, whiskers.as_ref()), directions, ink);
            let [one, two, three] = self.lines_over(&ground, directions, detail);
            first.extend(one);
            self.check().map(|()| [first, two, three])
        };
        let all = [Surface::Skin, Surface::Hair, Surface::Beard, Surface::Cloth];
        let of_grounds: Vec<Result<Pieces, StyleError>> =
            if ink.len() <= TOGETHER { mapped(&all, &on) } else { all.iter().map(on).collect() };
        let mut pieces: Pieces = Default::default();
        for of_ground in of_grounds {
            pieces.iter_mut().zip(of_ground?).for_each(|(all, own)| all.extend(own));
        }
        Ok(pieces)
    }

    /// A surface with the ink of its families, and the strokes of coiled hair over it.
    fn inked(
        &self,
        surface: Surface,
        surfaces: &Surfaces,
        (roots, whiskers): (&Roots, Option<&Whiskers>),
        directions: &Directions,
        ink: &Raster<f32>,
    ) -> (Vec<Piece>, Ground) {
        let (region, mut own) = (roots.region_of(surface, surfaces), roots.ink_of(surface, ink));
        if let (Surface::Skin, Some(whiskers)) = (surface, whiskers) {
            own = whiskers.beneath(&own);
        }
        let mut hooks = Vec::new();
        if surface == Surface::Hair {
            let coils = self.coiled_hair(&self.hair_of_heads(&surfaces.hair));
            hooks = self.hooks(&coils, &region, directions.of(surface), &own);
            own = hooks::beneath(&own, &coils);
        }
        let shares = match self.parameters.look {
            Look::Hatch => [own.clone(), own.map(|_| 0.0), own.map(|_| 0.0)],
            _ => shares::shares_of(&own, surface, &region, self.pitch()),
        };
        (hooks, Ground { surface, region, shares })
    }

    /// The pieces of the lines on one ground.
    fn lines_over(&self, ground: &Ground, directions: &Directions, detail: &Raster<f32>) -> Pieces {
        // Lines run on a little beyond a ground's border, where they are cut.
        let room = (ROOM * self.pitch()) as usize;
        let near = dilate(&ground.region.map(|share| u8::from(share > LEAST_SHARE)), room);
        let at = |x, y| if near.get(x, y) == 0 { 0.0 } else { ground.closeness(detail.get(x, y)) };
        let closeness = Closeness { at: &at, closest: ground.closest(detail) };
        let families = collected(3, &|family| self.family(ground, family, directions, closeness));
        self.pieces(ground, &families, directions)
    }

    /// The lines of one family, laid where it has ink; none if that is nowhere.
    fn family(&self, ground: &Ground, family: usize, directions: &Directions, closeness: Closeness<'_>) -> Option<Family> {
        let room = (ROOM * self.pitch()) as usize;
        let extent = match family {
            2 => Extent::of(&ground.shares[2].zip_map(&ground.region, f32::min), 0.0, room),
            _ => Extent::of(&ground.region, LEAST_SHARE, room),
        };
        let name = format!("{:?} {family}", ground.surface);
        extent.map(|extent| self.even_lines(&extent, directions.of(ground.surface), ground.turn(family), closeness, &name))
    }

    /// The pieces of a ground's lines; the second family also breaks the first in the lights.
    fn pieces(&self, ground: &Ground, families: &[Option<Family>], directions: &Directions) -> Pieces {
        let silhouette = ground.surface.is_hair().then(|| gaussian_blur(&self.portrait.subject, self.pitch() as f32));
        let pieces = |family: usize| {
            let Some(own) = &families[family] else { return Vec::new() };
            let ink = &ground.shares[family];
            let course = Course {
                family: own,
                directions: directions.of(ground.surface),
                turn: ground.turn(family),
                ink,
                region: &ground.region,
                breaks: if family == 0 { families[1].as_ref() } else { None },
                thinnest: self.parameters.thinnest / self.parameters.pitch,
                dot_min: self.pixels(self.parameters.dot_min),
                pitch: self.pitch(),
                silhouette: silhouette.as_ref(),
                picture: Rect::new(0.0, 0.0, ink.width() as f64, ink.height() as f64),
            };
            course.pieces()
        };
        [pieces(0), pieces(1), pieces(2)]
    }

    fn form_drawing(&self, pieces: &Pieces, own: [Layer; 2]) -> Drawing {
        let names = ["lines", "cross lines", "third lines"];
        let mut layers: Vec<Layer> = Vec::new();
        for (name, pieces) in names.into_iter().zip(pieces) {
            let mut layer = Layer::new(name, 1);
            layer.marks = marks(pieces.iter(), &self.portrait.placement);
            layers.push(layer);
        }
        layers.extend(own);
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
