//! What stays in force from block to block, and where it puts the coordinates of a program in the machine.
//!
//! Decision: A point of the program is turned by G45, mirrored by G61 and G62, moved by zero point, G92, G44 and the length
//! of the tool, in this order; P8892 mirrors what comes out. G92 is turned with it where P8859 does not say otherwise

use bahn_path::parallel::Side;
use bahn_path::{Axis, PerAxis, Plane, Position};
use bahn_system900::Memory;

use crate::axes::ChannelAxes;
use crate::contour::ContourRules;
use crate::feeds::Feeds;
use crate::refusal::{Refusal, wrong};
use crate::turning::{Turning, Way};

/// Kv of an axis that the channel does not have, 1/s: that of P12020 where it is cleared.
const KV: f64 = 16.0;

/// How F is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedKind {
    /// G93: the time of a block.
    Time,
    /// G94
    PerMinute,
    /// G95
    PerTurn,
}

/// What stays in force. At the start as [002:5075-5143] says.
#[derive(Clone, Debug)]
pub(crate) struct Modal {
    /// 0 to 3.
    pub motion: u8,
    /// Number of its G function.
    pub plane_word: u16,
    pub plane: Plane,
    /// G28
    pub exact_stop: bool,
    /// G44
    pub axis_correction: bool,
    /// G45: origin, and sine and cosine.
    pub rotation: Option<Turned>,
    /// G61, G62
    pub mirrored: [bool; 2],
    pub zero_point: u16,
    /// G90
    pub is_absolute: bool,
    pub g92: PerAxis<f64>,
    pub has_g92: bool,
    /// As it was programmed.
    pub feed: f64,
    pub feed_kind: FeedKind,
    /// Of the spindle words.
    pub speeds: [f64; 8],
    /// G96
    pub cuts: bool,
    /// G10
    pub is_polar: bool,
    /// The last radius and angle of G10.
    pub polar: [f64; 2],
    /// G63
    pub override_off: bool,
    /// G63, G64; 60 before the first one [002:5129-5131].
    pub full_feed: u16,
    /// G47, G147
    pub coordinates: u16,
    /// M24: how often it jumps, and how often still.
    pub loops: Option<[u32; 2]>,
    /// G81 to G85 that is modal.
    pub drilling: Option<u16>,
    pub feeds: Feeds,
    /// G41, G42, as they are programmed.
    pub side: Side,
    /// With its correction, mm.
    pub tool_radius: f64,
    pub contour: ContourRules,
    /// Where the zero of the program lies in the machine without rotation.
    pub shift: PerAxis<f64>,
    /// The logical axis of each, from 1; 0 where there is none.
    pub logical: PerAxis<u8>,
    /// Axes that turn their sense at the end, by P8892.
    pub turned_round: PerAxis<bool>,
    pub g92_is_turned: bool,
    /// G5, G6, G7: the way of axes that turn.
    pub way: Way,
    pub turns: PerAxis<Option<Turning>>,
}

/// A rotation about a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned {
    pub origin: [f64; 2],
    pub sin: f64,
    pub cos: f64,
}

impl Modal {
    /// As a program begins, before the memory is known.
    pub fn new() -> Modal {
        Modal {
            motion: 1,
            plane_word: 17,
            plane: Plane::XY,
            exact_stop: false,
            axis_correction: false,
            rotation: None,
            mirrored: [false; 2],
            zero_point: 53,
            is_absolute: true,
            g92: PerAxis::default(),
            has_g92: false,
            feed: 0.0,
            feed_kind: FeedKind::PerMinute,
            speeds: [0.0; 8],
            cuts: false,
            is_polar: false,
            polar: [0.0; 2],
            override_off: false,
            full_feed: 60,
            coordinates: 147,
            loops: None,
            drilling: None,
            feeds: Feeds::default(),
            side: Side::Off,
            tool_radius: 0.0,
            contour: ContourRules::default(),
            shift: PerAxis::default(),
            logical: PerAxis::default(),
            turned_round: PerAxis::default(),
            g92_is_turned: true,
            way: Way::Shortest,
            turns: PerAxis::default(),
        }
    }

