//! What instructions do with operands.

use bahn_exchange::{Bit, BitArea, Number};

use crate::operand::{BitOperand, NumberOperand, TextOperand, Value};
use crate::program::{Instruction, Op, PlcProgram};

/// What an instruction does with an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Looks at it without changing it.
    Read,
    /// Sets it whatever the accumulator is.
    Assign,
    /// Sets, resets, counts or stores to it among others.
    Change,
}

/// An operand as a line names it; with `[X]` it may be any one of its memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs, reason = "the variants say what their fields are")]
pub enum Subject {
    /// A marker, input, output, timer or counter.
    Bit { bit: Bit, indexed: bool },
    /// A byte, word or doubleword.
    Number { number: Number, indexed: bool },
    /// One of the strings S0 to S3.
    Text { string: u8, indexed: bool },
}

/// A kind of memory with addresses of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// Bits of an area: M, I, O, T or C.
    Bits(BitArea),
    /// What B, W and D share.
    Bytes,
    /// The strings S0 to S3.
    Texts,
}

/// Strings S0 to S3.
const STRINGS: u16 = bahn_exchange::STRINGS as u16;
/// Bytes that B, W and D share [000:11571].
const BYTES: u16 = 1024;

impl Subject {
    /// The memory and the addresses in it that it may occupy.
    pub fn extent(self) -> (Memory, std::ops::Range<u16>) {
        match self {
            Subject::Bit { bit, indexed: false } => {
                (Memory::Bits(bit.area()), bit.number()..bit.number() + 1)
            }
            Subject::Bit { bit, indexed: true } => (Memory::Bits(bit.area()), 0..bit.area().last() + 1),
            Subject::Number {
                number,
                indexed: false,
            } => (
                Memory::Bytes,
                number.address()..number.address() + number.size().bytes(),
            ),
            Subject::Number { indexed: true, .. } => (Memory::Bytes, 0..BYTES),
            Subject::Text {
                string,
                indexed: false,
            } => (Memory::Texts, string.into()..u16::from(string) + 1),
            Subject::Text { indexed: true, .. } => (Memory::Texts, 0..STRINGS),
        }
    }

    /// Whether both may occupy the same memory.
    pub fn meets(self, other: Subject) -> bool {
        let ((memory, own), (other_memory, others)) = (self.extent(), other.extent());
        memory == other_memory && own.start < others.end && others.start < own.end
    }

    /// It is named with `[X]`.
    pub fn is_indexed(self) -> bool {
        let (Subject::Bit { indexed, .. } | Subject::Number { indexed, .. } | Subject::Text { indexed, .. }) =
            self;
        indexed
    }

    /// The letter of the kind.
    pub fn letter(self) -> char {
        match self {
            Subject::Bit { bit, .. } => bit.area().letter(),
            Subject::Number { number, .. } => number.size().letter(),
            Subject::Text { .. } => 'S',
        }
    }

    /// First and last operand that an indexed one may be, as `B0-B1023` [000:14012-14034].
    pub fn range(self) -> Option<String> {
        let last = match self {
            Subject::Bit { bit, .. } => bit.area().last(),
            Subject::Number { number, .. } => BYTES - number.size().bytes(),
            Subject::Text { .. } => STRINGS - 1,
        };
        let letter = self.letter();
        self.is_indexed().then(|| format!("{letter}0-{letter}{last}"))
    }
}

impl std::fmt::Display for Subject {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Subject::Bit { bit, .. } => bit.fmt(f)?,
            Subject::Number { number, .. } => number.fmt(f)?,
            Subject::Text { string, .. } => write!(f, "S{string}")?,
        }
        f.write_str(if self.is_indexed() { "[X]" } else { "" })
    }
}

impl From<BitOperand> for Subject {
    fn from(operand: BitOperand) -> Subject {
        Subject::Bit {
            bit: operand.bit,
            indexed: operand.indexed,
        }
    }
}

impl From<NumberOperand> for Subject {
    fn from(operand: NumberOperand) -> Subject {
        Subject::Number {
            number: operand.number,
            indexed: operand.indexed,
        }
    }
}

/// What an instruction names in its line.
#[derive(Clone, Copy)]
pub(crate) enum Named<'a> {
    /// A bit that is read, set or counted.
    Bit(BitOperand),
    /// So many bits, one after the other.
    Bits(BitOperand, u8),
    /// A byte, word, doubleword or constant.
    Value(Value),
    /// A text that is read.
    Text(&'a TextOperand),
    /// A string that is written, and whether the index register is added to its number.
    String { string: u8, indexed: bool },
}

