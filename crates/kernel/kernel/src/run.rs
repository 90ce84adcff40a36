//! The run of a program on its track: start, stop, single block, end, and what is waited for.
//!
//! Decision: What is after an acknowledgement, a programmed stop or the end waits until the axes are back there; a
//! way back that was stopped goes on with NC start only (also `kernel/src/restore.rs`)

use bahn_motion::{Drive, State, Stop};
use bahn_parameters::operation::RestartParameters;
use bahn_path::{Barrier, Direction, LiveData, PathElement, Position};

use crate::axes::OwnAxes;
use crate::axis::Mover;
use crate::block_time::BlockTime;
use crate::feeder::{Feeder, RunFault};
use crate::progress::{Progress, RunState};
use crate::restore::{Restoration, ScanEnd};
use crate::run_family::{Acting, Demands, RunFamily};
use crate::thread::{self, Preparation, Tapping, Taps, is_floating, is_rigid};
use crate::track::{RefusedBlock, Track};

/// Elements that one call of prepare reads at most.
const BUDGET: usize = 256;

/// The run of a program.
#[derive(Clone, Debug)]
pub struct Run {
    /// The path that it goes, with its look-ahead.
    pub track: Track,
    /// What threads need of the spindle.
    pub tapping: Tapping,
    /// Block processing time that is simulated.
    pub block_time: BlockTime,
    progress: Progress,
    /// Block scan and return to the contour.
    restoration: Restoration,
    /// The program goes on with this at the next preparation.
    answer: Option<LiveData>,
}

/// What NC start comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Started {
    /// The run begins, with the next preparation, or goes on.
    On,
    /// It goes on in a thread out of which the tool was led by hand.
    LedOut,
}

/// Where a run that is broken off goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrokenOff {
    /// It cannot be broken off now.
    Refused,
    /// A fault has broken it off before.
    Before,
    /// At a block, by its place in the order of execution; `None` without a program.
    At(Option<u64>),
}

/// What a run comes to in a cycle.
#[allow(
    clippy::large_enum_variant,
    reason = "one at a time, and no cycle allocates: a scan goes with its barrier"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Came {
    /// It goes on, or waits.
    On,
    /// A block is over, and the axes stand: [`Run::end_block`] says how it goes on.
    BlockEnd,
    /// A thread cannot begin: its spindle cannot be led.
    NoThread,
    /// The path stands at a block one of whose functions was refused, or after it where the axes did not stand for it: the run
    /// is to end before that block.
    Refused(RefusedBlock),
    /// What the program says after its path: the end, a fault, or what the family does before it answers.
    Stop(Stop<RunFault>),
}

impl Run {
    /// Nothing runs on a track.
    pub fn new(track: Track) -> Run {
        Run {
            track,
            tapping: Tapping::default(),
            block_time: BlockTime::default(),
            progress: Progress::default(),
            restoration: Restoration::default(),
            answer: None,
        }
    }

    /// How far it is.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Axes are being brought back to the contour, or are to be.
    pub fn restores(&self) -> bool {
        self.restoration.is_on()
    }

    /// A scan looks for a block.
    pub fn scans(&self) -> bool {
        self.restoration.scans()
    }

    /// The element that is executed, while a run is.
    pub fn element(&self) -> Option<&PathElement> {
        self.track.path.element().filter(|_| self.progress.is_active())
    }

    /// A path that follows the spindle is executed, or begins.
    pub fn taps_rigidly(&self) -> bool {
        is_rigid(self.element())
    }

    /// A tap in a floating holder cuts.
    pub fn taps_floating(&self) -> bool {
        is_floating(self.element())
    }

    /// Spindle and axis have come apart.
    pub fn part_thread(&mut self) {
        let element = self.track.path.element().filter(|_| self.progress.is_active());
        self.tapping.part(&self.track, element);
    }

    /// Once in each contour cycle: what tapping tells the family, the axes and the spindle.
    pub fn follow_tapping(&mut self, at: &mut Acting) -> Taps {
        let active = self.progress.is_active();
        self.tapping.follow(&self.track, active, &mut at.leading())
    }

