//! Program run: MDI, single block, full sequence; start, stop, internal stop, end.

use bahn_exchange::{Image, signal};
use bahn_kernel::reference::is_due;
use bahn_kernel::{
    AxisUnit, BlockTime, Chain, Feeder, Mover, Preparation, Progress, RunFault, RunState, Tapping, Track,
    distance_to_go, is_floating, is_rigid, thread,
};
use bahn_motion::{Drive, State, Stop};
use bahn_parameters::MessageId;
use bahn_parameters::operation::RestartParameters;
use bahn_path::{Barrier, BlockRef, Frame, LiveData, PathElement};
use bahn_reader::Reader;
use bahn_servo::Measured;

use crate::command::Mode;
use crate::driving::Driving;
use crate::language::{self, OwnLanguage};
use crate::message::Message;
use crate::probing::{Probe, Probed};
use crate::programs::Selection;
use crate::q_transfer::QTransfer;
use crate::replacement::{Replacement, Wear};
use crate::restore::{Restoration, ScanEnd};
use crate::site::{PathOutputs, Site};
use crate::source::{Basis, Resume, Source, machine_zero};

/// Elements that one call of prepare reads at most.
const BUDGET: usize = 256;

/// The program run of a channel.
#[derive(Clone)]
pub(crate) struct ProgramRun {
    pub selection: Selection,
    pub source: Source,
    pub track: Track,
    progress: Progress,
    /// A probing movement.
    pub probe: Probe,
    /// Block scan and return to the contour.
    restoration: Restoration,
    pub tapping: Tapping,
    /// Q100 to Q107 as the PLC wrote them.
    q_transfer: QTransfer,
    /// The source goes on with this at the next preparation.
    answer: Option<LiveData>,
    /// Of a tool that is worn, under M101.
    replacement: Replacement,
    /// Block processing time that is simulated.
    pub block_time: BlockTime,
}

impl ProgramRun {
    pub fn new(selection: Selection, source: Source, track: Track) -> ProgramRun {
        ProgramRun {
            selection,
            source,
            track,
            progress: Progress::default(),
            probe: Probe::default(),
            restoration: Restoration::default(),
            tapping: Tapping::default(),
            q_transfer: QTransfer::default(),
            answer: None,
            replacement: Replacement::default(),
            block_time: BlockTime::default(),
        }
    }

    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    pub fn is_active(&self) -> bool {
        self.progress.is_active()
    }

    /// Axes are being brought back to the contour, or are to be.
    pub fn restores(&self) -> bool {
        self.restoration.is_on()
    }

    /// The block that is executed, while a run is on.
    pub fn running_block(&self) -> Option<BlockRef> {
        self.element().map(|element| element.block)
    }

    /// The element that is executed, while a run is.
    fn element(&self) -> Option<&PathElement> {
        self.track.path.element().filter(|_| self.is_active())
    }

    /// A path that follows the spindle is executed, or begins.
    pub fn taps_rigidly(&self) -> bool {
        is_rigid(self.element())
    }

    /// Cycle 2 taps.
    pub fn taps_floating(&self) -> bool {
        is_floating(self.element())
    }

    /// Spindle and axis have come apart.
    pub fn part_thread(&mut self) {
        let element = self.track.path.element().filter(|_| self.progress.is_active());
        self.tapping.part(&self.track, element);
    }

    /// Once in each contour cycle: what tapping tells the PLC, the axes and the spindle.
    pub fn follow_tapping(&mut self, site: &mut Site) {
        let active = self.progress.is_active();
        let taps = self.tapping.follow(&self.track, active, &mut site.leading());
        site.exchange.nc_put(signal::TAPPING_CALLED, taps.called);
        site.exchange.nc_put(signal::RIGID_TAPPING_ACTIVE, taps.rigid);
    }

    /// Shows a message of the run.
    fn show(&self, message: Message, site: &mut Site) {
        let block = match &message {
            Message::Program(error) => Some(error.block),
            _ => self.running_block(),
        };
        site.messages.show(message, block);
    }

