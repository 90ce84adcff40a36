//! Graphics of TEST RUN and program run [003:854-945]: a part that is cut while a program is tested, another one that is
//! cut while it runs, and how the operator looks at them.
//!
//! - `stock` is the part that is being cut, which pictures are made of meanwhile;
//! - `trial` tests a program with it, `follow` cuts what the machine has executed;
//! - `contour` is a program that is being written as lines, `drawing` their picture; `figure` draws the cycle that
//!   is asked for.
//!
//! By the clock on the wall both cut on threads of their own; by the free clock with the machine, so that the same
//! inputs give the same screens.

mod contour;
mod drawing;
mod figure;
mod follow;
mod picture;
mod stock;
mod trial;

use std::sync::{Arc, Mutex};

use bahn_control::{Control, Programs};
use bahn_dialogue::Key;
use bahn_host::{Host, LoadedMachine};
use bahn_parameters::machining::GraphicsSettings;

use crate::programs::ProgramMemory;

use crate::screen::{GraphicsLine, GraphicsView};
pub use picture::Picture;
pub(crate) use picture::Sight;

pub(crate) use contour::Wish;
use contour::{Lines, Sketch};
use follow::Follower;
use trial::Trial;

/// Between two pictures of a part that is being cut, µs (inferred).
const EVERY_US: u64 = 500_000;
/// A section moves by this part of the blank with each arrow key (inferred).
const SECTION_STEP: f64 = 0.05;
/// Magnifications that MAGN goes through (inferred) [003:940-945].
const MAGNIFICATIONS: [u8; 3] = [1, 2, 4];

/// Which part is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    /// That of TEST RUN.
    Test,
    /// That of the program run.
    Run,
    /// The program that is being written, as lines.
    Contour,
}

/// Another drawing takes the place of one that is shown when it is whole, or after this time, µs (inferred).
const DRAWN_US: u64 = 300_000;

