//! Fields: what a style reads from a portrait. Each file computes one field.
//!
//! In: rasters and curves in working pixels. Out: one field each. Nothing here knows of styles, pages or files.

mod b_spline;
mod coherent_lines;
mod contour;
mod crossings;
mod direction;
mod distance;
mod edges;
mod flow_dog;
mod isophotes;
mod lanes;
mod poisson;
mod relief;
mod stripes;
mod superpixels;
mod tangent_flow;
mod covering;
mod face;
mod facial_features;
mod grain;
mod hough;
mod inside;
mod orientation;
mod scale_space;
mod trace;
mod voronoi;
mod watershed;

pub use b_spline::{BSpline, Datum, multilevel_b_spline};
pub use coherent_lines::{CoherentLine, CoherentLines, coherent_lines};
pub use contour::contours;
pub use crossings::{crossings, holes};
pub use direction::{DirectionField, FieldParameters, Guides, Singularity, direction_field};
pub use distance::{FeatureDistance, distance_to_curves, nearest_seed};
pub use edges::{EdgeParameters, EdgeSteps, detect_edges, lines_of};
pub use flow_dog::{FlowLines, LineParameters, flow_lines};
pub use isophotes::{IsophoteSteps, detect_isophotes};
pub use lanes::{LaneParameters, Lanes, offset_lanes};
pub use poisson::poisson;
pub use relief::{bend_by_shading, inflate};
pub use stripes::{Start, StripeLattice, StripeLine, StripeParameters, Wave, stripe_lines, stripes};
pub use superpixels::superpixels;
pub use tangent_flow::{EdgeTangentFlow, edge_tangent_flow};
pub use covering::{Covering, cover};
pub use face::{FaceExpectation, FaceFrame, find_face};
pub use facial_features::{FacialFeature, FacialFeatures, facial_features};
pub use grain::grain_areas;
pub use hough::{HoughFilter, HoughForm};
pub use inside::pieces_inside;
pub use orientation::OrientationField;
pub use scale_space::{Mode, histogram_modes};
pub use trace::{Curve, trace};
pub use voronoi::{Sites, cell_polygon};
pub use watershed::watershed;
