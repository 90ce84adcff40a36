//! A channel to be looked at.

use bahn_interpreter::{DripFeed, DripFeedState, Interpreter};
use bahn_kernel::{RunState, machine_position, reference};
use bahn_parameters::{ParameterList, PerPlcAxis};
use bahn_path::{Axis, BlockRef, Frame, PathElement, Position};
use bahn_reader::Reader;

use crate::channel::Channel;
use crate::command::Mode;
use crate::handshake::Waiting;
use crate::machine::MachineSide;
use crate::scanning::DigitizedNews;
use crate::screen_command::ScreenCommand;
use crate::setup::{AxisLimit, Remembered};
use crate::signal::Signal;
use crate::snapshot::Snapshot;
use crate::upkeep::by_index;
use crate::watch::{AxisFollowing, AxisWatch};
use bahn_kernel::Clock;

/// What the status display shows of a program beside positions [003:1297].
#[derive(Clone, Debug, PartialEq)]
pub struct InForce {
    /// Axis along which the tool lies.
    pub tool_axis: Axis,
    /// `N`: axes whose datum is shifted.
    pub shifted: Vec<Axis>,
    /// `S`: axes that are mirrored by cycle 8.
    pub mirrored: Vec<Axis>,
    /// `ROT`: rotation or basic rotation.
    pub rotated: bool,
    /// `SCL`: a scaling factor is in force.
    pub scaled: bool,
    /// Positions are those of a tilted working plane: of a program that runs, or of 3D ROT by hand [000:4254-4256].
    pub tilted: bool,
}

/// A channel of a control as of now.
#[derive(Clone, Copy)]
pub struct ChannelView<'a> {
    channel: &'a Channel,
    machine: &'a MachineSide,
    seam: &'a Clock,
}

impl<'a> ChannelView<'a> {
    pub(crate) fn new(channel: &'a Channel, machine: &'a MachineSide, seam: &'a Clock) -> ChannelView<'a> {
        ChannelView {
            channel,
            machine,
            seam,
        }
    }

    /// Its number, from 0.
    pub fn number(&self) -> usize {
        self.channel.number()
    }

    /// Operating mode of the channel.
    pub fn mode(&self) -> Mode {
        self.channel.desk().mode()
    }

    /// Indices of the axes whose direction keys are pressed.
    pub fn pressed_axes(&self) -> impl Iterator<Item = usize> + use<'a> {
        let keys = self.channel.desk().panel().axis_keys.iter().enumerate();
        keys.filter(|(_, key)| key.is_some()).map(|(index, _)| index)
    }

    /// An axis has not passed its reference mark: PASS OVER REFERENCE MARKS can be chosen [000:4581].
    pub fn misses_marks(&self) -> bool {
        self.machine
            .core
            .axes
            .owned(self.channel.number())
            .any(reference::waits)
    }

    /// State of the channel's run.
    pub fn run_state(&self) -> RunState {
        self.channel.run.progress().state()
    }

    /// A run is on its way, or begins as soon as it can.
    pub fn is_active(&self) -> bool {
        self.channel.run.is_active()
    }

    /// A fault has interrupted the run: nothing of it is on its way, and NC start tries its block again.
    pub fn is_broken(&self) -> bool {
        self.channel.run.progress().is_broken()
    }

    /// The run came to its end since it was started.
    pub fn has_ended(&self) -> bool {
        self.channel.run.progress().has_ended()
    }

    /// The program that is transferred while it runs; `None` when none is, or its run has come to its end.
    pub fn drip_feed(&self) -> Option<DripFeedState> {
        self.channel.run.source.drip_feed.as_ref().map(DripFeed::state)
    }

