//! The keys of the control: keyboard with contour, tool, cycle and mode keys, alpha keyboard, soft keys
//! [003:9-206].
//!
//! Decision: The keyboard of a TNC 360 is that of its cover, and HELP and soft keys, which are ours there; that of a
//! TNC 151/155 is the same without soft keys, and has letters while MP217 = 1; a key that a model does not have is
//! refused with a word

use std::fmt;

use bahn_parameters::ControlModel;

/// Which part of the keyboard a key belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KeyGroup {
    /// Keys of the operating modes.
    Mode,
    /// Programs and supplementary functions.
    Files,
    /// Arrow keys and GOTO.
    Cursor,
    /// Keys of the path functions.
    Contour,
    /// Tools and radius compensation.
    Tool,
    /// Cycles, labels, stop, touch probe.
    Cycle,
    /// Keys of the graphics.
    Graphics,
    /// Keys that name an axis.
    Axis,
    /// Digits, point and sign.
    Number,
    /// Polar, incremental, Q, actual position.
    Value,
    /// What ends or clears an entry.
    Entry,
    /// Letters of the alpha keyboard that are no other key.
    Letter,
    /// Soft keys below the screen.
    Soft,
}

impl KeyGroup {
    /// Its name in lower case, as a page writes it: `mode`.
    pub const fn name(self) -> &'static str {
        match self {
            KeyGroup::Mode => "mode",
            KeyGroup::Files => "files",
            KeyGroup::Cursor => "cursor",
            KeyGroup::Contour => "contour",
            KeyGroup::Tool => "tool",
            KeyGroup::Cycle => "cycle",
            KeyGroup::Graphics => "graphics",
            KeyGroup::Axis => "axis",
            KeyGroup::Number => "number",
            KeyGroup::Value => "value",
            KeyGroup::Entry => "entry",
            KeyGroup::Letter => "letter",
            KeyGroup::Soft => "soft",
        }
    }

    /// All groups in the order of the table.
    pub const ALL: &[KeyGroup] = &[
        KeyGroup::Mode,
        KeyGroup::Files,
        KeyGroup::Cursor,
        KeyGroup::Contour,
        KeyGroup::Tool,
        KeyGroup::Cycle,
        KeyGroup::Graphics,
        KeyGroup::Axis,
        KeyGroup::Number,
        KeyGroup::Value,
        KeyGroup::Entry,
        KeyGroup::Letter,
        KeyGroup::Soft,
    ];
}

/// The language of what people read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tongue {
    /// Screens and messages in English.
    #[default]
    English,
    /// Screens and messages in German.
    German,
}

/// A row of the table.
struct Row {
    name: &'static str,
    group: KeyGroup,
    label: [&'static str; 2],
}

macro_rules! keys {
    ($($key:ident: $name:literal, $group:ident, $english:literal, $german:literal;)+) => {
        /// A key. Where a letter of the alpha keyboard has the name of another key (`C`, `I`, `L`, `P`, `Q`, `V`, `X`,
        /// `Y`, `Z`) it is that key: what it means depends on what is being entered.
        ///
        /// ```
        /// use bahn_dialogue::{Key, KeyGroup};
        ///
        /// let key = Key::from_name("CYCL_DEF").unwrap();
        /// assert_eq!((key, key.group()), (Key::CyclDef, KeyGroup::Cycle));
        /// assert_eq!((key.name(), key.label()), ("CYCL_DEF", "Cycle definition"));
        /// assert_eq!(Key::from_name("7"), Some(Key::Digit7));
        /// assert_eq!(Key::L.character(), Some('L'));
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Key {
            $(
                #[doc = concat!("`", $name, "`: ", $english, ".")]
                $key,
            )+
        }

        impl Key {
            /// All keys in the order of the table.
            pub const ALL: &[Key] = &[$(Key::$key),+];

            const fn row(self) -> &'static Row {
                match self {
                    $(Key::$key => &Row {
                        name: $name,
                        group: KeyGroup::$group,
                        label: [$english, $german],
                    },)+
                }
            }
        }
    };
}

