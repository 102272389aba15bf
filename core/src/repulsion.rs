//! Repulsion.

/// Cut-off distance d_c = 2·2^(1/6), R0 (Eq. 15).
pub const CUTOFF: f64 = 2.244924096618746;
