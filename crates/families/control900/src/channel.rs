//! A channel: its program on its track, and what the operator and the PLC want of it.

use std::sync::Arc;

use bahn_kernel::{
    Acting, Chain, Demands, Feeder, Now, Offsets, Outputs, OwnAxes, Run, RunFamily, SpindleLoop, Track,
};
use bahn_motion::{FunctionOutput, Limits, Place};
use bahn_path::{Axis, BlockRef, FeedRate, Function, LiveData, Position, Voltage};
use bahn_reader::Reader;
use bahn_servo::Timing;
use bahn_system900::{Acts, AxisParameter, ChannelParameter, MTable, Memory};

use crate::kinematics::OfAxes;
use crate::transfer::{Transfer, Transfers, When};

/// The tool change [002:1795-1801].
const TOOL_CHANGE: u16 = 6;

/// The modes of a channel [002:3773-3787].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Axes are moved by hand: HAND.
    #[default]
    Hand,
    /// Blocks one after the other.
    Sequence,
    /// Each block with its own start.
    Single,
    /// Blocks that are entered one by one.
    Positioning,
}

impl Mode {
    /// That of P8703; P8683 prints 3 for single blocks, too.
    pub fn of(number: i64) -> Option<Mode> {
        Some(match number {
            1 => Mode::Hand,
            2 => Mode::Sequence,
            3 | 4 => Mode::Single,
            8 => Mode::Positioning,
            _ => return None,
        })
    }

    /// The number of P8703.
    pub fn number(self) -> i64 {
        match self {
            Mode::Hand => 1,
            Mode::Sequence => 2,
            Mode::Single => 4,
            Mode::Positioning => 8,
        }
    }
}

/// What is wanted of a run and not done yet.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wanted {
    pub start: bool,
    pub stop: bool,
    pub abort: bool,
}

/// System parameters that programs have written, which may run a routine.
#[derive(Clone, Debug, Default)]
pub(crate) struct Written(Vec<u32>);

impl Written {
    /// As many as a cycle brings at most.
    const KEPT: usize = 1024;

    /// Makes room.
    pub fn reserve(&mut self) {
        if self.0.capacity() < Written::KEPT {
            self.0.reserve(Written::KEPT - self.0.len());
        }
    }

    /// One was written.
    pub fn push(&mut self, q: u32) {
        self.0.push(q);
    }

    /// The first one that nobody has looked at.
    pub fn take(&mut self) -> Option<u32> {
        (!self.0.is_empty()).then(|| self.0.remove(0))
    }
}

/// A restart on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Restart {
    /// The program is read up to a block, by its place in the order of execution.
    Simulating(u64),
    /// The axes go to where this block begins.
    Approaching(u64),
}

/// A channel of the control.
#[derive(Clone)]
pub(crate) struct Channel {
    /// From 1 on.
    pub number: u8,
    pub run: Run,
    pub chain: Chain,
    pub spindle: SpindleLoop,
    /// What starts.
    pub program: Option<Box<dyn Reader>>,
    /// Emergency programs 1 to 4.
    pub emergency: [Option<Box<dyn Reader>>; 4],
    /// One of them was called.
    pub called: Option<usize>,
    /// One of them is what starts, or runs.
    pub runs: Option<usize>,
    /// What runs.
    pub feeder: Option<Feeder>,
    pub mode: Mode,
    pub wanted: Wanted,
    /// How M functions act.
    pub m: MTable,
    /// M functions with stop wait for their acknowledgement.
    pub waits_for_m: bool,
    /// M6 went out.
    pub changes_tool: bool,
    /// A branch that waits for its confirmation, until its block is over: the target.
    pub branch: Option<Branch>,
    /// The block with M26 that is executed, whose way may be ended, by its place in the order of execution.
    pub residual: Option<u64>,
    /// The branch was confirmed, or the way is to end: the path stops, and goes on there.
    pub jump: Option<Branch>,
    /// The axes may move: P8701, P8702.
    pub axes_enabled: bool,
    pub safety_stop: bool,
    pub loops_enabled: bool,
    /// How fast the slopes of its axes let the path be, mm/min.
    pub slope_mm_min: f64,
    /// The block that is shown, and its number.
    pub shown: Option<(BlockRef, u32)>,
    /// The place in the order of execution of the block whose G functions are shown.
    pub shown_sequence: Option<u64>,
    /// Override of the path, %.
    pub override_percent: f64,
    /// P8817: the feed of the block of this place in the order of execution, mm/min.
    pub block_feed: Option<(u64, f64)>,
    /// A restart at the contour is on its way.
    pub restart: Option<Restart>,
    /// Where the axes stood when its program began from its start.
    pub began_at: Option<Position>,
    /// Where a restart would begin, by the order of execution, and whether that is in a cycle.
    pub place: Option<(u64, bool)>,
    /// The block whose fault has broken the program off.
    pub faulty: Option<BlockRef>,
}

/// A branch function on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Branch {
    /// The block in which it stands, by its place in the order of execution.
    pub sequence: u64,
    /// The block where the program goes on; `None` is the one after it.
    pub target: Option<u32>,
}

impl Channel {
    pub fn new(number: u8, limits: &Limits, timing: Timing, memory: &Memory) -> Channel {
        let offsets = Offsets {
            datum: Position::ZERO,
            tool_axis: Axis::Z,
            tool_length: 0.0,
        };
        Channel {
            number,
            run: Run::new(Track::new(limits)),
            chain: Chain::new(Arc::new(OfAxes), offsets),
            spindle: SpindleLoop::none(timing),
            program: None,
            emergency: [const { None }; 4],
            called: None,
            runs: None,
            feeder: None,
            mode: Mode::Hand,
            wanted: Wanted::default(),
            m: MTable::of(memory, number),
            waits_for_m: false,
            changes_tool: false,
            branch: None,
            residual: None,
            jump: None,
            axes_enabled: false,
            safety_stop: false,
            loops_enabled: false,
            slope_mm_min: f64::INFINITY,
            shown: None,
            shown_sequence: None,
            override_percent: 100.0,
            block_feed: None,
            restart: None,
            began_at: None,
            place: None,
            faulty: None,
        }
    }

