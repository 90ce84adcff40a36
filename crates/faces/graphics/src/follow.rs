//! The part of the program run: what the machine has executed is cut.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use bahn_host::{ExecutedPath, Host, Operable};
use bahn_path::{BlockRef, PathElement};
use bahn_tnc::{Mode, RunState};

use crate::stock::{Heard, Stock};

/// Elements that wait for the thread that cuts; the machine waits for it beyond that.
const WAITING: usize = 4096;

/// Follows what is executed.
#[derive(Default)]
pub(crate) struct Follower {
    /// The part of the run that was started last; `None` before the first one.
    stock: Option<Arc<Stock>>,
    path: ExecutedPath,
    /// Who cuts, when it is a thread.
    cutter: Option<SyncSender<PathElement>>,
    program: String,
    elements: u64,
    last: RunState,
    /// The next run goes on, or begins at a block, as of the last cycle.
    goes_on: bool,
}

impl Follower {
    /// Takes what a cycle has executed.
    pub fn cycle<P: Operable>(&mut self, host: &mut Host<P>, beside: bool) {
        let control = host.control();
        let now = control.run_state();
        let by_program = matches!(control.mode(), Mode::FullSequence | Mode::SingleBlock);
        if now != RunState::Idle && self.last == RunState::Idle && by_program {
            let program = control.selected_program().unwrap_or_default().to_owned();
            self.begin(program, beside);
        }
        self.last = now;
        let next = control.first().next_start();
        self.goes_on = next.map_or(self.goes_on, |next| next != BlockRef::default());
        self.path.follow(host);
        if self.stock.is_none() {
            self.path.clear();
        }
        while let Some(element) = self.path.next() {
            self.cut(element);
        }
    }

    /// A run from the beginning has the whole blank, one from another block or that was broken off goes on with the part as
    /// it is (inferred).
    fn begin(&mut self, program: String, beside: bool) {
        self.path.clear();
        self.program = program;
        if self.goes_on && self.stock.is_some() {
            return;
        }
        let stock = Arc::new(Stock::default());
        self.cutter = beside.then(|| cutter(Arc::clone(&stock)));
        self.stock = Some(stock);
    }

    fn cut(&mut self, element: PathElement) {
        self.elements += 1;
        match (&self.cutter, &self.stock) {
            // It ends only after the sender.
            (Some(cutter), _) => drop(cutter.send(element)),
            (None, Some(stock)) => stock.cut(&element, 0.0, &mut Heard::default()),
            (None, None) => {}
        }
    }

    /// The blank is whole again.
    pub fn restore(&self) {
        if let Some(stock) = &self.stock {
            stock.restore();
        }
    }

    pub fn stock(&self) -> Option<Arc<Stock>> {
        self.stock.clone()
    }

    pub fn program(&self) -> &str {
        &self.program
    }

    /// Elements that were cut since the machine was switched on.
    pub fn elements(&self) -> u64 {
        self.elements
    }
}

/// A thread that cuts what it is sent, until nobody sends any more.
fn cutter(stock: Arc<Stock>) -> SyncSender<PathElement> {
    let (sender, receiver): (_, Receiver<PathElement>) = sync_channel(WAITING);
    std::thread::spawn(move || {
        for element in receiver {
            stock.cut(&element, 0.0, &mut Heard::default());
        }
    });
    sender
}
