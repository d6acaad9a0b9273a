//! Viewers that share one line: to the controller they are one connection, so that what a connection has for itself is kept apart
//! here. Errors are, because each line is asked for its own; command level and ownership are by this.

use std::collections::HashMap;

use firmware::gcs::{Action, ErrorCode, Query, Request, parse};

use crate::line::Answer;

/// Number of a viewer.
pub(super) type ViewerNumber = u64;

/// What a viewer is called where others ask who commands.
pub(super) fn page_name(viewer: ViewerNumber) -> String {
    format!("page_{viewer}")
}

/// Command level at first.
const LOWEST_LEVEL: &str = "CCL 0";

/// Who has which command level, and who owns.
#[derive(Default)]
pub(super) struct Arbiter {
    owner: Option<ViewerNumber>,
    /// The line that gave a viewer its command level.
    levels: HashMap<ViewerNumber, String>,
    /// The one that the controller had last.
    level: Option<String>,
    /// Whose name the line has.
    named: Option<ViewerNumber>,
}

/// What is to be done for a viewer.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// This error, and nothing goes out.
    Refuse(ErrorCode),
    /// These lines go out, the last of them for the viewer.
    Send(Vec<String>),
}

impl Arbiter {
    /// What a line of a viewer comes to.
    pub fn judge(&self, viewer: ViewerNumber, line: &str) -> Verdict {
        let is_others = self.owner.is_some_and(|owner| owner != viewer);
        let line = match said(line) {
            Said::Own { own: true, .. } if is_others => {
                return Verdict::Refuse(ErrorCode::OwnedByAnother);
            }
            // The line's ownership is that of the viewer who has it.
            Said::Own { own: false, .. } if is_others => {
                return Verdict::Send(vec!["OWN?".to_owned()]);
            }
            Said::Own {
                own: true,
                named: false,
            } => format!("OWN 1 {}", page_name(viewer)),
            _ => line.to_owned(),
        };
        let changes_stage = parse(line.as_bytes()).is_ok_and(|request| request.changes_stage());
        if is_others && changes_stage {
            return Verdict::Refuse(ErrorCode::OwnedByAnother);
        }
        let level = self.level_of(viewer);
        let is_same = self.level.as_deref().unwrap_or(LOWEST_LEVEL) == level;
        let level = (!is_same).then(|| level.to_owned());
        // So that others are told who commanded last. Who owns has given the line its name by that.
        let is_named = self.named == Some(viewer) || self.owner.is_some();
        let name = (changes_stage && !is_named).then(|| format!("OWN 0 {}", page_name(viewer)));
        Verdict::Send(level.into_iter().chain(name).chain([line]).collect())
    }

    /// Of the lines for a viewer the last has not gone out, perhaps none has.
    pub fn interrupt(&mut self) {
        // Neither is that of any viewer: both are given again.
        self.level = Some(String::new());
        self.named = None;
    }

    /// Takes what became of a viewer's line, and says it as for a connection of its own.
    pub fn note(&mut self, viewer: ViewerNumber, line: &str, answer: &mut Answer) {
        self.level = Some(self.level_of(viewer).to_owned());
        let changes_stage = parse(line.as_bytes()).is_ok_and(|request| request.changes_stage());
        self.named = if changes_stage {
            Some(viewer)
        } else {
            self.named
        };
        let done = answer.error == 0;
        match said(line) {
            Said::Own { own: true, .. } if done => {
                (self.owner, self.named) = (Some(viewer), Some(viewer));
            }
            Said::Own { own: false, .. } => {
                answer.reply = None;
                self.named = None;
                self.owner = self.owner.filter(|owner| *owner != viewer);
            }
            Said::WhoOwns => {
                let mine = format!("MINE={}", u8::from(self.owner == Some(viewer)));
                let rows = answer.reply.iter().flat_map(|reply| reply.lines());
                let rows = rows.map(|row| if row.starts_with("MINE=") { &mine } else { row });
                answer.reply = Some(rows.collect::<Vec<_>>().join("\n"));
            }
            Said::Level if done => {
                self.levels.insert(viewer, line.to_owned());
                self.level = Some(line.to_owned());
            }
            _ => {}
        }
    }

    /// A viewer is gone; whether the line is to give the stage back.
    pub fn leave(&mut self, viewer: ViewerNumber) -> bool {
        self.levels.remove(&viewer);
        let owned = self.owner == Some(viewer);
        self.owner = self.owner.filter(|owner| *owner != viewer);
        owned
    }

    /// Another connection to the controller, which knows nothing of all that.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    fn level_of(&self, viewer: ViewerNumber) -> &str {
        self.levels
            .get(&viewer)
            .map_or(LOWEST_LEVEL, String::as_str)
    }
}

