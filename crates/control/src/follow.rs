//! The axes along the path of a program, contour cycle by contour cycle: gates, stops, functions.

use bahn_motion::{Drive, State, Stop};
use bahn_path::{Axis, AxisSet, Barrier, Curve, PathElement, Position};

use crate::axes::Mover;
use crate::command::Mode;
use crate::control::Control;
use crate::feeder::{Feeder, RunFault};
use crate::message::Message;
use crate::panel::Direction;
use crate::run::{OUTPUTS, Resume, RunState};

/// So near is no other place, mm or degrees.
const SAME_MM: f64 = 1e-6;

impl Control {
    /// Moves the axes along the path for a cycle.
    pub(crate) fn move_path(&mut self) {
        if self.stop_given() {
            self.stop_run();
        } else if self.start_pressed && self.mode.is_automatic() {
            self.start_run();
        }
        if self.run.state == RunState::Idle || self.run.broken || self.run.restore.is_some() {
            return;
        }
        if !self.path_axes_able() {
            // Without feed enable the axes stand at once [000:5352].
            self.path.halt();
            self.hold_path_axes();
            return;
        }
        if self.run.probing.is_some() {
            self.move_probe();
            return;
        }
        self.couple_thread();
        let percent = self.program_override_percent();
        let settled = self.path_in_position();
        let [back, on] = self.way_out();
        let wear = self.tools.wear().message();
        let stopped = self.run.state != RunState::Running && !on && !self.runs_out_of_thread();
        let drive = Drive {
            feed_override_percent: percent,
            rapid_override_percent: percent,
            spindle_override_percent: self.spindle.effective_percent(),
            master: self.master(),
            back,
            rapid_limit_mm_min: self.rapid_limit_mm_min(),
            // Without spindle enable nothing is led. Functions at which the axes do not stop (MP7440 bit 2) may
            // come faster than the PLC takes them.
            hold: stopped
                || self.handshakes.is_crowded()
                || self.path.is_coupled() && !self.spindle.is_enabled(),
            single_block: self.mode == Mode::SingleBlock
                || on
                || wear.is_some()
                || self.handshakes.inhibit_read_in(),
            stop_before: self.replacement_place(),
            in_position: settled,
            clamped: self.clamped_axes(),
            clamping: self.clamping_axes(),
        };
        let cycle = self.path.cycle(&drive);
        self.run.speed = cycle.speed_mm_s;
        self.lead_spindle(cycle.lead);
        self.follow_path(&cycle.position);
        while let Some(output) = self.path.next_output() {
            // Behind a function that waits there is none before it is acknowledged.
            debug_assert!(self.run.waiting.len() < OUTPUTS, "the path waits at its gate");
            self.run.waiting.push_back(output);
            self.output_functions(settled);
        }
        self.output_functions(settled);
        match cycle.state {
            State::Gate(_)
                if self.run.waiting.is_empty() && self.handshakes.is_idle() && !self.is_positioning() =>
            {
                self.path.release();
                self.regain_path();
            }
            State::Master => self.prepare_thread(),
            State::Clamped => self.ask_to_unclamp(drive.clamped),
            State::BlockEnd if settled && self.run.state == RunState::Running => {
                if let Some(message) = wear {
                    self.show(Message::Plain(message), false);
                }
                if self.replaces_here() {
                    // What follows is given by the next preparation.
                } else if self.mode == Mode::SingleBlock || wear.is_some() {
                    self.run.state = RunState::BlockEnd;
                } else if !self.handshakes.inhibit_read_in() {
                    self.path.go_on();
                }
            }
            State::Stopped
                if settled
                    && self.run.waiting.is_empty()
                    && self.handshakes.is_idle()
                    && !self.handshakes.inhibit_read_in() =>
            {
                self.take_stop();
            }
            _ => {}
        }
    }

    /// The axes that the current element moves are held in their loops and have feed enable. An element
    /// that waits for a clamped axis may do so.
    fn path_axes_able(&self) -> bool {
        let Some(element) = self.path.element() else {
            return true;
        };
        let stands = self.path.speed_mm_s() == 0.0;
        self.axes
            .iter()
            .filter(|unit| element.moves(unit.axis))
            .all(|unit| unit.enabled && (unit.servo.closed() || stands))
    }

    /// Axes whose loop is open: no block may move them.
    fn clamped_axes(&self) -> AxisSet {
        let open = self
            .axes
            .iter()
            .filter(|unit| unit.parameters.controlled && !unit.servo.closed());
        open.fold(AxisSet::EMPTY, |axes, unit| axes.with(unit.axis))
    }

    /// Axes that the PLC wants to clamp after their block (M2492 ff.), and whose loop is still closed.
    fn clamping_axes(&self) -> AxisSet {
        let nc = self.exchange.nc();
        let wanted = self.axes.iter().filter(|unit| {
            let marker = crate::markers::WAIT_OPEN_LOOP.get(unit.index);
            unit.servo.closed() && marker.is_some_and(|marker| nc.bit(*marker))
        });
        wanted.fold(AxisSet::EMPTY, |axes, unit| axes.with(unit.axis))
    }

