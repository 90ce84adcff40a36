//! What the view looks like.

use bahn_exchange::signal::{self, Signal, SignalOperand};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout};
use ratatui::style::{Modifier, Style};
use ratatui::text::Line;
use ratatui::widgets::{Block, Cell, Paragraph, Row, Table, TableState, Wrap};

use super::Watch;
use bahn_host::{Content, Operand};
use bahn_text::printable;

const KEYS: &str = "r run  s stop  c cycle  l line  n anew  enter set  space turn over  a add  d remove  \
     b break at line  x break on change  t trend  q end";
const MACHINE_KEYS: &str = "r run  s stop  c scan  enter set  space turn over  a add  d remove  x break on change  t trend  \
     q end     whole scans only: line by line on the bench (bahn plc watch MAIN.PLC)";
/// Lines of the program that are shown at least, frame included, where there is room.
const PROGRAM_ROWS: u16 = 9;
/// Rows of the screen without table and program: head, message, keys.
const OTHER_ROWS: u16 = 6;
/// Rows of a screen on which the program is shown.
const ROWS_WITH_PROGRAM: u16 = 20;
/// Columns of binary numbers and bars: a doubleword.
const TREND_WIDTH: u16 = 32;

pub(super) fn draw(frame: &mut Frame, watch: &Watch) {
    // The table takes what its operands need, at most half of the screen; the program has the rest.
    let height = frame.area().height;
    let table_rows = u16::try_from(watch.operands.len())
        .unwrap_or(u16::MAX)
        .saturating_add(3);
    let program_rows = if height >= ROWS_WITH_PROGRAM {
        let left = height.saturating_sub(OTHER_ROWS);
        left.saturating_sub(table_rows.min(left / 2)).max(PROGRAM_ROWS)
    } else {
        0
    };
    let machine = watch.subject.state();
    let (title, own_keys) = match machine.is_empty() {
        true => ("PLC".to_owned(), KEYS),
        false => (format!("PLC  {}", printable(&machine)), MACHINE_KEYS),
    };
    let key_rows = u16::try_from(own_keys.len()).unwrap_or(0) / frame.area().width.max(1) + 1;
    let parts = Layout::vertical([
        Constraint::Length(3),
        Constraint::Min(3),
        Constraint::Length(program_rows),
        Constraint::Length(1),
        Constraint::Length(key_rows),
    ]);
    let [head, body, program, message, keys] = parts.areas(frame.area());
    frame.render_widget(
        Paragraph::new(state(watch)).block(Block::bordered().title(title)),
        head,
    );

    let rows = watch.operands.iter().map(|operand| {
        let content = watch.subject.read(*operand);
        let mut columns = columns(*operand, &content);
        if watch.trend.is_shown() {
            columns[3] = watch.trend.bars(*operand, TREND_WIDTH.into());
        }
        let [name, decimal, hex, binary] = columns;
        let mark = if watch.breakpoints.watches(*operand) {
            "!"
        } else {
            ""
        };
        let called = signal_of(*operand).map_or(String::new(), |signal| signal.name.to_lowercase());
        let cells = [name + mark, decimal, hex, binary, called];
        Row::new(cells.map(Cell::from))
    });
    let widths = [
        Constraint::Length(8),
        Constraint::Length(14),
        Constraint::Length(10),
        Constraint::Length(TREND_WIDTH),
        Constraint::Min(6),
    ];
    let fourth = if watch.trend.is_shown() { "TREND" } else { "BINARY" };
    let table = Table::new(rows, widths)
        .header(
            Row::new(["OPERAND", "DECIMAL", "HEX", fourth, "NAME"])
                .style(Style::new().add_modifier(Modifier::BOLD)),
        )
        .row_highlight_style(Style::new().add_modifier(Modifier::REVERSED))
        .block(Block::bordered().title(table_title(watch)));
    let mut chosen = TableState::new().with_selected(watch.chosen);
    frame.render_stateful_widget(table, body, &mut chosen);
    if program_rows > 0 {
        let rows = usize::from(program.height.saturating_sub(2));
        let (title, lines) = program_lines(watch, rows);
        frame.render_widget(
            Paragraph::new(lines).block(Block::bordered().title(title)),
            program,
        );
    }

    let line = match &watch.entry {
        Some(entry) if watch.message.is_empty() => entry.prompt(),
        Some(entry) => format!("{}   {}", entry.prompt(), printable(&watch.message)),
        None => printable(&watch.message),
    };
    frame.render_widget(Paragraph::new(line), message);
    frame.render_widget(Paragraph::new(own_keys).wrap(Wrap { trim: true }), keys);
}

