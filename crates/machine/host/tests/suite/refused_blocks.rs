//! TOOL CALL with a speed that the spindle of a machine does not have is refused whole: no axis moves.

use crate::support::*;
use bahn_host::{Host, PowerOn};
use bahn_tnc::RunState;

/// Where the axes are commanded to be, mm of the machine.
fn commanded(host: &Host) -> Vec<f64> {
    host.control()
        .first()
        .watch()
        .map(|axis| axis.commanded)
        .collect()
}

fn messages(host: &Host) -> Vec<String> {
    let shown = host.control().snapshot().messages;
    let texts = shown
        .iter()
        .map(|shown| host.control().message_text(&shown.message));
    texts.map(|text| text.to_string()).collect()
}

/// None of the mills turns 9000 rpm. The tool in the spindle is number 0 without length, the one that is called is longer: of the
/// table, or 5 mm by TOOL DEF. Ten seconds after the message the axes are where they were.
#[test]
fn no_axis_moves_with_a_wrong_speed() {
    for name in ["mill", "mill-tnc360", "mill-tnc155"] {
        let machine = machine(name);
        for blocks in [
            "TOOL CALL 1 Z S9000\nL IX+10 R0 F500",
            "TOOL DEF 9 L+5 R+3\nTOOL CALL 9 Z S9000\nL IX+10 R0 F500",
        ] {
            let mut host = host(&machine, PowerOn::fresh(&machine), blocks);
            while host.control().snapshot().run == RunState::Idle {
                assert!(host.control().time_us() < 120_000_000, "{name}");
                host.step().unwrap();
            }
            let before = commanded(&host);
            for _ in 0..2500 {
                host.step().unwrap();
                for (now, before) in commanded(&host).iter().zip(&before) {
                    assert!((now - before).abs() < 1e-6, "{name} {blocks}: {before} to {now}");
                }
            }
            let wrong = messages(&host);
            assert!(
                matches!(wrong.as_slice(), [only] if ["WRONG RPM", "WRONG SPINDLE SPEED"].contains(&only.as_str())),
                "{name} {blocks}: {wrong:?}"
            );
            let snapshot = host.control().snapshot();
            assert_eq!(
                (snapshot.tool, snapshot.run),
                (0, RunState::Interrupted),
                "{name}"
            );
        }
    }
}
