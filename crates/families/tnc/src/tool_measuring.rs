//! Tools are measured with the tool probe, and the tool probe with a tool: the tool goes over its contact, turns
//! backwards or is oriented, and probes it, once or at each of its places [000:7960-8058].
//!
//! Decision: TCH PROBE 30, 31 and 32 have the blocks of later controls; the control measures at a barrier: the tool
//! turns against its cutting direction, CHECK 0 makes what was found its data, CHECK 1 the difference its oversize, a
//! broken tool keeps its data; Q115 and Q116 are the differences; a measuring that is broken off stops the spindle

use bahn_exchange::{Exchange, signal};
use bahn_kernel::probing_speed::{feed_mm_min, speed_rpm};
use bahn_kernel::{AxisUnit, Chain, OwnAxes, Straight};
use bahn_motion::Aim;
use bahn_parameters::MessageId;
use bahn_parameters::machining::{ProbeOrientation, ToolProbeParameters};
use bahn_path::{Axis, LiveData, MeasuredPart, Plane, Position, ToolMeasuring};
use bahn_servo::Measured;

use crate::handshake::Transfer;
use crate::message::Message;
use crate::site::Site;
use crate::tool::{MeasuredTool, ToolCondition};
use crate::tool_contacts::{Contact, Contacts};

/// Turn against the cutting direction: M4 for a tool that cuts with M3, and stop (inferred: the edges do not cut).
const BACKWARDS: [u8; 2] = [4, 3];
const STOP: u8 = 5;

/// A measuring comes to an end, or not yet.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Measuring {
    Moves,
    /// What the program goes on with: the differences of length and radius, in Q115 and Q116, too, and what was found.
    Over(LiveData),
    Refused(Message),
}

/// Q115 and Q116 take the differences (inferred: those of the successors).
const Q_LENGTH: u16 = 115;
const Q_RADIUS: u16 = 116;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// M2503 is set; the PLC resets it.
    Enable,
    Up,
    Over,
    Down,
    /// The spindle turns backwards, or is oriented.
    Spin,
    Orient,
    Search,
    Brake,
    Back,
    Leave,
    Stop,
    /// The tables take what was found.
    Store,
}

/// The measuring that is on its way, if one is.
#[derive(Clone, Debug, Default)]
pub(crate) struct ToolMeasurement(Option<Sequence>);

/// A measuring from the enabling of the probe to its result.
#[derive(Clone, Debug)]
struct Sequence {
    order: ToolMeasuring,
    phase: Phase,
    parameters: ToolProbeParameters,
    axis: Axis,
    contacts: Contacts,
    /// The touch that is under way.
    contact: Contact,
    /// The movement on its way.
    line: Straight,
    touch: Option<f64>,
    speed_before: f64,
    /// The angle of cycle 13, which the PLC is told of each tooth.
    angle_before: f64,
    /// The spindle was turned or oriented: it does not stay so.
    turned: bool,
    asked: bool,
}

impl ToolMeasurement {
    pub fn is_on(&self) -> bool {
        self.0.is_some()
    }

    /// The movement on its way: its start and its farthest end, path coordinates.
    pub fn way(&self) -> Option<[Position; 2]> {
        self.0.as_ref().map(|run| run.line.ends())
    }

    /// An axis of its way cannot move: the way stands at once.
    pub fn is_held(&mut self, axes: &OwnAxes) -> bool {
        self.0.as_mut().is_some_and(|run| run.line.is_held(axes))
    }

