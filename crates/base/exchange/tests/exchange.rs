//! When changes reach the other side.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use bahn_exchange::{Bit, BitArea, Exchange, Number, signal};
use proptest::prelude::*;

fn number(text: &str) -> Number {
    text.parse().unwrap()
}

#[test]
fn a_strobe_of_the_plc_is_reset_by_the_nc_at_the_next_scan_start() {
    let mut exchange = Exchange::default();
    let strobe = signal::TRANSFER_Q_PARAMETER;
    exchange.begin_scan();
    exchange.plc_mut().set_bit(strobe, true);
    exchange.plc_mut().set_number(signal::TRANSFER_VALUE, 4711);
    exchange.end_scan();
    assert!(exchange.nc().bit(strobe));
    assert_eq!(exchange.nc().number(signal::TRANSFER_VALUE), 4711);

    exchange.nc_set(strobe, false);
    assert!(exchange.plc().bit(strobe), "the PLC still sees its strobe");
    exchange.begin_scan();
    assert!(!exchange.plc().bit(strobe));
    exchange.end_scan();
    assert!(!exchange.nc().bit(strobe));
}

#[test]
fn the_nc_wins_when_it_writes_during_a_scan() {
    let mut exchange = Exchange::default();
    exchange.begin_scan();
    exchange.plc_mut().set_bit(signal::TOOL_LIFE_TIME1_ELAPSED, true);
    exchange.nc_set(signal::TOOL_LIFE_TIME1_ELAPSED, false);
    exchange.end_scan();
    assert!(!exchange.nc().bit(signal::TOOL_LIFE_TIME1_ELAPSED));
    exchange.begin_scan();
    assert!(!exchange.plc().bit(signal::TOOL_LIFE_TIME1_ELAPSED));
}

#[test]
fn a_written_input_lasts_until_the_next_scan() {
    let mut exchange = Exchange::default();
    let input: Bit = "I4".parse().unwrap();
    exchange.nc_set(input, true);
    exchange.begin_scan();
    exchange.plc_mut().set_bit(input, false);
    exchange.end_scan();
    assert!(exchange.nc().bit(input), "the outside is not touched");
    exchange.begin_scan();
    assert!(exchange.plc().bit(input));
}

#[test]
fn reset_keeps_the_retained_memory() {
    let mut exchange = Exchange::default();
    for name in ["M1000", "M1999", "M999", "M2000"] {
        exchange.nc_set(name.parse().unwrap(), true);
    }
    exchange.nc_set_number(number("B127"), 5);
    exchange.nc_set_number(number("B128"), 6);
    exchange.begin_scan();
    exchange.end_scan();
    exchange.reset();
    let bit = |name: &str| exchange.plc().bit(name.parse().unwrap());
    assert!(bit("M1000") && bit("M1999") && !bit("M999") && !bit("M2000"));
    assert_eq!(exchange.plc().number(number("B127")), 5);
    assert_eq!(exchange.nc().number(number("B128")), 0);
    exchange.plc_mut().erase_retained();
    assert!(!exchange.plc().bit("M1000".parse().unwrap()));
}

proptest! {
    /// After a scan in which the PLC changes nothing, both sides agree on everything.
    #[test]
    fn a_quiet_scan_brings_the_images_together(
        writes in prop::collection::vec((0_u16..3264, any::<bool>(), 0_u16..1024, any::<i8>()), 0..50),
    ) {
        let mut exchange = Exchange::default();
        for (marker, value, byte, content) in writes {
            exchange.nc_set(Bit::new(BitArea::M, marker).unwrap(), value);
            exchange.nc_set_number(number(&format!("B{byte}")), content.into());
        }
        exchange.begin_scan();
        exchange.end_scan();
        prop_assert_eq!(exchange.nc(), exchange.plc());
    }
}
