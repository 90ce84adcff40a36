//! What survives power-off: nothing is lost that the PLC has seen done, damage is said and starts nothing.

use std::collections::BTreeMap;
use std::fs;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use crate::support::Folder;

/// The PLC acknowledges a tool change at once. Kept at power-off: W110 counts the strobes that have fallen.
const TOOL_CHANGER: &str = "\
LBL TOOL
       LN    M2046
       A     M60
       = M61
       L     M2046
       = M60
       L     M61
       IFT
         L     W110
         +     K+1
         =     W110
       ENDI
       L     M2046
       = M2483
       EM

";

/// The calls of the program, again and again.
const CALLS: [u32; 7] = [2, 4, 1, 3, 5, 2, 3];

/// A folder with the machine `m`: an automatic tool changer with variable pocket coding, and a program that
/// changes tools.
fn machine() -> Folder {
    let folder = Folder::new();
    let run = folder.bahn("machine new m --model tnc415b --name Test");
    assert_eq!(run.code(), 0, "{}", run.err());
    let plc = folder.read("m/plc/MAIN.PLC");
    let start = plc.find("LBL TOOL").unwrap();
    let end = start + plc[start..].find("; ---- M functions").unwrap();
    folder.write(
        "m/plc/MAIN.PLC",
        [&plc[..start], TOOL_CHANGER, &plc[end..]]
            .concat()
            .replace("       CM    CHAIN\n       CM    CHANGER\n       CM    ARM\n", ""),
    );
    // The pockets are those of the tool table.
    let description = folder.read("m/machine.toml");
    let lines = description.lines().filter(|line| !line.starts_with("pockets"));
    folder.write(
        "m/machine.toml",
        lines.map(|line| format!("{line}\n")).collect::<String>(),
    );
    let list = folder.read("m/parameters.mp");
    let set = |list: String, number: &str, value: &str| -> String {
        let lines = list.lines().map(|line| match line.split(':').next() {
            Some(name) if name.trim() == number => format!("{number} : {value}\n"),
            _ => format!("{line}\n"),
        });
        lines.collect()
    };
    let list = set(set(list, "MP7480.0", "3"), "MP7261", "20");
    folder.write("m/parameters.mp", list);
    folder.write(
        "m/tools.tsv",
        "T\tL\tR\tP\n1\t70\t5\t11\n2\t95\t5\t12\n3\t85\t5\t13\n4\t80\t3\t14\n5\t75\t4\t15\n",
    );
    let calls: String = CALLS
        .iter()
        .map(|tool| format!("TOOL CALL {tool} Z S500\n"))
        .collect();
    folder.write(
        "m/programs/CHANGES.H",
        format!("BEGIN PGM CHANGES MM\nLBL 1\n{calls}CALL LBL 1 REP 40\nEND PGM CHANGES MM\n"),
    );
    folder.write(
        "m/programs/NOTHING.H",
        "BEGIN PGM NOTHING MM\nEND PGM NOTHING MM\n",
    );
    folder.write("COUNT.PLC", "EM\n");
    folder
}

/// Switches the machine on, which finishes what a kill has left half written, and off again.
fn power_on(folder: &Folder) {
    let run = folder.bahn("run NOTHING.H --machine m --no-graphics");
    assert_eq!(run.code(), 0, "{}", run.err());
}

