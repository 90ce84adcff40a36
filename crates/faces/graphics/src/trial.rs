//! TEST RUN with graphics: a program is executed as the control's own test does it, planned and cut.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use bahn_interpreter::Interpreter;
use bahn_motion::{AuxiliaryTimes, PlannedStep, Planner};
use bahn_path::{Axis, Barrier, BlockRef, LiveData, PathElement};
use bahn_reader::Reader;
use bahn_tnc::Control;

use crate::stock::{Heard, Stock};

/// Elements that are cut in one contour cycle in simulation time (inferred).
const BUDGET: u32 = 500;
/// Elements after which a thread says how far it has come.
const NEWS: u32 = 200;

/// A thread whose test is interrupted looks so often whether it goes on.
const LOOK: Duration = Duration::from_millis(20);

/// What the operator wants of a test.
#[derive(Debug, Default)]
struct Wishes {
    /// He has interrupted it.
    interrupted: bool,
    /// Stops of the program after which he let it go on.
    passed: u32,
    /// The block of the main program at which it is to be interrupted.
    interrupt_at: Option<u32>,
    /// Q parameters that he has changed.
    q: Vec<(u16, f64)>,
}

/// How far a test has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Progress {
    /// Elements that were cut.
    pub elements: u64,
    /// Part of the blocks of the main program that lie after it, 0 to 1.
    pub part: f64,
    pub machining_time_s: f64,
    /// Something could not be shown.
    not_shown: bool,
    /// Stops of the program that were reached, and blocks at which it was to be interrupted.
    stops: u32,
    /// It is through, wrong or broken off.
    pub ended: bool,
}

/// A program that is tested.
pub struct Trial {
    program: String,
    stock: Arc<Stock>,
    progress: Arc<Mutex<Progress>>,
    stop: Arc<AtomicBool>,
    wishes: Arc<Mutex<Wishes>>,
    /// `None` while a thread has it.
    run: Option<Box<Run>>,
    said: bool,
}

impl Trial {
    /// Begins with what the control has just begun to test; `None` when it tests nothing.
    pub fn begin(control: &Control, beside: bool) -> Option<Trial> {
        let (mut reader, report) = (control.tested()?, control.test_report()?);
        let stop = Arc::new(AtomicBool::new(false));
        reader.set_interrupt(Arc::clone(&stop));
        let blocks = reader.program(0).map_or(0, |program| program.block_count());
        let stock = Arc::new(Stock::default());
        let wishes = Arc::default();
        let run = Box::new(Run {
            planner: Planner::new(reader, &control.path_limits(), &AuxiliaryTimes::default()),
            stock: Arc::clone(&stock),
            blocks,
            progress: Progress::default(),
            wishes: Arc::clone(&wishes),
        });
        let mut trial = Trial {
            program: report.program,
            stock,
            progress: Arc::default(),
            stop,
            wishes,
            run: Some(run),
            said: false,
        };
        if beside {
            trial.start_thread();
        }
        Some(trial)
    }

    /// Without another thread the machine's own one does it.
    fn start_thread(&mut self) {
        let Some(mut run) = self.run.take() else { return };
        let (reported, stop) = (Arc::clone(&self.progress), Arc::clone(&self.stop));
        std::thread::spawn(move || {
            while !run.progress.ended && !stop.load(Ordering::Relaxed) {
                match run.waits() {
                    true => std::thread::sleep(LOOK),
                    false => run.advance(NEWS),
                }
                tell(&reported, run.progress);
            }
            run.progress.ended = true;
            tell(&reported, run.progress);
        });
    }

    /// Goes on, in simulation time.
    pub fn cycle(&mut self) {
        if let Some(run) = &mut self.run
            && !run.waits()
        {
            run.advance(BUDGET);
            tell(&self.progress, run.progress);
            if run.progress.ended {
                self.run = None;
            }
        }
    }

    /// Interrupts it, at once or at a block of its main program.
    pub fn interrupt(&mut self, at: Option<u32>) {
        let mut wishes = lock(&self.wishes);
        match at {
            None => wishes.interrupted = true,
            at => wishes.interrupt_at = at,
        }
    }

    /// Lets it go on.
    pub fn go_on(&mut self) {
        let mut wishes = lock(&self.wishes);
        match std::mem::take(&mut wishes.interrupted) {
            true => {}
            false => wishes.passed += 1,
        }
    }

    /// Changes a Q parameter, for the blocks that are read from now on.
    pub fn set_q(&mut self, number: u16, value: f64) {
        lock(&self.wishes).q.push((number, value));
    }

    /// It waits for the operator.
    pub fn is_interrupted(&self) -> bool {
        let progress = self.progress();
        !progress.ended && lock(&self.wishes).holds(progress)
    }

