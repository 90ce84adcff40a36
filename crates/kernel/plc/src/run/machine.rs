//! The PLC scan by scan.

use std::sync::Arc;

use bahn_exchange::{Exchange, signal};
use bahn_parameters::PLC_AXES;

use super::clock::Clock;
use super::processor::{Jobs, Processor, Step};
use super::registers::Registers;
use super::submit::{Queue, swap_markers};
use super::trace::{TraceStep, Tracer};
use crate::fast::FastProgram;
use crate::program::{Instruction, PlcProgram};
use crate::{InterfaceUser, Nc, PlcError};

/// Longest run in ns of nominal time [000:12038].
const RUN_TIME_MAX: u64 = 10_000_000;
/// 100 % of processing time, in ns [000:12038].
const FULL_LOAD: u64 = 5_000_000;
/// Nominal time that submit jobs get in each scan, in ns: 5 % of a cycle of 20 ms (inferred) [000:14305].
const JOBS_TIME: u64 = 1_000_000;

/// Interfaces of the control: RS-232-C/V.24 and RS-422/V.11.
const DATA_INTERFACES: usize = 2;

/// A time in percent as the PLC menu shows it.
pub(crate) fn percent(time: u64) -> f64 {
    time as f64 / FULL_LOAD as f64 * 100.0
}

/// Why the program starts: it sets M2180 or M2185 in its first scan [000:10662-10666].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Start {
    /// The control was switched on.
    #[default]
    PowerOn,
    /// The program was interrupted: compiled anew, or stopped by an error.
    Interruption,
}

/// An error that stopped the PLC [000:12013-12048].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: error {}: {}", error.number(), error.text())]
pub struct RuntimeError {
    /// One of the errors 50 to 56.
    pub error: PlcError,
    /// Source file of the line that failed.
    pub file: String,
    /// The line that failed, counted from 1; for a time out the last jump that was executed.
    pub line: u32,
    /// The identifier of the submit job that failed; `None` for the cyclic program.
    pub job: Option<u8>,
}

/// Processing times of runs, nominal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProcessingTime {
    /// The latest run, in ns.
    pub current: u64,
    /// The longest run since the program was started, in ns.
    pub maximum: u64,
}

impl ProcessingTime {
    /// The latest run in percent, 100 % = 5 ms.
    pub fn current_percent(&self) -> f64 {
        percent(self.current)
    }

    /// The longest run in percent.
    pub fn maximum_percent(&self) -> f64 {
        percent(self.maximum)
    }
}

/// What a scan did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ScanReport {
    /// Scans since the start, this one included.
    pub scans: u64,
    /// Processing times, this scan included.
    pub time: ProcessingTime,
}

/// Runs a PLC program.
///
/// One scan does, in this order (inferred from the manual's statements):
/// 1. what the NC wrote and the inputs come into the PLC's image;
/// 2. edges, timers and counters go on by one cycle;
/// 3. index register 0, stacks empty; the main program runs to the first EM outside modules;
/// 4. submit jobs go on for 1 ms of nominal time;
/// 5. what the program changed goes to the NC and the outputs.
///
/// ```
/// use bahn_exchange::Exchange;
/// use bahn_parameters::{ControlModel, ParameterList};
/// use bahn_plc::{Compilation, Machine, MemoryFiles, Options, Start, TestNc};
///
/// let files = MemoryFiles::from([("MAIN.PLC", "L I4\nA I5\n= O2\nEM\n")]);
/// let program = Compilation::compile(&files, "MAIN.PLC", Options::default()).program.unwrap();
/// let mut nc = TestNc::new(ParameterList::reference(ControlModel::Tnc415b));
/// let mut exchange = Exchange::default();
/// let mut machine = Machine::new(program.into(), Start::PowerOn);
/// exchange.nc_set("I4".parse()?, true);
/// exchange.nc_set("I5".parse()?, true);
/// machine.scan(&mut exchange, &mut nc)?;
/// assert!(exchange.nc().bit("O2".parse()?));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Machine {
    program: Arc<PlcProgram>,
    fast: Arc<FastProgram>,
    registers: Registers,
    queue: Queue,
    clock: Clock,
    start: Start,
    scans: u64,
    /// Nominal time of the run so far.
    elapsed: u64,
    time: ProcessingTime,
    /// Index of the last jump or call that was executed.
    last_jump: usize,
    stopped: Option<RuntimeError>,
}

