//! Examining documents on a thread of its own, one after the other; a newer version breaks off an older one.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, Sender, unbounded};
use lsp_types::Uri;

use crate::document::Version;
use crate::language::Examined;
use crate::world::World;

/// How long nothing is typed before a text is examined.
const QUIET: Duration = Duration::from_millis(15);
/// What a run may take before it is broken off; what it has found by then counts.
const RUN_MAX: Duration = Duration::from_secs(3);

/// What is to be examined.
struct Job {
    uri: Uri,
    version: Arc<Version>,
    world: World,
    interrupt: Arc<AtomicBool>,
}

/// The result of an examination in the background.
pub(crate) struct Done {
    pub(crate) uri: Uri,
    pub(crate) version: Arc<Version>,
    pub(crate) examined: Examined,
}

/// Texts that wait, and the one that is examined.
pub(crate) struct Background {
    jobs: Option<Sender<Job>>,
    pub(crate) done: Receiver<Done>,
    thread: Option<JoinHandle<()>>,
    waiting: Vec<(Uri, Instant)>,
    running: Option<(Uri, Arc<AtomicBool>, Instant)>,
}

impl Background {
    pub(crate) fn start() -> Background {
        let (jobs, taken) = unbounded::<Job>();
        let (found, done) = unbounded();
        let thread = std::thread::spawn(move || {
            for job in taken {
                let analysis = job.version.analysis(&job.world);
                let examined = analysis.map(|analysis| analysis.examine(&job.world, &job.interrupt));
                let done = Done {
                    uri: job.uri,
                    version: job.version,
                    examined: examined.unwrap_or_default(),
                };
                if found.send(done).is_err() {
                    return;
                }
            }
        });
        Background {
            jobs: Some(jobs),
            done,
            thread: Some(thread),
            waiting: Vec::new(),
            running: None,
        }
    }

    /// A document has changed: it is examined as soon as nothing more is typed.
    pub(crate) fn wants(&mut self, uri: &Uri) {
        self.forget(uri);
        self.waiting.push((uri.clone(), Instant::now() + QUIET));
    }

    /// A document is closed or changes: what is found in it is of no use.
    pub(crate) fn forget(&mut self, uri: &Uri) {
        self.waiting.retain(|(waiting, _)| waiting != uri);
        if let Some((running, interrupt, _)) = &self.running
            && running == uri
        {
            interrupt.store(true, Ordering::Relaxed);
        }
    }

    /// The document whose turn it is.
    pub(crate) fn next(&mut self) -> Option<Uri> {
        let now = Instant::now();
        if let Some((_, interrupt, until)) = &self.running {
            if now >= *until {
                interrupt.store(true, Ordering::Relaxed);
            }
            return None;
        }
        let place = self.waiting.iter().position(|(_, due)| *due <= now)?;
        Some(self.waiting.remove(place).0)
    }

    pub(crate) fn examine(&mut self, uri: Uri, version: Arc<Version>, world: World) {
        let interrupt = Arc::new(AtomicBool::new(false));
        self.running = Some((uri.clone(), interrupt.clone(), Instant::now() + RUN_MAX));
        if let Some(jobs) = &self.jobs {
            // Without its thread nothing is examined any more.
            let _ = jobs.send(Job {
                uri,
                version,
                world,
                interrupt,
            });
        }
    }

    /// The thread has ended what it did.
    pub(crate) fn has_done(&mut self) {
        self.running = None;
    }

    /// How long nothing needs to be looked at.
    pub(crate) fn patience(&self) -> Duration {
        const LONG: Duration = Duration::from_secs(3600);
        let until = match &self.running {
            // Whoever was stopped will say so.
            Some((_, interrupt, _)) if interrupt.load(Ordering::Relaxed) => return LONG,
            Some((_, _, until)) => Some(*until),
            None => self.waiting.iter().map(|(_, due)| *due).min(),
        };
        until.map_or(LONG, |until| until.saturating_duration_since(Instant::now()))
    }
}

impl Drop for Background {
    fn drop(&mut self) {
        if let Some((_, interrupt, _)) = &self.running {
            interrupt.store(true, Ordering::Relaxed);
        }
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
