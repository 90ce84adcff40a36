//! What the server asks of a language, and what it answers; the same for all of them.

mod kind;
mod mention;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use bahn_text::{Diagnostic, Related, Span};

pub(crate) use kind::Kind;
pub(crate) use mention::{Mention, Role, Thing, at as mention_at, of as mentions_of};

use crate::world::World;

/// One version of a document, read in its language. Places are bytes of the text.
pub(crate) trait Analysis: Send + Sync {
    /// All that is wrong, and what is known after a run; it may take long and ends soon after `interrupt`.
    fn examine(&self, world: &World, interrupt: &AtomicBool) -> Examined;

    /// What the word at a place means.
    fn hover(&self, at: usize, examined: Option<&Examined>) -> Option<Hover>;

    /// Whether [`Analysis::hover`] has more to say after a run.
    fn hover_waits(&self, _at: usize) -> bool {
        false
    }

    /// All names that the text sets or uses, in order.
    fn mentions(&self) -> &[Mention];

    /// The place in another file to which a name leads.
    fn elsewhere(&self, _thing: &Thing, _world: &World) -> Option<Elsewhere> {
        None
    }

    /// What the text is made of.
    fn symbols(&self) -> Vec<Symbol>;

    /// What can be folded, as lines from 0.
    fn folds(&self) -> Vec<Fold>;

    /// What may be written at a place.
    fn completions(&self, at: usize, world: &World) -> Vec<Completion>;

    /// The text as it is listed; why not, where it is not.
    fn formatted(&self, world: &World) -> Result<String, String>;

    /// How a name is written that is to be another one: all of its places with the text for each.
    fn renamed(&self, thing: &Thing, new: &str, world: &World)
    -> Result<Vec<(Range<usize>, String)>, String>;

    /// Whether a name can be another one.
    fn can_rename(&self, thing: &Thing) -> bool;

    /// What can be made of the text.
    fn targets(&self) -> Vec<Target> {
        Vec::new()
    }

    /// The text in the language of a target, or why not.
    fn converted(&self, _target: &str, _world: &World) -> Result<Conversion, String> {
        Err("nothing can be made of this text".to_owned())
    }

    /// The words of the text by kind.
    fn tokens(&self) -> Vec<(Range<usize>, Token)>;
}

/// A fault of another file, at the place in this one that leads there.
pub(crate) fn led_to(fault: Diagnostic, at: Span) -> Diagnostic {
    let name = fault.file.file_name().unwrap_or_default().to_string_lossy();
    let place = match fault.block.as_str() {
        "" => format!("line {}", fault.span.line),
        block => format!("block {block}"),
    };
    let message = format!("{name}, {place}: {}", fault.message);
    Diagnostic {
        related: vec![Related {
            file: fault.file.clone(),
            span: fault.span,
            message: fault.words(),
            source: fault.source.clone(),
        }],
        span: at,
        message,
        ..fault
    }
}

/// A place in a file that may not be open: line and characters from 0.
#[derive(Clone, Debug)]
pub(crate) struct Elsewhere {
    pub(crate) path: PathBuf,
    pub(crate) line: u32,
    pub(crate) characters: Range<u32>,
}

impl Elsewhere {
    /// The front of a file.
    pub(crate) fn front(path: PathBuf) -> Elsewhere {
        Elsewhere {
            path,
            line: 0,
            characters: 0..0,
        }
    }
}

/// What examining has found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Examined {
    /// Their places are those of the document.
    pub(crate) faults: Vec<Diagnostic>,
    /// Faults that were counted only.
    pub(crate) not_listed: usize,
    /// The Q parameters at the end of a run; none where the program does not set them.
    pub(crate) values: Vec<Option<f64>>,
    /// What else has a name and a value at the end of a run; without the value where that is not known.
    pub(crate) named: BTreeMap<String, Option<f64>>,
    /// The run came to its end.
    pub(crate) complete: bool,
}

/// What a word means, as Markdown.
#[derive(Clone, Debug)]
pub(crate) struct Hover {
    pub(crate) range: Range<usize>,
    pub(crate) text: String,
}

/// What a part of a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SymbolKind {
    Program,
    Label,
    Tool,
    Cycle,
    Section,
    Parameter,
    Field,
}

/// A part of a text, with what lies in it.
#[derive(Clone, Debug)]
pub(crate) struct Symbol {
    pub(crate) name: String,
    pub(crate) detail: String,
    pub(crate) kind: SymbolKind,
    pub(crate) range: Range<usize>,
    /// What is shown of it, inside [`Symbol::range`].
    pub(crate) selection: Range<usize>,
    pub(crate) children: Vec<Symbol>,
}

/// Lines that can be folded, from 0, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fold {
    pub(crate) first: usize,
    pub(crate) last: usize,
    pub(crate) is_comment: bool,
}

/// What a completion is, for its picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CompletionKind {
    Word,
    Cycle,
    Label,
    Function,
    Parameter,
    File,
    Value,
}

/// Something that may be written.
#[derive(Clone, Debug)]
pub(crate) struct Completion {
    pub(crate) label: String,
    pub(crate) detail: String,
    pub(crate) documentation: String,
    pub(crate) kind: CompletionKind,
    /// The bytes that are replaced.
    pub(crate) range: Range<usize>,
    /// What is written, with places to fill in as `${1:prompt}`.
    pub(crate) snippet: String,
}

/// A language that a text can be converted to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    pub(crate) id: &'static str,
    /// What the action says.
    pub(crate) title: &'static str,
}

/// The text in another language.
#[derive(Clone, Debug)]
pub(crate) struct Conversion {
    /// Name of the file beside this one.
    pub(crate) file_name: String,
    pub(crate) text: String,
}

/// What a word is, for colours; the order is that of the legend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Token {
    Keyword,
    Parameter,
    Number,
    Comment,
    Text,
    Function,
    Label,
    Variable,
}

impl Token {
    /// The names in the order of the variants.
    pub(crate) const LEGEND: [&'static str; 8] = [
        "keyword", "property", "number", "comment", "string", "function", "label", "variable",
    ];
}
