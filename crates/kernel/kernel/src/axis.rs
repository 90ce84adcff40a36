//! One axis of the machine as the kernel sees it: its loop, its nominal position, what moves it.
//!
//! Decision: A clamped axis that keys, reference run or PLC want drops its marker M2008 ff. as a block does, so that
//! the PLC unclamps it
//!
//! Decision: A list of machine parameters counts outputs and encoder inputs from 1, as the manuals do; a further
//! channel says at which connector of the machine that is
//!
//! Decision: Numbers 0 to 4 are the axes of the first channel; 5 is left to the spindle, the sixth axis of messages
//!
//! Decision: Coded marks that put an axis farther out of its traverse ranges than half of their width are refused,
//! with MP30 as MEASURING SYSTEM DEFECTIVE C
//!
//! Decision: `output step` ends when the key is released or the mode changes: the position loop goes on where the
//! axis is, on its ramp

use bahn_motion::{Aim, PointToPoint};
use bahn_parameters::axis::AxisParameters;
use bahn_path::{Axis, Direction};
use bahn_servo::{Axis as Servo, Gantry, Mark, Method, Timing};

use crate::way_back::WayBack;

/// A servo axis of the machine: 0 to 4 are those of the first channel by their index in markers and machine
/// parameters. 5 is left to the spindle, which counts as the sixth axis in messages [000:3310-3318].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AxisId(u8);

impl AxisId {
    /// Axes that a machine has at most, the place of the spindle among them.
    pub const COUNT: u8 = 38;
    /// The first axis of the first channel.
    pub const FIRST: AxisId = AxisId(0);
    /// The spindle among the axes of messages.
    pub const SPINDLE: AxisId = AxisId(5);

    /// The axis of a number; `None` for the spindle's, and beyond the greatest.
    pub fn new(number: u8) -> Option<AxisId> {
        (number < AxisId::COUNT && number != AxisId::SPINDLE.0).then_some(AxisId(number))
    }

    /// Its number on the machine, from 0; 0 to 4 are those of the first channel by their indices.
    pub fn number(self) -> u8 {
        self.0
    }
}

/// A kind of operation, on which the method of positioning depends [000:4721-4733].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// By hand, and the reference run.
    Manual,
    /// A program runs, or may.
    Automatic,
    /// The tool axis follows the spindle, in whatever operating mode.
    RigidTapping,
}

/// What moves an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mover {
    /// Nothing: it is held where it is.
    #[default]
    None,
    /// The path of a program.
    Path,
    /// Direction keys, handwheel, jog increment.
    Manual,
    /// The reference run: the axis seeks its reference mark.
    Reference,
    /// PLC positioning, return to the contour.
    Positioning,
    /// A PLC axis on command of modules.
    Plc,
    /// Free rotation: a rotary axis turns without end.
    Rotation,
}

/// The coupling of a slave.
#[derive(Clone, Debug)]
pub struct Coupling {
    /// Place of its master.
    pub master: usize,
    /// How it is held beside its master.
    pub gantry: Gantry,
    /// The relation of the two at switch-on was taken.
    pub switched_on: bool,
    /// The slave shows its own nominal position, not that of its master.
    pub shows_own: bool,
}

/// An axis of the machine with its position loop, and what the control knows of it.
#[derive(Clone, Debug)]
pub struct AxisUnit {
    /// Its number on the machine.
    pub id: AxisId,
    /// The channel and the index that its machine parameters are of.
    pub home: (usize, usize),
    /// Its list counts outputs and inputs of encoders from here.
    connectors: usize,
    /// The channel that moves it.
    pub channel: usize,
    /// Axis index of markers and machine parameters in that channel.
    pub index: usize,
    /// Its slot in that channel: its place in positions of the path.
    pub axis: Axis,
    /// What the machine builder says of it.
    pub parameters: AxisParameters,
    /// Its position loop, which gives the voltage to the drive.
    pub servo: Servo,
    /// Its reference mark was passed.
    pub referenced: bool,
    /// What moves it now.
    pub mover: Mover,
    /// Nominal position at the end of the contour cycle, machine coordinates, mm or degrees.
    pub nominal: f64,
    /// Nominal speed, mm/s, with its sign.
    pub speed: f64,
    /// Generator of movements that are no path.
    pub ptp: PointToPoint,
    /// The feed is enabled.
    pub enabled: bool,
    /// Direction of the last movement.
    pub direction: Direction,
    /// Distance since the last lubrication, mm.
    pub travelled: f64,
    /// Actual position of the last cycle, for the distance travelled.
    last_actual: f64,
    /// Contour cycles in which it was commanded to stand, since it moved last.
    pub stood_cycles: u32,
    /// Largest lag since power-on, mm.
    pub max_lag: f64,
    /// Status marker M2008 ff.: in position after a movement.
    pub in_position: bool,
    /// What moves it next waits for another axis.
    awaits_other: bool,
    /// Software limits of the active traverse range with the AXIS LIMIT of MOD, least and greatest.
    pub limits: [f64; 2],
    /// At a software limit.
    pub at_limit: Option<Direction>,
    /// The feed enable was withdrawn while it moved: 0 V until the enable is back.
    pub halted: bool,
    /// Back from where it ran on without feed enable.
    pub way_back: WayBack,
    /// Where an interrupted path has left it, when the actual position became the nominal one meanwhile.
    pub left_at: Option<f64>,
    /// Its loop was opened so that the nominal position stays: closed again, the axis goes back to it.
    pub(crate) keeps_nominal: bool,
    /// A synchronized slave is led by its master.
    pub coupling: Option<Coupling>,
}