impl Machine {
    /// A machine that will run a program from its start.
    pub fn new(program: Arc<PlcProgram>, start: Start) -> Machine {
        Machine {
            fast: Arc::new(FastProgram::new(&program)),
            program,
            registers: Registers::default(),
            queue: Queue::default(),
            clock: Clock::default(),
            start,
            scans: 0,
            elapsed: 0,
            time: ProcessingTime::default(),
            last_jump: 0,
            stopped: None,
        }
    }

    /// Starts the program anew: after RESET, a selected list of machine parameters (9033), or an error.
    /// Accumulators, stacks, submit jobs, timers, counters and processing times begin anew; operands are
    /// left to [`Exchange::reset`]. What the program had of the control is given back: data interfaces
    /// are released, overrides of PLC axes are 100 % [000:16013].
    pub fn restart(&mut self, start: Start, nc: &mut dyn Nc) {
        for interface in 0..DATA_INTERFACES {
            let interface = nc.data_interface(interface);
            if interface.user == Some(InterfaceUser::Plc) {
                interface.release();
            }
        }
        for axis in 0..PLC_AXES {
            nc.override_plc_axis(axis, 100.0);
        }
        *self = Machine {
            program: Arc::clone(&self.program),
            fast: Arc::clone(&self.fast),
            registers: Registers::default(),
            queue: Queue::default(),
            clock: Clock::default(),
            start,
            scans: 0,
            elapsed: 0,
            time: ProcessingTime::default(),
            last_jump: 0,
            stopped: None,
        };
    }

    /// Goes on with a program that was compiled anew; as [`Machine::restart`] after an interruption
    /// [000:11263][000:15616].
    pub fn load(&mut self, program: Arc<PlcProgram>, nc: &mut dyn Nc) {
        self.fast = Arc::new(FastProgram::new(&program));
        self.program = program;
        self.restart(Start::Interruption, nc);
    }

    /// Runs one scan, in the fast form of the program.
    ///
    /// # Errors
    /// When an error of the program stops the PLC. It stays stopped: every further scan returns the same
    /// error and does nothing.
    pub fn scan(&mut self, exchange: &mut Exchange, nc: &mut dyn Nc) -> Result<ScanReport, RuntimeError> {
        self.begin(exchange, nc)?;
        let program = Arc::clone(&self.program);
        let mut processor = Processor {
            program: &program,
            image: exchange.plc_mut(),
            registers: &mut self.registers,
            queue: Jobs::Cyclic(&mut self.queue),
            nc,
        };
        let run = self.fast.run(&mut processor, RUN_TIME_MAX);
        (self.elapsed, self.last_jump) = (run.elapsed, run.last_jump);
        if let Err((error, at)) = run.end {
            return Err(self.stop(&program, error, at, None));
        }
        self.finish(&program, exchange, nc, None)
    }

    /// Runs one scan in the reference interpreter and shows every executed instruction.
    ///
    /// # Errors
    /// As [`Machine::scan`].
    pub fn scan_traced(
        &mut self,
        exchange: &mut Exchange,
        nc: &mut dyn Nc,
        tracer: &mut dyn Tracer,
    ) -> Result<ScanReport, RuntimeError> {
        self.begin(exchange, nc)?;
        tracer.began(exchange.plc());
        let program = Arc::clone(&self.program);
        while !self.cyclic_step(&program, exchange, nc, Some(&mut *tracer))? {}
        self.finish(&program, exchange, nc, Some(tracer))
    }

