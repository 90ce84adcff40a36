//! Scripts for a machine with a System 900: `P8682=2` as the operator, `plc P8706=1` as the PLC, events of the machine, what is
//! expected of parameters and messages.

use std::path::Path;

use bahn_control900::{Control900, cycle_us};
use bahn_exchange::parts;
use bahn_script::{Fault, Script, Verbs};
use bahn_system900::{Memory, Name, Value};
use bahn_text::Diagnostic;

use super::command::Command900;
use crate::action::{Action, Answer, Source};
use crate::any_plant::AnyPlant;
use crate::error::HostError;
use crate::expectation::{Presence, Relation, quoted};
use crate::host::Host;
use crate::operable::Operable;
use crate::play::{Play, Scripted};
use crate::script::read;
use bahn_machine::Event;

/// A script for a machine with a System 900.
pub type Script900 = Script<Action900, Expectation900>;

/// What a line does at its time.
#[derive(Clone, Debug, PartialEq)]
pub enum Action900 {
    /// This is done, one after the other.
    Do(Vec<Action<Command900>>),
    /// Nothing; all of this must be so.
    Expect(Vec<Expectation900>),
    /// The run ends, whatever is still to come.
    End,
}

/// Something that must be so.
#[derive(Clone, Debug, PartialEq)]
pub enum Expectation900 {
    /// `2:P12151=10±0.01`, `P8685>0`.
    Number(Name, Relation, f64),
    /// `P8100=--`: it is cleared.
    Cleared(Name),
    /// `message "M2001"`, `no message`: number and text of a message that nobody has acknowledged contain it.
    Message(String, Presence),
}

impl Scripted for Action900 {
    type Expected = Expectation900;

    fn looks(&self) -> bool {
        matches!(self, Action900::Expect(_))
    }

    fn message(expected: &Expectation900) -> Option<&str> {
        match expected {
            Expectation900::Message(text, Presence::There) => Some(text),
            _ => None,
        }
    }
}

impl Expectation900 {
    /// Reads what stands after `expect`: one, or several with commas between.
    ///
    /// # Errors
    /// In words, when one of them is none.
    pub fn parse_all(text: &str, memory: &Memory) -> Result<Vec<Expectation900>, String> {
        parts(text).map(|part| parse(part.trim(), memory)).collect()
    }

    /// `None` when it is so; otherwise what is.
    pub fn check(&self, control: &Control900) -> Option<String> {
        match self {
            Expectation900::Number(name, relation, value) => match control.number(*name) {
                Ok(Some(actual)) => (!relation.holds(actual, *value)).then(|| format!("{name} is {actual}")),
                Ok(None) => Some(format!("{name} is cleared")),
                Err(error) => Some(error.to_string()),
            },
            Expectation900::Cleared(name) => match control.number(*name) {
                Ok(None) => None,
                Ok(Some(actual)) => Some(format!("{name} is {actual}")),
                Err(error) => Some(error.to_string()),
            },
            Expectation900::Message(text, presence) => {
                let all: Vec<String> = (1..=control.channels())
                    .flat_map(|channel| control.pending_messages(channel))
                    .map(ToString::to_string)
                    .collect();
                let is_there = all.iter().any(|said| said.contains(text.as_str()));
                match presence.agrees(is_there) {
                    true => None,
                    false if all.is_empty() => Some("there is no message".to_owned()),
                    false => Some(format!("there is {}", all.join(", "))),
                }
            }
        }
    }
}

fn parse(text: &str, memory: &Memory) -> Result<Expectation900, String> {
    if let Some(rest) = text.strip_prefix("message") {
        return Ok(Expectation900::Message(quoted(rest.trim())?, Presence::There));
    }
    if let Some(rest) = text.strip_prefix("no message") {
        let rest = rest.trim();
        let wanted = if rest.is_empty() {
            String::new()
        } else {
            quoted(rest)?
        };
        return Ok(Expectation900::Message(wanted, Presence::Absent));
    }
    let form = "it takes a parameter and its value, as P8685=2 or 2:P12151=10±0.01, or message \"TEXT\"";
    let at = text.find(['=', '<', '>']).ok_or(form)?;
    let (name, rest) = text.split_at(at);
    let name: Name = name
        .parse()
        .map_err(|error: bahn_system900::NoName| error.to_string())?;
    memory.place(name).map_err(|error| error.to_string())?;
    if rest.strip_prefix('=').is_some_and(|value| value.trim() == "--") {
        return Ok(Expectation900::Cleared(name));
    }
    let (relation, value) = Relation::read(rest, number)?;
    Ok(Expectation900::Number(name, relation, value))
}

