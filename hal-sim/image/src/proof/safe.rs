//! That nothing in the control loop can fail, and that nothing of it is in flash.

use super::code::{Code, FLASH};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// What must not be there, and the way to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// What.
    pub what: String,
    /// From the handler to the function in which it stands.
    pub path: Vec<String>,
}

/// Everything in the image that breaks the rules of the control loop, whose handlers these are.
#[must_use]
pub fn faults(code: &Code, handlers: &[&str]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let panics = code.functions.values().filter(|it| is_panic(&it.name));
    if panics.count() == 0 {
        faults.push(fault("no panic machinery found to lead to", Vec::new()));
    }
    for handler in handlers {
        match code.named(handler) {
            Some(start) => from(code, start, &mut faults),
            None => faults.push(fault("no such handler", vec![(*handler).to_owned()])),
        }
    }
    for function in code.functions.values() {
        for at in &function.fused {
            let what = format!("fused multiply-add at {at:#010x}");
            faults.push(fault(&what, vec![function.name.clone()]));
        }
    }
    faults
}

/// Looks at every function that a handler leads to.
fn from(code: &Code, start: u64, faults: &mut Vec<Fault>) {
    let mut before = BTreeMap::from([(start, None)]);
    let mut waiting = vec![start];
    while let Some(at) = waiting.pop() {
        let Some(function) = code.functions.get(&at) else {
            continue;
        };
        let mut note = |what: &str| faults.push(fault(what, path(code, &before, at)));
        if is_panic(&function.name) {
            note("panic");
            // One path there is enough.
            continue;
        }
        if is_double(&function.name) {
            note("arithmetic in f64");
        }
        if FLASH.contains(&at) {
            note("code in flash");
        }
        for place in &function.flash {
            note(&format!("an address of the flash at {place:#010x}"));
        }
        for trap in &function.traps {
            note(&format!("trap at {trap:#010x}"));
        }
        for pointer in &function.pointers {
            note(&format!("call through a pointer at {pointer:#010x}"));
        }
        for edge in &function.edges {
            if leads(code, edge.to, at) {
                note(&format!("recursion through {}", code.name(edge.to)));
            }
        }
        for edge in &function.edges {
            before.entry(edge.to).or_insert_with(|| {
                waiting.push(edge.to);
                Some(at)
            });
        }
    }
}

/// Bytes of the functions that handlers lead to.
#[must_use]
pub fn reached_bytes(code: &Code, handlers: &[&str]) -> u64 {
    let mut waiting: Vec<u64> = handlers
        .iter()
        .filter_map(|name| code.named(name))
        .collect();
    let mut seen: BTreeSet<u64> = waiting.iter().copied().collect();
    while let Some(at) = waiting.pop() {
        let edges = code.functions.get(&at).into_iter().flat_map(|it| &it.edges);
        waiting.extend(edges.map(|edge| edge.to).filter(|next| seen.insert(*next)));
    }
    let reached = seen.iter().filter_map(|at| code.functions.get(at));
    reached.map(|it| it.size).sum()
}

/// Whether one function leads to another, or is it.
fn leads(code: &Code, from: u64, to: u64) -> bool {
    let mut seen = BTreeSet::from([from]);
    let mut waiting = vec![from];
    while let Some(at) = waiting.pop() {
        if at == to {
            return true;
        }
        let edges = code.functions.get(&at).into_iter().flat_map(|it| &it.edges);
        waiting.extend(edges.map(|edge| edge.to).filter(|next| seen.insert(*next)));
    }
    false
}

fn path(code: &Code, before: &BTreeMap<u64, Option<u64>>, to: u64) -> Vec<String> {
    let mut path = vec![code.name(to)];
    let mut at = to;
    while let Some(Some(earlier)) = before.get(&at) {
        path.push(code.name(*earlier));
        at = *earlier;
    }
    path.reverse();
    path
}

fn fault(what: &str, path: Vec<String>) -> Fault {
    Fault {
        what: what.to_owned(),
        path,
    }
}

/// The panic machinery: `core`'s functions for it, its handler, and the reset that this ends in.
fn is_panic(name: &str) -> bool {
    let failures = [
        "unwrap_failed",
        "expect_failed",
        "slice_index_fail",
        "sys_reset",
    ];
    name.contains("core::panicking::")
        || name.contains("rust_begin_unwind")
        || failures.iter().any(|it| name.ends_with(it))
}

/// The runtime's functions for f64: `__aeabi_dmul`, `__aeabi_f2d`, `__muldf3`.
fn is_double(name: &str) -> bool {
    match name.strip_prefix("__aeabi_") {
        Some(operation) => operation.starts_with('d') || operation.ends_with("2d"),
        None => name.starts_with("compiler_builtins::") && name.contains("df"),
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.what, self.path.join(" -> "))
    }
}
