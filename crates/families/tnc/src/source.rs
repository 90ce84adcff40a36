//! Where the blocks of a run come from: the program that is read, the one that MDI has set aside, where a
//! run that was broken off goes on, what is in force between runs.
//!
//! Decision: After the end of a program transformations, feed and tool data stay in force for the next start until
//! MP7300 cancels them; a tool without its data stays in the spindle, and a block of MDI is no program
//!
//! Decision: Text of a transferred program comes by commands, so that logs and sessions repeat it; the next
//! preparation gives the interpreter a longer version, in batches while it has enough to do (also
//! `interpreter/src/drip_feed.rs`)
//!
//! Decision: After INTERNAL STOP and a fault the current block is that with which NC start goes on; arrows and GOTO
//! count in the main program, so that out of a called one GOTO alone leads (also `panel/src/pages/run.rs`)

use std::sync::Arc;

use bahn_exchange::{Bit, signal};
use bahn_interpreter::{DripFeed, Interpreter, Rules, Settings, Status};
use bahn_kernel::{Chain, Feeder, OwnAxes};
use bahn_parameters::own_functions::OwnFunctions;
use bahn_parameters::{ControlModel, InchFeed, MessageId, ParameterList};
use bahn_path::{AxisSet, BlockRef, Frame, PerAxis, Plane, Position, Sense};
use bahn_program::Program;
use bahn_reader::{Programs, Reader, Start};
use bahn_servo::Rotation;

use crate::beside::Loan;
use crate::language::{self, OwnLanguage};
use crate::manual_probing::ManualProbing;
use crate::message::Message;
use crate::plc_link::PlcLink;
use crate::programs::{Opened, Selection};
use crate::setup::Checking;
use crate::site::Site;

/// Blocks that take no time after which a program is taken for an endless loop (inferred): at 4 ms for a
/// block the control would have stood for 400 s.
const BLOCKS_WITHOUT_MOTION: u64 = 100_000;

/// What programs find of the machine: machine parameters, texts and datum tables.
pub(crate) struct Basis<'a> {
    pub list: &'a ParameterList,
    /// What was calibrated and measured by hand.
    pub touch: &'a ManualProbing,
    pub link: &'a PlcLink,
}

/// How programs are read.
#[derive(Clone)]
pub(crate) struct Reading {
    pub model: ControlModel,
    pub checking: Checking,
    /// What F counts in a program in inches, when that is not what it counts on the model.
    pub inch_feed: Option<InchFeed>,
    pub functions: OwnFunctions,
    pub programs: Arc<dyn Programs>,
}

impl Reading {
    /// What a program in another language begins with.
    pub fn begin(&self, site: &Site, basis: &Basis) -> Start {
        // Which axes its channel has the feeder knows.
        Start::of(basis.list, self.functions.clone(), AxisSet::EMPTY, site.upright())
    }
}

/// Where a run goes on that was broken off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Resume {
    /// At a block, by its place in the order of execution.
    Block(u64),
    /// At the block that could not be executed.
    Fault,
}

/// The source of a run.
#[derive(Clone)]
pub(crate) struct Source {
    pub reading: Reading,
    feeder: Option<Feeder>,
    /// The program that runs is read elsewhere: it is not here.
    loan: Option<Loan>,
    /// Loans so far: the number of the last one.
    loans: u64,
    /// Programs are read beside the control.
    beside: bool,
    /// The program whose run was interrupted, while blocks of MDI run.
    aside: Option<(Option<Feeder>, Option<Resume>)>,
    /// Blocks of MDI have run: back to the program.
    mdi_over: bool,
    /// After an internal stop or a fault: where the next start goes on.
    resume_from: Option<Resume>,
    /// What the last run left in force.
    status: Status,
    /// 3D ROT for program run: the machine positions of the swivel axes, degrees. What MP7300 cancels leaves it; cycle 19 goes
    /// over it.
    plane: Option<Position>,
    /// Q parameters between runs.
    q: Vec<(u16, f64)>,
    /// The run has ended: its Q parameters are to be kept.
    q_due: bool,
    /// Keep the executed elements.
    pub tap: bool,
    /// Long computations are done beside.
    pub defers: bool,
    /// What has come of a program that is executed while it is transferred.
    pub drip_feed: Option<DripFeed>,
}

