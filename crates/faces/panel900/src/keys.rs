//! The keys of the panel, and what each writes: all are parameters [002:3606-3629] [002:3983-4009].
//!
//! Decision: RAPID held makes the direction keys of a System 900 move with P8754 in place of P8755, and as fast as the axis can
//! where that is not loaded
//!
//! Decision: REFERENCE drives all axes of the channel that is shown to their reference points, in the direction plus, as the
//! operator of `bahn run` does
//!
//! Decision: ABORT writes P8705 and RESET writes P8508, which the chapter gives no keys

use bahn_control900::Mode;
use bahn_host::{KeyAction, reference_drives};
use bahn_live::Refusal;
use bahn_path::Direction;
use bahn_service::SurfaceKey;
use bahn_system900::{ChannelParameter, Name};

use crate::sight::{Desk, Sight};

/// Keys of the machine's operating panel that are there always, in the order in which they stand.
pub(crate) const MACHINE: [&str; 11] = [
    "HAND",
    "SEQUENCE",
    "SINGLE",
    "START",
    "STOP",
    "ABORT",
    "RESET",
    "REFERENCE",
    "STEP",
    "NEXT_STEP",
    "RAPID",
];

/// The keys that choose a channel, from 1 on.
pub(crate) const CHANNELS: [&str; 8] = ["CH1", "CH2", "CH3", "CH4", "CH5", "CH6", "CH7", "CH8"];

macro_rules! keys {
    ($($group:literal: $($name:literal $label:literal),+;)+) => {
        &[$($(SurfaceKey { name: $name, group: $group, label: $label },)+)+]
    };
}

/// The keyboard, but for the keys of channels.
pub(crate) const KEYBOARD: &[SurfaceKey] = keys! {
    "mode": "CHANNEL" "Next channel";
    "number":
        "0" "Digit 0", "1" "Digit 1", "2" "Digit 2", "3" "Digit 3", "4" "Digit 4", "5" "Digit 5", "6" "Digit 6",
        "7" "Digit 7", "8" "Digit 8", "9" "Digit 9", "POINT" "Decimal point", "SIGN" "Change sign";
    "value": "COLON" "Colon after a channel", "DOLLAR" "Hexadecimal number", "CLEARED" "Cleared parameter";
    "entry": "ENT" "Enter", "CE" "Clear entry", "BACK" "Take the last character away";
    "cursor": "UP" "Up", "DOWN" "Down", "LEFT" "Left", "RIGHT" "Right";
    "letter":
        "A" "Letter A", "B" "Letter B", "C" "Letter C", "D" "Letter D", "E" "Letter E", "F" "Letter F", "K" "Letter K",
        "P" "Letter P", "Q" "Letter Q";
    "soft":
        "SK1" "Soft key 1", "SK2" "Soft key 2", "SK3" "Soft key 3", "SK4" "Soft key 4", "SK5" "Soft key 5",
        "SK6" "Soft key 6", "SK7" "Soft key 7", "SK8" "Soft key 8";
};

/// The character that a key enters.
pub(crate) fn character(name: &str) -> Option<&'static str> {
    Some(match name {
        "POINT" => ".",
        "SIGN" => "-",
        "COLON" => ":",
        "DOLLAR" => "$",
        "CLEARED" => "--",
        _ => {
            let mut known = KEYBOARD.iter().filter(|key| key.name.len() == 1);
            return known.find(|key| key.name == name).map(|key| key.name);
        }
    })
}

/// A direction key that is tapped is down so long, µs, as on every machine's panel (docs/scripts.md).
const TAP_US: u64 = 200_000;

/// What is held, and what it has changed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Held {
    names: Vec<String>,
    /// Direction keys that were tapped, and when they come up, µs.
    taps: Vec<(String, u64)>,
    /// The feed by hand before RAPID, as it is written, and its parameter.
    feed: Option<(Name, String)>,
}

impl Held {
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// A key of the machine is pressed, released or tapped.
    ///
    /// # Errors
    /// When there is no such key, or something holds the operator back.
    pub fn key(&mut self, name: &str, action: KeyAction, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        let is_down = action != KeyAction::Release;
        let taps = action == KeyAction::Tap;
        self.names.retain(|held| held != name);
        if action == KeyAction::Press {
            self.names.push(name.to_owned());
        }
        if let Some((axis, direction)) = direction(name) {
            if is_down {
                move_axis(axis, direction, desk)?;
            }
            if taps {
                let until = desk.host.control().now_us() + TAP_US;
                self.taps.push((name.to_owned(), until));
            }
            return match is_down {
                true => Ok(()),
                false => desk.press(ChannelParameter::ManualMove, "0"),
            };
        }
        match name {
            "RAPID" => self.rapid(is_down && !taps, desk),
            "HAND" => {
                desk.press(ChannelParameter::ManualKey, if is_down { "1" } else { "0" })?;
                if taps {
                    desk.press(ChannelParameter::ManualKey, "0")?;
                }
                match is_down {
                    true => mode(Mode::Hand, desk),
                    false => Ok(()),
                }
            }
            "START" | "STOP" => start_key(name, is_down, taps, desk),
            _ if !is_down => Ok(()),
            _ => once(name, desk),
        }
    }

