//! The far part of the split capillary force on a mesh: the optimal influence function.
//!
//! What the near part (see [`crate::near_part`]) leaves is the smooth force of the potential with Fourier transform
//! Ĝ(k) = 2πV0·exp(−(k² + κ²)/(4α²))/(k² + κ²). Of all influence functions, with assignment by the B-spline of order
//! p, whose transform is U(k) = [sinc(k_x h/2)·sinc(k_y h/2)]ᵖ, and the gradient i·D(k), the one whose force has the
//! least mean square error is that of Hockney and Eastwood (*Computer Simulation Using Particles*, Eq. 8-22)
//!
//! G(k) = D(k)·Σ_m U²(k_m) R(k_m) / (|D(k)|²·[Σ_m U²(k_m)]²), R(k) = k·Ĝ(k), k_m = k + 2πm/h,
//!
//! the sums over the aliases of a mode. Here m runs from −[`ALIASES`] to [`ALIASES`] along each axis, which leaves out
//! less than 10⁻⁶ of the force (10⁻⁵ in order 2).
//!
//! ```
//! use meniscus_core::optimal::OptimalInfluence;
//! use meniscus_core::parameters::Assignment;
//!
//! let optimal = OptimalInfluence {
//!     grid: 64, side: 64.0, order: Assignment::Order5.order(), splitting: 0.5, capillary_length: f64::INFINITY,
//! };
//! // A long wave, which assignment and aliases hardly touch: exp(−k²/4α²)/k².
//! let k_squared = (2.0 * std::f64::consts::PI / 64.0_f64).powi(2);
//! assert!((optimal.at(1, 0) * k_squared - (-k_squared).exp()).abs() < 0.01);
//! ```

use core::f64::consts::PI;

/// How many aliases on either side count.
pub const ALIASES: usize = 2;

/// All aliases of a frequency along one axis.
const COUNT: usize = 2 * ALIASES + 1;

/// What the optimal influence function depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OptimalInfluence {
    /// Nodes M along a side, at least 2.
    pub grid: usize,
    /// Side L, R0.
    pub side: f64,
    /// Order p of the assignment.
    pub order: usize,
    /// Splitting α, 1/R0.
    pub splitting: f64,
    /// Capillary length λ, R0; infinity allowed.
    pub capillary_length: f64,
}

impl OptimalInfluence {
    /// G(k)/(2πV0) at k = 2π(l, m)/L for l, m in 0 … M/2, R0². Symmetric in l and m; 0 where the gradient is, at k = 0
    /// and where each component is 0 or Nyquist's.
    #[must_use]
    pub fn at(&self, l: usize, m: usize) -> f64 {
        // In one order, so that both ways give the same bits.
        let (x, y) = (self.along(l.min(m)), self.along(l.max(m)));
        let gradient_squared = x.gradient * x.gradient + y.gradient * y.gradient;
        if gradient_squared == 0.0 {
            return 0.0;
        }
        let kappa = 1.0 / self.capillary_length;
        let screening = kappa * kappa;
        let mut sum = 0.0;
        for alias_x in &x.aliases {
            for alias_y in &y.aliases {
                let along = x.gradient * alias_x.wave_number + y.gradient * alias_y.wave_number;
                let squared = alias_x.squared + alias_y.squared + screening;
                sum += alias_x.weight * alias_y.weight * along / squared;
            }
        }
        let assigned = x.assigned * y.assigned;
        let front = libm::exp(-screening / (4.0 * self.splitting * self.splitting));
        front * sum / (gradient_squared * assigned * assigned)
    }

    /// A frequency 0 … M/2 along one axis with its aliases.
    fn along(&self, frequency: usize) -> Axis {
        let grid = self.grid as f64;
        let gradient = if 2 * frequency == self.grid { 0.0 } else { 2.0 * PI * frequency as f64 / self.side };
        let sine = libm::sin(PI * frequency as f64 / grid);
        let mut axis = Axis { gradient, assigned: 0.0, aliases: [Alias::default(); COUNT] };
        for (index, alias) in axis.aliases.iter_mut().enumerate() {
            let cycles = frequency as f64 + (index as f64 - ALIASES as f64) * grid;
            let sinc = if cycles == 0.0 { 1.0 } else { sine * grid / (PI * cycles) };
            let assigned = whole_power(sinc * sinc, self.order);
            alias.wave_number = 2.0 * PI * cycles / self.side;
            alias.squared = alias.wave_number * alias.wave_number;
            alias.weight = assigned * libm::exp(-alias.squared / (4.0 * self.splitting * self.splitting));
            axis.assigned += assigned;
        }
        axis
    }
}

/// One alias along one axis.
#[derive(Clone, Copy, Default)]
struct Alias {
    /// k, 1/R0.
    wave_number: f64,
    /// k².
    squared: f64,
    /// U²(k)·exp(−k²/(4α²)).
    weight: f64,
}

/// A frequency along one axis.
struct Axis {
    /// D, 1/R0.
    gradient: f64,
    /// Σ U² over the aliases.
    assigned: f64,
    aliases: [Alias; COUNT],
}

fn whole_power(base: f64, exponent: usize) -> f64 {
    let mut power = 1.0;
    for _ in 0..exponent {
        power *= base;
    }
    power
}
