//! Single axes beside all paths: direction keys and steps in HAND, positions of the PLC, the reference point, handwheels.
//!
//! Decision: Keys and steps move axes in HAND alone, with P8755, at most P8754; where neither is loaded as fast as the axis
//! can
//!
//! Decision: An axis that has taken its reference point comes to a stop by itself
//!
//! Decision: A relative position counts from the nominal position at the moment of the write

use bahn_kernel::{AxisUnit, HandMove, Mover, Now, move_by_hand, within};
use bahn_motion::Aim;
use bahn_path::Direction;
use bahn_servo::Measured;
use bahn_system900::{AxisParameter, ChannelParameter, Memory};

use crate::axis_state::{AxisPlace, Goal, Hand, Report};
use crate::channel::Mode;
use crate::enable::{is_locked, slope_mm_min};
use crate::machine::Machine;
use crate::spindles;

/// Handwheels.
const WHEELS: u8 = 8;
/// Steps of the manual table where none is loaded, mm (inferred: their first ones are lost).
const STEPS_MM: [f64; 7] = [10.0, 1.0, 0.1, 0.01, 0.001, 0.0, 0.0];

/// P8752: the axis of P8751 moves as P8750 says [002:3983-4009].
pub(crate) fn begin_by_hand(machine: &mut Machine, number: u8) {
    let of = |parameter| machine.memory.of_channel(number, parameter);
    let direction = match of(ChannelParameter::ManualMove).whole() {
        Some(1) => Some(Direction::Plus),
        Some(2) => Some(Direction::Minus),
        _ => None,
    };
    let feed = manual_feed(machine, number);
    let is_step = of(ChannelParameter::ManualMode).whole() == Some(2);
    let step = step_mm(machine, number);
    let logical = of(ChannelParameter::ManualAxis).whole().unwrap_or(0);
    let is_hand = machine
        .channels
        .get(usize::from(number) - 1)
        .is_some_and(|channel| channel.mode == Mode::Hand);
    let places = machine
        .places
        .iter()
        .zip(&mut machine.hands)
        .zip(machine.core.axes.iter());
    for ((place, hand), unit) in places.filter(|((place, _), _)| place.channel + 1 == number) {
        let is_meant = i64::from(place.logical) == logical && is_hand;
        hand.key = None;
        match direction.filter(|_| is_meant) {
            Some(direction) if is_step && hand.goal.is_none() => {
                let (position, _) = within(unit, unit.nominal + direction.sign() * step);
                hand.goal = Some(Goal {
                    position,
                    feed_mm_min: feed,
                    reports: None,
                });
            }
            Some(direction) if !is_step => hand.key = Some((direction, feed)),
            _ => {}
        }
    }
}

/// The feed by hand, mm/min.
fn manual_feed(machine: &Machine, number: u8) -> f64 {
    let of = |parameter| {
        let feed = machine.memory.of_channel(number, parameter).number();
        feed.filter(|feed| *feed > 0.0).unwrap_or(f64::INFINITY)
    };
    of(ChannelParameter::ManualFeed).min(of(ChannelParameter::ManualFeedMax))
}

/// P8756: the feed by hand, where one is given.
fn show_feed(machine: &mut Machine, number: u8, feed: f64) {
    if let Some(place) = machine
        .memory
        .channel_place(number, ChannelParameter::ManualFeedActual)
    {
        machine.memory.store(place, Some(feed), 3);
    }
}

/// P12171 to P12173: how fast an axis goes to a relative, absolute, fixed position; 0 to the others.
fn show_speeds(place: &AxisPlace, hand: &Hand, unit: &AxisUnit, memory: &mut Memory) {
    let first = Memory::axis_place(place.physical, AxisParameter::RelativeSpeedActual);
    let Some(first) = first.and_then(|first| first.q()) else {
        return;
    };
    let reports = hand.goal.and_then(|goal| goal.reports);
    let speed = unit.servo.actual_velocity_mm_min().abs();
    let is = |parameter, after| {
        reports.is_some_and(|report| (report.parameter, report.after) == (parameter, after))
    };
    let kinds = [
        is(AxisParameter::Reached, 0),
        is(AxisParameter::Reached, 1),
        is(AxisParameter::FixedReached, 0),
    ];
    for (q, is_meant) in (first..).zip(kinds) {
        let shown = if is_meant { speed } else { 0.0 };
        memory.store(bahn_system900::Place::Q(q), Some(shown), 3);
    }
}

/// The step by hand, mm.
fn step_mm(machine: &Machine, number: u8) -> f64 {
    let at = machine
        .memory
        .of_channel(number, ChannelParameter::StepPointer)
        .whole()
        .unwrap_or(0);
    let at = u32::try_from(at).unwrap_or(0).min(STEPS_MM.len() as u32 - 1);
    let place = machine
        .memory
        .channel_place_at(number, ChannelParameter::StepTable, at);
    let own = place.and_then(|place| machine.memory.at(place).number());
    own.or(STEPS_MM.get(at as usize).copied()).unwrap_or(0.0)
}

