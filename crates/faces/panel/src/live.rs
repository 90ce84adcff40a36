//! A station of a TNC on a thread of its own, in real time.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use bahn_host::{HostError, Reader, Stamped};
use bahn_live::{Input, Refusal, Runs, Steps, Ticket};
use bahn_screen::Screen;

use crate::replay::Replay;
use crate::station::Station;

/// A station that runs.
pub type Live = bahn_live::Live<Station>;

/// Where inputs are given and screens are seen, from any thread.
pub type Link = bahn_live::Link<Station>;

/// Shows a session on a station, and lets it run on after its end. Who watches may let time stand; pauses of the
/// session are passed over.
pub fn live_replay(station: Station, replay: Replay) -> Live {
    let mut session = Some(replay);
    Live::start_with(station, move |station| {
        if let Some(replay) = &mut session {
            replay.give(station);
        }
        if session.as_ref().is_some_and(|replay| replay.is_over(station)) {
            session = None;
        }
    })
}

impl Runs for Station {
    type Notices = Reader<Stamped>;

    fn notices(&mut self) -> Reader<Stamped> {
        self.host().notices()
    }

    fn wait_outside(&mut self, urgent: Arc<AtomicBool>) {
        Station::wait_outside(self, urgent);
    }

    fn run_in_real_time(&mut self) {
        Station::run_in_real_time(self);
    }

    fn input(&mut self, input: &Input) -> Result<(), Refusal> {
        Station::input(self, input)
    }

    fn begin_steps(&mut self, cycles: u32) -> Ticket {
        Station::begin_steps(self, cycles)
    }

    fn steps(&self) -> &Steps {
        Station::steps(self)
    }

    fn stands(&self) -> bool {
        Station::stands(self)
    }

    fn rest(&self) -> Duration {
        Station::rest(self)
    }

    fn cycle(&mut self) -> Result<(), HostError> {
        Station::cycle(self)
    }

    fn screen(&mut self) -> &Screen {
        Station::screen(self)
    }

    fn store(&mut self) -> Result<(), HostError> {
        Station::store(self)
    }
}
