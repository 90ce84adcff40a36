//! The four blocks of a tool in a channel, and the commands that copy them [002:1695-1800].
//!
//! Decision: P8047 stores the spindle block in the record of its group and its number; without such a record it is cleared all
//! the same

use crate::channel_block::ChannelParameter;
use crate::memory::{Memory, Place};
use crate::tools::Layout;

/// Parameters of a block at most: the next one begins there.
const LENGTH_MAX: u32 = 50;

/// A block of a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Block {
    /// P8050: the tool that was programmed last, for the PLC.
    Plc,
    /// P8100: the tool in the spindle.
    Spindle,
    /// P8150: what the path is computed with.
    Offset,
    /// P8200: the tool of the block that is executed.
    RealTime,
}

impl Block {
    fn first(self) -> ChannelParameter {
        match self {
            Block::Plc => ChannelParameter::PlcTool,
            Block::Spindle => ChannelParameter::SpindleTool,
            Block::Offset => ChannelParameter::OffsetTool,
            Block::RealTime => ChannelParameter::RealTimeTool,
        }
    }
}

impl Memory {
    /// A command of P8045, P8046 or P8047 was written; others are none. In HAND P8045:2 also loads what the path is computed with.
    pub fn command_tool(&mut self, channel: u8, command: ChannelParameter, in_hand: bool) {
        let order = self.of_channel(channel, command).bits().unwrap_or(0) & 0xFF;
        match (command, order) {
            (ChannelParameter::TakeTool, 1) => {
                self.copy_tool(channel, Block::Plc, Block::Spindle);
                self.copy_tool(channel, Block::Plc, Block::Offset);
            }
            (ChannelParameter::TakeTool, 2) => {
                self.copy_tool(channel, Block::RealTime, Block::Spindle);
                self.set_channel(channel, ChannelParameter::ToolLock, 0);
                if in_hand {
                    self.copy_tool(channel, Block::Spindle, Block::Offset);
                }
            }
            (ChannelParameter::OffsetCommand, 1) => self.copy_tool(channel, Block::Spindle, Block::Offset),
            (ChannelParameter::OffsetCommand, 2) => self.copy_tool(channel, Block::Plc, Block::Offset),
            (ChannelParameter::StoreTool, 1) => self.store_tool(channel),
            _ => {}
        }
    }

    fn tool_length(&self, channel: u8) -> u32 {
        Layout::of(self, channel).map_or(LENGTH_MAX, |layout| layout.length.min(LENGTH_MAX))
    }

    fn tool_place(&self, channel: u8, block: Block, at: u32) -> Option<Place> {
        self.channel_place_at(channel, block.first(), at)
    }

    fn copy_tool(&mut self, channel: u8, from: Block, to: Block) {
        for at in 0..self.tool_length(channel) {
            if let (Some(from), Some(to)) = (
                self.tool_place(channel, from, at),
                self.tool_place(channel, to, at),
            ) {
                self.put(to, self.at(from));
            }
        }
    }

    /// The spindle block goes back to its record, and is cleared; nothing happens while it has no group.
    fn store_tool(&mut self, channel: u8) {
        let key = |memory: &Memory, first: Option<Place>| first.and_then(|place| memory.at(place).whole());
        let spindle = |at| self.tool_place(channel, Block::Spindle, at);
        let group = key(self, spindle(0)).filter(|group| *group != 0);
        let Some(group) = group else { return };
        let number = key(self, spindle(1));
        let length = self.tool_length(channel);
        let record = Layout::of(self, channel).and_then(|layout| {
            let records = (0..layout.records).filter_map(|record| layout.begin(record));
            let mut places = records.filter_map(|p| self.place(crate::Name::P(channel, p)).ok()?.q());
            places.find(|q| {
                let at = |offset| key(self, Some(Place::Q(q + offset)));
                at(0) == Some(group) && at(1) == number
            })
        });
        for at in 0..length {
            let Some(place) = self.tool_place(channel, Block::Spindle, at) else {
                continue;
            };
            if let Some(record) = record {
                self.put(Place::Q(record + at), self.at(place));
            }
            self.store(place, None, 0);
        }
    }
}
