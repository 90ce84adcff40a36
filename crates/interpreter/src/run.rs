//! The state of a run, and what every block does with it: functions, movements, warnings.

use std::collections::BTreeMap;

use bahn_parameters::technology::{self, Technology};
use bahn_parameters::{InchFeed, MessageId};
use bahn_path::{
    At, Axis, AxisSet, Barrier, Blank, BlockRef, Curve, FeedRate, Function, OverrideLaw, PathElement,
    Position, Synchronisation, TechnologyFunction, ToolShape,
};
use bahn_program::{Compensation, InputSteps, Unit, Value};

use crate::availability::Feature;
use crate::block_functions::BlockFunctions;
use crate::contour::{Contour, ContourMove, Side};
use crate::error::{Fault, WarningKind};
use crate::flow::{self, Flow};
use crate::modal::Modal;
use crate::output::Output;
use crate::q_parameters::{QTable, preassigned};
use crate::settings::Settings;
use crate::status::{Spindle, Status};
use crate::told::Told;

/// A probing that waits for its touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probing {
    pub axis: Axis,
    pub target: u16,
    /// +1 in positive, -1 in negative axis direction.
    pub direction: f64,
    pub radius: f64,
    /// Pre-position to which the probe returns.
    pub before: Position,
}

/// Everything that changes while a program runs. A copy of it is a checkpoint.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub modal: Modal,
    pub q: QTable,
    pub at: flow::Position,
    pub contour: Contour,
    pub out: Output,
    /// Tools defined by TOOL DEF.
    pub tools: BTreeMap<u32, ToolShape>,
    /// Unit of the running program.
    pub unit: Unit,
    /// Millimetres of its length unit.
    pub unit_mm: f64,
    /// Unit of the main program.
    pub main_unit: Unit,
    /// Executed blocks.
    pub sequence: u64,
    pub since_motion: u64,
    /// Block being executed: the call block while a cycle runs.
    pub block: BlockRef,
    pub told: Told,
    /// The first BLK FORM of the main program.
    pub blank: Option<Blank>,
    /// The next block is a straight line with coordinates: neither a rounding nor a tangential arc can refer
    /// to the movement of this block, so nothing needs to be held back for it.
    pub line_follows: bool,
    /// The next block is a rounding or chamfer: it refers to the movement of this block.
    pub join_follows: bool,
    /// After an interruption within a block: where the block began. Its incremental coordinates count from
    /// there, so that it ends where it was programmed to (inferred).
    pub increments_from: Option<Position>,
    /// See [`Settings::machine`].
    pub machine: bool,
    /// Nothing is moved: cycles are looked at but make no path, and the tool has no radius.
    pub rehearsal: bool,
    /// The tool was replaced, and the path is still to come back to where it was, programmed and moved.
    pub comes_back: Option<(Position, Position)>,
    /// Probing that waits for its touch.
    pub probing: Option<Probing>,
    /// A contour subprogram is being recorded for an SL cycle: M functions, feeds and cycle calls in it
    /// are ignored [003:5389-5454]. Holds the axes of the first coordinate block.
    pub recording: Option<AxisSet>,
}

impl Run {
    pub fn new(settings: &Settings, unit: Unit) -> Run {
        let mut q = QTable::new(usize::from(settings.model.limits().q_max) + 1);
        let modal = Modal::new(settings.start, settings.tool_length_mm);
        q.preassign(preassigned::TOOL_AXIS, -1.0);
        q.preassign(preassigned::SPINDLE, modal.spindle.q110());
        q.preassign(preassigned::OVERLAP, settings.rules.overlap);
        q.preassign(preassigned::UNIT, if unit == Unit::Inch { 1.0 } else { 0.0 });
        for &(number, value) in &settings.q_values {
            q.preassign(number, value);
        }
        let mut run = Run {
            modal,
            q,
            at: flow::Position::at(0, 0),
            contour: Contour::default(),
            out: Output::default(),
            tools: BTreeMap::new(),
            unit,
            unit_mm: unit.mm(),
            main_unit: unit,
            sequence: 0,
            since_motion: 0,
            block: BlockRef::default(),
            told: Told::default(),
            blank: None,
            line_follows: false,
            join_follows: false,
            increments_from: None,
            machine: settings.machine,
            rehearsal: false,
            comes_back: None,
            probing: None,
            recording: None,
        };
        run.take_status(&settings.status);
        run
    }

