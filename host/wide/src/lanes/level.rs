//! Which registers there are, and the choice among them.

use super::Lanes;
use super::portable::Portable;
#[cfg(target_arch = "x86_64")]
use super::{avx2::Avx2, avx512::Avx512, sse2::Sse2};

/// A computation written once for lanes of any width.
pub trait Kernel {
    /// What it gives.
    type Output;

    /// Does it. Has to be `#[inline(always)]`, as everything it calls: only then is it compiled for the registers.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Registers {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Sse2,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "aarch64")]
    Neon,
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128,
}

/// A kind of wide registers that this processor has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Level(Registers);

impl Level {
    /// Plain arrays of four, which every processor has.
    pub const PORTABLE: Self = Self(Registers::Portable);

    /// All kinds this processor has, the widest last.
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        let kinds = [
            Some(Registers::Portable),
            #[cfg(target_arch = "x86_64")]
            Some(Registers::Sse2),
            #[cfg(target_arch = "x86_64")]
            is_x86_feature_detected!("avx2").then_some(Registers::Avx2),
            #[cfg(target_arch = "x86_64")]
            (is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw"))
            .then_some(Registers::Avx512),
            #[cfg(target_arch = "aarch64")]
            Some(Registers::Neon),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Some(Registers::Simd128),
        ];
        kinds.into_iter().flatten().map(Self)
    }

    /// The widest this processor has.
    #[must_use]
    pub fn best() -> Self {
        Self::available().next_back().unwrap_or(Self::PORTABLE)
    }

    /// Its name: `portable`, `sse2`, `avx2`, `avx512`, `neon` or `simd128`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self.0 {
            Registers::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Registers::Sse2 => "sse2",
            #[cfg(target_arch = "x86_64")]
            Registers::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Registers::Avx512 => "avx512",
            #[cfg(target_arch = "aarch64")]
            Registers::Neon => "neon",
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Registers::Simd128 => "simd128",
        }
    }

    /// How many numbers are side by side in a register, [`Lanes::WIDTH`].
    #[must_use]
    pub fn width(self) -> usize {
        struct Width;
        impl Kernel for Width {
            type Output = usize;

            #[inline(always)]
            fn run<L: Lanes>(self, _lanes: L) -> usize {
                L::WIDTH
            }
        }
        self.dispatch(Width)
    }

    /// Runs a kernel with these registers.
    #[inline]
    pub fn dispatch<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            Registers::Portable => kernel.run(Portable),
            #[cfg(target_arch = "x86_64")]
            // SAFETY: SSE2 is part of x86-64.
            Registers::Sse2 => kernel.run(unsafe { Sse2::assume() }),
            #[cfg(target_arch = "x86_64")]
            // SAFETY: a level exists only if the processor has been seen to have its features, see `available`.
            Registers::Avx2 => unsafe { avx2(kernel) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: a level exists only if the processor has been seen to have its features, see `available`.
            Registers::Avx512 => unsafe { avx512(kernel) },
            #[cfg(target_arch = "aarch64")]
            // SAFETY: NEON is part of the targets this is compiled for.
            Registers::Neon => kernel.run(unsafe { super::neon::Neon::assume() }),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            // SAFETY: the feature is on for the whole program.
            Registers::Simd128 => kernel.run(unsafe { super::simd128::Simd128::assume() }),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
#[inline(never)]
pub(super) fn avx2<K: Kernel>(kernel: K) -> K::Output {
    // SAFETY: this function runs only where the processor has AVX2.
    kernel.run(unsafe { Avx2::assume() })
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
#[inline(never)]
pub(super) fn avx512<K: Kernel>(kernel: K) -> K::Output {
    // SAFETY: this function runs only where the processor has these features.
    kernel.run(unsafe { Avx512::assume() })
}
