//! Why a bit of the PLC is as it is: the chains that write it, followed back to inputs, timers and words.
//!
//! The values are those after the last scan. A bit that one scan writes in several chains is followed through them, from
//! the last to the first. What depends on jumps, brackets or an index is where the way ends.

use std::collections::{HashMap, HashSet};

use bahn_exchange::{Bit, BitArea, Image};
use bahn_plc::{Access, Comparison, Gate, Instruction, Op, PlcProgram, Subject, Transform, Value, accesses};

/// Chains that are followed one after the other.
const DEPTH: usize = 16;
/// Ends that are named at most.
const CAUSES: usize = 4;
/// Instructions that a chain has at most.
const CHAIN: usize = 64;

/// Where the way back ends: what is as it should not be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Cause {
    /// A bit has this value.
    Bit(Bit, bool),
    /// A comparison, as `W112 == 20`, holds or does not.
    Compare(String, bool),
}

/// Which instructions write to a bit, by their places in the code; those with an index are not among them.
#[derive(Debug, Default)]
pub(crate) struct Writers(HashMap<Bit, Vec<usize>>);

impl Writers {
    /// Finds where a program writes each operand.
    pub fn of(program: &PlcProgram) -> Writers {
        let mut writers = Writers::default();
        for (place, instruction) in program.code.iter().enumerate() {
            for (subject, access) in accesses(&instruction.op) {
                if let (Subject::Bit { bit, indexed: false }, Access::Assign | Access::Change) =
                    (subject, access)
                {
                    writers.0.entry(bit).or_default().push(place);
                }
            }
        }
        writers
    }
}

/// A program with the memory as it is now.
pub(crate) struct Trace<'a> {
    pub program: &'a PlcProgram,
    pub writers: &'a Writers,
    pub image: &'a Image,
}

/// What a chain reads.
#[derive(Clone, Debug)]
enum Source {
    Bit(Bit),
    Compare(String, Option<bool>),
}

struct Term {
    gate: Option<Gate>,
    invert: bool,
    source: Source,
}

