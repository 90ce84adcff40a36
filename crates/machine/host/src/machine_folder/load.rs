//! Everything that belongs to a machine, from its folder; all faults of all files at once.
//!
//! Decision: A folder may describe no simulated machine; then it is switched on only with a plant that is given. Keys
//! and axes that `machine.toml` names are checked against the simulated machine alone, since of another plant nobody
//! knows them when the files are read
//!
//! Decision: Of several tool tables of a folder the one of machine.toml is in use; `bahn run --tools` takes another
//! one for a run that keeps nothing, since what the control remembers belongs to the one in use. No manual here reads
//! point tables: `bahn table` shows and checks them

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use bahn_machine::{Folder900, Machine, MachineFolder};
use bahn_parameters::equipment::Equipment;
use bahn_parameters::own_functions::OwnFunctions;
use bahn_parameters::terminals::Fitted;
use bahn_parameters::{ControlModel, ListText, ParameterList};
use bahn_path::Position;
use bahn_plc::{MemoryTable, PlcProgram};
use bahn_text::{Diagnostic, Severity, Span, decode};
use bahn_tnc::{HandOver, NcFiles, Remembered, Tool};

use super::channel::{Channels, LoadedChannel, position};
use super::{macros, remembered, state};
use crate::{HostError, files};

/// Texts that a PLC message file holds at most: M2924 to M3023 [000:6625-6633].
const MESSAGES: usize = 100;

/// Why the folder of a System 900 is not switched on.
const SYSTEM_900: &str =
    "this machine has a System 900: bahn test, bahn check, bahn machine check and bahn q take it";

/// A machine that can be switched on.
pub struct LoadedMachine {
    /// The folder.
    pub root: PathBuf,
    /// What `machine.toml` says.
    pub folder: MachineFolder,
    /// The boards with more inputs and outputs.
    pub boards: Vec<Fitted>,
    /// Its machine parameters.
    pub parameters: ParameterList,
    /// Its PLC program.
    pub plc: Arc<PlcProgram>,
    /// Texts of PLC messages, from 0.
    pub plc_messages: Vec<String>,
    /// Texts of PLC dialogues, from 0.
    pub plc_dialogues: Vec<String>,
    /// The simulated machine at power-on; `None` where the plant is another one.
    pub plant: Option<Machine>,
    /// Tools by number; `None` when they come from TOOL DEF.
    pub tools: Option<BTreeMap<u32, Tool>>,
    /// Files that PLC modules and compensation read.
    pub files: NcFiles,
    /// Pallet file and datum tables.
    pub tables: Vec<PathBuf>,
    /// The channels beside the first one.
    pub channels: Vec<LoadedChannel>,
    /// The axes that go from one channel to another.
    pub hand_overs: Vec<HandOver>,
    /// The M functions that are synchronised otherwise than the control model does.
    pub functions: OwnFunctions,
    /// What is accepted, but looks wrong.
    pub warnings: Vec<Diagnostic>,
    /// The first list of machine parameters, of it or of a channel, that is empty or has faults: it is to be entered before the
    /// control goes on.
    pub to_be_entered: Option<String>,
    /// Faults of files that are refused when they are used: they come from outside, so that none of them keeps a machine
    /// from being switched on; and machine parameters that the control does not have.
    pub refused: Vec<Diagnostic>,
}

impl LoadedMachine {
    /// Loads the machine of a folder; the inner `Err` holds every fault of every file.
    ///
    /// # Errors
    /// When there is no such folder or no `machine.toml` in it.
    pub fn load(root: &Path) -> Result<Result<LoadedMachine, Vec<Diagnostic>>, HostError> {
        load(root, &Instead::default())
    }

    /// The same with another tool table of the folder than that of `machine.toml`: a control has several of them, of which
    /// one is in use [000:180] [000:7968].
    ///
    /// # Errors
    /// As [`LoadedMachine::load`].
    pub fn load_with_tools(
        root: &Path,
        tools: &str,
    ) -> Result<Result<LoadedMachine, Vec<Diagnostic>>, HostError> {
        let instead = Instead {
            tools: Some(tools),
            ..Instead::default()
        };
        load(root, &instead)
    }

