//! What PLC and operating modes get from the list.

use bahn_parameters::operation::{
    Handwheel, OverrideSteps, Station, ToolOutput, ToolOutputKind, UserParameter, UserText,
};
use bahn_parameters::plc::MonitoringInput;
use bahn_parameters::{ControlModel, ListText, ParameterId, ParameterList};
use bahn_path::Direction;

/// The reference list of a model with other values.
fn with(model: ControlModel, assignments: &[&str]) -> ParameterList {
    let mut list = ParameterList::reference(model);
    for assignment in assignments {
        list.assign(assignment).unwrap();
    }
    list
}

#[test]
fn the_plc_gets_its_presets_and_numbers() {
    let plc = with(
        ControlModel::Tnc415b,
        &[
            "4010=1",
            "4110.0=100",
            "4110.47=7",
            "4120.31=9",
            "4210.1=12.5",
            "4220.2=700",
            "4310.6=$8001",
            "4130=130",
            "4131=1",
            "4410=%10",
        ],
    )
    .plc_parameters();
    assert!(!plc.from_eprom);
    assert_eq!((plc.timers[0], plc.timers[47], plc.counters[31]), (100, 7, 9));
    assert_eq!(
        (plc.positions_mm[1], plc.feeds_mm_min[2], plc.words[6]),
        (12.5, 700.0, 0x8001)
    );
    assert_eq!(
        plc.monitoring_input,
        Some(MonitoringInput {
            input: 130,
            active_high: true
        })
    );
    assert_eq!((plc.analogue_inputs, plc.strobes), ([false, true], None));
}

#[test]
fn the_old_plc_has_fewer_of_them() {
    let plc = with(
        ControlModel::Tnc155,
        &[
            "77=1", "110=3", "125=4", "193=5", "208=6", "94=7", "109=8", "126=1.5", "156=-2", "163=90",
            "158=1", "250=2", "120=2", "121=7", "122=9",
        ],
    )
    .plc_parameters();
    assert!(plc.from_eprom);
    assert_eq!(
        [0, 15, 16, 31, 32].map(|timer| plc.timers[timer]),
        [3, 4, 5, 6, 0]
    );
    assert_eq!([0, 15, 16].map(|counter| plc.counters[counter]), [7, 8, 0]);
    assert_eq!(
        [0, 30, 31].map(|position| plc.positions_mm[position]),
        [1.5, -2.0, 0.0]
    );
    assert_eq!((plc.feeds_mm_min[0], plc.words[0], plc.words[2]), (90.0, 1, 2));
    // Strobe on after 40 ms, off after 140 ms, acknowledgement looked at after 180 ms.
    let strobes = plc.strobes.unwrap();
    assert!((strobes.on_s - 0.04).abs() < 1e-12 && (strobes.off_s - 0.14).abs() < 1e-12);
    assert!((strobes.test_s - 0.18).abs() < 1e-12);
}

#[test]
fn overrides_step_as_the_model_can() {
    let steps = |model, assignment: &str| {
        let overrides = with(model, &[assignment]).operation_parameters().overrides;
        (overrides.feed_steps, overrides.spindle_steps)
    };
    use OverrideSteps::{NonLinear, OnePercent, TwoPercent};
    assert_eq!(
        steps(ControlModel::Tnc415b, "7620=%0000"),
        (OnePercent, OnePercent)
    );
    assert_eq!(steps(ControlModel::Tnc415b, "7620=%1000"), (NonLinear, NonLinear));
    assert_eq!(steps(ControlModel::Tnc360, "7620=5"), (TwoPercent, TwoPercent));
    assert_eq!(steps(ControlModel::Tnc155, "74=2"), (OnePercent, TwoPercent));
    assert_eq!(steps(ControlModel::Tnc155, "74=8"), (TwoPercent, OnePercent));
    let overrides = with(ControlModel::Tnc407, &["7620=%0100"])
        .operation_parameters()
        .overrides;
    assert!(!overrides.on_rapid_key && overrides.on_manual_rapid);
}

#[test]
fn tools_are_put_out_as_mp7480_says() {
    let output = |value: f64| {
        let mut list = ParameterList::reference(ControlModel::Tnc425);
        list.set(7480, 0, value).unwrap();
        list.operation_parameters().tools.call
    };
    use ToolOutputKind::{FixedPocket, None, Pocket, Tool};
    let table = [
        (None, false),
        (Tool, false),
        (Tool, true),
        (Pocket, false),
        (Pocket, true),
        (FixedPocket, false),
        (FixedPocket, true),
    ];
    for (value, (what, always)) in (0u8..).zip(table) {
        assert_eq!(
            output(value.into()),
            ToolOutput { what, always },
            "MP7480.0 = {value}"
        );
    }
    let tools = with(ControlModel::Tnc155, &["225=40", "61=3", "157=1"])
        .operation_parameters()
        .tools;
    assert_eq!((tools.table_size, tools.pockets), (40, 40));
    assert_eq!((tools.call.what, tools.definition.what), (Pocket, Tool));
}

