//! A cycle of the machine, as the kernel's clock orders it.

use bahn_kernel::{AxisUnit, Came, Circuit, CircuitOrder, Core, Family, Mover, RunFamily, RunFault};
use bahn_motion::Stop;
use bahn_path::LiveData;
use bahn_reader::{Message, ProgramError};
use bahn_servo::{Commands, Measured};
use bahn_system900::{ChannelParameter, Event, Place, Writer};

use crate::machine::Machine;
use crate::message::Kind;
use crate::{branch, command, coupling, enable, hand, plc, plc_scan, restart};

impl Family for Machine {
    fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    fn begin_step(&mut self, _: &Measured) {
        if !std::mem::replace(&mut self.begun, true) {
            enable::take_positions(self);
        }
    }

    fn looks_at_inputs(&mut self, at_us: u64) -> bool {
        at_us >= self.scan_us
    }

    fn scan_is_due(&mut self, now_us: u64) -> bool {
        self.now_us = now_us;
        now_us >= self.scan_us
    }

    fn scan(&mut self, measured: &Measured, commands: &mut Commands) {
        self.scan_us = self.now_us + self.plc_us;
        plc_scan::scan(self, measured, commands);
        plc::answer(self);
    }

    fn output(&mut self, _: &mut Commands) {}

    fn pass(&mut self, now_us: u64) {
        self.now_us = now_us;
    }

    fn circuit_order(&mut self) -> CircuitOrder {
        match self.core.emergency.circuit() {
            Circuit::Ready if !self.core.loops_closed => CircuitOrder::CloseLoops,
            Circuit::EmergencyStop | Circuit::Defective => CircuitOrder::Stop,
            _ => CircuitOrder::Nothing,
        }
    }

    fn stop(&mut self, _: bool) {
        let text = "EMERGENCY STOP";
        self.say(0, 1, None, Kind::System, text.into());
    }

    fn come_to_a_stand(&mut self) -> bool {
        self.core.axes.iter().all(AxisUnit::stands)
    }

    fn loops_closed(&mut self) {}

    fn loops_open(&mut self) {
        for channel in &mut self.channels {
            channel.run.track.halt();
        }
    }

    fn follow_loops(&mut self, _: &Measured) {
        enable::follow_enables(self);
    }

    fn move_axes(&mut self, measured: &Measured) {
        for k in 0..self.channels.len() {
            move_channel(self, k);
        }
        hand::move_axes(self, measured);
    }

    fn settle(&mut self) {
        coupling::follow(self);
    }

    fn rest(&mut self, _: &Measured) {
        for channel in &mut self.channels {
            channel.wanted = Default::default();
        }
    }

    fn transfer(&mut self) {
        branch::follow_branches(self);
        restart::note_place(self);
        restart::follow(self);
    }

    fn end_cycle(&mut self, _: &Measured) {}
}

/// What a program has come to after its path.
fn take(machine: &mut Machine, k: usize, stop: Stop<RunFault>) {
    match stop {
        Stop::Barrier(_) => {
            branch::come_to_its_end(machine, k);
            let Some((run, _, mut site)) = machine.parts(k) else {
                return;
            };
            let here = site.acting().here();
            run.go_on_with(LiveData::default(), here);
        }
        Stop::End => {
            let number = k as u8 + 1;
            for parameter in [ChannelParameter::BrokenProgram, ChannelParameter::BrokenBlock] {
                machine.memory.set_channel(number, parameter, 0);
            }
            restart::forget(machine, k);
            machine.leave(k);
            if let Some((run, ..)) = machine.parts(k) {
                run.end();
            }
        }
        Stop::Error(fault) => fail(machine, k, &fault),
    }
}