    /// NC start in an automatic mode.
    pub fn start(&mut self, site: &mut Site) {
        if self.restoration.is_on() || site.positioning.is_on() {
            return;
        }
        if self.tapping.has_lost_spindle() || self.bars(site) {
            self.show(Message::Plain(MessageId::KeyNonFunctional), site);
            return;
        }
        match self.progress.state() {
            RunState::Idle => self.progress.want_begin(),
            _ if self.progress.is_broken() => self.progress.want_begin(),
            RunState::Running => {}
            state => {
                match state {
                    RunState::BlockEnd => self.track.path.go_on(),
                    RunState::Stopped => self.answer = Some(self.q_transfer.answer()),
                    _ if self.track.path.is_coupled() => {
                        // Led out of a thread by hand.
                        self.track.path.go_on();
                        site.exchange.nc_put(signal::MANUAL_OPERATION_PRESSED, false);
                    }
                    _ => {}
                }
                self.progress.enter(RunState::Running);
                self.restoration.return_to_path(&mut site.axes);
                if !self.restoration.is_on() {
                    self.track.regain(&site.axes, site.chain);
                }
            }
        }
    }

    /// No program is begun, nor goes on, before the axes that MP1340 names have passed their reference marks: until then no
    /// software limit holds and no datum is known [000:4563-4575] [001:953]. What MDI positions may do without, but for M91 and
    /// M92. What the control says then no manual prints (inferred).
    fn bars(&self, site: &Site) -> bool {
        site.mode != Mode::Mdi && !self.progress.is_running() && is_due(site.axes.iter())
    }

    /// NC stop, or anything that stops like it.
    pub fn stop(&mut self) {
        self.progress.stop();
    }

    /// INTERNAL STOP: the interrupted run is broken off; the next start begins with its block.
    pub fn internal_stop(&mut self, site: &mut Site) -> bool {
        if self.progress.is_running()
            || !self.track.stands(&site.axes)
            || thread::is_in_thread(&self.track, &site.standing())
        {
            return false;
        }
        if self.progress.is_broken() {
            self.progress.leave_fault();
            return true;
        }
        if self.progress.state() == RunState::Idle && !self.restoration.is_on() {
            return false;
        }
        let cut = self.track.path.clear().map(|cut| cut.sequence);
        let next = self.source.feeder().map(Feeder::next_sequence);
        // The block that probes is executed as far as its path goes.
        let resume = if self.probe.is_on() {
            next.map(|next| next - 1)
        } else {
            cut.or(next)
        };
        self.source.resume_at(resume.map(Resume::Block));
        self.break_off(site);
        true
    }

    /// Ends what is on its way for the run.
    fn break_off(&mut self, site: &mut Site) {
        self.progress.break_off();
        self.track.break_off();
        self.answer = None;
        self.restoration.break_off();
        self.source.break_off(site.mode == Mode::Mdi);
        site.handshakes.abort(site.exchange);
        self.probe.end(site);
        site.tools.take_back(&mut site.chain.offsets);
        site.chain.superimposed.forget();
        site.positioning.end_all(site.exchange);
        site.axes.release(|mover| mover == Mover::Path);
        site.exchange.nc_put(signal::MANUAL_OPERATION_PRESSED, false);
        site.exchange.nc_put(signal::BLOCK_SCAN_ACTIVE, false);
    }

    /// A fault interrupts the run [003:1578]; the next start begins with the block that was not executed.
    fn abort(&mut self, resume: Resume, site: &mut Site) {
        self.track.path.clear();
        self.source.resume_at(Some(resume));
        self.break_off(site);
        if site.mode != Mode::Mdi {
            self.progress.fail();
        }
    }

    /// What the block at the gate of the path asks for is refused: the run ends before it. `false` when it is
    /// only to be stopped.
    pub fn refuse_block(&mut self, site: &mut Site) -> bool {
        match self.track.path.element().map(|element| element.sequence) {
            Some(sequence) if self.track.stands(&site.axes) && self.is_active() => {
                self.abort(Resume::Block(sequence), site);
                true
            }
            _ => false,
        }
    }

    /// END PGM, M2 or M30.
    fn end(&mut self, site: &mut Site) {
        self.source.end();
        self.break_off(site);
        self.progress.end();
        if site.mode != Mode::Mdi {
            self.source.resume_at(None);
            self.selection.start_block = 0;
            site.exchange.nc_put(signal::PROGRAM_END_EXECUTED, true);
        }
    }

