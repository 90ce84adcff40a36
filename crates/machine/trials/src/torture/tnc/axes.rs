//! The axes after every contour cycle: travel, speed, acceleration, enable, monitoring, the way after a reaction.

use bahn_machine::{AxisState, Machine};
use bahn_parameters::fault::FaultId;
use bahn_tnc::{AxisWatch, ChannelView};

use crate::torture::rule::{Rule, Violation};

/// Rounding of positions and speeds.
const EPSILON: f64 = 1e-6;
/// What a corner may make of the bound of the acceleration at once: four fifths of it over the window of the servo, as
/// [`bahn_motion`](https://docs.rs/bahn-motion) passes corners, s.
const CORNER_S: f64 = 0.8 * 0.15;
/// The drive has no power so long after a reaction at the latest: relay and PLC, s.
const POWER_OFF_S: f64 = 0.06;
/// What play, windows and the rest of a lag add to a way, mm or degrees.
const REST: f64 = 0.5;

/// What an axis did in the last cycle.
#[derive(Clone, Copy, Debug)]
struct Before {
    watch: AxisWatch,
    channel: usize,
    /// The lag was beyond what is monitored.
    beyond: bool,
    /// Its loop has been open for so long, s.
    open_s: f64,
    /// Speed that the handwheel adds to its path (M118), mm/s.
    wheel_mm_s: f64,
    /// Speed on the way back after a feed enable, mm/s; not known in its first cycle.
    back_mm_s: Option<f64>,
}

/// Where an axis of the machine was when its power was taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Braking {
    output: usize,
    position: f64,
    bound: f64,
}

/// Follows the axes of a machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Axes {
    before: Vec<Before>,
    braking: Vec<Braking>,
    /// The elements that were executed last, by channel.
    sequences: Vec<u64>,
    corners: Vec<bool>,
}

/// What is known of the moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub time_us: u64,
    pub cycle_s: f64,
    /// The supply of the control is on, and it has not begun anew in this cycle.
    pub on: bool,
    pub loops_closed: bool,
    /// A message is shown that switches "control is ready" off.
    pub fatal: bool,
    /// Something of the machine has failed: its axes are where they are.
    pub broken: bool,
    /// The way after a reaction says nothing: the relay or a brake does not do what it should.
    pub unbraked: bool,
}

impl Axes {
    /// Forgets what was: another moment begins.
    pub fn restart(&mut self) {
        *self = Axes::default();
    }

    /// A cycle of a channel.
    pub fn channel(&mut self, channel: ChannelView, moment: &Moment) -> Result<(), Violation> {
        let number = channel.number();
        if self.sequences.len() <= number {
            self.sequences.resize(number + 1, 0);
            self.corners.resize(number + 1, true);
        }
        let element = channel.element();
        let sequence = element.map_or(0, |element| element.sequence);
        let threaded =
            element.is_some_and(|element| !matches!(element.override_law, bahn_path::OverrideLaw::Free));
        if let Some(last) = self.sequences.get_mut(number) {
            let passed = std::mem::replace(last, sequence) != sequence;
            if let Some(corner) = self.corners.get_mut(number) {
                *corner = passed || threaded;
            }
        }
        for watch in channel.watch() {
            self.axis(number, watch, moment)?;
        }
        Ok(())
    }

    fn axis(&mut self, channel: usize, watch: AxisWatch, moment: &Moment) -> Result<(), Violation> {
        let place = self.before.iter().position(|before| before.watch.id == watch.id);
        let before = place.and_then(|place| self.before.get(place)).copied();
        let corner = self.corners.get(channel).copied().unwrap_or(true);
        let led = |before: &Before| (watch.superimposed - before.watch.superimposed) / moment.cycle_s;
        let judge = Judge {
            watch: &watch,
            wheel_mm_s: before.as_ref().map_or(0.0, led),
            moment,
        };
        judge.numbers()?;
        judge.speed()?;
        if let Some(before) = before.filter(|before| before.channel == channel) {
            judge.travel(&before.watch)?;
            judge.acceleration(&before, corner)?;
            judge.reaction(&before.watch)?;
            judge.way_back(&before)?;
            judge.enable(&before)?;
            judge.monitoring(before.beyond)?;
        }
        let now = Before {
            watch,
            channel,
            wheel_mm_s: judge.wheel_mm_s,
            back_mm_s: before
                .filter(|before| before.watch.beside != 0.0 && watch.beside != 0.0)
                .filter(|before| !before.watch.halted && !watch.halted)
                .map(|before| (watch.beside - before.watch.beside) / moment.cycle_s),
            open_s: match before.filter(|_| !watch.closed) {
                Some(before) => before.open_s + moment.cycle_s,
                None => 0.0,
            },
            beyond: watch.closed && watch.lag.abs() > watch.lag_max,
        };
        match place.and_then(|place| self.before.get_mut(place)) {
            Some(before) => *before = now,
            None => self.before.push(now),
        }
        Ok(())
    }

    /// "Control is ready" has gone off: from here on the machine brakes.
    pub fn brake(&mut self, plant: &Machine) {
        self.braking = plant.axes().filter_map(|axis| Braking::of(&axis)).collect();
    }

