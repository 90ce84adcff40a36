//! What the control says of an entry before it becomes a block.

use bahn_parameters::MessageId::{
    self, EntryValueIncorrect, JumpToLabelZeroNotPermitted, LabelNumberAllocated, WrongAxisProgrammed,
    WrongSignProgrammed,
};
use bahn_program::{CycleWord, Operation, Program, Sign, Value, check_limits};

use crate::Setting;
use crate::field::Field;
use crate::line::Line;

/// What a line is checked against.
#[derive(Clone, Copy)]
pub(crate) struct Context<'a> {
    pub(crate) setting: &'a Setting,
    pub(crate) program: &'a Program,
    /// The block that the line takes the place of.
    pub(crate) replaces: Option<u32>,
}

impl Context<'_> {
    /// Checks a line, missing answers apart. The other lines are those of its cycle.
    pub(crate) fn check<'l>(
        &self,
        line: &'l Line,
        others: impl IntoIterator<Item = &'l Line>,
    ) -> Result<(), MessageId> {
        if !line.fields().iter().all(Field::is_whole) {
            return Err(EntryValueIncorrect);
        }
        let read = self.program.language().parse_block(&line.text_to_check());
        if let Some(fault) = read.faults.first() {
            return Err(fault.message);
        }
        let mut operation = read.block.operation;
        self.check_operation(&mut operation, line.is_complete())?;
        let others: Vec<&Line> = others.into_iter().collect();
        let all = || {
            std::iter::once(line)
                .chain(others.iter().copied())
                .flat_map(Line::fields)
        };
        if line.fields().iter().any(is_wrongly_negative) {
            return Err(EntryValueIncorrect);
        }
        let sides: Vec<&str> = all().filter_map(side).collect();
        if let [first, second] = sides.as_slice()
            && first == second
        {
            return Err(WrongAxisProgrammed);
        }
        let mut signs = all().filter_map(working_sign);
        let first = signs.next();
        match signs.any(|sign| Some(sign) != first) {
            true => Err(WrongSignProgrammed),
            false => Ok(()),
        }
    }

    /// Checks what a block does: its limits, how fine its numbers are, and its labels, unless it is not complete.
    pub(crate) fn check_operation(&self, operation: &mut Operation, complete: bool) -> Result<(), MessageId> {
        let unit = self.program.unit();
        if let Some(fault) = check_limits(operation, unit, self.setting.reading()) {
            return Err(fault.message);
        }
        if self.setting.steps(unit).round(operation) {
            return Err(EntryValueIncorrect);
        }
        let mut parts = operation.parts().iter();
        parts.try_for_each(|part| {
            zero_tool(part)?;
            self.labels(part, complete)
        })
    }

    /// A label is set once [003:7881-7883], and label 0 is only an end [003:7885-7887].
    fn labels(&self, operation: &Operation, complete: bool) -> Result<(), MessageId> {
        match operation {
            Operation::Label(label) if *label > 0 && complete => {
                let at = self.program.label(*label);
                match at.is_some_and(|block| Some(block) != self.replaces) {
                    true => Err(LabelNumberAllocated),
                    false => Ok(()),
                }
            }
            Operation::CallLabel { label: 0, .. } | Operation::Jump { label: 0, .. } => {
                Err(JumpToLabelZeroNotPermitted)
            }
            Operation::Cycle(block) => {
                let zero =
                    |word: &CycleWord| matches!(word, CycleWord::Labels(labels) if labels.contains(&0));
                match block.words.iter().any(zero) {
                    true => Err(JumpToLabelZeroNotPermitted),
                    false => Ok(()),
                }
            }
            _ => Ok(()),
        }
    }
}

/// Tool 0 has length and radius 0 [003:1816].
fn zero_tool(operation: &Operation) -> Result<(), MessageId> {
    let is_other = |value: &Option<Value>| matches!(value, Some(Value::Number(number)) if *number != 0.0);
    match operation {
        Operation::ToolDefinition {
            tool: Value::Number(0.0),
            length,
            radius,
        } if is_other(length) || is_other(radius) => Err(EntryValueIncorrect),
        _ => Ok(()),
    }
}

/// Negative, where the table of cycles has no such numbers.
fn is_wrongly_negative(field: &Field) -> bool {
    let is_negative = |value: &str| value.parse().is_ok_and(|number: f64| number < 0.0);
    !field.slot.sign.may_be_negative() && field.words.iter().any(|word| is_negative(&word.value))
}

/// The axis of a side of a slot or pocket: both lie in the working plane, on one axis each [003:5110-5250].
fn side(field: &Field) -> Option<&str> {
    let word = field
        .words
        .first()
        .filter(|_| field.slot.prompt.ends_with(" side"))?;
    Some(&word.address)
}

/// Whether a value that shows the working direction is negative; that of a Q parameter or of 0 is not known.
fn working_sign(field: &Field) -> Option<bool> {
    let word = field.words.first().filter(|_| field.slot.sign == Sign::Working)?;
    let number: f64 = word.value.parse().ok()?;
    (number != 0.0).then_some(number < 0.0)
}
