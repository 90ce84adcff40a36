//! Cycle definitions as they are read, block by block.

use bahn_parameters::MessageId;
use bahn_path::{Axis, BlockRef, Direction, ScanJob, Sense};
use bahn_program::{CycleBlock, CycleFunction, CycleWord, Feed, Quantity, Value, cycle_parameters};

use crate::error::Fault;
use crate::numbers::Numbers;
use crate::settings::Settings;

/// The definitions in force: the machining cycle for the call, and the one that acts at definition.
#[derive(Clone, Debug, Default)]
pub(crate) struct CycleData {
    pub machining: Collector,
    pub effective: Collector,
    /// Cycle 20, as far as its blocks were read.
    pub contour_data: Collector,
    /// The last one of the machine builder.
    pub oem: Collector,
}

impl CycleData {
    /// Whether a cycle call machines the contours of cycle 14.
    pub fn is_contour_cycle(&self) -> bool {
        let definition = self.machining.definition.as_ref();
        definition.is_some_and(|definition| is_contour_cycle(definition.number))
    }

    /// Whether that is a contour train.
    pub fn is_contour_train(&self) -> bool {
        self.machining
            .definition
            .as_ref()
            .is_some_and(|definition| matches!(definition.number, 25 | 27))
    }
}

/// Cycles of the machine builder [003:4904-4906].
pub(crate) const OEM_CYCLES: std::ops::RangeInclusive<u16> = 68..=99;

/// A cycle of the machine builder that runs, and what its end brings back.
#[derive(Clone, Debug)]
pub(crate) struct RunningOem {
    /// Calls that are open within it.
    pub depth: usize,
    /// It comes from the EPROM of the PLC.
    pub in_eprom: bool,
    /// Q parameters that may be local.
    pub q: Vec<f64>,
    /// The cycle for the call that was defined before it (inferred: standard cycles within it are its own).
    pub machining: Collector,
    pub after_each_block: bool,
}

/// Digitizing: the cycles that are being read, and the scan that is on its way.
#[derive(Clone, Debug, Default)]
pub(crate) struct Digitizing {
    pub range: Collector,
    pub pattern: Collector,
    /// What the block that is executed wants to be scanned.
    pub wanted: Option<ScanJob>,
    /// The block whose scan is under way, and its job.
    pub scan: Option<(BlockRef, ScanJob)>,
}

/// Collects the blocks n.0, n.1, ... of a definition.
#[derive(Clone, Debug, Default)]
pub(crate) struct Collector {
    definition: Option<Definition>,
    broken: bool,
    /// The signs of the definition were warned of.
    sign_reported: bool,
}

impl Collector {
    /// Takes block `number.sub`, which stands at `at`.
    pub fn take(&mut self, number: u16, sub: u16, words: Vec<Resolved>, unit_mm: f64, at: BlockRef) {
        if sub == 0 {
            self.sign_reported = false;
            self.definition = Some(Definition {
                number,
                at,
                blocks: vec![words],
                unit_mm,
            });
            self.broken = false;
            return;
        }
        match &mut self.definition {
            Some(definition)
                if definition.number == number && definition.blocks.len() == usize::from(sub) =>
            {
                definition.blocks.push(words);
            }
            // Missing or unordered blocks [003:7923-7928].
            _ => self.broken = true,
        }
    }

    /// The block that was taken last is refused: it has still to come.
    pub fn take_back(&mut self) {
        if let Some(definition) = &mut self.definition {
            definition.blocks.pop();
        }
    }

    /// Whether the signs of the definition are to be warned of now: once, however often it is called.
    pub fn report_sign(&mut self) -> bool {
        !std::mem::replace(&mut self.sign_reported, true)
    }

    /// Whether no definition was begun.
    pub fn is_empty(&self) -> bool {
        self.definition.is_none()
    }

    /// The definition, when its blocks came complete and in order so far.
    pub fn ready(&self) -> Option<&Definition> {
        self.definition.as_ref().filter(|_| !self.broken)
    }
}

/// A cycle definition with the values that its Q parameters had when it was read (inferred).
#[derive(Clone, Debug)]
pub(crate) struct Definition {
    pub number: u16,
    /// Place of the block n.0.
    pub at: BlockRef,
    blocks: Vec<Vec<Resolved>>,
    unit_mm: f64,
}

/// A word with its value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Resolved {
    Text(Box<str>),
    Number(f64),
    Coordinate {
        axis: Axis,
        value: f64,
        incremental: bool,
    },
    AxisFactor(Axis, f64),
    /// Centre of a scaling, program units.
    Centre(Axis, f64),
    Axis(Axis),
    AxisDirection(Axis, Direction),
    /// mm/min; `None` for FMAX.
    Feed(Option<f64>),
    Sense(Sense),
    Labels(Box<[u16]>),
    Target(u16),
    Assignment(u16, f64),
}

impl Resolved {
    /// The word as part of a program name.
    pub fn as_name(&self) -> Option<String> {
        match self {
            Resolved::Text(text) => Some(text.to_string()),
            Resolved::Number(number) => Some(format!("{number}")),
            _ => None,
        }
    }
}

impl Definition {
    /// What the definition assigns to a Q parameter.
    pub fn assigned(&self, q: u16) -> Option<f64> {
        self.blocks.iter().flatten().rev().find_map(|word| match word {
            Resolved::Assignment(number, value) if *number == q => Some(*value),
            _ => None,
        })
    }

    /// The words of a block.
    pub fn block(&self, sub: u16) -> &[Resolved] {
        self.blocks.get(usize::from(sub)).map_or(&[], Vec::as_slice)
    }