    /// Begins with what the run before has left in force.
    fn take_status(&mut self, status: &Status) {
        if let Some((frame, feed)) = status.programmed() {
            self.modal.frame = frame;
            self.modal.feed_mm_min = feed;
            self.modal.take_plane(frame.plane);
        }
        if let Some((spindle, speed_rpm)) = status.spindle() {
            self.modal.speed_rpm = speed_rpm;
            self.set_spindle(spindle);
        }
        if let Some(tool) = status.tool_data() {
            self.modal.tool = Some(tool);
            self.preassign_tool(tool.shape.length, tool.radius);
            self.preassign_tool_axis(tool.axis);
        }
    }

    /// Whether a tool is in the spindle and works on no contour with radius compensation.
    pub fn is_between_contours(&self, tool: u32) -> bool {
        let modal = &self.modal;
        modal.tool.is_some_and(|in_spindle| in_spindle.number == tool)
            && modal.compensation == Compensation::Off
            && modal.paraxial == Compensation::Off
            && self.contour.is_between_contours()
            && (modal.corner_arcs.is_none() || self.contour.is_empty())
            && self.out.queue.is_empty()
            && self.comes_back.is_none()
            && self.probing.is_none()
            && self.recording.is_none()
    }

    /// Notes a warning; the same one at the same block is counted, so that loops do not pile them up.
    pub fn warn(&mut self, kind: WarningKind) {
        self.warn_at(self.block, kind);
    }

    /// [`Run::warn`] at another block than the one being executed.
    pub fn warn_at(&mut self, block: BlockRef, kind: WarningKind) {
        self.told.warn(block, kind);
    }

    /// Whether a function is to be executed. Where it is met first, the user is told when it is not, or not
    /// wholly.
    ///
    /// # Errors
    /// FUNCTION NOT AVAILABLE ON THIS CONTROL for what must not be passed over.
    pub(crate) fn executes(&mut self, feature: Feature, settings: &Settings) -> Result<bool, Fault> {
        if let Some(executes) = self.told.said.executes(feature) {
            return Ok(executes);
        }
        let (executes, remark) = feature.judge(settings)?;
        if let Some(kind) = remark {
            self.warn(kind);
        }
        self.told.said.note(feature, executes);
        Ok(executes)
    }

