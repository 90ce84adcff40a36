//! The tool path as a drawing in plan view: rapid traverse dashed, feed solid, arcs as arcs.

use std::collections::HashSet;
use std::io::Write;

use bahn_path::{Arc, Blank, Curve, FeedRate, Function, PathElement, Plane, Point2, Position};

use crate::ReportError;
use crate::path_csv::push_number;
use bahn_host::files::NewFile;

/// Elements that are drawn; more are no drawing that somebody could look at, and take memory.
const MAX_ELEMENTS: usize = 2_000_000;
/// Lines that an arc outside the plane of the drawing is made of, for a full turn.
const LINES_PER_TURN: f64 = 72.0;

/// Width of the sheet, pixels, as all of these.
const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 800.0;
const TITLE_BAR: f64 = 44.0;
const MARGIN: [f64; 2] = [70.0, 60.0];

/// Collects the elements of the path for a drawing in plan view.
#[derive(Default)]
pub struct PathDrawing {
    /// Decided by the blank or the first tool.
    plane: Option<Plane>,
    blank: Option<Blank>,
    rapid: Line,
    feed: Line,
    elements: usize,
    bounds: Option<[Point2; 2]>,
    first: Option<Point2>,
    last: Option<Point2>,
    /// Where the tool moves in feed along its axis only, with its radius: once for each place and radius.
    plunges: Plunges,
    /// Where the path leaves the workpiece for a place that is not known (M91).
    leaving: Vec<Point2>,
}

/// Places where the tool goes down: drilled holes, and the beginnings of cuts.
#[derive(Default)]
struct Plunges {
    /// Of the tool in the spindle, mm.
    radius: f64,
    found: Vec<(Point2, f64)>,
    known: HashSet<[u64; 3]>,
}

impl Plunges {
    /// The way out of a hole is no plunge. The many plunges of a pecked hole are one.
    fn add(&mut self, at: Point2, is_down: bool) {
        let radius = if self.radius.is_finite() {
            self.radius.max(0.0)
        } else {
            0.0
        };
        if is_down && self.known.insert([at[0], at[1], radius].map(f64::to_bits)) {
            self.found.push((at, radius));
        }
    }

    /// A circle as great as the tool with a cross, for a tool without a radius the cross alone; `mm` is the length of
    /// a pixel.
    fn draw(&self, out: &mut Vec<u8>, mm: f64) {
        let least = 3.0 * mm;
        for ([x, y], radius) in &self.found {
            let arm = (1.3 * radius).max(least);
            let mut text = String::new();
            if *radius > 0.0 {
                text += &format!(
                    "<circle class=\"hole\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>",
                    short(*x),
                    short(*y),
                    short(*radius)
                );
            }
            text += &format!(
                "<path class=\"hole\" d=\"M{} {}h{w}M{} {}v{w}\"/>\n",
                short(x - arm),
                short(*y),
                short(*x),
                short(y - arm),
                w = short(2.0 * arm),
            );
            out.extend_from_slice(text.as_bytes());
        }
    }
}

/// The commands of one kind of line.
#[derive(Default)]
struct Line {
    commands: Vec<u8>,
    /// Where the pen is.
    at: Option<Point2>,
}

impl PathDrawing {
    /// Takes an element; `false` when there are too many.
    pub fn element(&mut self, element: &PathElement) -> bool {
        for function in element.functions() {
            match &function.function {
                Function::Blank(blank) => {
                    self.blank.get_or_insert(*blank);
                    self.plane.get_or_insert(blank.plane);
                }
                Function::Tool(call) => {
                    self.plunges.radius = call.shape.radius;
                    if self.plane.is_none() {
                        self.plane = Plane::of_tool_axis(call.axis);
                    }
                }
                _ => {}
            }
        }
        if element.curve == Curve::Hold {
            return true;
        }
        if self.elements >= MAX_ELEMENTS {
            return false;
        }
        self.elements += 1;
        let plane = *self.plane.get_or_insert(Plane::XY);
        match (known(plane, &element.start), known(plane, &element.end)) {
            (Some(from), Some(to)) => self.draw(plane, element, from, to),
            (Some(from), None) => self.leaving.push(from),
            _ => {}
        }
        true
    }

