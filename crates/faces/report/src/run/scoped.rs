//! The oscilloscope of the control beside a run [000:18638-18794].

use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_host::files::{self, NewFile};
use bahn_host::oscilloscope::{Oscilloscope, OscilloscopeRecord, OscilloscopeSetup};
use bahn_tnc::{OscilloscopeKeys, ServoSampler};

use crate::ReportError;

/// An oscilloscope and the file of its memory.
pub struct Scoped {
    path: PathBuf,
    file: NewFile,
    scope: Oscilloscope,
    /// How often START was pressed.
    starts: u32,
}

impl Scoped {
    /// An oscilloscope that is set up, whose memory goes into a file.
    ///
    /// # Errors
    /// When the oscilloscope cannot be set up so, or the file not be created.
    pub fn new(path: &Path, setup: OscilloscopeSetup) -> Result<Scoped, ReportError> {
        let scope = Oscilloscope::new(setup).map_err(ReportError::new)?;
        Ok(Scoped {
            file: NewFile::create(path)?,
            path: path.to_owned(),
            scope,
            starts: 0,
        })
    }

    /// Who looks at the servo steps, from START on: that of the operator once the code number was entered, else that of
    /// the program.
    pub(super) fn sampler(&mut self, started: bool, keys: OscilloscopeKeys) -> &mut dyn ServoSampler {
        if !keys.open {
            if started {
                self.scope.start();
            }
        } else if !keys.records {
            self.scope.stop();
        } else if keys.starts != self.starts {
            self.starts = keys.starts;
            self.scope.start_anew();
        }
        &mut self.scope
    }

    /// Writes the memory, and says what it holds.
    pub(super) fn finish(mut self, say: &mut dyn FnMut(&str)) -> Result<(), ReportError> {
        let record = self.scope.record();
        self.file
            .write_all(record.csv().as_bytes())
            .map_err(|error| files::cannot("write", &self.path, &error))?;
        say(&said(&record));
        Ok(self.file.finish()?)
    }
}

/// What the memory holds.
fn said(record: &OscilloscopeRecord) -> String {
    let count = record.samples.len();
    let sample_ms = f64::from(record.sample_us) * 1e-3;
    let seconds = count as f64 * sample_ms * 1e-3;
    let trigger = match record.trigger {
        Some(sample) => format!("trigger at sample {sample}"),
        None => "no trigger".to_owned(),
    };
    format!("oscilloscope: {count} samples of {sample_ms} ms ({seconds:.4} s), {trigger}")
}
