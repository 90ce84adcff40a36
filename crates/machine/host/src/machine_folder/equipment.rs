//! What is fitted to the control of `machine.toml`: boards, options, software.
//!
//! Decision: `analogue` says how the switch on the boards stands: it must agree with MP4410, which says of which board the
//! analogue inputs act; without the key it does

use bahn_exchange::{Bit, BitArea};
use bahn_machine::{EquipmentFolder, Machine, MachineFolder, Said};
use bahn_parameters::equipment::{Equipment, HardwareOption, Release};
use bahn_parameters::terminals::{BOARDS_MAX, Board, Fitted, Terminal, TerminalKind, terminals};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_text::{Diagnostic, Span};

use super::load::Loader;

impl Loader<'_> {
    /// Options and software; a fault is said, and the control has all.
    pub(super) fn equipment(&mut self, said: &EquipmentFolder, model: ControlModel) -> Equipment {
        let mut equipment = match &said.options {
            None => Equipment::default(),
            Some(options) => {
                let named: Vec<Option<HardwareOption>> =
                    options.iter().map(|option| self.option(option, model)).collect();
                let known: Option<Vec<HardwareOption>> = named.into_iter().collect();
                known.map_or_else(Equipment::default, |known| Equipment::with_options(&known))
            }
        };
        if let Some(software) = &said.software {
            match Release::read(model, &software.text) {
                Ok(release) => equipment.release = Some(release),
                Err(error) => self.fault_at_span(software.span, error.to_string()),
            }
        }
        equipment
    }

    fn option(&mut self, said: &Said, model: ControlModel) -> Option<HardwareOption> {
        let option = HardwareOption::named(&said.text).filter(|option| option.is_of(model));
        if option.is_none() {
            let known = HardwareOption::ALL
                .into_iter()
                .filter(|option| option.is_of(model));
            let known: Vec<&str> = known.map(HardwareOption::id).collect();
            let message = format!(
                "`{}` is no option of the {}; there are {}",
                said.text,
                model.name(),
                known.join(", ")
            );
            self.fault_at_span(said.span, message);
        }
        option
    }

    /// The boards that are fitted; all that the model can have where nobody says it, or something else.
    pub(super) fn boards(
        &mut self,
        said: &EquipmentFolder,
        model: ControlModel,
        parameters: Option<&ParameterList>,
    ) -> Vec<Fitted> {
        let by_parameter =
            parameters.map_or([false; BOARDS_MAX], |list| list.plc_parameters().analogue_inputs);
        let boards = said
            .boards
            .as_ref()
            .and_then(|boards| self.named_boards(boards, model));
        if let Some((span, on)) = said.analogue
            && parameters.is_some()
            && on != by_parameter.contains(&true)
        {
            let (says, cure) = match on {
                true => ("of no board", "set its bits, or leave `analogue` out"),
                false => ("that there are", "clear its bits, or leave `analogue` out"),
            };
            let message = format!("`analogue` is {on}, but MP4410 has analogue inputs {says}; {cure}");
            self.fault_at_span(span, message);
        }
        match boards {
            None => Board::all_of(model, by_parameter),
            Some(boards) => {
                let fitted = boards.into_iter().zip(by_parameter);
                fitted
                    .map(|(board, analogue)| board.with_analogue(analogue))
                    .collect()
            }
        }
    }

    /// `None` where one is no board of the model, which is said.
    fn named_boards(&mut self, said: &[Said], model: ControlModel) -> Option<Vec<&'static Board>> {
        let mut boards: Vec<&'static Board> = Vec::new();
        let mut all_known = true;
        for one in said {
            let known: Vec<&str> = Board::of(model).map(|board| board.id).collect();
            let board = Board::named(&one.text).filter(|board| known.contains(&board.id));
            let Some(board) = board else {
                let there = match known.is_empty() {
                    true => "it has none".to_owned(),
                    false => format!("there are {}", known.join(", ")),
                };
                let message = format!("`{}` is no board of the {}; {there}", one.text, model.name());
                self.fault_at_span(one.span, message);
                all_known = false;
                continue;
            };
            if boards.len() == BOARDS_MAX {
                let message = format!("{} boards are the most; take {} out", BOARDS_MAX, board.name);
                self.fault_at_span(one.span, message);
                continue;
            }
            if let Some(other) = boards.iter().find(|other| other.excludes(board)) {
                let message = format!(
                    "a {} is never beside a {}; take one of them out",
                    board.name, other.name
                );
                self.fault_at_span(one.span, message);
            }
            boards.push(board);
        }
        all_known.then_some(boards)
    }

    /// Every wire ends at a terminal, and the outputs fall with their supply.
    pub(super) fn fit(
        &mut self,
        folder: &MachineFolder,
        plant: &mut Machine,
        model: ControlModel,
        boards: &[Fitted],
    ) {
        let terminals: Vec<Terminal> = terminals(model, boards).collect();
        self.wiring(folder, plant, model, &terminals);
        let switched = |output: usize| {
            let at = |terminal: &&Terminal| is_output(terminal, output);
            terminals.iter().filter(at).any(|terminal| terminal.switched)
        };
        let bipolar = terminals
            .iter()
            .filter(|terminal| terminal.kind == TerminalKind::Bipolar);
        let bipolar: Vec<usize> = bipolar
            .filter_map(|terminal| Some(terminal.operand?.number.into()))
            .collect();
        if plant.fit(switched, &bipolar) {
            let message = "[bipolar] is for outputs of a PL 110 B, which is not among the boards".to_owned();
            let line = self.text_of_plant(folder).and_then(|(_, text)| {
                text.lines()
                    .position(|line| line.trim_start().starts_with("[bipolar]"))
            });
            self.fault_in_plant(folder, Span::line(line.map_or(1, |line| line + 1)), message);
        }
    }

    fn wiring(
        &mut self,
        folder: &MachineFolder,
        plant: &Machine,
        model: ControlModel,
        terminals: &[Terminal],
    ) {
        /// Faults of the wiring that are named at most.
        const FAULTS_MAX: usize = 1000;
        let there = |letter: char| {
            let operands = terminals.iter().filter_map(|terminal| terminal.operand);
            let mut numbers: Vec<u16> = operands
                .filter(|own| own.letter == letter)
                .map(|own| own.number)
                .collect();
            numbers.sort_unstable();
            numbers.dedup();
            numbers
        };
        let (inputs, outputs) = (there('I'), there('O'));
        let boards = |bit: Bit| match bit.area() {
            BitArea::O => &outputs,
            _ => &inputs,
        };
        let bits = plant.wires().iter();
        let bits = bits.filter_map(|wire| Some((wire, wire.operand.parse::<Bit>().ok()?)));
        let missing = bits.filter(|(_, bit)| boards(*bit).binary_search(&bit.number()).is_err());
        for (wire, bit) in missing.take(FAULTS_MAX) {
            let (what, area) = match bit.area() {
                BitArea::O => ("output", 'O'),
                _ => ("input", 'I'),
            };
            let message = format!(
                "{} has no {what} {}; there are {}",
                model.name(),
                wire.operand,
                ranges(area, boards(bit))
            );
            self.fault_in_plant(folder, wire.span, message);
        }
    }

    fn fault_in_plant(&mut self, folder: &MachineFolder, span: Span, message: String) {
        let fault = Diagnostic::error(span, message).under("the wiring is wrong");
        if let Some((path, text)) = self.text_of_plant(folder) {
            self.faults.push(fault.in_text(path, &text));
        }
    }
}

fn is_output(terminal: &Terminal, output: usize) -> bool {
    let operand = terminal.operand.filter(|operand| operand.letter == 'O');
    operand.is_some_and(|operand| usize::from(operand.number) == output)
}

/// Numbers as ranges: `I0-I31, I64-I126`.
fn ranges(letter: char, numbers: &[u16]) -> String {
    let runs = numbers.chunk_by(|one, next| next - one == 1);
    let named = runs.map(|run| match run {
        [] => String::new(),
        [one] => format!("{letter}{one}"),
        [first, .., last] => format!("{letter}{first}-{letter}{last}"),
    });
    named.collect::<Vec<_>>().join(", ")
}
