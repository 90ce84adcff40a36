//! `bahn test`: one program with its report, or a shelf of them as a table.
//!
//! - `options`: options and help; `bench`: from them to what programs run on;
//! - here: what is said of a single program. The table of many is [`crate::shelf`].

mod bench;
mod options;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use bahn_reader::Reader;
use bahn_report::record::{End, ErrorReport, Report};
use bahn_report::test_run::{Bench, Company, Outputs, Tested, write_page};
use bahn_report::text;
use bahn_viewer::Recording;
use bahn_workpiece::{Columns, Projection};

pub(crate) use bench::bench;
pub(crate) use options::{EXAMPLES, TestOptions};

use crate::cutting::{self, Written};
use crate::diagnostics;
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::progress::Progress;
use crate::settings::{self, Equipment};
use crate::{Outcome, UsageError, console, files};

/// What tests a shelf of programs.
type Shelf = fn(&TestOptions, Equipment) -> Result<Outcome, UsageError>;

/// Runs a program and reports, or leaves several programs to `shelf`.
pub(crate) fn command(mut options: TestOptions, shelf: Shelf) -> Result<Outcome, UsageError> {
    files::keep_inputs(&options.inputs(), &options.written())?;
    let equipment = Equipment::of_any_family(options.model, &options.machine, &options.run)?;
    options.model = equipment.list.model();
    settings::say_without_effect(&equipment.list, &options.machine.mp);
    match options.single() {
        Some(file) => single(&options, equipment, file),
        None if options.html.is_some() => Err(UsageError::new(
            "--html is the page of one program; --report OUT.html is that of a table".to_owned(),
        )),
        None => shelf(&options, equipment),
    }
}

fn single(options: &TestOptions, equipment: Equipment, file: &Path) -> Result<Outcome, UsageError> {
    let bench = bench(options, equipment, Columns::BySize)?;
    let interrupt = Interrupt::on_ctrl_c();
    let stop = interrupt.stop();
    if let Some(limit) = options.run.time_limit {
        stop.after(Duration::from_secs_f64(limit));
    }
    let company = Company {
        outputs: Outputs::create(&options.output.path, options.output.print.as_deref())?,
        follower: Some(Box::new(Progress::new(&interrupt))),
        survey: None,
        recording: options.html.as_ref().map(|_| Recording::default()),
        stop: stop.clone(),
    };
    let mut tested = bench.test(file, company)?;
    stop.run_is_over();
    let unwritten = tested.unwritten.take();
    let outcome = say(&mut tested, &bench, options, file, &interrupt.after_run())?;
    unwritten.map_or(Ok(outcome), |error| Err(error.into()))
}

/// Prints the report and writes picture and mesh.
fn say(
    tested: &mut Tested,
    bench: &Bench,
    options: &TestOptions,
    file: &Path,
    stop: &Arc<AtomicBool>,
) -> Result<Outcome, UsageError> {
    let report = &tested.report;
    if let Some(error) = &report.error {
        print_error(error, &*tested.reader, file);
    }
    match tested.end {
        End::Interrupted => diagnostics::print_line("interrupted: the report so far"),
        End::Late => diagnostics::print_line("the time limit is reached: the report so far"),
        _ => {}
    }
    let drawn = cutting::write(
        tested.part.as_ref(),
        &options.output,
        &format!("PGM {}", report.program),
        projection(bench),
        stop,
    );
    if let (Some(path), Some(recording)) = (&options.html, tested.recording.take()) {
        write_page(path, recording, tested, &bench.control())?;
    }
    let report = &tested.report;
    print_report(
        report,
        &bench.control(),
        options,
        matches!(drawn, Ok(Written::All)),
    )?;
    Ok(match drawn? {
        Written::All => outcome(&tested.end),
        Written::Interrupted => Outcome::Interrupted,
    })
}

/// The projection of the three planes.
pub(crate) fn projection(bench: &Bench) -> Projection {
    if bench.list.graphics().third_angle {
        Projection::ThirdAngle
    } else {
        Projection::FirstAngle
    }
}

fn outcome(end: &End) -> Outcome {
    match end {
        End::Completed | End::Stopped => Outcome::Fine,
        End::Interrupted => Outcome::Interrupted,
        End::Failed(_) | End::Late => Outcome::ProgramError,
    }
}

pub(crate) fn print_error(error: &ErrorReport, run: &dyn Reader, main: &Path) {
    let Some(program) = run.program(error.at.program) else {
        return;
    };
    // All programs of a run lie beside the main program.
    let path = match error.at.program {
        0 => main.to_owned(),
        _ => main.with_file_name(files::short_name(program)),
    };
    diagnostics::print_fault(&error.diagnostic(program, &path));
}

fn print_report(
    report: &Report,
    control: &str,
    options: &TestOptions,
    drawn: bool,
) -> Result<(), UsageError> {
    match options.format {
        Format::Text => {
            let mut written = options.output.names(drawn);
            written.extend(options.html.iter().map(|path| path.display().to_string()));
            console::print(&text::render(report, control, &written))
        }
        Format::Json => console::print_json(report),
    }
}
