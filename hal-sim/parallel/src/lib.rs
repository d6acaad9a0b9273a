//! Runs that know nothing of each other, side by side.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{ScopedJoinHandle, available_parallelism, scope};

/// As many threads as there are cores.
#[must_use]
pub fn cores() -> usize {
    available_parallelism().map_or(1, usize::from)
}

/// What is asked of each case, in the order of the cases, by so many threads. A thread that panics fails this one.
pub fn of_all<T: Sync, R: Send>(
    cases: &[T],
    threads: usize,
    ask: impl Fn(&T) -> R + Sync,
) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut answers = Vec::new();
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(i) else {
                return answers;
            };
            answers.push((i, ask(case)));
        }
    };
    let mut answers = scope(|scope| {
        let threads: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(work)).collect();
        (threads.into_iter().map(ScopedJoinHandle::join))
            .flat_map(|answers| answers.unwrap_or_else(|panic| resume_unwind(panic)))
            .collect::<Vec<_>>()
    });
    answers.sort_by_key(|(i, _)| *i);
    answers.into_iter().map(|(_, answer)| answer).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_stand_in_the_order_of_their_cases() {
        let cases: Vec<u64> = (0..100).collect();
        for threads in [0, 1, 3, 200] {
            let slow_first = |case: &u64| {
                std::thread::sleep(std::time::Duration::from_micros(100 - case));
                2 * case
            };
            let doubled: Vec<u64> = cases.iter().map(|case| 2 * case).collect();
            assert_eq!(of_all(&cases, threads, slow_first), doubled);
        }
    }
}