    /// What of it a cycle asks of the run, whose path is held, or stops before a block.
    pub fn demands(&self, held: bool, stop_before: Option<u64>) -> Demands {
        Demands {
            single_block: matches!(self.mode, Mode::Single | Mode::Positioning),
            crowded: self.safety_stop || !self.axes_enabled || self.jump.is_some() || held,
            stop_before,
            ..Demands::default()
        }
    }

    /// The override of the path, %, with what P8817 makes of the feed of the block that is executed.
    ///
    /// Decision: P8817 of a System 900 counts when it is written, for the block that is executed then, where that has a
    /// programmed feed; the override acts on it
    pub fn feed_percent(&self) -> f64 {
        let of_block =
            self.block_feed
                .zip(self.run.element())
                .map(|((sequence, feed), element)| match element.feed {
                    FeedRate::Programmed(programmed) if element.sequence == sequence && programmed > 0.0 => {
                        feed / programmed
                    }
                    _ => 1.0,
                });
        self.override_percent * of_block.unwrap_or(1.0)
    }

    /// What a start runs.
    pub fn starting(&self) -> Option<&dyn Reader> {
        let emergency = |which: usize| self.emergency.get(which).and_then(Option::as_deref);
        match self.runs {
            Some(which) => emergency(which),
            None => self.program.as_deref(),
        }
    }

    /// The block that is executed; that of the program where none is.
    pub fn block(&self) -> BlockRef {
        self.run
            .element()
            .map_or_else(BlockRef::default, |element| element.block)
    }
}

/// Where the run of a channel acts.
pub(crate) struct Site<'a> {
    pub number: u8,
    pub axes: OwnAxes<'a>,
    pub chain: &'a mut Chain,
    pub spindle: &'a mut SpindleLoop,
    pub m: &'a MTable,
    pub waits_for_m: &'a mut bool,
    pub changes_tool: &'a mut bool,
    pub branch: &'a mut Option<Branch>,
    pub residual: &'a mut Option<u64>,
    pub transfers: &'a mut Transfers,
    pub memory: &'a mut Memory,
    pub written: &'a mut Written,
    /// Where functions go out now.
    pub at: Option<FunctionOutput>,
    pub now: Now,
}

impl Site<'_> {
    /// An M function goes to the PLC, as its definition says.
    pub fn transfer(&mut self, m: u16, target: Option<u32>) {
        let rule = self.m.rule(m);
        if matches!(rule.acts, Acts::None | Acts::Cycle) {
            return;
        }
        // By hand they go out.
        let without = self.memory.of_channel(self.number, ChannelParameter::WithoutM);
        if self.at.is_some() && without.whole() == Some(1) {
            return;
        }
        let place = self.at.map_or(Place::Start, |at| at.place);
        let branch = rule.acts == Acts::Branch;
        let stop = branch || rule.acts == Acts::Stop;
        self.transfers.push(Transfer {
            time_us: self.now.us,
            channel: self.number,
            m,
            when: match place {
                Place::End => When::After,
                Place::Start | Place::Along(_) => When::Before,
            },
            stop,
            branch,
            block: self.at.map_or(0, |at| at.block.block),
            target: target.filter(|_| branch),
            at: self.at.map_or_else(BlockRef::default, |at| at.block),
            ack_us: None,
            taken: false,
        });
        if stop {
            self.memory
                .set_channel(self.number, ChannelParameter::BlockRelease, 0);
        }
        *self.changes_tool |= m == TOOL_CHANGE;
        match (branch, target) {
            (true, Some(target)) => {
                let sequence = self.at.map_or(0, |at| at.sequence);
                *self.branch = Some(Branch {
                    sequence,
                    target: Some(target),
                });
            }
            (true, None) => {}
            _ if stop => {
                *self.waits_for_m = true;
                self.memory
                    .set_channel(self.number, ChannelParameter::WaitsForM, 1);
            }
            _ => {}
        }
    }
}

impl Outputs for Site<'_> {
    fn begin(&mut self, at: &FunctionOutput) {
        self.at = Some(*at);
    }

    fn output(&mut self, function: &Function) -> bool {
        match function {
            Function::M(m) => self.transfer(*m, None),
            Function::Branch { m, target } => self.transfer(*m, Some(*target)),
            Function::Residual => *self.residual = self.at.map(|at| at.sequence),
            Function::Write { q, value } => {
                self.memory.store_exact(bahn_system900::Place::Q(*q), *value);
                self.written.push(*q);
            }
            Function::Shift { logical, by } => {
                let place = Memory::own_place(self.number, *logical, AxisParameter::DisplayShift);
                let decimals = self.memory.position_decimals(self.number);
                self.memory.store(place, Some(*by), decimals);
            }
            Function::SpindleSpeed(rpm) => self.memory.program_speed(self.number, *rpm),
            _ => {}
        }
        true
    }

    fn voltage(&mut self, _: Voltage, _: u64) {}
}

impl<'a> RunFamily<'a> for Site<'a> {
    fn acting(&mut self) -> Acting<'_, 'a> {
        Acting {
            axes: &mut self.axes,
            chain: self.chain,
            spindle: self.spindle,
            now: &self.now,
        }
    }

    fn has_transferred(&self) -> bool {
        !*self.waits_for_m
    }

    fn answer(&mut self) -> LiveData {
        LiveData::default()
    }
}
