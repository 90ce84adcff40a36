//! What of a run a program for LinuxCNC can say, in its order.
//!
//! Decision: In G-code a tool is changed at M06 where one follows its call, else at the call, with G43; M functions
//! of the machine become stops, what depends on a probe ends the program

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_interpreter::{Interpreter, WarningKind};
use bahn_parameters::ControlModel;
use bahn_parameters::technology::Technology;
use bahn_path::{
    At, Axis, BlockRef, ControlFunction, Curve, FeedRate, Function, OverrideLaw, PathElement, Plane,
    Position, SpindleOrder, Switch, TechnologyFunction, Thread,
};

use super::back::Stand;
use super::line::Said;
use super::options::Options;
use super::text::bare;
use crate::Listed;
use crate::proof::{self, Event, next_event};

/// Steps of the text to a unit.
pub(super) const STEPS: f64 = 1e6;

/// Runs a program and says what it does.
pub(super) struct Sayer {
    run: Interpreter,
    model: ControlModel,
    unit_mm: f64,
    rapid_mm_min: f64,
    queue: VecDeque<(BlockRef, Said)>,
    /// Whether the tools are changed by an M06 after their call, call by call.
    changes: VecDeque<bool>,
    stand: Stand,
    overrides: bool,
    /// The plunge into a thread whose retraction comes next.
    tap: Option<(Position, Position, Thread)>,
    user_functions: bool,
    refused: Vec<Listed>,
    left_out: Vec<Listed>,
    message: Option<String>,
    completed: bool,
    over: bool,
    /// The block that leaves the workpiece for a place that nobody knows.
    leaves: Option<BlockRef>,
    stop: Arc<AtomicBool>,
}

/// For each tool call whether an M06 comes before the next one.
pub(super) fn tool_changes(
    mut run: Interpreter,
    model: ControlModel,
    stop: &Arc<AtomicBool>,
) -> VecDeque<bool> {
    run.set_interrupt(stop.clone());
    let mut changes = VecDeque::new();
    loop {
        match next_event(&mut run, model) {
            Event::Element(element) => {
                for function in element.functions() {
                    match (&function.function, changes.back_mut()) {
                        (Function::Tool(_), _) => changes.push_back(false),
                        (Function::M(6), Some(last)) => *last = true,
                        _ => {}
                    }
                }
            }
            Event::Stop(_) | Event::Asked(_) => {}
            Event::Message(..) | Event::End | Event::Interrupted => return changes,
        }
        run.take_warnings();
        if stop.load(Ordering::Relaxed) {
            return changes;
        }
    }
}

impl Sayer {
    pub fn new(
        mut run: Interpreter,
        options: &Options,
        changes: VecDeque<bool>,
        stop: &Arc<AtomicBool>,
    ) -> Sayer {
        run.set_interrupt(stop.clone());
        Sayer {
            run,
            model: options.model,
            unit_mm: options.unit.mm(),
            rapid_mm_min: options.rapid_mm_min,
            queue: VecDeque::new(),
            changes,
            stand: Stand::new(),
            overrides: true,
            tap: None,
            user_functions: options.user_functions,
            refused: Vec::new(),
            left_out: Vec::new(),
            message: None,
            completed: false,
            over: false,
            leaves: None,
            stop: stop.clone(),
        }
    }

    pub fn run(&self) -> &Interpreter {
        &self.run
    }

    pub fn completed(&self) -> bool {
        self.completed
    }

    pub fn message(&self) -> Option<&str> {
        self.message.as_deref()
    }

    /// What was refused, and what is left out since the path does not depend on it.
    pub fn into_lists(self) -> (Vec<Listed>, Vec<Listed>) {
        (self.refused, self.left_out)
    }

    /// The next thing; `None` after the end.
    pub fn next(&mut self) -> Option<(BlockRef, Said)> {
        while self.queue.is_empty() && !self.over {
            if self.stop.load(Ordering::Relaxed) {
                self.over = true;
                break;
            }
            let event = next_event(&mut self.run, self.model);
            for warning in self.run.take_warnings() {
                if warning.kind == WarningKind::MachineZeroUnknown {
                    self.leaves.get_or_insert(warning.block);
                }
            }
            match event {
                Event::Element(element) => self.element(&element),
                // It is a function of its element, too.
                Event::Stop(_) => {}
                Event::Asked(block) => {
                    self.completed = true;
                    self.ends(block, "the path after it depends on what a probe finds");
                }
                Event::Message(block, text) => {
                    self.message = Some(text.clone());
                    self.completed = true;
                    self.ends(block, &text);
                }
                Event::End => {
                    self.completed = true;
                    self.over = true;
                    self.queue.push_back((BlockRef::default(), Said::End));
                }
                Event::Interrupted => self.over = true,
            }
        }
        self.queue.pop_front()
    }

