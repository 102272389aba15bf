//! What discs share out among their nodes: 1 each, or capillary strengths.

use super::weights::Stencil;
use crate::lanes::{Lanes, bits_of_i32};

/// What discs share out.
#[derive(Clone, Copy)]
pub(super) enum Shares<'a> {
    /// 1 each: the weights as they are.
    Equal,
    /// Moduli of strengths, unit 2⁻²⁰.
    Moduli(&'a [i32]),
    /// Strengths, unit 2⁻²⁰: shares in two's complement.
    Signed(&'a [i32]),
}

impl Shares<'_> {
    /// Turns the weights of the discs from `disc` on into their shares.
    #[inline(always)]
    pub fn apply<L: Lanes, const P: usize>(self, lanes: L, disc: usize, stencil: &mut Stencil<L, P>) {
        let (strengths, signed) = match self {
            Self::Equal => return,
            Self::Moduli(strengths) => (strengths, false),
            Self::Signed(strengths) => (strengths, true),
        };
        let strength = lanes.load_u32(bits_of_i32(strengths.get(disc..).unwrap_or(&[])));
        let sign = lanes.sar(strength, 31);
        stencil.share(lanes, with_sign(lanes, strength, sign));
        if signed {
            for share in stencil.weights.as_flattened_mut() {
                *share = with_sign(lanes, *share, sign);
            }
        }
    }

    /// Those of the discs before `disc`, and those from it on.
    pub fn divide(self, disc: usize) -> (Self, Self) {
        match self {
            Self::Equal => (self, self),
            Self::Moduli(strengths) => {
                let (before, after) = strengths.split_at(disc.min(strengths.len()));
                (Self::Moduli(before), Self::Moduli(after))
            }
            Self::Signed(strengths) => {
                let (before, after) = strengths.split_at(disc.min(strengths.len()));
                (Self::Signed(before), Self::Signed(after))
            }
        }
    }
}

/// −`integer` where all bits of `sign` are set, else `integer`.
#[inline(always)]
fn with_sign<L: Lanes>(lanes: L, integer: L::U32, sign: L::U32) -> L::U32 {
    lanes.sub_u32(lanes.xor(integer, sign), sign)
}
