//! Offset lanes: bands one pitch wide that follow the features (Kim et al. 2008; Bruehl 2023, sections 3.1.2 and 3.2).

use super::distance::FeatureDistance;
use crate::raster::Raster;

/// Parameters of lanes; lengths in working pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaneParameters {
    /// Width of a lane.
    pub pitch: f32,
    /// Width of a lane in detail regions.
    pub detail_pitch: f32,
    /// Weight of the edges; a larger weight extends a feature's influence.
    pub edge_weight: f32,
    /// Weight of the isophotes.
    pub isophote_weight: f32,
}

/// Lanes and the distances behind them.
#[derive(Clone, Debug)]
pub struct Lanes {
    /// Unweighted distance from each pixel to its governing feature, in pixels; infinite without features.
    pub distance: Raster<f32>,
    /// The number of each pixel's lane.
    pub lane: Raster<i32>,
    /// Marks the offset lines between lanes, one pixel wide.
    pub line: Raster<u8>,
}

impl Lanes {
    /// 1 for a lane of a detail region, else 0.
    pub const fn region(lane: i32) -> i32 {
        lane & 1
    }
}

/// Width of an offset line in pixels (`w0` of the thesis).
const LINE_WIDTH: f32 = 1.0;

/// Computes lanes around edges and isophotes.
///
/// The weighted distances `min(D_e / w_e, D_i / w_i)` choose the governing feature of a pixel; its lane follows from the plain distance
/// to that feature, since a weighted one would make lanes two pitches wide with two rows of dots (measured). An offset line is centred
/// on its lane border. The two sides of a feature are different lanes.
pub fn offset_lanes(
    edges: Option<&FeatureDistance>,
    isophotes: Option<&FeatureDistance>,
    detail: Option<&Raster<f32>>,
    size: (usize, usize),
    parameters: LaneParameters,
) -> Lanes {
    let ruling = Raster::from_fn(size.0, size.1, |x, y| {
        let of = |field: Option<&FeatureDistance>| field.map_or((f32::INFINITY, 1), |f| (f.distance.get(x, y), f.side.get(x, y)));
        let ((edge, edge_side), (isophote, isophote_side)) = (of(edges), of(isophotes));
        if edge / parameters.edge_weight <= isophote / parameters.isophote_weight {
            (edge, edge_side)
        } else {
            (isophote, isophote_side)
        }
    });
    let pitch_at = |x: usize, y: usize| match detail {
        Some(mask) if mask.get(x, y) >= 0.5 => (parameters.detail_pitch, 1),
        _ => (parameters.pitch, 0),
    };
    let lane = Raster::from_fn(size.0, size.1, |x, y| {
        let (distance, side) = ruling.get(x, y);
        let (pitch, region) = pitch_at(x, y);
        if distance.is_infinite() {
            return region;
        }
        let number = (distance / pitch) as i32;
        // The two sides can touch only next to the feature.
        let sided = if number == 0 && side < 0 { -1 } else { number };
        2 * sided + region
    });
    let line = Raster::from_fn(size.0, size.1, |x, y| {
        let distance = ruling.get(x, y).0;
        let pitch = pitch_at(x, y).0;
        let off_border = (distance - (distance / pitch).round() * pitch).abs();
        u8::from(distance.is_finite() && off_border <= 0.5 * LINE_WIDTH)
    });
    Lanes { distance: ruling.map(|(distance, _)| distance), lane, line }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Curve, distance_to_curves};
    use crate::geometry::Point;

    const PARAMETERS: LaneParameters = LaneParameters { pitch: 6.0, detail_pitch: 3.5, edge_weight: 1.0, isophote_weight: 2.0 };

    fn vertical(x: f64) -> FeatureDistance {
        let points = vec![Point::new(x, 0.0), Point::new(x, 40.0)];
        distance_to_curves(&[Curve { points, closed: false }], 80, 40).unwrap()
    }

    #[test]
    fn lanes_are_one_pitch_wide_and_told_apart_across_the_feature() {
        let lanes = offset_lanes(Some(&vertical(40.0)), None, None, (80, 40), PARAMETERS);
        let row: Vec<i32> = (0..80).map(|x| lanes.lane.get(x, 20)).collect();
        assert!(row[40..46].iter().all(|&l| l == row[40]));
        assert!(row[34..40].iter().all(|&l| l == row[34]));
        assert_ne!(row[34], row[40]);
        assert_ne!(row[46], row[45]);
        assert_eq!(lanes.line.get(46, 20) + lanes.line.get(45, 20), 2, "both pixels beside the border lie on its line");
        assert_eq!(lanes.line.get(43, 20), 0);
    }

    #[test]
    fn weights_choose_the_feature_but_do_not_stretch_its_lanes() {
        let lanes = offset_lanes(Some(&vertical(10.0)), Some(&vertical(70.0)), None, (80, 40), PARAMETERS);
        // Equal weighted distance where (x - 10) = (70 - x) / 2, at x = 30.
        assert!((lanes.distance.get(28, 20) - 18.5).abs() < 0.01);
        assert!((lanes.distance.get(31, 20) - 38.5).abs() < 0.01);
    }
}
