//! How long programs with SL contours of 20,000 elements take: from reading to the last movement of cycles 6, 15
//! and 16, without planning.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::sync::Arc;

use bahn_interpreter::{Interpreter, NoPrograms, Settings};
use bahn_path::{ElementSource, Step};
use bahn_program::Program;
use divan::Bencher;

fn main() {
    divan::main();
}

const ELEMENTS: usize = 20_000;
const SHAPES: [&str; 5] = ["star", "smooth", "scallops", "islands", "star_151"];

const ROUGH_OUT: &str = "CYCL DEF 6.0 ROUGH-OUT\nCYCL DEF 6.1 SET UP -2 DEPTH -10\n\
                         CYCL DEF 6.2 PECKG -5 F100 ALLOW +0.2\nCYCL DEF 6.3 ANGLE +20 F500\n";
const PILOT_DRILLING: &str = "CYCL DEF 15.0 PILOT DRILLING\nCYCL DEF 15.1 SET UP -2 DEPTH -10\n\
                              CYCL DEF 15.2 PECKG -5 F100 ALLOW +0.2\n";
const CONTOUR_MILLING: &str = "CYCL DEF 16.0 CONTOUR MILLING\nCYCL DEF 16.1 SET UP -2 DEPTH -10\n\
                               CYCL DEF 16.2 PECKG -5 F100 DR- F500\n";

/// Target: 2 s each.
#[divan::bench(args = SHAPES, sample_count = 3, sample_size = 1)]
fn rough_out(bencher: Bencher, shape: &str) {
    bench(bencher, shape, ROUGH_OUT);
}

/// Target: 2 s each.
#[divan::bench(args = SHAPES, sample_count = 3, sample_size = 1)]
fn pilot_drilling(bencher: Bencher, shape: &str) {
    bench(bencher, shape, PILOT_DRILLING);
}

/// Target: 2 s each.
#[divan::bench(args = SHAPES, sample_count = 3, sample_size = 1)]
fn contour_milling(bencher: Bencher, shape: &str) {
    bench(bencher, shape, CONTOUR_MILLING);
}

fn bench(bencher: Bencher, shape: &str, cycle: &str) {
    let subprograms = subprograms(shape);
    let labels: Vec<String> = (1..=subprograms.len()).map(|label| label.to_string()).collect();
    let mut text = format!(
        "BEGIN PGM SL MM\nTOOL DEF 1 L+0 R+3\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+2 R0 FMAX M3\n\
         CYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL {}\n{cycle}CYCL CALL\nL Z+50 FMAX M2\n",
        labels.join("/")
    );
    for (label, subprogram) in labels.iter().zip(subprograms) {
        let _ = write!(text, "LBL {label}\n{subprogram}LBL 0\n");
    }
    text.push_str("END PGM SL MM\n");
    bencher.bench(|| {
        let program = Arc::new(Program::from_bytes("SL.H", text.clone().into_bytes()));
        let mut run = Interpreter::new(program, Settings::default(), Arc::new(NoPrograms));
        let mut elements = 0;
        loop {
            match run.next() {
                Step::Element(_) => elements += 1,
                Step::Error(error) => {
                    eprintln!("{error:?}");
                    break;
                }
                _ => break,
            }
        }
        elements
    });
}

fn subprograms(shape: &str) -> Vec<String> {
    let turn = |k: usize| k as f64 / ELEMENTS as f64;
    let star = |k: usize| polar(if k.is_multiple_of(2) { 50.0 } else { 45.0 }, turn(k));
    match shape {
        "star" => vec![lines(star)],
        "smooth" => vec![lines(|k| {
            polar(50.0 + 8.0 * (5.0 * TAU * turn(k)).cos(), turn(k))
        })],
        "scallops" => vec![scallops([0.0, 0.0], 300.0, ELEMENTS, 1, "RL")],
        "islands" => {
            // 12 subcontours are all that cycle 14 takes.
            let pocket = scallops([0.0, 0.0], 300.0, ELEMENTS / 2, 2, "RL");
            let island = |k: usize| scallops(polar(180.0, k as f64 / 11.0), 20.0, ELEMENTS / 22, 2, "RR");
            std::iter::once(pocket).chain((0..11).map(island)).collect()
        }
        // 151 corners, each side leads past 75 of them; run through again and again.
        _ => vec![lines(|k| polar(50.0, (k * 75 % 151) as f64 / 151.0))],
    }
}

fn polar(radius: f64, turn: f64) -> [f64; 2] {
    let (sin, cos) = (TAU * turn).sin_cos();
    [radius * cos, radius * sin]
}

fn lines(at: impl Fn(usize) -> [f64; 2]) -> String {
    let point = |k: usize| {
        let [x, y] = at(k % ELEMENTS);
        format!("L X{x:+.4} Y{y:+.4}{}\n", if k == 0 { " RL" } else { "" })
    };
    (0..=ELEMENTS).map(point).collect()
}

/// Half circles that bulge outward, every one of so many elements; the others are lines.
fn scallops([x, y]: [f64; 2], radius: f64, count: usize, every: usize, side: &str) -> String {
    let joint = |k: usize| {
        let [dx, dy] = polar(radius, (k % count) as f64 / count as f64);
        [x + dx, y + dy]
    };
    let [x, y] = joint(0);
    let mut text = format!("L X{x:+.4} Y{y:+.4} {side}\n");
    for k in 0..count {
        let ([ax, ay], [bx, by]) = (joint(k), joint(k + 1));
        let _ = match k % every {
            0 => writeln!(
                text,
                "CC X{:+.4} Y{:+.4}\nC X{bx:+.4} Y{by:+.4} DR+",
                0.5 * (ax + bx),
                0.5 * (ay + by)
            ),
            _ => writeln!(text, "L X{bx:+.4} Y{by:+.4}"),
        };
    }
    text
}
