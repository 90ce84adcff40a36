//! A protocol of lines: a command comes in, its answer goes out. It stands for the next interface.

use std::error::Error;
use std::io::{self, BufRead, Read, Write};

use bahn_service::{MachineService, Operand};

/// Answers until nothing more comes.
pub fn serve(machine: &MachineService, input: impl BufRead, mut output: impl Write) -> io::Result<()> {
    for line in input.lines() {
        let line = line?;
        let (word, rest) = line.split_once(' ').unwrap_or((&line, ""));
        match answer(machine, word, rest) {
            Ok(text) => writeln!(output, "ok {text}")?,
            Err(error) => writeln!(output, "error {error}")?,
        }
    }
    Ok(())
}

fn answer(machine: &MachineService, word: &str, rest: &str) -> Result<String, Box<dyn Error>> {
    match word {
        "state" => {
            let state = machine.state()?;
            let axes: String = state.axes.iter().map(|axis| axis.letter).collect();
            let messages: Vec<_> = state.messages.into_iter().map(|message| message.text).collect();
            Ok(format!("{} {axes} {}", state.mode.name(), messages.join(", ")))
        }
        "key" => machine.press(rest).map(|()| rest.to_owned()).map_err(Into::into),
        "mem" => {
            let (name, value) = rest.split_once('=').unwrap_or((rest, ""));
            let operand: Operand = name.parse()?;
            if !value.is_empty() {
                machine.write(operand, value)?;
            }
            let contents = machine.read(vec![operand])?;
            Ok(contents.iter().map(ToString::to_string).collect())
        }
        "get" => {
            let mut text = String::new();
            machine.open(rest)?.read_to_string(&mut text)?;
            Ok(text.lines().count().to_string())
        }
        "put" => {
            let (name, text) = rest.split_once(' ').unwrap_or((rest, ""));
            machine.store_file(name, text.as_bytes())?;
            Ok(name.to_owned())
        }
        _ => Err(format!("{word} is no command").into()),
    }
}
