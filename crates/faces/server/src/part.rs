//! The part that is being cut, coded once for all viewers that look at it from every side.
//!
//! Decision: The part that is seen from every side is sent 15 times a second at most, and looking at it takes a fifth
//! of a core at most; a viewer is sent what it lacks when it has taken what was sent before (also
//! `viewer/src/stream.rs`)

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use bahn_service::{BeingCut, Operated};
use bahn_viewer::{PartStream, Sent};
use tokio::sync::watch;
use tokio::task::JoinHandle;

use crate::regions::region;

/// Between two looks at the part: 15 a second.
const EVERY: Duration = Duration::from_millis(66);
/// Looking takes this part of a core at most, however large the part is.
const SHARE: u32 = 4;
/// While nobody looks, whether the server has ended is found out so often.
const IDLE: Duration = Duration::from_secs(1);

/// Processor time of this thread. By the wall a look that waits for a processor among others would count, too, and be paid for by
/// a rest four times as long, in which nobody sees the part go on.
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::try_from(time).unwrap_or_default()
}

/// The part, for all viewers.
#[derive(Clone)]
pub(crate) struct PartFeed {
    shared: Arc<Shared>,
    news: watch::Receiver<u64>,
}

struct Shared {
    /// Apart from the part, so that nobody who comes or goes waits while one is coded.
    viewers: Mutex<usize>,
    /// Somebody wants to look.
    wanted: Condvar,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    seen: Option<Seen>,
    /// Number of parts that were cut so far.
    parts: u64,
}

/// The part that was seen last.
struct Seen {
    cut: BeingCut,
    version: u64,
    stream: Option<PartStream>,
}

/// Somebody looks, until this is dropped.
pub(crate) struct Looking {
    shared: Arc<Shared>,
    news: watch::Receiver<u64>,
    sent: Sent,
}

/// Encoded as MessagePack: an array of a name and a value, or of a name and nothing.
type Region = Vec<u8>;

impl PartFeed {
    /// Follows the part of a station while somebody looks, on a thread of its own.
    pub fn start(machine: Arc<dyn Operated>) -> PartFeed {
        let shared = Arc::new(Shared {
            viewers: Mutex::default(),
            wanted: Condvar::new(),
            state: Mutex::default(),
        });
        let (sender, news) = watch::channel(0);
        let own = Arc::clone(&shared);
        std::thread::spawn(move || own.follow(machine.as_ref(), &sender));
        PartFeed { shared, news }
    }

    /// Counts a viewer who looks at the part, as long as the result lives.
    fn look(&self) -> Looking {
        *lock(&self.shared.viewers) += 1;
        self.shared.wanted.notify_all();
        let mut news = self.news.clone();
        // What is there already is news for him.
        news.mark_changed();
        Looking {
            shared: Arc::clone(&self.shared),
            news,
            sent: Sent::default(),
        }
    }
}

impl Shared {
    fn follow(&self, machine: &dyn Operated, sender: &watch::Sender<u64>) {
        while !sender.is_closed() {
            let viewers = lock(&self.viewers);
            let waited = self
                .wanted
                .wait_timeout_while(viewers, IDLE, |viewers| *viewers == 0);
            let (viewers, _) = waited.unwrap_or_else(PoisonError::into_inner);
            if *viewers == 0 {
                continue;
            }
            drop(viewers);
            let begun = processor_time();
            let Ok(cut) = machine.being_cut() else {
                // The station has ended, or is busy.
                std::thread::sleep(EVERY);
                continue;
            };
            if lock(&self.state).take(cut) {
                sender.send_modify(|count| *count += 1);
            }
            std::thread::sleep(EVERY.max(processor_time().saturating_sub(begun) * SHARE));
        }
    }
}

