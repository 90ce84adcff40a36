//! Axes that have acceleration, kink point and monitoring in common, as those of a TNC 151/155 [001:2612-2760].
//!
//! Decision: On a TNC 151/155 `bahn tune` gives all axes of the path one kv, since they have acceleration, kink point and
//! monitoring in common: the other axes stop in each trial, too, and roundness counts beside the contour error, since a circle
//! that shrinks hides its peaks. MP60 stays as it is; MP54 goes up while stops get 1 % shorter, and with the square-root
//! characteristic down until they do not overshoot; MP56 and MP57 are 0.5 and 10 mm, as the manual recommends

use bahn_parameters::Adjustment;

use super::{Assistant, BETTER, KV_FACTOR, OVERSHOOT_MM, Try};

/// So much shorter must stops get for a steeper acceleration.
const SOONER: f64 = 0.99;
/// Damping of the run-up that is tried where MP64 holds for all axes, of 0.01 to 0.999 *(inferred: the chart is lost)*
/// [001:2725-2727].
const DAMPINGS: [f64; 3] = [0.3, 0.6, 0.9];
/// Recommended monitoring with the square-root characteristic, mm [001:2742-2752].
const PRECONTROL_MONITORS_MM: [f64; 2] = [0.5, 10.0];
/// Steps down that are tried at most, from whatever an entry is.
const STEPS_DOWN: u8 = 20;

impl Assistant<'_> {
    /// The loops of all axes that have their acceleration and monitoring in common, in the order of the manual: the linear
    /// characteristic, which jogging always has; then the square-root characteristic where MP60 says that programs run with
    /// it [001:1105-1121] [001:2612-2760].
    pub(super) fn common_loops(&mut self) {
        let method = self.value(Adjustment::ServoLag, self.first()).unwrap_or(1.0);
        let entry = (self.list.clone(), self.best.clone());
        if self.takes_method(1.0) {
            self.equalize(Adjustment::KvLag, STEPS_DOWN);
            self.accelerate();
            self.servo_lag();
        }
        if method == 1.0 {
            return;
        }
        if !self.takes_method(0.0) {
            (self.list, self.best) = entry;
            return;
        }
        // A higher kv overshoots less here. The two characteristics have the acceleration in common.
        self.equalize(Adjustment::KvPrecontrol, 1);
        self.precontrol();
        self.brake();
        self.precontrol();
        for damping in DAMPINGS {
            self.attempt(&vec![(Adjustment::Damping, self.first(), damping)]);
        }
        let [monitor_mm, emergency_mm] = PRECONTROL_MONITORS_MM;
        self.takes(&vec![
            (Adjustment::PrecontrolMonitor, self.first(), monitor_mm),
            (Adjustment::PrecontrolEmergency, self.first(), emergency_mm),
        ]);
    }

    /// One kv for all axes, the least, since the worst one determines it [000:9696-9698], and less where stops overshoot
    /// with it; with the monitoring that goes with it. MP55 is half of MP54 from here on [001:2701].
    fn equalize(&mut self, what: Adjustment, steps: u8) {
        let axes = self.kv_axes();
        let values = axes.iter().filter_map(|axis| self.value(what, *axis));
        let mut kv = values.filter(|kv| *kv > 0.0).fold(f64::INFINITY, f64::min);
        if !kv.is_finite() {
            return;
        }
        let acceleration = self.value(Adjustment::Acceleration, self.first());
        let radial = acceleration.map(|value| (Adjustment::RadialAcceleration, self.first(), value / 2.0));
        for _ in 0..steps {
            let mut entries: Try = axes.iter().map(|axis| (what, *axis, kv)).collect();
            entries.extend(radial);
            let taken = self.takes(&entries);
            if !taken || self.best.overshoot_mm <= OVERSHOOT_MM {
                break;
            }
            kv /= KV_FACTOR;
        }
    }

    /// MP54 with MP55, half of it, times a factor.
    fn acceleration(&self, factor: f64) -> Option<Try> {
        let now = self.value(Adjustment::Acceleration, self.first())?;
        let entry = vec![(Adjustment::Acceleration, self.first(), now * factor)];
        let then = self
            .adjusted(&entry)
            .adjustment(Adjustment::Acceleration, self.first())?;
        let both = vec![
            (Adjustment::Acceleration, self.first(), then),
            (Adjustment::RadialAcceleration, self.first(), then / 2.0),
        ];
        (then != now).then_some(both)
    }

    /// MP54 up, as far as the drives follow: while stops get shorter, and the contour no worse [001:2693-2701].
    fn accelerate(&mut self) {
        while let Some(entries) = self.acceleration(KV_FACTOR) {
            let error_mm = self.judge();
            let taken = self.attempt_by(&entries, |test, best| {
                test.stops_s < best.stops_s * SOONER && error_mm(test) * BETTER <= error_mm(best)
            });
            if !taken {
                break;
            }
        }
    }

    /// MP54 down until stops do not overshoot.
    fn brake(&mut self) {
        for _ in 0..STEPS_DOWN {
            if self.best.overshoot_mm <= OVERSHOOT_MM {
                break;
            }
            let Some(entries) = self.acceleration(1.0 / KV_FACTOR) else {
                break;
            };
            if !self.takes(&entries) {
                break;
            }
        }
    }
}
