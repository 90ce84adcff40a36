//! `bahn link dnc`: a program is executed while it is transferred, against the other command and against devices of the
//! test.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Stdio};
use std::time::Duration;

use serde_json::Value;
use support::*;

const SOH: u8 = 1;
const STX: u8 = 2;
const ETX: u8 = 3;
const EOT: u8 = 4;
const ACK: u8 = 6;
const NAK: u8 = 0x15;
const ETB: u8 = 0x17;

/// The other end of the line, as the manuals tell it.
struct Device(TcpStream);

impl Device {
    fn new(stream: TcpStream) -> Device {
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        stream.set_nodelay(true).unwrap();
        Device(stream)
    }

    fn byte(&mut self) -> u8 {
        let mut byte = [0];
        self.0.read_exact(&mut byte).unwrap();
        byte[0]
    }

    /// Whether anything comes within a time.
    fn is_quiet(&mut self, time: Duration) -> bool {
        self.0.set_read_timeout(Some(time)).unwrap();
        let quiet = self.0.read(&mut [0]).is_err();
        self.0.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        quiet
    }

    fn send(&mut self, first: u8, text: &str) {
        let mut block = vec![first];
        block.extend(text.bytes());
        block.push(ETB);
        block.push(block.iter().fold(0, |check, byte| check ^ byte));
        self.0.write_all(&block).unwrap();
    }

    /// A block or header with the DC1 after it; its text.
    fn block(&mut self, first: u8) -> String {
        let mut found = self.byte();
        while found == 0x11 {
            found = self.byte();
        }
        assert_eq!(found, first);
        let (mut text, mut check) = (Vec::new(), first ^ ETB);
        loop {
            match self.byte() {
                ETB => break,
                byte => {
                    text.push(byte);
                    check ^= byte;
                }
            }
        }
        assert_eq!(self.byte(), check);
        String::from_utf8(text).unwrap()
    }

    fn answer(&mut self) -> u8 {
        loop {
            match self.byte() {
                0x11 => {}
                byte => return byte,
            }
        }
    }
}

fn mill() -> Folder {
    Folder::with_mill("L X+1 R0 F100")
}

/// Starts the control, which connects to the test.
fn control(folder: &Folder, further: &str) -> (Child, Device) {
    control_for(folder, "15.H", further)
}

/// The same for a program of some name.
fn control_for(folder: &Folder, name: &str, further: &str) -> (Child, Device) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = format!("connect:{}", listener.local_addr().unwrap());
    let arguments =
        format!("link dnc run --machine mill --fresh --format json --port {port} {name} {further}");
    let child = folder
        .command()
        .args(arguments.split_whitespace())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    (child, Device::new(listener.accept().unwrap().0))
}

/// The report, and the exit status.
fn report(child: Child) -> (Value, i32) {
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let last = text
        .lines()
        .last()
        .unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&output.stderr)));
    (serde_json::from_str(last).unwrap(), output.status.code().unwrap())
}

const BLOCKS: [&str; 6] = [
    "0 BEGIN PGM 15 MM",
    "1 L X+100 Y+50 R0 F5000",
    "2 L X+110",
    "3 L Y+60",
    "4 L X+120",
    "5 END PGM 15 MM",
];

/// The header of the manual; a block that is refused by NAK comes again; ETX ends it, and EOT says so.
#[test]
fn a_program_comes_and_is_executed() {
    let (child, mut device) = control(&mill(), "");
    assert_eq!(device.block(SOH), "H15E");
    device.0.write_all(&[NAK]).unwrap();
    assert_eq!(device.block(SOH), "H15E");
    device.0.write_all(&[ACK]).unwrap();
    for block in BLOCKS {
        device.send(STX, block);
        assert_eq!(device.answer(), ACK, "{block}");
    }
    device.0.write_all(&[ETX]).unwrap();
    assert_eq!(device.answer(), EOT);
    let (report, status) = report(child);
    assert_eq!(status, 0, "{report}");
    assert_eq!((&report["blocks"], &report["executed"]), (&6.into(), &4.into()));
    assert_eq!(
        (&report["position"]["X"], &report["position"]["Y"]),
        (&120.0.into(), &60.0.into())
    );
    assert_eq!(
        (&report["message"], &report["completed"]),
        (&Value::Null, &true.into())
    );
}

/// The cable is pulled: what is known is executed, the message stands.
#[test]
fn what_is_known_is_executed_when_the_line_goes() {
    let (child, mut device) = control(&mill(), "");
    device.block(SOH);
    device.0.write_all(&[ACK]).unwrap();
    for block in &BLOCKS[..4] {
        device.send(STX, block);
        assert_eq!(device.answer(), ACK);
    }
    drop(device);
    let (report, status) = report(child);
    assert_eq!((status, &report["message"]), (1, &"PROGRAM INCOMPLETE".into()));
    assert_eq!(
        (&report["blocks"], &report["position"]["Y"]),
        (&4.into(), &60.0.into())
    );
    assert_eq!(report["position"]["X"], 110.0);
}

