//! Stripes along a field of directions: a phase at each node of a lattice, made regular from coarse to fine (Son et al. 2011, section 5,
//! with the phase as a complex number instead of the folded distance).
//!
//! ```text
//!   wave      at each node, across the stripes, cycles per pixel; of either sign
//!   edges     the phase that a wave gains from a node to its neighbour
//!   levels    nodes 8, 4, 2, 1 steps apart; each starts from the coarser one's result
//!   rounds    each node becomes the mean of its neighbourhood's predictions, normalised to length 1
//! ```
//!
//! The paper's update averages over a window aligned with the field. Here many small steps from node to neighbour make the same Gaussian
//! window, bent along the field, at a lower cost.

mod lattice;
mod lines;
mod relaxation;
mod steps;

pub use lattice::{StripeLattice, Wave};
pub(crate) use lines::CellPhases;
pub use lines::{StripeLine, stripe_lines};
pub use relaxation::{Start, StripeParameters, stripes};
