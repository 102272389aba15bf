//! Clusters minus holes, by flooding them one after the other.

use meniscus::observables::density::Density;

/// The number of connected components of the nodes that are members; the border of the field is one.
fn components(
    grid: usize,
    connected: impl Fn(usize, usize) -> bool,
    member: impl Fn(usize) -> bool,
) -> usize {
    let mut seen: Vec<bool> = (0..grid * grid).map(|node| !member(node)).collect();
    let mut count = 0;
    for start in 0..grid * grid {
        if seen[start] {
            continue;
        }
        count += 1;
        seen[start] = true;
        let mut waiting = vec![start];
        while let Some(node) = waiting.pop() {
            let (x, y) = (node / grid, node % grid);
            for near_x in x.saturating_sub(1)..=(x + 1).min(grid - 1) {
                for near_y in y.saturating_sub(1)..=(y + 1).min(grid - 1) {
                    let near = near_x * grid + near_y;
                    if !seen[near] && connected(node, near) {
                        seen[near] = true;
                        waiting.push(near);
                    }
                }
            }
        }
    }
    count
}

fn are_diagonal(grid: usize, first: usize, second: usize) -> bool {
    first / grid != second / grid && first % grid != second % grid
}

/// Clusters minus holes, in a field with a rim that is not in the domain. Nodes beside each other are connected; diagonal
/// ones, in the domain and out of it, by the two rules.
pub fn labelled(
    grid: usize,
    domain: &[bool],
    inside: impl Fn(usize, usize) -> bool,
    outside: impl Fn(usize, usize) -> bool,
) -> i64 {
    let clusters = components(
        grid,
        |first, second| !are_diagonal(grid, first, second) || inside(first, second),
        |node| domain[node],
    );
    let background = components(
        grid,
        |first, second| !are_diagonal(grid, first, second) || outside(first, second),
        |node| !domain[node],
    );
    clusters as i64 - (background as i64 - 1)
}

/// Whether the mean of a square, of which two diagonal nodes are given, exceeds the threshold.
pub fn mean_exceeds(density: &Density, threshold: f64, first: usize, second: usize) -> bool {
    let grid = density.grid();
    let corners = [first, second, first / grid * grid + second % grid, second / grid * grid + first % grid];
    corners.map(|node| density.values()[node] - threshold).iter().sum::<f64>() > 0.0
}
