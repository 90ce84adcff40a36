//! The numbers behind the screen, for programs.

use bahn_control::{AxisState, Control, RunState, Snapshot};
use serde_json::{Value, json};

/// The state of the control: lengths in mm, angles in degrees, speeds in mm/min and rpm, times in s.
pub(crate) fn of(snapshot: &Snapshot, control: &Control) -> Value {
    let messages: Vec<_> = snapshot
        .messages
        .iter()
        .map(|shown| {
            json!({
                "text": control.shown_text(shown),
                "flashing": shown.flashing,
                "t": shown.time_us as f64 / 1e6,
                "block": shown.block.map(|block| control.first().number_of(block)),
            })
        })
        .collect();
    json!({
        "t": snapshot.time_us as f64 / 1e6,
        "mode": snapshot.mode.name(),
        "run": run(snapshot.run),
        "ended": snapshot.ended,
        "program": snapshot.program,
        "block": snapshot.block.map(|block| control.first().number_of(block)),
        "axes": snapshot.axes.iter().map(axis).collect::<Vec<_>>(),
        "feed": snapshot.feed_mm_min,
        "programmed_feed": snapshot.programmed_feed_mm_min,
        "feed_override": snapshot.feed_override_percent,
        "spindle_override": snapshot.spindle_override_percent,
        "spindle": {
            "programmed_rpm": snapshot.spindle.programmed_rpm,
            "actual_rpm": snapshot.spindle.actual_rpm,
            "volts": snapshot.spindle.volts,
            "gear": snapshot.spindle.gear,
        },
        "tool": snapshot.tool,
        "messages": messages,
        "waiting": snapshot.waiting.map(|waiting| waiting.to_string()),
        "plc_percent": snapshot.plc_percent,
    })
}

fn run(state: RunState) -> &'static str {
    match state {
        RunState::Idle => "idle",
        RunState::Running => "running",
        RunState::Interrupted => "interrupted",
        RunState::Stopped => "stopped",
        RunState::BlockEnd => "block_end",
    }
}

fn axis(axis: &AxisState) -> Value {
    json!({
        "letter": axis.letter,
        "actual": axis.actual,
        "nominal": axis.nominal,
        "machine": axis.machine,
        "lag": axis.lag,
        "distance_to_go": axis.distance_to_go,
        "referenced": axis.referenced,
        "closed": axis.closed,
        "enabled": axis.enabled,
        "in_position": axis.in_position,
    })
}
