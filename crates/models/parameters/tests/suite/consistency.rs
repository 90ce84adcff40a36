//! Values that do not go together, each rule with an example.

use bahn_parameters::{ControlModel, ParameterList};

/// Where and what is wrong with the reference list with these values.
fn wrong(model: ControlModel, assignments: &[&str]) -> Vec<String> {
    let mut list = ParameterList::reference(model);
    for assignment in assignments {
        list.assign(assignment).unwrap();
    }
    list.inconsistencies()
        .iter()
        .map(|found| format!("{} {}", found.id, found.rule))
        .collect()
}

#[test]
fn the_reference_lists_go_together() {
    for model in ControlModel::ALL {
        assert_eq!(ParameterList::reference(model).inconsistencies(), [], "{model}");
    }
}

#[test]
fn every_rule_finds_what_breaks_it() {
    let rules: [(&[&str], &str); 17] = [
        (
            &["7110.0=0", "7110.1=0"],
            "MP7110.1 the feed override stops every tapping cycle",
        ),
        (
            &["910.1=-500"],
            "MP910.1 the axis cannot move between its software limits",
        ),
        (
            &["922.0=700"],
            "MP912.0 the axis cannot move between its software limits",
        ),
        // 15 m/min / kv 1 = 15 mm.
        (
            &["1710.0=14.9"],
            "MP1710.0 rapid traverse gives POSITIONING ERROR in lag operation",
        ),
        (
            &["1720.2=14"],
            "MP1720.2 the limit for EMERGENCY STOP is not above the cancellable one",
        ),
        (
            &["1420.4=0.4"],
            "MP1420.4 the limit for EMERGENCY STOP is not above the cancellable one",
        ),
        (&["1020.3=9000"], "MP1020.3 manual feed is above rapid traverse"),
        (
            &["1110.0=0.01"],
            "MP1110.0 standstill monitoring reacts inside the positioning window",
        ),
        (&["110.2=0"], "MP110.2 two axes have the same encoder input"),
        (
            &["120.1=3", "120.3=1", "120.4=1"],
            "MP120.4 two axes have the same nominal value output",
        ),
        (&["120.4=5"], "MP120.4 an axis has the output of the spindle"),
        (
            &["110.4=5"],
            "MP110.4 an axis has the encoder input of the spindle",
        ),
        (
            &["1810.2=1.5", "1710.2=18"],
            "MP1810.2 axes that interpolate have different kv factors",
        ),
        (&["1340.2=1"], "MP1340.0 the axis is not referenced automatically"),
        (
            &["3020=20802"],
            "MP3020 the analogue spindle needs a speed code without limits",
        ),
        (&["3510.0=40000"], "MP3510.0 the gear ranges do not ascend"),
        (
            &["7150=0.02"],
            "MP7150 the window of rigid tapping is wider than the positioning window",
        ),
    ];
    for (assignments, expected) in rules {
        let found = wrong(ControlModel::Tnc415b, assignments);
        assert!(
            found.iter().any(|text| text == expected),
            "{assignments:?}: {found:?}"
        );
    }
    assert_eq!(
        wrong(ControlModel::Tnc407, &["1220=10", "1080.0=100"]),
        ["MP1080.0 integral factor and automatic offset adjustment are both active"]
    );
    assert_eq!(wrong(ControlModel::Tnc425, &["3310.0=50", "3310.1=60"]).len(), 1);
}

/// The 4th axis, V, is the slave of X; each rule of the manual is broken once [000:4465] [000:4492-4539].
#[test]
fn masters_and_slaves_go_together() {
    let pair = ["410.3=4", "850.3=1", "860.3=0", "1340.3=0", "1900=0"];
    let found = |model, assignments: &[&str]| wrong(model, &[&pair, assignments].concat());
    let model = ControlModel::Tnc425;
    assert_eq!(found(model, &[]), [""; 0], "no mark is needed");
    for (assignments, expected) in [
        (
            &["860.3=1"][..],
            "MP1340.0 the axis is not referenced automatically",
        ),
        (
            &["850.1=1", "850.2=1"],
            "MP850.3 more than two pairs of axes are synchronized",
        ),
        (
            &["850.3=4"],
            "MP850.3 the axis follows one that does not exist, or itself",
        ),
        (
            &["850.0=2"],
            "MP850.3 an axis is master and slave at the same time",
        ),
        (&["410.3=2"], "MP850.3 master and slave are to be linear axes"),
        (
            &["1810.3=0.7"],
            "MP1810.3 master and slave have different kv factors",
        ),
        (
            &["1900=%00001"],
            "MP1900 one of master and slave has a digital speed controller",
        ),
        (
            &["860.3=1", "1350.0=3", "1350.3=1"],
            "MP1350.3 master and slave look for their reference marks in different ways",
        ),
        (
            &["860.3=1", "1340.0=4", "1340.1=1", "1340.2=2", "1340.3=3"],
            "MP1340.0 the slave comes before its master in the reference run",
        ),
    ] {
        let found = found(model, assignments);
        assert!(
            found.iter().any(|text| text == expected),
            "{assignments:?}: {found:?}"
        );
    }
}

