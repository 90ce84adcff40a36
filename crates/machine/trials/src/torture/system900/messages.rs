//! Messages: none without a cause, and after one that breaks programs off they stand.

use bahn_control900::{Control900, Kind as Weight, Message};
use bahn_kernel::RunState;
use bahn_system900::ChannelParameter;

use crate::torture::catalogue::Kind;
use crate::torture::rule::{Rule, Violation};

/// After a message of high priority a channel stands so long later at the latest, µs.
const STANDS_US: u64 = 2_000_000;

/// What was said, and what may have been the cause.
#[derive(Clone, Debug, Default)]
pub(super) struct Messages {
    /// Something failed, or the PLC or somebody pressed EMERGENCY STOP: whatever is said then has a cause.
    has_cause: bool,
    seen: usize,
}

impl Messages {
    /// From here on only what comes counts.
    pub fn of(control: &Control900) -> Messages {
        Messages {
            has_cause: false,
            seen: control.message_count(),
        }
    }

    /// Something happens.
    pub fn happens(&mut self, kind: Kind) {
        self.has_cause |= matches!(
            kind,
            Kind::Fault | Kind::Plc | Kind::Emergency | Kind::Power | Kind::Thing
        );
    }

    /// Messages of the last cycle.
    pub fn take(&mut self, control: &Control900) -> Result<Vec<String>, Violation> {
        let count = control.message_count();
        let new = count - std::mem::replace(&mut self.seen, count);
        let all = control.messages();
        let new = all.get(all.len().saturating_sub(new)..).unwrap_or_default();
        for message in new {
            if !self.has_cause && !is_of_operation(message) {
                return Err(Violation::new(Rule::Cause, control.now_us(), message.to_string()));
            }
        }
        Ok(new.iter().map(ToString::to_string).collect())
    }

    /// A program whose channel has a message that breaks it off does not run on; an emergency program may.
    pub fn reaction(control: &Control900) -> Result<(), Violation> {
        for channel in 1..=control.channels() {
            let now = control.now_us();
            let breaks = |message: &&Message| {
                matches!(message.kind, Weight::System | Weight::High) && now > message.time_us + STANDS_US
            };
            let (state, _) = control.run(channel);
            let number = |parameter| control.memory().of_channel(channel, parameter).whole();
            let own = number(ChannelParameter::ActualProgram) == number(ChannelParameter::Program);
            let runs = state == RunState::Running && control.is_on_its_way(channel) && own;
            if let Some(message) = control.pending_messages(channel).find(breaks).filter(|_| runs) {
                return Err(Violation::new(
                    Rule::Reaction,
                    now,
                    format!("the program runs on under {message}"),
                ));
            }
        }
        Ok(())
    }
}

/// What comes of keys that do not go together: a mode that is locked, an emergency program.
fn is_of_operation(message: &Message) -> bool {
    message.kind == Weight::Display
}
