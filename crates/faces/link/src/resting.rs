//! A line that nobody uses: what comes is not heard.

use std::time::Duration;

use crate::protocol::{Event, Protocol};

/// A protocol that says nothing, as between two transfers that the control begins.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resting;

impl Protocol for Resting {
    fn receive(&mut self, _byte: u8, _now: Duration) {}

    fn clock(&mut self, _now: Duration) {}

    fn deadline(&self) -> Option<Duration> {
        None
    }

    fn has_output(&self) -> bool {
        false
    }

    fn send(&mut self, _room: usize, _now: Duration, _into: &mut Vec<u8>) {}

    fn unplugged(&mut self, _now: Duration) {}

    fn event(&mut self) -> Option<Event> {
        None
    }

    fn answer(&mut self, _yes: bool, _now: Duration) {}

    fn end(&mut self, _now: Duration) {}

    fn is_idle(&self) -> bool {
        true
    }
}
