//! What happens while a System 900 is on, told once when it happens.

use bahn_control900::{Control900, Message, Mode};
use bahn_kernel::RunState;
use bahn_system900::Name;

use super::command::Command900;
use crate::action::{Action, Answer, Source};
use crate::hosted::HostNotice;

/// An event that those who follow a run are told of. The channel of the notice counts from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Notice900 {
    /// A message came up.
    Shown(Message),
    /// The run is in another state.
    Run(RunState),
    /// The program has come to its end.
    Ended,
    /// Another mode.
    Mode(Mode),
    /// A lock holds the operator back from a parameter, in words.
    Held(Name, String),
    /// The operator pressed START because the run waited for him.
    Confirmed,
    /// Something was done, and what came of it.
    Given(Source, Action<Command900>, Answer),
    /// Something keeps the machine from going on; in words.
    Fault(String),
    /// An earlier moment was gone back to: what comes now follows from it.
    Restored,
}

impl From<HostNotice<Command900>> for Notice900 {
    fn from(notice: HostNotice<Command900>) -> Notice900 {
        match notice {
            HostNotice::Given(source, action, answer) => Notice900::Given(source, action, answer),
            HostNotice::Restored => Notice900::Restored,
            HostNotice::Fault(what) => Notice900::Fault(what),
        }
    }
}

/// What was so after the last cycle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Before900 {
    messages: usize,
    channels: Vec<(Mode, RunState, bool)>,
}

impl Before900 {
    /// Tells what a cycle has changed, and in which channel, from 0.
    pub fn compare(&mut self, control: &Control900, mut tell: impl FnMut(usize, Notice900)) {
        let count = control.message_count();
        let new = count - std::mem::replace(&mut self.messages, count);
        let all = control.messages();
        for message in all.get(all.len().saturating_sub(new)..).unwrap_or_default() {
            let channel = usize::from(message.channel.saturating_sub(1));
            tell(channel, Notice900::Shown(message.clone()));
        }
        let channels = usize::from(control.channels());
        self.channels
            .resize(channels, (Mode::Hand, RunState::Idle, false));
        for (number, before) in self.channels.iter_mut().enumerate() {
            let channel = number as u8 + 1;
            let (run, ended) = control.run(channel);
            let now = (control.mode(channel), run, ended);
            let (mode, state, was_ended) = std::mem::replace(before, now);
            if mode != now.0 {
                tell(number, Notice900::Mode(now.0));
            }
            if state != run {
                tell(number, Notice900::Run(run));
            }
            if ended && !was_ended {
                tell(number, Notice900::Ended);
            }
        }
    }
}
