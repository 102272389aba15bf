//! What discs share out among their nodes: 1 each, or capillary strengths.

use super::weights::Stencil;
use crate::lanes::{Lanes, bits_of_i32};

/// What discs share out.
pub(super) trait Shares: Copy + Send + Sync {
    /// Whether what a node holds could overflow: then additions saturate, and the largest sum is looked for.
    const COUNTED: bool;

    /// Turns the weights of the discs from `disc` on into their shares.
    fn apply<L: Lanes, const P: usize>(self, lanes: L, disc: usize, stencil: &mut Stencil<L, P>);

    /// Those of the discs before `disc`, and those from it on.
    fn divide(self, disc: usize) -> (Self, Self);
}

/// 1 each: the weights as they are.
#[derive(Clone, Copy)]
pub(super) struct Equal<const COUNTED: bool>;

impl<const COUNTED: bool> Shares for Equal<COUNTED> {
    const COUNTED: bool = COUNTED;

    #[inline(always)]
    fn apply<L: Lanes, const P: usize>(self, _: L, _: usize, _: &mut Stencil<L, P>) {}

    fn divide(self, _: usize) -> (Self, Self) {
        (self, self)
    }
}

/// Moduli of strengths, unit 2⁻²⁰.
#[derive(Clone, Copy)]
pub(super) struct Moduli<'a>(pub &'a [i32]);

impl Shares for Moduli<'_> {
    const COUNTED: bool = true;

    #[inline(always)]
    fn apply<L: Lanes, const P: usize>(self, lanes: L, disc: usize, stencil: &mut Stencil<L, P>) {
        let (modulus, _) = modulus_and_sign(lanes, self.0, disc);
        stencil.share(lanes, modulus);
    }

    fn divide(self, disc: usize) -> (Self, Self) {
        let (before, after) = self.0.split_at(disc.min(self.0.len()));
        (Self(before), Self(after))
    }
}

/// Strengths, unit 2⁻²⁰: shares in two's complement.
#[derive(Clone, Copy)]
pub(super) struct Signed<'a>(pub &'a [i32]);

impl Shares for Signed<'_> {
    const COUNTED: bool = false;

    #[inline(always)]
    fn apply<L: Lanes, const P: usize>(self, lanes: L, disc: usize, stencil: &mut Stencil<L, P>) {
        let (modulus, sign) = modulus_and_sign(lanes, self.0, disc);
        stencil.share(lanes, modulus);
        for share in stencil.weights.as_flattened_mut() {
            *share = with_sign(lanes, *share, sign);
        }
    }

    fn divide(self, disc: usize) -> (Self, Self) {
        let (before, after) = self.0.split_at(disc.min(self.0.len()));
        (Self(before), Self(after))
    }
}

/// The moduli of the strengths from `disc` on, and all bits where they are negative.
#[inline(always)]
fn modulus_and_sign<L: Lanes>(lanes: L, strengths: &[i32], disc: usize) -> (L::U32, L::U32) {
    let strength = lanes.load_u32(bits_of_i32(strengths.get(disc..).unwrap_or(&[])));
    let sign = lanes.sar(strength, 31);
    (with_sign(lanes, strength, sign), sign)
}

/// −`integer` where all bits of `sign` are set, else `integer`.
#[inline(always)]
fn with_sign<L: Lanes>(lanes: L, integer: L::U32, sign: L::U32) -> L::U32 {
    lanes.sub_u32(lanes.xor(integer, sign), sign)
}
