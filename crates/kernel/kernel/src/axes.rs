//! The servo axes of the machine, and those of them that a channel moves.
//!
//! Decision: MANUAL OPERATION remembers where a probe has led the axes: RESTORE POSITION brings them back there, not
//! to the start of the probing
//!
//! Decision: An axis belongs to one channel, which gives it a slot of its path and an index of its markers; after
//! power-on it is where its list describes it
//!
//! Decision: An axis of the PLC has no place in the positions of a program

use bahn_motion::Aim;
use bahn_parameters::{PLC_AXES, ParameterList, PerPlcAxis};
use bahn_path::{Axis, AxisSet, PerAxis, Position};
use bahn_servo::{Commands, Measured, Timing};

use crate::axis::{AxisId, AxisUnit, Mover, Operation};
use crate::gantry;
use crate::kinematics::{Box2, Chain};

/// All axes of the machine. Each belongs to one channel, which gives it a slot of its path and an index of
/// its markers.
#[derive(Clone, Debug, Default)]
pub struct Axes {
    units: Vec<AxisUnit>,
}

impl Axes {
    /// The axes, slaves coupled to their masters.
    pub fn new(units: Vec<AxisUnit>, timing: Timing) -> Axes {
        Axes {
            units: gantry::couple(units, timing),
        }
    }

