//! A small machine to try single rules on: three ideal axes, a spindle, and a PLC that is all test.
#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "each test file uses a part of it; a helper that panics fails its test"
)]

use bahn_exchange::{Bit, Number};

use crate::support::{Build, Rig};

/// Axes and spindle do at once what they are told. Spare contacts for tests
/// are keys: I20 to I24.
const PLANT: &str = r#"
name = "bench"
step_us = 200
[emergency_stop]
acknowledgement = "I3"
pull_in_ms = 5
drop_out_ms = 10
[axis.X]
output = "1"
speed = 15000
volts = 9
start = 50
[axis.X.encoder]
input = "X1"
period_um = 20
mark = 52
[axis.Y]
output = "2"
speed = 15000
volts = 9
start = 50
[axis.Y.encoder]
input = "X2"
period_um = 20
mark = 52
[axis.Z]
output = "3"
speed = 12000
volts = 9
start = 50
[axis.Z.encoder]
input = "X3"
period_um = 20
mark = 52
[spindle]
output = "S"
rpm = 6000
volts = 9
at_speed = "I12"
stopped = "I13"
encoder = { input = "X6", lines = 1024, mark_deg = 90 }
[keys]
NC_START = "I10"
NC_STOP = "not I11"
RAPID = "I14"
A = "I20"
B = "I21"
C = "I22"
D = "I23"
E = "I24"
[probe]
length = 100
radius = 2
[[probe.solid]]
min = [80, 0, -50]
max = [120, 100, 0]
"#;

/// Machine parameters that differ from those of the mill.
const PARAMETERS: &[&str] = &[
    "10=%00111",
    "50=%00111",
    "30=0",
    "31=0",
    "32=0",
    "1350.0=1",
    "1350.1=1",
    "1350.2=1",
    "960.0=-52",
    "960.1=-52",
    "960.2=-52",
    "910.0=500",
    "910.1=500",
    "910.2=500",
    "920.0=-500",
    "920.1=-500",
    "920.2=-500",
    "1060.0=1",
    "1060.1=1",
    "1060.2=1",
    "7212=1",
    "4060.0=0",
    "4060.1=0",
    "4060.2=0",
];

/// Panel and complements; the test's own lines run as module TEST in every scan.
const PLC: &str = "
       L     M2719
       SN    M2719
       L     M2719
       S     M2465
       S     M2466
       S     M2472
       S     M2473
       S     M2474
       S     M2475
       S     M2476
       S     M2477
       S     M2478
       S     M2479
       S     M2540
       S     M2541
       S     M2451
       R     M2467
       L     I10
       = M2448
       L     I10
       =N M2464
       L     I11
       = M2488
       CM    TEST
       EM
LBL TEST
";

/// All functions are acknowledged in the scan that sees their strobe.
pub const ACKNOWLEDGE: &str = "
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
       L     M2149
       = M2611
";

/// All but M functions.
pub const ACKNOWLEDGE_BUT_M: &str = "
       L     M2043
       = M2480
       L     M2044
       = M2481
       L     M2046
       = M2483
       L     M2047
       = M2484
       L     M2149
       = M2611
";

/// An M function lets the PLC take Z to 80 mm from the machine datum; it is acknowledged when Z is there.
pub fn plc_moves_z() -> String {
    format!(
        "{ACKNOWLEDGE_BUT_M}
       L     M2045
       AN    M0
       = M1
       L     M2045
       = M0
       L     M1
       IFT
         L     K+800000
         = D536
         L     K+6000
         = W564
       ENDI
       L     M1
       S     M2706
       L     M2045
       AN    M2706
       = M2482
"
    )
}

/// A call of a module: what is pushed before it, and where its results go.
pub fn call(arguments: &[&str], module: u16, results: &[&str]) -> String {
    let push: String = arguments
        .iter()
        .map(|value| format!("       PS    {value}\n"))
        .collect();
    let pull: String = results
        .iter()
        .map(|operand| format!("       PL    {operand}\n"))
        .collect();
    format!("{push}       CM    {module}\n{pull}")
}

/// A bench with PLC lines of the test; modules of its own follow an `EM`.
pub fn bench(plc: &str) -> Build {
    let mut build = Build::mill();
    build.plant = PLANT.to_owned();
    build.plc = format!("{PLC}{plc}\n       EM\n");
    build.parameters = PARAMETERS.iter().map(|text| (*text).to_owned()).collect();
    build
}