    /// What is to be done once a run is over, outside the cycle.
    pub fn close(&mut self, site: &mut Site, basis: &Basis) {
        let (track, q_transfer) = (&mut self.track, &mut self.q_transfer);
        let closed = self.source.close(|| {
            track.path.clear();
            q_transfer.take_all()
        });
        if closed && site.chain.placement().is_some() {
            // By hand 3D ROT alone tilts.
            site.chain.place(None);
            self.track.begin_at(site.here(), site.chain);
        }
        if closed && basis.list.program_end_clearing().at_program_end && !self.source.was_mdi() {
            self.source.cancel_status(basis.list, site);
        }
        if closed && !self.source.was_mdi() {
            self.source.drip_feed = None;
        }
        self.source.take_back();
    }

    /// Interprets ahead; begins a run.
    pub fn prepare(&mut self, site: &mut Site, basis: &Basis) {
        let allowed = self.block_time.allow(site.now.us, BUDGET);
        let source = &mut self.source;
        let mdi = site.mode == Mode::Mdi;
        if self
            .progress
            .take_begin(|| site.axes.rest() && source.may_begin(mdi))
        {
            self.begin(site, basis);
        }
        self.track.reserve();
        if !self.is_active() && site.handshakes.is_idle() {
            site.call_inserted_tool();
        }
        self.replacement
            .prepare(self.source.feeder_mut(), &mut self.track, site);
        let wear = Wear::of(site.tools, site.magazine);
        let scans = self.restoration.scans();
        let Some(feeder) = self
            .source
            .feeder_mut()
            .filter(|_| self.progress.is_on_its_way() && !scans)
        else {
            return;
        };
        let path = &mut self.track.path;
        if let Some(recalled) = path.take_recalled() {
            feeder.put_back(recalled.into_iter());
        }
        let zero = machine_zero(&site.axes, site.chain);
        let limits = (site.axes.traverse_box(), site.axes.programmable());
        feeder.set_datum(site.chain.offsets.datum, zero, limits);
        let is_back = self.restoration.is_over(&site.axes);
        if let Some(answer) = self.answer.take_if(|_| is_back) {
            let probed = answer.touch.is_some();
            if !probed {
                // The PLC may have moved the axes, or corrected the datum [000:8914].
                feeder.reader_mut().stand_at(&site.here());
            }
            path.resume(feeder, answer);
            if let Some(call) = site.tools.inserted_call.take() {
                feeder.insert(&call);
            } else if let Wear::Replace(tool) = wear
                && !probed
            {
                feeder.replace_tool(site.tools.number, tool);
            }
        }
        if let Some(element) = path.element() {
            feeder.forget_before(element.sequence);
        }
        feeder.allow_work();
        let before = feeder.elements_read();
        path.prepare(feeder, allowed);
        self.block_time.spend(feeder.elements_read() - before);
    }

    fn begin(&mut self, site: &mut Site, basis: &Basis) {
        let mdi = site.mode == Mode::Mdi;
        site.exchange.nc_put(signal::PROGRAM_END_EXECUTED, false);
        self.progress.begin();
        self.track.forget_position();
        self.answer = None;
        if mdi {
            self.source.set_aside();
        }
        if !self.source.go_on(site) {
            match self.source.open(mdi, &self.selection, site, basis) {
                Ok(opened) => {
                    // Counted from TOOL CALL on [000:9181]; blocks of MDI are no program.
                    site.tools.counts &= mdi;
                    site.tools.replaces_worn &= mdi;
                    site.tools.takes_larger &= mdi;
                    let block = if mdi { 0 } else { self.selection.start_block };
                    site.chain.place(None);
                    let feeder = self.source.feeder_for_run(opened, block, site, basis);
                    self.source.put(feeder);
                }
                Err(message) => {
                    self.show(message, site);
                    return;
                }
            }
        } else if let Some(feeder) = self.source.feeder() {
            site.chain.place(feeder.reader().placement());
        }
        self.track.begin_at(site.here(), site.chain);
        self.progress.enter(RunState::Running);
    }

