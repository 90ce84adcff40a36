//! Runs programs for the tests and answers questions about what came out.
#![allow(dead_code, reason = "every test file uses its own part of the support")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a helper that panics fails its test"
)]

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_interpreter::{Interpreter, Message, ProgramError, Programs, Settings, Warning};
use bahn_parameters::MessageId;
use bahn_path::{
    Axis, Barrier, Blank, Curve, ElementSource, FeedRate, Function, LiveData, PathElement, Position, Step,
    ToolCall, Touch,
};
use bahn_program::Program;
use bahn_workpiece::{Event, Resolution, Workpiece};

/// Example 1 of the manual: a double swivel head, right-angled [000:4303-4340].
pub const SWIVEL_HEAD: &[&str] = &[
    "7500=1",
    "7510=%000100",
    "7512=200.4",
    "7520=%000010",
    "7522=-1.9",
    "7530=%001000",
    "7540=%000001",
    "7542=201.5",
    "7550=%000100",
    "7552=3.1",
    "7560=%010000",
];

/// A rotary table C with its centre at (400,150,-300) of the machine, under a table B that swivels about (400,150,-500).
pub const ROTARY_TABLE: &[&str] = &[
    "7500=1",
    "7510=%000001",
    "7511=%11",
    "7512=400",
    "7520=%000010",
    "7521=%11",
    "7522=150",
    "7530=%000100",
    "7531=%11",
    "7532=-300",
    "7540=%100000",
    "7541=%01",
    "7550=%000100",
    "7551=%01",
    "7552=-200",
    "7560=%010000",
    "7561=%01",
];

