//! Table editor: tools, pockets, datums, pallets, points, cell by cell. What is entered is checked, on the medium at once,
//! and counts in the control at once as far as the table is in use [000:8994-9192].
//!
//! Decision: Tables open with EDIT ON; RESET POCKET TABLE asks, and leaves what the pockets are. The file that a
//! figure calls TOOL.P is TOOL_P.TCH: .P are pallet tables

mod cells;
mod editor;
mod made;
mod page;
mod place;
mod store;

use bahn_parameters::MessageId;

use crate::page::Turn;
use crate::pages::ask::Choice;
use crate::site::Site;
use editor::TableEditor;

use place::{POCKET_FILE, TOOL_FILE};
use store::store;

use place::{form_of, is_open_to_all, path_of};
pub(crate) use place::{is_disabled, is_of_machine, is_protected, is_table, of_machine};

/// The tool table: program 0, and the soft key TOOL TABLE [003:1897].
pub(crate) fn tools(site: &mut Site) -> Turn {
    match has_tools(site) && path_of(TOOL_FILE, site).is_none() {
        true => ask_to_make(site),
        false => open(TOOL_FILE, site),
    }
}

/// There should be a tool table, but the machine has no file of it.
fn ask_to_make(site: &Site) -> Turn {
    let ask = site.words("THE MACHINE HAS NO TOOL TABLE: MAKE IT = ENT / END = NO ENT");
    Turn::Open(Choice::confirm(ask, "ENT".to_owned(), |site| {
        match made::make(site) {
            Ok(()) => match open(TOOL_FILE, site) {
                Turn::Open(page) => Turn::Replace(page),
                Turn::Say(why) => Turn::CloseSaying(why),
                other => other,
            },
            Err(why) => Turn::CloseSaying(why),
        }
    }))
}

/// The machine has a tool table that is not disabled: MP7260 says so, also where its file is still to be made [000:9103].
pub(crate) fn has_tools(site: &Site) -> bool {
    let sizes = site.parameters().operation_parameters().tools;
    sizes.table_size > 0 && !is_disabled(TOOL_FILE, site)
}

/// Opens the editor of the pocket table.
pub(crate) fn pockets(site: &mut Site) -> Turn {
    open(POCKET_FILE, site)
}

/// Opens the editor of a table.
pub(crate) fn open(name: &str, site: &mut Site) -> Turn {
    let missing = |site: &Site| Turn::Say(site.message(MessageId::ProgramNotFound));
    let path = path_of(name, site).filter(|_| !is_disabled(name, site));
    let (Some(path), Some(form)) = (path, form_of(name)) else {
        return missing(site);
    };
    match TableEditor::read(name, path, form, site) {
        Ok(editor) => Turn::Open(Box::new(editor)),
        Err(why) => Turn::Say(why),
    }
}
