//! Families of even lines along a field of directions: stripes whose phase is made regular from coarse to fine.

use super::super::Drawer;
use crate::elementary::Elementary as _;
use crate::field::{Curve, StripeLattice, StripeParameters, Wave, evening, stripe_lines, stripes};
use crate::geometry::{Point, Vec2, smooth_polyline};
use crate::raster::{Raster, gaussian_blur};
use crate::style::random::stream;
use rand::RngExt;
use std::f64::consts::TAU;
use std::ops::Range;

/// How much closer lines stand where detail is fine.
pub(super) const FINE: f32 = 0.34;

/// How much closer than a pitch lines stand.
#[derive(Clone, Copy)]
pub(super) struct Closeness<'a> {
    /// The factor at a pixel; 0 where there are no lines.
    pub at: &'a (dyn Fn(usize, usize) -> f32 + Sync),
    /// The greatest factor where lines are seen.
    pub closest: f32,
}

/// The columns and rows of a surface on the working grid.
#[derive(Clone, Debug)]
pub(super) struct Extent {
    columns: Range<usize>,
    rows: Range<usize>,
}

impl Extent {
    /// The box of what is above `least`, with room around it; none if nothing is.
    pub(super) fn of(share: &Raster<f32>, least: f32, room: usize) -> Option<Self> {
        let [columns, rows] = share.extent_above(least)?;
        let wide = |range: Range<usize>, end: usize| range.start.saturating_sub(room)..(range.end + room).min(end);
        Some(Self { columns: wide(columns, share.width()), rows: wide(rows, share.height()) })
    }

    fn origin(&self) -> Vec2 {
        Vec2::new(self.columns.start as f64, self.rows.start as f64)
    }
}

/// Working pixels per pixel of the grid on which lines are laid: there is one for about each node of their lattice.
const COARSER: usize = 2;

/// Lines in one direction over one surface.
pub(super) struct Family {
    /// On the coarser grid.
    stripes: StripeLattice,
    origin: Vec2,
    /// In working pixels.
    pub lines: Vec<Curve>,
    density: Raster<f32>,
}

impl Family {
    /// The distance of neighbouring lines at a place, in pixels.
    pub(super) fn spacing(&self, p: Point) -> f64 {
        COARSER as f64 / f64::from(self.stripes.read(&self.density, self.on_grid(p))).max(1e-6)
    }

    /// How far a place lies from the nearest line, 0 on it to 1 midway between two.
    pub(super) fn away(&self, p: Point) -> f64 {
        let phase = self.stripes.phase_at(self.on_grid(p)) / TAU;
        2.0 * (phase - phase.round()).abs()
    }

    /// A place in working pixels on the coarser grid of the lines.
    fn on_grid(&self, p: Point) -> Point {
        ((p - self.origin).to_vec2() / COARSER as f64).to_point()
    }
}

impl Drawer<'_> {
    /// Lines over an extent, turned by an angle from the directions, `closeness` times as close as the pitch.
    pub(super) fn even_lines(
        &self,
        extent: &Extent,
        directions: &Raster<f32>,
        turn: f64,
        closeness: Closeness<'_>,
        name: &str,
    ) -> Family {
        /// Cells in which the density is evened, in pitches, and the factors by which it may change so that lines need not end.
        /// With wider ones lines crowd beside noses; with none there are twice as many ends.
        const CELL: f64 = 1.5;
        const EVENED: [f32; 2] = [0.79, 1.2];
        /// Blur of the lines' density in pitches.
        const DENSITY_BLUR: f64 = 0.8;
        /// Smoothing of lines and the distance of their points, in pitches.
        const SMOOTH: f64 = 0.4;
        const SPACING: f64 = 0.25;
        let pitch = self.pitch();
        let (left, top) = (extent.columns.start, extent.rows.start);
        let (columns, rows) = (extent.columns.len(), extent.rows.len());
        let cell = (CELL * pitch).max(1.0);
        let cells = |side: usize| ((side as f64 / cell).ceil() as usize).max(2);
        let coarse = Raster::from_fn(cells(columns), cells(rows), |x, y| {
            let at = |i: usize, from: usize, count: usize| from + (((i as f64 + 0.5) * cell) as usize).min(count - 1);
            directions.get(at(x, left, columns), at(y, top, rows)) + turn as f32
        });
        let evened = evening(&coarse, EVENED);
        let middle = |i: usize, count: usize| (COARSER * i + COARSER / 2).min(count - 1);
        let wave: Raster<Wave> = Raster::from_fn(columns.div_ceil(COARSER), rows.div_ceil(COARSER), |i, j| {
            let (x, y) = (middle(i, columns), middle(j, rows));
            let close = (closeness.at)(left + x, top + y);
            if close <= 0.0 {
                return [0.0; 2];
            }
            let (sin, cos) = (directions.get(left + x, top + y) + turn as f32).sine_and_cosine();
            let evened = evened.sample((x as f64 + 0.5) / cell, (y as f64 + 0.5) / cell);
            let dense = COARSER as f32 * evened * close / pitch as f32;
            [-sin * dense, cos * dense]
        });
        let parameters = self.stripe_parameters(closeness.closest);
        let by_chance = |node: u64, _: Point, _: Wave| stream(self.seed, name, node).random::<f32>();
        let stripes = stripes(&wave, parameters, &by_chance, None);
        let density = gaussian_blur(&stripes.frequency(), (DENSITY_BLUR * pitch / COARSER as f64 / parameters.step) as f32);
        let origin = extent.origin();
        let lines = stripe_lines(&stripes).into_iter().map(|line| {
            let points: Vec<Point> = line.points.iter().map(|p| (p.to_vec2() * COARSER as f64).to_point()).collect();
            let smooth = smooth_polyline(&points, line.closed.into(), SMOOTH * pitch, SPACING * pitch);
            Curve { points: smooth.into_iter().map(|p| p + origin).collect(), closed: line.closed }
        });
        let lines = lines.filter(|line| line.points.len() > 1).collect();
        Family { stripes, origin, lines, density }
    }

    /// In pixels of the coarser grid, for lines at most so many times as close as the pitch.
    fn stripe_parameters(&self, closest: f32) -> StripeParameters {
        /// Nodes per narrowest pitch: with fewer a line between two nodes could be lost, more change nothing that is measured.
        const NODES_PER_PITCH: f64 = 1.5;
        /// Lines that are nowhere closer get nodes as if they were: with 1 crossing lines end a fifth more often on the mean face, with
        /// 1.25 a twentieth.
        const LEAST_CLOSEST: f32 = 1.25;
        /// Reach of the window in pitches, rounds, and levels from coarse to fine. Twice the work changes nothing that is
        /// measured on faces.
        const WINDOW: f64 = 1.6;
        const ROUNDS: u32 = 3;
        const LEVELS: u32 = 5;
        let pitch = self.pitch() / COARSER as f64;
        let step = pitch / NODES_PER_PITCH / f64::from(closest.max(LEAST_CLOSEST));
        StripeParameters { step, window: WINDOW * pitch / step, rounds: ROUNDS, levels: LEVELS }
    }
}