/// What a line means for those who share it.
enum Said {
    /// To own the stage, or no longer, and whether by a name.
    Own {
        own: bool,
        named: bool,
    },
    WhoOwns,
    Level,
    Other,
}

fn said(line: &str) -> Said {
    match parse(line.as_bytes()) {
        Ok(Request::Act(Action::Own(value, name))) if value == 0.0 || value == 1.0 => Said::Own {
            own: value == 1.0,
            named: name.is_some(),
        },
        Ok(Request::Query(Query::Ownership)) => Said::WhoOwns,
        Ok(Request::Act(Action::Level(..))) => Said::Level,
        _ => Said::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn done(
        arbiter: &mut Arbiter,
        viewer: ViewerNumber,
        line: &str,
        reply: Option<&str>,
    ) -> Answer {
        let mut answer = Answer {
            reply: reply.map(str::to_owned),
            error: 0,
        };
        arbiter.note(viewer, line, &mut answer);
        answer
    }

    fn sends(arbiter: &Arbiter, viewer: ViewerNumber, line: &str) -> Vec<String> {
        match arbiter.judge(viewer, line) {
            Verdict::Send(lines) => lines,
            Verdict::Refuse(code) => panic!("{line}: {code:?}"),
        }
    }

    #[test]
    fn the_level_of_a_viewer_is_its_own() {
        let mut arbiter = Arbiter::default();
        assert_eq!(sends(&arbiter, 1, "CCL 1 ADVANCED"), ["CCL 1 ADVANCED"]);
        done(&mut arbiter, 1, "CCL 1 ADVANCED", None);
        assert_eq!(sends(&arbiter, 1, "POS?"), ["POS?"]);
        assert_eq!(sends(&arbiter, 2, "POS?"), ["CCL 0", "POS?"]);
        done(&mut arbiter, 2, "POS?", None);
        assert_eq!(sends(&arbiter, 1, "CCL?"), ["CCL 1 ADVANCED", "CCL?"]);
    }

    #[test]
    fn the_line_has_the_name_of_whoever_commands() {
        let mut arbiter = Arbiter::default();
        assert_eq!(sends(&arbiter, 1, "MOV X 1"), ["OWN 0 page_1", "MOV X 1"]);
        done(&mut arbiter, 1, "MOV X 1", None);
        assert_eq!(sends(&arbiter, 1, "MOV X 2"), ["MOV X 2"]);
        assert_eq!(sends(&arbiter, 2, "POS?"), ["POS?"]);
        assert_eq!(sends(&arbiter, 2, "MOV X 3"), ["OWN 0 page_2", "MOV X 3"]);
        // What did not go out whole is given again.
        arbiter.interrupt();
        assert_eq!(
            sends(&arbiter, 1, "MOV X 1"),
            ["CCL 0", "OWN 0 page_1", "MOV X 1"]
        );
    }

    #[test]
    fn one_viewer_owns_and_the_others_look_and_stop() {
        let mut arbiter = Arbiter::default();
        assert_eq!(sends(&arbiter, 3, "own 1"), ["OWN 1 page_3"]);
        done(&mut arbiter, 3, "own 1", None);
        for line in ["MOV X 1", "svo x 0", "OWN 1", "VLS 10"] {
            assert_eq!(
                arbiter.judge(4, line),
                Verdict::Refuse(ErrorCode::OwnedByAnother),
                "{line}"
            );
            assert_ne!(
                arbiter.judge(3, line),
                Verdict::Refuse(ErrorCode::OwnedByAnother),
                "{line}"
            );
        }
        for line in ["POS?", "HLT", "HLP?"] {
            assert_eq!(sends(&arbiter, 4, line), [line]);
        }
        let told = "OWNER=page_3\nMINE=1\nLAST=page_3";
        assert_eq!(
            done(&mut arbiter, 3, "OWN?", Some(told)).reply.as_deref(),
            Some(told)
        );
        let others = done(&mut arbiter, 4, "OWN?", Some(told)).reply;
        assert_eq!(others.as_deref(), Some("OWNER=page_3\nMINE=0\nLAST=page_3"));
        // Who does not own gives nothing back, however the numbers are written.
        for line in ["OWN 0", "OWN 0.0", "own -0 eve"] {
            assert_eq!(sends(&arbiter, 4, line), ["OWN?"], "{line}");
        }
        for line in ["OWN 1.0", "OWN +1 eve"] {
            assert_eq!(
                arbiter.judge(4, line),
                Verdict::Refuse(ErrorCode::OwnedByAnother),
                "{line}"
            );
        }
        assert_eq!(done(&mut arbiter, 4, "OWN 0", Some(told)).reply, None);
        assert!(!arbiter.leave(4));
        assert!(arbiter.leave(3));
        assert_eq!(sends(&arbiter, 4, "OWN 1"), ["OWN 1 page_4"]);
    }
}
