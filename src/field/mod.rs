//! Fields: what a style reads from a portrait. Each file computes one field.
//!
//! In: rasters and curves in working pixels. Out: one field each. Nothing here knows of styles, pages or files.

mod contour;
mod distance;
mod edges;
mod flow;
mod glass;
mod glass_levels;
mod isophotes;
mod lanes;
mod ribbon;
mod trace;
mod voronoi;

pub use contour::contours;
pub use distance::{FeatureDistance, distance_to_curves, nearest_seed};
pub use edges::{EdgeParameters, EdgeSteps, detect_edges, lines_of};
pub use flow::Flow;
pub use glass::{glass_pattern, line_integral_convolution};
pub use glass_levels::GlassLevels;
pub use isophotes::{IsophoteSteps, detect_isophotes};
pub use lanes::{LaneParameters, Lanes, offset_lanes};
pub use ribbon::{Cut, Ribbon, glass_ribbons};
pub use trace::{Curve, trace};
pub use voronoi::{Sites, cell_polygon};
