//! The control models.

use std::fmt;
use std::str::FromStr;

/// A control model, or a version of it: every difference between controls hangs on it.
///
/// A version has the messages, machine parameters and functions of its [`ControlModel::family`]; what it has otherwise stands in
/// its [`Limits`](crate::Limits).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ControlModel {
    /// TNC 151: contouring control with character screen [001:186]; the interface is that of version Q (inferred).
    Tnc151,
    /// TNC 151 B: standard interface to an external PLC [001:132-177].
    Tnc151b,
    /// TNC 151 BR: standard interface to an external PLC, square-wave encoder inputs [001:132-177].
    Tnc151br,
    /// TNC 151 Q: PLC power boards [001:132-177].
    Tnc151q,
    /// TNC 151 QR: PLC power boards, square-wave encoder inputs [001:132-177].
    Tnc151qr,
    /// TNC 151 F: version B for export [001:132-177].
    Tnc151f,
    /// TNC 151 FR: version B for export, square-wave encoder inputs [001:132-177].
    Tnc151fr,
    /// TNC 151 W: version Q for export [001:132-177].
    Tnc151w,
    /// TNC 151 WR: version Q for export, square-wave encoder inputs [001:132-177].
    Tnc151wr,
    /// TNC 155: TNC 151 with graphics [001:186].
    Tnc155,
    /// TNC 155 B: standard interface to an external PLC [001:132-177].
    Tnc155b,
    /// TNC 155 BR: standard interface to an external PLC, square-wave encoder inputs [001:132-177].
    Tnc155br,
    /// TNC 155 Q: PLC power boards [001:132-177].
    Tnc155q,
    /// TNC 155 QR: PLC power boards, square-wave encoder inputs [001:132-177].
    Tnc155qr,
    /// TNC 155 F: version B for export [001:132-177].
    Tnc155f,
    /// TNC 155 FR: version B for export, square-wave encoder inputs [001:132-177].
    Tnc155fr,
    /// TNC 155 W: version Q for export [001:132-177].
    Tnc155w,
    /// TNC 155 WR: version Q for export, square-wave encoder inputs [001:132-177].
    Tnc155wr,
    /// TNC 360: control for up to 4 axes [003:7745-7825].
    Tnc360,
    /// TNC 407: up to 5 axes, 6 ms contour cycle [000:130-321].
    Tnc407,
    /// TNC 415 B: up to 5 axes, 3 ms contour cycle, 0.1 µm [000:130-321].
    #[default]
    Tnc415b,
    /// TNC 415 F: TNC 415 B for export, four of five axes, 1 µm [000:339-355] [000:752-760].
    Tnc415f,
    /// TNC 425: TNC 415 B with digital speed control [000:18117-18152].
    Tnc425,
    /// TNC 425 E: TNC 425 for export, as the TNC 415 F [000:339-355].
    Tnc425e,
}

/// A model: its identifier, its name for people, its family.
type Row = (ControlModel, &'static str, &'static str, ControlModel);

/// All models in their order.
const ROWS: [Row; ControlModel::ALL.len()] = {
    use ControlModel::*;
    [
        (Tnc151, "tnc151", "TNC 151", Tnc151),
        (Tnc151b, "tnc151b", "TNC 151 B", Tnc151),
        (Tnc151br, "tnc151br", "TNC 151 BR", Tnc151),
        (Tnc151q, "tnc151q", "TNC 151 Q", Tnc151),
        (Tnc151qr, "tnc151qr", "TNC 151 QR", Tnc151),
        (Tnc151f, "tnc151f", "TNC 151 F", Tnc151),
        (Tnc151fr, "tnc151fr", "TNC 151 FR", Tnc151),
        (Tnc151w, "tnc151w", "TNC 151 W", Tnc151),
        (Tnc151wr, "tnc151wr", "TNC 151 WR", Tnc151),
        (Tnc155, "tnc155", "TNC 155", Tnc155),
        (Tnc155b, "tnc155b", "TNC 155 B", Tnc155),
        (Tnc155br, "tnc155br", "TNC 155 BR", Tnc155),
        (Tnc155q, "tnc155q", "TNC 155 Q", Tnc155),
        (Tnc155qr, "tnc155qr", "TNC 155 QR", Tnc155),
        (Tnc155f, "tnc155f", "TNC 155 F", Tnc155),
        (Tnc155fr, "tnc155fr", "TNC 155 FR", Tnc155),
        (Tnc155w, "tnc155w", "TNC 155 W", Tnc155),
        (Tnc155wr, "tnc155wr", "TNC 155 WR", Tnc155),
        (Tnc360, "tnc360", "TNC 360", Tnc360),
        (Tnc407, "tnc407", "TNC 407", Tnc407),
        (Tnc415b, "tnc415b", "TNC 415 B", Tnc415b),
        (Tnc415f, "tnc415f", "TNC 415 F", Tnc415b),
        (Tnc425, "tnc425", "TNC 425", Tnc425),
        (Tnc425e, "tnc425e", "TNC 425 E", Tnc425),
    ]
};

