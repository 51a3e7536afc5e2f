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
mod cubic_fit;
mod direct_search;
mod disc;
mod fewer_curves;
mod graph;
mod hand_shading;
mod inset;
pub(crate) mod kd_tree;
mod length;
mod millimetres;
mod number;
mod polyline;
mod region;
mod smooth;
mod spline;
pub(crate) mod stroke_letters;
mod swell;
mod tangle;
mod thinning;

#[doc(hidden)]
pub use apart::Gap;
#[doc(hidden)]
pub use arc::{Step, arc_points, fit_arcs, flatten_arc};
#[doc(hidden)]
pub use blob::blob;
#[doc(hidden)]
pub use blue_noise::blue_noise_order;
#[doc(hidden)]
pub use bounded::{polygons_within, straightened_outside};
#[doc(hidden)]
pub use clip::{clip_disc, clip_polygon, clip_polyline, half_plane};
#[doc(hidden)]
pub use convex_hull::convex_hull;
#[doc(hidden)]
pub use crossings::{Crossings, crossings};
#[doc(hidden)]
pub use disc::{disc_area_in, radius_for_area};
#[doc(hidden)]
pub use fewer_curves::with_fewer_curves;
#[doc(hidden)]
pub use graph::{FitTolerance, Graph, GraphNode};
#[doc(hidden)]
pub use hand_shading::HandShading;
pub(crate) use inset::OffsetOutline;
pub use length::{LengthError, parse_length, parse_size};
#[doc(hidden)]
pub use length::{parse_drawn_length, parse_drawn_size};
pub use millimetres::Millimetres;
#[doc(hidden)]
pub use number::parse_finite;
#[doc(hidden)]
pub use polyline::{
    distance_to_segment, flatten, flattened_points, lengths_along, polygon_area, polyline_length, resample, simplify,
    simplify_until,
};
#[doc(hidden)]
pub use region::{Region, Winding, untangled, untangled_polygons};
#[doc(hidden)]
pub use smooth::{Ring, catmull_rom, smooth_polyline};
#[doc(hidden)]
pub use swell::{Ends, Station, Stretch, curve_length, sample_swelling, segment_length, stations, swelling_outline};
#[doc(hidden)]
pub use tangle::{WideSegment, estimated_crossings, estimated_crossings_among};
#[doc(hidden)]
pub use thinning::thinned;

pub use kurbo::{Affine, BezPath, Point, Rect, Vec2};
