//! A server in the process, with the files of a folder.

#![allow(dead_code, reason = "every test file uses its part")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in the support of tests fails the test"
)]

pub mod client;
pub mod script;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use bahn_lsp::{Connection, Disk, ServeError, Settings, serve};
use bahn_parameters::ControlModel;
use bahn_text::{Files, NamedFile};
use serde_json::Value;

use client::Wire;

/// Files as they lie in folders.
struct Folders;

impl Files for Folders {
    fn read(&self, name: &str) -> Option<NamedFile> {
        let bytes = std::fs::read(name).ok()?;
        let name = name.to_owned();
        Some(NamedFile { name, bytes })
    }
}

impl Disk for Folders {
    fn has(&self, path: &Path) -> bool {
        path.is_file()
    }

    fn model_of(&self, _: &Path) -> Option<ControlModel> {
        None
    }

    fn names(&self, folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten();
        let mut names: Vec<String> = entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .collect();
        names.sort();
        names
    }
}

/// A server that runs on a thread of its own.
pub struct InProcess {
    connection: Option<Connection>,
    thread: Option<JoinHandle<Result<(), ServeError>>>,
}

impl InProcess {
    pub fn start() -> InProcess {
        let (editor, server) = Connection::memory();
        let thread = std::thread::spawn(move || serve(&server, Arc::new(Folders), &Settings::default()));
        InProcess {
            connection: Some(editor),
            thread: Some(thread),
        }
    }

    /// How the server has ended.
    pub fn ended(mut self) -> Result<(), ServeError> {
        self.connection = None;
        self.thread
            .take()
            .unwrap()
            .join()
            .expect("the server does not panic")
    }
}

impl Wire for InProcess {
    fn send(&mut self, message: Value) {
        let message = serde_json::from_value(message).unwrap();
        self.connection.as_ref().unwrap().sender.send(message).unwrap();
    }

    fn receive(&mut self, patience: Duration) -> Option<Value> {
        let message = self
            .connection
            .as_ref()
            .unwrap()
            .receiver
            .recv_timeout(patience)
            .ok()?;
        Some(serde_json::to_value(message).unwrap())
    }
}

/// A folder that is removed in the end.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new() -> Folder {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("bahn-lsp-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
