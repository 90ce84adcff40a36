//! The graphics while programming: the program that is being written as lines, or the drawing of the cycle whose words
//! are asked for.

use std::sync::{Arc, Mutex};

use bahn_host::LoadedMachine;
use bahn_screen::GraphicsView;
use bahn_screen::programs::ProgramMemory;
use bahn_tnc::{Control, Programs};

use crate::contour::{self, Lines, Sketch, Wish};
use crate::drawing::LineColours;
use crate::picture::Picture;

/// Another drawing takes the place of one that is shown when it is whole, or after this time, µs (inferred).
const DRAWN_US: u64 = 300_000;

/// The drawing of a cycle: its number, and the id of the prompt that is open.
pub type Asked = (u16, &'static str);

/// The graphics while programming.
#[derive(Default)]
pub(crate) struct Programmed {
    /// The operator looks at the lines.
    on: bool,
    /// The cycle whose drawing is shown instead.
    asked: Option<Asked>,
    sketch: Option<Sketch>,
    /// What is shown until the next one has something: its lines, title and last block.
    shown: Option<(Arc<Mutex<Lines>>, String, Option<u32>)>,
    begun_us: u64,
    /// Lines of the picture that was shown last.
    lines: usize,
}

impl Programmed {
    /// Begins to draw a program.
    pub fn draw(
        &mut self,
        wish: Wish,
        control: &Control,
        machine: &LoadedMachine,
        programs: &Arc<ProgramMemory>,
        beside: bool,
    ) {
        let programs = Arc::clone(programs) as Arc<dyn Programs>;
        let settings = contour::settings(control, machine);
        self.sketch = Some(Sketch::begin(wish, settings, programs, beside));
        self.begun_us = control.time_us();
    }

    /// Whether the operator looks at the lines.
    pub fn is_on(&self) -> bool {
        self.on
    }

    /// Shows the lines, or no more.
    pub fn show(&mut self, on: bool) {
        let asked = self.asked;
        if !on {
            *self = Programmed::default();
        }
        (self.on, self.asked) = (on, asked);
    }

    /// Shows the drawing of a cycle instead, or no more; whether that is another one.
    pub fn ask(&mut self, asked: Option<Asked>) -> bool {
        std::mem::replace(&mut self.asked, asked) != asked
    }

    /// What is to be seen.
    pub fn view(&self) -> Option<GraphicsView> {
        let drawing = self.asked.map(|_| GraphicsView::Figure);
        drawing.or(self.on.then_some(GraphicsView::Lines))
    }

    /// Whether lines are still to come.
    pub fn is_drawing(&self) -> bool {
        self.sketch.as_ref().is_some_and(|sketch| !sketch.progress().1)
    }

    /// The drawing of the asked cycle, or of the programmed lines; `None` while it is off.
    pub fn picture(&self, magn: u8, turned: bool, colours: LineColours) -> Option<Picture> {
        if let Some((cycle, id)) = self.asked {
            return Picture::of_cycle(cycle, id);
        }
        let (lines, title, upto) = self.shown.as_ref().filter(|_| self.on)?;
        Some(Picture::of_lines(
            Arc::clone(lines),
            title,
            *upto,
            magn,
            turned,
            colours,
        ))
    }

    /// Goes on; whether there is another picture.
    pub fn cycle(&mut self, now_us: u64) -> bool {
        let Some(sketch) = &mut self.sketch else {
            return false;
        };
        sketch.cycle();
        let (count, ended) = sketch.progress();
        let lines = sketch.lines();
        let is_shown = self
            .shown
            .as_ref()
            .is_some_and(|(shown, ..)| Arc::ptr_eq(shown, &lines));
        let due = ended || now_us.abs_diff(self.begun_us) >= DRAWN_US;
        if !due || (is_shown && count == self.lines && !ended) {
            return false;
        }
        self.begun_us = now_us;
        self.lines = count;
        self.shown = Some((lines, format!("PGM {}", sketch.name), sketch.upto));
        if ended {
            self.sketch = None;
        }
        true
    }
}
