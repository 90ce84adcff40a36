//! From blocks to the path: where each function is output, and where the path waits for it.
//!
//! Decision: A block with G04 and no motion is one without a motion: its functions are output and waited for before
//! the dwell

use bahn_din::{Command, Unit};
use bahn_kernel::gates::{Action, Driving, Held, JointFeed, Leg, VectorLimit};
use bahn_path::{Ahead, Axis, Curve, OutputPlace, Switch, WaitPlace};

use super::decoding::Edge;
use super::fault::{named, numbered};
use super::order::OrderId;
use super::own::Own;
use super::plan::Taking;
use super::resolve::Resolve;
use crate::report::{Fault, Warning};

/// 0.1 µm are this part of a mm.
const PER_MM: f64 = 1e4;

/// The functions of a block by where they are output and waited for.
#[derive(Debug, Default)]
struct Sorted {
    /// Spindles of the NC are commanded.
    commanded: Vec<OrderId>,
    /// Output before the motion.
    before: Vec<OrderId>,
    /// Waited for before it.
    gate: Vec<OrderId>,
    /// Waited for after it.
    gate_after: Vec<OrderId>,
    /// Done after the motion.
    after: Vec<Action<OrderId, Own>>,
    /// Output ahead of the motion.
    ahead: Vec<OrderId>,
    /// Micro Joints before the motion and after it.
    joints: Vec<OrderId>,
    joints_after: Vec<OrderId>,
    /// At the measuring event.
    measured: Option<OrderId>,
}

