//! 3D view: the part as it would lie on the table.

use rayon::prelude::*;

use super::camera::{Camera, View3d};
use super::colouring::Palette;
use super::edges::{self, Spot};
use super::light::{screen, to_linear};
use super::raycast::Caster;
use super::scale::number;
use super::shade::{SAMPLES, Shader};
use super::{Area, Page, tool_path};
use crate::part::Part;
use bahn_picture::Anchor;
use bahn_picture::{Colour, Image, mix};

impl Part {
    /// The part in parallel projection, shaded, from any angle.
    pub fn view_3d(&self, page: &Page, options: &View3d) -> Image {
        let (mut image, area) = page.start(BACKGROUND_TOP);
        let size = page.text_size();
        let palette = Palette::new(self, options.colouring, 0, page);
        let pens = page.pens();
        let legend = palette.legend();
        let beside = legend.as_ref().map_or(0.0, |legend| legend.width(size) + size);
        let free = area.shrunk(2.5 * size, 2.5 * size, 2.5 * size + beside, 4.5 * size);
        let camera = Camera::new(self, options, &free);
        let spots = self.render(&mut image, &area, &camera, &palette, page);
        if let (true, Some(trail)) = (options.tool_path, &self.trail) {
            tool_path::draw(
                &mut image,
                trail,
                |point| camera.project(point),
                &spots,
                &area,
                page,
            );
        }
        if let Some(legend) = legend {
            let room = Area {
                min: [area.max[0] - beside, area.min[1] + size],
                max: [area.max[0], area.max[1] - 4.5 * size],
            };
            legend.draw(&mut image, &room, room.min[1], size, pens);
        }
        camera.triad(
            &mut image,
            self,
            [area.min[0] + 4.2 * size, area.max[1] - 4.0 * size],
            size,
        );
        camera.scale_bar(
            &mut image,
            [area.max[0] - 1.5 * size, area.max[1] - 1.4 * size],
            size,
            pens.ink,
        );
        let [a, b, c] = self.setup.size.map(|side| {
            number(side, 0.01)
                .trim_end_matches('0')
                .trim_end_matches('.')
                .to_owned()
        });
        let middle = [area.centre()[0], area.max[1] - 1.4 * size];
        image.text(
            middle,
            Anchor::Centre,
            size,
            pens.ink,
            &format!("{a} × {b} × {c} mm"),
        );
        image
    }

    fn render(
        &self,
        image: &mut Image,
        area: &Area,
        camera: &Camera,
        palette: &Palette,
        page: &Page,
    ) -> Vec<Spot> {
        let caster = Caster::new(self);
        let shader = Shader {
            caster: &caster,
            palette,
            lamp: camera.lamp(),
            to_eye: camera.forward.map(|v| -v),
            height_factor: camera.height_factor,
            pixel_mm: camera.mm,
            front: usize::from(camera.forward[1].abs() >= camera.forward[0].abs()),
        };
        let first = area.min[1] as usize;
        let count = area.size()[1];
        let width = image.width() as usize;
        let mut spots = vec![Spot::BACKGROUND; width * image.height() as usize];
        let rows = image
            .rows_mut()
            .zip(spots.chunks_exact_mut(width))
            .skip(first)
            .enumerate();
        rows.par_bridge().for_each(|(row, (pixels, spots))| {
            if page.is_stopped() {
                return;
            }
            let own = || mix(BACKGROUND_TOP, BACKGROUND_BOTTOM, row as f64 / count);
            let background = page.scheme.map_or_else(own, |scheme| scheme.background);
            for (x, (pixel, spot)) in pixels.iter_mut().zip(spots).enumerate() {
                (*pixel, *spot) = pixel_at(camera, &shader, [x, row + first], background);
            }
        });
        edges::draw(image, &spots, page);
        spots
    }
}

