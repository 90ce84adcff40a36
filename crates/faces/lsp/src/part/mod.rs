//! Part programs: plain language and DIN/ISO.

mod complete;
mod convert;
mod examine;
mod hover;
mod mentions;
mod outline;
mod part_program;
mod words;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use bahn_program::{FormatOptions, WordKind, format_program};

use crate::language::{
    Analysis, Completion, Conversion, Elsewhere, Examined, Fold, Hover, Mention, Symbol, Target, Thing, Token,
};

use crate::world::World;

pub(crate) use part_program::PartProgram;
use part_program::{PROGRAM_CYCLE, ReadBlock};

impl Analysis for PartProgram {
    fn examine(&self, world: &World, interrupt: &AtomicBool) -> Examined {
        examine::examine(self, world, interrupt)
    }

    fn hover(&self, at: usize, examined: Option<&Examined>) -> Option<Hover> {
        hover::hover(self, at, examined)
    }

    fn hover_waits(&self, at: usize) -> bool {
        let mention = crate::language::mention_at(self.mentions(), at);
        mention.is_some_and(|mention| matches!(mention.thing, Thing::Q(_)))
    }

    fn mentions(&self) -> &[Mention] {
        self.mentions.get_or_init(|| mentions::mentions(self))
    }

    fn elsewhere(&self, thing: &Thing, world: &World) -> Option<Elsewhere> {
        match thing {
            Thing::File(name) => world.called(name, &self.path).map(Elsewhere::front),
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

    fn formatted(&self, world: &World) -> Result<String, String> {
        if !self.program.begins_with_header() {
            let [begin, _] = self.language().frames();
            return Err(format!(
                "the text does not begin with {begin}, so it may be no program"
            ));
        }
        let options = FormatOptions {
            decimal_comma: world.settings.comma,
            iso_step: world.settings.iso_step,
        };
        Ok(format_program(&self.program, options).to_string())
    }

    fn can_rename(&self, thing: &Thing) -> bool {
        matches!(thing, Thing::Label(_))
    }

    fn renamed(&self, thing: &Thing, new: &str, _: &World) -> Result<Vec<(Range<usize>, String)>, String> {
        let max = self.model.limits().label_max;
        let number = new.parse::<u16>().ok();
        let number = number.filter(|number| (1..=max).contains(&u32::from(*number)));
        let number = number.ok_or_else(|| format!("label numbers go from 1 to {max}"))?;
        if let Some(block) = self.program.label(number) {
            let block = self.program.number_of(block);
            return Err(format!("label {number} is set in block {block} already"));
        }
        let places = crate::language::mentions_of(self.mentions(), thing);
        Ok(places
            .map(|place| (place.range.clone(), number.to_string()))
            .collect())
    }

    fn targets(&self) -> Vec<Target> {
        convert::targets(self)
    }

    fn converted(&self, target: &str, world: &World) -> Result<Conversion, String> {
        convert::converted(self, target, world)
    }

    fn tokens(&self) -> Vec<(Range<usize>, Token)> {
        let words = self.each().flat_map(|block| block.words);
        let mut tokens = Vec::new();
        for word in words {
            let own = match word.kind {
                WordKind::Number => Token::Label,
                WordKind::Skip | WordKind::Function => Token::Keyword,
                WordKind::Address => Token::Parameter,
                WordKind::Value => Token::Number,
                WordKind::Text => Token::Text,
                WordKind::Comment => Token::Comment,
            };
            if word.kind == WordKind::Address && !word.value.is_empty() && word.value.start > word.span.start
            {
                let value = self.text.get(word.value.clone());
                let is_q = value.contains(['Q', 'q']);
                tokens.push((word.span.start..word.value.start, own));
                tokens.push((word.value, if is_q { Token::Variable } else { Token::Number }));
            } else {
                tokens.push((word.span, own));
            }
        }
        tokens
    }
}
