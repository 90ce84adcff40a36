//! The clock: what comes after what in a servo step and in a contour cycle, and the seam to the family of the control.

use bahn_servo::{Commands, Measured, Plant, Step, Timing};

use crate::axes::Axes;
use crate::emergency::{Circuit, EmergencyStop};
use crate::sampling::{ServoSampler, ServoView};

/// What the kernel moves and watches itself.
#[derive(Clone, Debug)]
pub struct Core {
    /// Servo step and contour cycle.
    pub timing: Timing,
    /// The axes of the machine.
    pub axes: Axes,
    /// The "control is ready" circuit.
    pub emergency: EmergencyStop,
    /// The loops were closed since the control voltage came on.
    pub loops_closed: bool,
}

/// What the "control is ready" circuit asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CircuitOrder {
    /// Everything stays as it is.
    Nothing,
    /// The control voltage has come: the axes are held where they are [000:5341-5350].
    CloseLoops,
    /// Nothing is held any more.
    OpenLoops,
    /// The acknowledgement was lost: as an external stop, a moving axis is ramped down under control
    /// [000:6155-6157]. Then the loops are opened (inferred).
    Stop,
    /// Nothing is reported, and the loops open at once [000:5403-5421].
    StopSilently,
}

/// A family of controls: what it decides in the course of a contour cycle. The kernel orders it and moves the axes.
///
/// In a servo step: [`begin_step`](Family::begin_step), a [`scan`](Family::scan) when one is due, in the first step of a
/// contour cycle the contour cycle, [`output`](Family::output). In a contour cycle: [`circuit_order`](Family::circuit_order),
/// [`follow_loops`](Family::follow_loops), [`move_axes`](Family::move_axes) or [`rest`](Family::rest),
/// [`transfer`](Family::transfer), [`end_cycle`](Family::end_cycle).
pub trait Family {
    /// What the kernel moves and watches on the machine.
    fn core(&mut self) -> &mut Core;

    /// A servo step begins with what the machine has answered; axes and circuit have taken it.
    fn begin_step(&mut self, measured: &Measured);

    /// Somebody will look at the inputs of the machine in the servo step that begins at a time, µs.
    fn looks_at_inputs(&mut self, at_us: u64) -> bool;

    /// A scan of the PLC begins in the servo step of a time, µs; asked once in each step.
    fn scan_is_due(&mut self, now_us: u64) -> bool;

    /// A scan of the PLC: what it reads, what it does, what it asks for.
    fn scan(&mut self, measured: &Measured, commands: &mut Commands);

    /// What the machine is to do in a servo step, beside the axes.
    fn output(&mut self, commands: &mut Commands);

    /// A servo step has passed; it is now, µs.
    fn pass(&mut self, now_us: u64);

    /// What the circuit asks for, as the family answers what it says.
    fn circuit_order(&mut self) -> CircuitOrder;

    /// The circuit stops everything that moves by itself, and says so unless it does it silently.
    fn stop(&mut self, silently: bool);

    /// What moves comes down for the circuit; whether all stand as far as they can.
    fn come_to_a_stand(&mut self) -> bool;

    /// The loops were closed.
    fn loops_closed(&mut self);

    /// The loops are about to be opened.
    fn loops_open(&mut self);

    /// Opens and closes single loops, gives and takes the feed enable, and takes the faults of the loops.
    fn follow_loops(&mut self, measured: &Measured);

    /// Gives the axes their nominal positions for the end of the contour cycle.
    fn move_axes(&mut self, measured: &Measured);

    /// The axes have their nominal positions.
    fn settle(&mut self);

    /// The loops are open: no axis moves in this contour cycle.
    fn rest(&mut self, measured: &Measured);

    /// Transfers functions to the PLC, and learns which are done.
    fn transfer(&mut self);

    /// A contour cycle is over.
    fn end_cycle(&mut self, measured: &Measured);
}

/// The time of a control, and what passes between it and the machine.
#[derive(Clone, Default)]
pub struct Clock {
    now_us: u64,
    /// What the machine was told last.
    pub commands: Commands,
    /// What the machine measured in the last servo step.
    pub measured: Measured,
}

