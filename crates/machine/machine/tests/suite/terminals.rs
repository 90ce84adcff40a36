//! Outputs as the terminals of a control have them: their supply, and bipolar ones.

use crate::common::{IDEAL_X, input, machine, outputs};

/// The plant of the other tests, without `switched_outputs`.
const CHAIN: &str = "[emergency_stop]\nacknowledgement = \"I3\"\npull_in_ms = 10\ndrop_out_ms = 20\n";

/// A thing at each output shows whether voltage arrives.
fn things(numbers: &[usize]) -> String {
    let thing = |number: &usize| {
        format!(
            "[device.out{number}]\nstates = [\"off\", \"on\"]\nstart = \"off\"\noutput = \"O{number}\"\nforth_ms = 1\nback_ms = 1\n\
             input_second = \"I{}\"\n",
            number + 100
        )
    };
    numbers.iter().map(thing).collect()
}

/// With EMERGENCY STOP the outputs fall whose supply is switched off [000:2134-2174], unless the plant says it itself.
#[test]
fn outputs_fall_with_their_supply() {
    for (said, five_stays) in [("", false), ("switched_outputs = [\"O7\"]\n", true)] {
        let mut machine = machine(&format!("{CHAIN}{said}{}{IDEAL_X}", things(&[5, 26])));
        machine.fit(|output| output < 24, &[]);
        machine.set_control_ready(true);
        machine.advance(20_000);
        outputs(&mut machine, &[5, 26]);
        machine.advance(20_000);
        assert!(input(&mut machine, 105) && input(&mut machine, 126));
        machine.apply("emergency press").unwrap();
        machine.advance(100_000);
        assert_eq!(input(&mut machine, 105), five_stays, "{said}");
        assert!(input(&mut machine, 126), "{said}");
    }
}

/// J3/11 is 1 when the currents of all bipolar outputs are above about 0.85 A [001:363]: three loads of the nominal 0.3 A are
/// 0.9 A, two are 0.6 A. Between the outputs of a pair lies one load, which takes its current when they differ.
#[test]
fn the_sum_of_bipolar_currents_sets_the_overload_signal() {
    let plant = format!(
        "{CHAIN}[bipolar]\noverload = \"I40\"\n{}{IDEAL_X}",
        things(&[25, 26, 27, 28, 29])
    );
    let mut machine = machine(&plant);
    // Pairs of the first board; of the third one output alone is wired.
    assert!(!machine.fit(|_| false, &[25, 26, 27, 28, 29, 30]));
    machine.set_control_ready(true);
    for (on, overload) in [
        (&[][..], false),
        (&[25], false),
        (&[25, 27], false),
        (&[25, 27, 29], true),
        (&[26, 28, 29], true),
        (&[25, 26, 27, 29], false),
        (&[25, 26, 27, 28, 29], false),
    ] {
        outputs(&mut machine, on);
        machine.advance(20_000);
        assert_eq!(input(&mut machine, 40), overload, "{on:?}");
    }
    // Without bipolar outputs there is nothing to be overloaded: that is told.
    assert!(machine.fit(|_| false, &[]));
}
