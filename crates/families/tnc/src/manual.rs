//! Manual operation: axis direction keys, jog increment, electronic handwheel.
//!
//! Decision: MP7270 + 2 of a TNC 360: after NC stop in manual operation what was entered of S and M is forgotten, and
//! M5 and M9 are output
//!
//! Decision: With MP7270 + 2 an NC stop ends S and M by hand where it is pressed there: not one that is held from
//! another operating mode or from the TOUCH PROBE menu; M5 and M9 that still wait when the operator leaves for
//! another mode do not go out later

use bahn_exchange::signal;
use bahn_kernel::{
    AtLimit, AxisUnit, HandMove, Leaning, MAIN, Mover, Now, OwnAxes, StylusLead, Wish, look_at_limit,
    move_by_hand, within,
};
use bahn_parameters::machining::MeasuringProbe;
use bahn_parameters::operation::HandwheelParameters;
use bahn_parameters::technology::Technology;
use bahn_parameters::{ControlModel, PerPlcAxis};
use bahn_path::{BlockRef, Direction};
use bahn_plc::JogLimit;
use bahn_servo::{HandwheelInputs, Probe as Touch};

use crate::command::Mode;
use crate::handwheel::Handwheel;
use crate::message::{Message, Messages};
use crate::plc_link::StatusChanges;
use crate::reach::Reach;
use crate::site::Site;

/// M functions that end what was entered: spindle and coolant off.
const SWITCHED_OFF: [u16; 2] = [5, 9];

/// What manual operation remembers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Manual {
    /// Direction keys that were latched (M2450 with MP7680 bit 0): they count until NC stop [000:7545-7552].
    latched: PerPlcAxis<Option<Direction>>,
    /// Distance of a jog, mm.
    pub increment: f64,
    /// Limit of the jog increment by module 9036, mm.
    increment_limit: Option<f64>,
    /// Positions that jogging goes to.
    jogging: PerPlcAxis<Option<f64>>,
    /// Handwheel or jog increment would lead beyond a limit.
    pushed: PerPlcAxis<Option<Direction>>,
    pub handwheel: Handwheel,
    /// Axis key pressed last.
    last_key: usize,
    /// M function that was entered and waits for NC start.
    m: Option<u16>,
    /// Spindle speed that was entered and waits for NC start, rpm.
    s: Option<f64>,
    /// NC stop is pressed.
    stopped: bool,
    /// S and M are to be ended.
    ends: bool,
    /// PNT: the stylus leads the axes.
    stylus: Option<StylusLead>,
    /// The stylus leads them, or those that it has led run out.
    led: bool,
    /// OUTPUT of the oscilloscope: STEP with this feed, mm/min, or the RAMP [000:18737-18756].
    step_mm_min: Option<f64>,
}

impl Default for Manual {
    fn default() -> Manual {
        Manual {
            latched: PerPlcAxis::splat(None),
            increment: 0.0,
            increment_limit: None,
            jogging: PerPlcAxis::splat(None),
            pushed: PerPlcAxis::splat(None),
            handwheel: Handwheel::default(),
            last_key: 0,
            m: None,
            s: None,
            stopped: false,
            ends: false,
            stylus: None,
            led: false,
            step_mm_min: None,
        }
    }
}

impl Manual {
    /// Lets go of everything.
    pub fn stop(&mut self) {
        self.latched = PerPlcAxis::splat(None);
        self.jogging = PerPlcAxis::splat(None);
        self.pushed = PerPlcAxis::splat(None);
        self.handwheel.stop();
        self.stylus = None;
    }

    /// PNT: the stylus of a measuring probe leads the axes from now on, or does so no more.
    pub fn lead_by(&mut self, probe: Option<MeasuringProbe>) {
        self.stylus = probe.map(StylusLead::of);
        self.led |= self.stylus.is_some();
    }

    /// PNT is on: the axes follow the stylus.
    pub fn follows_stylus(&self) -> bool {
        self.stylus.is_some()
    }

    /// PNT is on, or axes that it has moved are not at a standstill.
    pub fn is_led(&self) -> bool {
        self.led
    }