impl Taking<'_> {
    /// Takes a block into the path.
    pub(super) fn take(&mut self, unit: &Unit) -> Result<(), Fault> {
        self.decoding.units += 1;
        let mut resolve = Resolve {
            settings: &self.in_force.settings,
            ranges: self.ranges,
            orders: self.orders,
            cycle_s: self.cycle_s,
        };
        let ids = resolve.block(unit)?;
        let flush_and_wait = self.flush_and_wait(&ids, unit)?;
        self.commands(unit)?;
        let moves = unit.motion.as_ref().is_some_and(is_moving);
        let sorted = self.sort(&ids, unit, moves)?;
        self.before(&sorted, unit)?;
        if let Some(motion) = &unit.motion {
            if moves {
                self.motion(motion, unit);
            }
            if let Some(id) = sorted.measured {
                self.measured(id, unit);
            }
            // Nothing is output ahead across the place where such a function is waited for [004:135].
            let waits_after = |id: &&OrderId| {
                let order = self.orders.get(**id);
                moves && order.is_some_and(|order| order.synch.kind.spans_motion())
            };
            if sorted.gate_after.iter().any(|id| waits_after(&id)) {
                self.gates.window.bar();
            }
        }
        self.after(&sorted, unit)?;
        // An axis that moves on its own has ended with its block (inferred).
        let moves_alone = |command: &Command| matches!(command, Command::Independent(_));
        let alone = unit.commands.iter().any(moves_alone);
        if alone {
            self.gates.window.action(Action::Own(Own::AllEnded));
        }
        if (moves || alone) && !unit.ends {
            self.gates.window.action(Action::BlockEnd);
        }
        if flush_and_wait || alone {
            self.flush(true);
        }
        if unit.ends {
            self.end();
        }
        if !self.in_force.settings.micro_joint.enabled || self.gates.window.is_full() {
            self.gates.release();
        }
        Ok(())
    }

    /// Whether a function holds decoding after the block.
    fn flush_and_wait(&self, ids: &[OrderId], unit: &Unit) -> Result<bool, Fault> {
        let of_block = ids.iter().filter_map(|id| self.orders.get(*id));
        let mut flushing = of_block.filter(|order| order.synch.flush_and_wait);
        let Some(order) = flushing.next() else {
            return Ok(false);
        };
        let turns_on = |command: &Command| matches!(command, Command::RadiusCompensation(Switch::On));
        if self.decoding.radius_compensation || unit.commands.iter().any(turns_on) {
            let message = format!(
                "{} with FAW_SYNCH, while tool radius compensation is on",
                order.label()
            );
            return Err(named(&unit.place, "faw-synch", message));
        }
        Ok(true)
    }

    fn commands(&mut self, unit: &Unit) -> Result<(), Fault> {
        for command in &unit.commands {
            match command {
                Command::ExplicitSynchronisation => {
                    let ids = std::mem::take(&mut self.late[1]);
                    self.gate(ids);
                }
                Command::Flush { wait } => self.flush(*wait),
                Command::MicroJoint {
                    entry_mm_min,
                    feed_mm_min,
                    vector_limit_off,
                } => {
                    self.gates.window.next = Some(JointFeed {
                        entry_mm_min: *entry_mm_min,
                        feed_mm_min: *feed_mm_min,
                        vector_limit_off: *vector_limit_off,
                    });
                }
                Command::VectorLimit {
                    velocity_mm_min,
                    acceleration_mm_s2,
                    deceleration_mm_s2,
                } => {
                    let or_none = |value: &Option<f64>| value.unwrap_or(f64::INFINITY);
                    self.decoding.limit = Some(VectorLimit {
                        velocity_mm_min: or_none(velocity_mm_min),
                        acceleration_mm_s2: or_none(acceleration_mm_s2).min(or_none(deceleration_mm_s2)),
                    });
                }
                Command::EdgeBanding(switch) => self.decoding.edge = switch.is_on().then(Edge::default),
                Command::RadiusCompensation(switch) => self.decoding.radius_compensation = switch.is_on(),
                Command::Independent(independent) => {
                    self.gates
                        .window
                        .action(Action::Own(Own::Independent(Box::new(independent.clone()))));
                }
                Command::Spindle(order) => {
                    let called = self.in_force.settings.spindle_called(&order.spindle);
                    if called.is_some_and(|(_, spindle)| spindle.plc_control) && order.position_deg.is_some()
                    {
                        let message = format!("a position is not available for {}", order.spindle);
                        return Err(numbered(&unit.place, 21202, message));
                    }
                }
            }
        }
        Ok(())
    }

    /// Nothing is output ahead across this place; with `wait` decoding holds until the channel is empty.
    pub(super) fn flush(&mut self, wait: bool) {
        self.gates.bar();
        self.decoding.holds |= wait;
    }

    /// The path stands here until functions are done.
    fn gate(&mut self, ids: Vec<OrderId>) {
        if !ids.is_empty() {
            self.gates.window.action(Action::Gate(ids.into()));
        }
    }

    fn sort(&mut self, ids: &[OrderId], unit: &Unit, moves: bool) -> Result<Sorted, Fault> {
        let mut sorted = Sorted::default();
        for id in ids.iter().copied() {
            let Some(order) = self.orders.get(id) else {
                continue;
            };
            let is_output = order.range.is_some();
            let kind = order.synch.kind;
            // Without a motion nothing is before or after it [004:57], so that functions go out in the order of the block.
            let (output, wait) = match kind.wait() {
                WaitPlace::After if !moves => (OutputPlace::Before, WaitPlace::Before),
                wait => (kind.output(), wait),
            };
            if order.spindle.is_some() {
                sorted.commanded.push(id);
            }
            if kind.takes_micro_joint() && order.lead.is_some() {
                match output {
                    OutputPlace::After => sorted.joints_after.push(id),
                    _ => sorted.joints.push(id),
                }
                continue;
            }
            match output {
                OutputPlace::Before if is_output => sorted.before.push(id),
                OutputPlace::Before | OutputPlace::Nowhere => {}
                // The path stands in any case [004:66], also for a spindle that has confirmed by then.
                OutputPlace::After if is_output => sorted.after.push(Action::Output(id)),
                OutputPlace::After => sorted.after.push(Action::Stand(id)),
                OutputPlace::Distance | OutputPlace::Time => sorted.ahead.push(id),
                OutputPlace::Event => {
                    let motion = unit.motion.is_some() && self.decoding.edge.is_some();
                    if !motion {
                        let message = format!("{} without a motion between G108 and G107", order.label());
                        return Err(named(&unit.place, "edge-banding", message));
                    }
                    sorted.measured = Some(id);
                }
            }
            match wait {
                WaitPlace::Before => sorted.gate.push(id),
                WaitPlace::After => sorted.gate_after.push(id),
                WaitPlace::Feed => self.late[0].push(id),
                WaitPlace::Point => self.late[1].push(id),
                WaitPlace::Nowhere | WaitPlace::Output => {}
            }
        }
        Ok(sorted)
    }

    /// What is done before the motion.
    fn before(&mut self, sorted: &Sorted, unit: &Unit) -> Result<(), Fault> {
        for id in &sorted.commanded {
            self.gates.window.action(Action::Command(*id));
        }
        for id in &sorted.joints {
            self.joint(*id, unit)?;
        }
        for id in &sorted.before {
            self.gates.window.action(Action::Output(*id));
        }
        for id in &sorted.ahead {
            let point = self.gates.window.distance();
            match self.orders.get(*id).and_then(|order| order.lead) {
                Some(lead) => self.gates.leads.push(*id, self.decoding.units, lead, point),
                None => self.gates.window.action(Action::Output(*id)),
            }
        }
        let mut gate = sorted.gate.clone();
        if unit.motion.as_ref().is_some_and(|motion| !motion.rapid) {
            gate.append(&mut self.late[0]);
        }
        self.gate(gate);
        Ok(())
    }

    /// Takes the motion of a block.
    fn motion(&mut self, motion: &bahn_din::Motion, unit: &Unit) {
        let settings = &self.in_force.settings;
        let leg = Leg {
            curve: motion.curve,
            start: motion.start,
            end: motion.end,
            driving: Driving {
                rapid: motion.rapid,
                feed_mm_min: motion.feed_mm_min,
                limit: self.decoding.limit.unwrap_or(VectorLimit::NONE),
            },
            block: unit.place.block.clone(),
            unit: self.decoding.units,
            length_mm: motion.curve.length(&motion.start, &motion.end),
            from_mm: self.gates.window.distance(),
        };
        if let (Some(edge), Some(script)) = (&mut self.decoding.edge, self.script)
            && edge.probed.is_none()
        {
            let mut crossings = script
                .driving
                .probes
                .iter()
                .filter_map(|probe| crossing(&leg, *probe));
            edge.probed = crossings.next().map(|along| leg.from_mm + along);
        }
        let most = if settings.micro_joint.enabled {
            settings.micro_joint.blocks as usize
        } else {
            0
        };
        let blocks = settings.pre_output.blocks as usize;
        self.gates.push(leg, most.max(1), blocks);
    }

    /// What is done after the motion.
    fn after(&mut self, sorted: &Sorted, unit: &Unit) -> Result<(), Fault> {
        if unit.dwell_s > 0.0 {
            self.gates.window.action(Action::Dwell(unit.dwell_s));
        }
        for id in &sorted.joints_after {
            self.joint(*id, unit)?;
        }
        for action in &sorted.after {
            self.gates.window.action(action.clone());
        }
        self.gate(sorted.gate_after.clone());
        Ok(())
    }

    /// A function that is output within what was decoded before.
    fn joint(&mut self, id: OrderId, unit: &Unit) -> Result<(), Fault> {
        let Some(order) = self.orders.get(id) else {
            return Ok(());
        };
        let Some(Ahead::Distance(lead)) = order.lead else {
            return Ok(());
        };
        let (waits, kind, label) = (order.waits, order.synch.kind, order.label());
        let settings = self.in_force.settings.micro_joint;
        let farthest = if settings.distance > 0 {
            f64::from(settings.distance) / PER_MM
        } else {
            f64::INFINITY
        };
        let planned = self.gates.window.plan(lead, farthest);
        let tolerance = f64::from(settings.tolerance) / PER_MM;
        if settings.tolerance > 0 && planned.deviation_mm > tolerance {
            let message = format!(
                "{label} is output {:.4} mm after its planned place, more than {tolerance} mm",
                planned.deviation_mm
            );
            return Err(numbered(&unit.place, 120_815, message));
        }
        if planned.held == Held::LookAhead {
            self.warnings.push(Warning {
                message: format!(
                    "{label} is output {:.4} mm after its planned place: the look-ahead ends there",
                    planned.deviation_mm
                ),
                program: unit.place.program.to_string(),
                block: unit.place.block.to_string(),
            });
        }
        let gate = || Action::Gate(Box::new([id]));
        let mut actions = vec![Action::Output(id)];
        let after = match kind {
            kind if waits && kind.spans_motion() => Some(gate()),
            _ => {
                if waits {
                    actions.push(gate());
                }
                None
            }
        };
        self.gates.window.insert(planned.real_mm, actions, after);
        self.gates.window.bar();
        self.gates.release();
        Ok(())
    }

    /// A function at the measuring event of edge banding, after its distance to go [004:69].
    fn measured(&mut self, id: OrderId, unit: &Unit) {
        let label = self
            .orders
            .get(id)
            .map_or_else(String::new, super::order::Order::label);
        let Some(edge) = &mut self.decoding.edge else {
            return;
        };
        let Some(probed) = edge.probed.take() else {
            let message = format!("no measuring event for {label}");
            let fault = named(&unit.place, "probe-missing", message);
            self.gates.window.action(Action::Own(Own::Fault(Box::new(fault))));
            return;
        };
        let place = probed + self.in_force.residual_mm;
        let actions = vec![Action::Output(id), Action::Gate(Box::new([id]))];
        self.gates.window.split_last(place, actions);
        self.gates.window.bar();
    }

    /// The end of a program.
    pub(super) fn end(&mut self) {
        if self.in_force.settings.late_sync_ready {
            let late = std::mem::take(self.late);
            self.gate(late.concat());
        }
        self.gates.window.action(Action::Own(Own::AllEnded));
        self.gates.window.action(Action::Own(Own::End));
        self.flush(false);
        self.decoding.ended = true;
    }

    /// A program begins. Late functions can be open here only after an abort: with P-CHAN-00033 they are waited for [004:78].
    pub(super) fn begin_program(&mut self) {
        self.decoding.begin();
        if self.in_force.settings.late_sync_ready {
            let late = std::mem::take(self.late);
            self.gate(late.concat());
        }
    }
}

