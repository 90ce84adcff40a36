//! The electronic handwheel: which axis its wheels lead and how far, and where its keys go [000:8060-8446].
//!
//! Decision: The first wheel of an HE 310 moves X or IV, the second Y or Z, as they were chosen last; so X-Y, X-Z, Y-IV and
//! IV-Z can move together
//!
//! Decision: Direction keys of a handwheel move axes in the mode Electronic Handwheel only; an HR 332 with all keys
//! at the PLC has its axis keys where places are left

use bahn_exchange::{Image, signal};
use bahn_kernel::{OwnAxes, within};
use bahn_parameters::operation::{Handwheel as Kind, HandwheelParameters};
use bahn_parameters::{MessageId, PerPlcAxis};
use bahn_path::Direction;
use bahn_servo::{HandwheelInputs, HandwheelKey, HandwheelKeys, WHEELS};

use crate::command::Mode;
use crate::markers::AXES;
use crate::message::Message;
use crate::reach::Reach;

/// Counting steps of a turn of the handwheel (inferred).
pub const HANDWHEEL_STEPS: f64 = 1000.0;
/// Travel of a turn with interpolation factor 0, mm [000:8071-8094].
const TRAVEL_MM: f64 = 20.0;
/// Highest interpolation factor: the slowest travel.
const FACTOR_MAX: u8 = 10;
/// Missing: the control asks for it.
const MISSING: Message = Message::Plain(MessageId::HandwheelMissing);

/// Keys that choose an axis, by the index of the axis.
const AXIS_KEYS: [HandwheelKey; AXES] = [
    HandwheelKey::X,
    HandwheelKey::Y,
    HandwheelKey::Z,
    HandwheelKey::Fourth,
    HandwheelKey::Fifth,
];
/// Keys that choose a speed of the HR 410, by the index of MP7670 and MP7671.
const SPEED_KEYS: [HandwheelKey; 3] = [HandwheelKey::Slow, HandwheelKey::Medium, HandwheelKey::Fast];

/// What is remembered of the handwheel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Handwheel {
    /// Axis index of the wheel that has no axis of its own.
    axis: usize,
    /// Axis indices of the two wheels of an HE 310.
    pair: [usize; 2],
    /// Interpolation factors, by axis index.
    factors: PerPlcAxis<u8>,
    /// Speed of the HR 410: slow, medium, fast.
    speed: usize,
    wheels: [Wheel; WHEELS],
    /// Keys of the cycle before, for their edges.
    keys: HandwheelKeys,
    /// It was asked for.
    missing: bool,
    /// What was turned for M118 in this cycle, by axis index, mm.
    travels: PerPlcAxis<f64>,
    /// The key for actual position capture was pressed.
    captures: bool,
    /// An axis key that highlights its axis was pressed.
    highlight: Option<usize>,
}

/// A handwheel, by the axis that it leads.
#[derive(Clone, Copy, Debug, Default)]
struct Wheel {
    /// Count up to which it was followed.
    count: Option<i64>,
    /// Axis index that it leads, and where to.
    lead: Option<(usize, f64)>,
}

impl Default for Handwheel {
    fn default() -> Handwheel {
        Handwheel {
            axis: 0,
            pair: [0, 1],
            factors: PerPlcAxis::splat(5),
            speed: 0,
            wheels: [Wheel::default(); WHEELS],
            keys: HandwheelKeys::default(),
            missing: false,
            travels: PerPlcAxis::splat(0.0),
            captures: false,
            highlight: None,
        }
    }
}

impl Handwheel {
    /// Counts the wheels without following them.
    pub fn forget_turns(&mut self, inputs: &HandwheelInputs) {
        for (wheel, count) in self.wheels.iter_mut().zip(inputs.counts) {
            wheel.count = Some(count);
        }
        self.travels = PerPlcAxis::splat(0.0);
    }

    /// What was turned for M118 in this cycle, by axis index, mm.
    pub fn travels(&self) -> PerPlcAxis<f64> {
        self.travels
    }

