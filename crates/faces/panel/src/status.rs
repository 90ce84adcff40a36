//! The status display, made of what the control shows [003:949-971].
//!
//! Decision: With MP7285 = 0 the display, and DATUM SET with it, are of the nose of the spindle; CAPTURE and the
//! probing by hand stay with the tip of the tool (also `panel/src/pages/datum.rs`)
//!
//! Decision: Axis V of a TNC 151/155 that takes the place of axis IV is called V with MP237 = 2; its angle is that of the
//! spindle from its reference mark on, and is not shown before
//!
//! Decision: F is highlighted when any controlled axis lacks its feed enable; between blocks it is the last feed that
//! was programmed, 0 after the choice of a program (also `kernel/src/track.rs`)

use bahn_exchange::signal;
use bahn_parameters::ParameterList;
use bahn_parameters::axis::AxisParameters;
use bahn_parameters::machining::Decimal;
use bahn_parameters::operation::SpindleDisplay;
use bahn_path::Axis;
use bahn_screen::{AxisLine, Star, Status};
use bahn_servo::Rotation;
use bahn_tnc::{AxisState, Control, InForce, Mode, RunState, Snapshot, SpindleState};

use crate::settings::{PositionType, Settings};

/// Millimetres of an inch.
const INCH_MM: f64 = 25.4;
/// Step of the angle of the spindle, degrees (inferred).
const SPINDLE_STEP_DEG: f64 = 0.001;
/// Index of axis IV.
const FOURTH: usize = 3;
/// Decimals of an inch display [003:7093-7102].
const INCH_DECIMALS: usize = 4;

/// How numbers stand on the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Notation {
    inch: bool,
    decimal: Decimal,
}

impl Notation {
    pub fn of(settings: &Settings, parameters: &ParameterList) -> Notation {
        Notation {
            inch: settings.inch,
            decimal: parameters.decimal(),
        }
    }

    /// A position with its sign, in steps of the display: mm, inches or degrees.
    pub fn position(self, value: f64, step_mm: f64, degrees: bool) -> String {
        let (value, decimals) = match self.inch && !degrees {
            true => (value / INCH_MM, INCH_DECIMALS),
            false => ((value / step_mm).round() * step_mm, decimals(step_mm)),
        };
        self.sign(format!("{value:+.decimals$}"), decimals)
    }

    /// What [`Notation::position`] shows, in mm or degrees.
    pub fn shown(self, value: f64, step_mm: f64, degrees: bool) -> f64 {
        let step = match self.inch && !degrees {
            true => INCH_MM / 10f64.powi(INCH_DECIMALS as i32),
            false => step_mm,
        };
        (value / step).round() * step
    }

    /// A number without a step of its own.
    pub fn number(self, value: f64, decimals: usize) -> String {
        self.sign(format!("{value:.decimals$}"), decimals)
    }

    /// With the decimal sign of MP7280, and without a sign before nothing.
    fn sign(self, text: String, decimals: usize) -> String {
        let zero = text.chars().all(|character| "+-0.".contains(character));
        let text = if zero && text.starts_with('-') {
            text.replacen('-', "+", 1)
        } else {
            text
        };
        match self.decimal {
            Decimal::Comma if decimals > 0 => text.replace('.', ","),
            _ => text,
        }
    }

    /// A feed as F shows it: mm/min, in inches 0.1 inch/min... of the programmed feed [003:2140-2144].
    pub fn feed(self, mm_min: f64) -> String {
        match self.inch {
            true => self.number(mm_min / INCH_MM, 1),
            false => self.number(mm_min, 0),
        }
    }
}

/// Decimals of a display step: three for 0.001 and 0.005, four for 0.0001.
fn decimals(step_mm: f64) -> usize {
    (0..6)
        .find(|decimals| {
            let scaled = step_mm * 10f64.powi(*decimals);
            (scaled - scaled.round()).abs() < 1e-9 && scaled > 0.5
        })
        .map_or(4, |decimals| decimals as usize)
}

