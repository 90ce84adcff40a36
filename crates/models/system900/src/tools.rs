//! The tools of a channel: where each lies [002:1149-1158] [002:1999-2048].

use std::fmt;

use serde::Serialize;

use crate::array::number_or_none;
use crate::memory::Memory;
use crate::name::Name;
use crate::numbers::TOOLS;
use crate::zero::NUMBERS_END;

/// The array of the tools.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tools {
    /// The first channel parameter; `None` when the channel has no tools.
    pub first: Option<u32>,
    /// How many records there are.
    pub count: u32,
    /// Parameters of each record.
    pub length: u32,
    /// All of them, by their parameters.
    pub records: Vec<Tool>,
}

/// The record of a tool. What is cleared, or beyond its length, is `None`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tool {
    /// Its place in the array, from 0 on.
    pub record: u32,
    /// The first channel parameter.
    pub p: u32,
    /// The same as system parameter; `None` outside the blocks of the channel.
    pub q: Option<u32>,
    /// The T number.
    pub group: Option<f64>,
    /// The number of the tool itself.
    pub number: Option<f64>,
    /// Its place in the magazine.
    pub place: Option<f64>,
    /// Its sub record.
    pub sub: Option<f64>,
    /// The type of correction.
    pub correction: Option<f64>,
    /// 1 when its life has run down.
    pub life: Option<f64>,
    /// Its radius, in the unit of the control.
    pub radius: Option<f64>,
    /// Its length, likewise.
    pub length: Option<f64>,
    /// What is added to the radius.
    pub radius_offset: Option<f64>,
    /// What is added to the length.
    pub length_offset: Option<f64>,
    /// Where its tip lies, 0 to 9.
    pub quadrant: Option<f64>,
}

/// The numbers that lay out the array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    pub first: u32,
    pub records: u32,
    pub length: u32,
}

impl Layout {
    /// That of a channel; `None` when it has no tools, or one of the numbers is none.
    pub fn of(memory: &Memory, channel: u8) -> Option<Layout> {
        let descriptor = memory.descriptor(channel);
        let layout = Layout {
            first: descriptor.count(TOOLS)?,
            records: descriptor.count(TOOLS + 1)?,
            length: descriptor.count(TOOLS + 3)?,
        };
        (layout.count() > 0).then_some(layout)
    }

    /// How many parameters there are.
    pub fn count(&self) -> u64 {
        u64::from(self.records) * u64::from(self.length)
    }

    /// The first parameter of a record.
    pub fn begin(&self, record: u32) -> Option<u32> {
        record.checked_mul(self.length)?.checked_add(self.first)
    }

    fn record(&self, memory: &Memory, channel: u8, record: u32, p: u32) -> Tool {
        let at = |offset: u32| {
            let name = Name::P(channel, p.checked_add(offset)?);
            let cell = memory.cell(name).ok().filter(|_| offset < self.length)?;
            cell.number()
        };
        Tool {
            record,
            p,
            q: memory.q(Name::P(channel, p)).ok(),
            group: at(0),
            number: at(1),
            place: at(2),
            sub: at(3),
            correction: at(4),
            life: at(8),
            radius: at(10),
            length: at(11),
            radius_offset: at(12),
            length_offset: at(13),
            quadrant: at(14),
        }
    }
}

impl Tools {
    /// Those of a channel.
    pub fn of(memory: &Memory, channel: u8) -> Tools {
        let Some(layout) = Layout::of(memory, channel) else {
            return Tools {
                first: None,
                count: 0,
                length: 0,
                records: Vec::new(),
            };
        };
        let begins = (0..layout.records).map_while(|record| {
            let p = record.checked_mul(layout.length)?.checked_add(layout.first)?;
            (p < NUMBERS_END).then_some((record, p))
        });
        Tools {
            first: Some(layout.first),
            count: layout.records,
            length: layout.length,
            records: begins
                .map(|(record, p)| layout.record(memory, channel, record, p))
                .collect(),
        }
    }
}

/// A line for each record that has a group.
impl fmt::Display for Tools {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = self.records.iter().filter(|tool| tool.group.is_some());
        for tool in named {
            let p = tool.p;
            let [group, radius, length, place] =
                [tool.group, tool.radius, tool.length, tool.place].map(number_or_none);
            writeln!(
                f,
                "P{p:<6} T{group:<6} radius {radius:<8} length {length:<8} place {place}"
            )?;
        }
        Ok(())
    }
}