    /// RESTORE AT N: scans to a block.
    pub fn restore_at(
        &mut self,
        block: u32,
        rules: &RestartParameters,
        site: &mut Site,
        basis: &Basis,
    ) -> bool {
        if self.is_active() || !rules.block_scan || self.bars(site) {
            return false;
        }
        let mdi = site.mode == Mode::Mdi;
        let ready = self.source.may_begin(mdi);
        let Some(opened) = self
            .source
            .open(mdi, &self.selection, site, basis)
            .ok()
            .filter(|_| ready)
        else {
            return false;
        };
        // The scan starts at the cursor, or with MP7680 bit 5 at the begin of the program.
        if rules.from_start {
            self.selection.start_block = 0;
        }
        let start = if mdi { 0 } else { self.selection.start_block };
        site.chain.place(None);
        let feeder = self.source.feeder_for_run(opened, start, site, basis);
        self.source.put(feeder);
        self.progress.scan();
        self.restoration.scan(block, site.exchange);
        true
    }

    /// Takes what has come of the program, and goes on with a scan; may allocate.
    pub fn read_on(&mut self, rules: &RestartParameters, site: &mut Site) {
        self.source.grow();
        if self.source.is_stuck() && self.progress.is_on_its_way() && self.track.path.element().is_none() {
            self.show(Message::Plain(MessageId::ProgramMemoryOverflow), site);
            self.abort(Resume::Fault, site);
        }
        let Some(feeder) = self.source.feeder_mut().filter(|_| self.restoration.scans()) else {
            return;
        };
        feeder.allow_work();
        let (q, track) = (&mut self.q_transfer, &mut self.track);
        match self.restoration.prepare(feeder, q, rules, track, site) {
            None => return,
            Some(ScanEnd::NotAddressed) => self.show(ScanEnd::NOT_ADDRESSED, site),
            Some(ScanEnd::Fault(fault)) => self.show_fault(fault, site),
        }
        self.internal_stop(site);
    }

    /// MANUAL OPERATION while a run is interrupted.
    pub fn manual_operation(&mut self, rules: &RestartParameters, site: &mut Site) -> bool {
        let coupled = self.track.path.is_coupled();
        let possible = self.progress.state() == RunState::Interrupted
            && !self.restoration.is_on()
            && (rules.return_to_contour && self.track.stands(&site.axes) || coupled);
        if possible {
            site.exchange.nc_put(signal::MANUAL_OPERATION_PRESSED, true);
            if !coupled {
                site.axes.leave_path(self.probe.is_on());
            }
        }
        possible
    }

    /// Whether the operator may move axes while a run is interrupted.
    pub fn is_operated_manually(&self, nc: &Image) -> bool {
        self.progress.state() == RunState::Interrupted && nc.bit(signal::MANUAL_OPERATION_PRESSED)
    }

    /// RESTORE POSITION.
    pub fn restore_position(&mut self, site: &mut Site) -> bool {
        let may = self.is_operated_manually(site.exchange.nc());
        self.restoration.arm(may, &self.track, site)
    }

    /// Moves the axes back to the contour for a cycle, when that is what is to be done.
    pub fn move_back(&mut self, site: &mut Site) {
        let (q, track) = (&mut self.q_transfer, &mut self.track);
        self.restoration.moves(self.source.feeder_mut(), q, track, site);
    }

    /// Moves the axes along the path for a cycle.
    pub fn moves(&mut self, site: &mut Site, measured: &Measured) {
        if !self.progress.is_on_its_way() || self.restoration.is_on() {
            site.chain.superimposed.stand();
            return;
        }
        let runs = self.progress.goes_on();
        if self.probe.is_held(&site.axes) || self.tapping.holds(&mut self.track, runs, &mut site.leading()) {
            // Without feed enable the axes stand at once [000:5352].
            site.chain.superimposed.stand();
            self.track.halt();
            self.track.hold(&mut site.axes, site.now.time_s);
            return;
        }
        if self.probe.is_on() {
            let probed = self.probe.moves(runs, site, measured);
            self.take_probed(probed, site);
            return;
        }
        let settled = self.is_in_position(site);
        let wear = Wear::of(site.tools, site.magazine).message();
        let drive = Driving {
            track: &self.track,
            progress: &self.progress,
            tapping: &self.tapping,
            element: self.element(),
            by_hand: self.is_operated_manually(site.exchange.nc()),
            stop_before: self.replacement.place(),
            settled,
            worn: wear.is_some(),
        }
        .drive(site);
        let cycle = self.track.path.cycle(&drive);
        self.track.set_speed(cycle.speed_mm_s);
        self.tapping.lead(cycle.lead, &mut site.spindle.drive);
        let wheels = site.now.wheels();
        self.track
            .follow(&cycle.position, &mut site.axes, site.chain, &wheels);
        let inch = self.source.inch();
        let q_transfer = &mut self.q_transfer;
        let outputs = &mut PathOutputs {
            site,
            q_transfer,
            inch,
        };
        self.track.output(outputs, settled);
        self.take_state(cycle.state, &drive, wear, site);
    }

