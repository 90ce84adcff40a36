//! Machine parameters that are changed while a program of DIN 66025 runs.

use std::sync::Arc;

use crate::support::*;
use bahn_host::{
    Action, Answer, Attendance, FolderPrograms, Host, Job, LoadedMachine, Observed, Operator, PowerOn, Source,
};
use bahn_tnc::RunState;

fn give(host: &mut Host, what: &str) {
    let done = host.act(Source::Script, Action::parse(what).unwrap());
    assert_eq!(done.unwrap(), Answer::Done, "{what}");
}

#[track_caller]
fn until(host: &mut Host, what: &str, holds: impl Fn(&Host) -> bool) {
    let end_us = host.control().time_us() + 60_000_000;
    while !holds(host) {
        assert!(host.control().time_us() < end_us, "{what}");
        host.step().unwrap();
    }
}

/// Changed machine parameters count for the blocks that are not yet read. MP7440 bit 0 = 0: M06 halts the program
/// [000:7258-7262]; the mill has it 1 until the stop before. The datum of X is 200.
#[test]
fn m6_stops_when_the_parameter_says_so_meanwhile() {
    for (bits, stops) in [("%11011", false), ("%11010", true)] {
        let copy = Copy::of("mill", "rules-of-a-run");
        let program = "N10 G01 X10 F2000\nN20 M0\nN30 M6\nN40 X20\nN50 M30\n";
        std::fs::write(copy.path().join("programs/PART.NC"), program).unwrap();
        let machine = LoadedMachine::load(copy.path()).unwrap().unwrap();
        let operator = Operator::new(
            Attendance::StopsWait,
            machine.folder.operator.clone(),
            Some(Job::whole("PART.NC")),
        );
        let programs = Arc::new(FolderPrograms::of_folder(&machine.programs(0)));
        let mut host = Host::new(&machine, PowerOn::fresh(&machine), programs, operator).unwrap();
        let stopped = |host: &Host| host.control().run_state() == RunState::Stopped;
        until(&mut host, "M0", stopped);
        give(&mut host, &format!("MP7440={bits}"));
        give(&mut host, "key NC_START tap");
        until(&mut host, "it goes on", |host| !stopped(host));
        until(&mut host, "M6 or the end", |host| {
            stopped(host) || host.control().snapshot().ended
        });
        let observed: Observed = "X.nominal".parse().unwrap();
        let x = observed.value(host.control(), host.plant());
        assert_eq!(
            (stopped(&host), x),
            (stops, if stops { 210.0 } else { 220.0 }),
            "{bits}"
        );
    }
}
