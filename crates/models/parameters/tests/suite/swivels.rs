//! The machine geometry of MP7510 to MP7592: the chains of the manual [000:4303-4437].

use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::{Axis, Position};

fn list(assignments: &[&str]) -> ParameterList {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    for assignment in assignments {
        list.assign(assignment).expect(assignment);
    }
    list
}

#[test]
fn swivel_chains_of_the_manual() {
    // Example 1: what stands after the end of the chain does not count.
    let head = list(&[
        "7510=%000100",
        "7511=%00",
        "7512=200.4",
        "7520=%000010",
        "7521=%00",
        "7522=-1.9",
        "7530=%001000",
        "7531=%00",
        "7532=0",
        "7540=%000001",
        "7541=%00",
        "7542=201.5",
        "7550=%000100",
        "7551=%00",
        "7552=3.1",
        "7560=%010000",
        "7561=%00",
        "7562=0",
        "7570=%000000",
        "7580=%100000",
    ]);
    let swivels = head.swivels().expect("a head");
    assert_eq!(swivels.free_axes().collect::<Vec<_>>(), [Axis::A, Axis::B]);
    assert_eq!(head.swivel_links().len(), 6);
    // The tool datum swings about B by half a turn: twice from it to the centre of B, (201.5, -1.9, 203.5).
    let mut angles = Position::ZERO;
    angles[Axis::B] = 180.0;
    let [x, y, z] = swivels.head_offset(&angles);
    assert!(
        (x + 403.0).abs() < 1e-9 && y.abs() < 1e-9 && (z + 407.0).abs() < 1e-9,
        "{x} {y} {z}"
    );

    // Example 3 uses all nine blocks: none ends it.
    let table = list(&[
        "7510=%000001",
        "7511=%11",
        "7512=420",
        "7520=%000010",
        "7521=%11",
        "7522=151.2",
        "7530=%000100",
        "7531=%11",
        "7532=-395.4",
        "7540=%100000",
        "7541=%01",
        "7542=0",
        "7550=%000010",
        "7551=%01",
        "7552=-2.7",
        "7560=%000100",
        "7561=%01",
        "7562=-331.3",
        "7570=%001000",
        "7571=%01",
        "7572=0",
        "7580=%000100",
        "7581=%01",
        "7582=125.9",
        "7590=%010000",
        "7591=%01",
        "7592=0",
    ]);
    assert_eq!(table.swivel_links().len(), 9);
    let swivels = table.swivels().expect("a table");
    assert_eq!(
        swivels.free_axes().collect::<Vec<_>>(),
        [Axis::C, Axis::A, Axis::B]
    );
    // C+90 brings what lies 10 mm beside its centre in +Y to +X: the table turns against the sense of the tool.
    let mut angles = Position::ZERO;
    angles[Axis::C] = 90.0;
    let [x, y, z] = swivels.on_table([420.0, 161.2, 0.0], &angles);
    assert!(
        (x - 430.0).abs() < 1e-9 && (y - 151.2).abs() < 1e-9 && z == 0.0,
        "{x} {y} {z}"
    );
}

#[test]
fn machines_without_swivel_axes() {
    assert!(list(&[]).swivels().is_none());
    // Shifts alone turn nothing; the TNC 407 and the 360 have no such parameters.
    assert!(list(&["7510=%000100", "7512=200"]).swivels().is_none());
    for model in [ControlModel::Tnc407, ControlModel::Tnc360, ControlModel::Tnc155] {
        assert!(ParameterList::reference(model).swivels().is_none());
    }
}
