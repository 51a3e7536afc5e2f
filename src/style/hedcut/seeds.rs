//! Step 5: seeds, and constrained Lloyd relaxation (Kim et al. 2008; Bruehl 2023, section 3.3).

use super::Drawer;
use crate::field::{LaneConstraint, Lanes, relaxed, relaxed_in_lanes};
use crate::geometry::Point;
use crate::raster::Raster;
use crate::style::{StyleError, random};
use rand::RngExt;

/// Density of dots in a detail region (Bruehl 4.3.2: three times).
const DETAIL_DENSITY: f32 = 3.0;

/// Scatters and relaxes the dots; positions in working pixels.
pub(super) fn relaxed_seeds(drawer: &Drawer<'_>, lanes: &Lanes) -> Result<Vec<Point>, StyleError> {
    drawer.observer.begin("seeds");
    let density = density(drawer);
    let mut sites = scatter(drawer, lanes, &density);
    if sites.is_empty() {
        return Err(StyleError::NothingToDraw(
            "the subject is smaller than one dot, or its mask is nowhere more than half white; use a smaller pitch or a whiter mask".to_owned(),
        ));
    }
    drawer.observer.picture("seeds", &|| drawer.dot_picture(&sites));
    drawer.observer.begin("relaxation");
    // The density of cells in a relaxed pattern is proportional to the square root of the weight (Du et al. 1999), so the weight is the
    // square.
    let weight = density.map(|d| d * d);
    let reach = drawer.pixels(drawer.parameters.flow_reach) as f32;
    let rounds = drawer.parameters.plain_rounds + drawer.parameters.flow_rounds;
    for round in 0..rounds {
        drawer.check()?;
        // The last round is a constrained one: it centres the dots in their lanes.
        let constrained = round >= drawer.parameters.plain_rounds && (rounds - round) % 2 == 1;
        sites = if constrained {
            relaxed_in_lanes(&sites, &weight, drawer.pitch(), LaneConstraint { lanes, reach })
        } else {
            relaxed(&sites, &weight, drawer.pitch())
        };
        drawer.observer.progress(f64::from(round + 1) / f64::from(rounds));
    }
    drawer.observer.picture("relaxed", &|| drawer.dot_picture(&sites));
    Ok(sites)
}

/// Target dots per squared pitch: 1 in the subject, more in detail regions, 0 outside.
fn density(drawer: &Drawer<'_>) -> Raster<f32> {
    let subject = &drawer.portrait.subject;
    match drawer.detail() {
        // A soft mask gives a soft change, which hides the border.
        Some(detail) => subject.zip_map(detail, |s, d| if s < 0.5 { 0.0 } else { 1.0 + (DETAIL_DENSITY - 1.0) * d }),
        None => subject.map(|s| f32::from(s >= 0.5)),
    }
}

/// Random seeds with the target mean density. Each cell of one pitch gets its share; the rounding error carries over to the next cell.
/// Seeds are random pixels, off the offset lines if there are enough of them.
fn scatter(drawer: &Drawer<'_>, lanes: &Lanes, density: &Raster<f32>) -> Vec<Point> {
    let (width, height) = drawer.size();
    let pitch = drawer.pitch();
    let side = pitch.round().max(1.0) as usize;
    let per_pixel = 1.0 / (pitch * pitch);
    let mut sites = Vec::new();
    let mut owed = 0.5;
    let mut free = Vec::new();
    for (row, y0) in (0..height).step_by(side).enumerate() {
        for (column, x0) in (0..width).step_by(side).enumerate() {
            let pixels = (y0..(y0 + side).min(height)).flat_map(|y| (x0..(x0 + side).min(width)).map(move |x| (x, y)));
            free.clear();
            let mut on_line = Vec::new();
            for (x, y) in pixels {
                let wanted = density.get(x, y);
                owed += f64::from(wanted) * per_pixel;
                if wanted > 0.0 {
                    if lanes.line.get(x, y) == 0 { free.push((x, y)) } else { on_line.push((x, y)) }
                }
            }
            let mut random = random::stream(drawer.seed, "seeds", (row as u64) << 32 | column as u64);
            while owed >= 1.0 && !(free.is_empty() && on_line.is_empty()) {
                let from = if free.is_empty() { &mut on_line } else { &mut free };
                let (x, y) = from.swap_remove(random.random_range(0..from.len()));
                sites.push(Point::new(x as f64 + random.random::<f64>(), y as f64 + random.random::<f64>()));
                owed -= 1.0;
            }
        }
    }
    sites
}

impl Drawer<'_> {
    /// Sites as equal dots, for `stages`.
    fn dot_picture(&self, sites: &[Point]) -> crate::style::Picture {
        let radius = 0.15 * self.pitch();
        let dots: Vec<super::SizedDot> = sites.iter().map(|&centre| super::SizedDot { centre, radius }).collect();
        let drawing = crate::drawing::Drawing { page: self.page(), layers: vec![self.plain_dots(&dots)] };
        crate::style::Picture::Drawing(Box::new(drawing))
    }

    fn plain_dots(&self, dots: &[super::SizedDot]) -> crate::drawing::Layer {
        use crate::drawing::{Dot, Layer, Mark};
        let scale = self.portrait.placement.mm_per_pixel();
        let mut layer = Layer::new("dots", 1);
        layer.marks = dots
            .iter()
            .map(|dot| Mark::Dot(Dot::circle(self.portrait.placement.to_page(dot.centre), dot.radius * scale)))
            .collect();
        layer
    }
}
