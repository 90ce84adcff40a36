//! One program run to its end: nothing is printed here, so that many can run side by side.

use bahn_reader::{ProgramError, Reader, Start};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_interpreter::{AbsentAxes, Interpreter, Settings};
use bahn_interpreter900::Reader900;
use bahn_motion::{AuxiliaryTimes, Limits, PlannedStep, Planner};
use bahn_nc::NcReader;
use bahn_parameters::{ControlModel, MessageId, ParameterList};
use bahn_path::{Barrier, BlockRef, LiveData, PathElement, Position, ScanJob};
use bahn_program::{Operation, Program};
use bahn_viewer::Recording;
use bahn_workpiece::{Columns, Cutting, Memory, Part};

use super::digitizing::digitize;
use super::outputs::Outputs;
use super::survey::Survey;
use super::system900::System900;
use crate::ReportError;
use crate::block_time::BlockTime;
use crate::follower::Follower;
use crate::record::{End, ErrorReport, Notice, Place, Record, Report};
use crate::stop::Stop;
use bahn_host::files::{self, Loaded};

/// Why a System 900 does not run a program.
const FOREIGN: &str = "this machine has a System 900, which runs programs in its own language: NAME.900";

/// What programs run on: model, machine parameters, tools.
pub struct Bench {
    /// The machine parameters under which programs run.
    pub list: ParameterList,
    /// How programs are interpreted.
    pub settings: Settings,
    /// What the axes can do.
    pub limits: Limits,
    /// Times of what is no movement.
    pub times: AuxiliaryTimes,
    /// Tools that cut with M4.
    pub left_hand: BTreeSet<u32>,
    /// What parts are made of; `None` for runs without graphics.
    pub columns: Option<Columns>,
    /// What pictures need to know beside the material.
    pub memory: Memory,
    /// A programmed stop ends the run; otherwise it is passed over.
    pub ends_at_stop: bool,
    /// The folder for digitized programs.
    pub digitized: Option<PathBuf>,
    /// What is digitized instead of the part.
    pub solid: Option<Arc<Part>>,
    /// Simulate the block processing time of the model.
    pub block_time: bool,
    /// The control is a System 900, which runs its own programs alone.
    pub system900: Option<System900>,
}

/// What goes along with a run.
#[derive(Default)]
pub struct Company {
    /// The files that take its path.
    pub outputs: Outputs,
    /// Who sees how far it has come.
    pub follower: Option<Box<dyn Follower>>,
    /// What a table says of it beyond its report.
    pub survey: Option<Survey>,
    /// What the page of the run shows.
    pub recording: Option<Recording>,
    /// What ends it before its end.
    pub stop: Stop,
}

/// A run that has ended.
pub struct Tested {
    /// At its end, at a stop, by Ctrl-C, a time limit or an error.
    pub end: End,
    /// What is said of it.
    pub report: Report,
    /// `None` without a blank, or without graphics.
    pub part: Option<Part>,
    /// What a table says beyond the report, when it is wanted.
    pub survey: Option<Survey>,
    /// What the page of the run shows, when it is wanted.
    pub recording: Option<Recording>,
    /// Why a file of the path is not whole. The run went on without it.
    pub unwritten: Option<ReportError>,
    /// The programs of the run, for places.
    pub reader: Box<dyn Reader>,
}

impl Bench {
    /// Machine zero from the workpiece datum.
    pub fn machine_zero(&self) -> &Position {
        &self.settings.rules.machine_zero
    }

    /// Runs the program of a file.
    ///
    /// # Errors
    /// When the file cannot be read, or the resolution is too fine.
    pub fn test(&self, file: &Path, mut company: Company) -> Result<Tested, ReportError> {
        let (program, fault) = match files::load_program(file)? {
            Loaded::Program(program) => (program, None),
            Loaded::Empty(program) => (program, Some((MessageId::EndOfProgramMissing, files::EMPTY))),
            Loaded::TooLarge => {
                let stand_in = Arc::new(Program::from_bytes(file.to_string_lossy(), Vec::new()));
                (
                    stand_in,
                    Some((MessageId::FurtherProgramEntryImpossible, files::TOO_LARGE)),
                )
            }
        };
        if let Some(follower) = &mut company.follower {
            follower.begin(program.block_count());
        }
        let fault = fault.or_else(|| self.foreign(&program));
        let limits = match &self.system900 {
            Some(machine) => machine.limits(&program, &self.limits),
            None => self.limits.clone(),
        };
        let mut reader = self.reader(program);
        reader.set_interrupt(company.stop.flag());
        let mut run = TestRun {
            planner: Planner::new(reader, &limits, &self.times),
            record: Record::new(self.settings.start),
            cutting: self
                .columns
                .map(|columns| Cutting::new(columns, self.memory, self.left_hand.clone())),
            company,
            unwritten: None,
            ends_at_stop: self.ends_at_stop,
            digitized: self.digitized.clone(),
            solid: self.solid.clone(),
            block_time: self.block_time.then(|| BlockTime::of(self.list.model())),
            last_stop: None,
            model: self.list.model(),
        };
        let end = match fault {
            Some((message, detail)) => run.failed_before_start(message, detail),
            None => run.run()?,
        };
        run.finish(end)
    }
}

