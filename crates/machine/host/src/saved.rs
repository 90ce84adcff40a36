//! Moments that can be gone back to.
//!
//! Decision: A moment of a run is reached again from a copy of control, plant and operator by doing again what was
//! given since; notices go on with new numbers behind `Notice::Restored`, and a run that is logged goes forward only

use std::collections::VecDeque;
use std::sync::Arc;

use bahn_tnc::Control;

use crate::action::{Action, Source};
use crate::error::HostError;
use crate::host::{Host, HostFamily};
use crate::hosted::{HostNotice, Hosted};
use crate::journal::{Given, Journal};
use crate::moment::Moment;
use crate::operable::Operable;

/// Control, plant, operator and what is ordered, as they were.
#[derive(Clone)]
pub struct Saved<P, C: Hosted = Control> {
    moment: Moment<P, C>,
    /// The first entry of the journal after it.
    entry: u64,
}

impl<P, C: Hosted> Saved<P, C> {
    /// When it was, µs since power-on.
    pub fn time_us(&self) -> u64 {
        self.moment.control.time_us()
    }
}

/// What was given since power-on, and how far the machine came with it: what is kept of it can be gone through again
/// when the machine has gone another way.
#[derive(Clone, Debug)]
pub struct Course<C: Hosted = Control> {
    journal: Journal<C>,
    end_us: u64,
}

impl<C: Hosted> Course<C> {
    /// How far the machine came, µs since power-on.
    pub fn end_us(&self) -> u64 {
        self.end_us
    }
}

impl<P: Operable, C: HostFamily> Host<P, C> {
    /// What was given until now.
    pub fn course(&self) -> Course<C> {
        Course {
            journal: self.journal.clone(),
            end_us: self.now.control.time_us(),
        }
    }

    /// The number of actions that were given in the course that led here.
    pub fn given_count(&self) -> u64 {
        self.journal.end()
    }

    /// The actions that were given in the course that led here, with their times, µs since power-on, and by whom, the
    /// oldest first; of very many the oldest are forgotten.
    pub fn given(&self) -> impl DoubleEndedIterator<Item = (u64, &Source, &Action<C::Command>)> {
        let entries = self.journal.entries();
        entries.filter_map(|(time, given)| given.action().map(|(source, action)| (*time, source, action)))
    }
}

impl<P: Operable, C: HostFamily> Host<P, C> {
    /// Everything as it is now; `None` where the plant cannot be copied.
    pub fn save(&mut self) -> Option<Saved<P, C>> {
        let plant = self.now.plant.copied()?;
        C::settle(self);
        Some(Saved {
            moment: self.now.with(plant),
            entry: self.journal.end(),
        })
    }

    /// Goes back to a moment. What was given since is forgotten, what is told goes on after
    /// [`Notice::Restored`](crate::Notice::Restored), and what survives power-off is that of the moment.
    ///
    /// # Errors
    /// [`HostError::Logged`], [`HostError::StaysWhereItIs`], [`HostError::NotStored`].
    pub fn restore(&mut self, saved: &Saved<P, C>) -> Result<(), HostError> {
        self.replay(saved, saved.time_us())
    }

    /// Goes back to a moment and repeats what was done since, until a time, µs since power-on, or as far as the
    /// machine had come. What was given later is forgotten.
    ///
    /// # Errors
    /// [`HostError::Logged`], [`HostError::StaysWhereItIs`], [`HostError::Forgotten`], [`HostError::NotStored`],
    /// [`HostError::BrokenOff`]. In the first three cases everything stays as it is.
    pub fn replay(&mut self, saved: &Saved<P, C>, time_us: u64) -> Result<(), HostError> {
        if self.is_logged() {
            return Err(HostError::Logged);
        }
        let then = saved.moment.copied().ok_or(HostError::StaysWhereItIs)?;
        let given = self.journal.split_off(saved.entry).ok_or(HostError::Forgotten)?;
        let end_us = time_us.min(self.now.control.time_us());
        self.repeat(then, given, end_us, false)
    }

