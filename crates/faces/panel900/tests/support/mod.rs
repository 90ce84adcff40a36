//! The portal, operated by keys.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use bahn_host::{KeyAction, Machine900, PowerOn900};
use bahn_live::{Input, InputText, Refusal};
use bahn_panel900::Station900;
use bahn_screen::{Line, Screen};
use bahn_system900::Name;

/// A station, and how long its cycle is.
pub struct Panel(pub Station900);

impl Panel {
    /// The portal of the machines on an ideal machine, fresh; the standard answers have enabled its axes.
    pub fn of_the_portal() -> Panel {
        let machine = Machine900::load(ideal_portal())
            .unwrap()
            .unwrap_or_else(|faults| panic!("{faults:?}"));
        let mut panel = Panel(Station900::switched_on(machine, PowerOn900::fresh));
        panel.run(0.1);
        panel
    }

    /// Lets so many seconds of the machine pass.
    pub fn run(&mut self, seconds: f64) {
        let end = self.time_s() + seconds;
        while self.time_s() < end {
            self.0.cycle().unwrap();
        }
    }

    /// Lets time pass until something is so, at most so many seconds.
    pub fn until(&mut self, seconds: f64, what: impl Fn(&Panel) -> bool) {
        let end = self.time_s() + seconds;
        while !what(self) {
            assert!(self.time_s() < end, "{:#?}", self.0.screen());
            self.0.cycle().unwrap();
        }
    }

    pub fn time_s(&self) -> f64 {
        self.0
            .host()
            .map_or(0.0, |host| host.control().now_us() as f64 / 1e6)
    }

    /// An input as JSON.
    pub fn give(&mut self, json: &str) -> Result<(), Refusal> {
        let text: InputText = serde_json::from_str(json).unwrap();
        self.0.take(&Input::try_from(text).unwrap())
    }

    /// Taps a key by its name.
    pub fn tap(&mut self, name: &str) -> Result<(), Refusal> {
        self.give(&format!("{{\"key\":\"{name}\"}}"))
    }

    /// Taps keys that are not refused.
    pub fn keys(&mut self, names: &str) {
        for name in names.split_whitespace() {
            self.tap(name)
                .unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
        }
    }

    /// Presses or releases a key of the machine.
    pub fn hold(&mut self, name: &str, action: KeyAction) -> Result<(), Refusal> {
        self.0.take(&Input::Machine(name.to_owned(), action))
    }

    /// Types a line and enters it.
    pub fn enter(&mut self, text: &str) -> Result<(), Refusal> {
        self.0.take(&Input::Text(text.to_owned()))?;
        self.tap("ENT")
    }

    pub fn screen(&mut self) -> Screen {
        self.0.screen().clone()
    }

    /// The lines of the page.
    pub fn page(&mut self) -> Vec<String> {
        let lines = self.0.screen().program.lines.iter();
        lines.map(|line: &Line| line.text.clone()).collect()
    }

    /// What a parameter holds.
    pub fn number(&self, name: &str) -> Option<f64> {
        let name: Name = name.parse().unwrap();
        self.0.host().unwrap().control().number(name).unwrap()
    }

    /// What the panel says.
    pub fn said(&mut self) -> String {
        let messages = self
            .0
            .screen()
            .messages
            .iter()
            .map(|message| message.text.clone());
        messages.collect::<Vec<_>>().join("; ")
    }
}

/// A copy of the portal without its plant and its PLC program; the standard answers change tools.
fn ideal_portal() -> &'static Path {
    static COPY: OnceLock<PathBuf> = OnceLock::new();
    COPY.get_or_init(|| {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/portal900");
        let copy = Path::new(env!("CARGO_TARGET_TMPDIR")).join("ideal-portal");
        fs::create_dir_all(copy.join("programs")).unwrap();
        for entry in fs::read_dir(shipped.join("programs")).unwrap() {
            let name = entry.unwrap().file_name();
            if name != "Z6.900" {
                fs::copy(
                    shipped.join("programs").join(&name),
                    copy.join("programs").join(&name),
                )
                .unwrap();
            }
        }
        fs::copy(shipped.join("parameters.q"), copy.join("parameters.q")).unwrap();
        let described = fs::read_to_string(shipped.join("machine.toml")).unwrap();
        let (ideal, _) = described.split_once("plant = ").unwrap();
        fs::write(copy.join("machine.toml"), ideal).unwrap();
        copy
    })
}
