//! The parameters of axes and spindle as servo and control see them, for every model.

use bahn_parameters::spindle::{GearSignal, SpindleOutput};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::{Axis, Direction};
use bahn_servo::settings::MarkKind;

/// The reference list of a model with other values.
fn with(model: ControlModel, assignments: &[&str]) -> ParameterList {
    let mut list = ParameterList::reference(model);
    for assignment in assignments {
        list.assign(assignment).unwrap();
    }
    list
}

#[test]
fn every_axis_of_every_model_can_be_controlled() {
    for model in ControlModel::ALL {
        let list = ParameterList::reference(model);
        for index in 0..5 {
            let axis = list.axis_parameters(index);
            // The machines of the reference lists have all their axes one after the other.
            let exists = usize::from(index) < list.axes().len();
            let on_model = index < model.limits().axes_max;
            assert_eq!(
                (axis.active, axis.controlled),
                (exists, exists),
                "{model} {index}"
            );
            assert_eq!(axis.letter.is_some(), on_model, "{model} {index}");
            assert!(
                axis.lag.kv >= 0.1 && axis.precontrol.kv >= 0.1,
                "{model} {index}: {axis:?}"
            );
            assert!(axis.output.rapid_volts >= 1.0, "{model} {index}");
            assert!(axis.encoder.signal_period_um >= 0.1, "{model} {index}");
            assert!(axis.monitoring.window_mm > 0.0, "{model} {index}");
            assert!(axis.digital.is_none() || model.family() == ControlModel::Tnc425);
        }
    }
}

#[test]
fn bits_belong_to_their_axis() {
    let list = with(
        ControlModel::Tnc415b,
        &[
            "MP10=%10111",
            "MP50=%00011",
            "MP210=%00100",
            "MP1040=%00010",
            "MP1320=%10000",
            "MP1391=%00001",
        ],
    );
    let axis = |index| list.axis_parameters(index);
    assert_eq!(
        [0, 1, 2, 3, 4].map(|i| axis(i).active),
        [true, true, true, false, true]
    );
    assert_eq!(
        [0, 1, 2, 3, 4].map(|i| axis(i).controlled),
        [true, true, false, false, false]
    );
    assert_eq!(
        [0, 1, 2].map(|i| axis(i).encoder.counts_negative),
        [false, false, true]
    );
    assert_eq!(
        [0, 1, 2].map(|i| axis(i).output.polarity_negative),
        [false, true, false]
    );
    assert_eq!([0, 4].map(|i| axis(i).reference.direction), Direction::BOTH);
    assert_eq!([0, 1].map(|i| axis(i).precontrol_in_manual), [true, false]);
}

#[test]
fn the_old_list_answers_under_its_own_numbers() {
    // The 2nd axis, Y, has the second of four consecutive numbers.
    let list = with(
        ControlModel::Tnc155,
        &[
            "1=9000", "5=1500", "9=900", "13=2", "17=1", "21=1", "25=1", "29=100", "37=0.02", "41=-0.1",
            "46=400", "47=-10", "52=8", "54=0.8", "58=0.02", "192=0.03", "90=1", "178=1.5", "174=9", "175=8",
            "176=0.5", "181=60", "243=500", "187=12", "160=1000", "59=12", "72=8", "76=5", "252=50",
        ],
    );
    let y = list.axis_parameters(1);
    assert_eq!(
        (
            y.motion.rapid_mm_min,
            y.motion.manual_mm_min,
            y.motion.acceleration_m_s2
        ),
        (9000.0, 1500.0, 0.8)
    );
    assert_eq!(
        (y.reference.feed_mm_min, y.reference.direction),
        (900.0, Direction::Minus)
    );
    assert_eq!(
        (y.reference.kind, y.reference.mark_spacing_mm),
        (MarkKind::DistanceCodedBesideCam, 10.0)
    );
    assert_eq!(
        (y.encoder.signal_period_um, y.encoder.counts_negative),
        (10.0, true)
    );
    assert_eq!(
        (
            y.output.polarity_negative,
            y.output.rapid_volts,
            y.output.integral_factor
        ),
        (true, 8.0, 100.0)
    );
    assert_eq!(y.offset_interval_s, 1.0, "50 times 20 ms");
    assert_eq!(
        (y.compensation.backlash_mm, y.compensation.linear_mm_m),
        (0.02, -0.1)
    );
    assert_eq!(y.travel.ranges_mm, [[-10.0, 400.0]; 3]);
    assert_eq!((y.travel.m92_mm, y.travel.lubrication_mm), (12.0, Some(65_536.0)));
    // 100 m are 100 000 / 65.536 = 1525.88 units: 1526 [000:3571].
    let entry = (100_000.0f64 / 65.536).round();
    let x = with(ControlModel::Tnc415b, &["4060.0=1526"]).axis_parameters(0);
    assert_eq!(x.travel.lubrication_mm, Some(entry * 65.536));
    assert_eq!(
        (y.lag.kv, y.lag.kink_factor, y.lag.kink_percent),
        (1.5, 0.5, 60.0)
    );
    assert_eq!((y.lag.monitoring_mm, y.lag.emergency_mm), (8.0, 9.0));
    assert_eq!(y.monitoring.window_mm, 0.02);
    // MP76: bit 0 shows inhibited axes, bit 2 is Y's supervision off.
    assert!(!y.encoder.check_amplitude && list.axis_parameters(0).encoder.check_amplitude);
    // MP72 = 8 inhibits IV, which MP90 = 1 calls B; it is shown all the same.
    let fourth = list.axis_parameters(3);
    assert_eq!(
        (fourth.letter, fourth.active, fourth.controlled),
        (Some(Axis::B), true, false)
    );
    assert_eq!(fourth.monitoring.window_mm, 0.03);
    // MP59 = 12: Z X Y IV.
    assert_eq!(
        [0, 1, 2, 3].map(|i| list.axis_parameters(i).reference.place),
        [Some(1), Some(2), Some(0), Some(3)]
    );
}

