//! Discrete Glass patterns: points and their positions after a flow moved them (Papari 2009, section 7.2.1), as dots whose ink makes the
//! tone.

use super::parameters::Points;
use super::{Drawer, Ground};
use crate::drawing::{Dot, Layer, Mark};
use crate::geometry::{Point, Rect, Vec2, blue_noise_order};
use crate::raster::Raster;
use crate::style::{StyleError, random};
use rand::RngExt;

/// Random candidates per point, of which the most evenly spread is kept: with fewer the pattern looks random, more only cost time.
const CHOICE: usize = 4;
/// Integration steps; the error of half a turn is then 1e-6 of its radius.
const STEPS: u32 = 32;
/// Smallest ink that gets a dot.
const LEAST_INK: f64 = 0.004;

pub(super) fn layer(drawer: &Drawer<'_>, ground: &Ground) -> Result<Layer, StyleError> {
    let mut layer = drawer.empty_layer("points");
    let picture = drawer.portrait.placement.picture;
    let points = points(drawer, picture);
    drawer.check()?;
    let ink = drawer.portrait.ink();
    let mover = Mover::new(drawer, ground);
    let moved = points.iter().map(|&p| mover.moved(p));
    let dot = |p: Point| dot(drawer, &ink, p);
    layer.marks = points.iter().copied().chain(moved).filter(|p| picture.contains(*p)).filter_map(dot).collect();
    if layer.marks.is_empty() {
        return Err(StyleError::NothingToDraw("the picture, or the part inside the subject mask, is white all over".to_owned()));
    }
    Ok(layer)
}

/// One point per squared pitch, in millimetres.
fn points(drawer: &Drawer<'_>, picture: Rect) -> Vec<Point> {
    let count = (picture.area() / drawer.parameters.pitch.0.powi(2)).round().max(1.0) as usize;
    let mut random = random::stream(drawer.seed, "points", 0);
    let drawn = if drawer.parameters.points == Points::Blue { CHOICE * count } else { count };
    let scattered: Vec<Point> = (0..drawn)
        .map(|_| {
            let (x, y): (f64, f64) = (random.random(), random.random());
            Point::new(picture.x0 + x * picture.width(), picture.y0 + y * picture.height())
        })
        .collect();
    if drawer.parameters.points == Points::Blue {
        blue_noise_order(&scattered)[..count].iter().map(|&i| scattered[i]).collect()
    } else {
        scattered
    }
}

/// A dot with half of the ink of a squared pitch at its place; its partner has the other half.
fn dot(drawer: &Drawer<'_>, ink: &Raster<f32>, at: Point) -> Option<Mark> {
    let placement = drawer.portrait.placement;
    let (x, y) = (at.x - placement.picture.x0, at.y - placement.picture.y0);
    let ink = f64::from(ink.sample(
        x * placement.columns as f64 / placement.picture.width(),
        y * placement.rows as f64 / placement.picture.height(),
    ));
    let radius = drawer.parameters.pitch.0 * (0.5 * ink.min(1.0) / std::f64::consts::PI).sqrt();
    (ink > LEAST_INK).then_some(Mark::Dot(Dot::circle(at, radius)))
}

/// The flow of equation 7.2 for a given time.
struct Mover<'a> {
    drawer: &'a Drawer<'a>,
    ground: &'a Ground,
    centre: Point,
    /// Half the shorter side in millimetres.
    half: f64,
}

impl<'a> Mover<'a> {
    fn new(drawer: &'a Drawer<'a>, ground: &'a Ground) -> Self {
        let picture = drawer.portrait.placement.picture;
        Self { drawer, ground, centre: picture.center(), half: 0.5 * picture.width().min(picture.height()) }
    }

    /// Runge and Kutta's fourth-order steps on the page.
    fn moved(&self, from: Point) -> Point {
        let step = self.drawer.parameters.time / f64::from(STEPS);
        (0..STEPS).fold(from, |p, _| {
            let k1 = self.velocity(p);
            let k2 = self.velocity(p + k1 * (0.5 * step));
            let k3 = self.velocity(p + k2 * (0.5 * step));
            let k4 = self.velocity(p + k3 * step);
            p + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (step / 6.0)
        })
    }

    /// Millimetres per unit of time.
    fn velocity(&self, p: Point) -> Vec2 {
        let laid = self.drawer.parameters.transform.velocity(p - self.centre, self.half);
        laid.unwrap_or_else(|| self.photograph(p) * self.drawer.parameters.length.0)
    }

    fn photograph(&self, p: Point) -> Vec2 {
        let placement = self.drawer.portrait.placement;
        let margin = self.ground.margin as f64;
        let x = (p.x - placement.picture.x0) * placement.columns as f64 / placement.picture.width();
        let y = (p.y - placement.picture.y0) * placement.rows as f64 / placement.picture.height();
        self.ground.flow.at(Point::new(x + margin, y + margin))
    }
}
