//! Faces by their tones alone, where no network found one: where they are, their features, and the hair over them. All lengths are in
//! distances of the eyes, from the middle between them ([`FaceFrame`]).

mod features;
mod finding;
mod fit;
mod frame;
mod hairline;

pub use features::{FacialFeature, FacialFeatures, SkinTone, facial_features};
pub use finding::{FaceExpectation, USUAL_WINDOWS, find_face};
pub use frame::{CROWN, FaceFrame, FeatureWindow};
pub use hairline::hair_over_face;
