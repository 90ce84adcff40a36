//! Probing in the program: the axes move until the stylus is deflected [000:7613-7718].

use bahn_exchange::signal;
use bahn_kernel::{AxisUnit, Chain, Direction, Mover, OwnAxes};
use bahn_motion::{Aim, PointToPoint};
use bahn_parameters::MessageId;
use bahn_parameters::machining::ProbeSettings;
use bahn_path::{
    Axis, Barrier, BlockRef, LiveData, PerAxis, Position, ScanFault, ScanJob, Scanned, ToolMeasuring, Touch,
};
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
    /// NC stop.
    pub stops: bool,
    /// What the probe says.
    pub touch: ProbeState,
}

/// A probing movement on a straight line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probing {
    phase: Phase,
    /// The block that probes; `None` for the operator, who finds the axes where he started.
    block: Option<BlockRef>,
    /// Feed back to the start, mm/min.
    home_mm_min: Option<f64>,
    /// The software limit that lies within the way: it ends there [000:3522].
    limit: Option<(Axis, Direction)>,
    /// Start of the way and its farthest end, path coordinates.
    from: Position,
    to: Position,
    feed_mm_min: f64,
    /// Path acceleration, m/s².
    acceleration_m_s2: f64,
    /// Way along the line, mm.
    way: PointToPoint,
    length: f64,
    /// Where along the line the stylus was deflected, mm.
    touch: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// M2503 is set; the PLC resets it when probing may begin.
    Enable,
    Search,
    /// Touched: down to a standstill.
    Brake,
    /// Back to where the stylus was deflected.
    Return,
    /// Back to the start.
    Home,
}

