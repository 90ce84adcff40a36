//! Program run: MDI, single block, full sequence; start, stop, internal stop, end.
//!
//! Decision: No program starts, and no block scan, before the axes that MP1340 names have passed their marks: KEY
//! NON-FUNCTIONAL; MDI does, without M91 and M92
//!
//! Decision: A block without path of its own (Q, labels) belongs to the next one in single block
//!
//! Decision: After the end of a program the tilted plane stays in force for the next start as shifts do; by hand 3D
//! ROT alone tilts
//!
//! Decision: A test run knows the axes of the whole machine, also those that another channel has now

use bahn_exchange::{Image, signal};
use bahn_kernel::reference::is_due;
use bahn_kernel::{
    AxisUnit, BrokenOff, Came, Chain, Demands, Feeder, Progress, RefusedBlock, Run, RunFault, RunState,
    ScanEnd, Started, Track, distance_to_go,
};
use bahn_motion::Stop;
use bahn_parameters::MessageId;
use bahn_parameters::operation::RestartParameters;
use bahn_path::{Barrier, BlockRef, Frame, LiveData};
use bahn_reader::Reader;
use bahn_servo::Measured;

use crate::command::Mode;
use crate::demands;
use crate::language::{self, OwnLanguage};
use crate::message::Message;
use crate::probing::{Probe, Probed};
use crate::programs::Selection;
use crate::q_transfer::QTransfer;
use crate::replacement::{Replacement, Wear};
use crate::site::{PathOutputs, Site};
use crate::source::{Basis, Resume, Source, machine_zero};

/// The program run of a channel.
#[derive(Clone)]
pub(crate) struct ProgramRun {
    pub selection: Selection,
    pub source: Source,
    pub core: Run,
    /// Probings, scans and measurements of tools that the program orders.
    pub probe: Probe,
    /// Q100 to Q107 as the PLC wrote them.
    q_transfer: QTransfer,
    /// Of a tool that is worn, under M101.
    replacement: Replacement,
}

impl ProgramRun {
    pub fn new(selection: Selection, source: Source, track: Track) -> ProgramRun {
        ProgramRun {
            selection,
            source,
            core: Run::new(track),
            probe: Probe::default(),
            q_transfer: QTransfer::default(),
            replacement: Replacement::default(),
        }
    }

    pub fn progress(&self) -> &Progress {
        self.core.progress()
    }

    pub fn is_active(&self) -> bool {
        self.progress().is_active()
    }

    /// The block that is executed, while a run is on.
    pub fn running_block(&self) -> Option<BlockRef> {
        self.core.element().map(|element| element.block)
    }

    /// Once in each contour cycle: what tapping tells the PLC, the axes and the spindle.
    pub fn follow_tapping(&mut self, site: &mut Site) {
        let taps = self.core.follow_tapping(&mut site.acting());
        site.exchange.nc_put(signal::TAPPING_CALLED, taps.called);
        site.exchange.nc_put(signal::RIGID_TAPPING_ACTIVE, taps.rigid);
    }

    /// Shows a message with the block that is executed.
    fn show(&self, message: Message, site: &mut Site) {
        let block = match &message {
            Message::Program(error) => Some(error.block),
            _ => self.running_block(),
        };
        site.messages.show(message, block);
    }

    /// NC start in an automatic mode.
    pub fn start(&mut self, site: &mut Site) {
        if self.core.restores() || site.positioning.is_on() {
            return;
        }
        if self.core.tapping.has_lost_spindle() || self.bars(site) {
            self.show(Message::Plain(MessageId::KeyNonFunctional), site);
            return;
        }
        let outputs = &mut PathOutputs::new(site, &mut self.q_transfer, self.source.inch());
        if self.core.start(outputs) == Started::LedOut {
            site.exchange.nc_put(signal::MANUAL_OPERATION_PRESSED, false);
        }
    }

    /// No program is begun, nor goes on, before the axes that MP1340 names have passed their reference marks: until then no
    /// software limit holds and no datum is known [000:4563-4575] [001:953]. What MDI positions may do without, but for M91 and
    /// M92. What the control says then no manual prints (inferred).
    fn bars(&self, site: &Site) -> bool {
        site.mode != Mode::Mdi && !self.progress().is_running() && is_due(site.axes.iter())
    }

    /// NC stop, or anything that stops like it.
    pub fn stop(&mut self) {
        self.core.stop();
    }

