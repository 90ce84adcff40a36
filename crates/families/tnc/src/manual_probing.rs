//! The functions of the TOUCH PROBE menu in MANUAL and HANDWHEEL [003:1217-1512]: calibration, basic rotation,
//! datums. NC start probes in the chosen direction and goes back in rapid traverse to where it started.
//!
//! Decision: ROTATION ANGLE is the basic rotation in force and the nominal angle of the side that is probed next:
//! without setting it to 0 a second side gives the angle between both
//!
//! Decision: NC stop ends a probing by hand; the function stays chosen, and the next start probes again
//!
//! Decision: In the plane of 3D ROT the probe finds datums, which move along it; a basic rotation is measured with
//! the swivel axes at 0 only, the probe calibrated upright: else PLANE WRONGLY DEFINED
//!
//! Decision: A TM 110 that is calibrated probes the ring again as soon as it is turned (MP6321), with no other start;
//! NC stop leaves that out, and a spindle that cannot be turned is KEY NON-FUNCTIONAL
//!
//! Decision: The probe is turned back by itself when its centre offset is found; a circle is fitted through all
//! touches, three at least (also `kernel/src/touched.rs`)

use bahn_interpreter::{BasicRotation, Rules};
use bahn_kernel::touched::{self, Contact};
use bahn_kernel::{Offsets, OwnAxes};
use bahn_parameters::machining::{ProbeSettings, ProbeTurn};
use bahn_parameters::{MessageId, ParameterList};
use bahn_path::{Axis, Direction, PerAxis, Plane, Position};
use bahn_servo::Measured;

use crate::datums::NewDatum;
use crate::handshake::Transfer;
use crate::message::Message;
use crate::probe_command::{ProbeCommand, ProbeFunction};
use crate::probing::{Probe, Probed};
use crate::setup::{Calibration, ProbeMemory};
use crate::site::Site;

/// Touches that a function takes at most; more take the place of the last one.
const CONTACTS_MAX: usize = 8;

/// What the menu knows: what survives power-off, and the function that is chosen.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ManualProbing {
    pub memory: ProbeMemory,
    /// The side of the last basic rotation, for the corner.
    side: Option<[Contact; 2]>,
    job: Option<Job>,
}

/// A function that is chosen.
#[derive(Clone, Copy, Debug)]
struct Job {
    function: ProbeFunction,
    /// What the next NC start probes.
    aim: Aim,
    /// Directions that are still to be probed of this start, the current one included.
    left: usize,
    /// Where the start was given, path coordinates.
    home: Position,
    contacts: [Contact; CONTACTS_MAX],
    count: usize,
    /// The coordinate of a surface, from machine zero with the length of the probe, mm.
    surface: Option<(Axis, f64)>,
    /// The nominal angle of the side, degrees.
    angle_deg: f64,
    /// The centre of the ring before the probe was turned by 180°, and whether it is turned.
    before_turn: Option<touched::Point>,
    /// A measuring probe turns by itself: as soon as it is turned the ring is probed again without NC start.
    again: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Aim {
    None,
    One(Axis, Direction),
    All,
}

/// What a screen shows of the function, coordinates from the datum, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ProbeShown {
    /// Touches that the next result has already.
    pub touches: usize,
    /// DATUM X =, DATUM Y =: of surface, corner or centre.
    pub datum: Position,
    /// PR of the circle, mm.
    pub radius_mm: Option<f64>,
}

/// What a command of the menu comes to.
pub(crate) enum Answer {
    /// It is not possible now.
    Refused,
    Done,
    /// Done, and it survives power-off.
    Kept,
    Datum(NewDatum),
}

impl ManualProbing {
    pub fn new(memory: ProbeMemory) -> ManualProbing {
        ManualProbing {
            memory,
            ..ManualProbing::default()
        }
    }

    /// A function is chosen: NC start probes.
    pub fn is_chosen(&self) -> bool {
        self.job.is_some()
    }

    /// Leaves the function; what was calibrated is kept.
    pub fn leave(&mut self) {
        self.job = None;
    }

    /// Programs probe with what was calibrated.
    pub fn calibrated(&self, mut rules: Rules) -> Rules {
        if let Some(calibration) = self.memory.calibration {
            rules.probe.length_mm = calibration.length_mm;
            rules.probe.radius_mm = calibration.radius_mm;
            rules.probe.offset_mm = calibration.offset_mm;
        }
        rules
    }

