//! The capillary pair force and energy as direct sums over the periodic images of the box.

use super::bessel::{k0, k1};
use super::minimum_image;

/// Shells whose terms could not reach this fraction of the nearest image's term are left out.
const NEGLIGIBLE_FRACTION: f64 = 1e-18;

/// The capillary attraction of two discs in a square periodic box, V(d) = −V₀ K₀(d/λ) over all images.
///
/// Shells of images are summed whole, (2n+1)² − (2n−1)² boxes at a time. Their number grows as 40 λ/L, so
/// that this is a reference for λ up to about the box; a K₁ law without screening has no such sum.
#[derive(Clone, Copy, Debug)]
pub struct ImageSum {
    side: f64,
    capillary_strength: f64,
    capillary_length: f64,
}

impl ImageSum {
    /// A box of this `side` (R₀), with V₀ = `capillary_strength` (k_B T) and λ = `capillary_length` (R₀).
    pub fn new(side: f64, capillary_strength: f64, capillary_length: f64) -> Self {
        assert!(capillary_length.is_finite(), "without screening the sum over the images does not converge");
        Self { side, capillary_strength, capillary_length }
    }

    /// Force (k_B T/R₀) on a disc at the origin due to a disc at (`dx`, `dy`) (R₀) and all its images:
    /// each image at d attracts with (V₀/λ) K₁(d/λ).
    pub fn pair_force(&self, dx: f64, dy: f64) -> [f64; 2] {
        let [x, y] = self.sum(dx, dy, |x, y, distance| {
            let magnitude = k1(distance / self.capillary_length);
            [magnitude * x / distance, magnitude * y / distance]
        });
        let unit = self.capillary_strength / self.capillary_length;
        [unit * x, unit * y]
    }

    /// Energy (k_B T) of a disc at the origin with a disc at (`dx`, `dy`) (R₀) and all its images:
    /// −V₀ Σ K₀(d/λ).
    pub fn pair_energy(&self, dx: f64, dy: f64) -> f64 {
        let [sum, _] = self.sum(dx, dy, |_, _, distance| [k0(distance / self.capillary_length), 0.0]);
        -self.capillary_strength * sum
    }

    /// Sum of `term(x, y, distance)` over the images of (`dx`, `dy`).
    fn sum(&self, dx: f64, dy: f64, term: impl Fn(f64, f64, f64) -> [f64; 2]) -> [f64; 2] {
        let x = minimum_image(dx, self.side);
        let y = minimum_image(dy, self.side);
        let shells = self.shells(libm::hypot(x, y));
        let mut total = [0.0; 2];
        // The distant, small terms come first, so that none is lost to rounding.
        for shell in (0..=shells).rev() {
            for (column, row) in boxes_of_shell(shell) {
                let image_x = x + column as f64 * self.side;
                let image_y = y + row as f64 * self.side;
                let [first, second] = term(image_x, image_y, libm::hypot(image_x, image_y));
                total[0] += first;
                total[1] += second;
            }
        }
        total
    }

    /// The number of the last shell that can matter beside a nearest image at this distance: no image of
    /// shell n is nearer than (n − ½)L, and K₀ < K₁.
    fn shells(&self, nearest: f64) -> i32 {
        let negligible = NEGLIGIBLE_FRACTION * k0(nearest / self.capillary_length);
        let largest_sum = |shell: i32| {
            let distance = (f64::from(shell) - 0.5) * self.side;
            8.0 * f64::from(shell) * k1(distance / self.capillary_length)
        };
        let mut shell = 0;
        while largest_sum(shell + 1) > negligible {
            shell += 1;
        }
        shell
    }
}

/// Columns and rows of the boxes of a square shell: the larger of |column|, |row| is `shell`.
fn boxes_of_shell(shell: i32) -> impl Iterator<Item = (i32, i32)> {
    let along = -shell..=shell;
    along.flat_map(move |column| {
        let step = if column.abs() == shell { 1 } else { 2 * shell };
        (-shell..=shell).step_by(step.max(1) as usize).map(move |row| (column, row))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_has_eight_boxes_per_unit_of_its_number() {
        assert_eq!(boxes_of_shell(0).collect::<Vec<_>>(), [(0, 0)]);
        for shell in 1..6 {
            let boxes: Vec<_> = boxes_of_shell(shell).collect();
            assert_eq!(boxes.len(), 8 * shell as usize);
            assert!(boxes.iter().all(|(column, row)| column.abs().max(row.abs()) == shell));
        }
    }

    #[test]
    fn a_close_pair_feels_the_bare_attraction() {
        let images = ImageSum::new(500.0, 0.89, 5.0);
        let [x, y] = images.pair_force(3.0, -4.0);
        let bare = 0.89 / 5.0 * k1(1.0);
        assert!((x / (0.6 * bare) - 1.0).abs() < 1e-15);
        assert!((y / (-0.8 * bare) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn force_is_minus_the_gradient_of_the_energy() {
        let images = ImageSum::new(50.0, 0.89, 27.0);
        let (x, y, h) = (7.0, -11.0, 0.01);
        // The other disc moves by (h, 0): the force on it is the opposite of that on the disc at the origin.
        let difference = |h: f64| (images.pair_energy(x + h, y) - images.pair_energy(x - h, y)) / (2.0 * h);
        let gradient = (4.0 * difference(h) - difference(2.0 * h)) / 3.0;
        assert!((gradient / images.pair_force(x, y)[0] - 1.0).abs() < 1e-10);
    }

    #[test]
    fn force_vanishes_half_a_box_away() {
        let [x, y] = ImageSum::new(50.0, 0.89, 27.0).pair_force(25.0, 25.0);
        assert!(x.abs() < 1e-15 && y.abs() < 1e-15);
    }
}
