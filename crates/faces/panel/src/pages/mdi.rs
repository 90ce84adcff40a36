//! POSITIONING WITH MANUAL DATA INPUT: a block is entered by dialogue and executed by NC start; it is not stored
//! [003:3564-3617].
//!
//! Decision: MDI of a TNC 360 refuses positioning blocks of several axes when they are complete; other blocks are
//! taken

use std::sync::Arc;

use bahn_dialogue::{Editor, Key, Setting};
use bahn_parameters::MessageId;
use bahn_path::Switch;
use bahn_program::{Block, Edit, MotionKind, Operation, Program};
use bahn_screen::SoftKeys;
use bahn_screen::texts;
use bahn_tnc::Command;

use crate::page::{Page, Turn, View};
use crate::pages::editing;
use crate::pages::row_after::RowAfter;
use crate::site::Site;

/// The frame in which blocks are entered.
const EMPTY: &[u8] = b"BEGIN PGM $MDI MM\nEND PGM $MDI MM\n";

/// The block that NC start executes.
#[derive(Default)]
pub(crate) struct Mdi {
    editor: Option<Editor>,
    /// The row with PNT.
    keys: RowAfter,
    /// PNT is on; `None` where the machine has no measuring probe.
    pnt: Option<bool>,
}

impl Mdi {
    fn editor(&mut self, site: &Site) -> &mut Editor {
        self.editor.get_or_insert_with(|| {
            let mut setting = Setting::of(site.parameters());
            setting.tongue = site.language();
            Editor::new(Arc::new(Program::from_bytes("$MDI", EMPTY.to_vec())), setting)
        })
    }

    /// A complete block takes the place of the one before, unless it belongs to the cycle that is there.
    fn entered(&mut self, site: &mut Site) -> Turn {
        let Some(editor) = &self.editor else {
            return Turn::Done;
        };
        let program = editor.program();
        let inner = 1..program.block_count().saturating_sub(1);
        if site.control().model().positions_one_axis_by_mdi()
            && !program.blocks().all(|own| is_of_one_axis(&own.block))
        {
            self.editor = None;
            self.editor(site);
            return Turn::Say(site.message(MessageId::EntryValueIncorrect));
        }
        let blocks: Vec<_> = inner.map(|block| program.text_of(block)).collect();
        match site.command(Command::Mdi(blocks.join("\n"))) {
            true => Turn::Done,
            false => Turn::Refused,
        }
    }

    /// A key of the row with PNT: the axes follow the stylus of a measuring probe, or do so no more [000:7907].
    fn key_after(&mut self, key: Key, site: &mut Site) -> Option<Turn> {
        let (editor, on) = (self.editor.as_ref()?, self.pnt?);
        match self.keys.place(key, editor) {
            Some(0) if site.command(Command::Pnt(Switch::from(!on))) => Some(Turn::Done),
            Some(_) => Some(Turn::Refused),
            None => self.keys.turn(key, editor),
        }
    }

    /// The next block is entered into an empty frame.
    fn clear(&mut self, site: &Site) {
        let editor = self.editor(site);
        let last = editor.program().block_count().saturating_sub(1);
        if last > 1
            && !editor.is_open()
            && let Ok(program) = editor.program().edit(&Edit::Delete { blocks: 1..last })
        {
            *editor = Editor::new(Arc::new(program), editor.setting().clone());
        }
    }
}

/// MDI of a TNC 360 positions one axis [003:3566].
fn is_of_one_axis(block: &Block) -> bool {
    block.operation.parts().iter().all(|part| match part {
        Operation::Motion(motion) => {
            matches!(motion.kind, MotionKind::Line | MotionKind::Paraxial)
                && motion.coordinates.axes().iter().count() <= 1
        }
        _ => true,
    })
}

impl Page for Mdi {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(turn) = self.key_after(key, site) {
            return turn;
        }
        let opens = matches!(
            key.group(),
            bahn_dialogue::KeyGroup::Contour | bahn_dialogue::KeyGroup::Tool | bahn_dialogue::KeyGroup::Axis
        ) || matches!(
            key,
            Key::CyclDef | Key::CyclCall | Key::Stop | Key::TouchProbe | Key::Q
        );
        if opens {
            self.clear(site);
        }
        let (turn, changed) = editing::key(self.editor(site), key, site);
        match changed {
            true => self.entered(site),
            false => turn,
        }
    }

    fn text(&mut self, text: &str, site: &mut Site) -> Turn {
        let frame = format!("BEGIN PGM $MDI MM\n{}\nEND PGM $MDI MM\n", text.trim());
        let setting = self.editor(site).setting().clone();
        let program = Program::from_bytes("$MDI", frame.into_bytes());
        self.editor = Some(Editor::new(Arc::new(program), setting));
        self.entered(site)
    }

    fn own_soft_keys(&self) -> Option<SoftKeys> {
        let editor = self.editor.as_ref()?;
        let Some(on) = self.pnt else {
            return Some(editing::soft_keys(editor));
        };
        let text = if on { "PNT OFF" } else { "PNT ON" };
        let words = || vec![texts::words(editor.setting().tongue, text).to_owned()];
        Some(self.keys.show(editor, words))
    }

    fn show(&self, _site: &Site, lines: usize) -> View {
        match &self.editor {
            Some(editor) => editing::view(editor, "$MDI", lines),
            None => View::default(),
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        self.editor(site);
        let on = site.control().first().follows_stylus();
        self.pnt = site.parameters().measuring_probe().map(|_| on);
        Turn::Done
    }
}