impl ControlModel {
    /// All models and their versions, oldest first.
    pub const ALL: [ControlModel; 24] = {
        use ControlModel::*;
        [
            Tnc151, Tnc151b, Tnc151br, Tnc151q, Tnc151qr, Tnc151f, Tnc151fr, Tnc151w, Tnc151wr, Tnc155,
            Tnc155b, Tnc155br, Tnc155q, Tnc155qr, Tnc155f, Tnc155fr, Tnc155w, Tnc155wr, Tnc360, Tnc407,
            Tnc415b, Tnc415f, Tnc425, Tnc425e,
        ]
    };

    /// The models that have lists of their own: messages, machine parameters, functions; oldest first.
    pub const FAMILIES: [ControlModel; 6] = [
        ControlModel::Tnc151,
        ControlModel::Tnc155,
        ControlModel::Tnc360,
        ControlModel::Tnc407,
        ControlModel::Tnc415b,
        ControlModel::Tnc425,
    ];

    /// The identifier used on the command line and in files: `tnc415b`.
    pub const fn id(self) -> &'static str {
        ROWS[self as usize].1
    }

    /// The name for people: `TNC 415 B`.
    pub const fn name(self) -> &'static str {
        ROWS[self as usize].2
    }

    /// The model of which it is a version; itself when it is none.
    ///
    /// ```
    /// use bahn_parameters::ControlModel;
    /// assert_eq!(ControlModel::Tnc155fr.family(), ControlModel::Tnc155);
    /// assert_eq!(ControlModel::Tnc360.family(), ControlModel::Tnc360);
    /// ```
    pub const fn family(self) -> ControlModel {
        ROWS[self as usize].3
    }

    /// The place of its family among [`ControlModel::FAMILIES`].
    pub(crate) const fn place(self) -> usize {
        match self.family() {
            ControlModel::Tnc151 => 0,
            ControlModel::Tnc155 => 1,
            ControlModel::Tnc360 => 2,
            ControlModel::Tnc407 => 3,
            ControlModel::Tnc415b => 4,
            _ => 5,
        }
    }

    /// Runs programs while they are transferred; the export versions of the TNC 151/155 do not [001:136] [001:173].
    pub const fn transfers_blockwise(self) -> bool {
        self.limits().transfers_blockwise
    }

    /// Draws programs and parts, and prints its screen; the TNC 151 has a screen for characters [001:186] [001:2157].
    pub const fn has_graphics(self) -> bool {
        self.limits().graphics
    }

    /// Has the PLC mode after code number 807 667: editor, compiler, trace and tables [000:11187-11241].
    pub const fn has_plc_mode(self) -> bool {
        self.limits().plc_mode
    }

    /// Has a second data interface, RS-422/V.11, beside RS-232-C/V.24 [000:16712-16722].
    pub const fn has_rs_422(self) -> bool {
        self.limits().rs_422
    }

    /// Shows a letter after TRANSFERRED DATA INCORRECT; the TNC 151/155 has none, and calls what it could not send
    /// PROGRAM INCOMPLETE [000:17581-17601] [001:2036-2052].
    pub const fn has_transfer_codes(self) -> bool {
        self.limits().transfer_codes
    }

    /// Has the screen of 14 inches: windows side by side, in colours [000:6289-6306] [000:2784-2833].
    pub const fn has_windows(self) -> bool {
        self.limits().windows
    }

    /// Has soft keys below its screen; the TNC 151/155 has none.
    pub const fn has_soft_keys(self) -> bool {
        self.limits().soft_keys
    }

    /// Draws in program run what runs; the graphics of a TNC 407 are those of TEST RUN [000:164-166] [000:6370].
    pub const fn draws_what_runs(self) -> bool {
        self.limits().draws_what_runs
    }

    /// Simulates the selected program in the program run modes, before it runs [003:856-874].
    pub const fn simulates_in_program_run(self) -> bool {
        self.limits().simulates_in_program_run
    }

    /// Positioning blocks of MDI are those of a single axis [003:3566].
    pub const fn positions_one_axis_by_mdi(self) -> bool {
        self.limits().one_axis_by_mdi
    }

    /// Shows by hand the feed of the axis whose direction key is pressed [000:6529-6540]; a TNC 360 shows a feed with MP7270 + 1
    /// alone [003:7304-7309].
    pub const fn shows_feed_of_keys(self) -> bool {
        self.limits().shows_feed_of_keys
    }

    /// Code number 531 210 erases the machine parameters, too [001:1293-1297]; on the later controls markers and bytes alone
    /// [000:6941].
    pub const fn erases_its_list(self) -> bool {
        self.limits().erases_its_list
    }

    /// M95 and M96 change how a compensated contour is approached and left [001:707-708].
    pub const fn has_approach_functions(self) -> bool {
        self.limits().approach_functions
    }

    /// Has an oscilloscope after code number 688 379 [000:18640].
    pub const fn has_oscilloscope(self) -> bool {
        self.limits().oscilloscope
    }

    /// The model that the comments at the beginning of a list name, as `TNC 415 B` or `tnc415b`; the first of several.
    ///
    /// ```
    /// use bahn_parameters::ControlModel;
    /// assert_eq!(ControlModel::named_in(b"; my mill, TNC 415 B\nMP10 : 1\n"), Some(ControlModel::Tnc415b));
    /// ```
    pub fn named_in(list: &[u8]) -> Option<ControlModel> {
        let text = bahn_text::decode(list);
        let comments = text
            .lines()
            .take_while(|line| line.trim().is_empty() || line.trim_start().starts_with([';', '*']));
        comments.map(str::to_lowercase).find_map(|line| {
            let mut starts = line.match_indices("tnc").filter_map(|(at, _)| line.get(at..));
            starts.find_map(ControlModel::named_at)
        })
    }

    /// The model whose name a text begins with, whatever blanks and dashes are in it; the longest one, and a letter of a
    /// version is no beginning of a word.
    fn named_at(text: &str) -> Option<ControlModel> {
        let after = |id: &str| {
            let mut rest = text;
            for letter in id.chars() {
                let gap = |c: char| matches!(c, ' ' | '\t' | '-');
                rest = rest.trim_start_matches(gap).strip_prefix(letter)?;
            }
            Some(rest)
        };
        let is_named = |model: &ControlModel| {
            let version = *model != model.family();
            let ends = |rest: &str| !rest.starts_with(char::is_alphanumeric);
            after(model.id()).is_some_and(|rest| !version || ends(rest))
        };
        let named = ControlModel::ALL.into_iter().filter(is_named);
        named.max_by_key(|model| model.id().len())
    }
}

