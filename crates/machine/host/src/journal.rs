//! What was given since power-on, and when: given again at these times it repeats the run.

use std::collections::VecDeque;

use bahn_tnc::Control;

use crate::action::{Action, Source};
use crate::hosted::Hosted;
use crate::orders::Order;

/// Entries that are known at most; the oldest are forgotten.
const GIVEN_MAX: usize = 100_000;

/// Text of programs that are executed while they are transferred that is known at most, bytes.
const TEXT_MAX: usize = 16 << 20;

/// How something was given.
#[derive(Clone, Debug)]
pub(crate) enum Given<C: Hosted = Control> {
    /// By whoever drives the host, at once.
    AtOnce(Source, Action<C::Command>),
    /// By an order of somebody beside the host, when its time had come.
    Order(Order<C::Command>),
    /// What an editor has written.
    Renewed(C::Renewed),
}

impl<C: Hosted> Given<C> {
    /// What was done, and by whom.
    pub fn action(&self) -> Option<(&Source, &Action<C::Command>)> {
        match self {
            Given::AtOnce(source, action) => Some((source, action)),
            Given::Order(order) => Some((&order.source, &order.action)),
            Given::Renewed(_) => None,
        }
    }

    /// Bytes of program text in it.
    fn text(&self) -> usize {
        match self.action() {
            Some((_, Action::Command(_, command))) => C::text_in(command),
            _ => 0,
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Journal<C: Hosted = Control> {
    given: VecDeque<(u64, Given<C>)>,
    /// Number of the first one.
    first: u64,
    /// Bytes of program text in it.
    text: usize,
}

impl<C: Hosted> Default for Journal<C> {
    fn default() -> Journal<C> {
        Journal {
            given: VecDeque::new(),
            first: 0,
            text: 0,
        }
    }
}

impl<C: Hosted> Journal<C> {
    pub fn add(&mut self, time_us: u64, given: Given<C>) {
        self.text += given.text();
        while (self.given.len() == GIVEN_MAX || self.text > TEXT_MAX)
            && let Some((_, oldest)) = self.given.pop_front()
        {
            self.text -= oldest.text();
            self.first += 1;
        }
        self.given.push_back((time_us, given));
    }

    /// Number of the next entry.
    pub fn end(&self) -> u64 {
        self.first + self.given.len() as u64
    }

    /// What is known, the oldest first.
    pub fn entries(&self) -> impl DoubleEndedIterator<Item = &(u64, Given<C>)> {
        self.given.iter()
    }

    /// Takes all entries from a number on; `None` when some of them are not known any more.
    pub fn split_off(&mut self, entry: u64) -> Option<VecDeque<(u64, Given<C>)>> {
        let place = usize::try_from(entry.checked_sub(self.first)?).ok()?;
        let split = (place <= self.given.len()).then(|| self.given.split_off(place))?;
        self.text -= split.iter().map(|(_, given)| given.text()).sum::<usize>();
        Some(split)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use bahn_tnc::{Command, Dnc};

    #[test]
    fn what_is_forgotten_is_not_repeated() {
        let mut journal: Journal = Journal::default();
        for time in 0..GIVEN_MAX as u64 + 2 {
            journal.add(time, Given::AtOnce(Source::Script, Action::tap("a")));
        }
        assert!(journal.split_off(1).is_none());
        let since = journal.split_off(GIVEN_MAX as u64).unwrap();
        let times: Vec<u64> = since.iter().map(|(time, _)| *time).collect();
        assert_eq!(times, [GIVEN_MAX as u64, GIVEN_MAX as u64 + 1]);
        assert_eq!(journal.end(), GIVEN_MAX as u64);
        assert!(journal.split_off(journal.end() + 1).is_none());
    }

    /// Of a program that is transferred while it runs no more is known than there is room for.
    #[test]
    fn program_text_does_not_pile_up() {
        let mut journal: Journal = Journal::default();
        let text = || Action::Command(0, Command::Dnc(Dnc::Text(vec![b' '; 1 << 16].into())));
        for time in 0..1000 {
            journal.add(time, Given::AtOnce(Source::Script, text()));
            assert!(journal.text <= TEXT_MAX);
        }
        assert_eq!(journal.given.len(), TEXT_MAX >> 16);
        assert_eq!(journal.end(), 1000);
        assert_eq!(journal.split_off(990).unwrap().len(), 10);
        assert_eq!(journal.text, TEXT_MAX - (10 << 16));
    }
}
