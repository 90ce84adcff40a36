//! Scripts for a machine and for the bench of the PLC: what can be done there, expected and waited for. A log of a run has the same
//! form.
//!
//! Decision: On the bench of the PLC what a script does in cycle n comes before its scan, what it expects after it

use std::path::Path;

use bahn_exchange::Assignment;
use bahn_machine::Event;
use bahn_parameters::ParameterList;
use bahn_script::{Fault, Times, Verbs};
use bahn_tnc::{Command, split_channel};

use crate::action::{Action, ActionError};
use crate::any_plant::AnyPlant;
use crate::expectation::{Expectation, Presence};
use crate::of_module::{NO_MODULE, of_module};
use crate::operable::Operable;
use bahn_text::{Diagnostic, decode};

/// The last second that a script may speak of: eleven days.
const SECONDS_MAX: f64 = 1e6;

/// What begins with the one word ends with the other: a span of time does both.
const ENDS: [(&str, &str); 8] = [
    ("press", "release"),
    ("release", "press"),
    ("off", "on"),
    ("on", "off"),
    ("insert", "remove"),
    ("remove", "insert"),
    ("plug", "unplug"),
    ("unplug", "plug"),
];

/// A script for a machine or for the bench of the PLC.
pub type Script = bahn_script::Script<ScriptAction, Expectation>;

/// A line of such a script.
pub type Line = bahn_script::Line<ScriptAction, Expectation>;

/// What a line of a script does at its time.
#[derive(Clone, Debug, PartialEq)]
pub enum ScriptAction {
    /// Something is done to a machine.
    Do(Action),
    /// Operands of the PLC and machine parameters get these values.
    Set(Vec<Assignment>),
    /// Nothing; all of this must be so.
    Expect(Vec<Expectation>),
    /// The run ends, whatever is still to come.
    End,
    /// Something is done to the positioning module beside the machine.
    Module(Box<ScriptAction>),
}

/// What a script is played on.
pub struct Stage<'a> {
    /// The bench of the PLC has none.
    plant: Option<&'a dyn Operable>,
    /// A copy of it, where it can be copied.
    copy: Option<AnyPlant>,
    parameters: &'a ParameterList,
    cycle_us: u32,
    /// The positioning module beside it.
    module: Option<Box<Stage<'a>>>,
}

impl<'a> Stage<'a> {
    /// A control with its machine: cycles are its contour cycles.
    pub fn machine<P: Operable + Send + Sync + 'static>(
        plant: &'a P,
        parameters: &'a ParameterList,
    ) -> Stage<'a> {
        Stage {
            plant: Some(plant),
            copy: plant.copied().map(AnyPlant::new),
            parameters,
            cycle_us: parameters.model().timing().contour_us(),
            module: None,
        }
    }

    /// With a positioning module beside it.
    #[must_use]
    pub fn with_module(self, module: Stage<'a>) -> Stage<'a> {
        Stage {
            module: Some(Box::new(module)),
            ..self
        }
    }

    /// A PLC program alone: cycles are its scans.
    pub fn bench(parameters: &'a ParameterList) -> Stage<'a> {
        Stage {
            plant: None,
            copy: None,
            parameters,
            cycle_us: parameters.model().limits().plc_cycle_us,
            module: None,
        }
    }

    fn known(&self) -> Known<'_> {
        Known {
            plant: self.plant,
            tried: self.copy.as_ref().and_then(AnyPlant::copied),
            parameters: self.parameters.clone(),
            module: self.module.as_ref().map(|module| Box::new(module.known())),
        }
    }

    /// Reads a script; what it does to a machine is tried on a copy of it.
    ///
    /// # Errors
    /// All faults of the script.
    pub fn script(&self, path: &Path, bytes: &[u8]) -> Result<Script, Vec<Diagnostic>> {
        read(path, bytes, self.cycle_us, &mut self.known())
    }
}

/// Reads a script for a machine with whatever verbs its family has.
///
/// # Errors
/// All faults of the script.
pub(crate) fn read<V: Verbs>(
    path: &Path,
    bytes: &[u8],
    cycle_us: u32,
    verbs: &mut V,
) -> Result<bahn_script::Script<V::Action, V::Condition>, Vec<Diagnostic>> {
    let times = Times::of_cycle(cycle_us).up_to(SECONDS_MAX);
    let (script, faults) = bahn_script::Script::read(path, &decode(bytes), times, verbs);
    match faults.is_empty() {
        true => Ok(script),
        false => Err(faults),
    }
}

