//! What is fitted to the control of a machine: keys of `machine.toml`.

use bahn_text::Span;

use crate::reader::Section;

/// Boards, options and software as `machine.toml` says them; what is not said is `None`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EquipmentFolder {
    /// The boards with more inputs and outputs, as `PL400`, in their order.
    pub boards: Option<Vec<Said>>,
    /// The analogue inputs of the boards are switched on.
    pub analogue: Option<(Span, bool)>,
    /// The hardware options, as `ts120`.
    pub options: Option<Vec<Said>>,
    /// The release of the software, as `280 54 06`, or its level as `8`.
    pub software: Option<Said>,
}

/// A value and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// Where it stands.
    pub span: Span,
    /// What stands there.
    pub text: String,
}

impl EquipmentFolder {
    pub(crate) fn read(root: &Section) -> EquipmentFolder {
        let said = |(at, text): (usize, &str)| Said {
            span: root.reader.place(at),
            text: text.to_owned(),
        };
        let list = |key| {
            let texts = root.texts(key);
            root.has(key).then(|| texts.into_iter().map(said).collect())
        };
        EquipmentFolder {
            boards: list("boards"),
            analogue: root.flag("analogue").map(|on| (root.place_of("analogue"), on)),
            options: list("options"),
            software: root.text_or_number("software").map(said),
        }
    }
}
