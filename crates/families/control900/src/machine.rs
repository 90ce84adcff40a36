//! The machine side: all axes, the circuit, the channels, and what the kernel's clock asks of them.

use bahn_kernel::{
    Axes, AxisUnit, Came, Circuit, CircuitOrder, Core, EmergencyStop, Family, Feeder, Mover, Now, Run,
    RunFamily, RunFault,
};
use bahn_motion::Stop;
use bahn_parameters::{EmergencyStopTest, PerPlcAxis};
use bahn_path::{LiveData, Position};
use bahn_servo::{Commands, Measured};
use bahn_system900::{ChannelParameter, Memory};

use crate::answers::Answers;
use crate::channel::{Channel, Site};
use crate::hand::Hand;
use crate::message::{Kind, Message, Messages};
use crate::monitor::Watch;
use crate::setup::Setup;
use crate::transfer::Transfers;
use crate::units::{self, AxisPlace};

/// The circuit is not tested at power-on: the manual names no test (inferred).
const NO_TEST: EmergencyStopTest = EmergencyStopTest {
    times: 0,
    recognise_us: 0,
    fall_us: 100_000,
    restore_us: 0,
};

/// Everything but the clock.
#[derive(Clone)]
pub(crate) struct Machine {
    pub core: Core,
    pub memory: Memory,
    pub channels: Vec<Channel>,
    /// What is known of the axes beside the kernel, in its order.
    pub places: Vec<AxisPlace>,
    pub watches: Vec<Watch>,
    pub hands: Vec<Hand>,
    pub messages: Messages,
    pub transfers: Transfers,
    pub answers: Answers,
    pub now_us: u64,
    pub plc_us: u64,
    /// When the PLC is due.
    scan_us: u64,
    /// Positions at power-on were taken.
    begun: bool,
}

impl Machine {
    pub fn new(mut memory: Memory, setup: Setup) -> Machine {
        memory.start();
        let timing = units::timing(&memory);
        let (list, places) = units::build(&memory, timing);
        let mut axes = Axes::new(list, timing);
        let channels = (1..=memory.channels()).map(|number| {
            let limits = units::limits(&axes.of(usize::from(number) - 1), &places, timing);
            Channel::new(number, &limits, timing, &memory)
        });
        let channels: Vec<Channel> = channels.collect();
        let mut machine = Machine {
            watches: vec![Watch::default(); places.len()],
            hands: vec![Hand::default(); places.len()],
            core: Core {
                timing,
                axes,
                emergency: EmergencyStop::new(NO_TEST, false),
                loops_closed: false,
            },
            memory,
            channels,
            places,
            messages: Messages::default(),
            transfers: Transfers::default(),
            answers: Answers::new(setup.answers),
            now_us: 0,
            plc_us: u64::from(setup.plc_us.max(1)),
            scan_us: 0,
            begun: false,
        };
        machine.messages.reserve();
        machine.transfers.reserve();
        machine.show_at_start();
        machine
    }

    /// What holds for a channel in this cycle.
    fn now(&self, k: usize) -> Option<Now> {
        let channel = self.channels.get(k)?;
        Some(Now {
            time_s: f64::from(self.core.timing.contour_us()) * 1e-6,
            us: self.now_us,
            start: channel.wanted.start,
            stop: channel.wanted.stop,
            fault: false,
            stop_pressed: channel.wanted.stop,
            ready: self.core.emergency.circuit() == Circuit::Ready,
            loops_closed: self.core.loops_closed,
            feed_percent: 100.0,
            program_percent: channel.override_percent,
            program_rapid: false,
            axis_keys: PerPlcAxis::splat(None),
            wheel_mm: PerPlcAxis::splat(0.0),
            rapid_limit_mm_min: f64::INFINITY,
        })
    }

    /// The run of a channel, what it reads, and where it acts.
    pub fn parts(&mut self, k: usize) -> Option<(&mut Run, Option<&mut Feeder>, Site<'_>)> {
        let now = self.now(k)?;
        let channel = self.channels.get_mut(k)?;
        let site = Site {
            number: channel.number,
            axes: self.core.axes.of(k),
            chain: &mut channel.chain,
            spindle: &mut channel.spindle,
            m: &channel.m,
            waits_for_m: &mut channel.waits_for_m,
            branch: &mut channel.branch,
            transfers: &mut self.transfers,
            memory: &mut self.memory,
            at: None,
            now,
        };
        Some((&mut channel.run, channel.feeder.as_mut(), site))
    }

