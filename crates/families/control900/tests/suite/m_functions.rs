//! M functions on their way to the PLC [002:5455-5517].

use bahn_control900::{StandardAnswers, When};
use bahn_path::{At, Axis, Function, Synchronisation};

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

/// M7.50 goes out before the way to X 80. Confirmed at X 60, the way is given up within its ramp, the measured positions are
/// written, and the program goes on at N50.
#[test]
fn a_confirmed_branch_gives_the_way_up() {
    let mut rig = Rig::on(EXAMPLE);
    let branch = Function::Branch { m: 7, target: 50 };
    let x = |x| Line::to(&[(Axis::X, x)], 3000.0);
    let lines = [
        x(40.0),
        x(80.0).says(branch, At::Start, Synchronisation::MvsSvs),
        x(90.0),
        x(95.0),
        Line::to(&[(Axis::Y, 10.0)], 3000.0),
    ];
    let mut other = rig.clone();
    rig.start(1, &lines);
    rig.until(|rig| rig.exact("P12151") > 60.0);
    rig.plc("P8706", "1");
    rig.until_end(1);
    // 50 mm/s brake on 3.1 mm.
    let stopped = rig.read("P12151");
    assert!((63.1..=63.6).contains(&stopped), "{stopped}");
    assert_eq!((rig.read("P12351"), rig.read("P12153")), (10.0, stopped));
    let transfer = *rig.control.transfers().next().unwrap();
    assert_eq!(
        (transfer.m, transfer.when, transfer.branch, transfer.taken),
        (7, When::Before, true, true)
    );
    assert!(transfer.ack_us.is_some());

    // Without the confirmation, which no standard answer gives, the block is executed to its end.
    other.start(1, &lines);
    other.until_end(1);
    assert_eq!((other.read("P12151"), other.read("P12351")), (95.0, 10.0));
    let transfer = *other.control.transfers().next().unwrap();
    assert_eq!(
        (transfer.branch, transfer.taken, transfer.ack_us),
        (true, false, None)
    );
}

/// A write on the path is done when the path comes there, with all its decimals; it may run a routine: P12312 positions axis 2.
#[test]
fn a_write_on_the_path_is_done_there() {
    let mut rig = Rig::on("");
    let write = |q, value| Function::Write {
        q,
        value: Some(value),
    };
    let lines = [
        Line::to(&[(Axis::X, 40.0)], 3000.0),
        Line::to(&[(Axis::X, 80.0)], 3000.0)
            .says(write(10_050, 1.23456), At::Start, Synchronisation::Mos)
            .says(write(2312, 7.5), At::Start, Synchronisation::Mos),
    ];
    rig.start(1, &lines);
    rig.until(|rig| rig.exact("P12151") > 39.0);
    assert!(rig.read("P50").is_nan());
    rig.until(|rig| rig.exact("P12151") > 41.0);
    assert_eq!(rig.read("P50"), 1.23456);
    rig.until_end(1);
    rig.until(|rig| rig.read("P12392") == 1.0);
    assert_eq!(rig.read("P12351"), 7.5);
}

/// At M6 the standard answers store the tool of the spindle, group 3, and take that of the real-time block, group 2: P8047:1,
/// then P8045:2 [002:1776-1790].
#[test]
fn the_standard_answer_changes_the_tool() {
    let tools = "q104: 30000\nq105: 1000\nq3: 40000\nq175: 20000\nq176: 4\nq178: 20\n\
        P20040: 3\nP20041: 1\nP8100: 3\nP8101: 1\nP8110: 5.5\nP8200: 2\nP8203: 1\nP8210: 8\nP8211: 50.25\nP8212: 0.5\nP8213: -1\nP8214: 9\nP8040: 1\n";
    let mut rig = Rig::on(&format!("{EXAMPLE}{tools}"));
    rig.start(1, &with(6, At::Start, Synchronisation::MvsSvs));
    rig.until_end(1);
    // The radius of the old one is in its record, that of the new one in the spindle; T is read again.
    let after = ["P20050", "P8100", "P8110", "P8040"].map(|name| rig.read(name));
    assert_eq!(after, [5.5, 2.0, 8.0, 0.0]);
    // That of the block is shown [002:4989-4996].
    let shown = ["P9080", "P9083", "P9090", "P9091", "P9092", "P9093", "P9094"].map(|name| rig.read(name));
    assert_eq!(shown, [2.0, 1.0, 8.0, 50.25, 0.5, -1.0, 9.0]);
}

/// P8690 sends an M function by hand: in HAND alone [002:3714-3715].
#[test]
fn an_m_function_goes_out_by_hand() {
    let mut rig = Rig::on(EXAMPLE);
    rig.operator("P8690", "4");
    assert_eq!(rig.control.transfers().next().map(|transfer| transfer.m), Some(4));
    rig.operator("P8683", "2");
    rig.seconds(0.05);
    rig.operator("P8690", "4");
    assert_eq!(rig.control.transfers().count(), 1);
}

/// P8813: no M function goes to the PLC, the path waits for none, and a branch that would be confirmed does not branch; by hand they
/// go out [002:4268-4273].
#[test]
fn without_m_functions_none_goes_out() {
    let mut rig = Rig::on(&format!("{EXAMPLE}P8813: 1\n"));
    rig.operator("P8690", "4");
    assert_eq!(rig.control.transfers().count(), 1);
    let x = |x| Line::to(&[(Axis::X, x)], 3000.0);
    let branch = Function::Branch { m: 7, target: 10 };
    let lines = [
        x(20.0).with(6, At::Start, Synchronisation::MvsSvs),
        x(40.0).says(branch, At::Start, Synchronisation::MvsSvs),
        x(60.0).with(4, At::Start, Synchronisation::Mos),
    ];
    rig.start(1, &lines);
    rig.until(|rig| rig.read("P12151") > 25.0);
    rig.plc("P8706", "1");
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.control.transfers().count()), (60.0, 1));
}

/// The measuring key P8716 takes the display positions where P8717 has released it, once or always; with P8855 those of the machine.
/// P8696 gets the block, P12181 says that it was taken; a new release takes both back [002:3724-3729] [002:3892-3901].
#[test]
fn the_measuring_key_takes_positions() {
    let mut rig = Rig::on("");
    rig.start(1, &[Line::to(&[(Axis::X, 200.0)], 3000.0)]);
    rig.until(|rig| rig.read("P12154") > 20.0);
    rig.plc("P8716", "1");
    assert!(rig.read("P12153").is_nan(), "it is not released");
    rig.plc("P8717", "1");
    let at = rig.read("P12154");
    rig.plc("P8716", "1");
    assert_eq!(["P12153", "P12353"].map(|name| rig.read(name)), [at, 0.0]);
    let said = ["P8696", "P8717", "P12181"].map(|name| rig.read(name));
    assert_eq!(said, [10.0, 0.0, 1.0]);
    rig.seconds(0.1);
    rig.plc("P8716", "1");
    assert_eq!(rig.read("P12153"), at, "once");
    rig.plc("P8717", "2");
    assert_eq!((rig.read("P8696"), rig.read("P12181")), (0.0, 0.0));
    rig.plc("P8855", "1");
    for _ in 0..2 {
        rig.seconds(0.1);
        rig.plc("P8716", "1");
        assert_eq!(rig.read("P12153"), rig.read("P12150"));
        assert!(rig.read("P12150") < rig.read("P12154"), "the lag");
    }
}