    /// What the path came to in this cycle.
    fn take_state(&mut self, state: State, drive: &Drive, wear: Option<MessageId>, site: &mut Site) {
        let all_output = self.track.has_output_all() && site.handshakes.is_idle();
        let done = drive.in_position && all_output && self.restoration.is_over(&site.axes);
        match state {
            State::Gate(_) if all_output && !site.positioning.is_on() => {
                self.track.path.release();
                self.track.regain(&site.axes, site.chain);
            }
            State::Master if self.prepare_thread(site) == Preparation::Refused => {
                // No manual names the message of a spindle without analogue output or encoder (inferred).
                self.show(Message::Plain(MessageId::WrongRpm), site);
                let block = self.track.path.element().map_or(0, |element| element.sequence);
                self.abort(Resume::Block(block), site);
            }
            State::Clamped => self.track.ask_to_unclamp(drive.clamped, &mut site.axes),
            State::BlockEnd if drive.in_position && self.progress.goes_on() => {
                if let Some(message) = wear {
                    self.show(Message::Plain(message), site);
                }
                if self.replacement.is_here(&self.track, site) {
                    // What follows is given by the next preparation.
                } else if site.mode == Mode::SingleBlock || wear.is_some() {
                    self.progress.enter(RunState::BlockEnd);
                } else if !site.handshakes.inhibit_read_in() {
                    self.track.path.go_on();
                }
            }
            State::Stopped if done && !site.handshakes.inhibit_read_in() => self.take_stop(site),
            _ => {}
        }
    }

    /// The path waits for its spindle, whose loop the PLC may keep open (M2499).
    fn prepare_thread(&mut self, site: &mut Site) -> Preparation {
        let open = site.exchange.nc().bit(signal::OPEN_SPINDLE_LOOP);
        self.tapping.prepare(&self.track, open, &mut site.leading())
    }

    fn is_in_position(&self, site: &Site) -> bool {
        if self.track.path.is_coupled() {
            return self.tapping.is_in_position(&self.track, &site.standing());
        }
        site.axes.are_in_position()
    }

    /// The axes stand as far as the loops may be opened: those of a thread as far as they can.
    pub fn axes_stand(&self, site: &Site) -> bool {
        if self.track.path.is_coupled() {
            thread::stands(&self.track, &site.axes)
        } else {
            site.axes.stand()
        }
    }

    /// The path came to what the source said after it.
    fn take_stop(&mut self, site: &mut Site) {
        match self.track.path.take_stop() {
            None => {}
            Some(Stop::Barrier(Barrier::Stop { .. })) => self.progress.enter(RunState::Stopped),
            Some(Stop::Barrier(Barrier::Acknowledge { .. })) => {
                self.answer = Some(self.q_transfer.answer());
            }
            Some(Stop::Barrier(barrier)) if site.chain.superimposed.is_on() => {
                self.take_probed(Probed::beside_the_path(&barrier), site);
            }
            Some(Stop::Barrier(Barrier::Probe {
                block,
                from,
                to,
                feed_mm_min,
                ..
            })) => self.probe.begin(block, [from, to], feed_mm_min, site),
            Some(Stop::Barrier(Barrier::MeasureTool(order))) => {
                let probed = self.probe.measure(order, site);
                self.take_probed(probed, site);
            }
            Some(Stop::Barrier(Barrier::Scan { block, job })) => self.probe.scan(block, job, site),
            Some(Stop::End) if self.source.is_incomplete() => self.abort(Resume::Fault, site),
            Some(Stop::End) => self.end(site),
            Some(Stop::Error(fault)) => {
                self.show_fault(fault, site);
                self.abort(Resume::Fault, site);
            }
        }
    }