/// Whether the axes move.
fn is_moving(motion: &bahn_din::Motion) -> bool {
    motion.curve != Curve::Hold && motion.curve.length(&motion.start, &motion.end) > 0.0
}

/// How far along an element an axis passes a place, mm.
fn crossing(leg: &Leg, (axis, place): (Axis, f64)) -> Option<f64> {
    /// Parts in which an arc is looked at: an axis turns back four times at most in a full circle.
    const PARTS: u32 = 64;
    /// Halvings: to far below a nanometre.
    const HALVINGS: u32 = 60;
    let value = |along: f64| leg.place(along)[axis] - place;
    let parts = if leg.curve == Curve::Line { 1 } else { PARTS };
    let step = leg.length_mm / f64::from(parts);
    for part in 0..parts {
        let (mut a, mut b) = (step * f64::from(part), step * f64::from(part + 1));
        let (at_a, at_b) = (value(a), value(b));
        // The very start counts to the element before, but for the first one.
        if at_a == 0.0 {
            return Some(a);
        }
        if at_b == 0.0 {
            return Some(b);
        }
        if at_a.is_nan() || at_b.is_nan() || (at_a < 0.0) == (at_b < 0.0) {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (a + b);
            if (value(middle) < 0.0) == (at_a < 0.0) {
                a = middle;
            } else {
                b = middle;
            }
        }
        return Some(b);
    }
    None
}