    fn say(&mut self, block: BlockRef, said: Said) {
        self.stand.said(&said);
        self.queue.push_back((block, said));
    }

    /// What cannot be said is listed once for each block; the program stops where it is.
    fn refuse(&mut self, block: BlockRef, what: &str) {
        let listed = self.listed(block, what);
        if !self.refused.contains(&listed) {
            self.refused.push(listed);
        }
        self.say(block, Said::Refused(what.to_owned()));
    }

    /// What the path does not depend on is listed once for each block.
    fn leave_out(&mut self, block: BlockRef, what: &str) {
        let listed = self.listed(block, what);
        if !self.left_out.contains(&listed) {
            self.left_out.push(listed);
        }
    }

    fn listed(&self, block: BlockRef, what: &str) -> Listed {
        let at = proof::At::of(&self.run, block);
        Listed {
            block: at.block,
            line: at.line,
            text: at.text,
            reason: what.to_owned(),
        }
    }

    /// Nothing can be said after here.
    fn ends(&mut self, block: BlockRef, what: &str) {
        self.refuse(block, what);
        self.say(block, Said::End);
        self.completed = true;
        self.over = true;
    }

    fn element(&mut self, element: &PathElement) {
        let block = element.block;
        let leaves = self.leaves == Some(block) && element.curve == Curve::Line;
        if let Some(what) = unsayable(element).or(leaves.then_some(UNKNOWN_PLACE)) {
            return self.ends(block, what);
        }
        let overrides = matches!(element.override_law, OverrideLaw::Free | OverrideLaw::Spindle(_));
        let before = |function: &&TechnologyFunction| matches!(function.at, At::Start | At::Ahead(_));
        for function in element.functions().iter().filter(before) {
            self.function(block, function, element.functions());
        }
        if self.over {
            return;
        }
        if overrides != self.overrides {
            self.overrides = overrides;
            self.say(block, Said::Overrides(Switch::from(overrides)));
        }
        if element.constant_speed {
            self.leave_out(block, "M90: G61 holds the corners, whatever the speed");
        }
        match element.thread() {
            Some(thread) => self.thread(element, *thread),
            None => self.movement(element),
        }
        if element.dwell_s > 0.0 {
            self.say(block, Said::Dwell(element.dwell_s));
        }
        for function in element.functions().iter().filter(|function| !before(function)) {
            self.function(block, function, element.functions());
        }
    }

    fn movement(&mut self, element: &PathElement) {
        let (start, end) = (self.rounded(&element.start), self.rounded(&element.end));
        let mut curve = element.curve;
        let mut feed = element.feed;
        if let Curve::Arc(arc) = curve {
            let same = arc.plane.point(&start) == arc.plane.point(&end);
            // Half a turn or less between places that are written the same is no full circle.
            if same && arc.sweep_deg.abs() < 180.0 {
                curve = Curve::Line;
            } else if feed == FeedRate::Rapid {
                feed = FeedRate::Programmed(self.rapid_mm_min);
            }
        }
        if !moves(&start, &end) && !matches!(curve, Curve::Arc(_)) {
            return;
        }
        let start = self.brought_back(element.block, [&start, &end], &curve, feed);
        if moves(&start, &end) || matches!(curve, Curve::Arc(_)) {
            let said = Said::Move {
                curve,
                start,
                end,
                feed,
            };
            self.say(element.block, said);
        }
    }

    /// Brings the axes back for a movement where they stand elsewhere, and says where it begins then.
    fn brought_back(
        &mut self,
        block: BlockRef,
        ends: [&Position; 2],
        curve: &Curve,
        feed: FeedRate,
    ) -> Position {
        let (lines, begins) = self.stand.back(ends, curve, feed);
        lines.into_iter().for_each(|line| self.say(block, line));
        self.stand.goes(ends[0], ends[1]);
        begins
    }