    /// An axis key of the keyboard highlights its axis. With a handwheel that shares the highlight its symbol goes with it
    /// [000:8139-8151].
    pub fn highlight(&mut self, index: usize, rules: &HandwheelParameters) {
        self.last_key = index;
        self.handwheel.go_with_highlight(index, rules);
    }

    /// Index of the axis key that was pressed last.
    pub fn last_key(&self) -> usize {
        self.last_key
    }

    /// M and S in Manual and Handwheel: entered here, output with NC start [003:1103-1111].
    pub fn enter(&mut self, m: Option<u16>, s: Option<f64>) {
        self.m = m.or(self.m);
        self.s = s.or(self.s);
    }

    /// OUTPUT of the oscilloscope: what direction keys put out in MANUAL OPERATION. A step needs an axis with digital
    /// speed controller.
    pub fn set_step(&mut self, feed_mm_min: Option<f64>, axes: &OwnAxes) -> bool {
        let possible = feed_mm_min.is_none() || axes.iter().any(|unit| unit.servo.speed().is_some());
        if possible {
            self.step_mm_min = feed_mm_min;
        }
        possible
    }

    /// Follows NC stop in every mode. Where it `ends` S and M in Manual and Handwheel, what waits is forgotten, and spindle and
    /// coolant are to be switched off by M5 and M9 (inferred) [003:7307-7315]. A stop that another mode has seen first
    /// ends nothing, and what is not yet switched off when the operator leaves stays on (inferred).
    pub fn follow_stop(&mut self, stop: bool, ends: bool) {
        let pressed = stop && !self.stopped;
        self.stopped = stop;
        if pressed && ends {
            (self.m, self.s, self.ends) = (None, None, true);
        }
    }

    /// Another operating mode is chosen than Manual and Handwheel.
    pub fn leave(&mut self) {
        self.ends = false;
    }

    /// Manual and Handwheel: NC start outputs what was entered, M5 and M9 go out where S and M are to be ended.
    pub fn output_entered(&mut self, model: ControlModel, now: &Now, site: &mut Site) {
        if !site.handshakes.is_idle() {
            return;
        }
        if std::mem::take(&mut self.ends) {
            for code in SWITCHED_OFF {
                if let Some(technology) = Technology::of_m(model, code) {
                    site.m_by_hand(technology, code);
                }
            }
        }
        if !now.start || now.stop {
            return;
        }
        if let Some(rpm) = self.s.take() {
            site.speed(rpm, false);
        }
        if let Some(m) = self.m.take()
            && let Some(technology) = Technology::of_m(model, m)
        {
            site.m_by_hand(technology, m);
        }
    }

    /// Takes what module 9036 sets: handwheel axis, factors, jog limit.
    pub fn take_status(&mut self, changes: StatusChanges) {
        self.handwheel.take(changes.factors, changes.handwheel_axis);
        match changes.jog_limit {
            None => {}
            Some(JogLimit::At(limit)) => self.increment_limit = Some(limit),
            Some(JogLimit::LastIncrement) => self.increment_limit = None,
            Some(JogLimit::SmallerOfLastIncrementAndLimit) => {
                if let Some(limit) = self.increment_limit.take() {
                    self.increment = self.increment.min(limit);
                }
            }
        }
    }
}

impl Manual {
    /// Moves the axes in Manual and Handwheel, and while a run is interrupted with MANUAL OPERATION.
    pub fn moves(
        &mut self,
        handwheel: &HandwheelInputs,
        reach: &mut Reach,
        now: &Now,
        leaning: &mut Leaning,
    ) {
        if now.stop {
            self.stop();
        }
        self.handwheel.look(handwheel, reach);
        self.last_key = self.handwheel.take_highlight().unwrap_or(self.last_key);
        let keys = self.keys(reach, now);
        let leans = leaning.is_on() && !reach.mode.is_automatic();
        if leans {
            self.lean(&keys, handwheel, reach, now, leaning);
        } else {
            self.handwheel.turn(handwheel, reach, &mut self.pushed);
        }
        for place in reach.axes.places() {
            let unit = reach.axes.get(place);
            let Some(index) = unit
                .filter(|unit| !leans || !MAIN.contains(&unit.axis))
                .map(|unit| unit.index)
            else {
                continue;
            };
            let key = keys.get(index).copied().flatten();
            let key = key.and_then(|key| Some((key, self.key_feed(reach.axes.get(place)?, reach, now))));
            self.move_by_hand(place, index, key, reach, now);
        }
    }

