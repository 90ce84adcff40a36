//! Distance-coded reference marks: where on the scale two neighbouring marks are.
//!
//! Fixed marks stand in equal intervals of N grating periods. Between two of them stands a mark that moves
//! on by one period from interval to interval: the first N/2 + 1 periods after its fixed mark, the next
//! N/2 + 2 and so on. So every distance of two neighbours, taken with the direction of travel, occurs once
//! [000:4545-4551].

/// The code of a scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DistanceCode {
    /// Grating periods between fixed marks, even: 1000 for 20 mm of 20 µm [001:1480].
    pub interval: i64,
    /// Counting steps of a grating period: those of a signal period times the factor of an external
    /// interpolation (MP340) [000:3218].
    pub period_steps: i64,
}

impl DistanceCode {
    /// Where a mark is, in grating periods from the zero reference mark: marks 0, 2, 4 are the fixed ones,
    /// marks 1, 3, 5 those between.
    pub fn mark(&self, number: i64) -> i64 {
        let (fixed, between) = (number.div_euclid(2), number.rem_euclid(2));
        fixed * self.interval + between * (self.interval / 2 + 1 + fixed)
    }

    /// Where the second of two neighbouring marks is that were crossed at these counts, in counting steps
    /// from the zero reference mark. `None` when no two neighbours are that far apart.
    pub fn locate(&self, first: i64, second: i64) -> Option<i64> {
        let distance = second.checked_sub(first)?;
        let direction = distance.signum();
        let periods = (distance.abs() + self.period_steps / 2).checked_div(self.period_steps)?;
        // A mark lies within a quarter of a period of its place (inferred).
        let exact = periods.checked_mul(self.period_steps)?;
        if (distance.abs() - exact).abs() > self.period_steps / 4 || self.interval % 2 != 0 {
            return None;
        }
        let code = 2 * periods - self.interval;
        if code == 0 || code.abs() >= self.interval {
            return None;
        }
        let start =
            (code.abs() - code.signum() - 1) * self.interval / 2 + (code.signum() - direction) * periods / 2;
        (start + direction * periods).checked_mul(self.period_steps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CODE: DistanceCode = DistanceCode {
        interval: 1000,
        period_steps: 1024,
    };

    #[test]
    fn the_marks_of_a_scale_stand_where_its_code_says() {
        // 20 mm between fixed marks of a 20 µm scale; 501, 502, 503 periods to the mark between.
        let marks: Vec<i64> = (0..6).map(|number| CODE.mark(number)).collect();
        assert_eq!(marks, [0, 501, 1000, 1502, 2000, 2503]);
    }

    #[test]
    fn no_two_neighbours_are_that_far_apart() {
        assert_eq!(CODE.locate(0, 500 * 1024), None, "half the interval");
        assert_eq!(CODE.locate(0, 1000 * 1024), None, "a mark was missed");
        assert_eq!(CODE.locate(0, 501 * 1024 + 400), None, "between two periods");
        assert_eq!(CODE.locate(7, 7), None);
        assert_eq!(CODE.locate(i64::MIN, i64::MAX), None);
    }

    proptest! {
        /// Two neighbours tell where the second is, in both directions, wherever the count began.
        #[test]
        fn two_marks_give_the_position(number in 0i64..990, begin in -1_000_000_000i64..1_000_000_000) {
            let steps = |number| CODE.mark(number) * 1024;
            let (left, right) = (steps(number), steps(number + 1));
            prop_assert_eq!(CODE.locate(begin + left, begin + right), Some(right));
            prop_assert_eq!(CODE.locate(begin + right, begin + left), Some(left));
        }
    }
}