impl Bench {
    /// What its reports call the control.
    pub fn control(&self) -> String {
        match &self.system900 {
            Some(machine) => machine.name().to_owned(),
            None => self.list.model().to_string().to_uppercase(),
        }
    }

    /// Why a program of another family is not run.
    fn foreign(&self, program: &Program) -> Option<(MessageId, &'static str)> {
        let is_foreign = self.system900.is_some() && !System900::runs(program);
        is_foreign.then_some((MessageId::BlockNotSupported, FOREIGN))
    }

    /// What reads the program, by its language.
    fn reader(&self, program: Arc<Program>) -> Box<dyn Reader> {
        if let Some(machine) = self.system900.as_ref().filter(|_| System900::runs(&program)) {
            return Box::new(machine.reader(program));
        }
        let settings = &self.settings;
        let AbsentAxes { missing, plc, slaves } = settings.absent;
        let absent = missing.union(plc).union(slaves);
        let start = Start::of(&self.list, settings.functions.clone(), absent, settings.start);
        if let Some(reader) = files::nc_reader(&program, &start) {
            return Box::new(reader);
        }
        let beside = Arc::new(files::beside(&program));
        Box::new(Interpreter::new(program, settings.clone(), beside))
    }
}

/// A run and everything that takes its elements.
struct TestRun {
    planner: Planner<Box<dyn Reader>>,
    record: Record,
    /// `None` for a run without graphics.
    cutting: Option<Cutting>,
    company: Company,
    unwritten: Option<ReportError>,
    ends_at_stop: bool,
    digitized: Option<PathBuf>,
    solid: Option<Arc<Part>>,
    block_time: Option<BlockTime>,
    /// The block of the last stop and its function: in a loop it is the same again and again.
    last_stop: Option<(BlockRef, Option<&'static str>)>,
    model: ControlModel,
}

impl TestRun {
    fn run(&mut self) -> Result<End, ReportError> {
        loop {
            match self.planner.next() {
                PlannedStep::Element(planned) => {
                    self.record.element(&planned);
                    if let Some(block_time) = &mut self.block_time {
                        self.record.machining_time_s += block_time.wait_s(planned.duration_s());
                    }
                    if let Some(survey) = &mut self.company.survey {
                        survey.element(&planned);
                    }
                    self.element(&planned.element)?;
                    if let Some(recording) = &mut self.company.recording {
                        let time_s = self.record.machining_time_s;
                        recording.element(&planned.element, time_s);
                        if recording.wants_part(time_s)
                            && let Some(part) = self.cutting.as_mut().and_then(Cutting::part)
                        {
                            recording.part(part, time_s);
                        }
                    }
                }
                PlannedStep::Barrier(barrier) => {
                    if self.is_stop(&barrier) && self.ends_at_stop {
                        return Ok(End::Stopped);
                    }
                    let live = match barrier {
                        Barrier::Scan { block, job } => match self.digitize(block, &job)? {
                            Some(live) => live,
                            None => return Ok(self.broken_off()),
                        },
                        _ => self.live_data(&barrier),
                    };
                    self.planner.resume(live);
                }
                PlannedStep::End => {
                    self.take_warnings();
                    return Ok(End::Completed);
                }
                // A loop without movements was interrupted.
                PlannedStep::Starved => return Ok(self.broken_off()),
                PlannedStep::Error(error) => {
                    self.take_warnings();
                    return Ok(End::Failed(Box::new(self.error_report(&error))));
                }
            }
            if self.company.stop.is_requested() {
                return Ok(self.broken_off());
            }
        }
    }

    fn broken_off(&mut self) -> End {
        self.take_warnings();
        if self.company.stop.is_late() {
            End::Late
        } else {
            End::Interrupted
        }
    }

    #[inline]
    fn element(&mut self, element: &PathElement) -> Result<(), ReportError> {
        if let Some(cutting) = &mut self.cutting {
            cutting.element(element, &mut self.record)?;
        }
        if !self.company.outputs.is_empty() {
            let outputs = &mut self.company.outputs;
            let written = outputs.element(element, &**self.planner.source(), &mut self.record);
            if let Err(error) = written {
                self.unwritten = Some(error);
                self.company.outputs = Outputs::default();
            }
        }
        if let Some(follower) = &mut self.company.follower {
            let block = (element.block.program == 0).then_some(element.block.block);
            follower.element(block, self.record.machining_time_s);
        }
        self.take_warnings();
        Ok(())
    }

