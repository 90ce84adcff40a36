//! COMPILE: the program as it lies on the medium, and the list of its errors [000:11478-11480].

use std::sync::Arc;

use bahn_host::PlcSource;
use bahn_plc::{Options, ProgramMemory};
use bahn_text::{Diagnostic, Severity};
use bahn_tnc::Renewed;

use super::editor::Editor;
use super::source;
use crate::page::Turn;
use crate::pages::description;
use crate::pages::menu::{Item, Items, Menu};
use crate::site::Site;

/// Compiles a main file and what it links. It has the status M then: it is the main file of the machine [000:14608], and runs
/// from the next power-on.
pub(super) fn run(name: &str, site: &mut Site) -> Turn {
    let mut compiled = source_of(name, site);
    let faults = compiled.faults().into_iter();
    let faults: Vec<Fault> = faults.map(|fault| Fault::of(&fault, site)).collect();
    let Some(program) = compiled.compilation.program.take() else {
        return Turn::Replace(Box::new(Menu::new(Faults { faults })));
    };
    let bytes = compiled.compilation.size_bytes;
    let said = format!(
        "{name}: 0 {}, {bytes} {}",
        site.words("ERRORS"),
        site.words("BYTES")
    );
    if name != source::main_file(site)
        && let Err(why) = description::set(source::MAIN, &source::named(name, site), site)
    {
        return Turn::CloseSaying(why);
    }
    let program = Arc::new(program);
    site.host.renew(Renewed::Plc(Arc::clone(&program)));
    site.plc.compiled = Some(program);
    Turn::CloseSaying(format!(
        "{said}; {}",
        site.words("COMPILED, RUNS FROM THE NEXT POWER-ON")
    ))
}

/// A main file and what it links, compiled as the machine does it.
pub(super) fn source_of(name: &str, site: &Site) -> PlcSource {
    let memory = match site.parameters().plc_parameters().from_eprom {
        true => ProgramMemory::Eprom,
        false => ProgramMemory::Ram,
    };
    let options = Options::for_model(site.control().model())
        .stored_in(memory)
        .with_equipment(site.parameters().equipment());
    PlcSource::compile(&source::path(name, site), None, options)
}

/// The directory, with the cursor on the main file of the machine.
pub(super) fn open(site: &Site) -> Turn {
    let mut names = source::list(site);
    names.retain(|name| source::is_source(name));
    let main = source::main_file(site);
    let at = names.iter().position(|name| *name == main).unwrap_or(0);
    Turn::Open(Box::new(Menu::at(Programs { names }, at)))
}

struct Programs {
    names: Vec<String>,
}

impl Items for Programs {
    fn title(&self, site: &Site) -> String {
        site.words("PLC FILES: COMPILE")
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let main = source::main_file(site);
        let runtime = |name: &String| match *name == main {
            true => Item::new(name.clone(), format!("M {}", site.words("RUNTIME PGM"))),
            false => Item::new(name.clone(), ""),
        };
        self.names.iter().map(runtime).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        match self.names.get(place) {
            Some(name) => run(name, site),
            None => Turn::Refused,
        }
    }
}

struct Fault {
    file: String,
    line: u32,
    text: String,
}

impl Fault {
    /// In the words of `bahn plc check`.
    fn of(fault: &Diagnostic, site: &Site) -> Fault {
        let file = fault
            .file
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        // "INPUT ERROR n", with its number [000:11919].
        let kind = match fault.severity {
            Severity::Error => format!("{} ", site.words("INPUT ERROR")),
            Severity::Warning => "warning: ".to_owned(),
        };
        Fault {
            text: format!("{kind}{}", fault.words()),
            line: fault.span.line,
            file,
        }
    }
}

/// The list: ENT opens the file at the line.
struct Faults {
    faults: Vec<Fault>,
}

impl Items for Faults {
    fn title(&self, site: &Site) -> String {
        site.words("COMPILE: ERRORS")
    }

    fn items(&self, _site: &Site) -> Vec<Item> {
        let item = |fault: &Fault| Item::new(format!("{}:{} {}", fault.file, fault.line, fault.text), "");
        self.faults.iter().map(item).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        let Some(fault) = self.faults.get(place) else {
            return Turn::Refused;
        };
        match Editor::open(&fault.file, fault.line as usize, site) {
            Ok(editor) => Turn::Replace(Box::new(editor)),
            Err(why) => Turn::Say(why),
        }
    }
}
