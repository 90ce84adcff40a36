//! A run as a program in plain language: each movement a block of its own, in millimetres and with R0.
//!
//! It is for programs with blocks that DIN/ISO cannot say: what those do to the path is in it. What a block says beyond the path
//! must be sayable in a block again. A tap becomes a cycle from where the tool stands; arcs in corners (M112), swivel axes and what
//! a probe finds are not said.
//!
//! Decision: What is unrolled has no arcs between skew lines (M112), since they lie in no main plane and no arc
//! becomes lines, and no swivel axes, since its path would be that of a plane which its text does not tilt. Its run
//! may warn of less than the source does, of nothing else (also `convert/src/floating_tap.rs`)

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_interpreter::Interpreter;
use bahn_parameters::ControlModel;
use bahn_path::{
    Arc as PathArc, At, Axis, BlockRef, Curve, FeedRate, Function, OverrideLaw, PathElement, Position, Sense,
    ToolCall,
};
use bahn_program::{
    Block, Compensation, Coordinates, CycleBlock, CycleFunction, CycleWord, Feed, FormatOptions, Header,
    MFunctions, Motion, MotionKind, Operation, Quantity, Unit, Value, Word, cycle_parameters, format_block,
};

use crate::floating_tap::{FloatingTaps, Part, Tap};
use crate::lower::bare;
use crate::proof::{self, Difference, Event, Proof, Warned, next_event};

/// Steps to a millimetre and to a degree.
const STEPS: f64 = 1e4;

/// The path of a run as text in plain language.
///
/// # Errors
/// What of it no block can say.
pub fn unroll(
    mut run: Interpreter,
    model: ControlModel,
    define_tools: bool,
    stop: &Arc<AtomicBool>,
) -> Result<String, String> {
    run.set_interrupt(stop.clone());
    let name = run
        .program(0)
        .and_then(|program| program.begin().map(|header| header.name.clone()));
    let header = Header {
        name: name.unwrap_or_default(),
        unit: Some(Unit::Mm),
        protected: false,
    };
    let mut writer = Writer {
        text: String::new(),
        number: 0,
        define_tools,
        defined: BTreeSet::new(),
        tap: None,
        floating: FloatingTaps::default(),
    };
    writer.block(Operation::Begin(Box::new(header.clone())));
    loop {
        let event = next_event(&mut run, model);
        run.take_warnings();
        match event {
            Event::Element(element) => writer.element(&element)?,
            // It is a function of its element, too.
            Event::Stop(_) => {}
            Event::Asked(_) => return Err("the path depends on what a probe finds".to_owned()),
            Event::Message(_, text) => return Err(format!("the run ends with {text}")),
            Event::Interrupted => return Err("the run was not followed to its end".to_owned()),
            Event::End => break,
        }
        if stop.load(Ordering::Relaxed) {
            return Err("the run was not followed to its end".to_owned());
        }
    }
    writer.block(Operation::End(Box::new(header)));
    Ok(writer.text)
}

/// Compares a run with that of its path as [`unroll`] writes it: movements, dwells and functions in their order, however they
/// are spread over blocks. Corners are passed by their geometry. Where cycles and words of a block are gone nobody is warned of
/// them; what only the target warns of is a difference.
pub fn prove_unrolled(
    source: Interpreter,
    target: Interpreter,
    model: ControlModel,
    stop: &Arc<AtomicBool>,
) -> Proof {
    let mut source = Flat::new(source, model, stop);
    let mut target = Flat::new(target, model, stop);
    let mut proof = Proof::new();
    let mut warned = Warned::default();
    loop {
        if stop.load(Ordering::Relaxed) {
            return proof;
        }
        let actions = (source.next(), target.next());
        warned.take(&mut source.run, &mut target.run);
        let what = match actions {
            (Action::Over(one), Action::Over(other)) if one == other => {
                proof.completed = true;
                proof.message = one;
                proof.warnings = warned.both();
                let gained = |source, target| source == 0 && target > 0;
                proof.first_difference = warned.difference(gained, &source.run, &target.run);
                return proof;
            }
            (Action::Move(one), Action::Move(other)) => {
                proof.elements += 1;
                moves_differ(&one, &other, &mut proof)
            }
            (Action::Dwell(one), Action::Dwell(other)) if (one - other).abs() < 1e-3 => None,
            (Action::Function(one), Action::Function(other)) if same_function(&one, &other) => {
                proof.functions += 1;
                None
            }
            (one, other) => Some(format!("{one:?} in the source, {other:?} in the target")),
        };
        if let Some(what) = what {
            proof.first_difference = Some(Difference {
                what,
                source: proof::At::of(&source.run, source.block),
                target: proof::At::of(&target.run, target.block),
            });
            return proof;
        }
    }
}

