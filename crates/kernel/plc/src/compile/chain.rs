//! The rules of gating chains: a chain begins with a load and ends with an assignment, a conditional jump,
//! call or end, or a structure [000:12060-12070][000:11946-12000].
//!
//! The state machine is inferred from the texts of the errors; it accepts the manual's listings.

use crate::PlcError;

/// State of one accumulator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// Nothing is loaded.
    #[default]
    Unloaded,
    /// Loaded or gated, the result not used yet.
    Open,
    /// The value is valid and was used.
    Done,
}

/// Which accumulator a bracket works on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Accumulator {
    #[default]
    Logic,
    Word,
}

/// The accumulators as the compiler sees them at a line.
#[derive(Clone, Copy, Debug, Default)]
struct Accumulators {
    logic: State,
    word: State,
    /// The accumulator that was addressed last.
    last: Option<Accumulator>,
}

/// What happens when a bracket closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Result {
    /// The content is a logic chain, as the result.
    Logic,
    /// The content is a word chain, as the result.
    Word,
    /// The content is a word chain, the result goes to the logic accumulator.
    Compared,
}

#[derive(Clone, Copy, Debug)]
struct Bracket {
    outside: Accumulators,
    result: Result,
    /// Whether error 10 was reported inside.
    assigned: bool,
}

/// Open brackets at most [000:13234].
const BRACKETS_MAX: usize = 16;

/// Follows the chains through the lines of a file. Every method returns the error of the rule that the
/// command breaks and goes on as if it had been right, so that one mistake is reported once.
#[derive(Debug, Default)]
pub(super) struct Chains {
    now: Accumulators,
    text: State,
    brackets: Vec<Bracket>,
}

impl Chains {
    /// Whether a bracket is open.
    pub(super) fn in_bracket(&self) -> bool {
        !self.brackets.is_empty()
    }

    /// How many brackets are open.
    pub(super) fn level(&self) -> u8 {
        u8::try_from(self.brackets.len()).unwrap_or(u8::MAX)
    }

    /// `L LN` of a bit, `PLL`: starts a logic chain.
    pub(super) fn load_logic(&mut self) -> Option<PlcError> {
        let error = (self.now.logic == State::Open).then_some(PlcError::NoLogicAssignment);
        self.open_logic();
        error
    }

    /// A logic gate. Tells whether it acts as a load, at the start of a chain [000:12070].
    pub(super) fn gate_logic(&mut self) -> bool {
        let loads = self.now.logic != State::Open;
        self.open_logic();
        loads
    }

    /// A bit is assigned, set or reset.
    pub(super) fn assign_logic(&mut self) -> Option<PlcError> {
        let missing = self.now.logic == State::Unloaded;
        self.now.logic = State::Done;
        self.now.last = Some(Accumulator::Logic);
        self.inside_bracket()
            .or(missing.then_some(PlcError::LogicNotLoaded))
    }

    /// `PSL`: uses the logic accumulator.
    pub(super) fn use_logic(&mut self) -> Option<PlcError> {
        let missing = self.now.logic == State::Unloaded;
        self.now.logic = State::Done;
        self.now.last = Some(Accumulator::Logic);
        missing.then_some(PlcError::LogicNotLoaded)
    }

    /// The loads of a word, also `PLW LX SUBM RPLY`: start a word chain.
    pub(super) fn load_word(&mut self) -> Option<PlcError> {
        let error = (self.now.word == State::Open).then_some(PlcError::NoWordAssignment);
        self.open_word();
        error
    }

    /// A word is gated, calculated or shifted.
    pub(super) fn gate_word(&mut self) -> Option<PlcError> {
        let missing = self.now.word == State::Unloaded;
        self.open_word();
        missing.then_some(PlcError::WordNotLoaded)
    }

    /// A word is assigned to memory.
    pub(super) fn assign_word(&mut self) -> Option<PlcError> {
        let error = self.use_word();
        self.inside_bracket().or(error)
    }

    /// `PSW =X`: use the word accumulator.
    pub(super) fn use_word(&mut self) -> Option<PlcError> {
        let missing = self.now.word == State::Unloaded;
        self.now.word = State::Done;
        self.now.last = Some(Accumulator::Word);
        missing.then_some(PlcError::WordNotLoaded)
    }

    /// A comparison or `BT`: from the word to the logic accumulator. An open logic chain would be lost.
    pub(super) fn compare_word(&mut self) -> Option<PlcError> {
        let error = self.use_word();
        error.or(self.load_logic())
    }

    /// `L` of a string.
    pub(super) fn load_text(&mut self) -> Option<PlcError> {
        let error = (self.text == State::Open).then_some(PlcError::NoStringAssignment);
        self.text = State::Open;
        self.text_in_bracket().or(error)
    }

    /// `+` of a string.
    pub(super) fn append_text(&mut self) -> Option<PlcError> {
        let missing = self.text == State::Unloaded;
        self.text = State::Open;
        self.text_in_bracket()
            .or(missing.then_some(PlcError::StringNotLoaded))
    }

    /// `= OVWR` of a string.
    pub(super) fn assign_text(&mut self) -> Option<PlcError> {
        let missing = self.text == State::Unloaded;
        self.text = State::Done;
        self.text_in_bracket()
            .or(missing.then_some(PlcError::StringNotLoaded))
    }

    /// A string is compared.
    pub(super) fn compare_text(&mut self) -> Option<PlcError> {
        let error = self.assign_text();
        error.or(self.load_logic())
    }

    /// A conditional jump, call, end or structure uses the logic accumulator.
    pub(super) fn condition(&mut self) -> Option<PlcError> {
        let missing = self.now.logic == State::Unloaded;
        self.now.logic = State::Done;
        let error = missing.then_some(PlcError::ConditionNotLoaded);
        self.jump().or(error)
    }

