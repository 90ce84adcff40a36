//! What happens in a lesson, and how far it has come: small, so that every state of it is kept for the time line.

use bahn_host::{Action, Answer, AnyPlant, Base, Expectation, Host, Line, Script, ScriptAction, Source};
use bahn_tnc::Command;

/// How far a script has come.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Player {
    /// When each condition came true, µs since the script began.
    bases: Vec<Option<u64>>,
    /// Lines that were done.
    done: Vec<bool>,
    /// Numbers of the lines, to name one that waits.
    numbers: Vec<u32>,
}

impl Player {
    pub fn new(script: &Script) -> Player {
        let conditions = script.lines.iter().filter(|line| !line.condition.is_empty());
        Player {
            bases: vec![None; conditions.count()],
            done: vec![false; script.lines.len()],
            numbers: script.lines.iter().map(|line| line.number).collect(),
        }
    }

    pub fn is_done(&self) -> bool {
        self.done.iter().all(|done| *done)
    }

    /// The number of the first line that waits.
    pub fn first_open(&self) -> Option<u32> {
        let mut open = self.done.iter().zip(&self.numbers).filter(|(done, _)| !**done);
        open.next().map(|(_, number)| *number)
    }

    /// Does everything that is due, in the order of the file; tells whether it did anything.
    ///
    /// # Errors
    /// When the machine has not what a line names.
    pub fn follow(
        &mut self,
        script: &Script,
        begun_us: u64,
        host: &mut Host<AnyPlant>,
    ) -> Result<bool, String> {
        let now_us = host.control().time_us().saturating_sub(begun_us);
        let mut conditions = 0;
        let mut did = false;
        for (place, line) in script.lines.iter().enumerate() {
            let own = (!line.condition.is_empty()).then_some(conditions);
            conditions += usize::from(own.is_some());
            if self.done.get(place) != Some(&false) || !self.is_due(line, now_us, host) {
                continue;
            }
            if let Some(done) = self.done.get_mut(place) {
                *done = true;
            }
            if let Some(base) = own.and_then(|own| self.bases.get_mut(own)) {
                *base = Some(now_us);
            }
            did = true;
            for action in actions(&line.action) {
                let answer = host.act(Source::Script, action);
                if let Answer::Impossible(why) = answer.map_err(|error| error.to_string())? {
                    return Err(why);
                }
            }
        }
        Ok(did)
    }

    fn is_due(&self, line: &Line, now_us: u64, host: &Host<AnyPlant>) -> bool {
        let base_us = match line.base {
            // The start of a program counts as the beginning: a lesson says with a condition that it waits for one.
            Base::PowerOn | Base::Start => Some(0),
            Base::Condition(number) => self.bases.get(number).copied().flatten(),
        };
        let is_so = |expected: &Expectation| expected.check(host.control(), host.plant()).is_none();
        base_us.is_some_and(|base_us| now_us >= base_us + line.offset_us) && line.condition.iter().all(is_so)
    }
}

/// What a line of a script does.
fn actions(action: &ScriptAction) -> Vec<Action> {
    match action {
        ScriptAction::Do(action) => vec![action.clone()],
        ScriptAction::Set(all) => {
            let commands = all.iter().cloned().map(Command::Set);
            commands.map(|command| Action::Command(0, command)).collect()
        }
        ScriptAction::Expect(_) | ScriptAction::End | ScriptAction::Module(_) => Vec::new(),
    }
}
