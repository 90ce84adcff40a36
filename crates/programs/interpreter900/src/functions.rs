//! M functions and tools of a block.
//!
//! Decision: An M function that no parameter defines and that the control does not know itself is refused at its block
//!
//! Decision: M functions of the control go out as they are defined; M6 without a definition goes out before the path and is
//! waited for. M0, M2, M30 without one go to nobody

use bahn_din::system900::{MFunction as Word, m_function};
use bahn_path::{At, Function, Synchronisation, TechnologyFunction, ToolCall, ToolShape};
use bahn_system900::{Acts, MFunction, Memory, ToolBlock, Value};

use crate::modal::Modal;
use crate::refusal::{Refusal, wrong};
use crate::words::Words;
use crate::writes::{Journal, Ordered, write};

/// What the M functions of a block do with the run at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Then {
    /// M0: stops the run.
    pub stops: bool,
    /// M2, M30
    pub ends: bool,
    /// M22: N of the block to jump to where the PLC says so.
    pub skips_to: Option<u32>,
    /// M24: N of the block, and how often.
    pub loops: Option<(u32, u32)>,
    /// A cycle is called.
    pub calls: Option<u16>,
    /// M26: P8715 ends the movement.
    pub is_cut: bool,
}

/// What M6 calls where it lies beside the program [002:1731-1735].
const TOOL_CYCLE: u16 = 6;

/// The way of its block may end before its end [002:3717-3727].
const RESIDUAL: u16 = 26;

/// Takes M functions. `has_tool_cycle` says whether Z6 lies beside the program, `block_of` which block has a number.
pub(crate) fn take_m(
    words: &Words,
    memory: &Memory,
    channel: u8,
    ordered: &mut Ordered,
    has_tool_cycle: bool,
    block_of: impl Fn(u32) -> Option<u32>,
) -> Result<Then, Refusal> {
    let mut then = Then::default();
    for word in &words.m {
        let Word {
            number,
            target,
            count,
        } = *word;
        let own = m_function(number).is_some();
        match number {
            0 => then.stops = true,
            1 => ordered.waits = true,
            2 | 30 => then.ends = true,
            22 => {
                then.skips_to = target;
                ordered.waits = true;
            }
            24 => then.loops = target.zip(count),
            RESIDUAL => then.is_cut = true,
            _ => {}
        }
        if number == TOOL_CYCLE && has_tool_cycle {
            then.calls = Some(TOOL_CYCLE);
            continue;
        }
        let defined = MFunction::of(memory, channel, number.min(bahn_system900::M_MAX));
        let is_defined = defined.bits != 0 && number <= bahn_system900::M_MAX;
        if !is_defined {
            if number == TOOL_CYCLE {
                ordered.at_start(Function::M(number), Synchronisation::MvsSvs);
            } else if !own {
                let parameter = &defined.parameter;
                return wrong(format!("M{number} is defined nowhere: {parameter}"));
            }
            continue;
        }
        ordered.waits |= defined.sync;
        match defined.acts {
            Acts::Branch => {
                let there = target.and_then(&block_of);
                let Some(there) = there else {
                    return wrong(format!(
                        "M{number} branches: it needs its target, as in M{number}.300"
                    ));
                };
                let function = Function::Branch {
                    m: number,
                    target: there,
                };
                ordered.at_start(function, Synchronisation::MvsSns);
            }
            Acts::Cycle if target.is_some() => {
                return wrong(format!("M{number} calls a cycle: it takes no extension"));
            }
            Acts::Cycle => match then.calls {
                None => then.calls = Some(number),
                Some(other) => return wrong(format!("M{number} beside a call of Z{other}")),
            },
            Acts::None | Acts::Flying | Acts::Stop => out(number, &defined, ordered),
        }
    }
    if then.is_cut {
        cut(&then, ordered)?;
    }
    Ok(then)
}

/// M26: the block may end early, so nothing after it is read until it is over, and nothing waits for its end.
fn cut(then: &Then, ordered: &mut Ordered) -> Result<(), Refusal> {
    if ordered.functions.iter().any(|function| function.at == At::End) {
        return wrong("M26 beside an M function that goes out after the path");
    }
    if then.calls.is_some() || then.stops || then.ends || then.loops.is_some() || then.skips_to.is_some() {
        return wrong("M26 beside what ends, repeats or leaves its block");
    }
    ordered.at_start(Function::Residual, Synchronisation::Mos);
    ordered.waits = true;
    Ok(())
}

fn out(number: u16, defined: &MFunction, ordered: &mut Ordered) {
    let stops = defined.acts == Acts::Stop;
    let pick = |waits, flies| if stops { waits } else { flies };
    if defined.before {
        let synchronisation = pick(Synchronisation::MvsSvs, Synchronisation::Mos);
        ordered.at_start(Function::M(number), synchronisation);
    }
    if defined.after {
        let synchronisation = pick(Synchronisation::MnsSns, Synchronisation::Mos);
        let function = TechnologyFunction::new(Function::M(number), At::End, synchronisation);
        ordered.functions.push(function);
    }
}

/// Takes T, with the data of the tool as 16.4 of the decisions has them: in look-ahead those for the PLC, with M6 or M16 those
/// that the path is computed with, the others when the block is executed. Whether the shifts have changed.
pub(crate) fn take_tool(
    words: &Words,
    modal: &Modal,
    memory: &mut Memory,
    channel: u8,
    mut journal: Option<&mut Journal>,
    ordered: &mut Ordered,
) -> Result<bool, Refusal> {
    let Some(group) = words.tool else {
        return Ok(false);
    };
    let has = |m: u16| words.m.iter().any(|word| word.number == m);
    let change = if has(6) {
        6
    } else if has(16) {
        16
    } else {
        0
    };
    let data = memory.path_data(channel);
    let record = data.spindle_record(group).or_else(|| data.tool_record(group));
    let Some(record) = record else {
        return wrong(format!(
            "T{group}: no tool of the channel has this group, q175 to q178"
        ));
    };
    let (said, shown) = (data.tool_m_function(), data.tool_group());
    let later = data.real_time_tool(record);
    let change_value = Value::Decimal {
        digits: change,
        decimals: 0,
    };
    write(memory, journal.as_deref_mut(), said, change_value)?;
    note(memory, channel, journal.as_deref_mut(), ToolBlock::Plc);
    memory.load_tool(channel, record.0, record.1, ToolBlock::Plc)?;
    if change != 0 {
        note(memory, channel, journal, ToolBlock::Offsetting);
        memory.load_tool(channel, record.0, record.1, ToolBlock::Offsetting)?;
    }
    ordered.write_later(memory, shown, Some(group))?;
    if change != 16 {
        for (q, value) in later {
            ordered.at_start(Function::Write { q, value }, Synchronisation::Mos);
        }
    }
    if change != 0 {
        let [length, radius] = memory.path_data(channel).offsets();
        let call = ToolCall {
            tool: group as u32,
            axis: modal.plane.normal,
            speed_rpm: modal.speeds[0],
            shape: ToolShape {
                length,
                radius,
                ..ToolShape::default()
            },
            at_end_of_life: false,
        };
        ordered.at_start(Function::Tool(call), Synchronisation::Mos);
    }
    Ok(change != 0)
}

/// Keeps what a block of tool data holds before it is loaded.
fn note(memory: &Memory, channel: u8, journal: Option<&mut Journal>, block: ToolBlock) {
    if let Some(journal) = journal {
        journal.extend(memory.tool_block(channel, block));
    }
}
