//! Geometry on the page: curves, clipping, areas, lengths. Units are millimetres, x right, y down.
//!
//! In and out: points, polygons and `kurbo` curves. This module does not depend on photographs, styles or machines.

mod apart;
mod arc;
mod blob;
mod blue_noise;
mod bounded;
mod clip;
mod convex_hull;
mod crossings;
mod direct_search;
mod disc;
mod graph;
mod hand_shading;
mod inset;
pub(crate) mod kd_tree;
mod length;
mod number;
mod polyline;
mod region;
mod smooth;
mod spline;
mod swell;
mod tangle;
mod thinning;

pub use apart::Gap;
pub use arc::{Step, arc_points, fit_arcs, flatten_arc};
pub use blob::blob;
pub use blue_noise::blue_noise_order;
pub use bounded::{polygons_within, straightened_outside};
pub use clip::{clip_disc, clip_polygon, clip_polyline, half_plane};
pub use convex_hull::convex_hull;
pub use crossings::{Crossings, crossings};
pub use disc::{disc_area_in, radius_for_area};
pub use graph::{FitTolerance, Graph, GraphNode};
pub use hand_shading::HandShading;
pub use inset::OffsetOutline;
pub use length::{LengthError, parse_drawn_length, parse_drawn_size, parse_length, parse_size};
pub use number::parse_finite;
pub use polyline::{
    distance_to_segment, flatten, flattened_points, polygon_area, polyline_length, resample, simplify, simplify_until,
};
pub use region::{Region, Winding, untangled, untangled_polygons};
pub use smooth::{catmull_rom, smooth_polyline};
pub use swell::{Ends, Station, Stretch, curve_length, sample_swelling, segment_length, stations, swelling_outline};
pub use tangle::{WideSegment, estimated_crossings, estimated_crossings_among};
pub use thinning::thinned;

pub use kurbo::{Affine, BezPath, Point, Rect, Vec2};