    /// Takes the warnings of the interpreter often, so that they are counted and do not pile up.
    #[inline]
    fn take_warnings(&mut self) {
        for warning in self.planner.source_mut().take_warnings() {
            self.record
                .warn(warning.block, Notice::Program(warning.kind), warning.count);
        }
    }

    /// Whether a barrier is a programmed stop, which is then listed. The stop for a tool change by M6
    /// (MP7440 bit 0) is none: nobody changes tools here.
    fn is_stop(&mut self, barrier: &Barrier) -> bool {
        let Barrier::Stop { block } = barrier else {
            return false;
        };
        let function = match self.last_stop {
            Some((last, function)) if last == *block => function,
            _ => stop_function(&**self.planner.source(), *block),
        };
        self.last_stop = Some((*block, function));
        if let Some(function) = function {
            self.record.stop(*block, function);
        }
        function.is_some()
    }

    /// What is found at a barrier. Everything before it has been executed and cut.
    fn live_data(&mut self, barrier: &Barrier) -> LiveData {
        if let Barrier::MeasureTool(measuring) = barrier {
            self.record.warn(measuring.block, Notice::NoToolProbe, 1);
        }
        let Barrier::Probe {
            block,
            from,
            to,
            stylus_radius,
            ..
        } = barrier
        else {
            return LiveData::default();
        };
        let touch = self
            .cutting
            .as_mut()
            .and_then(|cutting| cutting.touch(from, to, *stylus_radius));
        if !self.cutting.as_ref().is_some_and(Cutting::has_part) {
            self.record.warn(*block, Notice::NothingToProbe, 1);
        }
        LiveData {
            touch,
            ..LiveData::default()
        }
    }

    /// Scans the part as it is; `None` when the run is interrupted.
    fn digitize(&mut self, block: BlockRef, job: &ScanJob) -> Result<Option<LiveData>, ReportError> {
        let part = || {
            self.cutting
                .as_mut()
                .and_then(Cutting::part)
                .cloned()
                .map(Arc::new)
        };
        let Some(part) = self.solid.clone().or_else(part) else {
            self.record.warn(block, Notice::NothingToProbe, 1);
            return Ok(Some(LiveData::not_scanned(job.begin())));
        };
        let done = digitize(job, part, self.digitized.as_deref(), &self.company.stop)?;
        self.record.machining_time_s += done.time_s;
        if self.digitized.is_none() {
            self.record
                .warn(block, Notice::Digitized { points: done.points }, 1);
        }
        Ok(done.scanned.map(|scanned| LiveData {
            scan: Some(scanned),
            ..LiveData::default()
        }))
    }

    fn error_report(&self, error: &ProgramError) -> ErrorReport {
        let run = self.planner.source();
        let Place { program, block, .. } = Place::of(&**run, error.block);
        let line = run
            .program(error.block.program)
            .map_or(0, |program| program.span_of(error.block.block).line);
        let remedy = error.remedy();
        ErrorReport {
            message: error.message.text(self.model).to_owned(),
            program,
            block,
            line,
            detail: error.detail.clone(),
            at: error.block,
            remedy,
        }
    }

    fn failed_before_start(&self, message: MessageId, detail: &str) -> End {
        End::Failed(Box::new(ErrorReport {
            message: message.text(self.model).to_owned(),
            program: Place::of(&**self.planner.source(), Default::default()).program,
            block: 0,
            line: 1,
            detail: detail.to_owned(),
            at: Default::default(),
            remedy: Some(message.remedy()),
        }))
    }

    /// Writes the path and makes the report.
    fn finish(mut self, end: End) -> Result<Tested, ReportError> {
        drop(self.company.follower.take());
        let written = self.company.outputs.finish();
        let part = self.cutting.and_then(|cutting| cutting.finish(&mut self.record));
        let removed_mm3 = part.as_ref().map(Part::removed_mm3);
        let report = self
            .record
            .report(&**self.planner.source(), end.clone(), removed_mm3, self.model);
        Ok(Tested {
            end,
            report,
            part,
            survey: self.company.survey,
            recording: self.company.recording,
            unwritten: self.unwritten.or(written.err()),
            reader: self.planner.into_source(),
        })
    }
}

/// What stops in a block: STOP or M0; `None` for M6.
pub fn stop_function(run: &dyn Reader, block: BlockRef) -> Option<&'static str> {
    if let Some(run) = NcReader::of(run) {
        return run.stop_function(block);
    }
    if Reader900::of(run).is_some() {
        return Some("M0");
    }
    let chunk = run
        .program(block.program)?
        .decode(block.block / Program::CHUNK_SIZE);
    let offset = (block.block % Program::CHUNK_SIZE) as usize;
    let operation = &chunk.blocks.get(offset)?.operation;
    if matches!(operation, Operation::Stop(_)) {
        return Some("STOP");
    }
    operation.m()?.contains(0).then_some("M0")
}
