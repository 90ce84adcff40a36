//! What the control shows of the program: of the block that is executed, and of the last one that the look-ahead has read
//! [002:4845-5024] [002:5026-5228].
//!
//! Decision: What a block of a System 900 does not say is cleared where its words are shown; P8943 and P9343 are 7 at the start, as
//! G7 is in force then

use bahn_path::{Axis, PerAxis};

use crate::memory::Memory;
use crate::name::Name;

/// What is in force in a block, by the numbers of its G functions, and what the block alone says.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct BlockState {
    /// G0 to G3.
    pub motion: u16,
    /// G5 to G7.
    pub turn: u16,
    /// G8, G9 in this block.
    pub stop_in_block: Option<u16>,
    /// G10, G11.
    pub polar: u16,
    /// G12 in this block.
    pub corner: Option<u16>,
    /// G13, G14.
    pub tangent: u16,
    /// G15, G16.
    pub polar_transformation: u16,
    /// G17 to G19, G117 to G119.
    pub plane: u16,
    /// Its logical axes.
    pub plane_axes: [u8; 3],
    /// G28, G29.
    pub exact_stop: u16,
    /// G40 to G42.
    pub radius: u16,
    /// G43, G44.
    pub correction: u16,
    /// G45, G46.
    pub rotation: u16,
    /// G47 to G49, G147.
    pub coordinates: u16,
    /// G53 and so on.
    pub zero_point: u16,
    /// G60 or G61, G60 or G62.
    pub mirrors: [u16; 2],
    /// G63, G64; 60 before the first one.
    pub full_feed: u16,
    /// G90, G91.
    pub measure: u16,
    /// 92 where a shift acts, else 0.
    pub shifted: u16,
    /// G93 to G95.
    pub feed_kind: u16,
    /// F, mm/min.
    pub feed: f64,
    /// S to S8.
    pub speeds: [f64; 8],
    /// Shifts of G92: logical axis, 0 for none, and mm.
    pub shifts: PerAxis<(u8, f64)>,
    /// Dwell of this block, s.
    pub dwell_s: Option<f64>,
    /// I, J, K and R of this block.
    pub centre: [Option<f64>; 4],
    /// M24: how often it jumps, and how often still.
    pub loops: Option<[u32; 2]>,
    /// How many loops are on their way.
    pub loop_depth: u32,
    /// How many cycles are within one another.
    pub level: u32,
    /// Where the program is: its number, its block.
    pub place: [u32; 2],
    /// The cycle, and its block.
    pub cycle: Option<[u32; 2]>,
    /// Program or cycle, and block, from which the cycle was called.
    pub call: Option<[u32; 2]>,
}

/// The words of a block.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct BlockWords {
    /// Places of logical axes.
    pub axes: PerAxis<(u8, Option<f64>)>,
    /// F, mm/min.
    pub feed: Option<f64>,
    /// G functions in the order of the text.
    pub g: [Option<u16>; 8],
    /// M functions with their two fields.
    pub m: [Option<(u16, [Option<u32>; 2])>; 8],
    /// Speeds.
    pub speeds: [Option<f64>; 8],
}

/// A channel whose parameters show something.
struct Display<'a>(&'a mut Memory, u8);

