//! The process ends at any moment of a tool change and begins again: the simulated mechanics stand where they stood, and the PLC
//! program brings every tool to where the control has it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::*;
use bahn_host::{Attendance, Host, Job, LoadedMachine, Operator, PowerOn};
use bahn_tnc::{Mode, Signal};

/// What is kept, in the order in which it is written.
const FILES: [&str; 3] = ["mechanics.toml", "plc.mem", "control.toml"];

/// The mill with its magazine: tools 4 and 6 are special, 3 has no pocket. MP4310.0 is 3 with any pocket, 7 with fixed ones.
struct Mill {
    copy: Copy,
    machine: LoadedMachine,
}

impl Mill {
    fn new(what: &str, output: &str, kind: &str) -> Mill {
        let copy = Copy::of("mill", what);
        let path = copy.path().join("pockets.tsv");
        let text = fs::read_to_string(&path).unwrap();
        let text = text
            .replace("3\t3\t\t", "3\t\t\t")
            .replace("4\t4\t\t", "4\t4\tS\t")
            .replace("6\t6\t\t", "6\t6\tS\t");
        fs::write(&path, text).unwrap();
        let path = copy.path().join("parameters.mp");
        let text = fs::read_to_string(&path).unwrap();
        let text = text
            .replace("MP4310.0 : 1 ", &format!("MP4310.0 : {kind} "))
            .replace("MP7480.0 : 1 ", &format!("MP7480.0 : {output} "));
        fs::write(&path, text).unwrap();
        Mill::of(copy)
    }

    fn of(copy: Copy) -> Mill {
        let machine = LoadedMachine::load(copy.path()).unwrap().unwrap();
        Mill { copy, machine }
    }

    fn state(&self) -> PathBuf {
        self.copy.path().join("state")
    }

    /// Switched on with what the folder keeps.
    fn switch_on(&self, blocks: &str) -> (Host, Vec<String>) {
        let power_on = PowerOn::kept(&self.machine).unwrap();
        let warnings = power_on.warnings.clone();
        let job = (!blocks.is_empty()).then(|| Job::whole("1.H"));
        let operator = Operator::new(Attendance::Full, self.machine.folder.operator.clone(), job);
        let programs = Texts::new(&[("1.H", blocks)]);
        (
            Host::new(&self.machine, power_on, programs, operator).unwrap(),
            warnings,
        )
    }
}

fn number(host: &Host, operand: &str) -> f64 {
    host.control().observe(&operand.parse::<Signal>().unwrap())
}

fn until(host: &mut Host, seconds: f64, what: &str, mut is: impl FnMut(&Host) -> bool) {
    let end_us = host.control().time_us() + (seconds * 1e6) as u64;
    while !is(host) {
        assert!(
            host.control().time_us() < end_us,
            "{what}: {:?} {:?}",
            host.control().shown(),
            host.plant().magazine()
        );
        host.step().unwrap();
    }
}

/// Every tool is where the control has it, 3 and what is in the spindle apart; nothing is on its way.
fn agree(host: &Host, at: &str) {
    let remembered = host.control().remember();
    let mut pockets = vec![1, 2, 0, 4, 5, 6, 7, 8, 9, 0, 0, 0];
    for moved in &remembered.pockets {
        let there = pockets.iter_mut().filter(|tool| **tool == moved.tool);
        there.for_each(|tool| *tool = 0);
    }
    for moved in &remembered.pockets {
        if let Some(pocket) = moved.pocket {
            pockets[usize::from(pocket) - 1] = moved.tool;
        }
    }
    let there = pockets.iter_mut().filter(|tool| **tool == remembered.tool);
    there.for_each(|tool| *tool = 0);
    let state = host.plant().magazine().unwrap();
    assert_eq!((state.shuttle, state.arm), (0, [0, 0]), "{at}");
    assert_eq!(state.pockets, pockets, "{at}: {remembered:?}");
    // By hand nothing but a hand puts tool 3 in.
    if remembered.tool != 3 {
        assert_eq!(state.spindle, remembered.tool, "{at}");
    }
}

fn copy_files(from: &Path, to: &Path, names: &[&str]) {
    fs::create_dir_all(to).unwrap();
    for name in names {
        if from.join(name).exists() {
            fs::copy(from.join(name), to.join(name)).unwrap();
        }
    }
}

/// After power-on, reference run and what the PLC takes back: where the tools are, and that no file disagreed.
fn goes_on(mill: &Mill, at: &str) {
    let (mut host, warnings) = mill.switch_on("");
    assert_eq!(warnings, [""; 0], "{at}");
    until(&mut host, 120.0, &format!("{at}: the way back"), |host| {
        number(host, "W112") == 0.0
            && host.operator().phase() == bahn_host::Phase::Ready
            && host.control().mode() != Mode::Reference
            && host.control().stands()
    });
    seconds(&mut host, 0.5);
    agree(&host, at);
}

/// Numbers from a seed.
fn next(random: &mut u64) -> u64 {
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    *random >> 11
}

/// What the medium holds, and what it held before the last write.
struct Medium {
    state: PathBuf,
    before: PathBuf,
    now: PathBuf,
    seen: Vec<u8>,
}

