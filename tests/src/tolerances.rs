//! Every tolerance of the tests in one place, each with its reason. What is not here is compared bit for bit.

use meniscus_core::parameters::Assignment::{CloudInCell, TriangularShapedCloud};
use meniscus_core::parameters::Gradient::{Difference2, Difference4, Spectral};
use meniscus_core::parameters::Influence::{Continuum, Paper};
use meniscus_core::parameters::{Assignment, Gradient, Influence};

/// Fixed-point rounding of a disc's mass, in mesh cells, at order P: each of P² weights is off by up to 0.6 of
/// 2⁻²⁰ discs (half for its rounding, the rest for binary32) and lies at most P/2 cells away, and as much again goes to
/// the nearest node, half a cell away.
pub fn centre_of_mass(order: usize) -> f64 {
    let order = order as f64;
    0.6 * order * order * (0.5 * order + 0.5) / 1_048_576.0
}

/// Repulsion of a pair against its closed form, relative to the sum of the moduli of its two terms. The unit of
/// length, a coordinate and their product are rounded to binary32, 3 · 2⁻²⁴; the square of the distance is thus off
/// by 8 · 2⁻²⁴, its 7th power by 7 times that, and the products after it add some 20 · 2⁻²⁴. All of it at once is
/// 4.5e-6; 2.7e-6 was the most in 2·10⁷ random pairs.
pub const PAIR_FORCE: f64 = 4.5e-6;

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

/// The same of a split force with linear weights (order 2): the optimal influence function sums two aliases on either
/// side, beyond which a window squared falls as slowly as 1/k⁴. Its own error is a thousand times that.
pub const FEW_ALIASES: f64 = 1.5e-5;

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

/// Least and largest bias of Euler's steps, 1 − (density of two discs at 2.0 to 2.1 R0 over Boltzmann's), for each
/// R0²/D of the step's ceiling: Euler's step gives 0.72 of Boltzmann's density at 0.005, 0.95 at 0.001 and 0.99 at 2e-4, that
/// is 50 to 56; a longer step has a second-order part.
pub const CONTACT_BIAS: (f64, f64) = (42.0, 62.0);

/// Bias of Euler's steps allowed at 2e-4 R0²/D from 1.9 R0 on: it is 0.01 at contact.
pub const BIAS_AT_SHORT_STEPS: f64 = 0.015;

// Accuracy of the mesh against Ewald sums: tests/accuracy.rs.

/// The least and the most that a measured number may be. Errors have a least one so that a comparison of the mesh
/// with itself fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within(pub f64, pub f64);

/// rms error over rms force of 2500 random discs without overlap, L = 512 or 500 R0 on 512 nodes, λ = 270 R0.
/// 0.10, 0.04 and 0.02 (spectral continuum, CIC with four points) are what is demanded of the mesh; the rest is
/// what it has, and 15 % either way: the figure scatters by as much from sample to sample, as the few pairs
/// near contact decide it, and falls by 5 % from h = 1 to h = 0.98 R0.
pub const MESH_ERROR: [((Assignment, Influence, Gradient), Within); 12] = [
    ((CloudInCell, Paper, Spectral), Within(0.08, 0.1)),
    ((CloudInCell, Paper, Difference2), Within(0.018, 0.026)),
    ((CloudInCell, Paper, Difference4), Within(0.015, 0.02)),
    ((CloudInCell, Continuum, Spectral), Within(0.037, 0.051)),
    ((CloudInCell, Continuum, Difference2), Within(0.019, 0.027)),
    ((CloudInCell, Continuum, Difference4), Within(0.014, 0.021)),
    ((TriangularShapedCloud, Paper, Spectral), Within(0.03, 0.04)),
    ((TriangularShapedCloud, Paper, Difference2), Within(0.0145, 0.0205)),
    ((TriangularShapedCloud, Paper, Difference4), Within(0.0105, 0.0155)),
    ((TriangularShapedCloud, Continuum, Spectral), Within(0.0135, 0.02)),
    ((TriangularShapedCloud, Continuum, Difference2), Within(0.0165, 0.0235)),
    ((TriangularShapedCloud, Continuum, Difference4), Within(0.0095, 0.0135)),
];

