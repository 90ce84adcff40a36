//! Scripts: what happens at which time, and what is expected. A log of a run has the same form.

use std::path::{Path, PathBuf};

use bahn_control::split_channel;
use bahn_machine::{Event, Machine};

use crate::deed::{Deed, DeedError};
use crate::expectation::Expectation;
use crate::fault::{FileFault, Marked, Severity};
use crate::machine_folder::decode;

/// The last second that a script may speak of: eleven days.
const SECONDS_MAX: f64 = 1e6;

/// Faulty lines that are named; behind them reading ends.
const FAULTS_MAX: usize = 1000;

/// What a time counts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// Power-on.
    PowerOn,
    /// The start of the program.
    Start,
    /// The moment in which a condition came true; conditions are numbered in the order of the file.
    Condition(usize),
}

/// What happens.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Something is done.
    Do(Deed),
    /// Nothing; something must be so.
    Expect(Expectation),
    /// The run ends.
    End,
}

/// A line of a script.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// In the file, from 1.
    pub number: u32,
    /// What its time counts from.
    pub base: Base,
    /// Its time, µs.
    pub offset_us: u64,
    /// It waits from then on until this is so.
    pub condition: Option<Expectation>,
    /// What happens.
    pub action: Action,
}

/// A script: its lines in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Script {
    path: PathBuf,
    text: Vec<String>,
    /// Its lines.
    pub lines: Vec<Line>,
}

/// What is wrong in a line: first character and number of characters, and in words.
struct Wrong {
    column: usize,
    length: usize,
    message: String,
}

impl Script {
    /// Reads a script; what it does to the machine is tried on a copy of it. `cycle_us` is the contour cycle.
    ///
    /// # Errors
    /// All faults of the script.
    pub fn of(path: &Path, bytes: &[u8], machine: &Machine, cycle_us: u32) -> Result<Script, Vec<FileFault>> {
        Script::read(path, &decode(bytes), machine, cycle_us)
    }

    fn read(path: &Path, text: &str, machine: &Machine, cycle_us: u32) -> Result<Script, Vec<FileFault>> {
        let mut script = Script {
            path: path.to_owned(),
            text: text.lines().map(str::to_owned).collect(),
            lines: Vec::new(),
        };
        let mut faults = Vec::new();
        let mut reader = Reader {
            machine: machine.clone(),
            cycle_us,
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

    fn fault_at(&self, number: u32, wrong: &Wrong) -> FileFault {
        let count = |value: usize| u32::try_from(value).unwrap_or(1).max(1);
        FileFault {
            severity: Severity::Error,
            title: "the script is wrong".to_owned(),
            path: self.path.clone(),
            marked: Marked {
                line: number,
                text: self.line_text(number),
                columns: Some((count(wrong.column), count(wrong.length))),
            },
            label: wrong.message.clone(),
            help: None,
            opened: None,
        }
    }

    /// A line of the file that was not as expected when its time came.
    pub fn failure(&self, number: u32, title: &str, label: String) -> FileFault {
        FileFault {
            severity: Severity::Error,
            title: title.to_owned(),
            path: self.path.clone(),
            marked: Marked {
                line: number,
                text: self.line_text(number),
                columns: None,
            },
            label,
            help: None,
            opened: None,
        }
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
struct Reader {
    /// What the script does to the machine is tried on it.
    machine: Machine,
    cycle_us: u32,
    /// From what, and how far behind it, the next line counts.
    last: (Base, u64),
    conditions: usize,
}

impl Reader {
    fn line(&mut self, number: u32, line: &str) -> Result<Line, Wrong> {
        let Some((time, rest)) = split_time(line) else {
            return Err(wrong(
                line,
                line.trim(),
                "a line is `TIME: EVENT` or `TIME: expect ..`",
            ));
        };
        let (time, rest) = (time.trim(), rest.trim());
        let condition = self
            .condition(time)
            .map_err(|message| wrong(line, time, &message))?;
        let (base, offset_us) = match condition {
            Some(_) => self.last,
            None => self.time(time).map_err(|message| wrong(line, time, &message))?,
        };
        let action = read_action(rest, &mut self.machine).map_err(|message| wrong(line, rest, &message))?;
        self.last = (base, offset_us);
        if condition.is_some() {
            self.last = (Base::Condition(self.conditions), 0);
            self.conditions += 1;
        }
        Ok(Line {
            number,
            base,
            offset_us,
            condition,
            action,
        })
    }

    /// `when X.actual > 50`, `when message "TEXT"`, `after message TEXT`: what `expect` takes.
    fn condition(&self, text: &str) -> Result<Option<Expectation>, String> {
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        match word {
            "when" => Expectation::parse(rest, &self.machine).map(Some),
            "after" => {
                let text = rest.strip_prefix("message").map(str::trim);
                let text = text.map(|text| text.trim_matches('"'));
                let text = text.filter(|text| !text.is_empty());
                let text = text.ok_or("it is written `after message TEXT`")?;
                Ok(Some(Expectation::Message(text.to_owned(), true)))
            }
            _ => Ok(None),
        }
    }

    /// `12.5` since power-on, `+2` since the line before, `start` or `start+2` since the program was started; in
    /// seconds or, as `+20 cycles`, in contour cycles.
    fn time(&self, text: &str) -> Result<(Base, u64), String> {
        let (base, before_us) = self.last;
        if let Some(rest) = text.strip_prefix('+') {
            return Ok((base, before_us + self.duration(rest)?));
        }
        if let Some(rest) = text.strip_prefix("start") {
            let rest = rest.trim();
            if rest.is_empty() {
                return Ok((Base::Start, 0));
            }
            let rest = rest
                .strip_prefix('+')
                .ok_or("behind `start` stands + and a time")?;
            return Ok((Base::Start, self.duration(rest)?));
        }
        Ok((Base::PowerOn, self.duration(text)?))
    }

    /// µs.
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
                "`{text}` is no time: 12.5 (s since power-on), +2 (since the line before), start+3, +20 cycles, or a \
                 condition: when X.actual > 50, after message TEXT"
            )
        })
    }
}

