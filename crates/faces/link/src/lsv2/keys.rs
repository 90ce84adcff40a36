//! Codes of keys: those that clients know, of later controls (public). Of the older keyboard only the characters are there:
//! its other codes are characters of the newer one.

/// Codes of keys that have no character, and names of the keys here. Keys that this keyboard lacks have no row.
const KEYS: &[(u16, &str)] = &[
    (0x0180, "SK1"),
    (0x0181, "SK2"),
    (0x0182, "SK3"),
    (0x0183, "SK4"),
    (0x0184, "SK5"),
    (0x0185, "SK6"),
    (0x0186, "SK7"),
    (0x0187, "SK8"),
    (0x019D, "SK_RIGHT"),
    (0x019E, "SK_LEFT"),
    (0x01A0, "UP"),
    (0x01A1, "DOWN"),
    (0x01A2, "LEFT"),
    (0x01A3, "RIGHT"),
    (0x01A8, "ENT"),
    (0x01A9, "NO_ENT"),
    (0x01AB, "DEL"),
    (0x01AC, "END"),
    (0x01AD, "GOTO"),
    (0x01AE, "CE"),
    (0x01B0, "X"),
    (0x01B1, "Y"),
    (0x01B2, "Z"),
    (0x01B3, "IV"),
    (0x01B4, "V"),
    (0x01B8, "P"),
    (0x01B9, "I"),
    (0x01BA, "Q"),
    (0x01BB, "CAPTURE"),
    (0x01BC, "SIGN"),
    (0x01BD, "POINT"),
    (0x01C0, "MANUAL"),
    (0x01C1, "MDI"),
    (0x01C2, "SINGLE"),
    (0x01C3, "FULL"),
    (0x01C4, "PROGRAM"),
    (0x01C5, "HANDWHEEL"),
    (0x01C6, "TEST"),
    (0x01C7, "MOD"),
    (0x01CB, "PGM_NR"),
    (0x01D0, "PGM_CALL"),
    (0x01D1, "TOOL_DEF"),
    (0x01D2, "TOOL_CALL"),
    (0x01D3, "CYCL_DEF"),
    (0x01D4, "CYCL_CALL"),
    (0x01D5, "LBL_SET"),
    (0x01D6, "LBL_CALL"),
    (0x01D7, "L"),
    (0x01D8, "C"),
    (0x01D9, "CR"),
    (0x01DA, "CT"),
    (0x01DB, "CC"),
    (0x01DC, "RND"),
    (0x01DD, "CHF"),
    (0x01DF, "TOUCH_PROBE"),
    (0x01E0, "STOP"),
    (0x01ED, "HELP"),
];

/// Low byte of a character of the older keyboard, whose code is the high byte.
const OLD_CHARACTER: u16 = 0x50;

/// The name of a key, or the character that it enters: letters, digits, blank, `.`, `-` and `:`.
pub fn name(code: u16) -> Option<String> {
    let character = match code {
        0x20..=0x7e => u8::try_from(code).ok(),
        _ if code & 0xff == OLD_CHARACTER => u8::try_from(code >> 8).ok(),
        0x000D | 0x000A => return Some("ENT".to_owned()),
        _ => None,
    };
    let character = character
        .map(char::from)
        .filter(|character| character.is_ascii_alphanumeric() || matches!(character, ' ' | '.' | '-' | ':'));
    match character {
        Some(character) => Some(character.to_string()),
        None => KEYS
            .iter()
            .find(|(known, _)| *known == code)
            .map(|(_, name)| (*name).to_owned()),
    }
}