/// The operand of an instruction with what is done to it; what is counted is read before.
pub(crate) fn operand(op: &Op) -> Option<(Named<'_>, Access)> {
    use Access::{Assign, Change, Read};
    let number = |number: &NumberOperand| Named::Value(Value::Number(*number));
    let written = |string, indexed| Named::String { string, indexed };
    Some(match op {
        Op::LoadBit { bit, .. } | Op::GateBit { bit, .. } | Op::PushBit { bit } => (Named::Bit(*bit), Read),
        Op::AssignBit { bit, .. } => (Named::Bit(*bit), Assign),
        Op::SetBit { bit, .. } | Op::PullBit { bit } => (Named::Bit(*bit), Change),
        Op::LoadBits { first, count } => (Named::Bits(*first, *count), Read),
        Op::AssignBits { first, count } => (Named::Bits(*first, *count), Assign),
        Op::Load { value, .. }
        | Op::GateWord { value, .. }
        | Op::Arithmetic { value, .. }
        | Op::BitOperation { value, .. }
        | Op::TestBit { value }
        | Op::Compare { value, .. }
        | Op::Push { value } => (Named::Value(*value), Read),
        Op::Case { number: of, .. } | Op::Reply { number: of } | Op::Cancel { number: of } => {
            (number(of), Read)
        }
        Op::Assign { number: of, .. } => (number(of), Assign),
        Op::StepNumber { number: of, .. } | Op::Pull { number: of } => (number(of), Change),
        Op::LoadText { text } | Op::AppendText { text } | Op::CompareText { text, .. } => {
            (Named::Text(text), Read)
        }
        Op::AssignText { string, indexed } => (written(*string, *indexed), Assign),
        Op::OverwriteText { string, indexed } => (written(*string, *indexed), Change),
        _ => return None,
    })
}

/// The operands of an instruction.
pub fn accesses(op: &Op) -> Vec<(Subject, Access)> {
    let Some((named, access)) = operand(op) else {
        return Vec::new();
    };
    let text = |string, indexed| vec![Subject::Text { string, indexed }];
    let subjects = match named {
        Named::Bit(bit) => vec![bit.into()],
        Named::Bits(first, count) => bits(first, count),
        Named::Value(Value::Number(number)) => vec![number.into()],
        Named::Text(TextOperand::Memory { string, indexed }) => text(*string, *indexed),
        Named::Text(TextOperand::Part { string }) => text(*string, false),
        Named::String { string, indexed } => text(string, indexed),
        Named::Value(Value::Constant(_)) | Named::Text(_) => Vec::new(),
    };
    let reads_first = matches!(op, Op::StepNumber { .. });
    let of = |subject: Subject| {
        // Which of many operands is assigned is not known.
        let access = match access {
            Access::Assign if subject.is_indexed() => Access::Change,
            access => access,
        };
        let read = reads_first.then_some((subject, Access::Read));
        read.into_iter().chain([(subject, access)])
    };
    subjects.into_iter().flat_map(of).collect()
}

/// Consecutive bits; with an index they start anywhere.
fn bits(first: BitOperand, count: u8) -> Vec<Subject> {
    if first.indexed {
        return vec![first.into()];
    }
    (0..u16::from(count))
        .filter_map(|offset| Bit::new(first.bit.area(), first.bit.number().checked_add(offset)?))
        .map(|bit| Subject::Bit { bit, indexed: false })
        .collect()
}

impl PlcProgram {
    /// Where an instruction stands, as `MAIN.PLC:42`.
    pub fn place(&self, instruction: &Instruction) -> String {
        let file = self.files.get(usize::from(instruction.file));
        let name = file.map_or("", |file| file.name.as_str());
        format!("{name}:{}", instruction.line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operands_meet_where_they_share_memory() {
        let number = |text: &str, indexed| Subject::Number {
            number: text.parse().unwrap(),
            indexed,
        };
        let plain = |text| number(text, false);
        for (a, b, meet) in [
            ("D0", "W2", true),
            ("D0", "B3", true),
            ("D0", "W4", false),
            ("W2", "B1", false),
        ] {
            assert_eq!(plain(a).meets(plain(b)), meet, "{a} {b}");
            assert_eq!(plain(b).meets(plain(a)), meet, "{b} {a}");
        }
        assert!(number("B1000", true).meets(plain("D4")));
        assert_eq!(number("W8", true).range().as_deref(), Some("W0-W1022"));
        assert_eq!(number("D8", true).range().as_deref(), Some("D0-D1020"));
        let marker = Subject::Bit {
            bit: "M5".parse().unwrap(),
            indexed: true,
        };
        assert_eq!(
            (marker.to_string(), marker.range()),
            ("M5[X]".to_owned(), Some("M0-M3263".to_owned()))
        );
        assert!(!marker.meets(plain("B5")));
        assert_eq!(plain("B5").range(), None);
    }
}
