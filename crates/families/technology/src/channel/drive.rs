//! What the script says of a cycle, and what is reported of it.

use bahn_motion::Drive;

use super::Channel;
use crate::plc::{Reaction, cycle_at};
use crate::report::EventKind;

impl Channel<'_> {
    /// PLC and spindles do what they do in this cycle. Whether anything happened.
    pub(super) fn plc(&mut self) -> bool {
        let mut any = false;
        let cycle = self.side.cycle;
        self.side.plc.begin(cycle);
        if let Some(message) = self.side.plc.take_fault() {
            self.side.fault = Some(super::fault::named(&self.here(), "plc", message));
        }
        while let Some(reaction) = self.side.plc.next(cycle) {
            any = true;
            let at = self.now();
            match reaction {
                Reaction::Fetch(id) => self.side.answered(EventKind::Fetch, id, at),
                Reaction::Acknowledge(id) => self.side.answered(EventKind::Acknowledge, id, at),
                Reaction::Confirm(id) => {
                    if let Some(order) = self.side.orders.get_mut(id) {
                        order.state.confirmed = true;
                    }
                }
            }
        }
        any
    }

    /// How the path is to be driven now, but for where it stops.
    pub(super) fn drive_now(&self) -> Drive {
        let t = self.side.t() + 0.5 * self.side.cycle_s;
        let script = self.side.plc.script();
        let percent = script.and_then(|script| {
            let said = script.driving.overrides.iter().take_while(|(from, _)| *from <= t);
            said.last().map(|(_, percent)| *percent)
        });
        let held = script.is_some_and(|script| script.driving.holds.iter().any(|hold| hold.contains(&t)));
        let percent = percent.unwrap_or(100.0);
        Drive {
            feed_override_percent: percent,
            rapid_override_percent: percent,
            hold: held,
            ..Drive::default()
        }
    }

    /// The next cycle in which the script changes how the path is driven.
    pub(super) fn next_change(&self) -> Option<u64> {
        let script = self.side.plc.script()?;
        let cycles = script
            .driving
            .changes()
            .map(|time| cycle_at(time, self.side.cycle_s));
        cycles.filter(|cycle| *cycle > self.side.cycle).min()
    }

    /// Spends a cycle on the path. Whether anything moved.
    pub(super) fn spend(&mut self, mut drive: Drive) -> bool {
        drive.hold |= self.resets();
        let t = self.side.t() + 0.5 * self.side.cycle_s;
        let script = self.side.plc.script();
        let back =
            script.is_some_and(|script| script.driving.backward.iter().any(|range| range.contains(&t)));
        self.gates.cycle(drive, back, &mut self.side)
    }

    /// Says where the path stands, and for what.
    pub(super) fn stand(&mut self) {
        let at = self.now();
        if !self.gates.is_still() {
            self.side.record.stands_for_nothing(at.t);
            return;
        }
        let drive = self.drive_now();
        let missing = &mut self.progress.missing;
        missing.clear();
        missing.extend(self.gates.missing(&drive, &self.side));
        let orders = &self.side.orders;
        let orders = missing.iter().filter_map(|id| Some((*id, orders.get(*id)?)));
        self.side.record.stands_for(orders, at);
        let waits =
            self.gates.is_waiting(&self.side) || self.gates.is_held() || !self.progress.missing.is_empty();
        if !self.gates.stands() && waits {
            self.gates.stop(at, &mut self.side);
        }
    }

    /// The path stands, which is reported.
    pub(super) fn come_to_rest(&mut self) {
        if !self.gates.stands() {
            let at = self.now();
            self.gates.stop(at, &mut self.side);
        }
    }
}
