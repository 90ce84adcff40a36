//! Block scan and return to the contour [000:6765-6832].
//!
//! The scan executes the program without moving an axis up to a block; its functions go to the PLC with
//! M2059 = 1. RESTORE POSITION then moves the axes to where the path is, or, after MANUAL OPERATION, back to
//! where it was interrupted.

use std::collections::VecDeque;

use bahn_exchange::signal;
use bahn_motion::Aim;
use bahn_parameters::MessageId;
use bahn_path::{Barrier, ElementSource, Function, PathElement, Position, Step, TechnologyFunction};

use crate::axes::Mover;
use crate::control::Control;
use crate::feeder::{Feeder, Offsets};
use crate::functions::Target;
use crate::message::Message;
use crate::run::RunState;

/// Elements that one call of prepare passes at most.
const BUDGET: usize = 1000;

/// Where a return is.
#[derive(Clone, Debug)]
pub(crate) enum Restore {
    /// The scan runs towards a block of the main program.
    Scan {
        block: u32,
        functions: VecDeque<TechnologyFunction>,
        /// A dwell time lasts until then, µs since power-on.
        dwell_until_us: u64,
    },
    /// The scan is at a programmed stop; NC start goes on (MP7680 bit 3 = 0).
    Stopped { block: u32 },
    /// The axes must be brought to a place, machine coordinates: waiting for RESTORE POSITION.
    Ready { target: Position },
    /// RESTORE POSITION was given: waiting for NC start.
    Armed { target: Position },
    /// The axes move.
    Moving { target: Position },
}

impl Restore {
    /// The block is not found yet.
    pub fn scans(&self) -> bool {
        matches!(self, Restore::Scan { .. } | Restore::Stopped { .. })
    }
}

impl Control {
    /// RESTORE AT N: scans to a block.
    pub(crate) fn restore_at(&mut self, block: u32) -> bool {
        if self.run.is_active() || !self.operation.restart.block_scan {
            return false;
        }
        let Ok(program) = self.open_program() else {
            return false;
        };
        // The scan starts at the cursor, or with MP7680 bit 5 at the begin of the program.
        if self.operation.restart.from_start {
            self.run.start_block = 0;
        }
        let machine = self.machine_position();
        let feeder = self.new_feeder(program, &machine, self.traverse_box());
        self.run.feeder = Some(feeder);
        self.run.state = RunState::Interrupted;
        self.run.broken = false;
        self.run.ended = false;
        self.run.restore = Some(Restore::Scan {
            block,
            functions: VecDeque::new(),
            dwell_until_us: 0,
        });
        self.put(signal::BLOCK_SCAN_ACTIVE, true);
        true
    }

    /// MANUAL OPERATION while a run is interrupted.
    pub(crate) fn manual_operation(&mut self) -> bool {
        let possible = self.run.state == RunState::Interrupted
            && self.run.restore.is_none()
            && (self.operation.restart.return_to_contour && self.path_stands() || self.path.is_coupled());
        if possible {
            self.put(signal::MANUAL_OPERATION_PRESSED, true);
            let free = !self.path.is_coupled();
            for unit in self
                .axes
                .iter_mut()
                .filter(|unit| free && unit.mover == Mover::Path)
            {
                unit.mover = Mover::None;
            }
        }
        possible
    }

    /// Whether the operator may move axes while a run is interrupted.
    pub(crate) fn manual_operation_is_on(&self) -> bool {
        self.run.state == RunState::Interrupted && self.exchange.nc().bit(signal::MANUAL_OPERATION_PRESSED)
    }

    /// RESTORE POSITION.
    pub(crate) fn restore_position(&mut self) -> bool {
        let target = match &self.run.restore {
            Some(Restore::Ready { target }) => *target,
            None if self.manual_operation_is_on() => self.offsets.to_machine(&self.path.position()),
            _ => return false,
        };
        self.put(signal::MANUAL_OPERATION_PRESSED, false);
        self.put(signal::BLOCK_SCAN_ACTIVE, false);
        self.put(signal::RESTORE_POSITION_ACTIVE, true);
        self.run.restore = Some(Restore::Armed { target });
        true
    }

    /// Goes on with a scan; may allocate.
    pub(crate) fn prepare_restore(&mut self) {
        if let Some(feeder) = &mut self.run.feeder {
            feeder.allow_work();
        }
        for _ in 0..BUDGET {
            let Some(Restore::Scan {
                block,
                functions,
                dwell_until_us,
            }) = &mut self.run.restore
            else {
                return;
            };
            if !self.handshakes.is_idle() || self.panel.stop || self.now_us < *dwell_until_us {
                return;
            }
            let block = *block;
            if let Some(function) = functions.pop_front() {
                self.run.q_transfer.strobe();
                let mut target = Target {
                    spindle: &mut self.spindle,
                    tools: &mut self.tools,
                    offsets: &mut self.offsets,
                    handshakes: &mut self.handshakes,
                    exchange: &mut self.exchange,
                    axes: &mut self.axes,
                    inch: self.run.feeder.as_ref().is_some_and(Feeder::inch),
                };
                target.output(&function.function);
                continue;
            }
            let Some(feeder) = &mut self.run.feeder else {
                return;
            };
            match feeder.next() {
                Step::Element(element) => self.pass(element, block),
                Step::Barrier(Barrier::Stop { .. }) if !self.operation.restart.passes_stops => {
                    self.run.restore = Some(Restore::Stopped { block });
                }
                Step::Barrier(_) => feeder.resume(self.run.q_transfer.answer()),
                Step::Starved => return,
                Step::End => {
                    // The block does not come: the scan ends with the program.
                    self.show(Message::Plain(MessageId::SelectedBlockNotAddressed), false);
                    self.internal_stop();
                    return;
                }
                Step::Error(fault) => {
                    self.show_fault(fault);
                    self.internal_stop();
                    return;
                }
            }
        }
    }

