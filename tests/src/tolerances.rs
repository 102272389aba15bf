//! Every tolerance of the tests in one place, each with its reason. What is not here is compared bit for bit.

/// Fixed-point rounding of a disc's mass, in mesh cells: each of up to 9 weights is off by half of 2⁻²⁰ discs and
/// lies at most 1.5 cells away, and as much again goes to the nearest node.
pub const CENTRE_OF_MASS: f64 = 9.0 * 1.5 / 1_048_576.0;

/// Repulsion of a pair against its closed form, relative to the sum of the moduli of its two terms. A coordinate
/// rounded to binary32 is off by 2⁻²⁴, the unit of length by as much; the 13th power of the distance
/// makes 26 · 2⁻²⁴ = 1.6e-6 of it, the products after it add a few more 2⁻²⁴.
pub const PAIR_FORCE: f64 = 2.5e-6;

/// One unit of force, 2⁻²⁴ kBT/R0: what quantising may add to any comparison of forces.
pub const FORCE_QUANTUM: f64 = 1.0 / 16_777_216.0;

/// Sum of the mesh force over all discs, relative to the sum of the moduli. Exactly zero but for the rounding of
/// transforms and gather in binary32.
pub const MESH_NET_FORCE: f64 = 1e-5;

/// Mesh force of a disc on itself, in V0/h. Zero but for rounding in binary32.
pub const SELF_FORCE: f64 = 1e-5;

/// Mesh field against a direct Fourier sum in binary64, rms of the difference over rms of the field. A
/// transform of M points has 2 log2 M roundings of 2⁻²⁴ at each of four passes, which add as squares.
pub const MESH_FIELD: f64 = 1e-6;

/// Mesh forces in a turned, mirrored or shifted (by whole mesh cells) system against the turned, mirrored or
/// shifted forces, rms over rms: the same sums in another order in binary32; at ties of the nearest node a
/// remainder of 2⁻²⁰ discs may change its node.
pub const SYMMETRY: f64 = 1e-6;

/// Mesh forces at V0 times a factor that is not a power of two, relative to the largest force: rounding of the
/// influence table, 2⁻²⁴, and of the sums.
pub const LINEARITY: f64 = 1e-6;

/// Standard errors allowed where up to 10⁵ independent statistics are compared. A Gaussian one exceeds 6 once in
/// 5·10⁸, so that a failure is a fault. Seeds are the first ones, none is picked.
pub const SIGMAS_OF_MANY: f64 = 6.0;

/// Standard errors allowed where a few statistics are compared: exceeded once in 10⁷ for Gaussian statistics.
pub const SIGMAS_OF_FEW: f64 = 5.3;

/// Standard error of the mean squared displacement that the test of free diffusion must reach for it to
/// say anything, relative.
pub const DIFFUSION_RESOLUTION: f64 = 0.01;

/// Euler's bias of the density of two discs at 2.0 to 2.1 R0, relative to Boltzmann's, for each R0²/D of
/// the step's ceiling: PHYSICS gives 0.95 at 0.001 and 0.99 at 2e-4, that is 50 per unit.
pub const CONTACT_BIAS: (f64, f64) = (35.0, 75.0);
