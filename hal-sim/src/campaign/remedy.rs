//! What a builder adds for what the controller cannot detect.

use super::injection::NAMES;

const NOTHING: &str = "nothing: it is bridged, and shorter than what matters";
const AT_REST: &str = "nothing while it rests: it is found when the pivot has to move";
const SECOND_HEAD: &str = "a second head on the ring, or a sensor of the platform";
const MONITORED: &str =
    "nothing, if it is large: it is told after some seconds of fast motion (`EVT?`)";

/// One for each kind, in the order of [`NAMES`].
pub(super) const REMEDIES: [&str; NAMES.len()] = [
    NOTHING,
    NOTHING,
    NOTHING,
    AT_REST,
    SECOND_HEAD,
    NOTHING,
    NOTHING,
    "nothing while the servo is off",
    AT_REST,
    AT_REST,
    "nothing while the capacitor lasts",
    "a safety relay with two channels",
    AT_REST,
    "nothing: under the threshold it is a disturbance",
    NOTHING,
    NOTHING,
    NOTHING,
    "a thermal switch in the winding",
    "nothing: under the threshold it is a disturbance",
    AT_REST,
    NOTHING,
    "a safety relay that a watchdog of its own opens",
    NOTHING,
    NOTHING,
    NOTHING,
    "nothing while the servo is off",
    "a thermal switch on the brake resistor",
    "nothing: it is in what the supply may be",
    SECOND_HEAD,
    SECOND_HEAD,
    "nothing: seldom enough not to be told",
    "a count of bad frames that somebody looks at",
    NOTHING,
    MONITORED,
    MONITORED,
    MONITORED,
    MONITORED,
    AT_REST,
    "nothing, if it moves: it is told once it has knocked five times (`EVT?`); `tripivot frf` at service",
    "holding-down of the load; `tripivot tune` measures it",
    SECOND_HEAD,
    "nothing: at rest it is not in force or rings less than the threshold",
    "nothing: it is found after two seconds of rest, and at servo on",
    "a thermal fuse at the resistor: it is found after two seconds of rest, and at servo on",
    SECOND_HEAD,
    "a second current sensor, or a sum of currents and the supply's",
    "a second divider: it is found after two seconds of rest, and at servo on",
    NOTHING,
    "nothing: it was pushed no further than it may be",
    "nothing: it rings less than the threshold; `tripivot frf` at service",
];
