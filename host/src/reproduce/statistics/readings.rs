//! What is read off a mean curve: where it is highest, how steep it is, when it reaches a level.

use super::Curve;

/// Where a curve is highest, and how high: the vertex of the parabola that fits best within `window` about the largest
/// mean over `window`. At an end of the curve, the end. None for a curve without points.
#[must_use]
pub fn maximum(curve: &[(f64, f64)], window: f64) -> Option<(f64, f64)> {
    let near = |time: f64, reach: f64| -> Curve {
        curve.iter().filter(|(other, _)| (other - time).abs() <= reach + 1e-9).copied().collect()
    };
    let smooth = |time: f64| {
        let around = near(time, 0.5 * window);
        around.iter().map(|(_, value)| value).sum::<f64>() / around.len() as f64
    };
    let (mut best, mut highest) = (*curve.first()?, f64::NEG_INFINITY);
    for &(time, value) in curve {
        let level = smooth(time);
        if level > highest {
            (best, highest) = ((time, value), level);
        }
    }
    let around = near(best.0, window);
    let vertex = parabola(&around, best.0).and_then(|[constant, slope, curvature]| {
        let shift = -0.5 * slope / curvature;
        (curvature < 0.0 && shift.abs() <= window).then_some((best.0 + shift, constant + 0.5 * slope * shift))
    });
    let (first, last) = (curve.first()?.0, curve.last()?.0);
    Some(match vertex {
        Some((time, value)) if time > first && time < last => (time, value),
        _ => best,
    })
}

/// Constant, slope and curvature of the parabola in `time − origin` that fits best.
fn parabola(points: &[(f64, f64)], origin: f64) -> Option<[f64; 3]> {
    let mut powers = [0.0; 5];
    let mut moments = [0.0; 3];
    for &(time, value) in points {
        let mut power = 1.0;
        for (degree, sum) in powers.iter_mut().enumerate() {
            *sum += power;
            if let Some(moment) = moments.get_mut(degree) {
                *moment += power * value;
            }
            power *= time - origin;
        }
    }
    let [n, a, b, c, d] = powers;
    let [u, v, w] = moments;
    // Cramer's rule.
    let determinant = |[p, q, r]: [f64; 3], [s, t, x]: [f64; 3], [y, z, o]: [f64; 3]| {
        p * (t * o - x * z) - q * (s * o - x * y) + r * (s * z - t * y)
    };
    let whole = determinant([n, a, b], [a, b, c], [b, c, d]);
    let solved = [
        determinant([u, a, b], [v, b, c], [w, c, d]) / whole,
        determinant([n, u, b], [a, v, c], [b, w, d]) / whole,
        determinant([n, a, u], [a, b, v], [b, c, w]) / whole,
    ];
    (points.len() >= 3 && solved.iter().all(|number| number.is_finite())).then_some(solved)
}

/// Slope, value at time zero and coefficient of determination of the line that fits best; None with fewer than three
/// points.
#[must_use]
pub fn line(points: &[(f64, f64)]) -> Option<[f64; 3]> {
    let count = points.len() as f64;
    let middle = |pick: fn(&(f64, f64)) -> f64| points.iter().map(pick).sum::<f64>() / count;
    let (x, y) = (middle(|point| point.0), middle(|point| point.1));
    let sum =
        |pick: &dyn Fn(f64, f64) -> f64| -> f64 { points.iter().map(|&(a, b)| pick(a - x, b - y)).sum() };
    let (xx, xy, yy) = (sum(&|a, _| a * a), sum(&|a, b| a * b), sum(&|_, b| b * b));
    let slope = xy / xx;
    (points.len() >= 3 && xx > 0.0)
        .then(|| [slope, y - slope * x, if yy > 0.0 { slope * xy / yy } else { 1.0 }])
}

/// The first time at which a curve reaches `level` from below, between points by a straight line.
#[must_use]
pub fn reaches(curve: &[(f64, f64)], level: f64) -> Option<f64> {
    let first = curve.first().filter(|(_, value)| *value >= level).map(|(time, _)| *time);
    first.or_else(|| {
        curve.windows(2).find_map(|pair| match pair {
            [(earlier, low), (later, high)] if *low < level && *high >= level => {
                Some(earlier + (later - earlier) * (level - low) / (high - low))
            }
            _ => None,
        })
    })
}

/// The value of a curve at `time`, between points by a straight line; None before its first point and after its last.
#[must_use]
pub fn interpolated(curve: &[(f64, f64)], time: f64) -> Option<f64> {
    let exact = curve.iter().find(|point| point.0 == time).map(|point| point.1);
    exact.or_else(|| {
        let around =
            |pair: &&[(f64, f64)]| matches!(pair, [before, after] if before.0 < time && time < after.0);
        let [before, after] = curve.windows(2).find(around)? else { return None };
        Some(before.1 + (after.1 - before.1) * (time - before.0) / (after.0 - before.0))
    })
}

/// The mean of a curve over times from `from` to `to`; None if no point lies there.
#[must_use]
pub fn average(curve: &[(f64, f64)], from: f64, to: f64) -> Option<f64> {
    let inside: Vec<f64> =
        curve.iter().filter(|(time, _)| (from..=to).contains(time)).map(|(_, value)| *value).collect();
    (!inside.is_empty()).then(|| inside.iter().sum::<f64>() / inside.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(count: u32, step: f64, value: impl Fn(f64) -> f64) -> Curve {
        (0..count).map(|k| step * f64::from(k)).map(|time| (time, value(time))).collect()
    }

    #[test]
    fn the_vertex_of_a_noisy_hill_is_found() {
        let hill = |time: f64| 5.0 - (time - 1.5) * (time - 1.5) + 0.02 * libm::sin(40.0 * time);
        let (time, value) = maximum(&curve(61, 0.05, hill), 0.4).unwrap();
        assert!((time - 1.5).abs() < 0.02 && (value - 5.0).abs() < 0.02, "{time} {value}");
    }

    #[test]
    fn a_curve_that_rises_to_its_end_is_highest_there() {
        let (time, _) = maximum(&curve(31, 0.1, |time| time), 0.3).unwrap();
        assert!(time > 2.7, "{time}");
        assert_eq!(maximum(&[], 1.0), None);
    }

    #[test]
    fn a_line_is_found() {
        let [slope, start, determination] = line(&curve(10, 0.5, |time| 2.0 * time - 1.0)).unwrap();
        assert!(
            (slope - 2.0).abs() < 1e-12 && (start + 1.0).abs() < 1e-12 && (determination - 1.0).abs() < 1e-12
        );
        assert_eq!(line(&[(0.0, 1.0), (1.0, 2.0)]), None);
    }

    #[test]
    fn a_level_is_reached_between_points() {
        assert_eq!(reaches(&curve(4, 1.0, |time| 2.0 * time), 3.0), Some(1.5));
        assert_eq!(reaches(&curve(4, 1.0, |time| 2.0 * time), 7.0), None);
        let steep = curve(4, 1.0, |time| time * time);
        assert_eq!([0.0, 2.5, 3.0].map(|time| interpolated(&steep, time)), [Some(0.0), Some(6.5), Some(9.0)]);
        assert_eq!(interpolated(&steep, 3.1), None);
        assert_eq!(average(&curve(5, 1.0, |time| time), 1.0, 3.0), Some(2.0));
    }
}
