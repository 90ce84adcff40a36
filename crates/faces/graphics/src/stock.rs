//! The part that is being cut: one thread cuts, others make pictures of it meanwhile.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use bahn_path::{BlockRef, LiveData, PathElement, Position, Touch};
use bahn_viewer::Trail;
use bahn_workpiece::{Columns, Cutting, Hears, Memory, Part, Remark};

/// Whoever cuts looks so often whether those who look are through.
const COURTESY: Duration = Duration::from_millis(1);

/// Which tool cut what is remembered, for colours.
const TOOLS: Memory = Memory {
    tools: true,
    path: false,
};

/// The part that is being cut.
pub(crate) struct Stock {
    cutting: Mutex<Cutting>,
    /// The way of the tool.
    trail: Mutex<Trail>,
    /// Counts what was done to it.
    version: AtomicU64,
    /// How many want to look: they go first.
    looking: AtomicU32,
}

/// Whether something could not be shown: PGM SECTION CANNOT BE SHOWN [003:7967-7971].
#[derive(Default)]
pub(crate) struct Heard(pub bool);

impl Hears for Heard {
    fn hear(&mut self, _block: BlockRef, remark: Remark, _count: u64) {
        self.0 |= matches!(remark, Remark::Cut(kind) if kind.is_not_shown());
    }
}

impl Default for Stock {
    fn default() -> Stock {
        Stock {
            cutting: Mutex::new(Cutting::new(Columns::BySize, TOOLS, BTreeSet::new())),
            trail: Mutex::default(),
            version: AtomicU64::new(0),
            looking: AtomicU32::new(0),
        }
    }
}

impl Stock {
    /// Cuts an element that ends at a time, s. A blank without volume stays away, as one that was not programmed.
    pub fn cut(&self, element: &PathElement, end_s: f64, heard: &mut Heard) {
        while self.looking.load(Ordering::Relaxed) > 0 {
            std::thread::sleep(COURTESY);
        }
        // There are as many columns as a picture needs, so a blank can only be none.
        let _ = self.lock().element(element, heard);
        self.trail().element(element, end_s);
        self.version.fetch_add(1, Ordering::Relaxed);
    }

    /// What is to be said of the last tool.
    pub fn tell(&self, heard: &mut Heard) {
        self.lock().tell(heard);
    }

    /// What a stylus finds on its way.
    pub fn touch(&self, from: &Position, to: &Position, radius: f64) -> LiveData {
        let touch: Option<Touch> = self.lock().touch(from, to, radius);
        LiveData {
            touch,
            ..LiveData::default()
        }
    }

    /// The blank is whole again.
    pub fn restore(&self) {
        let _ = self.lock().restore();
        self.trail().begin_anew();
        self.version.fetch_add(1, Ordering::Relaxed);
    }

    /// The way of the tool so far.
    pub fn trail(&self) -> MutexGuard<'_, Trail> {
        self.trail.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts what was done to the part.
    pub fn version(&self) -> u64 {
        self.version.load(Ordering::Relaxed)
    }

    /// The part as it is now; `None` without a blank.
    pub fn part(&self) -> Option<Part> {
        self.looking.fetch_add(1, Ordering::Relaxed);
        let part = self.lock().part().cloned();
        self.looking.fetch_sub(1, Ordering::Relaxed);
        part
    }

    fn lock(&self) -> MutexGuard<'_, Cutting> {
        self.cutting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
