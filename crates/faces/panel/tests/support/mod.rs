//! A trainee at the station of a shipped machine, in a folder of his own.

#![allow(dead_code, reason = "each test uses a part")]

#[path = "../../../../machine/host/tests/support/copy.rs"]
pub mod copy;
mod tnc155;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use bahn_panel::{Input, InputText, Screen, Station};
use bahn_parameters::ControlModel;
use copy::copy;

/// A station whose time passes as the test says.
pub struct Trainee {
    pub station: Station,
    folder: Folder,
}

/// A folder that is removed in the end.
#[derive(Default)]
struct Folder(PathBuf);

impl Trainee {
    /// A machine that was never on.
    pub fn at(machine: &str) -> Trainee {
        Trainee::with(machine, |_| {})
    }

    /// The same with a folder that something was done to.
    pub fn with(machine: &str, what: impl FnOnce(&Path)) -> Trainee {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("bahn-panel-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        copy(&machines().join(machine), &folder);
        what(&folder);
        Trainee {
            station: on(&folder),
            folder: Folder(folder),
        }
    }

    /// The knee mill with a TNC 151 or 155, and lines of its list in place of its own.
    pub fn with_tnc155(model: ControlModel, lines: &[&str]) -> Trainee {
        Trainee::with("mill-tnc155", |folder| tnc155::fit(folder, model, lines))
    }

    /// His station, and his machine's folder, which is to be removed.
    pub fn apart(self) -> (Station, PathBuf) {
        let Trainee { station, mut folder } = self;
        (station, std::mem::take(&mut folder.0))
    }

    /// The station ends without being asked, and the machine is switched on again.
    pub fn killed(self) -> Trainee {
        let (station, folder) = self.apart();
        drop(station);
        Trainee {
            station: on(&folder),
            folder: Folder(folder),
        }
    }

    /// His machine's folder.
    pub fn folder(&self) -> &Path {
        &self.folder.0
    }

    /// Presses keys, separated by blanks, a tenth of a second apart; they must be there.
    pub fn press(&mut self, keys: &str) -> &mut Trainee {
        for key in keys.split_whitespace() {
            self.give(&format!("{{\"key\":\"{key}\"}}"));
            self.wait(0.1);
        }
        self
    }

    /// Types a number.
    pub fn number(&mut self, text: &str) -> &mut Trainee {
        for character in text.chars() {
            let key = match character {
                '-' => "SIGN".to_owned(),
                '.' => "POINT".to_owned(),
                digit => digit.to_string(),
            };
            self.press(&key);
        }
        self
    }

    /// Types letters and digits, each by its key.
    pub fn typed(&mut self, word: &str) -> &mut Trainee {
        for character in word.chars() {
            self.press(&character.to_string());
        }
        self
    }

    /// Goes to the line of a list that begins so: down, or from its top.
    pub fn down_to(&mut self, name: &str) {
        for way in ["", "UP"] {
            for _ in 0..60 {
                self.press(way);
            }
            for _ in 0..60 {
                let lines = self.screen().program.lines;
                if lines
                    .iter()
                    .any(|line| line.current && line.text.starts_with(name))
                {
                    return;
                }
                self.press("DOWN");
            }
        }
        panic!("no {name}: {:#?}", self.screen().program);
    }

    /// What a line of a menu stands at.
    pub fn menu_value(&mut self, name: &str) -> String {
        let lines = self.screen().program.lines;
        let line = lines.into_iter().find(|line| line.text.starts_with(name));
        line.unwrap().text[name.len()..].trim().to_owned()
    }

    /// Presses the soft key of this text, whatever row it is in.
    pub fn soft(&mut self, name: &str) {
        for _ in 0..self.screen().soft_keys.rows.max(1) {
            let keys = self.screen().soft_keys.keys;
            if let Some(place) = keys.iter().position(|key| key == name) {
                self.press(&format!("SK{}", place + 1));
                return;
            }
            self.press("SK_RIGHT");
        }
        panic!("no soft key {name}: {:?}", self.screen().soft_keys);
    }

    /// Gives an input.
    pub fn give(&mut self, json: &str) -> &mut Trainee {
        let text: InputText = serde_json::from_str(json).unwrap();
        let input = Input::try_from(text).unwrap();
        self.station
            .input(&input)
            .unwrap_or_else(|refusal| panic!("{json}: {refusal}"));
        self
    }

    /// Lets time pass, s.
    pub fn wait(&mut self, seconds: f64) -> &mut Trainee {
        let end = self.station.control().time_us() + (seconds * 1e6) as u64;
        while self.station.control().time_us() < end {
            self.station.cycle().unwrap();
        }
        self
    }

    /// Lets time pass until something is so, at most so many seconds.
    pub fn until(&mut self, at_most: f64, what: impl Fn(&Screen) -> bool) -> &mut Trainee {
        for _ in 0..(at_most * 10.0) as u32 {
            if what(self.station.screen()) {
                return self;
            }
            self.wait(0.1);
        }
        panic!("not within {at_most} s: {:#?}", self.station.screen());
    }

    pub fn screen(&mut self) -> Screen {
        self.station.screen().clone()
    }

    /// Messages that are shown.
    pub fn messages(&mut self) -> Vec<String> {
        let screen = self.station.screen();
        screen
            .messages
            .iter()
            .map(|message| message.text.clone())
            .collect()
    }

    /// The position of an axis as it stands on the screen.
    pub fn position(&mut self, letter: char) -> String {
        let screen = self.station.screen();
        let axis = screen.status.axes.iter().find(|axis| axis.letter == letter);
        axis.map(|axis| axis.value.clone()).unwrap()
    }

    /// POWER INTERRUPTED, control voltage and reference marks are after him.
    pub fn ready(&mut self) -> &mut Trainee {
        self.until(5.0, |screen| !screen.messages.is_empty());
        assert_eq!(self.messages(), ["POWER INTERRUPTED"]);
        self.press("CE");
        self.until(10.0, |screen| {
            screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
        });
        self.wait(1.0);
        self.press("NC_START");
        self.until(120.0, |screen| screen.mode == "MANUAL OPERATION");
        self
    }

    /// Whether there is a file in his machine's folder.
    pub fn has(&self, name: &str) -> bool {
        self.folder.0.join(name).exists()
    }

    /// Writes a file of his machine's folder.
    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.folder.0.join(name), text).unwrap();
    }

    /// A file of his machine's folder.
    pub fn file(&self, name: &str) -> String {
        std::fs::read_to_string(self.folder.0.join(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !self.0.as_os_str().is_empty() {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

fn on(folder: &Path) -> Station {
    let machine = bahn_panel::load(folder).unwrap();
    Station::power_on(machine).unwrap()
}

fn machines() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines")
}