    /// Takes plane, zero point and shifts from the memory.
    pub fn refresh(&mut self, memory: &Memory, channel: u8, axes: &ChannelAxes) -> Result<(), Refusal> {
        let data = memory.path_data(channel);
        let which = match self.plane_word {
            18 => 1,
            19 => 2,
            117 => 3,
            118 => 4,
            119 => 5,
            _ => 0,
        };
        let mut slots = [Axis::X, Axis::Y, Axis::Z];
        for (slot, logical) in slots.iter_mut().zip(data.plane(which)) {
            match axes.of_logical(logical) {
                Some(axis) => *slot = axis.slot,
                None if axes.iter().next().is_none() => {}
                None => {
                    return wrong(format!(
                        "G{}: logical axis {logical} of the plane is none",
                        self.plane_word
                    ));
                }
            }
        }
        let [first, second, normal] = slots;
        if first == second || second == normal || first == normal {
            return wrong(format!("G{}: the plane names an axis twice", self.plane_word));
        }
        self.plane = Plane {
            first,
            second,
            normal,
        };
        let mirrored = data.mirrored();
        let [length, radius] = data.offsets();
        let kv = |slot: Axis| axes.of_slot(slot).map_or(KV, |axis| data.kv(axis.logical));
        let kv = kv(first).min(kv(second));
        self.tool_radius = radius;
        self.feeds = Feeds::of(&data, kv);
        self.contour = ContourRules::of(&data, kv);
        self.g92_is_turned = !data.g92_is_not_turned();
        for axis in axes.iter() {
            let mut shift = match data.zero_shift(self.zero_point, axis.logical) {
                Some(shift) => shift,
                None if self.zero_point == 153 => 0.0,
                None => {
                    return wrong(format!(
                        "G{}: the channel has no such zero point, q174",
                        self.zero_point
                    ));
                }
            };
            if self.axis_correction {
                shift += data.axis_shift(axis.logical);
            }
            if axis.slot == normal {
                shift += length;
            }
            self.shift[axis.slot] = shift;
            self.logical[axis.slot] = axis.logical;
            self.turns[axis.slot] = data.turn(axis.logical).map(Turning::of);
            self.turned_round[axis.slot] = mirrored >> (axis.logical - 1).min(31) & 1 != 0;
        }
        Ok(())
    }

    /// Takes the rotation that the parameters say now.
    pub fn turn(&mut self, memory: &Memory, channel: u8) {
        let [x, y, angle] = memory.path_data(channel).rotation();
        let (sin, cos) = angle.to_radians().sin_cos();
        self.rotation = Some(Turned {
            origin: [x, y],
            sin,
            cos,
        });
    }

    /// Whether the sense of circles turns round.
    pub fn is_turned_over(&self) -> bool {
        let Plane { first, second, .. } = self.plane;
        let [one, two] = self.mirrored;
        one ^ two ^ self.turned_round[first] ^ self.turned_round[second]
    }

    /// The side of the tool on the path in the machine.
    pub fn side_of_path(&self) -> Side {
        match self.is_turned_over() {
            true => self.side.mirrored(),
            false => self.side,
        }
    }

    /// A vector of the plane in the machine.
    pub fn vector(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [x, y] = match self.rotation {
            None => [u, v],
            Some(Turned { sin, cos, .. }) => [u * cos - v * sin, u * sin + v * cos],
        };
        let Plane { first, second, .. } = self.plane;
        let [one, two] = self.mirrored;
        let sign = |value: f64, turned: bool| if turned { -value } else { value };
        [
            sign(x, one ^ self.turned_round[first]),
            sign(y, two ^ self.turned_round[second]),
        ]
    }

