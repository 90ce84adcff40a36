//! A machine that is switched on, as the drip feed sees it.

use bahn_host::{Action, Answer, Host, Operable, Source};
use bahn_tnc::{Command, Dnc, DripFeedState};

use super::Machine;

/// A host whose first channel executes the program.
pub struct Executing<'a, P>(pub &'a mut Host<P>);

impl<P: Operable> Executing<'_, P> {
    fn state(&self) -> Option<DripFeedState> {
        self.0.control().first().drip_feed()
    }

    fn tell(&mut self, dnc: Dnc) -> bool {
        let action = Action::Command(0, Command::Dnc(dnc));
        // What is done stands in the log; one that cannot be written says so with the next cycle.
        matches!(
            self.0.act(Source::Client("DNC".to_owned()), action),
            Ok(Answer::Done)
        )
    }
}

impl<P: Operable> Machine for Executing<'_, P> {
    fn wants_more(&self) -> bool {
        self.state().is_some_and(|state| state.wants_more)
    }

    fn has_ended(&self) -> bool {
        self.state().is_none()
    }

    fn take(&mut self, text: &[u8]) -> bool {
        self.tell(Dnc::Text(text.into()))
    }

    fn complete(&mut self) {
        self.tell(Dnc::End);
    }

    fn broken(&mut self) {
        self.tell(Dnc::Broken);
    }
}
