//! What a script expects of control and machine.

use bahn_control::{Control, Mode, RunState, Signal, TestState};
use bahn_machine::Machine;

/// So near counts as equal when a script does not say how near, for values that are no whole numbers: the
/// last digit of the display.
const TOLERANCE: f64 = 0.0005;

/// Something that must be so.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expectation {
    /// `X.actual=100±0.01`, `M2045=1`, `X.lag<0.01`, `S.rpm>900`.
    Signal(Signal, Relation, f64),
    /// `message "TEXT"`, `no message "TEXT"`: a message that is shown contains the text; any without text.
    Message(String, bool),
    /// `mode full`.
    Mode(Mode),
    /// `run stopped`.
    Run(Run),
    /// `tool=3`: the tool in the spindle.
    Tool(u32),
    /// `test finished`: the test run beside.
    Test(Tested),
    /// `lamp NC_START=1`.
    Lamp(String, bool),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Relation {
    /// Equal within a tolerance.
    Equal(f64),
    Less,
    Greater,
}

/// States of the run by their names in scripts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Run {
    State(RunState),
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
pub(crate) enum Tested {
    Running,
    Finished,
    Failed,
}

const TESTS: [(&str, Tested); 3] = [
    ("running", Tested::Running),
    ("finished", Tested::Finished),
    ("failed", Tested::Failed),
];