impl AxisUnit {
    /// An axis of a channel whose connectors count from a place on the machine; `None` when its parameters say that
    /// there is none.
    pub fn new(
        id: AxisId,
        (channel, connectors): (usize, usize),
        parameters: AxisParameters,
        timing: Timing,
    ) -> Option<AxisUnit> {
        let axis = parameters.letter.filter(|_| parameters.active)?;
        Some(AxisUnit {
            id,
            channel,
            home: (channel, parameters.index.into()),
            connectors,
            index: parameters.index.into(),
            axis,
            servo: Servo::new(parameters.settings(), timing),
            referenced: false,
            mover: Mover::None,
            nominal: 0.0,
            speed: 0.0,
            ptp: PointToPoint::new(0.0),
            enabled: false,
            direction: Direction::Plus,
            travelled: 0.0,
            last_actual: 0.0,
            stood_cycles: 0,
            max_lag: 0.0,
            in_position: true,
            awaits_other: false,
            limits: [f64::NEG_INFINITY, f64::INFINITY],
            at_limit: None,
            halted: false,
            way_back: WayBack::default(),
            left_at: None,
            keeps_nominal: false,
            coupling: None,
            parameters,
        })
    }

    /// A PLC axis is driven by modules only [000:4094-4116].
    pub fn is_plc_axis(&self) -> bool {
        self.parameters.plc_axis
    }

    /// It is moved for itself: neither by modules of the PLC nor by its master.
    pub fn is_free(&self) -> bool {
        !self.is_plc_axis() && self.coupling.is_none()
    }

    /// What the status display shows as lag: a slave shows how far it is from its master [000:4490].
    pub fn lag_mm(&self) -> f64 {
        match &self.coupling {
            Some(coupling) => coupling.gantry.difference_mm(),
            None => self.servo.lag_mm(),
        }
    }

    /// The software limits are effective: the axis is referenced and shows no modulo value [000:3442]
    /// [000:4570].
    pub fn limited(&self) -> Option<[f64; 2]> {
        (self.referenced && self.parameters.travel.modulo.is_none()).then_some(self.limits)
    }

    /// Its drive gets a voltage: the feed is enabled, or withdrawn on a ramp.
    pub fn is_released(&self) -> bool {
        self.enabled || self.parameters.motion.ramps_without_enable
    }

    /// Its feed is not enabled: it comes down on its ramp, and goes on when the enable is back [001:509-516].
    pub fn ramps_down(&self) -> bool {
        !self.enabled && self.parameters.motion.ramps_without_enable
    }

    /// Its loop is closed, and its drive gets a voltage.
    pub fn can_be_driven(&self) -> bool {
        self.servo.closed() && self.is_released()
    }

    /// Moves for a cycle, no path; no faster than the rapid traverse.
    pub fn drive(&mut self, time_s: f64, aim: Aim, feed_mm_min: f64) {
        let acceleration = self.parameters.motion.acceleration_m_s2;
        let (aim, feed_mm_min) = match self.ramps_down() {
            true => (Aim::Feed(0.0), f64::INFINITY),
            false => (aim, feed_mm_min),
        };
        let feed = feed_mm_min.min(self.parameters.motion.rapid_mm_min);
        self.nominal = self.ptp.cycle(time_s, aim, feed, acceleration);
        self.speed = self.ptp.speed_mm_s();
    }