fn state(watch: &Watch) -> String {
    let registers = watch.subject.plc().registers();
    let how = match (watch.running, watch.subject.is_inside()) {
        _ if watch.subject.plc().stopped().is_some() => "ERROR",
        (true, _) => "RUN",
        (false, true) => "LINE",
        (false, false) => "STOP",
    };
    let time = watch.subject.plc().time();
    format!(
        "{how:<5}  cycle {}  {:.2} % (max {:.2} %)  LA {}  WA {} = {:X}h  X {}",
        watch.subject.cycle(),
        time.current_percent(),
        time.maximum_percent(),
        u8::from(registers.logic),
        registers.word,
        registers.word,
        registers.index,
    )
}

/// The lines around the one that was executed last, which is marked with `*` as in TRACE [000:11426]; the
/// next one of a begun cycle with `>`. Before and between cycles the program is shown from its start.
fn program_lines(watch: &Watch, rows: usize) -> (String, Vec<Line<'static>>) {
    let machine = watch.subject.plc();
    let program = machine.program();
    let place = |at: usize| program.code.get(at).map(|i| (i.file, i.line as usize));
    let stopped = machine.stopped().and_then(|error| {
        let file = program.files.iter().position(|file| file.name == error.file)?;
        Some((u16::try_from(file).ok()?, error.line as usize))
    });
    let last = stopped.or(watch.last.0.and_then(place));
    let next = watch
        .subject
        .is_inside()
        .then(|| place(machine.registers().next))
        .flatten();
    let (file, line) = next.or(last).unwrap_or((0, 1));
    let first = line.saturating_sub(rows / 2).max(1);
    let Some(text) = program.files.get(usize::from(file)) else {
        return (String::new(), Vec::new());
    };
    let lines = text.lines.iter().enumerate().skip(first - 1).take(rows);
    let lines = lines.map(|(index, source)| {
        let here = Some((file, index + 1));
        let (mark, style) = match (next == here, last == here) {
            (true, _) => ('>', Style::new().add_modifier(Modifier::BOLD)),
            (_, true) => ('*', Style::new()),
            _ => (' ', Style::new()),
        };
        let number = u32::try_from(index + 1).unwrap_or(u32::MAX);
        let breaks = file == 0 && watch.breakpoints.is_line(number);
        let stop = if breaks { '!' } else { ' ' };
        Line::styled(format!("{mark}{number:>5}{stop} {}", printable(source)), style)
    });
    (text.name.clone(), lines.collect())
}

/// The meaning of the chosen operand, if it is a fixed marker or word: the column has no room for it.
fn table_title(watch: &Watch) -> String {
    let chosen = watch.operands.get(watch.chosen).copied();
    let signal = chosen.and_then(|operand| Some((operand, signal_of(operand)?)));
    signal.map_or("TABLE".to_owned(), |(operand, signal)| {
        format!("TABLE  {operand} {}", signal.function)
    })
}

/// The fixed marker or word that an operand is.
fn signal_of(operand: Operand) -> Option<&'static Signal> {
    signal::named(match operand {
        Operand::Bit(bit) => SignalOperand::Bit(bit),
        Operand::Number(number) => SignalOperand::Number(number),
        Operand::Text(_) => return None,
    })
}

/// Operand, decimal, hexadecimal, binary.
fn columns(operand: Operand, content: &Content) -> [String; 4] {
    let [decimal, hex, binary] = operand.forms(content);
    [operand.to_string(), printable(&decimal), hex, binary]
}