    /// Ends it where it is.
    pub fn stop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if self.run.take().is_some() {
            let ended = Progress {
                ended: true,
                ..self.progress()
            };
            tell(&self.progress, ended);
        }
    }

    pub(crate) fn progress(&self) -> Progress {
        *self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Something cannot be shown; told once.
    pub fn cannot_be_shown(&mut self) -> bool {
        let news = self.progress().not_shown && !self.said;
        self.said |= news;
        news
    }

    pub(crate) fn stock(&self) -> Arc<Stock> {
        Arc::clone(&self.stock)
    }

    pub(crate) fn program(&self) -> &str {
        &self.program
    }
}

impl Drop for Trial {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

fn tell(reported: &Mutex<Progress>, progress: Progress) {
    *reported.lock().unwrap_or_else(PoisonError::into_inner) = progress;
}

impl Wishes {
    fn holds(&self, progress: Progress) -> bool {
        self.interrupted || progress.stops > self.passed
    }
}

fn lock(wishes: &Mutex<Wishes>) -> MutexGuard<'_, Wishes> {
    wishes.lock().unwrap_or_else(PoisonError::into_inner)
}

/// It moves a rotary axis, or lies in a tilted plane.
fn turns(element: &PathElement) -> bool {
    let rotary = [Axis::A, Axis::B, Axis::C];
    element.placement.is_some() || rotary.into_iter().any(|axis| element.moves_axis(axis))
}

/// A program on its way.
struct Run {
    planner: Planner<Box<dyn Reader>>,
    stock: Arc<Stock>,
    /// Blocks of the main program.
    blocks: u32,
    progress: Progress,
    wishes: Arc<Mutex<Wishes>>,
}

impl Run {
    /// It is interrupted; otherwise what the operator has changed counts.
    fn waits(&mut self) -> bool {
        let mut wishes = lock(&self.wishes);
        if wishes.holds(self.progress) {
            return true;
        }
        for (number, value) in wishes.q.drain(..) {
            if let Some(interpreter) = Interpreter::of_mut(&mut **self.planner.source_mut()) {
                interpreter.set_q(number, value);
            }
        }
        false
    }

    /// A block was reached at which the operator wanted it to be interrupted.
    fn reached(&mut self, block: BlockRef) {
        let there = |at: &mut u32| block.program == 0 && block.block >= *at;
        let reached = lock(&self.wishes).interrupt_at.take_if(there);
        self.progress.stops += u32::from(reached.is_some());
    }

    /// Goes on by so many steps at most.
    fn advance(&mut self, steps: u32) {
        for _ in 0..steps {
            match self.planner.next() {
                PlannedStep::Element(planned) => {
                    self.progress.machining_time_s += planned.duration_s();
                    self.element(&planned.element);
                    self.reached(planned.element.block);
                }
                // STOP and M0 interrupt a test, too [003:2234].
                PlannedStep::Barrier(Barrier::Stop { .. }) => {
                    self.planner.resume(LiveData::default());
                    self.progress.stops += 1;
                }
                PlannedStep::Barrier(barrier) => {
                    let live = self.live_data(&barrier);
                    self.planner.resume(live);
                }
                PlannedStep::Starved => {
                    // A long computation is done here and now; without one it was interrupted.
                    let interpreter = Interpreter::of_mut(&mut **self.planner.source_mut());
                    let work = interpreter.and_then(|run| Some((run.take_work()?, run)));
                    match work {
                        Some((work, run)) => run.finish_work(work.compute()),
                        None => self.progress.ended = true,
                    }
                }
                PlannedStep::End => {
                    self.progress.part = 1.0;
                    self.progress.ended = true;
                }
                PlannedStep::Error(_) => self.progress.ended = true,
            }
            if !self.progress.ended && lock(&self.wishes).holds(self.progress) {
                return;
            }
            if self.progress.ended {
                let mut heard = Heard::default();
                self.stock.tell(&mut heard);
                self.progress.not_shown |= heard.0;
                return;
            }
        }
    }

    fn element(&mut self, element: &PathElement) {
        let mut heard = Heard::default();
        let end_s = self.progress.machining_time_s;
        self.stock.cut(element, end_s, &mut heard);
        // What cannot be shown is said with its first block [003:876], other remarks when the tool changes.
        if !self.progress.not_shown && turns(element) {
            self.stock.tell(&mut heard);
        }
        self.progress.not_shown |= heard.0;
        self.progress.elements += 1;
        if element.block.program == 0 && self.blocks > 0 {
            self.progress.part = f64::from(element.block.block) / f64::from(self.blocks);
        }
        let run = self.planner.source_mut();
        run.forget_before(element.sequence);
        drop(run.take_warnings());
    }

    /// What is found at a barrier: a stylus feels the part as it is; nothing is digitized.
    fn live_data(&self, barrier: &Barrier) -> LiveData {
        match barrier {
            Barrier::Probe {
                from,
                to,
                stylus_radius,
                ..
            } => self.stock.touch(from, to, *stylus_radius),
            Barrier::Scan { job, .. } => LiveData::not_scanned(job.begin()),
            _ => LiveData::default(),
        }
    }
}
