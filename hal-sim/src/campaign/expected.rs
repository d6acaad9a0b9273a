//! What the controller has to say about what breaks: under which names it may be told, and from when to when.

use firmware::fault::FaultKind as Kind;

use super::effect::Effect;
use super::injection::{Injection, Other};

/// A reason for a fault, or for an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cause {
    /// What has to have passed its threshold.
    pub effect: Effect,
    /// What it may be called then; nothing where it is told by an event.
    pub kind: Option<Kind>,
    /// Ticks after that at which it is latched at the latest; `None`: it need not be.
    pub within_ticks: Option<u64>,
    /// Ticks by which it may be latched before, since the judge computes in other numbers.
    pub early_ticks: u64,
    /// Ticks after which it is no reason any more, of what is looked at once.
    pub late_ticks: u64,
}

/// What the controller has to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Why it may latch a fault; none: it goes on.
    pub causes: &'static [Cause],
    /// Whether the fault names the pivot.
    pub names_pivot: bool,
    /// What `EVT?`, or the answer to `ERR?`, tells of it where it is no fault.
    pub told: Option<&'static str>,
}

impl Expected {
    /// Whether it may be told by an event, with none of its causes at a tick of its own.
    pub fn is_gathered(&self) -> bool {
        self.told.is_some() && self.causes.iter().all(|cause| cause.kind.is_some())
    }
}

/// Ticks until the command side, which has its turn every few, has told of something.
const COMMAND_SIDE_TICKS: u64 = 20;

const fn cause(effect: Effect, kind: Kind, within_ticks: u64) -> Cause {
    Cause {
        effect,
        kind: Some(kind),
        within_ticks: Some(within_ticks),
        early_ticks: 0,
        late_ticks: u64::MAX,
    }
}

const fn event(effect: Effect) -> Cause {
    Cause {
        effect,
        kind: None,
        within_ticks: Some(COMMAND_SIDE_TICKS),
        early_ticks: 0,
        late_ticks: u64::MAX,
    }
}

/// A pivot that is further off than it may be, whatever put it there.
const FOLLOWING: Cause = Cause {
    early_ticks: 1,
    ..cause(Effect::FollowingError, Kind::FollowingError, 1)
};
/// One that hardly grows is nearly as large as its limit for some ticks.
const NEARLY_FOLLOWING: Cause = Cause {
    effect: Effect::NearlyFollowingError,
    within_ticks: None,
    ..FOLLOWING
};
/// An encoder that repeats its reading, which one of a pivot that is held fast does too: nothing tells the two apart.
const STILL: Cause = Cause {
    within_ticks: None,
    ..cause(Effect::Still, Kind::EncoderFrozen, 0)
};
const OVERSPEED: Cause = cause(Effect::Overspeed, Kind::Overspeed, 0);
const BRIEFLY_OVERSPEED: Cause = Cause {
    effect: Effect::BrieflyOverspeed,
    within_ticks: None,
    ..OVERSPEED
};

