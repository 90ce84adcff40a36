//! Texts for hovers.

/// Lines of Markdown: a title and labelled facts; those without text are left out.
#[derive(Debug, Default)]
pub(crate) struct Markdown {
    text: String,
}

impl Markdown {
    pub(crate) fn titled(title: &str) -> Markdown {
        Markdown {
            text: format!("**{}**", escaped(title)),
        }
    }

    pub(crate) fn paragraph(mut self, text: &str) -> Markdown {
        if !text.is_empty() {
            self.text += &format!("\n\n{}", escaped(text));
        }
        self
    }

    pub(crate) fn fact(mut self, label: &str, text: &str) -> Markdown {
        if !text.is_empty() {
            self.text += &format!("\n\n*{label}:* {}", escaped(text));
        }
        self
    }

    pub(crate) fn list(mut self, items: impl IntoIterator<Item = String>) -> Markdown {
        for (at, item) in items.into_iter().enumerate() {
            let gap = if at == 0 { "\n\n" } else { "\n" };
            self.text += &format!("{gap}- {}", escaped(&item));
        }
        self
    }

    /// The chapters that citations like `[003:4929]` mean.
    pub(crate) fn source(self, citations: &str) -> Markdown {
        let chapters = bahn_parameters::chapters(citations);
        self.fact("Source", &chapters.join("; "))
    }

    pub(crate) fn text(self) -> String {
        self.text
    }
}

/// Signs that Markdown takes for its own.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        if matches!(
            character,
            '*' | '_' | '`' | '<' | '>' | '#' | '[' | ']' | '\\' | '|'
        ) {
            escaped.push('\\');
        }
        escaped.push(character);
    }
    escaped
}
