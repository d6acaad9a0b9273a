//! What is said of a command line that cannot be read.

use std::process::ExitCode;

use super::BAD_REQUEST;

/// Begins a line in which clap guesses what was meant.
const TIP: &str = "tip: ";

/// What a program of this name says of its command line: help and version as clap prints them; an error in one line, with what
/// may have been meant.
pub fn usage(program: &str, error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        // Nobody is left to be told when standard output is closed.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    eprintln!(
        "{program}: {} (see --help)",
        line(&error.render().to_string())
    );
    ExitCode::from(BAD_REQUEST)
}

/// The first paragraph of clap's text and its tips, in one line.
fn line(text: &str) -> String {
    let lines = || text.lines().map(str::trim);
    let paragraph: Vec<&str> = lines().take_while(|line| !line.is_empty()).collect();
    let error = paragraph.join(" ");
    let error = error.strip_prefix("error: ").unwrap_or(&error).to_owned();
    lines()
        .filter_map(|line| line.strip_prefix(TIP))
        .fold(error, |error, tip| error + "; " + tip)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tips_are_kept_and_usage_is_not() {
        let text = "error: one\n  two\n\n  tip: three\n  tip: four\n\nUsage: five\n";
        assert_eq!(line(text), "one two; three; four");
    }
}