    /// The `index`th of those parameters of a block that are given in something is missing.
    fn missing(&self, sub: u16, index: usize, given_in: impl Fn(Quantity) -> bool) -> Fault {
        let parameters = cycle_parameters(CycleFunction::Definition, self.number, sub);
        let mut alike = parameters.iter().filter(|parameter| given_in(parameter.quantity));
        let what = match alike.nth(index).map(|parameter| parameter.name) {
            None | Some("") => "a value",
            Some(name) => name,
        };
        let detail = format!("CYCL DEF {}.{sub}: {what} is missing", self.number);
        Fault::new(MessageId::CyclIncomplete, detail)
    }

    /// The `index`th number of a block.
    pub fn number(&self, sub: u16, index: usize) -> Result<f64, Fault> {
        self.optional_number(sub, index)
            .ok_or_else(|| self.missing(sub, index, Quantity::is_number))
    }

    /// A dwell time, s.
    pub fn dwell(&self, sub: u16, settings: &Settings) -> Result<f64, Fault> {
        dwell_time(self.number(sub, 0)?, settings)
    }

    pub fn optional_number(&self, sub: u16, index: usize) -> Option<f64> {
        let numbers = self.block(sub).iter().filter_map(|word| match word {
            Resolved::Number(number) => Some(*number),
            _ => None,
        });
        numbers.into_iter().nth(index)
    }

    /// The `index`th number of a block as a length, mm.
    pub fn length(&self, sub: u16, index: usize) -> Result<f64, Fault> {
        in_range(self.number(sub, index)? * self.unit_mm)
    }

    pub fn optional_length(&self, sub: u16, index: usize) -> Option<f64> {
        self.optional_number(sub, index)
            .map(|number| number * self.unit_mm)
    }

    /// The `index`th feed of a block, mm/min.
    pub fn feed(&self, sub: u16, index: usize) -> Result<f64, Fault> {
        let feeds = self.block(sub).iter().filter_map(|word| match word {
            Resolved::Feed(feed) => *feed,
            _ => None,
        });
        let is_feed = |quantity| quantity == Quantity::Feed;
        let feed = feeds
            .into_iter()
            .nth(index)
            .ok_or_else(|| self.missing(sub, index, is_feed))?;
        if feed <= 0.0 {
            return Err(MessageId::FeedRateIsMissing.into());
        }
        Ok(feed)
    }

    /// The axis word of a block, mm.
    pub fn coordinate(&self, sub: u16) -> Result<(Axis, f64), Fault> {
        let found = self.block(sub).iter().find_map(|word| match word {
            Resolved::Coordinate { axis, value, .. } => Some((*axis, *value * self.unit_mm)),
            _ => None,
        });
        let (axis, value) =
            found.ok_or_else(|| self.missing(sub, 0, |quantity| quantity == Quantity::Side))?;
        Ok((axis, in_range(value)?))
    }

    /// DR of a block; counter-clockwise (climb with M3 in pockets) when it is not given (inferred).
    pub fn sense(&self, sub: u16) -> Sense {
        let of_word = |word: &Resolved| match word {
            Resolved::Sense(sense) => Some(*sense),
            _ => None,
        };
        let given = self.block(sub).iter().find_map(of_word);
        given.unwrap_or(Sense::CounterClockwise)
    }
}

/// Gives every word of a cycle block its value.
pub(crate) fn resolve(
    block: &CycleBlock,
    numbers: &Numbers,
    settings: &Settings,
) -> Result<Vec<Resolved>, Fault> {
    let value = |value: Value| numbers.q.value(value);
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
            CycleWord::AxisFactor(axis, factor) => Resolved::AxisFactor(*axis, value(*factor)?),
            CycleWord::Centre(axis, at) => Resolved::Centre(*axis, value(*at)?),
            CycleWord::Axis(axis) => Resolved::Axis(*axis),
            CycleWord::AxisDirection(axis, direction) => Resolved::AxisDirection(*axis, *direction),
            CycleWord::Feed(Feed::Max) => Resolved::Feed(None),
            CycleWord::Feed(Feed::Value(feed)) => Resolved::Feed(Some(numbers.feed(*feed, settings)?)),
            CycleWord::Sense(sense) => Resolved::Sense(*sense),
            CycleWord::Labels(labels) => Resolved::Labels(labels.clone()),
            CycleWord::Target(number) => Resolved::Target(*number),
            CycleWord::Assignment(number, assigned) => Resolved::Assignment(*number, value(*assigned)?),
            CycleWord::M(_) => continue,
        });
    }
    Ok(words)
}

/// Refuses dwell times, s, that the model does not take.
pub(crate) fn dwell_time(seconds: f64, settings: &Settings) -> Result<f64, Fault> {
    let max = settings.model.limits().dwell_max_s;
    if (0.0..=max).contains(&seconds) {
        return Ok(seconds);
    }
    let detail = format!("dwell takes 0 to {max} s");
    Err(Fault::new(MessageId::EntryValueIncorrect, detail))
}

/// Refuses lengths that no machine has.
fn in_range(length_mm: f64) -> Result<f64, Fault> {
    const LENGTH_MAX_MM: f64 = 100_000.0;
    if length_mm.abs() <= LENGTH_MAX_MM {
        Ok(length_mm)
    } else {
        Err(Fault::new(
            MessageId::EntryValueIncorrect,
            "a length of the cycle is beyond the input range",
        ))
    }
}

/// Cycles that machine the contours of cycle 14.
pub(crate) fn is_contour_cycle(number: u16) -> bool {
    matches!(number, 6 | 15 | 16 | 21..=25 | 27)
}
