//! Probing in the program: the axes move until the stylus is deflected [000:7613-7718].

use bahn_exchange::signal;
use bahn_motion::{Aim, PointToPoint};
use bahn_parameters::MessageId;
use bahn_path::{Axis, LiveData, Position, Touch};
use bahn_servo::Plant;

use crate::axes::Mover;
use crate::control::Control;
use crate::message::Message;
use crate::run::{Resume, RunState};

/// A probing movement on a straight line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probing {
    phase: Phase,
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
    pub(crate) fn begin_probing(&mut self, from: Position, to: Position, feed_mm_min: f64) {
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

    /// Takes the position of the axes when the stylus is deflected; once in each servo step.
    pub(crate) fn watch_probe(&mut self, plant: &mut dyn Plant) {
        let Some(probing) = &mut self.run.probing else {
            return;
        };
        if probing.phase != Phase::Search || probing.touch.is_some() || !plant.probe_deflected() {
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

    /// Moves the axes of a probing for a cycle.
    pub(crate) fn move_probe(&mut self, plant: &mut dyn Plant) {
        let running = self.run.state == RunState::Running;
        let time = self.cycle_s();
        let percent = self.feed_override.percent().min(100.0);
        let Some(probing) = &mut self.run.probing else {
            return;
        };
        let feed = probing.feed_mm_min * percent / 100.0;
        let aim = match probing.phase {
            Phase::Enable => {
                if running && !self.exchange.nc().bit(signal::PROBING_ENABLE) {
                    self.enter_probing(plant);
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
        if let Some(touched) = answer.filter(|_| stands && self.path_in_position()) {
            self.finish_probing(touched);
        }
    }

    /// The PLC has enabled the probing: the probe must be ready and at rest.
    fn enter_probing(&mut self, plant: &mut dyn Plant) {
        let ready = plant.probe_ready();
        self.put(signal::PROBE_NOT_READY, !ready);
        self.put(signal::PROBE_BATTERY_LOW, plant.probe_battery_low());
        if !ready {
            let sequence = self
                .run
                .feeder
                .as_ref()
                .map_or(0, |feeder| feeder.interpreter().blocks_executed());
            self.show(Message::Plain(MessageId::ProbeSystemNotReady), false);
            self.abort_run(Resume::Block(sequence));
            return;
        }
        let deflected = plant.probe_deflected();
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
