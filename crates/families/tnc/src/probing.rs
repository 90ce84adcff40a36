//! Probing in the program: the axes move until the stylus is deflected [000:7613-7718].
//!
//! Decision: A deflected stylus (M2502) stops until all axes stand and no key moves them; programs go on when it is
//! free

use bahn_exchange::signal;
use bahn_kernel::probing::{self, Probing};
use bahn_kernel::{AxisUnit, Chain, OwnAxes, ScanMove};
use bahn_parameters::MessageId;
use bahn_parameters::machining::ProbeSettings;
use bahn_path::{Barrier, BlockRef, LiveData, Position, ScanFault, ScanJob, Scanned, ToolMeasuring, Touch};
use bahn_servo::{Measured, Probe as ProbeState};

use crate::message::Message;
use crate::scanning::{Digitized, DigitizedNews, ScanCycle, Scanning};
use crate::site::Site;
use crate::tool_measuring::{Measuring, ToolMeasurement};

/// What M2502 makes of the stylus.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stylus {
    deflected: bool,
    /// A probing has deflected it, and it is not yet free again.
    probed: bool,
    /// The stylus was deflected where it may not be: NC stop holds.
    pub stops: bool,
    /// What the probe says.
    pub touch: ProbeState,
}

/// A probing movement, and who wants it.
#[derive(Clone, Copy, Debug)]
struct Wanted {
    /// The block that probes; `None` for the operator, who finds the axes where he started.
    block: Option<BlockRef>,
    moves: Probing,
}

/// What a probing comes to in a cycle.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Probed {
    /// The movement goes on.
    Moves,
    /// It is over: the program learns of the touch, or that there was none.
    Over(Option<Touch>),
    /// A tool was measured or a surface digitized: the program learns of it.
    Found(LiveData),
    /// It is refused, with a message at its block.
    Refused(Message, Option<BlockRef>),
}

impl Probed {
    /// What would be measured beside the path (M118) is refused: nobody would know where it lies (inferred).
    pub fn beside_the_path(barrier: &Barrier) -> Probed {
        let (Barrier::Probe { block, .. }
        | Barrier::Stop { block }
        | Barrier::Acknowledge { block }
        | Barrier::Scan { block, .. }
        | Barrier::MeasureTool(ToolMeasuring { block, .. })) = barrier;
        Probed::Refused(Message::Plain(MessageId::ProbeSystemNotReady), Some(*block))
    }
}

/// How the axes move that a stylus guards.
pub(crate) struct Guarded {
    /// All stand, and no direction key is pressed.
    pub rest: bool,
    /// Blocks run in the operating mode.
    pub automatic: bool,
}

impl Stylus {
    /// M2502: the machine stops when the stylus is deflected, in all modes, but where it may be, by a probing or where it leads
    /// the axes, until it has left the workpiece again; not with a TS 511, which is on standby otherwise [000:7652]. The stop stays
    /// until all axes stand and no key moves them: by hand the stylus can then be freed; a program goes on only
    /// when it is free (inferred).
    pub fn watch(
        &mut self,
        measured: &Measured,
        guards: bool,
        may_touch: bool,
        guarded: impl FnOnce() -> Guarded,
    ) {
        self.touch = measured.probe;
        if !guards && !self.stops {
            return;
        }
        let touches = guards && measured.probe.deflected;
        self.probed = touches && (may_touch || self.probed);
        let deflected = touches && !self.probed;
        let rises = deflected && !self.deflected;
        self.deflected = deflected;
        let Guarded { rest, automatic } = guarded();
        let stays = deflected && automatic || !rest;
        self.stops = rises || self.stops && stays;
    }
}

/// The probing movement that is on its way, if one is.
#[derive(Clone, Debug, Default)]
pub(crate) struct Probe {
    probing: Option<Wanted>,
    /// The block that measures a tool.
    block: Option<BlockRef>,
    tool: ToolMeasurement,
    scanning: Option<Scanning>,
    /// What was digitized last.
    pub digitized: DigitizedNews,
}

impl Probe {
    /// A probing movement is on its way.
    pub fn is_on(&self) -> bool {
        self.probing.is_some() || self.tool.is_on() || self.scanning.is_some()
    }

