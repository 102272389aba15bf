//! From forces and noise to displacements, Δr = F·Δt + ξ.

use super::kick::Kick;
use crate::lanes::{Kernel, Lanes, Level};
use crate::pieces::{Divisible, place};
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::units::FORCE_UNITS;

/// Finds the displacements of discs.
pub(super) struct FindDisplacements<'a, K> {
    pub level: Level,
    pub step: Displacement,
    pub kick: K,
    pub ids: &'a [u32],
    /// Bits of forces, unit 2⁻²⁴ kBT/R0.
    pub force_x: &'a [u64],
    pub force_y: &'a [u64],
    /// Bits of displacements, unit L·2⁻³².
    pub along_x: &'a mut [u32],
    pub along_y: &'a mut [u32],
}

impl<K: Kick> Divisible for FindDisplacements<'_, K> {
    type Output = Result<(), HalfBox>;

    fn divide(self, first: usize, pieces: usize) -> (Self, Self) {
        let Self { level, step, kick, ids, force_x, force_y, along_x, along_y } = self;
        let lengths = [ids.len(), force_x.len(), force_y.len(), along_x.len(), along_y.len()];
        let at = place(lengths.into_iter().min().unwrap_or(0), first, pieces);
        let (ids, ids_after) = ids.split_at(at);
        let (force_x, force_x_after) = force_x.split_at(at);
        let (force_y, force_y_after) = force_y.split_at(at);
        let (along_x, along_x_after) = along_x.split_at_mut(at);
        let (along_y, along_y_after) = along_y.split_at_mut(at);
        let before = Self { level, step, kick, ids, force_x, force_y, along_x, along_y };
        let (ids, force_x, force_y) = (ids_after, force_x_after, force_y_after);
        let (along_x, along_y) = (along_x_after, along_y_after);
        (before, Self { level, step, kick, ids, force_x, force_y, along_x, along_y })
    }

    fn run(self) -> Result<(), HalfBox> {
        self.level.dispatch(self)
    }

    fn unite(first: Result<(), HalfBox>, second: Result<(), HalfBox>) -> Result<(), HalfBox> {
        first.and(second)
    }
}

impl<K: Kick> Kernel for FindDisplacements<'_, K> {
    type Output = Result<(), HalfBox>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Result<(), HalfBox> {
        let Self { step, kick, ids, force_x, force_y, along_x, along_y, .. } = self;
        let forces = force_x.chunks(L::WIDTH).zip(force_y.chunks(L::WIDTH));
        let targets = along_x.chunks_mut(L::WIDTH).zip(along_y.chunks_mut(L::WIDTH));
        for ((ids, (force_x, force_y)), (along_x, along_y)) in ids.chunks(L::WIDTH).zip(forces).zip(targets) {
            let (kick_x, kick_y) = kick.of(lanes, ids);
            let x = component(lanes, &step, lanes.load_u64(force_x), kick_x);
            let y = component(lanes, &step, lanes.load_u64(force_y), kick_y);
            if let (Some(x), Some(y)) = (x, y) {
                lanes.store_u32(x, along_x);
                lanes.store_u32(y, along_y);
                continue;
            }
            one_by_one(&step, ids, (force_x, force_y), (along_x, along_y))?;
        }
        Ok(())
    }
}

/// F·Δt + ξ along one axis in units of L·2⁻³², unless a disc's is half a box or no number.
#[inline(always)]
fn component<L: Lanes>(lanes: L, step: &Displacement, force: L::U64, kick: L::F32) -> Option<L::U32> {
    const FORCE_UNIT: f32 = 1.0 / FORCE_UNITS;
    const HALF_BOX: f32 = 2_147_483_648.0;
    let force = lanes.mul(lanes.of_i64(force), lanes.splat(FORCE_UNIT));
    let by_force = lanes.mul(force, lanes.splat(step.step_length));
    let units = lanes.mul(lanes.add(by_force, kick), lanes.splat(step.units));
    let fits = lanes.less(lanes.abs(units), lanes.splat(HALF_BOX));
    if lanes.bits(fits) == (1 << L::WIDTH) - 1 { Some(lanes.round(units)) } else { None }
}

/// As the core decides.
#[cold]
fn one_by_one(
    step: &Displacement,
    ids: &[u32],
    (force_x, force_y): (&[u64], &[u64]),
    (along_x, along_y): (&mut [u32], &mut [u32]),
) -> Result<(), HalfBox> {
    let forces = force_x.iter().zip(force_y);
    for ((&id, (&x, &y)), (along_x, along_y)) in ids.iter().zip(forces).zip(along_x.iter_mut().zip(along_y)) {
        let (x, y) = step.of(id, (x as i64, y as i64))?;
        (*along_x, *along_y) = (x as u32, y as u32);
    }
    Ok(())
}
