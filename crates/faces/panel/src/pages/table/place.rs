//! Where tables lie, and who may see and change them.

use std::path::PathBuf;

use bahn_host::TableForm;
use bahn_screen::programs::Entry;

use crate::pages::description;
use crate::site::Site;

/// Names of the tables of the machine in the directory, as a control has them [000:9002-9008].
pub(super) const TOOL_FILE: &str = "TOOL.T";
pub(super) const POCKET_FILE: &str = "TOOL_P.TCH";

/// The entry of machine.toml that names the file of the tool table.
pub(super) const TOOLS: &str = "tools";

/// Where a table lies.
pub(super) fn path_of(name: &str, site: &Site) -> Option<PathBuf> {
    let sizes = site.parameters().operation_parameters().tools;
    let named = |own: &String| site.machine.root.join(own);
    let folder = &site.machine.folder;
    match name {
        // Without tools in it there is no TOOL.T, and no pocket has one of it [000:9103].
        TOOL_FILE | POCKET_FILE if sizes.table_size == 0 => None,
        // It may have been made since the machine was loaded.
        TOOL_FILE => folder.tools.as_ref().map(named).or_else(|| made(site)),
        POCKET_FILE if sizes.pockets > 0 => folder.pockets.as_ref().map(named),
        POCKET_FILE => None,
        _ => site.programs.path(name).filter(|path| path.is_file()),
    }
}

fn made(site: &Site) -> Option<PathBuf> {
    let name = description::value(TOOLS, site)?;
    Some(site.machine.root.join(name))
}

/// The tables of the machine that lie beside the program memory, for the directory.
pub(crate) fn of_machine(site: &Site) -> Vec<Entry> {
    let entry = |name: &str| {
        let size = path_of(name, site)?.metadata().ok()?.len();
        Some(Entry {
            name: name.to_owned(),
            size,
            protected: is_protected(name, site),
        })
    };
    [TOOL_FILE, POCKET_FILE].into_iter().filter_map(entry).collect()
}

/// A table of the machine that lies beside the program memory.
pub(crate) fn is_of_machine(name: &str, site: &Site) -> bool {
    matches!(name, TOOL_FILE | POCKET_FILE) && path_of(name, site).is_some()
}

/// A file that holds a table, by its name.
pub(crate) fn is_table(name: &str) -> bool {
    form_of(name).is_some()
}

pub(super) fn form_of(name: &str) -> Option<TableForm> {
    let (_, ending) = name.rsplit_once('.')?;
    let is_meant = |form: &TableForm| form.ending().eq_ignore_ascii_case(ending);
    TableForm::ALL.into_iter().find(is_meant)
}

/// MP7224.1 protects the files of a type [000:6870-6880]; the code number took that of this file away.
pub(crate) fn is_protected(name: &str, site: &Site) -> bool {
    let types = site.parameters().table_parameters().types;
    types.is_protected(type_of(name)) && !site.settings.unprotected.contains(name)
}

/// MP7224.0 lets nobody see the files of a type [000:6857-6868].
pub(crate) fn is_disabled(name: &str, site: &Site) -> bool {
    let types = site.parameters().table_parameters().types;
    types.is_disabled(type_of(name))
}

/// The ending by which MP7224 knows a file.
pub(super) fn type_of(name: &str) -> &str {
    match form_of(name) {
        Some(form) => form.protected_with(),
        None => name.rsplit_once('.').map_or("", |(_, ending)| ending),
    }
}

/// There is such a table, and MP7224.0 does not disable it [000:9101].
pub(super) fn is_open_to_all(name: &str, site: &Site) -> bool {
    path_of(name, site).is_some() && !is_disabled(name, site)
}