#[test]
fn the_factor_of_the_square_root_characteristic_is_a_kv() {
    // kv 1, rapid traverse 10 m/min: the table prints 0.36 [001:1746-1762]; 3.6864 / 10 = 0.3686.
    let list = with(ControlModel::Tnc155, &["0=10000", "32=0.369", "52=9"]);
    assert!((list.axis_parameters(0).precontrol.kv - 1.0).abs() < 0.002);
    // Half the voltage at rapid traverse: a step is worth twice the speed.
    let list = with(ControlModel::Tnc155, &["0=10000", "32=0.369", "52=4.5"]);
    assert!((list.axis_parameters(0).precontrol.kv - 2.0).abs() < 0.004);
}

#[test]
fn three_traverse_ranges_and_the_sequence_of_the_reference_run() {
    let list = with(
        ControlModel::Tnc407,
        &[
            "910.1=300",
            "920.1=-300",
            "911.1=200",
            "921.1=-200",
            "912.1=100",
            "922.1=-100",
            "1340.0=3",
            "1340.1=0",
            "1340.2=2",
            "1340.3=0",
            "1340.4=0",
        ],
    );
    let ranges = list.axis_parameters(1).travel.ranges_mm;
    assert_eq!(ranges, [[-300.0, 300.0], [-200.0, 200.0], [-100.0, 100.0]]);
    // Z first, then Y; X and the rest are not named.
    let place = |index| list.axis_parameters(index).reference.place;
    assert_eq!([0, 1, 2].map(place), [None, Some(1), Some(0)]);
}

#[test]
fn what_only_some_axes_and_models_have() {
    let list = with(
        ControlModel::Tnc425,
        &[
            "1900=%00001",
            "1920.0=80",
            "420.3=1",
            "430.3=2.5",
            "850.1=1",
            "855.1=0.1",
            "7450=%00100",
            "951.2=50",
        ],
    );
    assert_eq!(list.axis_parameters(0).digital.unwrap().integral, 80.0);
    assert_eq!(list.axis_parameters(1).digital, None);
    assert_eq!(
        [3, 4].map(|i| list.axis_parameters(i).travel.hirth_deg),
        [Some(2.5), None]
    );
    let y = list.axis_parameters(1).synchronization;
    assert_eq!((y.master, y.coupling.difference_mm), (Some(0), Some(0.1)));
    assert_eq!(
        [1, 2].map(|i| list.axis_parameters(i).travel.tool_change_mm),
        [None, Some(50.0)]
    );
}

#[test]
fn the_spindle_of_every_model_turns() {
    for model in ControlModel::ALL {
        let spindle = ParameterList::reference(model).spindle_parameters();
        assert_eq!(
            spindle.output,
            SpindleOutput::Analogue {
                gear: GearSignal::OnChange
            },
            "{model}"
        );
        assert!(
            spindle.settings.gears[0].rated_rpm > 0.0 && spindle.settings.gears[0].rated_volts > 0.0,
            "{model}"
        );
        assert!(spindle.settings.ramps.normal_v_ms > 0.0, "{model}");
        assert!(
            spindle
                .settings
                .gears
                .iter()
                .all(|gear| gear.max_rpm >= gear.rated_rpm),
            "{model}"
        );
    }
}

