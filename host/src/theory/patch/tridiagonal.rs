//! Systems of equations in which each unknown meets its two neighbours only.

/// One equation: `before`·x₍ᵢ₋₁₎ + `own`·xᵢ + `after`·x₍ᵢ₊₁₎ = `right`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub before: f64,
    pub own: f64,
    pub after: f64,
    pub right: f64,
}

/// The unknowns, by elimination without pivots: for rows in which `own` outweighs the other two.
pub(super) fn solved(mut rows: Vec<Row>) -> Vec<f64> {
    for index in 1..rows.len() {
        let above = rows[index - 1];
        let row = &mut rows[index];
        let factor = row.before / above.own;
        row.own -= factor * above.after;
        row.right -= factor * above.right;
    }
    let mut unknowns = vec![0.0; rows.len()];
    let mut next = 0.0;
    for (unknown, row) in unknowns.iter_mut().zip(&rows).rev() {
        next = (row.right - row.after * next) / row.own;
        *unknown = next;
    }
    unknowns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unknowns_fulfil_their_equations() {
        let row = |index: usize| {
            let number = index as f64;
            Row { before: -1.0, own: 3.0 + number, after: -0.5 * number, right: number * number - 2.0 }
        };
        let rows: Vec<Row> = (0..6).map(row).collect();
        let found = solved(rows.clone());
        for (index, row) in rows.iter().enumerate() {
            let neighbour =
                |index: Option<usize>| index.and_then(|index| found.get(index)).copied().unwrap_or(0.0);
            let left = row.before * neighbour(index.checked_sub(1))
                + row.own * found[index]
                + row.after * neighbour(Some(index + 1));
            assert!((left - row.right).abs() < 1e-12, "{index}: {left}");
        }
    }
}