/// P8761: the next step of the table.
pub(crate) fn next_step(machine: &mut Machine, number: u8) {
    let at = machine
        .memory
        .of_channel(number, ChannelParameter::StepPointer)
        .whole()
        .unwrap_or(0);
    let next = (at + 1) % STEPS_MM.len() as i64;
    machine
        .memory
        .set_channel(number, ChannelParameter::StepPointer, next);
    machine.memory.set_channel(number, ChannelParameter::NextStep, 0);
    let step = step_mm(machine, number);
    if let Some(place) = machine.memory.channel_place(number, ChannelParameter::StepWidth) {
        machine.memory.store(place, Some(step), 3);
    }
}

/// P12111, P12112: a position of the PLC is written, or cleared [002:7799-7815].
pub(crate) fn position(machine: &mut Machine, physical: u8, parameter: AxisParameter) {
    let second = u32::from(parameter == AxisParameter::GoAbsolute);
    let value = machine.memory.of_axis(physical, parameter).number();
    let speed = axis_number(&machine.memory, physical, AxisParameter::RelativeSpeed, second);
    let percent = position_percent(machine, physical, second);
    report(
        &mut machine.memory,
        physical,
        Report {
            bits: 0,
            ..Report::reached(second)
        },
    );
    let axes = machine
        .places
        .iter()
        .zip(&mut machine.hands)
        .zip(machine.core.axes.iter());
    for ((place, hand), unit) in axes.filter(|((place, _), _)| place.physical == physical) {
        hand.goal = value.map(|value| {
            let wanted = if second == 0 { unit.nominal + value } else { value };
            let (position, _) = within(unit, wanted);
            let speed = speed
                .filter(|speed| *speed > 0.0)
                .unwrap_or(place.block.max_mm_min);
            Goal {
                position,
                feed_mm_min: speed * percent / 100.0,
                reports: Some(Report::reached(second)),
            }
        });
    }
}

fn position_percent(machine: &Machine, physical: u8, second: u32) -> f64 {
    let place = machine.places.iter().find(|place| place.physical == physical);
    let number = place.map_or(1, |place| place.channel + 1);
    let of_channel = match second {
        0 => ChannelParameter::RelativeOverride,
        _ => ChannelParameter::AbsoluteOverride,
    };
    let own = axis_number(&machine.memory, physical, AxisParameter::RelativeOverride, second);
    let own = own.filter(|number| *number > 0.0);
    let common = || machine.memory.of_channel(number, of_channel).number();
    let number = own.or_else(common).filter(|number| *number > 0.0).unwrap_or(1.0);
    machine.memory.override_percent(number as u8)
}

/// P12130: the axis seeks its reference point, its zero pulse counts, or it has it here [002:8018-8042].
pub(crate) fn begin_seek(machine: &mut Machine, physical: u8) {
    let bits = machine
        .memory
        .of_axis(physical, AxisParameter::Reference)
        .bits()
        .unwrap_or(0);
    let [plus, minus, release, set] = bits.to_le_bytes();
    let axes = machine
        .places
        .iter()
        .zip(&mut machine.hands)
        .zip(machine.core.axes.iter_mut());
    for ((place, hand), unit) in axes.filter(|((place, _), _)| place.physical == physical) {
        hand.seeks = match (plus, minus) {
            (1, _) => Some(Direction::Plus),
            (_, 1) => Some(Direction::Minus),
            _ => None,
        };
        if release == 1 && !hand.released {
            unit.servo.forget_marks();
            unit.referenced = false;
        }
        hand.released = release == 1;
        if set == 1 {
            unit.set_datum(unit.servo.count(), place.block.reference_mm);
            unit.referenced = true;
        }
    }
}

/// Moves what nothing but the operator and the PLC moves, for a cycle.
pub(crate) fn move_axes(machine: &mut Machine, measured: &Measured) {
    turn_wheels(machine, measured);
    spindles::turn(machine);
    for k in 0..machine.channels.len() {
        let feed = manual_feed(machine, k as u8 + 1);
        let is_hand = machine
            .channels
            .get(k)
            .is_some_and(|channel| channel.mode == Mode::Hand);
        let Some(now) = machine.parts(k).map(|(_, _, site)| site.now) else {
            continue;
        };
        let held = machine.channels.get(k).is_some_and(|channel| channel.safety_stop);
        show_feed(machine, k as u8 + 1, feed);
        let axes = machine
            .places
            .iter()
            .zip(&mut machine.hands)
            .zip(machine.core.axes.iter_mut());
        for ((place, hand), unit) in axes.filter(|((place, _), _)| usize::from(place.channel) == k) {
            if !is_hand {
                hand.key = None;
            }
            if held && matches!(unit.mover, Mover::Manual | Mover::Positioning | Mover::Reference) {
                // P8702: what leads it stays, and goes on afterwards.
                unit.drive(now.time_s, Aim::Feed(0.0), place.block.max_mm_min);
            } else if !held {
                lead(place, hand, unit, feed, &now, &mut machine.memory);
            }
            show_speeds(place, hand, unit, &mut machine.memory);
        }
    }
}

