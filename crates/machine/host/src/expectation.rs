//! What a script expects of control and machine.

use bahn_exchange::{Content, Image, Operand, parts};
use bahn_path::Switch;
use bahn_tnc::{ChannelView, Control, Mode, RunState, Signal, TestState, split_channel};

use crate::observable::Observable;
use crate::of_module::{NO_MODULE, of_module};
use crate::operable::Operable;

/// So near counts as equal when a script does not say how near, for values that are no whole numbers: the
/// last digit of the display.
const TOLERANCE: f64 = 0.0005;

/// Something that must be so.
#[derive(Clone, Debug, PartialEq)]
pub enum Expectation {
    /// `X.actual=100±0.01`, `M2045=1`, `X.lag<0.01`, `S.rpm>900`, `X.table>5`.
    Value(Observable, Relation, f64),
    /// `S0="TEXT"`: a string of the PLC.
    Text(usize, String),
    /// `message "TEXT"`, `no message "TEXT"`: a message that is shown contains the text; any without text.
    Message(String, Presence),
    /// `mode full`: the operating mode.
    Mode(Mode),
    /// `run stopped`: the state of the run.
    Run(Run),
    /// `tool=3`: the tool in the spindle.
    Tool(u32),
    /// `test finished`: the test run beside.
    Test(Tested),
    /// `lamp NC_START=1`: whether a lamp of the operating panel is lit.
    Lamp(String, Switch),
    /// `2:X.actual=100`, `2: run ended`: of a channel, from 0; signal, message, mode, run or tool.
    Of(usize, Box<Expectation>),
    /// `module:X.actual=100`, `module: no message`: of the positioning module beside the machine.
    Module(Box<Expectation>),
}

/// Whether something is to be there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// It is there.
    There,
    /// It is not there.
    Absent,
}

impl Presence {
    /// Whether what was looked for is as expected.
    pub fn agrees(self, is_there: bool) -> bool {
        is_there == (self == Presence::There)
    }
}

/// How a value compares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relation {
    /// Equal within a tolerance.
    Equal(f64),
    /// `<`: the value is less.
    Less,
    /// `>`: the value is greater.
    Greater,
}

/// States of the run by their names in scripts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Run {
    /// A state of the run.
    State(RunState),
    /// The run has come to its end.
    Ended,
}

const RUNS: [(&str, Run); 6] = [
    ("idle", Run::State(RunState::Idle)),
    ("running", Run::State(RunState::Running)),
    ("interrupted", Run::State(RunState::Interrupted)),
    ("stopped", Run::State(RunState::Stopped)),
    ("block-end", Run::State(RunState::BlockEnd)),
    ("ended", Run::Ended),
];

/// States of the test run by their names in scripts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tested {
    /// Blocks are being tested.
    Running,
    /// It waits for the operator.
    Interrupted,
    /// It has come to its end.
    Finished,
    /// An error has ended it.
    Failed,
}

const TESTS: [(&str, Tested); 4] = [
    ("running", Tested::Running),
    ("interrupted", Tested::Interrupted),
    ("finished", Tested::Finished),
    ("failed", Tested::Failed),
];

impl Tested {
    fn of(state: &TestState) -> Tested {
        match state {
            TestState::Running => Tested::Running,
            TestState::Interrupted => Tested::Interrupted,
            TestState::Finished => Tested::Finished,
            TestState::Failed(_) => Tested::Failed,
        }
    }

    fn name(self) -> &'static str {
        let named = TESTS.iter().find(|(_, state)| *state == self);
        named.map_or("", |(name, _)| name)
    }
}

/// The name of a state of the run.
pub fn run_name(state: RunState) -> &'static str {
    let named = RUNS.iter().find(|(_, run)| *run == Run::State(state));
    named.map_or("", |(name, _)| name)
}

impl Expectation {
    /// The forms of expectations, a line each.
    pub const HELP: &str = "\
expect X.actual=100±0.01            a signal and its value, +-0.01 also; without it within 0.0005
expect M2045=1                      an operand of the PLC, as W260=$1F or S0=\"TEXT\"
expect X.lag<0.05                   or greater, with >
expect message \"TEXT\"               a message with this in its text is shown
expect no message                   none is shown; with \"TEXT\" none with this in its text
expect mode full                    manual, handwheel, mdi, single, full, reference
expect run stopped                  idle, running, interrupted, stopped, block-end, ended
expect tool=3                       the tool in the spindle
expect M2045=1, W260=3              several: all must be so
expect test finished                the test run beside: running, interrupted, finished, failed
expect lamp NC_START=1              a lamp of the panel
expect 2:X.actual=100               of the second channel; also 2: message, 2: mode, 2: run, 2: tool
expect module:X.actual=100          of the positioning module (--with); also module: message and the like
";