/// At a programmed stop MP7228.1 = 1 kByte fills, and the next block is not acknowledged.
#[test]
fn a_full_memory_gives_no_acknowledgement() {
    let (child, mut device) = control(&mill(), "--mp 7228.1=1");
    device.block(SOH);
    device.0.write_all(&[ACK]).unwrap();
    let mut sent = 0;
    let mut blocks = vec![
        "0 BEGIN PGM 15 MM".to_owned(),
        "1 L X+50 R0 F5000".to_owned(),
        "2 STOP".to_owned(),
    ];
    blocks.extend((3..200).map(|at| format!("{at} L X+{at} Y+40 F3000")));
    for block in &blocks {
        device.send(STX, block);
        if device.is_quiet(Duration::from_millis(1500)) {
            break;
        }
        sent += block.len() + 2;
    }
    // What is executed is not held any more.
    assert!((1024..1024 + 80).contains(&sent), "{sent}");
    drop(device);
    let (report, status) = report(child);
    assert_eq!((status, &report["message"]), (1, &"PROGRAM INCOMPLETE".into()));
    assert_eq!(report["position"]["X"], 50.0);
}

/// START again after a broken line: the device sends everything anew, and no block is executed twice.
#[test]
fn start_again_after_a_broken_line() {
    let folder = mill();
    let mut child = folder
        .command()
        .args(
            "link dnc run --machine mill --fresh --format json --restarts 1 --port tcp:127.0.0.1:0 15.H"
                .split(' '),
        )
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut errors = BufReader::new(child.stderr.take().unwrap());
    let address = address(&mut errors);
    for sent in [4, BLOCKS.len()] {
        let mut device = Device::new(TcpStream::connect(&address).unwrap());
        assert_eq!(device.block(SOH), "H15E");
        device.0.write_all(&[ACK]).unwrap();
        for block in &BLOCKS[..sent] {
            // Incremental blocks would show that one is executed twice.
            device.send(
                STX,
                &block.replace("L X+110", "L IX+10").replace("L Y+60", "L IY+10"),
            );
            assert_eq!(device.answer(), ACK);
        }
        if sent == BLOCKS.len() {
            device.0.write_all(&[ETX]).unwrap();
            assert_eq!(device.answer(), EOT);
        }
    }
    let (report, status) = report(child);
    assert_eq!((status, &report["blocks"]), (0, &6.into()), "{report}");
    assert_eq!(
        (&report["position"]["X"], &report["position"]["Y"]),
        (&120.0.into(), &60.0.into())
    );
}

/// The address that a listening port is told to have.
fn address(errors: &mut impl BufRead) -> String {
    let mut line = String::new();
    while !line.contains(" is ") {
        line.clear();
        assert!(errors.read_line(&mut line).unwrap() > 0);
    }
    line.trim().rsplit(' ').next().unwrap().to_owned()
}

/// The other side says that it has no such program, in its own words.
#[test]
fn the_device_has_no_such_program() {
    let (child, mut device) = control(&mill(), "");
    device.block(SOH);
    device.send(SOH, "ERR: 010");
    assert_eq!(device.answer(), ACK);
    assert_eq!(device.answer(), EOT);
    let (report, status) = report(child);
    assert_eq!((status, &report["message"]), (1, &"ERR: 010".into()));
    assert_eq!(report["blocks"], 0);
}

/// Both commands against each other, over a good line in every mode: M30 stands before END PGM.
#[test]
fn both_sides() {
    let lines: String = (1..1000)
        .map(|at| format!("{at} L X+{} Y+{} R0 F8000\r\n", 50 + at % 60, 40 + at % 7))
        .collect();
    let text = format!("0 BEGIN PGM 15 MM\r\n{lines}1000 L X+77 M30\r\n1001 END PGM 15 MM\r\n");
    for mode in ["fe1", "fe2", "ext1"] {
        let folder = mill();
        std::fs::create_dir(folder.path("parts")).unwrap();
        folder.write("parts/15.H", &text);
        let mut sender = folder
            .command()
            .args(
                format!("link dnc send --dir parts --format json --port tcp:127.0.0.1:0,mode={mode} 15.H")
                    .split(' '),
            )
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let address = address(&mut BufReader::new(sender.stderr.take().unwrap()));
        let run = folder.bahn(&format!(
            "link dnc run --machine mill --fresh --format json --mp 7228.1=2 --port connect:{address},mode={mode} 15.H"
        ));
        let text = run.out();
        let report: Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
        assert_eq!(
            (run.code(), &report["message"]),
            (0, &Value::Null),
            "{mode}: {report}"
        );
        assert_eq!(
            (&report["blocks"], &report["executed"], &report["position"]["X"]),
            (&1002.into(), &1000.into(), &77.0.into()),
            "{mode}"
        );
        let output = sender.wait_with_output().unwrap();
        let reported = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{mode}: {reported}");
        let last: Value = serde_json::from_str(reported.lines().last().unwrap()).unwrap();
        assert_eq!(
            (&last["event"], &last["blocks"]),
            (&"done".into(), &1002.into()),
            "{mode}: {reported}"
        );
    }
}

