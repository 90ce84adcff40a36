//! A machine that stands still: what tests, measurements and fuzzing serve.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::{
    Area, Device, ErrorNumber, Event, EventKind, Execution, Features, Identity, Message, PlcMessage,
    ProgramState, Run, Tool,
};
use bahn_store::{Store, StoreError};

/// A machine that stands still. Its memory counts: byte n of the PLC is n modulo 256, each third bit is set.
pub struct StillDevice {
    store: Store,
    /// What was done to it, in words.
    calls: Mutex<Vec<String>>,
    /// What the PLC has to say.
    outgoing: Mutex<Vec<PlcMessage>>,
    control: String,
}

impl StillDevice {
    /// One over the folders `programs` and `plc` of a folder, which are made.
    ///
    /// # Errors
    /// When they cannot be made.
    pub fn new(folder: &Path) -> Result<StillDevice, StoreError> {
        let folders = ["programs", "plc"].map(|name| folder.join(name));
        for folder in &folders {
            std::fs::create_dir_all(folder).map_err(|error| StoreError::Medium(error.to_string()))?;
        }
        let [programs, plc] = folders;
        Ok(StillDevice {
            store: Store::of_machine(&programs, &plc)?,
            calls: Mutex::default(),
            outgoing: Mutex::default(),
            control: "BAHN TNC 415".to_owned(),
        })
    }

    /// The same with another name.
    #[must_use]
    pub fn named(mut self, control: &str) -> StillDevice {
        control.clone_into(&mut self.control);
        self
    }

    /// What was done to it since the last time.
    pub fn take_calls(&self) -> Vec<String> {
        std::mem::take(&mut self.calls.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The PLC has something to say.
    pub fn say(&self, message: PlcMessage) {
        let mut outgoing = self.outgoing.lock().unwrap_or_else(PoisonError::into_inner);
        outgoing.push(message);
    }

    fn note(&self, call: String) {
        let mut calls = self.calls.lock().unwrap_or_else(PoisonError::into_inner);
        // Whoever does not take them does not want them.
        if calls.len() < 1000 {
            calls.push(call);
        }
    }
}

impl Device for StillDevice {
    fn identity(&self) -> Identity {
        Identity {
            features: Features::of(&self.control),
            control: self.control.clone(),
            nc_software: "123456 07".to_owned(),
            plc_software: "MAIN.PLC".to_owned(),
            id: "Bahn".to_owned(),
        }
    }

    fn store(&self) -> &Store {
        &self.store
    }

    fn run(&self) -> Result<Run, ErrorNumber> {
        let message = |number: u32, text: &str| Message {
            class: 2,
            number,
            text: text.to_owned(),
        };
        Ok(Run {
            execution: Execution::SingleBlock,
            state: ProgramState::Stopped,
            block: 12,
            main: "TNC:\\MAIN.H".to_owned(),
            current: "TNC:\\SUB.H".to_owned(),
            axes: vec![('X', 12.5), ('C', -0.000_26)],
            overrides: [80.0, 112.5, 80.0],
            tool: Tool {
                number: 7,
                axis: 2,
                length: 80.5,
                radius: 4.0,
            },
            messages: vec![message(3, "POWER INTERRUPTED"), message(9, "PROTECTED PGM")],
        })
    }

    fn elements(&self, area: Area) -> u32 {
        match area {
            Area::Markers => 3264,
            Area::Inputs => 256,
            Area::Outputs | Area::Counters => 128,
            Area::Timers => 96,
            Area::Bytes => 1024,
            Area::Strings => 4,
        }
    }

    fn memory(&self, area: Area, first: u32, count: u32) -> Result<Vec<u8>, ErrorNumber> {
        let end = first.checked_add(count).filter(|end| *end <= self.elements(area));
        let places = first..end.ok_or(ErrorNumber::BAD_ADDRESS)?;
        Ok(match area {
            Area::Bytes => places.map(|place| (place % 256) as u8).collect(),
            Area::Strings => places
                .flat_map(|place| {
                    let mut text = format!("STRING {place}").into_bytes();
                    text.resize(128, 0);
                    text
                })
                .collect(),
            _ => places.map(|place| u8::from(place % 3 == 0)).collect(),
        })
    }

    fn tool_value(&self, tool: u32, column: &str) -> Option<String> {
        match (tool, column) {
            (1, "L") => Some("80.5".to_owned()),
            (1, "NAME") => Some("END MILL".to_owned()),
            _ => None,
        }
    }

    fn parameter(&self, number: u16, index: u8) -> Option<String> {
        match (number, index) {
            (7230, 0) => Some("1".to_owned()),
            (1010, 0..=4) => Some(format!("{}000", index + 1)),
            _ => None,
        }
    }

    fn set_parameter(&self, number: u16, index: u8, value: &str, for_good: bool) -> Result<(), ErrorNumber> {
        self.parameter(number, index).ok_or(ErrorNumber::NO_PARAMETER)?;
        self.note(format!("MP{number}.{index}={value} {for_good}"));
        Ok(())
    }

    fn press(&self, key: &str) -> Result<(), ErrorNumber> {
        self.note(format!("key {key}"));
        Ok(())
    }

    fn screen(&self) -> Result<Vec<u8>, ErrorNumber> {
        Ok(b"BM the screen".to_vec())
    }

    fn log_book(&self) -> Vec<Event> {
        let event = |time, kind, text: &str| Event {
            time,
            kind,
            text: text.to_owned(),
        };
        vec![
            event(1000, EventKind::Message, "POWER INTERRUPTED"),
            event(1001, EventKind::Key, "CE"),
        ]
    }

    fn host_is_there(&self, is_there: bool) {
        self.note(format!("host {is_there}"));
    }

    fn to_plc(&self, message: PlcMessage) -> Result<(), ErrorNumber> {
        self.note(format!("message {message:?}"));
        Ok(())
    }

    fn plc_message(&self) -> Option<PlcMessage> {
        self.outgoing.lock().unwrap_or_else(PoisonError::into_inner).pop()
    }

    fn files_changed(&self) {
        self.note("files".to_owned());
    }
}
