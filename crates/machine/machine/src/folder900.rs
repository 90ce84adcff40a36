//! The folder of a machine with a System 900: which file is what.
//!
//! Decision: A folder belongs to a System 900 when its `machine.toml` has the key `control`, which no other family needs

use bahn_text::{Diagnostic, Span};

use crate::MachineFolder;
use crate::reader::{Reader, Section};

/// What `machine.toml` in the folder of a machine with a System 900 says. Paths count from the folder; no file is opened here.
///
/// ```
/// use bahn_machine::Folder900;
/// let text = "name = 'portal'\ncontrol = 'system900'\nparameters = 'parameters.q'\nbeam = 2";
/// assert_eq!(Folder900::named_at(text).map(|span| span.line), Some(2));
/// let (folder, faults) = Folder900::read(text);
/// assert_eq!(folder.programs, "programs");
/// assert!(faults[0].to_string().starts_with("4:1: unknown key `beam` here"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder900 {
    /// Name of the machine for people.
    pub name: String,
    /// The data file with the parameters.
    pub parameters: String,
    /// Folder of part programs and cycles.
    pub programs: String,
}

impl Folder900 {
    /// What `control` says.
    const CONTROL: &str = "system900";

    /// Where the text of a `machine.toml` says that it describes a machine of this family, however many faults it has; `None`
    /// for one of a TNC.
    pub fn named_at(text: &str) -> Option<Span> {
        let reader = Reader::new(text);
        let table = reader.parse();
        let key = table.get_ref().get_key_value("control")?.0;
        Some(reader.place(key.span().start))
    }

    /// Reads the text of `machine.toml` as far as it can be understood, with all faults in its order. What is missing is empty.
    pub fn read(text: &str) -> (Folder900, Vec<Diagnostic>) {
        let reader = Reader::new(text);
        let table = reader.parse();
        let root = Section::root(&reader, &table);
        let needed = |key| {
            if !root.has(key) {
                root.fault(format!("the machine needs {key}"));
            }
            root.text(key).unwrap_or_default().to_owned()
        };
        if root
            .text("control")
            .is_some_and(|control| control != Folder900::CONTROL)
        {
            root.fault_at(
                "control",
                format!(
                    "the only control here is \"{}\"; a TNC is named by `model`",
                    Folder900::CONTROL
                ),
            );
        }
        let folder = Folder900 {
            name: needed("name"),
            parameters: needed("parameters"),
            programs: root.text("programs").unwrap_or("programs").to_owned(),
        };
        root.finish();
        (folder, reader.faults())
    }

    /// The name of the file in the folder.
    pub const FILE: &str = MachineFolder::FILE;
}