/// Pivots are looked at in turn, every fourth tick.
/// A tenth of the shortest time that a run has: noise of the current makes pauses that the controller sees and the judge does not.
const STALLED: Cause = cause(Effect::AtEnd, Kind::Stalled, 44);
const NEARLY_STALLED: Cause = Cause {
    effect: Effect::NearlyAtEnd,
    within_ticks: None,
    // The controller counts from when it limits the current, which rises some ticks later.
    early_ticks: 16,
    ..STALLED
};
const HOT: Cause = Cause {
    early_ticks: 6,
    ..cause(Effect::Hot, Kind::MotorHot, 6)
};
/// Each current is looked at every fourth tick only, and near the threshold it rises slowly.
const NEARLY_HOT: Cause = Cause {
    effect: Effect::NearlyHot,
    within_ticks: None,
    ..HOT
};
const OSCILLATES: Cause = Cause {
    early_ticks: 100,
    ..cause(Effect::Oscillates, Kind::Oscillation, 400)
};
/// The judge sees the whole voltage, the controller what its feedback asks for.
const NEARLY_OSCILLATES: Cause = Cause {
    effect: Effect::NearlyOscillates,
    within_ticks: None,
    ..OSCILLATES
};
const CURRENT: Cause = Cause {
    early_ticks: 16,
    ..cause(Effect::CurrentUnexplained, Kind::CurrentUnexplained, 40)
};
const MAYBE_CURRENT: Cause = Cause {
    effect: Effect::CurrentMaybeUnexplained,
    within_ticks: None,
    ..CURRENT
};
/// A reading that stays the same though the current does not; the judge's model of the current has the measured rate, the controller's what it
/// has learnt.
const STAYS: Cause = Cause {
    early_ticks: 16,
    ..cause(Effect::CurrentStays, Kind::CurrentUnexplained, 40)
};
/// A lead that was lost when the servo went on.
const LEADS: Cause = Cause {
    // A lead is missed by the first of two measurements, a direction by one of them.
    early_ticks: 16,
    ..cause(Effect::LeadsTested, Kind::CurrentUnexplained, 2)
};
/// Lost while it was tested, or a current that is told wrong by more than half.
const MAYBE_LEADS: Cause = Cause {
    effect: Effect::LeadsMaybeTested,
    within_ticks: None,
    late_ticks: 24,
    ..LEADS
};
/// What a motion that goes wrong may be found by.
const MOTION: &[Cause] = &[
    FOLLOWING,
    NEARLY_FOLLOWING,
    STILL,
    STALLED,
    NEARLY_STALLED,
    HOT,
    NEARLY_HOT,
    OVERSPEED,
    BRIEFLY_OVERSPEED,
    OSCILLATES,
    NEARLY_OSCILLATES,
    // What the servo has learnt of the motor constant explains some of it.
    MAYBE_CURRENT,
    // What drives a ring from outside may give back more than the brake resistor takes.
    MAYBE_RISES,
];
/// And what a current sensor is found by that is wrong: what the current's limit makes of it is a motion that goes wrong.
const CURRENT_SENSOR: &[Cause] = &{
    const OWN: [Cause; 2] = [STAYS, MAYBE_LEADS];
    let mut causes = [STAYS; MOTION.len() + OWN.len()];
    let (motion, own) = causes.split_at_mut(MOTION.len());
    motion.copy_from_slice(MOTION);
    own.copy_from_slice(&OWN);
    causes
};
/// A pivot that an excitation, or whoever pushes meanwhile, takes too far or too fast.
const EXCITED: &[Cause] = &{
    const TOO_FAR: Cause = cause(Effect::ExcitedTooFar, Kind::ExcitationWay, 1);
    const TOO_FAST: Cause = cause(Effect::ExcitedTooFast, Kind::Overspeed, 1);
    [
        TOO_FAR,
        Cause {
            effect: Effect::NearlyExcitedTooFar,
            within_ticks: None,
            ..TOO_FAR
        },
        TOO_FAST,
        Cause {
            effect: Effect::NearlyExcitedTooFast,
            within_ticks: None,
            ..TOO_FAST
        },
    ]
};
const SUPPLY_LOW: Cause = cause(Effect::LowSupply, Kind::SupplyLow, 1);
/// Near the threshold noise decides.
const NEARLY_SUPPLY_LOW: Cause = Cause {
    effect: Effect::NearlyLowSupply,
    within_ticks: None,
    ..SUPPLY_LOW
};
const SUPPLY_HIGH: Cause = cause(Effect::HighSupply, Kind::SupplyHigh, 1);
const NEARLY_SUPPLY_HIGH: Cause = Cause {
    effect: Effect::NearlyHighSupply,
    within_ticks: None,
    ..SUPPLY_HIGH
};
/// A five-hundredth of the time that heats it, for the voltages at which it is switched and the sums of 32 bits.
const RESISTOR_HOT: Cause = Cause {
    early_ticks: 70,
    ..cause(Effect::ResistorHot, Kind::BrakeResistorHot, 70)
};
/// The judge does not know to the tick when it was switched on.
const RISES: Cause = Cause {
    early_ticks: 10,
    ..cause(Effect::SupplyRises, Kind::SupplyRises, 10)
};
const MAYBE_RISES: Cause = Cause {
    effect: Effect::SupplyMayRise,
    within_ticks: None,
    ..RISES
};
const RESISTOR_DEAD: Cause = cause(Effect::ResistorTested, Kind::BrakeResistorDead, 1);
/// Broken while it was tested.
const MAYBE_RESISTOR_DEAD: Cause = Cause {
    effect: Effect::ResistorMaybeTested,
    within_ticks: None,
    ..RESISTOR_DEAD
};
const RESISTOR_DEAD_AT_REST: Cause =
    cause(Effect::ResistorTestedAtRest, Kind::BrakeResistorDead, 1);