/// One thing that a run does.
#[derive(Debug)]
enum Action {
    Move(Box<PathElement>),
    Dwell(f64),
    Function(Function),
    Over(Option<String>),
}

/// A run action by action.
struct Flat {
    run: Interpreter,
    model: ControlModel,
    block: BlockRef,
    queue: VecDeque<Action>,
}

impl Flat {
    fn new(mut run: Interpreter, model: ControlModel, stop: &Arc<AtomicBool>) -> Flat {
        run.set_interrupt(stop.clone());
        Flat {
            run,
            model,
            block: BlockRef::default(),
            queue: VecDeque::new(),
        }
    }

    fn next(&mut self) -> Action {
        loop {
            if let Some(action) = self.queue.pop_front() {
                return action;
            }
            match next_event(&mut self.run, self.model) {
                Event::Element(element) => self.element(*element),
                Event::Stop(_) | Event::Asked(_) => {}
                Event::Message(_, text) => return Action::Over(Some(text)),
                Event::End => return Action::Over(None),
                Event::Interrupted => return Action::Over(Some("interrupted".to_owned())),
            }
        }
    }

    fn element(&mut self, mut element: PathElement) {
        self.block = element.block;
        let functions = element.functions.take().unwrap_or_default();
        let (before, after): (Vec<_>, Vec<_>) = functions.into_iter().partition(|of| of.at == At::Start);
        let action = |of: bahn_path::TechnologyFunction| Action::Function(of.function);
        self.queue.extend(before.into_iter().map(action));
        let dwell_s = std::mem::take(&mut element.dwell_s);
        if element.curve != Curve::Hold {
            self.queue.push_back(Action::Move(Box::new(element)));
        }
        if dwell_s > 0.0 {
            self.queue.push_back(Action::Dwell(dwell_s));
        }
        self.queue.extend(after.into_iter().map(action));
    }
}

fn moves_differ(one: &PathElement, other: &PathElement, proof: &mut Proof) -> Option<String> {
    // A cycle counts from 0 where an axis has no position.
    let mut one = one.clone();
    for axis in Axis::ALL.into_iter().filter(|axis| other.start[*axis].is_nan()) {
        one.start[axis] = f64::NAN;
    }
    match proof::deviation_mm(&one, other) {
        Ok(deviation) => {
            proof.deviates(deviation);
            if deviation > proof::TOLERANCE_MM {
                return Some(format!("the path is {:.3} µm apart", deviation * 1e3));
            }
        }
        Err(what) => return Some(what),
    }
    if one.override_law != other.override_law || one.placement != other.placement {
        return Some("what overrides or swivel axes do differs".to_owned());
    }
    proof::feeds_differ(one.feed, other.feed)
}

/// The blank and the tool are the same within the steps of the text.
fn same_function(one: &Function, other: &Function) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= proof::TOLERANCE_MM;
    match (one, other) {
        (Function::Blank(a), Function::Blank(b)) => {
            let corners = a.min.iter().chain(&a.max).zip(b.min.iter().chain(&b.max));
            a.plane == b.plane && corners.into_iter().all(|(a, b)| near(*a, *b))
        }
        (Function::Tool(a), Function::Tool(b)) => {
            (a.tool, a.axis) == (b.tool, b.axis)
                && near(a.speed_rpm, b.speed_rpm)
                && near(a.shape.length, b.shape.length)
                && near(a.shape.radius, b.shape.radius)
        }
        _ => one == other,
    }
}

/// Writes what a run does as blocks without cycles and labels.
struct Writer {
    text: String,
    number: u32,
    define_tools: bool,
    /// Tools with the data that were written last.
    defined: BTreeSet<(u32, u64, u64)>,
    /// The plunge into a thread whose retraction comes next.
    tap: Option<PathElement>,
    floating: FloatingTaps,
}

impl Writer {
    fn block(&mut self, operation: Operation) {
        let block = Block {
            operation,
            ..Block::EMPTY
        };
        let text = format_block(&block, FormatOptions::default());
        self.text.push_str(&format!("{} {text}\n", self.number));
        self.number += 1;
    }