    fn draw(&mut self, plane: Plane, element: &PathElement, from: Point2, to: Point2) {
        self.first.get_or_insert(from);
        self.last = Some(to);
        self.include(from);
        self.include(to);
        let line = match element.feed {
            FeedRate::Rapid => &mut self.rapid,
            FeedRate::Programmed(_) => &mut self.feed,
        };
        line.move_to(from);
        if from == to && element.curve == Curve::Line && element.feed != FeedRate::Rapid {
            self.plunges.add(
                from,
                element.end.get(plane.normal) < element.start.get(plane.normal),
            );
        }
        match &element.curve {
            Curve::Arc(arc) if same_plane(arc.plane, plane) => {
                line.arc(arc, from, to);
                let radius = distance(arc.centre, from).max(distance(arc.centre, to));
                for point in extremes(arc, from, radius) {
                    self.include(point);
                }
            }
            Curve::Arc(_) | Curve::Corner(_) => {
                let sweep_deg = match &element.curve {
                    Curve::Arc(arc) => arc.sweep_deg.abs(),
                    Curve::Corner(arc) => arc.circle(&element.start, &element.end).sweep_rad.to_degrees(),
                    Curve::Hold | Curve::Line => 0.0,
                };
                let count = (sweep_deg / 360.0 * LINES_PER_TURN).ceil().clamp(1.0, 10_000.0);
                for step in 1..=count as u32 {
                    let at = element
                        .curve
                        .position(&element.start, &element.end, f64::from(step) / count);
                    if let Some(point) = known(plane, &at) {
                        line.line_to(point);
                    }
                }
            }
            _ => line.line_to(to),
        }
    }

    fn include(&mut self, point: Point2) {
        let [min, max] = self.bounds.get_or_insert([point, point]);
        for k in 0..2 {
            min[k] = min[k].min(point[k]);
            max[k] = max[k].max(point[k]);
        }
    }

    /// Draws the ways that leave the workpiece: out of everything, on the nearest side.
    fn lead_away(&mut self) {
        const BEYOND: f64 = 0.05;
        let Some([min, max]) = self.bounds else { return };
        let beyond = BEYOND * (max[0] - min[0]).max(max[1] - min[1]);
        for from in std::mem::take(&mut self.leaving) {
            let sides = [
                from[0] - min[0],
                max[0] - from[0],
                from[1] - min[1],
                max[1] - from[1],
            ];
            let nearest = sides.iter().copied().fold(f64::INFINITY, f64::min);
            let to = match sides.iter().position(|side| *side == nearest) {
                Some(0) => [min[0] - beyond, from[1]],
                Some(1) => [max[0] + beyond, from[1]],
                Some(2) => [from[0], min[1] - beyond],
                _ => [from[0], max[1] + beyond],
            };
            self.rapid.move_to(from);
            self.rapid.line_to(to);
            self.include(to);
        }
    }

