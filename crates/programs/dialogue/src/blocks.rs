//! The table of blocks: which key opens which dialogue, and what it asks in which order. What cycles ask comes from the
//! table of cycles.
//!
//! Decision: In the dialogue ENT alone answers TOOL RADIUS COMP. with R0, ROTATION CLOCKWISE with DR-, F MAX with
//! rapid traverse; NO ENT writes no word. RL and RR wait for ENT

use bahn_program::Sign;

use crate::Key;
use crate::field::{Ask, Choice, Most, Need, Signs, Slot};
use Need::{Optional, Required, Unasked};

/// A block, or blocks that belong together, as the dialogue makes them.
#[derive(Debug, PartialEq)]
pub(crate) struct BlockRow {
    /// What it is found by.
    pub(crate) id: &'static str,
    /// The key that opens it.
    pub(crate) key: Option<Key>,
    pub(crate) lines: &'static [LineRow],
    /// What P makes of it before anything is entered.
    pub(crate) polar: &'static str,
    /// Whether it may stand without any word.
    pub(crate) bare: bool,
}

/// One block of it.
#[derive(Debug, PartialEq)]
pub(crate) struct LineRow {
    pub(crate) head: &'static str,
    pub(crate) slots: &'static [Slot],
}

/// The row of this id; `None` where no block has it.
pub(crate) fn block_row(id: &str) -> Option<&'static BlockRow> {
    BLOCKS.iter().find(|row| row.id == id)
}

const fn slot(glue: &'static str, address: &'static str, ask: Ask, prompt: &'static str, need: Need) -> Slot {
    Slot {
        glue,
        address,
        ask,
        prompt,
        need,
        sign: Sign::Signed,
        of: "",
    }
}

/// A word that only some models have, by its name in their registry.
const fn of(name: &'static str, slot: Slot) -> Slot {
    Slot { of: name, ..slot }
}

const fn number(glue: &'static str, address: &'static str, prompt: &'static str, need: Need) -> Slot {
    slot(glue, address, SIGNED, prompt, need)
}

const fn plain(glue: &'static str, address: &'static str, prompt: &'static str, need: Need) -> Slot {
    slot(glue, address, UNSIGNED, prompt, need)
}

const fn points(most: Most, need: Need) -> Slot {
    slot(" ", "", coordinates(most, true), "coordinates", need)
}

/// Coordinates as positioning blocks have them.
pub(crate) const fn coordinates(most: Most, incremental: bool) -> Ask {
    Ask::Coordinates {
        prefix: "",
        signs: Signs::Always,
        incremental,
        most,
        table: false,
    }
}

pub(crate) const SIGNED: Ask = Ask::Number {
    signs: Signs::Always,
    incremental: false,
};
pub(crate) const UNSIGNED: Ask = Ask::Number {
    signs: Signs::None,
    incremental: false,
};
const POLAR: Ask = Ask::Number {
    signs: Signs::Always,
    incremental: true,
};
/// `DR+` and `DR-`; ENT alone answers ROTATION CLOCKWISE: DR-? with yes *(inferred)*.
pub(crate) const TURN: Ask = Ask::Choice(&[
    Choice {
        value: "+",
        key: None,
    },
    Choice {
        value: "-",
        key: None,
    },
]);
/// ENT alone is NO COMP., R0 *(inferred)*; NO ENT leaves what is in force.
const SIDE: Ask = Ask::Choice(&[
    Choice {
        value: "RL",
        key: Some(Key::Rl),
    },
    Choice {
        value: "RR",
        key: Some(Key::Rr),
    },
    Choice {
        value: "R0",
        key: None,
    },
]);
const LENGTHENING: Ask = Ask::Choice(&[
    Choice {
        value: "R+",
        key: Some(Key::RPlus),
    },
    Choice {
        value: "R-",
        key: Some(Key::RMinus),
    },
    Choice {
        value: "R0",
        key: None,
    },
]);

