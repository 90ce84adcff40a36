//! What changes while a program runs: a state to go back to is a copy.

use std::collections::VecDeque;

use bahn_din::system900::AxisName;
use bahn_path::{Axis, Barrier, BlockRef, Function, PathElement, PerAxis, Position};
use bahn_reader::ProgramError;
use bahn_system900::{AxisBlock, Memory, slots};

use crate::modal::Modal;

/// Cycles that call each other (inferred).
pub(crate) const NESTING_MAX: usize = 8;

/// The logical axes of a channel: what they are called, and their places on the path.
#[derive(Clone, Debug, Default)]
pub(crate) struct ChannelAxes(Vec<ChannelAxis>);

#[derive(Clone, Copy, Debug)]
struct ChannelAxis {
    logical: u8,
    physical: u8,
    name: AxisName,
    axis: Option<Axis>,
}

impl ChannelAxes {
    pub fn of(memory: &Memory, channel: u8) -> ChannelAxes {
        let slots = slots(memory, channel);
        let axes = memory.axis_words(channel).map(|(logical, word)| ChannelAxis {
            logical,
            physical: word.physical,
            name: AxisName {
                letter: char::from(word.letter).to_ascii_uppercase(),
                // A digit, as a number or as a character.
                extension: match word.extension {
                    digit @ b'1'..=b'9' => digit - b'0',
                    number => number,
                },
            },
            axis: slots.get(usize::from(logical) - 1).copied().flatten(),
        });
        ChannelAxes(axes.collect())
    }

    /// The place of a logical axis on the path.
    pub fn slot(&self, logical: u8) -> Option<Axis> {
        self.0.iter().find(|axis| axis.logical == logical)?.axis
    }

    /// The place of the axis with a name; the inner `None` where no program moves it.
    pub fn named(&self, name: AxisName) -> Option<Option<Axis>> {
        let found = self.0.iter().find(|axis| axis.name == name);
        found.map(|axis| axis.axis)
    }

    /// Logical axes with a place on the path.
    pub fn iter(&self) -> impl Iterator<Item = (u8, Axis)> {
        self.0.iter().filter_map(|axis| Some((axis.logical, axis.axis?)))
    }

    /// The gain of the position loop of an axis, 1/s.
    pub fn gain(&self, memory: &Memory, axis: Axis) -> Option<f64> {
        let found = self.0.iter().find(|own| own.axis == Some(axis))?;
        Some(AxisBlock::of(memory, found.physical).gain_s)
    }
}

/// Where a program goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    /// The file.
    pub program: u16,
    /// The line that is executed next, from 1.
    pub line: u32,
    /// The block that has called it: the movements of a cycle show it.
    pub caller: Option<BlockRef>,
}

/// A loop of M24.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Loop {
    pub program: u16,
    pub line: u32,
    pub left: u32,
}

/// What happens after a barrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Then {
    /// The next block.
    On,
    /// Where the PLC has given its condition the run goes on in a line: M22.
    SkipTo(u32),
}

#[derive(Clone, Debug)]
pub(crate) enum Item {
    Element(Box<PathElement>),
    Barrier(Box<Barrier>, Then),
}

#[derive(Clone, Debug)]
pub(crate) enum Ended {
    Finished,
    Failed(Box<ProgramError>),
}

/// All that changes while a program runs.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// The program, and the cycles that are open.
    pub levels: Vec<Level>,
    pub loops: Vec<Loop>,
    pub modal: Modal,
    /// How many blocks were executed so far.
    pub sequence: u64,
    /// Where the path ends, positions of the control.
    pub position: Position,
    /// Blocks since the last movement or wait.
    pub idle: u32,
    pub queue: VecDeque<Item>,
    pub waiting: Option<(Barrier, Then)>,
    /// The block that stops the run.
    pub stopped: Option<BlockRef>,
    pub ended: Option<Ended>,
}

impl Run {
    pub fn at(modal: Modal, position: Position) -> Run {
        let begin = Level {
            program: 0,
            line: 1,
            caller: None,
        };
        Run {
            levels: vec![begin],
            loops: Vec::new(),
            modal,
            sequence: 0,
            position,
            idle: 0,
            queue: VecDeque::new(),
            waiting: None,
            stopped: None,
            ended: None,
        }
    }
}

/// What the words of a block have said beside what stays in force.
#[derive(Clone, Debug, Default)]
pub(crate) struct Said {
    /// Coordinates by their places on the path.
    pub coordinates: PerAxis<Option<f64>>,
    /// I, J, K.
    pub centre: [Option<f64>; 3],
    pub radius: Option<f64>,
    pub feed: Option<f64>,
    pub tool: Option<i64>,
    /// Dwell, s.
    pub dwell_s: Option<f64>,
    /// G8, G9.
    pub stops_exactly: Option<bool>,
    /// G92 stands in the block.
    pub shifts: bool,
    /// Real-time parameters, which are written when the path comes to the block.
    pub writes: Vec<Function>,
}
