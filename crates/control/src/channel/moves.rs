//! What moves the axes of a channel in a contour cycle: what its operating mode says, then the PLC.

use bahn_servo::{HandwheelInputs, Measured};

use super::Channel;
use crate::command::Mode;
use crate::machine::MachineSide;
use crate::now::Now;
use crate::positioning::Moving;
use crate::reference;

impl Channel {
    /// Finds the nominal positions of its axes for the end of the contour cycle. NC start is kept as long as the
    /// operating mode waits for axes to come to a standstill.
    pub fn move_axes(&mut self, machine: &mut MachineSide, measured: &Measured) {
        let now = self.now(machine);
        let mut axes = machine.core.axes.of(self.number);
        reference::count_display_axes(&mut axes);
        let superimposes = self.datums.chain.superimposed.is_on();
        let exchange = machine.memory.of_mut(self.number);
        self.desk
            .count_handwheel(superimposes, &measured.operator.handwheel, &axes, exchange);
        self.desk.follow_stop(&now, self.touch.is_chosen());
        let automatic = now.mode.is_automatic();
        let rigid = self.run.taps_rigidly();
        let ready = axes.choose_methods(automatic && !self.desk.runs_reference(), rigid);
        // What the mode before moved comes to a standstill first.
        let waits = automatic && !ready && !self.run.is_active();
        if !waits {
            self.move_by_mode(&now, machine, measured);
        }
        self.move_for_plc(&now, machine);
        machine.core.axes.of(self.number).slow_down(now.time_s);
        if !waits {
            self.desk.forget_start();
        }
    }

    fn move_by_mode(&mut self, now: &Now, machine: &mut MachineSide, measured: &Measured) {
        let handwheel = &measured.operator.handwheel;
        match now.mode {
            Mode::Manual | Mode::Handwheel => {
                if self.touch.is_chosen() {
                    if self.probe_by_hand(machine, measured) {
                        return;
                    }
                } else {
                    self.output_entered(now, machine);
                }
                self.move_manually(handwheel, now, machine);
            }
            Mode::Reference => {
                let mut axes = machine.core.axes.of(self.number);
                let nc = machine.memory.of(self.number).nc();
                self.desk.move_reference(&mut axes, nc, now);
            }
            Mode::Mdi | Mode::SingleBlock | Mode::FullSequence => {
                let nc = machine.memory.of(self.number).nc();
                let by_hand = self.run.is_operated_manually(nc) || self.desk.manual.is_led();
                if by_hand && !self.run.track.path.is_coupled() {
                    self.move_manually(handwheel, now, machine);
                } else {
                    if now.stop {
                        self.stop();
                    } else if now.start {
                        let (run, mut site, _) = self.parts(machine);
                        run.start(&mut site);
                    }
                    let (run, mut site, _) = self.parts(machine);
                    run.moves(&mut site, measured);
                }
                let (run, mut site, _) = self.parts(machine);
                run.move_back(&mut site);
            }
        }
    }

    fn output_entered(&mut self, now: &Now, machine: &mut MachineSide) {
        let (mut manual, model) = (self.desk.manual, machine.model);
        let (_, mut site, _) = self.parts(machine);
        manual.output_entered(model, now, &mut site);
        self.desk.manual = manual;
    }

    /// A function of the TOUCH PROBE menu is chosen: whether it moves the axes.
    fn probe_by_hand(&mut self, machine: &mut MachineSide, measured: &Measured) -> bool {
        let mut touch = self.touch;
        let (run, mut site, basis) = self.parts(machine);
        let settings = basis.list.probe();
        let (moves, kept) = touch.moves(&mut run.probe, &settings, measured, &mut site);
        self.touch = touch;
        machine.unsaved |= kept;
        moves
    }

    fn move_manually(&mut self, handwheel: &HandwheelInputs, now: &Now, machine: &mut MachineSide) {
        let mut axes = machine.core.axes.of(self.number);
        let nc = machine.memory.of(self.number).nc();
        let block = self.run.running_block();
        let messages = machine.messages.of_channel(self.number);
        self.desk
            .move_by_hand(handwheel, &mut axes, nc, messages, block, now);
    }

    /// Moves what the PLC commands.
    fn move_for_plc(&mut self, now: &Now, machine: &mut MachineSide) {
        let moving = Moving {
            now: *now,
            active: self.run.is_active(),
            restores: self.run.restores(),
        };
        let exchange = machine.memory.of_mut(self.number);
        let mut axes = machine.core.axes.of(self.number);
        self.positioning.moves(&mut axes, exchange, &moving);
        if self.number == 0 {
            // Modules know the axes of the first channel.
            let statuses = &mut machine.link.plc_axes;
            self.positioning.move_plc_axes(&mut axes, statuses, now);
        }
        self.positioning.move_rotation(&mut axes, exchange.nc(), now);
    }
}
