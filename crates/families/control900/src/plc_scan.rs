//! A scan of the PLC: inputs in, window in, the program, window out, outputs out, as on every control of the house.
//!
//! Decision: An error of the PLC program stops the PLC: its outputs fall, the control is not ready any more, and a message of the system
//! says where

use bahn_exchange::Exchange;
use bahn_plc::RuntimeError;
use bahn_servo::{Commands, Measured};
use bahn_system900::{Cell, ChannelParameter, Direction, Marker, MarkerPart, Meaning, Place};

use crate::answers::bit;
use crate::command;
use crate::machine::Machine;
use crate::message::Kind;
use crate::plc_run::PlcRun;
use crate::plc_window::{FunctionEntry, Shown, Window900};

/// A scan of the PLC program, where there is one that has not stopped.
pub(crate) fn scan(machine: &mut Machine, measured: &Measured, commands: &mut Commands) {
    let Some(mut run) = machine.plc.take() else { return };
    if run.plc.stopped().is_none() {
        match spend(&mut run, machine, measured) {
            Ok(()) => run.write_outputs(commands),
            Err(error) => {
                commands.outputs.fill(false);
                machine.core.emergency.fail();
                let text = format!("the PLC has stopped at {error}");
                machine.say(0, 1, None, Kind::System, text.into());
            }
        }
    }
    machine.plc = Some(run);
}

fn spend(run: &mut PlcRun, machine: &mut Machine, measured: &Measured) -> Result<(), RuntimeError> {
    run.read_inputs(measured);
    publish(&mut run.window, machine, &mut run.exchange);
    run.plc.scan(&mut run.exchange, &mut run.modules)?;
    take(&mut run.window, machine, &run.exchange);
    Ok(())
}

/// Before a scan: what has changed in the parameters goes to the memory of the PLC.
fn publish(window: &mut Window900, machine: &Machine, exchange: &mut Exchange) {
    for entry in &mut window.bits {
        entry.last = is_so(machine, &entry.marker);
        exchange.nc_put(entry.at, entry.last);
    }
    for entry in &mut window.numbers {
        entry.last = machine.memory.at(entry.place).bits().unwrap_or(0);
        exchange.nc_put_number(entry.at, entry.last);
    }
    for entry in &mut window.functions {
        let channel = usize::from(entry.channel).checked_sub(1);
        let channel = channel.and_then(|k| machine.channels.get(k));
        // Another function may wait since this one was acknowledged.
        let is_open = |entry: &FunctionEntry| machine.transfers.is_open(entry.channel, entry.m);
        let stays = channel.is_some_and(|channel| match entry.shown {
            Shown::No | Shown::Flying => false,
            Shown::Stop => channel.waits_for_m && is_open(entry),
            Shown::Branch => channel.branch.is_some() && is_open(entry),
        });
        if !stays {
            entry.shown = Shown::No;
        }
        for transfer in machine.transfers.since(window.seen) {
            if (transfer.channel, transfer.m) == (entry.channel, entry.m) {
                entry.shown = match (transfer.branch, transfer.stop) {
                    (true, _) => Shown::Branch,
                    (false, true) => Shown::Stop,
                    (false, false) => Shown::Flying,
                };
            }
        }
        exchange.nc_put(entry.at, entry.shown != Shown::No);
    }
    window.seen = machine.transfers.count();
}

/// After a scan: what the PLC has changed goes to the parameters, and does what it says.
fn take(window: &mut Window900, machine: &mut Machine, exchange: &Exchange) {
    for entry in window
        .bits
        .iter_mut()
        .filter(|entry| entry.marker.direction != Direction::ToPlc)
    {
        let is_on = exchange.nc().bit(entry.at);
        if is_on != std::mem::replace(&mut entry.last, is_on) {
            write_marker(machine, &entry.marker, is_on);
        }
    }
    for entry in window
        .numbers
        .iter_mut()
        .filter(|entry| entry.direction != Direction::ToPlc)
    {
        let number = exchange.nc().number(entry.at);
        if number != std::mem::replace(&mut entry.last, number) {
            machine.memory.store_mantissa(entry.place, number);
            command::notice(machine, entry.place);
        }
    }
}

/// What a marker is now.
fn is_so(machine: &Machine, marker: &Marker) -> bool {
    let cell = machine.memory.at(marker.place);
    match marker.part {
        MarkerPart::Value(values) => has_one_of(cell, values),
        MarkerPart::Request(values) => was_asked(machine, marker.place) && has_one_of(cell, values),
        MarkerPart::Byte(byte) => byte_of(cell, byte) == 1,
        MarkerPart::Word => false,
    }
}

fn has_one_of(cell: Cell, values: &[i32]) -> bool {
    cell.whole()
        .is_some_and(|whole| values.iter().any(|value| i64::from(*value) == whole))
}

fn byte_of(cell: Cell, byte: u8) -> u8 {
    let bytes = cell.bits().unwrap_or(0).to_le_bytes();
    bytes.get(usize::from(byte)).copied().unwrap_or(0)
}

/// P8683 or P8684 was written since the last cycle of the PLC.
fn was_asked(machine: &Machine, place: Place) -> bool {
    let answers = &machine.answers;
    match machine.memory.meaning(place) {
        Meaning::OfChannel(number, ChannelParameter::ModeRequest) => answers.modes & bit(number) != 0,
        Meaning::OfChannel(number, ChannelParameter::StartRequest) => answers.starts & bit(number) != 0,
        _ => false,
    }
}

/// The PLC has set a marker, or reset it.
fn write_marker(machine: &mut Machine, marker: &Marker, is_on: bool) {
    let place = marker.place;
    let cell = machine.memory.at(place);
    match marker.part {
        MarkerPart::Value(values) | MarkerPart::Request(values) => {
            let number = match (is_on, values.first()) {
                (true, Some(value)) => f64::from(*value),
                // Another marker of it has become 1 meanwhile.
                (false, _) if !has_one_of(cell, values) => return,
                _ => 0.0,
            };
            machine.memory.store(place, Some(number), 0);
        }
        MarkerPart::Byte(byte) => {
            let mut bytes = cell.bits().unwrap_or(0).to_le_bytes();
            if let Some(own) = bytes.get_mut(usize::from(byte)) {
                *own = u8::from(is_on);
            }
            machine.memory.store_bits(place, i32::from_le_bytes(bytes));
        }
        MarkerPart::Word => return,
    }
    command::notice(machine, place);
}