    /// The way after it.
    pub fn distance(&self, plant: &Machine, moment: &Moment) -> Result<(), Violation> {
        if moment.unbraked || !moment.fatal {
            return Ok(());
        }
        for axis in plant.axes() {
            let braking = self.braking.iter().find(|braking| braking.output == axis.output);
            if let Some(braking) = braking {
                braking.check(&axis, "the reaction", moment)?;
            }
        }
        Ok(())
    }
}

impl Braking {
    /// Friction and brake of the machine; `None` where nothing brakes it.
    pub fn of(axis: &AxisState) -> Option<Braking> {
        // Until its power is off the motor may still accelerate it.
        let speed = axis.speed_per_min.abs() / 60.0 + axis.motor.min(20_000.0) * POWER_OFF_S;
        Braking::from(axis, speed, axis.braking.min(axis.motor))
    }

    /// The drive brakes with 0 V as well as it can, or on a ramp where it is held.
    pub fn by_drive(axis: &AxisState, ramp: Option<f64>) -> Option<Braking> {
        let least = axis.motor - axis.weight;
        let speed = axis.speed_per_min.abs() / 60.0;
        Braking::from(axis, speed, ramp.map_or(least, |ramp| ramp.min(least)))
    }

    fn from(axis: &AxisState, speed: f64, braking: f64) -> Option<Braking> {
        (braking > 0.0).then(|| Braking {
            output: axis.output,
            position: axis.position,
            bound: speed * POWER_OFF_S + speed * speed / (2.0 * braking) + REST,
        })
    }

    /// The axis is within the way that is left to it.
    pub fn check(&self, axis: &AxisState, after: &str, moment: &Moment) -> Result<(), Violation> {
        let way = (axis.position - self.position).abs();
        if way <= self.bound {
            return Ok(());
        }
        let values = format!(
            "{} travels {way:.3} after {after}, {:.3} are left to it",
            axis.letter, self.bound
        );
        Err(Violation::new(Rule::Distance, moment.time_us, values))
    }
}

/// An axis in a cycle.
struct Judge<'a> {
    watch: &'a AxisWatch,
    /// Speed that the handwheel adds to its path (M118), mm/s.
    wheel_mm_s: f64,
    moment: &'a Moment,
}