impl fmt::Display for ControlModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.id())
    }
}

impl FromStr for ControlModel {
    type Err = UnknownModel;

    /// Reads an identifier, upper or lower case.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        ControlModel::ALL
            .into_iter()
            .find(|model| model.id().eq_ignore_ascii_case(text))
            .ok_or_else(|| UnknownModel(text.to_owned()))
    }
}

/// The text names no control model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown control model `{0}`; known are {known}", known = ControlModel::ALL.map(ControlModel::id).join(", "))]
pub struct UnknownModel(pub String);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_comments_at_the_beginning_name_the_control() {
        let named = ControlModel::named_in;
        assert_eq!(
            named(b"; my mill, TNC 415 B\nMP10 : 1\n"),
            Some(ControlModel::Tnc415b)
        );
        assert_eq!(named(b"\xEF\xBB\xBF\n* tnc-360\n"), Some(ControlModel::Tnc360));
        assert_eq!(
            named(b"; TNC 155, before that a TNC 151\n"),
            Some(ControlModel::Tnc155)
        );
        assert_eq!(named(b"MP10 : 1 ;TNC 360\n"), None);
        assert_eq!(named(b""), None);
    }

    /// "TNC 151 B" is the version, "TNC 151 before" names none.
    #[test]
    fn a_version_is_named_by_its_letters() {
        let named = ControlModel::named_in;
        assert_eq!(named(b"; TNC 151 BR, lathe\n"), Some(ControlModel::Tnc151br));
        assert_eq!(named(b"; tnc155f\n"), Some(ControlModel::Tnc155f));
        assert_eq!(named(b"; TNC 151 before\n"), Some(ControlModel::Tnc151));
        assert_eq!(named(b"; TNC 425 E, TNC 360\n"), Some(ControlModel::Tnc425e));
    }

    #[test]
    fn rows_stand_in_their_order() {
        for (model, row) in ControlModel::ALL.into_iter().zip(ROWS) {
            assert_eq!(row.0, model);
            assert_eq!(ControlModel::FAMILIES[model.place()], model.family(), "{model}");
            assert!(model.id().starts_with(model.family().id().trim_end_matches('b')));
        }
    }

    #[test]
    fn identifiers_read_back() {
        for model in ControlModel::ALL {
            assert_eq!(model.to_string().parse(), Ok(model));
            assert_eq!(model.id().to_uppercase().parse(), Ok(model));
        }
        assert_eq!(
            "tnc430".parse::<ControlModel>(),
            Err(UnknownModel("tnc430".into()))
        );
    }
}