/// The status display of the first channel.
pub(crate) fn of(
    snapshot: &Snapshot,
    control: &Control,
    parameters: &ParameterList,
    settings: &Settings,
    earlier: &Status,
) -> Status {
    let notation = Notation::of(settings, parameters);
    let wheel = match snapshot.mode {
        Mode::Handwheel => Some(control.first().handwheel().0),
        _ => None,
    };
    let axes = snapshot
        .axes
        .iter()
        .filter(|axis| of_axis(axis, parameters).shown && !gives_way(axis, parameters));
    let axes = axes.map(|axis| AxisLine {
        handwheel: wheel == Some(axis.index),
        ..axis_line(axis, parameters, settings.position_type, notation)
    });
    let has_point = !parameters.model().has_soft_keys();
    let axes = axes
        .chain(spindle_line(snapshot, parameters, notation))
        .map(|axis| AxisLine {
            label: label(axis.letter, axis.locked, has_point),
            ..axis
        });
    // While the program is read on another thread what was shown stays.
    let (tool_axis, flags) = match control.first().in_force() {
        Some(in_force) => of_program(&in_force, snapshot.tool),
        None => (earlier.tool_axis.clone(), earlier.flags.clone()),
    };
    Status {
        position_type: settings.position_type.name().to_owned(),
        inch: settings.inch,
        axes: axes.collect(),
        tool: snapshot.tool,
        t_inverse: control.memory().bit(signal::TOOL_DISPLAY_INVERSE),
        tool_axis,
        s: speed(&snapshot.spindle, parameters),
        gear: snapshot.spindle.gear,
        spindle_rpm: snapshot.spindle.actual_rpm,
        f: feed(snapshot, control, parameters, notation),
        f_inverse: snapshot.axes.iter().any(|axis| {
            let own = of_axis(axis, parameters);
            !axis.enabled && own.controlled && !own.plc_axis
        }),
        feed_mm_min: snapshot.feed_mm_min,
        programmed_feed_mm_min: snapshot.programmed_feed_mm_min.unwrap_or_default(),
        m: functions(snapshot, control),
        m_inverse: [signal::SPINDLE_DISPLAY_INVERSE, signal::COOLANT_DISPLAY_INVERSE]
            .map(|marker| control.memory().bit(marker)),
        star: star(snapshot),
        flags,
        overrides: [snapshot.feed_override_percent, snapshot.spindle_override_percent],
        waiting: snapshot
            .waiting
            .map_or_else(String::new, |waiting| waiting.to_string()),
        plc_percent: snapshot.plc_percent,
    }
}

/// The tool axis, once a tool was called, and the flags `N XY`, `S X`, `ROT`, `SCL` [003:1297], in a tilted plane `3D ROT`.
fn of_program(in_force: &InForce, tool: u32) -> (Option<String>, Vec<String>) {
    let letters = |axes: &[Axis]| axes.iter().map(|axis| axis.letter()).collect::<String>();
    let marked = |name: &str, axes: &[Axis]| (!axes.is_empty()).then(|| format!("{name} {}", letters(axes)));
    let flags = [
        in_force.tilted.then(|| "3D ROT".to_owned()),
        marked("N", &in_force.shifted),
        marked("S", &in_force.mirrored),
        in_force.rotated.then(|| "ROT".to_owned()),
        in_force.scaled.then(|| "SCL".to_owned()),
    ];
    let axis = (tool > 0).then(|| in_force.tool_axis.letter().to_string());
    (axis, flags.into_iter().flatten().collect())
}

/// A letter with the mark of an open loop: a star before it [000:5366], or a point behind it [001:505-507].
fn label(letter: char, locked: bool, has_point: bool) -> String {
    match (locked, has_point) {
        (true, false) => format!("*{letter} "),
        (true, true) => format!(" {letter}."),
        (false, _) => format!(" {letter} "),
    }
}

/// The machine parameters of an axis.
fn of_axis(axis: &AxisState, parameters: &ParameterList) -> AxisParameters {
    parameters.axis_parameters(u8::try_from(axis.index).unwrap_or_default())
}