/// The same at λ = 0.02 L, of the paper's scheme (TSC) and of the most accurate one. The errors are those of near
/// pairs and hardly depend on λ; the force of distant discs, by which they are divided, is gone.
pub const SCREENED_MESH_ERROR: [Within; 2] = [Within(0.052, 0.072), Within(0.0175, 0.0245)];

/// The same at infinite λ, where all is as at λ = 270 R0.
pub const UNSCREENED_MESH_ERROR: [Within; 2] = [Within(0.03, 0.04), Within(0.0095, 0.0135)];

/// rms over random pairs in contact, h = 1 R0, of the error of the mesh force over the force: 21 % and 7 % in the
/// paper's schemes, a tenth of it either way for the sample.
pub const CONTACT_ERROR: [((Assignment, Influence, Gradient), Within); 2] = [
    ((CloudInCell, Paper, Spectral), Within(0.19, 0.23)),
    ((TriangularShapedCloud, Paper, Spectral), Within(0.063, 0.077)),
];

/// The same over pairs 20 h to L/4 apart, of schemes with a difference gradient. Their error is 0.36 (h/d)² rms
/// at second order, 9e-4 at 20 h and less beyond; rounding in binary32 leaves 1e-5.
pub const FAR_ERROR: Within = Within(1e-5, 5e-4);

/// Ratio of the errors of distant pairs at spacings h and h/2 in a scheme of second order: 4, but for what
/// higher orders add at the coarsest mesh and the assignment at the finest.
pub const SECOND_ORDER: Within = Within(3.5, 4.5);

// Accuracy of the split force against Ewald sums: tests/split_accuracy.rs.

/// Order, nodes along the side, αh and r_c (R0) of schemes for 2500 random discs, L = 500 R0, λ = 270 R0, and rms error over
/// reference force: those of `MEASURED` in `host/src/accuracy/mod.rs`, and 30 % either way, for the sample and two digits.
pub const SPLIT_ERROR: [((usize, usize, f64, f64), Within); 8] = [
    ((3, 256, 0.49, 12.0), Within(1e-3, 1.8e-3)),
    ((4, 256, 0.49, 12.0), Within(2.7e-4, 4.9e-4)),
    ((5, 256, 0.49, 13.0), Within(0.85e-4, 1.6e-4)),
    ((5, 256, 0.43, 15.0), Within(3.5e-5, 6.5e-5)),
    ((5, 256, 0.33, 22.0), Within(0.8e-5, 1.5e-5)),
    ((7, 256, 0.39, 20.0), Within(2e-6, 3.7e-6)),
    ((3, 128, 0.49, 24.0), Within(1.1e-3, 2.1e-3)),
    ((5, 128, 0.49, 26.0), Within(0.9e-4, 1.7e-4)),
];

/// rms error of random states over its estimate, which is made for uncorrelated discs. As discs keep 2 R0 apart, errors
/// cancel in part the denser they are: 0.64 to 0.91 was found at 0.1 R0⁻², 0.79 to 1.02 at 0.01 R0⁻², 0.89 to 1.13 at
/// 0.001 R0⁻², where few pairs near each other decide an estimate from a sample.
pub const ESTIMATE_ERROR: Within = Within(0.6, 1.25);

/// rms error over the accuracy that a scheme was chosen for, which leaves a quarter of room; 0.85 was the most.
pub const CHOSEN_ERROR: f64 = 1.0;

/// E(r²) = r·F_near/V0 from the table in binary32 against the integral.
pub const NEAR_TABLE: f64 = 1e-6;