    /// A probing goes on, hands the touch to the program, or ends the run at its block with a message; the next
    /// start then probes again.
    fn take_probed(&mut self, probed: Probed, site: &mut Site) {
        match probed {
            Probed::Moves => {}
            Probed::Over(touch) => {
                let at = touch.map_or_else(|| site.here(), |touch| touch.position);
                self.track.path.set_position(at);
                self.track.forget_position();
                self.answer = Some(LiveData {
                    touch,
                    ..LiveData::default()
                });
            }
            Probed::Found(live) => {
                self.track.path.set_position(site.here());
                self.track.forget_position();
                self.answer = Some(live);
            }
            Probed::Refused(message, block) => {
                let sequence = self.source.reader().map_or(0, Reader::blocks_executed);
                site.messages.show(message, block);
                self.abort(Resume::Block(sequence), site);
            }
        }
    }

    /// Shows why the run cannot go on, at the block that is refused.
    fn show_fault(&mut self, fault: RunFault, site: &mut Site) {
        match fault {
            RunFault::Program(error) => self.show(Message::Program(error), site),
            RunFault::Limit {
                axis,
                direction,
                block,
                ..
            } => {
                let message = site.limit_message(axis, direction);
                site.messages.show(message, Some(block));
            }
            RunFault::Absent { axis, block, .. } => {
                let error = language::absent(axis, site.axes.at(axis), block, self.source.reader());
                self.show(Message::Program(Box::new(error)), site);
            }
        }
    }

    /// Q parameters that are not 0, by number.
    pub fn q_values(&self) -> Vec<(u16, f64)> {
        self.source.q_values(self.progress.has_ended())
    }

    /// A Q parameter at the block that is executed; without a run as the last one has left it.
    pub fn q_value(&self, number: u16) -> f64 {
        let executed = self.element().map(|element| element.sequence);
        self.source.q_value(number, self.progress.has_ended(), executed)
    }

    /// Transformations at the block that is executed, else those that are left; `None` while the program is handed over.
    pub fn frame(&self) -> Option<Frame> {
        let executed = self.element().map(|element| element.sequence);
        self.source.frame(self.progress.has_ended(), executed)
    }

    /// The PLC writes a Q parameter: for a program that runs with the next M, S or T strobe
    /// [000:11657-11663].
    pub fn set_q(&mut self, number: u16, value: f64) {
        if self.is_active() && self.source.is_of_control() {
            self.q_transfer.write(number, value);
        } else {
            self.source.set_q(number, value);
        }
    }

    /// Selects a program.
    pub fn select(&mut self, name: String, site: &mut Site, basis: &Basis) -> bool {
        let possible = !self.is_active();
        if possible {
            self.source.keep_q_values(self.progress.has_ended());
            self.source.cancel_status(basis.list, site);
            self.source.drip_feed = None;
            self.selection.program = Some(name);
            self.begin_at(0);
        }
        possible
    }

    /// The next run starts at a block.
    pub fn goto(&mut self, block: u32) -> bool {
        let possible = !self.is_active();
        if possible {
            self.source.keep_q_values(self.progress.has_ended());
            self.begin_at(block);
        }
        possible
    }

    /// The next start begins anew, not with the block of an interruption.
    fn begin_at(&mut self, block: u32) {
        self.selection.start_block = block;
        self.track.forget_feed();
        self.source.forget();
        self.progress.leave_fault();
    }

    /// The blocks of MDI.
    pub fn set_mdi(&mut self, blocks: String) -> bool {
        let possible = !self.is_active();
        if possible {
            self.selection.mdi = Some(blocks);
        }
        possible
    }

    /// The rest of the way of an axis in the block that is executed, mm or degrees.
    pub fn distance_to_go(&self, unit: &AxisUnit, chain: &Chain) -> f64 {
        let element = self.element();
        element.map_or(0.0, |element| distance_to_go(element, unit, chain))
    }
}