    /// Goes to a moment of a course from a moment that was saved in it, as [`Host::replay`] does in that which led here.
    /// At the end of the course everything is as it was when the course was taken.
    ///
    /// # Errors
    /// As [`Host::replay`].
    pub fn replay_course(
        &mut self,
        course: &Course<C>,
        saved: &Saved<P, C>,
        time_us: u64,
    ) -> Result<(), HostError> {
        if self.is_logged() {
            return Err(HostError::Logged);
        }
        let then = saved.moment.copied().ok_or(HostError::StaysWhereItIs)?;
        let mut journal = course.journal.clone();
        let given = journal.split_off(saved.entry).ok_or(HostError::Forgotten)?;
        self.journal = journal;
        let whole = time_us >= course.end_us;
        self.repeat(then, given, time_us.min(course.end_us), whole)
    }

    /// Goes back and gives again what was given until a time; `whole`: also what was given at this time.
    fn repeat(
        &mut self,
        then: Moment<P, C>,
        mut given: VecDeque<(u64, Given<C>)>,
        end_us: u64,
        whole: bool,
    ) -> Result<(), HostError> {
        self.now = then;
        C::begin_again(self);
        self.repeats = true;
        let repeated = loop {
            let now = self.now.control.time_us();
            let at_end = now >= end_us;
            while (!at_end || whole)
                && given.front().is_some_and(|(time, _)| *time <= now)
                && let Some((_, entry)) = given.pop_front()
            {
                self.journal.add(now, entry.clone());
                match entry {
                    Given::AtOnce(source, action) => drop(self.execute(source, action)),
                    Given::Order(order) => self.take(order),
                    Given::Renewed(renewed) => {
                        C::take_over(self, renewed);
                    }
                }
            }
            if at_end {
                break Ok(());
            }
            if self.is_broken_off() {
                break Err(HostError::BrokenOff);
            }
            if let Err(error) = self.step() {
                break Err(error);
            }
            // Whoever follows the path has it already.
            self.drop_path();
        };
        self.repeats = false;
        self.reset_clock();
        self.tell(HostNotice::Restored);
        repeated.and_then(|()| self.store())
    }
}

/// Saved moments of a run at regular times, at most so many: when there are more, every other one goes and the
/// times between them double. A copy shares them.
pub struct Timeline<P, C: Hosted = Control> {
    moments: Vec<Arc<Saved<P, C>>>,
    every_us: u64,
    most: usize,
}

impl<P: Operable, C: HostFamily> Timeline<P, C> {
    /// Saves every so many µs of the machine, at most so many moments and at least two.
    pub fn new(every_us: u64, most: usize) -> Timeline<P, C> {
        Timeline {
            moments: Vec::new(),
            every_us: every_us.max(1),
            most: most.max(2),
        }
    }

    /// Saves the moment when it is time; to be called after every cycle.
    pub fn follow(&mut self, host: &mut Host<P, C>) {
        let now = host.now.control.time_us();
        // Moments of a time that was left lead nowhere.
        while self.moments.pop_if(|last| last.time_us() > now).is_some() {}
        let due = self
            .moments
            .last()
            .is_none_or(|last| now >= last.time_us() + self.every_us);
        if !due {
            return;
        }
        let Some(saved) = host.save() else { return };
        if self.moments.len() >= self.most {
            self.thin();
        }
        self.moments.push(Arc::new(saved));
    }

    /// The last saved moment up to a time.
    pub fn nearest(&self, time_us: u64) -> Option<&Saved<P, C>> {
        let mut moments = self.moments.iter();
        moments
            .rfind(|moment| moment.time_us() <= time_us)
            .map(Arc::as_ref)
    }

    /// Every other moment goes, and the times between them double.
    pub fn thin(&mut self) {
        let mut place = 0;
        self.moments.retain(|_| {
            place += 1;
            place % 2 == 1
        });
        self.every_us *= 2;
    }

    /// How many moments are saved.
    pub fn len(&self) -> usize {
        self.moments.len()
    }

    /// None is saved yet.
    pub fn is_empty(&self) -> bool {
        self.moments.is_empty()
    }
}

impl<P, C: Hosted> Clone for Timeline<P, C> {
    fn clone(&self) -> Timeline<P, C> {
        Timeline {
            moments: self.moments.clone(),
            ..*self
        }
    }
}