/// What stands before and behind the first colon outside quotes.
/// A channel behind `when` belongs to the condition: `when 2:X.actual > 50: ce`.
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

fn read_action(text: &str, machine: &mut Machine) -> Result<Action, String> {
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    match word {
        "expect" => return Expectation::parse(rest.trim(), machine).map(Action::Expect),
        "end" if rest.trim().is_empty() => return Ok(Action::End),
        _ => {}
    }
    let deed = Deed::parse(text).map_err(|error| match error {
        DeedError::Unknown(word) => format!(
            "`{word}` is no event and no command; events are {}, expect, end; commands those of the control",
            Event::WORDS.join(", ")
        ),
        DeedError::Wrong(what) => what,
    })?;
    if let Deed::Event(event, _) = &deed {
        machine.act(event).map_err(|error| error.to_string())?;
    }
    Ok(Action::Do(deed))
}

/// A line without what stands behind ; or # outside quotes and words.
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
    use bahn_control::Command;
    use proptest::prelude::*;

    use super::*;

    fn machine() -> Machine {
        Machine::from_toml(
            "name = 'one'\n[keys]\nNC_START = 'I1'\n[emergency_stop]\nacknowledgement = 'I3'\n\
             [axis.X]\noutput = '1'\nspeed = 15000\nvolts = 9\nencoder = { input = 'X1', period_um = 20 }",
        )
        .unwrap()
    }

    fn read(text: &str) -> Result<Script, Vec<FileFault>> {
        Script::read(Path::new("s.txt"), text, &machine(), 3000)
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
            Action::Do(Deed::Command(Command::Key(107)))
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
            .map(|line| (line.base, line.offset_us, line.condition.is_some()))
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
        let message = |text: &str| Some(Expectation::Message(text.to_owned(), true));
        assert_eq!(script.lines[3].condition, message("LIMIT SWITCH"));
        assert_eq!(script.lines[5].condition, message("A: B"));
        let faults = read("when X.heat > 5: ce\nafter rain: ce\n+2.5 cycles: ce\n1e7: ce").unwrap_err();
        let lines: Vec<u32> = faults.iter().map(|fault| fault.marked.line).collect();
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
                Action::Do(deed) => deed.to_string(),
                other => format!("{other:?}"),
            })
            .collect();
        assert_eq!(actions[..3], ["2: mode full", "ce", "ce"]);
        assert!(actions[3].starts_with("Expect(Of(1, Signal("), "{}", actions[3]);
        let conditions: Vec<bool> = script
            .lines
            .iter()
            .map(|line| matches!(line.condition, Some(Expectation::Of(1, _))))
            .collect();
        assert_eq!(conditions, [false, true, true, false]);
        let faults = read("1: 2: key NC_START tap\n1: 2: voltage off\n1: 9: ce\n1: expect 2: test finished")
            .unwrap_err();
        let lines: Vec<u32> = faults.iter().map(|fault| fault.marked.line).collect();
        assert_eq!(lines, [1, 2, 3, 4]);
    }

    #[test]
    fn the_handwheel_is_chosen_and_turned() {
        let script = read("1: handwheel X 3\n2: handwheel -500\n3: test OTHER.H").unwrap();
        let actions: Vec<_> = script.lines.into_iter().map(|line| line.action).collect();
        let turn = "handwheel -500".to_owned();
        assert_eq!(
            actions,
            [
                Action::Do(Deed::Command(Command::Handwheel(bahn_path::Axis::X, 3))),
                Action::Do(Deed::Event(Event::Handwheel(-500), turn)),
                Action::Do(Deed::Command(Command::Test("OTHER.H".into())))
            ]
        );
        let faults = read("1: handwheel X 11").unwrap_err();
        assert!(faults[0].label.contains("from 0 to 10"), "{}", faults[0].label);
    }

    #[test]
    fn faults_have_line_and_column() {
        let faults = read(
            "1: ce\nfive: ce\n2: jump\n  3: key NC_STOP tap\n4 ce\n5: override feed 200\n6: expect M4=2",
        )
        .unwrap_err();
        let places: Vec<_> = faults
            .iter()
            .map(|fault| (fault.marked.line, fault.marked.columns.unwrap().0))
            .collect();
        assert_eq!(places, [(2, 1), (3, 4), (4, 6), (5, 1), (6, 4), (7, 4)]);
        assert!(
            faults[2].label.contains("no key `NC_STOP`; there are NC_START"),
            "{}",
            faults[2].label
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn any_text_is_a_script_or_faults_with_their_lines(
            text in prop_oneof![".{0,60}", "([+0-9a-z. ]{0,6}: ?(expect )?[a-zA-Z0-9.=± \"]{0,12}\n){0,6}"],
        ) {
            if let Err(faults) = read(&text) {
                let lines = text.lines().count() as u32;
                prop_assert!(faults.iter().all(|fault| (1..=lines).contains(&fault.marked.line)));
            }
        }
    }
}
