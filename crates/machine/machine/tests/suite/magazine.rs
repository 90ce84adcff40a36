//! The tool magazine: chain, shuttle and arm, and what goes wrong with them.

use crate::common::{BASE, IDEAL_X, input, milliseconds, outputs, running};
use bahn_machine::Machine;

/// Every movement takes 100 ms, a pocket 50 ms. Outputs: 8 clamp opens, 9 shuttle, 10 grip, 11 draw, 12 turn, 13 chain forward,
/// 14 backward.
const MAGAZINE: &str = r#"
[device.tool_clamp]
output = "O8"
forth_ms = 100
back_ms = 100
[device.shuttle]
output = "O9"
forth_ms = 100
back_ms = 100
input_second = "I70"
[device.arm_grip]
output = "O10"
forth_ms = 100
back_ms = 100
[device.arm_draw]
output = "O11"
forth_ms = 100
back_ms = 100
input_first = "I73"
input_second = "I74"
[device.arm_turn]
output = "O12"
forth_ms = 100
back_ms = 100
[magazine]
pockets = 5
pocket_ms = 50
forward = "O13"
backward = "O14"
in_position = "I64"
code_1 = "I65"
code_2 = "I66"
code_4 = "I67"
shuttle_full = "I77"
spindle_full = "I78"
"#;

fn magazine() -> Machine {
    let mut machine = running(&format!("{BASE}{IDEAL_X}{MAGAZINE}"));
    machine.load_magazine([(1, 11), (2, 12), (5, 15)].into_iter(), 12);
    machine
}

/// Outputs are on for some time.
fn with(machine: &mut Machine, on: &[usize], ms: u32) {
    outputs(machine, on);
    milliseconds(machine, ms);
}

fn pocket(machine: &mut Machine) -> Option<u32> {
    input(machine, 64).then(|| {
        let bits = [65, 66, 67].map(|number| u32::from(input(machine, number)));
        bits[0] + 2 * bits[1] + 4 * bits[2]
    })
}

/// The chain is a ring, its contacts say which pocket stands at the change position, an index pin draws it there.
#[test]
fn the_chain_turns() {
    let mut machine = magazine();
    assert_eq!(pocket(&mut machine), Some(1));
    with(&mut machine, &[14], 25);
    assert_eq!(pocket(&mut machine), None, "half way");
    with(&mut machine, &[14], 20);
    assert_eq!(pocket(&mut machine), Some(5), "backward from 1");
    with(&mut machine, &[], 20);
    with(&mut machine, &[13], 100);
    assert_eq!(pocket(&mut machine), Some(2));
    machine.apply("fault device magazine jammed").unwrap();
    with(&mut machine, &[13], 500);
    assert_eq!(pocket(&mut machine), Some(2));
    machine.apply("fault device magazine no-feedback").unwrap();
    with(&mut machine, &[13], 50);
    assert_eq!(pocket(&mut machine), None);
    machine.apply("repair magazine").unwrap();
    assert_eq!(pocket(&mut machine), Some(3));
}

/// Tool 12 is in the spindle: its pocket is empty. Shuttle, grip, clamp, draw, turn, push: tools 11 and 12 have changed.
#[test]
fn the_arm_exchanges_two_tools() {
    let mut machine = magazine();
    let state = machine.magazine().unwrap();
    assert_eq!((state.pockets, state.spindle), (&[11, 0, 0, 0, 15][..], 12));
    assert!(input(&mut machine, 78) && !input(&mut machine, 77));
    for on in [&[9][..], &[9, 10], &[8, 9, 10], &[8, 9, 10, 11]] {
        with(&mut machine, on, 110);
    }
    assert_eq!(machine.magazine().unwrap().arm, [11, 12]);
    assert!(!input(&mut machine, 78) && !input(&mut machine, 77));
    with(&mut machine, &[8, 9, 10, 11, 12], 110);
    assert_eq!(machine.magazine().unwrap().arm, [12, 11]);
    for on in [&[8, 9, 10, 12][..], &[9, 10, 12], &[9, 12]] {
        with(&mut machine, on, 110);
    }
    let state = machine.magazine().unwrap();
    assert_eq!((state.shuttle, state.spindle), (12, 11));
    // The chain turns below the shuttle that is away; tool 12 goes to pocket 2.
    with(&mut machine, &[9, 12, 13], 50);
    with(&mut machine, &[12], 110);
    assert_eq!(machine.magazine().unwrap().pockets, [0, 12, 0, 0, 15]);
}

/// A tool in a closed clamp holds the arm until that opens; one that meets another tool jams the shuttle.
#[test]
fn tools_that_are_in_the_way() {
    let mut machine = magazine();
    for on in [&[9][..], &[9, 10], &[9, 10, 11]] {
        with(&mut machine, on, 110);
    }
    assert!(
        !input(&mut machine, 74) && input(&mut machine, 73),
        "held where it is"
    );
    assert_eq!(machine.magazine().unwrap().spindle, 12);
    with(&mut machine, &[8, 9, 10, 11], 220);
    assert_eq!(machine.magazine().unwrap().arm, [11, 12]);
    // Lost on the way.
    machine.apply("fault magazine lost").unwrap();
    assert_eq!(machine.magazine().unwrap().arm, [0, 0]);
    // Tool 15 of pocket 5 does not go into pocket 5 once more.
    let mut machine = magazine();
    with(&mut machine, &[9], 110);
    with(&mut machine, &[9, 14], 50);
    with(&mut machine, &[], 110);
    assert_eq!(machine.magazine().unwrap().shuttle, 11);
    assert!(input(&mut machine, 77));
    machine.apply("tool 3").unwrap();
    assert_eq!(machine.magazine().unwrap().spindle, 3);
}

#[test]
fn a_magazine_needs_its_things() {
    let text = format!("{BASE}{IDEAL_X}[magazine]\npockets = 300\n");
    let faults = Machine::from_toml(&text).err().unwrap();
    let said: Vec<&str> = faults.iter().map(|fault| fault.message.as_str()).collect();
    assert!(
        said.iter()
            .any(|text| text.contains("pockets is a number from 1 to 254")),
        "{said:?}"
    );
    assert!(
        said.iter().any(|text| text.contains("there is no `arm_draw`")),
        "{said:?}"
    );
    let mut machine = running(&format!("{BASE}{IDEAL_X}"));
    assert!(machine.magazine().is_none() && machine.apply("tool 3").is_err());
    assert!(machine.apply("fault magazine lost").is_err());
}

/// Two tools of one number in a tool probe are a fault, at the second one.
#[test]
fn a_tool_probe_has_each_tool_once() {
    let tool = "[[tool_probe.tool]]\nnumber = 3\nlength = 80\nradius = 5\n";
    let text = format!("{BASE}{IDEAL_X}[tool_probe]\ncentre = [0, 0, 0]\ndiameter = 40\n{tool}{tool}");
    let faults = Machine::from_toml(&text).err().unwrap();
    let line = text.lines().count() as u32 - 2;
    let said: Vec<(u32, &str)> = faults
        .iter()
        .map(|fault| (fault.span.line, fault.message.as_str()))
        .collect();
    assert_eq!(said, [(line, "tool 3 stands here already")]);
}
