//! What an operator does at the station, and how it is written: `{"key":"ENT"}`, `{"feed_override":80}`.

use bahn_dialogue::Key;
use bahn_machine::{Button, KeyAction};
use bahn_path::Switch;
use serde::{Deserialize, Serialize};

use crate::news::TransferNews;

/// Name of the EMERGENCY STOP button among the keys of the machine operating panel.
pub const EMERGENCY_STOP: &str = "EMERGENCY_STOP";

/// Something that the operator does.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A key of the keyboard.
    Key(Key),
    /// A key of the keyboard goes down and stays down, or comes up.
    Held(Key, Button),
    /// A key of the machine operating panel, or `EMERGENCY_STOP`.
    Machine(String, KeyAction),
    /// A line of text at once: what was pasted, or typed on a real keyboard.
    Text(String),
    /// The feed override knob, %.
    FeedOverride(f64),
    /// The spindle override knob, %.
    SpindleOverride(f64),
    /// The handwheel is turned by so many counting steps.
    Handwheel(i64),
    /// Axis and factor 0 to 10 of the handwheel.
    HandwheelAxis(char, u8),
    /// The supply of the control.
    Power(Switch),
    /// So many times as fast as real time, 0.1 to 100.
    Speed(f64),
    /// Time stands (on), or goes on (off).
    Pause(Switch),
    /// So many contour cycles pass, also while time stands; 10,000 wait at most.
    Cycles(u32),
    /// To a moment since power-on, s, of this way or of a branch; time stands there.
    GoTo(f64, Option<u32>),
    /// A lesson of the machine's folder begins, by its name; `None` ends it.
    Lesson(Option<String>),
    /// The trainee says that he has done what the lesson asks.
    HandIn,
    /// What a script does: a command of the control or an event of the machine (docs/scripts.md).
    Action(String),
    /// What has happened at a data interface, told by whoever has its line.
    Transfer(TransferNews),
}

impl Input {
    /// It does not wait after other inputs, nor for work that takes long.
    pub(crate) fn is_urgent(&self) -> bool {
        matches!(self, Input::Machine(name, _) if name == EMERGENCY_STOP)
    }
}

/// Why an input was refused, in words.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(pub String);

/// An input as JSON. Exactly one of its fields is set, beside `down`, `factor` and `branch`.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct InputText {
    /// A key of the keyboard or of the machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// The key is pressed and held, or released; without it, tapped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub down: Option<bool>,
    /// A line of text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// Where the feed override stands, %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub feed_override: Option<f64>,
    /// Where the spindle override stands, %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spindle_override: Option<f64>,
    /// Counting steps of the handwheel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub handwheel: Option<i64>,
    /// Letter of the axis that the handwheel is to lead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub handwheel_axis: Option<char>,
    /// Interpolation factor of the handwheel: each step up halves its travel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub factor: Option<u8>,
    /// The supply of the control.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub power: Option<bool>,
    /// How fast time passes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Time is to stand, or to go on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pause: Option<bool>,
    /// Number of contour cycles that pass, also while time stands.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cycles: Option<u32>,
    /// A moment, s since power-on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub go_to: Option<f64>,
    /// The branch of that moment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub branch: Option<u32>,
    /// A lesson; the empty name ends it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lesson: Option<String>,
    /// The task is done; always true.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hand_in: Option<bool>,
    /// An action of a script; older recordings of sessions say `deed`.
    #[serde(alias = "deed", skip_serializing_if = "Option::is_none")]
    pub action: Option<String>,
    /// What has happened at a data interface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transfer: Option<String>,
}

impl TryFrom<InputText> for Input {
    type Error = Refusal;

    fn try_from(text: InputText) -> Result<Input, Refusal> {
        let factor = text.factor.unwrap_or(3);
        let news = |text: String| text.parse().map(Input::Transfer).map_err(Refusal);
        let found = [
            text.key.map(|name| key(name, text.down)),
            text.text.map(Input::Text),
            text.feed_override.map(Input::FeedOverride),
            text.spindle_override.map(Input::SpindleOverride),
            text.handwheel.map(Input::Handwheel),
            text.handwheel_axis.map(|axis| Input::HandwheelAxis(axis, factor)),
            text.power.map(|on| Input::Power(on.into())),
            text.speed.map(Input::Speed),
            text.pause.map(|on| Input::Pause(on.into())),
            text.cycles.map(Input::Cycles),
            text.go_to.map(|time_s| Input::GoTo(time_s, text.branch)),
            text.lesson
                .map(|name| Input::Lesson((!name.is_empty()).then_some(name))),
            text.hand_in.map(|_| Input::HandIn),
            text.action.map(Input::Action),
            text.transfer.map(news).transpose()?,
        ];
        let mut found = found.into_iter().flatten();
        match (found.next(), found.next()) {
            (Some(input), None) => Ok(input),
            _ => Err(Refusal(
                "an input has exactly one field, as {\"key\":\"ENT\"}".into(),
            )),
        }
    }
}