    /// Reads what stands after `expect`: one, or several with commas between. Without a machine only operands of the
    /// PLC can be expected.
    ///
    /// # Errors
    /// In words, when one of them is none.
    pub fn parse_all(text: &str, machine: Option<&dyn Operable>) -> Result<Vec<Expectation>, String> {
        Expectation::parse_all_with(text, machine, None)
    }

    /// The same of a machine that has a positioning module beside it.
    ///
    /// # Errors
    /// As [`Expectation::parse_all`].
    pub fn parse_all_with(
        text: &str,
        machine: Option<&dyn Operable>,
        module: Option<&dyn Operable>,
    ) -> Result<Vec<Expectation>, String> {
        let parse = |text: &str| match of_module(text) {
            Some(of_it) => {
                let module = module.ok_or_else(|| NO_MODULE.to_owned())?;
                let what = Expectation::parse(of_it, Some(module))?;
                Ok(Expectation::Module(Box::new(what)))
            }
            None => Expectation::parse(text.trim(), machine),
        };
        parts(text).map(parse).collect()
    }

    fn parse(text: &str, machine: Option<&dyn Operable>) -> Result<Expectation, String> {
        let Some(machine) = machine else {
            let expectation = Expectation::of_value(text);
            return expectation
                .ok()
                .filter(Expectation::is_of_the_plc)
                .ok_or_else(|| {
                    format!("`{text}` is nothing to expect on the bench of the PLC: it has operands, as O2=1")
                });
        };
        if let (Some(channel), of_it) = split_channel(text) {
            let what = Expectation::parse(of_it, Some(machine))?;
            return match what {
                Expectation::Value(Observable::Signal(_), ..)
                | Expectation::Message(..)
                | Expectation::Mode(_)
                | Expectation::Run(_)
                | Expectation::Tool(_) => Ok(Expectation::Of(channel, Box::new(what))),
                _ => Err("it is no matter of a channel: leave the number away".to_owned()),
            };
        }
        match Expectation::of_state(text, machine)? {
            Some(expectation) => Ok(expectation),
            None => Expectation::of_value(text),
        }
    }

    /// It speaks of an operand.
    fn is_of_the_plc(&self) -> bool {
        matches!(
            self,
            Expectation::Text(..)
                | Expectation::Value(Observable::Signal(Signal::Bit(_) | Signal::Number(_)), ..)
        )
    }

    /// `None` when it is so in the memory of the PLC; otherwise what is. Of anything but operands nothing is known
    /// there.
    pub fn check_memory(&self, image: &Image) -> Option<String> {
        match self {
            Expectation::Text(string, text) => check_text(*string, text, image),
            Expectation::Value(signal @ Observable::Signal(Signal::Bit(bit)), relation, value) => {
                let actual = u8::from(image.bit(*bit));
                relation.check(signal, actual.into(), *value)
            }
            Expectation::Value(signal @ Observable::Signal(Signal::Number(number)), relation, value) => {
                relation.check(signal, image.number(*number).into(), *value)
            }
            _ => Some("there is no control".to_owned()),
        }
    }

    /// What begins with a word: a message, a mode, a state, a lamp; `None` for anything else.
    fn of_state(text: &str, machine: &dyn Operable) -> Result<Option<Expectation>, String> {
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        let expectation = match word {
            "message" => Expectation::Message(quoted(rest)?, Presence::There),
            "no" => {
                let rest = rest.strip_prefix("message");
                let rest = rest.ok_or("`expect no` takes `message`")?.trim();
                let text = if rest.is_empty() {
                    String::new()
                } else {
                    quoted(rest)?
                };
                Expectation::Message(text, Presence::Absent)
            }
            "mode" => Expectation::Mode(named(rest, "mode", &Mode::ALL.map(|mode| (mode.name(), mode)))?),
            "run" => Expectation::Run(named(rest, "state", &RUNS)?),
            "test" => Expectation::Test(named(rest, "state", &TESTS)?),
            "lamp" => {
                let (name, value) = rest.split_once('=').ok_or("it is written `lamp NAME=1`")?;
                let name = name.trim();
                if !machine.lamps().iter().any(|(lamp, _)| *lamp == name) {
                    let known: Vec<&str> = machine.lamps().iter().map(|(lamp, _)| *lamp).collect();
                    let known = known.join(", ");
                    return Err(format!("the machine has no lamp `{name}`; there are {known}"));
                }
                Expectation::Lamp(name.to_owned(), Switch::from(bit(value)?))
            }
            _ => return Ok(None),
        };
        Ok(Some(expectation))
    }