/// Whether an axis turns, and the step of its display.
fn step_of(axis: &AxisState, parameters: &ParameterList) -> (bool, f64) {
    let degrees = Axis::from_letter(axis.letter as u8).is_some_and(Axis::is_rotary);
    (degrees, of_axis(axis, parameters).travel.display_step_mm)
}

/// Length of the tool that is not in the display of its axis, mm: MP7285 = 0 [000:6428-6434]. The display shows how far
/// the nose of the spindle is from the datum then, so that DATUM SET with a preset tool is its length [003:1172].
pub(crate) fn hidden_length_mm(axis: &AxisState, parameters: &ParameterList) -> f64 {
    match parameters.operation_parameters().tool_length_shown {
        true => 0.0,
        false => axis.tool_length_mm,
    }
}

/// Whether the spindle is shown in place of an axis: MP237 from 2 on puts axis V there where axis IV is [001:3109].
fn gives_way(axis: &AxisState, parameters: &ParameterList) -> bool {
    let display = parameters.operation_parameters().spindle_display;
    axis.index == FOURTH && matches!(display, SpindleDisplay::AsFourth(_))
}

/// The angle of the spindle: MP40 bit 5 as long as neither M03 nor M04 is active [000:3418-3432] [000:5883]; as axis V of a
/// TNC 151/155 always.
fn spindle_line(snapshot: &Snapshot, parameters: &ParameterList, notation: Notation) -> Option<AxisLine> {
    let stands = snapshot.spindle.rotation == Rotation::M5;
    let letter = match parameters.operation_parameters().spindle_display {
        SpindleDisplay::Standing if stands => 'S',
        SpindleDisplay::AsFourth(letter) => letter,
        SpindleDisplay::Standing | SpindleDisplay::None => return None,
    };
    let angle_deg = snapshot.spindle.angle_deg?;
    Some(AxisLine {
        letter,
        value: notation.position(angle_deg.rem_euclid(360.0), SPINDLE_STEP_DEG, true),
        referenced: true,
        degrees: true,
        ..AxisLine::default()
    })
}

/// A position of an axis as the display shows it, mm or degrees.
pub(crate) fn shown(value: f64, axis: &AxisState, parameters: &ParameterList, settings: &Settings) -> f64 {
    let (degrees, step) = step_of(axis, parameters);
    Notation::of(settings, parameters).shown(value, step, degrees)
}

fn axis_line(
    axis: &AxisState,
    parameters: &ParameterList,
    position_type: PositionType,
    notation: Notation,
) -> AxisLine {
    let (degrees, step) = step_of(axis, parameters);
    let length_mm = hidden_length_mm(axis, parameters);
    let value = match position_type {
        PositionType::Actl => axis.actual + length_mm,
        PositionType::Noml => axis.nominal + length_mm,
        PositionType::Lag => axis.lag,
        PositionType::Dist => axis.distance_to_go,
        PositionType::Ref => axis.machine,
    };
    AxisLine {
        letter: axis.letter,
        value: notation.position(value, step, degrees),
        locked: !axis.closed,
        referenced: axis.referenced,
        degrees,
        ..AxisLine::default()
    }
}

/// The programmed feed in program run, as the potentiometer varies it, `MAX` in rapid traverse. By hand that of the axis whose
/// key is pressed, blank for two of them, or with MP7270 the least of all [000:6521-6561]; a TNC 360 shows it with MP7270
/// alone [003:7307]. With no key nothing moves *(inferred)*.
fn feed(snapshot: &Snapshot, control: &Control, parameters: &ParameterList, notation: Notation) -> String {
    let manual = |index: usize| {
        let axis = parameters.axis_parameters(u8::try_from(index).unwrap_or_default());
        axis.motion.manual_mm_min
    };
    let shown = |mm_min: f64| notation.feed(mm_min * snapshot.feed_override_percent / 100.0);
    if snapshot.mode.is_automatic() {
        return snapshot.programmed_feed_mm_min.map_or("MAX".to_owned(), shown);
    }
    if parameters.operation_parameters().manual_feed_shown {
        let feeds = snapshot.axes.iter().map(|axis| manual(axis.index));
        return shown(feeds.reduce(f64::min).unwrap_or_default());
    }
    if !parameters.model().shows_feed_of_keys() {
        return String::new();
    }
    let mut pressed = control.first().pressed_axes();
    match (pressed.next(), pressed.next()) {
        (Some(index), None) => shown(manual(index)),
        (None, _) => shown(0.0),
        _ => String::new(),
    }
}

