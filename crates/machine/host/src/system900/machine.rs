//! Everything that belongs to a machine with a System 900, from its folder; all faults of all files at once.

use std::path::{Path, PathBuf};

use bahn_control900::{Plc900, StandardAnswers};
use bahn_machine::{Answer900, Folder900, Machine, Plant900};
use bahn_system900::{AxisBlock, AxisParameter, Checked, Connection, DataFile, LOGICAL_AXES, Memory, check};
use bahn_text::{Diagnostic, Severity, Span, decode};

use super::ideal::IdealMachine;
use super::plc;
use crate::any_plant::AnyPlant;
use crate::{HostError, files};

/// A machine with a System 900.
pub struct Machine900 {
    /// The folder.
    pub root: PathBuf,
    /// What `machine.toml` says.
    pub folder: Folder900,
    /// Its parameters.
    pub parameters: DataFile,
    /// The channels with their axes, and what of the parameters looks wrong.
    pub checked: Checked,
    /// The plant, where a file describes it.
    described: Option<Machine>,
    /// The PLC program with its window; `None` without one.
    pub plc: Option<Plc900>,
    /// What is accepted of the PLC program, but looks wrong.
    plc_warnings: Vec<Diagnostic>,
}

impl Machine900 {
    /// Whether a folder describes a machine of this family.
    pub fn is_meant(root: &Path) -> bool {
        let bytes = files::read_description(&root.join(Folder900::FILE));
        bytes.is_ok_and(|bytes| Folder900::named_at(&decode(&bytes)).is_some())
    }

    /// Loads the machine of a folder; the inner `Err` holds every fault of every file.
    ///
    /// # Errors
    /// When there is no such folder or no `machine.toml` in it.
    pub fn load(root: &Path) -> Result<Result<Machine900, Vec<Diagnostic>>, HostError> {
        let file = root.join(Folder900::FILE);
        let text = decode(&files::read_description(&file)?);
        let (folder, faults) = Folder900::read(&text);
        let mut faults: Vec<Diagnostic> = faults
            .into_iter()
            .map(|fault| fault.in_text(&file, &text))
            .collect();
        if folder.parameters.is_empty() {
            return Ok(Err(faults));
        }
        let data = root.join(&folder.parameters);
        let parameters = match files::read_table(&data) {
            Ok(bytes) => DataFile::read(&bytes),
            Err(error) => {
                faults.push(Diagnostic::error(Span::default(), error.to_string()).at(&data, ""));
                return Ok(Err(faults));
            }
        };
        let checked = check(&parameters);
        let errors = checked.errors().cloned();
        faults.extend(errors.map(|fault| fault.in_text(&data, parameters.text())));
        let described = match described(root, &folder) {
            Ok(described) => described,
            Err(more) => {
                faults.extend(more);
                None
            }
        };
        let plc::Found { plc, warnings } = plc::load(root, &folder, parameters.memory(), &text, &mut faults);
        match faults.is_empty() {
            true => Ok(Ok(Machine900 {
                root: root.to_owned(),
                folder,
                parameters,
                checked,
                described,
                plc,
                plc_warnings: warnings,
            })),
            false => Ok(Err(faults)),
        }
    }

    /// The main file of the PLC program of a folder, whatever else is wrong there; `None` without one.
    ///
    /// # Errors
    /// When there is no `machine.toml`.
    pub fn plc_file(root: &Path) -> Result<Option<PathBuf>, HostError> {
        let text = decode(&files::read_description(&root.join(Folder900::FILE))?);
        let (folder, _) = Folder900::read(&text);
        Ok(folder.plc.map(|plc| root.join(plc.text)))
    }

    /// The folder of its part programs and cycles.
    pub fn programs(&self) -> PathBuf {
        self.root.join(&self.folder.programs)
    }

    /// Files that are read, beside its programs.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let plant = match &self.folder.plant {
            Plant900::File(file) => Some(self.root.join(file)),
            Plant900::Ideal => None,
        };
        let own = [Folder900::FILE, &self.folder.parameters].map(|file| self.root.join(file));
        let plc = self.folder.plc.iter().map(|plc| self.root.join(&plc.text));
        own.into_iter().chain(plant).chain(plc).collect()
    }

    /// What answers in the place of a PLC.
    pub fn answers(&self) -> StandardAnswers {
        let has = |answer| self.folder.answers.contains(&answer);
        StandardAnswers {
            enable: has(Answer900::Enable),
            mode: has(Answer900::Mode),
            start: has(Answer900::Start),
            m: has(Answer900::M),
            tools: has(Answer900::Tools),
        }
    }

    /// The plant as its file describes it, or an ideal one.
    ///
    /// Decision: The axes of a plant whose encoders know their position at power-on, P12015, stand where P12152 says: nobody has moved
    /// them since
    pub fn plant(&self, memory: &Memory) -> AnyPlant {
        match &self.described {
            Some(described) => {
                let mut plant = described.clone();
                let mut mechanics = plant.mechanics();
                for (axis, place) in described.axes().zip(&mut mechanics.axis) {
                    if let Some(position) = position_at_start(memory, axis.output) {
                        (place.table, place.motor) = (position, position);
                    }
                }
                // Beyond its travel an axis stays where its file has it.
                let _ = plant.stand_at(&mechanics);
                AnyPlant::new(plant)
            }
            None => AnyPlant::new(IdealMachine::of(self.parameters.memory())),
        }
    }

    /// What is accepted, but looks wrong.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let data = self.root.join(&self.folder.parameters);
        let all = self.checked.faults.iter();
        let warnings = all.filter(|fault| fault.severity != Severity::Error).cloned();
        let text = self.parameters.text();
        let own = warnings.map(|fault| fault.in_text(&data, text));
        own.chain(self.plc_warnings.iter().cloned()).collect()
    }
}

/// Where the axis at an output, from 0, was at power-off, as far as it knows that.
fn position_at_start(memory: &Memory, output: usize) -> Option<f64> {
    let is_there = |physical: &u8| {
        let block = AxisBlock::of(memory, *physical);
        block.connection != Connection::None && block.is_absolute && usize::from(block.output) == output + 1
    };
    let physical = (1..=LOGICAL_AXES as u8).find(is_there)?;
    memory.of_axis(physical, AxisParameter::ActualPosition).number()
}

/// The plant of a file; `None` for an ideal one.
fn described(root: &Path, folder: &Folder900) -> Result<Option<Machine>, Vec<Diagnostic>> {
    let Plant900::File(file) = &folder.plant else {
        return Ok(None);
    };
    let path = root.join(file);
    let bytes = files::read_description(&path)
        .map_err(|error| vec![Diagnostic::error(Span::default(), error.to_string()).at(&path, "")])?;
    let text = decode(&bytes);
    Machine::with_numbered_axes(&text).map(Some).map_err(|faults| {
        let faults = faults.into_iter();
        faults.map(|fault| fault.in_text(&path, &text)).collect()
    })
}
