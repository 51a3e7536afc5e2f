//! The larger of two values, without an edge where they cross.

/// How far the soft maximum of two values lies above the first, if the second does by `over`: nothing where that is below, `softness` less
/// than `over` where it is far above.
#[inline]
pub(crate) fn soft_rise(over: f32, softness: f32) -> f32 {
    let over = over.max(0.0);
    over * over / (over + softness)
}
