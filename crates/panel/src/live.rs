//! A station on a thread of its own, by the clock on the wall.

use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, TrySendError, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::input::{Input, Refusal};
use crate::replay::Replay;
use crate::screen::Screen;
use crate::station::Station;

/// Inputs that wait at most; more are refused.
const INPUTS: usize = 256;
/// Between two screens that nobody has asked for: 25 a second.
const SCREEN: Duration = Duration::from_millis(40);
/// While time stands, inputs are looked for so often.
const PAUSE: Duration = Duration::from_millis(5);

/// A screen that was published.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// The screen.
    pub screen: Arc<Screen>,
}

enum Order {
    Input(Input, SyncSender<Result<(), Refusal>>),
    /// Something that is done with the station between two cycles.
    With(Box<dyn FnOnce(&mut Station) + Send>),
    /// Somebody looks at the station: nothing changes, and no screen is made for it.
    Look(Box<dyn FnOnce(&Station) + Send>),
    End,
}

struct Shared {
    seen: Mutex<Seen>,
    changed: Condvar,
}

/// A station that runs.
pub struct Live {
    orders: SyncSender<Order>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Station>>,
}

/// Where inputs are given and screens are seen, from any thread.
#[derive(Clone)]
pub struct Link {
    orders: SyncSender<Order>,
    shared: Arc<Shared>,
}

impl Live {
    /// Lets a station run.
    pub fn start(station: Station) -> Live {
        Live::run(station, None)
    }

    /// Shows a session on a station, and lets it run on behind its end. Who watches may let time stand; pauses of the
    /// session are passed over.
    pub fn replay(station: Station, replay: Replay) -> Live {
        Live::run(station, Some(replay))
    }

    fn run(mut station: Station, mut replay: Option<Replay>) -> Live {
        let (orders, taken) = sync_channel(INPUTS);
        let shared = Arc::new(Shared {
            seen: Mutex::default(),
            changed: Condvar::new(),
        });
        let published = Arc::clone(&shared);
        let thread = std::thread::spawn(move || {
            station.run_by_the_wall();
            run(&mut station, &mut replay, &taken, &published);
            station
        });
        Live {
            orders,
            shared,
            thread: Some(thread),
        }
    }

    /// Where inputs are given.
    pub fn link(&self) -> Link {
        Link {
            orders: self.orders.clone(),
            shared: Arc::clone(&self.shared),
        }
    }

    /// It goes on no more, whatever ended it.
    pub fn has_ended(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Ends it; what must survive is on the medium.
    ///
    /// # Errors
    /// In words.
    pub fn end(mut self) -> Result<(), String> {
        let _ = self.orders.send(Order::End);
        let Some(thread) = self.thread.take() else {
            return Ok(());
        };
        let mut station = thread.join().map_err(|_| "the station has failed".to_owned())?;
        station.store().map_err(|error| error.to_string())
    }
}

impl Link {
    /// Gives an input and waits until it was taken.
    ///
    /// # Errors
    /// Why it was refused; also when too many wait.
    pub fn input(&self, input: Input) -> Result<(), Refusal> {
        let (answer, answered) = sync_channel(1);
        match self.orders.try_send(Order::Input(input, answer)) {
            Ok(()) => {}
            Err(TrySendError::Full(_)) => return Err(Refusal("too many inputs wait".to_owned())),
            Err(TrySendError::Disconnected(_)) => return Err(ended()),
        }
        answered.recv().unwrap_or_else(|_| Err(ended()))
    }

    /// Does something with the station between two cycles.
    ///
    /// # Errors
    /// When the station has ended, or too many wait.
    pub fn with<T: Send + 'static>(
        &self,
        what: impl FnOnce(&mut Station) -> T + Send + 'static,
    ) -> Result<T, Refusal> {
        let (answer, answered) = sync_channel(1);
        let order = Order::With(Box::new(move |station| drop(answer.send(what(station)))));
        self.orders
            .try_send(order)
            .map_err(|_| Refusal("too many inputs wait".to_owned()))?;
        answered.recv().map_err(|_| ended())
    }

    /// Looks at the station between two cycles.
    ///
    /// # Errors
    /// When the station has ended, or too many wait.
    pub fn look<T: Send + 'static>(
        &self,
        what: impl FnOnce(&Station) -> T + Send + 'static,
    ) -> Result<T, Refusal> {
        let (answer, answered) = sync_channel(1);
        let order = Order::Look(Box::new(move |station| drop(answer.send(what(station)))));
        self.orders
            .try_send(order)
            .map_err(|_| Refusal("too many inputs wait".to_owned()))?;
        answered.recv().map_err(|_| ended())
    }

    /// The screen as it was published last.
    pub fn screen(&self) -> Arc<Screen> {
        Arc::clone(&self.shared.lock().screen)
    }

    /// Waits for a screen behind this serial, at most so long.
    pub fn next_screen(&self, serial: u64, at_most: Duration) -> Arc<Screen> {
        let seen = self.shared.lock();
        let waited = self
            .shared
            .changed
            .wait_timeout_while(seen, at_most, |seen| seen.screen.serial <= serial);
        let (seen, _) = waited.unwrap_or_else(PoisonError::into_inner);
        Arc::clone(&seen.screen)
    }
}

fn ended() -> Refusal {
    Refusal("the station has ended".to_owned())
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Seen> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn publish(&self, screen: &Screen) {
        let mut seen = self.lock();
        if seen.screen.serial != screen.serial {
            seen.screen = Arc::new(screen.clone());
            self.changed.notify_all();
        }
    }
}

fn run(station: &mut Station, replay: &mut Option<Replay>, orders: &Receiver<Order>, shared: &Shared) {
    let mut due = Instant::now();
    loop {
        let mut asked = false;
        while let Some(order) = next(station, orders) {
            match order {
                Order::Input(input, answer) => {
                    let _ = answer.send(station.input(&input));
                    asked = true;
                }
                Order::With(what) => {
                    what(station);
                    asked = true;
                }
                Order::Look(what) => what(station),
                Order::End => return,
            }
        }
        if let Some(session) = replay {
            session.give(station);
        }
        if replay.as_ref().is_some_and(|session| session.is_over(station)) {
            *replay = None;
        }
        if !station.is_paused() {
            // What cannot be stored is said on the screen; the machine goes on.
            let _ = station.cycle();
        }
        if asked || Instant::now() >= due {
            due = Instant::now() + SCREEN;
            shared.publish(station.screen());
        }
    }
}

/// What waits; while time stands, waits for it a moment. Without anybody who could give orders it ends.
fn next(station: &Station, orders: &Receiver<Order>) -> Option<Order> {
    match station.is_paused() {
        true => match orders.recv_timeout(PAUSE) {
            Err(RecvTimeoutError::Disconnected) => Some(Order::End),
            waited => waited.ok(),
        },
        false => match orders.try_recv() {
            Err(TryRecvError::Disconnected) => Some(Order::End),
            tried => tried.ok(),
        },
    }
}