/// A fault of a program: a message at its block, P8910 and P8911.
fn fail(machine: &mut Machine, k: usize, fault: &RunFault) {
    let number = k as u8 + 1;
    let (block, axis, text) = match fault {
        RunFault::Program(error) => (error.block, None, said(error)),
        RunFault::Limit { axis, block, .. } => (*block, Some(*axis), format!("software limit of {axis}")),
        RunFault::Absent { axis, block, .. } => (*block, Some(*axis), format!("there is no axis {axis}")),
    };
    let logical = axis.and_then(|axis| {
        let unit = machine.core.axes.owned(k).find(|unit| unit.axis == axis)?;
        Some(unit.index as u8 + 1)
    });
    let [program, _] = machine.start_of(k);
    machine
        .memory
        .set_channel(number, ChannelParameter::FaultProgram, program);
    machine.memory.set_channel(
        number,
        ChannelParameter::FaultBlock,
        machine.block_number(k, block).into(),
    );
    machine.say(0, number, logical, Kind::High, text.into());
    if let Some(channel) = machine.channels.get_mut(k) {
        channel.faulty = Some(block);
    }
    machine.break_off(k);
}

/// What is said about a fault of a program. Messages of a TNC, which the planner has, are none of this control: only what
/// exactly is wrong.
fn said(error: &ProgramError) -> String {
    match &error.message {
        Message::Numbered(text) => text.clone(),
        Message::Control(_) => error.detail.clone(),
    }
}

/// Moves the axes of a channel for a cycle.
fn move_channel(machine: &mut Machine, k: usize) {
    let wanted = machine
        .channels
        .get_mut(k)
        .map(|channel| std::mem::take(&mut channel.wanted));
    let wanted = wanted.unwrap_or_default();
    if wanted.abort {
        machine.break_off(k);
    }
    let called = machine
        .channels
        .get_mut(k)
        .and_then(|channel| channel.called.take());
    if let Some(which) = called {
        machine.break_off(k);
        let number = k as u8 + 1;
        let trigger = machine
            .memory
            .channel_place_at(number, ChannelParameter::Emergency, which as u32);
        if let Some(trigger) = trigger {
            machine.memory.store(trigger, Some(0.0), 0);
        }
        if let Some(channel) = machine.channels.get_mut(k) {
            channel.runs = Some(which);
        }
    }
    let locked = enable::locked(machine, k);
    let axes = machine.core.axes.of(k);
    let Some(channel) = machine.channels.get(k) else {
        return;
    };
    let demands = channel.demands(locked.now || !channel.run.track.is_able(&axes), locked.next);
    let sent = machine.transfers.count();
    let Some((run, _, mut site)) = machine.parts(k) else {
        return;
    };
    if wanted.stop {
        run.stop();
    } else if wanted.start || called.is_some() {
        run.start(&mut site);
    }
    if run.may_move(|_| false, &mut site.acting()) {
        match run.moves(&demands, &mut site) {
            Came::On | Came::NoThread => {}
            Came::BlockEnd => run.end_block(demands.single_block, locked.next.is_some()),
            Came::Refused(_) => machine.break_off(k),
            Came::Stop(stop) => take(machine, k, stop),
        }
    }
    number_blocks(machine, k, sent);
    while let Some(q) = machine.written.take() {
        machine.pass(Place::Q(q), Writer::Program);
        command::notice(machine, Place::Q(q));
    }
    let Some((run, feeder, mut site)) = machine.parts(k) else {
        return;
    };
    run.move_back(feeder, &mut site);
    let time_s = site.now.time_s;
    if !run.progress().is_on_its_way() {
        site.axes.release(|mover| mover == Mover::Path);
    }
    site.axes.slow_down(time_s);
}

/// Transfers that went out since there were so many get the numbers of their blocks.
fn number_blocks(machine: &mut Machine, k: usize, sent: u64) {
    let mut transfers = std::mem::take(&mut machine.transfers);
    let count = usize::try_from(transfers.count() - sent).unwrap_or(0);
    transfers.number(count, |block| machine.block_number(k, block));
    let mut waits = false;
    for (place, sent) in (0..).zip(transfers.last(count)) {
        machine.record(Event::Function {
            channel: sent.channel,
            m: sent.m,
            place,
            branch: sent.target,
        });
        waits |= sent.stop;
    }
    if waits {
        machine.record(Event::EndOfBlock(k as u8 + 1));
    }
    machine.transfers = transfers;
}
