//! A machine that runs, as a host by LSV/2 sees it.

use std::time::UNIX_EPOCH;

use bahn_link::lsv2::{
    Area, Device, EVENTS, ErrorNumber, Event, EventKind, Execution, Features, Identity, Message, PlcMessage,
    ProgramState, Run, Tool,
};
use bahn_service::{
    Axis, Bit, BitArea, Content, HostMessage, MachineService, Mode, Number, Operand, RunState, STRING_LENGTH,
    STRINGS, ServiceError, Size, State, Store,
};

use crate::screen_picture;

/// What the identity begins with when nobody gives another one.
const OWN: &str = "BAHN";
/// Bytes of the PLC's memory [000:14054].
const BYTES: u32 = 1024;

/// A machine that runs.
pub struct MachineDevice {
    machine: MachineService,
    /// The files, of which hosts have all.
    store: Store,
    identity: Identity,
}

impl MachineDevice {
    /// A machine that runs, under the name of its control or under another one.
    ///
    /// # Errors
    /// When one may only look at it.
    pub fn new(machine: &MachineService, identity: Option<&str>) -> Result<MachineDevice, ServiceError> {
        let about = machine.machine();
        let control = identity.map_or_else(|| format!("{OWN} {}", about.model.name()), str::to_owned);
        Ok(MachineDevice {
            store: machine.store()?.clone(),
            identity: Identity {
                features: Features::of(&control),
                control,
                nc_software: nc_software(),
                plc_software: about.plc_program.clone(),
                id: format!("Bahn {}", env!("CARGO_PKG_VERSION")),
            },
            machine: machine.clone(),
        })
    }
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

/// The number of an error; `refused` is that of what the machine does not do now.
fn number(error: &ServiceError, refused: ErrorNumber) -> ErrorNumber {
    match error {
        ServiceError::Refused(_) => refused,
        ServiceError::OnlyLooks => ErrorNumber::NO_PRIVILEGE,
        ServiceError::NoKey(_) => ErrorNumber::KEY_REFUSED,
        ServiceError::NoParameter(..) => ErrorNumber::NO_PARAMETER,
        ServiceError::BadValue(_) => ErrorNumber::BAD_VALUE,
        ServiceError::File(error) => ErrorNumber::from(error),
        ServiceError::NotWritten(_) => ErrorNumber::NO_WRITE,
    }
}

/// The same of what the operating mode does not allow.
fn in_this_mode(error: ServiceError) -> ErrorNumber {
    number(&error, ErrorNumber::WRONG_MODE)
}

impl Device for MachineDevice {
    fn identity(&self) -> Identity {
        self.identity.clone()
    }

    fn store(&self) -> &Store {
        &self.store
    }

    fn run(&self) -> Result<Run, ErrorNumber> {
        self.machine.state().map(run_of).map_err(in_this_mode)
    }

    fn elements(&self, area: Area) -> u32 {
        let count = (0..)
            .take_while(|number| operand(area, *number).is_some())
            .count();
        u32::try_from(count).unwrap_or(u32::MAX)
    }

    fn memory(&self, area: Area, first: u32, count: u32) -> Result<Vec<u8>, ErrorNumber> {
        let end = first.checked_add(count).ok_or(ErrorNumber::BAD_ADDRESS)?;
        let operands: Option<Vec<Operand>> = (first..end).map(|number| operand(area, number)).collect();
        let contents = self.machine.read(operands.ok_or(ErrorNumber::BAD_ADDRESS)?);
        Ok(contents
            .map_err(in_this_mode)?
            .iter()
            .flat_map(bytes_of)
            .collect())
    }

    fn tool_value(&self, tool: u32, column: &str) -> Option<String> {
        self.machine.tool_value(tool, column)
    }

    fn parameter(&self, number: u16, index: u8) -> Option<String> {
        self.machine.parameter(number, index).ok()
    }

    fn set_parameter(&self, number: u16, index: u8, value: &str, for_good: bool) -> Result<(), ErrorNumber> {
        let set = self.machine.set_parameter(number, index, value, for_good);
        set.map_err(in_this_mode)
    }

    fn press(&self, key: &str) -> Result<(), ErrorNumber> {
        let pressed = self.machine.press(key);
        pressed.map_err(|error| number(&error, ErrorNumber::KEY_REFUSED))
    }

    fn screen(&self) -> Result<Vec<u8>, ErrorNumber> {
        let (screen, picture) = self.machine.screen_with_picture().map_err(in_this_mode)?;
        Ok(screen_picture::bmp(&screen_picture::draw(
            &screen,
            picture.as_ref(),
        )))
    }