    /// An axis of the way cannot move: the way stands at once, as a path does [000:5352]. A scan goes on from where the axes
    /// are then.
    pub fn is_held(&mut self, axes: &OwnAxes) -> bool {
        let scans = self.scanning.as_ref().is_some_and(Scanning::touches);
        let held = match &mut self.probing {
            _ if scans => axes
                .iter()
                .any(|unit| ScanMove::leads(unit.axis) && !unit.may_be_led()),
            Some(probing) => probing.moves.line().is_held(axes),
            None => false,
        };
        self.tool.is_held(axes) || held
    }

    /// The stylus is on its way to a surface, or is about to be. Measuring of tools is something else.
    pub fn seeks_surface(&self) -> bool {
        self.probing.is_some() || self.scanning.is_some()
    }

    /// The straight way that is on its way: its start and its farthest end, path coordinates.
    pub fn way(&self) -> Option<[Position; 2]> {
        let probing = self.probing.map(|probing| probing.moves.ends());
        probing.or_else(|| self.tool.way())
    }

    /// The path came to a digitizing cycle.
    pub fn scan(&mut self, block: BlockRef, job: ScanJob, site: &mut Site) {
        self.scanning = Some(Scanning::begin(block, job, site));
        self.digitized.tell(Digitized::Begins(job));
    }

    /// The path came to a cycle that measures tools.
    pub fn measure(&mut self, order: ToolMeasuring, site: &mut Site) -> Probed {
        self.block = Some(order.block);
        match self.tool.begin(order, site) {
            Ok(()) => Probed::Moves,
            Err(message) => Probed::Refused(message, Some(order.block)),
        }
    }

    /// The stylus may touch the workpiece.
    pub fn touches(&self) -> bool {
        self.probing.is_some_and(|probing| probing.moves.has_begun())
            || self.scanning.as_ref().is_some_and(Scanning::touches)
    }

    /// The path came to a probe block: asks the PLC to enable it [000:7682-7690].
    pub fn begin(&mut self, block: BlockRef, ends: [Position; 2], feed_mm_min: f64, site: &mut Site) {
        self.enable(Some(block), ends, (feed_mm_min, None), site);
    }

    /// The operator probes: after the touch the axes go back to the start in rapid traverse [003:1217-1224].
    pub fn begin_by_hand(&mut self, ends: [Position; 2], settings: &ProbeSettings, site: &mut Site) {
        let feeds = (settings.feed_mm_min, Some(settings.rapid_mm_min));
        self.enable(None, ends, feeds, site);
    }

    /// It moves no axis now.
    pub fn stands(&self) -> bool {
        self.probing.is_none_or(|probing| probing.moves.stands())
    }

    fn enable(
        &mut self,
        block: Option<BlockRef>,
        ends: [Position; 2],
        (feed_mm_min, home_mm_min): (f64, Option<f64>),
        site: &mut Site,
    ) {
        self.probing = Some(Wanted {
            block,
            moves: Probing::new(ends, feed_mm_min, home_mm_min, &site.axes, site.chain),
        });
        site.exchange.nc_put(signal::PROBING_ENDED, false);
        site.exchange.nc_set(signal::PROBING_ENABLE, true);
    }

