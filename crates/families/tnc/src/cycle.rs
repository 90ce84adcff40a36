//! What a TNC decides in the course of a contour cycle: scans of its PLC, and what its channels do.

use bahn_kernel::{CircuitOrder, Core, Family, PerChannel};
use bahn_plc::Tracer;
use bahn_servo::{Commands, Measured};

use crate::channel::{Channel, moves};
use crate::compensation::Compensation;
use crate::machine::MachineSide;

/// Machine side and channels for a contour cycle.
pub(crate) struct Cycle<'a, 't> {
    pub machine: &'a mut MachineSide,
    pub channels: &'a mut PerChannel<Channel>,
    /// Tool changes and datums must be stored before their strobe is reset.
    pub keeps: bool,
    /// Who looks at what the PLC executes.
    pub tracer: Option<&'a mut (dyn Tracer + 't)>,
}

impl Family for Cycle<'_, '_> {
    fn core(&mut self) -> &mut Core {
        &mut self.machine.core
    }

    fn begin_step(&mut self, measured: &Measured) {
        for spindle in self.machine.spindles.iter_mut() {
            spindle.drive.measure(measured);
        }
        for channel in self.channels.iter_mut() {
            channel.watch_probe(self.machine, measured);
        }
    }

    fn looks_at_inputs(&mut self, at_us: u64) -> bool {
        self.machine.looks_at_inputs(at_us)
    }

    fn scan_is_due(&mut self, now_us: u64) -> bool {
        self.machine.scan_is_due(now_us)
    }

    /// A PLC scan: inputs in, program, outputs out, then what the PLC asks for.
    fn scan(&mut self, measured: &Measured, commands: &mut Commands) {
        let machine = &mut *self.machine;
        machine.read_inputs(measured);
        for channel in self.channels.iter_mut() {
            channel.publish(measured, machine);
        }
        machine.link.program_running = self.channels.iter().any(|channel| channel.run.is_active());
        self.channels.first().inform(machine);
        let block = self.channels.first().run.running_block();
        let tracer = self.tracer.as_mut();
        let tracer = tracer.map(|tracer| &mut **tracer as &mut dyn Tracer);
        if !machine.scan(block, tracer) {
            return;
        }
        machine.write_outputs(commands);
        for channel in self.channels.iter_mut() {
            channel.after_scan(machine);
        }
        let block = self.channels.first().run.running_block();
        machine.messages.follow_plc(machine.memory.first(), block);
        let first = self.channels.first().number();
        let spindle = machine.spindles.of_mut(first);
        spindle.take_requests(&mut machine.link.requests);
        for channel in self.channels.iter_mut() {
            channel.take_strobes(machine);
        }
        self.take_module_requests();
    }

    fn output(&mut self, commands: &mut Commands) {
        for spindle in self.machine.spindles.iter_mut() {
            spindle.output(commands);
        }
    }

    fn pass(&mut self, now_us: u64) {
        self.machine.messages.set_time(now_us);
    }

    fn circuit_order(&mut self) -> CircuitOrder {
        let block = self.channels.first().run.running_block();
        self.machine.circuit_order(block)
    }

    fn stop(&mut self, silently: bool) {
        for channel in self.channels.iter_mut() {
            channel.stop();
        }
        if !silently {
            let block = self.channels.first().run.running_block();
            self.machine.show_emergency_stop(block);
        }
    }

    fn come_to_a_stand(&mut self) -> bool {
        let mut stand = true;
        for channel in self.channels.iter_mut() {
            stand &= channel.end_for_emergency(self.machine);
        }
        stand
    }

    fn loops_closed(&mut self) {
        for channel in self.channels.iter_mut() {
            channel.loops_closed(&mut self.machine.core.axes);
        }
    }

    fn loops_open(&mut self) {
        for channel in self.channels.iter_mut() {
            channel.loops_opened(self.machine);
        }
    }

    fn follow_loops(&mut self, measured: &Measured) {
        let monitoring_off = self.machine.monitoring_is_off(measured);
        for channel in self.channels.iter_mut() {
            channel.follow_loops(monitoring_off, self.machine);
        }
        for channel in self.channels.iter_mut() {
            channel.take_faults(self.machine);
        }
    }

    fn move_axes(&mut self, measured: &Measured) {
        for channel in self.channels.iter_mut() {
            moves::move_axes(channel, self.machine, measured);
        }
    }

    fn settle(&mut self) {
        for channel in self.channels.iter_mut() {
            channel.settle(&mut self.machine.core.axes);
        }
    }

    fn rest(&mut self, measured: &Measured) {
        for channel in self.channels.iter_mut() {
            channel.forget_input(measured);
        }
    }

    fn transfer(&mut self) {
        for channel in self.channels.iter_mut() {
            channel.follow_plc(self.keeps, self.machine);
        }
    }

    fn end_cycle(&mut self, measured: &Measured) {
        self.machine.look_after(measured);
    }
}

impl Cycle<'_, '_> {
    /// What modules asked for in a scan.
    fn take_module_requests(&mut self) {
        let machine = &mut *self.machine;
        self.channels.first_mut().take_module_requests(machine);
        machine.reset_wanted |= std::mem::take(&mut machine.link.requests.restart);
        if let Some(line) = machine.link.requests.compensation_line.take() {
            machine.compensation = Compensation::of(&machine.link.files, usize::try_from(line).ok());
            machine.unsaved = true;
        }
        if std::mem::take(&mut machine.link.requests.parameters_changed) {
            machine.take_parameters();
            self.channels.first_mut().take_parameters(machine);
        }
    }
}
