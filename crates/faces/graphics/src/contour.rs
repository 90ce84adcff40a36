//! Graphics while programming: what a program has so far, as lines in its working plane. Drawn is the
//! contour as it is programmed: where a block has RL or RR the contour that it names, else the path of the tool's
//! centre. The colours are those of the interactive graphics, subprograms have one of their own [000:6361-6366].

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bahn_host::LoadedMachine;
use bahn_interpreter::{Interpreter, Rules, Settings};
use bahn_path::{
    Barrier, Curve, ElementSource, FeedRate, Function, LiveData, PathElement, Plane, Point2, Step, Touch,
};
use bahn_program::{Edit, Program};
use bahn_tnc::{Control, Programs, Tool};

/// Elements of one contour cycle in simulation time (inferred).
const BUDGET: u32 = 500;
/// Elements after which a thread shows what it has.
const NEWS: u32 = 2000;
/// Lines that are drawn at most; a program with more is drawn as far as they reach.
const LINES_MAX: usize = 500_000;
/// Elements without a line in the plane that are passed over at most.
const ELEMENTS_MAX: u64 = 5_000_000;
/// Lines of a full turn.
const LINES_PER_TURN: f64 = 72.0;
/// Ends the program after the block up to which it is drawn; what stands there can still be called.
const END: &str = "M30";

/// What kind of line it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A line in rapid traverse.
    Rapid,
    /// A line of the contour, in feed.
    Feed,
    /// A subprogram, or another program.
    Called,
}

/// A straight line of the drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub from: [f32; 2],
    pub to: [f32; 2],
    pub kind: Kind,
    /// The block of the main program that programmed it; `None` for what is called.
    pub block: Option<u32>,
}

/// What is drawn so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines {
    pub plane: Option<Plane>,
    /// Least and greatest corner of the blank in the plane, mm.
    pub blank: Option<[Point2; 2]>,
    pub strokes: Vec<Stroke>,
}

/// How far a drawing has come: the machine looks at it without waiting for whoever makes a picture.
#[derive(Debug, Default)]
struct Progress {
    strokes: AtomicUsize,
    /// There is no more to come.
    ended: AtomicBool,
}

/// What is to be drawn.
pub struct Wish {
    /// Name of the program.
    pub name: String,
    /// What it says, with the block that is open.
    pub program: Arc<Program>,
    /// The last block; the whole program without.
    pub upto: Option<u32>,
}

/// What a program is drawn with: rules and tools of the machine; what it does not know is passed over.
pub(crate) fn settings(control: &Control, machine: &LoadedMachine) -> Settings {
    let shapes = |tools: &BTreeMap<u32, Tool>| {
        let shapes = tools.iter().map(|(number, tool)| (*number, tool.shape));
        shapes.collect()
    };
    Settings {
        model: control.model(),
        rules: Rules::of(control.first().edited_list()),
        tools: machine.tools.as_ref().map(shapes),
        skip_unknown: true,
        ..Settings::default()
    }
}

/// A drawing on its way.
pub(crate) struct Sketch {
    pub name: String,
    pub upto: Option<u32>,
    lines: Arc<Mutex<Lines>>,
    progress: Arc<Progress>,
    stop: Arc<AtomicBool>,
    /// `None` while a thread has it, and after the end.
    run: Option<Box<Run>>,
}

impl Sketch {
    /// Begins a drawing, on a thread of its own or step by step. Nothing is read here: a key does not wait.
    pub fn begin(wish: Wish, settings: Settings, programs: Arc<dyn Programs>, beside: bool) -> Sketch {
        let lines: Arc<Mutex<Lines>> = Arc::default();
        let progress: Arc<Progress> = Arc::default();
        let stop = Arc::new(AtomicBool::new(false));
        let settings = Settings {
            as_programmed: true,
            ..settings
        };
        let run = Run {
            start: Some((wish.program, settings, programs)),
            upto: wish.upto,
            interpreter: None,
            lines: Arc::clone(&lines),
            progress: Arc::clone(&progress),
            stop: Arc::clone(&stop),
            elements: 0,
        };
        let mut sketch = Sketch {
            name: wish.name,
            upto: wish.upto,
            lines,
            progress,
            stop,
            run: Some(Box::new(run)),
        };
        if beside && let Some(mut run) = sketch.run.take() {
            std::thread::spawn(move || while run.advance(NEWS) {});
        }
        sketch
    }