/// P11400: what the handwheels were turned in this cycle [002:6297-6360].
fn turn_wheels(machine: &mut Machine, measured: &Measured) {
    for number in 1..=WHEELS {
        let Some(wheel) = machine.memory.handwheel(number) else {
            continue;
        };
        let count = measured.encoder(usize::from(wheel.encoder) - 1).count;
        let axes = machine
            .places
            .iter()
            .zip(&mut machine.hands)
            .zip(machine.core.axes.iter());
        for ((_, hand), unit) in axes.filter(|((place, _), _)| place.physical == wheel.axis) {
            let is_free = matches!(unit.mover, Mover::None | Mover::Manual);
            hand.wheel = match hand.wheel {
                _ if !wheel.active || !is_free => None,
                Some((by, before, target)) if by == number => {
                    let way = (count - before) as f64 * wheel.step_mm;
                    Some((number, count, within(unit, target + way).0))
                }
                Some(other) => Some(other),
                None => Some((number, count, unit.nominal)),
            };
        }
    }
}

/// Leads one axis for a cycle.
fn lead(place: &AxisPlace, hand: &mut Hand, unit: &mut AxisUnit, feed: f64, now: &Now, memory: &mut Memory) {
    if hand.turns {
        return;
    }
    if let Some(direction) = hand.seeks.filter(|_| unit.can_be_driven()) {
        return seek(place, hand, unit, (direction, feed), now, memory);
    }
    if hand.released {
        take_mark(place, hand, unit);
    }
    if matches!(unit.mover, Mover::Reference) {
        return unit.come_to_rest(now.time_s);
    }
    let feed_max = slope_mm_min(memory, place);
    let key = hand
        .key
        .filter(|(direction, _)| !is_locked(memory, place.physical, *direction));
    let key = key.map(|(direction, feed)| (direction, feed.min(feed_max)));
    match hand.goal {
        Some(goal) if unit.can_be_driven() && matches!(unit.mover, Mover::None | Mover::Positioning) => {
            unit.mover = Mover::Positioning;
            let feed = goal.feed_mm_min.min(feed_max);
            unit.drive(now.time_s, Aim::Position(goal.position), feed);
            if unit.ptp.is_at(goal.position) && unit.servo.in_position() {
                (hand.goal, unit.mover) = (None, Mover::None);
                if let Some(reached) = goal.reports {
                    report(memory, place.physical, reached);
                }
            }
        }
        Some(_) => {}
        None if unit.mover == Mover::Positioning => unit.come_to_rest(now.time_s),
        None => {
            let wheel = hand.wheel.map(|(_, _, target)| target).filter(|_| key.is_none());
            let wheel = wheel.filter(|target| *target != unit.nominal || unit.mover == Mover::Manual);
            if key.is_some() || wheel.is_some() || unit.mover == Mover::Manual {
                let wanted = HandMove {
                    key,
                    wheel,
                    ..HandMove::default()
                };
                move_by_hand(unit, &wanted, &Now { stop: false, ..*now });
            }
        }
    }
}

/// On towards the reference point.
fn seek(
    place: &AxisPlace,
    hand: &mut Hand,
    unit: &mut AxisUnit,
    (direction, feed): (Direction, f64),
    now: &Now,
    memory: &mut Memory,
) {
    if !matches!(unit.mover, Mover::None | Mover::Reference) {
        return;
    }
    unit.mover = Mover::Reference;
    let feed = feed.min(place.block.max_mm_min);
    unit.drive(now.time_s, Aim::Feed(direction.sign() * feed), feed);
    let [plus, minus] = place.block.reference_directions;
    let counts = if direction == Direction::Plus { plus } else { minus };
    if hand.released && counts && take_mark(place, hand, unit) {
        hand.seeks = None;
        if let Some(place) = Memory::axis_place(place.physical, AxisParameter::Reference) {
            memory.store_bits(place, 1 << 16);
        }
    }
}

/// The zero pulse was passed while it counts: the axis knows where it is. Whether it does.
fn take_mark(place: &AxisPlace, hand: &Hand, unit: &mut AxisUnit) -> bool {
    let mark = unit
        .servo
        .take_mark()
        .filter(|_| hand.released && !unit.referenced);
    if let Some(mark) = mark {
        unit.set_datum(mark.count, place.block.reference_mm);
        unit.referenced = true;
    }
    mark.is_some()
}

/// A position is reached, or not.
pub(crate) fn report(memory: &mut Memory, physical: u8, report: Report) {
    let place = Memory::axis_place(physical, report.parameter).and_then(|place| place.q());
    if let Some(place) = place {
        memory.store_bits(bahn_system900::Place::Q(place + report.after), report.bits);
    }
}

/// The number of a parameter of an axis, or of one after it.
pub(crate) fn axis_number(
    memory: &Memory,
    physical: u8,
    parameter: AxisParameter,
    after: u32,
) -> Option<f64> {
    let place = Memory::axis_place(physical, parameter)?.q()?;
    memory.system_cell(place + after).number()
}
