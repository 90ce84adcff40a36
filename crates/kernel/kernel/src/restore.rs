//! Block scan and return to the contour [000:6765-6832].
//!
//! The scan executes the program without moving an axis up to a block; its functions are output. Then the axes go to where
//! the path is, or, after they were moved by hand, back to where it was interrupted.
//!
//! Decision: After EMERGENCY STOP or POSITIONING ERROR the loops close where the axes stand; NC start first brings
//! them back to where the path left them
//!
//! Decision: A clamped axis need not go back to the contour within MP1110; farther away the PLC is asked to unclamp
//! it. Until axes are back nothing is taken over from where they stand (also `kernel/src/track.rs`)
//!
//! Decision: After the way back to the contour the path goes on from where an axis stands that another channel gave
//! back meanwhile

use std::collections::VecDeque;

use bahn_motion::{Aim, FunctionOutput, Place};
use bahn_parameters::operation::RestartParameters;
use bahn_path::{At, Barrier, ElementSource, Function, PathElement, Position, Step, TechnologyFunction};

use crate::axes::OwnAxes;
use crate::axis::{AxisUnit, Mover};
use crate::block_search::{PassOver, Passed, Search, search};
use crate::feeder::{Feeder, RunFault};
use crate::kinematics::Offsets;
use crate::run_family::{Acting, RunFamily};
use crate::track::{RefusedBlock, Track};

/// Steps of a search in one call of prepare at most.
const BUDGET: usize = 1000;

/// Where a return is.
#[derive(Clone, Debug)]
enum Restore {
    /// The scan runs towards a block of the main program.
    Scan {
        block: u32,
        functions: VecDeque<TechnologyFunction>,
        /// The block that gives them.
        giver: RefusedBlock,
        /// A dwell time lasts until then, µs since power-on.
        dwell_until_us: u64,
    },
    /// The scan is at a programmed stop; NC start goes on.
    Stopped { block: u32 },
    /// The axes must be brought to a place, machine coordinates: waiting until that is asked for.
    Ready { target: Position },
    /// It was asked for, or the movement was stopped: waiting for NC start.
    Armed { target: Position },
    /// The axes move, or come to a standstill when they are `stopped`.
    Moving { target: Position, stopped: bool },
}

/// Why a scan ends before its block.
#[derive(Clone, Debug, PartialEq)]
pub enum ScanEnd {
    /// The block does not come.
    NotAddressed,
    /// A block is refused.
    Fault(RunFault),
    /// A function of a block is refused, and its block with it.
    Refused(RefusedBlock),
}

/// The return to the contour that is on its way, if one is.
#[derive(Clone, Debug, Default)]
pub struct Restoration(Option<Restore>);

impl Restoration {
    /// Axes are being brought back, or are to be.
    pub fn is_on(&self) -> bool {
        self.0.is_some()
    }

    /// Every axis is where the path has left it: the program may go on from where they stand.
    pub fn is_over(&self, axes: &OwnAxes) -> bool {
        self.0.is_none() && !axes.are_away()
    }

    /// The block is not found yet.
    pub fn scans(&self) -> bool {
        matches!(self.0, Some(Restore::Scan { .. } | Restore::Stopped { .. }))
    }

    /// The scan to a block begins.
    pub fn scan(&mut self, block: u32) {
        self.0 = Some(scan_to(block));
    }

    /// Nothing returns any more.
    pub fn break_off(&mut self) {
        self.0 = None;
    }

    /// After a stop in which axes lost their nominal positions (EMERGENCY STOP, POSITIONING ERROR) they go
    /// back to where the path left them before it goes on (inferred).
    pub fn return_to_path(&mut self, axes: &mut OwnAxes) {
        let mut target = axes.machine_position();
        let away = take_left(axes, &mut target);
        if away && self.0.is_none() {
            let stopped = false;
            self.0 = Some(Restore::Moving { target, stopped });
        }
    }

    /// The axes are to go back with NC start, from where an interrupted path was left when it `may` return there.
    pub fn arm(&mut self, may: bool, track: &Track, at: &mut Acting) -> bool {
        let target = match &self.0 {
            Some(Restore::Ready { target }) => *target,
            None if may => {
                let mut target = at.chain.to_axes(&track.stands_at());
                take_left(at.axes, &mut target);
                target
            }
            _ => return false,
        };
        self.0 = Some(Restore::Armed { target });
        true
    }