    /// Plunge and retraction of a tap are one line; the spindle turns by the cycle alone.
    fn thread(&mut self, element: &PathElement, thread: Thread) {
        let (start, end) = (self.rounded(&element.start), self.rounded(&element.end));
        let order = SpindleOrder::turn(thread.spindle);
        let mut said = Said::Thread {
            start,
            end,
            pitch_mm: thread.pitch_mm,
            returns: false,
        };
        let mut order = order;
        if thread.retracts {
            let Some((from, bottom, plunge)) = self.tap.take() else {
                self.tap = Some((start, end, thread));
                return;
            };
            if from != end || bottom != start {
                return self.ends(element.block, "the retraction from a thread is not its plunge");
            }
            order = SpindleOrder::turn(plunge.spindle);
            said = Said::Thread {
                start: from,
                end: bottom,
                pitch_mm: plunge.pitch_mm,
                returns: true,
            };
        }
        let begins = if thread.retracts { end } else { start };
        self.brought_back(element.block, [&begins, &begins], &Curve::Line, FeedRate::Rapid);
        // Plunge and retraction of a tap end where it began.
        self.stand.goes(&begins, &end);
        self.say(element.block, Said::Spindle(order));
        self.say(element.block, said);
        self.say(element.block, Said::Spindle(SpindleOrder::Stop));
    }

    /// To the steps of the text.
    fn rounded(&self, position: &Position) -> Position {
        let mut rounded = Position::UNKNOWN;
        for axis in Axis::ALL {
            let unit = if axis.is_rotary() { 1.0 } else { self.unit_mm };
            rounded[axis] = (position[axis] / unit * STEPS).round() / STEPS * unit;
        }
        rounded
    }

    fn function(&mut self, block: BlockRef, function: &TechnologyFunction, beside: &[TechnologyFunction]) {
        match &function.function {
            Function::M(code) => self.m_function(block, *code),
            Function::Tool(call) => {
                self.stand.tool_axis(call.axis);
                self.say(block, Said::Next(call.tool));
                if self.changes.pop_front() == Some(false) {
                    self.say(block, Said::Change);
                }
                if call.speed_rpm > 0.0 {
                    self.say(block, Said::Speed(call.speed_rpm));
                }
            }
            Function::NextTool(tool) => self.say(block, Said::Next(*tool)),
            Function::SpindleSpeed(rpm) => self.say(block, Said::Speed(*rpm)),
            Function::SpindleOrientation(angle) => self.say(block, Said::Orient(angle.rem_euclid(360.0))),
            Function::Stop => {
                let has = |code| beside.iter().any(|of| of.function == Function::M(code));
                // M06 waits by itself.
                if !has(6) {
                    self.say(block, Said::Stop { optional: has(1) });
                }
            }
            Function::Print(text) => self.say(block, Said::Print(bare(text))),
            Function::Voltage(_) => self.refuse(block, "LinuxCNC has no output S of M200 to M204"),
            Function::Plc(_) => self.refuse(block, "LinuxCNC has no FN19 PLC"),
            Function::Blank(_) => self.leave_out(block, "the blank: it is that of the graphics"),
            Function::Control(ControlFunction::SecondServoSet(_)) => {
                self.leave_out(block, "M105, M106: the loops of LinuxCNC are its own");
            }
            Function::Control(_) => {
                self.leave_out(
                    block,
                    "M101, M102, M107, M108: the tools of LinuxCNC have no life",
                );
            }
            Function::Superimpose(_) => {
                self.leave_out(block, "M118: LinuxCNC superimposes no handwheel by a program");
            }
            Function::Write { .. }
            | Function::Shift { .. }
            | Function::Branch { .. }
            | Function::Residual => {
                self.refuse(block, "LinuxCNC has no parameters and branches of a System 900");
            }
            // The angle stands beside M19; LinuxCNC executes one line after the other.
            Function::OrientationAngle(_) | Function::Synchronise => {}
        }
    }

    fn m_function(&mut self, block: BlockRef, code: u16) {
        let spindle = match code {
            3 | 13 => Some(SpindleOrder::Clockwise),
            4 | 14 => Some(SpindleOrder::CounterClockwise),
            0 | 5 => Some(SpindleOrder::Stop),
            _ => None,
        };
        let coolant = match code {
            8 | 13 | 14 => Some(Switch::On),
            0 | 9 => Some(Switch::Off),
            _ => None,
        };
        if let Some(order) = spindle {
            self.say(block, Said::Spindle(order));
        }
        if let Some(switch) = coolant {
            self.say(block, Said::Coolant(switch));
        }
        match code {
            6 => self.say(block, Said::Change),
            // The end says the same.
            2 | 30 | 1 => {}
            _ if spindle.is_some() || coolant.is_some() => {}
            _ if Technology::of_m(self.model, code).is_some_and(|known| known.actions().next().is_some()) => {
            }
            _ if self.user_functions && code < 100 => self.say(block, Said::User(100 + code)),
            _ => self.refuse(
                block,
                &format!("LinuxCNC has no M{code}: it belongs to the machine"),
            ),
        }
    }
}