const MAYBE_RESISTOR_DEAD_AT_REST: Cause = Cause {
    effect: Effect::ResistorMaybeTestedAtRest,
    within_ticks: None,
    ..RESISTOR_DEAD_AT_REST
};
const EMERGENCY_STOP: Cause = cause(Effect::AtOnce, Kind::EmergencyStop, 0);
const SILENT: Cause = cause(Effect::BadFrames, Kind::EncoderSilent, 0);
/// Bad frames in a row as they come, whatever is wrong with the last one.
const BAD_IN_A_ROW: Cause = cause(Effect::BadInARow, Kind::EncoderCrc, 0);
const SOME_BAD: Cause = Cause {
    effect: Effect::SomeBad,
    within_ticks: None,
    ..BAD_IN_A_ROW
};

const fn some_bad(kind: Kind) -> Cause {
    Cause {
        kind: Some(kind),
        ..SOME_BAD
    }
}

/// Found before the first tick.
const DAMAGED: Cause = Cause {
    early_ticks: 1,
    ..cause(Effect::AtOnce, Kind::SettingsDamaged, 0)
};

const NEWER: Cause = Cause {
    kind: Some(Kind::SettingsNewer),
    ..DAMAGED
};

/// Largest of the early ticks: for so long a fault may come before its cause.
pub(super) const MOST_EARLY: u64 = 16;
/// Ticks until the watchdog has bitten, the controller has started and its command side has told.
pub(super) const RESTART_TICKS: u64 = 10 + 20 + COMMAND_SIDE_TICKS;

/// On a stage that allows pivots to be far from their setpoints: they go where guides let them, while the controller's model of their currents has
/// the setpoints' rates.
const LED_ASTRAY: Cause = Cause {
    within_ticks: None,
    ..cause(Effect::FarOff, Kind::CurrentUnexplained, 0)
};

