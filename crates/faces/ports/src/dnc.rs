//! A machine that executes a program while it is transferred: cycle after cycle until the run ends.

use std::time::Duration;

use bahn_host::{Action, Answer, Host, HostError, Next, Notice, Operable, Reader, Source, Stamped};
use bahn_link::dnc::{BlockLine, Drip, DripState, Executing};
use bahn_tnc::{Command, Dnc, DripFeedState, Message, RunState};

/// One look at the line.
const LOOK: Duration = Duration::from_millis(20);
/// So long the machine waits for the line without spending time of its own.
const STILL: Duration = Duration::from_millis(200);
/// With so much text waiting the machine needs not wait for the line, bytes.
const ENOUGH: u64 = 4096;
/// Blocks that one cycle takes at most.
const BLOCKS_PER_CYCLE: u32 = 512;

/// So long NC start may take from the key to the run, time of the machine, µs.
const START_US: u64 = 5_000_000;

/// How a session ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The program came to its end.
    Completed,
    /// What control or line say has stopped it.
    Message(String),
    /// The operator has broken it off with Ctrl-C.
    Interrupted,
}

/// What is to be done.
pub struct Wishes {
    /// Name of the program that the line delivers.
    pub name: String,
    /// How often it is begun again when the line breaks.
    pub restarts: u32,
    /// The machine keeps pace with real time.
    pub realtime: bool,
}

/// A host and its line.
pub struct Session<'a, P> {
    /// The machine that executes it.
    pub host: Host<P>,
    line: &'a mut dyn BlockLine,
    wishes: Wishes,
    notices: Reader<Stamped>,
    drip: Option<Drip>,
    /// What the line has come to, and that nothing more comes over it.
    broken: Option<String>,
    given_up: bool,
    /// The control refused what the operator wanted.
    refused: Option<String>,
    /// When START was pressed, time of the machine, µs.
    pub start_us: Option<u64>,
    /// The run has begun.
    ran: bool,
}

