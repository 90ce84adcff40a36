//! The text of such a file: read, checked, written and put into force.

use std::path::{Path, PathBuf};

use bahn_host::{LoadedMachine, files};
use bahn_parameters::MessageId;
use bahn_text::decode;
use bahn_tnc::{
    CompensationAssignment, CompensationError, CompensationFiles, CompensationTable, CorrectionTables,
    Renewed,
};

use crate::pages::description;
use crate::site::Site;

/// DATUM and DIST of a new table (inferred).
pub(super) const NEW_HEAD: &str = "MM DATUM 0 DIST 16";

/// What stands in a file of axis errors.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// A compensation table (.COM).
    Table,
    /// Which table counts for which axis (.CMA).
    Assignment,
    /// The correction tables of code number 105 296.
    Corrections,
}

impl Kind {
    fn check(self, text: &str) -> Result<(), CompensationError> {
        match self {
            Kind::Table => CompensationTable::read(text).map(drop),
            Kind::Assignment => CompensationAssignment::read(text).map(drop),
            Kind::Corrections => CorrectionTables::read(text).map(drop),
        }
    }
}

/// A file of axis errors.
#[derive(Clone)]
pub(super) struct ErrorFile {
    kind: Kind,
    path: PathBuf,
}

impl ErrorFile {
    pub fn new(kind: Kind, path: &Path) -> ErrorFile {
        let path = path.to_owned();
        ErrorFile { kind, path }
    }

    /// How machine.toml names it.
    pub fn named(&self, site: &Site) -> String {
        let path = self.path.strip_prefix(&site.machine.root).unwrap_or(&self.path);
        path.to_string_lossy().replace('\\', "/")
    }

    /// Its lines without empty ones.
    ///
    /// # Errors
    /// In words: it cannot be read, or one of its lines.
    pub fn lines(&self) -> Result<Vec<String>, String> {
        let bytes = files::read_table(&self.path).map_err(|error| error.to_string())?;
        let text = decode(&bytes);
        let checked = self.kind.check(&text);
        checked.map_err(|error| format!("{}: {error}", self.path.display()))?;
        Ok(lines(&text))
    }

    /// Writes a text, and lets it act.
    ///
    /// # Errors
    /// In words: a line of it is incorrect, or the machine could not be switched on again with it. The file stays as it was.
    pub fn store(&self, text: &str, site: &mut Site) -> Result<(), String> {
        self.store_by(description::loaded, text, site)
    }

    /// The same where the machine with the text comes from something that goes with it, or is undone with it.
    ///
    /// # Errors
    /// As [`ErrorFile::store`].
    pub fn store_by(
        &self,
        load: impl FnOnce(&Site) -> Result<LoadedMachine, String>,
        text: &str,
        site: &mut Site,
    ) -> Result<(), String> {
        if let Err(error) = self.kind.check(text) {
            let incorrect = site.message(MessageId::EntryValueIncorrect);
            return Err(format!("{incorrect}: {}", error.what));
        }
        let before = files::read_table(&self.path).map_err(|error| error.to_string())?;
        files::write_text(&self.path, text).map_err(|error| error.to_string())?;
        match load(site) {
            Ok(machine) => {
                act(machine, site);
                Ok(())
            }
            Err(why) => {
                files::write_whole(&self.path, &before).map_err(|error| error.to_string())?;
                Err(why)
            }
        }
    }
}

/// The tables of a machine act from now on.
pub(super) fn act(machine: LoadedMachine, site: &mut Site) {
    let files = CompensationFiles {
        assignment: machine.files.compensation,
        tables: machine.files.compensation_tables,
        correction_tables: machine.files.correction_tables,
    };
    site.host.renew(Renewed::Compensation(Box::new(files)));
}

fn lines(text: &str) -> Vec<String> {
    let lines = text.lines().map(str::trim_end);
    lines.filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

/// The lines as a file, each with its end.
pub(super) fn text_of(lines: &[String]) -> String {
    lines.iter().map(|line| format!("{line}\n")).collect()
}
