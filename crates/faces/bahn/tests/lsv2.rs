//! A machine on its LSV/2 port, as the hosts of today and `bahn link lsv2` use it.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use support::{Folder, copy};

/// A machine that is served; it ends with the test.
struct Served {
    child: Child,
    address: String,
    folder: Folder,
}

impl Served {
    fn start(options: &[&str]) -> Served {
        let folder = Folder::new();
        copy(&root().join("machines/mill"), &folder.path("mill"));
        Served::on(folder, options)
    }

    fn on(folder: Folder, options: &[&str]) -> Served {
        // A port that is free: it was a moment ago.
        let free = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = free.local_addr().unwrap().to_string();
        drop(free);
        let mut child = Command::new(env!("CARGO_BIN_EXE_bahn"))
            .args(["link", "serve", "--machine"])
            .arg(folder.path("mill"))
            .args(["--lsv2", &address])
            .args(options)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut line)
            .unwrap();
        assert_eq!(line, "ready\n");
        Served {
            child,
            address,
            folder,
        }
    }

    fn signal(&self, signal: &str) {
        let id = self.child.id().to_string();
        assert!(
            Command::new("kill")
                .args([signal, &id])
                .status()
                .unwrap()
                .success()
        );
    }

    /// Ends as Ctrl-C does.
    fn end(mut self) -> i32 {
        self.signal("-INT");
        self.child.wait().unwrap().code().unwrap()
    }

    fn programs(&self) -> PathBuf {
        self.folder.path("mill/programs")
    }

    fn ask(&self, arguments: &[&str]) -> Output {
        let mut arguments = arguments.to_vec();
        arguments.insert(1, &self.address);
        Command::new(env!("CARGO_BIN_EXE_bahn"))
            .args(["link", "lsv2"])
            .args(arguments)
            .current_dir(self.folder.path("."))
            .output()
            .unwrap()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// The virtual environment with pyLSV2 that `make pylsv2` installs.
fn python() -> Option<PathBuf> {
    let python = root().join("out/pylsv2/bin/python");
    let there = python.exists();
    if !there {
        eprintln!("out/pylsv2 is not there, see `make pylsv2`: what it does is skipped");
    }
    there.then_some(python)
}

/// Versions, folders, files up and down, run information, memory, parameters, tool table, keys and screen.
#[test]
fn pylsv2_finds_the_control_it_knows() {
    let Some(python) = python() else {
        eprintln!("skipped: out/pylsv2 is not there, see `make pylsv2`");
        return;
    };
    let served = Served::start(&["--identity", "iTNC530"]);
    let list = || served.folder.read("mill/parameters.mp");
    let before = list();
    let here = served.folder.path("host");
    std::fs::create_dir(&here).unwrap();
    let port = served.address.rsplit(':').next().unwrap();
    let output = Command::new(python)
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsv2.py"))
        .arg(port)
        .arg(&here)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(said.lines().count(), 7, "{said}");
    let changed = before
        .lines()
        .zip(list().lines())
        .filter(|(old, new)| old != new)
        .count();
    assert_eq!(
        (changed, before.lines().count()),
        (1, list().lines().count()),
        "what was set for good"
    );
    assert_eq!(served.end(), 0);
}

#[test]
fn the_command_asks_what_the_command_serves() {
    let served = Served::start(&["--password", "FILE=steel"]);
    let refused = served.ask(&["ls"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("the password is wrong"));
    let with = |arguments: &[&str]| {
        let output = served.ask(&[arguments, &["--password", "FILE=steel"]].concat());
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8(output.stdout).unwrap()
    };
    let listed: serde_json::Value = serde_json::from_str(&with(&["ls", "--format", "json"])).unwrap();
    let names: Vec<_> = listed
        .as_array()
        .unwrap()
        .iter()
        .map(|entry| entry["name"].as_str().unwrap())
        .collect();
    assert!(
        names.contains(&"CIRCLE.H") && names.contains(&"TOOL.T"),
        "{names:?}"
    );
    let content = b"0 BEGIN PGM NEW MM\r\n1 END PGM NEW MM\r\n\0\x10";
    served.folder.write("new.h", content);
    with(&["put", "new.h", "TNC:/NEW.H"]);
    assert_eq!(std::fs::read(served.programs().join("NEW.H")).unwrap(), content);
    with(&["get", "TNC:/new.h", "back.h"]);
    assert_eq!(std::fs::read(served.folder.path("back.h")).unwrap(), content);
    with(&["rm", "TNC:/NEW.H"]);
    assert!(!served.programs().join("NEW.H").exists());
    let gone = served.ask(&[
        "get",
        "TNC:/NEW.H",
        "none.h",
        "--password",
        "FILE=steel",
        "--format",
        "json",
    ]);
    assert_eq!(gone.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&gone.stdout).contains("there is no such file"));
    assert!(!served.folder.path("none.h").exists());
    with(&["screen", "screen.bmp"]);
    assert_eq!(
        &std::fs::read(served.folder.path("screen.bmp")).unwrap()[..2],
        b"BM"
    );
    let info: serde_json::Value = serde_json::from_str(&with(&["info", "--format", "json"])).unwrap();
    assert_eq!(
        (&info["control"], &info["mode"]),
        (&"BAHN TNC 415 B".into(), &"manual operation".into())
    );
    assert_eq!(info["messages"], serde_json::json!(["POWER INTERRUPTED"]));
    assert!(info["position"]["X"].is_number());
    let software = info["nc_software"].as_str().unwrap();
    assert!(
        software.len() == 9 && software.as_bytes()[6] == b' ',
        "{software}"
    );
    let text = with(&["info"]);
    assert!(
        text.contains("POWER INTERRUPTED") && text.contains("mode          manual operation"),
        "{text}"
    );
    assert_eq!(served.end(), 0);
}

fn telegram(stream: &mut TcpStream, command: &[u8]) -> Vec<u8> {
    let length = (command.len() as u32 - 4).to_be_bytes();
    stream.write_all(&[length.as_slice(), command].concat()).unwrap();
    let mut head = [0; 8];
    stream.read_exact(&mut head).unwrap();
    let mut data = vec![0; u32::from_be_bytes(head[..4].try_into().unwrap()) as usize];
    stream.read_exact(&mut data).unwrap();
    [&head[4..], &data].concat()
}

/// `kill -9` in the middle of an upload: the file is what it was, and the next start finds nothing half written.
#[test]
fn a_killed_server_leaves_no_half_file() {
    let served = Served::start(&[]);
    let program = served.programs().join("CIRCLE.H");
    let before = std::fs::read(&program).unwrap();
    let mut stream = TcpStream::connect(&served.address).unwrap();
    for command in [
        b"A_LGFILE\0".as_slice(),
        b"C_FLTNC:\\CIRCLE.H\0\x01",
        b"S_FLhalf of it",
    ] {
        assert_eq!(telegram(&mut stream, command), b"T_OK");
    }
    let count = || std::fs::read_dir(served.programs()).unwrap().count();
    let with_half = count();
    served.signal("-KILL");
    let mut rest = Vec::new();
    let _ = stream.read_to_end(&mut rest);
    assert_eq!(
        (std::fs::read(&program).unwrap(), count()),
        (before.clone(), with_half)
    );
    let folder = Folder::new();
    copy(&served.folder.path("mill"), &folder.path("mill"));
    drop(served);
    let served = Served::on(folder, &[]);
    assert_eq!(
        std::fs::read_dir(served.programs()).unwrap().count(),
        with_half - 1
    );
    assert_eq!(std::fs::read(served.programs().join("CIRCLE.H")).unwrap(), before);
    assert_eq!(served.end(), 0);
}

/// The PLC sends back each doubleword that a host sends (modules 9111 and 9110).
#[test]
fn host_and_plc_talk_with_each_other() {
    const ECHO: &str = "       PS    K+0\n       PS    K+200\n       CM    9111\n       PL    B204\n       L     M3171\n       \
                        JPT   ECHOED\n       PS    K+0\n       PS    K+200\n       CM    9110\n       PL    B205\n\
                        LBL ECHOED\n";
    let folder = Folder::new();
    copy(&root().join("machines/mill"), &folder.path("mill"));
    let main = folder.read("mill/plc/MAIN.PLC");
    folder.write("mill/plc/MAIN.PLC", ECHO.to_owned() + &main);
    let served = Served::on(folder, &[]);
    let mut stream = TcpStream::connect(&served.address).unwrap();
    stream
        .set_read_timeout(Some(std::time::Duration::from_secs(10)))
        .unwrap();
    // The PLC runs when POWER INTERRUPTED is acknowledged.
    for command in [b"A_LGMONITOR\0".as_slice(), b"C_EK\x01\xae", b"A_LGDNC\0"] {
        assert_eq!(telegram(&mut stream, command), b"T_OK");
    }
    for value in [-2_i32, 0x0102_0304] {
        let message = [b"M_PC".as_slice(), &value.to_be_bytes()].concat();
        assert_eq!(telegram(&mut stream, &message), b"T_OK");
        let mut back = [0; 12];
        stream.read_exact(&mut back).unwrap();
        assert_eq!(back[4..], message);
    }
    assert_eq!(served.end(), 0);
}

#[test]
fn wrong_use_ends_before_anything_is_open() {
    let served = Served::start(&[]);
    let folder = Folder::new();
    copy(&root().join("machines/mill"), &folder.path("mill"));
    let serve = |options: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_bahn"))
            .args(["link", "serve", "--machine"])
            .arg(folder.path("mill"))
            .args(options)
            .output()
            .unwrap();
        assert!(output.stdout.is_empty(), "never ready");
        (
            output.status.code().unwrap(),
            String::from_utf8(output.stderr).unwrap(),
        )
    };
    let (code, said) = serve(&["--lsv2", &served.address]);
    assert!(code == 1 && said.contains(&served.address), "{code} {said}");
    let (code, said) = serve(&["--lsv2", "0.0.0.0:0", "--password", "FILE=steel"]);
    assert!(
        code == 2 && said.contains("INSPECT, DIAGNOSTICS, FILEPLC"),
        "{code} {said}"
    );
    assert_eq!(serve(&["--lsv2", "127.0.0.1:0", "--password", "KITCHEN=x"]).0, 2);
    assert_eq!(serve(&["--lsv2", "19000"]).0, 2);
}