    /// Goes on with a scan; may allocate. Why it ended, when that was not at its block.
    pub fn prepare<'b>(
        &mut self,
        feeder: &mut Feeder,
        rules: &RestartParameters,
        track: &mut Track,
        family: &mut impl RunFamily<'b>,
    ) -> Option<ScanEnd> {
        let mut scan = Scan {
            state: &mut self.0,
            feeder,
            rules,
            track,
            family,
        };
        match search(&mut scan, BUDGET) {
            Ok(Search::Found | Search::Open) => None,
            Ok(Search::Missing) => Some(ScanEnd::NotAddressed),
            Err(end) => Some(end),
        }
    }

    /// Moves the axes to the contour: those of the working plane first, the tool axis last, unless it has
    /// to be raised (inferred). The feed is that of PLC positioning [000:6785]. The path
    /// goes on from where they stand then: one that another channel gave back meanwhile stays where that has left it. Whether
    /// it is over with this cycle.
    pub fn moves<'b>(
        &mut self,
        feeder: Option<&mut Feeder>,
        track: &mut Track,
        family: &mut impl RunFamily<'b>,
    ) -> bool {
        let now = *family.acting().now;
        let start = now.start && !now.stop;
        match &self.0 {
            Some(Restore::Stopped { block }) if start => {
                let block = *block;
                if let Some(feeder) = feeder {
                    feeder.resume(family.answer());
                }
                self.0 = Some(scan_to(block));
                return false;
            }
            Some(Restore::Armed { target }) if start => {
                let (target, stopped) = (*target, false);
                self.0 = Some(Restore::Moving { target, stopped });
            }
            _ => {}
        }
        let Some(Restore::Moving { target, stopped }) = &mut self.0 else {
            return false;
        };
        // What has stopped moves again with NC start only.
        *stopped |= now.stop;
        let (target, stopped) = (*target, *stopped);
        let at = &mut family.acting();
        let over = lead_to(&target, stopped, at);
        if over {
            at.axes.release(|mover| mover == Mover::Positioning);
            self.0 = None;
            track.regain(at.axes, at.chain);
        } else if stopped && at.axes.stand() {
            self.0 = Some(Restore::Armed { target });
        }
        over
    }
}

/// A scan with what it reads: the functions of each block go out, one after the other.
struct Scan<'s, 'b> {
    state: &'s mut Option<Restore>,
    feeder: &'s mut Feeder,
    rules: &'s RestartParameters,
    track: &'s mut Track,
    family: &'s mut (dyn RunFamily<'b> + 's),
}

impl PassOver for Scan<'_, '_> {
    type Fault = ScanEnd;

    fn pass(&mut self) -> Result<Passed, ScanEnd> {
        let Some(Restore::Scan {
            block,
            functions,
            giver,
            dwell_until_us,
        }) = &mut self.state
        else {
            return Ok(Passed::Waits);
        };
        let transferred = self.family.has_transferred();
        let now = self.family.acting().now;
        if !transferred || now.stop_pressed || now.us < *dwell_until_us {
            return Ok(Passed::Waits);
        }
        let block = *block;
        if let Some(function) = functions.pop_front() {
            self.family.begin(&FunctionOutput {
                element: 0,
                block: giver.block,
                sequence: giver.sequence,
                place: if function.at == At::End {
                    Place::End
                } else {
                    Place::Start
                },
                waits: true,
            });
            return match self.family.output(&function.function) {
                true => Ok(Passed::Block),
                false => Err(ScanEnd::Refused(*giver)),
            };
        }
        match self.feeder.next() {
            Step::Element(element) => {
                // Nobody goes back after what the scan has passed.
                self.feeder.forget_before(element.sequence);
                if element.block.program == 0 && element.block.block >= block {
                    self.find(element);
                    return Ok(Passed::Found);
                }
                self.pass_element(&element);
            }
            Step::Barrier(Barrier::Stop { .. }) if !self.rules.passes_stops => {
                *self.state = Some(Restore::Stopped { block });
            }
            Step::Barrier(_) => self.feeder.resume(self.family.answer()),
            Step::Starved => return Ok(Passed::Waits),
            Step::End => return Ok(Passed::End),
            Step::Error(fault) => return Err(ScanEnd::Fault(fault)),
        }
        Ok(Passed::Block)
    }

    /// The programs of a file are one for the reader.
    fn begin_next(&mut self) -> Result<bool, ScanEnd> {
        Ok(false)
    }
}

