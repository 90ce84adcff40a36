//! TCH PROBE 31 and 32: the length and the radius of the tool in the spindle, measured with the tool probe, and 30, which
//! calibrates it
//! [000:7960-8058]. The manual leaves the blocks to the user's manual of these controls; they are those of their
//! successors (inferred):
//! `31.0 TOOL LENGTH`, `31.1 CHECK: 0` (1: compare; a Q parameter takes what was found), `31.2 HEIGHT: +100`,
//! `31.3 PROBING THE TEETH: 0` (1: each on its own); 32 is the radius; `30.0 TT CALIBRATION`, `30.1 HEIGHT: +100`.

use bahn_parameters::MessageId;
use bahn_path::{Barrier, MeasuredPart, ToolMeasuring};
use bahn_program::CycleBlock;

use crate::availability::{Feature, not_inhibited};
use crate::context::Context;
use crate::definition::{Resolved, resolve};
use crate::error::Fault;
use crate::modal::MeasuringBlocks;

/// The numbers of the cycles.
const CALIBRATION: u16 = 30;
const LENGTH: u16 = 31;
const RADIUS: u16 = 32;

/// Whether a probe function measures tools.
pub(crate) fn measures_tools(number: u16) -> bool {
    matches!(number, CALIBRATION | LENGTH | RADIUS)
}

/// A block of cycle 30, 31 or 32; the last one measures.
pub(crate) fn measure_tool(c: &mut Context<'_>, block: &CycleBlock) -> Result<(), Fault> {
    if !c.executes(Feature::Probe(block.number))? {
        return Ok(());
    }
    if block.sub == 0 {
        not_inhibited(block.number, c.settings)?;
    }
    let words = resolve(block, c.numbers, c.settings)?;
    let number = words.iter().find_map(|word| match word {
        Resolved::Number(number) => Some(*number),
        _ => None,
    });
    if block.sub == 0 {
        c.modal.measuring = Some(MeasuringBlocks {
            number: block.number,
            sub: 0,
            check: false,
            result: None,
            height: 0.0,
            teeth: false,
        });
        return Ok(());
    }
    let incomplete = |what: &str| {
        Fault::new(
            MessageId::CyclIncomplete,
            format!("TCH PROBE {}: {what}", block.number),
        )
    };
    let mut blocks = c.modal.measuring.take();
    let blocks = blocks
        .as_mut()
        .filter(|blocks| blocks.number == block.number && blocks.sub + 1 == block.sub)
        .ok_or_else(|| incomplete("a block is missing"))?;
    let number = number.ok_or_else(|| incomplete("a number is missing"))?;
    blocks.sub = block.sub;
    match block.sub {
        1 if block.number == CALIBRATION => {
            blocks.height = number * c.numbers.unit_mm;
            return start(c, *blocks);
        }
        _ if block.number == CALIBRATION => return Err(incomplete("there are two blocks")),
        1 => {
            blocks.check = yes_or_no(number, "CHECK is 0 or 1")?;
            blocks.result = words.iter().find_map(|word| match word {
                Resolved::Target(number) => Some(*number),
                _ => None,
            });
        }
        2 => blocks.height = number * c.numbers.unit_mm,
        3 => {
            blocks.teeth = yes_or_no(number, "PROBING THE TEETH is 0 or 1")?;
            return start(c, *blocks);
        }
        _ => return Err(incomplete("there are four blocks")),
    }
    c.modal.measuring = Some(*blocks);
    Ok(())
}

fn yes_or_no(number: f64, detail: &str) -> Result<bool, Fault> {
    match number {
        0.0 => Ok(false),
        1.0 => Ok(true),
        _ => Err(Fault::new(MessageId::EntryValueIncorrect, detail)),
    }
}

/// Everything before is executed, then the control measures.
fn start(c: &mut Context<'_>, blocks: MeasuringBlocks) -> Result<(), Fault> {
    c.pen.finish_contour()?;
    let tool = c.modal.tool.filter(|tool| tool.number != 0);
    let tool = tool.ok_or_else(|| Fault::new(MessageId::ToolNotDefined, "no tool is in the spindle"))?;
    let mut height = c.modal.frame.to_programmed(&c.modal.nominal);
    height[tool.axis] = blocks.height;
    c.pen.out.barrier(Barrier::MeasureTool(ToolMeasuring {
        block: c.pen.block,
        part: match blocks.number {
            CALIBRATION => MeasuredPart::Probe,
            RADIUS => MeasuredPart::Radius,
            _ => MeasuredPart::Length,
        },
        teeth: blocks.teeth,
        check: blocks.check,
        height: c.modal.frame.to_outer(&height)[tool.axis],
        result: blocks.result,
    }));
    c.modal.last_move = None;
    c.modal.stop_spindle(&mut c.numbers.q);
    c.pen.note_time();
    Ok(())
}
