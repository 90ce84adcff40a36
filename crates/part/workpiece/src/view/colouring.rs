//! What the colours of the views mean.

use super::Page;
use super::legend::{DepthShade, Legend, Swatch, hatched};
use super::light::{is_outline, screen, to_linear};
use super::raycast::{Face, Hit, Vector};
use super::scheme::Pens;
use crate::cutters::Cutter;
use crate::part::Part;
use bahn_picture::{Colour, mix};

/// What the colours of a view tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colouring {
    /// The skin of the blank and what was machined.
    #[default]
    Part,
    /// The height: the deeper, the darker.
    Depth,
    /// The tool that cut last, and cuts in rapid traverse. All is one colour unless
    /// [`Workpiece::remember_tools`](crate::Workpiece::remember_tools) was called.
    Tool,
}

/// A tool that the part knows, with its marks ([`Part::marks`](crate::Part::marks)) and colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CutBy {
    /// Its number; `None` for what was in the spindle before the first TOOL CALL.
    pub tool: Option<u32>,
    /// The marks of columns that it cut last: in feed, in rapid traverse.
    pub marks: [u8; 2],
    /// The colours of [`Colouring::Tool`] for both.
    pub colours: [Colour; 2],
}

impl Part {
    /// The tools whose marks it may have, in the order of their first call; empty when none are remembered.
    pub fn cutters(&self) -> Vec<CutBy> {
        let known = self.cutters.iter().flat_map(|cutters| cutters.known());
        known
            .map(|(tool, marks)| CutBy {
                tool,
                marks,
                colours: marks.map(|mark| Cutter::of(mark).map_or(NO_TOOL, tool_colour)),
            })
            .collect()
    }
}

/// The colours of a part.
pub(super) struct Palette<'a> {
    part: &'a Part,
    colouring: Colouring,
    depths: DepthShade,
    pens: Pens,
    /// What is looked at from above, from the front and from the side, where a scheme says so.
    faces: Option<[Colour; 3]>,
}