    /// The same with other bytes in one of the files that `machine.toml` names: whether the machine can be switched on when
    /// they are written.
    ///
    /// # Errors
    /// As [`LoadedMachine::load`].
    pub fn load_with_file(
        root: &Path,
        name: &str,
        bytes: &[u8],
    ) -> Result<Result<LoadedMachine, Vec<Diagnostic>>, HostError> {
        let instead = Instead {
            file: Some((name, bytes)),
            ..Instead::default()
        };
        load(root, &instead)
    }

    /// The same for a control that has its editor: a list of machine parameters that is missing, empty or faulty keeps none
    /// from being switched on, it is entered [000:10011]. What can be read of it counts meanwhile, where a machine can be so.
    ///
    /// # Errors
    /// As [`LoadedMachine::load`].
    pub fn load_to_enter(root: &Path) -> Result<Result<LoadedMachine, Vec<Diagnostic>>, HostError> {
        let instead = Instead {
            enters: true,
            ..Instead::default()
        };
        load(root, &instead)
    }

    /// The files that were read, and the lock of the state.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let folder = &self.folder;
        let named = [Some(folder.parameters.as_str()), folder.plc_file()];
        let further = [
            &folder.plant,
            &folder.plc_messages,
            &folder.plc_dialogues,
            &folder.compensation,
            &folder.correction_tables,
            &folder.tools,
            &folder.pockets,
        ];
        let named = named.into_iter().chain(further.map(Option::as_deref)).flatten();
        let lists = self
            .channels
            .iter()
            .map(|channel| channel.folder.parameters.as_str());
        let files = named.chain(lists).map(|name| self.root.join(name));
        let lock = self.root.join(&folder.state).join(state::LOCK);
        files.chain(self.tables.iter().cloned()).chain([lock]).collect()
    }

    /// The simulated machine that the folder describes.
    ///
    /// # Errors
    /// [`HostError::NotSimulated`].
    pub fn simulated(&self) -> Result<&Machine, HostError> {
        let name = || HostError::NotSimulated(self.root.display().to_string());
        self.plant.as_ref().ok_or_else(name)
    }

    /// The datum table of `machine.toml`.
    ///
    /// # Errors
    /// Why there is none, in words.
    pub fn datum_table(&self) -> Result<&MemoryTable, String> {
        self.files.datum_table_of(self.files.datum_table.as_ref())
    }

    /// The datum of `machine.toml`, for the axes that it names.
    pub fn datum(&self) -> Position {
        position(&self.folder.datum)
    }

    /// What the control of the folder remembers, without switching it on; `None` when it remembers nothing, or nobody
    /// can read it.
    pub fn remembered(&self) -> Option<Remembered> {
        let file = self.root.join(&self.folder.state).join(state::control_file(0));
        remembered::read(&files::read_table(&file).ok()?).ok()
    }

    /// Removes what was half written in its folders by who was killed; to be called by who has switched it on.
    pub(crate) fn sweep(&self) {
        let files = self.inputs();
        let folders = files.iter().filter_map(|file| file.parent().map(Path::to_owned));
        let programs = (0..=self.channels.len()).map(|channel| self.programs(channel));
        let own = [self.root.clone(), self.root.join("lessons")];
        let folders: BTreeSet<PathBuf> = folders.chain(programs).chain(own).collect();
        for folder in folders {
            files::sweep(&folder);
        }
    }

    /// Somebody has switched it on: its state is in use.
    pub fn is_switched_on(&self) -> bool {
        state::is_in_use(&self.root.join(&self.folder.state))
    }

    /// The folder of the part programs of a channel, from 0.
    pub fn programs(&self, channel: usize) -> PathBuf {
        let own = channel.checked_sub(1).and_then(|place| self.channels.get(place));
        let own = own.and_then(|channel| channel.folder.programs.as_ref());
        self.root.join(own.unwrap_or(&self.folder.programs))
    }

    /// The program that a channel runs when nobody names another one, from 0.
    pub fn usual_program(&self, channel: usize) -> Option<&str> {
        let program = match channel.checked_sub(1) {
            None => &self.folder.program,
            Some(place) => &self.channels.get(place)?.folder.program,
        };
        program.as_deref()
    }
}

