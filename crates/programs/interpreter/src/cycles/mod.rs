//! Cycles: definition, call, and what each does.
//!
//! Definitions are collected block by block. Cycles 7-11, 13, 14, 19, 20 and 26 act when they are defined, the
//! others when they are called [003:4849-4857].
//!
//! Decision: The definition of a cycle that is called ends M89; one that acts at once, as a datum shift, leaves it.
//! The list of the TNC 360 says "a new cycle definition" [003:4877-4881] after the two kinds of cycles that it has
//! just told apart [003:4846-4860]; the TNC 415 names none at all and calls the last-programmed machining cycle
//! [000:7274], which a datum shift is not
//!
//! Decision: CYCL CALL, M99 and M89 machine nothing where the only cycle that was defined is a macro of a TNC 151/155 that has
//! run at its definition (DLG-DEF): the program that the manual prints calls it after that, and makes its holes once
//! [001:2853-2869] [001:3067-3080]

mod contour_cycle;
mod contour_data;
mod contour_finish;
mod contour_pocket;
mod contour_train;
mod cylinder;
mod drilling;
mod machining;
mod pockets;
mod transformation;

use bahn_parameters::MessageId;
use bahn_program::{CycleBlock, CycleFunction, CycleWord, Value, cycle};

pub(crate) use self::contour_cycle::contour_cycle;
pub(crate) use self::contour_data::CYLINDER_SURFACE;
pub(crate) use self::contour_pocket::{ContourJob, Halt, Watch, contour_plane};
pub(crate) use self::cylinder::take_surface;
use self::drilling::{pecking, rigid_tapping, tapping, thread_cutting};
use self::machining::Machining;
use self::pockets::{circular_pocket, pocket_milling, slot_milling};
use self::transformation::{
    axis_scaling, contour_geometry, datum_shift, dwell, mirror_image, rotation, scaling, spindle_orientation,
};
use crate::availability::{Feature, names_datum_table, not_inhibited, words};
use crate::context::Context;
use crate::definition::{Definition, OEM_CYCLES, Resolved, is_contour_cycle, resolve};
use crate::error::{Cause, Fault};
use crate::flow::Flow;
use crate::settings::Settings;
use crate::tilting::{geometry, working_plane, works_as_defined};

/// One block of a cycle definition.
pub(crate) fn define_cycle(c: &mut Context<'_>, block: &CycleBlock) -> Result<Flow, Fault> {
    if block.sub == 0 {
        not_inhibited(block.number, c.settings)?;
    }
    let feature = Feature::Cycle(block.number);
    if OEM_CYCLES.contains(&block.number) {
        return define_oem_cycle(c, block);
    }
    let acts_here = is_effective_at_definition(block.number);
    // A cycle that acts at its call is refused there, unless the control does not know it at all.
    let is_judged = acts_here || !is_known(block.number, c.settings);
    if is_judged && !c.executes(feature)? && acts_here {
        return Ok(Flow::Next);
    }
    if names_datum_table(block) && !c.executes(Feature::Word(words::DATUM_TABLE))? {
        return Ok(Flow::Next);
    }
    let words = resolve(block, c.numbers, c.settings)?;
    if contour_data::is_assigned(block.number) {
        contour_data::assign(c.numbers, &words)?;
    }
    if block.number == contour_data::CONTOUR_DATA {
        let unit_mm = c.numbers.unit_mm;
        c.modal
            .cycle
            .contour_data
            .take(block.number, block.sub, words, unit_mm, c.pen.block);
        return Ok(Flow::Next);
    }
    if acts_here {
        define_effective(c, block, words)?;
        return Ok(Flow::Next);
    }
    // A new definition ends M89 [003:4875-4881].
    if block.sub == 0 {
        c.modal.cycle_after_each_block = false;
    }
    c.modal
        .cycle
        .machining
        .take(block.number, block.sub, words, c.numbers.unit_mm, c.pen.block);
    Ok(Flow::Next)
}

/// A block of the definition of a machine builder's cycle; where it goes on is for who knows its program.
fn define_oem_cycle(c: &mut Context<'_>, block: &CycleBlock) -> Result<Flow, Fault> {
    if !c.executes(Feature::Cycle(block.number))? {
        return Ok(Flow::Next);
    }
    let words = resolve(block, c.numbers, c.settings)?;
    contour_data::assign(c.numbers, &words)?;
    let unit_mm = c.numbers.unit_mm;
    let at = c.pen.block;
    c.modal
        .cycle
        .oem
        .take(block.number, block.sub, words, unit_mm, at);
    Ok(Flow::OemDefinition(block.number, block.sub))
}