impl<'a> Palette<'a> {
    /// `levels` of brightness for depths, 0 for a continuous scale.
    pub fn new(part: &'a Part, colouring: Colouring, levels: u8, page: &Page) -> Palette<'a> {
        let faces = page.scheme.map(|scheme| scheme.faces);
        Palette {
            part,
            colouring,
            depths: DepthShade::new(part, levels, faces.map(|[top, ..]| top)),
            pens: page.pens(),
            faces,
        }
    }

    /// What is seen where there is no column.
    pub fn background(&self) -> Colour {
        self.pens.background
    }

    /// Colour of a column seen from above; `stripe` counts pixels along a diagonal, for the hatching of holes.
    pub fn column_colour(&self, i: usize, j: usize, stripe: usize) -> Colour {
        let part = self.part;
        let height = part.height(i, j);
        if height <= 0.0 {
            return hatched(stripe, self.pens.background);
        }
        let colour = match self.colouring {
            Colouring::Depth => self.depths.colour(height),
            _ if height >= part.top() => screen(SKIN),
            Colouring::Part => screen(CUT),
            Colouring::Tool => self.cutter_of(i, j).map_or(screen(CUT), tool_colour),
        };
        // A line of shadow where a wall stands, so that neighbours of one level do not run together.
        let wall = 6.0 * part.grid.cell() as f32;
        let higher = |i: usize, j: usize| part.height(i, j) > height + wall;
        let edge = higher(i + 1, j)
            || higher(i, j + 1)
            || (i > 0 && higher(i - 1, j))
            || (j > 0 && higher(i, j - 1));
        if edge { mix(colour, EDGE, 0.4) } else { colour }
    }

    /// The linear light of a surface in the colours of a scheme, which know no lamp: a slope has part of the colour of
    /// each face. `None` in colours of our own, and where tools are told apart.
    pub fn flat(&self, normal: Vector, front: usize) -> Option<[f64; 3]> {
        let faces = self.faces.filter(|_| self.colouring != Colouring::Tool)?;
        let side = 1 - front;
        let shares = [normal[2], normal[front], normal[side]].map(|part| part * part);
        let mut light = [0.0; 3];
        for (share, face) in shares.into_iter().zip(faces.map(to_linear)) {
            for (light, face) in light.iter_mut().zip(face) {
                *light += share * face;
            }
        }
        Some(light)
    }

    /// Colour of the material that a ray meets: linear red, green, blue.
    pub fn material(&self, point: Vector, hit: &Hit) -> [f64; 3] {
        let part = self.part;
        let skin = match hit.face {
            Face::Top => part.height(hit.i, hit.j) >= part.top(),
            Face::Side(axis) => is_outline(part, point, axis),
            Face::Bottom => true,
        };
        match self.colouring {
            _ if skin => SKIN,
            Colouring::Part => CUT,
            Colouring::Depth => to_linear(self.depths.colour(point[2] as f32)),
            Colouring::Tool => self.cutter(point, hit).map_or(CUT, |c| to_linear(tool_colour(c))),
        }
    }

    /// Who cut what a ray meets: a wall is left by the one that cut the column before it.
    fn cutter(&self, point: Vector, hit: &Hit) -> Option<Cutter> {
        let grid = &self.part.grid;
        let mut column = [hit.i, hit.j];
        if let Face::Side(axis) = hit.face {
            let step = [grid.dx, grid.dy];
            let (at, size) = (column.get_mut(axis)?, step.get(axis)?);
            *at = if point[axis] < (*at as f64 + 0.5) * size {
                at.checked_sub(1)?
            } else {
                *at + 1
            };
        }
        self.cutter_of(column[0], column[1])
    }

    fn cutter_of(&self, i: usize, j: usize) -> Option<Cutter> {
        self.part.cutters.as_ref()?.at(j * self.part.grid.nx + i)
    }

    /// What the colours mean, when they need a word.
    pub fn legend(&self) -> Option<Legend> {
        match self.colouring {
            Colouring::Part => None,
            Colouring::Depth => Some(self.depths.legend()),
            Colouring::Tool => {
                let cutters = self.part.cutters.as_ref()?;
                let mut seen = cutters.seen();
                seen.sort_by_key(|cutter| cutters.tool(cutter.index));
                let name = |cutter: &Cutter| match cutters.tool(cutter.index) {
                    Some(number) => format!("T{number}"),
                    None => "no tool call".to_owned(),
                };
                let mut fields: Vec<(Swatch, String)> = seen
                    .iter()
                    .filter(|cutter| !cutter.rapid)
                    .map(|cutter| (Swatch::Plain(tool_colour(*cutter)), name(cutter)))
                    .collect();
                if seen.iter().any(|cutter| cutter.rapid) {
                    fields.push((Swatch::Plain(RAPID_CUT), "rapid traverse".to_owned()));
                }
                let title = "tools".to_owned();
                (!fields.is_empty()).then_some(Legend { title, fields })
            }
        }
    }
}

fn tool_colour(cutter: Cutter) -> Colour {
    if cutter.rapid {
        return RAPID_CUT;
    }
    // The first mark is what cuts before any TOOL CALL.
    let Some(place) = cutter.index.checked_sub(1) else {
        return NO_TOOL;
    };
    let plain = TOOLS[place % TOOLS.len()];
    // The next rounds are darker, then lighter.
    match place / TOOLS.len() % 3 {
        0 => plain,
        1 => mix(plain, [0; 3], 0.35),
        _ => mix(plain, [255; 3], 0.45),
    }
}

/// The blank as it came, and where a tool was: linear red, green, blue of steel blue and brass.
const SKIN: [f64; 3] = [0.243, 0.320, 0.443];
const CUT: [f64; 3] = [0.812, 0.612, 0.293];
/// What a wall throws its shadow with.
const EDGE: Colour = [45, 55, 68];
const RAPID_CUT: Colour = [222, 36, 36];
const NO_TOOL: Colour = [176, 176, 172];
/// Easily told from each other, from the skin and from red.
const TOOLS: [Colour; 9] = [
    [232, 190, 106],
    [64, 168, 150],
    [158, 120, 200],
    [140, 184, 76],
    [222, 138, 182],
    [164, 116, 78],
    [112, 196, 226],
    [226, 220, 104],
    [92, 104, 176],
];
