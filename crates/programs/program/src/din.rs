//! DIN 66025 (`.nc` of a TF5200, `.900` of a System 900), as far as its text goes: where its blocks stand and how they are
//! numbered. What they do other rooms read and execute; here, as a part of a program of the control, each is refused.
//!
//! Decision: CALL PGM, the dialogue and blockwise transfer refuse a `.nc` program that does not begin with BEGIN PGM, and
//! each `.900` program, as FUNCTION NOT YET SUPPORTED: its words mean other things in plain language
//! (also `program/src/grow.rs`)

use bahn_parameters::{Limits, MessageId};

use crate::dialect::DinLanguage;
use crate::format::FormatOptions;
use crate::language::{Landmark, Language, WordKind, WordSpan};
use crate::lines::{BlockText, Lines, RawBlock};
use crate::text::{character_count, is_blank, to_text};
use crate::{Block, BlockError, InvalidBlock, Operation};

impl DinLanguage {
    /// Why no block of it is executed as one of the control's own languages.
    fn refused(self) -> &'static str {
        match self {
            DinLanguage::Tf5200 => {
                "a program of DIN 66025 runs by itself from the program memory: it is neither called nor executed while \
                 it is transferred"
            }
            DinLanguage::System900 => "a program of the System 900 runs on a machine with that control alone",
        }
    }

    /// What to do about it.
    fn help(self) -> &'static str {
        match self {
            DinLanguage::Tf5200 => {
                "Run the program by itself, or write what it does in the language of the control."
            }
            DinLanguage::System900 => {
                "Name the folder of such a machine: `bahn test P1000.900 --machine DIR`."
            }
        }
    }

    fn fault(self, text: BlockText<'_>) -> BlockError {
        BlockError {
            message: MessageId::BlockNotSupported,
            line: 0,
            column: 1,
            length: character_count(text.bytes).max(1),
            detail: self.refused().into(),
            help: Some(self.help()),
        }
    }

    /// Where the number of a block stands: its `N`, its digits, and the byte after them.
    fn number_at(self, text: &[u8]) -> Option<(usize, usize, usize)> {
        let after_blanks = |from: usize| {
            let blanks = text.get(from..)?.iter().take_while(|byte| is_blank(**byte));
            Some(from + blanks.count())
        };
        let start = match after_blanks(0)? {
            // The block may be skipped.
            skip if self == DinLanguage::System900 && text.get(skip) == Some(&b'/') => {
                after_blanks(skip + 1)?
            }
            start => start,
        };
        if !text.get(start)?.eq_ignore_ascii_case(&b'N') {
            return None;
        }
        let digits = after_blanks(start + 1)?;
        let count = text
            .get(digits..)?
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        (count > 0).then_some((start, digits, digits + count))
    }
}

impl Language for DinLanguage {
    fn name(&self) -> &'static str {
        match self {
            DinLanguage::Tf5200 => "DIN 66025",
            DinLanguage::System900 => "System 900",
        }
    }

    fn dialect(&self) -> Option<DinLanguage> {
        Some(*self)
    }

    fn refuses(&self, _first_block: BlockText<'_>) -> Option<String> {
        Some(self.refused().to_owned())
    }

    fn next_block(&self, lines: &mut Lines<'_>) -> Option<RawBlock> {
        lines.next_with_text()
    }

    fn landmark(&self, _text: BlockText<'_>) -> Option<Landmark> {
        None
    }

    fn read(&self, text: BlockText<'_>, _may_begin: bool, block: &mut Block) {
        *block = Block {
            operation: Operation::Invalid(Box::new(InvalidBlock {
                text: to_text(text.bytes).into_boxed_str(),
                error: self.fault(text),
            })),
            ..Block::EMPTY
        };
    }

    fn faults(&self, text: BlockText<'_>, _may_begin: bool) -> Vec<BlockError> {
        vec![self.fault(text)]
    }

    fn words(&self, text: BlockText<'_>) -> Vec<WordSpan> {
        let end = text.bytes.len();
        let number = self.number_at(text.bytes).map(|(start, digits, after)| WordSpan {
            kind: WordKind::Number,
            span: start..after,
            value: digits..after,
        });
        let after = number.as_ref().map_or(0, |number| number.span.end);
        let rest = (after < end).then_some(WordSpan {
            kind: WordKind::Text,
            span: after..end,
            value: end..end,
        });
        number.into_iter().chain(rest).collect()
    }

    fn stands_alone(&self, text: BlockText<'_>) -> bool {
        let first = text.bytes.iter().find(|byte| !is_blank(**byte));
        match self {
            DinLanguage::Tf5200 => first == Some(&b';'),
            DinLanguage::System900 => matches!(first, Some(b';' | b'{')),
        }
    }

    fn write(&self, block: &Block, _options: FormatOptions, text: &mut String) {
        if let Operation::Invalid(invalid) = &block.operation {
            text.push_str(&invalid.text);
        }
    }

    fn write_number(&self, text: BlockText<'_>, _number: u32, _step: u32, new: &mut Vec<u8>) {
        new.extend_from_slice(text.bytes);
    }

    fn write_line_number(&self, _number: u32, _block: &Block, _options: FormatOptions, _text: &mut String) {}

    fn number(&self, text: BlockText<'_>) -> Option<u32> {
        let (_, digits, after) = self.number_at(text.bytes)?;
        let digits = std::str::from_utf8(text.bytes.get(digits..after)?).ok()?;
        digits.parse().ok()
    }

    /// A head begins with `%` [004:60], that of a subroutine with `%L` (public); programs of a System 900 have none.
    fn begins_subroutine(&self, text: BlockText<'_>) -> Option<bool> {
        if *self == DinLanguage::System900 {
            return None;
        }
        let head = text.bytes.trim_ascii().strip_prefix(b"%")?;
        let name = head.split(|byte| b";(".contains(byte)).next()?.trim_ascii();
        let word = name.split(u8::is_ascii_whitespace).next()?;
        Some(word.eq_ignore_ascii_case(b"L"))
    }

    fn has_numbers(&self) -> bool {
        true
    }

    fn characters_max(&self, _limits: &Limits) -> Option<u32> {
        None
    }

    fn frames(&self) -> [&'static str; 2] {
        match self {
            DinLanguage::Tf5200 => ["%NAME", "M30"],
            DinLanguage::System900 => ["N10", "M30"],
        }
    }
}