impl Source {
    pub fn new(reading: Reading, q: Vec<(u16, f64)>) -> Source {
        Source {
            reading,
            feeder: None,
            loan: None,
            loans: 0,
            beside: false,
            aside: None,
            mdi_over: false,
            resume_from: None,
            status: Status::default(),
            plane: None,
            q,
            q_due: false,
            tap: false,
            defers: false,
            drip_feed: None,
        }
    }

    /// The program that runs, or ran last; `None` while it is handed over.
    pub fn feeder(&self) -> Option<&Feeder> {
        self.feeder.as_ref()
    }

    /// The program that runs, or ran last; `None` while it is handed over.
    pub fn feeder_mut(&mut self) -> Option<&mut Feeder> {
        self.feeder.as_mut()
    }

    /// Another program is read from now on.
    pub fn put(&mut self, mut feeder: Feeder) {
        feeder.read_beside(self.beside);
        self.feeder = Some(feeder);
    }

    /// Programs are read beside the control from now on, or no more.
    pub fn read_beside(&mut self, on: bool) {
        self.beside = on;
        let aside = self.aside.as_mut().and_then(|(feeder, _)| feeder.as_mut());
        for feeder in self.feeder.iter_mut().chain(aside) {
            feeder.read_beside(on);
        }
    }

    /// The program, to be read elsewhere, and the number of the loan; `None` when there is nothing to read.
    pub fn hand_over_program(&mut self) -> Option<(Feeder, u64)> {
        let feeder = self.feeder.take_if(|feeder| feeder.wants_reading())?;
        self.loans += 1;
        self.loan = Some(Loan::new(self.loans, &feeder));
        Some((feeder, self.loans))
    }

    /// The program is back. One that nobody waits for any more is dropped.
    pub fn end_loan(&mut self, mut feeder: Feeder, loan: u64) {
        if let Some(loan) = self.loan.take_if(|current| current.number == loan) {
            loan.settle(&mut feeder);
            self.put(feeder);
        }
    }

    /// The program is read elsewhere.
    pub fn is_handed_over(&self) -> bool {
        self.loan.is_some()
    }

    /// The rules of machine parameters, for the blocks that are read from now on.
    pub fn set_rules(&mut self, rules: Rules) {
        if let Some(loan) = &mut self.loan {
            loan.rules = Some(rules);
        } else if let Some(feeder) = &mut self.feeder {
            feeder.set_rules(rules);
        }
    }

    /// The program that runs is in inches.
    pub fn inch(&self) -> bool {
        match &self.loan {
            Some(loan) => loan.inch,
            None => self.feeder.as_ref().is_some_and(Feeder::inch),
        }
    }

    pub fn reader(&self) -> Option<&dyn Reader> {
        self.feeder.as_ref().map(Feeder::reader)
    }

    pub fn reader_mut(&mut self) -> Option<&mut dyn Reader> {
        self.feeder.as_mut().map(Feeder::reader_mut)
    }

    /// The program that runs is in a language of the control: it has Q parameters, which it takes where it waits for the PLC,
    /// and tools.
    pub fn is_of_control(&self) -> bool {
        match &self.loan {
            Some(loan) => loan.of_control,
            None => self.interpreter().is_some(),
        }
    }

    pub fn interpreter(&self) -> Option<&Interpreter> {
        self.feeder.as_ref().and_then(Feeder::interpreter)
    }

    pub fn interpreter_mut(&mut self) -> Option<&mut Interpreter> {
        self.feeder.as_mut().and_then(Feeder::interpreter_mut)
    }

    /// The program that runs is one that is transferred.
    fn is_transferred(&self) -> bool {
        self.interpreter().is_some_and(Interpreter::is_transferred)
    }

    /// Gives the interpreter what has come of the program.
    pub fn grow(&mut self) {
        let (Some(drip_feed), Some(feeder)) = (&mut self.drip_feed, &mut self.feeder) else {
            return;
        };
        if let Some(interpreter) = feeder.interpreter_mut()
            && interpreter.is_transferred()
        {
            let at = interpreter.at();
            // In a called program nothing of this one is read.
            let read = if at.program == 0 { at.block } else { 0 };
            let needed = interpreter.needs_from();
            if let Some(program) = drip_feed.grow(needed, read, interpreter.is_starved()) {
                interpreter.grow(program);
            }
        }
    }

    /// The program that runs needs text for which its memory has no room.
    pub fn is_stuck(&self) -> bool {
        self.is_transferred() && self.drip_feed.as_ref().is_some_and(DripFeed::is_stuck)
    }