    /// Whether an axis moves the other way than the program says, without rotation.
    pub fn is_reversed(&self, axis: Axis) -> bool {
        self.turned_round[axis] ^ self.is_mirrored(axis)
    }

    fn is_mirrored(&self, axis: Axis) -> bool {
        let [one, two] = self.mirrored;
        one && axis == self.plane.first || two && axis == self.plane.second
    }

    /// What the display of an axis leaves out: its shifts with that of G92.
    pub fn display_shift(&self, axis: Axis) -> f64 {
        self.shift[axis] + self.g92[axis]
    }

    /// A coordinate of the program in the machine, without rotation.
    pub fn axis_to_machine(&self, axis: Axis, value: f64) -> f64 {
        let mirrored = if self.is_mirrored(axis) { -value } else { value };
        let moved = mirrored + self.shift[axis] + self.g92[axis];
        if self.turned_round[axis] { -moved } else { moved }
    }

    /// Where an axis comes to by its word, without rotation.
    pub fn axis_end(&self, axis: Axis, value: f64, here: f64) -> f64 {
        match self.is_absolute {
            true => self.turned(axis, self.axis_to_machine(axis, value), here),
            false => here + if self.is_reversed(axis) { -value } else { value },
        }
    }

    /// Where an axis that turns comes to, whose place is programmed absolutely.
    pub fn turned(&self, axis: Axis, end: f64, here: f64) -> f64 {
        match self.turns[axis] {
            None => end,
            Some(turning) => turning.end(self.way, end, here),
        }
    }

    /// Whether nothing but the shifts of its axes acts on a line that follows.
    pub fn is_straight(&self) -> bool {
        let is_free = !self.is_polar && self.rotation.is_none() && self.drilling.is_none();
        is_free && self.side == Side::Off && !self.exact_stop && self.feed_kind == FeedKind::PerMinute
    }

    /// A point of the program in the machine.
    pub fn to_machine(&self, program: &Position) -> Position {
        let mut at = *program;
        let Plane { first, second, .. } = self.plane;
        let inside = |axis: Axis| self.rotation.is_some() && self.g92_is_turned && self.plane.contains(axis);
        for axis in Axis::ALL.into_iter().filter(|axis| inside(*axis)) {
            at[axis] += self.g92[axis];
        }
        if let Some(Turned { origin, sin, cos }) = self.rotation {
            let (u, v) = (at[first], at[second]);
            at[first] = u * cos - v * sin + origin[0];
            at[second] = u * sin + v * cos + origin[1];
        }
        for (axis, mirrored) in [first, second].into_iter().zip(self.mirrored) {
            if mirrored {
                at[axis] = -at[axis];
            }
        }
        for axis in Axis::ALL {
            at[axis] += self.shift[axis];
            if !inside(axis) {
                at[axis] += self.g92[axis];
            }
            if self.turned_round[axis] {
                at[axis] = -at[axis];
            }
        }
        at
    }

    /// A point of the machine in the program.
    pub fn to_program(&self, machine: &Position) -> Position {
        let mut at = *machine;
        let Plane { first, second, .. } = self.plane;
        let inside = |axis: Axis| self.rotation.is_some() && self.g92_is_turned && self.plane.contains(axis);
        for axis in Axis::ALL {
            if self.turned_round[axis] {
                at[axis] = -at[axis];
            }
            at[axis] -= self.shift[axis];
            if !inside(axis) {
                at[axis] -= self.g92[axis];
            }
        }
        for (axis, mirrored) in [first, second].into_iter().zip(self.mirrored) {
            if mirrored {
                at[axis] = -at[axis];
            }
        }
        if let Some(Turned { origin, sin, cos }) = self.rotation {
            let (x, y) = (at[first] - origin[0], at[second] - origin[1]);
            at[first] = x * cos + y * sin;
            at[second] = y * cos - x * sin;
        }
        for axis in Axis::ALL.into_iter().filter(|axis| inside(*axis)) {
            at[axis] -= self.g92[axis];
        }
        at
    }
}