/// What a probing comes to in a cycle.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Probed {
    /// It goes on.
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
    probing: Option<Probing>,
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
        let led = |axis: Axis| Scanning::leads(axis) && scans;
        let moves = |probing: &Probing, axis: Axis| probing.to[axis] != probing.from[axis];
        let probing = self.probing.as_ref().filter(|_| !scans);
        let held = axes.iter().any(|unit| {
            let own = led(unit.axis) || probing.is_some_and(|probing| moves(probing, unit.axis));
            own && !unit.may_be_led()
        });
        if let Some(probing) = self.probing.as_mut().filter(|_| held) {
            probing.way = PointToPoint::new(probing.way.position());
        }
        self.tool.is_held(axes) || held
    }

    /// The stylus is on its way to a surface, or is about to be. Measuring of tools is something else.
    pub fn seeks_surface(&self) -> bool {
        self.probing.is_some() || self.scanning.is_some()
    }

    /// The straight way that is on its way: its start and its farthest end, path coordinates.
    pub fn way(&self) -> Option<[Position; 2]> {
        let probing = self.probing.map(|probing| [probing.from, probing.to]);
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
        self.probing.is_some_and(|probing| probing.phase != Phase::Enable)
            || self.scanning.as_ref().is_some_and(Scanning::touches)
    }

    /// The path came to a probe block: asks the PLC to enable it [000:7682-7690].
    pub fn begin(&mut self, block: BlockRef, ends: [Position; 2], feed_mm_min: f64, site: &mut Site) {
        self.enable(Some(block), ends, [feed_mm_min, 0.0], site);
    }

    /// The operator probes: after the touch the axes go back to the start in rapid traverse [003:1217-1224].
    pub fn begin_by_hand(&mut self, ends: [Position; 2], settings: &ProbeSettings, site: &mut Site) {
        self.enable(None, ends, [settings.feed_mm_min, settings.rapid_mm_min], site);
    }

    /// It moves no axis now.
    pub fn stands(&self) -> bool {
        self.probing.is_none_or(|probing| probing.way.speed_mm_s() == 0.0)
    }

    fn enable(&mut self, block: Option<BlockRef>, ends: [Position; 2], feeds: [f64; 2], site: &mut Site) {
        let ([from, to], [feed_mm_min, home_mm_min]) = (ends, feeds);
        let (to, limit) = within_range(&from, to, &site.axes, site.chain);
        let way = |axis: Axis| to[axis] - from[axis];
        let moving = |axis: &Axis| way(*axis).abs() > 0.0;
        let length = Axis::ALL.into_iter().filter(moving).map(|axis| way(axis).powi(2));
        let acceleration = site
            .axes
            .iter()
            .filter(|unit| moving(&unit.axis))
            .map(|unit| unit.parameters.motion.acceleration_m_s2)
            .fold(f64::INFINITY, f64::min);
        self.probing = Some(Probing {
            phase: Phase::Enable,
            block,
            home_mm_min: block.is_none().then_some(home_mm_min),
            limit,
            from,
            to,
            feed_mm_min,
            acceleration_m_s2: acceleration,
            way: PointToPoint::new(0.0),
            length: length.sum::<f64>().sqrt(),
            touch: None,
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
            scanning.watch(measured, axes.clone(), chain);
        }
        let Some(probing) = &mut self.probing else { return };
        if probing.phase != Phase::Search || probing.touch.is_some() || !measured.probe.deflected {
            return;
        }
        let mut actual = Position::UNKNOWN;
        for unit in axes.clone() {
            actual[unit.axis] = unit.servo.actual_mm();
        }
        let actual = chain.to_path(&actual);
        let along = axes.map(|unit| {
            let axis = unit.axis;
            let way = probing.to[axis] - probing.from[axis];
            let at = actual[axis] - probing.from[axis];
            if way == 0.0 || way.is_nan() {
                0.0
            } else {
                at * way / probing.length
            }
        });
        probing.touch = Some(along.sum());
    }

    /// Moves the axes of a probing for a cycle.
    pub fn moves(&mut self, running: bool, site: &mut Site, measured: &Measured) -> Probed {
        if self.tool.is_on() {
            return self.measures(running, site, measured);
        }
        if self.scanning.is_some() {
            return self.scans(running, site, measured);
        }
        let percent = site.now.feed_percent.min(100.0);
        let Some(probing) = &mut self.probing else {
            return Probed::Moves;
        };
        let feed = (probing.feed_mm_min * percent / 100.0).min(site.now.rapid_limit_mm_min);
        let aim = match probing.phase {
            Phase::Enable => {
                if running && !site.exchange.nc().bit(signal::PROBING_ENABLE) {
                    return self.enter(site, measured);
                }
                return Probed::Moves;
            }
            _ if !running => Aim::Feed(0.0),
            Phase::Search => match probing.touch {
                Some(_) => {
                    probing.phase = Phase::Brake;
                    site.exchange.nc_set(signal::STYLUS_DEFLECTED, true);
                    Aim::Feed(0.0)
                }
                None => Aim::Position(probing.length),
            },
            Phase::Brake => Aim::Feed(0.0),
            Phase::Return => Aim::Position(probing.touch.unwrap_or(0.0)),
            Phase::Home => Aim::Position(0.0),
        };
        let feed = match probing.home_mm_min.filter(|_| probing.phase == Phase::Home) {
            Some(rapid) => (rapid * percent / 100.0).min(site.now.rapid_limit_mm_min),
            None => feed,
        };
        let feed = if aim == Aim::Feed(0.0) {
            probing.feed_mm_min
        } else {
            feed
        };
        let time = site.now.time_s;
        let at = probing.way.cycle(time, aim, feed, probing.acceleration_m_s2);
        let stands = probing.way.speed_mm_s() == 0.0;
        let position = along(probing, at);
        let answer = match (probing.phase, probing.touch) {
            (Phase::Brake, _) if stands => {
                probing.phase = Phase::Return;
                None
            }
            (Phase::Return, Some(touch)) if probing.way.is_at(touch) && probing.home_mm_min.is_some() => {
                probing.phase = Phase::Home;
                None
            }
            (Phase::Return, Some(touch)) if probing.way.is_at(touch) => Some(Some(position)),
            (Phase::Home, Some(touch)) if probing.way.is_at(0.0) => Some(Some(along(probing, touch))),
            (Phase::Search, None) if probing.way.is_at(probing.length) => Some(None),
            _ => None,
        };
        let nominal = site.chain.to_axes(&position);
        for unit in site.axes.iter_mut() {
            let value = nominal[unit.axis];
            if value.is_finite() && matches!(unit.mover, Mover::None | Mover::Path) && unit.is_free() {
                unit.follow_probe(value, time);
            }
        }
        match (answer, probing.limit) {
            (Some(touched), limit) if stands && site.axes.have_arrived() => match (touched, limit) {
                (None, Some((axis, direction))) => {
                    let message = site.limit_message(axis, direction);
                    Probed::Refused(message, probing.block)
                }
                _ => self.finish(touched, site),
            },
            _ => Probed::Moves,
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
            let from = probing.from;
            return self.finish(Some(from), site);
        }
        probing.phase = Phase::Search;
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

/// The way of a probing as far as the traverse range reaches, and the limit that ends it. On kinematics that are
/// not Cartesian the way is that of the axes (inferred); in a tilted plane they move in straight lines, too.
fn within_range(
    from: &Position,
    to: Position,
    axes: &OwnAxes,
    chain: &Chain,
) -> (Position, Option<(Axis, Direction)>) {
    let [least, greatest] = axes.traverse_box();
    let placed = chain
        .placement()
        .map(|_| [from, &to].map(|position| chain.to_axes(position)));
    let mut part = 1.0;
    let mut limit = None;
    for unit in axes.iter() {
        let axis = unit.axis;
        let (offset, way) = (chain.offsets.of(axis), to[axis] - from[axis]);
        let (offset, from, way) = match &placed {
            Some([from, to]) => (0.0, from[axis], to[axis] - from[axis]),
            None => (offset, from[axis], way),
        };
        let (end, direction) = if way > 0.0 {
            (greatest[axis], Direction::Plus)
        } else {
            (least[axis], Direction::Minus)
        };
        let reach = (end - offset - from) / way;
        if way != 0.0 && reach < part {
            (part, limit) = (reach.max(0.0), Some((axis, direction)));
        }
    }
    if limit.is_none() {
        return (to, None);
    }
    let end = PerAxis::from_fn(|axis| {
        let way = to[axis] - from[axis];
        if way == 0.0 {
            to[axis]
        } else {
            from[axis] + part * way
        }
    });
    (end.into(), limit)
}

/// The position so far along the line, path coordinates.
fn along(probing: &Probing, way: f64) -> Position {
    let part = if probing.length > 0.0 {
        way / probing.length
    } else {
        0.0
    };
    PerAxis::from_fn(|axis| probing.from[axis] + part * (probing.to[axis] - probing.from[axis])).into()
}