impl Injection {
    /// What the controller has to say.
    #[must_use]
    pub const fn expected(&self) -> Expected {
        let causes: &'static [Cause] = match self {
            Self::Silent(_) | Self::TwoEncoders(_) => &[SILENT],
            Self::BadCrc => &const { [cause(Effect::BadFrames, Kind::EncoderCrc, 0)] },
            Self::ErrorBit => &const { [cause(Effect::BadFrames, Kind::EncoderError, 0)] },
            Self::Jump(_) => &const { [cause(Effect::BadFrames, Kind::EncoderJump, 0)] },
            // Where the setpoint slows down, it is the drive that shows it.
            Self::Frozen => &const { [cause(Effect::FrozenWay, Kind::EncoderFrozen, 30), STILL] },
            Self::BridgeFault => &const { [cause(Effect::Driven, Kind::BridgeFault, 1)] },
            Self::SupplySag(_) => &[
                SUPPLY_LOW,
                NEARLY_SUPPLY_LOW,
                FOLLOWING,
                NEARLY_FOLLOWING,
                STALLED,
                NEARLY_STALLED,
            ],
            Self::EmergencyStop => &[EMERGENCY_STOP],
            // At full speed the pivots lead by what was missed, which may be too far. A loop that misses ticks has less phase, and may ring.
            Self::LateLoop => {
                &const {
                    [
                        cause(Effect::LateTicks, Kind::LoopLate, 0),
                        FOLLOWING,
                        NEARLY_FOLLOWING,
                        OSCILLATES,
                        NEARLY_OSCILLATES,
                    ]
                }
            }
            Self::FewMissedTicks(_) => {
                &[FOLLOWING, NEARLY_FOLLOWING, OSCILLATES, NEARLY_OSCILLATES]
            }
            Self::DirectionStuck => &[
                FOLLOWING,
                NEARLY_FOLLOWING,
                CURRENT,
                MAYBE_CURRENT,
                LEADS,
                MAYBE_LEADS,
            ],
            Self::DriveLost => &[
                FOLLOWING,
                NEARLY_FOLLOWING,
                STILL,
                STALLED,
                NEARLY_STALLED,
                CURRENT,
                MAYBE_CURRENT,
                LEADS,
                MAYBE_LEADS,
            ],
            Self::Jam => &[FOLLOWING, NEARLY_FOLLOWING, STILL, STALLED, NEARLY_STALLED],
            // A machine that is hit rings. So does one whose loops hold a resonance that they do not hold with their gains cut by the current's limit.
            Self::Knock(_) | Self::Runaway(_) => MOTION,
            Self::Wedged => &[
                STALLED,
                NEARLY_STALLED,
                FOLLOWING,
                NEARLY_FOLLOWING,
                STILL,
                LED_ASTRAY,
                OSCILLATES,
                NEARLY_OSCILLATES,
            ],
            Self::HotMotor(_) => &[
                HOT,
                NEARLY_HOT,
                FOLLOWING,
                NEARLY_FOLLOWING,
                OSCILLATES,
                NEARLY_OSCILLATES,
            ],
            Self::DamagedSettings => &[DAMAGED],
            Self::NewerSettings => &[NEWER],
            Self::Warning | Self::QueueFull | Self::Slip(_) => &const { [event(Effect::AtOnce)] },
            Self::LoopStands | Self::Crash => {
                &const {
                    [Cause {
                        within_ticks: Some(RESTART_TICKS),
                        ..event(Effect::AtOnce)
                    }]
                }
            }
            Self::HostSilent => &const { [event(Effect::Silence)] },

            Self::FewBadFrames(_) | Self::SupplyRipple(..) => &[],
            Self::Bursts(..) => &const { [event(Effect::OftenBad)] },
            Self::SupplyHigh(_) => &[SUPPLY_HIGH, NEARLY_SUPPLY_HIGH],
            Self::ResistorHot(_) => &[RESISTOR_HOT],
            Self::ResistorOpen | Self::ResistorStuckOn => &[
                RESISTOR_DEAD,
                MAYBE_RESISTOR_DEAD,
                RESISTOR_DEAD_AT_REST,
                MAYBE_RESISTOR_DEAD_AT_REST,
                RISES,
                MAYBE_RISES,
            ],
            // It shows no drop when the resistor is tested. In motion duties are wrong by what the bus sags and rises.
            Self::SupplyStuck => &[
                RESISTOR_DEAD,
                MAYBE_RESISTOR_DEAD,
                RESISTOR_DEAD_AT_REST,
                MAYBE_RESISTOR_DEAD_AT_REST,
                FOLLOWING,
                NEARLY_FOLLOWING,
                STALLED,
                NEARLY_STALLED,
            ],
            Self::BitErrors(_) => {
                &const {
                    [
                        BAD_IN_A_ROW,
                        SOME_BAD,
                        some_bad(Kind::EncoderSilent),
                        some_bad(Kind::EncoderError),
                        some_bad(Kind::EncoderJump),
                        FOLLOWING,
                        NEARLY_FOLLOWING,
                        OVERSPEED,
                        BRIEFLY_OVERSPEED,
                    ]
                }
            }
            Self::Both(other) => match other {
                Other::EmergencyStop => &[SILENT, EMERGENCY_STOP],
                Other::Supply => &[SILENT, SUPPLY_LOW, NEARLY_SUPPLY_LOW],
                Other::Jam => &[SILENT, FOLLOWING, NEARLY_FOLLOWING, STILL, STALLED],
                Other::DriveLost => &[
                    SILENT,
                    FOLLOWING,
                    NEARLY_FOLLOWING,
                    STILL,
                    STALLED,
                    CURRENT,
                    MAYBE_CURRENT,
                ],
            },
            Self::CurrentBias(_) | Self::CurrentStuck => CURRENT_SENSOR,
            Self::PushedExcited(_) => EXCITED,
            Self::Drift(_)
            | Self::Scale(_)
            | Self::SupplyBias(_)
            | Self::Fading(_)
            | Self::Friction(_)
            | Self::GuideJam
            | Self::LooseCoupling(_)
            | Self::Softer(_)
            | Self::LoadLost
            | Self::ExchangedLines
            | Self::Gain(_) => MOTION,
        };
        let told = match self {
            Self::Warning => Some("encoder warns"),
            Self::Bursts(..) => Some("bad encoder frames bridged"),
            Self::Slip(_) => Some("encoder stepped"),
            Self::LooseCoupling(_) => Some("knocks"),
            Self::HostSilent => Some("no host heard"),
            Self::LoopStands => Some("start by the watchdog"),
            Self::Crash => Some("start by a panic"),
            Self::QueueFull => Some("1005"),
            _ => None,
        };
        // The platform ties the pivots together, so that another one may be the first that is too far off.
        let names_pivot = matches!(
            self,
            Self::Silent(_)
                | Self::BadCrc
                | Self::ErrorBit
                | Self::Frozen
                | Self::Jump(_)
                | Self::BridgeFault
                | Self::TwoEncoders(_)
        );
        Expected {
            causes,
            names_pivot,
            told,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::injection::NAMES;
    use super::*;
    use crate::machine::unknown;
    use crate::random::Random;
    use firmware::fault::FAULT_DESCRIPTIONS;

    /// Kinds that nothing which breaks at the machine brings about, and the tests that raise them, by kind or by what is told of it.
    const ELSEWHERE: [(Kind, &str); 7] = [
        (Kind::ImpossibleSetpoint, "tests/tests/impossible.rs"),
        (Kind::WorkspaceLeft, "tests/tests/impossible.rs"),
        (Kind::GuideRange, "tests/tests/impossible.rs"),
        (Kind::NotFinite, "tests/tests/impossible.rs"),
        (Kind::PivotsTooClose, "tests/tests/detections.rs"),
        (Kind::ImageDamaged, "tests/tests/faults.rs"),
        (Kind::CrystalFailed, "hal-sim/image/tests/chip_crash.rs"),
    ];

    #[test]
    fn every_kind_of_fault_arises_here_or_in_a_test_of_its_own() {
        let mut random = Random::new(1);
        let mut drawn = [false; NAMES.len()];
        let mut here = Vec::new();
        for _ in 0..10_000 {
            let injection = Injection::random(&mut random, 3, &unknown(1));
            drawn[injection.index()] = true;
            here.extend(
                injection
                    .expected()
                    .causes
                    .iter()
                    .filter_map(|cause| cause.kind),
            );
        }
        assert_eq!(drawn, [true; NAMES.len()]);
        for description in FAULT_DESCRIPTIONS {
            let kind = description.kind;
            let elsewhere = ELSEWHERE.iter().find(|(other, _)| *other == kind);
            assert_ne!(here.contains(&kind), elsewhere.is_some(), "{kind:?}");
            if let Some((_, test)) = elsewhere {
                let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
                let text = std::fs::read_to_string(root.join(test)).expect("the test is there");
                let is_raised = text.contains(&format!("FaultKind::{kind:?}"));
                let told = kind.text().split(',').next().unwrap_or_default();
                assert!(is_raised || text.contains(told), "{test}: {kind:?}");
            }
        }
    }
}