    /// The element of the path that is executed, or was last.
    pub fn element(&self) -> Option<&'a PathElement> {
        self.channel.run.core.track.path.element()
    }

    /// The block with which NC start begins, or goes on where a run was broken off [003:1630-1640]; `None` while the program
    /// is read on another thread.
    pub fn next_start(&self) -> Option<BlockRef> {
        let run = &self.channel.run;
        run.source.next_start(run.selection.start_block)
    }

    /// Path length to the end of that element, mm; below 0 where a thread waits after its end.
    pub fn rest_mm(&self) -> f64 {
        self.channel.run.core.track.path.rest_mm()
    }

    /// The program that runs, or ran last.
    pub fn reader(&self) -> Option<&'a dyn Reader> {
        self.channel.run.source.reader()
    }

    /// The same as a program of a TNC; `None` when it is in another language.
    pub fn interpreter(&self) -> Option<&'a Interpreter> {
        self.channel.run.source.interpreter()
    }

    /// What reports call a block: in DIN/ISO the number that it is programmed with; its place while the program is read on
    /// another thread.
    pub fn number_of(&self, block: BlockRef) -> u32 {
        let program = self.reader().and_then(|run| run.program(block.program));
        program.map_or(block.block, |program| program.number_of(block.block))
    }

    /// What the status display shows beside positions: transformations at the block that is executed, between runs those
    /// that the last one has left; `None` while the program is read on another thread.
    pub fn in_force(&self) -> Option<InForce> {
        let frame = self.channel.run.frame()?;
        let basic = self.channel.touch.memory.basic_rotation_deg;
        let axes = |is: fn(&Frame, Axis) -> bool| {
            let units = self.machine.core.axes.owned(self.channel.number());
            units
                .map(|unit| unit.axis)
                .filter(|axis| is(&frame, *axis))
                .collect()
        };
        let scaled = |axis: Axis| {
            let own = frame.axis_scaling.map_or(1.0, |own| own.factor[axis]);
            frame.factor[axis].abs() * own != 1.0
        };
        Some(InForce {
            tool_axis: self.channel.chain().offsets.tool_axis,
            shifted: axes(|frame, axis| frame.shift[axis] != 0.0),
            mirrored: axes(|frame, axis| frame.factor[axis] < 0.0),
            rotated: frame.rotation_deg != 0.0 || basic != 0.0,
            scaled: Axis::ALL.into_iter().any(scaled),
            tilted: self
                .channel
                .chain()
                .placement()
                .is_some_and(|placement| placement.is_tilted()),
        })
    }

    /// Machine positions of A, B and C in the plane of 3D ROT for manual operation or program run, degrees; `None` where it is
    /// off [000:4256]. That of program run is the one in which the next program begins: set in the menu, or left by
    /// cycle 19.
    pub fn plane(&self, run: bool) -> Option<[f64; 3]> {
        let angles = match run {
            true => self.channel.run.source.plane(),
            false => self.channel.desk().leaning.angles(),
        };
        angles.map(|angles| [Axis::A, Axis::B, Axis::C].map(|axis| angles[axis]))
    }

    /// AXIS LIMIT of MOD.
    pub fn axis_limits(&self) -> &'a [AxisLimit] {
        self.channel.datums.axis_limits()
    }

    /// Index of the axis that the handwheel moves, and its interpolation factor.
    pub fn handwheel(&self) -> (usize, u8) {
        let handwheel = &self.channel.desk().manual.handwheel;
        let axis = handwheel.axis();
        (axis, handwheel.factors().get(axis).copied().unwrap_or_default())
    }

    /// PNT is on: the stylus of a measuring probe leads the axes.
    pub fn follows_stylus(&self) -> bool {
        self.channel.desk().manual.follows_stylus()
    }

    /// A function of the TOUCH PROBE menu is chosen.
    pub fn probe_is_chosen(&self) -> bool {
        self.channel.touch.is_chosen()
    }

    /// A Q parameter at the block that is executed; without a run as the last one has left it.
    pub fn q_value(&self, number: u16) -> f64 {
        self.channel.run.q_value(number)
    }

    /// The datum table with M status.
    pub fn datum_table_name(&self) -> Option<&'a str> {
        self.machine.link.datum_table_name().map(String::as_str)
    }

    /// What a screen said last that it shows.
    pub fn screen(&self) -> Option<ScreenCommand> {
        self.machine.link.screen()
    }

    /// The list of machine parameters as it is edited, of the first channel.
    pub fn edited_list(&self) -> &'a ParameterList {
        self.machine.link.edited_list()
    }

    /// Where the workpiece datum of its axes is on the machine, mm or degrees.
    pub fn datum(&self) -> Position {
        self.channel.chain().offsets.datum
    }

    /// What was digitized last: to be looked at after every cycle.
    pub fn digitized(&self) -> DigitizedNews {
        self.channel.run.probe.digitized
    }

    /// The stylus is on its way to a surface, or is about to be: a probing, by program or by hand, or a scan.
    pub fn probes(&self) -> bool {
        self.channel.run.probe.seeks_surface()
    }

    /// The straight way on which a probe leads the path now: from where, and how far if it touches nothing. In coordinates of
    /// the path; `None` for a scan, which has its RANGE.
    pub fn probing_way(&self) -> Option<[Position; 2]> {
        self.channel.run.probe.way()
    }

    /// A probe leads the path, and no element of it: a probing, a scan, or the measuring of a tool.
    pub fn is_led_by_probe(&self) -> bool {
        self.channel.run.probe.is_on()
    }

    /// Handshake that the run waits for.
    pub fn waiting(&self) -> Option<Waiting> {
        let nc = self.machine.memory.of(self.number()).nc();
        self.channel.handshakes.waiting(nc)
    }

    /// Tool in the spindle.
    pub fn tool(&self) -> u32 {
        self.channel.tools.number
    }

    /// Feed override in force, %.
    pub fn feed_override_percent(&self) -> f64 {
        self.channel.desk().feed_percent()
    }

    /// The letters of the axes that it has now.
    pub fn axis_letters(&self) -> impl Iterator<Item = char> + use<'a> {
        self.machine
            .core
            .axes
            .owned(self.channel.number())
            .map(|unit| unit.axis.letter())
    }

    /// Axes whose reference marks are evaluated have not passed them: until then no program starts.
    pub fn lacks_reference(&self) -> bool {
        reference::is_due(self.machine.core.axes.owned(self.channel.number()))
    }

    /// The axes that it has now, as the kernel moves them.
    pub fn watch(&self) -> impl Iterator<Item = AxisWatch> + use<'a> {
        let superimposed = &self.channel.chain().superimposed;
        let axes = self.machine.core.axes.owned(self.channel.number());
        axes.map(|unit| AxisWatch::of(unit, superimposed))
    }

    /// How the axes that it has now follow.
    pub fn followings(&self) -> impl Iterator<Item = AxisFollowing> + use<'a> {
        let axes = self.machine.core.axes.owned(self.channel.number());
        axes.map(AxisFollowing::of)
    }

    /// Where its axes are commanded to be, in the coordinates of its path: without what the handwheel adds to it (M118).
    pub fn commanded(&self) -> Position {
        let axes = machine_position(self.machine.core.axes.owned(self.number()));
        self.channel.chain().to_path(&axes)
    }

    /// The spindle leads the path: a thread is being cut.
    pub fn is_in_thread(&self) -> bool {
        self.channel.run.core.track.path.is_coupled()
    }

    /// The axis of a thread goes where its spindle turns: neither is it held, nor have they come apart.
    pub fn follows_spindle(&self) -> bool {
        self.channel
            .run
            .core
            .tapping
            .follows_spindle(&self.channel.run.core.track)
    }

    /// Axes are being brought back to the contour, or are to be.
    pub fn restores(&self) -> bool {
        self.channel.run.core.restores()
    }

    /// The value of a signal; an axis that the channel does not have reads 0.
    pub fn observe(&self, signal: &Signal) -> f64 {
        signal.value(self.channel, self.machine, self.seam)
    }

    /// Positions, run, messages and spindle of the channel as of now.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot::of(self.channel, self.machine, None)
    }

    /// What survives power-off of a channel beside the first one: datums, tool, Q parameters, program, offsets of
    /// the axes that its list describes.
    pub fn remember(&self) -> Remembered {
        Remembered {
            offsets_volts: offsets_volts(self.machine, self.number()),
            ..self.channel.remember()
        }
    }
}

/// The adjusted offsets of the axes that the list of a channel describes, whichever channel has them now, V.
pub(crate) fn offsets_volts(machine: &MachineSide, channel: usize) -> PerPlcAxis<f64> {
    let axes = machine.core.axes.iter().filter(|unit| unit.home.0 == channel);
    by_index(
        axes,
        |unit| unit.home.1,
        |unit| unit.servo.offset_compensation_volts(),
    )
}
