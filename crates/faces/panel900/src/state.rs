//! The numbers behind the screen.

use bahn_control900::Mode;
use bahn_host::{Host900, Machine900};
use bahn_kernel::RunState;
use bahn_screen::texts::Language;
use bahn_system900::{AxisParameter, ChannelParameter};
use serde::Serialize;

use crate::sight::Sight;
use crate::status;

/// What the control does at a moment. Lengths in mm, angles in degrees, speeds in mm/min.
#[derive(Debug, Serialize)]
pub(crate) struct State {
    /// Time since power-on, s.
    t: f64,
    channels: Vec<ChannelState>,
    messages: Vec<MessageState>,
}

#[derive(Debug, Serialize)]
struct ChannelState {
    channel: u8,
    mode: &'static str,
    run: &'static str,
    ended: bool,
    program: Option<i64>,
    block: Option<i64>,
    feed: f64,
    feed_override: f64,
    /// M functions that wait for their acknowledgement.
    waiting_m: Vec<u16>,
    axes: Vec<AxisState>,
}

#[derive(Debug, Serialize)]
struct AxisState {
    name: String,
    physical: u8,
    display: Option<f64>,
    nominal: Option<f64>,
    actual: Option<f64>,
    lag: Option<f64>,
    referenced: bool,
}

#[derive(Debug, Serialize)]
struct MessageState {
    t: f64,
    number: u32,
    channel: u8,
    axis: Option<u8>,
    kind: &'static str,
    text: String,
    acknowledged: bool,
}

/// That of a control that is on.
pub(crate) fn of(machine: &Machine900, host: &Host900) -> State {
    let control = host.control();
    let messages = control.messages().iter().map(|message| MessageState {
        t: message.time_us as f64 / 1e6,
        number: message.number,
        channel: message.channel,
        axis: message.axis,
        kind: message.kind.id(),
        text: message.text.to_string(),
        acknowledged: message.acknowledged_us.is_some(),
    });
    let channel = |channel| {
        channel_state(&Sight {
            machine,
            host,
            channel,
            language: Language::default(),
        })
    };
    State {
        t: control.now_us() as f64 / 1e6,
        channels: (1..=control.channels()).map(channel).collect(),
        messages: messages.collect(),
    }
}

fn channel_state(sight: &Sight<'_>) -> ChannelState {
    let (run, ended) = sight.control().run(sight.channel);
    let on_its_way = sight.control().is_on_its_way(sight.channel);
    let [feed_override, _] = status::overrides(sight);
    let axes = sight.axes().map(|axis| {
        let of = |parameter| sight.of_axis(axis, parameter);
        AxisState {
            name: axis.name.clone(),
            physical: axis.physical,
            display: of(AxisParameter::DisplayPosition),
            nominal: of(AxisParameter::NominalPosition),
            actual: of(AxisParameter::ActualPosition),
            lag: of(AxisParameter::Lag),
            referenced: sight.is_referenced(axis),
        }
    });
    ChannelState {
        channel: sight.channel,
        mode: match sight.control().mode(sight.channel) {
            Mode::Hand => "hand",
            Mode::Sequence => "sequence",
            Mode::Single => "single",
            Mode::Positioning => "positioning",
        },
        run: match run {
            _ if !on_its_way => "idle",
            RunState::Idle => "idle",
            RunState::Running => "running",
            RunState::Interrupted => "interrupted",
            RunState::Stopped => "stopped",
            RunState::BlockEnd => "block_end",
        },
        ended,
        program: sight
            .whole(ChannelParameter::Program)
            .filter(|number| *number > 0),
        block: sight.whole(ChannelParameter::ActualBlock).filter(|_| on_its_way),
        feed: sight.number(ChannelParameter::ActualFeed).unwrap_or(0.0),
        feed_override,
        waiting_m: status::waiting_m(sight),
        axes: axes.collect(),
    }
}
