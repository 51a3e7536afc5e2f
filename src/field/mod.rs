//! Fields: what a style reads from a portrait. Each file computes one field.
//!
//! In: rasters and curves in working pixels. Out: one field each. Nothing here knows of styles, pages or files.

mod contour;
mod covering;
mod distance;
mod edges;
mod face;
mod facial_features;
mod grain;
mod hough;
mod inside;
mod isophotes;
mod lanes;
mod orientation;
mod scale_space;
mod trace;
mod voronoi;

pub use contour::contours;
pub use covering::{Covering, cover};
pub use distance::{FeatureDistance, distance_to_curves, nearest_seed};
pub use edges::{EdgeParameters, EdgeSteps, detect_edges, lines_of};
pub use face::{FaceExpectation, FaceFrame, find_face};
pub use facial_features::{FacialFeature, FacialFeatures, facial_features};
pub use grain::grain_areas;
pub use hough::{HoughFilter, HoughForm};
pub use inside::pieces_inside;
pub use isophotes::{IsophoteSteps, detect_isophotes};
pub use lanes::{LaneParameters, Lanes, offset_lanes};
pub use orientation::OrientationField;
pub use scale_space::{Mode, histogram_modes};
pub use trace::{Curve, trace};
pub use voronoi::{Sites, cell_polygon};