/// What no machine can be: axes in a circle, or after one that does not exist (MP850) [000:4467-4486]
/// [000:4519-4539], and two axes of one letter (MP410) [000:3350-3370].
#[test]
fn what_no_machine_can_be() {
    let impossible = |assignments: &[&str]| -> Vec<String> {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        for assignment in assignments {
            list.assign(assignment).unwrap();
        }
        let found = list
            .inconsistencies()
            .into_iter()
            .filter(|found| found.impossible);
        found
            .map(|found| format!("{} {}", found.id, found.detail))
            .collect()
    };
    let five = "10=%11111";
    let slave = ["410.3=4", "410.4=5", "850.3=1"];
    assert_eq!(impossible(&[&[five], &slave[..]].concat()), [""; 0]);
    assert_eq!(impossible(&["850.1=2"]), ["MP850.1 axis 2 follows axis 2"]);
    assert_eq!(
        impossible(&["850.0=2", "850.1=1"]),
        ["MP850.0 master is axis 2", "MP850.1 master is axis 1"]
    );
    assert_eq!(
        impossible(&["10=%00111", "850.1=5"]),
        ["MP850.1 axis 2 follows axis 5"]
    );
    assert_eq!(
        impossible(&[five, "410.3=2", "410.4=2"]),
        ["MP410.4 axes 4 and 5 are C"]
    );
    assert_eq!(impossible(&["10=%01111", "410.3=2", "410.4=2"]), [""; 0]);
    // What is only doubtful is none of these.
    assert_eq!(impossible(&["1720.2=14"]), [""; 0]);
}

#[test]
fn the_kink_counts_in_the_lag() {
    // v/kv * (0.5 + 0.5/0.25) = 15 * 2.5 = 37.5 mm [000:4907].
    let kink = ["1820.0=0.25", "1830.0=50", "1710.0=37", "1720.0=45"];
    assert_eq!(wrong(ControlModel::Tnc415b, &kink).len(), 1);
    let kink = ["1820.0=0.25", "1830.0=50", "1710.0=38", "1720.0=45"];
    assert!(wrong(ControlModel::Tnc415b, &kink).is_empty());
}

#[test]
fn the_old_list_is_named_by_its_numbers() {
    assert_eq!(
        wrong(ControlModel::Tnc155, &["47=450"]),
        ["MP46 the axis cannot move between its software limits"]
    );
    // Without a factor the square-root characteristic has no loop [001:1746-1762].
    assert_eq!(
        wrong(ControlModel::Tnc155, &["33=0"]),
        ["MP33 pre-control needs a kv factor of 0.1 at least"]
    );
    assert!(
        wrong(ControlModel::Tnc155, &["33=0", "60=1"]).is_empty(),
        "lag operation"
    );
    assert!(wrong(ControlModel::Tnc155, &["175=9"])[0].starts_with("MP175 rapid traverse"));
}

#[test]
fn a_programming_station_has_no_machine() {
    for model in ControlModel::ALL {
        assert_eq!(ParameterList::smallest(model).inconsistencies(), [], "{model}");
    }
}

/// MP121 must be below MP122: the strobe is off before E17 is looked at. Equal is not below [001:548-552].
#[test]
fn the_strobe_ends_before_its_acknowledgement_is_looked_at() {
    let rule = "MP121 the strobe is not off before E17 is looked at";
    for (off, test, expected) in [(7, 9, &[][..]), (8, 9, &[]), (9, 9, &[rule]), (10, 9, &[rule])] {
        let assignments = [format!("121={off}"), format!("122={test}")];
        let assignments: Vec<&str> = assignments.iter().map(String::as_str).collect();
        for model in [ControlModel::Tnc151, ControlModel::Tnc155] {
            assert_eq!(wrong(model, &assignments), expected, "{model}: {assignments:?}");
        }
    }
}