const LINE: Slot = points(Most::Line, Optional);
const ARC: Slot = points(Most::Circle, Required);
const RADIUS: Slot = number(" ", "R", "circle_radius", Required);
const DIRECTION: Slot = slot(" ", "DR", TURN, "turn", Required);
const PR: Slot = slot(" ", "PR", POLAR, "polar_radius", Optional);
const PA: Slot = slot(" ", "PA", POLAR, "polar_angle", Optional);
const SIDES: Slot = slot(" ", "", SIDE, "compensation", Optional);
const FEED: Slot = slot(" ", "F", Ask::Feed { max: true }, "feed_max", Optional);
const OWN_FEED: Slot = slot(" ", "F", Ask::Feed { max: false }, "feed", Optional);
const M: Slot = slot(" ", "M", Ask::M, "m", Optional);
const TARGET: Slot = slot(" ", "Q", Ask::Integer { q: false }, "result", Required);
const LABEL: Slot = slot(" ", "", Ask::Integer { q: false }, "label", Required);

/// Oversizes of a tool call, in the registry of the models.
const OVERSIZE: &str = "TOOL CALL DL DR";
/// Lines with surface normals there.
pub(crate) const NORMALS: &str = "LN (surface normals)";
/// What a cycle of the machine builder is there that acts at its call.
pub(crate) const DIALOG_CALL: &str = "DLG-CALL";
/// ENT answers DLG-DEF, NO ENT DLG-CALL [000:17732-17744].
const DIALOG: Ask = Ask::Choice(&[
    Choice {
        value: "DLG-CALL",
        key: Some(Key::NoEnt),
    },
    Choice {
        value: "DLG-DEF",
        key: None,
    },
]);

const fn unasked(slot: Slot) -> Slot {
    Slot {
        need: Unasked,
        ..slot
    }
}

const fn row(
    id: &'static str,
    key: Option<Key>,
    polar: &'static str,
    bare: bool,
    lines: &'static [LineRow],
) -> BlockRow {
    BlockRow {
        id,
        key,
        lines,
        polar,
        bare,
    }
}

const fn line(head: &'static str, slots: &'static [Slot]) -> LineRow {
    LineRow { head, slots }
}

/// FN 1 to 4, 8 and 13: two operands.
const fn two(operator: &'static str) -> [Slot; 3] {
    [
        TARGET,
        number(" = ", "", "first_value", Required),
        number(operator, "", "second_value", Required),
    ]
}

/// FN 0 and 5 to 7: one operand.
const fn one(operator: &'static str) -> [Slot; 2] {
    [TARGET, number(operator, "", "first_value", Required)]
}

/// FN 9 to 12.
const fn jump(operator: &'static str) -> [Slot; 3] {
    [
        number(" IF ", "", "first_value", Required),
        number(operator, "", "second_value", Required),
        slot(" GOTO LBL ", "", Ask::Integer { q: false }, "jump", Required),
    ]
}