    /// Passes an element of the scan, or has found the block.
    fn pass(&mut self, element: PathElement, block: u32) {
        if element.block.program == 0 && element.block.block >= block {
            let mut target = self.offsets.to_machine(&element.start);
            let here = self.machine_position();
            for unit in &self.axes {
                if target[unit.axis].is_nan() {
                    target[unit.axis] = here[unit.axis];
                }
            }
            self.path.set_position(element.start);
            if let Some(feeder) = &mut self.run.feeder {
                feeder.put_back(std::iter::once(element));
            }
            self.run.restore = Some(Restore::Ready { target });
            return;
        }
        if let Some(Restore::Scan {
            functions,
            dwell_until_us,
            ..
        }) = &mut self.run.restore
        {
            if !self.operation.restart.ignores_dwell {
                *dwell_until_us = self.now_us + (element.dwell_s * 1e6) as u64;
            }
            functions.extend(element.functions().iter().cloned());
        }
        self.pass_tool_change(&element);
    }

    /// MP951: where a tool change would have left the axes of MP7450, machine coordinates. The scan goes on
    /// from there. 1 = calculate: the list says so, the section the reverse [000:6783-6832].
    fn pass_tool_change(&mut self, element: &PathElement) {
        let call = element
            .functions()
            .iter()
            .find_map(|output| match &output.function {
                Function::Tool(call) => Some(*call),
                _ => None,
            });
        let places = self.operation.restart.tool_change;
        let (Some(call), Some(feeder)) = (call, &mut self.run.feeder) else {
            return;
        };
        if places.iter().all(Option::is_none) {
            return;
        }
        let offsets = Offsets {
            tool_axis: call.axis,
            tool_length: call.shape.length,
            ..self.offsets
        };
        let mut position = element.end;
        for unit in &self.axes {
            if let Some(Some(place)) = places.get(unit.index) {
                position[unit.axis] = place - offsets.of(unit.axis);
            }
        }
        feeder.interpreter_mut().relocate(&position);
    }

    /// Moves the axes to the contour: those of the working plane first, the tool axis last, unless it has
    /// to be raised (inferred). The feed is MP4220 of each axis [000:6785].
    pub(crate) fn move_restore(&mut self) {
        let start = self.start_pressed && !self.stop_given();
        match &self.run.restore {
            Some(Restore::Stopped { block }) if start => {
                let block = *block;
                if let Some(feeder) = &mut self.run.feeder {
                    feeder.resume(self.run.q_transfer.answer());
                }
                self.run.restore = Some(Restore::Scan {
                    block,
                    functions: VecDeque::new(),
                    dwell_until_us: 0,
                });
                return;
            }
            Some(Restore::Armed { target }) if start => {
                self.run.restore = Some(Restore::Moving { target: *target });
            }
            _ => {}
        }
        let Some(Restore::Moving { target }) = &self.run.restore else {
            return;
        };
        let (target, time, stop) = (*target, self.cycle_s(), self.stop_given());
        let percent = self.feed_override.percent();
        let limit = self.rapid_limit_mm_min();
        let tool_axis = self.offsets.tool_axis;
        let there = |unit: &crate::axes::AxisUnit| unit.ptp.is_at(target[unit.axis]);
        let raise = self
            .axes
            .iter()
            .any(|unit| unit.axis == tool_axis && target[unit.axis] > unit.nominal);
        let others_there = self
            .axes
            .iter()
            .filter(|unit| unit.axis != tool_axis && !unit.is_plc_axis())
            .all(there);
        let tool_there = self.axes.iter().filter(|unit| unit.axis == tool_axis).all(there);
        for unit in self.axes.iter_mut().filter(|unit| !unit.is_plc_axis()) {
            if !(unit.servo.closed() && unit.enabled) {
                continue;
            }
            let turn = if unit.axis == tool_axis {
                raise || others_there
            } else {
                !raise || tool_there
            };
            unit.mover = Mover::Positioning;
            let feed = (unit.parameters.motion.plc_mm_min * percent / 100.0).min(limit);
            if stop || !turn {
                unit.drive(time, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
            } else {
                unit.drive(time, Aim::Position(target[unit.axis]), feed);
            }
        }
        if others_there && tool_there && self.axes.iter().all(|unit| unit.stands()) {
            for unit in self
                .axes
                .iter_mut()
                .filter(|unit| unit.mover == Mover::Positioning)
            {
                unit.mover = Mover::None;
            }
            self.run.restore = None;
            self.put(signal::RESTORE_POSITION_ACTIVE, false);
        }
    }
}
