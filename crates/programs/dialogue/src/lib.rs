//! Programming by dialogue: the operator's editor, without screen, files or threads.
//!
//! The face of this room:
//! - [`Key`]: every key of the control, by name, with what it does;
//! - [`Editor`]: takes keys, changes a program, and says with [`View`] what is to be shown;
//! - [`Reaction`]: what a key did;
//! - [`Setting`]: what an editor has to know of its control and machine, [`BuilderCycle`] its own cycles;
//! - [`Draft`]: what is still open, to be kept and taken up again;
//! - [`figure`]: the drawing of a cycle, in which the word that is asked for stands out;
//! - [`cycle_template`]: the blocks of a cycle with what is asked for in them;
//! - programs in DIN/ISO are entered as text by the same [`Editor`], with numbers, checks and messages of the control;
//! - [`prompts`]: the texts of the dialogue in English and German.
//!
//! ```
//! use std::sync::Arc;
//! use bahn_dialogue::{Editor, Key, Reaction, Setting};
//! use bahn_parameters::{ControlModel, MessageId, ParameterList};
//! use bahn_program::Program;
//!
//! let setting = Setting::of(&ParameterList::reference(ControlModel::Tnc360));
//! let program = Program::from_bytes("7.H", b"0 BEGIN PGM 7 MM\n1 END PGM 7 MM\n".to_vec());
//! let mut editor = Editor::new(Arc::new(program), setting);
//! let mut keys = |names: &str| {
//!     let keys = names.split(' ').filter_map(Key::from_name);
//!     let last = keys.map(|key| editor.key(key)).last();
//!     (last.unwrap(), editor.view(4, 4))
//! };
//!
//! // Tapping, chosen by its number; a sign that differs from that of the set-up clearance is refused.
//! let (_, view) = keys("CYCL_DEF GOTO 2 ENT SIGN 2 ENT 1 5");
//! assert_eq!(view.question.unwrap().prompt, "THREAD DEPTH?");
//! let wrong = MessageId::WrongSignProgrammed;
//! assert_eq!(keys("ENT").0, Reaction::Refused(wrong));
//! let (reaction, view) = keys("SIGN ENT 0 ENT 1 0 0 ENT");
//! assert_eq!(reaction, Reaction::Edited);
//! assert_eq!(view.rows[2].text, "CYCL DEF 2.2 DEPTH -15");
//!
//! // A value that is highlighted is overwritten; an arrow confirms it.
//! keys("RIGHT RIGHT 2 5 0 RIGHT");
//! assert_eq!(editor.program().text_of(5), "CYCL DEF 2.4 F250");
//! ```

mod blocks;
mod capture;
mod check;
mod cycles;
mod dialogue;
mod draft;
mod editor;
mod entry;
mod field;
mod figure;
mod highlight;
mod history;
mod iso;
mod key;
mod line;
mod menu;
mod prompt;
mod reaction;
mod reading;
mod section;
mod setting;
mod show;
mod soft_keys;
mod template;
#[cfg(test)]
mod tests;
mod typing;
mod view;

use cycles::OEM_CYCLES;
pub use draft::{Draft, NoDraft};
pub use editor::Editor;
pub use field::Word;
pub use figure::{FIGURE_SIZE, FigurePart, Shape, figure};
pub use key::{Key, KeyGroup, Tongue};
pub use prompt::{Prompt, prompts};
pub use reaction::{Reaction, Wanted};
pub use setting::{BuilderCycle, Setting};
pub use template::{TemplatePart, cycle_template};
pub use view::{List, Question, Row, ShownWord, View};