impl Trace<'_> {
    /// The instructions that write to a bit, before a place.
    fn written(&self, bit: Bit, before: usize) -> impl DoubleEndedIterator<Item = (usize, &Instruction)> {
        let places = self.writers.0.get(&bit).into_iter().flatten().copied();
        let places = places.filter(move |place| *place < before);
        places.filter_map(|place| Some((place, self.program.code.get(place)?)))
    }

    /// The lines that write to a bit, as `MAIN.PLC:42`; `only` those that can make it so.
    pub fn lines(&self, bit: Bit, only: Option<bool>) -> Vec<String> {
        let can = |op: &Op| match (op, only) {
            (Op::SetBit { value, .. }, Some(wanted)) => *value == wanted,
            _ => true,
        };
        let all = self.written(bit, usize::MAX);
        all.filter(|(_, instruction)| can(&instruction.op))
            .map(|(_, instruction)| self.program.place(instruction))
            .collect()
    }

    /// What keeps a bit from being as it is wanted; nothing when it is, or nobody knows.
    pub fn causes(&self, bit: Bit, wanted: bool) -> Vec<Cause> {
        let mut found = Vec::new();
        let mut seen = HashSet::new();
        self.follow(bit, wanted, self.program.code.len(), DEPTH, &mut seen, &mut found);
        found.retain(|cause| *cause != Cause::Bit(bit, !wanted));
        // What comes from outside tells more than what the program holds for itself.
        let outside = |cause: &Cause| matches!(cause, Cause::Bit(bit, _) if bit.area() != BitArea::M);
        if found.iter().any(outside) {
            found.retain(outside);
        }
        found.truncate(CAUSES);
        found
    }

    fn follow(
        &self,
        bit: Bit,
        wanted: bool,
        before: usize,
        depth: usize,
        seen: &mut HashSet<(Bit, usize)>,
        found: &mut Vec<Cause>,
    ) {
        let end = Cause::Bit(bit, !wanted);
        let writer = self.decisive(bit, wanted, before);
        let Some((place, needed)) = writer.filter(|_| depth > 0) else {
            if !found.contains(&end) {
                found.push(end);
            }
            return;
        };
        if !seen.insert((bit, place)) {
            return;
        }
        let terms = self.chain(place);
        let culprits = self.culprits(&terms, bit, place, needed);
        if culprits.is_empty() && !found.contains(&end) {
            found.push(end);
        }
        for (term, value) in culprits {
            match &term.source {
                Source::Bit(other) => {
                    let limit = if *other == bit {
                        place
                    } else {
                        self.program.code.len()
                    };
                    self.follow(*other, !value, limit, depth - 1, seen, found);
                }
                Source::Compare(text, _) => {
                    let cause = Cause::Compare(text.clone(), value);
                    if !found.contains(&cause) {
                        found.push(cause);
                    }
                }
            }
        }
    }

    /// The instruction that decides that a bit is not as wanted, among those before a place, and what the logic
    /// accumulator would have to be there.
    fn decisive(&self, bit: Bit, wanted: bool, before: usize) -> Option<(usize, bool)> {
        let own: Vec<(usize, &Instruction)> = self.written(bit, before).collect();
        let plain = |operand: &bahn_plc::BitOperand| !operand.indexed;
        for (place, instruction) in own.iter().rev() {
            match &instruction.op {
                Op::AssignBit { bit: operand, invert } if plain(operand) => {
                    return Some((*place, wanted ^ invert));
                }
                // What holds it where it is not wanted now.
                Op::SetBit {
                    bit: operand,
                    value,
                    when,
                } if plain(operand) && *value != wanted => {
                    let terms = self.chain(*place);
                    if !terms.is_empty() && self.result(&terms, bit, *place) == Some(*when) {
                        return Some((*place, !when));
                    }
                }
                _ => {}
            }
        }
        let setter = own
            .iter()
            .rev()
            .find_map(|(place, instruction)| match &instruction.op {
                Op::SetBit {
                    bit: operand,
                    value,
                    when,
                } if plain(operand) && *value == wanted => Some((*place, *when)),
                _ => None,
            });
        setter.filter(|(place, _)| !self.chain(*place).is_empty())
    }

    /// The terms whose logic result a place uses, the first one first; empty when it is more than a plain chain.
    fn chain(&self, place: usize) -> Vec<Term> {
        let mut terms = Vec::new();
        let mut at = place;
        for _ in 0..CHAIN {
            let Some(earlier) = at.checked_sub(1) else {
                return Vec::new();
            };
            at = earlier;
            let Some(instruction) = self.program.code.get(at) else {
                return Vec::new();
            };
            match &instruction.op {
                Op::LoadBit { bit, invert } if !bit.indexed => {
                    terms.push(Term {
                        gate: None,
                        invert: *invert,
                        source: Source::Bit(bit.bit),
                    });
                    terms.reverse();
                    return terms;
                }
                Op::GateBit { gate, bit } if !bit.indexed => terms.push(Term {
                    gate: Some(*gate),
                    invert: false,
                    source: Source::Bit(bit.bit),
                }),
                Op::Compare { comparison, value } => {
                    terms.push(Term {
                        gate: None,
                        invert: false,
                        source: self.comparison(at, *comparison, *value),
                    });
                    terms.reverse();
                    return terms;
                }
                // They leave the logic accumulator as it is. A structure runs on what stands before it.
                Op::AssignBit { .. } | Op::SetBit { .. } | Op::Load { .. } | Op::Assign { .. } => {}
                _ => return Vec::new(),
            }
        }
        Vec::new()
    }

    /// `W112 == 20`, of a plain load before it.
    fn comparison(&self, at: usize, comparison: Comparison, value: Value) -> Source {
        let left = at.checked_sub(1).and_then(|at| self.program.code.get(at));
        let sign = match comparison {
            Comparison::Equal => "==",
            Comparison::Less => "<",
            Comparison::Greater => ">",
            Comparison::LessEqual => "<=",
            Comparison::GreaterEqual => ">=",
            Comparison::NotEqual => "<>",
        };
        let content = |value: Value| match value {
            Value::Constant(constant) => Some((constant.to_string(), constant)),
            Value::Number(number) if !number.indexed => {
                Some((number.number.to_string(), self.image.number(number.number)))
            }
            Value::Number(_) => None,
        };
        let left = match left.map(|left| &left.op) {
            Some(Op::Load {
                value,
                transform: Transform::Plain,
            }) => content(*value),
            _ => None,
        };
        match (left, content(value)) {
            (Some((name, left)), Some((other, right))) => {
                let holds = match comparison {
                    Comparison::Equal => left == right,
                    Comparison::Less => left < right,
                    Comparison::Greater => left > right,
                    Comparison::LessEqual => left <= right,
                    Comparison::GreaterEqual => left >= right,
                    Comparison::NotEqual => left != right,
                };
                Source::Compare(format!("{name} {sign} {other}"), Some(holds))
            }
            _ => Source::Compare(sign.to_owned(), None),
        }
    }

    /// The value of a term's operand for the chain that writes `own` at a place.
    fn value(&self, term: &Term, own: Bit, place: usize) -> Option<bool> {
        match &term.source {
            // Its own value is that of the chains before it in the scan.
            Source::Bit(bit) if *bit == own => Some(self.earlier(own, place, DEPTH)),
            Source::Bit(bit) => Some(self.image.bit(*bit)),
            Source::Compare(_, holds) => *holds,
        }
    }

    /// What a bit was in the scan before a place.
    fn earlier(&self, bit: Bit, before: usize, depth: usize) -> bool {
        let last = self.written(bit, before).next_back();
        let Some((place, instruction)) = last.filter(|_| depth > 0) else {
            return self.image.bit(bit);
        };
        let terms = self.chain(place);
        let values: Option<Vec<bool>> = terms
            .iter()
            .map(|term| match &term.source {
                Source::Bit(other) if *other == bit => Some(self.earlier(bit, place, depth - 1)),
                Source::Bit(other) => Some(self.image.bit(*other)),
                Source::Compare(_, holds) => *holds,
            })
            .collect();
        let result = values
            .filter(|_| !terms.is_empty())
            .map(|values| combine(&terms, &values));
        match (&instruction.op, result) {
            (Op::AssignBit { invert, .. }, Some(result)) => result ^ invert,
            (Op::SetBit { value, when, .. }, Some(result)) if result == *when => *value,
            (Op::SetBit { .. }, Some(_)) => self.earlier(bit, place, depth - 1),
            _ => self.image.bit(bit),
        }
    }

    fn result(&self, terms: &[Term], own: Bit, place: usize) -> Option<bool> {
        let values: Option<Vec<bool>> = terms.iter().map(|term| self.value(term, own, place)).collect();
        values.map(|values| combine(terms, &values))
    }

    /// The terms that keep a chain from the result that is needed, with their values: those that alone would change
    /// it; when none does, all that speak against it.
    fn culprits<'t>(&self, terms: &'t [Term], own: Bit, place: usize, needed: bool) -> Vec<(&'t Term, bool)> {
        let values: Option<Vec<bool>> = terms.iter().map(|term| self.value(term, own, place)).collect();
        let Some(values) = values.filter(|values| !values.is_empty()) else {
            return Vec::new();
        };
        if combine(terms, &values) == needed {
            return Vec::new();
        }
        let turned = |at: usize| {
            let mut values = values.clone();
            if let Some(value) = values.get_mut(at) {
                *value = !*value;
            }
            combine(terms, &values)
        };
        let with_value = |at: usize| Some((terms.get(at)?, *values.get(at)?));
        let alone: Vec<_> = (0..terms.len())
            .filter(|at| turned(*at) == needed)
            .filter_map(with_value)
            .collect();
        // Each would do: what comes from the machine tells most.
        let is_input =
            |(term, _): &(&Term, bool)| matches!(&term.source, Source::Bit(bit) if bit.area() == BitArea::I);
        if alone.iter().any(is_input) {
            return alone.into_iter().filter(is_input).collect();
        }
        if !alone.is_empty() {
            return alone;
        }
        let against = |at: &usize| {
            let (Some(term), Some(value)) = (terms.get(*at), values.get(*at)) else {
                return false;
            };
            let inverted =
                term.invert || matches!(term.gate, Some(Gate::AndNot | Gate::OrNot | Gate::XorNot));
            (value ^ inverted) != needed
        };
        (0..terms.len()).filter(against).filter_map(with_value).collect()
    }
}