    /// Takes the position of the axes when the stylus is deflected; once in each servo step.
    pub fn watch<'a>(
        &mut self,
        measured: &Measured,
        axes: impl Iterator<Item = &'a AxisUnit> + Clone,
        chain: &Chain,
    ) {
        self.tool.watch(measured, axes.clone(), chain);
        if let Some(scanning) = &mut self.scanning {
            scanning.watch(measured.probe.deflected, axes.clone(), chain);
        }
        if let Some(probing) = &mut self.probing {
            probing.moves.watch(measured.probe.deflected, axes, chain);
        }
    }

    /// Moves the axes of a probing for a cycle.
    pub fn moves(&mut self, running: bool, site: &mut Site, measured: &Measured) -> Probed {
        if self.tool.is_on() {
            return self.measures(running, site, measured);
        }
        if self.scanning.is_some() {
            return self.scans(running, site, measured);
        }
        let Some(probing) = &mut self.probing else {
            return Probed::Moves;
        };
        // M2503 is set; the PLC resets it when probing may begin.
        if !probing.moves.has_begun() && running && !site.exchange.nc().bit(signal::PROBING_ENABLE) {
            return self.enter(site, measured);
        }
        let block = probing.block;
        match probing
            .moves
            .moves(running, &mut site.axes, site.chain, &site.now)
        {
            probing::Probed::Moves => Probed::Moves,
            probing::Probed::Touches => {
                site.exchange.nc_set(signal::STYLUS_DEFLECTED, true);
                Probed::Moves
            }
            probing::Probed::AtLimit(axis, direction) => {
                Probed::Refused(site.limit_message(axis, direction), block)
            }
            probing::Probed::Over(touched) => self.finish(touched, site),
        }
    }

    /// Moves the axes of a tool measuring for a cycle.
    fn measures(&mut self, running: bool, site: &mut Site, measured: &Measured) -> Probed {
        match (self.tool.moves(running, site, measured), self.block) {
            (Measuring::Over(live), _) => Probed::Found(live),
            (Measuring::Refused(message), block @ Some(_)) => Probed::Refused(message, block),
            _ => Probed::Moves,
        }
    }

    /// Moves the axes of a digitizing for a cycle.
    fn scans(&mut self, running: bool, site: &mut Site, measured: &Measured) -> Probed {
        let Some(scanning) = &mut self.scanning else {
            return Probed::Moves;
        };
        let block = Some(scanning.block());
        match scanning.moves(running, site, measured, &mut self.digitized) {
            ScanCycle::Moves => Probed::Moves,
            ScanCycle::Over(Scanned {
                fault: Some(ScanFault::DeflectionExceedsMax),
                ..
            }) => Probed::Refused(Message::Plain(MessageId::StylusDeflectionExceedsMax), block),
            ScanCycle::Over(scanned) => {
                self.end(site);
                Probed::Found(LiveData {
                    scan: Some(scanned),
                    ..LiveData::default()
                })
            }
            ScanCycle::Refused(message) => Probed::Refused(message, block),
        }
    }

    /// The PLC has enabled the probing: the probe must be ready and at rest.
    fn enter(&mut self, site: &mut Site, measured: &Measured) -> Probed {
        let ready = measured.probe.ready;
        site.exchange.nc_put(signal::PROBE_NOT_READY, !ready);
        site.exchange
            .nc_put(signal::PROBE_BATTERY_LOW, measured.probe.battery_low);
        let Some(probing) = &mut self.probing else {
            return Probed::Moves;
        };
        if measured.probe.battery_low {
            // Only an infrared probe has one [003:8043].
            let message = Message::Plain(MessageId::ExchangeTouchProbeBattery);
            site.messages.show(message, probing.block);
        }
        if !ready {
            let message = Message::Plain(MessageId::ProbeSystemNotReady);
            return Probed::Refused(message, probing.block);
        }
        let deflected = measured.probe.deflected;
        site.exchange.nc_put(signal::STYLUS_ALREADY_DEFLECTED, deflected);
        if deflected && probing.block.is_none() {
            let message = Message::Plain(MessageId::StylusAlreadyInContact);
            return Probed::Refused(message, None);
        }
        if deflected {
            let [from, _] = probing.moves.ends();
            return self.finish(Some(from), site);
        }
        probing.moves.begin();
        Probed::Moves
    }

    fn finish(&mut self, touched: Option<Position>, site: &mut Site) -> Probed {
        self.end(site);
        Probed::Over(touched.map(|position| Touch { position }))
    }

    /// Nothing is probed any more.
    pub fn end(&mut self, site: &mut Site) {
        self.tool.end(site);
        let scanned = self.scanning.take();
        if scanned.is_some()
            && matches!(
                self.digitized.what,
                Some(Digitized::Begins(_) | Digitized::Point(_))
            )
        {
            self.digitized.tell(Digitized::BrokenOff);
        }
        if self.probing.take().is_some() || scanned.is_some() {
            site.exchange.nc_put(signal::PROBING_ENABLE, false);
            site.exchange.nc_put(signal::PROBING_ENDED, true);
        }
    }
}