#[test]
fn a_window_of_the_spindle_is_counted_in_increments() {
    // 10 increments of 360/4096 degree: 0.8789 degrees [000:5901-5907].
    let list = with(ControlModel::Tnc415b, &["3420=10"]);
    assert!((list.spindle_parameters().settings.orientation.window_deg - 0.878_906_25).abs() < 1e-12);
}

#[test]
fn rotary_axes_count_to_their_modulo_value() {
    let modulo = |model, assignment: &str| {
        let list = with(model, &[assignment]);
        [0, 3].map(|index| list.axis_parameters(index).travel.modulo.map(|modulo| modulo.deg))
    };
    assert_eq!(modulo(ControlModel::Tnc415b, "810.3=720"), [None, Some(720.0)]);
    assert_eq!(modulo(ControlModel::Tnc415b, "810.3=0"), [None, None]);
    // The axis counts to the modulo value as C, not as U.
    assert_eq!(modulo(ControlModel::Tnc415b, "410.3=3"), [None, None]);
    // 359.999 degrees to both sides of 0, or 30 000 [003:7424-7430].
    assert_eq!(modulo(ControlModel::Tnc360, "7470=0"), [None, Some(360.0)]);
    assert_eq!(modulo(ControlModel::Tnc360, "7470=1"), [None, None]);
    assert_eq!(modulo(ControlModel::Tnc155, "90=2"), [None, None]);
}

/// A TNC 360 displays up to ±359.999 degrees [003:7424-7430], a TNC 415 from 0 up to its modulo value [000:6470-6478].
#[test]
fn positions_within_the_modulo_value() {
    let shown = |model, assignment: &str| {
        let modulo = with(model, &[assignment])
            .axis_parameters(3)
            .travel
            .modulo
            .unwrap();
        [-370.0, -10.0, 350.0, 370.0].map(|position| (modulo.shown(position), modulo.turns(position)))
    };
    let signed = [(-10.0, -1.0), (-10.0, 0.0), (350.0, 0.0), (10.0, 1.0)];
    assert_eq!(shown(ControlModel::Tnc360, "7470=0"), signed);
    let positive = [(350.0, -2.0), (350.0, -1.0), (350.0, 0.0), (10.0, 1.0)];
    assert_eq!(shown(ControlModel::Tnc415b, "810.3=360"), positive);
}

#[test]
fn display_steps_of_the_models() {
    let step = |model, assignment: &str| {
        with(model, &[assignment])
            .axis_parameters(1)
            .travel
            .display_step_mm
    };
    // 0.1, 0.05, 0.01, 0.005, 0.001, 0.0005, 0.0001 mm; the last two not on the TNC 407 [000:6436-6457].
    assert_eq!(step(ControlModel::Tnc415b, "7290.1=6"), 0.0001);
    assert_eq!(step(ControlModel::Tnc407, "7290.1=4"), 0.001);
    let mut list = ParameterList::reference(ControlModel::Tnc407);
    assert!(list.assign("7290.1=5").is_err() && list.assign("7290.1=6").is_err());
    assert_eq!(step(ControlModel::Tnc407, "7290.1=1"), 0.05);
    assert_eq!(step(ControlModel::Tnc360, "7290=1"), 0.005);
    assert_eq!(step(ControlModel::Tnc155, "65=0"), 0.001);
}

/// A TNC 151 R counts the square waves of an EXE that divides the 20 µm of a scale by 5: four steps of 1 µm to each signal
/// period, as 20 steps to a period of the scale on the others [001:175-177] [001:416-444].
#[test]
fn versions_r_count_the_square_waves_of_an_exe() {
    for (model, square, period_um) in [
        (ControlModel::Tnc151b, false, 20.0),
        (ControlModel::Tnc151br, true, 20.0 / 5.0),
        (ControlModel::Tnc155wr, true, 20.0 / 5.0),
    ] {
        let encoder = ParameterList::reference(model).axis_parameters(0).encoder;
        assert_eq!(
            (encoder.square_wave, encoder.signal_period_um),
            (square, period_um),
            "{model}"
        );
    }
}