fn start(folder: &Folder, arguments: &str) -> Child {
    folder
        .command()
        .args("run CHANGES.H --machine m --no-graphics".split(' '))
        .args(arguments.split_whitespace())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The strobes that have fallen, as the PLC counts them.
fn strobes(folder: &Folder) -> i64 {
    if !folder.path("m/state/plc.mem").exists() {
        return 0;
    }
    let run = folder.bahn("plc run COUNT.PLC --retain m/state/plc.mem --cycles 1 --show W110 --format json");
    assert_eq!((run.code(), run.err().as_str()), (0, ""));
    run.json()["values"]["W110"].as_i64().unwrap()
}

/// Tool in the spindle and the pocket of each tool.
#[derive(Clone, Debug, PartialEq)]
struct Magazine {
    spindle: i64,
    pockets: BTreeMap<u32, i64>,
}

impl Magazine {
    /// As the control remembers it.
    fn of(folder: &Folder) -> Magazine {
        let mut pockets: BTreeMap<u32, i64> = (1..=5).map(|tool| (tool, 10 + i64::from(tool))).collect();
        let file = folder.path("m/state/control.toml");
        let text = fs::read_to_string(file).unwrap_or_default();
        let state: toml::Table = text.parse().unwrap();
        let spindle = state.get("tool").map_or(0, |tool| tool.as_integer().unwrap());
        let moved = state.get("pockets").and_then(toml::Value::as_table);
        for (tool, pockets_of) in moved.into_iter().flatten() {
            pockets.insert(tool.parse().unwrap(), pockets_of[0].as_integer().unwrap());
        }
        Magazine { spindle, pockets }
    }

    /// After so many changes of the program [000:9281]: the old tool takes the pocket of the new one.
    fn after(&self, changes: i64) -> Magazine {
        let mut magazine = self.clone();
        let mut calls = CALLS.iter().copied().cycle();
        let mut done = 0;
        while done < changes {
            let new = calls.next().unwrap();
            let old = magazine.spindle;
            if old == i64::from(new) {
                continue;
            }
            if let Ok(old) = u32::try_from(old)
                && old != 0
            {
                let pocket = magazine.pockets[&new];
                let pocket = magazine.pockets.insert(old, pocket).unwrap();
                magazine.pockets.insert(new, pocket);
            }
            magazine.spindle = new.into();
            done += 1;
        }
        magazine
    }
}

/// The process is killed at any time: every tool is in the pocket that the PLC has seen it go to, or the
/// change after it is done, whose strobe had not fallen yet. What counts is the machine that was switched on again.
#[test]
fn killed_at_any_time_the_right_tool_is_in_the_right_pocket() {
    let folder = machine();
    let started = Instant::now();
    let whole = start(&folder, "").wait_with_output().unwrap();
    let errors = String::from_utf8_lossy(&whole.stderr);
    assert_eq!(whole.status.code(), Some(0), "{errors}");
    let whole_time = started.elapsed();
    let changes = CALLS.len() as i64 * 41;
    // The run ends before a scan sees the last strobe fall.
    assert_eq!(strobes(&folder), changes - 1, "a change for each call");
    let empty = Magazine {
        spindle: 0,
        pockets: (1..=5).map(|tool| (tool, 10 + i64::from(tool))).collect(),
    };
    assert_eq!(Magazine::of(&folder), empty.after(changes));
    let mut in_the_midst = 0;
    let mut random = 0x2545_f491_4f6c_dd1d_u64;
    for kill in 0..12 {
        let (before, counted) = (Magazine::of(&folder), strobes(&folder));
        let mut child = start(&folder, "");
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        // The changes fill the last part of the run.
        let part = 0.3 + 0.7 * (random >> 11) as f64 / (1_u64 << 53) as f64;
        std::thread::sleep(whole_time.mul_f64(part));
        child.kill().unwrap();
        child.wait().unwrap();
        power_on(&folder);
        let done = strobes(&folder) - counted;
        let after = Magazine::of(&folder);
        assert!(
            [done, done + 1].iter().any(|done| before.after(*done) == after),
            "kill {kill}: {done} strobes fell\n{before:?}\n{after:?}"
        );
        in_the_midst += i32::from((1..changes).contains(&done));
    }
    assert!(in_the_midst >= 3, "{in_the_midst} kills hit a change");
}

/// The state after a run to its end.
fn run_once() -> Folder {
    let folder = machine();
    folder.write(
        "m/programs/CHANGES.H",
        "BEGIN PGM CHANGES MM\nTOOL CALL 2 Z S500\nTOOL CALL 4 Z S500\nEND PGM CHANGES MM\n",
    );
    let run = start(&folder, "").wait_with_output().unwrap();
    assert_eq!(
        run.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    folder
}

#[test]
fn a_damaged_state_starts_nothing_and_is_kept() {
    let folder = run_once();
    let whole = folder.read("m/state/control.toml");
    let damaged = whole.replace("tool = 4", "tool = 5");
    folder.write("m/state/control.toml", &damaged);
    let aside = "m/state/control.toml.damaged";
    for why in ["its check sum is wrong", "it was found damaged"] {
        let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
        assert_eq!((run.code(), run.out().as_str()), (2, ""));
        assert!(
            run.err().contains(why) && run.err().contains(aside),
            "{}",
            run.err()
        );
        assert_eq!(folder.read(aside), damaged);
        assert!(!folder.path("m/state/control.toml").exists());
    }
    // Mended and given its name back, it counts.
    let lines: Vec<&str> = whole.lines().filter(|line| !line.starts_with("# end")).collect();
    folder.write(
        "m/state/control.toml",
        lines.join("\n") + "\n# end, check by hand\n",
    );
    fs::remove_file(folder.path(aside)).unwrap();
    folder.write("m/tools.tsv", folder.read("m/tools.tsv"));
    let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
    assert_eq!((run.code(), run.err().as_str()), (0, ""));
    // 2 had taken pocket 14 of 4; called again, it goes back, and then 4 again.
    let expected = Magazine::of(&folder);
    assert_eq!(
        (expected.spindle, expected.pockets[&2], expected.pockets[&4]),
        (4, 14, 12)
    );
}

#[test]
fn a_magazine_that_was_loaded_anew_counts() {
    let folder = run_once();
    folder.write("m/tools.tsv", folder.read("m/tools.tsv").replace("12", "16"));
    let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
    assert_eq!(run.code(), 0);
    assert!(
        run.err().contains("the pockets of the tool table have changed"),
        "{}",
        run.err()
    );
}

#[test]
fn damaged_plc_memory_is_said_and_kept() {
    let folder = run_once();
    let counted = strobes(&folder);
    let mut journal = fs::read(folder.path("m/state/plc.mem")).unwrap();
    // The newest record is the one with the greatest number.
    let newest = (0..journal.len() / 512)
        .max_by_key(|record| journal[record * 512 + 4..][..8].to_vec())
        .unwrap();
    let old = (newest + 8) % 16;
    journal[old * 512 + 100] ^= 4;
    fs::write(folder.path("m/state/plc.mem"), &journal).unwrap();
    let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
    assert_eq!(run.code(), 0);
    assert!(
        run.err().contains("1 of 16 records") && run.err().contains("nothing is lost"),
        "{}",
        run.err()
    );
    assert_eq!(fs::read(folder.path("m/state/plc.mem.damaged")).unwrap(), journal);
    assert!(strobes(&folder) >= counted);
}

/// What cannot be read is not replaced.
#[test]
fn unreadable_state_is_refused() {
    for name in ["control.toml", "plc.mem", "lock"] {
        let folder = run_once();
        fs::remove_file(folder.path("m/state").join(name)).unwrap();
        fs::create_dir(folder.path("m/state").join(name)).unwrap();
        let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
        assert_eq!((run.code(), run.out().as_str()), (2, ""), "{name}");
        assert!(
            run.err().contains(name) && folder.path("m/state").join(name).is_dir(),
            "{}",
            run.err()
        );
    }
}

#[cfg(unix)]
#[test]
fn links_are_refused_and_what_they_name_stays() {
    for name in ["control.toml", "plc.mem", "lock"] {
        let folder = machine();
        fs::create_dir(folder.path("m/state")).unwrap();
        folder.write("letter", "mine");
        std::os::unix::fs::symlink(folder.path("letter"), folder.path("m/state").join(name)).unwrap();
        let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
        assert_eq!(run.code(), 2, "{name}");
        assert!(run.err().contains("is a link"), "{}", run.err());
        assert_eq!(folder.read("letter"), "mine");
    }
    let folder = machine();
    fs::create_dir(folder.path("elsewhere")).unwrap();
    std::os::unix::fs::symlink(folder.path("elsewhere"), folder.path("m/state")).unwrap();
    assert_eq!(folder.bahn("run CHANGES.H --machine m --no-graphics").code(), 2);
    assert_eq!(fs::read_dir(folder.path("elsewhere")).unwrap().count(), 0);
}

#[test]
fn names_do_not_lead_out_of_the_folder() {
    let outside = ["../state", "/tmp/state", "a/../../state"];
    for name in outside {
        let folder = machine();
        let description = folder
            .read("m/machine.toml")
            .replace("\"state\"", &format!("\"{name}\""));
        folder.write("m/machine.toml", description);
        let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
        assert_eq!(run.code(), 1);
        assert!(run.err().contains("leads out of the folder"), "{}", run.err());
    }
    let folder = machine();
    folder.write("outside.CMA", "0\n");
    let description = folder
        .read("m/machine.toml")
        .replace("state = ", "compensation = \"../outside.CMA\"\nstate = ");
    folder.write("m/machine.toml", description);
    let said = folder.bahn("machine check m").err();
    assert!(
        said.contains("`../outside.CMA` leads out of the folder"),
        "{said}"
    );
}

/// Module 9033 selects the list OTHER.MP of the folder: the control resets, and begins with it from then on. A
/// faulty or missing one is refused with its code 3 or 2.
#[test]
fn another_list_of_machine_parameters() {
    let folder = machine();
    let plc = folder.read("m/plc/MAIN.PLC");
    let select = "       L     M2046\n       CMT   SELECT\n       L     M2046\n       = M2483\n       EM\n\
         LBL SELECT\n       LN    M61\n       CMT   ONCE\n       S     M61\n       EM\n\
         LBL ONCE\n       SUBM  JOB\n       = B90\n       EM\n\
         LBL JOB\n       L     S\"BAD.MP\"\n       = S1\n       PS    K+1\n       CM    9033\n       PL    B120\n\
       L     S\"GONE.MP\"\n       = S1\n       PS    K+1\n       CM    9033\n       PL    B121\n\
       L     S\"OTHER.MP\"\n       = S1\n       PS    K+1\n       CM    9033\n       PL    B122\n       EM\n\n";
    folder.write(
        "m/plc/MAIN.PLC",
        plc.replace(TOOL_CHANGER, &format!("LBL TOOL\n{select}")),
    );
    let list = folder.read("m/parameters.mp");
    folder.write("m/OTHER.MP", list.replace("MP7480.0 : 3", "MP7480.0 : 0"));
    folder.write("m/BAD.MP", list.replace("MP7480.0 : 3", "MP7480.0 : 99"));
    let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("module 9033 has selected OTHER.MP"),
        "{}",
        run.err()
    );
    assert!(
        folder
            .read("m/state/control.toml")
            .contains("parameter_list = \"OTHER.MP\"")
    );
    let run =
        folder.bahn("plc run COUNT.PLC --retain m/state/plc.mem --cycles 1 --show B120,B121 --format json");
    assert_eq!(
        (&run.json()["values"]["B120"], &run.json()["values"]["B121"]),
        (&3.into(), &2.into())
    );
    // With MP7480.0 = 0 no tool call comes to the PLC.
    let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
    assert_eq!((run.code(), run.err().as_str()), (0, ""));
    // Missing or faulty, it keeps no machine off: that is said once with its name, and the usual list counts.
    let other = folder.read("m/OTHER.MP");
    folder.write("m/programs/STILL.H", crate::support::program("L Z+50 R0 FMAX"));
    for what in ["missing", "faulty"] {
        assert!(
            folder.read("m/state/control.toml").contains("\"OTHER.MP\""),
            "{what}"
        );
        match what {
            "missing" => fs::remove_file(folder.path("m/OTHER.MP")).unwrap(),
            _ => drop(folder.write("m/OTHER.MP", "MP7480.0 : 99\n")),
        }
        let run = folder.bahn("run STILL.H --machine m --no-graphics");
        let says = format!("warning: OTHER.MP, which module 9033 selected, is {what}");
        assert!(
            run.code() == 0 && run.err().contains(&says) && run.err().contains("parameters.mp counts"),
            "{what}: {} {}",
            run.code(),
            run.err()
        );
        assert!(
            !folder.read("m/state/control.toml").contains("OTHER.MP"),
            "{what}"
        );
        let run = folder.bahn("run STILL.H --machine m --no-graphics");
        assert_eq!((run.code(), run.err().as_str()), (0, ""), "{what}: said once");
        // There again, it is selected as the first time.
        folder.write("m/OTHER.MP", &other);
        let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
        assert_eq!(run.code(), 1, "{what}: {}", run.err());
    }
}

/// A process that runs in real time until it is killed.
struct Running(Child);

impl Running {
    fn new(folder: &Folder) -> Running {
        let running = Running(start(folder, "--realtime"));
        let since = Instant::now();
        while !folder.path("m/state/control.toml").exists() {
            assert!(since.elapsed() < Duration::from_secs(60), "it keeps its state");
            std::thread::sleep(Duration::from_millis(20));
        }
        running
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn a_machine_that_is_on_keeps_its_files() {
    let folder = machine();
    let _running = Running::new(&folder);
    let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
    assert!(
        run.code() == 2 && run.err().contains("switched on already"),
        "{}",
        run.err()
    );
    let run = folder.bahn("plc run COUNT.PLC --retain m/state/plc.mem --cycles 1");
    assert!(
        run.code() == 2 && run.err().contains("plc.mem is in use"),
        "{}",
        run.err()
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_without_end_is_no_memory() {
    let folder = machine();
    for device in ["/dev/zero", "/dev/full"] {
        let run = folder.bahn(&format!("plc run COUNT.PLC --retain {device} --cycles 1"));
        assert!(
            run.code() == 2 && run.err().contains("no regular file"),
            "{}",
            run.err()
        );
    }
}

/// The medium is gone while the machine runs: the run ends, and its report is there.
#[test]
fn a_state_that_cannot_be_stored_loses_no_report() {
    let folder = machine();
    let mut running = Running::new(&folder);
    fs::remove_dir_all(folder.path("m/state")).unwrap();
    let output = {
        let since = Instant::now();
        while running.0.try_wait().unwrap().is_none() {
            assert!(since.elapsed() < Duration::from_secs(60), "it ends");
            std::thread::sleep(Duration::from_millis(20));
        }
        let mut text = [String::new(), String::new()];
        use std::io::Read;
        running
            .0
            .stdout
            .take()
            .unwrap()
            .read_to_string(&mut text[0])
            .unwrap();
        running
            .0
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut text[1])
            .unwrap();
        text
    };
    assert!(output[1].contains("cannot be stored"), "{}", output[1]);
    assert!(
        output[0].contains("Test") && output[0].lines().count() > 3,
        "{}",
        output[0]
    );
}

/// Asked twice to end, in quick succession: the report is there, and nothing half-written.
#[cfg(unix)]
#[test]
fn a_second_request_to_end_keeps_the_report() {
    let folder = machine();
    let running = start(&folder, "--realtime --record out.csv --log out.log");
    let since = Instant::now();
    while !folder.path("m/state/control.toml").exists() {
        assert!(since.elapsed() < Duration::from_secs(60), "it keeps its state");
        std::thread::sleep(Duration::from_millis(20));
    }
    for _ in 0..2 {
        let id = running.id().to_string();
        let sent = std::process::Command::new("kill")
            .args(["-TERM", &id])
            .status()
            .unwrap();
        assert!(sent.success());
        std::thread::sleep(Duration::from_millis(3));
    }
    let output = running.wait_with_output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert_eq!(output.status.code(), Some(130), "{err}");
    assert!(
        err.contains("the report so far") && out.contains("Test"),
        "{out}{err}"
    );
    let names = folder.names();
    assert!(names.contains(&"out.csv".to_owned()), "{names:?}");
    assert!(!names.iter().any(|name| name.ends_with(".tmp")), "{names:?}");
}

/// No output of a run replaces what its machine is made of.
#[test]
fn outputs_leave_the_machine_alone() {
    let folder = run_once();
    folder.write("m/programs/SUB.H", "BEGIN PGM SUB MM\nEND PGM SUB MM\n");
    let names = [
        "machine.toml",
        "plant.toml",
        "parameters.mp",
        "tools.tsv",
        "plc/MAIN.PLC",
        "programs/CHANGES.H",
        "programs/SUB.H",
        "state/lock",
        "state/plc.mem",
        "state/control.toml",
    ];
    let files = || names.map(|name| fs::read(folder.path("m").join(name)).unwrap());
    let before = files();
    for name in names {
        for option in ["--log", "--record"] {
            let run = folder.bahn(&format!(
                "run CHANGES.H --machine m --no-graphics {option} m/{name}"
            ));
            assert_eq!((run.code(), run.out().as_str()), (2, ""), "{option} {name}");
            assert!(run.err().contains(name), "{}", run.err());
        }
    }
    assert_eq!(files(), before);
}

/// Of retained memory that is gone it is said.
#[test]
fn missing_plc_memory_is_said() {
    let folder = run_once();
    fs::remove_file(folder.path("m/state/plc.mem")).unwrap();
    let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
    assert_eq!(run.code(), 0);
    assert!(run.err().contains("plc.mem is missing"), "{}", run.err());
    let run = folder.bahn("run CHANGES.H --machine m --no-graphics");
    assert_eq!((run.code(), run.err().as_str()), (0, ""));
}

/// What may not be read is refused, and stays as it is.
#[cfg(unix)]
#[test]
fn a_state_that_may_not_be_read_is_kept() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
    use std::os::unix::process::CommandExt;
    /// Somebody who may read nothing of others.
    const NOBODY: u32 = 65_534;
    for name in ["control.toml", "plc.mem", "lock"] {
        let folder = run_once();
        let file = folder.path("m/state").join(name);
        let before = fs::read(&file).unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o000)).unwrap();
        let command = folder.path("bahn");
        fs::copy(env!("CARGO_BIN_EXE_bahn"), &command).unwrap();
        let mut command = std::process::Command::new(command);
        command
            .current_dir(&folder)
            .args("run CHANGES.H --machine m --no-graphics".split(' '));
        // Who is root may read everything.
        if fs::metadata(&file).unwrap().uid() == 0 {
            chown(folder.path("m/state"), Some(NOBODY), None).unwrap();
            for other in ["control.toml", "plc.mem", "lock", "mechanics.toml"]
                .map(|other| folder.path("m/state").join(other))
            {
                chown(&other, (other != file).then_some(NOBODY), None).unwrap();
            }
            command.uid(NOBODY);
        }
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout), (Some(2), vec![]), "{said}");
        assert!(said.contains(name) && said.contains("ermission denied"), "{said}");
        fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
        assert_eq!(fs::read(&file).unwrap(), before, "{name}");
        let mut names: Vec<_> = fs::read_dir(folder.path("m/state"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        names.sort();
        assert_eq!(names, ["control.toml", "lock", "mechanics.toml", "plc.mem"]);
    }
}

/// The process is killed in the midst of changes with the magazine, and begins again where it was: no file disagrees, and the last
/// run, in which nobody kills it, comes to its end with the tool that it called.
#[test]
fn killed_in_a_change_of_the_magazine() {
    let folder = Folder::new();
    assert_eq!(folder.bahn("machine new m --model tnc415b --name Test").code(), 0);
    let list = folder.read("m/parameters.mp");
    let list = list
        .replace("MP7480.0 : 1 ", "MP7480.0 : 3 ")
        .replace("MP4310.0 : 1 ", "MP4310.0 : 3 ");
    assert!(list.contains("MP7480.0 : 3 ") && list.contains("MP4310.0 : 3 "));
    folder.write("m/parameters.mp", list);
    let calls: String = [1, 5, 2, 7, 1, 3]
        .map(|tool| format!("TOOL CALL {tool} Z S0\n"))
        .concat();
    folder.write(
        "m/programs/CHANGES.H",
        format!("BEGIN PGM CHANGES MM\n{calls}END PGM CHANGES MM\n"),
    );
    let started = Instant::now();
    let whole = start(&folder, "--fresh").wait_with_output().unwrap();
    assert_eq!(
        whole.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&whole.stderr)
    );
    let whole_time = started.elapsed();
    for part in [0.5, 0.63, 0.72, 0.81, 0.9] {
        let mut child = start(&folder, "");
        std::thread::sleep(whole_time.mul_f64(part));
        child.kill().unwrap();
        let killed = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&killed.stderr);
        assert!(!said.contains("moment") && !said.contains("missing"), "{said}");
    }
    let last = start(&folder, "").wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&last.stderr);
    assert_eq!(
        (last.status.code(), said.as_ref()),
        (Some(0), ""),
        "{}",
        String::from_utf8_lossy(&last.stdout)
    );
    let mechanics = folder.read("m/state/mechanics.toml");
    let control = folder.read("m/state/control.toml");
    assert!(
        control.contains("\ntool = 3\n") && mechanics.contains("\nspindle = 3\n"),
        "{mechanics}"
    );
}