    /// PNT: moves the axes for a cycle as the stylus leads them, on the ways of direction keys. Everything that stops axes
    /// ends it (inferred).
    pub fn follow_stylus(&mut self, touch: &Touch, reach: &mut Reach, now: &Now) {
        if now.stop {
            self.stop();
        }
        let feeds = self.stylus.map(|stylus| stylus.feeds_mm_min(touch));
        let feeds = feeds.unwrap_or(Ok([0.0; 3])).unwrap_or_else(|message| {
            self.stop();
            reach.messages.show(Message::Plain(message), reach.block);
            [0.0; 3]
        });
        self.led = self.stylus.is_some();
        for place in reach.axes.places() {
            let led = reach.axes.get(place).and_then(|unit| {
                let along = MAIN.iter().position(|axis| *axis == unit.axis)?;
                Some((unit.index, feeds.get(along).copied()?))
            });
            let Some((index, feed)) = led else { continue };
            let led = Direction::of(feed).map(|direction| (direction, feed.abs() * now.feed_percent / 100.0));
            self.move_by_hand(place, index, led, reach, now);
            let unit = reach.axes.get(place);
            self.led |= unit.is_some_and(|unit| unit.mover == Mover::Manual);
        }
    }

    /// Moves the main axes along those of the plane of 3D ROT. A wheel that has a rotary axis leads it as ever; jog
    /// increments lead along the axes of the plane, too.
    fn lean(
        &mut self,
        keys: &PerPlcAxis<Option<Direction>>,
        handwheel: &HandwheelInputs,
        reach: &mut Reach,
        now: &Now,
        leaning: &mut Leaning,
    ) {
        let of_plane = |index| {
            let unit = reach.axes.with_index(index);
            unit.is_some_and(|unit| MAIN.contains(&unit.axis))
        };
        let leads = reach.mode == Mode::Handwheel && of_plane(self.handwheel.axis());
        if leads {
            let rules = &reach.rules.handwheel;
            self.handwheel.superimpose(handwheel, rules, reach.axes, reach.nc);
        } else {
            self.handwheel.turn(handwheel, reach, &mut self.pushed);
        }
        let travels = self.handwheel.travels();
        let increment = self.increment();
        let wishes = MAIN.map(|axis| {
            let Some(unit) = reach.axes.at(axis) else {
                return Wish::default();
            };
            let key = keys.get(unit.index).copied().flatten();
            let wheel_mm = travels.get(unit.index).filter(|_| leads).copied();
            let jog = reach.panel.jog_started.get_mut(unit.index).and_then(Option::take);
            let jog = jog.filter(|_| reach.mode == Mode::Handwheel);
            Wish {
                key: key.map(|direction| (direction, self.key_feed(unit, reach, now))),
                wheel_mm: wheel_mm.unwrap_or(0.0),
                jog_mm: jog.map(|direction| direction.sign() * increment),
                jog_mm_min: unit.parameters.motion.manual_mm_min * now.feed_percent / 100.0,
            }
        });
        let (axes, block) = (&mut *reach.axes, reach.block);
        let messages = &mut *reach.messages;
        leaning.moves(&wishes, axes, now, &mut |at| tell(at, messages, block));
    }

    /// The feed of a direction key, mm/min.
    fn key_feed(&self, unit: &AxisUnit, reach: &Reach, now: &Now) -> f64 {
        let (motion, rules) = (&unit.parameters.motion, &reach.rules.handwheel);
        let in_wheel_mode = reach.mode == Mode::Handwheel;
        if reach.panel.rapid || in_wheel_mode && self.handwheel.rapid(rules) {
            let percent = if reach.rules.overrides.on_manual_rapid {
                now.feed_percent.min(100.0)
            } else {
                100.0
            };
            return motion.rapid_mm_min * percent / 100.0;
        }
        let share = if in_wheel_mode {
            self.handwheel.share(rules)
        } else {
            1.0
        };
        motion.manual_mm_min * share * now.feed_percent / 100.0
    }

