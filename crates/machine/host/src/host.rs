//! A machine that is switched on, whatever the family of its control is.
//!
//! Decision: Planning ahead and the cycle share the control, and so a thread, in real time, too; contours that take
//! long have one of their own

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use bahn_machine::Machine;
use bahn_reader::Warning;
use bahn_tnc::Control;

use crate::action::{Action, Answer, Source};
use crate::error::HostError;
use crate::feed::Reader;
use crate::feeds::Feeds;
use crate::hosted::{HostNotice, Hosted, Prepared};
use crate::journal::{Given, Journal};
use crate::log::Sink;
use crate::moment::Moment;
use crate::notice::Stamped;
use crate::operable::Operable;
use crate::orders::{Desk, Order, When};
use crate::pace::{Clock, Lateness, Pacing};

/// Control and plant, driven cycle by cycle, observed, and kept over power-off.
///
/// [`Host::step`] is one contour cycle: what is due is done, the operator acts, the control prepares and spends
/// the cycle, what must survive is stored, and what has changed is told. The same machine and the same actions at
/// the same times give the same bits, but for computations that a [`Clock::Wall`] does not wait for.
pub struct Host<P = Machine, C: Hosted = Control> {
    pub(crate) now: Moment<P, C>,
    pub(crate) journal: Journal<C>,
    /// What of the family's host belongs to no moment.
    pub(crate) beside: C::Beside,
    pub(crate) feeds: Feeds<C>,
    pub(crate) pacing: Pacing,
    /// What was is repeated: nobody is told, and nothing is stored but in the end.
    pub(crate) repeats: bool,
    desk: Desk<C::Command>,
    pub(crate) state: Option<C::State>,
    sink: Option<Box<dyn Sink + Send>>,
    pub(crate) break_off: Arc<AtomicBool>,
}

/// What a host asks of the family of its control. Time, orders, log, followers, pace, and the way back to a moment are the host's; a
/// family says what a cycle is, what can be done, and what survives power-off.
pub trait HostFamily: Hosted {
    /// Spends a cycle: the control prepares, moves the plant, and tells what has changed.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    fn spend<P: Operable>(host: &mut Host<P, Self>) -> Result<(), HostError>;

    /// Does something to a channel.
    fn command<P: Operable>(host: &mut Host<P, Self>, channel: usize, command: &Self::Command) -> Answer;

    /// Takes over what an editor has written; `false` when the control refuses it.
    fn take_over<P: Operable>(host: &mut Host<P, Self>, renewed: Self::Renewed) -> bool;

    /// Waits until what is done on other threads is back.
    fn settle<P: Operable>(_host: &mut Host<P, Self>) {}

    /// The pace is another one now.
    fn pace<P: Operable>(_host: &mut Host<P, Self>) {}

    /// Another moment has taken the place of the present one, and what followed is repeated.
    fn begin_again<P: Operable>(_host: &mut Host<P, Self>) {}

    /// Stores everything.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    fn store<P: Operable>(host: &mut Host<P, Self>) -> Result<(), HostError>;
}

impl<P: Operable, C: HostFamily> Host<P, C> {
    /// A control at power-on with its plant and who stands by; what survives power-off is kept in `state`.
    pub(crate) fn switched_on(now: Moment<P, C>, beside: C::Beside, state: Option<C::State>) -> Host<P, C> {
        Host {
            now,
            journal: Journal::default(),
            beside,
            feeds: Feeds::default(),
            pacing: Pacing::default(),
            repeats: false,
            desk: Desk::default(),
            state,
            sink: None,
            break_off: Arc::default(),
        }
    }

    /// Gives back what survives power-off, so that somebody else can take it; nothing is kept from now on.
    pub fn release_state(&mut self) {
        self.state = None;
    }

    /// What survives power-off is kept somewhere.
    pub fn is_kept(&self) -> bool {
        self.state.is_some()
    }

    /// What survives power-off is kept there from now on.
    pub fn keep_in(&mut self, state: C::State) {
        self.state = Some(state);
    }

    /// One contour cycle: [`Host::begin`] and [`Host::cycle`].
    ///
    /// # Errors
    /// When the log or what survives power-off cannot be written. The machine can go on all the same.
    pub fn step(&mut self) -> Result<(), HostError> {
        self.begin()?;
        self.cycle()
    }

