//! Pictures that programs ask for: one is drawn at a time, and after it the processor rests as long as it took.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::{Semaphore, oneshot};

/// Longest side of a picture, pixels (inferred).
pub(crate) const SIDE: u32 = 3840;
/// Pixels of a picture at most: 3840 x 2160 (inferred).
pub(crate) const PIXELS: u64 = 3840 * 2160;
/// Those who wait for pictures at most.
pub(crate) const WAITING: usize = 32;
/// Between two pictures at least: 25 a second.
const EVERY: Duration = Duration::from_millis(40);

/// Where pictures are waited for.
#[derive(Debug)]
pub(crate) struct Pictures {
    waiting: Semaphore,
    drawing: Arc<Semaphore>,
}

impl Default for Pictures {
    fn default() -> Pictures {
        Pictures {
            waiting: Semaphore::new(WAITING),
            drawing: Arc::new(Semaphore::new(1)),
        }
    }
}

impl Pictures {
    /// Draws when it is its turn; `None` when too many wait. Whoever gave up waiting is passed over.
    pub async fn draw<T: Send + 'static>(&self, what: impl FnOnce() -> T + Send + 'static) -> Option<T> {
        let _waits = self.waiting.try_acquire().ok()?;
        let draws = Arc::clone(&self.drawing).acquire_owned().await.ok()?;
        let (sender, receiver) = oneshot::channel();
        tokio::task::spawn_blocking(move || {
            let begun = Instant::now();
            let _ = sender.send(what());
            std::thread::sleep(begun.elapsed().max(EVERY));
            drop(draws);
        });
        receiver.await.ok()
    }
}
