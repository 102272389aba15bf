//! The mesh problem that every contender solves: Table I's interface on a mesh of any size, spacing 500/512 R0.

use meniscus_core::parameters::Parameters;

/// The paper's scheme on a mesh of `grid` nodes a side.
pub fn parameters(grid: usize) -> Parameters {
    Parameters { side: grid as f64 * 500.0 / 512.0, grid, ..Parameters::PAPER }
}

/// Mass of node `index`, unit 2⁻²⁰ discs: noise that every language can make.
pub fn mass(index: usize) -> u32 {
    (index as u32).wrapping_mul(2_654_435_761) >> 12
}

/// The nodes whose fields are compared.
pub fn checked_nodes(grid: usize) -> impl Iterator<Item = usize> {
    (0..64_u32).map(move |index| index.wrapping_mul(2_654_435_761) as usize % (grid * grid))
}