    /// Writes what was collected as SVG under a title.
    pub fn write(mut self, title: &str, file: &mut NewFile) -> Result<(), ReportError> {
        let plane = self.plane.unwrap_or(Plane::XY);
        let blank = self.blank.map(|blank| {
            let corner = |corner: [f64; 3]| {
                [plane.first, plane.second].map(|axis| {
                    axis.main()
                        .and_then(|axis| corner.get(axis.index()).copied())
                        .unwrap_or_default()
                })
            };
            [corner(blank.min), corner(blank.max)]
        });
        for point in blank.into_iter().flatten() {
            self.include(point);
        }
        self.lead_away();
        let sheet = Sheet::new(self.bounds.unwrap_or([[0.0; 2], [100.0; 2]]));
        let mut out = Vec::new();
        sheet.begin(&mut out, title, plane);
        if let Some(corners) = blank {
            sheet.blank(&mut out, corners);
        }
        sheet.grid(&mut out, plane);
        sheet.open_drawing(&mut out);
        for (class, line) in [("rapid", &self.rapid), ("feed", &self.feed)] {
            if !line.commands.is_empty() {
                out.extend_from_slice(format!("<path class=\"{class}\" d=\"").as_bytes());
                out.extend_from_slice(&line.commands);
                out.extend_from_slice(b"\"/>\n");
            }
        }
        self.plunges.draw(&mut out, 1.0 / sheet.scale);
        out.extend_from_slice(b"</g>\n");
        sheet.marks(&mut out, self.first, self.last);
        sheet.end(&mut out);
        file.write_all(&out)
            .map_err(|error| ReportError::new(format!("cannot write the drawing: {error}")))
    }
}

impl Line {
    fn move_to(&mut self, point: Point2) {
        if self.at != Some(point) {
            self.command(b'M', point);
        }
    }

    fn line_to(&mut self, point: Point2) {
        if self.at != Some(point) {
            self.command(b'L', point);
        }
    }

    /// Coordinates are upright here (the group turns the page over), so the sweep flag 1 is
    /// counter-clockwise. An arc of SVG cannot end where it starts: a turn is drawn as two halves.
    fn arc(&mut self, arc: &Arc, from: Point2, to: Point2) {
        let radius = 0.5 * (distance(arc.centre, from) + distance(arc.centre, to));
        if radius <= 0.0 {
            return self.line_to(to);
        }
        let start = (from[1] - arc.centre[1]).atan2(from[0] - arc.centre[0]);
        // More than one turn covers the same circle again.
        let sweep = arc.sweep_deg.clamp(-720.0, 720.0).to_radians();
        let pieces = (sweep.abs() / std::f64::consts::PI * 1.05).ceil().max(1.0) as u32;
        for piece in 1..=pieces {
            let end = if piece == pieces {
                to
            } else {
                let angle = start + sweep * f64::from(piece) / f64::from(pieces);
                [
                    arc.centre[0] + radius * angle.cos(),
                    arc.centre[1] + radius * angle.sin(),
                ]
            };
            self.commands.push(b'A');
            push_point(&mut self.commands, [radius, radius]);
            self.commands
                .extend_from_slice(if sweep > 0.0 { b" 0 0 1 " } else { b" 0 0 0 " });
            push_point(&mut self.commands, end);
        }
        self.at = Some(to);
    }

    fn command(&mut self, letter: u8, point: Point2) {
        self.commands.push(letter);
        push_point(&mut self.commands, point);
        self.at = Some(point);
    }
}

/// How the path lies on the sheet.
struct Sheet {
    min: Point2,
    max: Point2,
    /// How many pixels a mm has.
    scale: f64,
    /// Pixel of the least corner.
    origin: Point2,
}

impl Sheet {
    fn new([min, max]: [Point2; 2]) -> Sheet {
        // A path on one line still needs a width.
        let longest = (max[0] - min[0]).max(max[1] - min[1]).max(1e-3);
        let pad = 0.03 * longest;
        let (min, max) = (min.map(|v| v - pad), max.map(|v| v + pad));
        let room = [WIDTH - MARGIN[0] - 40.0, HEIGHT - TITLE_BAR - MARGIN[1] - 50.0];
        let scale = (room[0] / (max[0] - min[0])).min(room[1] / (max[1] - min[1]));
        let used = [(max[0] - min[0]) * scale, (max[1] - min[1]) * scale];
        let origin = [
            MARGIN[0] + 0.5 * (room[0] - used[0]),
            TITLE_BAR + 30.0 + 0.5 * (room[1] - used[1]) + used[1],
        ];
        Sheet {
            min,
            max,
            scale,
            origin,
        }
    }