    /// Keys that were tapped are to come up.
    pub fn is_tapped(&self) -> bool {
        !self.taps.is_empty()
    }

    /// Time goes on: keys that were tapped come up.
    pub fn tick(&mut self, desk: &mut Desk<'_>) {
        let now = desk.host.control().now_us();
        let (due, later) = std::mem::take(&mut self.taps)
            .into_iter()
            .partition(|(_, until)| *until <= now);
        self.taps = later;
        let due: Vec<(String, u64)> = due;
        for (name, _) in due {
            // Who has locked the parameter meanwhile stops the axis himself.
            let _ = self.key(&name, KeyAction::Release, desk);
        }
    }

    /// What is held is let go.
    pub fn release_all(&mut self, desk: &mut Desk<'_>) {
        let tapped = std::mem::take(&mut self.taps).into_iter().map(|(name, _)| name);
        for name in std::mem::take(&mut self.names).into_iter().chain(tapped) {
            // What cannot be let go any more is not held either.
            let _ = self.key(&name, KeyAction::Release, desk);
        }
    }

    fn rapid(&mut self, is_down: bool, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        if !is_down {
            return match self.feed.take() {
                Some((name, feed)) => desk.write(name, &feed),
                None => Ok(()),
            };
        }
        let name = desk.sight().name(ChannelParameter::ManualFeed);
        if let Some(name) = name.filter(|_| self.feed.is_none()) {
            let sight = desk.sight();
            let written = |parameter| sight.memory().of_channel(sight.channel, parameter).written();
            let [feed, most] = [ChannelParameter::ManualFeed, ChannelParameter::ManualFeedMax].map(written);
            desk.write(name, &most)?;
            self.feed = Some((name, feed));
        }
        Ok(())
    }
}

/// What a key does that does nothing when it comes up.
fn once(name: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    match name {
        "SEQUENCE" => mode(Mode::Sequence, desk),
        "SINGLE" => mode(Mode::Single, desk),
        "ABORT" => desk.press(ChannelParameter::Abort, "1"),
        "RESET" => desk.press(ChannelParameter::Acknowledge, "1"),
        "REFERENCE" => {
            let mut drives = reference_drives(desk.host.control(), desk.channel);
            drives.reverse();
            drives.into_iter().try_for_each(|command| desk.give(command))
        }
        "STEP" => {
            let steps = steps(&desk.sight());
            desk.press(ChannelParameter::ManualMode, if steps { "1" } else { "2" })
        }
        "NEXT_STEP" => desk.press(ChannelParameter::NextStep, "1"),
        _ => Err(Refusal(format!("the panel has no key {name}"))),
    }
}

/// Direction keys move an axis by a step.
pub(crate) fn steps(sight: &Sight<'_>) -> bool {
    sight.whole(ChannelParameter::ManualMode) == Some(2)
}

fn mode(mode: Mode, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    desk.press(ChannelParameter::ModeRequest, &mode.number().to_string())
}

/// P8682 is 2 while START is held, 1 while STOP is [002:3613-3619].
fn start_key(name: &str, is_down: bool, taps: bool, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    if is_down {
        desk.press(
            ChannelParameter::StartKey,
            if name == "START" { "2" } else { "1" },
        )?;
    }
    match taps || !is_down {
        true => desk.press(ChannelParameter::StartKey, "0"),
        false => Ok(()),
    }
}

/// The axis of a direction key, and where it goes.
fn direction(name: &str) -> Option<(&str, Direction)> {
    let plus = name.strip_suffix('+').map(|axis| (axis, Direction::Plus));
    plus.or_else(|| name.strip_suffix('-').map(|axis| (axis, Direction::Minus)))
}

fn move_axis(axis: &str, direction: Direction, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    let sight = desk.sight();
    let logical = sight.axes().find(|own| own.name == axis).map(|own| own.logical);
    let channel = sight.channel;
    let logical = logical.ok_or_else(|| Refusal(format!("channel {channel} has no axis {axis}")))?;
    if sight.control().mode(channel) != Mode::Hand {
        return Err(Refusal(
            sight.words("direction keys move axes in HAND").to_owned(),
        ));
    }
    desk.press(ChannelParameter::ManualAxis, &logical.to_string())?;
    let order = match direction {
        Direction::Plus => "1",
        Direction::Minus => "2",
    };
    desk.press(ChannelParameter::ManualMove, order)
}
