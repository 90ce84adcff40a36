//! Scripts: what happens at which time, and what is expected. A log of a run has the same form.
//!
//! Decision: On the bench of the PLC what a script does in cycle n comes before its scan, what it expects after it

use std::path::{Path, PathBuf};

use bahn_exchange::Assignment;
use bahn_machine::Event;
use bahn_parameters::ParameterList;
use bahn_tnc::{Command, split_channel};

use crate::action::{Action, ActionError};
use crate::any_plant::AnyPlant;
use crate::expectation::{Expectation, Presence};
use crate::operable::Operable;
use bahn_text::{Diagnostic, Span, decode};

/// The last second that a script may speak of: eleven days.
const SECONDS_MAX: f64 = 1e6;

/// The last cycle that a script may speak of: on the bench more than two days. A slip of the keyboard is not to run for
/// years.
const CYCLES_MAX: u64 = 10_000_000;

/// Faulty lines that are named; after them reading ends.
const FAULTS_MAX: usize = 1000;

/// What a script is played on.
pub struct Stage<'a> {
    /// The bench of the PLC has none.
    plant: Option<&'a dyn Operable>,
    /// A copy of it, where it can be copied.
    copy: Option<AnyPlant>,
    parameters: &'a ParameterList,
    cycle_us: u32,
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
        }
    }

    /// A PLC program alone: cycles are its scans.
    pub fn bench(parameters: &'a ParameterList) -> Stage<'a> {
        Stage {
            plant: None,
            copy: None,
            parameters,
            cycle_us: parameters.model().limits().plc_cycle_us,
        }
    }
}

/// What a time counts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// Power-on of the machine.
    PowerOn,
    /// The start of the program.
    Start,
    /// The moment in which a condition came true; conditions are numbered in the order of the file.
    Condition(usize),
}

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
}

/// A line of a script.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// In the file, from 1.
    pub number: u32,
    /// What its time counts from.
    pub base: Base,
    /// Time of the line after its base, µs.
    pub offset_us: u64,
    /// It comes before everything else of this time: it looks at the cycle that has ended then.
    pub after: bool,
    /// It waits from then on until all of this is so.
    pub condition: Vec<Expectation>,
    /// What happens at that time.
    pub action: ScriptAction,
}

/// A script: its lines in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Script {
    path: PathBuf,
    text: Vec<String>,
    /// What it does, a line each, in the order of the file.
    pub lines: Vec<Line>,
}

/// What is wrong in a line: first character and number of characters, and in words.
struct Wrong {
    column: usize,
    length: usize,
    message: String,
}

impl Script {
    /// Reads a script; what it does to a machine is tried on a copy of it.
    ///
    /// # Errors
    /// All faults of the script.
    pub fn of(path: &Path, bytes: &[u8], stage: &Stage) -> Result<Script, Vec<Diagnostic>> {
        Script::read(path, &decode(bytes), stage)
    }

    fn read(path: &Path, text: &str, stage: &Stage) -> Result<Script, Vec<Diagnostic>> {
        let mut script = Script {
            path: path.to_owned(),
            text: text.lines().map(str::to_owned).collect(),
            lines: Vec::new(),
        };
        let mut faults = Vec::new();
        let mut reader = Reader {
            plant: stage.plant,
            tried: stage.copy.as_ref().and_then(AnyPlant::copied),
            parameters: stage.parameters.clone(),
            cycle_us: stage.cycle_us,
            last: (Base::PowerOn, 0),
            conditions: 0,
        };
        for (number, line) in (1..).zip(text.lines()) {
            let content = without_comment(line);
            if content.trim().is_empty() {
                continue;
            }
            if faults.len() == FAULTS_MAX {
                let message = "too many faults: what follows is not read";
                faults.push(script.fault_at(number, &wrong(line, line, message)));
                break;
            }
            match reader.line(number, content) {
                Ok(line) => script.lines.push(line),
                Err(wrong) => faults.push(script.fault_at(number, &wrong)),
            }
        }
        if faults.is_empty() {
            Ok(script)
        } else {
            Err(faults)
        }
    }

    fn fault_at(&self, number: u32, wrong: &Wrong) -> Diagnostic {
        let span = Span::new(number as usize, wrong.column.max(1), wrong.length.max(1));
        self.at(span, "the script is wrong", wrong.message.clone())
    }

    fn at(&self, span: Span, title: &str, label: String) -> Diagnostic {
        Diagnostic::error(span, title)
            .with_detail(label)
            .at(self.path.clone(), self.line_text(span.line))
    }

    /// A line of the file that was not as expected when its time came.
    pub fn failure(&self, number: u32, title: &str, label: String) -> Diagnostic {
        self.at(Span::line(number as usize), title, label)
    }

