//! A station on a thread of its own, in real time, whatever the family of its control is.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use bahn_host::HostError;
use bahn_screen::Screen;

use crate::input::{Input, Refusal};
use crate::steps::{Stepped, Steps, Ticket};

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

/// A machine that is on and its panel, as a thread lets it run.
pub trait Runs: Send + 'static {
    /// What tells what has happened at it.
    type Notices: Clone;

    /// What happens from now on.
    fn notices(&mut self) -> Self::Notices;

    /// Whoever lets cycles pass waits for [`Runs::rest`] himself; nothing waits for long work while this is set, since
    /// something urgent does.
    fn wait_outside(&mut self, urgent: Arc<AtomicBool>);

    /// Runs in real time from now on, as fast as the operator chose.
    fn run_in_real_time(&mut self);

    /// Takes what the operator does.
    ///
    /// # Errors
    /// When there is no such key, or it cannot be done.
    fn input(&mut self, input: &Input) -> Result<(), Refusal>;

    /// The same as [`Input::Cycles`], for whoever waits for them.
    fn begin_steps(&mut self, cycles: u32) -> Ticket;

    /// Cycles that are asked for.
    fn steps(&self) -> &Steps;

    /// Time stands: the operator lets it, and no cycles are asked for.
    fn stands(&self) -> bool;

    /// How long it is until the next cycle in real time.
    fn rest(&self) -> Duration;

    /// One contour cycle of the machine.
    ///
    /// # Errors
    /// When what survives power-off cannot be written; the machine goes on all the same.
    fn cycle(&mut self) -> Result<(), HostError>;

    /// The screen as it is now. Its serial counts on when it is another one.
    fn screen(&mut self) -> &Screen;

    /// Everything is on the medium: the station ends.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    fn store(&mut self) -> Result<(), HostError>;
}

enum Order<S> {
    Input(Input, Answer<()>),
    /// So many contour cycles; the answer waits until no more of them pass.
    Steps(u32, Answer<Stepped>),
    /// Something that is done with the station between two cycles.
    With(Box<dyn FnOnce(&mut S) + Send>),
    /// Somebody looks at the station: nothing changes, and no screen is made for it.
    Look(Box<dyn FnOnce(&S) + Send>),
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
pub struct Live<S: Runs> {
    orders: SyncSender<Order<S>>,
    shared: Arc<Shared>,
    notices: S::Notices,
    thread: Option<JoinHandle<S>>,
}

/// Where inputs are given and screens are seen, from any thread.
pub struct Link<S> {
    orders: SyncSender<Order<S>>,
    shared: Arc<Shared>,
}

impl<S> Clone for Link<S> {
    fn clone(&self) -> Link<S> {
        Link {
            orders: self.orders.clone(),
            shared: Arc::clone(&self.shared),
        }
    }
}

/// What somebody does to a station before each cycle.
type Before<S> = Box<dyn FnMut(&mut S) + Send>;

impl<S: Runs> Live<S> {
    /// Lets a station run.
    pub fn start(station: S) -> Live<S> {
        Live::start_with(station, |_| {})
    }

    /// The same, and something is done to it before each cycle, also while time stands.
    pub fn start_with(mut station: S, before: impl FnMut(&mut S) + Send + 'static) -> Live<S> {
        let mut before: Before<S> = Box::new(before);
        let (orders, taken) = sync_channel(INPUTS);
        let shared = Arc::new(Shared {
            seen: Mutex::default(),
            changed: Condvar::new(),
            urgent: Mutex::default(),
            alarm: Arc::default(),
        });
        let published = Arc::clone(&shared);
        let notices = station.notices();
        let thread = std::thread::spawn(move || {
            station.wait_outside(Arc::clone(&published.alarm));
            station.run_in_real_time();
            run(&mut station, &mut before, &taken, &published);
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
    pub fn link(&self) -> Link<S> {
        Link {
            orders: self.orders.clone(),
            shared: Arc::clone(&self.shared),
        }
    }

    /// What has happened at the machine since it runs here.
    pub fn notices(&self) -> S::Notices {
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

impl<S: Runs> Link<S> {
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

    fn order(&self, order: Order<S>) -> Result<(), Refusal> {
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
        what: impl FnOnce(&mut S) -> T + Send + 'static,
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
    pub fn look<T: Send + 'static>(&self, what: impl FnOnce(&S) -> T + Send + 'static) -> Result<T, Refusal> {
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
    fn next_urgent<S>(&self) -> Option<Order<S>> {
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

fn run<S: Runs>(station: &mut S, before: &mut Before<S>, orders: &Receiver<Order<S>>, shared: &Shared) {
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
        before(station);
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
fn is_on_its_way<S: Runs>(station: &S, ticket: &Ticket, answer: &Answer<Stepped>) -> bool {
    let outcome = station.steps().outcome(ticket);
    outcome.is_none_or(|stepped| {
        let _ = answer.send(Ok(stepped));
        false
    })
}

/// What is given before the next cycle: until its time in real time, or, while time stands, a moment. Without
/// anybody who could give orders it ends.
fn next<S: Runs>(station: &S, orders: &Receiver<Order<S>>, shared: &Shared) -> Option<Order<S>> {
    if let Some(urgent) = shared.next_urgent() {
        return Some(urgent);
    }
    let wait = if station.stands() { PAUSE } else { station.rest() };
    match orders.recv_timeout(wait) {
        Err(RecvTimeoutError::Disconnected) => Some(Order::End),
        waited => waited.ok(),
    }
}