    /// NC start: begins a run, or goes on with one that stands.
    pub fn start<'b>(&mut self, family: &mut impl RunFamily<'b>) -> Started {
        let mut started = Started::On;
        match self.progress.state() {
            RunState::Idle => self.progress.want_begin(),
            _ if self.progress.is_broken() => self.progress.want_begin(),
            RunState::Running => {}
            state => {
                match state {
                    RunState::BlockEnd => self.track.path.go_on(),
                    RunState::Stopped => self.answer = Some(family.answer()),
                    _ if self.track.path.is_coupled() => {
                        self.track.path.go_on();
                        started = Started::LedOut;
                    }
                    _ => {}
                }
                self.progress.enter(RunState::Running);
                let at = family.acting();
                self.restoration.return_to_path(at.axes);
                if !self.restoration.is_on() {
                    self.track.regain(at.axes, at.chain);
                }
            }
        }
        started
    }

    /// NC stop, or anything that stops like it.
    pub fn stop(&mut self) {
        self.progress.stop();
    }

    /// The interrupted run is to be broken off, and its path given up. `next`: the block that the program gives next;
    /// `probes`: the block before it is executed as far as its path goes, and is executed again.
    pub fn give_up(&mut self, next: Option<u64>, probes: bool, at: &Acting) -> BrokenOff {
        if self.progress.is_running()
            || !self.track.stands(at.axes)
            || thread::is_in_thread(&self.track, &at.standing())
        {
            return BrokenOff::Refused;
        }
        if self.progress.is_broken() {
            self.progress.leave_fault();
            return BrokenOff::Before;
        }
        if self.progress.state() == RunState::Idle && !self.restoration.is_on() {
            return BrokenOff::Refused;
        }
        let cut = self.track.path.clear().map(|cut| cut.sequence);
        BrokenOff::At(match probes {
            true => next.map(|next| next - 1),
            false => cut.or(next),
        })
    }

    /// Ends what is on its way.
    pub fn break_off(&mut self, at: &mut Acting) {
        self.progress.break_off();
        self.track.break_off();
        self.answer = None;
        self.restoration.break_off();
        at.chain.superimposed.forget();
        at.axes.release(|mover| mover == Mover::Path);
    }

    /// A fault has broken it off: the next start tries its block again.
    pub fn fail(&mut self) {
        self.progress.fail();
    }

    /// The program came to its end.
    pub fn end(&mut self) {
        self.progress.end();
    }

    /// The block at the gate of the path, when it can be refused: the axes stand.
    pub fn refusable(&self, axes: &OwnAxes) -> Option<u64> {
        let element = self.element().filter(|_| self.track.stands(axes));
        element.map(|element| element.sequence)
    }

    /// Another program, or another block, is to begin.
    pub fn forget(&mut self) {
        self.track.forget_feed();
        self.progress.leave_fault();
    }

    /// NC start was given, and nothing speaks against beginning.
    pub fn takes_begin(&mut self, may: impl FnOnce() -> bool) -> bool {
        self.progress.take_begin(may)
    }

    /// A run begins: what the last one left of positions and answers is forgotten.
    pub fn begin(&mut self) {
        self.progress.begin();
        self.track.forget_position();
        self.answer = None;
    }

    /// It sets off from where the axes stand.
    pub fn set_off(&mut self, at: &Acting) {
        self.track.begin_at(at.here(), at.chain);
        self.progress.enter(RunState::Running);
    }

    /// Reads ahead and plans, as many elements as are `allowed`; may allocate. `machine_zero`: in workpiece coordinates. `answered` is called when the program
    /// goes on after it has waited, with whether it has learned of a touch.
    pub fn prepare(
        &mut self,
        feeder: &mut Feeder,
        allowed: usize,
        machine_zero: Position,
        at: &Acting,
        answered: impl FnOnce(&mut Feeder, bool),
    ) {
        let refused = self.track.refused();
        let path = &mut self.track.path;
        if let Some(recalled) = path.take_recalled() {
            feeder.put_back(recalled.into_iter());
        }
        let limits = (at.axes.traverse_box(), at.axes.programmable());
        feeder.set_datum(at.chain.offsets.datum, machine_zero, limits);
        let is_back = self.restoration.is_over(at.axes);
        if let Some(answer) = self.answer.take_if(|_| is_back) {
            let probed = answer.touch.is_some();
            if !probed {
                // The family may have moved the axes, or corrected the datum [000:8914].
                feeder.reader_mut().stand_at(&at.here());
            }
            path.resume(feeder, answer);
            answered(feeder, probed);
        }
        if let Some(element) = path.element() {
            // The next start goes back before a block that is refused.
            feeder.forget_before(refused.map_or(element.sequence, |refused| refused.sequence));
        }
        feeder.allow_work();
        let before = feeder.elements_read();
        path.prepare(feeder, allowed);
        self.block_time.spend(feeder.elements_read() - before);
    }

    /// How many elements may be read now, µs; asked in every cycle.
    pub fn allowed(&mut self, now_us: u64) -> usize {
        self.block_time.allow(now_us, BUDGET)
    }

    /// Seeks the start of a block, without movements, with everything in force as if it had run to there.
    pub fn scan(&mut self, block: u32) {
        self.progress.scan();
        self.restoration.scan(block);
    }

    /// Goes on with a scan; may allocate. Why it ended, when that was not at its block.
    pub fn scan_on<'b>(
        &mut self,
        feeder: &mut Feeder,
        rules: &RestartParameters,
        family: &mut impl RunFamily<'b>,
    ) -> Option<ScanEnd> {
        feeder.allow_work();
        self.restoration.prepare(feeder, rules, &mut self.track, family)
    }

    /// The operator is to move the axes while the run is interrupted, where that `may` be; `probed`: a probe has led them.
    pub fn leave_path(&mut self, may: bool, probed: bool, axes: &mut OwnAxes) -> bool {
        let coupled = self.track.path.is_coupled();
        let possible = self.progress.state() == RunState::Interrupted
            && !self.restoration.is_on()
            && (may && self.track.stands(axes) || coupled);
        if possible && !coupled {
            axes.leave_path(probed);
        }
        possible
    }

    /// The axes are to go back to the contour with NC start, from where the path was left when it `may` return there.
    pub fn restore(&mut self, may: bool, at: &mut Acting) -> bool {
        self.restoration.arm(may, &self.track, at)
    }

    /// Moves the axes back to the contour for a cycle, when that is what is to be done. Whether that is over.
    pub fn move_back<'b>(&mut self, feeder: Option<&mut Feeder>, family: &mut impl RunFamily<'b>) -> bool {
        self.restoration.moves(feeder, &mut self.track, family)
    }

    /// Whether the axes move in this cycle, along the path or as the family leads them. Those that cannot stand at once
    /// [000:5352]; `held`: one that the family leads cannot.
    pub fn may_move(&mut self, held: impl FnOnce(&OwnAxes) -> bool, at: &mut Acting) -> bool {
        if !self.progress.is_on_its_way() || self.restoration.is_on() {
            at.chain.superimposed.stand();
            return false;
        }
        let runs = self.progress.goes_on();
        if held(at.axes) || self.tapping.holds(&mut self.track, runs, &mut at.leading()) {
            at.chain.superimposed.stand();
            self.track.halt();
            self.track.hold(at.axes, at.now.time_s);
            return false;
        }
        true
    }

    /// Moves the axes along the path for a cycle.
    pub fn moves<'b>(&mut self, demands: &Demands, family: &mut impl RunFamily<'b>) -> Came {
        let transferred = family.has_transferred();
        let at = family.acting();
        let drive = self.drive(demands, transferred, &at);
        let settled = drive.in_position;
        let cycle = self.track.path.cycle(&drive);
        self.track.set_speed(cycle.speed_mm_s);
        self.tapping.lead(cycle.lead, at.spindle);
        let wheels = at.now.wheels();
        self.track.follow(&cycle.position, at.axes, at.chain, &wheels);
        self.track.output(family, settled);
        self.take_state(cycle.state, &drive, demands, family)
    }

    /// What the interpolator may do in a cycle.
    fn drive(&self, demands: &Demands, transferred: bool, at: &Acting) -> Drive {
        let now = at.now;
        let coupled = self.track.path.is_coupled();
        let [back, on] = if demands.by_hand {
            way_out(&self.track, at)
        } else {
            [false; 2]
        };
        let runs_out = self
            .tapping
            .runs_out(self.element(), at.axes, demands.drives_stopped);
        let stopped = !self.progress.goes_on() && !on && !runs_out;
        Drive {
            feed_override_percent: now.program_percent,
            rapid_override_percent: now.program_percent,
            rapid: now.program_rapid,
            spindle_override_percent: at.spindle.effective_percent(),
            master: self.tapping.master(&self.track, &at.standing()),
            back,
            rapid_limit_mm_min: now.rapid_limit_mm_min,
            // Without spindle enable nothing is led. Functions at which the axes do not stop may come faster than they are
            // taken.
            hold: stopped
                || demands.crowded
                || self.track.refused().is_some()
                || coupled && !at.spindle.is_enabled()
                || self.track.ramps_down(at.axes),
            single_block: demands.single_block || on || demands.read_in_inhibited,
            stop_before: demands.stop_before,
            acknowledged: self.track.has_output_all() && transferred,
            in_position: self.is_in_position(at),
            clamped: at.axes.clamped(),
            clamping: demands.clamping,
        }
    }

    /// What the path came to in this cycle.
    fn take_state<'b>(
        &mut self,
        state: State,
        drive: &Drive,
        demands: &Demands,
        family: &mut impl RunFamily<'b>,
    ) -> Came {
        let all_output = self.track.has_output_all() && family.has_transferred();
        let mut at = family.acting();
        if let Some(refused) = self.track.refused()
            && self.track.stands(at.axes)
        {
            return Came::Refused(refused);
        }
        let done = drive.in_position && all_output && self.restoration.is_over(at.axes);
        match state {
            State::Gate(_) if all_output && !demands.positions => {
                self.track.path.release();
                self.track.regain(at.axes, at.chain);
            }
            State::Master => {
                let leading = &mut at.leading();
                if self.tapping.prepare(&self.track, demands.spindle_open, leading) == Preparation::Refused {
                    return Came::NoThread;
                }
            }
            State::Clamped => self.track.ask_to_unclamp(drive.clamped, at.axes),
            State::BlockEnd if drive.in_position && self.progress.goes_on() => return Came::BlockEnd,
            State::Stopped if done && !demands.read_in_inhibited => return self.take_stop(family),
            _ => {}
        }
        Came::On
    }

    /// The path came to what the program said after it.
    fn take_stop<'b>(&mut self, family: &mut impl RunFamily<'b>) -> Came {
        match self.track.path.take_stop() {
            None => return Came::On,
            Some(Stop::Barrier(Barrier::Stop { .. })) => self.progress.enter(RunState::Stopped),
            Some(Stop::Barrier(Barrier::Acknowledge { .. })) => self.answer = Some(family.answer()),
            Some(stop) => return Came::Stop(stop),
        }
        Came::On
    }

    /// A block is over: the run `waits` for NC start, or goes on unless that is inhibited. A block that stops the program waits
    /// once only, as at its stop.
    pub fn end_block(&mut self, waits: bool, inhibited: bool) {
        let stops = match (self.track.path.element(), self.track.path.stop_after_this()) {
            (Some(element), Some(Stop::Barrier(Barrier::Stop { block, .. }))) => *block == element.block,
            _ => false,
        };
        if waits && !stops {
            self.progress.enter(RunState::BlockEnd);
        } else if !inhibited {
            self.track.path.go_on();
        }
    }

    /// The program goes on with an answer where the axes are now, path coordinates.
    pub fn go_on_with(&mut self, answer: LiveData, here: Position) {
        self.track.path.set_position(here);
        self.track.forget_position();
        self.answer = Some(answer);
    }

    fn is_in_position(&self, at: &Acting) -> bool {
        if self.track.path.is_coupled() {
            return self.tapping.is_in_position(&self.track, &at.standing());
        }
        at.axes.are_in_position()
    }

    /// The axes stand as far as the loops may be opened: those of a thread as far as they can.
    pub fn axes_stand(&self, axes: &OwnAxes) -> bool {
        if self.track.path.is_coupled() {
            thread::stands(&self.track, axes)
        } else {
            axes.stand()
        }
    }
}

/// The path is led back, or on, out of the thread by the axis key plus of the tool axis.
fn way_out(track: &Track, at: &Acting) -> [bool; 2] {
    let axis = at.chain.offsets.tool_axis;
    let unit = at.axes.at(axis);
    let key = unit.and_then(|unit| at.now.axis_keys.get(unit.index).copied().flatten());
    let ascends = track
        .path
        .element()
        .is_some_and(|element| element.end[axis] > element.start[axis]);
    let wanted = key == Some(Direction::Plus) && !at.now.stop;
    [wanted && !ascends, wanted && ascends]
}