    /// The program that runs ends where its transfer was broken off.
    pub fn is_incomplete(&self) -> bool {
        self.is_transferred() && self.drip_feed.as_ref().is_some_and(DripFeed::is_incomplete)
    }

    /// The program that the next run is to execute is there.
    pub fn may_begin(&mut self, mdi: bool) -> bool {
        mdi || self.feeder.is_some() || self.drip_feed.as_mut().is_none_or(DripFeed::is_ready)
    }

    /// Where the next start goes on; `None` for at the start block.
    pub fn resume_at(&mut self, resume: Option<Resume>) {
        self.resume_from = resume;
    }

    /// The block with which the next start goes on or begins; `None` while the program is handed over.
    pub fn next_start(&self, begin: u32) -> Option<BlockRef> {
        let begin = BlockRef {
            program: 0,
            block: begin,
        };
        let Some(resume) = self.resume_from else {
            return Some(begin);
        };
        let feeder = self.feeder.as_ref()?;
        Some(match resume {
            Resume::Block(sequence) => feeder.block_at(sequence),
            Resume::Fault => feeder.block_of_fault(),
        })
    }

    /// The next run begins anew.
    pub fn forget(&mut self) {
        self.feeder = None;
        self.loan = None;
        self.resume_from = None;
    }

    /// A run is broken off, of MDI or of a program.
    pub fn break_off(&mut self, mdi: bool) {
        self.mdi_over = mdi;
        if let Some(loan) = &mut self.loan {
            loan.broken_off = true;
        }
        if let Some(interpreter) = self.interpreter_mut() {
            interpreter.give_up_work();
        }
    }

    /// Sets the program aside for blocks of MDI.
    pub fn set_aside(&mut self) {
        if self.aside.is_none() {
            self.aside = Some((self.feeder.take(), self.resume_from.take()));
        }
    }

    /// Goes back to where the run was broken off, when it was.
    pub fn go_on(&mut self, site: &Site) -> bool {
        let (Some(resume), Some(feeder)) = (self.resume_from.take(), &mut self.feeder) else {
            return false;
        };
        let (machine, limits) = (site.axes.programmed_position(), site.axes.traverse_box());
        match resume {
            Resume::Block(sequence) => feeder.return_to(sequence, &machine, site.chain, limits),
            Resume::Fault => feeder.retry(&machine, site.chain, limits),
        }
        true
    }

    /// The run has come to its end: its Q parameters are to be kept.
    pub fn end(&mut self) {
        self.q_due = true;
    }

    /// The run that has ended is closed, outside the cycle: its Q parameters, with those that the PLC wrote
    /// meanwhile, and what it left in force are kept. Whether there was one.
    pub fn close(&mut self, by_plc: impl FnOnce() -> Vec<(u16, f64)>) -> bool {
        let due = self.q_due;
        if due {
            self.q = self.q_values(true);
            self.q_due = false;
            for (number, value) in by_plc() {
                self.keep_q(number, value);
            }
            if let Some(interpreter) = self.interpreter() {
                self.status = interpreter.status();
                self.plane = self.plane.and(self.status.plane_angles());
            }
        }
        due
    }

    /// It was a block of MDI that has run: no program that comes to its end (inferred).
    pub fn was_mdi(&self) -> bool {
        self.mdi_over
    }

    /// Why nothing is probed by hand: a transformation stays in force after the end of the program.
    pub fn bars_probing(&self) -> Option<MessageId> {
        self.status.bars_probing()
    }

    /// The program that MDI has set aside is back, once the blocks of MDI have run.
    pub fn take_back(&mut self) {
        if std::mem::take(&mut self.mdi_over)
            && let Some((feeder, resume)) = self.aside.take()
        {
            self.feeder = feeder;
            self.resume_from = resume;
        }
    }

    /// Cancels what MP7300 names [000:6589-6601]. The tool stays in the spindle, without its data.
    pub fn cancel_status(&mut self, list: &ParameterList, site: &mut Site) {
        let clearing = list.program_end_clearing();
        if clearing.q_parameters {
            self.q.clear();
        }
        if clearing.status {
            self.status.cancel_programmed();
        }
        if clearing.tool {
            self.status.cancel_tool();
            site.tools.forget_length(&mut site.chain.offsets);
        }
    }

    /// Q parameters that are not 0, by number. After the end of a run they are those that its end has left.
    pub fn q_values(&self, ended: bool) -> Vec<(u16, f64)> {
        let over = ended && !self.q_due;
        let Some(interpreter) = self.interpreter().filter(|_| !over) else {
            return self.q.clone();
        };
        (0u16..)
            .zip(interpreter.q_values())
            .filter(|(_, value)| **value != 0.0)
            .map(|(number, value)| (number, *value))
            .collect()
    }

