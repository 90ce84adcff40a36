//! Prints the path elements of a program, one a line: `cargo run -p bahn-interpreter --example trace FILE`.

use std::sync::Arc;

use bahn_interpreter::{Interpreter, NoPrograms, Settings};
use bahn_path::{Curve, ElementSource, LiveData, Step};
use bahn_program::Program;

fn main() -> std::io::Result<()> {
    let name = std::env::args().nth(1).unwrap_or_default();
    let program = Arc::new(Program::from_bytes(name.as_str(), std::fs::read(&name)?));
    let mut run = Interpreter::new(program, Settings::default(), Arc::new(NoPrograms));
    let mut length = 0.0;
    loop {
        match run.next() {
            Step::Element(e) => {
                length += e.length();
                let known: String = e
                    .end
                    .known()
                    .iter()
                    .map(|a| format!(" {a}{:.4}", e.end[a]))
                    .collect();
                let shape = match e.curve {
                    Curve::Hold => "hold".to_owned(),
                    Curve::Line => "line".to_owned(),
                    Curve::Arc(arc) => format!("arc {:.4?} {:.3}", arc.centre, arc.sweep_deg),
                    Curve::Corner(arc) => format!("corner arc {:.4?}", arc.corner),
                };
                println!(
                    "{:5} {:?}{known} {shape} {:.4}",
                    e.block.block,
                    e.feed,
                    e.length()
                );
            }
            Step::Barrier(barrier) => {
                println!("{barrier:?}");
                run.resume(LiveData::default());
            }
            Step::Error(error) => {
                println!("{error:?}");
                break;
            }
            Step::End | Step::Starved => break,
        }
    }
    println!("length {length:.4} mm, {} blocks", run.blocks_executed());
    Ok(())
}