    /// The basic rotation of programs, in the plane of a tool axis.
    pub fn basic_rotation(&self, tool_axis: Axis) -> BasicRotation {
        BasicRotation {
            angle_deg: self.memory.basic_rotation_deg,
            plane: Plane::of_tool_axis(tool_axis).unwrap_or(Plane::XY),
        }
    }

    fn calibration(&self) -> Calibration {
        self.memory.calibration.unwrap_or_default()
    }

    /// A command of the menu; `barred` by a transformation that is active.
    pub fn execute(
        &mut self,
        command: ProbeCommand,
        turn: ProbeTurn,
        barred: Option<MessageId>,
        site: &mut Site,
    ) -> Answer {
        let tool_axis = site.chain.offsets.tool_axis;
        if let ProbeCommand::Choose(function) = command {
            if let Some(message) = barred {
                site.messages.show(Message::Plain(message), None);
                return Answer::Done;
            }
            return self.choose(function, tool_axis);
        }
        let Some(job) = &mut self.job else {
            return Answer::Refused;
        };
        match command {
            ProbeCommand::Choose(_) => Answer::Refused,
            ProbeCommand::Direction(axis, direction) => {
                let linear = !axis.is_rotary() && site.axes.at(axis).is_some();
                let fits = match job.function {
                    ProbeFunction::Surface => linear,
                    ProbeFunction::Length(_) => axis == tool_axis,
                    _ => linear && axis != tool_axis && plane_of(tool_axis).contains(axis),
                };
                if fits {
                    job.aim = Aim::One(axis, direction);
                }
                if fits { Answer::Done } else { Answer::Refused }
            }
            ProbeCommand::AllDirections => match job.function {
                ProbeFunction::Circle | ProbeFunction::Radius(_) => {
                    job.aim = Aim::All;
                    Answer::Done
                }
                _ => Answer::Refused,
            },
            ProbeCommand::Turn => self.turn(turn, site),
            ProbeCommand::Angle(angle) if job.function == ProbeFunction::Rotation => {
                job.angle_deg = angle;
                job.count = 0;
                self.memory.basic_rotation_deg = angle;
                Answer::Kept
            }
            ProbeCommand::Angle(_) => Answer::Refused,
            ProbeCommand::Datum(axis, value) => match self.probed(axis, &site.chain.offsets) {
                Some(at) => Answer::Datum(NewDatum { axis, at, value }),
                None => Answer::Refused,
            },
            ProbeCommand::End => {
                self.job = None;
                Answer::Done
            }
        }
    }

    fn choose(&mut self, function: ProbeFunction, tool_axis: Axis) -> Answer {
        let aim = match function {
            ProbeFunction::Length(_) => Aim::One(tool_axis, Direction::Minus),
            ProbeFunction::Radius(_) | ProbeFunction::Circle => Aim::All,
            _ => Aim::None,
        };
        let none = Contact {
            centre: [0.0; 2],
            towards: [0.0; 2],
        };
        let mut job = Job {
            function,
            aim,
            left: 0,
            home: Position::UNKNOWN,
            contacts: [none; CONTACTS_MAX],
            count: 0,
            surface: None,
            angle_deg: self.memory.basic_rotation_deg,
            before_turn: None,
            again: false,
        };
        if function == (ProbeFunction::Corner { reuse: true }) {
            let Some(side) = self.side else {
                return Answer::Refused;
            };
            for contact in side {
                job.add(contact);
            }
        }
        self.job = Some(job);
        Answer::Done
    }

    /// The soft key 180°: once the ring has been probed, the spindle turns the probe for the second time.
    fn turn(&mut self, turn: ProbeTurn, site: &mut Site) -> Answer {
        let Some(job) = &mut self.job else {
            return Answer::Refused;
        };
        let centre = touched::circle(job.contacts(), 0.0).map(|circle| circle.centre);
        match centre {
            Some(centre) if matches!(job.function, ProbeFunction::Radius(_)) && job.before_turn.is_none() => {
                if !turn_by_180(turn, false, site) {
                    return Answer::Refused;
                }
                job.before_turn = Some(centre);
                job.count = 0;
                Answer::Done
            }
            _ => Answer::Refused,
        }
    }

