//! Cycles: definition, call, and what each does.
//!
//! Definitions are collected block by block. Cycles 7-11, 13, 14, 19 and 26 act when they are defined, the
//! others when they are called [003:4849-4857].

mod contour_pocket;
mod drilling;
mod machining;
mod pockets;
mod transformation;

use bahn_parameters::MessageId;
use bahn_program::{CycleBlock, CycleFunction, CycleWord, Feed, Value, cycle};

pub(crate) use self::contour_pocket::{ContourJob, Halt, Watch, contour_plane};
use crate::availability::{Feature, names_datum_table, words};
use crate::definition::{Definition, Resolved, is_contour_cycle};
use crate::error::{Cause, Fault};
use crate::flow::Flow;
use crate::run::Run;
use crate::settings::Settings;

impl Run {
    /// One block of a cycle definition.
    pub(crate) fn define_cycle(&mut self, block: &CycleBlock, settings: &Settings) -> Result<(), Fault> {
        if block.sub == 0 && is_inhibited(block.number, settings) {
            let detail = format!("MP7245 inhibits cycle {}", block.number);
            return Err(Fault::new(MessageId::BlockNotKnown, detail));
        }
        let feature = Feature::Cycle(block.number);
        let acts_here = is_effective_at_definition(block.number);
        // A cycle that acts at its call is refused there, unless the control does not know it at all.
        let is_judged = acts_here || !is_known(block.number, settings);
        if is_judged && !self.executes(feature, settings)? && acts_here {
            return Ok(());
        }
        if names_datum_table(block) && !self.executes(Feature::Word(words::DATUM_TABLE), settings)? {
            return Ok(());
        }
        let words = self.resolve(block, settings)?;
        if acts_here {
            return self.define_effective(block, words, settings);
        }
        // A new definition ends M89 [003:4875-4881].
        if block.sub == 0 {
            self.modal.cycle_after_each_block = false;
        }
        self.modal.cycle.machining.take(
            block.number,
            block.sub,
            words,
            self.numbers.unit_mm,
            self.pen.block,
        );
        Ok(())
    }

    fn define_effective(
        &mut self,
        block: &CycleBlock,
        words: Vec<Resolved>,
        settings: &Settings,
    ) -> Result<(), Fault> {
        self.modal.cycle.effective.take(
            block.number,
            block.sub,
            words,
            self.numbers.unit_mm,
            self.pen.block,
        );
        if block.sub == 0 {
            return Ok(());
        }
        let Some(definition) = self.modal.cycle.effective.ready() else {
            return Err(Fault::new(
                MessageId::CyclIncomplete,
                "blocks of the cycle are missing or out of order",
            ));
        };
        let words = definition.block(block.sub).to_vec();
        match block.number {
            7 => self.datum_shift(&words, settings),
            8 => self.mirror_image(&words),
            9 => self.dwell(&words, settings),
            10 => self.rotation(&words, has_q_parameter(block), settings),
            11 => self.scaling(&words, settings),
            13 => self.spindle_orientation(&words, settings),
            _ => self.contour_geometry(&words, settings),
        }
    }

    /// Gives every word of a cycle block its value.
    pub(crate) fn resolve(&self, block: &CycleBlock, settings: &Settings) -> Result<Vec<Resolved>, Fault> {
        let value = |value: Value| self.numbers.q.value(value);
        let mut words = Vec::with_capacity(block.words.len());
        for word in &block.words {
            words.push(match word {
                CycleWord::Text(text) => Resolved::Text(text.clone()),
                CycleWord::Number(number) => Resolved::Number(value(*number)?),
                CycleWord::Coordinate(axis, word) => Resolved::Coordinate {
                    axis: *axis,
                    value: value(word.value)?,
                    incremental: word.incremental,
                },
                CycleWord::Axis(axis) => Resolved::Axis(*axis),
                CycleWord::AxisDirection(axis, direction) => Resolved::AxisDirection(*axis, *direction),
                CycleWord::Feed(Feed::Max) => Resolved::Feed(None),
                CycleWord::Feed(Feed::Value(feed)) => {
                    Resolved::Feed(Some(self.numbers.feed(*feed, settings)?))
                }
                CycleWord::Direction(direction) => Resolved::Direction(*direction),
                CycleWord::Labels(labels) => Resolved::Labels(labels.clone()),
                CycleWord::Target(number) => Resolved::Target(*number),
                CycleWord::Assignment(number, assigned) => Resolved::Assignment(*number, value(*assigned)?),
                CycleWord::M(_) => continue,
            });
        }
        Ok(words)
    }

    /// CYCL CALL, M99 or M89: runs the last defined machining cycle [003:4857-4881].
    pub(crate) fn call_cycle(&mut self, settings: &Settings) -> Result<Flow, Fault> {
        let Some(definition) = self.modal.cycle.machining.ready().cloned() else {
            let cause = match self.modal.cycle.machining.is_empty() {
                true => Cause::NoCycle,
                false => Cause::Message,
            };
            return Err(Fault::new(MessageId::CyclIncomplete, "no complete cycle is defined").because(cause));
        };
        if !self.executes(Feature::Cycle(definition.number), settings)? {
            return Ok(Flow::Next);
        }
        if definition.number == 12 {
            return self.called_program(&definition);
        }
        self.pen.finish_contour()?;
        match definition.number {
            1 => self.pecking(&definition, settings)?,
            2 => self.tapping(&definition, settings)?,
            3 => self.slot_milling(&definition, settings)?,
            4 => self.pocket_milling(&definition, settings)?,
            5 => self.circular_pocket(&definition, settings)?,
            number if is_contour_cycle(number) => return Ok(Flow::ContourCycle),
            17 => self.rigid_tapping(&definition, settings)?,
            number => {
                let detail = format!("cycle {number} is read but not executed by this control");
                return Err(Fault::new(MessageId::BlockNotKnown, detail));
            }
        }
        Ok(Flow::Next)
    }

    /// Cycle 12: the called program is what the cycle call runs [003:6476-6490].
    fn called_program(&self, definition: &Definition) -> Result<Flow, Fault> {
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

/// MP7245: the machine builder inhibits the cycle [000:6655-6698].
fn is_inhibited(number: u16, settings: &Settings) -> bool {
    number < 32 && settings.rules.inhibited_cycles >> number & 1 != 0
}

fn is_effective_at_definition(number: u16) -> bool {
    cycle(CycleFunction::Definition, number).is_some_and(|cycle| cycle.acts_at_definition)
}
