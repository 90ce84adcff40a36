//! Programs of the PLC.

mod complete;
mod examine;
mod hover;
mod outline;
mod plc_source;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use bahn_plc::{LineOperand, LineWords, Nesting, line_words, listed_code, nesting, split_comment};

use crate::language::{
    Analysis, Completion, Elsewhere, Examined, Fold, Hover, Mention, Role, Symbol, Thing, Token, mentions_of,
};

use crate::world::World;

pub(crate) use plc_source::PlcSource;
use plc_source::{Line, mention};

impl Analysis for PlcSource {
    fn examine(&self, world: &World, _: &AtomicBool) -> Examined {
        examine::examine(self, world)
    }

    fn hover(&self, at: usize, _: Option<&Examined>) -> Option<Hover> {
        hover::hover(self, at)
    }

    fn mentions(&self) -> &[Mention] {
        self.mentions
            .get_or_init(|| self.words().filter_map(|(_, _, words)| mention(words)).collect())
    }

    fn elsewhere(&self, thing: &Thing, world: &World) -> Option<Elsewhere> {
        match thing {
            Thing::File(name) => examine::linked(self, name, world).map(Elsewhere::front),
            Thing::PlcLabel(name) => {
                let is_extern = |words: &LineWords| {
                    words.instruction == "EXTERN" && words.operand == LineOperand::Label(name.clone())
                };
                let declared = self.words().any(|(_, _, words)| is_extern(words));
                declared
                    .then(|| examine::label_elsewhere(self, name, world))
                    .flatten()
            }
            _ => None,
        }
    }

    fn symbols(&self) -> Vec<Symbol> {
        outline::symbols(self)
    }

    fn folds(&self) -> Vec<Fold> {
        outline::folds(self)
    }

    fn completions(&self, at: usize, world: &World) -> Vec<Completion> {
        complete::completions(self, at, world)
    }

    /// Commands, operands and comments in columns, structures indented, as `bahn plc list` shows them.
    fn formatted(&self, _: &World) -> Result<String, String> {
        const COMMENT_COLUMN: usize = 31;
        let mut formatted = String::new();
        let mut depth = 0_usize;
        let mut from = 0;
        for line in &self.lines {
            formatted += self.text.get(from..line.bytes.start);
            from = line.bytes.end;
            let text = self.text.get(line.bytes.clone());
            let (code, comment) = split_comment(text);
            let code = code.trim();
            if code.is_empty() {
                formatted += text.trim_end();
                continue;
            }
            let (command, operand) = code.split_once(char::is_whitespace).unwrap_or((code, ""));
            let nesting = nesting(command);
            let outside = matches!(nesting, Nesting::Closes | Nesting::Both);
            let listed = listed_code(command, operand.trim(), depth.saturating_sub(outside.into()));
            match nesting {
                Nesting::Closes => depth = depth.saturating_sub(1),
                Nesting::Opens => depth += 1,
                Nesting::Both | Nesting::Neither => {}
            }
            let width = if comment.is_empty() { 0 } else { COMMENT_COLUMN };
            formatted += format!("{listed:<width$}{}", comment.trim_end()).trim_end();
        }
        Ok(formatted + self.text.get(from..self.text.text.len()))
    }

    fn can_rename(&self, thing: &Thing) -> bool {
        matches!(thing, Thing::PlcLabel(_))
    }

    fn renamed(&self, thing: &Thing, new: &str, _: &World) -> Result<Vec<(Range<usize>, String)>, String> {
        let written = line_words(&format!("LBL {new}"), self.model);
        let name = match written.map(|words| words.operand) {
            Some(LineOperand::Label(name)) => name,
            _ => return Err("a label is a number from 0 to 511 or a name of up to 32 characters".to_owned()),
        };
        let taken = Thing::PlcLabel(name);
        if taken != *thing && mentions_of(self.mentions(), &taken).any(|other| other.role == Role::Sets) {
            return Err(format!("label {new} is set already"));
        }
        let known_outside = self.words().any(|(_, _, words)| {
            let is_it = mention(words).is_some_and(|mention| mention.thing == *thing);
            is_it && matches!(words.instruction, "GLOBAL" | "EXTERN")
        });
        if known_outside {
            return Err("the label is GLOBAL or EXTERN: other files know it by this name".to_owned());
        }
        let places = mentions_of(self.mentions(), thing);
        Ok(places
            .map(|place| (place.range.clone(), new.to_owned()))
            .collect())
    }

    fn tokens(&self) -> Vec<(Range<usize>, Token)> {
        let mut tokens = Vec::new();
        for line in &self.lines {
            if let Some(words) = &line.words {
                tokens.push((words.instruction_at.clone(), Token::Keyword));
                let token = match &words.operand {
                    LineOperand::Bit(_) | LineOperand::Number(_) => Token::Variable,
                    LineOperand::Constant(_) => Token::Number,
                    LineOperand::Label(_) | LineOperand::Field(_) => Token::Label,
                    LineOperand::Module(_) => Token::Function,
                    LineOperand::None | LineOperand::Text(_) | LineOperand::File(_) => Token::Text,
                };
                tokens.push((words.operand_at.clone(), token));
            }
            let code = split_comment(self.text.get(line.bytes.clone())).0;
            tokens.push((line.bytes.start + code.len()..line.bytes.end, Token::Comment));
        }
        tokens
    }
}
