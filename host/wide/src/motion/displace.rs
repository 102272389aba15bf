//! The move.

use crate::lanes::{Kernel, Lanes, Level};
use crate::pieces::{Divisible, place};

/// Moves one coordinate of discs.
pub(super) struct Displace<'a> {
    pub level: Level,
    /// Bits of coordinates, unit L·2⁻³².
    pub coordinates: &'a mut [u32],
    /// Borders crossed, in two's complement.
    pub crossings: &'a mut [u32],
    /// Displacements, unit L·2⁻³², in two's complement.
    pub units: &'a [u32],
}

impl Divisible for Displace<'_> {
    type Output = ();

    fn divide(self, first: usize, pieces: usize) -> (Self, Self) {
        let Self { level, coordinates, crossings, units } = self;
        let at = place(coordinates.len().min(crossings.len()).min(units.len()), first, pieces);
        let (coordinates, coordinates_after) = coordinates.split_at_mut(at);
        let (crossings, crossings_after) = crossings.split_at_mut(at);
        let (units, units_after) = units.split_at(at);
        let before = Self { level, coordinates, crossings, units };
        let (coordinates, crossings, units) = (coordinates_after, crossings_after, units_after);
        (before, Self { level, coordinates, crossings, units })
    }

    fn run(self) {
        self.level.dispatch(self);
    }

    fn unite((): (), (): ()) {}
}

impl Kernel for Displace<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { coordinates, crossings, units, .. } = self;
        let (one, none) = (lanes.splat_u32(1), lanes.splat_u32(0));
        let places = coordinates.chunks_mut(L::WIDTH).zip(crossings.chunks_mut(L::WIDTH));
        for ((coordinates, crossings), units) in places.zip(units.chunks(L::WIDTH)) {
            let (before, units) = (lanes.load_u32(coordinates), lanes.load_u32(units));
            let after = lanes.add_u32(before, units);
            // A carry is a border crossed, but for negative displacements, of which having none is.
            let carry = lanes.select_u32(lanes.less_u32(after, before), one, none);
            let crossed = lanes.add_u32(lanes.sar(units, 31), carry);
            lanes.store_u32(after, coordinates);
            lanes.store_u32(lanes.add_u32(lanes.load_u32(crossings), crossed), crossings);
        }
    }
}
