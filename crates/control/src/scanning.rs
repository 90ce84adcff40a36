//! Digitizing in the program: the stylus scans a surface with the axes [003:6532-6882] [000:7722-7880].

use bahn_exchange::signal;
use bahn_kernel::{AxisUnit, Chain, Mover};
use bahn_motion::{Scan, ScanStep, Sense};
use bahn_parameters::MessageId;
use bahn_path::{Axis, BlockRef, Position, ScanFault, ScanJob, ScanPoint, Scanned};
use bahn_servo::Measured;

use crate::message::Message;
use crate::site::Site;

/// The axes of a scan.
const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
/// The axes stand elsewhere than the scan has left them, mm.
const ELSEWHERE_MM: f64 = 1e-6;

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
    /// What is said.
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
    scan: Scan,
    job: ScanJob,
    /// The PLC has enabled it (M2503).
    enabled: bool,
    /// Deflected in the last servo step; where the tip was when it became so, as long as nobody has asked.
    deflected: bool,
    touch: Option<ScanPoint>,
    /// Where the tip is, nominal for the axes without an encoder.
    tip: ScanPoint,
    battery_reported: bool,
    /// Lines that had ended when the battery was looked at.
    lines: u32,
    /// The cycle that moved it last, µs.
    moved_us: u64,
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
    pub fn begin(block: BlockRef, mut job: ScanJob, site: &mut Site) -> Scanning {
        let axes = || site.axes.iter().filter(|unit| AXES.contains(&unit.axis));
        let least = |of: fn(&AxisUnit) -> f64| axes().map(of).fold(f64::INFINITY, f64::min);
        let acceleration = least(|unit| unit.parameters.motion.acceleration_m_s2);
        let rapid = least(|unit| unit.parameters.motion.rapid_mm_min);
        for feed in [&mut job.rules.rapid_mm_min, &mut job.rules.probing_mm_min] {
            *feed = feed.min(rapid);
        }
        let scan = Scan::new(job, acceleration);
        site.exchange.nc_put(signal::PROBING_ENDED, false);
        site.exchange.nc_set(signal::PROBING_ENABLE, true);
        Scanning {
            block,
            tip: scan.position(),
            scan,
            job,
            enabled: false,
            deflected: false,
            touch: None,
            battery_reported: false,
            lines: 0,
            moved_us: site.now.us,
        }
    }

    pub fn block(&self) -> BlockRef {
        self.block
    }

    /// The stylus may touch the workpiece.
    pub fn touches(&self) -> bool {
        self.enabled
    }

    /// Takes the position of the tip when the stylus is deflected; once in each servo step.
    pub fn watch<'a>(
        &mut self,
        measured: &Measured,
        axes: impl Iterator<Item = &'a AxisUnit>,
        chain: &Chain,
    ) {
        if !self.enabled {
            return;
        }
        let mut actual = Position::UNKNOWN;
        for unit in axes {
            actual[unit.axis] = unit.servo.actual_mm();
        }
        self.tip = self.tip_at(&chain.to_path(&actual));
        let deflected = measured.probe.deflected;
        if deflected && !self.deflected {
            self.touch.get_or_insert(self.tip);
        }
        self.deflected = deflected;
    }

    fn tip_at(&self, axes: &Position) -> ScanPoint {
        std::array::from_fn(|k| axes[AXES[k]] + self.job.beside[k])
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
        self.regain(site);
        let feed = self.feed(running, site);
        let touch = if feed > 0.0 { self.touch.take() } else { self.touch };
        let sense = Sense {
            deflected: measured.probe.deflected,
            at: self.place(site),
            touch,
            deflection: self.deflection(measured),
        };
        let step = self.scan.cycle(site.now.time_s, &sense, feed);
        self.lead(site);
        match step {
            ScanStep::Point(point) => {
                site.exchange.nc_set(signal::STYLUS_DEFLECTED, true);
                news.tell(Digitized::Point(point));
                ScanCycle::Moves
            }
            ScanStep::Over(scanned) if site.axes.have_arrived() => {
                news.tell(match scanned.fault {
                    None => Digitized::Complete,
                    Some(_) => Digitized::BrokenOff,
                });
                ScanCycle::Over(scanned)
            }
            ScanStep::Over(_) | ScanStep::Moves => ScanCycle::Moves,
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
        self.moved_us = site.now.us;
        Ok(())
    }

    /// A probe that is not ready any more ends the scan; a battery that is low is told when the end of a line is reached
    /// [003:8043-8045], once (inferred).
    fn look_after_probe(&mut self, site: &mut Site, measured: &Measured) {
        let probe = measured.probe;
        site.exchange.nc_put(signal::PROBE_NOT_READY, !probe.ready);
        site.exchange.nc_put(signal::PROBE_BATTERY_LOW, probe.battery_low);
        if !probe.ready {
            self.scan.break_off(ScanFault::NotReady);
        }
        let ended = self.scan.lines_ended();
        let at_line_end = std::mem::replace(&mut self.lines, ended) != ended;
        if probe.battery_low && at_line_end && !self.battery_reported {
            self.battery_reported = true;
            let message = Message::Plain(MessageId::ExchangeTouchProbeBattery);
            site.messages.show(message, Some(self.block));
        }
    }

    /// Without feed enable the axes may stand elsewhere: it goes on from there. Axes that CE took over from where they are
    /// go back with NC start to where it has left them. The stylus leaves the surface first, so that no point is taken where
    /// axes ran on (inferred).
    fn regain(&mut self, site: &Site) {
        let passed_us = site.now.us.saturating_sub(self.moved_us);
        self.moved_us = site.now.us;
        // Two cycles and more without a movement.
        if passed_us as f64 * 1e-6 < 1.5 * site.now.time_s {
            return;
        }
        let here = self.tip_at(&site.chain.to_path(&site.axes.left_position()));
        let nominal = self.scan.position();
        self.touch = None;
        let away = (0..3).any(|k| (here[k] - nominal[k]).abs() > ELSEWHERE_MM);
        self.scan.stand_at(if away { here } else { nominal });
    }

    /// What the override leaves of the speeds; rapid traverse may be limited by PLC and probe.
    fn feed(&self, running: bool, site: &Site) -> f64 {
        if !running {
            return 0.0;
        }
        let limit = site.now.rapid_limit_mm_min / self.job.rules.rapid_mm_min;
        (site.now.feed_percent / 100.0).min(limit).min(1.0)
    }

    /// Where the tip is. An axis that stands in its position window is where it is to be.
    fn place(&self, site: &Site) -> ScanPoint {
        let mut at = self.tip;
        let (nominal, velocity) = (self.scan.position(), self.scan.velocity_mm_s());
        for unit in site.axes.iter() {
            let place = AXES.iter().position(|axis| *axis == unit.axis);
            if let Some(place) = place.filter(|place| velocity[*place] == 0.0)
                && unit.servo.in_position()
            {
                at[place] = nominal[place];
            }
        }
        at
    }

    /// How far a measuring probe is deflected along the axes of the machine.
    fn deflection(&self, measured: &Measured) -> ScanPoint {
        let Some(measuring) = &self.job.rules.measuring else {
            return [0.0; 3];
        };
        measuring.along_axes(&measured.probe.deflection_mm)
    }

    /// It leads an axis.
    pub fn leads(axis: Axis) -> bool {
        AXES.contains(&axis)
    }

    /// The axes follow the scan.
    fn lead(&self, site: &mut Site) {
        let (tip, mut position) = (self.scan.position(), site.here());
        for (place, axis) in AXES.into_iter().enumerate() {
            position[axis] = tip[place] - self.job.beside[place];
        }
        let (nominal, time) = (site.chain.to_axes(&position), site.now.time_s);
        for unit in site.axes.iter_mut() {
            let value = nominal[unit.axis];
            let leads = AXES.contains(&unit.axis) && value.is_finite() && !unit.is_plc_axis();
            if leads && matches!(unit.mover, Mover::None | Mover::Path) {
                unit.follow_probe(value, time);
            }
        }
    }
}
