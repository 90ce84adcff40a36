//! The status display of a channel: positions, tool, spindle, feed, and what is in force.

use bahn_control900::Mode;
use bahn_screen::{AxisLine, Star, Status};
use bahn_system900::{AxisParameter, ChannelParameter};

use crate::sight::Sight;

/// Which positions the display shows, in the order in which a key goes through them [002:8348-8420].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Positions {
    /// P12154.
    #[default]
    Display,
    /// P12151.
    Nominal,
    /// P12152.
    Actual,
    /// P12160.
    Lag,
    /// P12156.
    Rest,
}

impl Positions {
    pub const ALL: [Positions; 5] = [
        Positions::Display,
        Positions::Nominal,
        Positions::Actual,
        Positions::Lag,
        Positions::Rest,
    ];

    pub fn next(self) -> Positions {
        let place = Positions::ALL.iter().position(|positions| *positions == self);
        let next = place.map_or(0, |place| place + 1) % Positions::ALL.len();
        Positions::ALL.get(next).copied().unwrap_or_default()
    }

    pub fn parameter(self) -> AxisParameter {
        match self {
            Positions::Display => AxisParameter::DisplayPosition,
            Positions::Nominal => AxisParameter::NominalPosition,
            Positions::Actual => AxisParameter::ActualPosition,
            Positions::Lag => AxisParameter::Lag,
            Positions::Rest => AxisParameter::DeltaPosition,
        }
    }

    pub fn title(self, sight: &Sight<'_>) -> &'static str {
        match self {
            Positions::Display => sight.words("DISPLAY"),
            Positions::Nominal => sight.words("NOMINAL"),
            Positions::Actual => sight.words("ACTUAL"),
            Positions::Lag => sight.words("LAG ERROR"),
            Positions::Rest => sight.words("REMAINING"),
        }
    }
}

/// The mode of the channel that is shown, as the panel writes it.
pub(crate) fn mode_of(sight: &Sight<'_>, channel: u8) -> &'static str {
    match sight.control().mode(channel) {
        Mode::Hand => sight.words("HAND"),
        Mode::Sequence => sight.words("AUTO, SEQUENCE"),
        Mode::Single => sight.words("AUTO, SINGLE BLOCK"),
        Mode::Positioning => sight.words("AUTO, POSITIONING"),
    }
}

/// Overrides in force, %: of the path of the channel, and of its spindle.
pub(crate) fn overrides(sight: &Sight<'_>) -> [f64; 2] {
    [path_override(sight), SPINDLE_OVERRIDE].map(|number| sight.memory().override_percent(number))
}

/// The override of the path, P8865; the first where nothing is said.
pub(crate) fn path_override(sight: &Sight<'_>) -> u8 {
    let number = sight.whole(ChannelParameter::PathOverride);
    number
        .and_then(|number| u8::try_from(number).ok())
        .filter(|number| *number > 0)
        .unwrap_or(1)
}

/// Decision: The second knob of the panel is override 2, which the chapter gives no fixed use
pub(crate) const SPINDLE_OVERRIDE: u8 = 2;

/// The spindle of the channel: that whose axis the channel has. Programmed and actual speed, rpm.
fn spindle(sight: &Sight<'_>) -> [f64; 2] {
    let own: Vec<u8> = sight
        .memory()
        .axes_of(sight.channel)
        .map(|(_, physical)| physical)
        .collect();
    let mut spindles = (1..=8).filter_map(|number| sight.memory().spindle(number));
    let Some(spindle) = spindles.find(|spindle| own.contains(&spindle.axis)) else {
        return [0.0; 2];
    };
    let actual = sight
        .memory()
        .of_axis(spindle.axis, AxisParameter::ActualSpeed)
        .number();
    [spindle.rpm, actual.unwrap_or(0.0) / 360.0]
}

/// M functions of the channel that wait for their acknowledgement.
pub(crate) fn waiting_m(sight: &Sight<'_>) -> Vec<u16> {
    if sight.whole(ChannelParameter::WaitsForM) != Some(1) {
        return Vec::new();
    }
    let own = sight
        .control()
        .transfers()
        .filter(|sent| sent.channel == sight.channel);
    own.filter(|sent| sent.stop && sent.ack_us.is_none())
        .map(|sent| sent.m)
        .collect()
}

pub(crate) fn of(sight: &Sight<'_>, positions: Positions) -> Status {
    let [s, rpm] = spindle(sight);
    let feed = sight.number(ChannelParameter::ActualFeed).unwrap_or(0.0);
    let state = sight.whole(ChannelParameter::ProgramState).unwrap_or(0);
    let programmed = sight
        .number(ChannelParameter::ProgrammedFeed)
        .filter(|_| state != 0);
    let rapid = sight.whole(ChannelParameter::Interpolation) == Some(0);
    let m = waiting_m(sight)
        .iter()
        .map(u16::to_string)
        .collect::<Vec<_>>()
        .join("/");
    Status {
        position_type: positions.title(sight).to_owned(),
        axes: sight.axes().map(|axis| line(sight, axis, positions)).collect(),
        tool: tool(sight),
        s,
        spindle_rpm: rpm,
        f: format!("{feed:.0}"),
        feed_mm_min: feed,
        f_inverse: sight.whole(ChannelParameter::AxesEnabled) != Some(1),
        programmed_feed_mm_min: programmed.filter(|_| !rapid).unwrap_or(0.0),
        m: if m.is_empty() { m } else { format!("M{m}") },
        star: match state {
            2 => Star::Steady,
            1 => Star::Blinking,
            _ => Star::Off,
        },
        flags: flags(sight),
        overrides: overrides(sight),
        ..Status::default()
    }
}

fn line(sight: &Sight<'_>, axis: &bahn_system900::ChannelAxis, positions: Positions) -> AxisLine {
    AxisLine {
        letter: axis.name.chars().next().unwrap_or_default(),
        label: format!(" {} ", axis.name),
        value: sight.position(sight.of_axis(axis, positions.parameter())),
        referenced: sight.is_referenced(axis),
        degrees: sight.turns(axis),
        handwheel: sight
            .memory()
            .handwheel(1)
            .is_some_and(|wheel| wheel.active && wheel.axis == axis.physical),
        ..AxisLine::default()
    }
}

/// The tool in the spindle, P8100.
fn tool(sight: &Sight<'_>) -> u32 {
    let group = sight.whole(ChannelParameter::SpindleTool);
    group.and_then(|group| u32::try_from(group).ok()).unwrap_or(0)
}

/// Zero point, work area, how the direction keys move.
fn flags(sight: &Sight<'_>) -> Vec<String> {
    let zero = sight
        .whole(ChannelParameter::ZeroPoint)
        .filter(|point| *point > 0);
    let area = sight.whole(ChannelParameter::WorkArea).filter(|area| *area > 0);
    let is_hand = sight.control().mode(sight.channel) == Mode::Hand;
    let step = || {
        let width = sight
            .memory()
            .of_channel(sight.channel, ChannelParameter::StepWidth);
        format!("{} {}", sight.words("STEP OF"), width.written())
    };
    let all = [
        zero.map(|point| format!("G{point}")),
        area.map(|area| format!("{} {area}", sight.words("AREA"))),
        (is_hand && crate::keys::steps(sight)).then(step),
    ];
    all.into_iter().flatten().collect()
}