    /// What moved it does so no more: it comes down on its ramp, and belongs to nobody when it stands.
    pub fn come_to_rest(&mut self, time_s: f64) {
        self.drive(time_s, Aim::Feed(0.0), self.parameters.motion.rapid_mm_min);
        if self.stands() {
            self.mover = Mover::None;
        }
    }

    /// Takes the nominal position of the path.
    pub fn follow(&mut self, position: f64, time_s: f64) {
        self.speed = (position - self.nominal) / time_s;
        self.nominal = position;
        self.ptp = PointToPoint::moving(position, self.speed);
    }

    /// Takes the nominal position of a probing movement. An axis that CE has taken over from where it stood stays there,
    /// and goes back with NC start to where the movement has left it.
    pub fn follow_probe(&mut self, position: f64, time_s: f64) {
        self.mover = Mover::Path;
        match &mut self.left_at {
            Some(left_at) => {
                *left_at = position;
                self.follow(self.nominal, time_s);
            }
            None => self.follow(position, time_s),
        }
    }

    /// Puts out a step of speed in place of a movement, mm/min; `false` without digital speed controller.
    pub fn step(&mut self, speed_mm_min: f64) -> bool {
        let steps = self.servo.set_speed_step(Some(speed_mm_min));
        if steps {
            self.stand(self.servo.actual_mm());
            self.speed = speed_mm_min / 60.0;
        }
        steps
    }

    /// A step ends: the position loop goes on where the axis is, and as fast.
    pub fn end_step(&mut self) {
        if let Some(speed_mm_min) = self.servo.speed_step_mm_min() {
            self.servo.set_speed_step(None);
            self.nominal = self.servo.actual_mm();
            self.ptp = PointToPoint::moving(self.nominal, speed_mm_min / 60.0);
        }
    }

    /// Takes over the nominal position of its master.
    pub fn follow_master(&mut self, position: f64, speed_mm_s: f64) {
        self.speed = speed_mm_s;
        self.nominal = position;
        self.ptp = PointToPoint::moving(position, speed_mm_s);
    }

    /// A clamped axis is wanted: its marker M2008 ff. falls, and the PLC is to close its loop [000:5407].
    pub fn ask_to_unclamp(&mut self) {
        if !self.servo.closed() {
            self.in_position = false;
        }
    }

    /// Several axes are wanted together, one of which is clamped: the markers M2008 ff. of all of them fall, so that the PLC clamps
    /// none that it has unclamped while it unclamps another. To be said as long as they wait.
    pub fn wait_to_begin(&mut self) {
        (self.in_position, self.awaits_other) = (false, true);
    }

    /// Status marker M2008 ff. before a PLC scan.
    pub fn show_in_position(&mut self) -> bool {
        let waits = std::mem::take(&mut self.awaits_other);
        if !self.stands() || self.mover == Mover::Reference {
            self.in_position = false;
        } else if self.servo.closed() && self.servo.in_position() && !waits {
            self.in_position = true;
        }
        self.in_position
    }

    /// Stands at once where it is: the loop was opened, or the feed enable withdrawn.
    pub fn stand(&mut self, position: f64) {
        self.nominal = position;
        self.speed = 0.0;
        self.ptp = PointToPoint::new(position);
    }

    /// Makes the actual position the nominal one. On an interrupted path it is remembered where the path
    /// left the axis: it goes on there.
    pub fn transfer(&mut self) {
        if self.mover == Mover::Path {
            self.left_at.get_or_insert(self.nominal);
        }
        self.servo.transfer();
        self.way_back.end();
        self.stand(self.servo.actual_mm());
    }

    /// The feed enable is back: from where it is the axis goes back to its nominal position on its ramp.
    pub fn go_back(&mut self) {
        self.servo.transfer();
        let speed_mm_s = self.servo.actual_velocity_mm_min() / 60.0;
        self.way_back
            .begin(self.servo.actual_mm() - self.nominal, speed_mm_s);
    }

    /// The position that its loop is to have at the end of the contour cycle.
    pub fn wanted(&mut self, time_s: f64) -> f64 {
        let motion = &self.parameters.motion;
        if !self.halted {
            self.way_back
                .goes_on(time_s, motion.rapid_mm_min, motion.acceleration_m_s2);
        }
        self.nominal + self.way_back.beside()
    }

    /// The place of its encoder among the inputs of the machine.
    pub fn input(&self) -> usize {
        self.connectors + usize::from(self.parameters.wiring.input)
    }

    /// The place of its nominal value output among those of the machine.
    pub fn output(&self) -> usize {
        self.connectors + usize::from(self.parameters.wiring.output)
    }

    /// Whether nothing is commanded to move.
    pub fn stands(&self) -> bool {
        self.speed == 0.0
    }

