//! A block: parameters first, then what its words put in force, then its movement and its functions.
//!
//! Decision: A value that a cleared parameter is to give is a fault of the block: no axis goes to what nobody has said

use bahn_din::system900::{self, Block, Condition, Relation, Word, WordKind, g_function};
use bahn_path::{Axis, BlockRef, Function};
use bahn_system900::{Memory, Name, PathParameter, Value};

use crate::frame::Frame;
use crate::modal::{Interpolation, Rotation};
use crate::refusal::Refusal;
use crate::run::{ChannelAxes, Run, Said};
use crate::texts::Texts;

/// What a block is executed with.
pub(crate) struct Work<'a> {
    pub memory: &'a mut Memory,
    pub channel: u8,
    pub axes: &'a ChannelAxes,
    pub run: &'a mut Run,
    pub texts: &'a mut Texts,
    pub at: BlockRef,
}

/// Where the program goes on after a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Next {
    /// With the next line.
    Line,
    /// With the block of a number.
    Number(u32),
    /// With a cycle, after which the next line follows.
    Cycle(u16),
    /// Nowhere: M2, M30.
    End,
}

/// Why words of the manual are not executed.
const NOT_EXPLAINED: &str = "the manual names it and does not say what it does";
const NOT_YET: &str = "this control does not do it yet";