    /// The block has numbers that were rounded: the user is told at the first of each program.
    ///
    /// # Errors
    /// ENTRY VALUE INCORRECT where checking is strict.
    #[cold]
    pub(crate) fn tell_rounded(&mut self, settings: &Settings) -> Result<(), Fault> {
        let steps = InputSteps::of(settings.model, self.unit);
        let unit = match self.unit {
            Unit::Mm => "mm",
            Unit::Inch => "inch",
        };
        let step = format!("{} {unit} and {}°", steps.length(), steps.angle());
        let first = self.told.said.is_first_rounded(self.block.program);
        // A rehearsal goes on after an error, and says this one once, too.
        if settings.strict && (first || !self.rehearsal) {
            let detail = format!("the input step of this control is {step}");
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        if first {
            self.warn(WarningKind::Rounded { step });
        }
        Ok(())
    }

    pub(crate) fn set_spindle(&mut self, spindle: Spindle) {
        self.modal.spindle = spindle;
        self.q.preassign(preassigned::SPINDLE, spindle.q110());
    }

    pub(crate) fn stop_spindle(&mut self) {
        let stopped = self.modal.spindle.stopped();
        self.set_spindle(stopped);
    }

    /// Q parameters of the tool in use, in the unit of the main program.
    pub(crate) fn preassign_tool(&mut self, length: f64, radius: f64) {
        let unit = self.main_unit_mm();
        self.q.preassign(preassigned::TOOL_RADIUS, radius / unit);
        self.q.preassign(preassigned::TOOL_LENGTH, length / unit);
    }

    /// The Q parameter of the tool axis.
    pub(crate) fn preassign_tool_axis(&mut self, axis: Axis) {
        let number = match axis {
            Axis::X => 0.0,
            Axis::Y => 1.0,
            Axis::Z => 2.0,
            Axis::U => 6.0,
            Axis::V => 7.0,
            Axis::W => 8.0,
            Axis::A | Axis::B | Axis::C => -1.0,
        };
        self.q.preassign(preassigned::TOOL_AXIS, number);
    }

    /// Millimetres of the unit of the main program, in which the control shows lengths.
    pub(crate) fn main_unit_mm(&self) -> f64 {
        self.main_unit.mm()
    }

    /// A function with a block of its own.
    pub fn output_function(
        &mut self,
        function: Function,
        block: technology::Block,
        settings: &Settings,
    ) -> Result<(), Fault> {
        let Some(technology) = Technology::of_block(settings.model, block) else {
            return Ok(());
        };
        let functions = BlockFunctions {
            output: vec![settings.rules.m_functions.output(function, technology)],
            ..Default::default()
        };
        self.hold(functions)?;
        Ok(())
    }

    /// A block of functions without movement.
    pub fn hold(&mut self, functions: BlockFunctions) -> Result<Flow, Fault> {
        if functions.output.is_empty() && !functions.stop && !functions.end {
            return Ok(Flow::Next);
        }
        let element = self.element(Curve::Hold, self.modal.actual, self.modal.actual, FeedRate::Rapid);
        self.push(element, functions, false)
    }

    /// Hands a movement or hold with the functions of its block to the contour stages.
    pub fn push(
        &mut self,
        mut element: PathElement,
        mut functions: BlockFunctions,
        in_plane: bool,
    ) -> Result<Flow, Fault> {
        let mut barrier = None;
        if functions.stop {
            let stop = TechnologyFunction::new(Function::Stop, At::End, Synchronisation::MnsSns);
            functions.output.push(stop);
            barrier = Some(Barrier::Stop { block: self.block });
        } else if self.machine && !functions.cycle_call && self.may_wait_for_plc(&element, &functions.output)
        {
            barrier = Some(Barrier::Acknowledge { block: self.block });
        }
        if !functions.output.is_empty() {
            element.functions = Some(functions.output.into_boxed_slice());
        }
        element.constant_speed = functions.constant_speed;
        self.note_motion(element.curve, &element.start, &element.end);
        if self.machine && barrier.is_some() {
            self.note_time();
        }
        let item = ContourMove {
            element,
            plane: self.modal.contour_plane,
            side: self.side(),
            radius: if self.rehearsal {
                0.0
            } else {
                self.modal.tool_radius()
            },
            corner: functions.corner,
            feed_law: self.modal.feed_law,
            in_plane,
            smooth: None,
            barrier,
            corner_arcs: self.modal.corner_arcs,
        };
        let waits = item.barrier.is_some() && item.side == Side::Off;
        self.contour
            .push(item, &mut self.out)
            .map_err(Fault::found_ahead)?;
        if waits {
            // The run stands still here: no block behind it is read before it goes on. Inside a compensated
            // contour the corner needs the next element all the same.
            self.contour.flush(&mut self.out).map_err(Fault::found_ahead)?;
        }
        Ok(if functions.end { Flow::EndOfRun } else { Flow::Next })
    }

    /// A block that leads somewhere else is a movement; `L IX+0` is none.
    #[inline]
    pub fn note_motion(&mut self, curve: Curve, start: &Position, end: &Position) {
        // An axis without a position gets one.
        let moves = |axis: Axis| start[axis] != end[axis] && !end[axis].is_nan();
        let moved = match curve {
            Curve::Hold => false,
            Curve::Line => Axis::ALL.into_iter().any(moves),
            Curve::Arc(_) => curve.length(start, end) > 0.0,
        };
        if moved {
            self.since_motion = 0;
        }
    }

    /// What waits on a machine takes time: a loop of it, such as for a Q parameter of the PLC, may go on.
    pub fn note_time(&mut self) {
        self.since_motion = 0;
    }

    /// Whether the path stands until the PLC has acknowledged, so that nothing is lost when the next block is
    /// read only then. A block that goes on moving after its functions is not cut off from the next one, nor
    /// from its rounding or its cycle.
    fn may_wait_for_plc(&self, element: &PathElement, functions: &[TechnologyFunction]) -> bool {
        let stands = |function: &TechnologyFunction| {
            function.synchronisation != Synchronisation::Mos
                && (function.at == At::End || element.curve == Curve::Hold)
        };
        functions.iter().any(stands) && !self.join_follows && !self.contour.has_join()
    }

    /// An element of the current block.
    #[inline]
    pub fn element(&self, curve: Curve, start: Position, end: Position, feed: FeedRate) -> PathElement {
        PathElement {
            block: self.block,
            sequence: self.sequence,
            curve,
            start,
            end,
            feed,
            override_law: OverrideLaw::Free,
            constant_speed: false,
            tangential_end: false,
            dwell_s: 0.0,
            functions: None,
        }
    }

    /// Hands out what the contour stages hold back and takes over where the tool centre really stands.
    pub fn finish_contour(&mut self) -> Result<(), Fault> {
        self.contour.flush(&mut self.out).map_err(Fault::found_ahead)
    }

    /// Where the tool centre stands after [`Run::finish_contour`].
    pub fn tool_centre(&self) -> Position {
        let mut position = self.modal.actual;
        if let Some((plane, point)) = self.contour.displaced() {
            plane.set(&mut position, point);
        }
        position
    }

    /// Side of the tool in workpiece coordinates: a mirrored contour has it on the other side.
    fn side(&self) -> Side {
        let side = match self.modal.compensation {
            Compensation::Left => Side::Left,
            Compensation::Right => Side::Right,
            _ => return Side::Off,
        };
        if self.modal.frame.reverses(self.modal.contour_plane) {
            side.mirrored()
        } else {
            side
        }
    }

    /// Scaling factor in the working plane.
    pub fn plane_scale(&self) -> f64 {
        self.modal.frame.factor[self.modal.plane.first].abs()
    }

    /// A length in mm.
    pub fn length(&self, value: Value) -> Result<f64, Fault> {
        Ok(self.q.value(value)? * self.unit_mm)
    }

    /// A feed in mm/min, checked against the range of the control [003:2142-2144].
    pub fn feed(&self, value: Value, settings: &Settings) -> Result<f64, Fault> {
        let feed = self.q.value(value)?;
        let inch_feed = settings.inch_feed();
        let max_mm_min = settings.model.limits().feed_max_mm_min;
        let max = self.unit.feed_max(inch_feed, max_mm_min);
        if !(0.0..=max).contains(&feed) {
            let unit = match (self.unit, inch_feed) {
                (Unit::Mm, _) => "mm/min",
                (Unit::Inch, InchFeed::Whole) => "inch/min",
                (Unit::Inch, InchFeed::Tenths) => "tenths of an inch/min",
            };
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                format!("F takes 0 to {max} {unit}"),
            ));
        }
        Ok((feed * self.unit.feed_mm_min(inch_feed)).min(max_mm_min))
    }

    /// Millimetres or degrees of a value for an axis.
    pub fn axis_unit(&self, axis: Axis) -> f64 {
        if axis.is_rotary() { 1.0 } else { self.unit_mm }
    }
}
