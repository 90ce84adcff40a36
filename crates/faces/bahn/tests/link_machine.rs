//! A machine and what hangs on its ports: its PLC at a line, its backup, a printer.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use support::{Folder, copy, machines};

/// What is awaited comes within this time, or the test fails.
const PATIENCE: Duration = Duration::from_secs(60);

/// The PLC sends back every line that comes over RS-422, in strings S2.
const ECHO: &str = "
LBL LINE_WATCH
       RPLY  B620
       <> K+0
       JPT   LINE_WATCH_END
       SUBM  LINE_JOB
       = B620
LBL LINE_WATCH_END
       EM

LBL LINE_JOB
       L     M972
       JPT   LINE_ASSIGNED
       PS    K+1
       PS    K+0
       CM    9100
       LN    M3171
       S     M972
       EM
LBL LINE_ASSIGNED
       L     M973
       JPT   LINE_ANSWER
       PS    K+1
       PS    K+2
       CM    9104
       LN    M3171
       S     M973
       EM
LBL LINE_ANSWER
       PS    K+1
       PS    K+2
       CM    9103
       LN    M3171
       R     M973
       EM
";

fn mill() -> Folder {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("mill"));
    folder
}

fn free_address() -> String {
    let free = TcpListener::bind("127.0.0.1:0").unwrap();
    free.local_addr().unwrap().to_string()
}

/// A command that runs until the test ends.
struct Served(Child);

impl Served {
    fn start(folder: &Folder, arguments: &[&str]) -> Served {
        let mut child = Command::new(env!("CARGO_BIN_EXE_bahn"))
            .args(arguments)
            .current_dir(folder.path("."))
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        while line != "ready\n" {
            line.clear();
            assert!(
                output.read_line(&mut line).unwrap() > 0,
                "it ends before it is ready"
            );
        }
        // What it says later is read by nobody, and does not stop it.
        std::thread::spawn(move || std::io::copy(&mut output, &mut std::io::sink()));
        Served(child)
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// What is lost at power-on is said by whoever switches a machine on, as `bahn run` says it.
#[test]
fn what_is_lost_at_power_on_is_said() {
    let folder = mill();
    std::fs::create_dir_all(folder.path("mill/state")).unwrap();
    let commands = [
        format!("link serve --machine mill --rs232 tcp:{}", free_address()),
        format!("link serve --machine mill --lsv2 {}", free_address()),
        "panel --machine mill --listen 127.0.0.1:0".to_owned(),
        format!("link dnc run 1 --machine mill --port tcp:{}", free_address()),
    ];
    for command in commands {
        // A damaged file is put aside, and said once.
        folder.write("mill/state/mechanics.toml", "this is not where it stands\n");
        let mut child = Command::new(env!("CARGO_BIN_EXE_bahn"))
            .args(command.split(' '))
            .current_dir(folder.path("."))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stderr.take().unwrap())
            .read_line(&mut line)
            .unwrap();
        let _ = child.kill();
        let _ = child.wait();
        assert!(
            line.starts_with("warning: ") && line.contains("mechanics.toml"),
            "{command}: {line}"
        );
    }
}

/// Modules 9100, 9103 and 9104 on a real port: the PLC of a machine that is served answers a device.
#[test]
fn the_plc_answers_over_its_line() {
    let folder = mill();
    let plc = folder.read("mill/plc/MAIN.PLC");
    let watched = "       CM    MESSAGES\n       CM    LINE_WATCH\n";
    let plc = plc.replacen("       CM    MESSAGES\n", watched, 1) + ECHO;
    assert!(plc.contains(watched));
    folder.write("mill/plc/MAIN.PLC", plc);
    // The control goes on without POWER INTERRUPTED, so that its PLC runs before anybody presses CE.
    let list = folder.read("mill/parameters.mp");
    let line = list.lines().find(|line| line.starts_with("MP7212")).unwrap();
    folder.write("mill/parameters.mp", list.replacen(line, "MP7212 : 1", 1));
    let address = free_address();
    let port = format!("tcp:{address},mode=ext2");
    let _served = Served::start(&folder, &["link", "serve", "--machine", "mill", "--rs422", &port]);

    // Before the PLC has got the line it is that of the operator, and what begins then is a transfer.
    let begin = Instant::now();
    let mut came = Vec::new();
    while !came.windows(10).any(|text| text == b"PALLET 7\r\n") {
        assert!(begin.elapsed() < PATIENCE, "{}", String::from_utf8_lossy(&came));
        let mut device = TcpStream::connect(&address).unwrap();
        device.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
        device.write_all(b"PALLET 7\r\n").unwrap();
        came.clear();
        let mut bytes = [0; 64];
        while let Ok(count @ 1..) = device.read(&mut bytes) {
            came.extend(&bytes[..count]);
        }
    }
}

/// A machine goes into one file and comes back as it was, also in an empty folder; a damaged backup changes nothing, and
/// neither does one for a machine that is on.
#[test]
fn a_machine_is_backed_up_and_restored() {
    let folder = mill();
    let run = folder.bahn("link backup --machine mill --output mill.anc");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(folder.read("mill.anc").starts_with("BEGIN BACKUP 1 mill\n"));

    let run = folder.bahn("link restore --machine again mill.anc");
    assert_eq!(run.code(), 0, "{}", run.err());
    for file in [
        "machine.toml",
        "parameters.mp",
        "plc/MAIN.PLC",
        "programs/CIRCLE.H",
    ] {
        assert_eq!(
            folder.read(&format!("again/{file}")),
            folder.read(&format!("mill/{file}"))
        );
    }
    assert_eq!(folder.bahn("machine check again").code(), 0);

    let text = folder.read("mill.anc").replacen("TOOL CALL", "TOOL FALL", 1);
    folder.write("damaged.anc", text);
    folder.write("again/programs/CIRCLE.H", "BEGIN PGM 1 MM\nEND PGM 1 MM\n");
    let run = folder.bahn("link restore --machine again damaged.anc");
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("check sum"), "{}", run.err());
    assert!(
        folder
            .read("again/programs/CIRCLE.H")
            .starts_with("BEGIN PGM 1 MM")
    );