    fn pixel(&self, point: Point2) -> Point2 {
        [
            self.origin[0] + (point[0] - self.min[0]) * self.scale,
            self.origin[1] - (point[1] - self.min[1]) * self.scale,
        ]
    }

    fn begin(&self, out: &mut Vec<u8>, title: &str, plane: Plane) {
        let mm = 1.0 / self.scale;
        let style = format!(
            ".blank{{fill:#eef2f6;stroke:#9aa7b5;stroke-width:1}}\
             .rapid{{fill:none;stroke:#d9822b;stroke-width:{w1};stroke-dasharray:{d1} {d2}}}\
             .feed{{fill:none;stroke:#1f5fa8;stroke-width:{w2};stroke-linejoin:round;stroke-linecap:round}}\
             .hole{{fill:none;stroke:#6b3fa0;stroke-width:{w1}}}\
             .grid{{stroke:#d3dbe4;stroke-width:1}}.axis{{stroke:#9aa7b5;stroke-width:1}}\
             text{{font-family:sans-serif;font-size:13px;fill:#2d3744}}",
            w1 = short(mm),
            w2 = short(1.6 * mm),
            d1 = short(6.0 * mm),
            d2 = short(4.0 * mm),
        );
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\">\n\
             <title>{title}</title>\n<style>{style}</style>\n\
             <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>\n\
             <rect width=\"{WIDTH}\" height=\"{TITLE_BAR}\" fill=\"#263242\"/>\n\
             <text x=\"16\" y=\"28\" style=\"font-size:17px;fill:#ffffff\">PGM {title}</text>\n\
             <text x=\"{right}\" y=\"28\" text-anchor=\"end\" style=\"fill:#becddd\">tool path, {a}{b} plane, mm</text>\n",
            title = escaped(title),
            right = WIDTH - 16.0,
            a = plane.first,
            b = plane.second,
        );
        out.extend_from_slice(text.as_bytes());
    }

    fn blank(&self, out: &mut Vec<u8>, [min, max]: [Point2; 2]) {
        let ([left, bottom], [right, top]) = (self.pixel(min), self.pixel(max));
        let text = format!(
            "<rect class=\"blank\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
            short(left),
            short(top),
            short(right - left),
            short(bottom - top),
        );
        out.extend_from_slice(text.as_bytes());
    }

    /// Lines at round coordinates with their numbers, and the axis letters.
    fn grid(&self, out: &mut Vec<u8>, plane: Plane) {
        let mut text = String::new();
        let step = round_step(80.0 / self.scale);
        let [left, bottom] = self.pixel(self.min);
        let [right, top] = self.pixel(self.max);
        for (k, axis) in [plane.first, plane.second].into_iter().enumerate() {
            let mut number = (self.min[k] / step).ceil();
            while number * step <= self.max[k] {
                let value = number * step;
                let class = if number == 0.0 { "axis" } else { "grid" };
                let label = short(value);
                if k == 0 {
                    let x = short(self.pixel([value, 0.0])[0]);
                    text += &format!(
                        "<line class=\"{class}\" x1=\"{x}\" y1=\"{}\" x2=\"{x}\" y2=\"{}\"/>\
                         <text x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{label}</text>\n",
                        short(top),
                        short(bottom),
                        short(bottom + 18.0),
                    );
                } else {
                    let y = self.pixel([0.0, value])[1];
                    text += &format!(
                        "<line class=\"{class}\" x1=\"{}\" y1=\"{y1}\" x2=\"{}\" y2=\"{y1}\"/>\
                         <text x=\"{}\" y=\"{}\" text-anchor=\"end\">{label}</text>\n",
                        short(left),
                        short(right),
                        short(left - 8.0),
                        short(y + 4.5),
                        y1 = short(y),
                    );
                }
                number += 1.0;
            }
            let at = if k == 0 {
                [right + 14.0, bottom + 5.0]
            } else {
                [left, top - 10.0]
            };
            text += &format!(
                "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" style=\"font-weight:bold\">{axis}</text>\n",
                short(at[0]),
                short(at[1]),
            );
        }
        out.extend_from_slice(text.as_bytes());
    }

    /// Opens the group whose coordinates are those of the path, mm, second axis upward.
    fn open_drawing(&self, out: &mut Vec<u8>) {
        let [x, y] = self.pixel([0.0, 0.0]);
        let text = format!("<g transform=\"matrix({s} 0 0 -{s} {x} {y})\">\n", s = self.scale);
        out.extend_from_slice(text.as_bytes());
    }

    /// Start, end and legend.
    fn marks(&self, out: &mut Vec<u8>, first: Option<Point2>, last: Option<Point2>) {
        let mut text = String::new();
        if let Some([x, y]) = first.map(|point| self.pixel(point)) {
            text += &format!(
                "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"none\" stroke=\"#2a8f4f\" stroke-width=\"2\"/>\n",
                short(x),
                short(y)
            );
        }
        if let Some([x, y]) = last.map(|point| self.pixel(point)) {
            text += &format!(
                "<rect x=\"{}\" y=\"{}\" width=\"8\" height=\"8\" fill=\"none\" stroke=\"#c0392b\" stroke-width=\"2\"/>\n",
                short(x - 4.0),
                short(y - 4.0)
            );
        }
        let y = HEIGHT - 16.0;
        text += &format!(
            "<g><line x1=\"70\" y1=\"{l}\" x2=\"110\" y2=\"{l}\" stroke=\"#1f5fa8\" stroke-width=\"1.6\"/><text x=\"116\" y=\"{y}\">feed</text>\
             <line x1=\"170\" y1=\"{l}\" x2=\"210\" y2=\"{l}\" stroke=\"#d9822b\" stroke-dasharray=\"6 4\"/><text x=\"216\" y=\"{y}\">rapid traverse</text>\
             <circle cx=\"330\" cy=\"{l}\" r=\"5\" fill=\"none\" stroke=\"#2a8f4f\" stroke-width=\"2\"/><text x=\"342\" y=\"{y}\">start</text>\
             <rect x=\"396\" y=\"{e}\" width=\"8\" height=\"8\" fill=\"none\" stroke=\"#c0392b\" stroke-width=\"2\"/><text x=\"410\" y=\"{y}\">end</text>\
             <path d=\"M452 {l}h16m-8 -8v16\" stroke=\"#6b3fa0\"/><circle cx=\"460\" cy=\"{l}\" r=\"5\" fill=\"none\" stroke=\"#6b3fa0\"/>\
             <text x=\"474\" y=\"{y}\">plunge or hole</text></g>\n",
            l = y - 4.0,
            e = y - 8.0,
        );
        // A bar of a round length, as the scale.
        let length = round_step(80.0 / self.scale);
        let right = WIDTH - 40.0;
        let left = right - length * self.scale;
        text += &format!(
            "<path d=\"M{left} {t}v8m0 -4H{right}m0 -4v8\" fill=\"none\" stroke=\"#2d3744\"/>\
             <text x=\"{}\" y=\"{}\" text-anchor=\"end\">{} mm</text>\n",
            short(left - 8.0),
            short(y),
            short(length),
            left = short(left),
            right = short(right),
            t = short(y - 8.0),
        );
        out.extend_from_slice(text.as_bytes());
    }

    fn end(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(b"</svg>\n");
    }
}

