//! A mill that runs in real time, in a folder of its own.

#![allow(dead_code, reason = "each test uses a part")]

#[path = "../../../../machine/host/tests/support/copy.rs"]
mod copy;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use bahn_service::{Input, Key, KeyAction, Live, MachineService, RunState, Screen, Station, load};
use copy::copy;

/// A mill that is on.
pub struct Mill {
    live: Option<Live>,
    pub machine: MachineService,
    pub folder: PathBuf,
}

impl Mill {
    pub fn new() -> Mill {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("bahn-service-{}-{number}", std::process::id()));
        copy(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/mill"),
            &folder,
        );
        let live = Live::start(Station::power_on(load(&folder).unwrap()).unwrap());
        Mill {
            machine: MachineService::of(&live).unwrap(),
            live: Some(live),
            folder,
        }
    }

    /// Presses keys, separated by blanks.
    pub fn press(&self, keys: &str) {
        for key in keys.split_whitespace() {
            self.machine.press(key).unwrap();
        }
    }

    /// A key of the machine operating panel.
    pub fn tap(&self, key: &str) {
        self.machine
            .input(Input::Machine(key.to_owned(), KeyAction::Tap))
            .unwrap();
    }

    /// Waits until the screen is so.
    pub fn until(&self, what: impl Fn(&Screen) -> bool) {
        let end = Instant::now() + Duration::from_secs(120);
        while !what(&self.machine.screen()) {
            assert!(Instant::now() < end, "{:#?}", self.machine.screen());
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// After POWER INTERRUPTED and the reference run.
    pub fn ready(&self) {
        self.machine.input(Input::Speed(50.0)).unwrap();
        self.until(|screen| !screen.messages.is_empty());
        self.machine.input(Input::Key(Key::Ce)).unwrap();
        self.until(|screen| screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty());
        std::thread::sleep(Duration::from_millis(50));
        self.tap("NC_START");
        self.until(|screen| screen.mode == "MANUAL OPERATION");
    }

    /// A program runs.
    pub fn run(&self, name: &str) {
        self.press("FULL PGM_NR");
        for letter in name.chars() {
            self.press(&letter.to_string());
        }
        self.press("ENT");
        self.tap("NC_START");
        let end = Instant::now() + Duration::from_secs(60);
        while self.machine.state().unwrap().run != RunState::Running {
            assert!(Instant::now() < end, "{:#?}", self.machine.screen());
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// The machine ends.
    pub fn end(&mut self) {
        if let Some(live) = self.live.take() {
            live.end().unwrap();
        }
    }
}

impl Drop for Mill {
    fn drop(&mut self) {
        if let Some(live) = self.live.take() {
            let _ = live.end();
        }
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}