    let address = free_address();
    let port = format!("tcp:{address}");
    let _served = Served::start(
        &folder,
        &["link", "serve", "--machine", "again", "--rs232", &port],
    );
    let run = folder.bahn("link restore --machine again mill.anc");
    assert_eq!(run.code(), 2, "{}", run.err());
}

/// A machine that has digitized much comes back, too: the file of a backup is longer than any table.
#[test]
fn a_large_machine_comes_back() {
    let folder = mill();
    let block = "L X+123.456 Y+78.9 Z-12.345\n";
    // 17 MiB and a bit.
    let text = format!(
        "BEGIN PGM LONG MM\n{}END PGM LONG MM\n",
        block.repeat((17 << 20) / block.len() + 1)
    );
    folder.write("mill/programs/LONG.H", &text);
    let run = folder.bahn("link backup --machine mill --output mill.anc");
    assert_eq!(run.code(), 0, "{}", run.err());
    let run = folder.bahn("link restore --machine again mill.anc");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(folder.read("again/programs/LONG.H") == text);
}

/// BACKUP DATA to a floppy disk unit, and RESTORE DATA from it.
#[test]
fn a_backup_goes_over_a_line() {
    let folder = mill();
    std::fs::create_dir(folder.path("disk")).unwrap();
    let address = free_address();
    let port = format!("tcp:{address},mode=fe2");
    let _disk = Served::start(&folder, &["link", "disk", "disk", "--port", &port]);
    let to = format!("--port connect:{address},mode=fe2");
    let run = folder.bahn(&format!("link backup --machine mill {to}"));
    assert_eq!(run.code(), 0, "{} {}", run.out(), run.err());
    assert_eq!(folder.names().iter().filter(|name| *name == "disk").count(), 1);
    let run = folder.bahn(&format!("link restore --machine again {to}"));
    assert_eq!(run.code(), 0, "{} {}", run.out(), run.err());
    assert_eq!(
        folder.read("again/plc/MAIN.PLC"),
        folder.read("mill/plc/MAIN.PLC")
    );
}

/// The printer of the manual: ESC A 8 once, LF ESC N 00 02 before each line of 512 dots.
#[test]
fn a_picture_is_printed() {
    let folder = mill();
    let run = folder.bahn("machine new mill155 --model tnc155");
    assert_eq!(run.code(), 0, "{}", run.err());
    folder.write(
        "part.h",
        support::program("BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+60 Z+0\nTOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\nL X+50 Y+30 Z-5 R0 F500 M3"),
    );
    let run = folder.bahn("test part.h --view plan --image part.png");
    assert_eq!(run.code(), 0, "{}", run.err());
    let refused = folder.bahn("link print part.png --machine mill155 --output part.prn");
    assert_eq!(refused.code(), 1, "{}", refused.err());
    let printer = "MP226 : 795\nMP227 : 16648\nMP230 : 1290\nMP231 : 6990\nMP232 : 2\n";
    let list = folder.read("mill155/parameters.mp");
    folder.write("mill155/parameters.mp", list + printer);
    let run = folder.bahn("link print part.png --machine mill155 --output part.prn");
    assert_eq!(run.code(), 0, "{}", run.err());
    let bytes = std::fs::read(folder.path("part.prn")).unwrap();
    assert_eq!(bytes[..8], [0x1B, b'A', 8, 0x0A, 0x1B, b'N', 0, 2]);
    assert_eq!((bytes.len() - 3) % (5 + 512), 0);
    assert!(
        bytes
            .chunks(517)
            .skip(1)
            .any(|line| line.iter().any(|byte| *byte != 0))
    );
}
