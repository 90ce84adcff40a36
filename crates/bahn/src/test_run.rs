//! `bahn test`: the driver that pulls the planned path through to the report.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use bahn_interpreter::{Interpreter, ProgramError};
use bahn_motion::{PlannedStep, Planner};
use bahn_parameters::{ControlModel, MessageId, ParameterList};
use bahn_path::{Barrier, BlockRef, Function, LiveData, PathElement};
use bahn_program::{Operation, Program};
use bahn_workpiece::Projection;

use crate::block_time::BlockTime;
use crate::cli::{Format, OutputOptions, PathFile, TestOptions};
use crate::cutting::{self, Cutting};
use crate::diagnostics::{self, Diagnostic, Marked, Severity};
use crate::files::{self, FileLibrary, Loaded, NewFile};
use crate::interrupt::Interrupt;
use crate::path_csv::PathTable;
use crate::path_svg::PathDrawing;
use crate::progress::Progress;
use crate::report::{End, ErrorReport, Notice, Place, Record, Report};
use crate::{Outcome, UsageError, console, report_text, settings};

/// Runs a program and reports.
pub(crate) fn command(options: &TestOptions) -> Result<Outcome, UsageError> {
    let list = settings::parameters(options.model, &options.machine)?;
    let settings = settings::interpreter(&list, &options.machine, &options.run)?;
    let (program, fault) = match files::load_program(&options.file)? {
        Loaded::Program(program) => (program, None),
        Loaded::Empty(program) => (program, Some((MessageId::EndOfProgramMissing, files::EMPTY))),
        Loaded::TooLarge => {
            let stand_in = Arc::new(Program::from_bytes(options.file.to_string_lossy(), Vec::new()));
            (
                stand_in,
                Some((MessageId::FurtherProgramEntryImpossible, files::TOO_LARGE)),
            )
        }
    };
    let start = settings.start;
    let library = FileLibrary::with_main(&program);
    let progress = Progress::new(program.block_count());
    let interrupt = Interrupt::on_ctrl_c();
    let mut interpreter = Interpreter::new(program, settings, Box::new(library));
    interpreter.set_interrupt(interrupt.flag());
    let limits = settings::limits(&list, &options.machine);
    let times = settings::times(&options.machine);
    let mut run = TestRun {
        planner: Planner::new(interpreter, &limits, &times),
        record: Record::new(start),
        cutting: (!options.output.no_graphics).then(|| Cutting::new(options.output.resolution)),
        outputs: Outputs::create(&options.output)?,
        progress,
        interrupt,
        ends_at_stop: options.run.stop,
        block_time: options.machine.block_time.then(|| BlockTime::of(options.model)),
        last_stop: None,
        model: options.model,
    };
    let end = match fault {
        Some((message, detail)) => run.failed_before_start(message, detail),
        None => run.run()?,
    };
    run.finish(end, options, &list)
}

/// A run and everything that takes its elements.
struct TestRun {
    planner: Planner<Interpreter>,
    record: Record,
    /// `None` for a run without graphics.
    cutting: Option<Cutting>,
    outputs: Outputs,
    progress: Progress,
    interrupt: Interrupt,
    ends_at_stop: bool,
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
                    self.element(&planned.element)?;
                }
                PlannedStep::Barrier(barrier) => {
                    if self.is_stop(&barrier) && self.ends_at_stop {
                        return Ok(End::Stopped);
                    }
                    let live = self.live_data(&barrier);
                    self.planner.resume(live);
                }
                PlannedStep::End => {
                    self.take_warnings();
                    return Ok(End::Completed);
                }
                // A loop without movements was interrupted.
                PlannedStep::Starved => return Ok(End::Interrupted),
                PlannedStep::Error(error) => {
                    self.take_warnings();
                    return Ok(End::Failed(Box::new(self.error_report(&error))));
                }
            }
            if self.interrupt.is_requested() {
                return Ok(End::Interrupted);
            }
        }
    }

    #[inline]
    fn element(&mut self, element: &PathElement) -> Result<(), UsageError> {
        if let Some(cutting) = &mut self.cutting {
            cutting.element(element, &mut self.record)?;
        }
        if !self.outputs.is_empty() {
            self.outputs
                .element(element, self.planner.source(), &mut self.record)?;
        }
        let block = (element.block.program == 0).then_some(element.block.block);
        self.progress.element(block, self.record.machining_time_s);
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
            _ => stop_function(self.planner.source(), *block),
        };
        self.last_stop = Some((*block, function));
        if let Some(function) = function {
            self.record.stop(*block, function);
        }
        function.is_some()
    }

    /// What is found at a barrier. Everything before it has been executed and cut.
    fn live_data(&mut self, barrier: &Barrier) -> LiveData {
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

    fn error_report(&self, error: &ProgramError) -> ErrorReport {
        let run = self.planner.source();
        let Place { program, block, .. } = Place::of(run, error.block);
        let line = run
            .program(error.block.program)
            .map_or(0, |program| Marked::of_block(program, block).line);
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
            program: Place::of(self.planner.source(), Default::default()).program,
            block: 0,
            line: 1,
            detail: detail.to_owned(),
            at: Default::default(),
            remedy: Some(message.remedy()),
        }))
    }

    /// Writes all files and the report.
    fn finish(
        mut self,
        end: End,
        options: &TestOptions,
        list: &ParameterList,
    ) -> Result<Outcome, UsageError> {
        drop(self.progress);
        self.outputs.finish()?;
        let part = self.cutting.and_then(|cutting| cutting.finish(&mut self.record));
        let outcome = match &end {
            End::Completed | End::Stopped => Outcome::Fine,
            End::Interrupted => Outcome::Interrupted,
            End::Failed(_) => Outcome::ProgramError,
        };
        let run = self.planner.source();
        let removed_mm3 = part.as_ref().map(|part| part.removed_mm3());
        let report = self.record.report(run, end, removed_mm3, self.model);
        if let Some(error) = &report.error {
            print_error(error, run, &options.file);
        }
        if outcome == Outcome::Interrupted {
            diagnostics::print_line("interrupted: the report so far");
        }
        let projection = if list.graphics().third_angle {
            Projection::ThirdAngle
        } else {
            Projection::FirstAngle
        };
        let drawn = cutting::write(
            part.as_ref(),
            &options.output,
            &format!("PGM {}", report.program),
            projection,
        );
        print_report(&report, options, drawn.is_ok())?;
        drawn?;
        Ok(outcome)
    }
}