impl Judge<'_> {
    fn breaks(&self, rule: Rule, values: String) -> Result<(), Violation> {
        let letter = self.watch.axis.letter();
        let values = format!("{letter} (axis {}): {values}", self.watch.id.number());
        Err(Violation::new(rule, self.moment.time_us, values))
    }

    fn numbers(&self) -> Result<(), Violation> {
        let watch = self.watch;
        let numbers = [
            watch.commanded,
            watch.speed_mm_s,
            watch.actual,
            watch.lag,
            watch.volts,
        ];
        if numbers.iter().any(|number| !number.is_finite()) || watch.volts.abs() > 10.0 {
            return self.breaks(Rule::Numbers, format!("{watch:?}"));
        }
        Ok(())
    }

    /// No axis is commanded out of its range; what has failed may have brought it there, and it may come back.
    fn travel(&self, before: &AxisWatch) -> Result<(), Violation> {
        // With its reference mark an axis is elsewhere without having moved.
        let Some([least, greatest]) = self.watch.limits.filter(|_| before.limits.is_some()) else {
            return Ok(());
        };
        let (at, was) = (self.watch.commanded, before.commanded);
        let beyond = |at: f64| (least - at).max(at - greatest);
        let moves = self.watch.closed && self.watch.speed_mm_s != 0.0;
        // What a wrong reference mark put outside comes to a standstill there.
        let inside = beyond(was) <= EPSILON || !self.moment.broken;
        if moves && inside && beyond(at) > EPSILON && beyond(at) > beyond(was) + EPSILON {
            return self.breaks(
                Rule::Travel,
                format!("commanded to {at:.6}, limits {least} and {greatest}"),
            );
        }
        // The axis itself is no farther out than its lag may be.
        let out = beyond(self.watch.actual);
        if !self.moment.broken && out > self.watch.lag_max {
            let actual = self.watch.actual;
            return self.breaks(
                Rule::Travel,
                format!("is at {actual:.4}, limits {least} and {greatest}"),
            );
        }
        Ok(())
    }

    fn speed(&self) -> Result<(), Violation> {
        let (speed, rapid) = (self.watch.speed_mm_s, self.watch.rapid_mm_s);
        if speed.abs() > rapid * (1.0 + EPSILON) + EPSILON {
            return self.breaks(Rule::Speed, format!("{speed:.4} mm/s, rapid traverse {rapid:.4}"));
        }
        Ok(())
    }

    fn acceleration(&self, last: &Before, corner: bool) -> Result<(), Violation> {
        let (watch, before, cycle_s) = (self.watch, &last.watch, self.moment.cycle_s);
        // It stands at once without enable or loop, where it was taken over from its actual position, and where
        // another one moves it.
        let held = watch.closed && before.closed && !watch.halted && !before.halted;
        let faultless = watch.fault.is_none() && before.fault.is_none();
        if !held || !faultless || self.moment.fatal || watch.on_path != before.on_path {
            return Ok(());
        }
        // MP1070 is no greater than MP1060.
        let bound = watch.acceleration_mm_s2 * std::f64::consts::SQRT_2;
        let now = watch.speed_mm_s - self.wheel_mm_s;
        let was = before.speed_mm_s - last.wheel_mm_s;
        let step = (now - was).abs();
        let most = bound * if corner { cycle_s + CORNER_S } else { cycle_s };
        if step > most * (1.0 + 1e-3) + 1e-4 {
            let values = format!(
                "{now:.4} mm/s after {was:.4}: {:.1} mm/s², at most {:.1}",
                step / cycle_s,
                most / cycle_s
            );
            return self.breaks(Rule::Acceleration, values);
        }
        // The handwheel has a ramp of its own, whose mean speeds in two cycles differ by no more than that of their ends. At
        // rapid traverse it gives way to the path: then the axis keeps |path + wheel| = MP1010 whatever the path gains.
        let given = if watch.speed_mm_s.abs() >= watch.rapid_mm_s * (1.0 - EPSILON) {
            step
        } else {
            0.0
        };
        let step = (self.wheel_mm_s - last.wheel_mm_s).abs();
        let most = watch.acceleration_mm_s2 * cycle_s + given;
        if step > most * (1.0 + 1e-3) + 1e-4 {
            let values = format!(
                "led by the handwheel at {:.4} mm/s after {:.4}, at most {most:.4} more",
                self.wheel_mm_s, last.wheel_mm_s
            );
            return self.breaks(Rule::Acceleration, values);
        }
        Ok(())
    }

    /// An axis beside the path that does not follow comes to a standstill on its ramp, whoever moves it.
    fn reaction(&self, before: &AxisWatch) -> Result<(), Violation> {
        let watch = self.watch;
        let alone = |watch: &AxisWatch| {
            let held = watch.closed && !watch.halted;
            held && watch.fault.is_some() && !watch.on_path && !watch.slave
        };
        let most = before.speed_mm_s.abs() - watch.acceleration_mm_s2 * self.moment.cycle_s * (1.0 - 1e-3);
        if alone(watch) && alone(before) && watch.speed_mm_s.abs() > most.max(0.0) + 1e-4 {
            let values = format!(
                "{:.4} mm/s after {:.4} with a fault",
                watch.speed_mm_s, before.speed_mm_s
            );
            return self.breaks(Rule::Reaction, values);
        }
        Ok(())
    }

    /// The torque of a digital drive brakes for a while, and holds it without feed enable.
    fn enable(&self, before: &Before) -> Result<(), Violation> {
        let (watch, was) = (self.watch, &before.watch);
        let holds = watch.torque_s.is_some();
        let braked = watch.torque_s.is_none_or(|torque_s| before.open_s > torque_s);
        let open = !watch.closed && (!was.closed || !self.moment.loops_closed || !self.moment.on);
        if open && braked && watch.volts != 0.0 {
            return self.breaks(Rule::Enable, format!("{:.4} V without loop", watch.volts));
        }
        if watch.halted && was.halted && !holds && watch.volts != 0.0 {
            return self.breaks(Rule::Enable, format!("{:.4} V without enable", watch.volts));
        }
        Ok(())
    }

    /// Back from where it ran on without feed enable it goes with no more than MP1060, MP1010; what a drive that ran away
    /// has gathered above that is braked.
    fn way_back(&self, before: &Before) -> Result<(), Violation> {
        let (watch, was) = (self.watch, &before.watch);
        let Some(speed) = before
            .back_mm_s
            .filter(|_| watch.beside != 0.0 && !watch.halted && !was.halted)
        else {
            return Ok(());
        };
        let now = (watch.beside - was.beside) / self.moment.cycle_s;
        // Mean speeds of two cycles differ by no more than that of their ends.
        let most = watch.acceleration_mm_s2 * self.moment.cycle_s;
        if (now - speed).abs() > most * (1.0 + 1e-3) + 1e-4
            || now.abs() > watch.rapid_mm_s.max(speed.abs()) + 1e-4
        {
            let values = format!("{now:.4} mm/s after {speed:.4} on the way back, at most {most:.4} more");
            return self.breaks(Rule::Acceleration, values);
        }
        Ok(())
    }

    /// A lag beyond the limits is a fault by the next cycle.
    fn monitoring(&self, beyond: bool) -> Result<(), Violation> {
        let watch = self.watch;
        let lag = watch.lag.abs();
        if beyond && watch.closed && lag > watch.lag_max && watch.fault.is_none() {
            let values = format!("lag {lag:.4} beyond {:.4} without a fault", watch.lag_max);
            return self.breaks(Rule::Monitoring, values);
        }
        let gross = watch.fault.is_some_and(|fault| fault != FaultId::Positioning);
        if beyond && watch.closed && lag > watch.lag_gross && !gross {
            let values = format!("lag {lag:.4} beyond {:.4} is no gross fault", watch.lag_gross);
            return self.breaks(Rule::Monitoring, values);
        }
        Ok(())
    }
}