    /// The path came to a cycle that measures.
    ///
    /// # Errors
    /// When tools are not measured on this machine, or this one cannot be.
    pub fn begin(&mut self, order: ToolMeasuring, site: &mut Site) -> Result<(), Message> {
        let not_ready = || Message::Plain(MessageId::ProbeSystemNotReady);
        let parameters = site.tools.probe();
        let axis = site.chain.offsets.tool_axis;
        let tool = site.magazine.tool(site.tools.number);
        let plane = Plane::of_tool_axis(axis).filter(|plane| plane.normal.main() == Some(plane.normal));
        let mut middle = site.axes.machine_position();
        let [x, y, z] = parameters.centre_mm;
        (middle[Axis::X], middle[Axis::Y], middle[Axis::Z]) = (x, y, z);
        middle[axis] += site.chain.offsets.tool_length;
        let middle = site.chain.to_path(&middle);
        let contacts = plane.and_then(|plane| Contacts::new(order, parameters, &tool, plane, middle));
        let contacts = contacts.ok_or_else(not_ready)?;
        let contact = contacts.next().ok_or_else(not_ready)?;
        let (feed, oriented) = match contacts.stands() {
            true => (parameters.standing_mm_min, may_be_oriented(&parameters, site)),
            false => (feed_mm_min(&parameters, tool.shape.radius), true),
        };
        if !parameters.enabled || !oriented || parameters.rapid_mm_min <= 0.0 || feed <= 0.0 {
            return Err(not_ready());
        }
        let here = site.here();
        self.0 = Some(Sequence {
            order,
            phase: Phase::Enable,
            parameters,
            axis,
            contacts,
            contact,
            line: Straight::new([here; 2], &site.axes),
            touch: None,
            speed_before: site.spindle.state().programmed_rpm,
            angle_before: site.spindle.cycle_angle_deg(),
            turned: false,
            asked: false,
        });
        let exchange = &mut *site.exchange;
        exchange.nc_put(signal::TOOL_CYCLE_KIND, order.check);
        exchange.nc_put(signal::WEAR_TOLERANCE_EXCEEDED, false);
        exchange.nc_put(signal::BREAKAGE_TOLERANCE_EXCEEDED, false);
        exchange.nc_put(signal::TOOL_MEASURING_STARTED, true);
        exchange.nc_put(signal::PROBING_ENDED, false);
        exchange.nc_set(signal::PROBING_ENABLE, true);
        Ok(())
    }

    /// Takes the position of the axes when the contact is deflected; once in each servo step.
    pub fn watch<'a>(
        &mut self,
        measured: &Measured,
        axes: impl Iterator<Item = &'a AxisUnit>,
        chain: &Chain,
    ) {
        let Some(run) = &mut self.0 else { return };
        if run.phase != Phase::Search || run.touch.is_some() || !measured.tool_probe.deflected {
            return;
        }
        let mut actual = Position::UNKNOWN;
        for unit in axes {
            actual[unit.axis] = unit.servo.actual_mm();
        }
        run.touch = Some(chain.to_path(&actual)[run.contact.axis]);
    }

    /// Leads the axes of the measurement for a contour cycle.
    pub fn moves(&mut self, running: bool, site: &mut Site, measured: &Measured) -> Measuring {
        let Some(run) = &mut self.0 else {
            return Measuring::Moves;
        };
        match run.phase {
            Phase::Enable if running && !site.exchange.nc().bit(signal::PROBING_ENABLE) => {
                let probe = measured.tool_probe;
                site.exchange.nc_put(signal::PROBE_NOT_READY, !probe.ready);
                site.exchange
                    .nc_put(signal::STYLUS_ALREADY_DEFLECTED, probe.deflected);
                if !probe.ready {
                    return Measuring::Refused(Message::Plain(MessageId::ProbeSystemNotReady));
                }
                if probe.deflected {
                    return Measuring::Refused(Message::Plain(MessageId::StylusAlreadyInContact));
                }
                run.go_to(Phase::Up, site);
                Measuring::Moves
            }
            Phase::Enable => Measuring::Moves,
            // The spindle is asked for nothing before NC start.
            Phase::Spin | Phase::Stop | Phase::Orient if !running => Measuring::Moves,
            Phase::Spin | Phase::Stop => {
                run.turn(site);
                Measuring::Moves
            }
            Phase::Orient => {
                run.orient(site);
                Measuring::Moves
            }
            Phase::Store => match site.tools.measured {
                Some(_) => Measuring::Moves,
                None => self.over(site),
            },
            _ => run.drive(running, site),
        }
    }

    fn over(&mut self, site: &mut Site) -> Measuring {
        let Some(run) = self.0.take() else {
            return Measuring::Moves;
        };
        ended(site.exchange);
        let [longest, _] = run.contacts.found();
        let (q, tool_differences_mm) = match run.order.part {
            MeasuredPart::Length => (Q_LENGTH, [longest, 0.0]),
            MeasuredPart::Radius => (Q_RADIUS, [0.0, longest]),
            MeasuredPart::Probe => return Measuring::Over(LiveData::default()),
        };
        let state = f64::from(run.state(site) as u8);
        let result = run.order.result.map(|number| (number, state));
        Measuring::Over(LiveData {
            q_values: [Some((q, longest)), result].into_iter().flatten().collect(),
            tool_differences_mm,
            ..LiveData::default()
        })
    }

    /// Nothing is measured any more: a tool that was turned stops, with the speed that was programmed, so that nobody
    /// meets a tool that turns backwards (inferred).
    pub fn end(&mut self, site: &mut Site) {
        let Some(run) = self.0.take() else { return };
        site.exchange.nc_put(signal::PROBING_ENABLE, false);
        ended(site.exchange);
        if run.turned {
            run.stop_spindle(site);
        }
    }
}