    /// Reads ahead for a channel, outside the cycle; begins a run that is to begin.
    pub fn prepare(&mut self, k: usize) {
        let start_block = self
            .memory
            .of_channel(k as u8 + 1, ChannelParameter::StartBlock)
            .whole();
        let now_us = self.now_us;
        let Some((run, _, mut site)) = self.parts(k) else {
            return;
        };
        run.track.reserve();
        if run.takes_begin(|| site.axes.rest()) {
            run.begin();
            run.set_off(&site.acting());
            self.begin(k, start_block.unwrap_or(0));
        }
        let Some((run, Some(feeder), mut site)) = self.parts(k) else {
            return;
        };
        if run.progress().is_on_its_way() {
            let allowed = run.allowed(now_us);
            run.prepare(feeder, allowed, Position::ZERO, &site.acting(), |_, _| {});
        }
    }

    /// The program of a channel is read from a block on, 0 for its first.
    fn begin(&mut self, k: usize, block: i64) {
        let within = {
            let axes = self.core.axes.of(k);
            (axes.traverse_box(), axes.programmable())
        };
        let Some((_, _, mut site)) = self.parts(k) else {
            return;
        };
        let here = site.acting().here();
        let Some(channel) = self.channels.get_mut(k) else {
            return;
        };
        (channel.branch, channel.jump, channel.waits_for_m) = (None, None, false);
        let Some(program) = &channel.program else {
            return;
        };
        let mut feeder = Feeder::new(program.boxed(), channel.chain.clone(), within);
        feeder.reader_mut().relocate(&here);
        if let Some(block) = u32::try_from(block).ok().filter(|block| *block > 0) {
            feeder.reader_mut().goto(block);
        }
        channel.feeder = Some(feeder);
    }

    /// A message comes, and does what its kind says.
    pub fn raise(&mut self, number: u32, channel: u8, axis: Option<u8>, kind: Kind) {
        self.say(
            number,
            channel,
            axis,
            kind,
            crate::message::text_of(number).into(),
        );
    }

    /// The same with a text of its own.
    pub fn say(
        &mut self,
        number: u32,
        channel: u8,
        axis: Option<u8>,
        kind: Kind,
        text: std::borrow::Cow<'static, str>,
    ) {
        let message = Message {
            time_us: self.now_us,
            number,
            channel,
            axis,
            kind,
            text,
            acknowledged_us: None,
        };
        if !self.messages.raise(message) {
            return;
        }
        for other in &mut self.channels {
            let is_own = other.number == channel;
            match kind {
                Kind::System => other.wanted.abort = true,
                Kind::High => other.wanted.abort |= is_own,
                Kind::Low => other.wanted.stop |= is_own,
                Kind::Display => {}
            }
        }
    }

    /// The run of a channel is broken off where it is.
    pub fn break_off(&mut self, k: usize) {
        let Some(channel) = self.channels.get(k) else {
            return;
        };
        if channel.run.progress().is_active() {
            let (number, block) = (channel.number, i64::from(channel.block().block));
            let program = self
                .memory
                .of_channel(number, ChannelParameter::Program)
                .whole()
                .unwrap_or(0);
            for (parameter, value) in [
                (ChannelParameter::AbortProgram, program),
                (ChannelParameter::AbortBlock, block),
                (ChannelParameter::BrokenProgram, program),
                (ChannelParameter::BrokenBlock, block),
            ] {
                self.memory.set_channel(number, parameter, value);
            }
        }
        self.leave(k);
    }

    /// Nothing of a run is left; its axes come down on their ramps.
    fn leave(&mut self, k: usize) {
        let Some((run, _, mut site)) = self.parts(k) else {
            return;
        };
        run.stop();
        run.break_off(&mut site.acting());
        run.track.path.clear();
        *site.waits_for_m = false;
        *site.branch = None;
        let number = site.number;
        site.memory.set_channel(number, ChannelParameter::WaitsForM, 0);
        if let Some(channel) = self.channels.get_mut(k) {
            channel.jump = None;
        }
    }