/// A control that is played by the test: broken off and asked again it gets the program from its beginning, with `--resume`
/// from the block on that it has not acknowledged.
#[test]
fn the_sender_goes_on_after_a_broken_line() {
    for (option, expected) in [
        ("", &BLOCKS[..]),
        ("--resume", &[BLOCKS[0], BLOCKS[3], BLOCKS[4], BLOCKS[5]]),
    ] {
        let folder = Folder::new();
        std::fs::create_dir(folder.path("parts")).unwrap();
        folder.write("parts/15.H", BLOCKS.join("\n") + "\n");
        let mut sender = folder
            .command()
            .args(
                format!("link dnc send --dir parts --format json --port tcp:127.0.0.1:0 15.H {option}")
                    .split_whitespace(),
            )
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let address = address(&mut BufReader::new(sender.stderr.take().unwrap()));
        let mut device = Device::new(TcpStream::connect(&address).unwrap());
        device.send(SOH, "H16E");
        assert_eq!(device.block(SOH), "ERR: 010", "it was not named");
        device.0.write_all(&[ACK]).unwrap();
        device.send(SOH, "H15E");
        assert_eq!(device.answer(), ACK);
        for block in &BLOCKS[..3] {
            assert_eq!(device.block(STX), *block);
            device.0.write_all(&[ACK]).unwrap();
        }
        assert_eq!(device.block(STX), BLOCKS[3]);
        drop(device);
        let mut device = Device::new(TcpStream::connect(&address).unwrap());
        device.send(SOH, "H15E");
        assert_eq!(device.answer(), ACK);
        for block in expected {
            assert_eq!(device.block(STX), *block, "{option}");
            device.0.write_all(&[ACK]).unwrap();
        }
        assert_eq!(device.answer(), ETX);
        device.0.write_all(&[EOT]).unwrap();
        let output = sender.wait_with_output().unwrap();
        let reported = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{reported}");
        let events: Vec<Value> = reported
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        let broken = events
            .iter()
            .find(|event| event["event"] == "broken" && event["blocks"] == 3);
        assert!(broken.is_some(), "{reported}");
        assert_eq!(events.last().unwrap()["complete"], true, "{reported}");
    }
}

/// In real time, at the speed of the network and over a line that is slower than the feed: the path waits for its
/// blocks then, and is as long as the line takes.
#[test]
fn in_real_time() {
    let lines: Vec<String> = (1..=300)
        .map(|at| format!("{at} L X+{}.{} F6000", 20 + at / 5, at % 5 * 2))
        .collect();
    let text = format!("0 BEGIN PGM 15 MM\n{}\n301 END PGM 15 MM\n", lines.join("\n"));
    let run = |baud: &str| {
        let folder = mill();
        std::fs::create_dir(folder.path("parts")).unwrap();
        folder.write("parts/15.H", &text);
        let mut sender = folder
            .command()
            .args(format!("link dnc send --dir parts --port tcp:127.0.0.1:0,mode=fe1{baud} 15.H").split(' '))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let address = address(&mut BufReader::new(sender.stderr.take().unwrap()));
        let begun = std::time::Instant::now();
        let run = folder.bahn(&format!(
            "link dnc run --machine mill --fresh --realtime --format json --port connect:{address},mode=fe1{baud} 15.H"
        ));
        let wall = begun.elapsed().as_secs_f64();
        let report: Value = serde_json::from_str(run.out().lines().last().unwrap()).unwrap();
        assert_eq!((run.code(), &report["blocks"]), (0, &302.into()), "{report}");
        assert_eq!(report["position"]["X"], 80.0);
        assert!(sender.wait().unwrap().success());
        let machining = report["machining_time_s"].as_f64().unwrap();
        assert!(wall > machining, "{wall} s for {machining} s");
        machining
    };
    let (fast, slow) = std::thread::scope(|scope| {
        let fast = scope.spawn(|| run(""));
        let slow = scope.spawn(|| run(",baud=9600"));
        (fast.join().unwrap(), slow.join().unwrap())
    });
    // Each block has STX, ETB, BCC and DC1 around it, and an acknowledgement; a character has ten bits.
    let characters: usize = text.lines().map(|line| line.len() + 5).sum();
    // Slow enough that a busy computer does not make a fast line look as slow.
    let line = characters as f64 * 10.0 / 9_600.0;
    // The first blocks come before the machine starts.
    let started = line * 0.9;
    assert!(slow > started && slow < line * 2.0, "{slow} s, the line {line} s");
    // 60 mm with F6000 and the ramps.
    assert!(fast > 0.6 && fast < line, "{fast} s, the line {line} s");
}

