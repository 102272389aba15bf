//! From bytes to numbers: any bytes will do, and none is like zeros without end.

/// Bytes being read.
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl Bytes<'_> {
    /// Whether nothing is left.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn array<const LENGTH: usize>(&mut self) -> [u8; LENGTH] {
        let (taken, rest) = self.0.split_at(LENGTH.min(self.0.len()));
        self.0 = rest;
        let mut array = [0; LENGTH];
        array[..taken.len()].copy_from_slice(taken);
        array
    }

    /// The next byte.
    pub(super) fn byte(&mut self) -> u8 {
        let [byte] = self.array();
        byte
    }

    /// The next 32 bits, little-endian.
    pub(super) fn bits_32(&mut self) -> u32 {
        u32::from_le_bytes(self.array())
    }

    /// The next 64 bits, little-endian.
    pub(super) fn bits_64(&mut self) -> u64 {
        u64::from_le_bytes(self.array())
    }

    /// Whether the next byte is odd.
    pub(super) fn flag(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    /// One of `choices`.
    pub(super) fn choice<T: Copy, const COUNT: usize>(&mut self, choices: [T; COUNT]) -> T {
        choices[usize::from(self.byte()) % COUNT]
    }

    /// Any bits as a number.
    pub(super) fn any_number(&mut self) -> f64 {
        f64::from_bits(self.bits_64())
    }

    /// Most often a number from `least` to `most`; else one end, a neighbour of one, or any bits at all.
    pub(super) fn number(&mut self, least: f64, most: f64) -> f64 {
        match self.byte() {
            0 => self.any_number(),
            1 => least,
            2 => most,
            3 => least.next_up(),
            4 => most.next_down(),
            5 => least.next_down(),
            6 => most.next_up(),
            _ => {
                let fraction = f64::from(self.bits_32()) / f64::from(u32::MAX);
                // Not `clamp`, which breaks down where the ends are no range.
                (least + (most - least) * fraction).max(least).min(most)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beyond_the_end_are_zeros() {
        let mut bytes = Bytes(&[1, 2, 3, 4, 5]);
        assert_eq!((bytes.bits_32(), bytes.bits_32(), bytes.byte()), (0x0403_0201, 5, 0));
        assert!(bytes.is_empty());
    }

    #[test]
    fn numbers_reach_both_ends() {
        let of = |bytes: &[u8]| Bytes(bytes).number(2.0, 8.0);
        assert_eq!((of(&[1]), of(&[2])), (2.0, 8.0));
        assert_eq!((of(&[9]), of(&[9, 255, 255, 255, 255])), (2.0, 8.0));
        assert_eq!(of(&[0, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F]), 1.0);
    }
}