    /// INTERNAL STOP: the interrupted run is broken off; the next start begins with its block.
    pub fn internal_stop(&mut self, site: &mut Site) -> bool {
        let next = self.source.feeder().map(Feeder::next_sequence);
        let resume = match self.core.give_up(next, self.probe.is_on(), &site.acting()) {
            BrokenOff::Refused => return false,
            BrokenOff::Before => return true,
            BrokenOff::At(resume) => resume,
        };
        self.source.resume_at(resume.map(Resume::Block));
        self.break_off(site);
        true
    }

    /// Ends what is on its way for the run.
    fn break_off(&mut self, site: &mut Site) {
        self.core.break_off(&mut site.acting());
        self.source.break_off(site.mode == Mode::Mdi);
        site.handshakes.abort(site.exchange);
        self.probe.end(site);
        site.tools.take_back(&mut site.chain.offsets);
        site.positioning.end_all(site.exchange);
        site.exchange.nc_put(signal::MANUAL_OPERATION_PRESSED, false);
        site.exchange.nc_put(signal::BLOCK_SCAN_ACTIVE, false);
    }

    /// A fault interrupts the run [003:1578]; the next start begins with the block that was not executed.
    fn abort(&mut self, resume: Resume, site: &mut Site) {
        self.core.track.path.clear();
        self.source.resume_at(Some(resume));
        self.break_off(site);
        if site.mode != Mode::Mdi {
            self.core.fail();
        }
    }

    /// What the block at the gate of the path asks for is refused: the run ends before it. `false` when it is
    /// only to be stopped.
    pub fn refuse_block(&mut self, site: &mut Site) -> bool {
        let Some(sequence) = self.core.refusable(&site.axes) else {
            return false;
        };
        self.abort(Resume::Block(sequence), site);
        true
    }

    /// END PGM, M2 or M30.
    fn end(&mut self, site: &mut Site) {
        self.source.end();
        self.break_off(site);
        self.core.end();
        if site.mode != Mode::Mdi {
            self.source.resume_at(None);
            self.selection.start_block = 0;
            site.exchange.nc_put(signal::PROGRAM_END_EXECUTED, true);
        }
    }

    /// What is to be done once a run is over, outside the cycle.
    pub fn close(&mut self, site: &mut Site, basis: &Basis) {
        let (track, q_transfer) = (&mut self.core.track, &mut self.q_transfer);
        let closed = self.source.close(|| {
            track.path.clear();
            q_transfer.take_all()
        });
        if closed && site.chain.placement().is_some() {
            // By hand 3D ROT alone tilts.
            site.chain.place(None);
            self.core.track.begin_at(site.here(), site.chain);
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
        let allowed = self.core.allowed(site.now.us);
        let source = &mut self.source;
        let mdi = site.mode == Mode::Mdi;
        if self
            .core
            .takes_begin(|| site.axes.rest() && source.may_begin(mdi))
        {
            self.begin(site, basis);
        }
        self.core.track.reserve();
        if !self.is_active() && site.handshakes.is_idle() {
            site.call_inserted_tool();
        }
        self.replacement
            .prepare(self.source.feeder_mut(), &mut self.core.track, site);
        let reads = self.progress().is_on_its_way() && !self.core.scans();
        let Some(feeder) = self.source.feeder_mut().filter(|_| reads) else {
            return;
        };
        let zero = machine_zero(&site.axes, site.chain);
        let wear = Wear::of(site.tools, site.magazine);
        let (worn, mut inserted) = (site.tools.number, site.tools.inserted_call.take());
        self.core
            .prepare(feeder, allowed, zero, &site.acting(), |feeder, probed| {
                if let Some(call) = inserted.take() {
                    feeder.insert(&call);
                } else if let Wear::Replace(tool) = wear
                    && !probed
                {
                    feeder.replace_tool(worn, tool);
                }
            });
        site.tools.inserted_call = inserted;
    }

    fn begin(&mut self, site: &mut Site, basis: &Basis) {
        let mdi = site.mode == Mode::Mdi;
        site.exchange.nc_put(signal::PROGRAM_END_EXECUTED, false);
        self.core.begin();
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
        self.core.set_off(&site.acting());
    }

    /// RESTORE AT N: scans to a block. A program that cannot begin is said as at NC start.
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
        if !self.source.may_begin(mdi) {
            return false;
        }
        let opened = match self.source.open(mdi, &self.selection, site, basis) {
            Ok(opened) => opened,
            Err(message) => {
                self.show(message, site);
                return true;
            }
        };
        // The scan starts at the cursor, or with MP7680 bit 5 at the begin of the program.
        if rules.from_start {
            self.selection.start_block = 0;
        }
        let start = if mdi { 0 } else { self.selection.start_block };
        site.chain.place(None);
        let feeder = self.source.feeder_for_run(opened, start, site, basis);
        self.source.put(feeder);
        self.core.scan(block);
        site.exchange.nc_put(signal::BLOCK_SCAN_ACTIVE, true);
        true
    }