/// See [`LoadedMachine::load`].
fn load(root: &Path, instead: &Instead<'_>) -> Result<Result<LoadedMachine, Vec<Diagnostic>>, HostError> {
    let file = root.join(MachineFolder::FILE);
    let bytes = files::read_description(&file).map_err(|error| {
        HostError::new(format!(
            "{error}\na machine is a folder with {}",
            MachineFolder::FILE
        ))
    })?;
    let text = decode(&bytes);
    if let Some(span) = Folder900::named_at(&text) {
        return Ok(Err(vec![
            Diagnostic::error(span, SYSTEM_900).in_text(&file, &text),
        ]));
    }
    let (mut folder, faults) = MachineFolder::read(&text);
    if let Some(tools) = instead.tools {
        folder.tools = Some(tools.to_owned());
    }
    let mut loader = Loader {
        root,
        file: instead.file,
        enters: instead.enters,
        to_be_entered: None,
        faults: Vec::new(),
        warnings: Vec::new(),
        refused: Vec::new(),
        description: (file.clone(), text),
        equipment: Equipment::default(),
    };
    for fault in faults {
        // At the begin of a line all of it is meant.
        let span = match fault.span.column {
            ..=1 => Span::line(fault.span.line as usize),
            _ => fault.span,
        };
        loader.fault_in_description(Diagnostic { span, ..fault });
    }
    let machine = loader.load(folder);
    Ok(match machine {
        Some(mut machine) if loader.faults.is_empty() => {
            machine.warnings = loader.warnings;
            let (dialogues, list) = (&machine.plc_dialogues, &machine.parameters);
            let wrong = macros::warnings(&machine.programs(0), dialogues, list);
            machine.warnings.extend(wrong);
            machine.to_be_entered = loader.to_be_entered;
            machine.refused = loader.refused;
            Ok(machine)
        }
        _ => {
            loader
                .faults
                .sort_by_key(|fault| fault.severity == Severity::Warning);
            Err(loader.faults)
        }
    })
}

/// What is taken in place of what the folder says.
#[derive(Default)]
struct Instead<'a> {
    /// The tool table.
    tools: Option<&'a str>,
    /// The bytes of a file.
    file: Option<(&'a str, &'a [u8])>,
    /// The list of machine parameters can be entered.
    enters: bool,
}

pub(super) struct Loader<'a> {
    pub root: &'a Path,
    /// The bytes of a file that are taken in place of its own.
    file: Option<(&'a str, &'a [u8])>,
    /// Lists of machine parameters can be entered, and the first that is to be.
    enters: bool,
    pub to_be_entered: Option<String>,
    pub faults: Vec<Diagnostic>,
    pub warnings: Vec<Diagnostic>,
    /// See [`LoadedMachine::refused`].
    pub refused: Vec<Diagnostic>,
    /// `machine.toml`: its path and text.
    description: (PathBuf, String),
    /// Options and software of the control.
    pub equipment: Equipment,
}

