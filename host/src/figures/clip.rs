//! What of a line is inside of a plotting area, how it is broken into dashes, and how many places it needs.

use super::canvas::Place;
use super::chart::Dash;

/// A plotting area, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Rectangle {
    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub(super) fn contains(&self, (x, y): Place) -> bool {
        let within = |at: f64, from: f64, to: f64| at >= from - ROUNDING && at <= to + ROUNDING;
        within(x, self.left, self.right()) && within(y, self.top, self.bottom())
    }

    /// The part of a straight line that is inside (Liang and Barsky).
    fn part(&self, from: Place, to: Place) -> Option<(Place, Place)> {
        let along = (to.0 - from.0, to.1 - from.1);
        let sides = [
            (-along.0, from.0 - self.left),
            (along.0, self.right() - from.0),
            (-along.1, from.1 - self.top),
            (along.1, self.bottom() - from.1),
        ];
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for (speed, distance) in sides {
            if speed == 0.0 {
                if distance < 0.0 {
                    return None;
                }
            } else if speed < 0.0 {
                enters = enters.max(distance / speed);
            } else {
                leaves = leaves.min(distance / speed);
            }
        }
        let at = |part: f64| (from.0 + part * along.0, from.1 + part * along.1);
        (enters <= leaves).then(|| (at(enters), at(leaves)))
    }

    /// The parts of a line through `places` that are inside.
    pub(super) fn parts(&self, places: &[Place]) -> Vec<Vec<Place>> {
        let mut parts: Vec<Vec<Place>> = Vec::new();
        for pair in places.windows(2) {
            let &[from, to] = pair else { continue };
            let Some((from, to)) = self.part(from, to) else { continue };
            match parts.last_mut() {
                Some(part) if part.last() == Some(&from) => part.push(to),
                _ => parts.push(vec![from, to]),
            }
        }
        parts
    }
}

/// How far a place may be outside by rounding, pixels.
const ROUNDING: f64 = 1e-6;

/// Width of the columns of which a line needs the first, lowest, highest and last place only, pixels.
const COLUMN: f64 = 0.4;

/// A line that looks the same with fewer places.
pub(super) fn thinned(places: &[Place]) -> Vec<Place> {
    let column = |place: &Place| libm::floor(place.0 / COLUMN);
    let mut kept = Vec::new();
    for run in places.chunk_by(|one, other| column(one) == column(other)) {
        let by_height = |one: &usize, other: &usize| run[*one].1.total_cmp(&run[*other].1);
        let lowest = (0..run.len()).max_by(by_height).unwrap_or(0);
        let highest = (0..run.len()).min_by(by_height).unwrap_or(0);
        let mut needed = [0, lowest, highest, run.len() - 1];
        needed.sort_unstable();
        for (number, at) in needed.iter().enumerate() {
            if number == 0 || needed.get(number - 1) != Some(at) {
                kept.extend(run.get(*at));
            }
        }
    }
    kept
}

/// Lengths drawn and left out in turn, pixels.
fn pattern(dash: Dash) -> &'static [f64] {
    match dash {
        Dash::Solid => &[],
        Dash::Dashed => &[7.0, 4.0],
        Dash::Dotted => &[1.6, 2.6],
        Dash::DashDotted => &[8.0, 3.0, 1.6, 3.0],
    }
}

/// A line broken into dashes.
pub(super) fn dashed(places: &[Place], dash: Dash) -> Vec<Vec<Place>> {
    let pattern = pattern(dash);
    if pattern.is_empty() {
        return vec![places.to_vec()];
    }
    let mut dashes = Vec::new();
    let mut number = 0;
    let mut left = pattern.first().copied().unwrap_or(1.0);
    let mut stroke: Vec<Place> = places.first().copied().into_iter().collect();
    for pair in places.windows(2) {
        let &[mut from, to] = pair else { continue };
        loop {
            let (x, y) = (to.0 - from.0, to.1 - from.1);
            let length = libm::hypot(x, y);
            // So that a length that is no number ends the line, too.
            if !matches!(length.partial_cmp(&left), Some(std::cmp::Ordering::Greater)) {
                left -= length;
                stroke.push(to);
                break;
            }
            from = (from.0 + x * left / length, from.1 + y * left / length);
            stroke.push(from);
            if number % 2 == 0 {
                dashes.push(std::mem::take(&mut stroke));
            }
            stroke = vec![from];
            number += 1;
            left = pattern.get(number % pattern.len()).copied().unwrap_or(1.0);
        }
    }
    if number % 2 == 0 {
        dashes.push(stroke);
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rectangle = Rectangle { left: 10.0, top: 20.0, width: 100.0, height: 50.0 };

    #[test]
    fn lines_are_cut_at_the_border() {
        let parts = AREA.parts(&[(0.0, 30.0), (20.0, 30.0), (20.0, 200.0), (60.0, 200.0), (60.0, 0.0)]);
        let expected = [vec![(10.0, 30.0), (20.0, 30.0), (20.0, 70.0)], vec![(60.0, 70.0), (60.0, 20.0)]];
        assert_eq!(parts, expected);
        assert!(AREA.parts(&[(0.0, 0.0), (5.0, 90.0)]).is_empty());
    }

    #[test]
    fn thinning_keeps_ends_and_extremes() {
        let wild: Vec<Place> = (0..1000).map(|n| (f64::from(n) * 1e-4, f64::from(n * 37 % 101))).collect();
        let kept = thinned(&wild);
        // The first place is the lowest.
        assert_eq!(kept.len(), 3);
        assert_eq!((kept.first(), kept.last()), (wild.first(), wild.last()));
        assert!(kept.iter().any(|place| place.1 == 0.0) && kept.iter().any(|place| place.1 == 100.0));
    }

    #[test]
    fn dashes_have_their_lengths() {
        let dashes = dashed(&[(0.0, 0.0), (3.0, 0.0), (22.0, 0.0)], Dash::Dashed);
        let ends: Vec<(f64, f64)> = dashes.iter().map(|dash| (dash[0].0, dash[dash.len() - 1].0)).collect();
        assert_eq!(ends, [(0.0, 7.0), (11.0, 18.0), (22.0, 22.0)][..ends.len()]);
        assert!(ends.len() >= 2);
    }
}
