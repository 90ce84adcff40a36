//! Every command that README, help texts and the READMEs of machines show is run as it stands there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use crate::support::{Folder, copy};

/// What may end otherwise than with 0: part of the command and its exit code.
const EXCEPTIONS: &[(&str, i32)] = &[
    // Wrong use: there is no terminal here.
    ("plc watch", 2),
    ("panel --terminal", 2),
    // No such port is there.
    ("serial:/dev/ttyUSB0", 1),
    // There is no editor here.
    ("bahn lsp", 2),
    // There are differences.
    ("mp diff mill.mp", 1),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// The commands in a text: lines that begin with `bahn`, without what explains them after.
fn commands(text: &str) -> Vec<String> {
    let lines = text
        .lines()
        .map(str::trim)
        .filter(|line| line.starts_with("bahn "));
    let without_comment = |line: &str| {
        let line = line.split(" # ").next().unwrap_or(line);
        line.split("   ").next().unwrap_or(line).trim().to_owned()
    };
    lines.map(without_comment).collect()
}

/// Everything that the texts name: the shipped files, and files of the user's own.
fn desk() -> Folder {
    let folder = Folder::new();
    for shipped in ["examples", "machines"] {
        copy(&root().join(shipped), &folder.path(shipped));
    }
    copy(&root().join("machines/mill"), &folder.path("mill"));
    copy(&root().join("examples/technology"), folder.as_ref());
    let part = "BEGIN PGM PART MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+60 Y+40 Z+0\nTOOL DEF 1 L+0 R+5\n\
                TOOL CALL 1 Z S1000\nL Z+20 R0 F MAX M3\nL X-10 Y+10 F MAX\nL Z-4 F MAX\nL X+70 F400\n\
                CC X+40 Y+10\nC X+70 Y+10 DR+ F3000\nL Z+20 F MAX M2\n\
                END PGM PART MM\n";
    for name in ["part.h", "PART.H"] {
        folder.write(name, part);
    }
    folder.write("part.nc", "%PART\nN10 G00 X0 Y0\nN20 G01 X40 F2000 M3\nM30\n");
    fs::create_dir(folder.path("parts")).unwrap();
    folder.write("parts/part.h", part);
    folder.write(
        "parts/15.H",
        "BEGIN PGM 15 MM\nL X+50 Y+50 R0 F2000\nL X+60\nEND PGM 15 MM\n",
    );
    let list = fs::read_to_string(root().join("machines/mill/parameters.mp")).unwrap();
    for name in ["mill.mp", "old.mp", "new.mp", "machine.MP"] {
        folder.write(name, &list);
    }
    folder.write("changes.mp", "MP1010.0 : 12000\n");
    folder.write("tool.t", "T L R R2 NAME\n1 80.5 10 0 END MILL\n2 62 4 4 BALL\n");
    let data = root().join("crates/models/system900/tests/data/two-channels.q");
    fs::copy(data, folder.path("two-channels.q")).unwrap();
    folder.write("MAIN.PLC", "       LN    I4\n       =     O2\n       EM\n");
    folder.write("EPROM.TXT", "IDENT 123 456 99\nLOAD MAIN.PLC /M\nLOAD MAIN.ER1\n");
    fs::create_dir(folder.path("eprom")).unwrap();
    folder.write("door.txt", "cycle 1: I4=1\ncycle 5: I4=0\n");
    folder.write(
        "stop.txt",
        "start+0.5: key NC_STOP tap\nstart+1.5: key NC_START tap\n",
    );
    for name in ["before.csv", "after.csv"] {
        folder.write(name, "time [s],X.lag [mm],event\n1,0.5,start\n2,0.25,\n");
    }
    folder.write("jog.txt", "30: end\n");
    // A machine with a printer.
    assert_eq!(folder.bahn("machine new mill155 --model tnc155").code(), 0);
    let list = folder.read("mill155/parameters.mp");
    let printer = "MP226 : 795\nMP227 : 16648\nMP230 : 1290\nMP231 : 6990\nMP232 : 2\n";
    folder.write("mill155/parameters.mp", list + printer);
    folder.write("line.txt", "0.5 > 01 48 31 35 45 17 1F 11\n0.6 < 06\n");
    folder.write(
        "parts/15.H",
        "0 BEGIN PGM 15 MM\n1 L Z+100 R0 FMAX M2\n2 END PGM 15 MM\n",
    );
    fs::create_dir(folder.path("mill/programs/PARTS")).unwrap();
    folder
}

/// What is digitized: a part and the program that machines it again, and a mesh with the program that scans it on the
/// machine. The ball of its probe is 120 mm below the spindle, and nothing is calibrated.
fn digitizing(folder: &Folder) {
    folder.write(
        "tools.tsv",
        "T\tL\tR\tR2\tNAME\n1\t100\t4\t4\tBALL 8\n2\t100\t3\t3\tBALL 6\n",
    );
    let scan = |name: &str, [lowest, highest, clearance]: [i32; 3]| {
        format!(
            "TCH PROBE 5.0 RANGE\nTCH PROBE 5.1 PGM NAME: {name}\nTCH PROBE 5.2 Z X+4 Y+3 Z{lowest:+}\n\
             TCH PROBE 5.3 X+8 Y+4 Z{highest:+}\nTCH PROBE 5.4 HEIGHT: {clearance:+}\nTCH PROBE 6.0 MEANDER\n\
             TCH PROBE 6.1 DIRECTN: X\nTCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 1 P.P. INT: 1\n"
        )
    };
    let blank = "BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+20 Y+10 Z+0\n";
    let model = format!(
        "{blank}TOOL CALL 1 Z S1000\nL X+5 Y+5 Z+10 R0 FMAX M3\nL Z-2 F500\nL X+15\nL Z+20 FMAX M5\n\
         TOOL CALL 2 Z S1000\n{}",
        scan("SURFACE", [-6, 1, 10])
    );
    folder.write("MODEL.H", crate::support::program(&model));
    let again = "TOOL CALL 2 Z S1000\nL Z+50 R0 FMAX M3\nL X+4 Y+3 F500\nCALL PGM SURFACE\n";
    folder.write("AGAIN.H", crate::support::program(&format!("{blank}{again}")));
    let on_machine = format!(
        "TOOL CALL 0 Z S0\nL Z+140 R0 FMAX\n{}",
        scan("MESH", [114, 121, 125])
    );
    folder.write("SCAN.H", crate::support::program(&on_machine));
    folder.write("probe.txt", "0: probe insert\n");
    folder.write(
        "model.stl",
        "solid roof\nvertex 0 0 -5\nvertex 10 0 -1\nvertex 10 10 -1\nvertex 0 0 -5\nvertex 10 10 -1\n\
         vertex 0 10 -5\nvertex 10 0 -1\nvertex 20 0 -5\nvertex 10 10 -1\nvertex 10 10 -1\nvertex 20 0 -5\n\
         vertex 20 10 -5\nendsolid\n",
    );
}

/// Held while a panel runs.
static PANEL: Mutex<()> = Mutex::new(());

/// A command that asks a control: one is served meanwhile. What the one before it has said would be taken for its word.
fn beside_a_server(command: &str) -> String {
    format!(
        "rm -f served.txt; bahn link serve --machine mill --lsv2 127.0.0.1:19000 >served.txt & server=$!; \
         until grep -q ready served.txt; do kill -0 $server || exit 1; sleep 0.05; done; \
         {command}; code=$?; kill -INT $server; wait $server; exit $code"
    )
}

/// One side of a blockwise transfer: the other one is there meanwhile.
fn with_its_other_side(command: &str) -> String {
    let sends = command.starts_with("bahn link dnc send");
    let send = if sends {
        command
    } else {
        "bahn link dnc send --dir parts --port tcp:127.0.0.1:4711 15.H"
    };
    let run = if sends {
        "bahn link dnc run --machine mill --port connect:127.0.0.1:4711 15.H"
    } else {
        command
    };
    // Until the sender listens nobody answers.
    format!("{send} & sender=$!; until {run}; do kill -0 $sender || exit 1; sleep 0.05; done; wait $sender")
}

/// A control that asks a device: a disk is there meanwhile.
fn beside_a_disk(command: &str) -> String {
    format!(
        "rm -f disk.txt; bahn link disk parts --port tcp:127.0.0.1:4711,mode=fe2 >disk.txt & disk=$!; \
         until grep -q ready disk.txt; do kill -0 $disk || exit 1; sleep 0.05; done; \
         {command}; code=$?; kill -INT $disk; wait $disk; exit $code"
    )
}

/// One that goes on until somebody ends it: it is ended when it says that it is there.
fn until_it_is_there(command: &str) -> String {
    format!(
        "(rm -f there.txt; {command} >there.txt 2>&1 & it=$!; \
         until grep -q -e '^ready' -e 'the panel is at' there.txt || ! kill -0 $it; do sleep 0.05; done; sleep 0.3; \
         kill -INT $it; wait $it; code=$?; cat there.txt; exit $code)"
    )
}

/// Commands that go on until somebody ends them.
const ENDLESS: &[&str] = &[
    "bahn panel",
    "bahn link serve",
    "bahn link disk",
    "bahn link monitor tcp",
];

/// What the smallest Debian has (debootstrap --variant=minbase) of what a shell is given to do: coreutils, findutils, grep, sed,
/// tar, gzip, mawk. Of more no text makes use, since the README asks for a toolchain and a C compiler only.
const PROGRAMS: &[&str] = &[
    "sh",
    "awk",
    "basename",
    "cat",
    "chmod",
    "cmp",
    "cp",
    "cut",
    "date",
    "diff",
    "dirname",
    "echo",
    "env",
    "expr",
    "false",
    "find",
    "grep",
    "gzip",
    "head",
    "install",
    "kill",
    "ln",
    "ls",
    "mkdir",
    "mktemp",
    "mv",
    "nl",
    "od",
    "printf",
    "pwd",
    "rm",
    "rmdir",
    "sed",
    "seq",
    "sha256sum",
    "sleep",
    "sort",
    "split",
    "stat",
    "tail",
    "tar",
    "tee",
    "test",
    "timeout",
    "touch",
    "tr",
    "true",
    "uname",
    "uniq",
    "wc",
    "xargs",
    "yes",
];

/// A folder with these programs and nothing else.
fn programs(folder: &Folder) -> PathBuf {
    let own = folder.path(".programs");
    fs::create_dir_all(&own).unwrap();
    for name in PROGRAMS {
        let found = ["/usr/bin", "/bin"]
            .iter()
            .map(|place| Path::new(place).join(name))
            .find(|path| path.exists());
        if let Some(path) = found {
            // There from the file before, when several are run in one folder.
            let _ = std::os::unix::fs::symlink(path, own.join(name));
        }
    }
    own
}

/// Runs each command in a shell, in this order.
fn run_all(folder: &Folder, place: &Path, commands: &[String]) {
    assert!(!commands.is_empty());
    let own = Path::new(env!("CARGO_BIN_EXE_bahn")).parent().unwrap();
    let path = format!("{}:{}", own.display(), programs(folder).display());
    for below in [
        ".local/share/bash-completion/completions",
        ".zfunc",
        ".config/fish/completions",
    ] {
        fs::create_dir_all(folder.path(below)).unwrap();
    }
    let mut faults = Vec::new();
    for command in commands {
        // Only one panel listens at an address.
        let ended = until_it_is_there(command);
        let ends_itself = !ENDLESS.iter().any(|name| command.starts_with(name));
        let asks = command.starts_with("bahn link lsv2");
        let drips = command.starts_with("bahn link dnc");
        let held = command.starts_with("bahn link").then(|| PANEL.lock().unwrap());
        let held = held.or_else(|| (!ends_itself).then(|| PANEL.lock().unwrap()));
        let own = if ends_itself { command } else { &ended };
        let command = match (command.contains("connect:127.0.0.1:4711"), asks) {
            _ if drips => &with_its_other_side(command),
            (true, _) => &beside_a_disk(own),
            (false, true) => &beside_a_server(own),
            (false, false) => own,
        };
        let output = Command::new("/bin/sh")
            .args(["-c", command])
            .current_dir(place)
            .env("PATH", &path)
            .env("HOME", folder.path(""))
            .env("XDG_DATA_HOME", folder.path(".local/share"))
            .stdin(std::process::Stdio::null())
            .output()
            .unwrap();
        drop(held);
        let exception = EXCEPTIONS.iter().find(|(part, _)| command.contains(part));
        let code = output.status.code();
        if code != Some(0) && code != exception.map(|(_, code)| *code) {
            let said = |bytes: &[u8]| {
                String::from_utf8_lossy(bytes)
                    .chars()
                    .take(400)
                    .collect::<String>()
            };
            faults.push(format!(
                "{command}: {}\n{}{}",
                output.status,
                said(&output.stderr),
                said(&output.stdout)
            ));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn of_the_readmes() {
    for file in [
        "README.md",
        "docs/tour.md",
        "examples/README.md",
        "examples/plc/README.md",
    ] {
        let folder = desk();
        let text = fs::read_to_string(root().join(file)).unwrap();
        run_all(&folder, folder.as_ref(), &commands(&text));
    }
}

#[test]
fn of_the_documents() {
    for file in [
        "docs/channel-lists.md",
        "docs/digitizing.md",
        "docs/dnc.md",
        "docs/lsv2.md",
        "docs/positioning-module.md",
        "docs/system900.md",
        "docs/technology.md",
        "docs/torture.md",
        "machines/portal900/README.md",
    ] {
        let folder = desk();
        digitizing(&folder);
        let text = fs::read_to_string(root().join(file)).unwrap();
        run_all(&folder, folder.as_ref(), &commands(&text));
    }
}

/// Help texts of a command and of all below it.
fn helps(folder: &Folder, command: &str, found: &mut Vec<String>) {
    let help = folder.bahn(&format!("{command} --help")).out();
    found.extend(commands(&help));
    let listed = help.split("\nCommands:\n").nth(1).unwrap_or_default();
    let names = listed.lines().take_while(|line| !line.is_empty());
    for line in names.filter(|line| line.starts_with("  ") && !line.starts_with("   ")) {
        let name = line.split_whitespace().next().unwrap();
        if name != "help" {
            helps(folder, &format!("{command} {name}"), found);
        }
    }
}

/// What kind of command the help texts show. Each kind is a test of its own, with a folder of its own and its own order: those that
/// speak with somebody wait most of their time, those that try a machine again and again take most of the processor.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Speaks,
    Tries,
    Works,
}

fn kind(command: &str) -> Kind {
    let is_one_of = |names: &[&str]| {
        names
            .iter()
            .any(|name| command.starts_with(&format!("bahn {name}")))
    };
    match command {
        _ if is_one_of(&["panel", "link"]) => Kind::Speaks,
        _ if is_one_of(&["tune", "compensate", "torture"]) => Kind::Tries,
        _ => Kind::Works,
    }
}

fn of_the_help_texts(wanted: Kind, least: usize) {
    let folder = desk();
    digitizing(&folder);
    let mut shown = Vec::new();
    helps(&folder, "", &mut shown);
    shown.retain(|command| kind(command) == wanted);
    assert!(shown.len() > least, "{}", shown.len());
    if wanted == Kind::Speaks {
        // A picture of the user's own, to be printed.
        assert_eq!(folder.bahn("test part.h --image part.png").code(), 0);
    }
    run_all(&folder, folder.as_ref(), &shown);
}

#[test]
fn of_the_help_texts_that_speak() {
    of_the_help_texts(Kind::Speaks, 20);
}

#[test]
fn of_the_help_texts_that_try() {
    of_the_help_texts(Kind::Tries, 10);
}

#[test]
fn of_the_help_texts_that_work() {
    of_the_help_texts(Kind::Works, 50);
}

/// The shell of these tests has nothing that the smallest Debian has not: what would show a text in pages, fetch or draw something is
/// a command that is not found.
#[test]
fn nothing_else_is_needed() {
    let folder = Folder::new();
    let place = folder.path("");
    let run =
        |command: &str| std::panic::catch_unwind(|| run_all(&folder, &place, &[command.to_owned()])).is_ok();
    assert!(run("bahn mp new | head -n 3") && run("bahn mp new | sed -n p | grep -c MP1010"));
    for other in [
        "less", "more", "curl", "wget", "python3", "jq", "nc", "xdg-open", "git", "vi",
    ] {
        assert!(!run(&format!("bahn mp new | {other}")), "{other}");
        assert!(!PROGRAMS.contains(&other));
    }
}

#[test]
fn of_the_readmes_of_machines() {
    let folder = desk();
    for machine in [
        "mill",
        "mill-tnc360",
        "mill-tnc155",
        "module-tnc360",
        "dig425",
        "twin",
        "gantry",
    ] {
        let place = folder.path(&format!("machines/{machine}"));
        let text = fs::read_to_string(place.join("README.md")).unwrap();
        run_all(&folder, &place, &commands(&text));
    }
}

/// A new machine of each model: its texts name that model, no link is dead, every command runs.
#[test]
fn of_new_machines_of_each_model() {
    let models = [
        ("tnc151", "TNC 151"),
        ("tnc155", "TNC 155"),
        ("tnc360", "TNC 360"),
        ("tnc407", "TNC 407"),
        ("tnc415b", "TNC 415 B"),
        ("tnc425", "TNC 425"),
    ];
    for (model, name) in models {
        let folder = Folder::new();
        let made = folder.bahn(&format!("machine new m --model {model}"));
        assert_eq!(made.code(), 0, "{}", made.err());
        let place = folder.path("m");
        let readme = folder.read("m/README.md");
        assert!(readme.contains(name), "{model}: {readme}");
        for (other, its_name) in models.iter().filter(|(other, _)| *other != model) {
            for file in ["README.md", "machine.toml", "parameters.mp"] {
                let text = folder.read(&format!("m/{file}"));
                let names = |line: &&str| {
                    line.contains(its_name) && !line.contains(name) && !line.contains(" as the ")
                };
                assert_eq!(text.lines().find(names), None, "{model}/{file} names {other}");
            }
        }
        for link in readme
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
        {
            assert!(place.join(link).exists(), "{model}: {link}");
        }
        run_all(&folder, &place, &commands(&readme));
    }
}

/// A page for each command, each with its examples.
#[test]
fn manual_pages() {
    let folder = Folder::new();
    let run = folder.bahn("man pages");
    assert_eq!(run.code(), 0, "{}", run.err());
    let run = folder.read("pages/bahn-plc-run.1");
    assert!(
        run.contains(".TH bahn-plc-run 1") && run.contains("Examples"),
        "{run}"
    );
    for page in ["bahn.1", "bahn-test.1", "bahn-machine-new.1", "bahn-man.1"] {
        assert!(folder.path(&format!("pages/{page}")).exists(), "{page}");
    }
    assert!(folder.bahn("man").out().contains(".TH bahn 1"));
}
