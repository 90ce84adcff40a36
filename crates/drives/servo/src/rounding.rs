//! Whole numbers of counters and converters, to the bit what the standard library gives: there they are calls, since the
//! processors that everything is compiled for need not have an instruction for them.

/// Below this every sum with [`SHIFT`] is a whole number.
const EXACT: f64 = 2_251_799_813_685_248.0;
/// 1.5 · 2^52: a number of this size has no digits after the point.
const SHIFT: f64 = 6_755_399_441_055_744.0;

/// `x.floor() as i64`.
#[inline]
pub fn floor_to_i64(x: f64) -> i64 {
    let whole = x as i64;
    // What has no digits after the point is not greater than its whole part: nothing is subtracted at the ends.
    whole.saturating_sub(i64::from(whole as f64 > x))
}

/// `x.round()`: halves go away from 0.
#[inline]
pub fn round(x: f64) -> f64 {
    if x.abs() < EXACT {
        // The nearest whole number, of two the even one; the difference is exact.
        let even = (x + SHIFT) - SHIFT;
        let left = x - even;
        let away = if left.abs() == 0.5 && left * x > 0.0 {
            2.0 * left
        } else {
            0.0
        };
        (even + away).copysign(x)
    } else {
        x.round()
    }
}

#[cfg(test)]
mod tests {
    use super::{floor_to_i64, round};
    use proptest::prelude::*;

    const EDGES: [f64; 21] = [
        0.0,
        -0.0,
        0.5,
        1.5,
        2.5,
        0.499_999_999_999_999_94,
        5e-324,
        1e-300,
        4_503_599_627_370_495.5,
        4_503_599_627_370_496.0,
        2_251_799_813_685_247.5,
        2_251_799_813_685_248.5,
        2_251_799_813_685_247.8,
        9_007_199_254_740_993.0,
        9.223_372_036_854_775e18,
        9.3e18,
        1e300,
        f64::INFINITY,
        f64::NAN,
        65_535.5,
        65_536.5,
    ];

    fn is_the_same(x: f64) {
        assert_eq!(floor_to_i64(x), x.floor() as i64, "{x}");
        // Which NaN it is does not count.
        assert!(round(x).to_bits() == x.round().to_bits() || x.is_nan(), "{x}");
        assert_eq!(round(x).is_nan(), x.is_nan());
    }

    #[test]
    fn edges_are_as_in_the_standard_library() {
        for x in EDGES {
            is_the_same(x);
            is_the_same(-x);
        }
    }

    proptest! {
        #[test]
        fn any_number_is_as_in_the_standard_library(bits: u64) {
            is_the_same(f64::from_bits(bits));
        }

        #[test]
        fn halves_and_their_neighbours_are(half in -200_000i32..200_000) {
            let x = f64::from(half) * 0.5;
            for near in [x, x.next_up(), x.next_down()] {
                is_the_same(near);
            }
        }

        #[test]
        fn usual_numbers_are(x in -1e6f64..1e6) {
            is_the_same(x);
        }
    }
}
