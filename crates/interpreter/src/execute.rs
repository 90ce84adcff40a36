//! The execution of one block.

use bahn_parameters::{MessageId, technology};
use bahn_path::Function;
use bahn_program::{Block, InvalidBlock, Operation, Value};

use crate::availability::{Feature, words};
use crate::contour::rounding::{Join, JoinKind};
use crate::cycles::{call_cycle, define_cycle};
use crate::error::{Cause, Fault, Message, WarningKind};
use crate::flow::Flow;
use crate::functions::take_m_functions;
use crate::path_functions::circle_centre;
use crate::positioning::positioning;
use crate::run::Run;
use crate::settings::Settings;

impl Run {
    /// Executes a block. The caller has already passed over skipped blocks.
    #[inline]
    pub fn execute(&mut self, block: &Block, settings: &Settings) -> Result<Flow, Fault> {
        self.execute_operation(&block.operation, settings)
    }

    /// Executes what a block says.
    #[inline]
    pub fn execute_operation(&mut self, operation: &Operation, settings: &Settings) -> Result<Flow, Fault> {
        match operation {
            Operation::Motion(motion) => match positioning(self.context(settings), motion)? {
                (Flow::Next, true) => call_cycle(&mut self.context(settings)),
                (flow, _) => Ok(flow),
            },
            Operation::Calculate {
                function,
                target,
                a,
                b,
            } => {
                let value = self.numbers.q.calculate(*function, *a, *b)?;
                self.numbers.q.set(*target, value)?;
                Ok(Flow::Next)
            }
            Operation::Jump {
                condition,
                a,
                b,
                label,
            } => Ok(if self.numbers.q.holds(*condition, *a, *b)? {
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
            other => self.execute_rare(other, settings),
        }
    }

    fn execute_rare(&mut self, operation: &Operation, settings: &Settings) -> Result<Flow, Fault> {
        match operation {
            Operation::End(_) => return Ok(Flow::EndOfProgram),
            Operation::Formula { target, expression } => {
                if !settings.model.limits().formulas {
                    return Err(Fault::new(
                        MessageId::BlockNotKnown,
                        "this control has no formulas",
                    ));
                }
                let value = self.numbers.q.evaluate(expression)?;
                self.numbers.q.set(*target, value)?;
            }
            Operation::CallLabel { label, repeats } => return self.call_label(*label, *repeats, settings),
            Operation::CallProgram(name) => return Ok(Flow::CallProgram(name.clone())),
            Operation::CircleCentre(coordinates) => {
                circle_centre(&mut self.modal, &self.numbers, coordinates)?
            }
            Operation::Rounding { radius, feed } => self.rounding(*radius, *feed, settings)?,
            Operation::Chamfer { length, feed } => self.chamfer(*length, *feed, settings)?,
            Operation::BlankMin(coordinates, axis) => self.blank_min(coordinates, *axis)?,
            Operation::BlankMax(coordinates) => self.blank_max(coordinates, settings)?,
            Operation::ToolDefinition { tool, length, radius } => {
                self.tool_definition(*tool, *length, *radius, settings)?;
            }
            Operation::ToolCall {
                tool,
                axis,
                speed,
                delta_length,
                delta_radius,
            } => {
                self.tool_call(*tool, *axis, *speed, [*delta_length, *delta_radius], settings)?;
            }
            Operation::Stop(m) => {
                let mut functions = take_m_functions(&mut self.context(settings), m)?;
                functions.stop = true;
                functions.cycle_call = false;
                return self.pen.hold(&self.modal, functions);
            }
            Operation::Miscellaneous(m) => {
                let functions = take_m_functions(&mut self.context(settings), m)?;
                let call = m.contains(99);
                let flow = self.pen.hold(&self.modal, functions)?;
                return if call {
                    call_cycle(&mut self.context(settings))
                } else {
                    Ok(flow)
                };
            }
            Operation::ErrorNumber(number) => return Err(self.numbered_error(*number, settings)),
            Operation::Print(items) => self.print(items, settings)?,
            Operation::Plc { a, b } => self.plc(*a, *b, settings)?,
            Operation::Cycle(block) => define_cycle(&mut self.context(settings), block)?,
            Operation::CycleCall(m) => {
                // CYCL CALL ends M89 [003:4875-4881].
                self.modal.cycle_after_each_block = false;
                let mut functions = take_m_functions(&mut self.context(settings), m)?;
                functions.cycle_call = true;
                self.pen.hold(&self.modal, functions)?;
                return call_cycle(&mut self.context(settings));
            }
            Operation::Probe(block) => self.probe(block, settings)?,
            Operation::Dialog(dialog) => {
                let name = if dialog.call {
                    words::DIALOG_CALL
                } else {
                    words::DIALOG_DEFINITION
                };
                self.executes(Feature::Word(name), settings)?;
            }
            Operation::Invalid(invalid) => return self.unreadable(invalid, settings),
            Operation::Motion(_)
            | Operation::Calculate { .. }
            | Operation::Jump { .. }
            | Operation::Label(_)
            | Operation::Comment(_)
            | Operation::Begin(_) => {}
        }
        Ok(Flow::Next)
    }

    fn call_label(&mut self, label: u16, repeats: Option<Value>, settings: &Settings) -> Result<Flow, Fault> {
        if label == 0 {
            return Err(MessageId::JumpToLabelZeroNotPermitted.into());
        }
        let Some(repeats) = repeats else {
            return Ok(Flow::Call(label));
        };
        let count = self.numbers.q.value(repeats)?;
        let max = f64::from(settings.model.limits().repeat_max);
        if !(0.0..=max).contains(&count) {
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                format!("REP takes 1 to {max}"),
            ));
        }
        Ok(Flow::Repeat(label, count as u32))
    }

