//! A small mill with a TNC 155, wired as its manual says: cams and pulse inhibit at E0 to E7, EMERGENCY STOP at E8, direction
//! buttons at E9 to E16, feed release at E18, rapid, start and stop at E21 to E23 [001:941-949] [001:1005-1013].
//!
//! X, Y and Z travel 0 to 200 mm with one reference mark at 150 mm; each end cam is closed from 140 mm to the end of the
//! travel, past any limit switch, and the axis stands at 50 mm. Free inputs are forced with `fault input I30 1`.

use bahn_parameters::ControlModel;
use bahn_tnc::Mode;

use super::bench::{ACKNOWLEDGE, axis_keys, three_axes};
use super::{Build, Rig};

const PLANT: &str = r#"
name = "knee"
seed = 1
step_us = 200

[emergency_stop]
acknowledgement = "I8"
pull_in_ms = 10
drop_out_ms = 50

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
";

/// No keys of a fifth axis; cams and pulse inhibit.
const CAMS: &str = "
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
";

/// The mill, whose PLC program goes on with these instructions.
pub fn knee(instructions: &str) -> Build {
    let plant = format!("{PLANT}{}", three_axes(140, 150));
    let keys = axis_keys([9, 10, 11, 12, 13, 14, 15, 16]);
    let plc = format!("{PLC}{keys}{CAMS}{ACKNOWLEDGE}{instructions}\n       EM\n");
    Build {
        list: Some(PARAMETERS.to_owned()),
        ..Build::new(ControlModel::Tnc155, plant, plc)
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
