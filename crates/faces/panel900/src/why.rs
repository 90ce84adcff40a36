//! What a channel does, and what it waits for, in plain words.

use bahn_control900::Mode;
use bahn_screen::texts::filled;
use bahn_system900::ChannelParameter;

use crate::sight::Sight;
use crate::status::{path_override, waiting_m};

/// The state of the channel, and what it waits for, what is most urgent first.
pub(crate) fn of(sight: &Sight<'_>) -> Vec<String> {
    let mut why = Vec::new();
    let program = sight
        .whole(ChannelParameter::Program)
        .filter(|program| *program > 0);
    let is_on_its_way = sight.control().is_on_its_way(sight.channel);
    if sight.control().pending_messages(sight.channel).next().is_some() {
        why.push(
            sight
                .words("A message is pending: RESET acknowledges it")
                .to_owned(),
        );
    }
    enables(sight, &mut why);
    if sight.control().mode(sight.channel) == Mode::Hand {
        let open: Vec<&str> = sight
            .axes()
            .filter(|axis| !sight.is_referenced(axis))
            .map(|axis| axis.name.as_str())
            .collect();
        if !open.is_empty() {
            let text = sight.words("Reference points are missing of {1}: REFERENCE drives there");
            why.push(filled(text, &[&open.join(", ")]));
        } else if let Some(program) = program {
            let text = sight.words("Program {1} waits for AUTO: SEQUENCE or SINGLE, then START");
            why.push(filled(text, &[&program.to_string()]));
        }
    } else if is_on_its_way {
        run(sight, &mut why);
    } else {
        ready(sight, program, &mut why);
    }
    why
}

/// What the PLC has not enabled.
fn enables(sight: &Sight<'_>, why: &mut Vec<String>) {
    let wanted = [
        (
            ChannelParameter::LoopsEnabled,
            sight.words("The position loops wait for the PLC: {1} is {2}"),
        ),
        (
            ChannelParameter::AxesEnabled,
            sight.words("The axes wait for the PLC to enable them: {1} is {2}"),
        ),
    ];
    for (parameter, text) in wanted {
        if sight.whole(parameter) != Some(1) {
            why.push(of_parameter(sight, parameter, text));
        }
    }
    if sight.whole(ChannelParameter::SafetyStop) == Some(1) {
        let text = sight.words("The axes are stopped by the PLC: {1} is {2}");
        why.push(of_parameter(sight, ChannelParameter::SafetyStop, text));
    }
}

/// A text with name and value of a parameter.
fn of_parameter(sight: &Sight<'_>, parameter: ChannelParameter, text: &str) -> String {
    let name = sight
        .name(parameter)
        .map(|name| name.to_string())
        .unwrap_or_default();
    let value = sight.memory().of_channel(sight.channel, parameter).written();
    filled(text, &[&name, &value])
}

/// A program is on its way.
fn run(sight: &Sight<'_>, why: &mut Vec<String>) {
    let block = sight
        .whole(ChannelParameter::ActualBlock)
        .unwrap_or(0)
        .to_string();
    let waiting = waiting_m(sight);
    if !waiting.is_empty() {
        let m = waiting
            .iter()
            .map(|m| format!("M{m}"))
            .collect::<Vec<_>>()
            .join(", ");
        let text = sight.words("N{1} waits until the PLC acknowledges {2}: {3} is {4}");
        let text = filled(text, &[&block, &m, "{1}", "{2}"]);
        why.push(of_parameter(sight, ChannelParameter::BlockRelease, &text));
    }
    if sight.whole(ChannelParameter::ProgramState) == Some(1) {
        why.push(filled(sight.words("Stopped at N{1}: START goes on"), &[&block]));
    } else if sight.memory().override_percent(path_override(sight)) == 0.0 {
        why.push(sight.words("The feed override is 0").to_owned());
    } else if waiting.is_empty() && sight.number(ChannelParameter::ActualFeed).unwrap_or(0.0) == 0.0 {
        let barred = sight
            .whole(ChannelParameter::AxisLock)
            .is_some_and(|axes| axes != 0);
        if barred {
            let text = sight.words("N{1} waits until an area is free: {2} is {3}");
            let text = filled(text, &[&block, "{1}", "{2}"]);
            why.push(of_parameter(sight, ChannelParameter::AxisLock, &text));
        }
    }
}

/// AUTO, and nothing runs.
fn ready(sight: &Sight<'_>, program: Option<i64>, why: &mut Vec<String>) {
    let Some(program) = program else {
        return why.push(sight.words("No program is chosen: PROGRAM has them").to_owned());
    };
    let number = program.to_string();
    if !sight.control().has_program(sight.channel) {
        why.push(filled(sight.words("There is no program {1}"), &[&number]));
    } else if sight.whole(ChannelParameter::Referenced) != Some(1) {
        why.push(
            sight
                .words("Reference points are missing: HAND, then REFERENCE")
                .to_owned(),
        );
    } else {
        why.push(filled(sight.words("START runs program {1}"), &[&number]));
    }
}
