//! Fields that a style computes from a portrait. Each file computes one field.
//!
//! In: rasters and curves in working pixels. Out: one field each. This module knows nothing of styles, pages or files.

mod b_spline;
mod border;
mod coherent_lines;
mod contour;
mod covering;
mod crossings;
mod curve;
mod dark_relief;
mod direction;
mod distance;
mod edges;
mod evening;
mod faces;
mod flow;
mod flow_dog;
mod glass;
mod glass_levels;
mod grain;
mod hough;
mod inside;
mod isophotes;
mod lanes;
mod least_squares;
mod linking;
mod orientation;
mod poisson;
mod relaxation;
mod relief;
mod ribbon;
mod scale_space;
mod spread;
mod stripes;
mod superpixels;
mod tangent_flow;
mod trace;
mod voronoi;
mod watershed;

#[doc(hidden)]
pub use b_spline::{BSpline, Datum, multilevel_b_spline};
pub(crate) use border::over_the_border;
#[doc(hidden)]
pub use coherent_lines::{CoherentLine, CoherentLines, coherent_lines};
#[doc(hidden)]
pub use contour::contours;
#[doc(hidden)]
pub use covering::{Covering, cover};
#[doc(hidden)]
pub use crossings::{LocalLength, crossings, holes};
pub use curve::Curve;
#[doc(hidden)]
pub use direction::{DirectionField, FieldParameters, Guides, Singularity, direction_field};
pub(crate) use distance::distance_within;
#[doc(hidden)]
pub use distance::nearest_seed;
pub use distance::{FeatureDistance, distance_to_curves};
#[doc(hidden)]
pub use edges::{EdgeParameters, EdgeSteps, detect_edges, lines_of};
pub(crate) use evening::evening;
#[doc(hidden)]
pub use faces::{
    CROWN, FaceExpectation, FaceFrame, FacialFeature, FacialFeatures, FeatureWindow, SkinTone, USUAL_WINDOWS, facial_features,
    find_face, hair_over_face,
};
#[doc(hidden)]
pub use flow::Flow;
#[doc(hidden)]
pub use flow_dog::{FlowLines, LineParameters, flow_lines};
#[doc(hidden)]
pub use glass::{glass_pattern, line_integral_convolution};
#[doc(hidden)]
pub use glass_levels::GlassLevels;
#[doc(hidden)]
pub use grain::grain_areas;
#[doc(hidden)]
pub use hough::{HoughFilter, HoughForm};
#[doc(hidden)]
pub use inside::pieces_inside;
#[doc(hidden)]
pub use isophotes::{IsophoteSteps, detect_isophotes};
#[doc(hidden)]
pub use lanes::{LaneParameters, Lanes, offset_lanes};
#[doc(hidden)]
pub use orientation::OrientationField;
#[doc(hidden)]
pub use poisson::{poisson, screened_poisson};
pub use relaxation::relaxed;
#[doc(hidden)]
pub use relaxation::{LaneConstraint, relaxed_in_lanes};
#[doc(hidden)]
pub use relief::{bend_by_shading, inflate};
#[doc(hidden)]
pub use ribbon::{Ribbon, RibbonFit, glass_ribbons};
#[doc(hidden)]
pub use scale_space::{Mode, histogram_modes};
pub(crate) use spread::spread;
#[doc(hidden)]
pub use stripes::{Start, StripeLattice, StripeLine, StripeParameters, Wave, stripe_lines, stripes};
pub use superpixels::superpixels;
pub use tangent_flow::{EdgeTangentFlow, edge_tangent_flow};
pub use trace::trace;
pub use voronoi::{Sites, cell_polygon};
#[doc(hidden)]
pub use watershed::watershed;