    /// A signal, or the tool, with its value.
    fn of_value(text: &str) -> Result<Expectation, String> {
        let at = text
            .find(['=', '<', '>'])
            .ok_or("it takes a signal and its value, as X.actual=100±0.01, or message \"TEXT\"")?;
        let (name, rest) = text.split_at(at);
        let equal = rest.strip_prefix('=').map(str::trim);
        if let ("tool", Some(value)) = (name.trim(), equal) {
            let tool = value.parse().map_err(|_| format!("`{value}` is no tool"))?;
            return Ok(Expectation::Tool(tool));
        }
        if let (Ok(Operand::Text(string)), Some(value)) = (name.parse(), equal) {
            return Operand::Text(string).content(value).map(|content| match content {
                Content::Text(text) => Expectation::Text(string, text),
                Content::Number(number) => Expectation::Text(string, number.to_string()),
            });
        }
        let signal: Observable = name.trim().parse().map_err(|error| format!("{error}"))?;
        let (relation, value) = Relation::read(rest, |text| value_of(&signal, text))?;
        Ok(Expectation::Value(signal, relation, value))
    }

    /// `None` when it is so; otherwise what is.
    pub fn check(&self, control: &Control, machine: &dyn Operable) -> Option<String> {
        self.check_in(control.first(), None, control, machine)
    }

    /// The same of a channel; `only` its messages count, or all.
    fn check_in(
        &self,
        channel: ChannelView,
        only: Option<usize>,
        control: &Control,
        machine: &dyn Operable,
    ) -> Option<String> {
        match self {
            Expectation::Of(number, what) => match control.channel(*number) {
                Some(channel) => what.check_in(channel, Some(*number), control, machine),
                None => Some(format!("the machine has no channel {}", number + 1)),
            },
            Expectation::Module(_) => Some(NO_MODULE.to_owned()),
            Expectation::Value(signal, relation, value) => {
                relation.check(signal, signal.value(channel, machine), *value)
            }
            Expectation::Text(string, text) => check_text(*string, text, control.exchange().plc()),
            Expectation::Message(text, wanted) => {
                let shown: Vec<String> = control
                    .shown()
                    .iter()
                    .filter(|shown| only.is_none() || shown.channel == only)
                    .map(|shown| control.shown_text(shown))
                    .collect();
                let is_shown = shown.iter().any(|message| message.contains(text.as_str()));
                (!wanted.agrees(is_shown)).then(|| match shown.as_slice() {
                    [] => "no message is shown".to_owned(),
                    shown => format!("shown is {}", shown.join(", ")),
                })
            }
            Expectation::Mode(mode) => {
                let actual = channel.mode();
                (actual != *mode).then(|| format!("the mode is {}", actual.name()))
            }
            Expectation::Run(run) => {
                let holds = match run {
                    Run::State(state) => channel.run_state() == *state,
                    Run::Ended => channel.has_ended(),
                };
                (!holds).then(|| format!("the run is {}", run_name(channel.run_state())))
            }
            Expectation::Tool(tool) => {
                let actual = channel.tool();
                (actual != *tool).then(|| format!("tool {actual} is in the spindle"))
            }
            Expectation::Test(state) => {
                let actual = control.test_report().map(|report| Tested::of(&report.state));
                (actual != Some(*state)).then(|| match actual {
                    Some(actual) => format!("the test run is {}", actual.name()),
                    None => "there is no test run".to_owned(),
                })
            }
            Expectation::Lamp(name, light) => {
                let actual = machine.lamps().contains(&(name.as_str(), true));
                (actual != light.is_on()).then(|| format!("lamp {name} is {}", u8::from(actual)))
            }
        }
    }
}