    /// Counts the wheels for M118: axes and factors are those of Electronic Handwheel.
    pub fn superimpose(
        &mut self,
        inputs: &HandwheelInputs,
        rules: &HandwheelParameters,
        axes: &OwnAxes,
        nc: &Image,
    ) {
        self.take_keys(inputs, rules, axes);
        self.travels = PerPlcAxis::splat(0.0);
        for (number, count) in inputs.counts.into_iter().enumerate() {
            let axis = wheel_axis(number, rules, inputs, (self.axis, self.pair));
            let factor = axis.map_or(FACTOR_MAX, |index| self.factor(index, rules, axes));
            let Some(wheel) = self.wheels.get_mut(number) else {
                continue;
            };
            wheel.lead = None;
            let before = wheel.count.replace(count).unwrap_or(count);
            let steps = count.wrapping_sub(before);
            let travel = axis.and_then(|index| self.travels.get_mut(index));
            let Some(travel) = travel.filter(|_| inputs.connected && rules.kind != Kind::None) else {
                continue;
            };
            if steps.unsigned_abs() < u64::from(rules.threshold) {
                wheel.count = Some(before);
            } else if !nc.bit(signal::SUPPRESS_HANDWHEEL) {
                *travel += travel_mm(steps, factor, rules);
            }
        }
    }

    /// Lets go of the axes.
    pub fn stop(&mut self) {
        for wheel in &mut self.wheels {
            wheel.lead = None;
        }
    }

    /// Axis index of the wheel.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// Interpolation factors by axis index.
    pub fn factors(&self) -> PerPlcAxis<u8> {
        self.factors
    }

    /// The wheel moves an axis with an interpolation factor. With MP7641 = 1 the factor is the PLC's: another one than
    /// that in force is refused [000:8108-8111].
    pub fn choose(&mut self, index: usize, factor: u8, rules: &HandwheelParameters) -> bool {
        let Some(own) = self.factors.get_mut(index) else {
            return false;
        };
        if rules.factor_from_plc && *own != factor {
            return false;
        }
        *own = factor;
        self.go_to(index);
        self.highlight = Some(index).filter(|_| shares_highlight(rules));
        true
    }

    /// The highlight goes to an axis: with MP7640 = 2 the handwheel, too [000:8139-8151].
    pub fn go_with_highlight(&mut self, index: usize, rules: &HandwheelParameters) {
        if shares_highlight(rules) {
            self.go_to(index);
        }
    }

    /// The wheel moves another axis, of an HE 310 the one that has it: X and IV are of its first wheel, Y and Z of its second
    /// (inferred from the pairs that move together [001:1073-1077]).
    fn go_to(&mut self, index: usize) {
        self.axis = index;
        let [first, second] = &mut self.pair;
        match index {
            0 | 3 => *first = index,
            1 | 2 => *second = index,
            _ => {}
        }
    }

    /// The axis that the highlight follows the handwheel to: MP7640 = 2 and an axis key of it was pressed.
    pub fn take_highlight(&mut self) -> Option<usize> {
        self.highlight.take()
    }

    /// Module 9036: factors and axis.
    pub fn take(&mut self, factors: PerPlcAxis<Option<u8>>, axis: Option<usize>) {
        for (factor, changed) in self.factors.iter_mut().zip(factors) {
            *factor = changed.unwrap_or(*factor);
        }
        if let Some(axis) = axis {
            self.go_to(axis);
        }
    }

    /// Where a wheel leads an axis.
    pub fn target(&self, index: usize) -> Option<f64> {
        let mut leads = self.wheels.iter().filter_map(|wheel| wheel.lead);
        leads.find(|(axis, _)| *axis == index).map(|(_, target)| target)
    }

    /// Looks at the keys, and asks for a handwheel that is not there.
    pub fn look(&mut self, inputs: &HandwheelInputs, reach: &mut Reach) {
        let rules = &reach.rules.handwheel;
        let missing = rules.kind != Kind::None && !inputs.connected;
        if missing && !self.missing {
            reach.messages.show(MISSING, reach.block);
        } else if self.missing && !missing {
            reach.messages.remove(&MISSING);
        }
        self.missing = missing;
        self.take_keys(inputs, rules, reach.axes);
    }

