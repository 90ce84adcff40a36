//! Messages, simulated keys, markers of input edges, faults of the PLC program [000:6619-6649]
//! [000:7309-7440] [000:11870-11892].

use crate::support::bench::*;

/// M2924 ff. bring up the PLC's messages; CE steps through them and the NC resets their markers; the PLC may
/// reset them itself. They do not stop the machine [000:6625-6633].
#[test]
fn plc_messages() {
    let mut rig = bench("       L I28\n       AN M80\n       S M2924\n       S M2927\n       L I28\n       = M80\n       L I29\n       R M2927\n").ready();
    rig.event("key X- press");
    rig.seconds(0.2);
    rig.input("I28", true);
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["PLC: ERROR 0", "PLC: ERROR 3"]);
    rig.scan();
    assert!(rig.bit("M2190") && !rig.bit("M2191"));
    close(rig.speed('X'), -1200.0, 5.0);
    rig.command("ce");
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["PLC: ERROR 3"]);
    assert!(!rig.bit("M2924") && rig.bit("M2927"));
    rig.input("I29", true);
    rig.seconds(0.1);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(!rig.bit("M2190"));
    close(rig.speed('X'), -1200.0, 5.0);
}

/// With M2815 the message flashes; M2815 alone is EMERGENCY STOP PLC. The machine is off, CE is of no use.
#[test]
fn flashing_plc_messages() {
    for (program, text) in [
        ("       L I28\n       S M2815\n       S M2925\n", "PLC: ERROR 1"),
        ("       L I28\n       S M2815\n", "EMERGENCY STOP PLC"),
    ] {
        let mut rig = bench(program).ready();
        rig.input("I28", true);
        rig.seconds(0.2);
        assert_eq!(rig.messages(), [text]);
        assert!(rig.control.snapshot().messages[0].flashing);
        assert!(!rig.axis('X').closed && !rig.machine.control_voltage());
        assert!(!rig.control.command("ce".parse().unwrap()));
    }
}

/// A run-time error stops the PLC: flashing message with the line of the fault; the machine is off.
#[test]
fn run_time_error_of_the_plc() {
    let mut rig = bench("       L I28\n       CMT 50\nLBL 50\n       CM 50\n       EM\n").ready();
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(0.3);
    rig.input("I28", true);
    rig.seconds(0.1);
    let messages = rig.messages();
    assert_eq!(messages.len(), 1, "{messages:?}");
    assert!(messages[0].starts_with("ERROR IN PLC-PROGRAM"), "{messages:?}");
    assert!(messages[0].contains("MAIN.PLC line"), "{messages:?}");
    assert!(rig.control.snapshot().messages[0].flashing);
    rig.seconds(0.5);
    assert!(!rig.axis('X').closed && !rig.machine.control_voltage());
}

/// More than one of M03, M04, M05: 1Q [000:5496-5498].
#[test]
fn two_senses_of_rotation() {
    let mut rig = bench("       L I28\n       S M2485\n").ready();
    rig.input("I28", true);
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["ERROR IN PLC-PROGRAM 1Q"]);
}

/// An inhibited key (M2854 ff.) only tells the PLC: M2182 and its code in W274 [000:7319].
#[test]
fn inhibited_keys() {
    let mut rig = bench("       L I28\n       = M2896\n       L I29\n       R M2182\n").ready();
    rig.command("key 100");
    rig.scan();
    assert!(!rig.bit("M2182"), "not inhibited");
    rig.input("I28", true);
    rig.scan();
    rig.command("key 100");
    rig.scan();
    assert!(rig.bit("M2182"));
    assert_eq!(rig.number("W274"), 100);
    rig.input("I29", true);
    rig.scan();
    assert!(!rig.bit("M2182"), "the PLC took note");
}

/// M2813: the key in W516 is pressed, M2187 = 1 at its falling edge when that was not possible: INTERNAL
/// STOP with nothing to stop [000:7406-7440].
#[test]
fn simulated_keys() {
    let program = "
       L I28
       IFT
       L K+100
       = W516
       ELSE
       L K+0
       = W516
       ENDI
       L I29
       AN M80
       S M2813
       L I29
       = M80
";
    let mut rig = bench(program).program("1.H", "L X+20 R0 F500").ready();
    for (key, refused) in [(true, 0), (false, 1)] {
        rig.input("I28", key);
        rig.scan();
        rig.input("I29", true);
        let edges = rig.edges(0.1, &["M2813"]);
        assert_eq!(edges, ["M2813=1", "M2813=0"]);
        assert_eq!(rig.bit("M2187"), refused == 1);
        rig.input("I29", false);
        rig.scan();
    }
    // With an interrupted run INTERNAL STOP is possible.
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.seconds(1.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    assert!(rig.bit("M2183"));
    rig.input("I29", true);
    rig.seconds(0.1);
    assert!(!rig.bit("M2187") && !rig.bit("M2183"));
}

/// M2497: each change of an input sets M1500 + input or M1700 + input for one PLC cycle [000:11870-11892].
#[test]
fn edges_of_inputs() {
    let mut rig =
        bench("       L I29\n       = M2497\n       L M1528\n       S M90\n       L M1728\n       S M91\n")
            .ready();
    rig.input("I28", true);
    rig.seconds(0.1);
    rig.input("I28", false);
    rig.seconds(0.1);
    assert!(!rig.bit("M90") && !rig.bit("M91"), "not without M2497");
    rig.input("I29", true);
    rig.seconds(0.1);
    rig.input("I28", true);
    let edges = rig.edges(0.1, &["M1528", "M1728", "M90", "M91"]);
    assert_eq!(edges, ["M1528=1", "M90=1", "M1528=0"]);
    rig.input("I28", false);
    let edges = rig.edges(0.1, &["M1528", "M1728", "M90", "M91"]);
    assert_eq!(edges, ["M1728=1", "M91=1", "M1728=0"]);
}
