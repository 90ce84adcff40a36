//! Whether a run still comes on while no axis moves.
//!
//! A tool that is changed, a spindle that ramps, a gear that shifts, a door that opens, a PLC program that goes from step to step: all
//! of these bring machine and PLC into states in which they have not been since an axis moved last. A run that hangs has no new state;
//! a lamp that blinks and a pump that runs every minute come back to states that were there. A timer of the PLC is given its time.
//!
//! Decision: A run without movement comes on while control, PLC and plant reach states in which they were not since
//! an axis moved last, 4096 at most; a timer of the PLC that runs is given its longest time

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hasher as _};

use bahn_exchange::{BitArea, Image};
use bahn_host::{Host, LoadedMachine};
use bahn_machine::Machine;

/// New states without a movement that count at most: a counter made of markers is no progress for ever.
const STATES_MAX: usize = 4096;

/// Tells a run that hangs from one that still comes on.
#[derive(Debug, Default)]
pub(super) struct Standstill {
    seen: HashSet<u64>,
    /// When something came on last, µs.
    since_us: u64,
}

impl Standstill {
    /// Looks at the machine after a cycle; `moves` when an axis does, or a dwell runs.
    pub fn cycle(&mut self, host: &Host, moves: bool) {
        let now_us = host.control().time_us();
        if moves {
            self.seen.clear();
            self.since_us = now_us;
        } else if self.seen.len() < STATES_MAX && self.seen.insert(state(host)) {
            self.since_us = now_us;
        }
    }

    /// When something came on last, µs.
    pub fn since_us(&self) -> u64 {
        self.since_us
    }

    /// Nothing has come on for this time, and no timer that the PLC still waits for can be the reason.
    pub fn is_longer_than(&self, host: &Host, machine: &LoadedMachine, wait_us: u64) -> bool {
        let control = host.control();
        let still_us = control.time_us().saturating_sub(self.since_us);
        if still_us <= wait_us {
            return false;
        }
        let image = control.exchange().plc();
        let running = (RUNNING_FROM..RUNNING_FROM + TIMERS).any(|timer| bit(image, BitArea::T, timer));
        let longest = machine.parameters.plc_parameters().timers;
        let longest = longest.iter().copied().max().map_or(0, u64::from);
        let cycle_us = u64::from(control.model().limits().plc_cycle_us);
        !running || still_us > wait_us.saturating_add(longest * cycle_us)
    }
}

/// T48 to T95 say that timers T0 to T47 run.
const RUNNING_FROM: usize = 48;
const TIMERS: usize = 48;

fn bit(image: &Image, area: BitArea, number: usize) -> bool {
    let cell = usize::from(area.first_cell()) + number;
    image.cells().get(cell).is_some_and(|cell| *cell != 0)
}

/// Every bit of the PLC, the blocks of all channels, and where the things of the plant are.
fn state(host: &Host) -> u64 {
    let control = host.control();
    let mut sum = DefaultHasher::new();
    let cells = control.exchange().plc().cells();
    for area in [BitArea::M, BitArea::I, BitArea::O, BitArea::T] {
        let first = usize::from(area.first_cell());
        let cells = cells.get(first..first + usize::from(area.count()));
        write_bits(cells.unwrap_or_default(), &mut sum);
    }
    for number in 0..control.channels() {
        let element = control.channel(number).and_then(|channel| channel.element());
        let sequence = element.map_or(0, |element| element.sequence);
        sum.write(&sequence.to_le_bytes());
    }
    plant(host.plant(), &mut sum);
    sum.finish()
}

/// Cells of bits hold 0 or 1: 64 of them are one number, of which the sum is found sooner than of so many bytes.
fn write_bits(cells: &[u8], sum: &mut DefaultHasher) {
    // The product brings bit 0 of every byte into the highest byte.
    const GATHER: u64 = 0x0102_0408_1020_4080;
    for cells in cells.chunks(64) {
        let (octets, rest) = cells.as_chunks::<8>();
        let bits = octets.iter().fold(0, |bits, octet| {
            bits << 8 | u64::from_le_bytes(*octet).wrapping_mul(GATHER) >> 56
        });
        sum.write_u64(bits);
        sum.write(rest);
    }
}

fn plant(machine: &Machine, sum: &mut DefaultHasher) {
    for device in machine.devices() {
        sum.write(&[(device.position * 100.0) as u8]);
    }
    if let Some(magazine) = machine.magazine() {
        sum.write(&magazine.pocket.to_le_bytes());
        for tool in magazine.arm.iter().chain([&magazine.shuttle, &magazine.spindle]) {
            sum.write(&tool.to_le_bytes());
        }
    }
    for spindle in machine.spindles() {
        // Steps of speed, finer at low ones: a ramp passes many of them, the noise of a drive two.
        let step = (spindle.motor_rpm.abs().ln_1p() * 16.0) as u8;
        sum.write(&[step, spindle.gear.map_or(0, |gear| gear as u8)]);
    }
}