    /// It has feed enable, is where it shall be, and its loop is closed unless it stands.
    pub fn may_be_led(&self) -> bool {
        self.is_released() && self.way_back.is_over() && (self.servo.closed() || self.stands())
    }

    /// Whether it is held at its place, or not held at all.
    pub fn is_at_rest(&self) -> bool {
        !self.servo.closed() || self.stands() && self.servo.in_position()
    }

    /// The method of positioning for a kind of operation [000:4721-4733]. PLC axes always run with lag, all others
    /// with pre-control in rigid tapping [000:6122].
    fn wanted_method(&self, operation: Operation) -> Method {
        let wanted = match operation {
            Operation::Manual => self.parameters.precontrol_in_manual,
            Operation::Automatic => self.parameters.precontrol_in_automatic,
            Operation::RigidTapping => true,
        };
        if wanted && !self.is_plc_axis() {
            Method::Precontrol
        } else {
            Method::Lag
        }
    }

    /// Chooses lag or feed pre-control for a kind of operation; an axis that moves changes when it has come
    /// to a standstill (inferred). Whether it has the method.
    pub fn choose_method(&mut self, operation: Operation) -> bool {
        if self.has_method(operation) {
            return true;
        }
        let wanted = self.wanted_method(operation);
        let rests = self.is_at_rest();
        if rests {
            self.servo.set_method(wanted);
        }
        rests
    }

    /// Whether it has the method for a kind of operation.
    pub fn has_method(&self, operation: Operation) -> bool {
        self.servo.method() == self.wanted_method(operation)
    }

    /// Says at which machine position a count is; nominal and actual position shift alike, by the value
    /// returned.
    pub fn set_datum(&mut self, count: i64, position_mm: f64) -> f64 {
        let shift = self.servo.set_datum(count, position_mm);
        self.nominal += shift;
        self.last_actual += shift;
        self.ptp = PointToPoint::moving(self.nominal, self.speed);
        shift
    }

    /// Count and machine position of a mark that was crossed, once it tells where it is. Coded marks that put the axis
    /// farther out of its traverse ranges than half of their width are refused: a doubled mark does (inferred).
    pub fn located(&mut self, mark: Mark) -> Option<(i64, f64)> {
        let travel = &self.parameters.travel;
        let position = mark.scale_mm? - travel.machine_datum_mm;
        let least = travel
            .ranges_mm
            .iter()
            .fold(f64::INFINITY, |least, range| least.min(range[0]));
        let greatest = travel
            .ranges_mm
            .iter()
            .fold(f64::NEG_INFINITY, |most, range| most.max(range[1]));
        let beyond = (least - position).max(position - greatest);
        let endless = travel.modulo.is_some() || !self.parameters.reference.kind.is_coded();
        if !endless && beyond > (greatest - least) / 2.0 {
            self.servo.refuse_marks();
            return None;
        }
        Some((mark.count, position))
    }

    /// Counts within one turn again (MP810), after it has turned farther; nothing moves.
    pub fn wrap(&mut self) {
        let Some(modulo) = self.parameters.travel.modulo else {
            return;
        };
        let turns = modulo.turns(self.nominal);
        if turns != 0.0 {
            let shift = -turns * modulo.deg;
            self.servo.shift(shift);
            self.nominal += shift;
            self.last_actual += shift;
            self.ptp = PointToPoint::moving(self.nominal, self.speed);
        }
    }

    /// A position as it is shown: within one turn where MP810 says so [000:6468-6484].
    pub fn shown(&self, position: f64) -> f64 {
        match self.parameters.travel.modulo {
            Some(modulo) => modulo.shown(position),
            None => position,
        }
    }

    /// Goes over to changed machine parameters, as far as they take effect without a restart.
    pub fn set_parameters(&mut self, parameters: AxisParameters) {
        self.servo.configure(parameters.settings());
        self.parameters = parameters;
    }

    /// Goes on by a contour cycle: counts the distance, remembers direction and lag.
    pub fn count(&mut self) {
        let actual = self.servo.actual_mm();
        self.travelled += (actual - self.last_actual).abs();
        self.last_actual = actual;
        if self.servo.closed() {
            self.max_lag = self.max_lag.max(self.servo.lag_mm().abs());
        }
        self.stood_cycles = match self.stands() {
            true => self.stood_cycles.saturating_add(1),
            false => 0,
        };
        if self.speed > 0.0 {
            self.direction = Direction::Plus;
        } else if self.speed < 0.0 {
            self.direction = Direction::Minus;
        }
    }
}