    /// The coordinate of an axis that was probed, from machine zero, mm.
    fn probed(&self, axis: Axis, offsets: &Offsets) -> Option<f64> {
        let job = self.job.as_ref()?;
        let plane = plane_of(offsets.tool_axis);
        let ball = self.calibration().radius_mm;
        let of_plane = |point: touched::Point| match axis {
            axis if axis == plane.first => Some(point[0]),
            axis if axis == plane.second => Some(point[1]),
            _ => None,
        };
        match (job.function, job.contacts()) {
            (ProbeFunction::Surface, _) => job.surface.filter(|(of, _)| *of == axis).map(|(_, at)| at),
            (ProbeFunction::Corner { .. }, [a, b, c, d]) => {
                touched::corner(&[[*a, *b], [*c, *d]], ball).and_then(of_plane)
            }
            (ProbeFunction::Circle, contacts) => {
                touched::circle(contacts, ball).and_then(|circle| of_plane(circle.centre))
            }
            _ => None,
        }
    }

    /// What is shown of the function that is chosen.
    pub fn shown(&self, offsets: &Offsets) -> Option<ProbeShown> {
        let job = self.job.as_ref()?;
        let datum = PerAxis::from_fn(|axis| match self.probed(axis, offsets) {
            Some(at) => at - offsets.datum[axis],
            None => f64::NAN,
        });
        let circle = matches!(job.function, ProbeFunction::Circle)
            .then(|| touched::circle(job.contacts(), self.calibration().radius_mm));
        Some(ProbeShown {
            touches: job.count,
            datum: datum.into(),
            radius_mm: circle.flatten().map(|circle| circle.radius),
        })
    }

    /// Probes for a cycle: a movement that is on its way, or one that NC start begins. Whether it moves the axes; and
    /// whether something changed that survives power-off.
    pub fn moves(
        &mut self,
        probe: &mut Probe,
        settings: &ProbeSettings,
        measured: &Measured,
        site: &mut Site,
    ) -> (bool, bool) {
        let Some(job) = &mut self.job else {
            return (false, false);
        };
        if !probe.is_on() {
            let turns = site.spindle.is_orienting() || !site.handshakes.is_idle();
            job.again &= !site.now.stop;
            let starts = site.now.start || job.again;
            if !starts || site.now.stop || turns || !site.axes.rest() {
                return (false, false);
            }
            job.again = false;
            if job.begin(probe, settings, site) {
                return (true, false);
            }
            let message = Message::Plain(MessageId::KeyNonFunctional);
            site.messages.show(message, None);
            return (false, false);
        }
        let able = site.axes.iter().all(|unit| {
            let moves = job.axis().is_some_and(|axis| axis == unit.axis);
            !moves || unit.enabled && unit.servo.closed()
        });
        let running = !site.now.stop && able;
        let kept = match probe.moves(running, site, measured) {
            // NC stop ends it; the next start probes anew (inferred).
            Probed::Moves if !running && (probe.stands() || !able) => {
                self.give_up(probe, site);
                false
            }
            Probed::Moves => return (true, false),
            Probed::Refused(message, _) => {
                site.messages.show(message, None);
                self.give_up(probe, site);
                false
            }
            Probed::Over(None) => {
                let message = Message::Plain(MessageId::TouchPointInaccessible);
                site.messages.show(message, None);
                self.give_up(probe, site);
                false
            }
            // Tools are measured and surfaces digitized in programs only.
            Probed::Found(_) => false,
            Probed::Over(Some(touch)) => self.take(&touch.position, probe, settings, site),
        };
        (true, kept)
    }

    /// Nothing is probed any more; the axes stand where they are.
    fn give_up(&mut self, probe: &mut Probe, site: &mut Site) {
        probe.end(site);
        if let Some(job) = &mut self.job {
            job.left = 0;
        }
        site.axes.release(|mover| mover == bahn_kernel::Mover::Path);
    }