/// What stops in a block: STOP or M0; `None` for M6.
pub(crate) fn stop_function(run: &Interpreter, block: BlockRef) -> Option<&'static str> {
    let chunk = run
        .program(block.program)?
        .decode(block.block / Program::CHUNK_SIZE);
    let offset = (block.block % Program::CHUNK_SIZE) as usize;
    let m = match &chunk.blocks.get(offset)?.operation {
        Operation::Stop(_) => return Some("STOP"),
        Operation::Motion(motion) => &motion.m,
        Operation::Miscellaneous(m) | Operation::CycleCall(m) => m,
        _ => return None,
    };
    m.contains(0).then_some("M0")
}

pub(crate) fn print_error(error: &ErrorReport, run: &Interpreter, main: &Path) {
    let Some(program) = run.program(error.at.program) else {
        return;
    };
    // All programs of a run lie beside the main program.
    let path = match error.at.program {
        0 => main.to_owned(),
        _ => main.with_file_name(files::short_name(program)),
    };
    diagnostics::print(&Diagnostic {
        severity: Severity::Error,
        title: &error.message,
        path: &path.to_string_lossy(),
        marked: Marked::of_block(program, error.block),
        label: match error.detail.as_str() {
            "" => format!("block {}", error.block),
            detail => format!("block {}: {detail}", error.block),
        },
        help: error.remedy,
    });
}

fn print_report(report: &Report, options: &TestOptions, drawn: bool) -> Result<(), UsageError> {
    match options.format {
        Format::Text => console::print(&report_text::render(
            report,
            options.model,
            &report_text::written(&options.output, drawn),
        )),
        Format::Json => {
            let json = serde_json::to_string_pretty(report)
                .map_err(|error| UsageError::new(format!("cannot write the report: {error}")))?;
            console::print(&(json + "\n"))
        }
    }
}

/// The files that take the tool path.
#[derive(Default)]
pub(crate) struct Outputs {
    tables: Vec<(PathTable, std::path::PathBuf)>,
    drawings: Vec<(PathDrawing, NewFile)>,
    /// What FN15 puts out.
    print: Option<(NewFile, std::path::PathBuf)>,
    /// Short names of the programs of the run by number.
    names: Vec<String>,
}

impl Outputs {
    pub fn create(wanted: &OutputOptions) -> Result<Outputs, UsageError> {
        let mut outputs = Outputs::default();
        if let Some(path) = &wanted.print {
            outputs.print = Some((NewFile::create(path)?, path.clone()));
        }
        for file in &wanted.path {
            match file {
                PathFile::Csv(path) => {
                    let table = PathTable::new(NewFile::create(path)?);
                    outputs
                        .tables
                        .push((table.map_err(|e| files::cannot("write", path, &e))?, path.clone()));
                }
                PathFile::Svg(path) => outputs
                    .drawings
                    .push((PathDrawing::default(), NewFile::create(path)?)),
            }
        }
        Ok(outputs)
    }

    pub fn is_empty(&self) -> bool {
        self.tables.is_empty() && self.drawings.is_empty() && self.print.is_none()
    }

    pub fn element(
        &mut self,
        element: &PathElement,
        run: &Interpreter,
        record: &mut Record,
    ) -> Result<(), UsageError> {
        let number = element.block.program;
        while self.names.len() <= usize::from(number) {
            let program = run.program(self.names.len() as u16);
            self.names.push(
                program
                    .map(|program| files::short_name(program).to_owned())
                    .unwrap_or_default(),
            );
        }
        if let Some((file, path)) = &mut self.print {
            for output in element.functions() {
                if let Function::Print(line) = &output.function {
                    writeln!(file, "{line}").map_err(|error| files::cannot("write", path, &error))?;
                }
            }
        }
        let name = self.names.get(usize::from(number)).map_or("", String::as_str);
        for (table, path) in &mut self.tables {
            table
                .element(element, name)
                .map_err(|error| files::cannot("write", path, &error))?;
        }
        for (drawing, _) in &mut self.drawings {
            if !drawing.element(element) {
                record.warn(element.block, Notice::DrawingIncomplete, 1);
            }
        }
        Ok(())
    }

    pub fn finish(&mut self) -> Result<(), UsageError> {
        for (table, _) in self.tables.drain(..) {
            table.into_file().finish()?;
        }
        if let Some((file, _)) = self.print.take() {
            file.finish()?;
        }
        let title = self.names.first().cloned().unwrap_or_default();
        for (drawing, mut file) in self.drawings.drain(..) {
            drawing.write(&title, &mut file)?;
            file.finish()?;
        }
        Ok(())
    }
}
