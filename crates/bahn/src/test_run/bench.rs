//! One program run to its end: nothing is printed here, so that many can run side by side.

use bahn_reader::{ProgramError, Reader, Start};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_interpreter::{AbsentAxes, Interpreter};
use bahn_motion::{AuxiliaryTimes, Limits, PlannedStep, Planner};
use bahn_nc::NcReader;
use bahn_parameters::{ControlModel, MessageId, ParameterList};
use bahn_path::{Barrier, BlockRef, LiveData, PathElement, Position, ScanJob};
use bahn_program::{Operation, Program};
use bahn_viewer::Recording;
use bahn_workpiece::{Columns, Cutting, Memory, Part};

use super::digitizing::digitize;
use super::options::TestOptions;
use super::outputs::Outputs;
use super::survey::Survey;
use crate::block_time::BlockTime;
use crate::cutting::{self, no_workpiece};
use crate::diagnostics::Marked;
use crate::files::{self, FileLibrary, Loaded};
use crate::interrupt::Stop;
use crate::progress::Progress;
use crate::report::{End, ErrorReport, Notice, Place, Record, Report};
use crate::settings::Equipment;
use crate::{UsageError, settings};

/// What programs run on: model, machine parameters, tools.
pub(crate) struct Bench {
    pub list: ParameterList,
    settings: bahn_interpreter::Settings,
    limits: Limits,
    times: AuxiliaryTimes,
    left_hand: BTreeSet<u32>,
    /// `None` for runs without graphics.
    columns: Option<Columns>,
    memory: Memory,
    ends_at_stop: bool,
    /// Where digitized programs go.
    digitized: Option<PathBuf>,
    /// What is digitized instead of the part.
    solid: Option<Arc<Part>>,
    /// Simulate the block processing time of the model.
    block_time: bool,
}

/// What goes along with a run.
#[derive(Default)]
pub(crate) struct Company {
    pub outputs: Outputs,
    /// Show how far the run has come.
    pub progress: bool,
    pub survey: Option<Survey>,
    /// What the page of the run shows.
    pub recording: Option<Recording>,
    pub stop: Stop,
}

/// A run that has ended.
pub(crate) struct Tested {
    pub end: End,
    pub report: Report,
    /// `None` without a blank, or without graphics.
    pub part: Option<Part>,
    pub survey: Option<Survey>,
    /// What the page of the run shows, when it is wanted.
    pub recording: Option<Recording>,
    /// Why a file of the path is not whole. The run went on without it.
    pub unwritten: Option<UsageError>,
    /// The programs of the run, for places.
    pub reader: Box<dyn Reader>,
}

impl Bench {
    /// What the options say; `columns` are those of the part unless they give a resolution.
    pub fn new(options: &TestOptions, equipment: Equipment, columns: Columns) -> Result<Bench, UsageError> {
        let machine = &options.machine;
        let wanted = options.output.resolution.map_or(columns, Columns::Millimetres);
        let mut settings = settings::interpreter(&equipment, &options.run)?;
        settings.point_angles_deg = machine.point_angle.iter().copied().collect();
        Ok(Bench {
            settings,
            left_hand: settings::left_hand(equipment.tools.as_ref()),
            limits: settings::limits(&equipment.list, machine),
            times: settings::times(machine),
            memory: match &options.html {
                Some(_) => Memory {
                    tools: true,
                    ..cutting::memory(&options.output)
                },
                None => cutting::memory(&options.output),
            },
            columns: (!options.output.no_graphics).then_some(wanted),
            ends_at_stop: options.run.stop,
            digitized: options.output.digitized.clone(),
            solid: match &options.output.solid {
                Some(path) => Some(crate::solid::read(path, options.output.resolution)?),
                None => None,
            },
            block_time: machine.block_time,
            list: equipment.list,
        })
    }

    /// Machine zero from the workpiece datum.
    pub fn machine_zero(&self) -> &Position {
        &self.settings.rules.machine_zero
    }

    /// Runs the program of a file.
    ///
    /// # Errors
    /// When the file cannot be read, or the resolution is too fine.
    pub fn test(&self, file: &Path, company: Company) -> Result<Tested, UsageError> {
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
        let progress = company.progress.then(|| Progress::new(program.block_count()));
        let mut reader = self.reader(program);
        reader.set_interrupt(company.stop.flag());
        let mut run = TestRun {
            planner: Planner::new(reader, &self.limits, &self.times),
            record: Record::new(self.settings.start),
            cutting: self
                .columns
                .map(|columns| Cutting::new(columns, self.memory, self.left_hand.clone())),
            progress,
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
    /// What reads the program, by its language.
    fn reader(&self, program: Arc<Program>) -> Box<dyn Reader> {
        let settings = &self.settings;
        let AbsentAxes { missing, plc, slaves } = settings.absent;
        let absent = missing.union(plc).union(slaves);
        let start = Start::of(&self.list, settings.functions.clone(), absent, settings.start);
        if let Some(reader) = files::nc_reader(&program, &start) {
            return Box::new(reader);
        }
        let library = FileLibrary::with_main(&program);
        Box::new(Interpreter::new(program, settings.clone(), Box::new(library)))
    }
}

/// A run and everything that takes its elements.
struct TestRun {
    planner: Planner<Box<dyn Reader>>,
    record: Record,
    /// `None` for a run without graphics.
    cutting: Option<Cutting>,
    company: Company,
    unwritten: Option<UsageError>,
    progress: Option<Progress>,
    ends_at_stop: bool,
    digitized: Option<PathBuf>,
    solid: Option<Arc<Part>>,
    block_time: Option<BlockTime>,
    /// The block of the last stop and its function: in a loop it is the same again and again.
    last_stop: Option<(BlockRef, Option<&'static str>)>,
    model: ControlModel,
}

impl TestRun {
    fn run(&mut self) -> Result<End, UsageError> {
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
    fn element(&mut self, element: &PathElement) -> Result<(), UsageError> {
        if let Some(cutting) = &mut self.cutting {
            cutting.element(element, &mut self.record).map_err(no_workpiece)?;
        }
        if !self.company.outputs.is_empty() {
            let outputs = &mut self.company.outputs;
            let written = outputs.element(element, &**self.planner.source(), &mut self.record);
            if let Err(error) = written {
                self.unwritten = Some(error);
                self.company.outputs = Outputs::default();
            }
        }
        if let Some(progress) = &mut self.progress {
            let block = (element.block.program == 0).then_some(element.block.block);
            progress.element(block, self.record.machining_time_s);
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
    fn digitize(&mut self, block: BlockRef, job: &ScanJob) -> Result<Option<LiveData>, UsageError> {
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
            .map_or(0, |program| Marked::of_block(program, error.block.block).line);
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
    fn finish(mut self, end: End) -> Result<Tested, UsageError> {
        drop(self.progress);
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
pub(crate) fn stop_function(run: &dyn Reader, block: BlockRef) -> Option<&'static str> {
    if let Some(run) = NcReader::of(run) {
        return run.stop_function(block);
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
