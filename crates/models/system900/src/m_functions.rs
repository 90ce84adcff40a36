//! What the M functions of a channel do: a byte for each, four in a parameter [002:2049-2100] [002:5455-5530].
//!
//! Decision: Bit 5 is execution in the simulation of a restart, bit 6 the call of a cycle: they stand in the order of the
//! drawing. A function that calls a cycle does nothing else, as the manual says; neither does one that branches, which
//! goes out before the path and stops [002:5484-5501]
//!
//! Decision: A function whose number is not above 30 calls no cycle [002:5500], and one that goes out neither before nor
//! after the path does not stop it, since nothing acknowledges it

use std::fmt;

use serde::Serialize;

use crate::memory::Memory;
use crate::name::Name;
use crate::numbers::{M_BLOCK, M_OF_CHANNEL, M_OF_SYSTEM};

/// The highest M function [002:950-953].
pub const M_MAX: u16 = 999;
/// The highest one that the system may define.
const OF_SYSTEM_MAX: u16 = 199;
/// Functions up to it call no cycle [002:5500-5501].
const NO_CYCLE_MAX: u16 = 30;

const BEFORE: u8 = 1;
const AFTER: u8 = 1 << 1;
const STOP: u8 = 1 << 2;
const SYNC: u8 = 1 << 3;
const BRANCH: u8 = 1 << 4;
pub(crate) const RESTART: u8 = 1 << 5;
const CYCLE: u8 = 1 << 6;

/// How an M function acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// It does not go out.
    None,
    /// It goes out, and the program goes on.
    Flying,
    /// It goes out at an exact stop, and the program waits for its acknowledgement.
    Stop,
    /// It goes out before the path, which its acknowledgement ends for a branch.
    Branch,
    /// It calls the cycle of its number at the end of the block.
    Cycle,
}

impl Acts {
    /// As reports write it.
    pub fn id(self) -> &'static str {
        match self {
            Acts::None => "none",
            Acts::Flying => "flying",
            Acts::Stop => "stop",
            Acts::Branch => "branch",
            Acts::Cycle => "cycle",
        }
    }
}

impl Serialize for Acts {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

/// The definition of an M function.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MFunction {
    /// Its number.
    pub m: u16,
    /// The parameter that defines it.
    pub parameter: String,
    /// The byte of it, from 1 on.
    pub byte: u8,
    /// The byte itself.
    pub bits: u8,
    /// How it acts.
    pub acts: Acts,
    /// It acts before the path of its block.
    pub before: bool,
    /// It acts after the path of its block.
    pub after: bool,
    /// The look-ahead waits for it.
    pub sync: bool,
    /// It is executed in the simulation of a restart.
    pub restart: bool,
}

/// How an M function acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MRule {
    /// How.
    pub acts: Acts,
    /// Before the path of its block.
    pub before: bool,
    /// After it.
    pub after: bool,
    /// The look-ahead waits for it.
    pub sync: bool,
}

/// The number of an M function that somebody writes: `M7`, `m07`; `None` for others and above M999.
pub fn m_number(text: &str) -> Option<u16> {
    let digits = text.trim().strip_prefix(['M', 'm'])?;
    let all = digits.bytes().all(|digit| digit.is_ascii_digit());
    let number = digits.parse().ok().filter(|_| all);
    number.filter(|number| *number <= M_MAX)
}

impl MFunction {
    /// The definition that counts in a channel.
    pub fn of(memory: &Memory, channel: u8, m: u16) -> MFunction {
        let name = definition(memory, channel, m);
        let bits = bits_of(memory, channel, m);
        let rule = MFunction::rule(m, bits);
        MFunction {
            m,
            parameter: name.to_string(),
            byte: (m % 4) as u8 + 1,
            bits,
            acts: rule.acts,
            before: rule.before,
            after: rule.after,
            sync: rule.sync,
            restart: !matches!(rule.acts, Acts::Branch | Acts::Cycle) && bits & RESTART != 0,
        }
    }

    /// How a function acts whose definition is a byte.
    pub fn rule(m: u16, bits: u8) -> MRule {
        let acts = acts(m, bits);
        let goes_out = matches!(acts, Acts::Flying | Acts::Stop);
        let is_alone = matches!(acts, Acts::Branch | Acts::Cycle);
        let has = |bit: u8| bits & bit != 0;
        MRule {
            acts,
            before: acts == Acts::Branch || goes_out && has(BEFORE),
            after: acts == Acts::Cycle || goes_out && has(AFTER),
            sync: !is_alone && has(SYNC),
        }
    }

    /// All that a channel defines.
    pub fn defined(memory: &Memory, channel: u8) -> Vec<MFunction> {
        let all = (0..=M_MAX).map(|m| MFunction::of(memory, channel, m));
        all.filter(|function| function.bits != 0).collect()
    }

    /// What of its bits does not go together, in words.
    pub fn doubt(&self) -> Option<String> {
        let has = |bits: u8| self.bits & bits != 0;
        let m = self.m;
        match self.acts {
            Acts::Cycle if has(!CYCLE) => Some(format!("M{m} calls a cycle: its other bits do not count")),
            Acts::Branch if has(!(BRANCH | STOP | BEFORE)) => {
                Some(format!("M{m} branches: its other bits do not count"))
            }
            Acts::Cycle | Acts::Branch => None,
            _ if has(CYCLE) => Some(format!(
                "M{m} calls no cycle: only numbers above {NO_CYCLE_MAX} do"
            )),
            Acts::None if has(STOP) => Some(format!(
                "M{m} does not stop: it goes out neither before nor after the path"
            )),
            _ => None,
        }
    }
}

/// The parameter that defines a function of a channel.
fn definition(memory: &Memory, channel: u8, m: u16) -> Name {
    let own = memory.descriptor(channel).entry(M_BLOCK).whole().unwrap_or(0);
    let quarter = u32::from(m / 4);
    let number = match own == 0 && m <= OF_SYSTEM_MAX {
        true => M_OF_SYSTEM + quarter,
        false => M_OF_CHANNEL + quarter,
    };
    // Those of the system belong to no channel.
    let owner = if number >= M_OF_SYSTEM { 1 } else { channel };
    Name::P(owner, number)
}

/// The byte that defines a function of a channel.
pub(crate) fn bits_of(memory: &Memory, channel: u8, m: u16) -> u8 {
    let cell = memory.cell(definition(memory, channel, m)).ok();
    let bytes = cell.and_then(|cell| cell.bits()).unwrap_or(0).to_le_bytes();
    bytes.get(usize::from(m % 4)).copied().unwrap_or(0)
}

fn acts(m: u16, bits: u8) -> Acts {
    match bits {
        bits if bits & CYCLE != 0 && m > NO_CYCLE_MAX => Acts::Cycle,
        bits if bits & BRANCH != 0 => Acts::Branch,
        bits if bits & (BEFORE | AFTER) == 0 => Acts::None,
        bits if bits & STOP != 0 => Acts::Stop,
        _ => Acts::Flying,
    }
}

/// In a line.
impl fmt::Display for MFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let MFunction { m, byte, bits, .. } = self;
        let (parameter, acts) = (&self.parameter, self.acts.id());
        write!(f, "M{m:<4} {parameter} byte {byte} ${bits:02X}  {acts}")?;
        let when = [
            (self.before, " before the path"),
            (self.after, " after the path"),
            (self.sync, ", the look-ahead waits"),
            (self.restart, ", also in the simulation of a restart"),
        ];
        for (_, word) in when.iter().filter(|(is_so, _)| *is_so) {
            f.write_str(word)?;
        }
        Ok(())
    }
}