    /// Goes on, in simulation time.
    pub fn cycle(&mut self) {
        if self.run.as_mut().is_some_and(|run| !run.advance(BUDGET)) {
            self.run = None;
        }
    }

    /// What is drawn so far; a picture is made of it on any thread.
    pub fn lines(&self) -> Arc<Mutex<Lines>> {
        Arc::clone(&self.lines)
    }

    /// Lines so far, and whether that is all.
    pub fn progress(&self) -> (usize, bool) {
        let ended = self.progress.ended.load(Ordering::Acquire);
        (self.progress.strokes.load(Ordering::Relaxed), ended)
    }
}

impl Drop for Sketch {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// Nobody panics while holding it; if so, what is there can still be drawn.
pub(crate) fn lock(lines: &Mutex<Lines>) -> MutexGuard<'_, Lines> {
    lines.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A program on its way.
struct Run {
    start: Option<(Arc<Program>, Settings, Arc<dyn Programs>)>,
    upto: Option<u32>,
    interpreter: Option<Interpreter>,
    lines: Arc<Mutex<Lines>>,
    progress: Arc<Progress>,
    stop: Arc<AtomicBool>,
    elements: u64,
}

impl Run {
    /// Goes on by so many elements; whether there is more.
    fn advance(&mut self, elements: u32) -> bool {
        if let Some((program, settings, programs)) = self.start.take() {
            let mut interpreter = Interpreter::new(self.cut_off(program), settings, programs);
            interpreter.set_interrupt(Arc::clone(&self.stop));
            self.interpreter = Some(interpreter);
        }
        let mut drawn = Lines::default();
        let mut more = true;
        for _ in 0..elements {
            more = !self.stop.load(Ordering::Relaxed) && self.step(&mut drawn);
            if !more {
                break;
            }
        }
        let mut lines = lock(&self.lines);
        lines.plane = lines.plane.or(drawn.plane);
        lines.blank = lines.blank.or(drawn.blank);
        let room = LINES_MAX.saturating_sub(lines.strokes.len());
        lines.strokes.extend(drawn.strokes.into_iter().take(room));
        more &= lines.strokes.len() < LINES_MAX && self.elements < ELEMENTS_MAX;
        self.progress
            .strokes
            .store(lines.strokes.len(), Ordering::Relaxed);
        self.progress.ended.store(!more, Ordering::Release);
        more
    }

    /// The program up to the last block. A last block that cannot be followed by another is the end.
    fn cut_off(&self, program: Arc<Program>) -> Arc<Program> {
        let last = program.block_count().saturating_sub(1);
        let before = self.upto.filter(|upto| *upto < last).map(|upto| upto + 1);
        let end = before.and_then(|before| program.edit(&Edit::Insert { before, text: END }).ok());
        end.map_or(program, Arc::new)
    }

    /// One step of the program; whether there is more.
    fn step(&mut self, drawn: &mut Lines) -> bool {
        let Some(interpreter) = &mut self.interpreter else {
            return false;
        };
        match interpreter.next() {
            Step::Element(element) => {
                interpreter.forget_before(element.sequence);
                drop(interpreter.take_warnings());
                self.elements += 1;
                self.draw(&element, drawn);
            }
            Step::Barrier(barrier) => interpreter.resume(live_data(&barrier)),
            Step::Starved => match interpreter.take_work() {
                Some(work) => interpreter.finish_work(work.compute()),
                None => return false,
            },
            // What is wrong is said by the test run.
            Step::End | Step::Error(_) => return false,
        }
        true
    }

