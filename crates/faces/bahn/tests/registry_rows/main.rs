//! What the registry says of each machine parameter of a TNC 155 is what a machine shows: with the parameter changed it
//! differs from the unchanged one as the manual says, or not at all where the registry says `none`.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "what panics in a probe is the verdict of its row"
)]

mod axes;
mod bench;
mod manual;
mod mill;
mod plc;
mod program;
mod screen;
mod servo;
mod spindle;
#[path = "../../../../families/tnc/tests/support/mod.rs"]
mod support;
#[path = "../../../../families/tnc/tests/support/terminals.rs"]
mod terminals;
#[path = "../../../panel/tests/support/mod.rs"]
mod trainee;
mod transfer;

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use bahn_parameters::conformance::{Effect, Kind, find};
use bahn_parameters::{ControlModel, Definition};
use bench::{Probe, Row, Verdict};

/// All rows, by the files that show them.
const GROUPS: &[&[Row]] = &[
    axes::ROWS,
    manual::ROWS,
    plc::ROWS,
    program::ROWS,
    screen::ROWS,
    servo::ROWS,
    spindle::ROWS,
    transfer::ROWS,
    NOTHING,
];

/// Rows that no run shows: the list has them without a function [001:3368].
const NOTHING: &[Row] = &[Row(260..=262, Probe::Nothing)];

/// What the registry says of a parameter.
fn effect(number: u16) -> Option<Effect> {
    find(
        ControlModel::Tnc155,
        Kind::MachineParameter,
        &format!("MP{number}"),
    )
    .map(|entry| entry.effect)
}

/// A probe whose run comes to nothing is a verdict, too.
fn verdict(probe: fn(u16) -> Verdict, number: u16) -> Verdict {
    let said = |panic: Box<dyn std::any::Any + Send>| match panic.downcast::<String>() {
        Ok(text) => *text,
        Err(other) => other
            .downcast_ref::<&str>()
            .map_or_else(|| "it panics".to_owned(), |text| (*text).to_owned()),
    };
    let short = |text: String| text.split(" Snapshot {").next().unwrap_or_default().to_owned();
    catch_unwind(AssertUnwindSafe(|| probe(number))).unwrap_or_else(|panic| Err(short(said(panic))))
}

/// The rows that do not do what the registry says.
fn faults(rows: &[Row]) -> Vec<String> {
    let mut faults = Vec::new();
    for Row(numbers, probe) in rows {
        for number in numbers.clone() {
            let verdict = match (effect(number), probe) {
                (Some(Effect::Acts | Effect::Partly), Probe::Acts(probe)) => verdict(*probe, number),
                (Some(Effect::None), Probe::Nothing) => verdict(bench::unmoved, number),
                (said, _) => Err(format!("the registry says {said:?}, and the row otherwise")),
            };
            if let Err(why) = verdict {
                faults.push(format!("MP{number}: {why}"));
            }
        }
    }
    faults
}

/// Each parameter of the list has one row here and one in the registry.
#[test]
fn every_parameter_has_a_row() {
    let mut rows: BTreeMap<u16, usize> = BTreeMap::new();
    for number in GROUPS.iter().copied().flatten().flat_map(|row| row.0.clone()) {
        *rows.entry(number).or_default() += 1;
    }
    let missing: Vec<u16> = (0..=263).filter(|number| rows.get(number) != Some(&1)).collect();
    assert_eq!(missing, [0u16; 0]);
    assert_eq!(rows.len(), 264);
    for number in 0..=263 {
        assert!(
            Definition::find(ControlModel::Tnc155, number, 0).is_some(),
            "MP{number}"
        );
        assert!(effect(number).is_some(), "MP{number} is not in the registry");
    }
}

#[test]
fn rows_of_axes() {
    assert_eq!(faults(axes::ROWS).join("\n"), "");
}

#[test]
fn rows_of_manual() {
    assert_eq!(faults(manual::ROWS).join("\n"), "");
}

#[test]
fn rows_of_plc() {
    assert_eq!(faults(plc::ROWS).join("\n"), "");
}

#[test]
fn rows_of_program() {
    assert_eq!(faults(program::ROWS).join("\n"), "");
}

#[test]
fn rows_of_screen() {
    assert_eq!(faults(screen::ROWS).join("\n"), "");
}

#[test]
fn rows_of_servo() {
    assert_eq!(faults(servo::ROWS).join("\n"), "");
}

#[test]
fn rows_of_spindle() {
    assert_eq!(faults(spindle::ROWS).join("\n"), "");
}

#[test]
fn rows_of_transfer() {
    assert_eq!(faults(transfer::ROWS).join("\n"), "");
}

#[test]
fn rows_of_nothing() {
    assert_eq!(faults(NOTHING).join("\n"), "");
    assert!(verdict(bench::unmoved, 177).is_err(), "a kv factor is seen");
}