fn define_effective(c: &mut Context<'_>, block: &CycleBlock, words: Vec<Resolved>) -> Result<(), Fault> {
    c.modal
        .cycle
        .effective
        .take(block.number, block.sub, words, c.numbers.unit_mm, c.pen.block);
    if block.sub == 0 {
        return Ok(());
    }
    let Some(definition) = c.modal.cycle.effective.ready() else {
        return Err(Fault::new(
            MessageId::CyclIncomplete,
            "blocks of the cycle are missing or out of order",
        ));
    };
    let words = definition.block(block.sub).to_vec();
    let acts = match block.number {
        7 => datum_shift(c, &words),
        8 => mirror_image(c.modal, &words),
        9 => dwell(c.modal, c.pen, &words, c.settings),
        10 => rotation(c.modal, &words, has_q_parameter(block), c.settings),
        11 => scaling(c.modal, &words, c.settings),
        13 => spindle_orientation(c, &words),
        26 => axis_scaling(c, &words),
        19 => working_plane(c, &words),
        _ => contour_geometry(c.modal, &words, c.settings),
    };
    if acts.is_err() {
        // The run may try the block again.
        c.modal.cycle.effective.take_back();
    }
    acts
}

/// The only cycle that was defined is a macro of a TNC 151/155 that has run at its definition: the printed program calls it all the
/// same [001:3067-3080].
fn has_run_at_definition(c: &Context<'_>) -> bool {
    let old = c.settings.model.limits().has_old_numbers();
    let cycle = &c.modal.cycle;
    old && cycle.machining.is_empty() && cycle.oem.ready().is_some()
}

/// CYCL CALL, M99 or M89: runs the last defined machining cycle [003:4857-4881].
pub(crate) fn call_cycle(c: &mut Context<'_>) -> Result<Flow, Fault> {
    if has_run_at_definition(c) {
        return Ok(Flow::Next);
    }
    let Some(definition) = c.modal.cycle.machining.ready().cloned() else {
        let cause = match c.modal.cycle.machining.is_empty() {
            true => Cause::NoCycle,
            false => Cause::Message,
        };
        return Err(Fault::new(MessageId::CyclIncomplete, "no complete cycle is defined").because(cause));
    };
    if !c.executes(Feature::Cycle(definition.number))? {
        return Ok(Flow::Next);
    }
    if definition.number == 12 {
        return called_program(&definition);
    }
    if definition.number == CYLINDER_SURFACE && !c.pen.rehearsal && geometry(c, "CYCL DEF 27")?.is_none() {
        return Ok(Flow::Next);
    }
    works_as_defined(c)?;
    c.pen.finish_contour()?;
    let mut m = Machining::new(c);
    match definition.number {
        1 => pecking(&mut m, &definition)?,
        2 => tapping(&mut m, &definition)?,
        3 => slot_milling(&mut m, &definition)?,
        4 => pocket_milling(&mut m, &definition)?,
        5 => circular_pocket(&mut m, &definition)?,
        number if OEM_CYCLES.contains(&number) => return Ok(Flow::OemCall(number)),
        number if is_contour_cycle(number) => {
            contour_data::check(c.modal, &definition)?;
            if contour_data::reciprocates(&definition) {
                c.without_effect(format!(
                    "cycle {number}: Q19, the tool reaches the floor straight down"
                ))?;
            }
            return Ok(Flow::ContourCycle);
        }
        17 => rigid_tapping(&mut m, &definition)?,
        18 => thread_cutting(&mut m, &definition)?,
        number => {
            let detail = format!("cycle {number} is read but not executed by this control");
            return Err(Fault::new(MessageId::BlockNotKnown, detail));
        }
    }
    Ok(Flow::Next)
}

/// Number of another tool whose radius a contour cycle needs.
pub(crate) fn other_tool(c: &Context<'_>) -> Result<Option<f64>, Fault> {
    let values = contour_data::Values {
        numbers: c.numbers,
        settings: c.settings,
    };
    match c.modal.cycle.machining.ready() {
        Some(definition) => values.other_tool(definition),
        None => Ok(None),
    }
}

/// Cycle 12: the called program is what the cycle call runs [003:6476-6490].
fn called_program(definition: &Definition) -> Result<Flow, Fault> {
    let name: Vec<String> = definition.block(1).iter().filter_map(Resolved::as_name).collect();
    // `PGM 50` and `50` name the same program.
    let name = match &name[..] {
        [word, rest @ ..] if !rest.is_empty() && word.eq_ignore_ascii_case("PGM") => rest.join(" "),
        words => words.join(" "),
    };
    if name.is_empty() {
        return Err(Fault::new(MessageId::CyclIncomplete, "cycle 12 names no program"));
    }
    Ok(Flow::CallProgram(name.into()))
}

fn has_q_parameter(block: &CycleBlock) -> bool {
    block
        .words
        .iter()
        .any(|word| matches!(word, CycleWord::Number(Value::Q { .. })))
}

fn is_known(number: u16, settings: &Settings) -> bool {
    settings.model.limits().has_cycle(u32::from(number))
}

fn is_effective_at_definition(number: u16) -> bool {
    cycle(CycleFunction::Definition, number).is_some_and(|cycle| cycle.acts_at_definition)
}
