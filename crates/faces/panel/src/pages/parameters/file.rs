//! The file of a list that is edited: which lists there are, and how one is read, written and put into effect.
//!
//! Decision: The lists of PGM NAME are the usual one and NAME.MP in the folder of the machine, as module 9033 knows
//! them; another list than the one in force, and one that was written meanwhile, goes into effect as a whole, with a
//! reset. A list with entries that PGM NAME leaves is checked and written as by END: one in force acts, another one
//! does not. Nothing is written while any channel runs a program

use std::collections::BTreeMap;
use std::path::PathBuf;

use bahn_host::{LoadedMachine, files};
use bahn_parameters::{ListError, ListText, ParameterId, ParameterList};
use bahn_text::Diagnostic;
use bahn_tnc::Renewed;

use crate::site::Site;

/// The lists of the machine: the usual one, and the files `NAME.MP` of its folder [000:14894-14896].
pub(super) fn names(site: &Site) -> Vec<String> {
    let usual = &site.machine.folder.parameters;
    let entries = std::fs::read_dir(&site.machine.root);
    let is_list = |name: &String| {
        name.ends_with(".MP") && name != usual && !name.bytes().any(|byte| byte.is_ascii_lowercase())
    };
    let found = entries.into_iter().flatten().flatten();
    let found = found.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_file()));
    let names = found.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> = names.filter(is_list).collect();
    names.sort();
    names.insert(0, usual.clone());
    names
}

/// The list in force: the usual one, or that which was selected.
pub(super) fn in_force(site: &Site) -> String {
    let selected = site.control().remember().parameter_list;
    selected.unwrap_or_else(|| site.machine.folder.parameters.clone())
}

/// What the editor has changed and not yet written.
#[derive(Default)]
pub(super) struct Entered {
    /// New values of parameters.
    pub values: BTreeMap<ParameterId, f64>,
    /// New comments of parameters [000:10017].
    pub comments: BTreeMap<ParameterId, String>,
    /// Lines that were taken away, from 1, with what stood there.
    pub removed: BTreeMap<usize, String>,
}

impl Entered {
    pub fn is_empty(&self) -> bool {
        self.values.is_empty() && self.comments.is_empty() && self.removed.is_empty()
    }
}

/// The file of a list.
pub(super) struct ListFile {
    /// Its name in the folder of the machine.
    pub name: String,
    path: PathBuf,
    /// What stood in it when the editor was opened.
    opened: Option<Vec<u8>>,
}

/// Why a list does not go into effect.
pub(super) enum Refused {
    /// A line of it cannot be read.
    Line(ListError),
    /// What is wrong with its values or its file, in words.
    Words(String),
}

impl ListFile {
    /// A list by its name.
    pub fn new(name: String, site: &Site) -> ListFile {
        let path = site.machine.root.join(&name);
        let opened = files::read_table(&path).ok();
        ListFile { name, path, opened }
    }

    /// Somebody has written it since: over a data interface, or a host.
    pub fn was_written(&self) -> bool {
        files::read_table(&self.path).ok() != self.opened
    }

    /// What stands in it; nothing where there is no file yet.
    pub fn text(&self, site: &Site) -> Result<ListText, String> {
        let model = site.control().model();
        let bytes = match self.path.try_exists() {
            Ok(false) => Ok(Vec::new()),
            _ => files::read_table(&self.path).map_err(|error| error.to_string()),
        };
        Ok(ListText::from_bytes(model, &bytes?))
    }

    /// What stands in it by now, with what was entered; its comments stay.
    pub fn with(&self, entered: &Entered, site: &Site) -> Result<ListText, String> {
        let mut text = self.text(site)?;
        for (id, value) in &entered.values {
            text.set(*id, *value).map_err(|error| error.to_string())?;
        }
        for (id, comment) in &entered.comments {
            text.set_comment(*id, comment);
        }
        // From the last one on, so that the others keep their numbers.
        for (line, was) in entered.removed.iter().rev() {
            if text.line(*line) == *was {
                text.remove_line(*line);
            }
        }
        Ok(text)
    }

    /// Writes a text, whole or not at all.
    pub fn write(&self, text: &ListText) -> Result<(), String> {
        files::write_whole(&self.path, &text.to_bytes()).map_err(|error| error.to_string())
    }

    /// Checks a text as a whole: no control is switched on with one that has a fault, or with which its machine cannot be.
    pub fn check(&self, text: &ListText, site: &Site) -> Result<ParameterList, Refused> {
        if let Some(fault) = text.faults().first() {
            return Err(Refused::Line(fault.clone()));
        }
        let mut list =
            ParameterList::reference(text.model()).with_equipment(site.machine.parameters.equipment());
        list.take(text);
        if let Some(found) = list.inconsistencies().iter().find(|found| found.impossible) {
            return Err(Refused::Words(format!("{}: {}", found.id, found.rule)));
        }
        // Another list than that of a channel is read as the usual one: whether the machine can be with it. What is wrong with
        // a list of another channel is entered there.
        let (root, folder) = (&site.machine.root, &site.machine.folder);
        let further = folder.channels.iter().map(|channel| &channel.parameters);
        let mut lists: Vec<&String> = further.chain([&folder.parameters]).collect();
        let own = lists.iter().position(|name| **name == self.name);
        let own = lists.swap_remove(own.unwrap_or(lists.len() - 1));
        let loaded = LoadedMachine::load_with_file(root, own, &text.to_bytes());
        let faults = loaded.map_err(|error| Refused::Words(error.to_string()))?.err();
        let is_elsewhere = |fault: &Diagnostic| lists.iter().any(|name| root.join(name) == fault.file);
        let mut faults = faults.into_iter().flatten();
        match faults.find(|fault| !is_elsewhere(fault)) {
            Some(fault) => Err(Refused::Words(fault.words())),
            None => Ok(list),
        }
    }

    /// The whole list goes into effect [000:10072-10074]; `false` when that is not possible now.
    pub fn put_into_effect(&self, list: ParameterList, site: &mut Site) -> bool {
        let name = (self.name != site.machine.folder.parameters).then(|| self.name.clone());
        site.host.renew(Renewed::List(name, Box::new(list)))
    }
}
