//! The execution of one block: which part of the run does what it says.

use bahn_parameters::conformance::Kind;
use bahn_parameters::equipment::Use;
use bahn_parameters::{MessageId, technology};
use bahn_path::Function;
use bahn_program::{
    Compensation, Dialog, Expression, Feed, InvalidBlock, ModalBlock, Modality, Motion, MotionKind,
    Operation, PathFunction, Value,
};

use crate::availability::{Feature, words};
use crate::blank::{blank_max, blank_min};
use crate::context::Context;
use crate::contour::rounding::{Join, JoinKind};
use crate::cycles::{call_cycle, define_cycle};
use crate::error::{Cause, Fault, Message, WarningKind};
use crate::flow::Flow;
use crate::functions::take_m_functions;
use crate::path_functions::circle_centre;
use crate::positioning::{positioning, take_compensation, take_feed};
use crate::probe::probe;
use crate::q_parameters::QTable;
use crate::run::Run;
use crate::settings::Settings;
use crate::tool_measuring::{measure_tool, measures_tools};
use crate::tools::set_tool_axis;
use crate::unrolled::unrolled_words;

/// Executes what a block says. The caller has already passed over skipped blocks.
#[inline]
pub(crate) fn execute(run: &mut Run, operation: &Operation, settings: &Settings) -> Result<Flow, Fault> {
    match operation {
        Operation::Motion(motion) if let Some(modality) = &motion.modal => {
            execute_motion(run, motion, modality, settings)
        }
        Operation::Motion(motion) => match positioning(run.context(settings), motion)? {
            (Flow::Next, true) => call_cycle(&mut run.context(settings)),
            (flow, _) => Ok(flow),
        },
        Operation::Calculate {
            function,
            target,
            a,
            b,
        } => {
            let value = run.numbers.q.calculate(*function, *a, *b)?;
            run.numbers.q.set(*target, value)?;
            Ok(Flow::Next)
        }
        Operation::Jump {
            condition,
            a,
            b,
            label,
        } => Ok(if run.numbers.q.holds(*condition, *a, *b)? {
            Flow::Jump(*label)
        } else {
            Flow::Next
        }),
        Operation::Label(0) => Ok(Flow::Return),
        Operation::Label(label) if u32::from(*label) > settings.model.limits().label_max => {
            let detail = format!("labels are 1 to {}", settings.model.limits().label_max);
            Err(Fault::new(MessageId::EntryValueIncorrect, detail))
        }
        Operation::Label(_) | Operation::Comment(_) | Operation::Begin(_) => Ok(Flow::Next),
        other => execute_rare(run, other, settings),
    }
}

fn execute_rare(run: &mut Run, operation: &Operation, settings: &Settings) -> Result<Flow, Fault> {
    let (mut c, tools, blank) = run.parts(settings);
    let c = &mut c;
    match operation {
        Operation::End(_) => return Ok(Flow::EndOfProgram),
        Operation::Formula { target, expression } => {
            formula(&mut c.numbers.q, *target, expression, settings)?;
        }
        Operation::CallLabel { label, repeats } => {
            return call_label(&c.numbers.q, *label, *repeats, settings);
        }
        Operation::CallProgram(name) => return Ok(Flow::CallProgram(name.clone())),
        Operation::CircleCentre(coordinates) => {
            let coordinates = unrolled_words(c, coordinates)?;
            circle_centre(c.modal, c.numbers, &coordinates)?;
        }
        Operation::Rounding { radius, feed } => rounding(c, *radius, *feed)?,
        Operation::Chamfer { length, feed } => chamfer(c, *length, *feed)?,
        Operation::BlankMin(coordinates, axis) => blank_min(c.modal, c.numbers, coordinates, *axis)?,
        Operation::BlankMax(coordinates) => blank_max(c, blank, coordinates)?,
        Operation::ToolDefinition { tool, length, radius } => {
            tools.define(c, *tool, *length, *radius)?;
        }
        Operation::ToolCall {
            tool,
            axis,
            speed,
            delta_length,
            delta_radius,
        } => {
            let oversize = [*delta_length, *delta_radius];
            tools.call(c, blank.as_ref(), *tool, *axis, *speed, oversize)?;
        }
        Operation::Stop(m) => {
            let mut functions = take_m_functions(c, m)?;
            functions.stop = true;
            functions.cycle_call = false;
            return c.pen.hold(c.modal, functions);
        }
        Operation::Miscellaneous(m) => {
            let functions = take_m_functions(c, m)?;
            let flow = c.pen.hold(c.modal, functions)?;
            return if m.contains(99) { call_cycle(c) } else { Ok(flow) };
        }
        Operation::ErrorNumber(number) => return Err(numbered_error(&c.numbers.q, *number, settings)),
        Operation::Print(items) => print(c, items)?,
        Operation::Plc { a, b } => plc(c, *a, *b)?,
        Operation::Cycle(block) => return define_cycle(c, block),
        Operation::CycleCall(m) => {
            // CYCL CALL ends M89 [003:4875-4881].
            c.modal.cycle_after_each_block = false;
            let mut functions = take_m_functions(c, m)?;
            functions.cycle_call = true;
            c.pen.hold(c.modal, functions)?;
            return call_cycle(c);
        }
        Operation::Probe(block) if measures_tools(block.number) => measure_tool(c, block)?,
        Operation::Probe(block) => {
            if let Some(probing) = probe(c, block)? {
                run.probing = Some(probing);
            }
            if run.modal.digitizing.wanted.is_some() {
                return Ok(Flow::Scan);
            }
        }
        Operation::Dialog(dialog) if is_dialog(c, dialog)? => return Ok(Flow::Dialog),
        Operation::Dialog(_) => {}
        Operation::Modal(block) => return execute_block(run, block, settings),
        Operation::Invalid(invalid) => return unreadable(run, invalid, settings),
        Operation::Motion(_)
        | Operation::Calculate { .. }
        | Operation::Jump { .. }
        | Operation::Label(_)
        | Operation::Comment(_)
        | Operation::Begin(_) => {}
    }
    Ok(Flow::Next)
}

