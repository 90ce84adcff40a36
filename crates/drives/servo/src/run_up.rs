//! The transient response on acceleration: the pre-controlled velocity runs up damped.
//!
//! Decision: MP1530 (MP64) is the part of the missing velocity that pre-control keeps back in each servo step while
//! the axis accelerates; braking is not damped, and what is kept back is lag. Software without MP1530 is its smallest
//! entry, which the lists have

/// The pre-controlled part of the nominal velocity. While an axis accelerates it comes up with the velocity of the
/// profile damped by MP1530, MP64 of the TNC 151/155; when the profile brakes it goes down with it at once, for that
/// is the response of MP1520 alone [000:4965-4979] [001:2725-2727].
///
/// The manuals give a name, a range of 0.01 to 0.999 and no formula. It is read as a factor: so much of what the
/// velocity still lacks is left behind each servo step (inferred). What is left out is lag, which the loop makes up.
#[derive(Clone, Debug, Default)]
pub(crate) struct RunUp {
    velocity_mm_min: f64,
}

impl RunUp {
    /// One servo step: the velocity that is pre-controlled for that of the profile.
    pub(crate) fn advance(&mut self, profile_mm_min: f64, damping: f64) -> f64 {
        // After a reversal the axis accelerates from standstill.
        let from = match self.velocity_mm_min * profile_mm_min < 0.0 {
            true => 0.0,
            false => self.velocity_mm_min,
        };
        let accelerates = profile_mm_min.abs() > from.abs();
        self.velocity_mm_min = match accelerates {
            true => profile_mm_min + (from - profile_mm_min) * damping,
            false => profile_mm_min,
        };
        self.velocity_mm_min
    }

    /// Goes with the profile while another method drives the axis.
    pub(crate) fn follow(&mut self, profile_mm_min: f64) {
        self.velocity_mm_min = profile_mm_min;
    }
}

#[cfg(test)]
mod tests {
    use super::RunUp;

    /// Half of what is missing is left each step: of 800 there come 400, 600, 700; 500 and -800 are braking and then
    /// a run-up from standstill: 500, -400, -600. Standstill is there at once.
    #[test]
    fn a_velocity_comes_up_damped_and_goes_down_at_once() {
        let mut run_up = RunUp::default();
        let profile = [800.0, 800.0, 800.0, 500.0, -800.0, -800.0, 0.0, 0.0];
        let wanted = [400.0, 600.0, 700.0, 500.0, -400.0, -600.0, 0.0, 0.0];
        for (profile, wanted) in profile.into_iter().zip(wanted) {
            assert_eq!(run_up.advance(profile, 0.5), wanted);
        }
    }

    #[test]
    fn what_followed_is_not_damped_afterwards() {
        let mut run_up = RunUp::default();
        run_up.follow(800.0);
        assert_eq!(run_up.advance(800.0, 0.9), 800.0);
    }
}