    /// A Q parameter, as it was before the block of a sequence or where the interpreter is.
    pub fn q_value(&self, number: u16, ended: bool, sequence: Option<u64>) -> f64 {
        let over = ended && !self.q_due;
        match (self.interpreter().filter(|_| !over), sequence) {
            (Some(interpreter), Some(sequence)) => interpreter.q_value_at(number, sequence),
            (Some(interpreter), None) => interpreter.q_value(number),
            (None, _) => {
                let known = self.q.iter().find(|(known, _)| *known == number);
                known.map_or(0.0, |(_, value)| *value)
            }
        }
    }

    /// The machine positions of the swivel axes in whose plane the next program begins, degrees; during a run as it began.
    pub fn plane(&self) -> Option<Position> {
        self.status.plane_angles().or(self.plane)
    }

    /// 3D ROT for program run: the next program begins in the plane of these positions of the swivel axes, or upright.
    /// `false` while one can still go on, and where transformations are in force that begin after the plane only.
    pub fn tilt(&mut self, angles: Option<Position>) -> bool {
        let done = self.resume_from.is_none() && !self.q_due && self.status.tilt(None);
        if done {
            self.plane = angles;
        }
        done
    }

    /// The transformations before the block of a sequence, else where a run that was broken off goes on or the interpreter is,
    /// else as the last run has left them; `None` while the program is handed over.
    pub fn frame(&self, ended: bool, sequence: Option<u64>) -> Option<Frame> {
        if self.is_handed_over() {
            return None;
        }
        let broken_off = match self.resume_from {
            Some(Resume::Block(sequence)) => Some(sequence),
            _ => None,
        };
        let over = ended && !self.q_due;
        Some(match self.feeder.as_ref().filter(|_| !over) {
            None => self.status.frame(),
            // Programs in other languages transform nothing.
            Some(feeder) => feeder.interpreter().map_or_else(
                || Frame::identity(Plane::XY),
                |interpreter| interpreter.frame_at(sequence.or(broken_off)),
            ),
        })
    }

    /// Keeps the Q parameters of the run for the next one.
    pub fn keep_q_values(&mut self, ended: bool) {
        self.q = self.q_values(ended);
    }

    /// Sets a Q parameter between runs.
    pub fn set_q(&mut self, number: u16, value: f64) {
        if let Some(loan) = &mut self.loan {
            loan.q.push((number, value));
        }
        if let Some(interpreter) = self.interpreter_mut() {
            interpreter.set_q(number, value);
        }
        self.keep_q(number, value);
    }

    fn keep_q(&mut self, number: u16, value: f64) {
        self.q.retain(|(known, _)| *known != number);
        self.q.push((number, value));
    }

    /// The program of the next run.
    ///
    /// # Errors
    /// The message why there is none, or why it cannot begin in the plane that is in force.
    pub fn open(
        &self,
        mdi: bool,
        selection: &Selection,
        site: &Site,
        basis: &Basis,
    ) -> Result<Opened, Message> {
        if let Some(feed) = self.drip_feed.as_ref().filter(|_| !mdi) {
            let program = feed.open(selection.start_block).map_err(Message::Plain)?;
            return Ok(Opened::Program(program));
        }
        let reading = &self.reading;
        let opened = selection.open(mdi, &*reading.programs, || reading.begin(site, basis))?;
        match &opened {
            Opened::Reader(reader) if self.plane().is_some() => {
                let error = language::without_planes(selection.start_block, &**reader);
                Err(Message::Program(Box::new(error)))
            }
            _ => Ok(opened),
        }
    }

    /// A feeder for TEST RUN of a program, which finds nothing in force when it is selected.
    /// The axes are those of the machine: nobody hands one over meanwhile.
    ///
    /// # Errors
    /// The message why there is none.
    pub fn feeder_for_test(
        &self,
        name: &str,
        axes: AxisSet,
        site: &Site,
        basis: &Basis,
    ) -> Result<Feeder, Message> {
        let reading = &self.reading;
        let opened = Opened::of(name, &*reading.programs, || reading.begin(site, basis))?;
        let mut feeder = self.feeder_from(opened, Status::default(), site, basis);
        feeder.expect_axes(axes);
        Ok(feeder)
    }