fn known(plane: Plane, position: &Position) -> Option<Point2> {
    let point = plane.point(position);
    point.iter().all(|value| value.is_finite()).then_some(point)
}

fn same_plane(a: Plane, b: Plane) -> bool {
    a.first == b.first && a.second == b.second
}

fn distance(a: Point2, b: Point2) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The points of an arc farthest along the axes.
fn extremes(arc: &Arc, from: Point2, radius: f64) -> impl Iterator<Item = Point2> {
    let start = (from[1] - arc.centre[1])
        .atan2(from[0] - arc.centre[0])
        .to_degrees();
    let (centre, sweep) = (arc.centre, arc.sweep_deg);
    [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
        .into_iter()
        .zip([0.0, 90.0, 180.0, 270.0])
        .filter_map(move |(direction, angle): (Point2, f64)| {
            let turned = (angle - start) * sweep.signum();
            let passed = turned.rem_euclid(360.0) <= sweep.abs();
            passed.then(|| {
                [
                    centre[0] + radius * direction[0],
                    centre[1] + radius * direction[1],
                ]
            })
        })
}

/// The next greater of 1, 2, 5 times a power of ten.
fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|factor| factor * decade)
        .find(|step| *step >= least)
        .unwrap_or(10.0 * decade)
}

fn push_point(out: &mut Vec<u8>, point: Point2) {
    push_number(out, point[0]);
    out.push(b' ');
    push_number(out, point[1]);
}