impl<'a, P: Operable> Session<'a, P> {
    /// A machine that is on, with the line that its program comes over.
    pub fn new(host: Host<P>, line: &'a mut dyn BlockLine, wishes: Wishes) -> Session<'a, P> {
        Session {
            notices: host.notices(),
            host,
            line,
            wishes,
            drip: None,
            broken: None,
            given_up: false,
            refused: None,
            start_us: None,
            ran: false,
        }
    }

    /// Blocks that the machine has taken.
    pub fn blocks(&self) -> u64 {
        self.drip.as_ref().map_or(0, Drip::blocks)
    }

    /// Runs to the end.
    ///
    /// # Errors
    /// When what survives power-off cannot be stored, or the machine not do what it is told.
    pub fn run(&mut self, is_interrupted: &dyn Fn() -> bool) -> Result<Ended, HostError> {
        loop {
            if is_interrupted() {
                self.line.give_up();
                return Ok(Ended::Interrupted);
            }
            self.host.step()?;
            self.follow_notices();
            self.ran |= self.start_us.is_some() && self.host.control().first().is_active();
            self.feed()?;
            if let Some(ended) = self.ended() {
                self.line.give_up();
                return Ok(ended);
            }
        }
    }

    fn state(&self) -> Option<DripFeedState> {
        self.host.control().first().drip_feed()
    }

    fn follow_notices(&mut self) {
        for next in self.notices.by_ref() {
            let Next::Item(stamped) = next else { continue };
            if let Notice::Given(Source::Operator, action, Answer::Refused) = stamped.notice
                && action != Action::Command(0, Command::Ce)
            {
                self.refused = Some(format!("the control refuses `{action}`"));
            }
        }
    }

    /// Hands on what comes, and asks for it at first.
    fn feed(&mut self) -> Result<(), HostError> {
        let stopped = self.host.control().run_state() == RunState::Stopped;
        if stopped && !self.wishes.realtime {
            // Somebody else presses START, in real time.
            std::thread::sleep(Duration::from_micros(self.host.control().cycle_us().into()));
        }
        let Some(drip) = &self.drip else {
            if self.host.operator().has_started() && self.state().is_some() {
                self.start();
            }
            return Ok(());
        };
        match drip.state() {
            DripState::Running => self.turn(),
            DripState::Broken(message) => {
                let message = message.clone();
                return self.go_on_broken(message);
            }
            DripState::Over => {}
        }
        Ok(())
    }

    /// START: the header is sent as soon as somebody is there.
    fn start(&mut self) {
        self.start_us.get_or_insert(self.host.control().time_us());
        if self.line.is_connected() {
            self.drip = Some(Drip::start(&self.wishes.name, self.line));
        } else if !self.wishes.realtime {
            self.line.look(LOOK);
        }
    }

    fn turn(&mut self) {
        let Some(drip) = &mut self.drip else { return };
        let mut waited = Duration::ZERO;
        let mut taken = 0;
        while taken < BLOCKS_PER_CYCLE && *drip.state() == DripState::Running {
            let state = self.host.control().first().drip_feed();
            // After the end of the run only the end of the text is awaited.
            let hungry = state.is_none_or(|state| state.wants_more && state.bytes < ENOUGH);
            let waits = hungry && !self.wishes.realtime && waited < STILL;
            let at_most = if waits { LOOK } else { Duration::ZERO };
            if drip.turn(self.line, &mut Executing(&mut self.host), at_most) {
                taken += 1;
                waited = Duration::ZERO;
            } else if waits {
                waited += LOOK;
            } else {
                return;
            }
        }
    }

    /// After a broken line: START again, as often as the operator wants to; else what is known is executed.
    fn go_on_broken(&mut self, message: String) -> Result<(), HostError> {
        if self.wishes.restarts > 0 {
            if !self.line.is_connected() {
                self.line.look(LOOK);
                return Ok(());
            }
            self.wishes.restarts -= 1;
            self.tell(Command::Ce)?;
            if self.tell(Command::Dnc(Dnc::Begin(self.wishes.name.clone())))?
                && let Some(drip) = &mut self.drip
            {
                drip.start_again(self.line);
                return Ok(());
            }
        }
        self.broken = Some(message);
        if !std::mem::replace(&mut self.given_up, true) {
            self.tell(Command::Dnc(Dnc::End))?;
        }
        Ok(())
    }

    fn tell(&mut self, command: Command) -> Result<bool, HostError> {
        let answer = self.host.act(Source::Operator, Action::Command(0, command))?;
        Ok(answer == Answer::Done)
    }

    /// Why the session ends with this cycle.
    fn ended(&self) -> Option<Ended> {
        if let Some(refused) = &self.refused {
            return Some(Ended::Message(refused.clone()));
        }
        let control = self.host.control();
        let over = self
            .drip
            .as_ref()
            .is_some_and(|drip| *drip.state() == DripState::Over);
        if control.has_ended() && over {
            return Some(Ended::Completed);
        }
        let idle = !control.first().is_active();
        let waited_us = control
            .time_us()
            .saturating_sub(self.start_us.unwrap_or(u64::MAX));
        let is_broken = |drip: &Drip| matches!(drip.state(), DripState::Broken(_));
        if self.broken.is_none() && self.drip.as_ref().is_some_and(is_broken) {
            // START may be pressed again.
            return None;
        }
        if let Some(broken) = &self.broken {
            let executed = idle && (self.ran || waited_us > START_US);
            let stopped = control.run_state() == RunState::Stopped && control.stands();
            return (executed || stopped).then(|| Ended::Message(broken.clone()));
        }
        // A message that stood before START keeps nothing from running.
        let since = self.start_us.filter(|_| idle).unwrap_or(u64::MAX);
        let of_the_run = |message: &Message| !matches!(message, Message::Plc(_));
        let mut shown = control.shown().iter().rev();
        let message =
            shown.find(|shown| shown.flashing || shown.time_us >= since && of_the_run(&shown.message));
        message.map(|shown| Ended::Message(control.shown_text(shown)))
    }
}
