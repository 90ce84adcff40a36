//! A spindle with two gears, and a PLC that acknowledges its functions at once.
#![allow(dead_code, reason = "each test file uses a part of it")]

use crate::stand::bench;
use crate::support::Build;

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
/// The gear at once, too.
pub const GEAR: &str = "       L     M2043\n       = M2480\n";

/// Both.
pub fn with_gear() -> String {
    format!("{SPINDLE}{GEAR}")
}

/// A spindle of two gears.
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
