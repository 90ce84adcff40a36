//! Movements that the PLC commands: PLC positioning of NC axes, PLC axes, free rotation.

use bahn_exchange::{Exchange, Image, signal};
use bahn_kernel::{AxisUnit, Mover, Now, OwnAxes};
use bahn_motion::Aim;
use bahn_parameters::PerPlcAxis;
use bahn_parameters::plc::PlcParameters;
use bahn_plc::{PlcAxisCommand, PlcAxisStatus};

use crate::markers::{AXES, POSITIONING_FEED, TRANSFER};
use crate::panel::PlcFaultCode;
use crate::plc_link::Requests;
use crate::strobe_form::{self, Form};

/// Position words count in 1/10 000 mm [000:4026].
pub(crate) const PER_MM: f64 = 10_000.0;

/// What the PLC commanded.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Positioning {
    targets: PerPlcAxis<Option<Target>>,
    /// Strobes of the marker form that were set in the last scan, taken or not.
    ordered: PerPlcAxis<bool>,
    /// What each PLC axis executes.
    plc_axes: PerPlcAxis<PlcAxis>,
    /// Free rotation: feed with sign, by axis.
    rotation: PerPlcAxis<Option<f64>>,
}

/// Where the PLC positions an axis.
#[derive(Clone, Copy, Debug)]
struct Target {
    /// Machine coordinate, mm.
    position: f64,
    feed_mm_min: f64,
    /// In which form it was ordered: that strobe is reset at the end.
    form: Form,
}

impl Target {
    /// Target and feed of an axis as the PLC has written them: in words, or by the code of one of MP4210 with the feed
    /// of MP4220 for the axis, as on the TNC 151/155 [001:3285-3289] *(inferred)*. `None` for a code that has none.
    fn read(form: Form, unit: &AxisUnit, nc: &Image, numbers: &PlcParameters) -> Option<Target> {
        let index = unit.index;
        let (position, feed_mm_min) = match form {
            Form::Words => {
                let position = f64::from(nc.number(*TRANSFER.get(index)?)) / PER_MM;
                // Feeds above 32 767 mm/min count on in the word.
                (
                    position,
                    f64::from(nc.number(*POSITIONING_FEED.get(index)?) as u16),
                )
            }
            Form::Markers => {
                let code = strobe_form::POSITIONING.get(index)?.code.read(nc)?;
                (
                    numbers.coded_position_mm(code)?,
                    unit.parameters.motion.plc_mm_min,
                )
            }
        };
        Some(Target {
            position,
            feed_mm_min,
            form,
        })
    }
}

/// A PLC axis.
#[derive(Clone, Copy, Debug)]
struct PlcAxis {
    command: Option<PlcAxisCommand>,
    /// Target of the positioning, once it began.
    target: Option<f64>,
    override_percent: f64,
}

/// A cycle in which the PLC moves axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moving {
    pub now: Now,
    /// A program runs or is interrupted.
    pub active: bool,
    /// Axes are being brought back to the contour.
    pub restores: bool,
}

impl Default for PlcAxis {
    fn default() -> PlcAxis {
        PlcAxis {
            command: None,
            target: None,
            override_percent: 100.0,
        }
    }
}

impl Positioning {
    /// Ends what PLC axes do and the free rotation: EMERGENCY STOP.
    pub fn stop(&mut self) {
        for axis in &mut self.plc_axes {
            if axis.command.is_some() {
                axis.command = Some(PlcAxisCommand::Stop);
            }
        }
        self.rotation = PerPlcAxis::splat(None);
    }

    /// PLC positioning: M2704 ff. (M2452 ff.) with target and feed, relative to the machine datum, without software
    /// limits. It starts only on referenced axes, when the NC is `free`: without a program or during a strobe of
    /// it, in Manual without direction keys [000:4005-4053].
    pub fn take_strobes(
        &mut self,
        nc: &Image,
        numbers: &PlcParameters,
        free: bool,
        most: usize,
        axes: &OwnAxes,
    ) {
        let mut running = self.targets.iter().flatten().count();
        let form = Form::of(nc);
        for (index, slot) in self.targets.iter_mut().enumerate() {
            if slot.is_some() || !form.positions(index, nc) || !free || running >= most {
                continue;
            }
            let unit = axes.with_index(index);
            let ready = unit.filter(|unit| unit.referenced && unit.is_free() && unit.parameters.controlled);
            *slot = ready.and_then(|unit| Target::read(form, unit, nc, numbers));
            running += usize::from(slot.is_some());
        }
    }