/// Near part of a pair force over V0/d: the table, and ten roundings of 2⁻²⁴ on the way.
pub const NEAR_FORCE: f64 = 2e-6;

/// rms error of dense clusters over their rms force, over the accuracy a scheme was chosen for: they attract their discs 12
/// to 60 times as strongly as a random start does, so that 0.03 to 0.3 is had.
pub const CLUSTER_ERROR: Within = Within(0.01, 0.6);

/// The same over the reference force, that of a random start: 25 times as dense makes √25 times the error.
pub const CLUSTER_ABSOLUTE_ERROR: Within = Within(0.5, 6.0);

/// Force of a pair in schemes with an error of some 1e-6 against the closed form with its images, in V0 (1/d + 1/L).
pub const SPLIT_PAIR: f64 = 2e-5;

// Unequal capillary strengths: tests/strengths.rs.

/// rms error over rms force of 60 discs of strengths of either sign at least 1 R0 apart, in a scheme with αh = 0.31, order 7,
/// and αr_c = 4.25: exp(−18) is left out, and the mesh's error is some 1e-6.
pub const UNEQUAL_ERROR: Within = Within(1e-7, 2e-5);

/// Forces of discs of strength f each against f² times those of strength 1, rms over rms: shares are rounded to 2⁻²⁰
/// once more.
pub const STRENGTH_RATIO: f64 = 1e-5;

// Cold collapse: tests/ring_collapse.rs.

/// A0 of a ring against the paper's, which has two decimals: its rounding, 0.005, and as much for reading R_f.
pub const DELAY: f64 = 0.01;

/// A0 on the coarse mesh and step against the preset's mesh: a tenth of 0.01 for Euler's step, which is late by
/// half a step of 0.05 R0²/D in T = 42 R0²/D, and a tenth for a mesh of spacing 6 R0 in rings 19 R0 apart.
pub const COARSE_DELAY: f64 = 0.002;

/// Radius of a ring against the closed form up to 0.6 T, relative. Euler's step is late by half of 0.05 R0²/D, and
/// t/T is 6e-4 early; in the inner rings, of radius 40 R0 then, what a mesh of spacing 6 R0 does shows as well.
pub const NEWTONIAN_RADIUS: Within = Within(1e-5, 1e-3);

/// The same with the split force, where nothing of the mesh shows in any ring: steps of 0.05 R0²/D of the closed form's
/// equation in binary64 leave 2.75e-4 (ring 9) to 2.86e-4 (ring 3), and forces off by 7e-5 may add a third of that.
pub const SPLIT_NEWTONIAN_RADIUS: Within = Within(2e-4, 3.5e-4);

// Growth of modes: tests/mode_growth.rs.

/// Growth rate of waves k < 0.2 K against Eq. 10, relative, beside the statistical error. Eq. 10 has the pressure of an
/// ideal gas, (k/K)² < 0.04 of the rate; contacts raise it by 4π·0.01 of itself, clusters lower it. A mesh
/// of spacing 4.8 R0 adds 0.4 %, Euler's steps of 0.05 R0²/D add 0.15 %.
pub const GROWTH_OF_LONG_WAVES: f64 = 0.01;

/// Standard errors allowed beside it.
pub const GROWTH_SIGMAS: f64 = 3.0;

/// Standard error of the growth rate, relative, that a test of it must reach for it to say anything.
pub const GROWTH_RESOLUTION: f64 = 0.025;

// Density modes: tests/modes.rs.

/// |ρ̂_k| per disc against the sum that defines it. A phase factor of l ≤ 300 is a product of l rounded ones, of which
/// each is off by 2π·2⁻⁵³: 2e-13 at most, and there are two; most waves are far better.
pub const DENSITY_MODE: f64 = 4e-13;

// Trajectories against binary64: tests/reference_run.rs.

/// Distance between repelling discs and their reference after 20 steps, rms over rms distance covered: the rounding
/// of [`PAIR_FORCE`], which contacts, being stable, do not amplify.
pub const REPELLED_DEVIATION: Within = Within(1e-9, 2.5e-6);