/// What is known on a stage.
struct Known<'a> {
    /// The bench has none.
    plant: Option<&'a dyn Operable>,
    /// What the script does to the machine is tried on a copy of it; where there is none, it shows when it is done.
    tried: Option<AnyPlant>,
    /// What it does to machine parameters is tried on them.
    parameters: ParameterList,
    /// What is known of the positioning module beside it.
    module: Option<Box<Known<'a>>>,
}

impl Verbs for Known<'_> {
    type Action = ScriptAction;
    type Condition = Expectation;

    fn action<'a>(&mut self, what: &'a str) -> Result<ScriptAction, Fault<'a>> {
        let wrong = |message| Fault::new(what, message);
        let (word, rest) = what.split_once(char::is_whitespace).unwrap_or((what, ""));
        match word {
            "expect" => {
                let all = self.expectations(rest);
                return all.map(ScriptAction::Expect).map_err(wrong);
            }
            "end" if rest.trim().is_empty() => return Ok(ScriptAction::End),
            _ => {}
        }
        if let Some(of_it) = of_module(what) {
            let module = self.module.as_mut().ok_or_else(|| wrong(NO_MODULE.to_owned()))?;
            return match module.action(of_it)? {
                ScriptAction::Expect(_) => Err(wrong("it is written `expect module: ..`".to_owned())),
                ScriptAction::End => Err(wrong("`end` is of the run, not of the module".to_owned())),
                action => Ok(ScriptAction::Module(Box::new(action))),
            };
        }
        if split_channel(what).0.is_none() && Assignment::is_meant(what) {
            return self.assignments(what).map(ScriptAction::Set).map_err(wrong);
        }
        if self.plant.is_none() {
            return Err(wrong(NO_CONTROL.to_owned()));
        }
        let action = Action::parse(what).map_err(|error| match error {
            ActionError::Unknown(word) => {
                let events = Event::WORDS.join(", ");
                let message = format!(
                    "`{word}` is no event and no command; events are {events}, expect, end; commands those of the control"
                );
                wrong(message).meant(&word, Event::WORDS.iter().copied().chain(["expect", "end"]))
            }
            ActionError::Wrong(message) => wrong(message),
        })?;
        if let (Action::Event(event, _), Some(tried)) = (&action, &mut self.tried) {
            tried.operate(event).map_err(wrong)?;
        }
        Ok(ScriptAction::Do(action))
    }

    fn end<'a>(&mut self, what: &'a str) -> Result<ScriptAction, Fault<'a>> {
        let (before, last) = what.rsplit_once(char::is_whitespace).unwrap_or(("", what));
        let end = ENDS.iter().find(|(begins, _)| *begins == last);
        let (_, ends) = end.ok_or_else(|| {
            let words: Vec<&str> = ENDS.iter().map(|(begins, _)| *begins).collect();
            let message = format!("a span of time takes what ends, as {}", words.join(", "));
            Fault::new(what, message)
        })?;
        let end = format!("{before} {ends}");
        self.action(&end)
            .map_err(|fault| Fault::new(what, fault.message()))
    }

    fn looks(&self, action: &ScriptAction) -> bool {
        matches!(action, ScriptAction::Expect(_) | ScriptAction::End)
    }

    fn started(&self) -> Result<(), String> {
        match self.plant {
            Some(_) => Ok(()),
            None => Err("on the bench of the PLC no program is started".to_owned()),
        }
    }

    fn condition<'a>(&mut self, text: &'a str) -> Result<Vec<Expectation>, Fault<'a>> {
        self.expectations(text)
            .map_err(|message| Fault::new(text, message))
    }

    fn message(&mut self, text: &str) -> Result<Vec<Expectation>, String> {
        match self.plant {
            Some(_) => Ok(vec![Expectation::Message(text.to_owned(), Presence::There)]),
            None => Err(NO_CONTROL.to_owned()),
        }
    }
}

