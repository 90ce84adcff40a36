//! A machine that runs, as a host by LSV/2 sees it.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use bahn_control::{Command, Control, DataLineEvent, HostEvent, Mode, RunState, Shown};
use bahn_exchange::{Bit, BitArea, Image};
use bahn_host::{LoadedMachine, PlainTable, TableForm, TextTable, files};
use bahn_link::lsv2::{
    Area, Device, ErrorNumber, Event, EventKind, Execution, Features, Identity, Message, PlcMessage,
    ProgramState, Run, Tool,
};
use bahn_link::store::{Place, Store, StoreError, TNC, View};
use bahn_machine::MachineFolder;
use bahn_panel::{Input, Key, Link, Station};
use bahn_parameters::{Definition, ListText, ParameterId};
use bahn_path::Axis;
use bahn_plc::HostMessage;
use bahn_text::decode;

use crate::lsv2_log::LogBook;
use crate::lsv2_screen;
use crate::open::plc_folder;

/// What the identity begins with when nobody gives another one.
const OWN: &str = "BAHN";
/// Bytes of the PLC's memory, and strings [000:14054].
const BYTES: u32 = 1024;
const STRINGS: u32 = 4;

/// A machine that runs.
pub struct MachineDevice {
    /// As soon as it runs.
    link: OnceLock<Link>,
    store: Store,
    identity: Identity,
    root: PathBuf,
    /// The list of machine parameters of the folder.
    list: String,
    /// The tool table, when there is one.
    tools: Option<PathBuf>,
    log: LogBook,
    /// A message of the PLC goes to one host.
    messages: Mutex<()>,
    /// One change of the list at a time.
    writes: Mutex<()>,
}

impl MachineDevice {
    /// The machine of a station that is about to run.
    pub fn new(station: &mut Station, identity: Option<&str>) -> Result<MachineDevice, StoreError> {
        let machine = station.machine();
        let root = machine.root.clone();
        let main = root.join(&machine.folder.plc);
        let plc = plc_folder(machine);
        let programs = machine.programs(0);
        for folder in [&plc, &programs] {
            std::fs::create_dir_all(folder)
                .map_err(|error| StoreError::Medium(format!("cannot make {}: {error}", folder.display())))?;
        }
        let model = station.control().model().name();
        let plc_name = main
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let control = identity.map_or_else(|| format!("{OWN} {model}"), str::to_owned);
        Ok(MachineDevice {
            link: OnceLock::new(),
            store: Store::of_machine_with(&programs, &plc, tables(&root, &machine.folder)?)?,
            identity: Identity {
                features: Features::of(&control),
                control,
                nc_software: nc_software(),
                plc_software: plc_name,
                id: format!("Bahn {}", env!("CARGO_PKG_VERSION")),
            },
            list: machine.folder.parameters.clone(),
            tools: machine.folder.tools.as_ref().map(|name| root.join(name)),
            root,
            log: LogBook::new(station.host().notices()),
            messages: Mutex::default(),
            writes: Mutex::default(),
        })
    }

    /// The machine runs.
    pub fn connect(&self, link: Link) {
        // It begins once.
        let _ = self.link.set(link);
    }

    fn link(&self) -> Result<&Link, ErrorNumber> {
        self.link.get().ok_or(ErrorNumber::WRONG_MODE)
    }