/// The logic accumulator after a chain.
fn combine(terms: &[Term], values: &[bool]) -> bool {
    let pairs = terms.iter().zip(values);
    pairs.fold(false, |logic, (term, value)| match term.gate {
        None => value ^ term.invert,
        Some(gate) => gate.bits(logic, *value),
    })
}

#[cfg(test)]
mod tests {
    use bahn_exchange::{Bit, Image};
    use bahn_plc::{Compilation, MemoryFiles, Options, PlcProgram};

    use super::*;

    fn program(text: &str) -> PlcProgram {
        let files = MemoryFiles::from([("MAIN.PLC", text)]);
        Compilation::compile(&files, "MAIN.PLC", Options::default())
            .program
            .unwrap()
    }

    fn bit(text: &str) -> Bit {
        text.parse().unwrap()
    }

    fn names(program: &PlcProgram, ones: &[&str], of: &str, wanted: bool) -> Vec<String> {
        let mut image = Image::default();
        for one in ones {
            image.set_bit(bit(one), true);
        }
        let trace = Trace {
            program,
            writers: &Writers::of(program),
            image: &image,
        };
        let causes = trace.causes(bit(of), wanted);
        let name = |cause: &Cause| match cause {
            Cause::Bit(bit, value) => format!("{bit}={}", u8::from(*value)),
            Cause::Compare(text, holds) => format!("{text}: {holds}"),
        };
        causes.iter().map(name).collect()
    }

