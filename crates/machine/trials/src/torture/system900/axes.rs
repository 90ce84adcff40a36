//! The axes after every interpolation cycle: numbers, travel, speed, acceleration, enable, monitoring.

use bahn_control900::{AxisView, Control900};

use crate::torture::rule::{Rule, Violation};

/// Rounding of positions and speeds.
const EPSILON: f64 = 1e-6;
/// What a corner may make of the bound of the acceleration at once: four fifths of it over the window of the servo, as
/// [`bahn_motion`](https://docs.rs/bahn-motion) passes corners, s.
const CORNER_S: f64 = 0.8 * 0.15;
/// A monitor says what it found so long later at the latest, s.
const SAID_S: f64 = 0.05;
/// The most that a converter gives, V.
const VOLTS: f64 = 10.0;

/// What an axis did in the last cycle.
#[derive(Clone, Copy, Debug)]
struct Before {
    view: AxisView,
    /// The lag has been beyond what any speed allows for so long, s.
    beyond_s: f64,
}

/// Follows the axes of a machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Axes {
    before: Vec<Before>,
}

/// What is known of the moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub time_us: u64,
    pub cycle_s: f64,
}

impl Axes {
    /// A cycle of the machine.
    pub fn cycle(&mut self, control: &Control900) -> Result<(), Violation> {
        let moment = Moment {
            time_us: control.now_us(),
            cycle_s: f64::from(control.cycle_us()) * 1e-6,
        };
        for (place, view) in control.axes().enumerate() {
            let judge = Judge {
                view: &view,
                moment: &moment,
            };
            judge.numbers()?;
            judge.speed()?;
            judge.enable()?;
            let before = self.before.get(place).copied();
            let beyond_s = before.map_or(0.0, |before| judge.beyond_s(before.beyond_s));
            if let Some(before) = before {
                judge.travel(&before.view)?;
                judge.acceleration(&before.view)?;
                judge.monitoring(control, beyond_s)?;
            }
            let now = Before { view, beyond_s };
            match self.before.get_mut(place) {
                Some(before) => *before = now,
                None => self.before.push(now),
            }
        }
        Ok(())
    }
}

/// An axis in a cycle.
struct Judge<'a> {
    view: &'a AxisView,
    moment: &'a Moment,
}

impl Judge<'_> {
    fn breaks(&self, rule: Rule, values: String) -> Result<(), Violation> {
        let values = format!("physical axis {}: {values}", self.view.physical);
        Err(Violation::new(rule, self.moment.time_us, values))
    }

    fn numbers(&self) -> Result<(), Violation> {
        let view = self.view;
        let numbers = [view.nominal, view.speed_mm_s, view.actual, view.lag, view.volts];
        if !numbers.iter().all(|number| number.is_finite()) {
            return self.breaks(Rule::Numbers, format!("{numbers:?}"));
        }
        if view.volts.abs() > VOLTS + EPSILON {
            return self.breaks(Rule::Numbers, format!("{} V", view.volts));
        }
        Ok(())
    }

    /// Beyond a software limit no axis is commanded farther out.
    fn travel(&self, before: &AxisView) -> Result<(), Violation> {
        let view = self.view;
        if !view.referenced || !view.closed {
            return Ok(());
        }
        let [least, greatest] = view.settings.limits_mm;
        let out = |position: f64| {
            let under = least.map_or(0.0, |least| least - position);
            let over = greatest.map_or(0.0, |greatest| position - greatest);
            under.max(over)
        };
        let (was, is) = (out(before.nominal), out(view.nominal));
        if is > EPSILON && is > was.max(0.0) + EPSILON {
            return self.breaks(
                Rule::Travel,
                format!("{:.6} is {is:.6} beyond its software limit", view.nominal),
            );
        }
        Ok(())
    }

    fn speed(&self) -> Result<(), Violation> {
        let most = self.view.settings.max_mm_min / 60.0;
        let speed = self.view.speed_mm_s.abs();
        if self.view.closed && speed > most * (1.0 + EPSILON) + EPSILON {
            return self.breaks(Rule::Speed, format!("{speed:.6} of {most:.6} mm/s"));
        }
        Ok(())
    }

    /// Ramps by hand and on paths; at corners more, and without enable an axis stops at once [002:3758-3762].
    fn acceleration(&self, before: &AxisView) -> Result<(), Violation> {
        let view = self.view;
        if !(view.closed && before.closed && view.enabled && before.enabled) {
            return Ok(());
        }
        let [by_hand_s, on_path_s] = view.settings.ramps_s;
        let ramp_s = by_hand_s.min(on_path_s).max(EPSILON);
        let most = view.settings.max_mm_min / 60.0 / ramp_s;
        let corner_s = if view.is_led || before.is_led {
            CORNER_S
        } else {
            0.0
        };
        let bound = most * (self.moment.cycle_s + corner_s) * (1.0 + EPSILON) + EPSILON;
        let step = (view.speed_mm_s - before.speed_mm_s).abs();
        if step > bound {
            return self.breaks(
                Rule::Acceleration,
                format!("{step:.6} mm/s in a cycle, {bound:.6} are allowed"),
            );
        }
        Ok(())
    }

    fn enable(&self) -> Result<(), Violation> {
        let view = self.view;
        if !view.closed && view.volts != 0.0 {
            return self.breaks(Rule::Enable, format!("{} V with the loop open", view.volts));
        }
        Ok(())
    }

    /// For how long the lag has been beyond what the greatest speed allows, s.
    fn beyond_s(&self, before_s: f64) -> f64 {
        let view = self.view;
        let settings = &view.settings;
        let [fine_mm, _] = settings.exact_stop_mm;
        let most = settings.lag_mm(settings.max_mm_min) * (1.0 + settings.lag_part) + fine_mm;
        match view.closed && view.enabled && view.lag.abs() > most {
            true => before_s + self.moment.cycle_s,
            false => 0.0,
        }
    }

    /// Such a lag is said [002:7044-7127].
    fn monitoring(&self, control: &Control900, beyond_s: f64) -> Result<(), Violation> {
        let Some(time_s) = self.view.settings.lag_s else {
            return Ok(());
        };
        let is_said = || control.pending_messages(self.view.channel).next().is_some();
        if beyond_s > time_s + SAID_S && !is_said() {
            return self.breaks(
                Rule::Monitoring,
                format!(
                    "a lag of {:.3} for {beyond_s:.3} s, and no message",
                    self.view.lag
                ),
            );
        }
        Ok(())
    }
}