    /// As [`Script::failure`], at the place of an operand in the line.
    pub fn failure_of(&self, number: u32, operand: &str, title: &str, label: String) -> Diagnostic {
        let text = self.line_text(number);
        // The name as it is written, in a script of the same letters mostly.
        let at = text.to_ascii_uppercase().rfind(operand);
        let span = at.map_or(Span::line(number as usize), |at| {
            let before = text.get(..at).unwrap_or_default().chars().count();
            let item = text.get(at..).unwrap_or_default();
            let item = item.split([',', ';', '#']).next().unwrap_or_default().trim_end();
            Span::new(number as usize, before + 1, item.chars().count())
        });
        self.at(span, title, label)
    }

    /// Where a line stands, as `mill.txt:3`.
    pub fn place(&self, number: u32) -> String {
        format!("{}:{number}", self.path.display())
    }

    /// The text of a line, from 1.
    pub fn line_text(&self, number: u32) -> String {
        let index = (number as usize).saturating_sub(1);
        self.text.get(index).cloned().unwrap_or_default()
    }
}

/// Reads line after line.
struct Reader<'a> {
    /// The bench has none.
    plant: Option<&'a dyn Operable>,
    /// What the script does to the machine is tried on a copy of it; where there is none, it shows when it is done.
    tried: Option<AnyPlant>,
    /// What it does to machine parameters is tried on them.
    parameters: ParameterList,
    cycle_us: u32,
    /// From what, and how far after it, the next line counts.
    last: (Base, u64),
    conditions: usize,
}