    /// Takes what has come of the program, and goes on with a scan; may allocate.
    pub fn read_on(&mut self, rules: &RestartParameters, site: &mut Site) {
        self.source.grow();
        let waits = self.progress().is_on_its_way() && self.core.track.path.element().is_none();
        if waits && self.source.is_stuck() {
            self.show(Message::Plain(MessageId::ProgramMemoryOverflow), site);
            self.abort(Resume::Fault, site);
        }
        let inch = self.source.inch();
        let Some(feeder) = self.source.feeder_mut().filter(|_| self.core.scans()) else {
            return;
        };
        let outputs = &mut PathOutputs::new(site, &mut self.q_transfer, inch);
        match self.core.scan_on(feeder, rules, outputs) {
            None => return,
            Some(ScanEnd::NotAddressed) => {
                self.show(Message::Plain(MessageId::SelectedBlockNotAddressed), site);
            }
            Some(ScanEnd::Fault(fault)) => self.show_fault(fault, site),
            Some(ScanEnd::Refused(refused)) => {
                self.show_refused(refused, site);
                self.internal_stop(site);
                // Tool and datum are as before it: nothing after it is executed with those of the block.
                self.source.resume_at(Some(Resume::Block(refused.sequence)));
                return;
            }
        }
        self.internal_stop(site);
    }

    /// MANUAL OPERATION while a run is interrupted.
    pub fn manual_operation(&mut self, rules: &RestartParameters, site: &mut Site) -> bool {
        let probed = self.probe.is_on();
        let possible = self
            .core
            .leave_path(rules.return_to_contour, probed, &mut site.axes);
        if possible {
            site.exchange.nc_put(signal::MANUAL_OPERATION_PRESSED, true);
        }
        possible
    }

    /// Whether the operator may move axes while a run is interrupted.
    pub fn is_operated_manually(&self, nc: &Image) -> bool {
        self.progress().state() == RunState::Interrupted && nc.bit(signal::MANUAL_OPERATION_PRESSED)
    }

    /// RESTORE POSITION: the axes may return to the contour. Whether they may.
    pub fn restore_position(&mut self, site: &mut Site) -> bool {
        let may = self.is_operated_manually(site.exchange.nc());
        let armed = self.core.restore(may, &mut site.acting());
        if armed {
            let exchange = &mut *site.exchange;
            exchange.nc_put(signal::MANUAL_OPERATION_PRESSED, false);
            exchange.nc_put(signal::BLOCK_SCAN_ACTIVE, false);
            exchange.nc_put(signal::RESTORE_POSITION_ACTIVE, true);
        }
        armed
    }

    /// Moves the axes back to the contour for a cycle, when that is what is to be done.
    pub fn move_back(&mut self, site: &mut Site) {
        let inch = self.source.inch();
        let outputs = &mut PathOutputs::new(site, &mut self.q_transfer, inch);
        if self.core.move_back(self.source.feeder_mut(), outputs) {
            site.exchange.nc_put(signal::RESTORE_POSITION_ACTIVE, false);
        }
    }

    /// Moves the axes along the path for a cycle.
    pub fn moves(&mut self, site: &mut Site, measured: &Measured) {
        let probe = &mut self.probe;
        if !self.core.may_move(|axes| probe.is_held(axes), &mut site.acting()) {
            return;
        }
        if self.probe.is_on() {
            let probed = self.probe.moves(self.core.progress().goes_on(), site, measured);
            self.take_probed(probed, site);
            return;
        }
        let wear = Wear::of(site.tools, site.magazine).message();
        let by_hand = self.is_operated_manually(site.exchange.nc());
        let demands = demands::of(site, self.replacement.place(), wear.is_some(), by_hand);
        let outputs = &mut PathOutputs::new(site, &mut self.q_transfer, self.source.inch());
        match self.core.moves(&demands, outputs) {
            Came::On => {}
            Came::BlockEnd => self.end_block(&demands, wear, site),
            Came::NoThread => {
                // No manual names the message of a spindle without analogue output or encoder (inferred).
                self.show(Message::Plain(MessageId::WrongRpm), site);
                let block = self.core.track.path.element();
                self.abort(Resume::Block(block.map_or(0, |element| element.sequence)), site);
            }
            Came::Refused(refused) => {
                self.show_refused(refused, site);
                self.abort(Resume::Block(refused.sequence), site);
            }
            Came::Stop(stop) => self.take_stop(stop, site),
        }
    }