/// The spindle has a loop, and who orients it.
fn may_be_oriented(parameters: &ToolProbeParameters, site: &Site) -> bool {
    match parameters.orientation {
        ProbeOrientation::None => false,
        ProbeOrientation::Nc => site.spindle.drive.can_be_led(),
        ProbeOrientation::Plc(_) => true,
    }
}

fn ended(exchange: &mut Exchange) {
    exchange.nc_put(signal::TOOL_MEASURING_STARTED, false);
    exchange.nc_put(signal::PROBING_ENDED, true);
}

impl Sequence {
    /// Where a phase leads to, from where the axes stand.
    fn go_to(&mut self, phase: Phase, site: &Site) {
        self.phase = phase;
        let from = site.here();
        let mut to = from;
        self.asked = false;
        match phase {
            Phase::Up | Phase::Leave => to[self.axis] = self.order.height,
            Phase::Over => {
                to = self.contact.before;
                to[self.axis] = from[self.axis];
            }
            Phase::Down | Phase::Back => to = self.contact.before,
            Phase::Search => to = self.contact.farthest,
            _ => {}
        }
        self.line = Straight::new([from, to], &site.axes);
    }

    /// The spindle turns backwards at the speed for its radius, or stops and has the speed that was programmed.
    fn turn(&mut self, site: &mut Site) {
        if !self.asked {
            self.asked = true;
            if self.phase == Phase::Stop {
                return self.stop_spindle(site);
            }
            let tool = site.magazine.tool(site.tools.number);
            let [normal, left_hand] = BACKWARDS;
            self.turned = true;
            site.speed(speed_rpm(&self.parameters, tool.shape.radius), false);
            let code = if tool.left_hand { left_hand } else { normal };
            site.handshakes.push(Transfer::M(code));
            return;
        }
        if !site.handshakes.is_idle() {
            return;
        }
        match self.phase {
            Phase::Spin => self.go_to(Phase::Search, site),
            _ => {
                self.turned = false;
                self.phase = Phase::Store;
                self.store(site);
            }
        }
    }

    /// M5, and what the program has set of speed and angle.
    fn stop_spindle(&self, site: &mut Site) {
        if self.contacts.stands() {
            site.spindle.set_cycle_angle(self.angle_before, site.exchange);
        }
        site.speed(self.speed_before, false);
        site.handshakes.push(Transfer::M(STOP));
    }

    /// The spindle brings the tooth to the contact: by itself, for which M2499 must be reset, or the PLC does it with an
    /// M function to the angle of cycle 13 [000:7979] (inferred: that angle).
    fn orient(&mut self, site: &mut Site) {
        let Some(angle) = self.contact.orientation_deg else {
            return;
        };
        let by_nc = !matches!(self.parameters.orientation, ProbeOrientation::Plc(_));
        if by_nc && site.exchange.nc().bit(signal::OPEN_SPINDLE_LOOP) {
            return;
        }
        if !self.asked || by_nc && !site.spindle.drive.holds_orientation() {
            (self.asked, self.turned) = (true, true);
            match self.parameters.orientation {
                ProbeOrientation::Plc(code) => {
                    site.spindle.set_cycle_angle(angle, site.exchange);
                    site.handshakes.push(Transfer::M(code));
                }
                _ => site.spindle.drive.orient_shortest(angle),
            }
            return;
        }
        let oriented = match by_nc {
            true => site.spindle.drive.is_oriented(),
            false => site.handshakes.is_idle() && !site.spindle.is_orienting(),
        };
        if oriented {
            self.go_to(Phase::Search, site);
        }
    }