/// The text of a program of the manual, from the folder `tests/programs`.
pub fn manual(name: &str) -> String {
    let path = format!("{}/tests/programs/{name}.H", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A program from its blocks: begin, end and block numbers are added, so that the first line is block 1.
pub fn program(blocks: &str) -> String {
    let lines = blocks.lines().map(str::trim).filter(|line| !line.is_empty());
    let mut text = "0 BEGIN PGM TEST MM\n".to_owned();
    let mut number = 0;
    for line in lines {
        number += 1;
        text.push_str(&format!("{number} {line}\n"));
    }
    text.push_str(&format!("{} END PGM TEST MM\n", number + 1));
    text
}

/// A program and what it runs with.
pub struct Job {
    name: &'static str,
    text: Vec<u8>,
    pub settings: Settings,
    library: BTreeMap<String, String>,
    eprom: BTreeMap<String, String>,
    surfaces: Vec<f64>,
    /// Q parameters from the start.
    q: Vec<(u16, f64)>,
}

impl Job {
    /// A program whose numbers count to their last decimal: those finer than any input step, which would be rounded,
    /// come by Q parameters, which are not.
    pub fn exact(text: &str) -> Job {
        let mut free = (1..100).chain(120..300);
        let mut q: Vec<(u16, f64)> = Vec::new();
        let mut exact = String::new();
        let mut rest = text;
        while let Some(at) = rest.find(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-')) {
            let (before, number) = rest.split_at(at);
            let end = number
                .find(|c: char| !(c.is_ascii_digit() || matches!(c, '+' | '-' | '.')))
                .unwrap_or(number.len());
            let (number, after) = number.split_at(end);
            exact.push_str(before);
            let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            if decimals > 4 && !before.ends_with("SCL ") {
                let value: f64 = number.parse().unwrap();
                let known = q.iter().find(|(_, known)| *known == value).map(|(name, _)| *name);
                let name = known.unwrap_or_else(|| {
                    let name = free.next().expect("a free Q parameter");
                    q.push((name, value));
                    name
                });
                exact.push_str(&format!("+Q{name}"));
            } else {
                exact.push_str(number);
            }
            rest = after;
        }
        exact.push_str(rest);
        Job { q, ..Job::new(exact) }
    }

    pub fn new(text: impl Into<Vec<u8>>) -> Job {
        Job {
            name: "TEST",
            text: text.into(),
            settings: Settings::default(),
            library: BTreeMap::new(),
            eprom: BTreeMap::new(),
            surfaces: Vec::new(),
            q: Vec::new(),
        }
    }

    /// A program in DIN/ISO.
    pub fn iso(text: impl Into<Vec<u8>>) -> Job {
        Job {
            name: "TEST.I",
            ..Job::new(text)
        }
    }

    /// Changes the settings.
    pub fn with(mut self, change: impl FnOnce(&mut Settings)) -> Job {
        change(&mut self.settings);
        self
    }

    /// A program that can be called.
    pub fn library(mut self, name: &str, text: impl Into<String>) -> Job {
        self.library.insert(name.to_owned(), text.into());
        self
    }

    /// A cycle of the machine builder in the EPROM.
    pub fn eprom(mut self, name: &str, text: impl Into<String>) -> Job {
        self.eprom.insert(name.to_owned(), text.into());
        self
    }

    /// The probe touches at this coordinate of the probing axis, one after the other; afterwards nothing.
    pub fn surfaces(mut self, surfaces: &[f64]) -> Job {
        self.surfaces = surfaces.to_vec();
        self
    }

    pub fn run(self) -> Run {
        let main = Arc::new(Program::from_bytes(self.name, self.text));
        let shelf = |programs: BTreeMap<String, String>, folder: &str| {
            let programs = programs.into_iter().map(|(name, text)| {
                let program = Program::from_bytes(format!("{folder}{name}"), text.into_bytes());
                (name, Arc::new(program))
            });
            programs.collect()
        };
        let library = Shelf {
            memory: shelf(self.library, ""),
            eprom: shelf(self.eprom, "eprom/"),
        };
        let mut interpreter = Interpreter::new(main, self.settings, Arc::new(library));
        for (number, value) in self.q {
            interpreter.set_q(number, value);
        }
        let mut run = Run::new();
        let mut surfaces = self.surfaces.into_iter();
        loop {
            match interpreter.next() {
                Step::Element(element) => run.elements.push(element),
                Step::Barrier(barrier) => {
                    run.barriers.push(barrier);
                    run.scans.extend(interpreter.scan().map(|(_, job)| *job));
                    interpreter.resume(LiveData {
                        touch: touch(&barrier, &mut surfaces),
                        ..LiveData::default()
                    });
                    run.touched_q.push(interpreter.q_values().to_vec());
                }
                Step::Error(error) => {
                    run.error = Some(*error);
                    break;
                }
                Step::End | Step::Starved => break,
            }
        }
        run.q = interpreter.q_values().to_vec();
        run.blocks_executed = interpreter.blocks_executed();
        run.position = interpreter.position();
        run.warnings = interpreter.take_warnings();
        run
    }
}

/// Runs a program of the manual that must come to its end.
pub fn run_manual(name: &str) -> Run {
    let run = Job::new(manual(name)).run();
    run.assert_completed();
    run
}

/// Runs blocks that must come to their end.
pub fn run(blocks: &str) -> Run {
    let run = Job::new(program(blocks)).run();
    run.assert_completed();
    run
}

/// The same with settings.
pub fn run_with(blocks: &str, settings: Settings) -> Run {
    let run = Job::new(program(blocks)).with(|own| *own = settings).run();
    run.assert_completed();
    run
}

struct Shelf {
    memory: BTreeMap<String, Arc<Program>>,
    eprom: BTreeMap<String, Arc<Program>>,
}

impl Programs for Shelf {
    fn open(&self, name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        Ok(self.memory.get(name).cloned())
    }

    fn open_in_eprom(&self, name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        Ok(self.eprom.get(name).cloned())
    }
}

fn touch(barrier: &Barrier, surfaces: &mut impl Iterator<Item = f64>) -> Option<Touch> {
    let Barrier::Probe { from, to, .. } = barrier else {
        return None;
    };
    let axis = Axis::ALL
        .into_iter()
        .find(|axis| from[*axis] != to[*axis] && !from[*axis].is_nan())?;
    let surface = surfaces.next()?;
    let mut position = *from;
    position[axis] = surface;
    let reachable = (surface - from[axis]) * (surface - to[axis]) <= 0.0;
    reachable.then_some(Touch { position })
}

/// What a run brought out.
pub struct Run {
    pub elements: Vec<PathElement>,
    pub barriers: Vec<Barrier>,
    /// What was to be digitized.
    pub scans: Vec<bahn_path::ScanJob>,
    /// The Q parameters after each barrier.
    pub touched_q: Vec<Vec<f64>>,
    pub error: Option<ProgramError>,
    pub q: Vec<f64>,
    pub blocks_executed: u64,
    pub position: Position,
    pub warnings: Vec<Warning>,
}

impl Run {
    fn new() -> Run {
        Run {
            elements: Vec::new(),
            barriers: Vec::new(),
            scans: Vec::new(),
            touched_q: Vec::new(),
            error: None,
            q: Vec::new(),
            blocks_executed: 0,
            position: Position::UNKNOWN,
            warnings: Vec::new(),
        }
    }

    pub fn assert_completed(&self) {
        assert_eq!(self.error, None);
    }

    /// Message and block of the error.
    pub fn message(&self) -> Option<(MessageId, u32)> {
        let error = self.error.as_ref()?;
        match error.message {
            Message::Control(id) => Some((id, error.block.block)),
            Message::Numbered(_) => None,
        }
    }

    /// The elements that move something.
    pub fn moves(&self) -> impl Iterator<Item = &PathElement> {
        self.elements.iter().filter(|e| e.curve != Curve::Hold)
    }

    /// The movements of a block.
    pub fn of_block(&self, block: u32) -> Vec<&PathElement> {
        self.moves()
            .filter(|e| e.block.program == 0 && e.block.block == block)
            .collect()
    }

    /// The movements of a range of blocks.
    pub fn of_blocks(&self, blocks: std::ops::RangeInclusive<u32>) -> Vec<&PathElement> {
        self.moves()
            .filter(|e| e.block.program == 0 && blocks.contains(&e.block.block))
            .collect()
    }

    /// The order in which blocks moved, each run of elements of one block once.
    pub fn order(&self) -> Vec<u32> {
        let mut order: Vec<u32> = self.moves().map(|e| e.block.block).collect();
        order.dedup();
        order
    }

    /// Functions with the block of their element.
    pub fn functions(&self) -> Vec<(u32, &Function)> {
        let all = self.elements.iter();
        all.flat_map(|e| e.functions().iter().map(move |f| (e.block.block, &f.function)))
            .collect()
    }

    pub fn tool_calls(&self) -> Vec<ToolCall> {
        let calls = self.functions().into_iter();
        calls
            .filter_map(|(_, f)| {
                if let Function::Tool(call) = f {
                    Some(*call)
                } else {
                    None
                }
            })
            .collect()
    }

    pub fn blank(&self) -> Blank {
        let found = self.functions().into_iter().find_map(|(_, f)| match f {
            Function::Blank(blank) => Some(*blank),
            _ => None,
        });
        found.expect("the program has a blank")
    }

    /// The workpiece after the run at this resolution.
    pub fn workpiece(&self, resolution_mm: f64) -> Workpiece {
        let mut workpiece = Workpiece::new(&self.blank(), Resolution::Millimetres(resolution_mm)).unwrap();
        self.cut(&mut workpiece, &self.elements);
        workpiece
    }

    /// Removes what the elements sweep with the tools that they call.
    pub fn cut(&self, workpiece: &mut Workpiece, elements: &[PathElement]) {
        let mut tool: Option<ToolCall> = None;
        for element in elements {
            for function in element.functions() {
                if let Function::Tool(call) = &function.function {
                    tool = Some(*call);
                }
            }
            if let Some(tool) = tool {
                workpiece.cut(element, &tool.shape, tool.axis);
            }
        }
    }

    /// Removed volume at this resolution, mm³.
    pub fn removed_mm3(&self, resolution_mm: f64) -> f64 {
        self.workpiece(resolution_mm).finished().removed_mm3()
    }

    pub fn events(&self, resolution_mm: f64) -> Vec<Event> {
        self.workpiece(resolution_mm).take_events()
    }
}

/// X and Y of the end points.
pub fn ends(elements: &[&PathElement]) -> Vec<[f64; 2]> {
    elements
        .iter()
        .map(|e| [e.end[Axis::X], e.end[Axis::Y]])
        .collect()
}

/// X, Y and Z of a position.
pub fn xyz(p: &Position) -> [f64; 3] {
    [p[Axis::X], p[Axis::Y], p[Axis::Z]]
}

/// Path length of elements, mm.
pub fn length(elements: &[&PathElement]) -> f64 {
    elements.iter().map(|e| e.length()).sum()
}

/// Whether an element runs in rapid traverse.
pub fn is_rapid(element: &PathElement) -> bool {
    element.feed == FeedRate::Rapid
}

/// Radius of an arc at its start, mm; 0 for other curves.
pub fn arc_radius(element: &PathElement) -> f64 {
    match element.curve {
        Curve::Arc(arc) => arc.radii(&element.start, &element.end).0,
        _ => 0.0,
    }
}

/// Centre and sweep of an arc.
pub fn arc_of(element: &PathElement) -> ([f64; 2], f64) {
    match element.curve {
        Curve::Arc(arc) => (arc.centre, arc.sweep_deg),
        other => panic!("{other:?} is no arc"),
    }
}

/// The number agrees with the expected one within a tolerance.
#[track_caller]
pub fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!(
        (actual - expected).abs() <= tolerance,
        "{actual} is not {expected} ± {tolerance}"
    );
}

/// Points agree with the expected ones within a tolerance.
#[track_caller]
pub fn close_points<const N: usize>(actual: &[[f64; N]], expected: &[[f64; N]], tolerance: f64) {
    let agree = actual.len() == expected.len()
        && actual
            .iter()
            .flatten()
            .zip(expected.iter().flatten())
            .all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(agree, "\n  actual {actual:.4?}\nexpected {expected:.4?}");
}

/// What a path consists of, for comparing runs: curve, start, end and feed without block numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    pub curve: Curve,
    pub start: Position,
    pub end: Position,
    pub feed: FeedRate,
}

/// The movements of a run as shapes.
pub fn shapes(run: &Run) -> Vec<Shape> {
    run.moves()
        .map(|e| Shape {
            curve: e.curve,
            start: e.start,
            end: e.end,
            feed: e.feed,
        })
        .collect()
}