/// A value as parameters have it.
fn number(text: &str) -> Result<f64, String> {
    match text.parse::<Value>().map_err(|error| error.to_string())? {
        Value::Cleared => Err("cleared is neither more nor less than anything".to_owned()),
        Value::Bits(bits) => Ok(bits.into()),
        Value::Decimal { digits, decimals } => Ok(digits as f64 / 10f64.powi(decimals.into())),
    }
}

/// What a script is played on.
pub struct Stage900<'a> {
    memory: &'a Memory,
    plant: &'a AnyPlant,
}

impl<'a> Stage900<'a> {
    /// A control with these parameters, and its machine.
    pub fn new(memory: &'a Memory, plant: &'a AnyPlant) -> Stage900<'a> {
        Stage900 { memory, plant }
    }

    /// Reads a script; what it does to the machine is tried on a copy of it.
    ///
    /// # Errors
    /// All faults of the script.
    pub fn script(&self, path: &Path, bytes: &[u8]) -> Result<Script900, Vec<Diagnostic>> {
        let mut known = Known {
            memory: self.memory,
            tried: self.plant.copied(),
        };
        read(path, bytes, cycle_us(self.memory), &mut known)
    }
}

/// What is known on a stage.
struct Known<'a> {
    memory: &'a Memory,
    tried: Option<AnyPlant>,
}

impl Verbs for Known<'_> {
    type Action = Action900;
    type Condition = Expectation900;

    fn action<'a>(&mut self, what: &'a str) -> Result<Action900, Fault<'a>> {
        let wrong = |message| Fault::new(what, message);
        let (word, rest) = what.split_once(char::is_whitespace).unwrap_or((what, ""));
        match word {
            "expect" => {
                let all = Expectation900::parse_all(rest, self.memory);
                return all.map(Action900::Expect).map_err(wrong);
            }
            "end" if rest.trim().is_empty() => return Ok(Action900::End),
            word if Event::WORDS.contains(&word) => {
                let event = Event::parse(what).map_err(|error| wrong(error.to_string()))?;
                if let Some(tried) = &mut self.tried {
                    tried.operate(&event).map_err(wrong)?;
                }
                let text = what.split_whitespace().collect::<Vec<_>>().join(" ");
                return Ok(Action900::Do(vec![Action::Event(event, text)]));
            }
            _ => {}
        }
        if !what.contains('=') {
            let message = format!(
                "`{word}` is nothing that is done here: P8682=2 as the operator, plc P8706=1 as the PLC, an event of the \
                 machine, expect, end"
            );
            let known = Event::WORDS.iter().copied().chain(["plc", "expect", "end"]);
            return Err(wrong(message).meant(word, known));
        }
        let all = Command900::parse_all(what).map_err(wrong)?;
        for command in &all {
            let place = self.memory.place(command.name);
            place.map_err(|error| wrong(error.to_string()))?;
        }
        let actions = all.into_iter().map(|command| Action::Command(0, command));
        Ok(Action900::Do(actions.collect()))
    }

    fn looks(&self, action: &Action900) -> bool {
        matches!(action, Action900::Expect(_) | Action900::End)
    }

    fn condition<'a>(&mut self, text: &'a str) -> Result<Vec<Expectation900>, Fault<'a>> {
        Expectation900::parse_all(text, self.memory).map_err(|message| Fault::new(text, message))
    }

    fn message(&mut self, text: &str) -> Result<Vec<Expectation900>, String> {
        Ok(vec![Expectation900::Message(text.to_owned(), Presence::There)])
    }
}

impl Play<Action900> {
    /// Plays everything that is due on a machine, in the order of time and of the file; tells whether it ends the run.
    ///
    /// # Errors
    /// When the machine has not what a line names, or the log cannot be written.
    pub fn follow900<P: Operable>(&mut self, host: &mut Host<P, Control900>) -> Result<bool, HostError> {
        let now = host.control().now_us();
        let mut ends = false;
        loop {
            let holds = |condition: &Expectation900| condition.check(host.control()).is_none();
            let Some(line) = self.due(now, holds) else {
                return Ok(ends);
            };
            match line.action {
                Action900::End => ends = true,
                Action900::Expect(all) => {
                    for expectation in &all {
                        match expectation.check(host.control()) {
                            Some(actual) => self.fail(line.number, actual, now as f64 * 1e-6),
                            None => self.expect(expectation),
                        }
                    }
                }
                Action900::Do(actions) => {
                    for action in actions {
                        let text = action.to_string();
                        if let Answer::Impossible(error) = host.act(Source::Script, action)? {
                            return Err(HostError::new(format!("{text}: {error}")));
                        }
                    }
                }
            }
        }
    }
}