    /// Those of a channel.
    pub fn of(&mut self, channel: usize) -> OwnAxes<'_> {
        let is_own = |unit: &AxisUnit| unit.channel == channel;
        let first = self.units.iter().position(is_own).unwrap_or(0);
        let end = self.units.iter().rposition(is_own).map_or(first, |last| last + 1);
        OwnAxes {
            units: &mut self.units,
            channel,
            span: (first, end),
        }
    }

    /// Those of a channel, to be looked at.
    pub fn owned(&self, channel: usize) -> impl Iterator<Item = &AxisUnit> + Clone {
        self.units.iter().filter(move |unit| unit.channel == channel)
    }

    /// The axis that a slave follows.
    pub fn master(&self, slave: &AxisUnit) -> Option<&AxisUnit> {
        self.units.get(slave.coupling.as_ref()?.master)
    }

    /// All of them, in the order of their outputs.
    pub fn iter(&self) -> std::slice::Iter<'_, AxisUnit> {
        self.units.iter()
    }

    /// All of them, to be changed.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, AxisUnit> {
        self.units.iter_mut()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.units.len()
    }

    /// The axis at a place among all of the machine.
    pub fn get(&self, place: usize) -> Option<&AxisUnit> {
        self.units.get(place)
    }

    /// The same, to be changed.
    pub fn get_mut(&mut self, place: usize) -> Option<&mut AxisUnit> {
        self.units.get_mut(place)
    }

    /// The axis of a number on the machine.
    pub fn with_id_mut(&mut self, id: AxisId) -> Option<&mut AxisUnit> {
        self.units.iter_mut().find(|unit| unit.id == id)
    }

    /// Gives an axis to a channel, in a slot and at an index of its markers that no axis of it has. `false` when one
    /// has.
    pub fn give(&mut self, id: AxisId, channel: usize, slot: Axis, index: usize) -> bool {
        let taken = |unit: &AxisUnit| unit.id != id && (unit.axis == slot || unit.index == index);
        if index >= PLC_AXES || self.owned(channel).any(taken) {
            return false;
        }
        let Some(unit) = self.with_id_mut(id) else {
            return false;
        };
        unit.channel = channel;
        unit.axis = slot;
        unit.index = index;
        unit.mover = Mover::None;
        unit.left_at = None;
        true
    }

    /// Gives an axis another slot of its channel. Whoever does so for several leaves no slot to two of them.
    pub fn rename(&mut self, id: AxisId, slot: Axis) {
        if let Some(unit) = self.with_id_mut(id) {
            unit.axis = slot;
            unit.mover = Mover::None;
            unit.left_at = None;
        }
    }

    /// An axis may go to another channel: it stands, and moves for nobody but a path; it is coupled to none.
    pub fn may_leave(&self, id: AxisId) -> bool {
        let mut couplings = self.units.iter().filter_map(|unit| unit.coupling.as_ref());
        let leads = |place: usize| couplings.any(|coupling| coupling.master == place);
        let place = self.units.iter().position(|unit| unit.id == id);
        let found = place.and_then(|place| self.units.get(place));
        found.is_some_and(|unit| {
            let moved = !matches!(unit.mover, Mover::None | Mover::Path);
            !moved && unit.is_at_rest() && unit.stands() && unit.is_free()
        }) && !place.is_some_and(leads)
    }

    /// Reads the encoders, once in each servo step.
    pub fn measure(&mut self, measured: &Measured) {
        for unit in &mut self.units {
            let encoder = measured.encoder(unit.input());
            if unit.servo.is_digital() {
                unit.servo.measure_motor(measured.motor(unit.output()));
            }
            unit.servo.measure(encoder);
            let drive = measured.drive(unit.output());
            unit.servo.take_drive_fault(drive.fault);
        }
    }

    /// Outputs what the drives are to do in a servo step.
    pub fn output(&mut self, commands: &mut Commands) {
        for unit in &mut self.units {
            unit.servo.step();
            if let Some(output) = commands.axes.get_mut(unit.output()) {
                *output = unit.servo.output();
            }
        }
    }

    /// Hands the nominal positions of a contour cycle to the loops; slaves follow their masters.
    pub fn command(&mut self, time_s: f64) {
        for unit in self.units.iter_mut().filter(|unit| unit.coupling.is_none()) {
            let wanted = unit.wanted(time_s);
            unit.servo.command(wanted);
        }
        gantry::command(&mut self.units);
    }

    /// A contour cycle in which the loops are open: nothing is commanded, what is measured goes on.
    pub fn pass(&mut self) {
        for unit in &mut self.units {
            unit.servo.command(f64::NAN);
        }
    }

    /// The control voltage has come: all are held where they are.
    pub fn close_loops(&mut self) {
        for unit in self.units.iter_mut().filter(|unit| unit.parameters.controlled) {
            unit.transfer();
            unit.servo.end_shutdown();
            unit.servo.close();
        }
        gantry::switch_on(&mut self.units);
    }

    /// The control voltage goes: digital speed controllers brake as long as MP1980 says.
    pub fn begin_shutdown(&mut self) {
        for unit in &mut self.units {
            unit.servo.begin_shutdown();
        }
    }

    /// The control voltage is gone: nothing moves them.
    pub fn open_loops(&mut self) {
        for unit in &mut self.units {
            unit.servo.open();
            unit.transfer();
            unit.mover = Mover::None;
        }
    }
}

/// The numbers of the axes of the first channel.
pub fn first_ids() -> PerPlcAxis<Option<AxisId>> {
    PerPlcAxis::from_fn(AxisId::new)
}

/// The axes that a list of machine parameters gives to a channel, whose connectors count from a place on the machine.
pub fn units(
    parameters: &ParameterList,
    of: (usize, usize),
    ids: PerPlcAxis<Option<AxisId>>,
) -> Vec<AxisUnit> {
    let timing = parameters.model().timing();
    let ids = (0u8..).zip(ids);
    ids.filter_map(|(index, id)| AxisUnit::new(id?, of, parameters.axis_parameters(index), timing))
        .collect()
}

/// The axes of a channel.
pub struct OwnAxes<'a> {
    units: &'a mut [AxisUnit],
    channel: usize,
    /// All of the channel stand from here on, before there: most of the others need not be looked at.
    span: (usize, usize),
}