    fn element(&mut self, element: &PathElement) -> Result<(), String> {
        let is_retraction = matches!(element.thread(), Some(thread) if thread.retracts);
        if self.tap.is_some() && !is_retraction {
            return Err("a movement between plunge and retraction of a tap".to_owned());
        }
        match self.floating.take(element)? {
            Part::None => {}
            Part::Inside => return Ok(()),
            Part::Whole(tap) => return self.floating_tap(&tap),
        }
        let mut m = MFunctions::default();
        let mut stops = false;
        for of in element.functions() {
            match &of.function {
                Function::M(code) => {
                    if !m.push(*code) {
                        return Err("more M functions than a block takes".to_owned());
                    }
                }
                Function::Stop => stops = true,
                Function::SpindleOrientation(_) => {
                    if !m.push(19) {
                        return Err("more M functions than a block takes".to_owned());
                    }
                }
                other => self.function(other)?,
            }
        }
        let by_m = [0, 1, 6].iter().any(|code| m.contains(*code));
        match &element.curve {
            Curve::Hold if stops && !by_m => self.block(Operation::Stop(m)),
            _ if stops && !by_m => return Err("a stop within a tap".to_owned()),
            Curve::Hold if m.is_empty() => {}
            Curve::Hold => self.block(Operation::Miscellaneous(m)),
            Curve::Line if element.thread().is_some() => {
                if element.functions().iter().any(|of| of.at != At::Start) {
                    return Err("a function on the way of a thread".to_owned());
                }
                if !m.is_empty() {
                    self.block(Operation::Miscellaneous(m));
                }
                self.thread(element)?;
            }
            Curve::Line => self.movement(element, m, None)?,
            Curve::Arc(arc) => self.movement(element, m, Some(arc))?,
            Curve::Corner(_) => return Err("an arc in a corner (M112)".to_owned()),
        }
        if element.dwell_s > 0.0 {
            self.dwell(element.dwell_s);
        }
        Ok(())
    }

    fn function(&mut self, function: &Function) -> Result<(), String> {
        match function {
            Function::Tool(call) => self.tool(call),
            Function::NextTool(tool) => self.block(Operation::ToolDefinition {
                tool: number(f64::from(*tool)),
                length: None,
                radius: None,
            }),
            Function::SpindleSpeed(rpm) => self.block(Operation::ToolCall {
                tool: None,
                axis: None,
                speed: Some(number(*rpm)),
                delta_length: None,
                delta_radius: None,
            }),
            Function::OrientationAngle(angle) => self.cycle(13, *angle),
            Function::Blank(blank) => {
                let corner = |at: &[f64; 3]| {
                    let mut corner = Coordinates::default();
                    for (axis, value) in [Axis::X, Axis::Y, Axis::Z].into_iter().zip(at) {
                        corner.set(axis, word(*value));
                    }
                    corner
                };
                let (min, max) = (corner(&blank.min), corner(&blank.max));
                self.block(Operation::BlankMin(min, Some(blank.plane.normal)));
                self.block(Operation::BlankMax(max));
            }
            other => return Err(format!("{other:?} belongs to no block of a path")),
        }
        Ok(())
    }

    fn tool(&mut self, call: &ToolCall) {
        let shape = (
            call.tool,
            call.shape.length.to_bits(),
            call.shape.radius.to_bits(),
        );
        if self.define_tools && call.tool != 0 && self.defined.insert(shape) {
            self.block(Operation::ToolDefinition {
                tool: number(f64::from(call.tool)),
                length: Some(number(call.shape.length)),
                radius: Some(number(call.shape.radius)),
            });
        }
        self.block(Operation::ToolCall {
            tool: Some(number(f64::from(call.tool))),
            axis: Some(call.axis),
            speed: Some(number(call.speed_rpm)),
            delta_length: None,
            delta_radius: None,
        });
    }

    fn movement(
        &mut self,
        element: &PathElement,
        m: MFunctions,
        arc: Option<&PathArc>,
    ) -> Result<(), String> {
        match element.override_law {
            OverrideLaw::Free => {}
            _ => return Err("a movement on which overrides do not act".to_owned()),
        }
        if element.placement.is_some() {
            return Err("swivel axes are compensated".to_owned());
        }
        let (start, end) = (&element.start, &element.end);
        let mut motion = Motion {
            coordinates: moved(start, end),
            compensation: Some(Compensation::Off),
            feed: Some(match element.feed {
                FeedRate::Rapid => Feed::Max,
                FeedRate::Programmed(feed) => Feed::Value(number(feed)),
            }),
            m,
            ..bare()
        };
        if let Some(arc) = arc {
            let mut centre = Coordinates::default();
            centre.set(arc.plane.first, word(arc.centre[0]));
            centre.set(arc.plane.second, word(arc.centre[1]));
            self.block(Operation::CircleCentre(centre));
            motion.direction = Some(Sense::of_sweep(arc.sweep_deg));
            let helix = motion
                .coordinates
                .axes()
                .iter()
                .any(|axis| !arc.plane.contains(axis));
            motion.kind = MotionKind::Circle;
            if helix || arc.sweep_deg.abs() > 360.0 {
                // By its angle: the path in the plane follows from the start.
                motion.kind = MotionKind::CirclePolar;
                motion.polar_angle = Some(Word {
                    value: number(arc.sweep_deg),
                    incremental: true,
                });
                let mut outside = Coordinates::default();
                for (axis, value) in motion.coordinates.iter() {
                    if !arc.plane.contains(axis) {
                        outside.set(axis, value);
                    }
                }
                motion.coordinates = outside;
            } else {
                motion
                    .coordinates
                    .set(arc.plane.first, word(end[arc.plane.first]));
                motion
                    .coordinates
                    .set(arc.plane.second, word(end[arc.plane.second]));
            }
        }
        if motion.coordinates.is_empty() && arc.is_none() {
            // A block that leads nowhere names an axis where it stands.
            let axis = end.known().iter().next().ok_or("a movement without a position")?;
            motion.coordinates.set(axis, word(end[axis]));
        }
        self.block(Operation::Motion(motion));
        Ok(())
    }