/// Keys that the machine does not have are refused where they are pressed.
fn key(name: String, down: Option<bool>) -> Input {
    match (Key::from_name(&name), down) {
        (Some(key), None) => Input::Key(key),
        (Some(key), Some(true)) => Input::Held(key, Button::Pressed),
        (Some(key), Some(false)) => Input::Held(key, Button::Released),
        (None, Some(true)) => Input::Machine(name, KeyAction::Press),
        (None, Some(false)) => Input::Machine(name, KeyAction::Release),
        (None, None) => Input::Machine(name, KeyAction::Tap),
    }
}

impl From<&Input> for InputText {
    fn from(input: &Input) -> InputText {
        let mut text = InputText::default();
        match input {
            Input::Key(key) => text.key = Some(key.name().to_owned()),
            Input::Held(key, button) => {
                text.key = Some(key.name().to_owned());
                text.down = Some(button.is_pressed());
            }
            Input::Machine(name, action) => {
                text.key = Some(name.clone());
                text.down = match action {
                    KeyAction::Press => Some(true),
                    KeyAction::Release => Some(false),
                    KeyAction::Tap => None,
                };
            }
            Input::Text(line) => text.text = Some(line.clone()),
            Input::FeedOverride(percent) => text.feed_override = Some(*percent),
            Input::SpindleOverride(percent) => text.spindle_override = Some(*percent),
            Input::Handwheel(steps) => text.handwheel = Some(*steps),
            Input::HandwheelAxis(axis, factor) => {
                text.handwheel_axis = Some(*axis);
                text.factor = Some(*factor);
            }
            Input::Power(switch) => text.power = Some(switch.is_on()),
            Input::Speed(factor) => text.speed = Some(*factor),
            Input::Pause(switch) => text.pause = Some(switch.is_on()),
            Input::Cycles(cycles) => text.cycles = Some(*cycles),
            Input::GoTo(time_s, branch) => {
                text.go_to = Some(*time_s);
                text.branch = *branch;
            }
            Input::Lesson(name) => text.lesson = Some(name.clone().unwrap_or_default()),
            Input::HandIn => text.hand_in = Some(true),
            Input::Action(action) => text.action = Some(action.clone()),
            Input::Transfer(news) => text.transfer = Some(news.to_string()),
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_read_as_they_are_written() {
        for text in [
            r#"{"key":"ENT"}"#,
            r#"{"key":"END","down":true}"#,
            r#"{"key":"NC_START"}"#,
            r#"{"key":"X+","down":true}"#,
            r#"{"text":"L X+10 R0 F200"}"#,
            r#"{"feed_override":80.0}"#,
            r#"{"handwheel_axis":"Y","factor":5}"#,
            r#"{"handwheel":-250}"#,
            r#"{"pause":true}"#,
            r#"{"go_to":12.5}"#,
            r#"{"go_to":12.5,"branch":2}"#,
            r#"{"lesson":"door"}"#,
            r#"{"lesson":""}"#,
            r#"{"hand_in":true}"#,
            r#"{"action":"fault drive X off"}"#,
            r#"{"transfer":"received 15.H"}"#,
        ] {
            let read: InputText = serde_json::from_str(text).unwrap();
            let input = Input::try_from(read).unwrap();
            assert_eq!(serde_json::to_string(&InputText::from(&input)).unwrap(), text);
        }
    }

    #[test]
    fn an_input_is_one_thing() {
        for text in ["{}", r#"{"key":"ENT","pause":true}"#] {
            let read: InputText = serde_json::from_str(text).unwrap();
            assert!(Input::try_from(read).is_err(), "{text}");
        }
        assert!(serde_json::from_str::<InputText>(r#"{"kee":"ENT"}"#).is_err());
    }
}