impl OwnAxes<'_> {
    /// Those of the channel.
    pub fn iter(&self) -> impl Iterator<Item = &AxisUnit> + Clone {
        let channel = self.channel;
        let (first, end) = self.span;
        let span = self.units.get(first..end).unwrap_or_default();
        span.iter().filter(move |unit| unit.channel == channel)
    }

    /// Those of the channel, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut AxisUnit> {
        let channel = self.channel;
        let (first, end) = self.span;
        let span = self.units.get_mut(first..end).unwrap_or_default();
        span.iter_mut().filter(move |unit| unit.channel == channel)
    }

    /// The places of its axes among all.
    pub fn places(&self) -> impl Iterator<Item = usize> + use<> {
        let places = self.units.iter().enumerate();
        let own = places.fold(0u64, |own, (place, unit)| {
            own | u64::from(unit.channel == self.channel) << place
        });
        (0..self.units.len()).filter(move |place| own >> place & 1 != 0)
    }

    /// The axis at a place among all of the machine.
    pub fn get(&self, place: usize) -> Option<&AxisUnit> {
        self.units.get(place)
    }

    /// The same, to be changed.
    pub fn get_mut(&mut self, place: usize) -> Option<&mut AxisUnit> {
        self.units.get_mut(place)
    }

    /// All axes of the machine, where masters and slaves find each other.
    pub fn all_mut(&mut self) -> &mut [AxisUnit] {
        self.units
    }

    /// The axis of a slot.
    pub fn at(&self, axis: Axis) -> Option<&AxisUnit> {
        self.iter().find(|unit| unit.axis == axis)
    }

    /// The axis of an index of markers.
    pub fn with_index(&self, index: usize) -> Option<&AxisUnit> {
        self.iter().find(|unit| unit.index == index)
    }

    /// Nothing is commanded to move.
    pub fn stand(&self) -> bool {
        self.iter().all(AxisUnit::stands)
    }

    /// Some were taken over from where they are while a path was interrupted, and go back to it with NC start.
    pub fn are_away(&self) -> bool {
        self.iter().any(|unit| unit.left_at.is_some())
    }

    /// Where the axes stand, machine coordinates; unknown where there is no axis.
    pub fn machine_position(&self) -> Position {
        machine_position(self.iter())
    }

    /// Where the axes stand that programs move.
    pub fn programmed_position(&self) -> Position {
        machine_position(self.iter().filter(|unit| unit.is_free()))
    }

    /// The same of an interrupted path: axes that were taken over from somewhere else count where it has left them.
    pub fn left_position(&self) -> Position {
        let mut at = self.programmed_position();
        for unit in self.iter().filter(|unit| unit.is_free()) {
            at[unit.axis] = unit.left_at.unwrap_or(at[unit.axis]);
        }
        at
    }

    /// The axes that programs move: neither slaves [000:4519] nor those of the PLC [000:4094-4116].
    pub fn programmable(&self) -> AxisSet {
        self.iter()
            .filter(|unit| unit.is_free())
            .fold(AxisSet::EMPTY, |slots, unit| slots.with(unit.axis))
    }

    /// The box of the active traverse range.
    pub fn traverse_box(&self) -> Box2 {
        let mut limits: Box2 = [
            PerAxis::splat(f64::NEG_INFINITY).into(),
            PerAxis::splat(f64::INFINITY).into(),
        ];
        // An axis of the PLC has no place in it.
        for unit in self.iter().filter(|unit| !unit.is_plc_axis()) {
            if let Some([least, greatest]) = unit.limited() {
                let [min, max] = &mut limits;
                min[unit.axis] = least;
                max[unit.axis] = greatest;
            }
        }
        limits
    }

    /// Nothing moves that a run could take over in the midst of its movement.
    pub fn rest(&self) -> bool {
        let moves =
            |unit: &AxisUnit| !unit.is_at_rest() && unit.mover != Mover::Rotation && !unit.is_plc_axis();
        !self.iter().any(moves)
    }

    /// Those whose loop is open: no block may move them.
    pub fn clamped(&self) -> AxisSet {
        let open = self
            .iter()
            .filter(|unit| unit.parameters.controlled && !unit.servo.closed());
        open.fold(AxisSet::EMPTY, |axes, unit| axes.with(unit.axis))
    }

    /// Those of the path stand within their windows.
    pub fn are_in_position(&self) -> bool {
        self.iter()
            .filter(|unit| unit.mover == Mover::Path && unit.servo.closed())
            .all(|unit| unit.stands() && unit.servo.in_position())
    }

    /// Those of a probing movement stand where it has led them: none was taken over from somewhere else.
    pub fn have_arrived(&self) -> bool {
        self.are_in_position() && !self.are_away()
    }

    /// Chooses lag or feed pre-control for a kind of operation; whether all have it.
    pub fn choose_methods(&mut self, operation: Operation) -> bool {
        let mut ready = true;
        for unit in self.iter_mut() {
            ready &= unit.choose_method(operation);
        }
        ready
    }

    /// Those that nobody moves any more come down to a standstill.
    pub fn slow_down(&mut self, time_s: f64) {
        for unit in self.iter_mut() {
            if unit.mover == Mover::None && !unit.stands() && unit.coupling.is_none() {
                unit.drive(time_s, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
            }
        }
    }

    /// The path was given up: nothing is left to go back to.
    pub fn forget_path(&mut self) {
        for unit in self.iter_mut() {
            unit.left_at = None;
        }
    }

    /// No path leads them: those that stand count within one turn, and nothing is left to go back to.
    pub fn settle(&mut self) {
        for unit in self.iter_mut() {
            unit.left_at = None;
            if unit.mover == Mover::None && unit.stands() {
                unit.wrap();
            }
        }
    }

    /// Goes over to changed machine parameters; the limits of the traverse range are the caller's.
    pub fn set_parameters(&mut self, list: &ParameterList) {
        let channel = self.channel;
        for unit in self.units.iter_mut().filter(|unit| unit.home.0 == channel) {
            let Ok(index) = u8::try_from(unit.home.1) else {
                continue;
            };
            let mut parameters = list.axis_parameters(index);
            let coupled = unit.coupling.is_some();
            if let Some(master) = unit.parameters.synchronization.master.filter(|_| coupled) {
                parameters = parameters.as_slave_of(&list.axis_parameters(master));
            }
            unit.set_parameters(parameters);
        }
    }

    /// The operator may move those that a path has led. Where a probe has led them no path says, and so it is remembered:
    /// RESTORE POSITION brings them back to it.
    pub fn leave_path(&mut self, probed: bool) {
        for unit in self.iter_mut().filter(|unit| unit.mover == Mover::Path && probed) {
            unit.left_at.get_or_insert(unit.nominal);
        }
        self.release(|mover| mover == Mover::Path);
    }

    /// Those that something moves belong to nobody.
    pub fn release(&mut self, moved_by: impl Fn(Mover) -> bool) {
        for unit in self.iter_mut().filter(|unit| moved_by(unit.mover)) {
            unit.end_step();
            unit.mover = Mover::None;
        }
    }
}

/// Where axes stand, as path positions: the actual one, and the nominal one.
pub fn path_positions<'a>(axes: impl Iterator<Item = &'a AxisUnit> + Clone, chain: &Chain) -> [Position; 2] {
    let mut actual = Position::UNKNOWN;
    for unit in axes.clone() {
        actual[unit.axis] = unit.servo.actual_mm();
    }
    [actual, machine_position(axes)].map(|machine| chain.tip(&machine))
}

/// Where axes stand, machine coordinates; unknown where there is none.
pub fn machine_position<'a>(axes: impl Iterator<Item = &'a AxisUnit>) -> Position {
    let mut position = Position::UNKNOWN;
    for unit in axes {
        position[unit.axis] = unit.nominal;
    }
    position
}
