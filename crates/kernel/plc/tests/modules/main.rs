//! Modules 9000 to 9171, called from programs: arguments in, results and error status out. Expected values
//! stand in the manual or are computed beside the test.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod any_argument;
mod axes;
mod coordinates;
mod desk;
mod files;
mod host;
mod interface;
mod memory;
mod numbers;
mod parameters;
mod spindle;
mod status;
mod strings;
mod tables;
mod window;

/// Every module of the manual, and no other.
#[test]
fn all_fifty_modules_exist() {
    let manual = [
        9000, 9001, 9010, 9011, 9012, 9020, 9021, 9022, 9031, 9032, 9033, 9035, 9036, 9040, 9041, 9042, 9050,
        9051, 9052, 9053, 9054, 9070, 9071, 9080, 9081, 9082, 9083, 9090, 9092, 9093, 9094, 9095, 9100, 9101,
        9102, 9103, 9104, 9105, 9106, 9107, 9110, 9111, 9120, 9121, 9122, 9123, 9124, 9130, 9150, 9171,
    ];
    assert_eq!(manual.len(), 50);
    let numbers: Vec<u16> = bahn_plc::modules().iter().map(|module| module.number).collect();
    assert_eq!(numbers, manual);
}