/// Whether a block DLG-DEF or DLG-CALL is executed here.
fn is_dialog(c: &mut Context<'_>, dialog: &Dialog) -> Result<bool, Fault> {
    c.executes(Feature::Word(if dialog.call {
        words::DIALOG_CALL
    } else {
        words::DIALOG_DEFINITION
    }))
}

fn formula(q: &mut QTable, target: u16, expression: &Expression, settings: &Settings) -> Result<(), Fault> {
    if !settings.model.limits().formulas {
        return Err(Fault::new(
            MessageId::BlockNotKnown,
            "this control has no formulas",
        ));
    }
    let wanted = Use::of(Kind::Fn, "FORMULA");
    if let Some(why) = settings.rules.equipment.lacks(settings.model, wanted) {
        return Err(Fault::new(
            MessageId::BlockNotKnown,
            format!("a formula is {why}"),
        ));
    }
    let value = q.evaluate(expression)?;
    q.set(target, value)
}

fn call_label(q: &QTable, label: u16, repeats: Option<Value>, settings: &Settings) -> Result<Flow, Fault> {
    if label == 0 {
        return Err(MessageId::JumpToLabelZeroNotPermitted.into());
    }
    let Some(repeats) = repeats else {
        return Ok(Flow::Call(label));
    };
    let count = q.value(repeats)?;
    let max = f64::from(settings.model.limits().repeat_max);
    if !(0.0..=max).contains(&count) {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            format!("REP takes 1 to {max}"),
        ));
    }
    Ok(Flow::Repeat(label, count as u32))
}

fn rounding(c: &mut Context<'_>, radius: Value, feed: Option<Value>) -> Result<(), Fault> {
    let radius = c.numbers.length(radius)? * c.modal.plane_scale()?;
    if radius < 0.0 {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "a rounding radius is positive",
        ));
    }
    if radius > 0.0 {
        join(c, JoinKind::Rounding(radius), feed)?;
    }
    Ok(())
}

fn chamfer(c: &mut Context<'_>, length: Value, feed: Option<Value>) -> Result<(), Fault> {
    let length = c.numbers.length(length)? * c.modal.plane_scale()?;
    if length <= 0.0 {
        let detail = "the length of a chamfer must be positive";
        return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
    }
    join(c, JoinKind::Chamfer(length), feed)
}

fn join(c: &mut Context<'_>, kind: JoinKind, feed: Option<Value>) -> Result<(), Fault> {
    let feed_mm_min = feed.map(|feed| c.numbers.feed(feed, c.settings)).transpose()?;
    c.pen.contour.join(Join {
        kind,
        feed_mm_min,
        block: c.pen.block,
        sequence: c.pen.sequence,
    })
}

/// FN14: the run ends with the text of the number [003:4352-4367].
fn numbered_error(q: &QTable, number: Value, settings: &Settings) -> Fault {
    let number = match q.value(number) {
        Ok(number) => number,
        Err(fault) => return fault,
    };
    let max = settings.model.limits().fn14_max;
    if !(0.0..=f64::from(max)).contains(&number) {
        return Fault::new(MessageId::EntryValueIncorrect, format!("FN14 takes 0 to {max}"));
    }
    match settings.texts.text(number as u16, settings.model) {
        Some(text) => Fault {
            message: Message::Numbered(text),
            detail: String::new(),
            block: None,
            ahead: false,
            cause: Cause::Message,
        },
        None => Fault::from(MessageId::EntryValueIncorrect),
    }
}

