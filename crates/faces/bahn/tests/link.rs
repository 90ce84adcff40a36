//! The commands of the serial interfaces, over sockets and pseudo terminals.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

mod support;

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use support::{Folder, copy, machines};

const PROGRAM: &str = "0 BEGIN PGM 1 MM\n1 L X+1\n2 END PGM 1 MM\n";

/// A command that goes on until it is ended.
struct Running {
    child: Child,
    /// Where its port is found.
    place: String,
}

impl Running {
    /// Starts one with a port `tcp:127.0.0.1:0` or `pty`, and waits until it is open.
    fn start(folder: &Folder, arguments: &str) -> Running {
        let mut child = folder
            .command()
            .args(arguments.split_whitespace())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        if arguments.contains(":0") {
            let mut stderr = BufReader::new(child.stderr.take().unwrap());
            stderr.read_line(&mut line).unwrap();
        }
        let place = line
            .trim()
            .rsplit_once(" is ")
            .map_or(String::new(), |(_, place)| place.to_owned());
        Running { child, place }
    }

    /// Waits for `ready`.
    fn ready(mut self) -> Running {
        let mut line = String::new();
        BufReader::new(self.child.stdout.take().unwrap())
            .read_line(&mut line)
            .unwrap();
        assert_eq!(line, "ready\n");
        self
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(&self.place).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        stream
    }

    fn signal(&mut self, signal: &str) {
        let done = Command::new("kill")
            .args([signal, &self.child.id().to_string()])
            .status();
        assert!(done.unwrap().success());
        self.child.wait().unwrap();
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn desk() -> Folder {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("mill"));
    for name in ["disk", "other"] {
        fs::create_dir(folder.path(name)).unwrap();
    }
    folder
}

/// A block with its check character.
fn block(kind: u8, text: &str) -> Vec<u8> {
    let mut block = vec![kind];
    block.extend(text.bytes());
    block.push(0x17);
    block.push(block.iter().fold(0, |check, byte| check ^ byte) & 0x7F);
    block.push(0x11);
    block
}

/// Says something and hears what is expected.
fn say(stream: &mut TcpStream, bytes: &[u8], expected: &[u8]) {
    stream.write_all(bytes).unwrap();
    let mut heard = vec![0; expected.len()];
    stream.read_exact(&mut heard).unwrap();
    assert_eq!(heard, expected, "{:?}", String::from_utf8_lossy(&heard));
}

fn error(code: &str) -> Vec<u8> {
    let mut error = block(1, &format!("ERR: {code}"));
    error.pop();
    error
}

fn same(one: &Path, other: &Path) {
    let content = |folder: &Path| {
        let mut files: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap())
            .filter(|entry| entry.path().is_file())
            .map(|entry| (entry.file_name(), fs::read(entry.path()).unwrap()))
            .collect();
        files.sort();
        files
    };
    assert_eq!(content(one), content(other));
}

#[test]
fn files_go_to_a_disk_and_come_back() {
    let folder = desk();
    copy(&machines().join("mill"), &folder.path("empty"));
    fs::remove_dir_all(folder.path("empty/programs")).unwrap();
    fs::create_dir(folder.path("empty/programs")).unwrap();
    // A disk has no folders.
    fs::remove_dir_all(folder.path("mill/programs/eprom")).unwrap();
    let disk = Running::start(&folder, "link disk disk --port tcp:127.0.0.1:0,mode=fe2").ready();
    let port = format!("--port connect:{},mode=fe2", disk.place);
    let sent = folder.bahn(&format!("link send --machine mill {port} --all"));
    assert_eq!((sent.code(), sent.err().as_str()), (0, ""), "{}", sent.out());
    same(&folder.path("mill/programs"), &folder.path("disk"));
    let received = folder.bahn(&format!(
        "link receive --machine empty {port} --all --format json"
    ));
    assert_eq!(received.code(), 0, "{}", received.err());
    assert_eq!(received.json()["received"].as_array().unwrap().len(), 9);
    same(&folder.path("mill/programs"), &folder.path("empty/programs"));
    // The directory, by both ways.
    let listed = folder.bahn(&format!("link list --machine mill {port}"));
    assert_eq!(
        listed.out(),
        "BRACKET.H\nCIRCLE.H\nDATUM.H\nFLANGE.H\nINDEX.H\nKNOB.H\nMEASURE.H\nPALLET.H\nSADDLE.H\n"
    );
    let listed = folder.bahn(&format!(
        "link list --machine mill --port connect:{},mode=fe1 --format json",
        disk.place
    ));
    assert_eq!(listed.json()["listed"][1]["name"], "CIRCLE");
    assert!(listed.json()["free_sectors"].as_u64().unwrap() > 1000);
    // What the control shows stands word for word in the output.
    for (arguments, message) in [
        ("NOWHERE.H", "ERR: 010"),
        ("CIRCLE.H --answer no", "ERASE/OVERREAD"),
        ("CIRCLE.H", "ERASE/OVERREAD"),
    ] {
        let command = format!("link receive --machine mill {port} {arguments}");
        let run = folder.bahn(&command);
        assert_eq!(
            (run.code(), run.out()),
            (1, format!("{message}\n")),
            "{arguments}"
        );
        let run = folder.bahn(&format!("{command} --format json"));
        assert_eq!(
            (run.code(), run.json()["message"].as_str()),
            (1, Some(message)),
            "{arguments}"
        );
    }
    let replaced = folder.bahn(&format!(
        "link receive --machine mill {port} CIRCLE.H --answer yes"
    ));
    assert_eq!(
        (replaced.code(), replaced.out().as_str()),
        (0, "CIRCLE.H received\n")
    );
}

