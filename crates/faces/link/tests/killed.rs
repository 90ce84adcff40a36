//! A process that is killed in the middle of a transfer leaves no file under the final name, and nothing when the folder is
//! opened again.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use bahn_store::{Existing, Store};

const FOLDER: &str = "BAHN_LINK_KILLED_FOLDER";

/// What the killed process does: begins a file and never ends it. By itself it does nothing.
#[test]
fn half_a_transfer() {
    let Ok(folder) = std::env::var(FOLDER) else {
        return;
    };
    let store = Store::of_disk(Path::new(&folder)).unwrap();
    let mut file = store
        .create(&store.root().join("1.H").unwrap(), Existing::Replace)
        .unwrap();
    file.write_all(&[b'x'; 1 << 20]).unwrap();
    println!("half");
    loop {
        std::thread::park();
    }
}

#[test]
fn a_killed_transfer_leaves_nothing() {
    let folder = std::env::temp_dir().join(format!("bahn-link-killed-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("1.H"), "before").unwrap();
    let mut process = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "half_a_transfer", "--nocapture"])
        .env(FOLDER, &folder)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let output = BufReader::new(process.stdout.take().unwrap());
    assert!(output.lines().any(|line| line.unwrap().contains("half")));
    let count = || fs::read_dir(&folder).unwrap().count();
    assert_eq!(count(), 2);
    // While it is being written it is not swept.
    drop(Store::of_disk(&folder).unwrap());
    assert_eq!(count(), 2);
    process.kill().unwrap();
    process.wait().unwrap();
    assert_eq!(
        (count(), fs::read_to_string(folder.join("1.H")).unwrap()),
        (2, "before".into())
    );
    let store = Store::of_disk(&folder).unwrap();
    assert_eq!((count(), store.list(&store.root()).unwrap().len()), (1, 1));
    fs::remove_dir_all(&folder).unwrap();
}
