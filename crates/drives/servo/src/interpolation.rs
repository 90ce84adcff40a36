//! Nominal positions of the servo steps: fine interpolation and transient response.

/// Divides the distance of a contour cycle evenly among its servo steps [000:212-224].
#[derive(Clone, Debug)]
pub(crate) struct FineInterpolation {
    start: f64,
    end: f64,
    /// From start to end.
    way: f64,
    now: f64,
    step: u32,
    steps: u32,
}

impl FineInterpolation {
    pub(crate) fn new(steps: u32) -> FineInterpolation {
        FineInterpolation {
            start: 0.0,
            end: 0.0,
            way: 0.0,
            now: 0.0,
            step: 0,
            steps: steps.max(1),
        }
    }

    /// The position for the end of the contour cycle that begins.
    pub(crate) fn command(&mut self, end: f64) {
        self.start = self.now;
        self.end = end;
        self.way = end - self.start;
        self.step = 0;
    }

    /// Goes on by one step and gives the position at its end.
    pub(crate) fn advance(&mut self) -> f64 {
        self.step = (self.step + 1).min(self.steps);
        self.now = if self.step == self.steps {
            self.end
        } else {
            self.start + self.way * f64::from(self.step) / f64::from(self.steps)
        };
        self.now
    }

    pub(crate) fn now(&self) -> f64 {
        self.now
    }

    pub(crate) fn end(&self) -> f64 {
        self.end
    }

    pub(crate) fn set(&mut self, position: f64) {
        self.start = position;
        self.end = position;
        self.way = 0.0;
        self.now = position;
    }

    pub(crate) fn shift(&mut self, way: f64) {
        self.start += way;
        self.end += way;
        self.way = self.end - self.start;
        self.now += way;
    }
}

/// Most servo steps over which the transient response takes the mean.
const WINDOW_MAX: usize = 64;
/// The entry of MP1520 at which the window is one contour cycle, m/min: the commissioning value
/// [000:9736].
const TRANSIENT_M_MIN: f64 = 0.5;

/// The transient response MP1520: corners of the velocity profile are rounded by the mean over a window
/// of time that falls with the entry, the same for all axes (inferred; the manual only says that smaller
/// entries arrive more slowly and larger ones tend to oscillate [000:4965]).
///
/// The separate response on accelerating, MP1530, is that of the velocity: [`RunUp`](crate::run_up::RunUp).
///
/// On a circle the mean over one contour cycle lies inside by radial acceleration · T² / 8 everywhere, the
/// chord error that the contour cycle has anyway: so an entry from 0.5 m/min on does not cost accuracy.
#[derive(Clone, Debug)]
pub(crate) struct Transient {
    ring: [f64; WINDOW_MAX],
    at: usize,
    window: usize,
    /// The position that came in last.
    last: f64,
    mean: f64,
    /// Steps for which the same position came in.
    equal: usize,
}

impl Transient {
    pub(crate) fn new(contour_steps: u32, transient_m_min: f64) -> Transient {
        let mut new = Transient {
            ring: [0.0; WINDOW_MAX],
            at: 0,
            window: 1,
            last: 0.0,
            mean: 0.0,
            equal: 0,
        };
        new.set_entry(contour_steps, transient_m_min);
        new
    }

    pub(crate) fn set_entry(&mut self, contour_steps: u32, transient_m_min: f64) {
        let steps = (f64::from(contour_steps) * TRANSIENT_M_MIN / transient_m_min).round();
        let window = (steps as usize).clamp(1, WINDOW_MAX);
        if window != self.window {
            self.window = window;
            self.set(self.mean);
        }
    }

    /// By so many steps the mean is late.
    pub(crate) fn delay_steps(&self) -> f64 {
        0.5 * (self.window - 1) as f64
    }

    /// Takes the next position in and gives the mean.
    pub(crate) fn advance(&mut self, position: f64) -> f64 {
        let equal = position == self.last;
        self.last = position;
        self.equal = if equal { self.equal.saturating_add(1) } else { 0 };
        if equal && self.equal >= self.window {
            // The whole window is this position already.
            self.mean = position;
            return position;
        }
        let oldest = std::mem::replace(&mut self.ring[self.at], position);
        self.at += 1;
        if self.at >= self.window {
            self.at = 0;
        }
        self.mean = if self.equal + 1 >= self.window {
            position
        } else {
            self.mean + (position - oldest) / self.window as f64
        };
        self.mean
    }

    pub(crate) fn now(&self) -> f64 {
        self.mean
    }

    pub(crate) fn set(&mut self, position: f64) {
        self.ring = [position; WINDOW_MAX];
        self.at = 0;
        self.last = position;
        self.mean = position;
        self.equal = WINDOW_MAX;
    }

    pub(crate) fn shift(&mut self, way: f64) {
        self.ring.iter_mut().for_each(|position| *position += way);
        self.last += way;
        self.mean += way;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_steps_divide_a_contour_cycle() {
        let mut fine = FineInterpolation::new(5);
        fine.command(1.0);
        let steps: Vec<f64> = (0..7).map(|_| fine.advance()).collect();
        assert_eq!(steps, [0.2, 0.4, 0.6, 0.8, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn the_mean_ends_exactly_at_the_target() {
        // 0.1 m/min: five contour cycles of 5 steps; the mean arrives 24 steps later, with no overshoot.
        let mut transient = Transient::new(5, 0.1);
        let mut last = 0.0;
        for step in 1..=100 {
            let mean = transient.advance(f64::from(step.min(50)) * 0.1);
            assert!(mean >= last && mean <= 5.0 + 1e-12, "step {step}: {mean}");
            assert_eq!(mean == 5.0, step >= 74, "step {step}: {mean}");
            last = mean;
        }
    }

    #[test]
    fn a_large_entry_leaves_the_profile_as_it_is() {
        let mut transient = Transient::new(5, 10.0);
        assert_eq!(transient.advance(3.0), 3.0);
        assert_eq!(transient.advance(1.0), 1.0);
    }
}
