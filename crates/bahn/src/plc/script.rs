//! Stimuli and expectations.

use std::collections::BTreeMap;
use std::path::Path;

use super::operand::{Assignment, Content, Operand};
use crate::{UsageError, files};

/// A script: what is set before and expected after its cycles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Script(BTreeMap<u64, Cycle>);

/// One cycle of a script.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Cycle {
    pub set: Vec<Assignment>,
    pub expect: Vec<(Operand, Content)>,
}

impl Script {
    pub fn load(path: &Path) -> Result<Script, UsageError> {
        let bytes = files::read_table(path)?;
        Script::parse(&String::from_utf8_lossy(&bytes))
            .map_err(|(line, error)| UsageError::new(format!("{}:{line}: {error}", path.display())))
    }

    /// Reads a script; an error comes with its line.
    fn parse(text: &str) -> Result<Script, (usize, String)> {
        let mut script = Script::default();
        for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let line = without_comment(line).trim();
            if !line.is_empty() {
                script.add(line).map_err(|error| (index + 1, error))?;
            }
        }
        Ok(script)
    }

    fn add(&mut self, line: &str) -> Result<(), String> {
        let (cycle, rest) = line
            .split_once(':')
            .ok_or("a line is `cycle: operand=value, ..` or `cycle: expect operand=value, ..`")?;
        let number = cycle
            .trim()
            .parse()
            .ok()
            .filter(|number| *number > 0)
            .ok_or_else(|| format!("`{}` is no cycle; the first is 1", cycle.trim()))?;
        let rest = rest.trim();
        let expected = rest.split_at_checked(6).filter(|(word, behind)| {
            word.eq_ignore_ascii_case("expect") && behind.starts_with(char::is_whitespace)
        });
        let cycle = self.0.entry(number).or_default();
        match expected {
            None => cycle.set.extend(Assignment::parse_all(rest)?),
            Some((_, rest)) => {
                for assignment in Assignment::parse_all(rest)? {
                    match assignment {
                        Assignment::Operand(operand, content) => cycle.expect.push((operand, content)),
                        Assignment::Parameter(_) => return Err("machine parameters do not change".to_owned()),
                    }
                }
            }
        }
        Ok(())
    }

    pub fn cycle(&self, number: u64) -> Option<&Cycle> {
        self.0.get(&number)
    }

    /// All cycles that it speaks of.
    pub fn cycles(&self) -> impl Iterator<Item = &Cycle> {
        self.0.values()
    }

    /// The last cycle it speaks of, 0 when it is empty.
    pub fn last(&self) -> u64 {
        self.0.last_key_value().map_or(0, |(number, _)| *number)
    }

    /// All operands, in the order of their first cycle.
    pub fn operands(&self) -> Vec<Operand> {
        let mut operands = Vec::new();
        for cycle in self.cycles() {
            let set = cycle.set.iter().filter_map(|assignment| match assignment {
                Assignment::Operand(operand, _) => Some(*operand),
                Assignment::Parameter(_) => None,
            });
            for operand in set.chain(cycle.expect.iter().map(|(operand, _)| *operand)) {
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
    use super::*;

    #[test]
    fn lines_are_stimuli_or_expectations() {
        let script = Script::parse("; door\n1: I4=1, W6=100 # on\n\n3: expect O2=1, S0=\"A;B\"\n").unwrap();
        assert_eq!(script.cycle(1).map(|cycle| cycle.set.len()), Some(2));
        assert_eq!(script.cycle(3).map(|cycle| cycle.expect.len()), Some(2));
        assert_eq!(script.last(), 3);
        for wrong in ["I4=1", "0: I4=1", "1: I4", "2: expect MP10=1", "x: I4=1", "1:"] {
            assert!(Script::parse(wrong).is_err(), "{wrong}");
        }
    }
}