keys! {
    Manual: "MANUAL", Mode, "Manual operation", "Manueller Betrieb";
    Handwheel: "HANDWHEEL", Mode, "Electronic handwheel", "El. Handrad";
    Mdi: "MDI", Mode, "Positioning with manual data input", "Positionieren mit Handeingabe";
    Single: "SINGLE", Mode, "Program run, single block", "Programmlauf Einzelsatz";
    Full: "FULL", Mode, "Program run, full sequence", "Programmlauf Satzfolge";
    Program: "PROGRAM", Mode, "Programming and editing", "Programm-Einspeichern/Editieren";
    Test: "TEST", Mode, "Test run", "Programm-Test";
    PgmNr: "PGM_NR", Files, "Select program", "Programm wählen";
    ClPgm: "CL_PGM", Files, "Erase program", "Programm löschen";
    PgmCall: "PGM_CALL", Files, "Program call", "Programm-Aufruf";
    Ext: "EXT", Files, "External data transfer", "Externe Datenübertragung";
    Mod: "MOD", Files, "Supplementary modes", "Zusatz-Betriebsarten";
    Help: "HELP", Files, "Help", "Hilfe";
    Screen: "SCREEN", Files, "Screen layout", "Bildschirm-Aufteilung";
    Up: "UP", Cursor, "Up", "Nach oben";
    Down: "DOWN", Cursor, "Down", "Nach unten";
    Left: "LEFT", Cursor, "Left", "Nach links";
    Right: "RIGHT", Cursor, "Right", "Nach rechts";
    Goto: "GOTO", Cursor, "Go to", "Gehe zu";
    L: "L", Contour, "Straight line", "Gerade";
    Cc: "CC", Contour, "Circle centre or pole", "Kreismittelpunkt oder Pol";
    C: "C", Contour, "Circle about the centre", "Kreis um den Mittelpunkt";
    Cr: "CR", Contour, "Circle with radius", "Kreis mit Radius";
    Ct: "CT", Contour, "Tangential circle", "Kreis mit tangentialem Anschluss";
    Rnd: "RND", Contour, "Corner rounding", "Ecken-Runden";
    Chf: "CHF", Contour, "Chamfer", "Fase";
    ToolDef: "TOOL_DEF", Tool, "Tool definition", "Werkzeug-Definition";
    ToolCall: "TOOL_CALL", Tool, "Tool call", "Werkzeug-Aufruf";
    Rl: "RL", Tool, "Radius compensation left", "Radiuskorrektur links";
    Rr: "RR", Tool, "Radius compensation right", "Radiuskorrektur rechts";
    RPlus: "R_PLUS", Tool, "Path longer by the radius", "Weg um den Radius verlängert";
    RMinus: "R_MINUS", Tool, "Path shorter by the radius", "Weg um den Radius verkürzt";
    CyclDef: "CYCL_DEF", Cycle, "Cycle definition", "Zyklus-Definition";
    CyclCall: "CYCL_CALL", Cycle, "Cycle call", "Zyklus-Aufruf";
    LblSet: "LBL_SET", Cycle, "Set label", "Label setzen";
    LblCall: "LBL_CALL", Cycle, "Call label", "Label aufrufen";
    Stop: "STOP", Cycle, "Stop", "Halt";
    TouchProbe: "TOUCH_PROBE", Cycle, "Touch probe", "Tastsystem";
    Graphics: "GRAPHICS", Graphics, "Graphics", "Grafik";
    BlkForm: "BLK_FORM", Graphics, "Blank form", "Rohteil";
    Magn: "MAGN", Graphics, "Magnify", "Ausschnitt vergrößern";
    Start: "START", Graphics, "Start graphics or probing", "Grafik oder Antasten starten";
    X: "X", Axis, "X axis", "X-Achse";
    Y: "Y", Axis, "Y axis", "Y-Achse";
    Z: "Z", Axis, "Z axis", "Z-Achse";
    Iv: "IV", Axis, "Fourth axis", "Vierte Achse";
    V: "V", Axis, "Fifth axis", "Fünfte Achse";
    Digit0: "0", Number, "Digit 0", "Ziffer 0";
    Digit1: "1", Number, "Digit 1", "Ziffer 1";
    Digit2: "2", Number, "Digit 2", "Ziffer 2";
    Digit3: "3", Number, "Digit 3", "Ziffer 3";
    Digit4: "4", Number, "Digit 4", "Ziffer 4";
    Digit5: "5", Number, "Digit 5", "Ziffer 5";
    Digit6: "6", Number, "Digit 6", "Ziffer 6";
    Digit7: "7", Number, "Digit 7", "Ziffer 7";
    Digit8: "8", Number, "Digit 8", "Ziffer 8";
    Digit9: "9", Number, "Digit 9", "Ziffer 9";
    Point: "POINT", Number, "Decimal point", "Dezimalpunkt";
    Sign: "SIGN", Number, "Change sign", "Vorzeichen wechseln";
    P: "P", Value, "Polar coordinates", "Polarkoordinaten";
    I: "I", Value, "Incremental", "Inkremental";
    Q: "Q", Value, "Q parameter", "Q-Parameter";
    Capture: "CAPTURE", Value, "Actual position capture", "Istposition übernehmen";
    NoEnt: "NO_ENT", Entry, "No entry", "Keine Eingabe";
    Ent: "ENT", Entry, "Enter", "Eingabe";
    End: "END", Entry, "End of block", "Satzende";
    Ce: "CE", Entry, "Clear entry", "Eingabe löschen";
    Del: "DEL", Entry, "Delete block", "Satz löschen";
    A: "A", Letter, "Letter A", "Buchstabe A";
    B: "B", Letter, "Letter B", "Buchstabe B";
    D: "D", Letter, "Letter D", "Buchstabe D";
    E: "E", Letter, "Letter E", "Buchstabe E";
    F: "F", Letter, "Letter F", "Buchstabe F";
    G: "G", Letter, "Letter G", "Buchstabe G";
    H: "H", Letter, "Letter H", "Buchstabe H";
    J: "J", Letter, "Letter J", "Buchstabe J";
    K: "K", Letter, "Letter K", "Buchstabe K";
    M: "M", Letter, "Letter M", "Buchstabe M";
    N: "N", Letter, "Letter N", "Buchstabe N";
    O: "O", Letter, "Letter O", "Buchstabe O";
    R: "R", Letter, "Letter R", "Buchstabe R";
    S: "S", Letter, "Letter S", "Buchstabe S";
    T: "T", Letter, "Letter T", "Buchstabe T";
    U: "U", Letter, "Letter U", "Buchstabe U";
    W: "W", Letter, "Letter W", "Buchstabe W";
    Sk1: "SK1", Soft, "Soft key 1", "Softkey 1";
    Sk2: "SK2", Soft, "Soft key 2", "Softkey 2";
    Sk3: "SK3", Soft, "Soft key 3", "Softkey 3";
    Sk4: "SK4", Soft, "Soft key 4", "Softkey 4";
    Sk5: "SK5", Soft, "Soft key 5", "Softkey 5";
    Sk6: "SK6", Soft, "Soft key 6", "Softkey 6";
    Sk7: "SK7", Soft, "Soft key 7", "Softkey 7";
    Sk8: "SK8", Soft, "Soft key 8", "Softkey 8";
    SkLeft: "SK_LEFT", Soft, "Soft-key row to the left", "Softkey-Leiste nach links";
    SkRight: "SK_RIGHT", Soft, "Soft-key row to the right", "Softkey-Leiste nach rechts";
}