/// A running bench with one program, selected in full sequence.
pub fn bench_with(plc: &str, blocks: &str) -> Rig {
    ready(bench(plc).program("1.H", blocks))
}

/// Power on, reference run, the axes stand at 50 in the display, program 1 selected in full sequence.
pub fn ready(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.power_on();
    rig.seconds(0.3);
    for axis in ["X", "Y", "Z"] {
        rig.command(&format!("datum {axis} 50"));
    }
    rig.command("mode full");
    rig.command("select 1.H");
    rig
}

/// Runs for a time; the changes of bits in the PLC's memory in their order, as `M2045+ M2482+`. Numbers are
/// shown with the edge that they come with, as `W260=3`.
pub fn edges(rig: &mut Rig, names: &str, seconds: f64) -> String {
    let end = rig.control.time_us() + (seconds * 1e6) as u64;
    let mut seen = Vec::new();
    let now = |rig: &Rig| -> Vec<i32> {
        let value = |name: &str| match name.parse::<Bit>() {
            Ok(bit) => i32::from(rig.control.exchange().plc().bit(bit)),
            Err(_) => rig
                .control
                .exchange()
                .plc()
                .number(name.parse::<Number>().unwrap()),
        };
        names.split(' ').map(value).collect()
    };
    let mut before = now(rig);
    while rig.control.time_us() < end {
        rig.cycle();
        let after = now(rig);
        for ((name, before), after) in names.split(' ').zip(&before).zip(&after) {
            if before != after {
                seen.push(match (name.parse::<Bit>(), after) {
                    (Ok(_), 0) => format!("{name}-"),
                    (Ok(_), _) => format!("{name}+"),
                    (Err(_), value) => format!("{name}={value}"),
                });
            }
        }
        before = after;
    }
    seen.join(" ")
}

/// Position of an axis in the display.
pub fn display(rig: &Rig, letter: char) -> f64 {
    let axes = rig.control.snapshot().axes;
    axes.iter().find(|axis| axis.letter == letter).unwrap().actual
}

/// Nominal position of an axis in the display.
pub fn nominal(rig: &Rig, letter: char) -> f64 {
    let axes = rig.control.snapshot().axes;
    axes.iter().find(|axis| axis.letter == letter).unwrap().nominal
}

/// Starts the selected program and waits for its end.
pub fn run(rig: &mut Rig, seconds: f64) {
    rig.start();
    rig.until(1.0, "the run begins", |rig| {
        rig.control.snapshot().run == bahn_tnc::RunState::Running
    });
    rig.until(seconds, "the run ends", |rig| rig.control.snapshot().ended);
}

pub fn near(actual: f64, expected: f64) {
    assert!((actual - expected).abs() < 0.006, "{actual} is not {expected}");
}

/// The M functions of the spindle, acknowledged at once, without the gear.
pub const SPINDLE: &str = "
       L     M1903
       S     M2485
       R     M2486
       R     M2487
       L     M1904
       S     M2486
       R     M2485
       R     M2487
       L     M1905
       S     M2487
       R     M2485
       R     M2486
       L     M2719
       S     M2496
       L     M2045
       = M2482
       L     M2044
       = M2481
       L     M2046
       = M2483
";
/// The gear is acknowledged at once.
pub const GEAR: &str = "       L     M2043\n       = M2480\n";

/// Both.
pub fn with_gear() -> String {
    format!("{SPINDLE}{GEAR}")
}

/// A bench whose spindle has the two gear ranges of the manual's diagram [000:5596-5610].
pub fn diagram(plc: &str) -> Build {
    // Gear I 1500 rpm at 6 V, gear II 3000 rpm at 8 V and 3375 rpm at most, override 50 to 125 %, at least 1 V.
    let mut build = bench(plc);
    for parameter in [
        "3510.0=1500",
        "3510.1=3000",
        "3210.0=6",
        "3210.1=8",
        "3515.0=1875",
        "3515.1=3375",
        "3310.0=125",
        "3310.1=50",
        "3240.1=1",
        "3410.0=0.1",
    ] {
        build = build.mp(parameter);
    }
    build
}
