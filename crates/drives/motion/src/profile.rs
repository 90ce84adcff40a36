//! Speed over time along one element.

/// Speed along one element: it accelerates from the entry to the peak speed, keeps it and decelerates
/// to the exit speed, with the same acceleration on both slopes [000:4749]. Lengths are mm, or degrees
/// where only rotary axes move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Profile {
    /// Length of the path, mm.
    pub length_mm: f64,
    /// Path speed at the start, mm/s.
    pub entry_mm_s: f64,
    /// Greatest path speed, mm/s.
    pub peak_mm_s: f64,
    /// Path speed at the end, mm/s.
    pub exit_mm_s: f64,
    /// Path acceleration of both slopes, mm/s².
    pub acceleration_mm_s2: f64,
    /// Time of the movement, s; infinite when it cannot move (feed 0 or override 0).
    pub duration_s: f64,
}

impl Profile {
    /// The path speed, mm/s, at a time from the start of the movement, s.
    pub fn speed(&self, t: f64) -> f64 {
        let (rise, fall) = self.slopes();
        if t < rise {
            self.entry_mm_s + self.acceleration_mm_s2 * t.max(0.0)
        } else if t <= self.duration_s - fall {
            self.peak_mm_s
        } else {
            self.exit_mm_s + self.acceleration_mm_s2 * (self.duration_s - t).max(0.0)
        }
    }

    /// The path length, mm, covered at a time from the start of the movement, s.
    pub fn distance(&self, t: f64) -> f64 {
        let (rise, fall) = self.slopes();
        let half_a = 0.5 * self.acceleration_mm_s2;
        let s = if t <= 0.0 {
            0.0
        } else if t >= self.duration_s {
            self.length_mm
        } else if t < rise {
            (self.entry_mm_s + half_a * t) * t
        } else if t <= self.duration_s - fall {
            (self.entry_mm_s + half_a * rise) * rise + self.peak_mm_s * (t - rise)
        } else {
            let rest = self.duration_s - t;
            self.length_mm - (self.exit_mm_s + half_a * rest) * rest
        };
        s.clamp(0.0, self.length_mm)
    }

    /// Times of the rising and the falling slope, s.
    fn slopes(&self) -> (f64, f64) {
        let a = self.acceleration_mm_s2;
        if a > 0.0 {
            (
                (self.peak_mm_s - self.entry_mm_s) / a,
                (self.peak_mm_s - self.exit_mm_s) / a,
            )
        } else {
            (0.0, 0.0)
        }
    }

    /// The profile of a path of `length` between two speeds, whose squares are given too: fast as
    /// `speed` and the acceleration allow. The end speeds must be reachable within the length.
    #[inline]
    pub(crate) fn new(length: f64, acceleration: f64, speed: f64, entry: Speed, exit: Speed) -> Profile {
        // From v0 and v1 with the acceleration a the ramps meet at v² = (v0² + v1²) / 2 + a·s.
        let meeting = 0.5 * (entry.squared + exit.squared) + acceleration * length;
        let peak = if speed * speed <= meeting {
            Speed {
                value: speed,
                squared: speed * speed,
            }
        } else {
            // Rounding must not put the peak below an end speed: no slope takes negative time.
            let squared = meeting.max(entry.squared).max(exit.squared);
            if squared == exit.squared {
                exit
            } else {
                Speed::from_squared(squared)
            }
        };
        let peak = peak.max(entry).max(exit);
        let per_a = 1.0 / acceleration;
        let ramps = (2.0 * peak.squared - entry.squared - exit.squared) * 0.5 * per_a;
        let cruise = (length - ramps).max(0.0);
        let duration = if length <= 0.0 {
            0.0
        } else if peak.value > 0.0 {
            (2.0 * peak.value - entry.value - exit.value) * per_a + cruise / peak.value
        } else {
            f64::INFINITY
        };
        Profile {
            length_mm: length,
            entry_mm_s: entry.value,
            peak_mm_s: peak.value,
            exit_mm_s: exit.value,
            acceleration_mm_s2: acceleration,
            duration_s: duration,
        }
    }
}

/// A speed with its square, so that neither is computed twice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Speed {
    pub(crate) value: f64,
    pub(crate) squared: f64,
}

impl Speed {
    pub(crate) const ZERO: Speed = Speed {
        value: 0.0,
        squared: 0.0,
    };

    #[inline]
    pub(crate) fn from_squared(squared: f64) -> Speed {
        Speed {
            value: squared.sqrt(),
            squared,
        }
    }

    #[inline]
    fn max(self, other: Speed) -> Speed {
        if other.value > self.value { other } else { self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{a} is not {b}");
    }

    /// 100 mm at 100 mm/s with 1000 mm/s²: each ramp takes 0.1 s and 5 mm, the rest of 90 mm 0.9 s.
    #[test]
    fn trapezoid() {
        let p = Profile::new(100.0, 1000.0, 100.0, Speed::ZERO, Speed::ZERO);
        close(p.duration_s, 1.1);
        close(p.speed(0.05), 50.0);
        close(p.distance(0.05), 0.5 * 1000.0 * 0.05 * 0.05);
        close(p.distance(0.1), 5.0);
        close(p.speed(0.5), 100.0);
        close(p.distance(0.5), 45.0);
        close(p.distance(1.0), 95.0);
        close(p.speed(1.05), 50.0);
        close(p.distance(1.05), 100.0 - 1.25);
        assert_eq!(p.distance(2.0), 100.0);
        assert_eq!(p.distance(-1.0), 0.0);
    }

    /// 2.5 mm cannot reach 100 mm/s: the peak is sqrt(1000 · 2.5) = 50 mm/s after 0.05 s.
    #[test]
    fn triangle() {
        let p = Profile::new(2.5, 1000.0, 100.0, Speed::ZERO, Speed::ZERO);
        close(p.peak_mm_s, 50.0);
        close(p.duration_s, 0.1);
        close(p.distance(0.05), 1.25);
    }

    /// From 60 to 20 mm/s with 1000 mm/s²: braking takes (60² - 20²) / 2000 = 1.6 mm. Over 3.4 mm the
    /// ramps meet at sqrt((3600 + 400) / 2 + 3400) = sqrt(5400) mm/s.
    #[test]
    fn between_two_speeds() {
        let (entry, exit) = (Speed::from_squared(3600.0), Speed::from_squared(400.0));
        let p = Profile::new(3.4, 1000.0, 100.0, entry, exit);
        close(p.peak_mm_s, 5400f64.sqrt());
        close(p.duration_s, (2.0 * 5400f64.sqrt() - 80.0) / 1000.0);
        let braking = Profile::new(1.6, 1000.0, 100.0, entry, exit);
        close(braking.peak_mm_s, 60.0);
        close(braking.duration_s, 0.04);
    }

    #[test]
    fn standstill_takes_for_ever_and_no_length_no_time() {
        let p = Profile::new(1.0, 1000.0, 0.0, Speed::ZERO, Speed::ZERO);
        assert_eq!(p.duration_s, f64::INFINITY);
        assert_eq!((p.speed(1e9), p.distance(1e9)), (0.0, 0.0));
        let nothing = Profile::new(0.0, 1.0, f64::INFINITY, Speed::ZERO, Speed::ZERO);
        assert_eq!((nothing.duration_s, nothing.peak_mm_s), (0.0, 0.0));
        assert_eq!((nothing.speed(0.0), nothing.distance(0.0)), (0.0, 0.0));
    }
}