impl Medium {
    /// What was written when the machine was switched on, or by then.
    fn of(mill: &Mill) -> Medium {
        let path = |name| mill.copy.path().join(name);
        let mut medium = Medium {
            state: mill.state(),
            before: path("before"),
            now: path("now"),
            seen: Vec::new(),
        };
        medium.look();
        copy_files(&medium.now, &medium.before, &FILES);
        medium
    }

    /// After every cycle.
    fn look(&mut self) {
        let written = fs::read(self.state.join(FILES[0])).unwrap_or_default();
        if written != self.seen {
            copy_files(&self.now, &self.before, &FILES);
            copy_files(&self.state, &self.now, &FILES);
            self.seen = written;
        }
    }

    /// The state of another machine when these files were written of the last write, and the others were not.
    fn found(&self, state: &Path, written: &[&str]) {
        copy_files(&self.before, state, &FILES);
        copy_files(&self.now, state, written);
    }
}

/// 200 kills in ten changes: of a normal tool for another one, a special one for a normal one in both orders of codes, a special one
/// for a special one, one without pocket, out of the spindle. The process ends at a moment that the seed says, or when the control
/// has just taken the acknowledgement; its last write was complete, or ended after the first file, or after two of them in
/// either order.
#[test]
fn killed_at_any_moment_of_a_change() {
    let kinds = [("any", "3", "3"), ("old-first", "3", "11"), ("fixed", "5", "7")];
    let changes: [&[(u32, u32)]; 3] = [
        &[(1, 2), (4, 1), (1, 4), (4, 6), (1, 3), (5, 0)],
        &[(1, 4), (4, 2)],
        &[(1, 2), (4, 6)],
    ];
    let mut random = 0x2545_f491_4f6c_dd1d_u64;
    let (mut kills, mut under_way, mut torn) = (0, 0, 0);
    for ((what, output, kind), changes) in kinds.into_iter().zip(changes) {
        for (old, new) in changes {
            let mill = Mill::new(&format!("kill-{what}-{old}-{new}"), output, kind);
            let blocks = format!("TOOL CALL {old} Z S0\nTOOL CALL {new} Z S0\nL R0 F200");
            let (mut host, _) = mill.switch_on(&blocks);
            until(&mut host, 120.0, "the old tool", |host| {
                host.control().tool() == *old
            });
            let begin_us = host.control().time_us();
            let length_us = mill.length_us(&blocks, *old, *new);
            let mut moments: Vec<u64> = (0..19)
                .map(|_| begin_us + next(&mut random) % (length_us + length_us / 20))
                .collect();
            moments.push(begin_us + length_us);
            moments.sort_unstable();
            let mut medium = Medium::of(&mill);
            for moment in moments {
                until(&mut host, 600.0, "the moment", |host| {
                    medium.look();
                    host.control().time_us() >= moment
                });
                let step = number(&host, "W112");
                if next(&mut random).is_multiple_of(2) {
                    host.store().unwrap();
                    medium.look();
                }
                let written: &[&str] = match next(&mut random) % 5 {
                    0 => &FILES[..1],
                    1 => &FILES[..2],
                    2 => &["mechanics.toml", "control.toml"],
                    _ => &FILES,
                };
                let copy = Copy::of_folder(mill.copy.path(), &format!("found-{what}-{old}-{new}-{kills}"));
                medium.found(&copy.path().join("state"), written);
                let at = format!("{what}, {old} to {new}, step {step}, written: {written:?}");
                goes_on(&Mill::of(copy), &at);
                kills += 1;
                under_way += i32::from(step != 0.0);
                torn += i32::from(written.len() < FILES.len());
            }
        }
    }
    assert_eq!(kills, 200);
    assert!(under_way > 100 && torn > 80, "{under_way} {torn}");
}

impl Mill {
    /// How long the change takes, µs.
    fn length_us(&self, blocks: &str, old: u32, new: u32) -> u64 {
        let mut host = host(&self.machine, PowerOn::fresh(&self.machine), blocks);
        until(&mut host, 120.0, "the old tool", |host| {
            host.control().tool() == old
        });
        let begin_us = host.control().time_us();
        until(&mut host, 240.0, "the new tool", |host| {
            host.control().tool() == new
        });
        host.control().time_us() - begin_us
    }
}

/// A mill that has put tool 2 into its spindle, switched off.
fn with_tool_2(what: &str) -> Mill {
    let mill = Mill::new(what, "3", "3");
    let (mut host, _) = mill
        .switch_on("TOOL CALL 2 Z S0\nL X+210 R0 FMAX\nTOOL CALL 5 Z S0\nTOOL CALL 7 Z S0\nTOOL CALL 2 Z S0");
    let first = mill.copy.path().join("first");
    until(&mut host, 120.0, "the first tool", |host| {
        host.control().tool() == 2
    });
    host.store().unwrap();
    copy_files(&mill.state(), &first, &FILES);
    until(&mut host, 300.0, "the end", |host| {
        host.control().snapshot().ended
    });
    host.store().unwrap();
    mill
}

