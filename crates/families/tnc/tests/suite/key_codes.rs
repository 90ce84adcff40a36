//! `key CODE` of scripts takes what W516 takes [000:7406-7436].

use bahn_tnc::{Command, Mode};

/// "Code for soft key functions: 0000 INTERNAL STOP, 0100 M, 0200 S, 0300 TOUCH PROBE, 0400 PASS OVER REFERENCE,
/// 0500 RESTORE POSITION", hexadecimal.
#[test]
fn codes_of_w516_are_commands() {
    for (code, command) in [
        (0x0000, Command::InternalStop),
        (0x0100, Command::Key(0x0100)),
        (0x0200, Command::Key(0x0200)),
        (0x0300, Command::Key(0x0300)),
        (0x0400, Command::Mode(Mode::Reference)),
        (0x0500, Command::RestorePosition),
        (58, Command::Key(58)),
        (127, Command::Key(127)),
    ] {
        assert_eq!(format!("key {code}").parse::<Command>().unwrap(), command);
    }
    // No table has codes below the first key, and the alphabetic keyboard ends with FF50.
    for code in (1..58).chain([0xFF51]) {
        let error = format!("key {code}").parse::<Command>().unwrap_err().to_string();
        assert!(error.contains("0 or a code from 58 to 65360"), "{error}");
    }
}