impl Tested {
    fn of(state: &TestState) -> Tested {
        match state {
            TestState::Running => Tested::Running,
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
pub(super) fn run_name(state: RunState) -> &'static str {
    let named = RUNS.iter().find(|(_, run)| *run == Run::State(state));
    named.map_or("", |(name, _)| name)
}

impl Expectation {
    /// The forms of expectations, a line each.
    pub const HELP: &str = "\
expect X.actual=100±0.01            a signal and its value, +-0.01 also; without it within 0.0005
expect M2045=1                      an operand of the PLC
expect X.lag<0.05                   or greater, with >
expect message \"TEXT\"               a message with this in its text is shown
expect no message                   none is shown; with \"TEXT\" none with this in its text
expect mode full                    manual, handwheel, mdi, single, full, reference
expect run stopped                  idle, running, interrupted, stopped, block-end, ended
expect tool=3                       the tool in the spindle
expect test finished                the test run beside: running, finished, failed
expect lamp NC_START=1              a lamp of the panel
";

    /// Reads what stands behind `expect`.
    pub fn parse(text: &str, machine: &Machine) -> Result<Expectation, String> {
        match Expectation::of_state(text, machine)? {
            Some(expectation) => Ok(expectation),
            None => Expectation::of_value(text),
        }
    }

    /// What begins with a word: a message, a mode, a state, a lamp; `None` for anything else.
    fn of_state(text: &str, machine: &Machine) -> Result<Option<Expectation>, String> {
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        match word {
            "message" => return Ok(Some(Expectation::Message(quoted(rest)?, true))),
            "no" => {
                let rest = rest
                    .strip_prefix("message")
                    .ok_or("`expect no` takes `message`")?
                    .trim();
                let text = if rest.is_empty() {
                    String::new()
                } else {
                    quoted(rest)?
                };
                return Ok(Some(Expectation::Message(text, false)));
            }
            "mode" => {
                let mode = Mode::ALL.into_iter().find(|mode| mode.name() == rest);
                return mode.map(|mode| Some(Expectation::Mode(mode))).ok_or_else(|| {
                    format!(
                        "`{rest}` is no mode; there are {}",
                        Mode::ALL.map(Mode::name).join(", ")
                    )
                });
            }
            "run" => {
                let run = RUNS.iter().find(|(name, _)| *name == rest);
                return run.map(|(_, run)| Some(Expectation::Run(*run))).ok_or_else(|| {
                    format!(
                        "`{rest}` is no state; there are {}",
                        RUNS.map(|(name, _)| name).join(", ")
                    )
                });
            }
            "test" => {
                let state = TESTS.iter().find(|(name, _)| *name == rest);
                return state
                    .map(|(_, state)| Some(Expectation::Test(*state)))
                    .ok_or_else(|| {
                        format!(
                            "`{rest}` is no state; there are {}",
                            TESTS.map(|(name, _)| name).join(", ")
                        )
                    });
            }
            "lamp" => {
                let (name, value) = rest.split_once('=').ok_or("it is written `lamp NAME=1`")?;
                let name = name.trim();
                if machine.lamp(name).is_none() {
                    let known: Vec<&str> = machine.lamps().collect();
                    return Err(format!(
                        "the machine has no lamp `{name}`; there are {}",
                        known.join(", ")
                    ));
                }
                return bit(value).map(|on| Some(Expectation::Lamp(name.to_owned(), on)));
            }
            _ => Ok(None),
        }
    }

    /// A signal, or the tool, with its value.
    fn of_value(text: &str) -> Result<Expectation, String> {
        let at = text
            .find(['=', '<', '>'])
            .ok_or("it takes a signal and its value, as X.actual=100±0.01, or message \"TEXT\"")?;
        let (name, rest) = text.split_at(at);
        let mut characters = rest.chars();
        let relation = characters.next();
        let value = characters.as_str().trim();
        if name.trim() == "tool" && relation == Some('=') {
            let tool = value.parse().map_err(|_| format!("`{value}` is no tool"))?;
            return Ok(Expectation::Tool(tool));
        }
        let signal: Signal = name.trim().parse().map_err(|error| format!("{error}"))?;
        if let Signal::Bit(_) = signal {
            bit(value)?;
        }
        match relation {
            Some('<') => Ok(Expectation::Signal(signal, Relation::Less, number(value)?)),
            Some('>') => Ok(Expectation::Signal(signal, Relation::Greater, number(value)?)),
            _ => {
                let parts = ["±", "+-", "+/-"]
                    .into_iter()
                    .find_map(|separator| value.split_once(separator));
                let (value, tolerance) = match parts {
                    Some((value, tolerance)) => (number(value)?, number(tolerance)?.abs()),
                    None => (number(value)?, TOLERANCE),
                };
                Ok(Expectation::Signal(signal, Relation::Equal(tolerance), value))
            }
        }
    }

    /// `None` when it is so; otherwise what is.
    pub fn check(&self, control: &Control, machine: &Machine) -> Option<String> {
        match self {
            Expectation::Signal(signal, relation, value) => {
                let actual = control.observe(signal);
                let holds = match relation {
                    Relation::Equal(tolerance) => (actual - value).abs() <= *tolerance,
                    Relation::Less => actual < *value,
                    Relation::Greater => actual > *value,
                };
                (!holds).then(|| format!("{signal} is {}", super::recording::value(signal, actual)))
            }
            Expectation::Message(text, wanted) => {
                let shown: Vec<String> = control
                    .shown()
                    .iter()
                    .map(|shown| control.message_text(&shown.message))
                    .collect();
                let is_shown = shown.iter().any(|message| message.contains(text.as_str()));
                (is_shown != *wanted).then(|| match shown.as_slice() {
                    [] => "no message is shown".to_owned(),
                    shown => format!("shown is {}", shown.join(", ")),
                })
            }
            Expectation::Mode(mode) => {
                let actual = control.mode();
                (actual != *mode).then(|| format!("the mode is {}", actual.name()))
            }
            Expectation::Run(run) => {
                let holds = match run {
                    Run::State(state) => control.run_state() == *state,
                    Run::Ended => control.has_ended(),
                };
                (!holds).then(|| format!("the run is {}", run_name(control.run_state())))
            }
            Expectation::Tool(tool) => {
                let actual = control.tool();
                (actual != *tool).then(|| format!("tool {actual} is in the spindle"))
            }
            Expectation::Test(state) => {
                let actual = control.test_report().map(|report| Tested::of(&report.state));
                (actual != Some(*state)).then(|| match actual {
                    Some(actual) => format!("the test run is {}", actual.name()),
                    None => "there is no test run".to_owned(),
                })
            }
            Expectation::Lamp(name, on) => {
                let actual = machine.lamp(name).unwrap_or(false);
                (actual != *on).then(|| format!("lamp {name} is {}", u8::from(actual)))
            }
        }
    }
}

fn quoted(text: &str) -> Result<String, String> {
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

fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    text.parse::<f64>()
        .ok()
        .filter(|value| value.is_finite())
        .ok_or_else(|| format!("`{text}` is no number"))
}
