//! Where a machine stands.

/// Where a machine stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// The pen's position in the work's coordinates, in machine units.
    pub at: [f64; 3],
    /// The value that sets the pen's servo, if the machine tells it.
    pub servo: Option<f64>,
}
