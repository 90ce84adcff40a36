//! M functions on their way to the PLC [002:5455-5517].

use bahn_control900::{StandardAnswers, When};
use bahn_path::{At, Axis, Synchronisation};

use crate::support::Rig;
use crate::support::list::Line;

/// The example of the manual: M7 branches, M6 goes out before the path with stop, M5 after it with stop, M4 before it,
/// flying.
const EXAMPLE: &str = "P11051: $10050601\n";

fn with(m: u16, at: At, how: Synchronisation) -> [Line; 2] {
    [
        Line::to(&[(Axis::X, 40.0)], 3000.0),
        Line::to(&[(Axis::X, 80.0)], 3000.0).with(m, at, how),
    ]
}

#[test]
fn a_flying_function_does_not_stop_the_path() {
    let mut rig = Rig::answered(
        EXAMPLE,
        StandardAnswers {
            m: false,
            ..StandardAnswers::ALL
        },
    );
    rig.start(1, &with(4, At::Start, Synchronisation::Mos));
    rig.until(|rig| rig.control.transfers().count() == 1);
    assert!(rig.read("P8938") > 2900.0, "{}", rig.read("P8938"));
    rig.until_end(1);
    let transfer = *rig.control.transfers().next().unwrap();
    assert_eq!(
        (transfer.m, transfer.when, transfer.stop),
        (4, When::Before, false)
    );
    assert_eq!((transfer.block, transfer.ack_us), (20, None));
}

/// M6 waits at X 40 for P8706, M5 at X 80.
#[test]
fn a_function_with_stop_waits_for_its_acknowledgement() {
    for (m, at, how, place, when) in [
        (6, At::Start, Synchronisation::MvsSvs, 40.0, When::Before),
        (5, At::End, Synchronisation::MnsSns, 80.0, When::After),
    ] {
        let mut rig = Rig::answered(
            EXAMPLE,
            StandardAnswers {
                m: false,
                ..StandardAnswers::ALL
            },
        );
        rig.start(1, &with(m, at, how));
        rig.until(|rig| rig.read("P8559") == 1.0);
        rig.seconds(1.0);
        assert_eq!(rig.read("P12151"), place);
        // The path stood within its exact stop when the function went out.
        assert!((rig.read("P12150") - place).abs() < 0.04);
        let sent = *rig.control.transfers().next().unwrap();
        assert_eq!((sent.m, sent.when, sent.stop, sent.ack_us), (m, when, true, None));
        rig.plc("P8706", "1");
        let now_us = rig.control.now_us();
        assert_eq!(rig.control.transfers().next().unwrap().ack_us, Some(now_us));
        assert_eq!(rig.read("P8559"), 0.0);
        rig.until_end(1);
        assert_eq!(rig.read("P12151"), 80.0);
    }
}

/// The standard answer comes in the next cycle of the PLC, 10 ms, but not in that of the transfer.
#[test]
fn the_standard_answer_acknowledges() {
    let mut rig = Rig::on(EXAMPLE);
    rig.start(1, &with(6, At::Start, Synchronisation::MvsSvs));
    rig.until_end(1);
    let transfer = *rig.control.transfers().next().unwrap();
    let took_us = transfer.ack_us.unwrap() - transfer.time_us;
    assert!((1000..=14_000).contains(&took_us), "{took_us}");
}

/// A definition that is changed takes effect with the change from HAND to AUTO.
#[test]
fn a_definition_takes_effect_with_the_mode() {
    let mut rig = Rig::on("");
    let lines = with(4, At::Start, Synchronisation::Mos);
    rig.start(1, &lines);
    rig.operator("P11051", "$00000001");
    rig.until_end(1);
    assert_eq!(rig.control.transfers().count(), 0, "it is not defined yet");
    rig.operator("P8683", "1");
    rig.seconds(0.05);
    rig.start(1, &lines);
    rig.until_end(1);
    assert_eq!(rig.control.transfers().count(), 1);
}