impl Display<'_> {
    /// A number with so many decimals; `None` clears the parameter.
    fn decimal(&mut self, number: u32, value: Option<f64>, decimals: u8) {
        if let Ok(place) = self.0.place(Name::P(self.1, number)) {
            self.0.store(place, value, decimals);
        }
    }

    fn number(&mut self, number: u32, value: impl Into<f64>) {
        self.decimal(number, Some(value.into()), 0);
    }

    fn maybe(&mut self, number: u32, value: Option<impl Into<f64>>) {
        self.decimal(number, value.map(Into::into), 0);
    }

    /// What both displays have, the second one so many after the first.
    fn common(&mut self, state: &BlockState, after: u32) {
        let first = 8900 + after;
        self.maybe(first + 4, state.cycle.map(|[number, _]| number));
        self.maybe(first + 5, state.cycle.map(|[_, block]| block));
        self.decimal(first + 41, state.dwell_s, 3);
        self.number(first + 43, state.turn);
        self.number(first + 45, state.polar);
        self.maybe(first + 46, state.corner);
        self.number(first + 50, state.plane);
        for (at, axis) in (first + 51..).zip(state.plane_axes) {
            self.number(at, axis);
        }
        self.number(first + 58, state.exact_stop);
        self.number(first + 64, state.radius);
        self.number(first + 65, state.correction);
        self.number(first + 66, state.rotation);
        self.number(first + 67, state.coordinates);
        self.number(first + 69, state.zero_point);
        for (at, mirror) in (first + 70..).zip(state.mirrors) {
            self.number(at, mirror);
        }
        self.number(first + 72, state.full_feed);
        self.number(first + 78, state.measure);
        self.number(first + 79, state.shifted);
    }

    fn shifts(&mut self, first: u32, state: &BlockState) {
        for axis in Axis::ALL {
            let (logical, shift) = state.shifts[axis];
            if logical > 0 {
                self.decimal(first + u32::from(logical) - 1, Some(shift), 3);
            }
        }
    }
}

impl Memory {
    /// Shows the tool of the block that a channel executes: group, sub record, radius, length, their corrections, type.
    pub fn show_tool(&mut self, channel: u8) {
        for at in [0, 3, 10, 11, 12, 13, 14] {
            let Ok(cell) = self.cell(Name::P(channel, 8200 + at)) else {
                return;
            };
            let decimals = cell.status().decimals();
            Display(self, channel).decimal(9080 + at, cell.number(), decimals);
        }
    }

    /// Shows what is in force in the block that a channel executes.
    pub fn show_executed(&mut self, channel: u8, state: &BlockState) {
        let mut display = Display(self, channel);
        display.common(state, 0);
        display.number(8912, state.level);
        display.maybe(8913, state.call.map(|[program, _]| program));
        display.maybe(8914, state.call.map(|[_, block]| block));
        for (at, value) in (8918..).zip(state.centre) {
            display.decimal(at, value, 3);
        }
        display.maybe(8934, state.loops.map(|[programmed, _]| programmed));
        display.maybe(8935, state.loops.map(|[_, left]| left));
        display.number(8947, state.tangent);
        display.number(8948, state.polar_transformation);
        display.number(8980, state.feed_kind);
        display.shifts(9100, state);
    }

    /// Shows what is in force in the block that the look-ahead of a channel has read last, and its words.
    pub fn show_read(&mut self, channel: u8, state: &BlockState, words: &BlockWords) {
        let mut display = Display(self, channel);
        display.common(state, 400);
        let [program, block] = state.place;
        display.number(9300, program);
        display.number(9301, block);
        display.number(9303, state.level);
        let [i, j, k, _] = state.centre;
        for (at, value) in (9318..).zip([i, j, k]) {
            display.decimal(at, value, 3);
        }
        for (at, speed) in (9325..).zip(state.speeds) {
            display.decimal(at, Some(speed), 3);
        }
        display.number(9334, state.loop_depth);
        display.decimal(9336, Some(state.feed), 3);
        display.number(9340, state.motion);
        display.maybe(9344, state.stop_in_block);
        display.shifts(9500, state);
        for axis in Axis::ALL {
            let (logical, to) = words.axes[axis];
            if logical > 0 {
                display.decimal(9699 + u32::from(logical), to, 3);
            }
        }
        for (at, value) in (9732..).zip(state.centre) {
            display.decimal(at, value, 3);
        }
        display.decimal(9739, words.feed, 3);
        for (at, function) in (9740..).zip(words.g) {
            display.maybe(at, function);
        }
        for (at, function) in (9750..).step_by(3).zip(words.m) {
            display.maybe(at, function.map(|(number, _)| number));
            let [target, count] = function.map_or([None; 2], |(_, fields)| fields);
            display.maybe(at + 1, target);
            display.maybe(at + 2, count);
        }
        for (at, speed) in (9780..).zip(words.speeds) {
            display.decimal(at, speed, 3);
        }
    }
}