/// Colour of a pixel, and what its edges are made from.
fn pixel_at(camera: &Camera, shader: &Shader, [x, y]: [usize; 2], background: Colour) -> (Colour, Spot) {
    let mut seen = [None; SAMPLES * SAMPLES];
    for (k, seen) in seen.iter_mut().enumerate() {
        // Nearly to the borders of the pixel: no edge falls between the rays of neighbours.
        let offset = |k: usize| 0.02 + 0.96 * k as f64 / (SAMPLES - 1) as f64;
        let (u, v) = (offset(k % SAMPLES), offset(k / SAMPLES));
        let (origin, direction) = camera.ray(x as f64 + u, y as f64 + v);
        *seen = shader.caster.cast(origin, direction).map(|hit| {
            let point = [0, 1, 2].map(|k| origin[k] + direction[k] * hit.t);
            shader.light(point, &hit, k)
        });
    }
    if seen.iter().all(Option::is_none) {
        return (background, Spot::BACKGROUND);
    }
    let backdrop = to_linear(background);
    let mut sum = [0.0; 3];
    for light in seen.iter().map(|seen| seen.map_or(backdrop, |seen| seen.light)) {
        for (sum, light) in sum.iter_mut().zip(light) {
            *sum += light;
        }
    }
    let colour = screen(sum.map(|value| value / (SAMPLES * SAMPLES) as f64));
    (colour, Spot::new(&seen, camera))
}

const BACKGROUND_TOP: Colour = [246, 248, 250];
const BACKGROUND_BOTTOM: Colour = [214, 221, 229];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::colouring::Colouring;
    use crate::{Resolution, Workpiece};
    use bahn_path::{Blank, Plane};

    /// 100 x 100 mm in columns of 0.25 mm, 40 mm thick, with a height over the lower face by the place.
    fn part(height: impl Fn(f64, f64) -> f64) -> Part {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0; 3],
            max: [100.0, 100.0, 40.0],
        };
        let mut part = Workpiece::new(&blank, Resolution::Millimetres(0.25))
            .unwrap()
            .finished();
        let nx = part.grid.nx;
        for (k, cell) in part.heights.iter_mut().enumerate() {
            let place = |n: usize| (n as f64 + 0.5) * 0.25;
            *cell = height(place(k % nx), place(k / nx)) as f32;
        }
        part
    }

    /// A sphere of 60 mm whose top is at 39 mm, over a floor at 10 mm.
    fn sphere(x: f64, y: f64) -> f64 {
        let square = (x - 50.0).powi(2) + (y - 50.0).powi(2);
        ((3600.0_f64 - square).max(0.0).sqrt() - 21.0).max(10.0)
    }

    /// How many of the 90 x 60 pixels in the middle of the picture carry a line.
    fn lines(part: &Part, elevation_deg: f64) -> usize {
        let page = Page::new(300, 240, "", "").unwrap();
        let options = View3d {
            elevation_deg,
            ..View3d::default()
        };
        let (mut image, area) = page.start(BACKGROUND_TOP);
        let camera = Camera::new(part, &options, &area);
        let palette = Palette::new(part, Colouring::Part, 0, &page);
        let spots = part.render(&mut image, &area, &camera, &palette, &page);
        let weights = edges::weights(&spots, 300, &page);
        (105..165)
            .flat_map(|y| (105..195).map(move |x| y * 300 + x))
            .filter(|at| weights[*at] > 0.1)
            .count()
    }

    #[test]
    fn smooth_surfaces_have_no_lines() {
        for elevation_deg in [25.0, 38.0] {
            let found = lines(&part(sphere), elevation_deg);
            assert_eq!(found, 0, "{elevation_deg}");
        }
    }

    /// A sphere left in steps of 0.5 mm, as a flat mill does.
    #[test]
    fn steps_of_a_finishing_cut_are_no_lines() {
        let steps = part(|x, y| (sphere(x, y) * 2.0).floor() / 2.0);
        for elevation_deg in [25.0, 38.0] {
            let found = lines(&steps, elevation_deg);
            assert_eq!(found, 0, "{elevation_deg}");
        }
    }

    /// An edge that runs across the picture without a gap: at least a pixel in each of the columns.
    #[test]
    fn edges_are_lines() {
        let step = part(|_, y| if y > 50.0 { 40.0 } else { 20.0 });
        let found = lines(&step, 38.0);
        assert!(found >= 90, "{found}");
    }
}