impl Reader<'_> {
    fn line(&mut self, number: u32, line: &str) -> Result<Line, Wrong> {
        let Some((time, rest)) = split_time(line) else {
            return Err(wrong(
                line,
                line.trim(),
                "a line is `TIME: WHAT` or `TIME: expect ..`",
            ));
        };
        let (time, rest) = (time.trim(), rest.trim());
        let wrong = |part: &str, message: String| wrong(line, part, &message);
        let condition = self.condition(time).map_err(|message| wrong(time, message))?;
        let cycle = self.cycle(time).map_err(|message| wrong(time, message))?;
        let (base, mut offset_us) = match (condition.is_empty(), cycle) {
            (false, _) => self.last,
            (true, Some(begin_us)) => (Base::PowerOn, begin_us),
            (true, None) => self.time(time).map_err(|message| wrong(time, message))?,
        };
        let action = self.action(rest).map_err(|message| wrong(rest, message))?;
        // What is done in a cycle is done before it; what is looked at is so after it.
        let after = cycle.is_some() && matches!(action, ScriptAction::Expect(_) | ScriptAction::End);
        if after {
            offset_us += u64::from(self.cycle_us);
        }
        self.last = (base, offset_us);
        if !condition.is_empty() {
            self.last = (Base::Condition(self.conditions), 0);
            self.conditions += 1;
        }
        Ok(Line {
            number,
            base,
            offset_us,
            after,
            condition,
            action,
        })
    }

    /// `when X.actual > 50`, `when message "TEXT"`, `after message TEXT`: what `expect` takes.
    fn condition(&self, text: &str) -> Result<Vec<Expectation>, String> {
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        match word {
            "when" => Expectation::parse_all(rest, self.plant),
            "after" if self.plant.is_none() => Err(NO_CONTROL.to_owned()),
            "after" => {
                let text = rest.strip_prefix("message").map(str::trim);
                let text = text.map(|text| text.trim_matches('"'));
                let text = text.filter(|text| !text.is_empty());
                let text = text.ok_or("it is written `after message TEXT`")?;
                Ok(vec![Expectation::Message(text.to_owned(), Presence::There)])
            }
            _ => Ok(Vec::new()),
        }
    }

    /// When the cycle begins that `cycle 5` names, µs since power-on.
    fn cycle(&self, text: &str) -> Result<Option<u64>, String> {
        let Some(number) = text.strip_prefix("cycle ") else {
            return Ok(None);
        };
        let number = number.trim().parse().ok();
        let number = number.filter(|number| (1..=CYCLES_MAX).contains(number));
        let before = number.map(|number| (number - 1) * u64::from(self.cycle_us));
        let before = before.ok_or_else(|| format!("`{text}` is no cycle from 1 to {CYCLES_MAX}"));
        before.map(Some)
    }

    /// `12.5` since power-on, `+2` since the line before, `start` or `start+2` since the program was started; in
    /// seconds or, as `+20 cycles`, in cycles.
    fn time(&self, text: &str) -> Result<(Base, u64), String> {
        let (base, before_us) = self.last;
        if let Some(rest) = text.strip_prefix('+') {
            return Ok((base, before_us + self.duration(rest)?));
        }
        if let Some(rest) = text.strip_prefix("start") {
            if self.plant.is_none() {
                return Err("on the bench of the PLC no program is started".to_owned());
            }
            let rest = rest.trim();
            if rest.is_empty() {
                return Ok((Base::Start, 0));
            }
            let rest = rest
                .strip_prefix('+')
                .ok_or("after `start` stands + and a time")?;
            return Ok((Base::Start, self.duration(rest)?));
        }
        Ok((Base::PowerOn, self.duration(text)?))
    }

    /// A time, or a count of control cycles, in µs.
    fn duration(&self, text: &str) -> Result<u64, String> {
        let cycles = ["cycles", "cycle"];
        let cycles = cycles.iter().find_map(|unit| text.trim().strip_suffix(unit));
        let us = match cycles {
            Some(count) => {
                let count = count.trim().parse::<u32>().ok();
                count.map(|count| u64::from(count) * u64::from(self.cycle_us))
            }
            None => {
                let seconds = text.trim().parse::<f64>().ok();
                let seconds = seconds.filter(|seconds| (0.0..=SECONDS_MAX).contains(seconds));
                seconds.map(|seconds| (seconds * 1e6).round() as u64)
            }
        };
        us.filter(|us| *us as f64 <= SECONDS_MAX * 1e6).ok_or_else(|| {
            format!(
                "`{text}` is no time: 12.5 (s since power-on), +2 (since the line before), start+3, +20 cycles, cycle 5, \
                 or a condition: when X.actual > 50, after message TEXT"
            )
        })
    }

    fn action(&mut self, text: &str) -> Result<ScriptAction, String> {
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        match word {
            "expect" => {
                return Expectation::parse_all(rest, self.plant).map(ScriptAction::Expect);
            }
            "end" if rest.trim().is_empty() => return Ok(ScriptAction::End),
            _ => {}
        }
        if split_channel(text).0.is_none() && Assignment::is_meant(text) {
            return self.assignments(text).map(ScriptAction::Set);
        }
        if self.plant.is_none() {
            return Err(NO_CONTROL.to_owned());
        }
        let action = Action::parse(text).map_err(|error| match error {
            ActionError::Unknown(word) => format!(
                "`{word}` is no event and no command; events are {}, expect, end; commands those of the control",
                Event::WORDS.join(", ")
            ),
            ActionError::Wrong(what) => what,
        })?;
        if let (Action::Event(event, _), Some(tried)) = (&action, &mut self.tried) {
            tried.operate(event)?;
        }
        Ok(ScriptAction::Do(action))
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

/// What stands before and after the first colon outside quotes.
/// A channel after `when` belongs to the condition: `when 2:X.actual > 50: ce`.
fn split_time(line: &str) -> Option<(&str, &str)> {
    let condition = line.trim_start().strip_prefix("when ").map(str::trim_start);
    let before = condition.map_or(0, |condition| match split_channel(condition) {
        (Some(_), _) => line.len() - condition.len() + 2,
        (None, _) => 0,
    });
    let mut quoted = false;
    let at = line.get(before..)?.find(|character: char| {
        quoted ^= character == '"';
        character == ':' && !quoted
    })?;
    let at = before + at;
    Some((line.get(..at)?, line.get(at + 1..)?))
}

/// A fault in a part of a line.
fn wrong(line: &str, part: &str, message: &str) -> Wrong {
    // The part is a slice of the line.
    let at = (part.as_ptr() as usize).saturating_sub(line.as_ptr() as usize);
    let before = line.get(..at).unwrap_or_default();
    Wrong {
        column: before.chars().count() + 1,
        length: part.chars().count(),
        message: message.to_owned(),
    }
}

/// A line without what stands after ; or # outside quotes and words.
fn without_comment(line: &str) -> &str {
    let (mut quoted, mut before) = (false, ' ');
    let end = line.find(|character: char| {
        quoted ^= character == '"';
        let begins = std::mem::replace(&mut before, character).is_whitespace();
        matches!(character, ';' | '#') && begins && !quoted
    });
    line.split_at(end.unwrap_or(line.len())).0
}

#[cfg(test)]
mod tests {
    use bahn_parameters::ControlModel;
    use proptest::prelude::*;

    use super::*;
    use bahn_machine::Machine;

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
        Script::read(Path::new("s.txt"), text, &Stage::machine(&machine(), &parameters))
    }

    fn read_for_bench(text: &str) -> Result<Script, Vec<Diagnostic>> {
        let parameters = ParameterList::reference(ControlModel::Tnc415b);
        Script::read(Path::new("s.txt"), text, &Stage::bench(&parameters))
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
            faults.iter().all(|fault| fault.detail.contains("bench")),
            "{faults:?}"
        );
        assert_eq!(lines(faults), [1, 2, 3, 4, 5, 6]);
        assert!(read_for_bench("1: I4=1").is_ok());
        let faults = read("1: M5=1, I4=1").unwrap_err();
        assert!(
            faults[0].detail.contains("fault input I4 1"),
            "{}",
            faults[0].detail
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
        assert!(faults[0].detail.contains("from 0 to 10"), "{}", faults[0].detail);
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
            faults[2].detail.contains("no key `NC_STOP`; there are NC_START"),
            "{}",
            faults[2].detail
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