    fn look<T: Send + 'static>(
        &self,
        what: impl FnOnce(&Station) -> T + Send + 'static,
    ) -> Result<T, ErrorNumber> {
        self.link()?.look(what).map_err(|_| ErrorNumber::WRONG_MODE)
    }

    /// Something happens at the PLC's connection to a host.
    fn happen(&self, event: HostEvent) -> Result<(), ErrorNumber> {
        let command = Command::DataLine(DataLineEvent::Host(event));
        let given = self.link()?.input(Input::Action(command.to_string()));
        given.map_err(|_| ErrorNumber::WRONG_MODE)
    }

    /// Messages come into the log book.
    fn follow(&self) {
        self.log.follow(|shown| {
            let texts = self.look(move |station| {
                let text = |shown: &Shown| station.control().shown_text(shown);
                shown.iter().map(text).collect()
            });
            texts.unwrap_or_default()
        });
    }

    /// Writes a machine parameter into its list, which stays one that the machine can be switched on with.
    fn write_parameter(&self, id: ParameterId, value: f64) -> Result<(), ErrorNumber> {
        let _one_at_a_time = self.writes.lock().unwrap_or_else(PoisonError::into_inner);
        let selected = self.look(|station| station.control().remember().parameter_list)?;
        let name = selected.unwrap_or_else(|| self.list.clone());
        let path = self.root.join(&name);
        let model = self.look(|station| station.control().model())?;
        let refused = |_| ErrorNumber::NO_WRITE;
        let bytes = files::read_table(&path).map_err(refused)?;
        let mut text = ListText::from_bytes(model, &bytes);
        text.set(id, value).map_err(|_| ErrorNumber::NO_PARAMETER)?;
        let bytes = text.to_bytes();
        let loaded = LoadedMachine::load_with_file(&self.root, &name, &bytes).map_err(refused)?;
        // The machine could not be switched on with it.
        loaded.map_err(|_| ErrorNumber::BAD_VALUE)?;
        files::write_whole(&path, &bytes).map_err(refused)
    }
}

/// Tool and pocket table of the machine where hosts look for them (public), in the form of the control.
fn tables(root: &Path, folder: &MachineFolder) -> Result<Vec<View>, StoreError> {
    let named = [
        ("TOOL.T", TableForm::Tool, &folder.tools),
        ("TOOL_P.TCH", TableForm::Pocket, &folder.pockets),
    ];
    let there = named
        .into_iter()
        .filter_map(|(name, form, file)| Some((name, form, root.join(file.as_ref()?))));
    let view = |(name, form, source): (&str, TableForm, PathBuf)| {
        let path = source.clone();
        let title = name.split('.').next().unwrap_or(name).to_owned();
        let bytes = move || {
            let text = decode(&files::read_table(&path).ok()?);
            let table = TextTable::read(&text).ok()?;
            Some(PlainTable::new(form, &table).of_control(&title).into_bytes())
        };
        Ok(View {
            place: Place::root(TNC).join(name)?,
            source,
            bytes: Box::new(bytes),
        })
    };
    there.map(view).collect()
}

/// The version of Bahn in the form of the manufacturer's numbers: six digits and two.
fn nc_software() -> String {
    let parts: Vec<u32> = env!("CARGO_PKG_VERSION")
        .split('.')
        .map(|part| part.parse().unwrap_or(0))
        .collect();
    let part = |place: usize| parts.get(place).copied().unwrap_or(0);
    format!("{:03}{:03} {:02}", part(0), part(1), part(2))
}

impl Device for MachineDevice {
    fn identity(&self) -> Identity {
        self.identity.clone()
    }

    fn store(&self) -> &Store {
        &self.store
    }

    fn run(&self) -> Result<Run, ErrorNumber> {
        self.follow();
        self.look(run_of)
    }

    fn elements(&self, area: Area) -> u32 {
        match bits_of(area) {
            Some(area) => (0..=u16::MAX)
                .take_while(|number| Bit::new(area, *number).is_some())
                .count() as u32,
            None if area == Area::Strings => STRINGS,
            None => BYTES,
        }
    }

    fn memory(&self, area: Area, first: u32, count: u32) -> Result<Vec<u8>, ErrorNumber> {
        let end = first.checked_add(count).ok_or(ErrorNumber::BAD_ADDRESS)?;
        if end > self.elements(area) {
            return Err(ErrorNumber::BAD_ADDRESS);
        }
        self.look(move |station| read(station.control().memory(), area, first..end))
    }

    fn tool_value(&self, tool: u32, column: &str) -> Option<String> {
        let text = decode(&files::read_table(self.tools.as_ref()?).ok()?);
        let table = PlainTable::new(TableForm::Tool, &TextTable::read(&text).ok()?);
        let place = |name: &str| {
            table
                .names
                .iter()
                .position(|known| known.eq_ignore_ascii_case(name))
        };
        let (number, wanted) = (place("T")?, place(column)?);
        let mut rows = table.rows.iter();
        let row = rows.find(|row| {
            row.get(number)
                .is_some_and(|text| text.trim().parse() == Ok(tool))
        })?;
        row.get(wanted).map(|text| text.trim().to_owned())
    }