    /// A touch. Whether something changed that survives power-off.
    fn take(
        &mut self,
        touch: &Position,
        probe: &mut Probe,
        settings: &ProbeSettings,
        site: &mut Site,
    ) -> bool {
        let calibration = self.calibration();
        let Some(job) = &mut self.job else { return false };
        site.axes.release(|mover| mover == bahn_kernel::Mover::Path);
        job.note(touch, &calibration, &site.chain.offsets);
        job.left = job.left.saturating_sub(1);
        if job.left > 0 {
            job.probe_next(probe, settings, site);
            return false;
        }
        match self.evaluate(touch, settings, site) {
            Ok(kept) => kept,
            Err(message) => {
                site.messages.show(Message::Plain(message), None);
                if let Some(job) = &mut self.job {
                    job.count = 0;
                }
                false
            }
        }
    }

    /// What the touches come to, as soon as there are enough.
    fn evaluate(
        &mut self,
        touch: &Position,
        settings: &ProbeSettings,
        site: &mut Site,
    ) -> Result<bool, MessageId> {
        let Some(job) = &mut self.job else {
            return Ok(false);
        };
        let offsets = site.chain.offsets;
        let mut calibration = self.memory.calibration.unwrap_or_default();
        match (job.function, job.contacts()) {
            (ProbeFunction::Length(height), _) => {
                calibration.length_mm = touch[offsets.tool_axis] + offsets.tool_length - height;
                self.memory.calibration = Some(calibration);
                Ok(true)
            }
            (ProbeFunction::Radius(ring), contacts @ [_, _, _, _]) => {
                let circle = touched::circle(contacts, 0.0).ok_or(MessageId::ArithmeticalError)?;
                calibration.radius_mm = ring - circle.radius;
                if calibration.radius_mm <= 0.0 {
                    return Err(MessageId::ArithmeticalError);
                }
                if let Some(before) = job.before_turn.take() {
                    // Half the way between the two centres; the contacts have the offset known so far in them, which
                    // was turned the wrong way for the second ones.
                    for (k, offset) in calibration.offset_mm.iter_mut().enumerate() {
                        let (one, two) = (before[k] - *offset, circle.centre[k] - *offset);
                        *offset = (two - one) / 2.0;
                    }
                    turn_by_180(settings.turn, true, site);
                } else if settings.turns_itself && settings.turn != ProbeTurn::Off {
                    job.turn_by_itself(circle.centre, settings.turn, site);
                }
                self.memory.calibration = Some(calibration);
                Ok(true)
            }
            (ProbeFunction::Rotation, [a, b]) => {
                let side = [*a, *b];
                let measured = touched::angle_deg(&side).ok_or(MessageId::ArithmeticalError)?;
                let angle = touched::within_90(measured - job.angle_deg);
                job.count = 0;
                job.angle_deg = angle;
                self.side = Some(side);
                self.memory.basic_rotation_deg = angle;
                Ok(true)
            }
            (ProbeFunction::Corner { .. }, [a, b, c, d]) => {
                touched::corner(&[[*a, *b], [*c, *d]], calibration.radius_mm)
                    .map(|_| false)
                    .ok_or(MessageId::ArithmeticalError)
            }
            _ => Ok(false),
        }
    }
}

impl Job {
    fn contacts(&self) -> &[Contact] {
        self.contacts.get(..self.count).unwrap_or_default()
    }

    /// What is probed next: with all four directions those of the plane one after another.
    fn direction(&self, tool_axis: Axis) -> Option<(Axis, Direction)> {
        match self.aim {
            Aim::None => None,
            Aim::One(axis, direction) => Some((axis, direction)),
            Aim::All => {
                let plane = plane_of(tool_axis);
                [plane.first, plane.second]
                    .into_iter()
                    .flat_map(|axis| Direction::BOTH.map(|direction| (axis, direction)))
                    .nth(4 - self.left.clamp(1, 4))
            }
        }
    }

    /// The axis that is probed; with all four directions none alone.
    fn axis(&self) -> Option<Axis> {
        match self.aim {
            Aim::One(axis, _) => Some(axis),
            _ => None,
        }
    }

    /// NC start: `false` when no direction is chosen, or nothing more is to be probed.
    fn begin(&mut self, probe: &mut Probe, settings: &ProbeSettings, site: &mut Site) -> bool {
        self.left = if self.aim == Aim::All { 4 } else { 1 };
        self.home = site.here();
        let full = match self.function {
            ProbeFunction::Radius(_) | ProbeFunction::Corner { .. } => 4,
            ProbeFunction::Rotation => 2,
            _ => CONTACTS_MAX,
        };
        if self.count >= full || self.aim == Aim::All {
            self.count = 0;
        }
        self.probe_next(probe, settings, site)
    }

