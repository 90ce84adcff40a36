//! Two runs side by side: every element of the path, every function, every stop, the message at the end, and what the
//! user is warned of on the way.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_interpreter::{Interpreter, WarningKind};
use bahn_parameters::ControlModel;
use bahn_path::{
    Axis, Barrier, BlockRef, Curve, ElementSource, FeedRate, LiveData, PathElement, Position, Step, Touch,
};
use serde::Serialize;

/// Paths are the same within this, mm.
pub const TOLERANCE_MM: f64 = 1e-3;
/// Feeds are the same within this part of them.
pub const FEED_TOLERANCE: f64 = 1e-3;

/// What two runs have in common, and where they part.
#[derive(Clone, Debug, Serialize)]
pub struct Proof {
    /// Elements of the path that are the same.
    pub elements: u64,
    /// Functions that are the same.
    pub functions: u64,
    /// Programmed stops that both have.
    pub stops: u64,
    /// Warnings that both have.
    pub warnings: u64,
    /// The farthest that two elements are apart, µm.
    pub max_deviation_um: f64,
    /// The message that both runs end with, if they do.
    pub message: Option<String>,
    /// Whether both were followed to their ends.
    pub completed: bool,
    /// Where they part first.
    pub first_difference: Option<Difference>,
}

impl Proof {
    /// Whether both runs are the same from begin to end.
    pub fn holds(&self) -> bool {
        self.completed && self.first_difference.is_none()
    }
}

/// Where two runs part.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// What is not the same.
    pub what: String,
    /// The block of the source.
    pub source: At,
    /// The block of the target.
    pub target: At,
}

/// A block of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct At {
    /// The name of the program without folders.
    pub program: String,
    /// What reports call the block.
    pub block: u32,
    /// Its line in the file.
    pub line: u32,
    /// The text of the block; empty where there is none.
    pub text: String,
}

impl At {
    /// The place of a block in a run.
    pub fn of(run: &Interpreter, at: BlockRef) -> At {
        let Some(program) = run.program(at.program) else {
            return At::default();
        };
        let name = program.name().rsplit(std::path::MAIN_SEPARATOR).next();
        At {
            program: name.unwrap_or_default().to_owned(),
            block: program.number_of(at.block),
            line: program.line_of(at.block),
            text: program.text_of(at.block),
        }
    }
}

/// What a run says next.
#[derive(Clone, Debug)]
pub(crate) enum Event {
    Element(Box<PathElement>),
    Stop(BlockRef),
    /// A probe was asked, and has answered.
    Asked(BlockRef),
    Message(BlockRef, String),
    End,
    Interrupted,
}

/// The next event of a run. What it asks of the outside gets the same answer every time: a probe touches half way,
/// nothing is scanned.
pub(crate) fn next_event(run: &mut Interpreter, model: ControlModel) -> Event {
    loop {
        match run.next() {
            Step::Element(element) => return Event::Element(Box::new(element)),
            Step::End => return Event::End,
            Step::Starved => return Event::Interrupted,
            Step::Error(error) => return Event::Message(error.block, error.message.text(model).to_owned()),
            Step::Barrier(barrier) => {
                run.resume(answer(&barrier));
                match barrier {
                    Barrier::Stop { block } => return Event::Stop(block),
                    Barrier::Probe { block, .. } | Barrier::Scan { block, .. } => return Event::Asked(block),
                    Barrier::MeasureTool(measuring) => return Event::Asked(measuring.block),
                    Barrier::Acknowledge { .. } => {}
                }
            }
        }
    }
}

fn answer(barrier: &Barrier) -> LiveData {
    match barrier {
        Barrier::Probe { from, to, .. } => {
            let mut position = Position::UNKNOWN;
            for axis in Axis::ALL {
                position[axis] = 0.5 * (from[axis] + to[axis]);
            }
            LiveData {
                touch: Some(Touch { position }),
                ..LiveData::default()
            }
        }
        Barrier::Scan { job, .. } => LiveData::not_scanned(job.begin()),
        _ => LiveData::default(),
    }
}