    /// A feeder of a program that is to run, from a block on, with what the last run left in force.
    pub fn feeder_for_run(&self, opened: Opened, block: u32, site: &Site, basis: &Basis) -> Feeder {
        let mut status = self.status.clone();
        if status.plane_angles().is_none() && self.plane.is_some() {
            status.tilt(self.plane);
        }
        if status.tool() != Some(site.tools.number) {
            status.cancel_tool();
        }
        let spindle = site.spindle.state();
        let sense = match spindle.rotation {
            Rotation::M3 => Some(Sense::Clockwise),
            Rotation::M4 => Some(Sense::CounterClockwise),
            Rotation::M5 => None,
        };
        status.take_spindle(sense, spindle.programmed_rpm);
        let mut feeder = self.feeder_from(opened, status, site, basis);
        if block > 0 {
            feeder.reader_mut().goto(block);
        }
        feeder.set_tap(self.tap);
        feeder
    }

    /// A feeder of a program with what is in force before it.
    pub fn feeder_from(&self, opened: Opened, status: Status, site: &Site, basis: &Basis) -> Feeder {
        let limits = (site.axes.traverse_box(), site.axes.programmable());
        let reader: Box<dyn Reader> = match opened {
            Opened::Reader(reader) => reader,
            Opened::Program(program) => Box::new(self.interpreter_of(program, status, site, basis)),
        };
        Feeder::new(reader, site.chain.upright(), limits)
    }

    /// The interpreter of a program with what is in force before it.
    fn interpreter_of(
        &self,
        program: Arc<Program>,
        status: Status,
        site: &Site,
        basis: &Basis,
    ) -> Interpreter {
        let mut rules = basis.touch.calibrated(Rules::of(basis.list));
        rules.machine_zero = machine_zero(&site.axes, site.chain);
        let settings = Settings {
            model: self.reading.model,
            rules,
            texts: basis.link.machine_texts().clone(),
            tools: site.magazine.shapes(),
            barred_tools: site.magazine.barred(),
            inhibited_oem_cycles: inhibited_oem_cycles(site),
            datum_table: basis.link.datums(basis.list),
            strict: self.reading.checking.strict,
            skip_unknown: self.reading.checking.skip_unknown,
            q_values: self.q.clone(),
            start: site.upright(),
            tool_length_mm: Some(site.chain.offsets.tool_length),
            status,
            basic_rotation: basis.touch.basic_rotation(site.chain.offsets.tool_axis),
            machine: true,
            transferred: self.drip_feed.as_ref().is_some_and(|feed| feed.brings(&program)),
            max_blocks_without_motion: BLOCKS_WITHOUT_MOTION,
            inch_feed: self.reading.inch_feed,
            functions: self.reading.functions.clone(),
            ..Settings::default()
        };
        let called = Arc::clone(&self.reading.programs);
        let mut interpreter = Interpreter::new(program, settings, called);
        if self.defers {
            interpreter.defer_work();
        }
        interpreter
    }
}

/// M2240 to M2271: the PLC inhibits cycles of the machine builder in the EPROM, when the program starts (inferred)
/// [000:17812-17821].
fn inhibited_oem_cycles(site: &Site) -> u32 {
    let first = signal::OEM_CYCLE_68_INHIBITED;
    (0..32u16)
        .filter_map(|cycle| Some((cycle, Bit::new(first.area(), first.number() + cycle)?)))
        .filter(|(_, bit)| site.exchange.nc().bit(*bit))
        .fold(0, |bits, (cycle, _)| bits | 1 << cycle)
}

/// Blocks that are read from now on find other tools, or other datums in the tables.
pub(crate) fn renew(interpreter: &mut Interpreter, [tools, datums]: [bool; 2], site: &Site, basis: &Basis) {
    if tools {
        interpreter.set_tools(site.magazine.shapes(), site.magazine.barred());
    }
    if datums {
        interpreter.set_datum_table(basis.link.datums(basis.list));
    }
}

/// Machine zero in workpiece coordinates; unknown for axes that have not passed their reference mark
/// [000:4568-4576].
pub(crate) fn machine_zero(axes: &OwnAxes, chain: &Chain) -> Position {
    let mut zero: Position = PerAxis::from_fn(|axis| -chain.offsets.datum[axis]).into();
    for unit in axes.iter().filter(|unit| !unit.referenced && !unit.is_plc_axis()) {
        zero[unit.axis] = f64::NAN;
    }
    zero
}