    /// Whether the PLC wants an axis positioned that is not yet. It aborts one by resetting its strobe
    /// [000:4009-4013].
    ///
    /// # Errors
    /// The code of the first strobe that agrees with its complement.
    pub fn follow_strobes(&mut self, exchange: &mut Exchange) -> Result<bool, PlcFaultCode> {
        for (index, slot) in self.targets.iter_mut().enumerate() {
            slot.take_if(|target| !target.form.positions(index, exchange.nc()));
        }
        let form = Form::of(exchange.nc());
        if form == Form::Markers {
            for (pair, ordered) in strobe_form::POSITIONING.iter().zip(&mut self.ordered) {
                if *ordered && pair.is_taken_back(exchange.nc()) {
                    pair.end(exchange);
                }
                *ordered = pair.is_set(exchange.nc());
            }
            for pair in &strobe_form::POSITIONING {
                pair.check(exchange.nc())?;
            }
        }
        let mut targets = self.targets.iter().enumerate();
        Ok(targets.any(|(index, slot)| slot.is_none() && form.positions(index, exchange.nc())))
    }

    /// The PLC positions an axis.
    pub fn is_on(&self) -> bool {
        self.targets.iter().any(Option::is_some)
    }

    /// Moves what the PLC positions; the NC resets the strobe at the end, or when it is broken off.
    pub fn moves(&mut self, axes: &mut OwnAxes, exchange: &mut Exchange, moving: &Moving) {
        let now = &moving.now;
        // NC stop ends it in Manual and Handwheel; in the automatic modes only with internal stop.
        let broken_off = now.stop && !moving.active;
        let mut reached = PerPlcAxis::splat(false);
        for unit in axes.iter_mut() {
            let Some(target) = self.targets.get(unit.index).copied().flatten() else {
                if unit.mover == Mover::Positioning && !moving.restores {
                    unit.drive(now.time_s, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
                    if unit.stands() {
                        unit.mover = Mover::None;
                    }
                }
                continue;
            };
            unit.ask_to_unclamp();
            if !(unit.servo.closed() && unit.enabled) {
                continue;
            }
            unit.mover = Mover::Positioning;
            let (aim, feed) = if now.stop {
                (Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min)
            } else {
                let feed = (target.feed_mm_min * now.feed_percent / 100.0).min(now.rapid_limit_mm_min);
                (Aim::Position(target.position), feed)
            };
            unit.drive(now.time_s, aim, feed);
            let there = unit.ptp.is_at(target.position) && unit.servo.in_position();
            if (there || broken_off)
                && let Some(reached) = reached.get_mut(unit.index)
            {
                *reached = true;
            }
        }
        for (index, reached) in reached.into_iter().enumerate() {
            if reached {
                self.end(index, exchange);
            }
        }
    }

    /// Resets the strobe of a PLC positioning.
    fn end(&mut self, index: usize, exchange: &mut Exchange) {
        if let Some(target) = self.targets.get_mut(index).and_then(Option::take) {
            target.form.end_positioning(index, exchange);
        }
    }

    /// Resets the strobes of all PLC positionings.
    pub fn end_all(&mut self, exchange: &mut Exchange) {
        for index in 0..AXES {
            self.end(index, exchange);
        }
    }

    /// What modules 9120 to 9124 asked for in a scan.
    pub fn take_requests(&mut self, requests: &mut Requests) {
        let wanted = requests.plc_axes.iter_mut().zip(&mut requests.plc_axis_override);
        for (axis, (command, percent)) in self.plc_axes.iter_mut().zip(wanted) {
            if let Some(command) = command.take() {
                axis.command = Some(command);
                axis.target = None;
            }
            if let Some(percent) = percent.take() {
                axis.override_percent = percent;
            }
        }
    }

    /// PLC axes: modules 9120 to 9124. Always with servo lag, no override but that of 9124, no software
    /// limits in the reference run [000:4094-4116] [000:15938-16000].
    pub fn move_plc_axes(&mut self, axes: &mut OwnAxes, statuses: &mut PerPlcAxis<PlcAxisStatus>, now: &Now) {
        for unit in axes.iter_mut() {
            if let (Some(axis), Some(status)) =
                (self.plc_axes.get_mut(unit.index), statuses.get_mut(unit.index))
            {
                if unit.is_plc_axis() {
                    axis.moves(unit, now);
                }
                *status = PlcAxisStatus {
                    positioning: axis.command.is_some(),
                    negative: unit.speed < 0.0,
                    referenced: unit.referenced,
                    error: unit.servo.fault().is_some(),
                };
            }
        }
    }

    /// M2720: free rotation of the axes in B518 in the directions of B519 [000:6494-6517].
    pub fn take_free_rotation(&mut self, exchange: &mut Exchange) {
        let nc = exchange.nc();
        if !nc.bit(signal::FREE_ROTATION) {
            return;
        }
        let axes = nc.number(signal::FREE_ROTATION_AXIS);
        let negative = nc.number(signal::FREE_ROTATION_DIRECTION);
        for (index, rotation) in self.rotation.iter_mut().enumerate().skip(3) {
            let turns = axes >> index & 1 != 0;
            let sign = if negative >> index & 1 != 0 { -1.0 } else { 1.0 };
            *rotation = turns.then_some(sign);
        }
        exchange.nc_set(signal::FREE_ROTATION, false);
    }

    /// Turns the axes of the free rotation, at W566 or W568 with the override W754, 0 to 300 %.
    pub fn move_rotation(&mut self, axes: &mut OwnAxes, nc: &Image, now: &Now) {
        let percent = f64::from(nc.number(signal::FREE_ROTATION_FEED_OVERRIDE).clamp(0, 300));
        for unit in axes.iter_mut() {
            let Some(rotation) = self.rotation.get(unit.index).copied() else {
                continue;
            };
            if !(unit.servo.closed() && unit.enabled) {
                continue;
            }
            match rotation.filter(|_| now.ready) {
                Some(sign) if matches!(unit.mover, Mover::None | Mover::Rotation) => {
                    let word = POSITIONING_FEED.get(unit.index);
                    let feed = word.map_or(0.0, |word| f64::from(nc.number(*word) as u16));
                    unit.mover = Mover::Rotation;
                    let feed = (feed * percent / 100.0).min(now.rapid_limit_mm_min);
                    unit.drive(now.time_s, Aim::Feed(sign * feed), feed);
                }
                None if unit.mover == Mover::Rotation => {
                    unit.drive(now.time_s, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
                    if unit.stands() {
                        unit.mover = Mover::None;
                    }
                }
                _ => {}
            }
        }
    }
}

impl PlcAxis {
    /// Moves its axis for a cycle.
    fn moves(&mut self, unit: &mut AxisUnit, now: &Now) {
        let rapid = unit.parameters.motion.rapid_mm_min;
        let able = unit.servo.closed() && unit.enabled && now.ready;
        let passes_marks = matches!(self.command, Some(PlcAxisCommand::TraverseReferenceMarks { .. }));
        let cancels = unit.servo.fault().is_some_and(|fault| !fault.opens_loop());
        if able && passes_marks && cancels && self.target.is_none() {
            // A reference run cancels the positioning error [000:15979].
            unit.servo.acknowledge();
            unit.transfer();
        }
        // An axis that does not follow stops, as the machine does [000:5198].
        let mut stop = !able || unit.servo.fault().is_some();
        match self.command {
            Some(PlcAxisCommand::Start {
                target,
                incremental,
                feed,
            }) if !stop => {
                let wanted = *self.target.get_or_insert(if incremental {
                    unit.nominal + target
                } else {
                    let modulo = unit.parameters.travel.modulo.map(|modulo| modulo.deg);
                    shortest(unit.nominal, target, modulo)
                });
                let feed = feed.max(0.0) * self.override_percent / 100.0;
                unit.drive(now.time_s, Aim::Position(wanted), feed);
                if unit.ptp.is_at(wanted) && unit.servo.in_position() {
                    self.command = None;
                }
            }
            Some(PlcAxisCommand::TraverseReferenceMarks { feed, negative }) if !stop => {
                if self.target.replace(0.0).is_none() {
                    unit.servo.forget_marks();
                    unit.referenced = false;
                }
                let mark = unit.servo.take_mark();
                if let Some((count, scale)) = mark.and_then(|mark| Some((mark.count, mark.scale_mm?))) {
                    unit.set_datum(count, scale - unit.parameters.travel.machine_datum_mm);
                    unit.referenced = true;
                    self.command = Some(PlcAxisCommand::Stop);
                }
                let feed = feed.max(0.0);
                let sign = if negative { -1.0 } else { 1.0 };
                unit.drive(now.time_s, Aim::Feed(sign * feed), feed);
            }
            _ => stop = true,
        }
        if stop {
            unit.drive(now.time_s, Aim::Feed(0.0), rapid);
            if unit.stands() {
                self.command = None;
            }
        }
        if self.command.is_none() {
            self.target = None;
        }
        unit.mover = if self.command.is_some() {
            Mover::Plc
        } else {
            Mover::None
        };
    }
}

/// The target of an axis with modulo value, on the shorter way [000:4107] (which way is inferred).
fn shortest(from: f64, target: f64, modulo: Option<f64>) -> f64 {
    match modulo.filter(|modulo| *modulo > 0.0) {
        Some(modulo) => {
            let turns = ((from - target) / modulo).round();
            target + turns * modulo
        }
        None => target,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_turns_the_shorter_way() {
        assert_eq!(shortest(350.0, 10.0, Some(360.0)), 370.0);
        assert_eq!(shortest(10.0, 350.0, Some(360.0)), -10.0);
        assert_eq!(shortest(730.0, 108.0, Some(360.0)), 828.0);
        assert_eq!(shortest(350.0, 10.0, None), 10.0);
    }
}