    fn parameter(&self, number: u16, index: u8) -> Option<String> {
        let value = self.look(move |station| {
            let list = station.control().first().edited_list();
            let definition = Definition::named(list.model(), named(list.model(), number, index)?).ok()?;
            Some(definition.format_value(list.get(number, index)?))
        });
        value.ok().flatten()
    }

    fn set_parameter(&self, number: u16, index: u8, value: &str, for_good: bool) -> Result<(), ErrorNumber> {
        let value = value.trim().to_owned();
        let (id, assignment, value, is_other) = self.look(move |station| {
            let mut list = station.control().first().edited_list().clone();
            let id = named(list.model(), number, index).ok_or(ErrorNumber::NO_PARAMETER)?;
            let before = list.get(number, index);
            let assignment = format!("{id}={value}");
            list.assign(&assignment).map_err(|_| ErrorNumber::BAD_VALUE)?;
            let after = list.get(number, index).ok_or(ErrorNumber::NO_PARAMETER)?;
            Ok::<_, ErrorNumber>((id, assignment, after, before != Some(after)))
        })??;
        if for_good {
            self.write_parameter(id, value)?;
        }
        // What is so already needs no reset.
        if is_other {
            let given = self.link()?.input(Input::Action(assignment));
            given.map_err(|_| ErrorNumber::WRONG_MODE)?;
        }
        Ok(())
    }

    fn press(&self, key: &str) -> Result<(), ErrorNumber> {
        let mut characters = key.chars();
        let of_character = match (characters.next(), characters.next()) {
            (Some(character), None) => Key::of_character(character),
            _ => None,
        };
        let key = Key::from_name(key)
            .or(of_character)
            .ok_or(ErrorNumber::KEY_REFUSED)?;
        self.follow();
        self.log.note(EventKind::Key, key.name().to_owned());
        let pressed = self.link()?.input(Input::Key(key));
        pressed.map_err(|_| ErrorNumber::KEY_REFUSED)
    }

    fn screen(&self) -> Result<Vec<u8>, ErrorNumber> {
        let seen = self.link()?.with(|station| {
            let picture = station.picture();
            (station.screen().clone(), picture)
        });
        let (screen, picture) = seen.map_err(|_| ErrorNumber::WRONG_MODE)?;
        Ok(lsv2_screen::bmp(&lsv2_screen::draw(&screen, picture.as_ref())))
    }

    fn log_book(&self) -> Vec<Event> {
        self.follow();
        self.log.all()
    }

    fn host_is_there(&self, is_there: bool) {
        // A machine that has ended has no host.
        let _ = self.happen(HostEvent::Connected(is_there));
    }

    fn to_plc(&self, message: PlcMessage) -> Result<(), ErrorNumber> {
        let message = match message {
            PlcMessage::Double(value) => HostMessage::Double(value),
            PlcMessage::Text(text) => HostMessage::Text(text),
        };
        self.happen(HostEvent::Message(message))
            .map_err(|_| ErrorNumber::BUFFER_FULL)
    }

    fn plc_message(&self) -> Option<PlcMessage> {
        let _one_takes_it = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        let message = self.look(|station| station.control().message_to_host().cloned());
        let message = match message.ok()?? {
            HostMessage::Double(value) => PlcMessage::Double(value),
            HostMessage::Text(text) => PlcMessage::Text(text),
        };
        self.happen(HostEvent::Taken).ok()?;
        Some(message)
    }

    fn files_changed(&self) {
        // A machine that has ended reads nothing any more.
        let _ = self.look(Station::programs_changed);
    }
}