    fn probe_next(&mut self, probe: &mut Probe, settings: &ProbeSettings, site: &mut Site) -> bool {
        let Some((axis, direction)) = self.direction(site.chain.offsets.tool_axis) else {
            self.left = 0;
            return false;
        };
        let mut to = self.home;
        to[axis] += direction.sign() * settings.range_mm;
        probe.begin_by_hand([self.home, to], settings, site);
        true
    }

    /// Keeps a touch: where the ball stood, from machine zero.
    fn note(&mut self, touch: &Position, calibration: &Calibration, offsets: &Offsets) {
        let Some((axis, direction)) = self.direction(offsets.tool_axis) else {
            return;
        };
        let plane = plane_of(offsets.tool_axis);
        let mut tip: Position = PerAxis::from_fn(|axis| touch[axis] + offsets.datum[axis]).into();
        tip[offsets.tool_axis] += offsets.tool_length - calibration.length_mm;
        let [x, y] = plane.point(&tip);
        let [dx, dy] = calibration.offset_mm;
        let centre = [x + dx, y + dy];
        plane.set(&mut tip, centre);
        let in_plane = axis != offsets.tool_axis;
        let beside = if in_plane {
            direction.sign() * calibration.radius_mm
        } else {
            0.0
        };
        self.surface = Some((axis, tip[axis] + beside));
        let mut towards = Position::ZERO;
        towards[axis] = direction.sign();
        self.add(Contact {
            centre,
            towards: plane.point(&towards),
        });
    }

    /// A measuring probe is turned as soon as the ring is probed [000:7654]; a spindle that cannot be turned is said, and
    /// leaves the offset as it was (inferred).
    fn turn_by_itself(&mut self, centre: touched::Point, turn: ProbeTurn, site: &mut Site) {
        if turn_by_180(turn, false, site) {
            self.before_turn = Some(centre);
            self.count = 0;
            self.again = true;
        } else {
            site.messages
                .show(Message::Plain(MessageId::KeyNonFunctional), None);
        }
    }

    fn add(&mut self, contact: Contact) {
        let place = self.count.min(CONTACTS_MAX - 1);
        if let Some(slot) = self.contacts.get_mut(place) {
            *slot = contact;
        }
        self.count = place + 1;
    }
}

/// What the swivel axes bar: a basic rotation unless they stand at 0 [000:4269], and in the plane of 3D ROT (`leans`) the
/// calibration (inferred). The manual names no message (inferred).
pub(crate) fn tilted(
    command: ProbeCommand,
    leans: bool,
    list: &ParameterList,
    axes: &OwnAxes,
) -> Option<MessageId> {
    let is_at_0 = |axis| {
        let unit = axes.at(axis);
        unit.is_none_or(|unit| unit.servo.actual_mm().abs() <= unit.parameters.monitoring.window_mm)
    };
    let tilts = list.operation_parameters().tilting;
    let swivels = || list.swivels().filter(|_| tilts);
    let barred = match command {
        ProbeCommand::Choose(ProbeFunction::Rotation) => {
            leans || swivels().is_some_and(|swivels| !swivels.free_axes().all(is_at_0))
        }
        ProbeCommand::Choose(ProbeFunction::Length(_) | ProbeFunction::Radius(_)) => leans,
        _ => false,
    };
    barred.then_some(MessageId::PlaneWronglyDefined)
}

fn plane_of(tool_axis: Axis) -> Plane {
    Plane::of_tool_axis(tool_axis).unwrap_or(Plane::XY)
}

/// Turns the probe by 180° (MP6160), there or back, so that a cable does not wind up. It does so from where the spindle
/// stands, which need not have turned before. `false` when it cannot be turned.
fn turn_by_180(turn: ProbeTurn, back: bool, site: &mut Site) -> bool {
    match turn {
        ProbeTurn::Off => false,
        ProbeTurn::ByControl => {
            let turn_deg = if back { -180.0 } else { 180.0 };
            site.spindle.turn_by(turn_deg, site.exchange)
        }
        ProbeTurn::ByPlc(code) => {
            site.handshakes.push(Transfer::M(code));
            true
        }
    }
}
