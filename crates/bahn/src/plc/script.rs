//! Stimuli and expectations.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::diagnostics::{FileFault, Marked, Severity};
use crate::{UsageError, files};
use bahn_host::{Assignment, Content, Operand};

/// The last cycle that a script may speak of: more than two days of a machine. A slip of the keyboard is
/// not to run for years.
const CYCLES_MAX: u64 = 10_000_000;

/// A script: what is set before and expected after its cycles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Script {
    path: PathBuf,
    text: Vec<String>,
    cycles: BTreeMap<u64, Cycle>,
}

/// One cycle of a script.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Cycle {
    pub set: Vec<Assignment>,
    pub expect: Vec<Expected>,
}

/// A content that an operand must have after a cycle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Expected {
    pub operand: Operand,
    pub content: Content,
    /// Line of the script.
    pub line: u32,
}

impl Script {
    pub fn load(path: &Path) -> Result<Script, UsageError> {
        let bytes = files::read_table(path)?;
        Script::read(&path.to_string_lossy(), &bytes).map_err(UsageError::new)
    }

    /// Reads a script from the bytes of a file; an error names file and line.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Script, String> {
        let script = Script::parse(&String::from_utf8_lossy(bytes))
            .map_err(|(line, error)| format!("{name}:{line}: {error}"))?;
        Ok(Script {
            path: PathBuf::from(name),
            ..script
        })
    }

    /// Reads a script; an error comes with its line.
    fn parse(text: &str) -> Result<Script, (usize, String)> {
        let mut script = Script::default();
        for (number, line) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
            script.text.push(line.to_owned());
            let line = without_comment(line).trim();
            if !line.is_empty() {
                script
                    .add(number, line)
                    .map_err(|error| (number as usize, error))?;
            }
        }
        Ok(script)
    }

    fn add(&mut self, line_number: u32, line: &str) -> Result<(), String> {
        let (cycle, rest) = line
            .split_once(':')
            .ok_or("a line is `cycle: operand=value, ..` or `cycle: expect operand=value, ..`")?;
        let number = cycle
            .trim()
            .parse()
            .ok()
            .filter(|number| (1..=CYCLES_MAX).contains(number))
            .ok_or_else(|| format!("`{}` is no cycle from 1 to {CYCLES_MAX}", cycle.trim()))?;
        let rest = rest.trim();
        let expected = rest.split_at_checked(6).filter(|(word, behind)| {
            word.eq_ignore_ascii_case("expect") && behind.starts_with(char::is_whitespace)
        });
        let cycle = self.cycles.entry(number).or_default();
        match expected {
            None => cycle.set.extend(Assignment::parse_all(rest)?),
            Some((_, rest)) => {
                for assignment in Assignment::parse_all(rest)? {
                    match assignment {
                        Assignment::Operand(operand, content) => cycle.expect.push(Expected {
                            operand,
                            content,
                            line: line_number,
                        }),
                        Assignment::Parameter(_) => return Err("machine parameters do not change".to_owned()),
                    }
                }
            }
        }
        Ok(())
    }

    pub fn cycle(&self, number: u64) -> Option<&Cycle> {
        self.cycles.get(&number)
    }

    /// An expectation that does not hold, at its place in the file.
    pub fn failure(&self, line: u32, operand: &str, title: &str, found: String) -> FileFault {
        let index = (line as usize).saturating_sub(1);
        let text = self.text.get(index).cloned().unwrap_or_default();
        // The name as it is written, in a script of the same letters mostly.
        let at = text.to_ascii_uppercase().find(operand);
        let columns = at.map(|at| {
            let before = text.get(..at).unwrap_or_default().chars().count();
            let item = text.get(at..).unwrap_or_default();
            let item = item.split([',', ';', '#']).next().unwrap_or_default().trim_end();
            let count = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
            (count(before + 1), count(item.chars().count()))
        });
        FileFault {
            severity: Severity::Error,
            title: title.to_owned(),
            path: self.path.clone(),
            marked: Marked { line, text, columns },
            label: found,
            help: None,
            opened: None,
        }
    }

    /// Where a line stands, as `door.txt:3`.
    pub fn place(&self, line: u32) -> String {
        format!("{}:{line}", self.path.display())
    }

    /// All cycles that it speaks of.
    pub fn cycles(&self) -> impl Iterator<Item = &Cycle> {
        self.cycles.values()
    }

    /// All expectations with their cycles.
    pub fn expectations(&self) -> impl Iterator<Item = (u64, &Expected)> {
        let cycles = self.cycles.iter();
        cycles.flat_map(|(number, cycle)| cycle.expect.iter().map(|expected| (*number, expected)))
    }

    /// The last cycle it speaks of, 0 when it is empty.
    pub fn last(&self) -> u64 {
        self.cycles.last_key_value().map_or(0, |(number, _)| *number)
    }

    /// All operands, in the order of their first cycle.
    pub fn operands(&self) -> Vec<Operand> {
        let mut operands = Vec::new();
        for cycle in self.cycles() {
            let set = cycle.set.iter().filter_map(|assignment| match assignment {
                Assignment::Operand(operand, _) => Some(*operand),
                Assignment::Parameter(_) => None,
            });
            for operand in set.chain(cycle.expect.iter().map(|expected| expected.operand)) {
                if !operands.contains(&operand) {
                    operands.push(operand);
                }
            }
        }
        operands
    }
}

fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    let end = line.find(|character| {
        quoted ^= character == '"';
        matches!(character, ';' | '#') && !quoted
    });
    line.split_at(end.unwrap_or(line.len())).0
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn lines_are_stimuli_or_expectations() {
        let script = Script::parse("; door\n1: I4=1, W6=100 # on\n\n3: expect O2=1, S0=\"A;B\"\n").unwrap();
        assert_eq!(script.cycle(1).map(|cycle| cycle.set.len()), Some(2));
        assert_eq!(script.cycle(3).map(|cycle| cycle.expect.len()), Some(2));
        assert_eq!(script.last(), 3);
        for wrong in [
            "I4=1",
            "0: I4=1",
            "1: I4",
            "2: expect MP10=1",
            "x: I4=1",
            "1:",
            "10000001: I4=1",
            "1: I4=1,",
        ] {
            assert!(Script::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn errors_name_file_and_line() {
        let error = Script::read("door.txt", b"1: I4=1\r\n; \xff\r\n2: W7=1").unwrap_err();
        assert!(error.starts_with("door.txt:3: "), "{error}");
    }

    /// An assignment as text, and what it is.
    fn assignment() -> impl Strategy<Value = (String, Operand, Content)> {
        let bit = ("[MmIOTC]", 0_u16..32, 0..2_i32).prop_map(|(area, number, value)| {
            (
                format!("{area}{number}"),
                value.to_string(),
                Content::Number(value),
            )
        });
        let number = (0_u16..64, any::<i32>(), any::<bool>()).prop_map(|(address, value, hex)| {
            let text = if hex {
                format!("${value:X}")
            } else {
                value.to_string()
            };
            (format!("D{}", 4 * address), text, Content::Number(value))
        });
        let text = (0..4_u8, "[A-Z ,;#=:]{0,9}")
            .prop_map(|(string, text)| (format!("S{string}"), format!("\"{text}\""), Content::Text(text)));
        prop_oneof![bit, number, text].prop_map(|(name, value, content)| {
            (format!(" {name} = {value} "), name.parse().unwrap(), content)
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn what_is_written_is_read(
            lines in prop::collection::vec(
                (1..CYCLES_MAX, any::<bool>(), prop::collection::vec(assignment(), 1..4), "( *[;#].{0,5})?"),
                0..12,
            ),
        ) {
            let mut text = String::new();
            let mut expected: BTreeMap<u64, Cycle> = BTreeMap::new();
            for (line, (cycle, is_expectation, assignments, comment)) in (1..).zip(lines) {
                let word = if is_expectation { " Expect" } else { "" };
                let parts: Vec<&str> = assignments.iter().map(|(text, ..)| text.as_str()).collect();
                text += &format!("{cycle}:{word}{}{}\n", parts.join(","), comment.replace(['\n', '\r'], ""));
                let entry = expected.entry(cycle).or_default();
                for (_, operand, content) in assignments {
                    if is_expectation {
                        entry.expect.push(Expected { operand, content, line });
                    } else {
                        entry.set.push(Assignment::Operand(operand, content));
                    }
                }
            }
            prop_assert_eq!(Script::parse(&text).map(|script| script.cycles), Ok(expected), "{}", text);
        }

        #[test]
        fn any_bytes_are_a_script_or_an_error_with_its_line(
            bytes in prop_oneof![
                prop::collection::vec(any::<u8>(), 0..200),
                "([0-9]{1,2}: ?(expect )?[MWDSBI][0-9]{1,4}=[$\"0-9-]{1,5}[,\n;]){0,9}".prop_map(String::into_bytes),
            ],
        ) {
            if let Err(error) = Script::read("F", &bytes) {
                let line = error.strip_prefix("F:").and_then(|rest| rest.split(':').next());
                let line: usize = line.unwrap().parse().unwrap();
                let lines = String::from_utf8_lossy(&bytes).lines().count();
                prop_assert!((1..=lines).contains(&line), "{}", error);
            }
        }
    }
}
