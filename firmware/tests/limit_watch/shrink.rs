//! Leaves out lines as long as a rule stays broken.

use super::rule::Rule;
use super::run::run;
use super::script::Script;

/// Runs at most so many scripts.
const MOST: usize = 300;

/// A script that breaks the rule and has no line that it could do without, as far as so many runs can tell. Half of the
/// lines is tried first, then less and less (Zeller and Hildebrandt, 2002).
pub fn shrink(mut script: Script, rule: Rule) -> Script {
    let mut runs = 0;
    let mut block = script.0.len() / 2;
    while block > 0 {
        let before = script.0.len();
        let mut end = before;
        while end > 0 && runs < MOST {
            let start = end.saturating_sub(block);
            let shorter = script.without(start..end);
            runs += 1;
            if run(&shorter).breaches.contains_key(&rule) {
                script = shorter;
            }
            end = start;
        }
        if script.0.len() == before || block > 1 {
            block /= 2;
        }
        if runs == MOST {
            break;
        }
    }
    script
}