/// The programmed speed of the spindle; with MP191 = 0 of a TNC 151/155 once it turns [001:1577].
fn speed(spindle: &SpindleState, parameters: &ParameterList) -> f64 {
    let shown = spindle.rotation != Rotation::M5 || parameters.operation_parameters().speed_shown_at_rest;
    if shown { spindle.programmed_rpm } else { 0.0 }
}

/// `M5/9`: the M functions of spindle and coolant as the PLC shows them [000:6563-6579].
fn functions(snapshot: &Snapshot, control: &Control) -> String {
    let spindle = match snapshot.spindle.rotation {
        Rotation::M3 => '3',
        Rotation::M4 => '4',
        Rotation::M5 => '5',
    };
    let bit = |marker| control.memory().bit(marker);
    let coolant = match (
        bit(signal::COOLANT_DISPLAY_BIT_0),
        bit(signal::COOLANT_DISPLAY_BIT_1),
    ) {
        (false, false) => "9",
        (false, true) => "7",
        (true, false) => "8",
        (true, true) => "K",
    };
    format!("M{spindle}/{coolant}")
}

/// Steady while a run goes on, blinking while it is interrupted [003:1594-1600].
fn star(snapshot: &Snapshot) -> Star {
    match snapshot.run {
        RunState::Idle => Star::Off,
        RunState::Running => Star::Steady,
        RunState::Interrupted | RunState::Stopped | RunState::BlockEnd => Star::Blinking,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn notation(inch: bool, decimal: Decimal) -> Notation {
        Notation { inch, decimal }
    }

    /// MP191 of a TNC 155: with 0 the speed of the S word is shown once the spindle turns, with 1 before [001:1577].
    #[test]
    fn mp191_shows_the_speed_before_the_spindle_runs() {
        for (mp191, at_rest) in [("191=0", 0.0), ("191=1", 1200.0)] {
            let mut list = ParameterList::reference(bahn_parameters::ControlModel::Tnc155);
            assert!(list.assign(mp191).is_ok());
            let spindle = |rotation| SpindleState {
                programmed_rpm: 1200.0,
                nominal_rpm: 0.0,
                actual_rpm: 0.0,
                volts: 0.0,
                gear: 1,
                rotation,
                angle_deg: None,
            };
            assert_eq!(speed(&spindle(Rotation::M5), &list), at_rest, "{mp191}");
            assert_eq!(speed(&spindle(Rotation::M3), &list), 1200.0, "{mp191}");
        }
    }

    #[test]
    fn positions_have_the_step_of_the_display() {
        let point = notation(false, Decimal::Point);
        assert_eq!(point.position(12.3456, 0.001, false), "+12.346");
        // 12.3456 in steps of 5 um: 12.345.
        assert_eq!(point.position(12.3456, 0.005, false), "+12.345");
        assert_eq!(point.position(-0.00004, 0.0001, false), "+0.0000");
        let comma = notation(false, Decimal::Comma);
        assert_eq!(comma.position(-1.5, 0.0001, false), "-1,5000");
        // An inch has four decimals, an angle stays an angle.
        let inch = notation(true, Decimal::Point);
        assert_eq!(inch.position(25.4, 0.001, false), "+1.0000");
        assert_eq!(inch.position(90.0, 0.001, true), "+90.000");
        assert_eq!(
            (inch.feed(254.0), point.feed(254.4)),
            ("10.0".into(), "254".into())
        );
    }
}
