//! What a script can speak of on a machine with a System 900: axes, keys, the window of its PLC, events.

use bahn_host::{Event, Machine900, Operable};
use bahn_text::printable;

/// What scripts write, a line each.
const COMMANDS: &str = "\
P8682=2, 2:P8043=1, q904=$3         a parameter, by the operator: locks hold him back
plc P8706=1                         the same by the PLC, which no lock holds back
";

/// What can be recorded and expected, a line each.
const SIGNALS: &str = "\
P12151, 2:P8685, q2150              a parameter, not rounded
message \"M2001\", no message        what nobody has acknowledged
";

/// The names of a machine, for people.
pub fn machine_names900(machine: &Machine900) -> String {
    let row = |name: &str, items: Vec<&str>| format!("{name:<10}{}\n", items.join(" "));
    let mut text = format!("{}, System 900\n\n", printable(&machine.folder.name));
    for channel in &machine.checked.channels {
        let axes = channel.axes.iter();
        let axes = axes.map(|axis| match axis.name.is_empty() {
            true => format!("{}", axis.physical),
            false => format!("{} ({})", axis.name, axis.physical),
        });
        let axes: Vec<String> = axes.collect();
        let name = format!("channel {}", channel.channel);
        text += &row(&name, axes.iter().map(String::as_str).collect());
    }
    let plant = machine.plant(machine.parameters.memory());
    let letters: Vec<String> = plant.axis_letters().into_iter().map(String::from).collect();
    text += &row("axes", letters.iter().map(String::as_str).collect());
    text += &row("keys", plant.keys());
    text += &row("lamps", plant.lamps().into_iter().map(|(name, _)| name).collect());
    text += &row(
        "things",
        plant.devices().into_iter().map(|device| device.name).collect(),
    );
    let window = machine.folder.window.iter();
    let window: Vec<String> = window.map(|entry| printable(&entry.text).to_string()).collect();
    if !window.is_empty() {
        text += &format!("\nWindow of the PLC:\n{}\n", window.join("\n"));
    }
    text += &format!("\nEvents:\n{}", Event::HELP);
    text += &format!("\nCommands:\n{COMMANDS}");
    text += &format!("\nSignals, for --signals and expectations:\n{SIGNALS}end\n");
    text
}