    /// A movement with the spindle, from where the tool stands: cycle 18, and cycle 17 with the retraction.
    fn thread(&mut self, element: &PathElement) -> Result<(), String> {
        let Some(thread) = element.thread().copied() else {
            return Ok(());
        };
        let plunge = match (thread.retracts, self.tap.take()) {
            (true, None) => {
                self.tap = Some(element.clone());
                return Ok(());
            }
            (true, Some(plunge)) if plunge.start == element.end && plunge.end == element.start => plunge,
            (true, Some(_)) => return Err("the retraction from a thread is not its plunge".to_owned()),
            (false, _) => element.clone(),
        };
        let travel = along_one_axis(&plunge)?;
        let clockwise = plunge
            .thread()
            .is_some_and(|thread| thread.spindle == Sense::Clockwise);
        if thread.retracts {
            let pitch = if clockwise {
                thread.pitch_mm
            } else {
                -thread.pitch_mm
            };
            self.cycle_of(17, &[0.0, travel, pitch]);
        } else {
            // Away from the workpiece the other sense makes the same hand.
            let right_hand = clockwise == (travel < 0.0);
            let pitch = if right_hand {
                thread.pitch_mm
            } else {
                -thread.pitch_mm
            };
            self.cycle_of(18, &[travel, pitch]);
        }
        self.block(Operation::CycleCall(MFunctions::default()));
        Ok(())
    }

    /// A tap with a floating holder from where the tool stands: cycle 2.
    fn floating_tap(&mut self, tap: &Tap) -> Result<(), String> {
        let travel = along_one_axis(&tap.plunge)?;
        self.cycle_of(2, &[0.0, travel, tap.dwell_s, tap.feed_mm_min]);
        self.block(Operation::CycleCall(MFunctions::default()));
        Ok(())
    }

    fn dwell(&mut self, seconds: f64) {
        self.cycle(9, seconds);
    }

    /// A cycle with one number.
    fn cycle(&mut self, number: u16, value: f64) {
        self.cycle_of(number, &[value]);
    }

    /// A cycle with a number in each of its blocks.
    fn cycle_of(&mut self, number: u16, values: &[f64]) {
        let block =
            |sub: u16, words: Vec<CycleWord>| Operation::Cycle(Box::new(CycleBlock { number, sub, words }));
        let numbered = (1..).zip(values);
        let values = numbered.map(|(sub, value)| {
            let value = self::number(*value);
            let parameters = cycle_parameters(CycleFunction::Definition, number, sub);
            let is_feed = parameters.iter().any(|of| of.quantity == Quantity::Feed);
            block(
                sub,
                vec![match is_feed {
                    true => CycleWord::Feed(Feed::Value(value)),
                    false => CycleWord::Number(value),
                }],
            )
        });
        for operation in [block(0, Vec::new())].into_iter().chain(values) {
            self.block(crate::canonical::decorated(operation));
        }
    }
}

/// The travel of a thread, mm, with its sign.
fn along_one_axis(element: &PathElement) -> Result<f64, String> {
    let mut moved = moved(&element.start, &element.end).axes().iter();
    match (moved.next(), moved.next()) {
        (Some(axis), None) => Ok(element.end[axis] - element.start[axis]),
        _ => Err("a thread that lies not along one axis".to_owned()),
    }
}

/// The axes that get another position.
fn moved(start: &Position, end: &Position) -> Coordinates {
    let mut moved = Coordinates::default();
    for axis in Axis::ALL {
        if end[axis].is_finite() && start[axis] != end[axis] {
            moved.set(axis, word(end[axis]));
        }
    }
    moved
}

fn number(value: f64) -> Value {
    Value::Number((value * STEPS).round() / STEPS)
}

fn word(value: f64) -> Word {
    Word {
        value: number(value),
        incremental: false,
    }
}