/// All files that are sent are programs of both languages, or files of one type that is asked for.
#[test]
fn both_languages_are_sent() {
    let iso = "%7 G71 *\nN10 G00 X+1 *\nN99999999 %7 G71 *\n";
    for (arguments, expected) in [
        ("", &["1.H", "7.I"][..]),
        ("--type H", &["1.H"]),
        ("--type d", &["7.I"]),
        ("--type A", &["NOTES.A"]),
    ] {
        let folder = desk();
        fs::remove_dir_all(folder.path("mill/programs")).unwrap();
        fs::create_dir(folder.path("mill/programs")).unwrap();
        fs::write(folder.path("mill/programs/1.H"), PROGRAM).unwrap();
        fs::write(folder.path("mill/programs/7.I"), iso).unwrap();
        fs::write(folder.path("mill/programs/NOTES.A"), "TWO PARTS\n").unwrap();
        let disk = Running::start(&folder, "link disk disk --port tcp:127.0.0.1:0,mode=fe2").ready();
        let sent = folder.bahn(&format!(
            "link send --machine mill --port connect:{},mode=fe2 --all {arguments}",
            disk.place
        ));
        assert_eq!(
            (sent.code(), sent.err().as_str()),
            (0, ""),
            "{arguments}: {}",
            sent.out()
        );
        // The disk gives a file its name when the line has told its end.
        let there = || {
            let entries = fs::read_dir(folder.path("disk")).unwrap();
            let mut there: Vec<String> = entries
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .collect();
            there.sort();
            there
        };
        let patience = Instant::now() + Duration::from_secs(20);
        while there() != expected && Instant::now() < patience {
            std::thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(there(), expected, "{arguments}");
    }
}

#[test]
fn programs_in_folders_are_transferred_by_their_name_alone() {
    let folder = desk();
    fs::create_dir_all(folder.path("mill/programs/parts")).unwrap();
    folder.write("mill/programs/parts/1.H", PROGRAM);
    let disk = Running::start(&folder, "link disk disk --port tcp:127.0.0.1:0,mode=fe2").ready();
    let port = format!("--port connect:{},mode=fe2", disk.place);
    let sent = folder.bahn(&format!("link send --machine mill {port} 1.H"));
    assert_eq!(
        (sent.code(), sent.out().as_str()),
        (0, "1.H sent\n"),
        "{}",
        sent.err()
    );
    assert_eq!(fs::read_to_string(folder.path("disk/1.H")).unwrap(), PROGRAM);
    // What is read in again replaces it where it lies.
    let longer = PROGRAM.replace("X+1", "X+17");
    folder.write("disk/1.H", &longer);
    let received = folder.bahn(&format!("link receive --machine mill {port} 1.H --answer yes"));
    assert_eq!(received.code(), 0, "{}", received.err());
    let parts = folder.path("mill/programs/parts/1.H");
    assert_eq!(fs::read_to_string(parts).unwrap(), longer);
    assert!(!folder.path("mill/programs/1.H").exists());
}

#[test]
fn a_disk_answers_a_control_byte_by_byte() {
    let folder = desk();
    folder.write("disk/1.HNC", PROGRAM).write("disk/secret.txt", "x");
    std::os::unix::fs::symlink("/etc/passwd", folder.path("disk/9.H")).unwrap();
    let mut disk = Running::start(&folder, "link disk disk --port tcp:127.0.0.1:0,mode=fe2").ready();
    let mut line = disk.connect();
    // Read, as the control does.
    let first = [&b"\x06"[..], &block(2, "0 BEGIN PGM 1 MM")].concat();
    say(&mut line, &block(1, "H1E"), &first);
    say(&mut line, b"\x06", &block(2, "1 L X+1"));
    say(&mut line, b"\x06", &block(2, "2 END PGM 1 MM"));
    say(&mut line, b"\x06", b"\x03");
    line.write_all(b"\x04").unwrap();
    // Tricks and links lead nowhere.
    for (header, code) in [
        ("H..E", "002"),
        ("H../1E", "002"),
        ("H/etc/passwdE", "002"),
        ("HC:1E", "002"),
        ("H9E", "010"),
        ("HSECRETE", "010"),
        ("HCONA", "002"),
        ("H1.HA", "002"),
        ("H1X", "001"),
    ] {
        say(&mut line, &block(1, header), &error(code));
        line.write_all(b"\x06\x04").unwrap();
    }
    // A cable that is pulled leaves nothing, and the next one finds an idle port.
    say(&mut line, &block(1, "H5A"), b"\x06");
    say(&mut line, &block(2, "0 BEGIN PGM 5 MM"), b"\x06");
    drop(line);
    let mut line = disk.connect();
    say(&mut line, &block(1, "H5E"), &error("010"));
    line.write_all(b"\x06\x04").unwrap();
    // The process is killed in the middle.
    say(&mut line, &block(1, "H6A"), b"\x06");
    say(&mut line, &block(2, "0 BEGIN PGM 6 MM"), b"\x06");
    disk.signal("-KILL");
    let names: Vec<String> = fs::read_dir(folder.path("disk"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| !name.starts_with('.'))
        .collect();
    assert!(
        names
            .iter()
            .all(|name| ["1.HNC", "secret.txt", "9.H"].contains(&name.as_str())),
        "{names:?}"
    );
}

/// Over a pseudo terminal, as over a cable: paced, with the link that goes with it.
#[test]
fn over_a_pseudo_terminal() {
    let folder = desk();
    let mut disk = Running::start(&folder, "link disk disk --port pty:line,mode=fe1").ready();
    for (arguments, said) in [("CIRCLE.H", "CIRCLE.H sent\n"), ("BRACKET.H", "BRACKET.H sent\n")] {
        let port = "--port serial:line,mode=fe1,baud=38400";
        let sent = folder.bahn(&format!("link send --machine mill {port} {arguments}"));
        assert_eq!((sent.code(), sent.out().as_str()), (0, said), "{}", sent.err());
    }
    let read = |path: &str| fs::read(folder.path(path)).unwrap();
    assert_eq!(read("disk/BRACKET.H"), read("mill/programs/BRACKET.H"));
    disk.signal("-INT");
    assert!(fs::symlink_metadata(folder.path("line")).is_err());
}

#[test]
fn host_and_control() {
    let folder = desk();
    folder.write("disk/1.H", PROGRAM);
    // The standard protocol of a tape, and that with check characters.
    for mode in ["me", "fe2"] {
        let mut host = Running::start(
            &folder,
            &format!("link receive --as host --dir other --port tcp:127.0.0.1:0,mode={mode}"),
        );
        let sent = folder.bahn(&format!(
            "link send --machine mill --port connect:{},mode={mode} CIRCLE.H",
            host.place
        ));
        assert_eq!(
            (sent.code(), sent.out().as_str()),
            (0, "CIRCLE.H sent\n"),
            "{mode}: {}",
            sent.err()
        );
        assert_eq!(host.child.wait().unwrap().code(), Some(0), "{mode}");
        assert_eq!(
            fs::read(folder.path("other/CIRCLE.H")).unwrap(),
            fs::read(folder.path("mill/programs/CIRCLE.H")).unwrap()
        );
        fs::remove_file(folder.path("other/CIRCLE.H")).unwrap();

        let mut host = Running::start(
            &folder,
            &format!("link send --as host --dir disk --port tcp:127.0.0.1:0,mode={mode} 1.H"),
        );
        let command = format!(
            "link receive --machine mill --port connect:{},mode={mode} 1.H --answer yes",
            host.place
        );
        let received = folder.bahn(&command);
        assert_eq!(
            (received.code(), received.out().as_str()),
            (0, "1.H received\n"),
            "{mode}: {}",
            received.err()
        );
        assert_eq!(host.child.wait().unwrap().code(), Some(0), "{mode}");
        assert_eq!(folder.read("mill/programs/1.H"), PROGRAM);
    }
}

#[test]
fn a_machine_that_answers() {
    let folder = desk();
    folder.write("disk/1.H", PROGRAM);
    let serve = "link serve --machine mill --rs232 tcp:127.0.0.1:0,mode=fe2 --answer yes --trace line.txt";
    let mut machine = Running::start(&folder, serve).ready();
    let mut line = machine.connect();
    let first = [&b"\x06"[..], &block(2, "0 BEGIN PGM CIRCLE MM")].concat();
    say(&mut line, &block(1, "HCIRCLEE"), &first);
    line.write_all(b"\x04").unwrap();
    say(&mut line, &block(1, "H7A"), b"\x06");
    say(&mut line, &block(2, "0 BEGIN PGM 7 MM"), b"\x06");
    say(&mut line, &block(2, "1 END PGM 7 MM"), b"\x06");
    line.write_all(b"\x03\x04").unwrap();
    // LSV/2 between transfers: ENQ is answered DLE 0.
    say(&mut line, b"\x05", b"\x100");
    say(&mut line, b"\x10\x02R_PR\x10\x03\x0C", b"\x101");
    drop(line);
    for _ in 0..100 {
        if folder.path("mill/programs/7.H").exists() {
            break;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(
        folder.read("mill/programs/7.H"),
        "0 BEGIN PGM 7 MM\n1 END PGM 7 MM\n"
    );
    machine.signal("-INT");
    let monitor = folder.bahn("link monitor --trace line.txt");
    assert_eq!(monitor.code(), 0, "{}", monitor.err());
    for said in [
        "< SOH \"HCIRCLEE\" ETB BCC=09",
        "> ACK STX \"0 BEGIN PGM CIRCLE MM\" ETB BCC=2A",
        "\"R_PR\" DLE ETX BCC=0C",
    ] {
        assert!(monitor.out().contains(said), "{said}\n{}", monitor.out());
    }
}

/// What cannot be opened ends it before anything is.
#[test]
fn ports_that_cannot_be_opened() {
    let folder = desk();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap();
    let serve = "link serve --machine mill";
    let run = folder.bahn(&format!(
        "{serve} --rs232 tcp:127.0.0.1:0,baud=19200 --rs422 tcp:127.0.0.1:0,baud=38400"
    ));
    assert_eq!((run.code(), run.out().as_str()), (1, "BAUD RATE NOT POSSIBLE\n"));
    let run = folder.bahn(&format!("{serve} --rs232 tcp:{address}"));
    assert_eq!(
        (run.code(), run.out().as_str()),
        (1, "INTERFACE ALREADY ASSIGNED\n")
    );
    for (ports, said) in [
        (
            "--rs232 tcp:127.0.0.1:0,mode=fe3".to_owned(),
            "column 17, `mode=fe3`: a mode is",
        ),
        ("--rs422 usb:1".to_owned(), "a port is tcp:ADDR:PORT"),
    ] {
        let run = folder.bahn(&format!("{serve} {ports}"));
        assert_eq!((run.code(), run.out().as_str()), (1, ""), "{ports}");
        assert!(run.err().contains(said), "{ports}: {}", run.err());
    }
    drop(taken);
    let run = folder.bahn(&format!(
        "link receive --machine mill --port connect:{address} 1.H"
    ));
    assert_eq!(
        (run.code(), run.out().as_str()),
        (1, "EXT. OUTPUT/INPUT NOT READY\n")
    );
    assert_eq!(folder.bahn("link receive --machine mill --port pty").code(), 2);
    assert_eq!(
        folder
            .bahn("link send --machine mill --port pty NOWHERE.H")
            .code(),
        2
    );
    assert_eq!(folder.bahn("link receive --port pty --all").code(), 2);
}

/// A device that says nothing: N when an answer is missing, PROGRAM INCOMPLETE when the rest is.
#[test]
fn a_device_that_falls_silent() {
    let folder = desk();
    for (answer, message) in [
        (&b""[..], "TRANSFERRED DATA INCORRECT N"),
        (&b"\x06\x02"[..], "PROGRAM INCOMPLETE"),
    ] {
        let device = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let address = device.local_addr().unwrap();
        let thread = std::thread::spawn(move || {
            let (mut line, _) = device.accept().unwrap();
            let mut header = [0; 8];
            line.read_exact(&mut header).unwrap();
            assert_eq!(header, *b"\x01H15E\x17\x1F\x11");
            line.write_all(answer).unwrap();
            let mut rest = Vec::new();
            line.read_to_end(&mut rest).unwrap();
            rest
        });
        let command =
            format!("link receive --machine mill --port connect:{address},mode=fe1,timeout=0.3 15.H");
        let run = folder.bahn(&command);
        assert_eq!((run.code(), run.out()), (1, format!("{message}\n")));
        let rest = thread.join().unwrap();
        assert!(rest.ends_with(b"\x04"), "{rest:?}");
    }
}