    /// Does what is due before the cycle, and lets the operator act.
    ///
    /// # Errors
    /// When the log cannot be written.
    pub fn begin(&mut self) -> Result<(), HostError> {
        while let Some(order) = self.next_order() {
            let now = self.now.control.time_us();
            self.journal.add(now, Given::Order(order.clone()));
            self.take(order);
        }
        while let Some(order) = self.now.waiting.due(self.now.control.time_us()) {
            self.execute(order.source, order.action)?;
        }
        let now = &mut self.now;
        if let Some((channel, action, notice)) = now.control.stand_by(&mut now.operator) {
            if let Some(notice) = notice {
                self.tell_in(channel, notice);
            }
            self.execute(Source::Operator, action)?;
        }
        Ok(())
    }

    /// Spends a contour cycle, stores what must survive, tells what has changed, and waits for the clock.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    pub fn cycle(&mut self) -> Result<(), HostError> {
        C::spend(self)
    }

    /// Whoever follows has his snapshot, and the clock its due.
    pub(crate) fn end_cycle(&mut self) {
        if !self.repeats {
            self.feeds.look(&self.now.control);
            self.pacing.keep(self.now.control.time_us());
        }
    }

    /// Does something at once, between two cycles.
    ///
    /// # Errors
    /// When the log cannot be written.
    pub fn act(&mut self, source: Source, action: Action<C::Command>) -> Result<Answer, HostError> {
        let now = self.now.control.time_us();
        self.journal
            .add(now, Given::AtOnce(source.clone(), action.clone()));
        self.execute(source, action)
    }

    /// Gives an order; [`Host::desk`] takes them from any thread.
    ///
    /// # Errors
    /// [`HostError::Busy`] when too many wait.
    pub fn order(&self, source: Source, when: When, action: Action<C::Command>) -> Result<(), HostError> {
        self.desk.give(source, when, action)
    }

    /// Where others give orders.
    pub fn desk(&self) -> Desk<C::Command> {
        self.desk.clone()
    }

    /// What was given at the desk. Of the past nobody orders anything more.
    fn next_order(&self) -> Option<Order<C::Command>> {
        if self.repeats { None } else { self.desk.take() }
    }

    /// An order that finds no place among those that wait is answered at once.
    pub(crate) fn take(&mut self, order: Order<C::Command>) {
        let (source, action) = (order.source.clone(), order.action.clone());
        if !self.now.waiting.add(order, self.now.control.time_us()) {
            let answer = Answer::Impossible(HostError::Busy.to_string());
            self.tell(HostNotice::Given(source, action, answer));
        }
    }

    pub(crate) fn execute(
        &mut self,
        source: Source,
        action: Action<C::Command>,
    ) -> Result<Answer, HostError> {
        if let Some(sink) = &mut self.sink {
            sink.note(self.now.control.time_us(), &source, &action.to_string())?;
        }
        let answer = match &action {
            Action::Command(channel, command) => C::command(self, *channel, command),
            Action::Event(event, _) => match self.now.plant.operate(event) {
                Ok(()) => Answer::Done,
                Err(what) => Answer::Impossible(what),
            },
        };
        self.tell(HostNotice::Given(source, action, answer.clone()));
        Ok(answer)
    }

    pub(crate) fn tell(&self, notice: HostNotice<C::Command>) {
        let channel = match &notice {
            HostNotice::Given(_, Action::Command(channel, _), _) => *channel,
            _ => 0,
        };
        self.tell_in(channel, notice.into());
    }

    pub(crate) fn tell_in(&self, channel: usize, notice: C::Notice) {
        if !self.repeats {
            self.feeds.tell(self.now.control.time_us(), channel, notice);
        }
    }

    /// Stores everything: the machine is switched off, or is where it was before.
    ///
    /// # Errors
    /// [`HostError::NotStored`].
    pub fn store(&mut self) -> Result<(), HostError> {
        C::store(self)
    }

    /// The control as of now, to be looked at.
    pub fn control(&self) -> &C {
        &self.now.control
    }

    /// Takes over what an editor has written; see [`Control::renew`]. Who goes back finds what was there then.
    pub fn renew(&mut self, renewed: C::Renewed) -> bool {
        let now = self.now.control.time_us();
        self.journal.add(now, Given::Renewed(renewed.clone()));
        C::take_over(self, renewed)
    }

    /// The plant as of now, to be looked at.
    pub fn plant(&self) -> &P {
        &self.now.plant
    }

    /// The plant, to be changed between two cycles: no log notes that.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.now.plant
    }

    /// The operator who stands by.
    pub fn operator(&self) -> &C::Operator {
        &self.now.operator
    }

    /// A reader of what happens from now on.
    pub fn notices(&self) -> Reader<Stamped<C::Notice>> {
        self.feeds.notices()
    }

    /// A reader of the snapshots from now on; see [`Host::take_snapshots`].
    pub fn snapshots(&self) -> Reader<C::Snapshot> {
        self.feeds.snapshots()
    }

    /// Takes a snapshot every so many µs of the machine from now on; 0 is every contour cycle.
    pub fn take_snapshots(&mut self, every_us: u64) {
        self.feeds.take_snapshots(every_us, self.now.control.time_us());
    }

    /// Runs by another clock from now on. By that on the wall part programs are read on a thread of their own: what a
    /// program needs to be read holds no cycle. It is back for every action, and for what is stored.
    pub fn set_clock(&mut self, clock: Clock) {
        self.pacing.begin(clock, self.now.control.time_us());
        C::pace(self);
    }

    /// From now on no cycle waits for real time: whoever lets them pass waits as long as [`Host::rest`] says,
    /// and can do something else meanwhile.
    pub fn pace_outside(&mut self) {
        self.pacing.wait_outside();
    }

    /// How long it is until the time of the last cycle is over in real time.
    pub fn rest(&self) -> Duration {
        self.pacing.rest()
    }

    /// From now on a cycle waits for what programs need to be read and computed, also in real time: what is
    /// given then at the same times gives the same bits again, at the price of cycles that come late.
    pub fn be_exact(&mut self) {
        self.pacing.be_exact();
        self.set_clock(self.pacing.clock());
    }

    /// Programs are read, and long computations done, on a thread of their own.
    pub(crate) fn works_beside(&self) -> bool {
        self.pacing.works_beside() && !self.repeats
    }

    /// The clock begins anew: the machine is at another time.
    pub(crate) fn reset_clock(&mut self) {
        self.set_clock(self.pacing.clock());
        self.feeds.reset(self.now.control.time_us());
    }

    /// Keeps the path elements of programs of all channels that begin from now on, for [`Host::take_prepared`].
    pub fn keep_path(&mut self) {
        self.now.control.keep_path();
    }

    /// What a channel, from 0, has prepared of its path since the last call.
    pub fn take_prepared(&mut self, channel: usize) -> Prepared {
        self.now.control.take_prepared(channel)
    }

    /// What is to be said of the program of a channel, from 0, since the last call, and ends no run.
    pub fn take_warnings(&mut self, channel: usize) -> Vec<Warning> {
        self.now.control.take_warnings(channel)
    }

    /// What nobody follows is of no use to anybody.
    pub fn drop_path(&mut self) {
        for channel in 0..self.now.control.channels() {
            drop(self.take_prepared(channel));
            drop(self.take_warnings(channel));
        }
    }

    /// How well the pace of the wall was kept; `None` where the machine runs freely.
    pub fn lateness(&self) -> Option<Lateness> {
        self.pacing.lateness()
    }

    /// Notes what is done from now on.
    pub fn set_log(&mut self, sink: Box<dyn Sink + Send>) {
        self.sink = Some(sink);
    }

    /// Notes something that is no action.
    ///
    /// # Errors
    /// When the log cannot be written.
    pub fn remark(&mut self, source: &Source, what: &str) -> Result<(), HostError> {
        match &mut self.sink {
            Some(sink) => sink.note(self.now.control.time_us(), source, what),
            None => Ok(()),
        }
    }

    pub(crate) fn is_logged(&self) -> bool {
        self.sink.is_some()
    }

    /// Completes the log.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish_log(&mut self) -> Result<(), HostError> {
        self.sink.take().map_or(Ok(()), |mut sink| sink.finish())
    }

    /// While this is set, nothing waits for a computation that takes long, and nothing that was is repeated.
    pub fn break_off_by(&mut self, flag: Arc<AtomicBool>) {
        self.break_off = flag;
    }

    /// The flag that breaks off is set.
    pub fn is_broken_off(&self) -> bool {
        self.break_off.load(Ordering::Relaxed)
    }
}
