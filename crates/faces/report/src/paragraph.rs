//! Lines of an explanation: a label, and text that is wrapped beside it.

/// Columns of a terminal that text is wrapped to.
const WIDTH: usize = 80;
/// Columns before the text: two blanks and the label.
const INDENT: usize = 15;

/// A labelled text; nothing for an empty one.
pub fn labelled(label: &str, content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    let mut text = format!("  {label:<width$}", width = INDENT - 2);
    let mut column = INDENT;
    for (at, word) in content.split_whitespace().enumerate() {
        let length = word.chars().count();
        if at > 0 && column + 1 + length > WIDTH {
            text += &format!("\n{:INDENT$}", "");
            column = INDENT;
        } else if at > 0 {
            text.push(' ');
            column += 1;
        }
        text += word;
        column += length;
    }
    text + "\n"
}

/// Labelled lines, the label before the first one only.
pub fn labelled_lines(label: &str, lines: &[String]) -> String {
    let labels = std::iter::once(label).chain(std::iter::repeat(""));
    lines
        .iter()
        .zip(labels)
        .map(|(line, label)| labelled(label, line))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_wrapped_beside_its_label() {
        assert_eq!(labelled("does:", "One two."), "  does:        One two.\n");
        assert_eq!(labelled("note:", ""), "");
        let long = labelled("note:", &"word ".repeat(30));
        assert!(long.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(
            long.lines()
                .skip(1)
                .all(|line| line.starts_with(&" ".repeat(INDENT)))
        );
        assert_eq!(long.split_whitespace().count(), 31, "nothing is lost");
        let wide = labelled("", &"x".repeat(200));
        assert_eq!(wide.trim().len(), 200, "a word is never broken");
    }
}