/// The drawing of a cycle: its number, and the id of the prompt that is open.
pub(crate) type Asked = (u16, &'static str);

/// The graphics while programming.
#[derive(Default)]
struct Programmed {
    /// The operator looks at them.
    on: bool,
    sketch: Option<Sketch>,
    /// What is shown until the next one has something: its lines, title and last block.
    shown: Option<(Arc<Mutex<Lines>>, String, Option<u32>)>,
    begun_us: u64,
    /// Lines of the picture that was shown last.
    lines: usize,
}

/// The graphics of a station.
pub(crate) struct Graphics {
    trial: Option<Trial>,
    programmed: Programmed,
    /// The cycle whose drawing is shown.
    asked: Option<Asked>,
    follower: Follower,
    /// How it is looked at; `None` shows the program alone.
    view: Option<GraphicsView>,
    sight: Sight,
    /// Threads cut, not the machine's own one.
    beside: bool,
    serial: u64,
    /// What the last picture showed, and when it was made.
    shown: (u64, u64),
}

impl Graphics {
    /// Those of a machine that was switched on.
    pub fn new(host: &mut Host) -> Graphics {
        host.keep_path();
        Graphics {
            trial: None,
            programmed: Programmed::default(),
            asked: None,
            follower: Follower::default(),
            view: None,
            sight: Sight::default(),
            beside: false,
            serial: 0,
            shown: (0, 0),
        }
    }

    /// Cuts on threads from now on.
    pub fn run_beside(&mut self) {
        self.beside = true;
    }

    /// Once in every contour cycle.
    pub fn cycle(&mut self, host: &mut Host) {
        self.follower.cycle(host, self.beside);
        if let Some(trial) = &mut self.trial {
            trial.cycle();
        }
        let now_us = host.control().time_us();
        self.serial += u64::from(self.programmed.cycle(now_us));
        let progress = self.trial.as_ref().map(Trial::progress).unwrap_or_default();
        let cut = progress.elements + self.follower.elements();
        let (seen, then_us) = self.shown;
        if cut != seen && (progress.ended || now_us.abs_diff(then_us) >= EVERY_US) {
            self.shown = (cut, now_us);
            self.serial += 1;
        }
    }

    /// Begins the test of a program that the control has just begun to test, with the whole blank.
    pub fn test(&mut self, control: &Control) {
        self.stop();
        self.trial = Trial::begin(control, self.beside);
        self.serial += 1;
    }

    /// Breaks the test off; what was cut stays to be seen.
    pub fn stop(&mut self) {
        if let Some(trial) = &mut self.trial {
            trial.stop();
        }
    }

    /// A test that came upon something that cannot be shown, told once.
    pub fn cannot_be_shown(&mut self) -> bool {
        self.trial.as_mut().is_some_and(Trial::cannot_be_shown)
    }

    /// The machine was brought to another moment: what it had cut by then is not known.
    pub fn machine_is_elsewhere(&mut self) {
        self.follower = Follower::default();
        self.serial += 1;
    }

    /// Draws a program that is being written.
    pub fn draw(
        &mut self,
        wish: Wish,
        control: &Control,
        machine: &LoadedMachine,
        programs: &Arc<ProgramMemory>,
    ) {
        let programs = Arc::clone(programs) as Arc<dyn Programs>;
        let sketch = Sketch::begin(wish, contour::settings(control, machine), programs, self.beside);
        self.programmed.sketch = Some(sketch);
        self.programmed.begun_us = control.time_us();
    }

    /// Shows what is being written beside the program, or no more.
    pub fn show_programmed(&mut self, on: bool) {
        self.programmed.on = on;
        if !on {
            self.programmed = Programmed::default();
        }
        self.serial += 1;
    }

    /// Shows the drawing of a cycle instead, or no more.
    pub fn show_cycle(&mut self, asked: Option<Asked>) {
        self.serial += u64::from(self.asked != asked);
        self.asked = asked;
    }

    /// Whether it is shown.
    pub fn shows_programmed(&self) -> bool {
        self.programmed.on
    }

    /// Takes a key; `false` when it is not for the graphics.
    pub fn key(&mut self, cut: Cut, key: Key) -> bool {
        if cut == Cut::Contour {
            let taken = key == Key::Magn && self.programmed.on && self.magnify();
            self.serial += u64::from(taken);
            return taken;
        }
        if key == Key::Graphics {
            self.view = match self.view {
                None => Some(GraphicsView::Plan),
                Some(GraphicsView::Plan) => Some(GraphicsView::ThreePlanes),
                Some(GraphicsView::ThreePlanes) => Some(GraphicsView::Solid),
                Some(GraphicsView::Solid | GraphicsView::Lines | GraphicsView::Figure) => None,
            };
            self.serial += 1;
            return true;
        }
        let Some(view) = self.view else { return false };
        let taken = match (key, view) {
            (Key::BlkForm, _) => self.restore(cut),
            (Key::Magn, _) => self.magnify(),
            (Key::Left, GraphicsView::Solid) => self.turn(-1),
            (Key::Right, GraphicsView::Solid) => self.turn(1),
            (Key::Up, GraphicsView::Solid) => self.stretch(true),
            (Key::Down, GraphicsView::Solid) => self.stretch(false),
            (Key::Left, GraphicsView::ThreePlanes) => self.shift(0, -SECTION_STEP),
            (Key::Right, GraphicsView::ThreePlanes) => self.shift(0, SECTION_STEP),
            (Key::Down, GraphicsView::ThreePlanes) => self.shift(1, -SECTION_STEP),
            (Key::Up, GraphicsView::ThreePlanes) => self.shift(1, SECTION_STEP),
            _ => false,
        };
        self.serial += u64::from(taken);
        taken
    }

    /// GRAPHICS and BLK FORM: the programmed blank is whole again [003:931-935].
    fn restore(&mut self, cut: Cut) -> bool {
        match cut {
            Cut::Test => {
                self.stop();
                if let Some(trial) = &self.trial {
                    trial.stock().restore();
                }
            }
            Cut::Run => self.follower.restore(),
            Cut::Contour => {}
        }
        true
    }

    fn magnify(&mut self) -> bool {
        let place = MAGNIFICATIONS.iter().position(|magn| *magn == self.sight.magn);
        let next = place.map_or(0, |place| (place + 1) % MAGNIFICATIONS.len());
        self.sight.magn = MAGNIFICATIONS.get(next).copied().unwrap_or(1);
        true
    }

    fn turn(&mut self, quarters: i8) -> bool {
        self.sight.quarter = (self.sight.quarter as i8 + quarters).rem_euclid(4) as u8;
        true
    }

    fn stretch(&mut self, stretched: bool) -> bool {
        self.sight.stretched = stretched;
        true
    }

    fn shift(&mut self, axis: usize, by: f64) -> bool {
        if let Some(section) = self.sight.sections.get_mut(axis) {
            // Whole steps: as many back lead to the same place.
            *section = (((*section + by) / SECTION_STEP).round() * SECTION_STEP).clamp(0.0, 1.0);
        }
        true
    }

    /// What the screen says of it; `None` while the operator looks at the program alone.
    pub fn line(&self, cut: Cut) -> Option<GraphicsLine> {
        if cut == Cut::Contour {
            let drawing = self.asked.map(|_| GraphicsView::Figure);
            let view = drawing.or(self.programmed.on.then_some(GraphicsView::Lines));
            return view.map(|view| GraphicsLine {
                view,
                running: self
                    .programmed
                    .sketch
                    .as_ref()
                    .is_some_and(|sketch| !sketch.progress().1),
                progress: 0.0,
                machining_time_s: None,
                magn: self.sight.magn,
                azimuth_deg: 0.0,
                sections: self.sight.sections,
                serial: self.serial,
            });
        }
        let view = self.view?;
        let progress = self.trial.as_ref().map(Trial::progress).unwrap_or_default();
        let test = cut == Cut::Test;
        Some(GraphicsLine {
            view,
            running: test && self.trial.is_some() && !progress.ended,
            progress: if test { progress.part } else { 0.0 },
            machining_time_s: test.then_some(progress.machining_time_s),
            magn: self.sight.magn,
            azimuth_deg: self.sight.azimuth_deg(),
            sections: self.sight.sections,
            serial: self.serial,
        })
    }

    /// What is to be seen, to be drawn by whoever wants it; `None` as with [`Graphics::line`], and without a part.
    pub fn picture(&self, cut: Cut, settings: &GraphicsSettings) -> Option<Picture> {
        if let (Cut::Contour, Some((cycle, id))) = (cut, self.asked) {
            return Picture::of_cycle(cycle, id);
        }
        if cut == Cut::Contour {
            let (lines, title, upto) = self.programmed.shown.as_ref().filter(|_| self.programmed.on)?;
            let (magn, turned) = (self.sight.magn, settings.plane_rotated);
            return Some(Picture::of_lines(Arc::clone(lines), title, *upto, magn, turned));
        }
        let view = self.view?;
        let (stock, program, time_s) = match cut {
            Cut::Test => {
                let trial = self.trial.as_ref()?;
                let time_s = trial.progress().machining_time_s;
                (trial.stock(), trial.program(), Some(time_s))
            }
            Cut::Run | Cut::Contour => (self.follower.stock()?, self.follower.program(), None),
        };
        Some(Picture::new(
            stock,
            program,
            time_s,
            view,
            self.sight,
            settings.third_angle,
        ))
    }
}

impl Programmed {
    /// Goes on; whether there is another picture.
    fn cycle(&mut self, now_us: u64) -> bool {
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