/// Runs source and target until they part or end. `stop` ends the search early.
pub fn prove(
    mut source: Interpreter,
    mut target: Interpreter,
    model: ControlModel,
    stop: &Arc<AtomicBool>,
) -> Proof {
    source.set_interrupt(stop.clone());
    target.set_interrupt(stop.clone());
    let mut proof = Proof::new();
    let (mut last_source, mut last_target) = (BlockRef::default(), BlockRef::default());
    let mut warned = Warned::default();
    loop {
        if stop.load(std::sync::atomic::Ordering::Relaxed) {
            return proof;
        }
        let events = (next_event(&mut source, model), next_event(&mut target, model));
        warned.take(&mut source, &mut target);
        last_source = block_of(&events.0).unwrap_or(last_source);
        last_target = block_of(&events.1).unwrap_or(last_target);
        let what = match &events {
            (Event::Interrupted, _) | (_, Event::Interrupted) => return proof,
            (Event::End, Event::End) => {
                proof.ends(None, warned, &source, &target);
                return proof;
            }
            (Event::Message(_, one), Event::Message(_, other)) if one == other => {
                proof.ends(Some(one.clone()), warned, &source, &target);
                return proof;
            }
            (Event::Stop(_), Event::Stop(_)) => {
                proof.stops += 1;
                None
            }
            (Event::Asked(_), Event::Asked(_)) => None,
            (Event::Element(one), Event::Element(other)) => proof.element(one, other),
            (one, other) => Some(format!(
                "{} in the source, {} in the target",
                name(one),
                name(other)
            )),
        };
        if let Some(what) = what {
            proof.first_difference = Some(Difference {
                what,
                source: At::of(&source, last_source),
                target: At::of(&target, last_target),
            });
            return proof;
        }
    }
}

/// What two runs warned of: they need not do so at the same element, since either may look ahead.
#[derive(Default)]
pub(crate) struct Warned {
    /// How often each side said a thing, and where it did first.
    said: HashMap<WarningKind, [(u64, BlockRef); 2]>,
}

/// Most different warnings that are compared: many texts name a number of the program.
const WARNINGS_MAX: usize = 10_000;

impl Warned {
    pub fn take(&mut self, source: &mut Interpreter, target: &mut Interpreter) {
        for (side, run) in [source, target].into_iter().enumerate() {
            for warning in run.take_warnings() {
                if self.said.len() >= WARNINGS_MAX && !self.said.contains_key(&warning.kind) {
                    continue;
                }
                let said = self.said.entry(warning.kind).or_default();
                if let Some((count, first)) = said.get_mut(side) {
                    if *count == 0 {
                        *first = warning.block;
                    }
                    *count += warning.count;
                }
            }
        }
    }

    /// How many both sides have.
    pub fn both(&self) -> u64 {
        let least = |[(one, _), (other, _)]: &[(u64, BlockRef); 2]| *one.min(other);
        self.said.values().map(least).sum()
    }

    /// The first warning, by its place, whose counts in source and target differ by this rule.
    pub fn difference(
        self,
        differ: fn(u64, u64) -> bool,
        source: &Interpreter,
        target: &Interpreter,
    ) -> Option<Difference> {
        let unlike = self
            .said
            .into_iter()
            .filter(|(_, [one, other])| differ(one.0, other.0));
        let first = unlike.min_by_key(|(kind, [one, other])| {
            let at = if one.0 > 0 { one.1 } else { other.1 };
            (at.program, at.block, kind.to_string())
        });
        let (kind, [one, other]) = first?;
        let at = |run, (count, block): (u64, BlockRef)| match count {
            0 => At::default(),
            _ => At::of(run, block),
        };
        Some(Difference {
            what: format!(
                "the warning '{kind}' {} times in the source, {} times in the target",
                one.0, other.0
            ),
            source: at(source, one),
            target: at(target, other),
        })
    }
}

fn block_of(event: &Event) -> Option<BlockRef> {
    match event {
        Event::Element(element) => Some(element.block),
        Event::Stop(block) | Event::Asked(block) | Event::Message(block, _) => Some(*block),
        Event::End | Event::Interrupted => None,
    }
}

fn name(event: &Event) -> String {
    match event {
        Event::Element(_) => "an element of the path".to_owned(),
        Event::Stop(_) => "a stop".to_owned(),
        Event::Asked(_) => "probing".to_owned(),
        Event::Message(_, text) => format!("the message {text}"),
        Event::End => "the end".to_owned(),
        Event::Interrupted => "nothing more".to_owned(),
    }
}

impl Proof {
    pub(crate) fn new() -> Proof {
        Proof {
            elements: 0,
            functions: 0,
            stops: 0,
            warnings: 0,
            max_deviation_um: 0.0,
            message: None,
            completed: false,
            first_difference: None,
        }
    }

    /// Both runs are at their ends: what is left to compare is what they warned of.
    fn ends(&mut self, message: Option<String>, warned: Warned, source: &Interpreter, target: &Interpreter) {
        self.completed = true;
        self.message = message;
        self.warnings = warned.both();
        self.first_difference = warned.difference(|one, other| one != other, source, target);
    }