impl Work<'_> {
    /// Executes a block.
    pub fn block(&mut self, block: &Block) -> Result<Next, Refusal> {
        if block.may_be_skipped && self.path(PathParameter::BlockSkip) == 1.0 {
            return Ok(Next::Line);
        }
        if let [
            Word {
                kind: WordKind::Jump(condition),
                ..
            },
        ] = block.words.as_slice()
        {
            return self.jump(condition);
        }
        let mut said = Said::default();
        let synchronises = self.write_parameters(block, &mut said)?;
        self.take_g(block, &mut said)?;
        self.take_words(block, &mut said)?;
        let next = self.order(block, &said)?;
        if synchronises {
            self.wait_for_execution();
        }
        Ok(next)
    }

    /// A number of a parameter of the channel; 0 where it is cleared.
    pub fn path(&self, parameter: PathParameter) -> f64 {
        self.memory.path_number(self.channel, parameter)
    }

    /// A cycle lies beside the program.
    pub fn has_cycle(&mut self, number: u16) -> bool {
        self.texts.cycle(number).is_some()
    }

    /// How the coordinates stand now.
    pub fn frame(&self) -> Result<Frame, Refusal> {
        Frame::of(self.memory, self.channel, self.axes, &self.run.modal)
    }

    /// The number that a word gives.
    pub fn number(&self, value: system900::Value) -> Result<f64, Refusal> {
        match value {
            system900::Value::Number(number) => Ok(number.value()),
            system900::Value::Content(parameter) => {
                let name = Name::P(self.channel, parameter.number().into());
                let cell = self.memory.cell(name)?;
                cell.number()
                    .ok_or_else(|| Refusal::of(format!("{parameter} is cleared: it gives no value")))
            }
        }
    }

    /// A condition is looked at when the block is read, which M1 and parameters that synchronise put off [002:1634-1655].
    fn jump(&self, condition: &Condition) -> Result<Next, Refusal> {
        let name = Name::P(self.channel, condition.parameter.number().into());
        // What is cleared is less and greater than nothing, and equal to nothing.
        let Some(own) = self.memory.cell(name)?.number() else {
            return Ok(Next::Line);
        };
        let with = self.number(condition.with)?;
        let is_so = match condition.relation {
            Relation::Less => own < with,
            Relation::Equal => own == with,
            Relation::Greater => own > with,
        };
        Ok(if is_so {
            Next::Number(condition.target)
        } else {
            Next::Line
        })
    }

    /// Writes the parameters of a block; whether the look-ahead waits for its execution. Real-time parameters are written when
    /// the path comes to it.
    fn write_parameters(&mut self, block: &Block, said: &mut Said) -> Result<bool, Refusal> {
        let mut synchronises = false;
        for (parameter, value) in block.writes() {
            let p = u32::from(parameter.number());
            let name = Name::P(self.channel, p);
            let status = self.memory.cell(name)?.status();
            synchronises |= status.synchronises();
            if status.is_real_time() {
                let value = value.map(|value| self.number(value)).transpose()?;
                let q = self.memory.q(name)?;
                said.writes.push(Function::Write { q, value });
                continue;
            }
            let value = match value {
                None => Value::Cleared,
                Some(system900::Value::Number(number)) => Value::Decimal {
                    digits: number.mantissa.into(),
                    decimals: number.decimals,
                },
                Some(system900::Value::Content(other)) => {
                    let cell = self.memory.cell(Name::P(self.channel, other.number().into()))?;
                    cell.value()
                }
            };
            self.memory.write_in_program(self.channel, p, value)?;
        }
        Ok(synchronises)
    }

    fn take_g(&mut self, block: &Block, said: &mut Said) -> Result<(), Refusal> {
        for word in &block.words {
            if let WordKind::G(g) = word.kind {
                self.g(g, said)?;
            }
        }
        Ok(())
    }

    /// Puts a G function in force [002:5075-5143].
    fn g(&mut self, g: u16, said: &mut Said) -> Result<(), Refusal> {
        let modal = &mut self.run.modal;
        match g {
            0 => modal.interpolation = Interpolation::Rapid,
            1 => modal.interpolation = Interpolation::Line,
            2 => modal.interpolation = Interpolation::Clockwise,
            3 => modal.interpolation = Interpolation::CounterClockwise,
            4 => said.dwell_s = Some(0.0),
            8 | 9 => said.stops_exactly = Some(g == 8),
            10 | 11 => modal.is_polar = g == 10,
            17..=19 | 117..=119 => modal.plane = g,
            28 | 29 => modal.stops_exactly = g == 28,
            43 | 44 => modal.shifts_axes = g == 44,
            45 => {
                let at = |parameter, after| {
                    let cell = self.memory.path_at(self.channel, parameter, after);
                    cell.number().unwrap_or(0.0)
                };
                modal.rotation = Some(Rotation {
                    origin: [0, 1].map(|after| at(PathParameter::RotationOrigin, after)),
                    angle_deg: at(PathParameter::RotationAngle, 0),
                });
            }
            46 => modal.rotation = None,
            // What is in force at the start: nothing is transformed or corrected.
            15 | 40 | 47 | 147 => {}
            53..=59
            | 153..=159
            | 254..=259
            | 354..=359
            | 454..=459
            | 554..=559
            | 654..=659
            | 754..=759
            | 854..=859
            | 954..=959 => modal.zero_point = g,
            60 => modal.mirrors = [false; 2],
            61 => modal.mirrors[0] = true,
            62 => modal.mirrors[1] = true,
            63 | 64 => modal.is_feed_fixed = g == 63,
            80 => modal.drilling = None,
            81 | 83 | 85 => modal.drilling = Some(g),
            90 | 91 => modal.is_absolute = g == 90,
            92 => said.shifts = true,
            94 | 95 => modal.is_per_turn = g == 95,
            97 => {}
            _ => {
                let named_only = g_function(g).is_some_and(|row| row.part == system900::Part::NamedOnly);
                let why = if named_only { NOT_EXPLAINED } else { NOT_YET };
                return Err(Refusal::not_executed(format!("G{g}"), why));
            }
        }
        Ok(())
    }

    fn take_words(&mut self, block: &Block, said: &mut Said) -> Result<(), Refusal> {
        for word in &block.words {
            match word.kind {
                WordKind::Axis(name, value) => {
                    let value = self.number(value)?;
                    if said.dwell_s.is_some() && name.letter == 'X' && name.extension == 0 {
                        said.dwell_s = Some(value);
                        continue;
                    }
                    let axis = self.named(name)?;
                    said.coordinates[axis] = Some(value);
                }
                WordKind::Feed(value) => {
                    let value = self.number(value)?;
                    match &mut said.dwell_s {
                        Some(dwell_s) => *dwell_s = value,
                        None => said.feed = Some(value),
                    }
                }
                WordKind::Speed(1, value) => self.run.modal.speed_rpm = self.number(value)?,
                WordKind::Tool(value) => said.tool = Some(self.number(value)?.round() as i64),
                WordKind::Centre(index, value) => {
                    let value = self.number(value)?;
                    if let Some(own) = said.centre.get_mut(usize::from(index)) {
                        *own = Some(value);
                    }
                }
                WordKind::Radius(value) => said.radius = Some(self.number(value)?),
                _ => {}
            }
        }
        Ok(())
    }

    /// The place of an axis on the path.
    fn named(&self, name: system900::AxisName) -> Result<Axis, Refusal> {
        match self.axes.named(name) {
            Some(Some(axis)) => Ok(axis),
            Some(None) => Err(Refusal::of(format!("{name} has no place on a path of nine axes"))),
            None => Err(Refusal::of(format!("the channel has no axis {name}"))),
        }
    }
}
