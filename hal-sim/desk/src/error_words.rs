//! Error numbers of the General Command Set in words, for people: what the page shows in place of a number.

use firmware::gcs::ErrorCode;

/// Makes the table, and a `match` over it: a code that is missing or named twice, or that no controller sets, does not compile.
macro_rules! error_words {
    ($($code:ident: $words:literal,)*) => {
        /// What an error means.
        #[must_use]
        pub const fn words(code: ErrorCode) -> &'static str {
            match code {
                $(ErrorCode::$code => $words,)*
            }
        }

        /// All errors that a controller sets, and what each means.
        pub const ERROR_WORDS: &[(ErrorCode, &str)] = &[$((ErrorCode::$code, $words),)*];
    };
}

error_words! {
    None: "no error",
    Syntax: "the line is not understood",
    UnknownCommand: "no such command",
    LineTooLong: "the line is too long",
    NotReady: "not referenced, or the servo is off",
    PositionLimit: "out of the stage’s reach or of the soft limits",
    VelocityLimit: "velocity out of limits",
    CentreNotSettable: "the centre of rotation is the frame’s origin",
    Stopped: "stopped",
    InvalidAxis: "no such axis",
    OutOfRange: "a value is out of range",
    MacroName: "no such macro name",
    MacroNotFound: "no such macro",
    AxisTwice: "an axis is named twice",
    ParameterCount: "wrong number of values",
    InvalidNumber: "not a number",
    SoftLimit: "soft limit out of range",
    NotForStage: "not possible with this stage",
    ReferencingFailed: "referencing failed: an encoder does not answer, or the pivots are no pose",
    InMotion: "not while something moves",
    UnknownParameter: "no such parameter",
    Password: "wrong password",
    NoSuchTable: "no such recorder table",
    UnknownOption: "no such recorder option, or not of this source",
    LevelTooLow: "this needs command level 1",
    ReadOnly: "this parameter can only be read",
    WaveTooLarge: "no memory left for that waveform",
    GeneratorActive: "a generator is running",
    NoWave: "a generator has no table, or an empty one",
    NotRecorded: "so many points have not been recorded",
    TableOff: "this recorder table records nothing",
    NotAllowed: "not in this state",
    WhileMoving: "not while it moves, or with frames like these",
    StreamDry: "streamed targets did not come in time: the stage has stopped",
    StreamFull: "streamed targets came too fast: this one was not taken",
    ReceiveOverflow: "too much was sent at once, or it was damaged on the way",
    FollowingError: "following error too large: the motors are off",
    NoMemory: "no room for another macro or variable",
    TooDeeplyNested: "macros start macros too deeply",
    NotRecording: "no macro is being recorded",
    MacroParameter: "nothing that a macro can have",
    Busy: "busy: nothing was done",
    InvalidIdentifier: "no name for a variable",
    UnknownVariable: "no such variable",
    MacroRunning: "a macro is running",
    MotionError: "a fault is latched: acknowledge it first",
    FlashFailed: "the settings cannot be kept: the flash does not take them",
    OwnedByAnother: "another connection owns the stage: OWN? tells which; only stopping is possible",
    NothingToRecover: "nothing to recover: the measured pose is in reach, or the servo is on",
    NotCommissioned: "the machine is not commissioned, so nothing drives: CMS? says what is missing",
    Debugged: "a debugger is attached, which can halt the loop under load: nothing drives unless parameter 0x54500512 is 1",
    StopUntested: "the emergency stop has to be pressed once, released and acknowledged (FLC) after each start before anything drives: parameter 0x54500514",
    CalibrationDamaged: "the calibration has not come whole: numbers are missing, or its checksum is another",
    CalibrationBeyondLimits: "the calibration has numbers that cannot be corrected: is an encoder’s zero not the parameter’s?",
    CalibrationOfAnother: "the calibration is another machine’s: its serial number is not that of SSN?",
    LimitsNotBorne: "motors and supply do not bear these limits of motion with this load: EVT? tells which they bear",
    ReferenceOutside: "the measured pose is out of the stage’s reach: check wiring and zeros (EVT? has the pose), then RCV 1 drives it slowly back in",
}

/// What an error number means, with the number; one that no controller of ours sets, by its number alone.
#[must_use]
pub fn refused_with(number: u16) -> String {
    let known = ERROR_WORDS.iter().find(|(code, _)| code.number() == number);
    known.map_or_else(
        || format!("refused with error {number}"),
        |(code, _)| format!("{} (error {number})", words(*code)),
    )
}

/// The table as a script of the page.
#[must_use]
pub fn script() -> String {
    let row = |(code, words): &(ErrorCode, &str)| format!("  {}: {words:?},\n", code.number());
    let rows: String = ERROR_WORDS.iter().map(row).collect();
    format!(
        "// Error numbers in words, made from the program's table.\n\nexport const WORDS = {{\n{rows}}};\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn refusals_are_told_in_words() {
        assert_eq!(
            refused_with(7),
            "out of the stage’s reach or of the soft limits (error 7)"
        );
        assert_eq!(refused_with(9999), "refused with error 9999");
    }

    #[test]
    fn the_page_gets_the_words_of_every_error_and_of_nothing_else() {
        let script = script();
        let object = script.split_once("WORDS = ").expect("the table").1;
        let rows = object.lines().filter_map(|line| {
            let (number, words) = line.trim().split_once(": ")?;
            let words = serde_json::from_str::<String>(words.strip_suffix(',')?).ok()?;
            Some((number.parse().ok()?, words))
        });
        let served: BTreeMap<u16, String> = rows.collect();
        assert_eq!(served.len(), ERROR_WORDS.len());
        for (code, _) in ERROR_WORDS {
            let served = served.get(&code.number()).map(String::as_str);
            assert_eq!(served, Some(words(*code)));
        }
    }
}
