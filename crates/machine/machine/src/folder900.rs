//! The folder of a machine with a System 900: which file is what.
//!
//! Decision: A folder belongs to a System 900 when its `machine.toml` says so with the key `control`, which no
//! other family has

use bahn_text::{Diagnostic, Span, path_below};

use crate::MachineFolder;
use crate::equipment::Said;
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
    /// The machine, as far as it is simulated.
    pub plant: Plant900,
    /// Folder of what survives power-off.
    pub state: String,
    /// The main file of the PLC program, and where it is named; `None` without one.
    pub plc: Option<Said>,
    /// Which markers and double words of the PLC are which parameters, as `SAFREK1 = M300`.
    pub window: Vec<Said>,
    /// What answers in the place of a PLC.
    pub answers: Vec<Answer900>,
}

/// The machine of a System 900.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Plant900 {
    /// `"ideal"`: of which nothing is known but its parameters.
    Ideal,
    /// A file that describes it.
    File(String),
}

/// What may answer in the place of a PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer900 {
    /// `"enable"`: loops and axes are enabled, and whether they are referenced.
    Enable,
    /// `"mode"`: the mode that is asked for is given.
    Mode,
    /// `"start"`: a start or stop that is asked for is given.
    Start,
    /// `"m"`: M functions with stop are acknowledged.
    M,
    /// `"tools"`: tools are changed.
    Tools,
}

impl Answer900 {
    /// All of them, with their names.
    pub const ALL: [(&str, Answer900); 5] = [
        ("enable", Answer900::Enable),
        ("mode", Answer900::Mode),
        ("start", Answer900::Start),
        ("m", Answer900::M),
        ("tools", Answer900::Tools),
    ];
}

/// What an ideal machine is called.
const IDEAL: &str = "ideal";

impl Folder900 {
    /// What `control` says.
    const CONTROL: &str = "system900";

    /// Where the text of a `machine.toml` says that it describes a machine of this family, however many faults it has; `None`
    /// for one of a TNC.
    pub fn named_at(text: &str) -> Option<Span> {
        let reader = Reader::new(text);
        let table = reader.parse();
        let (key, value) = table.get_ref().get_key_value("control")?;
        let is_named = value.get_ref().as_str() == Some(Folder900::CONTROL);
        is_named.then(|| reader.place(key.span().start))
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
        // That it is a System 900 is known.
        root.text("control");
        let parameters = needed("parameters");
        if root.has("parameters") && path_below(&parameters).is_none() {
            root.fault_at(
                "parameters",
                "`parameters` names no data file of the folder".to_owned(),
            );
        }
        let folder = Folder900 {
            name: needed("name"),
            parameters: path_below(&parameters).unwrap_or_default(),
            programs: root.text("programs").unwrap_or("programs").to_owned(),
            plant: match root.text("plant").unwrap_or(IDEAL) {
                IDEAL => Plant900::Ideal,
                file => Plant900::File(file.to_owned()),
            },
            state: root.text("state").unwrap_or("state").to_owned(),
            plc: plc(&root),
            window: root
                .texts("window")
                .into_iter()
                .map(|said| at(&reader, said))
                .collect(),
            answers: answers(&reader, &root),
        };
        if folder.plc.is_none() && !folder.window.is_empty() {
            root.fault_at(
                "window",
                "a window is one of a PLC program: `plc` names none".to_owned(),
            );
        }
        root.finish();
        (folder, reader.faults())
    }

    /// The name of the file in the folder.
    pub const FILE: &str = MachineFolder::FILE;
}

fn at(reader: &Reader, (at, text): (usize, &str)) -> Said {
    Said {
        span: reader.place(at),
        text: text.to_owned(),
    }
}

/// The main file of the PLC program.
fn plc(root: &Section) -> Option<Said> {
    let text = root.text("plc")?;
    let span = root.place_of("plc");
    let Some(text) = path_below(text) else {
        root.fault_at("plc", "`plc` names no file of the folder".to_owned());
        return None;
    };
    Some(Said { span, text })
}

/// Where the key is missing all of them, and none beside a PLC program.
fn answers(reader: &Reader, root: &Section) -> Vec<Answer900> {
    if !root.has("answers") && root.has("plc") {
        return Vec::new();
    }
    if !root.has("answers") {
        return Answer900::ALL.map(|(_, answer)| answer).to_vec();
    }
    let mut all = Vec::new();
    for (at, name) in root.texts("answers") {
        match Answer900::ALL.iter().find(|(known, _)| *known == name) {
            Some((_, answer)) => all.push(*answer),
            None => {
                let known = Answer900::ALL.map(|(known, _)| known).join(", ");
                reader.fault(at, format!("`{name}` is no answer; there are {known}"));
            }
        }
    }
    all
}
