//! Probing in the program: the axes move until the stylus is deflected [000:7613-7718].

use bahn_exchange::signal;
use bahn_motion::{Aim, PointToPoint};
use bahn_parameters::MessageId;
use bahn_path::{Axis, BlockRef, LiveData, Position, Touch};

use crate::axes::Mover;
use crate::control::Control;
use crate::message::Message;
use crate::panel::Direction;
use crate::run::{Resume, RunState};

/// What M2502 makes of the stylus.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stylus {
    deflected: bool,
    /// A probing has deflected it, and it is not yet free again.
    probed: bool,
    /// NC stop.
    pub stops: bool,
}

/// A probing movement on a straight line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probing {
    phase: Phase,
    block: BlockRef,
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
}

impl Control {
    /// The path came to a probe block: asks the PLC to enable it [000:7682-7690].
    pub(crate) fn begin_probing(&mut self, block: BlockRef, from: Position, to: Position, feed_mm_min: f64) {
        let (to, limit) = self.within_range(&from, to);
        let way = |axis: Axis| to[axis] - from[axis];
        let moving = |axis: &Axis| way(*axis).abs() > 0.0;
        let length = Axis::ALL.into_iter().filter(moving).map(|axis| way(axis).powi(2));
        let acceleration = self
            .axes
            .iter()
            .filter(|unit| moving(&unit.axis))
            .map(|unit| unit.parameters.motion.acceleration_m_s2)
            .fold(f64::INFINITY, f64::min);
        self.run.probing = Some(Probing {
            phase: Phase::Enable,
            block,
            limit,
            from,
            to,
            feed_mm_min,
            acceleration_m_s2: acceleration,
            way: PointToPoint::new(0.0),
            length: length.sum::<f64>().sqrt(),
            touch: None,
        });
        self.put(signal::PROBING_ENDED, false);
        self.exchange.nc_set(signal::PROBING_ENABLE, true);
    }

    /// The way of a probing as far as the traverse range reaches, and the limit that ends it.
    fn within_range(&self, from: &Position, to: Position) -> (Position, Option<(Axis, Direction)>) {
        let [least, greatest] = self.traverse_box();
        let mut part = 1.0;
        let mut limit = None;
        for unit in &self.axes {
            let axis = unit.axis;
            let (offset, way) = (self.offsets.of(axis), to[axis] - from[axis]);
            let (end, direction) = if way > 0.0 {
                (greatest[axis], Direction::Plus)
            } else {
                (least[axis], Direction::Minus)
            };
            let reach = (end - offset - from[axis]) / way;
            if way != 0.0 && reach < part {
                (part, limit) = (reach.max(0.0), Some((axis, direction)));
            }
        }
        if limit.is_none() {
            return (to, None);
        }
        let end = Axis::ALL.map(|axis| {
            let way = to[axis] - from[axis];
            if way == 0.0 {
                to[axis]
            } else {
                from[axis] + part * way
            }
        });
        (end.into(), limit)
    }

    /// Takes the position of the axes when the stylus is deflected; once in each servo step.
    pub(crate) fn watch_probe(&mut self) {
        self.watch_stylus();
        let Some(probing) = &mut self.run.probing else {
            return;
        };
        if probing.phase != Phase::Search || probing.touch.is_some() || !self.measured.probe.deflected {
            return;
        }
        let along = self.axes.iter().map(|unit| {
            let axis = unit.axis;
            let way = probing.to[axis] - probing.from[axis];
            let at = unit.servo.actual_mm() - self.offsets.of(axis) - probing.from[axis];
            if way == 0.0 || way.is_nan() {
                0.0
            } else {
                at * way / probing.length
            }
        });
        probing.touch = Some(along.sum());
    }

    /// M2502: the machine stops when the stylus is deflected, in all modes, but where a probing deflects it, until it
    /// has left the workpiece again; not with a TS 511, which is on standby otherwise [000:7652]. The stop stays
    /// until all axes stand and no key moves them: by hand the stylus can then be freed; a program goes on only
    /// when it is free (inferred).
    fn watch_stylus(&mut self) {
        let guards = self.exchange.nc().bit(signal::NC_STOP_ON_STYLUS_DEFLECTION)
            && !self.link.list().probe().on_standby;
        if !guards && !self.stylus.stops {
            return;
        }
        let probes = self
            .run
            .probing
            .is_some_and(|probing| probing.phase != Phase::Enable);
        let touches = guards && self.measured.probe.deflected;
        self.stylus.probed = touches && (probes || self.stylus.probed);
        let deflected = touches && !self.stylus.probed;
        let rises = deflected && !self.stylus.deflected;
        self.stylus.deflected = deflected;
        let keys = self.panel.axis_keys.iter().any(Option::is_some);
        let rests = !keys && self.axes.iter().all(|unit| unit.stands());
        let stays = deflected && self.mode.is_automatic() || !rests;
        self.stylus.stops = rises || self.stylus.stops && stays;
    }

