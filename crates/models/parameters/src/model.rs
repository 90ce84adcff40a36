//! The control models.

use std::fmt;
use std::str::FromStr;

/// A control model: every difference between controls hangs on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ControlModel {
    /// TNC 151: contouring control with character screen [001:186].
    Tnc151,
    /// TNC 155: TNC 151 with graphics [001:186].
    Tnc155,
    /// TNC 360: control for up to 4 axes [003:7745-7825].
    Tnc360,
    /// TNC 407: up to 5 axes, 6 ms contour cycle [000:130-321].
    Tnc407,
    /// TNC 415 B: up to 5 axes, 3 ms contour cycle, 0.1 µm [000:130-321].
    #[default]
    Tnc415b,
    /// TNC 425: TNC 415 B with digital speed control [000:18117-18152].
    Tnc425,
}

impl ControlModel {
    /// All models, oldest first.
    pub const ALL: [ControlModel; 6] = [
        ControlModel::Tnc151,
        ControlModel::Tnc155,
        ControlModel::Tnc360,
        ControlModel::Tnc407,
        ControlModel::Tnc415b,
        ControlModel::Tnc425,
    ];

    /// The identifier used on the command line and in files: `tnc415b`.
    pub const fn id(self) -> &'static str {
        match self {
            ControlModel::Tnc151 => "tnc151",
            ControlModel::Tnc155 => "tnc155",
            ControlModel::Tnc360 => "tnc360",
            ControlModel::Tnc407 => "tnc407",
            ControlModel::Tnc415b => "tnc415b",
            ControlModel::Tnc425 => "tnc425",
        }
    }

    /// The name for people: `TNC 415 B`.
    pub const fn name(self) -> &'static str {
        match self {
            ControlModel::Tnc151 => "TNC 151",
            ControlModel::Tnc155 => "TNC 155",
            ControlModel::Tnc360 => "TNC 360",
            ControlModel::Tnc407 => "TNC 407",
            ControlModel::Tnc415b => "TNC 415 B",
            ControlModel::Tnc425 => "TNC 425",
        }
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

    /// Draws programs and parts, and prints its screen; the TNC 151 has a screen for characters [001:186] [001:2157].
    pub const fn has_graphics(self) -> bool {
        self.limits().graphics
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
        let letters: String = comments
            .flat_map(|line| line.chars().chain(['\n']))
            .filter(|c| *c != ' ' && *c != '\t' && *c != '-')
            .flat_map(char::to_lowercase)
            .collect();
        let place = |model: &ControlModel| letters.find(model.id());
        ControlModel::ALL
            .into_iter()
            .filter(|model| place(model).is_some())
            .min_by_key(place)
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
#[error("unknown control model `{0}`; known are tnc151, tnc155, tnc360, tnc407, tnc415b, tnc425")]
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
