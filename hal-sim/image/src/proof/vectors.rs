//! That every exception has a handler that ends, and that those nobody expects use no stack.

use super::code::Code;
use super::safe::Fault;
use super::stack::LEVELS;

/// Vectors that lead to nothing of the image's own, and what the last line of defence does that it must not: a stack that is
/// broken already is no stack to push to.
#[must_use]
pub fn vector_faults(code: &Code) -> Vec<Fault> {
    let expected = |name: &str| LEVELS.iter().any(|level| level.handlers.contains(&name));
    let mut faults = Vec::new();
    let mut note = |what: &str, name: String| {
        faults.push(Fault {
            what: what.to_owned(),
            path: vec![name],
        });
    };
    for at in &code.handlers {
        if !expected(&code.name(*at)) {
            note("a vector of nobody", code.name(*at));
        }
    }
    let [.., last] = LEVELS;
    for name in last.handlers {
        let found = code.named(name).and_then(|at| code.functions.get(&at));
        match found {
            None => note("no such handler", (*name).to_owned()),
            Some(it) if it.frame > 0 || !it.edges.is_empty() || !it.pointers.is_empty() => {
                note("a stack is used by", it.name.clone());
            }
            Some(_) => {}
        }
    }
    faults
}