/// The same with attraction by a mesh of h = 0.375 R0, TSC and four-point differences: at contact, 5 h, such a
/// mesh is off by 0.15 % rms, at 1.8 R0 by 0.2 %.
pub const ATTRACTED_DEVIATION: Within = Within(1e-5, 3e-3);

/// Time reached after 20 steps against the reference, relative: the largest force decides each step, and that is a
/// repulsion, of [`PAIR_FORCE`] itself but with a part of the error of the mesh.
pub const REFERENCE_TIME: f64 = 1e-5;

/// The same with the split force at order 7, αh = 0.375 and αr_c = 4.4: such a mesh is off by 2e-6 rms, and what the
/// cut-off leaves out, exp(−4.4²), is nothing beside it.
pub const SPLIT_DEVIATION: Within = Within(1e-7, 5e-6);

/// Its time: [`PAIR_FORCE`] and no more, as nothing of the mesh is to be seen in the largest force.
pub const SPLIT_REFERENCE_TIME: f64 = 4.5e-6;

// Motion of attracting discs: tests/diffusion.rs, tests/boltzmann.rs.

/// How far the centre of 200 cold discs goes in 100 steps, R0. Places are rounded to 9.3e-9 R0, which leaves 2e-9 R0 of the
/// mean, and displacements of up to R0/4 in binary32, as much again for the few that are large.
pub const CENTRE_DRIFT: f64 = 2e-8;

/// Standard error of the density of attracting discs in a bin, relative, that the test of it must reach for it to say
/// anything: attraction makes discs in contact 1.7 times as frequent.
pub const ATTRACTED_RESOLUTION: f64 = 0.03;

// The observed density and its Minkowski functionals: tests/density.rs, tests/minkowski.rs.

/// A disc's share of a node of the observed density, in discs, against the definition in binary64, in which a distance of up to
/// 40 cells is off by some 2⁻⁴⁶ cells. The shares themselves are rounded to 2⁻⁴⁸.
pub const CLOUD_SHARE: f64 = 1.0 / 17_592_186_044_416.0;

/// The sum of the observed density over all nodes, relative: integers that are exact, converted and added in binary64, up to
/// some thousand roundings of 2⁻⁵³.
pub const DENSITY_TOTAL: f64 = 1e-13;

/// Areas and lengths by contours against exact ones, relative to 1 plus their modulus: some hundred squares, each with some ten
/// roundings of 2⁻⁵³.
pub const POLYGON_ROUNDING: f64 = 1e-13;

/// Error of a disc's area and length by contours over that at half the spacing: 4 at second order. Where nodes lie on the circle
/// differs from grid to grid.
pub const QUARTERED: Within = Within(3.3, 4.8);

// Ensembles: tests/ensemble.rs.

/// Mean and standard error of three numbers by two formulas, relative to the largest of them: some ten roundings of
/// 2⁻⁵³ each.
pub const ENSEMBLE_STATISTICS: f64 = 2e-15;

// Shells: tests/shells.rs.

/// Mean force on the discs of a ring of Fig. 12 against that on a shell at λ = `length` (R0), relative to the largest. Multipoles
/// of a ring of m discs meet those of another at the least common multiple of their numbers only, and the square lattice of images
/// turns them by fours, so that discs are shells in the mean. On itself a ring errs by the order of (12/λ)² of one disc's part,
/// 12 R0 being the distance of neighbours: 0.27/λ² in the innermost ring.
pub fn shell_force(length: f64) -> f64 {
    1e-6 + 0.35 / (length * length)
}

/// Mean radius of the rings of Fig. 12 at 0.3 T against shells, relative: Euler's steps of 0.05 R0²/D err by 6e-5, the split
/// force by 7e-5 of the rms force.
pub const SHELL_RADIUS: f64 = 5e-4;