    /// The keys that choose an axis or a speed, or capture.
    fn take_keys(&mut self, inputs: &HandwheelInputs, rules: &HandwheelParameters, axes: &OwnAxes) {
        let before = std::mem::replace(&mut self.keys, inputs.keys);
        let pressed = |key: &HandwheelKey| inputs.keys.has(*key) && !before.has(*key);
        if axis_keys_are_of_the_nc(rules)
            && let Some(index) = AXIS_KEYS.iter().position(pressed)
            && axes.with_index(index).is_some()
        {
            self.go_to(index);
            self.highlight = Some(index).filter(|_| shares_highlight(rules));
        }
        if is_hr410_of_the_nc(rules)
            && let Some(speed) = SPEED_KEYS.iter().position(pressed)
        {
            self.speed = speed;
        }
        if is_hr410_of_the_nc(rules) {
            self.captures |= pressed(&HandwheelKey::Capture);
        }
    }

    /// Whether the key for actual position capture was pressed since this was asked: that of an HR 410 which the NC
    /// evaluates [000:8257-8269].
    pub fn take_capture(&mut self) -> bool {
        std::mem::take(&mut self.captures)
    }

    /// The direction key that moves an axis: with the HR 330 and the HR 410, where the NC has them [000:8124-8151] [000:8292-8304]. Both at once move nothing.
    pub fn direction(&self, rules: &HandwheelParameters) -> Option<(usize, Direction)> {
        let has = |key| self.keys.has(key);
        let of_the_nc = matches!(rules.kind, Kind::Hr330 | Kind::Hr130) || is_hr410_of_the_nc(rules);
        match (has(HandwheelKey::Plus), has(HandwheelKey::Minus)) {
            (true, false) if of_the_nc => Some((self.axis, Direction::Plus)),
            (false, true) if of_the_nc => Some((self.axis, Direction::Minus)),
            _ => None,
        }
    }

    /// The rapid traverse key of an HR 330 is pressed.
    pub fn rapid(&self, rules: &HandwheelParameters) -> bool {
        matches!(rules.kind, Kind::Hr330 | Kind::Hr130) && self.keys.has(HandwheelKey::Rapid)
    }

    /// Part of the manual feed with which a direction key moves, MP7671 with an HR 410 [000:8300-8304].
    pub fn share(&self, rules: &HandwheelParameters) -> f64 {
        let percent = rules
            .jog_percent
            .get(self.speed)
            .filter(|_| is_hr410_of_the_nc(rules));
        percent.map_or(1.0, |percent| percent / 100.0)
    }

    /// Follows the wheels: their steps move the targets of their axes. The limits that they would lead beyond.
    pub fn turn(
        &mut self,
        inputs: &HandwheelInputs,
        reach: &Reach,
        pushed: &mut PerPlcAxis<Option<Direction>>,
    ) {
        let rules = &reach.rules.handwheel;
        for (number, count) in inputs.counts.into_iter().enumerate() {
            let axis = wheel_axis(number, rules, inputs, (self.axis, self.pair));
            let factor = axis.map_or(FACTOR_MAX, |index| self.factor(index, rules, reach.axes));
            let Some(wheel) = self.wheels.get_mut(number) else {
                continue;
            };
            wheel.turn(count, axis.filter(|_| inputs.connected), factor, reach, pushed);
        }
    }

    /// The interpolation factor of an axis: not below what the rapid traverse of the slowest axis allows, nor
    /// MP7670; with an HR 410 that of the speed that is chosen.
    fn factor(&self, index: usize, rules: &HandwheelParameters, axes: &OwnAxes) -> u8 {
        let rapid = axes.iter().map(|unit| unit.parameters.motion.rapid_mm_min);
        let least = factor_min(rapid.fold(f64::INFINITY, f64::min));
        let [slow, ..] = rules.factor_min;
        let chosen = match rules.factor_min.get(self.speed) {
            Some(factor) if is_hr410_of_the_nc(rules) => *factor,
            _ => self.factors.get(index).copied().unwrap_or(FACTOR_MAX).max(slow),
        };
        chosen.max(least)
    }
}