impl Relation {
    /// Reads what follows a name, from `=`, `<` or `>` on, with whatever reads a value.
    pub(crate) fn read(
        text: &str,
        number: impl Fn(&str) -> Result<f64, String>,
    ) -> Result<(Relation, f64), String> {
        let mut characters = text.chars();
        let sign = characters.next();
        let value = characters.as_str().trim();
        match sign {
            Some('<') => Ok((Relation::Less, number(value)?)),
            Some('>') => Ok((Relation::Greater, number(value)?)),
            _ => {
                let mut separators = ["±", "+-", "+/-"].into_iter();
                Ok(
                    match separators.find_map(|separator| value.split_once(separator)) {
                        Some((value, tolerance)) => {
                            (Relation::Equal(decimal(tolerance)?.abs()), number(value)?)
                        }
                        None => (Relation::Equal(TOLERANCE), number(value)?),
                    },
                )
            }
        }
    }

    /// Whether an actual value is so.
    pub(crate) fn holds(self, actual: f64, value: f64) -> bool {
        match self {
            Relation::Equal(tolerance) => (actual - value).abs() <= tolerance,
            Relation::Less => actual < value,
            Relation::Greater => actual > value,
        }
    }

    /// `None` when an actual value is so; otherwise what it is.
    fn check(self, signal: &Observable, actual: f64, value: f64) -> Option<String> {
        (!self.holds(actual, value)).then(|| format!("{signal} is {}", signal.decimals(actual)))
    }
}

fn check_text(string: usize, text: &str, image: &Image) -> Option<String> {
    let actual = Operand::Text(string).read(image);
    (actual != Content::Text(text.to_owned())).then(|| format!("S{string} is {actual}"))
}

/// What has this name.
fn named<T: Copy>(name: &str, what: &str, all: &[(&str, T)]) -> Result<T, String> {
    let found = all.iter().find(|(known, _)| *known == name);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let known: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
        format!("`{name}` is no {what}; there are {}", known.join(", "))
    })
}

/// The text of a message, in quotes.
pub(crate) fn quoted(text: &str) -> Result<String, String> {
    text.strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'))
        .map(str::to_owned)
        .ok_or_else(|| "the text of a message stands in quotes".to_owned())
}

fn bit(text: &str) -> Result<bool, String> {
    match text.trim() {
        "0" => Ok(false),
        "1" => Ok(true),
        text => Err(format!("`{text}` is neither 0 nor 1")),
    }
}

/// A value of a signal; an operand takes what fits it, `$` is hexadecimal.
fn value_of(signal: &Observable, text: &str) -> Result<f64, String> {
    let operand = match signal {
        Observable::Signal(Signal::Bit(bit)) => Operand::Bit(*bit),
        Observable::Signal(Signal::Number(number)) => Operand::Number(*number),
        _ => return decimal(text),
    };
    match operand.content(text)? {
        Content::Number(value) => Ok(value.into()),
        Content::Text(text) => decimal(&text),
    }
}

fn decimal(text: &str) -> Result<f64, String> {
    let text = text.trim();
    text.parse::<f64>()
        .ok()
        .filter(|value| value.is_finite())
        .ok_or_else(|| format!("`{text}` is no number"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use bahn_machine::Machine;

    fn read(text: &str) -> Result<Expectation, String> {
        let machine = Machine::from_toml(
            "name = 'one'\n[emergency_stop]\nacknowledgement = 'I3'\n\
             [axis.X]\noutput = '1'\nspeed = 15000\nvolts = 9\nencoder = { input = 'X1', period_um = 20 }",
        );
        Expectation::parse(text, Some(&machine.unwrap()))
    }

    /// Numbers of the PLC are signed and may be hexadecimal; what does not fit is no value.
    #[test]
    fn operands_take_what_fits_them() {
        let value = |text: &str| match read(text) {
            Ok(Expectation::Value(_, Relation::Equal(tolerance), value)) => Ok((value, tolerance)),
            other => Err(other),
        };
        assert_eq!(value("W6=$FFFE"), Ok((-2.0, TOLERANCE)));
        assert_eq!(value("B8 = 200"), Ok((-56.0, TOLERANCE)));
        assert_eq!(value("D8=-3+-2"), Ok((-3.0, 2.0)));
        assert_eq!(value("M5=1"), Ok((1.0, TOLERANCE)));
        assert_eq!(value("X.actual=1.5±0.1"), Ok((1.5, 0.1)));
        assert!(matches!(
            read("W6>$10"),
            Ok(Expectation::Value(_, Relation::Greater, 16.0))
        ));
        let text = Expectation::Text(0, "A=B".to_owned());
        assert_eq!(
            (read("S0=\"A=B\""), read("s0 = A=B")),
            (Ok(text.clone()), Ok(text))
        );
        for wrong in ["M5=2", "W6=$10000", "W6=1.5", "B8=256", "S4=\"A\"", "X.actual=$1"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