    /// A block is over: a worn tool is said or replaced, in SINGLE BLOCK the run waits for NC start.
    fn end_block(&mut self, demands: &Demands, wear: Option<MessageId>, site: &mut Site) {
        if let Some(message) = wear {
            self.show(Message::Plain(message), site);
        }
        // What follows a replacement is given by the next preparation.
        if !self.replacement.is_here(&self.core.track, site) {
            self.core
                .end_block(demands.single_block, demands.read_in_inhibited);
        }
    }

    /// The axes stand as far as the loops may be opened: those of a thread as far as they can.
    pub fn axes_stand(&self, site: &Site) -> bool {
        self.core.axes_stand(&site.axes)
    }

    /// The path came to what the source said after it.
    fn take_stop(&mut self, stop: Stop<RunFault>, site: &mut Site) {
        match stop {
            Stop::Barrier(barrier) if site.chain.superimposed.is_on() => {
                self.take_probed(Probed::beside_the_path(&barrier), site);
            }
            Stop::Barrier(Barrier::Probe {
                block,
                from,
                to,
                feed_mm_min,
                ..
            }) => self.probe.begin(block, [from, to], feed_mm_min, site),
            Stop::Barrier(Barrier::MeasureTool(order)) => {
                let probed = self.probe.measure(order, site);
                self.take_probed(probed, site);
            }
            Stop::Barrier(Barrier::Scan { block, job }) => self.probe.scan(block, job, site),
            // The run has answered these itself.
            Stop::Barrier(Barrier::Stop { .. } | Barrier::Acknowledge { .. }) => {}
            Stop::End if self.source.is_incomplete() => self.abort(Resume::Fault, site),
            Stop::End => self.end(site),
            Stop::Error(fault) => {
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
                let answer = LiveData {
                    touch,
                    ..LiveData::default()
                };
                self.core.go_on_with(answer, at);
            }
            Probed::Found(live) => self.core.go_on_with(live, site.here()),
            Probed::Refused(message, block) => {
                let sequence = self.source.reader().map_or(0, Reader::blocks_executed);
                site.messages.show(message, block);
                self.abort(Resume::Block(sequence), site);
            }
        }
    }

    /// A function of a block was refused: shows why.
    fn show_refused(&self, refused: RefusedBlock, site: &mut Site) {
        if site.spindle.take_wrong_speed() {
            let message = Message::Plain(MessageId::WrongRpm);
            site.messages.show(message, Some(refused.block));
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
        self.source.q_values(self.progress().has_ended())
    }

    /// A Q parameter at the block that is executed; without a run as the last one has left it.
    pub fn q_value(&self, number: u16) -> f64 {
        let executed = self.core.element().map(|element| element.sequence);
        self.source.q_value(number, self.progress().has_ended(), executed)
    }

    /// Transformations at the block that is executed, else those that are left; `None` while the program is handed over.
    pub fn frame(&self) -> Option<Frame> {
        let executed = self.core.element().map(|element| element.sequence);
        self.source.frame(self.progress().has_ended(), executed)
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

    /// Selects the program of the automatic modes; `false` while a run is active.
    pub fn select(&mut self, name: String, site: &mut Site, basis: &Basis) -> bool {
        let possible = !self.is_active();
        if possible {
            self.source.keep_q_values(self.progress().has_ended());
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
            self.source.keep_q_values(self.progress().has_ended());
            self.begin_at(block);
        }
        possible
    }

    /// The next start begins anew, not with the block of an interruption.
    fn begin_at(&mut self, block: u32) {
        self.selection.start_block = block;
        self.core.forget();
        self.source.forget();
    }

    /// Sets the blocks that MDI executes; `false` while a run is active.
    pub fn set_mdi(&mut self, blocks: String) -> bool {
        let possible = !self.is_active();
        if possible {
            self.selection.mdi = Some(blocks);
        }
        possible
    }

    /// Distance that an axis has to go in the block that is executed, mm or degrees.
    pub fn distance_to_go(&self, unit: &AxisUnit, chain: &Chain) -> f64 {
        let element = self.core.element();
        element.map_or(0.0, |element| distance_to_go(element, unit, chain))
    }
}
