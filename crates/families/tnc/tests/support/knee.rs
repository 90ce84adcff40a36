//! A small mill with a TNC 155, wired as its manual says: cams and pulse inhibit at E0 to E7, EMERGENCY STOP at E8, direction
//! buttons at E9 to E16, feed release at E18, rapid, start and stop at E21 to E23 [001:941-949] [001:1005-1013].
//!
//! X, Y and Z travel 0 to 200 mm with one reference mark at 150 mm; each end cam is closed from 140 mm to the end of the
//! travel, past any limit switch, and the axis stands at 50 mm. Free inputs are forced with `fault input I30 1`.

use std::collections::BTreeMap;

use bahn_parameters::ControlModel;
use bahn_tnc::{Mode, Remembered};

use super::{Build, Rig, Shelf};

const PLANT: &str = r#"
name = "knee"
seed = 1
step_us = 200

[emergency_stop]
acknowledgement = "I8"
pull_in_ms = 10
drop_out_ms = 50

[axis.X]
output = "1"
speed = 6000
volts = 9
time_constant_ms = 2
travel = [0, 200]
start = 50
reference_cam = { range = [140, 200], input = "I0" }
[axis.X.encoder]
input = "X1"
period_um = 20
mark = 150

[axis.Y]
output = "2"
speed = 6000
volts = 9
time_constant_ms = 2
travel = [0, 200]
start = 50
reference_cam = { range = [140, 200], input = "I1" }
[axis.Y.encoder]
input = "X2"
period_um = 20
mark = 150

[axis.Z]
output = "3"
speed = 6000
volts = 9
time_constant_ms = 2
travel = [0, 200]
start = 50
reference_cam = { range = [140, 200], input = "I2" }
[axis.Z.encoder]
input = "X3"
period_um = 20
mark = 150

[keys]
"X+" = "I9"
"X-" = "I10"
"Y+" = "I11"
"Y-" = "I12"
"Z+" = "I13"
"Z-" = "I14"
"IV+" = "I15"
"IV-" = "I16"
NO_FEED = "not I18"
RAPID = "I21"
NC_START = "I22"
NC_STOP = "not I23"
"#;

/// Axis IV, a rotary table with a mark at 90 degrees in each turn.
pub const TABLE: &str = r#"
[axis.C]
output = "4"
speed = 3600
volts = 9
time_constant_ms = 2
start = 10
[axis.C.encoder]
input = "X4"
period_um = 20
marks_every = 360
marks_from = 90
"#;

/// Rapid traverse 6 m/min at 9 V, kv 2, reference run with 3 m/min up; three axes, IV inhibited.
const PARAMETERS: &str = "
MP0   : 6000
MP1   : 6000
MP2   : 6000
MP3   : 3600
MP4   : 1200
MP5   : 1200
MP6   : 1200
MP7   : 1200
MP8   : 3000
MP9   : 3000
MP10  : 3000
MP11  : 3000
MP54  : 0.5
MP58  : 0.01
MP59  : 0
MP60  : 1
MP72  : 8
MP74  : 15
MP169 : 5
MP174 : 6
MP175 : 4
MP177 : 2
MP178 : 2
MP179 : 2
MP180 : 2
MP242 : 0
MP243 : 0
MP244 : 0
MP245 : 0
MP252 : 0
";

/// The PLC program: keys, cams and acknowledgements.
const PLC: &str = "
       L     M2719
       SN    M2719
       L     I22
       = M2448
       =N M2464
       L     I23
       = M2488
       L     I21
       = M2449
       =N M2465
       LN    M2719
       = M2450
       =N M2466
       L     I18
       = M2451
       =N M2467
       L     I9
       = M2456
       =N M2472
       L     I10
       = M2457
       =N M2473
       L     I11
       = M2458
       =N M2474
       L     I12
       = M2459
       =N M2475
       L     I13
       = M2460
       =N M2476
       L     I14
       = M2461
       =N M2477
       L     I15
       = M2462
       =N M2478
       L     I16
       = M2463
       =N M2479
       LN    M2719
       = M2524
       =N M2540
       = M2525
       =N M2541
       L     I0
       = M2556
       L     I1
       = M2557
       L     I2
       = M2558
       L     I3
       = M2559
       L     I4
       = M2616
       L     I5
       = M2617
       L     I6
       = M2618
       L     I7
       = M2619
       L     M2045
       = M2482
       L     M2043
       = M2480
       L     M2044
       = M2481
       L     M2046
       = M2483
       L     M2047
       = M2484
       L     M2180
       S     M2487
";

/// The mill, whose PLC program goes on with these instructions.
pub fn knee(instructions: &str) -> Build {
    Build {
        model: ControlModel::Tnc155,
        plant: PLANT.to_owned(),
        parameters: Vec::new(),
        plc: format!("{PLC}{instructions}\n       EM\n"),
        list: Some(PARAMETERS.to_owned()),
        programs: Shelf::default(),
        tools: Some(BTreeMap::new()),
        remembered: Remembered::default(),
        files: bahn_tnc::NcFiles::default(),
        functions: Default::default(),
    }
}

/// Power-on until the control asks for the reference run.
pub fn asked(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.command("ce");
    rig.until(10.0, "the reference run is asked for", |rig| {
        rig.control.snapshot().mode == Mode::Reference
    });
    rig.scan();
    rig
}

/// NC start until the reference run is over.
pub fn reference(rig: &mut Rig) {
    rig.start();
    rig.until(60.0, "the reference run ends", |rig| {
        rig.control.snapshot().mode == Mode::Manual
    });
    rig.settle();
}