#[test]
fn switch_on_restart_and_datums() {
    let operation = with(
        ControlModel::Tnc415b,
        &[
            "7212=1",
            "7690=%10",
            "7680=%0100110",
            "7490=1",
            "7475=1",
            "7500=1",
            "7210=2",
        ],
    )
    .operation_parameters();
    assert_eq!(operation.station, Station::WithoutPlc);
    assert!(!operation.power_interrupted && operation.ram_test && !operation.eprom_test);
    let restart = operation.restart;
    assert!(restart.return_to_contour && restart.block_scan && restart.from_start && operation.tilting);
    assert!(!restart.passes_stops && !restart.ignores_dwell && !operation.keys_latched);
    assert!(
        operation.datums.ranges == 3
            && operation.datums.datum_for_each_range
            && operation.datums.table_from_machine
    );
    let old = with(ControlModel::Tnc151, &["92=6", "68=1", "167=1"]).operation_parameters();
    assert!(old.english && !old.ram_test && old.eprom_test && old.keys_latched && old.manual_feed_shown);
    assert!(old.power_interrupted && !old.restart.block_scan && old.datums.ranges == 1);
}

#[test]
fn handwheels() {
    let handwheel = |model, assignments: &[&str]| with(model, assignments).operation_parameters().handwheel;
    let hr410 = handwheel(
        ControlModel::Tnc415b,
        &["7640=6", "7650=1", "7660=4", "7670.2=3", "7671.0=25"],
    );
    assert_eq!(
        (hr410.kind, hr410.direction, hr410.threshold),
        (Handwheel::Hr410, Direction::Plus, 4)
    );
    assert_eq!((hr410.factor_min, hr410.jog_percent[0]), ([0, 0, 3], 25.0));
    assert_eq!(
        handwheel(ControlModel::Tnc155, &["171=1", "247=9"]).kind,
        Handwheel::He310
    );
    assert_eq!(handwheel(ControlModel::Tnc155, &["171=2"]).kind, Handwheel::Hr130);
}

#[test]
fn user_parameters_have_a_two_digit_index() {
    // MP5030.1 is entered as 5030.01 [000:6911-6919].
    let list = with(
        ControlModel::Tnc407,
        &["7330.0=5030.01", "7340.0=17", "7330.1=7280", "7330.2=0"],
    );
    let found: Vec<_> = list
        .user_parameters()
        .iter()
        .map(|user| (user.id.to_string(), user.text))
        .collect();
    assert_eq!(
        found,
        [
            ("MP5030.1".to_owned(), UserText::Dialogue(17)),
            ("MP7280".to_owned(), UserText::Dialogue(0))
        ]
    );
}

/// The letter P behind a value gives the parameter to the operator, as `MP 217 0 P` on the screen; they are listed in
/// ascending order, with the texts of PLC: ERROR 99, 98 and so on [001:1299-1334].
#[test]
fn the_letter_p_gives_a_parameter_to_the_operator() {
    let mut list = ParameterList::reference(ControlModel::Tnc155);
    let text = b"MP217 : 0 P ; dialogue or ISO\nMP 54 0.5 P\nMP92 : 3\n";
    assert_eq!(list.read(text), []);
    let found: Vec<_> = list.user_parameters();
    let of = |number, error, place| UserParameter {
        id: ParameterId { number, index: None },
        text: UserText::PlcError { number: error, place },
    };
    assert_eq!(found, [of(54, 99, 1), of(217, 98, 2)]);
    assert_eq!((list.get(217, 0), list.get(54, 0)), (Some(0.0), Some(0.5)));
    // It stays where the list is written, and where a value is changed in its place.
    let mut again = ParameterList::smallest(ControlModel::Tnc155);
    again.read(list.to_string().as_bytes());
    assert_eq!(again, list);
    let mut file = ListText::from_bytes(ControlModel::Tnc155, text);
    file.set(of(217, 98, 2).id, 1.0).unwrap();
    assert!(file.to_bytes().starts_with(b"MP217 : 1 P ; dialogue"));
    // The later controls have MP7330 for it: there nothing may follow a value.
    let mut later = ParameterList::reference(ControlModel::Tnc407);
    assert_eq!(later.read(b"MP7280 : 0 P\n").len(), 1);
}

/// The 17th is TOO MANY USER PARAMETERS [001:1309-1313].
#[test]
fn sixteen_parameters_at_most_are_the_operator_s() {
    let lines = |count: usize| {
        (0..count)
            .map(|number| format!("MP{number} : 1000 P\n"))
            .collect::<String>()
    };
    let mut list = ParameterList::reference(ControlModel::Tnc155);
    assert_eq!(list.read(lines(12).as_bytes()), []);
    let more = (44..48)
        .map(|number| format!("MP{number} : 100 P\n"))
        .collect::<String>();
    let mut full = ParameterList::reference(ControlModel::Tnc155);
    assert_eq!(full.read((lines(12) + &more).as_bytes()), []);
    assert_eq!(full.user_parameters().len(), 16);
    let errors = full.read((lines(12) + &more + "MP48 : 100 P\n").as_bytes());
    let error = errors.first().map(ToString::to_string);
    assert_eq!(error.as_deref(), Some("line 17: MP48: TOO MANY USER PARAMETERS"));
    assert_eq!(errors[0].error.control_text(), "TOO MANY USER PARAMETERS");
    let refused = full.assign("49=-100 P").map_err(|error| error.to_string());
    assert_eq!(refused, Err("MP49: TOO MANY USER PARAMETERS".to_owned()));
    assert_eq!(full.user_parameters().len(), 16);
}

/// MP65 of a TNC 151/155: display in steps of 1 um with 0, of 5 um with 1 [001:1612-1614].
#[test]
fn the_display_step_of_a_tnc_155() {
    let step = |value: &str| {
        let list = with(ControlModel::Tnc155, &[&format!("65={value}")]);
        list.axis_parameters(0).travel.display_step_mm
    };
    assert_eq!((step("0"), step("1")), (0.001, 0.005));
}