    fn rounding(&mut self, radius: Value, feed: Option<Value>, settings: &Settings) -> Result<(), Fault> {
        let radius = self.numbers.length(radius)? * self.modal.plane_scale();
        if radius < 0.0 {
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                "a rounding radius is positive",
            ));
        }
        if radius > 0.0 {
            self.join(JoinKind::Rounding(radius), feed, settings)?;
        }
        Ok(())
    }

    fn chamfer(&mut self, length: Value, feed: Option<Value>, settings: &Settings) -> Result<(), Fault> {
        let length = self.numbers.length(length)? * self.modal.plane_scale();
        if length <= 0.0 {
            let detail = "the length of a chamfer must be positive";
            return Err(Fault::new(MessageId::WrongAxisProgrammed, detail));
        }
        self.join(JoinKind::Chamfer(length), feed, settings)
    }

    fn join(&mut self, kind: JoinKind, feed: Option<Value>, settings: &Settings) -> Result<(), Fault> {
        let feed_mm_min = feed.map(|feed| self.numbers.feed(feed, settings)).transpose()?;
        self.pen.contour.join(Join {
            kind,
            feed_mm_min,
            block: self.pen.block,
            sequence: self.pen.sequence,
        })
    }

    /// FN14: the run ends with the text of the number [003:4352-4367].
    fn numbered_error(&mut self, number: Value, settings: &Settings) -> Fault {
        let number = match self.numbers.q.value(number) {
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

    /// FN15: PRINT. A number up to 200 prints the FN14 text of that number, a Q parameter its value
    /// [003:4371-4385].
    fn print(&mut self, items: &[Value], settings: &Settings) -> Result<(), Fault> {
        const TEXT_NUMBER_MAX: f64 = 200.0;
        if !self.executes(Feature::Fn(15), settings)? {
            return Ok(());
        }
        if items.len() > usize::from(settings.model.limits().print_items_max) {
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                "too many items for PRINT",
            ));
        }
        let mut line = Vec::new();
        for item in items {
            line.push(match item {
                Value::Number(number) if (0.0..=TEXT_NUMBER_MAX).contains(number) => settings
                    .texts
                    .text(*number as u16, settings.model)
                    .unwrap_or_default(),
                Value::Number(_) => {
                    return Err(Fault::new(
                        MessageId::EntryValueIncorrect,
                        "PRINT takes texts 0 to 200",
                    ));
                }
                Value::Q { .. } => format!("{:+}", self.numbers.q.value(*item)?),
            });
        }
        self.pen.output_function(
            &self.modal,
            Function::Print(line.join(" ")),
            technology::Block::Print,
            settings,
        )
    }

    /// FN19: two values to the PLC in the unit of the control model [003:4387-4395] [000:11597-11655].
    fn plc(&mut self, a: Value, b: Option<Value>, settings: &Settings) -> Result<(), Fault> {
        let Some(per_mm) = settings.model.limits().fn19_per_mm else {
            return Err(Fault::new(MessageId::BlockNotKnown, "this control has no FN19"));
        };
        // TNC 360: the programmed number already counts in micrometres [003:4391-4395].
        let scale = if per_mm < 1e4 { 1.0 } else { per_mm };
        let a = self.numbers.q.value(a)? * scale;
        let b = b.map(|b| self.numbers.q.value(b)).transpose()?.map(|b| b * scale);
        self.pen.output_function(
            &self.modal,
            Function::Plc([Some(a), b]),
            technology::Block::Plc,
            settings,
        )
    }

    /// A block that could not be read. With [`Settings::skip_unknown`] a word that nothing knows is left
    /// out, and a block that opens with one is passed over.
    #[cold]
    pub(crate) fn unreadable(&mut self, block: &InvalidBlock, settings: &Settings) -> Result<Flow, Fault> {
        let error = &block.error;
        if !settings.skip_unknown || !block.is_unknown() {
            let cause = error.help.map_or(Cause::Message, Cause::Written);
            return Err(Fault::new(error.message, error.detail.to_string()).because(cause));
        }
        let (operation, words) = block.without_unknown_words();
        self.warn(WarningKind::PassedOver { what: words });
        match operation {
            Some(operation) => self.execute_operation(&operation, settings),
            None => Ok(Flow::Next),
        }
    }
}