/// A sender that connects does so again when its line drops, and goes on there; nobody there any more ends it.
#[test]
fn the_sender_connects_again() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("parts")).unwrap();
    folder.write("parts/15.H", BLOCKS.join("\n") + "\n");
    for (comes_back, option) in [(true, "--resume"), (false, "--again 1")] {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let place = listener.local_addr().unwrap();
        let arguments =
            format!("link dnc send --dir parts --format json --port connect:{place} 15.H {option}");
        let sender = folder
            .command()
            .args(arguments.split_whitespace())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut device = Device::new(listener.accept().unwrap().0);
        device.send(SOH, "H15E");
        assert_eq!(device.answer(), ACK);
        for block in &BLOCKS[..2] {
            assert_eq!(device.block(STX), *block);
            device.0.write_all(&[ACK]).unwrap();
        }
        assert_eq!(device.block(STX), BLOCKS[2]);
        drop((device, listener));
        if comes_back {
            // For a while nobody is there.
            std::thread::sleep(Duration::from_millis(800));
            let listener = TcpListener::bind(place).unwrap();
            let mut device = Device::new(listener.accept().unwrap().0);
            device.send(SOH, "H15E");
            assert_eq!(device.answer(), ACK);
            for block in [BLOCKS[0], BLOCKS[2], BLOCKS[3], BLOCKS[4], BLOCKS[5]] {
                assert_eq!(device.block(STX), block);
                device.0.write_all(&[ACK]).unwrap();
            }
            assert_eq!(device.answer(), ETX);
            device.0.write_all(&[EOT]).unwrap();
        }
        let output = sender.wait_with_output().unwrap();
        let reported = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(i32::from(!comes_back)), "{reported}");
        assert!(
            reported.contains(r#""event":"broken","program":"15.H","blocks":2"#),
            "{reported}"
        );
        let last: Value = serde_json::from_str(reported.lines().last().unwrap()).unwrap();
        assert_eq!(last["complete"], comes_back, "{reported}");
    }
}

/// A control that connects, too: START again finds the next line.
#[test]
fn the_control_connects_again() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = format!("connect:{}", listener.local_addr().unwrap());
    let folder = mill();
    let arguments =
        format!("link dnc run --machine mill --fresh --format json --restarts 1 --port {port} 15.H");
    let child = folder
        .command()
        .args(arguments.split_whitespace())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    for blocks in [3, BLOCKS.len()] {
        let mut device = Device::new(listener.accept().unwrap().0);
        assert_eq!(device.block(SOH), "H15E");
        device.0.write_all(&[ACK]).unwrap();
        for block in &BLOCKS[..blocks] {
            device.send(STX, block);
            assert_eq!(device.answer(), ACK);
        }
        if blocks == BLOCKS.len() {
            device.0.write_all(&[ETX]).unwrap();
            assert_eq!(device.answer(), EOT);
        }
    }
    let (report, status) = report(child);
    assert_eq!((status, &report["completed"]), (0, &true.into()), "{report}");
    assert_eq!(report["position"]["X"], 120.0);
}

/// What is written wrongly ends before anything is opened.
#[test]
fn wrong_ports() {
    let folder = mill();
    for port in ["tcp", "connect:127.0.0.1:1", "tcp:127.0.0.1:0,mode=fe3"] {
        let run = folder.bahn(&format!("link dnc run --machine mill --fresh --port {port} 15.H"));
        assert_eq!(run.code(), 1, "{port}");
    }
}

/// A program of DIN 66025 is no program of this control, and is not executed as one while it comes, though each of its
/// blocks is one of plain language, too.
#[test]
fn a_program_of_din_66025() {
    let (child, mut device) = control_for(&mill(), "15.NC", "");
    device.block(SOH);
    device.0.write_all(&[ACK]).unwrap();
    for block in ["M8", "M30"] {
        device.send(STX, block);
        assert_eq!(device.answer(), ACK, "{block}");
    }
    device.0.write_all(&[ETX]).unwrap();
    let (report, status) = report(child);
    assert_eq!(
        (status, &report["message"]),
        (1, &"FUNCTION NOT YET SUPPORTED".into()),
        "{report}"
    );
    // The computer at the other end does not offer it either.
    let folder = Folder::new();
    folder.write("15.nc", "M8\nM30\n");
    let run = folder.bahn("link dnc send --dir . --port tcp:127.0.0.1:0 15.NC");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("15.NC is a program of DIN 66025"),
        "{}",
        run.err()
    );
}