/// The id of a parameter: with an index, or of one that has none.
fn named(model: bahn_parameters::ControlModel, number: u16, index: u8) -> Option<ParameterId> {
    let with = ParameterId {
        number,
        index: Some(index),
    };
    let without = ParameterId { number, index: None };
    let is_known = |id: &ParameterId| Definition::named(model, *id).is_ok();
    [with, without]
        .into_iter()
        .filter(|id| id.index.is_some() || index == 0)
        .find(is_known)
}

fn bits_of(area: Area) -> Option<BitArea> {
    match area {
        Area::Markers => Some(BitArea::M),
        Area::Inputs => Some(BitArea::I),
        Area::Outputs => Some(BitArea::O),
        Area::Counters => Some(BitArea::C),
        Area::Timers => Some(BitArea::T),
        Area::Bytes | Area::Strings => None,
    }
}

fn read(image: &Image, area: Area, which: std::ops::Range<u32>) -> Vec<u8> {
    let place = |number: u32| u16::try_from(number).unwrap_or(u16::MAX);
    match bits_of(area) {
        Some(area) => which
            .map(|number| u8::from(Bit::new(area, place(number)).is_some_and(|bit| image.bit(bit))))
            .collect(),
        None if area == Area::Strings => which.flat_map(|number| string(image, number as usize)).collect(),
        None => which
            .filter_map(|number| bahn_exchange::Number::new(bahn_exchange::Size::Byte, place(number)))
            .map(|number| image.number(number) as u8)
            .collect(),
    }
}

/// A string with zero bytes after its end.
fn string(image: &Image, number: usize) -> Vec<u8> {
    let mut text = image.text(number).to_vec();
    text.resize(image.string(number).len(), 0);
    text
}

/// The run as it is now.
fn run_of(station: &Station) -> Run {
    let control = station.control();
    let snapshot = control.snapshot();
    let path = |name: &str| match name.is_empty() {
        true => String::new(),
        false => format!("TNC:\\{}", name.rsplit(['/', '\\']).next().unwrap_or(name)),
    };
    let main = path(snapshot.program.as_deref().unwrap_or_default());
    let current = snapshot
        .block
        .and_then(|block| control.reader()?.program(block.program).cloned())
        .map_or_else(|| main.clone(), |program| path(program.name()));
    let feed = snapshot.feed_override_percent;
    let message = |shown: &Shown| Message {
        class: if shown.flashing { 1 } else { 2 },
        number: shown.fault() as u32,
        text: control.shown_text(shown),
    };
    Run {
        execution: match snapshot.mode {
            Mode::Manual | Mode::Handwheel => Execution::Manual,
            Mode::Mdi => Execution::Mdi,
            Mode::Reference => Execution::Reference,
            Mode::SingleBlock => Execution::SingleBlock,
            Mode::FullSequence => Execution::Automatic,
        },
        state: match snapshot.run {
            RunState::Running => ProgramState::Started,
            RunState::Interrupted if control.is_broken() => ProgramState::Error,
            RunState::Interrupted => ProgramState::Interrupted,
            RunState::Stopped | RunState::BlockEnd => ProgramState::Stopped,
            RunState::Idle if snapshot.ended => ProgramState::Finished,
            RunState::Idle => ProgramState::Idle,
        },
        block: snapshot.block.map_or(0, |block| block.block),
        main,
        current,
        axes: snapshot
            .axes
            .iter()
            .map(|axis| (axis.letter, axis.actual))
            .collect(),
        // Rapid traverse has no override of its own.
        overrides: [feed, snapshot.spindle_override_percent, feed],
        tool: tool_of(station, control, snapshot.tool),
        messages: snapshot.messages.iter().map(message).collect(),
    }
}

fn tool_of(station: &Station, control: &Control, number: u32) -> Tool {
    let axis = match control.first().in_force().map(|in_force| in_force.tool_axis) {
        Some(Axis::X) => 0,
        Some(Axis::Y) => 1,
        _ => 2,
    };
    let tools = station.machine().tools.as_ref();
    let shape = tools.and_then(|tools| tools.get(&number)).map(|tool| tool.shape);
    Tool {
        number,
        axis,
        length: shape.map_or(0.0, |shape| shape.length),
        radius: shape.map_or(0.0, |shape| shape.radius),
    }
}