/// Where axes, chain and things stand is as it was.
#[test]
fn mechanics_stand_where_they_stood() {
    let mill = with_tool_2("stands");
    let (host, warnings) = mill.switch_on("");
    assert_eq!(warnings, [""; 0]);
    let x = host.plant().axis('X').unwrap().position;
    // The datum of machine.toml is at X 200.
    assert!((x - 410.0).abs() < 0.05, "{x}");
    let magazine = host.plant().magazine().unwrap();
    // Any pocket, each old tool takes that of the new one: 2 that of 5, 5 that of 7, and 7 that of 2, which is 5.
    assert_eq!(
        (magazine.spindle, magazine.pocket, magazine.pockets[4]),
        (2, 5, 7)
    );
    assert_eq!(host.plant().device("lubricant").unwrap().state, Some("full"));
    drop(host);
    // A fresh one stands at its start.
    let fresh = host_of_fresh(&mill);
    let start = mill.machine.simulated().unwrap().axis('X').unwrap().position;
    assert_eq!(fresh.plant().axis('X').unwrap().position, start);
    assert_eq!(fresh.plant().magazine().unwrap().spindle, 0);
}

fn host_of_fresh(mill: &Mill) -> Host {
    host(&mill.machine, PowerOn::fresh(&mill.machine), "L R0 F200")
}

/// A file that is missing, older, edited, damaged or of another form is said, with what is where and what to do.
#[test]
fn files_that_do_not_agree_are_said() {
    let said = |what: &str, action: &dyn Fn(&Mill)| {
        let mill = with_tool_2(what);
        action(&mill);
        let (host, warnings) = mill.switch_on("");
        let place = host
            .plant()
            .magazine()
            .map(|state| (state.spindle, state.pockets.to_vec()))
            .unwrap();
        (warnings.join("\n"), place)
    };
    let (text, place) = said("missing", &|mill| {
        fs::remove_file(mill.state().join(FILES[0])).unwrap()
    });
    assert!(
        text.contains("mechanics.toml is missing") && text.contains("tools lie where the control"),
        "{text}"
    );
    assert_eq!((place.0, place.1[4]), (2, 7), "as the control remembers");
    let (text, place) = said("older", &|mill| {
        copy_files(&mill.copy.path().join("first"), &mill.state(), &FILES[..1]);
    });
    assert!(text.contains("not of the same moment"), "{text}");
    // Then tool 2 was in the spindle, and all others in their own pockets.
    assert!(
        text.contains("pocket 5: tool 5; the control has tool 7 there"),
        "{text}"
    );
    assert!(
        text.contains("pocket 7: tool 7; the control has tool 5 there"),
        "{text}"
    );
    assert_eq!((place.0, place.1[4]), (2, 5), "the mechanics are what they are");
    let (text, _) = said("older-control", &|mill| {
        copy_files(&mill.copy.path().join("first"), &mill.state(), &FILES[2..]);
    });
    assert!(text.contains("control.toml are not of the same moment"), "{text}");
    let (text, place) = said("edited", &|mill| {
        let path = mill.state().join("control.toml");
        let text = fs::read_to_string(&path).unwrap();
        let content = &text[..text.rfind("# end").unwrap()];
        let text = content.replace("tool = 2\n", "tool = 7\n") + "# end, check by hand\n";
        fs::write(&path, text).unwrap();
    });
    assert!(
        text.contains("spindle: tool 2; the control has tool 7 there"),
        "{text}"
    );
    assert_eq!(place.0, 2);
    let (text, place) = said("damaged", &|mill| {
        let path = mill.state().join(FILES[0]);
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.replace("spindle = 2", "spindle = 3")).unwrap();
    });
    assert!(
        text.contains("check sum is wrong") && text.contains("mechanics.toml.damaged"),
        "{text}"
    );
    assert_eq!(place.0, 2);
    let (text, place) = said("other-machine", &|mill| {
        let path = mill.state().join(FILES[0]);
        let text = fs::read_to_string(&path).unwrap();
        let content = &text[..text.rfind("# end").unwrap()];
        let text = content.replace("\"arm_turn\"", "\"arm\"") + "# end, check by hand\n";
        fs::write(&path, text).unwrap();
    });
    assert!(text.contains("of another machine: it has the things"), "{text}");
    assert_eq!(place.0, 2);
}

/// Who changes the tables has put the tools there.
#[test]
fn a_magazine_that_was_loaded_anew_counts() {
    let mut mill = with_tool_2("loaded");
    let path = mill.copy.path().join("pockets.tsv");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(
        &path,
        text.replace("9\t9\t", "9\t\t").replace("12\t\t", "12\t9\t"),
    )
    .unwrap();
    mill.machine = LoadedMachine::load(mill.copy.path()).unwrap().unwrap();
    let (host, warnings) = mill.switch_on("");
    let warnings = warnings.join("\n");
    assert!(
        warnings.contains("the tools lie in the magazine as they say"),
        "{warnings}"
    );
    let magazine = host.plant().magazine().unwrap();
    assert_eq!(
        (magazine.spindle, magazine.pockets[8], magazine.pockets[11]),
        (2, 0, 9)
    );
}