impl Clock {
    /// Time since power-on, µs.
    pub fn now_us(&self) -> u64 {
        self.now_us
    }

    /// It is the same control that was on before: its time goes on.
    pub fn follow_on(&mut self, before: &Clock) {
        self.now_us = before.now_us;
    }

    /// Spends a contour cycle on a machine, and shows a sampler the axes in each servo step. While the supply is off, time
    /// passes on the machine alone.
    pub fn cycle(
        &mut self,
        family: &mut impl Family,
        is_off: bool,
        plant: &mut dyn Plant,
        mut sampler: Option<&mut (dyn ServoSampler + '_)>,
    ) {
        if is_off {
            // The outputs are off.
            self.commands = Commands::default();
        }
        // Somebody may have touched the machine meanwhile.
        self.exchange(family, plant, 0, true);
        let timing = family.core().timing;
        let last = timing.steps().saturating_sub(1);
        for step in 0..timing.steps() {
            if !is_off {
                self.servo_step(family, step == 0);
                if let Some(sampler) = &mut sampler {
                    sampler.sample(self.now_us, &ServoView(&family.core().axes));
                }
            }
            // What there is after the last step, the next cycle asks for anew.
            self.exchange(family, plant, timing.step_us(), step != last);
        }
    }

    /// One servo step: a contour cycle begins with the first of its steps, a PLC scan with the first step at or after its
    /// time.
    fn servo_step(&mut self, family: &mut impl Family, first: bool) {
        let (measured, commands) = (&self.measured, &mut self.commands);
        let core = family.core();
        core.emergency.step(self.now_us, measured.control_ready);
        commands.control_ready = core.emergency.output();
        core.axes.measure(measured);
        family.begin_step(measured);
        if family.scan_is_due(self.now_us) {
            family.scan(measured, commands);
        }
        if first {
            contour_cycle(family, measured);
        }
        family.core().axes.output(commands);
        family.output(commands);
    }

    /// Lets time pass on the machine, µs. `asks`: a servo step follows that may look at the inputs.
    fn exchange(&mut self, family: &mut impl Family, plant: &mut dyn Plant, length_us: u32, asks: bool) {
        let step = Step {
            from_us: self.now_us,
            length_us,
        };
        let before = self.measured.control_ready;
        let until_us = self.now_us + u64::from(length_us);
        self.commands.reads_inputs = asks && family.looks_at_inputs(until_us);
        plant.exchange(step, &self.commands, &mut self.measured);
        if length_us > 0 {
            family.core().emergency.pass(step, before, &self.measured);
            self.now_us = until_us;
            family.pass(until_us);
        }
    }
}

/// What is decided once in each contour cycle.
fn contour_cycle(family: &mut impl Family, measured: &Measured) {
    follow_circuit(family);
    family.follow_loops(measured);
    if family.core().loops_closed {
        family.move_axes(measured);
        let core = family.core();
        core.axes.command(f64::from(core.timing.contour_us()) * 1e-6);
        family.settle();
    } else {
        family.core().axes.pass();
        family.rest(measured);
    }
    family.transfer();
    for unit in family.core().axes.iter_mut() {
        unit.count();
    }
    family.end_cycle(measured);
}

/// Follows the "control is ready" circuit.
fn follow_circuit(family: &mut impl Family) {
    match family.circuit_order() {
        CircuitOrder::Nothing => {}
        CircuitOrder::CloseLoops => {
            let core = family.core();
            core.loops_closed = true;
            core.axes.close_loops();
            family.loops_closed();
        }
        CircuitOrder::OpenLoops => open_loops(family),
        CircuitOrder::StopSilently => {
            family.stop(true);
            open_loops(family);
            // The silent stop is over with the control voltage.
            let emergency = &mut family.core().emergency;
            if emergency.circuit() == Circuit::VoltageBack {
                emergency.clear();
            }
        }
        CircuitOrder::Stop => {
            family.stop(false);
            family.core().axes.begin_shutdown();
            let stands = family.come_to_a_stand();
            if family.core().loops_closed && stands {
                open_loops(family);
            }
        }
    }
}

fn open_loops(family: &mut impl Family) {
    family.loops_open();
    let core = family.core();
    core.loops_closed = false;
    core.axes.open_loops();
}
