//! Minkowski functionals by marching squares: a boundary of straight pieces through interpolated points.
//!
//! The boundary crosses the line between two neighbouring nodes, one in the domain and one not, where linear interpolation
//! gives the threshold; crossings are joined by straight pieces within each square of four nodes. Where two diagonal nodes
//! are in the domain and the other two are not (a saddle), the diagonal is connected if the mean of the four values exceeds
//! the threshold, and cut otherwise. Area, length and Euler characteristic are those of the one domain of polygons that
//! results. For a smooth field, area and length are right to second order in the spacing.
//!
//! In: a [`Density`] and a threshold of its unit. Out: areas in R0², lengths in R0.
//!
//! ```
//! use meniscus::observables::density::Density;
//! use meniscus::observables::minkowski::by_contours;
//! use meniscus_core::torus::Torus;
//!
//! // A cone: the threshold is crossed 20 R0 away from the middle.
//! let torus = Torus::new(64.0).unwrap();
//! let distance = |node: usize| ((node / 64) as f64 - 32.0).hypot((node % 64) as f64 - 32.0);
//! let cone = (0..64 * 64).map(|node| -distance(node)).collect();
//! let disc = by_contours(&Density::from_values(&torus, cone).unwrap(), -20.0);
//! assert!((disc.shape().unwrap() - 1.0).abs() < 1e-3);
//! ```

use super::{Density, Minkowski};

/// The functionals of the domain of polygons where the interpolated density exceeds `threshold`.
///
/// Nodes whose value is the threshold itself are not in the domain.
#[must_use]
pub fn by_contours(density: &Density, threshold: f64) -> Minkowski {
    let (mut area, mut length, mut euler) = (0.0, 0.0, 0);
    for values in density.squares() {
        let square = Square { values, threshold };
        let piece = square.piece();
        area += piece.area;
        length += piece.length;
        euler += square.euler();
    }
    let spacing = density.spacing();
    Minkowski { area: area * spacing * spacing, length: length * spacing, euler }
}

/// A square between four nodes, in units of the spacing.
struct Square {
    /// Values at the corners, anticlockwise.
    values: [f64; 4],
    threshold: f64,
}

/// What of a square is in the domain, in units of the spacing.
struct Piece {
    area: f64,
    /// Length of the boundary inside the square.
    length: f64,
}

/// The corners of a square, anticlockwise.
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

impl Square {
    fn inside(&self) -> [bool; 4] {
        self.values.map(|value| value > self.threshold)
    }

    /// Whether two diagonal corners are in the domain and the other two are not.
    fn is_saddle(&self) -> bool {
        let [first, second, third, fourth] = self.inside();
        first == third && second == fourth && first != second
    }

    /// Whether the mean of the corners is in the domain.
    fn middle_is_inside(&self) -> bool {
        // Of differences, so that turning the square or adding a constant hardly changes a tie.
        let [first, second, third, fourth] = self.values.map(|value| value - self.threshold);
        (first + third) + (second + fourth) > 0.0
    }

    /// Area and boundary of what is in the domain.
    fn piece(&self) -> Piece {
        // A diagonal that is cut is what a connected diagonal of the complement leaves.
        if self.is_saddle() && !self.middle_is_inside() {
            let complement = self.connected(false);
            return Piece { area: 1.0 - complement.area, length: complement.length };
        }
        self.connected(true)
    }

    /// Area and boundary of the one polygon that holds all corners that are in the domain, or all that are not.
    fn connected(&self, inside: bool) -> Piece {
        let member = self.inside().map(|corner| corner == inside);
        let mut polygon = Polygon::default();
        for corner in 0..4 {
            let next = (corner + 1) % 4;
            if member[corner] {
                polygon.to(CORNERS[corner], false);
            }
            if member[corner] != member[next] {
                polygon.to(self.crossing(corner, next), member[next]);
            }
        }
        polygon.close()
    }

    /// Where the threshold is crossed between two corners.
    fn crossing(&self, from: usize, to: usize) -> [f64; 2] {
        let share = (self.threshold - self.values[from]) / (self.values[to] - self.values[from]);
        [0, 1].map(|axis| CORNERS[from][axis] + share * (CORNERS[to][axis] - CORNERS[from][axis]))
    }

    /// The square's share of vertices − edges + faces, counted with its first corner and the two sides that meet there.
    ///
    /// What of the domain is next to a single node, or to the line between two, shrinks onto it. So nodes are vertices, the
    /// lines between two nodes in the domain are edges, and so are connected diagonals; squares with four nodes in the domain
    /// are faces.
    fn euler(&self) -> i64 {
        let [here, right, across, above] = self.inside();
        let diagonal = self.is_saddle() && self.middle_is_inside();
        let edges = i64::from(here && right) + i64::from(here && above) + i64::from(diagonal);
        i64::from(here) - edges + i64::from(here && right && across && above)
    }
}

/// A polygon that is walked around anticlockwise.
#[derive(Default)]
struct Polygon {
    first: Option<([f64; 2], bool)>,
    last: [f64; 2],
    twice_the_area: f64,
    length: f64,
}

impl Polygon {
    /// Goes on to `point`, along the boundary of the domain or not.
    fn to(&mut self, point: [f64; 2], along_boundary: bool) {
        if self.first.is_none() {
            self.first = Some((point, along_boundary));
        } else {
            let ([from_x, from_y], [x, y]) = (self.last, point);
            self.twice_the_area += from_x * y - x * from_y;
            if along_boundary {
                self.length += libm::hypot(x - from_x, y - from_y);
            }
        }
        self.last = point;
    }

    fn close(mut self) -> Piece {
        if let Some((point, along_boundary)) = self.first {
            self.to(point, along_boundary);
        }
        Piece { area: 0.5 * self.twice_the_area, length: self.length }
    }
}
