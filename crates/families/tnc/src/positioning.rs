//! Movements that the PLC commands: PLC positioning of NC axes, PLC axes, free rotation.

use bahn_exchange::{Exchange, Image, signal};
use bahn_kernel::{AxisOrder, AxisUnit, Goal, Now, OwnAxes, Positioning};
use bahn_parameters::PerPlcAxis;
use bahn_parameters::plc::PlcParameters;
use bahn_path::Direction;
use bahn_plc::{PlcAxisCommand, PlcAxisStatus};

use crate::markers::{AXES, POSITIONING_FEED, TRANSFER};
use crate::panel::PlcFaultCode;
use crate::plc_link::Requests;
use crate::strobe_form::{self, Form};

/// Position words count in 1/10 000 mm [000:4026].
pub(crate) const PER_MM: f64 = 10_000.0;

/// What the PLC commanded.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlcPositioning {
    moves: Positioning,
    /// In which form an axis is positioned: that strobe is reset at the end.
    forms: PerPlcAxis<Option<Form>>,
    /// Strobes of the marker form that were set in the last scan, taken or not.
    ordered: PerPlcAxis<bool>,
}

/// Target and feed of an axis as the PLC has written them: in words, or by the code of one of MP4210 with the feed
/// of MP4220 for the axis, as on the TNC 151/155 [001:3285-3289] *(inferred)*. `None` for a code that has none.
fn goal(form: Form, unit: &AxisUnit, nc: &Image, numbers: &PlcParameters) -> Option<Goal> {
    let index = unit.index;
    let (position, feed_mm_min) = match form {
        // Feeds above 32 767 mm/min count on in the word.
        Form::Words => (
            f64::from(nc.number(*TRANSFER.get(index)?)) / PER_MM,
            word_feed(index, nc)?,
        ),
        Form::Markers => {
            let code = strobe_form::POSITIONING.get(index)?.code.read(nc)?;
            (
                numbers.coded_position_mm(code)?,
                unit.parameters.motion.plc_mm_min,
            )
        }
    };
    Some(Goal {
        position,
        feed_mm_min,
    })
}

/// W560 ff.: the feed of an axis, mm/min.
fn word_feed(index: usize, nc: &Image) -> Option<f64> {
    Some(f64::from(nc.number(*POSITIONING_FEED.get(index)?) as u16))
}

/// What modules 9120 to 9123 order.
fn order_of(command: PlcAxisCommand) -> AxisOrder {
    match command {
        PlcAxisCommand::Start {
            target,
            incremental,
            feed,
        } => AxisOrder::Go {
            target,
            incremental,
            feed,
        },
        PlcAxisCommand::Stop => AxisOrder::Stop,
        PlcAxisCommand::TraverseReferenceMarks { feed, negative } => AxisOrder::FindMark {
            feed,
            direction: Direction::minus_if(negative),
        },
    }
}

impl PlcPositioning {
    /// Ends what PLC axes do and the free rotation: EMERGENCY STOP.
    pub fn stop(&mut self) {
        self.moves.stop();
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
        let mut running = self.forms.iter().flatten().count();
        let form = Form::of(nc);
        for (index, slot) in self.forms.iter_mut().enumerate() {
            if slot.is_some() || !form.positions(index, nc) || !free || running >= most {
                continue;
            }
            let unit = axes.with_index(index);
            let ready = unit.filter(|unit| unit.referenced && unit.is_free() && unit.parameters.controlled);
            let goal = ready.and_then(|unit| goal(form, unit, nc, numbers));
            self.moves.position(index, goal);
            *slot = goal.map(|_| form);
            running += usize::from(slot.is_some());
        }
    }

    /// Whether the PLC wants an axis positioned that is not yet. It aborts one by resetting its strobe
    /// [000:4009-4013].
    ///
    /// # Errors
    /// The code of the first strobe that agrees with its complement.
    pub fn follow_strobes(&mut self, exchange: &mut Exchange) -> Result<bool, PlcFaultCode> {
        for (index, slot) in self.forms.iter_mut().enumerate() {
            if slot
                .take_if(|form| !form.positions(index, exchange.nc()))
                .is_some()
            {
                self.moves.position(index, None);
            }
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
        let mut forms = self.forms.iter().enumerate();
        Ok(forms.any(|(index, slot)| slot.is_none() && form.positions(index, exchange.nc())))
    }

    /// The PLC positions an axis.
    pub fn is_on(&self) -> bool {
        self.moves.is_on()
    }

    /// Moves what the PLC positions; the NC resets the strobe at the end, or when it is broken off. A program run may be
    /// `active`, and bring axes back to the contour, which it `restores`.
    pub fn moves(
        &mut self,
        axes: &mut OwnAxes,
        exchange: &mut Exchange,
        now: &Now,
        [active, restores]: [bool; 2],
    ) {
        // NC stop ends it in Manual and Handwheel; in the automatic modes only with internal stop.
        let over = self.moves.moves(axes, now, now.stop && !active, restores);
        for (index, over) in over.into_iter().enumerate() {
            if over {
                self.end(index, exchange);
            }
        }
    }

    /// Resets the strobe of a PLC positioning.
    fn end(&mut self, index: usize, exchange: &mut Exchange) {
        if let Some(form) = self.forms.get_mut(index).and_then(Option::take) {
            self.moves.position(index, None);
            form.end_positioning(index, exchange);
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
        for (index, (command, percent)) in wanted.enumerate() {
            if let Some(command) = command.take() {
                self.moves.order(index, order_of(command));
            }
            if let Some(percent) = percent.take() {
                self.moves.set_override(index, percent);
            }
        }
    }

    /// PLC axes: modules 9120 to 9124.
    pub fn move_plc_axes(&mut self, axes: &mut OwnAxes, statuses: &mut PerPlcAxis<PlcAxisStatus>, now: &Now) {
        self.moves.move_ordered(axes, now);
        for unit in axes.iter() {
            if let Some(status) = statuses.get_mut(unit.index) {
                *status = PlcAxisStatus {
                    positioning: self.moves.is_ordered(unit.index),
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
        for index in 3..AXES {
            let turns = axes >> index & 1 != 0;
            let sign = if negative >> index & 1 != 0 { -1.0 } else { 1.0 };
            self.moves.turn(index, turns.then_some(sign));
        }
        exchange.nc_set(signal::FREE_ROTATION, false);
    }

    /// Turns the axes of the free rotation, at W566 or W568 with the override W754, 0 to 300 %.
    pub fn move_rotation(&mut self, axes: &mut OwnAxes, nc: &Image, now: &Now) {
        let percent = f64::from(nc.number(signal::FREE_ROTATION_FEED_OVERRIDE).clamp(0, 300));
        let feed = |index| word_feed(index, nc).unwrap_or(0.0) * percent / 100.0;
        self.moves.move_turning(axes, feed, now);
    }
}
