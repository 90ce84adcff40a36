//! Digitizing in the program: the stylus scans a surface with the axes [003:6532-6882] [000:7722-7880].
//!
//! Decision: After an EMERGENCY STOP or without feed enable a scan goes on from where the axes stand, off the surface
//! first; a probe that is not ready any more ends it, a low battery is said once, at the end of the first line after
//! which it is low (also `kernel/src/scanning.rs`)

use bahn_exchange::signal;
use bahn_kernel::{AxisUnit, Chain, Felt, ScanMove};
use bahn_motion::ScanStep;
use bahn_parameters::MessageId;
use bahn_path::{BlockRef, ScanFault, ScanJob, ScanPoint, Scanned};
use bahn_servo::Measured;

use crate::message::Message;
use crate::site::Site;

/// What a digitizing has come to: the control knows no files, so whoever drives it keeps the points.
#[allow(clippy::large_enum_variant, reason = "one at a time, and no cycle allocates")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Digitized {
    /// A scan is wanted; the PLC may still have to enable it.
    Begins(ScanJob),
    /// A point of the surface: the tip of the stylus.
    Point(ScanPoint),
    /// The range is scanned.
    Complete,
    /// The scan was broken off: it begins anew when the program goes on.
    BrokenOff,
}

/// What was said of digitizing last. A cycle says one thing at most.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DigitizedNews {
    /// It grows with everything that is said.
    pub number: u64,
    /// What was said last; `None` before anything was.
    pub what: Option<Digitized>,
}

impl DigitizedNews {
    pub(crate) fn tell(&mut self, what: Digitized) {
        self.number += 1;
        self.what = Some(what);
    }
}

/// A scan that is on its way.
#[derive(Clone, Debug)]
pub(crate) struct Scanning {
    block: BlockRef,
    moves: ScanMove,
    /// The PLC has enabled it (M2503).
    enabled: bool,
    battery_reported: bool,
}

/// What a cycle of scanning comes to.
pub(crate) enum ScanCycle {
    Moves,
    /// The axes stand where it ended.
    Over(Scanned),
    Refused(Message),
}

impl Scanning {
    /// The path came to a digitizing cycle: the PLC is asked to enable it [000:7682-7690].
    pub fn begin(block: BlockRef, job: ScanJob, site: &mut Site) -> Scanning {
        site.exchange.nc_put(signal::PROBING_ENDED, false);
        site.exchange.nc_set(signal::PROBING_ENABLE, true);
        Scanning {
            block,
            moves: ScanMove::new(job, &site.axes, &site.now),
            enabled: false,
            battery_reported: false,
        }
    }

    pub fn block(&self) -> BlockRef {
        self.block
    }

    /// The stylus may touch the workpiece.
    pub fn touches(&self) -> bool {
        self.enabled
    }

    /// Looks at the stylus; once in each servo step.
    pub fn watch<'a>(&mut self, deflected: bool, axes: impl Iterator<Item = &'a AxisUnit>, chain: &Chain) {
        if self.enabled {
            self.moves.watch(deflected, axes, chain);
        }
    }

    /// Moves the axes for a cycle, and says what there is to be kept.
    pub fn moves(
        &mut self,
        running: bool,
        site: &mut Site,
        measured: &Measured,
        news: &mut DigitizedNews,
    ) -> ScanCycle {
        if !self.enabled {
            let enabled = running && !site.exchange.nc().bit(signal::PROBING_ENABLE);
            return match enabled.then(|| self.enter(site, measured)) {
                Some(Err(message)) => ScanCycle::Refused(message),
                Some(Ok(())) | None => ScanCycle::Moves,
            };
        }
        self.look_after_probe(site, measured);
        let felt = Felt {
            deflected: measured.probe.deflected,
            deflection_mm: self.deflection(measured),
        };
        let step = self
            .moves
            .moves(running, &felt, &mut site.axes, site.chain, &site.now);
        match step {
            ScanStep::Point(point) => {
                site.exchange.nc_set(signal::STYLUS_DEFLECTED, true);
                news.tell(Digitized::Point(point));
                ScanCycle::Moves
            }
            ScanStep::Over(scanned) => {
                news.tell(match scanned.fault {
                    None => Digitized::Complete,
                    Some(_) => Digitized::BrokenOff,
                });
                ScanCycle::Over(scanned)
            }
            ScanStep::Moves => ScanCycle::Moves,
        }
    }

    /// The PLC has enabled it: the probe must be ready and at rest.
    fn enter(&mut self, site: &mut Site, measured: &Measured) -> Result<(), Message> {
        let probe = measured.probe;
        site.exchange.nc_put(signal::PROBE_NOT_READY, !probe.ready);
        if !probe.ready {
            return Err(Message::Plain(MessageId::ProbeSystemNotReady));
        }
        site.exchange
            .nc_put(signal::STYLUS_ALREADY_DEFLECTED, probe.deflected);
        if probe.deflected {
            return Err(Message::Plain(MessageId::StylusAlreadyInContact));
        }
        self.enabled = true;
        self.moves.begin(&site.now);
        Ok(())
    }

    /// A probe that is not ready any more ends the scan; a battery that is low is told when the end of a line is reached
    /// [003:8043-8045], once (inferred).
    fn look_after_probe(&mut self, site: &mut Site, measured: &Measured) {
        let probe = measured.probe;
        site.exchange.nc_put(signal::PROBE_NOT_READY, !probe.ready);
        site.exchange.nc_put(signal::PROBE_BATTERY_LOW, probe.battery_low);
        if !probe.ready {
            self.moves.break_off(ScanFault::NotReady);
        }
        let at_line_end = self.moves.takes_line_end();
        if probe.battery_low && at_line_end && !self.battery_reported {
            self.battery_reported = true;
            let message = Message::Plain(MessageId::ExchangeTouchProbeBattery);
            site.messages.show(message, Some(self.block));
        }
    }

    /// How far a measuring probe is deflected along the axes of the machine.
    fn deflection(&self, measured: &Measured) -> ScanPoint {
        let Some(measuring) = &self.moves.job().rules.measuring else {
            return [0.0; 3];
        };
        measuring.along_axes(&measured.probe.deflection_mm)
    }
}
