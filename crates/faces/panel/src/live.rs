//! A station on a thread of its own, in real time.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use bahn_host::{Reader, Stamped};
use bahn_screen::Screen;

use crate::input::{Input, Refusal};
use crate::replay::Replay;
use crate::station::Station;
use crate::steps::{Stepped, Ticket};

/// Inputs that wait at most; more are refused.
const INPUTS: usize = 256;
/// Those who wait for contour cycles at most.
const STEPPING: usize = 16;
/// Urgent inputs that wait at most.
const URGENT: usize = 64;
/// Between two screens that nobody has asked for: 25 a second.
const SCREEN: Duration = Duration::from_millis(40);
/// While time stands, inputs are looked for so often.
const PAUSE: Duration = Duration::from_millis(5);

/// A screen that was published.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// What the screen showed when it was published.
    pub screen: Arc<Screen>,
}

enum Order {
    Input(Input, Answer<()>),
    /// So many contour cycles; the answer waits until no more of them pass.
    Steps(u32, Answer<Stepped>),
    /// Something that is done with the station between two cycles.
    With(Box<dyn FnOnce(&mut Station) + Send>),
    /// Somebody looks at the station: nothing changes, and no screen is made for it.
    Look(Box<dyn FnOnce(&Station) + Send>),
    /// Wakes who waits for orders: an urgent one is in the other queue.
    Urgent,
    End,
}

/// Where whoever gave an input waits.
type Answer<T> = SyncSender<Result<T, Refusal>>;

struct Shared {
    seen: Mutex<Seen>,
    changed: Condvar,
    urgent: Mutex<VecDeque<(Input, Answer<()>)>>,
    /// Set while something urgent waits: long work is broken off for it.
    alarm: Arc<AtomicBool>,
}

/// A station that runs.
pub struct Live {
    orders: SyncSender<Order>,
    shared: Arc<Shared>,
    notices: Reader<Stamped>,
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

    /// Shows a session on a station, and lets it run on after its end. Who watches may let time stand; pauses of the
    /// session are passed over.
    pub fn replay(station: Station, replay: Replay) -> Live {
        Live::run(station, Some(replay))
    }

