//! The colours of a sheet.
//!
//! Decision: The 3D view in the colours of MP7360 knows no lamp: a slope has part of the colour of each face, the
//! front is the face that is nearer to the eye; the plan view has the colours that it has among the three planes,
//! darker with the depth; MP7362.1 to .3 are those of the line above a part (also `graphics/src/graphics.rs`)

use bahn_picture::{Colour, mix};

/// The colours of a control's graphics, which its machine parameters name [000:6344-6360]. Without one a sheet is drawn
/// in colours of our own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scheme {
    /// Colour behind the part.
    pub background: Colour,
    /// Words, rulers and lines over the part.
    pub text: Colour,
    /// What is looked at: from above, from the front, from the side.
    pub faces: [Colour; 3],
    /// The title line: background, words, values.
    pub title: [Colour; 3],
}

/// What lines and words are drawn with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pens {
    pub background: Colour,
    /// Words, frames and edges.
    pub ink: Colour,
    /// Lines that are not to be seen first.
    pub faint: Colour,
    /// Colour of sectional planes.
    pub section: Colour,
    /// The face of a section and its hatching.
    pub cut: [Colour; 2],
    /// What is seen behind a section, near and far.
    pub farther: [Colour; 2],
}

/// Our own: ink on paper.
const OWN: Pens = Pens {
    background: [252, 252, 250],
    ink: [45, 55, 68],
    faint: [150, 160, 172],
    section: [190, 48, 44],
    cut: [[240, 222, 180], [176, 132, 62]],
    farther: [[186, 200, 214], [232, 237, 242]],
};

impl Pens {
    /// Those of a scheme, or our own.
    pub fn of(scheme: Option<Scheme>) -> Pens {
        scheme.map_or(OWN, |scheme| scheme.pens())
    }
}

impl Scheme {
    fn pens(&self) -> Pens {
        let front = self.faces[1];
        let back = |share| mix(front, self.background, share);
        Pens {
            background: self.background,
            ink: self.text,
            faint: mix(self.text, self.background, 0.5),
            section: self.text,
            cut: [front, back(0.5)],
            farther: [back(0.4), back(0.8)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Page;
    use bahn_picture::Image;

    /// MP7362.1 to .3 [000:6356-6360], and what is behind the part and over it.
    #[test]
    fn the_line_above_a_part_has_the_colours_of_mp7362() {
        let scheme = Scheme {
            background: [1, 0, 0],
            text: [2, 0, 0],
            faces: [[3, 0, 0], [4, 0, 0], [5, 0, 0]],
            title: [[6, 0, 0], [0, 200, 0], [0, 0, 200]],
        };
        let page = Page::new(1600, 1200, "WORDS", "VALUES")
            .unwrap()
            .in_colours(scheme);
        let (image, area) = page.start(OWN.background);
        let count = |image: &Image, colour| image.pixels().iter().filter(|own| **own == colour).count();
        let [below, bar] = [1200.0 - area.min[1], area.min[1]].map(|tall| (1600.0 * tall) as usize);
        assert_eq!(count(&image, [1, 0, 0]), below);
        assert!((bar / 2..bar).contains(&count(&image, [6, 0, 0])));
        for words in [[0, 200, 0], [0, 0, 200]] {
            assert!(count(&image, words) > 5, "{words:?}");
        }
        let pens = page.pens();
        assert_eq!(
            (pens.background, pens.ink, pens.cut[0]),
            ([1, 0, 0], [2, 0, 0], [4, 0, 0])
        );
        // Without one it is paper and ink.
        let own = Page::new(400, 300, "", "").unwrap();
        assert_eq!(own.pens().background, OWN.background);
        assert_eq!(count(&own.start(OWN.background).0, [1, 0, 0]), 0);
    }
}
