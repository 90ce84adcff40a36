//! The terminals of the controls and of the boards that extend them: which input or output of the PLC is where.
//!
//! Decision: Terminals of PL 100 B and PL 110 B that no list of manual 001 names lie in the order of the PL 400, whose
//! connectors X1 to X9 have the order of their J1 to J9 wherever both are known; E20, which none names, lies in its row
//!
//! Decision: Rows are signals: pins of supplies, screens and 0 V are none
//!
//! Decision: Boards that nobody names are two of the first kind in `data/boards.tsv`, whose operands are those of all others
//!
//! Decision: Outputs of a PL 410 have the supply of those of a PL 400: O56-O62 keep theirs with EMERGENCY STOP, since its four
//! groups are wired as the machine builder likes

use std::fmt;
use std::sync::LazyLock;

use crate::ControlModel;

/// A board that extends the inputs and outputs of a control: a row of `data/boards.tsv`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Board {
    /// The identifier used in files: `PL400`.
    pub id: &'static str,
    /// The name for people: `PL 400`.
    pub name: &'static str,
    /// Where the manuals say it.
    pub source: &'static str,
    unit: &'static str,
    not_with: &'static str,
    /// How far the numbers of inputs, outputs and words of a second board are from those of a first one.
    second: [i16; 3],
}

/// A board that is fitted, and which of its terminals act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fitted {
    /// The board.
    pub board: &'static Board,
    /// Its analogue inputs act: MP4410 [000:8449-8484].
    pub analogue: bool,
    /// The inputs and outputs act whose place the analogue inputs take [000:2057].
    pub all_digital: bool,
}

/// Boards that a control may have [000:2029] [001:165].
pub const BOARDS_MAX: usize = 2;

/// What a terminal is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TerminalKind {
    /// An input or output of 24 V.
    Digital,
    /// A potential-free contact of version B [001:265-273].
    Relay,
    /// One of a pair of outputs between which a load lies either way round [001:327-369].
    Bipolar,
    /// A voltage or a thermistor.
    Analogue,
    /// A signal in the serial line of the handwheel, which has no pin of its own [000:8276-8304].
    Handwheel,
}

/// The operand of a terminal in the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Operand {
    /// `I`, `O` or `W`.
    pub letter: char,
    /// Its number.
    pub number: u16,
}

/// A terminal, and what is at it.
///
/// ```
/// use bahn_parameters::ControlModel::Tnc415b;
/// use bahn_parameters::terminals::{Board, terminals};
/// let fitted = [Board::named("PL400").unwrap().with_analogue(false)];
/// let found = terminals(Tnc415b, &fitted).find(|terminal| terminal.to_string() == "PL1 X4/1");
/// assert_eq!(found.unwrap().operand.unwrap().to_string(), "I126");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terminal {
    /// The board that it is on, from 1; `None` on the control itself.
    pub board: Option<usize>,
    /// The connector, as `X41`.
    pub connector: &'static str,
    /// The pin; `None` for signals that have none.
    pub pin: Option<u16>,
    /// What it is.
    pub kind: TerminalKind,
    /// What the PLC calls it; `None` for what no operand is.
    pub operand: Option<Operand>,
    /// An output that loses its voltage with EMERGENCY STOP [000:2134-2174] [000:2310-2342] [001:910].
    pub switched: bool,
    /// What it is for on every machine; empty where the machine builder decides.
    pub name: &'static str,
}

/// A row of `data/terminals.tsv`.
struct Row {
    board: &'static str,
    connector: &'static str,
    pins: Option<[u16; 2]>,
    kind: TerminalKind,
    operands: Option<(char, [u16; 2])>,
    /// It acts with or without the analogue inputs of its board only.
    only: &'static str,
    switched: bool,
    name: &'static str,
}

static BOARDS: LazyLock<Vec<Board>> = LazyLock::new(|| {
    include_str!("../data/boards.tsv")
        .lines()
        .skip(1)
        .filter_map(board)
        .collect()
});

static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    include_str!("../data/terminals.tsv")
        .lines()
        .skip(1)
        .filter_map(row)
        .collect()
});

fn board(line: &'static str) -> Option<Board> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    Some(Board {
        id: next()?,
        name: next()?,
        unit: next()?,
        not_with: next()?,
        second: [
            next()?.parse().ok()?,
            next()?.parse().ok()?,
            next()?.parse().ok()?,
        ],
        source: next()?,
    })
}

fn row(line: &'static str) -> Option<Row> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    Some(Row {
        board: next()?,
        connector: next()?,
        pins: match next()? {
            "-" => None,
            pins => Some(range(pins)?),
        },
        kind: match next()? {
            "digital" => TerminalKind::Digital,
            "relay" => TerminalKind::Relay,
            "bipolar" => TerminalKind::Bipolar,
            "analogue" => TerminalKind::Analogue,
            "handwheel" => TerminalKind::Handwheel,
            _ => return None,
        },
        operands: match next()? {
            "" => None,
            operands => {
                let letter = operands.chars().next()?;
                Some((letter, range(&operands.replace(letter, ""))?))
            }
        },
        only: next()?,
        switched: next()? == "switched",
        name: next()?,
    })
}