    /// Starts a scan that is then executed by [`Machine::step`]: for stepping line by line.
    ///
    /// # Errors
    /// When the PLC is stopped.
    pub fn begin(&mut self, exchange: &mut Exchange, nc: &mut dyn Nc) -> Result<(), RuntimeError> {
        if let Some(error) = &self.stopped {
            return Err(error.clone());
        }
        exchange.begin_scan();
        let image = exchange.plc_mut();
        let first = self.scans == 0;
        image.set_bit(
            signal::FIRST_SCAN_AFTER_POWER_ON,
            first && self.start == Start::PowerOn,
        );
        image.set_bit(
            signal::FIRST_SCAN_AFTER_PLC_INTERRUPTION,
            first && self.start == Start::Interruption,
        );
        self.clock.tick(image, nc.parameters());
        self.registers.restart();
        self.elapsed = 0;
        self.last_jump = 0;
        Ok(())
    }

    /// Executes the next instruction of a scan that was begun. The scan is over when it returns a report:
    /// then submit jobs have run and the exchange has taken place.
    ///
    /// # Errors
    /// As [`Machine::scan`].
    pub fn step(
        &mut self,
        exchange: &mut Exchange,
        nc: &mut dyn Nc,
        mut tracer: Option<&mut (dyn Tracer + '_)>,
    ) -> Result<Option<ScanReport>, RuntimeError> {
        if let Some(error) = &self.stopped {
            return Err(error.clone());
        }
        let program = Arc::clone(&self.program);
        if !self.cyclic_step(&program, exchange, nc, reborrow(&mut tracer))? {
            return Ok(None);
        }
        self.finish(&program, exchange, nc, tracer).map(Some)
    }

    /// Accumulators and stacks of the cyclic program.
    pub fn registers(&self) -> &Registers {
        &self.registers
    }

    /// The compiled program that runs.
    pub fn program(&self) -> &Arc<PlcProgram> {
        &self.program
    }

    /// Processing times of the latest and of the longest scan.
    pub fn time(&self) -> ProcessingTime {
        self.time
    }

    /// The error that stopped the PLC.
    pub fn stopped(&self) -> Option<&RuntimeError> {
        self.stopped.as_ref()
    }

    /// One instruction of the cyclic program; tells whether the run is over.
    fn cyclic_step(
        &mut self,
        program: &PlcProgram,
        exchange: &mut Exchange,
        nc: &mut dyn Nc,
        tracer: Option<&mut (dyn Tracer + '_)>,
    ) -> Result<bool, RuntimeError> {
        let at = self.registers.next;
        let mut processor = Processor {
            program,
            image: exchange.plc_mut(),
            registers: &mut self.registers,
            queue: Jobs::Cyclic(&mut self.queue),
            nc,
        };
        let (step, instruction) = match processor.step() {
            Ok((step, instruction)) => (step, instruction),
            Err(error) => return Err(self.stop(program, error, at, None)),
        };
        let Some(instruction) = instruction else {
            return Ok(true);
        };
        self.elapsed = self.elapsed.saturating_add(cost(instruction, step));
        if let Some(tracer) = tracer {
            let image = exchange.plc();
            tracer.executed(&TraceStep {
                program,
                at,
                instruction,
                registers: &self.registers,
                image,
                job: None,
            });
        }
        if step == Step::Transferred {
            self.last_jump = at;
        }
        // The budget is looked at where control is transferred and at the end, so that a translated program
        // can stop at the same place (inferred).
        let looked_at = matches!(step, Step::Transferred | Step::Ended);
        if looked_at && self.elapsed > RUN_TIME_MAX {
            return Err(self.stop(program, PlcError::TimeOut, self.last_jump, None));
        }
        Ok(step == Step::Ended)
    }

    /// The end of a run: times, submit jobs, exchange.
    fn finish(
        &mut self,
        program: &PlcProgram,
        exchange: &mut Exchange,
        nc: &mut dyn Nc,
        tracer: Option<&mut (dyn Tracer + '_)>,
    ) -> Result<ScanReport, RuntimeError> {
        self.scans = self.scans.saturating_add(1);
        self.time.current = self.elapsed;
        self.time.maximum = self.time.maximum.max(self.elapsed);
        self.run_jobs(program, exchange, nc, tracer)?;
        exchange.end_scan();
        Ok(ScanReport {
            scans: self.scans,
            time: self.time,
        })
    }

    /// Lets the submit jobs go on, one after the other, until their time is used up.
    fn run_jobs(
        &mut self,
        program: &PlcProgram,
        exchange: &mut Exchange,
        nc: &mut dyn Nc,
        mut tracer: Option<&mut (dyn Tracer + '_)>,
    ) -> Result<(), RuntimeError> {
        let mut elapsed = 0;
        while elapsed < JOBS_TIME {
            let Some(job) = self.queue.running().cloned() else {
                break;
            };
            let mut job = job;
            swap_markers(exchange.plc_mut(), &mut job.markers);
            let mut cancelled = None;
            let outcome = loop {
                let at = job.registers.next;
                let mut processor = Processor {
                    program,
                    image: exchange.plc_mut(),
                    registers: &mut job.registers,
                    queue: Jobs::Job(&self.queue, &mut cancelled),
                    nc,
                };
                let (step, instruction) = match processor.step() {
                    Ok((step, Some(instruction))) => (step, instruction),
                    Ok((_, None)) => break Ok(true),
                    Err(error) => break Err((error, at)),
                };
                elapsed += cost(instruction, step);
                if nc.resets() {
                    // A control reset ends all of them [000:14893].
                    self.queue = Queue::default();
                    return Ok(());
                }
                if let Some(tracer) = reborrow(&mut tracer) {
                    tracer.executed(&TraceStep {
                        program,
                        at,
                        instruction,
                        registers: &job.registers,
                        image: exchange.plc(),
                        job: Some(job.identifier),
                    });
                }
                if step == Step::Ended {
                    break Ok(true);
                }
                if elapsed >= JOBS_TIME || cancelled.is_some() {
                    break Ok(false);
                }
            };
            swap_markers(exchange.plc_mut(), &mut job.markers);
            let identifier = job.identifier;
            if let Some(running) = self.queue.running() {
                *running = job;
            }
            if let Some(identifier) = cancelled {
                self.queue.cancel(identifier);
            }
            match outcome {
                Ok(true) => self.queue.cancel(identifier.into()),
                Ok(false) => {}
                Err((error, at)) => return Err(self.stop(program, error, at, Some(identifier))),
            }
        }
        Ok(())
    }

    fn stop(&mut self, program: &PlcProgram, error: PlcError, at: usize, job: Option<u8>) -> RuntimeError {
        let (file, line) = program.code.get(at).map_or(("", 0), |instruction| {
            (program.file_name(instruction.file), instruction.line)
        });
        self.time.current = self.elapsed;
        self.time.maximum = self.time.maximum.max(self.elapsed);
        let error = RuntimeError {
            error,
            file: file.to_owned(),
            line,
            job,
        };
        self.stopped = Some(error.clone());
        error
    }
}

fn cost(instruction: &Instruction, step: Step) -> u64 {
    match step {
        Step::Skipped => instruction.time_skipped.into(),
        Step::Next | Step::Transferred | Step::Ended => instruction.time.into(),
    }
}

/// Lends a tracer on.
fn reborrow<'a>(tracer: &'a mut Option<&mut (dyn Tracer + '_)>) -> Option<&'a mut (dyn Tracer + 'a)> {
    match tracer {
        Some(tracer) => Some(&mut **tracer),
        None => None,
    }
}