    /// Counts two elements that are the same, or says what differs.
    fn element(&mut self, one: &PathElement, other: &PathElement) -> Option<String> {
        let deviation = match deviation_mm(one, other) {
            Ok(deviation) => deviation,
            Err(what) => return Some(what),
        };
        self.deviates(deviation);
        if deviation > TOLERANCE_MM {
            return Some(format!("the path is {:.3} µm apart", deviation * 1e3));
        }
        if let Some(what) = feeds_differ(one.feed, other.feed) {
            return Some(what);
        }
        if (one.dwell_s - other.dwell_s).abs() > 1e-6 {
            return Some(format!("dwell {} s and {} s", one.dwell_s, other.dwell_s));
        }
        let same = one.override_law == other.override_law
            && one.constant_speed == other.constant_speed
            && one.tangential_end == other.tangential_end
            && one.placement == other.placement;
        if !same {
            return Some("what overrides, corners or swivel axes do differs".to_owned());
        }
        if one.functions() != other.functions() {
            return Some(functions_differ(one, other));
        }
        self.elements += 1;
        self.functions += one.functions().len() as u64;
        None
    }

    pub(crate) fn deviates(&mut self, mm: f64) {
        self.max_deviation_um = self.max_deviation_um.max(mm * 1e3);
    }
}

/// How far two elements are apart, mm; what differs where they are of different kinds.
pub(crate) fn deviation_mm(one: &PathElement, other: &PathElement) -> Result<f64, String> {
    let ends = between(&one.start, &other.start)?.max(between(&one.end, &other.end)?);
    let curves = curves_apart(&one.curve, &other.curve, one, other)?;
    Ok(ends.max(curves))
}

fn curves_apart(
    one: &Curve,
    other: &Curve,
    of_one: &PathElement,
    of_other: &PathElement,
) -> Result<f64, String> {
    let lengths = || (of_one.length() - of_other.length()).abs();
    match (one, other) {
        (Curve::Hold, Curve::Hold) | (Curve::Line, Curve::Line) => Ok(0.0),
        (Curve::Arc(a), Curve::Arc(b))
            if a.plane.first == b.plane.first && a.plane.second == b.plane.second =>
        {
            if a.sweep_deg.signum() != b.sweep_deg.signum() {
                return Err("the arcs turn differently".to_owned());
            }
            let centres = (a.centre[0] - b.centre[0]).hypot(a.centre[1] - b.centre[1]);
            Ok(centres.max(lengths()))
        }
        (Curve::Corner(a), Curve::Corner(b)) => {
            let corners = a.corner.iter().zip(&b.corner).map(|(a, b)| (a - b).abs());
            Ok(corners.fold(lengths(), f64::max))
        }
        _ => Err(format!(
            "{} in the source, {} in the target",
            kind(one),
            kind(other)
        )),
    }
}

fn kind(curve: &Curve) -> &'static str {
    match curve {
        Curve::Hold => "a block without movement",
        Curve::Line => "a line",
        Curve::Arc(_) => "an arc",
        Curve::Corner(_) => "an arc in a corner",
    }
}

/// The greatest distance of an axis; an axis without a position in one of both is a difference.
pub(crate) fn between(one: &Position, other: &Position) -> Result<f64, String> {
    let mut most: f64 = 0.0;
    for axis in Axis::ALL {
        match (one.get(axis), other.get(axis)) {
            (None, None) => {}
            (Some(a), Some(b)) => most = most.max((a - b).abs()),
            _ => return Err(format!("{axis} has a position in one of both only")),
        }
    }
    Ok(most)
}

pub(crate) fn feeds_differ(one: FeedRate, other: FeedRate) -> Option<String> {
    match (one, other) {
        (FeedRate::Rapid, FeedRate::Rapid) => None,
        (FeedRate::Programmed(a), FeedRate::Programmed(b)) if (a - b).abs() <= FEED_TOLERANCE * a.abs() => {
            None
        }
        (FeedRate::Programmed(a), FeedRate::Programmed(b)) => Some(format!("feed {a} and {b} mm/min")),
        _ => Some("rapid traverse in one of both only".to_owned()),
    }
}

fn functions_differ(one: &PathElement, other: &PathElement) -> String {
    let said = |element: &PathElement| {
        let names = element.functions().iter().map(|of| format!("{:?}", of.function));
        match names.collect::<Vec<_>>().join(", ") {
            none if none.is_empty() => "no function".to_owned(),
            some => some,
        }
    };
    format!("{} in the source, {} in the target", said(one), said(other))
}