/// Reads `4` or `12-2`.
fn range(text: &str) -> Option<[u16; 2]> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    Some([first.parse().ok()?, last.parse().ok()?])
}

/// The numbers of a range in its direction.
fn numbers([first, last]: [u16; 2]) -> impl Iterator<Item = u16> {
    let back = first > last;
    (0..=first.abs_diff(last)).map(move |step| if back { first - step } else { first + step })
}

impl Board {
    /// The boards that a model can have, in the order of the table.
    pub fn of(model: ControlModel) -> impl Iterator<Item = &'static Board> {
        let unit = model.limits().unit;
        BOARDS.iter().filter(move |board| board.unit == unit)
    }

    /// The board of an identifier, upper or lower case.
    pub fn named(id: &str) -> Option<&'static Board> {
        BOARDS.iter().find(|board| board.id.eq_ignore_ascii_case(id))
    }

    /// Two boards that must not be on one control: PL 410 B beside PL 410 or PA 110 [000:2029].
    pub fn excludes(&self, other: &Board) -> bool {
        let names = |one: &Board, other: &Board| one.not_with.split(' ').any(|id| id == other.id);
        names(self, other) || names(other, self)
    }

    /// Has analogue inputs.
    pub fn has_analogue(&self) -> bool {
        let own = |row: &&Row| row.board == self.id;
        ROWS.iter()
            .filter(own)
            .any(|row| row.kind == TerminalKind::Analogue)
    }

    /// The board with its analogue inputs switched on or off.
    pub fn with_analogue(&'static self, analogue: bool) -> Fitted {
        Fitted {
            board: self,
            analogue: analogue && self.has_analogue(),
            all_digital: !analogue,
        }
    }

    /// All that a model can have, where nobody says what is fitted. `analogue` says of which boards the analogue inputs act;
    /// the other terminals in their place may be those of another board.
    pub fn all_of(model: ControlModel, analogue: [bool; BOARDS_MAX]) -> Vec<Fitted> {
        let first = Board::of(model).next();
        let fitted = analogue.into_iter().filter_map(|analogue| {
            Some(Fitted {
                board: first?,
                analogue: analogue && first?.has_analogue(),
                all_digital: true,
            })
        });
        fitted.collect()
    }
}

/// The terminals of a control with these boards, in the order of the table.
pub fn terminals(model: ControlModel, fitted: &[Fitted]) -> impl Iterator<Item = Terminal> {
    let unit = model.limits().unit;
    let own = ROWS.iter().filter(move |row| row.board == unit);
    let own = own.flat_map(|row| row.terminals(None, [0; 3]));
    let boards = fitted.iter().take(BOARDS_MAX).copied().enumerate();
    let boards = boards.flat_map(|(place, fitted)| {
        let shift = if place == 0 { [0; 3] } else { fitted.board.second };
        let rows = ROWS.iter().filter(move |row| row.board == fitted.board.id);
        let acts = move |row: &&Row| match row.only {
            "analogue" => fitted.analogue,
            "digital" => fitted.all_digital,
            _ => true,
        };
        rows.filter(acts)
            .flat_map(move |row| row.terminals(Some(place + 1), shift))
    });
    own.chain(boards)
}

impl Row {
    fn terminals(&self, board: Option<usize>, shift: [i16; 3]) -> impl Iterator<Item = Terminal> {
        let operands = self.operands;
        let numbered = operands.into_iter().flat_map(move |(letter, range)| {
            let shift = match letter {
                'I' => shift[0],
                'O' => shift[1],
                _ => shift[2],
            };
            let shifted = numbers(range).map(move |number| number.saturating_add_signed(shift));
            shifted.map(move |number| Some(Operand { letter, number }))
        });
        // What has no operand is one terminal.
        let operands = numbered.chain(operands.is_none().then_some(None));
        let pins = self.pins.into_iter().flat_map(numbers).map(Some);
        let pins = pins.chain(std::iter::repeat_n(None, usize::from(u16::MAX)));
        let (connector, kind, switched, name) = (self.connector, self.kind, self.switched, self.name);
        operands.zip(pins).map(move |(operand, pin)| Terminal {
            board,
            connector,
            pin,
            kind,
            operand,
            switched,
            name,
        })
    }
}

impl TerminalKind {
    /// The word for it: `digital`.
    pub const fn id(self) -> &'static str {
        match self {
            TerminalKind::Digital => "digital",
            TerminalKind::Relay => "relay",
            TerminalKind::Bipolar => "bipolar",
            TerminalKind::Analogue => "analogue",
            TerminalKind::Handwheel => "handwheel",
        }
    }
}

impl fmt::Display for Operand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&format!("{}{}", self.letter, self.number))
    }
}

impl fmt::Display for Terminal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let board = self.board.map_or(String::new(), |board| format!("PL{board} "));
        let pin = self.pin.map_or(String::new(), |pin| format!("/{pin}"));
        f.pad(&format!("{board}{}{pin}", self.connector))
    }
}
