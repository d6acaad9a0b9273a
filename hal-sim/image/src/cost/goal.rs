//! What a part may cost at most, in instructions of its worst call.

const GOALS: [(&str, u32); 12] = [
    ("motion: line from rest", 60_000),
    ("motion: new target in motion", 60_000),
    ("motion: jog from rest", 60_000),
    ("motion: jog in motion", 60_000),
    ("motion: streamed target", 25_000),
    ("tick: next setpoint", 300),
    ("inverse kinematics: position, rate, acceleration", 400),
    ("direct kinematics", 350),
    ("encoder decoding, three", 250),
    ("tick as a whole", 1_750),
    ("tick as a whole, centre of rotation", 1_750),
    ("tick as a whole, recording 8 signals", 1_750),
];

/// The goal of the part of this name.
pub fn goal(name: &str) -> Option<u32> {
    let found = GOALS.iter().find(|(part, _)| *part == name);
    found.map(|&(_, goal)| goal)
}