    fn run(mut station: Station, mut replay: Option<Replay>) -> Live {
        let (orders, taken) = sync_channel(INPUTS);
        let shared = Arc::new(Shared {
            seen: Mutex::default(),
            changed: Condvar::new(),
            urgent: Mutex::default(),
            alarm: Arc::default(),
        });
        let published = Arc::clone(&shared);
        let notices = station.host().notices();
        let thread = std::thread::spawn(move || {
            station.wait_outside(Arc::clone(&published.alarm));
            station.run_in_real_time();
            run(&mut station, &mut replay, &taken, &published);
            station
        });
        Live {
            orders,
            shared,
            notices,
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

    /// What has happened at the machine since it runs here.
    pub fn notices(&self) -> Reader<Stamped> {
        self.notices.clone()
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
    /// Gives an input and waits until it was taken; contour cycles are only asked for. EMERGENCY STOP does not wait
    /// after anything.
    ///
    /// # Errors
    /// Why it was refused; also when too many wait.
    pub fn input(&self, input: Input) -> Result<(), Refusal> {
        let (answer, answered) = sync_channel(1);
        match input.is_urgent() {
            true => {
                self.shared.add_urgent(input, answer)?;
                // Where so many orders wait that there is no place, the station does not sleep.
                let _ = self.orders.try_send(Order::Urgent);
            }
            false => self.order(Order::Input(input, answer))?,
        }
        answered.recv().unwrap_or_else(|_| Err(ended()))
    }

    /// Asks for so many contour cycles, and waits until they have passed or will not pass any more.
    ///
    /// # Errors
    /// When the station has ended, or too many wait.
    pub fn steps(&self, cycles: u32) -> Result<Stepped, Refusal> {
        let (answer, answered) = sync_channel(1);
        self.order(Order::Steps(cycles, answer))?;
        answered.recv().unwrap_or_else(|_| Err(ended()))
    }

    fn order(&self, order: Order) -> Result<(), Refusal> {
        self.orders.try_send(order).map_err(|error| match error {
            TrySendError::Full(_) => too_many(),
            TrySendError::Disconnected(_) => ended(),
        })
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
        self.order(order)?;
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
        self.order(order)?;
        answered.recv().map_err(|_| ended())
    }

    /// The screen as it was published last.
    pub fn screen(&self) -> Arc<Screen> {
        Arc::clone(&self.shared.lock().screen)
    }

    /// Waits for a screen after this serial, at most so long.
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

fn too_many() -> Refusal {
    Refusal("too many inputs wait".to_owned())
}

fn ended() -> Refusal {
    Refusal("the station has ended".to_owned())
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Seen> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds something urgent; long work that goes on is broken off.
    fn add_urgent(&self, input: Input, answer: Answer<()>) -> Result<(), Refusal> {
        let mut urgent = self.urgent.lock().unwrap_or_else(PoisonError::into_inner);
        if urgent.len() == URGENT {
            return Err(too_many());
        }
        urgent.push_back((input, answer));
        self.alarm.store(true, Ordering::Relaxed);
        Ok(())
    }

    /// What is most urgent; with the last of it long work may go on.
    fn next_urgent(&self) -> Option<Order> {
        let mut urgent = self.urgent.lock().unwrap_or_else(PoisonError::into_inner);
        let next = urgent.pop_front();
        self.alarm.store(!urgent.is_empty(), Ordering::Relaxed);
        next.map(|(input, answer)| Order::Input(input, answer))
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
    let mut stepping = Vec::new();
    loop {
        let mut asked = false;
        while let Some(order) = next(station, orders, shared) {
            match order {
                Order::Input(input, answer) => {
                    let _ = answer.send(station.input(&input));
                    asked = true;
                }
                Order::Steps(cycles, answer) => match stepping.len() {
                    STEPPING => drop(answer.send(Err(too_many()))),
                    _ => stepping.push((station.begin_steps(cycles), answer)),
                },
                Order::With(what) => {
                    what(station);
                    asked = true;
                }
                Order::Look(what) => what(station),
                Order::Urgent => {}
                Order::End => return,
            }
            stepping.retain(|(ticket, answer)| is_on_its_way(station, ticket, answer));
        }
        if let Some(session) = replay {
            session.give(station);
        }
        if replay.as_ref().is_some_and(|session| session.is_over(station)) {
            *replay = None;
        }
        if !station.stands() {
            // What cannot be stored is said on the screen; the machine goes on.
            let _ = station.cycle();
        }
        let before = stepping.len();
        stepping.retain(|(ticket, answer)| is_on_its_way(station, ticket, answer));
        asked |= stepping.len() < before;
        if asked || Instant::now() >= due {
            due = Instant::now() + SCREEN;
            shared.publish(station.screen());
        }
    }
}

/// Whether somebody waits on for his cycles; else he is told what became of them.
fn is_on_its_way(station: &Station, ticket: &Ticket, answer: &Answer<Stepped>) -> bool {
    let outcome = station.steps().outcome(ticket);
    outcome.is_none_or(|stepped| {
        let _ = answer.send(Ok(stepped));
        false
    })
}

/// What is given before the next cycle: until its time in real time, or, while time stands, a moment. Without
/// anybody who could give orders it ends.
fn next(station: &Station, orders: &Receiver<Order>, shared: &Shared) -> Option<Order> {
    if let Some(urgent) = shared.next_urgent() {
        return Some(urgent);
    }
    let wait = if station.stands() { PAUSE } else { station.rest() };
    match orders.recv_timeout(wait) {
        Err(RecvTimeoutError::Disconnected) => Some(Order::End),
        waited => waited.ok(),
    }
}