impl Loader<'_> {
    /// Reads all files, so that every fault is found; `None` when one of them could not be read.
    fn load(&mut self, folder: MachineFolder) -> Option<LoadedMachine> {
        self.stays_inside("state", &folder.state);
        let model = self.model(&folder.model);
        if let Some(model) = model {
            self.equipment = self.equipment(&folder.equipment, model);
        }
        let mut plant = self.plant(&folder);
        let plc_messages = self.texts("plc_messages", folder.plc_messages.as_deref(), MESSAGES);
        let plc_dialogues = self.texts("plc_dialogues", folder.plc_dialogues.as_deref(), 4096);
        let mut files = self.compensation(&folder);
        let parameters = model.and_then(|model| self.parameters(&folder, model));
        let mut none = NcFiles::default();
        let boards = model.map(|model| self.boards(&folder.equipment, model, parameters.as_ref()));
        if let (Some(model), Some(boards), Some(Some(plant))) = (model, &boards, &mut plant) {
            self.fit(&folder, plant, model, boards);
        }
        // Tables fit the list that is entered, when it is.
        let sizes = parameters.as_ref().filter(|_| self.to_be_entered.is_none());
        let tools = self.tool_files(&folder, sizes, files.as_mut().unwrap_or(&mut none));
        let plc = self.plc_program(&folder, model?, parameters.as_ref());
        let (parameters, plant) = (parameters?, plant?);
        let mut files = files?;
        self.nonlinear(&folder.parameters, &parameters, &files);
        let tables = self.nc_memory(&folder, &parameters, &mut files);
        self.further_lists(&mut files, model?);
        self.agree(&folder, plant.as_ref());
        let functions = self.functions(&folder, model?);
        let channels = self.channels(&folder, model?, &parameters, plant.as_ref());
        let Channels { channels, hand_overs } = channels?;
        for channel in &channels {
            // Tables are those of the axes of the first channel.
            self.nonlinear(
                &channel.folder.parameters,
                &channel.parameters,
                &NcFiles::default(),
            );
        }
        Some(LoadedMachine {
            root: self.root.to_owned(),
            boards: boards?,
            parameters,
            plc: plc?,
            plc_messages: plc_messages?,
            plc_dialogues: plc_dialogues?,
            plant,
            tools: tools?,
            files,
            tables,
            channels,
            hand_overs,
            functions,
            warnings: Vec::new(),
            to_be_entered: None,
            refused: Vec::new(),
            folder,
        })
    }

    fn model(&mut self, name: &str) -> Option<ControlModel> {
        if name.is_empty() {
            return None;
        }
        let model = name.parse().ok();
        if model.is_none() {
            let known = ControlModel::ALL.map(ControlModel::id).join(", ");
            self.fault_at_key(
                "model",
                &format!("`{name}` is no control model; there are {known}"),
            );
        }
        model
    }

    /// A name that leads out of the folder is a fault: what belongs to a machine lies in it.
    pub(super) fn stays_inside(&mut self, key: &str, name: &str) -> bool {
        let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        let stays = Path::new(name).components().all(inside) && !name.contains('\\');
        if !stays {
            self.fault_at_key(key, &format!("`{name}` leads out of the folder of the machine"));
        }
        stays
    }

    /// The path of a file that `machine.toml` names, when it is there.
    pub(super) fn named(&mut self, key: &str, name: &str) -> Option<PathBuf> {
        self.read(key, name).map(|(path, _)| path)
    }

    /// The bytes of a file that `machine.toml` names.
    pub(super) fn read(&mut self, key: &str, name: &str) -> Option<(PathBuf, Vec<u8>)> {
        self.read_with(key, name, files::read_table)
    }

    fn read_with(
        &mut self,
        key: &str,
        name: &str,
        reading: fn(&Path) -> Result<Vec<u8>, HostError>,
    ) -> Option<(PathBuf, Vec<u8>)> {
        let line = self.line_of(key).unwrap_or(1);
        self.read_at(line, name, reading)
    }

    fn read_at(
        &mut self,
        line: usize,
        name: &str,
        reading: fn(&Path) -> Result<Vec<u8>, HostError>,
    ) -> Option<(PathBuf, Vec<u8>)> {
        if name.is_empty() {
            return None;
        }
        let path = self.root.join(name);
        if let Some((_, bytes)) = self.file.filter(|(own, _)| *own == name) {
            return Some((path, bytes.to_vec()));
        }
        match reading(&path) {
            Ok(bytes) => Some((path, bytes)),
            Err(error) => {
                self.fault_at_line(line, error.to_string());
                None
            }
        }
    }

    fn parameters(&mut self, folder: &MachineFolder, model: ControlModel) -> Option<ParameterList> {
        let line = self.line_of("parameters").unwrap_or(1);
        self.list_at(line, &folder.parameters, model)
    }

    /// A list that may be entered: what can be read of it, unless no machine can be so. One that is not there is empty; a
    /// file that cannot be read is a fault, since nobody knows what is in it.
    fn list_to_enter(&mut self, line: usize, name: &str, model: ControlModel) -> Option<ParameterList> {
        let path = self.root.join(name);
        let bytes = match path.try_exists() {
            Ok(false) => Vec::new(),
            _ => self.read_at(line, name, files::read_table)?.1,
        };
        let text = ListText::from_bytes(model, &bytes);
        let mut list = ParameterList::reference(model).with_equipment(self.equipment);
        list.take(&text);
        let found = text.diagnostics(&list, &path);
        self.refused.extend(text.lacking(&list, &path));
        let faulty = found.iter().any(|fault| fault.severity == Severity::Error);
        match faulty || text.entries().is_empty() {
            true => {
                self.to_be_entered.get_or_insert_with(|| name.to_owned());
            }
            false => self.warnings.extend(found),
        }
        match list.inconsistencies().iter().any(|found| found.impossible) {
            true => Some(ParameterList::reference(model).with_equipment(self.equipment)),
            false => Some(list),
        }
    }

    /// A list of machine parameters that a line of `machine.toml` names.
    pub(super) fn list_at(&mut self, line: usize, name: &str, model: ControlModel) -> Option<ParameterList> {
        if self.enters && !name.is_empty() && self.stays_inside("parameters", name) {
            return self.list_to_enter(line, name, model);
        }
        let (path, bytes) = self.read_at(line, name, files::read_table)?;
        let text = ListText::from_bytes(model, &bytes);
        let mut list = ParameterList::reference(model).with_equipment(self.equipment);
        list.take(&text);
        let found = text.diagnostics(&list, &path);
        self.refused.extend(text.lacking(&list, &path));
        self.sort(found).then_some(list)
    }

    /// The lists of machine parameters that module 9033 can select: files `NAME.MP` of the folder, in capitals
    /// [000:14894-14896]. A faulty one is refused when it is selected.
    fn further_lists(&mut self, files: &mut NcFiles, model: ControlModel) {
        for entry in std::fs::read_dir(self.root).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if !name.ends_with(".MP") || name.bytes().any(|byte| byte.is_ascii_lowercase()) {
                continue;
            }
            let list = files::read_table(&entry.path()).ok().and_then(|bytes| {
                let text = ListText::from_bytes(model, &bytes);
                let mut list = ParameterList::reference(model).with_equipment(self.equipment);
                list.take(&text);
                let found = text.diagnostics(&list, &entry.path());
                let faulty = found.iter().any(|fault| fault.severity == Severity::Error);
                (!faulty).then_some(list)
            });
            files.parameter_lists.insert(name, list);
        }
    }

    /// The simulated machine, or that there is none; `None` when it is faulty.
    fn plant(&mut self, folder: &MachineFolder) -> Option<Option<Machine>> {
        let Some(name) = &folder.plant else {
            return Some(None);
        };
        let (path, bytes) = self.read_with("plant", name, files::read_description)?;
        let text = decode(&bytes);
        match Machine::from_toml(&text) {
            Ok(machine) => Some(Some(machine)),
            Err(faults) => {
                let faults = faults.into_iter();
                self.faults.extend(
                    faults.map(|fault| fault.under("the machine is wrong").in_text(path.clone(), &text)),
                );
                None
            }
        }
    }

    /// The file of the simulated machine and its text.
    pub(super) fn text_of_plant(&self, folder: &MachineFolder) -> Option<(PathBuf, String)> {
        let name = folder.plant.as_deref()?;
        let path = self.root.join(name);
        let bytes = match self.file.filter(|(own, _)| *own == name) {
            Some((_, bytes)) => bytes.to_vec(),
            None => files::read_description(&path).ok()?,
        };
        Some((path, decode(&bytes)))
    }

    fn texts(&mut self, key: &str, name: Option<&str>, most: usize) -> Option<Vec<String>> {
        let Some(name) = name else {
            return Some(Vec::new());
        };
        let (path, bytes) = self.read(key, name)?;
        let text = decode(&bytes);
        let lines: Vec<String> = text.lines().map(|line| line.trim_end().to_owned()).collect();
        if lines.len() > most {
            let message = format!("there are {most} texts at most");
            let fault = Diagnostic::error(Span::line(most + 1), message).under("too many texts");
            self.faults.push(fault.in_text(path, &text));
        }
        Some(lines)
    }

    /// What must fit between the files. What another plant has, nobody knows here.
    fn agree(&mut self, folder: &MachineFolder, plant: Option<&Machine>) {
        let Some(plant) = plant else { return };
        for (letter, _) in &folder.datum {
            if plant.axis(*letter).is_none() {
                self.fault_at_key(&letter.to_string(), &format!("the machine has no axis {letter}"));
            }
        }
        let operator = &folder.operator;
        let voltage = operator.control_voltage.iter();
        let named = [("start", &operator.start)]
            .into_iter()
            .chain(voltage.map(|key| ("control_voltage", key)))
            .chain(operator.tool_change.iter().map(|key| ("tool_change", key)));
        let keys: Vec<&str> = plant.keys().collect();
        for (key, name) in named {
            // What is not written is a guess; it shows when it is needed.
            if !keys.contains(&name.as_str()) && self.line_of(key).is_some() {
                let message = format!("the machine has no key `{name}`; there are {}", keys.join(", "));
                self.fault_at_key(key, &message);
            }
        }
    }

    /// Keeps warnings, and errors as faults; whether there was no error.
    pub(super) fn sort(&mut self, found: Vec<Diagnostic>) -> bool {
        let before = self.faults.len();
        for fault in found {
            match fault.severity {
                Severity::Error => self.faults.push(fault),
                Severity::Warning => self.warnings.push(fault),
            }
        }
        self.faults.len() == before
    }

    /// The line of `machine.toml` that sets a key, from 1; those of further channels know their own.
    fn line_of(&self, key: &str) -> Option<usize> {
        let sets = |line: &str| line.split('=').next().is_some_and(|name| name.trim() == key);
        let (_, text) = &self.description;
        let mut elsewhere = false;
        let found = text.lines().position(|line| {
            if line.trim_start().starts_with('[') {
                elsewhere = line.contains("[channel") || line.contains("[hand_over");
            }
            !elsewhere && line.contains('=') && sets(line)
        });
        found.map(|index| index + 1)
    }

    pub(super) fn fault_at_key(&mut self, key: &str, message: &str) {
        let line = self.line_of(key).unwrap_or(1);
        self.fault_at_line(line, message.to_owned());
    }

    pub(super) fn warning_at_key(&mut self, key: &str, message: &str) {
        let (path, text) = &self.description;
        let place = Span::line(self.line_of(key).unwrap_or(1));
        let fault = Diagnostic::warning(place, message).under("something is not used");
        self.warnings.push(fault.in_text(path, text));
    }

    pub(super) fn fault_at_span(&mut self, span: Span, message: String) {
        self.fault_in_description(Diagnostic::error(span, message));
    }

    pub(super) fn fault_at_line(&mut self, line: usize, message: String) {
        self.fault_in_description(Diagnostic::error(Span::line(line), message));
    }

    fn fault_in_description(&mut self, fault: Diagnostic) {
        let (path, text) = &self.description;
        let fault = fault.under("the machine's description is wrong");
        self.faults.push(fault.in_text(path, text));
    }
}
