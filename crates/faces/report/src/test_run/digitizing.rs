//! Digitizing in a test run: the stylus scans the part as far as it is machined.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_motion::{Scan, ScanStep, Sense};
use bahn_path::{ScanFault, ScanJob, ScanPoint, Scanned};
use bahn_program::DigitizedText;
use bahn_workpiece::{Feeler, Part};

use crate::ReportError;
use crate::stop::Stop;
use bahn_host::files::{self, NewFile};

/// Contour cycle of the scan, s: that of a TNC 407.
const CYCLE_S: f64 = 6e-3;
/// Acceleration of the axes, m/s² (inferred).
const ACCELERATION_M_S2: f64 = 1.0;
/// Halvings that find a touch within a cycle.
const HALVINGS: u32 = 12;
/// Cycles after which somebody may have interrupted the run.
const PATIENCE: u64 = 10_000;

/// A scan that was done.
pub struct Digitized {
    /// How it ended; `None` when it was interrupted.
    pub scanned: Option<Scanned>,
    pub points: u64,
    pub time_s: f64,
}

/// Scans a part; the program is written into a folder when one is given, and stays there when the scan came to its end.
///
/// # Errors
/// When the program cannot be written.
pub fn digitize(
    job: &ScanJob,
    part: Arc<Part>,
    folder: Option<&Path>,
    stop: &Stop,
) -> Result<Digitized, ReportError> {
    let mut file = match folder {
        Some(folder) => Some(Program::create(folder, job)?),
        None => None,
    };
    let mut scan = Scan::new(*job, ACCELERATION_M_S2);
    let feeler = Feeler::new(part, job.stylus_radius_mm);
    let mut sense = Sense {
        at: scan.position(),
        ..Sense::default()
    };
    sense.deflected = feeler.touches(&sense.at);
    if sense.deflected {
        scan.break_off(ScanFault::AlreadyInContact);
    }
    let mut cycles = 0u64;
    loop {
        let step = scan.cycle(CYCLE_S, &sense, 1.0);
        cycles += 1;
        match step {
            ScanStep::Moves => {}
            ScanStep::Point(point) => {
                if let Some(file) = &mut file {
                    file.point(&point)?;
                }
            }
            ScanStep::Over(scanned) => {
                if let Some(file) = file.filter(|_| scanned.fault.is_none()) {
                    file.finish()?;
                }
                return Ok(Digitized {
                    scanned: Some(scanned),
                    points: scan.points(),
                    time_s: cycles as f64 * CYCLE_S,
                });
            }
        }
        if cycles.is_multiple_of(PATIENCE) && stop.is_requested() {
            return Ok(Digitized {
                scanned: None,
                points: scan.points(),
                time_s: cycles as f64 * CYCLE_S,
            });
        }
        sense = feel(&feeler, &sense, scan.position());
        if job.rules.measuring.is_some() {
            sense.deflection = feeler.deflection(&sense.at);
        }
    }
}

/// What the stylus feels when its tip has gone on.
fn feel(feeler: &Feeler, before: &Sense, at: ScanPoint) -> Sense {
    let deflected = feeler.touches(&at);
    let touch = (deflected && !before.deflected).then(|| {
        let (mut free, mut touches) = (before.at, at);
        for _ in 0..HALVINGS {
            let middle: ScanPoint = std::array::from_fn(|k| (free[k] + touches[k]) / 2.0);
            if feeler.touches(&middle) {
                touches = middle;
            } else {
                free = middle;
            }
        }
        touches
    });
    Sense {
        deflected,
        at,
        touch,
        deflection: [0.0; 3],
    }
}

/// The program that takes the points.
struct Program {
    text: DigitizedText,
    file: NewFile,
    path: PathBuf,
    line: String,
}

impl Program {
    fn create(folder: &Path, job: &ScanJob) -> Result<Program, ReportError> {
        let path = folder.join(format!("{}.H", job.program.as_str()));
        let mut program = Program {
            text: DigitizedText::new(*job),
            file: NewFile::create(&path)?,
            path,
            line: String::new(),
        };
        program.line = program.text.begin();
        program.write()?;
        Ok(program)
    }

    fn point(&mut self, point: &ScanPoint) -> Result<(), ReportError> {
        self.text.point(&mut self.line, point);
        self.write()
    }

    fn write(&mut self) -> Result<(), ReportError> {
        let written = self.file.write_all(self.line.as_bytes());
        self.line.clear();
        written.map_err(|error| files::cannot("write", &self.path, &error).into())
    }

    fn finish(mut self) -> Result<(), ReportError> {
        self.line = self.text.end();
        self.write()?;
        Ok(self.file.finish()?)
    }
}
