//! Words of a line, and where they stand.

/// A word and its column, counted from 1.
#[derive(Clone, Copy)]
pub(crate) struct Word<'a> {
    pub text: &'a [u8],
    pub column: usize,
}

/// Takes a line apart from left to right.
pub(crate) struct Scanner<'a> {
    line: &'a [u8],
    at: usize,
}

impl<'a> Scanner<'a> {
    pub const fn new(line: &'a [u8]) -> Self {
        Self { line, at: 0 }
    }

    /// Everything up to the next space; empty at the end of the line.
    pub fn word(&mut self) -> Word<'a> {
        self.run(|byte| byte != b' ')
    }

    /// What [`word`](Self::word) comes to next.
    pub fn peek_word(&self) -> Word<'a> {
        let Self { line, at } = *self;
        Self { line, at }.word()
    }

    /// The next name, operator or number. They need no space between them (`X1`, `W>=2.5`) where one can tell them
    /// apart, and one can: a name starts with a letter, a number never does. Empty at the end of the line.
    pub fn next(&mut self) -> Word<'a> {
        self.skip_spaces();
        match self.line.get(self.at) {
            Some(byte) if byte.is_ascii_alphabetic() => {
                self.run(|byte| byte.is_ascii_alphabetic() || byte == b'?')
            }
            Some(byte) if is_operator(*byte) => self.run(is_operator),
            Some(byte) if is_number(*byte) => self.run(is_number),
            _ => self.word(),
        }
    }

    /// Whether nothing but spaces is left.
    pub fn is_at_end(&mut self) -> bool {
        self.skip_spaces();
        self.at == self.line.len()
    }

    fn skip_spaces(&mut self) {
        self.run_from_here(|byte| byte == b' ');
    }

    fn run(&mut self, belongs: impl Fn(u8) -> bool) -> Word<'a> {
        self.skip_spaces();
        let column = self.at + 1;
        let text = self.run_from_here(belongs);
        Word { text, column }
    }

    fn run_from_here(&mut self, belongs: impl Fn(u8) -> bool) -> &'a [u8] {
        let rest = self.line.get(self.at..).unwrap_or_default();
        let length = rest
            .iter()
            .position(|&byte| !belongs(byte))
            .unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }
}

fn is_operator(byte: u8) -> bool {
    matches!(byte, b'=' | b'<' | b'>' | b'!')
}

fn is_number(byte: u8) -> bool {
    matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E')
}
