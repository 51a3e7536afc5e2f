//! The numbers of path ends.

/// One end of one path. Path `p` has the ends `2 p` (its start) and `2 p + 1` (its end), so that `end ^ 1` is the
/// other end of the same path and `end >> 1` the path. The numbering is the internal one of [`Sites`](super::sites::Sites).
pub(super) type End = u32;