/// A number with few digits.
fn short(value: f64) -> String {
    let mut out = Vec::new();
    push_number(&mut out, (value * 1e4).round() / 1e4);
    String::from_utf8(out).unwrap_or_default()
}

fn escaped(text: &str) -> String {
    bahn_text::printable(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(arc: &Arc, from: Point2, to: Point2) -> String {
        let mut line = Line::default();
        line.move_to(from);
        line.arc(arc, from, to);
        String::from_utf8(line.commands).unwrap()
    }

    /// A hole of radius 3 that is pecked is one circle; the way out and rapid traverse are none.
    #[test]
    fn drilled_places_are_circles() {
        let mut plunges = Plunges {
            radius: 3.0,
            ..Plunges::default()
        };
        plunges.add([15.0, 45.0], true);
        plunges.add([15.0, 45.0], false);
        plunges.add([15.0, 45.0], true);
        plunges.add([85.0, 45.0], false);
        let mut out = Vec::new();
        plunges.draw(&mut out, 0.1);
        let text = String::from_utf8(out).unwrap();
        assert_eq!(text.matches("<circle").count(), 1);
        assert!(text.contains("cx=\"15\" cy=\"45\" r=\"3\""), "{text}");
        // The arms reach 0.3 of the radius beyond.
        assert!(text.contains("M11.1 45h7.8M15 41.1v7.8"), "{text}");
    }

    #[test]
    fn arcs_stay_arcs() {
        let arc = |sweep_deg| Arc {
            plane: Plane::XY,
            centre: [0.0, 0.0],
            sweep_deg,
        };
        assert_eq!(
            drawn(&arc(90.0), [10.0, 0.0], [0.0, 10.0]),
            "M10 0A10 10 0 0 1 0 10"
        );
        assert_eq!(
            drawn(&arc(-90.0), [0.0, 10.0], [10.0, 0.0]),
            "M0 10A10 10 0 0 0 10 0"
        );
        // A full turn cannot be one arc: three of 120 degrees.
        assert_eq!(
            drawn(&arc(360.0), [10.0, 0.0], [10.0, 0.0]).matches('A').count(),
            3
        );
    }

    #[test]
    fn arcs_reach_to_their_extremes() {
        let arc = Arc {
            plane: Plane::XY,
            centre: [1.0, 2.0],
            sweep_deg: -100.0,
        };
        // From 50 degrees clockwise to -50: passes 0 degrees only.
        let angle = 50f64.to_radians();
        let from = [1.0 + 5.0 * angle.cos(), 2.0 + 5.0 * angle.sin()];
        assert_eq!(extremes(&arc, from, 5.0).collect::<Vec<_>>(), [[6.0, 2.0]]);
    }

    #[test]
    fn steps_are_round() {
        assert_eq!(
            [0.7, 1.0, 1.1, 3.0, 7.0].map(round_step),
            [1.0, 1.0, 2.0, 5.0, 10.0]
        );
    }
}