impl State {
    /// Looks at the part; whether there may be news. In operating modes without a part the last one stays to be seen.
    fn take(&mut self, cut: Option<BeingCut>) -> bool {
        let Some(cut) = cut else { return false };
        let version = cut.version();
        let before = self.seen.take();
        let mut seen = match before {
            Some(mut seen) if seen.cut.is(&cut) => {
                let moved = seen.cut.tool_at() != cut.tool_at();
                if seen.version == version {
                    seen.cut = cut;
                    self.seen = Some(seen);
                    return moved;
                }
                (seen.cut, seen.version) = (cut, version);
                seen
            }
            _ => Seen {
                cut,
                version,
                stream: None,
            },
        };
        let part = seen.cut.part();
        match (&mut seen.stream, &part) {
            (Some(stream), Some(part)) if stream.fits(part) => {
                seen.cut.with_trail(|trail| stream.take(part, trail));
            }
            (stream, Some(part)) => {
                self.parts += 1;
                let program = seen.cut.program();
                *stream = Some(
                    seen.cut
                        .with_trail(|trail| PartStream::new(self.parts, program, part, trail)),
                );
            }
            (stream, None) => *stream = None,
        }
        self.seen = Some(seen);
        true
    }

    fn news(&self, sent: &mut Sent) -> Option<Region> {
        let seen = self.seen.as_ref();
        let Some((seen, stream)) = seen.and_then(|seen| Some((seen, seen.stream.as_ref()?))) else {
            // There is no part; that is said once.
            let first = *sent != Sent::default();
            *sent = Sent::default();
            return first.then(|| region("part", &None::<()>));
        };
        let at = seen.cut.tool_at();
        let news = seen.cut.with_trail(|trail| stream.news(trail, at, sent))?;
        Some(region("part", &news))
    }
}

/// Whether a viewer looks.
#[derive(Default)]
pub(crate) enum Look {
    #[default]
    Away,
    /// He has everything, and waits for news.
    Waits(Looking),
    /// What he lacks is being coded. A large part takes a while, for which nothing else waits, neither of the server nor of his:
    /// he sees screens meanwhile.
    Coded(JoinHandle<(Looking, Option<Region>)>),
}

impl Look {
    /// A viewer begins to look.
    pub fn on(feed: &PartFeed) -> Look {
        Look::Waits(feed.look())
    }

    /// Whether the viewer looks at the part.
    pub fn is_on(&self) -> bool {
        !matches!(self, Look::Away)
    }

    /// Waits for what he lacks, when that is anything; for ever, when he does not look. Whoever gives up waiting loses nothing.
    pub async fn news(&mut self) -> Option<Region> {
        if let Look::Waits(looking) = self {
            if looking.news.changed().await.is_err() {
                *self = Look::Away;
            } else if let Look::Waits(looking) = std::mem::take(self) {
                *self = Look::Coded(tokio::task::spawn_blocking(|| looking.coded()));
            }
        }
        let Look::Coded(coded) = self else {
            return std::future::pending().await;
        };
        match coded.await {
            Ok((looking, news)) => {
                *self = Look::Waits(looking);
                news
            }
            Err(_) => {
                *self = Look::Away;
                None
            }
        }
    }
}

impl Looking {
    /// What he lacks, and how to ask the next time.
    fn coded(mut self) -> (Looking, Option<Region>) {
        let mut sent = self.sent;
        let news = lock(&self.shared.state).news(&mut sent);
        self.sent = sent;
        (self, news)
    }
}

impl Drop for Looking {
    fn drop(&mut self) {
        let mut viewers = lock(&self.shared.viewers);
        *viewers = viewers.saturating_sub(1);
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// While the part is being coded a viewer waits for other things, too, and still gets it when it is there.
    #[test]
    fn screens_come_while_the_part_is_coded() {
        let shared = Arc::new(Shared {
            viewers: Mutex::default(),
            wanted: Condvar::new(),
            state: Mutex::default(),
        });
        let (_sender, news) = watch::channel(0);
        let feed = PartFeed {
            shared: Arc::clone(&shared),
            news,
        };
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_time()
            .build()
            .unwrap();
        let mut look = Look::on(&feed);
        assert!(look.is_on() && !Look::Away.is_on());
        let moment = Duration::from_millis(20);
        let held = lock(&shared.state);
        for _ in 0..3 {
            let waited = runtime.block_on(async { tokio::time::timeout(moment, look.news()).await });
            assert!(waited.is_err() && matches!(look, Look::Coded(_)));
        }
        drop(held);
        // There is no part, and he was sent none.
        assert_eq!(runtime.block_on(look.news()), None);
        assert!(matches!(look, Look::Waits(_)) && *lock(&shared.viewers) == 1);
        drop(look);
        assert_eq!(*lock(&shared.viewers), 0);
    }
}
