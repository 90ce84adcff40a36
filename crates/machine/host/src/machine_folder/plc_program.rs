//! Which PLC program a machine runs: that of its folder, or the standard program of its control.
//!
//! Decision: On TNC 151/155 MP77 = 1 takes the image of the program in the folder EPROM, and where there is none the
//! standard program; `plc = "standard"` is the standard program whatever MP77 is

use std::path::Path;
use std::sync::Arc;

use bahn_machine::MachineFolder;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Options, PlcProgram, ProgramMemory, standard_program};

use super::load::Loader;
use crate::plc_source::PlcSource;

/// The name under which messages show it.
const STANDARD_FILE: &str = "STANDARD.PLC";

impl Loader<'_> {
    /// The PLC program that `plc` of `machine.toml` and the list of machine parameters choose.
    pub(super) fn plc_program(
        &mut self,
        folder: &MachineFolder,
        model: ControlModel,
        parameters: Option<&ParameterList>,
    ) -> Option<Arc<PlcProgram>> {
        let reference = || ParameterList::reference(model).plc_parameters();
        let plc = parameters.map_or_else(reference, ParameterList::plc_parameters);
        let memory = match plc.from_eprom {
            true => ProgramMemory::Eprom,
            false => ProgramMemory::Ram,
        };
        // The standard program comes with the control, whatever is fitted to it.
        let delivered = Options::for_model(model).stored_in(memory);
        let options = delivered.with_equipment(self.equipment);
        let Some(name) = folder.plc_file() else {
            return self.standard(model, delivered);
        };
        let old = model.limits().has_old_numbers();
        if old && memory == ProgramMemory::Eprom {
            return match PlcSource::eprom_image(&self.root.join(name)) {
                Some(image) => self.compiled(&image, None, options),
                None => self.standard(model, delivered),
            };
        }
        let (path, _) = self.read("plc", name)?;
        self.compiled(&path, None, options)
    }

    fn standard(&mut self, model: ControlModel, options: Options) -> Option<Arc<PlcProgram>> {
        let Some(text) = standard_program(model) else {
            let message = format!("the {} has no standard PLC program", model.name());
            self.fault_at_key("plc", &message);
            return None;
        };
        let path = self.root.join(STANDARD_FILE);
        self.compiled(&path, Some(text.as_bytes().to_vec()), options)
    }

    fn compiled(&mut self, path: &Path, bytes: Option<Vec<u8>>, options: Options) -> Option<Arc<PlcProgram>> {
        let mut source = PlcSource::compile(path, bytes, options);
        self.sort(source.faults());
        source.compilation.program.take().map(Arc::new)
    }
}
