//! Fourier transforms of lines: microfft's graph of operations, radix 2 in binary32.
//!
//! Only the forward transform X_k = Σ_j x_j exp(−2πi jk/M) is needed: the inverse of a spectrum is the
//! forward transform of the same spectrum with real and imaginary parts exchanged, exchanged again.
//!
//! ```
//! use meniscus_core::transform::{AnySize, Complex32, LineTransform};
//!
//! let mut line = [Complex32::new(1.0, 0.0); 16];
//! AnySize.forward(&mut line);
//! assert_eq!(line[0], Complex32::new(16.0, 0.0));
//! assert_eq!(line[5], Complex32::new(0.0, 0.0));
//! ```

use microfft::complex::{
    cfft_16, cfft_32, cfft_64, cfft_128, cfft_256, cfft_512, cfft_1024, cfft_2048, cfft_4096,
};

pub use microfft::Complex32;

/// A way to transform one line in place.
pub trait LineTransform {
    /// Replaces `line` by its forward transform, not normalised.
    ///
    /// The length is a power of two from 16 to 4096; a line of any other length is left as it is.
    fn forward(&self, line: &mut [Complex32]);
}

/// Applies microfft's transform of `$size` points if `$line` has as many.
macro_rules! transform_sized {
    ($line:expr, $size:literal, $transform:path) => {
        if let Ok(line) = <&mut [Complex32; $size]>::try_from($line) {
            let _ = $transform(line);
        }
    };
}

/// The transform of `points` points.
#[inline(always)]
fn forward(points: usize, line: &mut [Complex32]) {
    match points {
        16 => transform_sized!(line, 16, cfft_16),
        32 => transform_sized!(line, 32, cfft_32),
        64 => transform_sized!(line, 64, cfft_64),
        128 => transform_sized!(line, 128, cfft_128),
        256 => transform_sized!(line, 256, cfft_256),
        512 => transform_sized!(line, 512, cfft_512),
        1024 => transform_sized!(line, 1024, cfft_1024),
        2048 => transform_sized!(line, 2048, cfft_2048),
        4096 => transform_sized!(line, 4096, cfft_4096),
        _ => {}
    }
}

/// The transform of lines of M points, M known at compile time: a program links this one size only.
#[derive(Clone, Copy, Debug, Default)]
pub struct FixedSize<const M: usize>;

impl<const M: usize> LineTransform for FixedSize<M> {
    #[inline]
    fn forward(&self, line: &mut [Complex32]) {
        forward(M, line);
    }
}

/// The transform of lines of whatever length they have.
#[derive(Clone, Copy, Debug, Default)]
pub struct AnySize;

impl LineTransform for AnySize {
    #[inline]
    fn forward(&self, line: &mut [Complex32]) {
        forward(line.len(), line);
    }
}