    fn draw(&self, element: &PathElement, drawn: &mut Lines) {
        let known = || lock(&self.lines).plane;
        for output in element.functions() {
            match &output.function {
                Function::Blank(blank) => {
                    drawn.plane.get_or_insert(blank.plane);
                    let at = |corner: &[f64; 3]| {
                        let axis = |axis| corner.get(axis as usize).copied().unwrap_or_default();
                        [axis(blank.plane.first), axis(blank.plane.second)]
                    };
                    drawn.blank = Some([at(&blank.min), at(&blank.max)]);
                }
                Function::Tool(call) if drawn.plane.is_none() => drawn.plane = Plane::of_tool_axis(call.axis),
                _ => {}
            }
        }
        if element.curve == Curve::Hold {
            return;
        }
        let plane = *drawn.plane.get_or_insert_with(|| known().unwrap_or(Plane::XY));
        let main = element.block.program == 0 && self.upto.is_none_or(|upto| element.block.block <= upto);
        let kind = match element.feed {
            FeedRate::Rapid => Kind::Rapid,
            _ if main => Kind::Feed,
            _ => Kind::Called,
        };
        let parts = match element.curve {
            Curve::Arc(arc) => (arc.sweep_deg.abs() / 360.0 * LINES_PER_TURN).ceil().max(1.0),
            Curve::Corner(_) => LINES_PER_TURN / 4.0,
            _ => 1.0,
        };
        let at = |part: u32| {
            let t = f64::from(part) / parts;
            let point = plane.point(&element.curve.position(&element.start, &element.end, t));
            point.map(|value| value as f32)
        };
        let mut from = at(0);
        for part in 1..=parts as u32 {
            let to = at(part);
            let known = from.iter().chain(&to).all(|value| value.is_finite());
            if known && from != to {
                drawn.strokes.push(Stroke {
                    from,
                    to,
                    kind,
                    block: main.then_some(element.block.block),
                });
            }
            from = to;
        }
    }
}

/// What is found at a barrier: a stylus touches where the block says it will; nothing is digitized.
fn live_data(barrier: &Barrier) -> LiveData {
    match barrier {
        Barrier::Probe { to, .. } => LiveData {
            touch: Some(Touch { position: *to }),
            ..LiveData::default()
        },
        Barrier::Scan { job, .. } => LiveData::not_scanned(job.begin()),
        _ => LiveData::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Nothing;

    impl Programs for Nothing {
        fn open(&self, name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
            let text = "BEGIN PGM 9 MM\nL X+70 Y+70 F100\nEND PGM 9 MM\n";
            let program = || Arc::new(Program::from_bytes("9.H", text.into()));
            Ok((name == "9").then(program))
        }
    }

    fn sketch(blocks: &str, upto: Option<u32>, beside: bool) -> Sketch {
        let text = format!("BEGIN PGM 7 MM\n{blocks}\nEND PGM 7 MM\n");
        let wish = Wish {
            name: "7.H".to_owned(),
            program: Arc::new(Program::from_bytes("7.H", text.into_bytes())),
            upto,
        };
        Sketch::begin(wish, Settings::default(), Arc::new(Nothing), beside)
    }

    fn drawn(blocks: &str, upto: Option<u32>) -> Vec<Stroke> {
        let mut sketch = sketch(blocks, upto, false);
        while !sketch.progress().1 {
            sketch.cycle();
        }
        let lines = sketch.lines();
        lock(&lines).strokes.clone()
    }

    fn stroke(from: [f32; 2], to: [f32; 2], kind: Kind, block: impl Into<Option<u32>>) -> Stroke {
        let block = block.into();
        Stroke {
            from,
            to,
            kind,
            block,
        }
    }

    const CONTOUR: &str = "TOOL CALL 0 Z S1000
L X+0 Y+0 Z+5 R0 FMAX
L X+10 FMAX
L X+20 Y+10 F100
CALL LBL 1
L X+0 Y+50
L Z-50
CALL PGM 9
STOP M2
LBL 1
L IX+5
LBL 0";

    /// Each line is where the program says, with its kind; a movement along the tool axis is none.
    #[test]
    fn a_program_is_drawn_up_to_a_block() {
        use Kind::{Called, Feed, Rapid};
        let all = [
            stroke([0.0, 0.0], [10.0, 0.0], Rapid, 3),
            stroke([10.0, 0.0], [20.0, 10.0], Feed, 4),
            stroke([20.0, 10.0], [25.0, 10.0], Called, None),
            stroke([25.0, 10.0], [0.0, 50.0], Feed, 6),
            stroke([0.0, 50.0], [70.0, 70.0], Called, None),
        ];
        for (upto, count) in [
            (1, 0),
            (2, 0),
            (3, 1),
            (4, 2),
            (5, 3),
            (6, 4),
            (7, 4),
            (8, 5),
            (9, 5),
        ] {
            assert_eq!(drawn(CONTOUR, Some(upto)), all[..count], "up to {upto}");
        }
        // The whole program has its subprogram in sight, which is a part of the program itself.
        let whole = drawn(CONTOUR, None);
        assert_eq!(whole.len(), 5);
        assert_eq!((whole[2].kind, whole[2].block), (Feed, Some(11)));
    }

    #[test]
    fn arcs_are_round_and_the_plane_is_that_of_the_tool() {
        let circle = "TOOL CALL 0 Y S1\nCC Z+0 X+0\nL Z+30 X+0 Y+0 R0 FMAX\nC Z+30 X+0 DR+ F100";
        let strokes = drawn(circle, None);
        assert_eq!(strokes.len(), 72);
        for (number, stroke) in strokes.iter().enumerate() {
            let [z, x] = stroke.to.map(f64::from);
            let angle = (5.0 * (number as f64 + 1.0)).to_radians();
            assert!(
                (z - 30.0 * angle.cos()).abs() < 1e-4 && (x - 30.0 * angle.sin()).abs() < 1e-4,
                "{stroke:?}"
            );
        }
    }

    /// A tool of 5 mm beside a contour, and once more without compensation: both times the contour is drawn, sharp at
    /// its corners and with arcs of their programmed radius, however large the tool. R+ ends where it says.
    #[test]
    fn the_contour_is_drawn_as_it_is_programmed() {
        let ends = |compensation: &str, radius: &str| {
            let blocks = format!(
                "TOOL DEF 1 L+0 R+{radius}\nTOOL CALL 1 Z S1000\nL X-10 Y+0 R0 FMAX\nL X+0 Y+0 {compensation} F100
L X+0 Y+40\nRND R10\nL X+60 Y+40\nCC X+60 Y+20\nC X+60 Y+0 DR-\nL X+0 Y+0\nL X-10 Y+0 R0 FMAX"
            );
            drawn(&blocks, None)
        };
        let plain = ends("R0", "5");
        // The way to the contour and its first line, a quarter, a line, a half, a line.
        let feeds = plain.iter().filter(|stroke| stroke.kind == Kind::Feed).count();
        assert_eq!(feeds, 2 + 72 / 4 + 1 + 72 / 2 + 1);
        for compensation in ["RL", "RR"] {
            for radius in ["5", "25"] {
                let compensated = ends(compensation, radius);
                assert_eq!(compensated.len(), plain.len(), "{compensation} {radius}");
                for (is, wanted) in compensated.iter().zip(&plain) {
                    assert_eq!((is.kind, is.block), (wanted.kind, wanted.block));
                    let off = [0, 1].map(|axis| (is.to[axis] - wanted.to[axis]).abs());
                    assert!(off.iter().all(|off| *off < 1e-4), "{is:?} is not {wanted:?}");
                }
            }
        }
        let paraxial = "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1\nL X+0 Y+0 R0 FMAX\nX+40 R+ F100\nX+10 R-";
        let strokes = drawn(paraxial, None);
        let to: Vec<_> = strokes.iter().map(|stroke| stroke.to).collect();
        assert_eq!(to, [[40.0, 0.0], [10.0, 0.0]]);
    }

    #[test]
    fn what_is_wrong_ends_the_drawing() {
        let strokes = drawn("L X+0 Y+0 R0 FMAX\nL X+5 F100\nL FOO\nL X+9", None);
        assert_eq!(strokes, [stroke([0.0, 0.0], [5.0, 0.0], Kind::Feed, 2)]);
    }

    /// A million lines have a bound; a drawing that is dropped leaves its thread.
    #[test]
    fn a_long_program_is_bounded_and_can_be_dropped() {
        let endless = "L X+0 Y+0 R0 FMAX\nLBL 1\nL IX+1 F100\nL IX-1\nCALL LBL 1 REP 65000/65000\nCALL LBL 1 REP 65000/65000
CALL LBL 1 REP 65000/65000\nCALL LBL 1 REP 65000/65000\nCALL LBL 1 REP 65000/65000";
        assert_eq!(drawn(endless, None).len(), LINES_MAX);
        let sketch = sketch(endless, None, true);
        let lines = Arc::downgrade(&sketch.lines());
        drop(sketch);
        let begun = std::time::Instant::now();
        while lines.strong_count() > 0 {
            assert!(begun.elapsed().as_secs() < 10, "the thread goes on");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
    }
}
