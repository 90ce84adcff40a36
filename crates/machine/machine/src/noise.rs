//! Noise from a seed that the description holds: the same file gives the same noise.

/// A xorshift generator with three rounds of xor and a multiplication.
#[derive(Clone, Debug)]
pub(crate) struct Noise(u64);

impl Noise {
    /// A generator for one of the parts of a machine; equal seeds in different parts are independent.
    pub fn new(seed: u64, part: u64) -> Noise {
        let mixed = (seed ^ part.wrapping_mul(0x9E37_79B9_7F4A_7C15)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        Noise((mixed ^ (mixed >> 31)) | 1)
    }

    /// The next value, triangular between -1 and 1 about 0.
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D);
        let scale = f64::from(u32::MAX);
        (f64::from((bits >> 32) as u32) - f64::from(bits as u32)) / scale
    }
}