/// FN15: PRINT. A number up to 200 prints the FN14 text of that number, a Q parameter its value; slashes separate
/// them [003:4371-4385].
fn print(c: &mut Context<'_>, items: &[Value]) -> Result<(), Fault> {
    const TEXT_NUMBER_MAX: f64 = 200.0;
    if !c.executes(Feature::Fn(15))? {
        return Ok(());
    }
    if items.len() > usize::from(c.settings.model.limits().print_items_max) {
        return Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "too many items for PRINT",
        ));
    }
    let mut line = Vec::new();
    for item in items {
        line.push(match item {
            Value::Number(number) if (0.0..=TEXT_NUMBER_MAX).contains(number) => c
                .settings
                .texts
                .text(*number as u16, c.settings.model)
                .unwrap_or_default(),
            Value::Number(_) => {
                return Err(Fault::new(
                    MessageId::EntryValueIncorrect,
                    "PRINT takes texts 0 to 200",
                ));
            }
            Value::Q { .. } => format!("{:+}", c.numbers.q.value(*item)?),
        });
    }
    c.output_function(Function::Print(line.join("/").into()), technology::Block::Print)
}

/// FN19: two values to the PLC in the unit of the control model [003:4387-4395] [000:11597-11655].
fn plc(c: &mut Context<'_>, a: Value, b: Option<Value>) -> Result<(), Fault> {
    let Some(per_mm) = c.settings.model.limits().fn19_per_mm else {
        return Err(Fault::new(MessageId::BlockNotKnown, "this control has no FN19"));
    };
    // TNC 360: the programmed number already counts in micrometres [003:4391-4395].
    let scale = if per_mm < 1e4 { 1.0 } else { per_mm };
    let a = c.numbers.q.value(a)? * scale;
    let b = b.map(|b| c.numbers.q.value(b)).transpose()?.map(|b| b * scale);
    c.output_function(Function::Plc([Some(a), b]), technology::Block::Plc)
}

/// A block that could not be read. With [`Settings::skip_unknown`] a word that nothing knows is left
/// out, and a block that opens with one is passed over.
#[cold]
fn unreadable(run: &mut Run, block: &InvalidBlock, settings: &Settings) -> Result<Flow, Fault> {
    let error = &block.error;
    if !settings.skip_unknown || !block.is_unknown() {
        let cause = error.help.map_or(Cause::Message, Cause::Written);
        return Err(Fault::new(error.message, error.detail.to_string()).because(cause));
    }
    let (operation, words) = block.without_unknown_words();
    run.context(settings)
        .warn(WarningKind::PassedOver { what: words });
    match operation {
        Some(operation) => execute(run, &operation, settings),
        None => Ok(Flow::Next),
    }
}

/// A positioning block of a language with G functions.
fn execute_motion(
    run: &mut Run,
    motion: &Motion,
    modality: &Modality,
    settings: &Settings,
) -> Result<Flow, Fault> {
    take_plane(run, modality, settings)?;
    let resolved = run.modal.in_force.resolve(motion, modality);
    let mut motion = resolved.map_err(|detail| Fault::new(MessageId::EntryValueIncorrect, detail))?;
    let rapid = run.modal.in_force.function.is_rapid();
    if rapid && matches!(motion.feed, Some(Feed::Value(_))) {
        // The feed counts from the next block on that is not in rapid traverse.
        take_feed(&mut run.modal, &run.numbers, settings, motion.feed)?;
    }
    let stands =
        motion.coordinates.is_empty() && motion.polar_radius.is_none() && motion.polar_angle.is_none();
    if stands && motion.m.is_empty() {
        // What only sets functions in force is no positioning block that M89 would call a cycle after.
        if run.modal.in_force.function == PathFunction::Paraxial
            || matches!(
                motion.compensation,
                Some(Compensation::Lengthen | Compensation::Shorten)
            )
        {
            motion.kind = MotionKind::Paraxial;
        }
        take_compensation(&mut run.modal, &mut run.numbers.q, &motion)?;
        take_feed(&mut run.modal, &run.numbers, settings, motion.feed)?;
        return Ok(Flow::Next);
    }
    if rapid {
        motion.feed = Some(Feed::Max);
    }
    execute(run, &Operation::Motion(motion), settings)
}

/// A block that does several things; the first that leads elsewhere ends it.
fn execute_block(run: &mut Run, block: &ModalBlock, settings: &Settings) -> Result<Flow, Fault> {
    take_plane(run, &block.modality, settings)?;
    let before = run.modal.in_force.distance;
    if let Some(distance) = block.modality.distance {
        run.modal.in_force.distance = distance;
    }
    for operation in block.resolved(before) {
        let flow = execute(run, &operation, settings)?;
        if flow != Flow::Next {
            return Ok(flow);
        }
    }
    Ok(Flow::Next)
}

/// G17 to G19 without a tool call choose the tool axis where it is another one (inferred).
fn take_plane(run: &mut Run, modality: &Modality, settings: &Settings) -> Result<(), Fault> {
    let Some(axis) = modality.plane else {
        return Ok(());
    };
    if axis == run.modal.plane.normal {
        return Ok(());
    }
    run.pen.finish_contour()?;
    set_tool_axis(&mut run.modal, &mut run.numbers, settings, axis)
}