impl Known<'_> {
    fn expectations(&self, text: &str) -> Result<Vec<Expectation>, String> {
        let module = self.module.as_ref().and_then(|module| module.plant);
        Expectation::parse_all_with(text, self.plant, module)
    }

    /// Values of operands and parameters: `I4=1, W6=100, MP4110.2=4`.
    fn assignments(&mut self, text: &str) -> Result<Vec<Assignment>, String> {
        let all = Assignment::parse_all(text)?;
        for assignment in &all {
            match assignment {
                Assignment::Parameter(text) => {
                    let tried = self.parameters.assign(text);
                    tried.map_err(|error| error.to_string())?;
                }
                Assignment::Operand(..) if self.plant.is_none() => {}
                // On the machine it is a command of the control, which refuses inputs.
                Assignment::Operand(..) => {
                    let command = assignment.to_string().parse::<Command>();
                    command.map_err(|error| error.to_string())?;
                }
            }
        }
        Ok(all)
    }
}

/// What a script wants that the bench does not have.
const NO_CONTROL: &str = "on the bench the PLC is alone: operands and machine parameters, as I4=1 or MP4110.2=4, \
     `expect O2=1`, `end`";

#[cfg(test)]
mod tests {
    use bahn_parameters::ControlModel;
    use proptest::prelude::*;

    use super::*;
    use bahn_machine::Machine;
    use bahn_script::Base;

    fn machine() -> Machine {
        Machine::from_toml(
            "name = 'one'\n[keys]\nNC_START = 'I1'\n[emergency_stop]\nacknowledgement = 'I3'\n\
             [axis.X]\noutput = '1'\nspeed = 15000\nvolts = 9\nencoder = { input = 'X1', period_um = 20 }",
        )
        .unwrap()
    }

    fn read(text: &str) -> Result<Script, Vec<Diagnostic>> {
        // The contour cycle of the TNC 415 is 3 ms, its PLC cycle 20 ms [000:3685] [000:239].
        let parameters = ParameterList::reference(ControlModel::Tnc415b);
        Stage::machine(&machine(), &parameters).script(Path::new("s.txt"), text.as_bytes())
    }

    fn read_for_bench(text: &str) -> Result<Script, Vec<Diagnostic>> {
        let parameters = ParameterList::reference(ControlModel::Tnc415b);
        Stage::bench(&parameters).script(Path::new("s.txt"), text.as_bytes())
    }

    #[test]
    fn times_count_from_power_on_start_or_the_line_before() {
        let script = read(
            "; a comment\n1.5: ce # clear\n+0.5: key NC_START tap\nstart+3: override feed 50\n+1: key 107\n\
             start: expect message \"; no comment\"\n12: end",
        )
        .unwrap();
        let times: Vec<_> = script
            .lines
            .iter()
            .map(|line| (line.base, line.offset_us))
            .collect();
        use Base::*;
        assert_eq!(
            times,
            [
                (PowerOn, 1_500_000),
                (PowerOn, 2_000_000),
                (Start, 3_000_000),
                (Start, 4_000_000),
                (Start, 0),
                (PowerOn, 12_000_000)
            ]
        );
        assert_eq!(
            script.lines[3].action,
            ScriptAction::Do(Action::Command(0, Command::Key(107)))
        );
    }

    #[test]
    fn conditions_begin_a_chain_and_cycles_are_times() {
        let script = read(
            "1: ce\nwhen X.actual > 50: key NC_START tap\n+20 cycles: ce\nafter message LIMIT SWITCH: ce\n+0.5: ce\n\
             when message \"A: B\": ce\n2: ce\n1 cycle: ce",
        )
        .unwrap();
        let lines: Vec<_> = script
            .lines
            .iter()
            .map(|line| (line.base, line.offset_us, !line.condition.is_empty()))
            .collect();
        use Base::*;
        assert_eq!(
            lines,
            [
                (PowerOn, 1_000_000, false),
                // It waits from the line before on.
                (PowerOn, 1_000_000, true),
                (Condition(0), 60_000, false),
                (Condition(0), 60_000, true),
                (Condition(1), 500_000, false),
                (Condition(1), 500_000, true),
                (PowerOn, 2_000_000, false),
                (PowerOn, 3_000, false),
            ]
        );
        let message = |text: &str| vec![Expectation::Message(text.to_owned(), Presence::There)];
        assert_eq!(script.lines[3].condition, message("LIMIT SWITCH"));
        assert_eq!(script.lines[5].condition, message("A: B"));
        let faults = read("when X.heat > 5: ce\nafter rain: ce\n+2.5 cycles: ce\n1e7: ce").unwrap_err();
        let lines: Vec<u32> = faults.iter().map(|fault| fault.span.line).collect();
        assert_eq!(lines, [1, 2, 3, 4]);
    }