impl Key {
    /// The key of a name, as [`Key::name`] writes it.
    pub fn from_name(name: &str) -> Option<Key> {
        Key::ALL.iter().copied().find(|key| key.name() == name)
    }

    /// The name of the key in scripts and inputs, such as `CYCL_DEF`.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// What it does, in English.
    pub const fn label(self) -> &'static str {
        self.label_in(Tongue::English)
    }

    /// The label of the key in a language: what it does.
    pub const fn label_in(self, tongue: Tongue) -> &'static str {
        let [english, german] = self.row().label;
        match tongue {
            Tongue::English => english,
            Tongue::German => german,
        }
    }

    /// Whether the keyboard of a control model has it. That of a TNC 360 has four axes, no key for the layout of its one
    /// column, none for a chamfer, which is L and a number, and no letters but those of other keys [003:9-206]
    /// [003:2682-2685]. That of a TNC 155 is the same without soft keys, and with letters for DIN/ISO, which has no soft keys
    /// to write them; a TNC 151 has none of the keys of the graphics [001:186].
    ///
    /// ```
    /// use bahn_dialogue::Key;
    /// use bahn_parameters::ControlModel;
    ///
    /// assert!(Key::Screen.is_on(ControlModel::Tnc415b));
    /// assert!(!Key::Screen.is_on(ControlModel::Tnc360));
    /// ```
    pub const fn is_on(self, model: ControlModel) -> bool {
        match (self, self.group()) {
            (_, KeyGroup::Soft) => model.has_soft_keys(),
            (_, KeyGroup::Graphics) => model.has_graphics(),
            (_, KeyGroup::Letter) => model.has_windows() || !model.has_soft_keys(),
            (Key::Screen | Key::Chf | Key::V, _) => model.has_windows(),
            _ => true,
        }
    }

    /// Which part of the keyboard it belongs to.
    pub const fn group(self) -> KeyGroup {
        self.row().group
    }

    /// The digit it enters.
    pub fn digit(self) -> Option<u8> {
        let digit = self.character()?.to_digit(10)?;
        u8::try_from(digit).ok()
    }

    /// What it writes where text is entered.
    pub fn character(self) -> Option<char> {
        match (self, self.name().as_bytes()) {
            (Key::Point, _) => Some('.'),
            (Key::Sign, _) => Some('-'),
            (_, [byte]) => Some(char::from(*byte)),
            _ => None,
        }
    }

    /// The key that writes a letter, a digit, `.` or `-`.
    pub fn of_character(character: char) -> Option<Key> {
        let upper = character.to_ascii_uppercase();
        Key::ALL
            .iter()
            .copied()
            .find(|key| key.character() == Some(upper))
    }

    /// The number of a soft key, from 0 on the left.
    pub fn soft_key(self) -> Option<usize> {
        let number = self.name().strip_prefix("SK")?.parse::<usize>().ok()?;
        number.checked_sub(1)
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn the_table_is_complete_and_names_are_unique() {
        let names: HashSet<_> = Key::ALL.iter().map(|key| key.name()).collect();
        assert_eq!(names.len(), Key::ALL.len());
        for tongue in [Tongue::English, Tongue::German] {
            let labels: HashSet<_> = Key::ALL.iter().map(|key| key.label_in(tongue)).collect();
            assert_eq!(labels.len(), Key::ALL.len(), "two keys are called the same");
            assert!(!labels.contains(""));
        }
        for key in Key::ALL {
            assert_eq!(Key::from_name(key.name()), Some(*key));
            assert!(KeyGroup::ALL.contains(&key.group()));
        }
        assert_eq!(Key::from_name("Ent"), None);
    }

    #[test]
    fn every_key_of_the_keyboards_has_its_name() {
        let names = "MANUAL HANDWHEEL MDI SINGLE FULL PROGRAM TEST PGM_NR CL_PGM PGM_CALL EXT MOD HELP SCREEN UP DOWN \
                     LEFT RIGHT GOTO L CC C CR CT RND CHF TOOL_DEF TOOL_CALL RL RR R_PLUS R_MINUS CYCL_DEF CYCL_CALL \
                     LBL_SET LBL_CALL STOP TOUCH_PROBE GRAPHICS BLK_FORM MAGN START X Y Z IV V 0 1 2 3 4 5 6 7 8 9 \
                     POINT SIGN P I Q CAPTURE NO_ENT ENT END CE DEL A B C D E F G H I J K L M N O P Q R S T U V W X Y \
                     Z SK1 SK2 SK3 SK4 SK5 SK6 SK7 SK8 SK_LEFT SK_RIGHT";
        let mut keys = HashSet::new();
        for name in names.split_whitespace() {
            keys.insert(Key::from_name(name).unwrap_or_else(|| panic!("no key {name}")));
        }
        assert_eq!(keys.len(), Key::ALL.len());
    }

    #[test]
    fn a_small_keyboard_has_what_its_manual_shows() {
        // The keys on the cover [003:9-206]; HELP and soft keys are ours there.
        let names = "MANUAL HANDWHEEL MDI SINGLE FULL PROGRAM TEST PGM_NR CL_PGM PGM_CALL EXT MOD HELP UP DOWN LEFT RIGHT \
                     GOTO L CC C CR CT RND TOOL_DEF TOOL_CALL RL RR R_PLUS R_MINUS CYCL_DEF CYCL_CALL LBL_SET LBL_CALL \
                     STOP TOUCH_PROBE GRAPHICS BLK_FORM MAGN START X Y Z IV 0 1 2 3 4 5 6 7 8 9 POINT SIGN P I Q CAPTURE \
                     NO_ENT ENT END CE DEL SK1 SK2 SK3 SK4 SK5 SK6 SK7 SK8 SK_LEFT SK_RIGHT";
        let expected: Vec<_> = names.split_whitespace().collect();
        let small = Key::ALL.iter().filter(|key| key.is_on(ControlModel::Tnc360));
        assert_eq!(small.map(|key| key.name()).collect::<Vec<_>>(), expected);
        // That of a TNC 155 has no soft keys, and letters of DIN/ISO for MP217 = 1; a TNC 151 has no graphics [001:186].
        let has = |model, name| Key::from_name(name).unwrap().is_on(model);
        for name in expected.iter().filter(|name| !name.starts_with("SK")) {
            let drawn = ["GRAPHICS", "BLK_FORM", "MAGN", "START"].contains(name);
            assert!(has(ControlModel::Tnc155, name), "{name}");
            assert_eq!(has(ControlModel::Tnc151, name), !drawn, "{name}");
        }
        for name in ["SK1", "SK8", "SK_LEFT", "SK_RIGHT", "SCREEN", "CHF", "V"] {
            assert!(!has(ControlModel::Tnc155, name), "{name}");
        }
        for name in ["D", "F", "G", "H", "J", "K", "M", "N", "R", "S", "T"] {
            assert!(has(ControlModel::Tnc155, name), "{name}");
        }
        for model in [ControlModel::Tnc407, ControlModel::Tnc415b, ControlModel::Tnc425] {
            assert!(Key::ALL.iter().all(|key| key.is_on(model)), "{model}");
        }
    }

    #[test]
    fn characters_and_soft_keys() {
        for character in ('A'..='Z').chain('0'..='9').chain(['.', '-']) {
            let key = Key::of_character(character).unwrap();
            assert_eq!(key.character(), Some(character));
        }
        assert_eq!(Key::of_character('x'), Some(Key::X));
        assert_eq!(Key::of_character(' '), None);
        let soft: Vec<_> = Key::ALL.iter().filter_map(|key| key.soft_key()).collect();
        assert_eq!(soft, (0..8).collect::<Vec<_>>());
        assert_eq!((Key::Digit0.digit(), Key::L.digit()), (Some(0), None));
    }
}
