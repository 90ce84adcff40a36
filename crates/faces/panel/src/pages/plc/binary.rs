//! OUTPUT BINARY CODE: the list of what an EPROM is to have; EXT writes it as records for a programmer [000:11388-11412].
//!
//! Decision: EXT on the list of OUTPUT BINARY CODE writes the records beside it, as `bahn oem export` does; SELECT
//! .DI1/.ER1 names the file in `machine.toml`, whose texts stand there at once (also `panel/src/pages/plc/texts.rs`)

use bahn_host::eprom::{self, LoadList};

use super::editor::Editor;
use super::source;
use crate::page::Turn;
use crate::site::Site;

/// The list, among the files of the PLC.
const LIST: &str = "EPROM.A";
/// Ending of binary files [000:11345].
const ENDING: &str = ".BIN";

/// The list, with names that are there already when it is new.
pub(super) fn open(site: &mut Site) -> Turn {
    let names = source::list(site);
    if !names.iter().any(|name| name == LIST)
        && let Err(why) = source::create(LIST, preset(&names, site).as_bytes(), site)
    {
        return Turn::Say(why);
    }
    match Editor::open(LIST, 1, site) {
        Ok(editor) => Turn::Open(Box::new(editor.with_output(write))),
        Err(why) => Turn::Say(why),
    }
}

/// The PLC program, its messages and dialogues, under a number that is to be overwritten.
fn preset(names: &[String], site: &Site) -> String {
    let main = source::main_file(site);
    let mut text = format!("IDENT 000 000 00\nLOAD {main}/M\n");
    for name in names.iter().filter(|name| super::texts::is_text(name)) {
        text = text + "LOAD " + name + "\n";
    }
    text
}

/// EXT on the list: no interface has a device, so that the records become a file beside it.
fn write(text: &str, site: &Site) -> Turn {
    let line = |line: u32, message: &str| Turn::Say(format!("{LIST}:{line} {message}"));
    let list = match LoadList::parse(text) {
        Ok(list) => list,
        Err(faults) => {
            let first = faults.first();
            return first.map_or(Turn::Refused, |fault| line(fault.span.line, &fault.message));
        }
    };
    let (contents, faults) = match eprom::contents(site.machine, &list) {
        Ok(found) => found,
        Err(error) => return Turn::Say(error.to_string()),
    };
    if let Some(fault) = faults.first() {
        return line(fault.span.line, &fault.message);
    }
    let name = format!("{}{ENDING}", list.ident);
    let image = match list.image(&contents) {
        Ok(image) => image,
        Err(why) => return Turn::Say(why),
    };
    match source::replace(&name, &image.to_records(), site) {
        Ok(()) => Turn::Say(format!("{name}: {} {}", image.bytes.len(), site.words("BYTES"))),
        Err(why) => Turn::Say(why),
    }
}