    /// Moves the axes of a probing for a cycle.
    pub(crate) fn move_probe(&mut self) {
        let running = self.run.state == RunState::Running;
        let time = self.cycle_s();
        let percent = self.feed_override.percent().min(100.0);
        let limit = self.rapid_limit_mm_min();
        let Some(probing) = &mut self.run.probing else {
            return;
        };
        let feed = (probing.feed_mm_min * percent / 100.0).min(limit);
        let aim = match probing.phase {
            Phase::Enable => {
                if running && !self.exchange.nc().bit(signal::PROBING_ENABLE) {
                    self.enter_probing();
                }
                return;
            }
            _ if !running => Aim::Feed(0.0),
            Phase::Search => match probing.touch {
                Some(_) => {
                    probing.phase = Phase::Brake;
                    self.exchange.nc_set(signal::STYLUS_DEFLECTED, true);
                    Aim::Feed(0.0)
                }
                None => Aim::Position(probing.length),
            },
            Phase::Brake => Aim::Feed(0.0),
            Phase::Return => Aim::Position(probing.touch.unwrap_or(0.0)),
        };
        let feed = if aim == Aim::Feed(0.0) {
            probing.feed_mm_min
        } else {
            feed
        };
        let at = probing.way.cycle(time, aim, feed, probing.acceleration_m_s2);
        let stands = probing.way.speed_mm_s() == 0.0;
        let position = along(probing, at);
        let answer = match (probing.phase, probing.touch) {
            (Phase::Brake, _) if stands => {
                probing.phase = Phase::Return;
                None
            }
            (Phase::Return, Some(touch)) if probing.way.is_at(touch) => Some(Some(position)),
            (Phase::Search, None) if probing.way.is_at(probing.length) => Some(None),
            _ => None,
        };
        for unit in &mut self.axes {
            let value = position[unit.axis];
            if value.is_finite() && matches!(unit.mover, Mover::None | Mover::Path) && !unit.is_plc_axis() {
                unit.mover = Mover::Path;
                unit.follow(value + self.offsets.of(unit.axis), time);
            }
        }
        let Some(touched) = answer.filter(|_| stands && self.path_in_position()) else {
            return;
        };
        match (touched, self.run.probing.and_then(|probing| probing.limit)) {
            (None, Some((axis, direction))) => {
                let message = self.limit_message(axis, direction);
                self.refuse_probing(message);
            }
            _ => self.finish_probing(touched),
        }
    }

    /// The PLC has enabled the probing: the probe must be ready and at rest.
    fn enter_probing(&mut self) {
        let ready = self.measured.probe.ready;
        self.put(signal::PROBE_NOT_READY, !ready);
        self.put(signal::PROBE_BATTERY_LOW, self.measured.probe.battery_low);
        if !ready {
            self.refuse_probing(Message::Plain(MessageId::ProbeSystemNotReady));
            return;
        }
        let deflected = self.measured.probe.deflected;
        self.put(signal::STYLUS_ALREADY_DEFLECTED, deflected);
        let Some(probing) = &mut self.run.probing else {
            return;
        };
        if deflected {
            let from = probing.from;
            self.finish_probing(Some(from));
        } else {
            probing.phase = Phase::Search;
        }
    }

    /// The run ends at the block that probes, with a message; the next start probes again.
    fn refuse_probing(&mut self, message: Message) {
        let block = self.run.probing.map(|probing| probing.block);
        let feeder = self.run.feeder.as_ref();
        let sequence = feeder.map_or(0, |feeder| feeder.interpreter().blocks_executed());
        self.show_at(message, false, block);
        self.abort_run(Resume::Block(sequence));
    }

    /// Hands the touch to the program, or that there was none.
    fn finish_probing(&mut self, touched: Option<Position>) {
        self.end_probing();
        let here = self.offsets.to_path(&self.machine_position());
        self.path.set_position(touched.unwrap_or(here));
        self.run.last = None;
        self.run.answer = Some(LiveData {
            touch: touched.map(|position| Touch { position }),
            q_values: Vec::new(),
        });
    }

    /// Nothing is probed any more.
    pub(crate) fn end_probing(&mut self) {
        if self.run.probing.take().is_some() {
            self.put(signal::PROBING_ENABLE, false);
            self.put(signal::PROBING_ENDED, true);
        }
    }
}

/// The position so far along the line, path coordinates.
fn along(probing: &Probing, way: f64) -> Position {
    let part = if probing.length > 0.0 {
        way / probing.length
    } else {
        0.0
    };
    Axis::ALL
        .map(|axis| probing.from[axis] + part * (probing.to[axis] - probing.from[axis]))
        .into()
}
