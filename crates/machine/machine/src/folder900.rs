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
/// let text = "name = 'portal'\ncontrol = 'system900'\nparameters = 'parameters.q'\nanswers = ['mode', 'lunch']";
/// assert_eq!(Folder900::named_at(text).map(|span| span.line), Some(2));
/// let (folder, faults) = Folder900::read(text);
/// assert_eq!(folder.programs, "programs");
/// let said = "4:20: `lunch` is no standard answer; there are enable, mode, start, m, tools";
/// assert!(faults.iter().any(|fault| fault.to_string() == said));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder900 {
    /// Name of the machine for people.
    pub name: String,
    /// The data file with the parameters.
    pub parameters: String,
    /// Description of the simulated machine, or [`Folder900::IDEAL`].
    pub plant: Option<String>,
    /// Folder of part programs and cycles.
    pub programs: String,
    /// Folder of what survives power-off.
    pub state: String,
    /// The answers that stand for a PLC program; all of them without the key.
    pub answers: Vec<Answer>,
}

/// A standard answer: what stands for the PLC program where a folder has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The channel and its axes are enabled: P8700, P8701, and P8709 when all axes are referenced.
    Enable,
    /// A wanted operating mode comes: P8683 goes to P8703.
    Mode,
    /// A wanted start comes: P8684 goes to P8704.
    Start,
    /// M functions with stop are done: P8706.
    M,
    /// M6 changes the tool: P8047, then P8045.
    Tools,
}

impl Answer {
    /// All of them with their names in the folder.
    pub const ALL: [(Answer, &str); 5] = [
        (Answer::Enable, "enable"),
        (Answer::Mode, "mode"),
        (Answer::Start, "start"),
        (Answer::M, "m"),
        (Answer::Tools, "tools"),
    ];

    fn of_name(name: &str) -> Option<Answer> {
        let found = Answer::ALL.into_iter().find(|(_, own)| *own == name);
        found.map(|(answer, _)| answer)
    }
}

impl Folder900 {
    /// What `control` says.
    const CONTROL: &str = "system900";
    /// A plant whose axes go where they are led, without delay.
    pub const IDEAL: &str = "ideal";

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
        let optional = |key, usual: &str| root.text(key).unwrap_or(usual).to_owned();
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
            plant: root.text("plant").map(str::to_owned),
            programs: optional("programs", "programs"),
            state: optional("state", "state"),
            answers: match root.has("answers") {
                true => answers(&root),
                false => Answer::ALL.map(|(answer, _)| answer).to_vec(),
            },
        };
        root.finish();
        (folder, reader.faults())
    }

    /// The name of the file in the folder.
    pub const FILE: &str = MachineFolder::FILE;
}

fn answers(root: &Section) -> Vec<Answer> {
    let mut found = Vec::new();
    for (at, name) in root.texts("answers") {
        match Answer::of_name(name) {
            Some(answer) => found.push(answer),
            None => {
                let names = Answer::ALL.map(|(_, name)| name).join(", ");
                root.reader
                    .fault(at, format!("`{name}` is no standard answer; there are {names}"));
            }
        }
    }
    found
}