    /// Any jump or call: not inside brackets.
    pub(super) fn jump(&mut self) -> Option<PlcError> {
        self.leave_brackets(PlcError::JumpInBracket)
    }

    /// `JP`: no chain may be open. What follows starts anew.
    pub(super) fn jump_always(&mut self) -> Option<PlcError> {
        let error = self.jump().or(self.is_open().then_some(PlcError::JumpInChain));
        self.start_anew();
        error
    }

    /// A call: the accumulators are what the module leaves in them (inferred) [000:5979-5983].
    pub(super) fn called(&mut self) {
        self.now.logic = State::Done;
        self.now.word = State::Done;
        self.text = State::Done;
    }

    /// `LBL ELSE ENDI REPEAT`: a place that is reached from elsewhere.
    pub(super) fn label(&mut self) -> Option<PlcError> {
        let error = self
            .leave_brackets(PlcError::LabelInBracket)
            .or(self.is_open().then_some(PlcError::LabelInChain));
        self.start_anew();
        error
    }

    /// `EM`: an open chain is tolerated [000:5707-5710], an open bracket is not.
    pub(super) fn end(&mut self) -> Option<PlcError> {
        let error = self.leave_brackets(PlcError::BracketOpenAtEnd);
        self.start_anew();
        error
    }

    /// `EMT EMF`: a condition must have been gated.
    pub(super) fn end_if(&mut self) -> Option<PlcError> {
        self.leave_brackets(PlcError::BracketOpenAtEnd)
            .or(self.condition())
    }

    /// Opens a bracket of a gate; tells the accumulator that is buffered: the one addressed last
    /// [000:13230-13234].
    pub(super) fn open_gate(&mut self) -> (Accumulator, Option<PlcError>) {
        let accumulator = self.now.last.unwrap_or_default();
        let state = match accumulator {
            Accumulator::Logic => self.now.logic,
            Accumulator::Word => self.now.word,
        };
        let result = match accumulator {
            Accumulator::Logic => Result::Logic,
            Accumulator::Word => Result::Word,
        };
        (accumulator, self.open(result, state))
    }

    /// Opens a bracket of an arithmetic command or a comparison.
    pub(super) fn open_on_word(&mut self, result: Result) -> Option<PlcError> {
        self.open(result, self.now.word)
    }

    /// Closes a bracket; tells what it makes of its content, `None` when none is open.
    pub(super) fn close(&mut self) -> (Option<Result>, Option<PlcError>) {
        let Some(bracket) = self.brackets.pop() else {
            return (None, Some(PlcError::CloseWithoutOpen));
        };
        let inside = self.now;
        let (wanted, state) = match bracket.result {
            Result::Logic => (Accumulator::Logic, inside.logic),
            Result::Word | Result::Compared => (Accumulator::Word, inside.word),
        };
        let fits = inside.last == Some(wanted) && state != State::Unloaded;
        let touched = |inside: State, outside: State| {
            if inside == State::Unloaded {
                outside
            } else {
                State::Done
            }
        };
        self.now.logic = touched(inside.logic, bracket.outside.logic);
        self.now.word = touched(inside.word, bracket.outside.word);
        match bracket.result {
            Result::Logic => self.open_logic(),
            Result::Word => self.open_word(),
            Result::Compared => {
                self.now.word = State::Done;
                self.open_logic();
            }
        }
        let lost_chain = bracket.result == Result::Compared && bracket.outside.logic == State::Open;
        let error = if !fits {
            Some(PlcError::WrongBracketResult)
        } else if lost_chain {
            Some(PlcError::NoLogicAssignment)
        } else {
            None
        };
        (Some(bracket.result), error)
    }

    fn open(&mut self, result: Result, state: State) -> Option<PlcError> {
        // A logic chain that was assigned has ended: a gate would start a new one, so that there is nothing
        // to buffer. A word chain may go on after an assignment [000:12273].
        let begun = match result {
            Result::Logic => state == State::Open,
            Result::Word | Result::Compared => state != State::Unloaded,
        };
        let error = if !begun {
            let other_chain = result != Result::Logic && self.now.last.is_some();
            Some(if other_chain {
                PlcError::WordNotLoaded
            } else {
                PlcError::NothingLoadedAtBracket
            })
        } else if self.brackets.len() >= BRACKETS_MAX {
            Some(PlcError::BracketsTooDeep)
        } else {
            None
        };
        self.brackets.push(Bracket {
            outside: self.now,
            result,
            assigned: false,
        });
        self.now = Accumulators::default();
        error
    }

    /// Error 10, once for each bracket.
    fn inside_bracket(&mut self) -> Option<PlcError> {
        let bracket = self.brackets.last_mut()?;
        let first = !std::mem::replace(&mut bracket.assigned, true);
        first.then_some(PlcError::AssignmentInBracket)
    }

    fn text_in_bracket(&self) -> Option<PlcError> {
        self.in_bracket().then_some(PlcError::StringInBracket)
    }

    fn leave_brackets(&mut self, error: PlcError) -> Option<PlcError> {
        let outermost = self.brackets.first()?.outside;
        self.now = Accumulators {
            logic: State::Done,
            word: State::Done,
            ..outermost
        };
        self.brackets.clear();
        Some(error)
    }

    fn is_open(&self) -> bool {
        [self.now.logic, self.now.word, self.text].contains(&State::Open)
    }

    fn start_anew(&mut self) {
        self.now = Accumulators::default();
        self.text = State::Unloaded;
    }

    fn open_logic(&mut self) {
        self.now.logic = State::Open;
        self.now.last = Some(Accumulator::Logic);
    }

    fn open_word(&mut self) {
        self.now.word = State::Open;
        self.now.last = Some(Accumulator::Word);
    }
}
