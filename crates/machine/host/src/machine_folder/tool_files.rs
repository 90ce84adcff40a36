//! Tool table and pocket table of a machine, and whether they fit its parameters.
//!
//! Decision: With MP7260 = 0 the tool table of machine.toml is not used, which is a warning: tools come from TOOL
//! DEF; the panel shows neither tool nor pocket table then (also `panel/src/pages/table/place.rs`)
//!
//! Decision: Tables that do not fit MP7226, MP7260, MP7261 or MP7264 are faults of the machine's folder, with line
//! and column

use std::collections::BTreeMap;

use bahn_machine::MachineFolder;
use bahn_parameters::ParameterList;
use bahn_parameters::operation::ToolParameters;
use bahn_text::{Diagnostic, decode};
use bahn_tnc::{NcFiles, Tool};

use super::load::{LoadedMachine, Loader};
use crate::{TableForm, files, pocket_table, tool_table};

/// The tools of a machine; `None` when they come from TOOL DEF.
pub(super) type Tools = Option<BTreeMap<u32, Tool>>;

/// Whether another tool or pocket table of a machine would fit machine parameters and the other of both
/// [000:9103-9113].
///
/// # Errors
/// What does not fit.
pub fn tools_fit(
    machine: &LoadedMachine,
    form: TableForm,
    text: &str,
    parameters: &ParameterList,
) -> Result<(), String> {
    let sizes = parameters.operation_parameters().tools;
    let first = |faults: Vec<Diagnostic>| {
        faults
            .first()
            .map_or_else(String::new, |fault| fault.message.clone())
    };
    let read = |name: &Option<String>| {
        let bytes = files::read_table(&machine.root.join(name.as_ref()?)).ok()?;
        Some(decode(&bytes))
    };
    let (tools, pockets) = match form {
        TableForm::Tool => (Some(text.to_owned()), read(&machine.folder.pockets)),
        TableForm::Pocket => (read(&machine.folder.tools), Some(text.to_owned())),
        _ => return Ok(()),
    };
    let Some(tools) = tools else { return Ok(()) };
    let table = tool_table::parse(&tools).map_err(first)?;
    tool_table::fits(&tools, &sizes).map_err(first)?;
    let Some(pockets) = pockets.filter(|_| sizes.pockets > 0) else {
        return Ok(());
    };
    let lines = pocket_table::parse(&pockets).map_err(first)?;
    pocket_table::fits(&pockets, &lines, &table, &sizes).map_err(first)
}

impl Loader<'_> {
    /// Reads tool table and pocket table; `None` when one of them is faulty.
    pub(super) fn tool_files(
        &mut self,
        folder: &MachineFolder,
        parameters: Option<&ParameterList>,
        files: &mut NcFiles,
    ) -> Option<Tools> {
        let Some(name) = &folder.tools else {
            if folder.pockets.is_some() {
                self.fault_at_key("pockets", "a pocket table needs a tool table (tools)");
            }
            return Some(None);
        };
        let sizes = parameters.map(|list| list.operation_parameters().tools);
        if sizes.as_ref().is_some_and(|sizes| sizes.table_size == 0) {
            // "The system will run without a tool table": tools come from TOOL DEF [000:9103].
            self.warning_at_key(
                "tools",
                "the control has no tool table (MP7260 = 0): it is not used",
            );
            return Some(None);
        }
        let path = self.named("tools", name)?;
        let mut tools = self.table(&path, "the tool table is wrong", |text| {
            let tools = tool_table::parse(text)?;
            if let Some(sizes) = &sizes {
                tool_table::fits(text, sizes)?;
            }
            Ok(tools)
        })?;
        // Without pockets there is no pocket table [000:9113].
        let pockets = sizes.as_ref().is_none_or(|sizes| sizes.pockets > 0);
        if let Some(name) = folder.pockets.as_ref().filter(|_| pockets) {
            self.pockets(name, &mut tools, sizes.as_ref(), files)?;
        }
        Some(Some(tools))
    }

    /// Reads the pocket table: from there on it says where the tools are.
    fn pockets(
        &mut self,
        name: &str,
        tools: &mut BTreeMap<u32, Tool>,
        sizes: Option<&ToolParameters>,
        files: &mut NcFiles,
    ) -> Option<()> {
        if let Some((tool, _)) = tools.iter().find(|(_, tool)| tool.pocket.is_some()) {
            let message =
                format!("the tool table has a pocket for tool {tool}, but {name} says where tools are");
            self.fault_at_key("pockets", &message);
            return None;
        }
        let path = self.named("pockets", name)?;
        let lines = self.table(&path, "the pocket table is wrong", |text| {
            let lines = pocket_table::parse(text)?;
            if let Some(sizes) = sizes {
                pocket_table::fits(text, &lines, tools, sizes)?;
            }
            Ok(lines)
        })?;
        pocket_table::put_away(&lines, tools, &mut files.pockets);
        Some(())
    }
}