    /// The direction keys that count, latched ones included.
    fn keys(&mut self, reach: &Reach, now: &Now) -> PerPlcAxis<Option<Direction>> {
        if reach.mode == Mode::Handwheel {
            // The direction keys work in Handwheel, too, unless jogging is on.
            if reach.nc.bit(signal::ENABLE_JOG_INCREMENT) {
                return PerPlcAxis::splat(None);
            }
        }
        let mut keys = if now.stop {
            PerPlcAxis::splat(None)
        } else {
            reach.panel.axis_keys
        };
        let by_wheel = self.handwheel.direction(&reach.rules.handwheel);
        let by_wheel = by_wheel.filter(|_| reach.mode == Mode::Handwheel && !now.stop);
        if let Some((index, direction)) = by_wheel
            && let Some(key) = keys.get_mut(index)
        {
            *key = key.or(Some(direction));
        }
        for (index, (key, latched)) in keys.iter_mut().zip(&mut self.latched).enumerate() {
            if key.is_some() {
                self.last_key = index;
                if reach.panel.memory && reach.rules.keys_latched {
                    *latched = *key;
                }
            }
            *key = key.or(*latched);
        }
        keys
    }

    /// Moves one axis by its key, in a direction with a feed, mm/min, by its jog increment or the handwheel.
    fn move_by_hand(
        &mut self,
        place: usize,
        index: usize,
        key: Option<(Direction, f64)>,
        reach: &mut Reach,
        now: &Now,
    ) {
        let wanted = HandMove {
            key,
            jog: self.jog_target(place, index, reach),
            wheel: self.handwheel.target(index),
            step_mm_min: self.step_mm_min.filter(|_| reach.mode == Mode::Manual),
        };
        let Some(unit) = reach.axes.get_mut(place) else {
            return;
        };
        if !move_by_hand(unit, &wanted, now) {
            return;
        }
        let pushed = self.pushed.get_mut(index);
        let towards = key.map(|(direction, _)| direction);
        let towards = towards.or(pushed.as_deref().copied().flatten());
        let Some(at) = look_at_limit(unit, towards) else {
            return;
        };
        if let (AtLimit::Reached(..), Some(pushed)) = (at, pushed) {
            *pushed = None;
        }
        tell(at, reach.messages, reach.block);
    }

    /// The jog increment within its limit, mm.
    fn increment(&self) -> f64 {
        match self.increment_limit {
            Some(limit) => self.increment.min(limit),
            None => self.increment,
        }
    }

    /// Where the jog increment leads the axis to.
    fn jog_target(&mut self, place: usize, index: usize, reach: &mut Reach) -> Option<f64> {
        let started = reach
            .panel
            .jog_started
            .get(index)
            .copied()
            .flatten()
            .filter(|_| reach.mode == Mode::Handwheel);
        let increment = self.increment();
        let unit = reach.axes.get(place)?;
        let (nominal, stands) = (unit.nominal, unit.stands());
        let target = self.jogging.get_mut(index)?;
        if let Some(direction) = started
            && stands
        {
            let (within, pushed) = within(unit, nominal + direction.sign() * increment);
            *target = Some(within);
            if let Some(slot) = self.pushed.get_mut(index) {
                *slot = pushed;
            }
            if let Some(started) = reach.panel.jog_started.get_mut(index) {
                *started = None;
            }
        } else if *target == Some(nominal) && stands {
            *target = None;
        }
        *target
    }
}

/// The message of a software limit comes and goes.
fn tell(at: AtLimit, messages: &mut Messages, block: Option<BlockRef>) {
    match at {
        AtLimit::Reached(id, direction) => messages.show(Message::limit(id, direction), block),
        AtLimit::Left(id, direction) => messages.remove(&Message::limit(id, direction)),
    }
}