impl Scan<'_, '_> {
    /// The run is to begin with an element: the axes have to be brought to its start.
    fn find(&mut self, element: PathElement) {
        let at = self.family.acting();
        at.chain.place(element.placement.as_ref());
        let mut target = at.chain.to_axes(&element.start);
        for unit in at.axes.iter() {
            if target[unit.axis].is_nan() {
                target[unit.axis] = unit.nominal;
            }
        }
        self.track.begin_at(element.start, at.chain);
        self.feeder.put_back(std::iter::once(element));
        *self.state = Some(Restore::Ready { target });
    }

    fn pass_element(&mut self, element: &PathElement) {
        let at = self.family.acting();
        if let Some(Restore::Scan {
            functions,
            giver,
            dwell_until_us,
            ..
        }) = &mut self.state
        {
            if !self.rules.ignores_dwell {
                *dwell_until_us = at.now.us + (element.dwell_s * 1e6) as u64;
            }
            functions.extend(element.functions().iter().cloned());
            (giver.block, giver.sequence) = (element.block, element.sequence);
        }
        pass_tool_change(element, self.feeder, self.rules, &at);
    }
}

fn scan_to(block: u32) -> Restore {
    Restore::Scan {
        block,
        functions: VecDeque::new(),
        giver: RefusedBlock::default(),
        dwell_until_us: 0,
    }
}

/// The places at which an interrupted path has left axes that were taken over from where they are, which are none of its
/// any more; whether one is somewhere else.
fn take_left(axes: &mut OwnAxes, target: &mut Position) -> bool {
    let mut away = false;
    for unit in axes.iter_mut() {
        if let Some(left_at) = unit.left_at.take() {
            // What is clamped stays where its clamp holds it, unless it was moved (inferred).
            let held = !unit.servo.closed()
                && (left_at - unit.nominal).abs() <= unit.parameters.monitoring.standstill_mm;
            if held {
                unit.stand(left_at);
            }
            target[unit.axis] = left_at;
            away |= left_at != unit.nominal;
        }
    }
    away
}

/// Leads the axes to a place for a cycle, or to a standstill; whether they stand there.
fn lead_to(target: &Position, stopped: bool, at: &mut Acting) -> bool {
    let now = at.now;
    let tool_axis = at.chain.offsets.tool_axis;
    let axes = &mut *at.axes;
    let there = |unit: &AxisUnit| unit.ptp.is_at(target[unit.axis]);
    let raise = axes
        .iter()
        .any(|unit| unit.axis == tool_axis && target[unit.axis] > unit.nominal);
    let others_there = axes
        .iter()
        .filter(|unit| unit.axis != tool_axis && unit.is_free())
        .all(there);
    let tool_there = axes.iter().filter(|unit| unit.axis == tool_axis).all(there);
    for unit in axes.iter_mut().filter(|unit| unit.is_free()) {
        let turn = if unit.axis == tool_axis {
            raise || others_there
        } else {
            !raise || tool_there
        };
        if turn && !unit.ptp.is_at(target[unit.axis]) {
            unit.ask_to_unclamp();
        }
        if !unit.can_be_driven() {
            continue;
        }
        unit.mover = Mover::Positioning;
        let feed = (unit.parameters.motion.plc_mm_min * now.feed_percent / 100.0).min(now.rapid_limit_mm_min);
        if stopped || !turn {
            unit.drive(now.time_s, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
        } else {
            unit.drive(now.time_s, Aim::Position(target[unit.axis]), feed);
        }
    }
    others_there && tool_there && axes.stand()
}

/// Where a tool change would have left some axes, machine coordinates. The scan goes on
/// from there. 1 = calculate: the list says so, the section the reverse [000:6783-6832].
fn pass_tool_change(element: &PathElement, feeder: &mut Feeder, rules: &RestartParameters, at: &Acting) {
    let call = element
        .functions()
        .iter()
        .find_map(|output| match &output.function {
            Function::Tool(call) => Some(*call),
            _ => None,
        });
    let places = rules.tool_change;
    let Some(call) = call.filter(|_| places.iter().any(Option::is_some)) else {
        return;
    };
    let chain = at.chain.with(Offsets {
        tool_axis: call.axis,
        tool_length: call.shape.length,
        ..at.chain.offsets
    });
    let mut position = element.end;
    let mut axes = chain.to_axes(&position);
    for unit in at.axes.iter() {
        if let Some(Some(place)) = places.get(unit.index) {
            axes[unit.axis] = *place;
        }
    }
    let changed = chain.to_path(&axes);
    for unit in at.axes.iter() {
        if let Some(Some(_)) = places.get(unit.index) {
            position[unit.axis] = changed[unit.axis];
        }
    }
    feeder.reader_mut().relocate(&position);
}