impl Wheel {
    fn turn(
        &mut self,
        count: i64,
        axis: Option<usize>,
        factor: u8,
        reach: &Reach,
        pushed: &mut PerPlcAxis<Option<Direction>>,
    ) {
        let before = self.count.replace(count).unwrap_or(count);
        if self.lead.is_some_and(|(index, _)| Some(index) != axis) {
            self.lead = None;
        }
        let rules = &reach.rules.handwheel;
        let there = reach.mode == Mode::Handwheel && rules.kind != Kind::None;
        let unit = axis.and_then(|index| reach.axes.with_index(index));
        // What is turned while the feed is not enabled moves nothing later.
        let Some((index, unit)) = axis.zip(unit.filter(|unit| there && unit.enabled)) else {
            self.lead = None;
            return;
        };
        let steps = count.wrapping_sub(before);
        let few = steps.unsigned_abs() < u64::from(rules.threshold);
        if few || reach.nc.bit(signal::SUPPRESS_HANDWHEEL) {
            if steps != 0 && few {
                // A vibration: its steps are counted together with those that follow.
                self.count = Some(before);
            }
        } else if steps != 0 {
            let from = self.lead.map_or(unit.nominal, |(_, target)| target);
            let target = from + travel_mm(steps, factor, rules);
            let (target, limit) = within(unit, target);
            self.lead = Some((index, target));
            if let Some(slot) = pushed.get_mut(index) {
                *slot = limit;
            }
        }
        if self.lead == Some((index, unit.nominal)) && unit.stands() {
            self.lead = None;
        }
    }
}

/// How far counting steps lead, mm.
fn travel_mm(steps: i64, factor: u8, rules: &HandwheelParameters) -> f64 {
    let travel = TRAVEL_MM / f64::from(1u32 << factor.min(FACTOR_MAX));
    rules.direction.sign() * steps as f64 / HANDWHEEL_STEPS * travel
}

/// The axis that a wheel leads: the first and second at an HRA 110 X and Y, the third the one of MP7645 or of
/// switch S2; those of an HE 310 one of a pair each [001:1073-1077]; all others the one that is chosen [000:8310-8351].
fn wheel_axis(
    number: usize,
    rules: &HandwheelParameters,
    inputs: &HandwheelInputs,
    (chosen, pair): (usize, [usize; 2]),
) -> Option<usize> {
    match (rules.kind, number) {
        (Kind::He310, _) => pair.get(number).copied(),
        (Kind::Hra110, 0 | 1) => Some(number),
        (Kind::Hra110, _) => third_axis(rules.initialization, inputs.switches[1]),
        (_, 0) => Some(chosen),
        _ => None,
    }
}

/// The axis of the third wheel at an HRA 110, with switch S2 in a position from 1, or without it (0).
fn third_axis([first, fixed, from_parameter, ..]: [u8; 8], position: u8) -> Option<usize> {
    if from_parameter == 1 || position == 0 {
        let axis = fixed.trailing_zeros() as usize;
        return (fixed.is_power_of_two() && axis < AXES).then_some(axis);
    }
    let position = usize::from(position);
    match (first, position) {
        (0, 1..=3) => Some(position + 1),
        (1, 1..=5) | (2, 3..=5) => Some(position - 1),
        _ => None,
    }
}

fn axis_keys_are_of_the_nc(rules: &HandwheelParameters) -> bool {
    match rules.kind {
        Kind::Hr330 | Kind::Hr130 | Kind::Hr330Plc | Kind::He310 => true,
        Kind::Hr332 | Kind::Hr410 => rules.initialization[0] == 0,
        _ => false,
    }
}

/// Axis keys of the keyboard and of the handwheel move highlight and symbol together: HR 130, or HR 330 with MP7640 = 2
/// [000:8139-8151].
fn shares_highlight(rules: &HandwheelParameters) -> bool {
    rules.kind == Kind::Hr130
}

fn is_hr410_of_the_nc(rules: &HandwheelParameters) -> bool {
    rules.kind == Kind::Hr410 && rules.initialization[0] == 0
}