/// The table. Prompts and their order as far as the manual has them [003:2591-2615] [003:2893-2899] [003:3103-3109]
/// [003:2246-2254] [003:3894], the others *(inferred)* from the order of the words.
#[rustfmt::skip]
pub(crate) static BLOCKS: &[BlockRow] = &[
    row("L", Some(Key::L), "LP", false, &[line("L", &[LINE, SIDES, FEED, M])]),
    row("C", Some(Key::C), "CP", false, &[line("C", &[ARC, DIRECTION, SIDES, FEED, M])]),
    row("CR", Some(Key::Cr), "", false, &[line("CR", &[ARC, RADIUS, DIRECTION, SIDES, FEED, M])]),
    row("CT", Some(Key::Ct), "CTP", false, &[line("CT", &[ARC, SIDES, FEED, M])]),
    row("LP", None, "L", false, &[line("LP", &[PR, PA, unasked(LINE), SIDES, FEED, M])]),
    // With a coordinate of the tool axis it is a helix [003:3324].
    row("CP", None, "C", false, &[
        line("CP", &[unasked(PR), Slot { need: Required, ..PA }, points(Most::Count(1), Optional), DIRECTION, SIDES, FEED, M]),
    ]),
    row("CTP", None, "CT", false, &[line("CTP", &[PR, PA, unasked(LINE), SIDES, FEED, M])]),
    row("LN", None, "", false, &[line("LN", &[
        LINE, number(" ", "NX", "normal", Required), number(" ", "NY", "normal", Required),
        number(" ", "NZ", "normal", Required), SIDES, FEED, M,
    ])]),
    row("AXIS", None, "", false, &[line("", &[
        Slot { glue: "", ..points(Most::Count(1), Required) },
        slot(" ", "", LENGTHENING, "paraxial_compensation", Optional), FEED, M,
    ])]),
    row("CC", Some(Key::Cc), "", true, &[line("CC", &[points(Most::Count(2), Optional)])]),
    row("RND", Some(Key::Rnd), "", false, &[line("RND", &[plain(" ", "R", "rounding", Required), OWN_FEED])]),
    row("CHF", Some(Key::Chf), "", false, &[line("L", &[plain("", "", "chamfer", Required), unasked(OWN_FEED)])]),
    row("TOOL DEF", Some(Key::ToolDef), "", false, &[line("TOOL DEF", &[
        slot(" ", "", Ask::Integer { q: true }, "tool_number", Required),
        number(" ", "L", "tool_length", Optional), number(" ", "R", "tool_radius", Optional),
    ])]),
    row("TOOL CALL", Some(Key::ToolCall), "", false, &[line("TOOL CALL", &[
        slot(" ", "", Ask::Integer { q: true }, "tool_number", Optional),
        slot(" ", "", Ask::Axes(1), "tool_axis", Optional), plain(" ", "S", "speed", Optional),
        of(OVERSIZE, number(" ", "DL", "delta_length", Optional)),
        of(OVERSIZE, number(" ", "DR", "delta_radius", Optional)),
    ])]),
    row("LBL", Some(Key::LblSet), "", false, &[line("LBL", &[LABEL])]),
    row("CALL LBL", Some(Key::LblCall), "", false, &[
        line("CALL LBL", &[LABEL, slot(" REP ", "", Ask::Repeat, "repeat", Optional)]),
    ]),
    row("CALL PGM", Some(Key::PgmCall), "", false, &[line("CALL PGM", &[slot(" ", "", Ask::Name, "program", Required)])]),
    row("STOP", Some(Key::Stop), "", true, &[line("STOP", &[M])]),
    row("CYCL CALL", Some(Key::CyclCall), "", true, &[line("CYCL CALL", &[M])]),
    row("M", Some(Key::M), "", false, &[line("", &[Slot { glue: "", need: Required, ..M }])]),
    row("BLK FORM", Some(Key::BlkForm), "", false, &[
        line("BLK FORM 0.1", &[
            slot(" ", "", Ask::Axes(1), "tool_axis", Required),
            slot(" ", "", coordinates(Most::Corner, false), "blank_min", Required),
        ]),
        line("BLK FORM 0.2", &[slot(" ", "", coordinates(Most::Corner, true), "blank_max", Required)]),
    ]),
    row("FN 0", None, "", false, &[line("FN0:", &one(" = "))]),
    row("FN 1", None, "", false, &[line("FN1:", &two(" + "))]),
    row("FN 2", None, "", false, &[line("FN2:", &two(" - "))]),
    row("FN 3", None, "", false, &[line("FN3:", &two(" * "))]),
    row("FN 4", None, "", false, &[line("FN4:", &two(" DIV "))]),
    row("FN 5", None, "", false, &[line("FN5:", &one(" = SQRT "))]),
    row("FN 6", None, "", false, &[line("FN6:", &one(" = SIN "))]),
    row("FN 7", None, "", false, &[line("FN7:", &one(" = COS "))]),
    row("FN 8", None, "", false, &[line("FN8:", &two(" LEN "))]),
    row("FN 9", None, "", false, &[line("FN9:", &jump(" EQU "))]),
    row("FN 10", None, "", false, &[line("FN10:", &jump(" NE "))]),
    row("FN 11", None, "", false, &[line("FN11:", &jump(" GT "))]),
    row("FN 12", None, "", false, &[line("FN12:", &jump(" LT "))]),
    row("FN 13", None, "", false, &[line("FN13:", &two(" ANG "))]),
    row("FN 14", None, "", false, &[line("FN14:", &[plain(" ERROR = ", "", "error", Required)])]),
    row("FN 15", None, "", false, &[line("FN15:", &[slot(" PRINT ", "", Ask::Items, "print", Required)])]),
    row("FN 19", None, "", false, &[
        line("FN19:", &[number(" PLC = ", "", "plc", Required), number("/", "", "plc_second", Optional)]),
    ]),
    row("FORMULA", None, "", false, &[
        line("", &[Slot { glue: "", ..TARGET }, slot(" = ", "", Ask::Text, "formula", Required)]),
    ]),
    row("DLG", None, "", false, &[line("", &[
        slot("", "", DIALOG, "dialog", Required), slot(" ", "", Ask::Texts, "dialog_texts", Required),
    ])]),
    row("TEXT", None, "", false, &[line("", &[slot("", "", Ask::Text, "text", Required)])]),
];
