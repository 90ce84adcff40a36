//! All programs on all cores. A program that does not end stops neither the others nor the table.
//!
//! Decision: A run of a shelf that does not end when told so is left alone in its thread; the others go on

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::against;
use super::row::{Row, Verdict};
use crate::ReportError;
use crate::stop::Stop;
use crate::test_run::{Bench, Company, Survey, Tested};

/// Stack of a worker, that of the main thread of a program.
const STACK_BYTES: usize = 8 << 20;
/// How often the clock and Ctrl-C are looked at.
const PERIOD: Duration = Duration::from_millis(50);
/// A run that was told to end has this long for it; after that it is left alone and the others go on.
const GRACE: Duration = Duration::from_secs(2);

/// Draws a part as PNG; `None` where there is none.
pub type Draw = fn(&Tested, &Path) -> Option<Vec<u8>>;

/// What is done with each program.
pub struct Work {
    /// Paths of the programs.
    pub files: Vec<PathBuf>,
    /// What they run on.
    pub bench: Bench,
    /// What the runs are compared with.
    pub before: Option<Bench>,
    /// Density of the material, g/cm³, for weights.
    pub density: Option<f64>,
    /// What is drawn of every part.
    pub draw: Option<Draw>,
    /// How long one may run.
    pub time_limit: Duration,
}

/// A program that is done.
pub struct Done {
    /// What is said of it.
    pub row: Row,
    /// The picture of the part, PNG.
    pub picture: Option<Vec<u8>>,
}

enum News {
    Begun(usize, Stop),
    Done(usize, Box<Done>),
}

/// Runs all programs; those that Ctrl-C kept from running are in the table, too.
///
/// `is_interrupted` says whether somebody wants the work to end, `reported` hears of each program that is done.
///
/// # Errors
/// When the system gives no thread.
pub fn run(
    work: Work,
    is_interrupted: &dyn Fn() -> bool,
    reported: &mut dyn FnMut(),
) -> Result<Vec<Done>, ReportError> {
    let workers = thread::available_parallelism()
        .map_or(1, usize::from)
        .min(work.files.len());
    let (sender, news) = channel();
    let mut office = Office {
        next: Arc::default(),
        done: work.files.iter().map(|_| None).collect(),
        running: HashMap::new(),
        work: Arc::new(work),
        sender,
    };
    for _ in 0..workers {
        office.hire()?;
    }
    office.lead(&news, is_interrupted, reported)?;
    let files = &office.work.files;
    Ok(files
        .iter()
        .zip(office.done)
        .map(|(path, done)| done.unwrap_or_else(|| without_run(path, Verdict::NotRun, None)))
        .collect())
}

/// Who gives out the work and takes the results.
struct Office {
    work: Arc<Work>,
    next: Arc<AtomicUsize>,
    sender: Sender<News>,
    /// Since when a program runs.
    running: HashMap<usize, (Instant, Stop)>,
    done: Vec<Option<Done>>,
}

impl Office {
    fn hire(&self) -> Result<(), ReportError> {
        let (work, next, sender) = (self.work.clone(), self.next.clone(), self.sender.clone());
        thread::Builder::new()
            .stack_size(STACK_BYTES)
            .spawn(move || worker(&work, &next, &sender))
            .map(|_| ())
            .map_err(|error| ReportError::new(format!("cannot start a thread: {error}")))
    }

    /// Until everything is done, or given up after Ctrl-C.
    fn lead(
        &mut self,
        news: &Receiver<News>,
        is_interrupted: &dyn Fn() -> bool,
        reported: &mut dyn FnMut(),
    ) -> Result<(), ReportError> {
        let mut given_up = None;
        let mut open = self.done.len();
        while open > 0 {
            match news.recv_timeout(PERIOD) {
                Ok(News::Begun(index, stop)) => {
                    self.running.insert(index, (Instant::now(), stop));
                }
                Ok(News::Done(index, done)) => {
                    open -= self.take(index, *done, reported);
                }
                Err(RecvTimeoutError::Timeout) => {}
                // This office holds a sender itself.
                Err(RecvTimeoutError::Disconnected) => break,
            }
            if is_interrupted() && given_up.is_none() {
                self.next.store(self.done.len(), Ordering::Relaxed);
                self.running.values().for_each(|(_, stop)| stop.end());
                given_up = Some(Instant::now());
            }
            if given_up.is_some_and(|since| self.running.is_empty() || since.elapsed() > GRACE) {
                break;
            }
            open -= self.end_late_ones(reported)?;
        }
        Ok(())
    }

    /// Takes a result; the answer is how many programs are done by it.
    fn take(&mut self, index: usize, done: Done, reported: &mut dyn FnMut()) -> usize {
        self.running.remove(&index);
        match self.done.get_mut(index) {
            Some(slot @ None) => {
                *slot = Some(done);
                reported();
                1
            }
            // It came too late and stands in the table already.
            _ => 0,
        }
    }

    /// Ends runs whose time is over, and leaves alone those that do not end.
    fn end_late_ones(&mut self, reported: &mut dyn FnMut()) -> Result<usize, ReportError> {
        let limit = self.work.time_limit;
        let mut lost = Vec::new();
        for (index, (since, stop)) in &self.running {
            let spent = since.elapsed();
            if spent > limit && !stop.is_requested() {
                stop.end_late();
            } else if spent > limit + GRACE {
                lost.push(*index);
            }
        }
        let count = lost.len();
        for index in lost {
            let path = self.work.files.get(index).cloned().unwrap_or_default();
            self.take(index, without_run(&path, Verdict::TimeLimit, None), reported);
            self.hire()?;
        }
        Ok(count)
    }
}

fn worker(work: &Work, next: &AtomicUsize, sender: &Sender<News>) {
    loop {
        let index = next.fetch_add(1, Ordering::Relaxed);
        let Some(path) = work.files.get(index) else {
            return;
        };
        let stop = Stop::default();
        if sender.send(News::Begun(index, stop.clone())).is_err() {
            return;
        }
        // A fault of this program itself must not take the rest of the table with it.
        let done = catch_unwind(AssertUnwindSafe(|| program(work, path, &stop)))
            .unwrap_or_else(|_| without_run(path, Verdict::Unreadable, Some("internal error".into())));
        if sender.send(News::Done(index, Box::new(done))).is_err() {
            return;
        }
    }
}

fn program(work: &Work, path: &Path, stop: &Stop) -> Done {
    let now = match test(&work.bench, path, stop) {
        Ok(tested) => tested,
        Err(error) => return without_run(path, Verdict::Unreadable, Some(error.to_string())),
    };
    let mut row = Row::of(&work.bench, path, &now, work.density);
    if let Some(bench) = &work.before {
        match test(bench, path, stop) {
            Ok(before) => row.changes = against::changes(&Row::of(bench, path, &before, work.density), &row),
            Err(error) => row.changes = vec![error.to_string()],
        }
    }
    Done {
        picture: work.draw.and_then(|draw| draw(&now, path)),
        row,
    }
}

fn test(bench: &Bench, path: &Path, stop: &Stop) -> Result<Tested, ReportError> {
    bench.test(
        path,
        Company {
            survey: Some(Survey::default()),
            stop: stop.clone(),
            ..Company::default()
        },
    )
}

fn without_run(path: &Path, result: Verdict, why: Option<String>) -> Done {
    Done {
        row: Row::without_run(path, result, why),
        picture: None,
    }
}
