//! Figures among what a command prints.

/// The lines of figures in `output`: all but the test harness's own and those that hold one of `without`.
///
/// Where several tests print, each one's first line says whose it is. (That needs `--test-threads 1`.)
#[must_use]
pub fn figures(output: &str, without: &[&str]) -> String {
    let mut lines: Vec<Line<'_>> = Vec::new();
    let mut test = None;
    for line in output.lines() {
        let (name, rest) = of_test(line);
        test = name.or(test);
        let is_out = is_harness(rest) || without.iter().any(|part| rest.contains(part));
        // Of several empty lines one.
        let is_gap = rest.trim().is_empty() && lines.last().is_none_or(|last| last.text.is_empty());
        if !is_out && !is_gap {
            lines.push(Line {
                test,
                text: rest.trim_end(),
            });
        }
    }
    while lines.last().is_some_and(|last| last.text.is_empty()) {
        lines.pop();
    }
    written(&lines)
}

struct Line<'a> {
    test: Option<&'a str>,
    text: &'a str,
}

fn written(lines: &[Line<'_>]) -> String {
    let first = lines.first().and_then(|line| line.test);
    let of_several = lines.iter().any(|line| line.test != first);
    let mut text = String::new();
    let mut said = None;
    for line in lines {
        match line.test {
            Some(name) if of_several && said != Some(name) && !line.text.is_empty() => {
                said = Some(name);
                text += &format!("{}: {}\n", name.replace('_', " "), line.text);
            }
            _ => text += &format!("{}\n", line.text),
        }
    }
    text
}

/// The name of the test that begins in this line, and what it prints there.
fn of_test(line: &str) -> (Option<&str>, &str) {
    let split = (line.strip_prefix("test ")).and_then(|rest| rest.split_once(" ..."));
    match split {
        Some((name, rest)) if !name.contains(' ') => (Some(name), rest.trim_start()),
        _ => (None, line),
    }
}

/// Lines of the test harness.
fn is_harness(line: &str) -> bool {
    let counts_tests = line.starts_with("running ") && line.contains(" test");
    counts_tests || line == "ok" || line.starts_with("test result: ")
}

#[cfg(test)]
mod tests {
    use super::figures;

    #[test]
    fn the_harness_is_left_out() {
        let output = "\nrunning 1 test\nworst 3 um\n\n\n  twice\ntest a_test ... ok\n\ntest result: ok. 1 passed\n\n";
        assert_eq!(figures(output, &[]), "worst 3 um\n\n  twice\n");
    }

    #[test]
    fn several_tests_are_named() {
        let output = "running 3 tests\ntest one ... error 1\nerror 2\nok\ntest silent ... ok\ntest the_other ... error 3\nok\n";
        let expected = "one: error 1\nerror 2\nthe other: error 3\n";
        assert_eq!(figures(output, &[]), expected);
    }

    #[test]
    fn what_is_not_wanted_is_left_out() {
        let output = "peak 4\nspeed 13 times real time\n";
        assert_eq!(figures(output, &["times real time"]), "peak 4\n");
    }
}