    fn log_book(&self) -> Vec<Event> {
        let events = self.machine.events(0).events;
        let last = events.len().saturating_sub(EVENTS);
        let events = events.into_iter().skip(last);
        events.map(event).collect()
    }

    fn host_is_there(&self, is_there: bool) {
        self.machine.host_is_there(is_there);
    }

    fn to_plc(&self, message: PlcMessage) -> Result<(), ErrorNumber> {
        let message = match message {
            PlcMessage::Double(value) => HostMessage::Double(value),
            PlcMessage::Text(text) => HostMessage::Text(text),
        };
        let given = self.machine.to_plc(message);
        given.map_err(|error| number(&error, ErrorNumber::BUFFER_FULL))
    }

    fn plc_message(&self) -> Option<PlcMessage> {
        Some(match self.machine.take_plc_message()? {
            HostMessage::Double(value) => PlcMessage::Double(value),
            HostMessage::Text(text) => PlcMessage::Text(text),
        })
    }

    fn files_changed(&self) {
        self.machine.files_changed();
    }
}

/// The operand of a number in an area.
fn operand(area: Area, number: u32) -> Option<Operand> {
    let place = u16::try_from(number).ok()?;
    let bit = |area| Bit::new(area, place).map(Operand::Bit);
    match area {
        Area::Markers => bit(BitArea::M),
        Area::Inputs => bit(BitArea::I),
        Area::Outputs => bit(BitArea::O),
        Area::Counters => bit(BitArea::C),
        Area::Timers => bit(BitArea::T),
        Area::Bytes if number < BYTES => Number::new(Size::Byte, place).map(Operand::Number),
        Area::Strings if usize::from(place) < STRINGS => Some(Operand::Text(place.into())),
        Area::Bytes | Area::Strings => None,
    }
}

/// A byte for a bit or a byte, a string with zero bytes after its end.
fn bytes_of(content: &Content) -> Vec<u8> {
    match content {
        Content::Number(value) => vec![*value as u8],
        Content::Text(text) => {
            // Characters are bytes of the memory.
            let mut bytes: Vec<u8> = text.chars().filter_map(|one| u8::try_from(one).ok()).collect();
            bytes.resize(STRING_LENGTH, 0);
            bytes
        }
    }
}

fn event(event: bahn_service::Event) -> Event {
    let since_1970 = event.time.duration_since(UNIX_EPOCH).unwrap_or_default();
    Event {
        time: u32::try_from(since_1970.as_secs()).unwrap_or(u32::MAX),
        kind: match event.kind {
            bahn_service::EventKind::Key => EventKind::Key,
            bahn_service::EventKind::Message => EventKind::Message,
        },
        text: event.text,
    }
}

/// The run in the numbers of LSV/2.
fn run_of(state: State) -> Run {
    let path = |name: &str| match name.is_empty() {
        true => String::new(),
        false => format!("TNC:\\{}", name.rsplit(['/', '\\']).next().unwrap_or(name)),
    };
    let main = path(state.program.as_deref().unwrap_or_default());
    let running = state.running.as_ref();
    let current = running.and_then(|block| block.program.as_deref()).map(path);
    let feed = state.feed_override_percent;
    Run {
        execution: match state.mode {
            Mode::Manual | Mode::Handwheel => Execution::Manual,
            Mode::Mdi => Execution::Mdi,
            Mode::Reference => Execution::Reference,
            Mode::SingleBlock => Execution::SingleBlock,
            Mode::FullSequence => Execution::Automatic,
        },
        state: match state.run {
            RunState::Running => ProgramState::Started,
            RunState::Interrupted if state.broken => ProgramState::Error,
            RunState::Interrupted => ProgramState::Interrupted,
            RunState::Stopped | RunState::BlockEnd => ProgramState::Stopped,
            RunState::Idle if state.ended => ProgramState::Finished,
            RunState::Idle => ProgramState::Idle,
        },
        block: running.map_or(0, |block| block.index),
        current: current.unwrap_or_else(|| main.clone()),
        main,
        axes: state.axes.iter().map(|axis| (axis.letter, axis.actual)).collect(),
        // Rapid traverse has no override of its own.
        overrides: [feed, state.spindle_override_percent, feed],
        tool: Tool {
            number: state.tool,
            axis: match state.tool_shape.axis {
                Some(Axis::X) => 0,
                Some(Axis::Y) => 1,
                _ => 2,
            },
            length: state.tool_shape.length_mm,
            radius: state.tool_shape.radius_mm,
        },
        messages: state
            .messages
            .into_iter()
            .map(|message| Message {
                class: if message.flashing { 1 } else { 2 },
                number: message.fault,
                text: message.text,
            })
            .collect(),
    }
}