    /// A channel is told by its number before a colon: in commands, in what is expected, in conditions.
    #[test]
    fn lines_speak_of_channels() {
        let script = read(
            "1: 2: mode full\nwhen 2:X.actual > 50: ce\nwhen 2: run ended: 1: ce\n2: expect 2:X.actual=3",
        )
        .unwrap();
        let actions: Vec<String> = script
            .lines
            .iter()
            .map(|line| match &line.action {
                ScriptAction::Do(action) => action.to_string(),
                other => format!("{other:?}"),
            })
            .collect();
        assert_eq!(actions[..3], ["2: mode full", "ce", "ce"]);
        assert!(actions[3].starts_with("Expect([Of(1, Value("), "{}", actions[3]);
        let conditions: Vec<bool> = script
            .lines
            .iter()
            .map(|line| matches!(line.condition.as_slice(), [Expectation::Of(1, _)]))
            .collect();
        assert_eq!(conditions, [false, true, true, false]);
        let faults = read("1: 2: key NC_START tap\n1: 2: voltage off\n1: 9: ce\n1: expect 2: test finished")
            .unwrap_err();
        let lines: Vec<u32> = faults.iter().map(|fault| fault.span.line).collect();
        assert_eq!(lines, [1, 2, 3, 4]);
    }

    /// What is done in a cycle is done before it, what is expected is looked at after it and before the next.
    #[test]
    fn cycles_are_numbered() {
        let times = |script: Script| -> Vec<_> {
            let lines = script.lines.iter();
            lines.map(|line| (line.offset_us, line.after)).collect()
        };
        let text = "cycle 1: M5=1, W6=-3\n+2 cycles: W6=$10\ncycle 5: expect M5=1, W6>3\n0.5: M5=0\n";
        let bench = times(read_for_bench(text).unwrap());
        assert_eq!(
            bench,
            [(0, false), (40_000, false), (100_000, true), (500_000, false)]
        );
        let machine = times(read(text).unwrap());
        assert_eq!(
            machine,
            [(0, false), (6_000, false), (15_000, true), (500_000, false)]
        );
        let script = read_for_bench("when O2=1, W6=4: I4=0, S0=\"A,B\", MP4110.2=4\n").unwrap();
        let ScriptAction::Set(all) = &script.lines[0].action else {
            panic!("{script:?}");
        };
        let texts: Vec<String> = all.iter().map(Assignment::to_string).collect();
        assert_eq!(texts, ["I4=0", "S0=\"A,B\"", "MP4110.2=4"]);
        assert_eq!(script.lines[0].condition.len(), 2);
    }

    /// Each fault has its line, on the bench too; an input belongs to the machine.
    #[test]
    fn what_a_stage_does_not_have_is_refused() {
        let text = "cycle 0: M5=1\ncycle 10000001: M5=1\ncycle 1: W7=1\ncycle 1: MP9999=1\ncycle 1: MP4110.2=x\n\
                    cycle 1: M5=1,\ncycle 1: expect MP10=1\n";
        let lines =
            |faults: Vec<Diagnostic>| -> Vec<u32> { faults.iter().map(|fault| fault.span.line).collect() };
        let all: Vec<u32> = (1..=7).collect();
        assert_eq!(lines(read_for_bench(text).unwrap_err()), all);
        assert_eq!(lines(read(text).unwrap_err()), all);
        let text = "1: key NC_START tap\nstart: M5=1\n2: expect X.actual=3\nafter message A: M5=1\n3: ce\n\
                    when mode full: M5=1\n";
        let faults = read_for_bench(text).unwrap_err();
        assert!(
            faults.iter().all(|fault| fault.message.contains("bench")),
            "{faults:?}"
        );
        assert_eq!(lines(faults), [1, 2, 3, 4, 5, 6]);
        assert!(read_for_bench("1: I4=1").is_ok());
        let faults = read("1: M5=1, I4=1").unwrap_err();
        assert!(
            faults[0].message.contains("fault input I4 1"),
            "{}",
            faults[0].message
        );
    }