/// The inputs I160 to I175 as a handwheel sets them [000:8153-8186] [000:8257-8302] [000:8353-8385].
pub(crate) fn plc_inputs(rules: &HandwheelParameters, inputs: &HandwheelInputs) -> [bool; 16] {
    use HandwheelKey as Key;
    let mut bits = [false; 16];
    let mut put = |keys: &[(usize, Key)]| {
        for (place, key) in keys {
            if let Some(bit) = bits.get_mut(*place) {
                *bit = inputs.connected && inputs.keys.has(*key);
            }
        }
    };
    // - and + of the HR 332 are at I169 and I170 [000:8225]; its other keys have no names.
    const HR332: [(usize, Key); 7] = [
        (4, Key::Free1),
        (5, Key::Free2),
        (6, Key::Free3),
        (7, Key::Free4),
        (8, Key::Free5),
        (9, Key::Minus),
        (10, Key::Plus),
    ];
    // The places of the axis keys are inferred from those that are left.
    const HR332_AXES: [(usize, Key); AXES] = [
        (0, Key::X),
        (1, Key::Y),
        (2, Key::Z),
        (3, Key::Fourth),
        (11, Key::Fifth),
    ];
    const HR410_FREE: [(usize, Key); 3] = [(13, Key::A), (14, Key::B), (15, Key::C)];
    const HR410: [(usize, Key); 11] = [
        (0, Key::X),
        (1, Key::Fourth),
        (2, Key::Y),
        (3, Key::Fifth),
        (4, Key::Z),
        (7, Key::Capture),
        (8, Key::Slow),
        (9, Key::Medium),
        (10, Key::Fast),
        (11, Key::Minus),
        (12, Key::Plus),
    ];
    match rules.kind {
        Kind::Hr330 | Kind::Hr130 | Kind::Hr330Plc => {
            put(&[(0, Key::Plus), (1, Key::Minus), (2, Key::Rapid)]);
        }
        Kind::Hr332 => {
            put(&HR332);
            if rules.initialization[0] == 1 {
                put(&HR332_AXES);
            }
        }
        Kind::Hr410 => {
            put(&HR410_FREE);
            if rules.initialization[0] == 1 {
                put(&HR410);
            }
        }
        Kind::Hra110 => {
            // 0 V logic: the contact of the position is 0.
            for (first, position) in [0, 8].into_iter().zip(inputs.switches) {
                for (place, bit) in (0..8).zip(bits.iter_mut().skip(first)) {
                    *bit = inputs.connected && position != 0 && place + 1 != usize::from(position);
                }
            }
        }
        Kind::None | Kind::He310 => {}
    }
    bits
}

/// Least interpolation factor that the rapid traverse of the slowest axis allows [000:8075-8092].
pub(crate) fn factor_min(rapid_mm_min: f64) -> u8 {
    // Rapid traverse from which on factors 0 to 4 are possible.
    const FROM: [f64; 5] = [12_000.0, 6_000.0, 3_000.0, 1_500.0, 750.0];
    let factor = FROM
        .iter()
        .position(|from| rapid_mm_min >= *from)
        .unwrap_or(FROM.len());
    u8::try_from(factor).unwrap_or(FACTOR_MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of the manual: rapid traverse 12 000 allows factor 0, 80 mm/min only 5 to 10
    /// [000:8075-8092].
    #[test]
    fn least_factor_by_rapid_traverse() {
        for (rapid, factor) in [
            (15_000.0, 0),
            (12_000.0, 0),
            (11_999.0, 1),
            (6_000.0, 1),
            (3_000.0, 2),
            (1_500.0, 3),
            (750.0, 4),
            (80.0, 5),
        ] {
            assert_eq!(factor_min(rapid), factor, "{rapid}");
        }
    }

    /// The tables of the third handwheel: MP7645.0 with the positions of S2, and MP7645.1 [000:8310-8349].
    #[test]
    fn axes_of_the_third_wheel() {
        let axes = |first, positions: [u8; 5]| {
            positions.map(|position| third_axis([first, 0, 0, 0, 0, 0, 0, 0], position))
        };
        let (z, fourth, fifth) = (Some(2), Some(3), Some(4));
        assert_eq!(axes(0, [1, 2, 3, 4, 5]), [z, fourth, fifth, None, None]);
        assert_eq!(axes(1, [1, 2, 3, 4, 5]), [Some(0), Some(1), z, fourth, fifth]);
        assert_eq!(axes(2, [1, 2, 3, 4, 5]), [None, None, z, fourth, fifth]);
        for (value, axis) in [
            (1, Some(0)),
            (2, Some(1)),
            (4, z),
            (8, fourth),
            (16, fifth),
            (3, None),
        ] {
            assert_eq!(
                third_axis([0, value, 1, 0, 0, 0, 0, 0], 2),
                axis,
                "by MP7645.1 = {value}"
            );
            assert_eq!(
                third_axis([0, value, 0, 0, 0, 0, 0, 0], 0),
                axis,
                "without a switch"
            );
        }
    }
}