/// Whether an axis moves between two positions.
fn moves(start: &Position, end: &Position) -> bool {
    Axis::ALL
        .into_iter()
        .any(|axis| end[axis].is_finite() && start[axis] != end[axis])
}

/// Why a movement to a place of the machine has no line.
const UNKNOWN_PLACE: &str = "nobody has said where the machine's datum lies: M91 and M92 need --datum";

/// Why a movement has no line.
fn unsayable(element: &PathElement) -> Option<&'static str> {
    if element.placement.is_some() {
        return Some("swivel axes are compensated, the path is not that of the axes");
    }
    let lost = |axis: Axis| element.end[axis].is_nan() && element.start[axis].is_finite();
    if Axis::ALL.into_iter().any(lost) {
        return Some(UNKNOWN_PLACE);
    }
    match &element.curve {
        Curve::Corner(_) => Some("an arc in a corner (M112) may lie in no main plane"),
        Curve::Arc(arc) if plane_word(&arc.plane).is_none() => {
            Some("LinuxCNC has no arc in the plane of these axes")
        }
        Curve::Arc(arc) if arc.plane.point(&element.start).iter().any(|at| at.is_nan()) => {
            Some("the arc begins where an axis has no position")
        }
        _ => None,
    }
}

/// The G function of a plane.
pub(super) fn plane_word(plane: &Plane) -> Option<&'static str> {
    match (plane.first, plane.second) {
        (Axis::X, Axis::Y) => Some("G17"),
        (Axis::Z, Axis::X) => Some("G18"),
        (Axis::Y, Axis::Z) => Some("G19"),
        _ => None,
    }
}

/// How far what two say is apart, mm; what differs where it is not the same.
pub(super) fn deviation_mm(one: &Said, other: &Said) -> Result<f64, String> {
    match (one, other) {
        (
            Said::Move {
                curve,
                start,
                end,
                feed,
            },
            Said::Move { .. },
        ) => {
            let [one, other] = [one, other].map(as_element);
            if let (Some(mut one), Some(other)) = (one, other) {
                forget_unwritten((&mut one.start, &mut one.end), (&other.start, &other.end));
                if let Some(what) = proof::feeds_differ(one.feed, other.feed) {
                    return Err(what);
                }
                return proof::deviation_mm(&one, &other);
            }
            Err(format!("{curve:?} from {start:?} to {end:?} with {feed:?}"))
        }
        (
            Said::Thread {
                start,
                end,
                pitch_mm,
                returns,
            },
            Said::Thread {
                start: other_start,
                end: other_end,
                pitch_mm: other_pitch,
                returns: other_returns,
            },
        ) if returns == other_returns => {
            let (mut start, mut end) = (*start, *end);
            forget_unwritten((&mut start, &mut end), (other_start, other_end));
            let apart = proof::between(&start, other_start)?.max(proof::between(&end, other_end)?);
            Ok(apart.max((pitch_mm - other_pitch).abs()))
        }
        (Said::Dwell(a), Said::Dwell(b)) if (a - b).abs() < 1e-5 => Ok(0.0),
        (Said::Speed(a), Said::Speed(b)) if (a - b).abs() < 1e-5 => Ok(0.0),
        (Said::Orient(a), Said::Orient(b)) if (a - b).abs() < 1e-5 => Ok(0.0),
        (one, other) if one == other => Ok(0.0),
        (one, other) => Err(format!("{one:?} in the source, {other:?} in the target")),
    }
}

/// A cycle counts from 0 where an axis has no position. A line of the text does not know that; an axis that stands there is
/// not in it.
fn forget_unwritten(one: (&mut Position, &mut Position), other: (&Position, &Position)) {
    for axis in Axis::ALL.into_iter().filter(|axis| other.0[*axis].is_nan()) {
        if other.1[axis].is_nan() && one.0[axis] == one.1[axis] {
            one.1[axis] = f64::NAN;
        }
        one.0[axis] = f64::NAN;
    }
}

fn as_element(said: &Said) -> Option<PathElement> {
    let Said::Move {
        curve,
        start,
        end,
        feed,
    } = said
    else {
        return None;
    };
    Some(PathElement::new(
        BlockRef::default(),
        0,
        *curve,
        [*start, *end],
        *feed,
    ))
}