    /// After a touch: another one from the same place, or from another one, or none.
    fn go_on(&mut self, site: &Site) {
        let Some(next) = self.contacts.next() else {
            return self.go_to(Phase::Leave, site);
        };
        let same = next.before == self.contact.before;
        self.contact = next;
        self.touch = None;
        match same {
            true => self.go_to(self.turns(), site),
            false => self.go_to(Phase::Up, site),
        }
    }

    /// What the spindle does for a touch.
    fn turns(&self) -> Phase {
        match self.contact.orientation_deg {
            Some(_) => Phase::Orient,
            None => Phase::Spin,
        }
    }

    /// One cycle of a movement.
    fn drive(&mut self, running: bool, site: &mut Site) -> Measuring {
        let radius = site.magazine.radius(site.tools.number);
        let probes = matches!(self.phase, Phase::Search | Phase::Brake);
        let feed = if probes && self.contacts.stands() {
            self.parameters.standing_mm_min
        } else if probes {
            feed_mm_min(&self.parameters, radius)
        } else {
            self.parameters.rapid_mm_min * (site.now.feed_percent / 100.0).min(1.0)
        };
        let feed = feed.min(site.now.rapid_limit_mm_min);
        if self.phase == Phase::Search && self.touch.is_some() {
            self.phase = Phase::Brake;
            site.exchange.nc_set(signal::STYLUS_DEFLECTED, true);
        }
        let aim = match self.phase {
            _ if !running => Aim::Feed(0.0),
            Phase::Brake => Aim::Feed(0.0),
            _ => Aim::Position(self.line.length()),
        };
        self.line.lead(aim, feed, &mut site.axes, site.chain, &site.now);
        let arrived = match self.phase {
            Phase::Brake => self.line.stands(),
            _ => self.line.is_over(),
        };
        if !arrived || !site.axes.have_arrived() {
            return Measuring::Moves;
        }
        match self.phase {
            Phase::Up => self.go_to(Phase::Over, site),
            Phase::Over => self.go_to(Phase::Down, site),
            Phase::Down => self.go_to(self.turns(), site),
            Phase::Search => return Measuring::Refused(Message::Plain(MessageId::TouchPointInaccessible)),
            Phase::Brake => {
                let touch = self.touch.unwrap_or(self.contact.expected);
                self.contacts.take(&self.contact, touch);
                self.go_to(Phase::Back, site);
            }
            Phase::Back => self.go_on(site),
            _ => self.go_to(Phase::Stop, site),
        }
        Measuring::Moves
    }

    /// What a check says of the tool, by the tooth that is farthest off; a tolerance of 0 is none.
    fn state(&self, site: &Site) -> ToolCondition {
        let edges = site.magazine.tool(site.tools.number).edges;
        let [_, farthest] = self.contacts.found();
        let (wear, breakage) = match self.order.part == MeasuredPart::Radius {
            true => (edges.radius_wear, edges.radius_break),
            false => (edges.length_wear, edges.length_break),
        };
        let beyond = |tolerance: f64| tolerance > 0.0 && farthest.abs() > tolerance;
        match self.order.check {
            true if beyond(breakage) => ToolCondition::Broken,
            true if beyond(wear) => ToolCondition::Worn,
            _ => ToolCondition::Good,
        }
    }

    /// What was found: the place of the contact, or what the tables take.
    fn store(&self, site: &mut Site) {
        match self.order.part {
            MeasuredPart::Probe => {
                let (centre, width) = self.contacts.calibrated();
                site.tools.calibrate(centre, width);
            }
            _ => site.tools.measured = Some(self.found(site)),
        }
    }

    /// What the tables take: a tool beyond a tolerance is locked, and the PLC is told [000:8025].
    fn found(&self, site: &mut Site) -> MeasuredTool {
        let state = self.state(site);
        let exchange = &mut *site.exchange;
        exchange.nc_put(signal::WEAR_TOLERANCE_EXCEEDED, state == ToolCondition::Worn);
        exchange.nc_put(
            signal::BREAKAGE_TOLERANCE_EXCEEDED,
            state == ToolCondition::Broken,
        );
        let [difference, _] = self.contacts.found();
        let radius = self.order.part == MeasuredPart::Radius;
        if !radius {
            site.chain.offsets.tool_length += difference;
        }
        MeasuredTool {
            number: site.tools.number,
            radius,
            check: self.order.check,
            difference,
            state,
        }
    }
}
