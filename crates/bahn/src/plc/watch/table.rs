//! What the view looks like.

use bahn_exchange::Size;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout};
use ratatui::style::{Modifier, Style};
use ratatui::widgets::{Block, Cell, Paragraph, Row, Table, TableState};

use super::Watch;
use crate::diagnostics::printable;
use crate::plc::operand::{Content, Operand};

const KEYS: &str = "r run  s stop  c cycle  l line  enter set  space turn over  a add  d remove  q end";

pub(super) fn draw(frame: &mut Frame, watch: &Watch) {
    let parts = Layout::vertical([
        Constraint::Length(3),
        Constraint::Min(3),
        Constraint::Length(1),
        Constraint::Length(1),
    ]);
    let [head, body, message, keys] = parts.areas(frame.area());
    frame.render_widget(
        Paragraph::new(state(watch)).block(Block::bordered().title("PLC")),
        head,
    );

    let rows = watch.operands.iter().map(|operand| {
        let content = watch.bench.read(*operand);
        Row::new(columns(*operand, &content).map(Cell::from))
    });
    let widths = [
        Constraint::Length(8),
        Constraint::Length(14),
        Constraint::Length(10),
        Constraint::Min(32),
    ];
    let table = Table::new(rows, widths)
        .header(
            Row::new(["OPERAND", "DECIMAL", "HEX", "BINARY"])
                .style(Style::new().add_modifier(Modifier::BOLD)),
        )
        .row_highlight_style(Style::new().add_modifier(Modifier::REVERSED))
        .block(Block::bordered().title("TABLE"));
    let mut chosen = TableState::new().with_selected(watch.chosen);
    frame.render_stateful_widget(table, body, &mut chosen);

    let line = match &watch.entry {
        Some(entry) if entry.is_value => format!("value: {}", entry.text),
        Some(entry) => format!("operand: {}", entry.text),
        None => printable(&watch.message),
    };
    frame.render_widget(Paragraph::new(line), message);
    frame.render_widget(Paragraph::new(KEYS), keys);
}

fn state(watch: &Watch) -> String {
    let registers = watch.bench.machine.registers();
    let how = match (watch.running, watch.inside) {
        (true, _) => "RUN",
        (false, true) => "LINE",
        (false, false) => "STOP",
    };
    format!(
        "{how}  cycle {}  {:.2} %  LA {}  WA {}  X {}  {}",
        watch.bench.cycle,
        watch.bench.machine.time().current_percent(),
        u8::from(registers.logic),
        registers.word,
        registers.index,
        printable(&watch.last_line.0)
    )
}

/// Operand, decimal, hexadecimal, binary.
fn columns(operand: Operand, content: &Content) -> [String; 4] {
    let name = operand.to_string();
    match (operand, content) {
        (Operand::Number(number), Content::Number(value)) => {
            let (digits, mask) = match number.size() {
                Size::Byte => (2, 0xff),
                Size::Word => (4, 0xffff),
                Size::Double => (8, u32::MAX),
            };
            let bits = *value as u32 & mask;
            let width = digits * 4;
            [
                name,
                value.to_string(),
                format!("{bits:0digits$X}"),
                format!("{bits:0width$b}"),
            ]
        }
        (_, Content::Number(value)) => [name, value.to_string(), String::new(), value.to_string()],
        (_, Content::Text(text)) => [name, printable(text), String::new(), String::new()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_in_their_width() {
        let columns = |operand: &str, value| columns(operand.parse().unwrap(), &Content::Number(value));
        assert_eq!(columns("B8", -2), ["B8", "-2", "FE", "11111110"]);
        assert_eq!(columns("W8", 10), ["W8", "10", "000A", "0000000000001010"]);
        assert_eq!(columns("O2", 1), ["O2", "1", "", "1"]);
    }
}