    /// What a program has come to after its path.
    fn take(&mut self, k: usize, stop: Stop<RunFault>) {
        match stop {
            Stop::Barrier(_) => {
                let Some((run, _, mut site)) = self.parts(k) else {
                    return;
                };
                let here = site.acting().here();
                run.go_on_with(LiveData::default(), here);
            }
            Stop::End => {
                let number = k as u8 + 1;
                for parameter in [ChannelParameter::BrokenProgram, ChannelParameter::BrokenBlock] {
                    self.memory.set_channel(number, parameter, 0);
                }
                self.leave(k);
                if let Some((run, ..)) = self.parts(k) {
                    run.end();
                }
            }
            Stop::Error(fault) => self.fail(k, &fault),
        }
    }

    /// A fault of a program: a message at its block, P8910 and P8911.
    fn fail(&mut self, k: usize, fault: &RunFault) {
        let number = k as u8 + 1;
        let (block, axis, text) = match fault {
            RunFault::Program(error) => (error.block.block, None, error.detail.clone()),
            RunFault::Limit { axis, block, .. } => {
                (block.block, Some(*axis), format!("software limit of {axis}"))
            }
            RunFault::Absent { axis, block, .. } => {
                (block.block, Some(*axis), format!("there is no axis {axis}"))
            }
        };
        let logical = axis.and_then(|axis| {
            let unit = self.core.axes.owned(k).find(|unit| unit.axis == axis)?;
            Some(unit.index as u8 + 1)
        });
        let program = self
            .memory
            .of_channel(number, ChannelParameter::Program)
            .whole()
            .unwrap_or(0);
        self.memory
            .set_channel(number, ChannelParameter::FaultProgram, program);
        self.memory
            .set_channel(number, ChannelParameter::FaultBlock, block.into());
        self.say(0, number, logical, Kind::High, text.into());
        self.break_off(k);
    }

    /// Moves the axes of a channel for a cycle.
    fn move_channel(&mut self, k: usize) {
        let wanted = self
            .channels
            .get_mut(k)
            .map(|channel| std::mem::take(&mut channel.wanted));
        let wanted = wanted.unwrap_or_default();
        if wanted.abort {
            self.break_off(k);
        }
        let held = self.is_locked(k);
        let Some(demands) = self.channels.get(k).map(|channel| channel.demands(held)) else {
            return;
        };
        let Some((run, _, mut site)) = self.parts(k) else {
            return;
        };
        if wanted.stop {
            run.stop();
        } else if wanted.start {
            run.start(&mut site);
        }
        if run.may_move(|_| false, &mut site.acting()) {
            match run.moves(&demands, &mut site) {
                Came::On | Came::NoThread => {}
                Came::BlockEnd => run.end_block(demands.single_block, false),
                Came::Refused(_) => self.break_off(k),
                Came::Stop(stop) => self.take(k, stop),
            }
        }
        let Some((run, feeder, mut site)) = self.parts(k) else {
            return;
        };
        run.move_back(feeder, &mut site);
        let time_s = site.now.time_s;
        if !run.progress().is_on_its_way() {
            site.axes.release(|mover| mover == Mover::Path);
        }
        site.axes.slow_down(time_s);
    }
}

impl Family for Machine {
    fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    fn begin_step(&mut self, _: &Measured) {
        if !std::mem::replace(&mut self.begun, true) {
            self.take_positions();
        }
    }

    fn looks_at_inputs(&mut self, at_us: u64) -> bool {
        at_us >= self.scan_us
    }

    fn scan_is_due(&mut self, now_us: u64) -> bool {
        self.now_us = now_us;
        now_us >= self.scan_us
    }

    fn scan(&mut self, _: &Measured, _: &mut Commands) {
        self.scan_us = self.now_us + self.plc_us;
        self.answer();
    }

    fn output(&mut self, _: &mut Commands) {}

    fn pass(&mut self, now_us: u64) {
        self.now_us = now_us;
    }

    fn circuit_order(&mut self) -> CircuitOrder {
        match self.core.emergency.circuit() {
            Circuit::Ready if !self.core.loops_closed => CircuitOrder::CloseLoops,
            Circuit::EmergencyStop => CircuitOrder::Stop,
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
        self.follow_enables();
    }

    fn move_axes(&mut self, measured: &Measured) {
        for k in 0..self.channels.len() {
            self.move_channel(k);
        }
        self.move_by_hand(measured);
    }

    fn settle(&mut self) {}

    fn rest(&mut self, _: &Measured) {
        for channel in &mut self.channels {
            channel.wanted = Default::default();
        }
    }

    fn transfer(&mut self) {
        self.follow_branches();
    }

    fn end_cycle(&mut self, _: &Measured) {}
}