    #[test]
    fn the_input_after_two_markers_is_found() {
        let program = program("L I1\nA I2\nO I3\n= M1\nL M1\nAN I4\n= M2451\nEM\n");
        assert_eq!(names(&program, &["I1"], "M2451", true), ["I2=0", "I3=0"]);
        assert_eq!(
            names(&program, &["I1", "I2", "I4", "M1"], "M2451", true),
            ["I4=1"]
        );
        // Two contacts of a chain of three are open: neither alone is to blame.
        let program = self::program("L I1\nA I2\nA I3\n= M1\nEM\n");
        assert_eq!(names(&program, &["I3"], "M1", true), ["I1=0", "I2=0"]);
    }

    #[test]
    fn chains_of_one_scan_are_followed_from_the_last_to_the_first() {
        // An acknowledgement that is set when nothing is to be done any more.
        let text = "L M1903\n= M46\nL I10\n=N M44\nL M46\nA M44\n= M44\nL M1910\nA I15\nO M44\n= M44\nL M44\nSN M2482\nL \
                    M2045\nRN M2482\nEM\n";
        let program = program(text);
        let ones = ["M1903", "M46", "M44", "M2045"];
        assert_eq!(names(&program, &ones, "M2482", true), ["I10=0"]);
    }

    #[test]
    fn a_comparison_is_an_end() {
        let program = program("L W6\n== K+20\nA I1\n= M1\nEM\n");
        assert_eq!(names(&program, &["I1"], "M1", true), ["W6 == 20: false"]);
    }
}
