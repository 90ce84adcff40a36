//! Module 9150 while a program of DIN 66025 runs, which has no tools.

use std::sync::Arc;

use crate::support::*;
use bahn_host::{Attendance, FolderPrograms, Host, Job, LoadedMachine, Observed, Operator, PowerOn};
use bahn_parameters::MessageId;
use bahn_tnc::RunState;

/// A module of the PLC program that inserts TOOL CALL 2 with the strobe of an M function [000:16063-16118].
fn inserts_at(code: u32) -> String {
    format!(
        "
LBL INSERTS
       L     M2045
       AN    M190
       = M191
       L     M2045
       = M190
       L     W260
       == K+{code}
       A     M191
       CMT   INSERT
       EM
LBL INSERT
       L     K+1
       = B200
       L     K+2
       = W202
       PS    K+0
       PS    K+200
       CM    9150
       PL    B204
       EM
"
    )
}

/// The mill with such a PLC program, and a program that is started; nobody stands by after that.
fn mill_that_inserts(code: u32, program: &str) -> (Copy, Host) {
    let copy = Copy::of("mill", &format!("inserted-{code}"));
    let main = copy.path().join("plc/MAIN.PLC");
    let text = std::fs::read_to_string(&main).unwrap();
    let calls = text.replacen("CM    STATE\n", "CM    STATE\n       CM    INSERTS\n", 1);
    std::fs::write(&main, calls + &inserts_at(code)).unwrap();
    std::fs::write(copy.path().join("programs/PART.NC"), program).unwrap();
    let machine = LoadedMachine::load(copy.path()).unwrap().unwrap();
    let operator = Operator::new(
        Attendance::Full,
        machine.folder.operator.clone(),
        Some(Job::whole("PART.NC")),
    );
    let programs = Arc::new(FolderPrograms::of_folder(&machine.programs(0)));
    let host = Host::new(&machine, PowerOn::fresh(&machine), programs, operator).unwrap();
    (copy, host)
}

fn see(host: &Host, signal: &str) -> f64 {
    let observed: Observed = signal.parse().unwrap();
    observed.value(host.control(), host.plant())
}

/// "Erroneous parameters result in an abortion of the NC program with the corresponding error message" [000:16071]: a program
/// of DIN 66025 calls no tools. It ends at the block of the strobe, whether this is a stop (M0) or not (M70); X+20, datum 200,
/// is not executed, and the tool stays.
#[test]
fn a_program_without_tools_is_broken_off() {
    for code in [0, 70] {
        let program = format!("N10 G01 X10 F2000\nN20 M{code}\nN30 X20\nN40 M30\n");
        let (_copy, mut host) = mill_that_inserts(code, &program);
        let tool = host.control().snapshot().tool;
        let refused = MessageId::BlockNotSupported.text(host.control().model());
        let said = |host: &Host| {
            let shown = host.control().shown();
            let mut texts = shown.iter().map(|shown| host.control().shown_text(shown));
            texts.any(|text| text.contains(refused))
        };
        let end_us = host.control().time_us() + 60_000_000;
        while !said(&host) && !host.control().snapshot().ended && host.control().time_us() < end_us {
            host.step().unwrap();
        }
        assert!(said(&host), "M{code}: X {}", see(&host, "X.nominal"));
        assert_eq!(see(&host, "X.nominal"), 210.0, "M{code}");
        // A fault interrupts the run [003:1578].
        assert_eq!(host.control().run_state(), RunState::Interrupted, "M{code}");
        let shown = host.control().first().snapshot().tool;
        assert_eq!(shown, tool, "M{code}");
    }
}