    /// A block wants a clamped axis: its marker M2008 ff. falls, and the PLC unclamps it [000:5407].
    fn ask_to_unclamp(&mut self, clamped: AxisSet) {
        let Some(element) = self.path.element() else {
            return;
        };
        for unit in &mut self.axes {
            if clamped.contains(unit.axis) && element.moves(unit.axis) {
                unit.in_position = false;
            }
        }
    }

    pub(crate) fn path_in_position(&self) -> bool {
        if self.path.is_coupled() {
            return self.thread_in_position();
        }
        self.axes
            .iter()
            .filter(|unit| unit.mover == Mover::Path && unit.servo.closed())
            .all(|unit| unit.stands() && unit.servo.in_position())
    }

    /// The axes of the path stand where they are.
    fn hold_path_axes(&mut self) {
        let time = self.cycle_s();
        for unit in self.axes.iter_mut().filter(|unit| unit.mover == Mover::Path) {
            unit.follow(unit.nominal, time);
        }
    }

    /// The nominal positions of the axes from that of the path.
    fn follow_path(&mut self, position: &Position) {
        let time = self.cycle_s();
        let moved = self.run.last != Some(*position);
        self.run.last = Some(*position);
        let element = self.path.element();
        for unit in &mut self.axes {
            let value = position[unit.axis];
            if value.is_nan() || !matches!(unit.mover, Mover::None | Mover::Path) || unit.is_plc_axis() {
                continue;
            }
            unit.servo
                .set_circular(element.is_some_and(|element| is_circular(element, unit.axis)));
            if moved {
                unit.mover = Mover::Path;
                unit.follow(value + self.offsets.of(unit.axis), time);
            } else {
                unit.follow(unit.nominal, time);
            }
        }
    }

    /// The axes stand elsewhere than the path: the PLC has moved them, corrected the datum or changed the
    /// tool length. The path then goes on from where they are, within the traverse range as it is now.
    pub(crate) fn regain_path(&mut self) {
        if self.path.is_coupled() {
            return;
        }
        // A tool call lets the tip stand elsewhere without a movement.
        let end = match self.path.element() {
            Some(element) if element.curve == Curve::Hold => element.end,
            _ => self.path.position(),
        };
        let at = self.path.position();
        let here = self.offsets.to_path(&self.machine_position());
        let differs = |a: f64, b: f64| (a - b).abs() > SAME_MM;
        let elsewhere = self.axes.iter().map(|unit| unit.axis).any(|axis| {
            differs(here[axis], at[axis]) && (differs(here[axis], end[axis]) || end[axis].is_nan())
        });
        let needed = elsewhere || self.upkeep.range_changed;
        if !needed || !self.run.waiting.is_empty() || self.path.speed_mm_s() != 0.0 {
            return;
        }
        self.upkeep.range_changed = false;
        self.path.recall(here);
        self.run.last = None;
    }

    /// Outputs the functions of the path in their order, once the axes are in position.
    fn output_functions(&mut self, settled: bool) {
        while let Some(output) = self.run.waiting.front().copied() {
            if output.waits && !settled {
                return;
            }
            self.run.waiting.pop_front();
            let Control {
                path,
                spindle,
                tools,
                offsets,
                handshakes,
                exchange,
                axes,
                run,
                ..
            } = self;
            let mut target = crate::functions::Target {
                spindle,
                tools,
                offsets,
                handshakes,
                exchange,
                axes,
                inch: run.feeder.as_ref().is_some_and(Feeder::inch),
            };
            run.q_transfer.strobe();
            for function in path.functions(&output) {
                target.output(&function.function);
            }
        }
    }

    /// The path came to what the source said after it.
    fn take_stop(&mut self) {
        match self.path.take_stop() {
            None => {}
            Some(Stop::Barrier(Barrier::Stop { .. })) => self.run.state = RunState::Stopped,
            Some(Stop::Barrier(Barrier::Acknowledge { .. })) => {
                self.run.answer = Some(self.run.q_transfer.answer());
            }
            Some(Stop::Barrier(Barrier::Probe {
                block,
                from,
                to,
                feed_mm_min,
                ..
            })) => self.begin_probing(block, from, to, feed_mm_min),
            Some(Stop::End) => self.end_run(),
            Some(Stop::Error(fault)) => {
                self.show_fault(fault);
                self.abort_run(Resume::Fault);
            }
        }
    }

    /// Shows why the run cannot go on, at the block that is refused.
    pub(crate) fn show_fault(&mut self, fault: RunFault) {
        match fault {
            RunFault::Program(error) => self.show(Message::Program(error), false),
            RunFault::Limit {
                axis,
                direction,
                block,
                ..
            } => {
                let message = self.limit_message(axis, direction);
                self.show_at(message, false, Some(block));
            }
        }
    }

    pub(crate) fn limit_message(&mut self, axis: Axis, direction: Direction) -> Message {
        let index = self
            .axes
            .iter_mut()
            .find(|unit| unit.axis == axis)
            .map_or(0, |unit| {
                unit.at_limit = Some(direction);
                unit.index
            });
        Message::limit(index, direction)
    }
}

/// Whether an axis moves on the circle of an element, where reversal peaks are compensated.
fn is_circular(element: &PathElement, axis: Axis) -> bool {
    match &element.curve {
        Curve::Arc(arc) => axis == arc.plane.first || axis == arc.plane.second,
        Curve::Line | Curve::Hold => false,
    }
}