    #[test]
    fn the_handwheel_is_chosen_and_turned() {
        let script = read("1: handwheel X 3\n2: handwheel -500\n3: test OTHER.H").unwrap();
        let actions: Vec<_> = script.lines.into_iter().map(|line| line.action).collect();
        let turn = "handwheel -500".to_owned();
        assert_eq!(
            actions,
            [
                ScriptAction::Do(Action::Command(0, Command::Handwheel(bahn_path::Axis::X, 3))),
                ScriptAction::Do(Action::Event(Event::Handwheel(0, -500), turn)),
                ScriptAction::Do(Action::Command(0, Command::Test("OTHER.H".into())))
            ]
        );
        let faults = read("1: handwheel X 11").unwrap_err();
        assert!(
            faults[0].message.contains("from 0 to 10"),
            "{}",
            faults[0].message
        );
    }

    /// A span of time does the one thing at its beginning and the other at its end; what follows counts from the end.
    #[test]
    fn spans_of_time_begin_and_end() {
        let script = read("1..1.5: key NC_START press\n+1: ce\nstart+1..+20 cycles: voltage off\n").unwrap();
        let lines = script.lines.iter().map(|line| match &line.action {
            ScriptAction::Do(action) => (line.number, line.base, line.offset_us, action.to_string()),
            other => panic!("{other:?}"),
        });
        use Base::*;
        let expected = [
            (1, PowerOn, 1_000_000, "key NC_START press"),
            (1, PowerOn, 1_500_000, "key NC_START release"),
            (2, PowerOn, 2_500_000, "ce"),
            (3, Start, 1_000_000, "voltage off"),
            // 20 cycles of 3 ms.
            (3, Start, 1_060_000, "voltage on"),
        ];
        assert!(
            lines.eq(expected.map(|(number, base, us, text)| (number, base, us, text.to_owned()))),
            "{script:?}"
        );
        let faults = read("2..1: voltage off\n1..start: voltage off\n1..2: ce\n1..2: expect M5=1\n1..x: ce")
            .unwrap_err();
        let places: Vec<_> = faults
            .iter()
            .map(|fault| (fault.span.line, fault.span.column))
            .collect();
        assert_eq!(places, [(1, 1), (2, 1), (3, 7), (4, 7), (5, 4)]);
    }

    /// A slip of the keyboard is told from its neighbour, as in every script.
    #[test]
    fn what_is_meant_is_said() {
        let faults = read("1: overide feed 50\n").unwrap_err();
        assert_eq!(faults[0].help.as_deref(), Some("did you mean `override`?"));
    }

    #[test]
    fn faults_have_line_and_column() {
        let faults = read(
            "1: ce\nfive: ce\n2: jump\n  3: key NC_STOP tap\n4 ce\n5: override feed 200\n6: expect M4=2",
        )
        .unwrap_err();
        let places: Vec<_> = faults
            .iter()
            .map(|fault| (fault.span.line, fault.span.column))
            .collect();
        assert_eq!(places, [(2, 1), (3, 4), (4, 6), (5, 1), (6, 4), (7, 4)]);
        assert!(
            faults[2].message.contains("no key `NC_STOP`; there are NC_START"),
            "{}",
            faults[2].message
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn any_text_is_a_script_or_faults_with_their_lines(
            text in prop_oneof![".{0,60}", "((cycle )?[+0-9a-z. ]{0,6}: ?(expect )?[a-zA-Z0-9.=±, \"]{0,12}\n){0,6}"],
        ) {
            for read in [read(&text), read_for_bench(&text)] {
                if let Err(faults) = read {
                    let lines = text.lines().count() as u32;
                    prop_assert!(faults.iter().all(|fault| (1..=lines).contains(&fault.span.line)));
                }
            }
        }
    }
}
