//! All seeds on all cores: each thread has a control of its own.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread;

use bahn_host::HostError;
use bahn_report::torture::Tried;
use bahn_trials::torture::{Campaign, Worker};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::UsageError;
use crate::interrupt::Interrupt;

/// Stack of a worker, that of the main thread of a program.
const STACK_BYTES: usize = 8 << 20;

/// The seeds of a campaign and how it goes.
struct Course<'a> {
    campaign: &'a Campaign,
    next: AtomicU64,
    end: u64,
    stop: AtomicBool,
    interrupt: &'a Interrupt,
}

/// Tries all seeds; `take` gets what came of each, and says whether it goes on.
pub(super) fn run(
    campaign: &Campaign,
    seeds: std::ops::Range<u64>,
    jobs: usize,
    interrupt: &Interrupt,
    mut take: impl FnMut(Tried) -> bool,
) -> Result<(), UsageError> {
    let course = Course {
        campaign,
        next: AtomicU64::new(seeds.start),
        end: seeds.end,
        stop: AtomicBool::new(false),
        interrupt,
    };
    let bar = bar(seeds.end - seeds.start, campaign.name());
    let (sender, news) = channel();
    let failed = thread::scope(|scope| {
        let jobs = jobs.min(usize::try_from(seeds.end - seeds.start).unwrap_or(jobs));
        for _ in 0..jobs {
            let (course, sender) = (&course, sender.clone());
            let worker = thread::Builder::new().stack_size(STACK_BYTES);
            worker.spawn_scoped(scope, move || work(course, &sender))?;
        }
        drop(sender);
        let mut failed = None;
        for tried in news {
            match tried {
                Ok(tried) => {
                    bar.inc(1);
                    if !take(*tried) {
                        course.stop.store(true, Ordering::Relaxed);
                    }
                }
                Err(error) => {
                    course.stop.store(true, Ordering::Relaxed);
                    failed = Some(error);
                }
            }
        }
        Ok(failed)
    });
    bar.finish_and_clear();
    let failed: Option<HostError> =
        failed.map_err(|error: std::io::Error| UsageError::new(format!("cannot start a thread: {error}")))?;
    failed.map_or(Ok(()), |error| Err(UsageError::from(error)))
}

type News = Result<Box<Tried>, HostError>;

/// Tries one seed after another.
fn work(course: &Course, sender: &Sender<News>) {
    let mut worker = None;
    while !course.stop.load(Ordering::Relaxed) && !course.interrupt.is_requested() {
        let seed = course.next.fetch_add(1, Ordering::Relaxed);
        if seed >= course.end {
            return;
        }
        let tried = catch_unwind(AssertUnwindSafe(|| {
            let worker = match &mut worker {
                Some(worker) => worker,
                none => none.insert(course.campaign.worker()?),
            };
            Ok(one(worker, seed))
        }));
        let tried = tried.unwrap_or_else(|_| {
            // What is left of its control is of no use any more.
            let plan = worker.take().map(|worker: Worker| worker.plan(seed));
            Ok(Tried::panicked(seed, plan))
        });
        let failed = tried.is_err();
        if sender.send(tried.map(Box::new)).is_err() || failed {
            return;
        }
    }
}

fn one(worker: &mut Worker, seed: u64) -> Tried {
    let plan = worker.plan(seed);
    let trial = worker.run(&plan);
    let rule = trial.violation.as_ref().map(|violation| violation.rule);
    let shrunk = rule.map(|rule| {
        let plan = worker.shrink(&plan, rule);
        let trial = worker.run(&plan);
        (plan, trial)
    });
    Tried { plan, trial, shrunk }
}

fn bar(seeds: u64, machine: &str) -> ProgressBar {
    // Standard error; hidden when that is no terminal.
    let bar = ProgressBar::with_draw_target(Some(seeds), ProgressDrawTarget::stderr_with_hz(10));
    if let Ok(style) = ProgressStyle::with_template(
        "{spinner} [{bar:20}] {msg}: seed {human_pos} of {human_len}, {elapsed}, {eta} left",
    ) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.set_message(machine.to_owned());
    bar
}
