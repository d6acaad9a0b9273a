//! A rising voltage on one bridge after the other, both ways, until a ring moves: which one, which way, and what it takes.

use super::wiring_picture::picture;
use crate::commission::bench::{BY_WAY, Bench, Ended};
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;

/// Largest voltage of an excitation while nothing is known, V.
pub(super) const USUAL_EXCITATION_V: f64 = 2.0;
/// Where the voltage ends, V: break-away of a weak machine and the dead time; and in which time, s.
pub(super) const MOST_V: f64 = 1.6;
const SECONDS: f64 = 0.3;
/// Way that is a motion, rad, and how many times as far the one moves as the others.
pub(super) const WAY_RAD: f64 = 1e-3;
const LEAST_RATIO: f64 = 3.0;
/// How unlike the three may be.
const MOST_UNLIKE: f64 = 2.5;
/// Until a ring has come to rest, s.
const REST_S: f64 = 0.1;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    bench.set(&[(id::EXCITATION_V, USUAL_EXCITATION_V)])?;
    for (pivot, reversed) in (0..).zip(known.reversed_at_port) {
        bench.set(&[(id::ENCODER_REVERSED + pivot, f64::from(u8::from(reversed)))])?;
    }
    bench.delay(0.05)?;
    let mut volts = [0.0; AXES];
    for (bridge, volts) in volts.iter_mut().enumerate() {
        let there = nudge(bench, bridge, MOST_V)?;
        let back = nudge(bench, bridge, -MOST_V)?;
        if there.port != back.port || there.way_rad * back.way_rad > 0.0 {
            return fail(
                format!(
                    "bridge {} moves port {}'s ring {:+.2} mrad one way and port {}'s {:+.2} mrad the other",
                    bridge + 1,
                    there.port + 1,
                    there.way_rad * 1e3,
                    back.port + 1,
                    back.way_rad * 1e3
                ),
                "a motor that turns one way only: one half of its bridge, or its direction wire",
            );
        }
        known.port_of_bridge[bridge] = there.port;
        known.reversed_at_bridge[bridge] = there.way_rad < 0.0;
        *volts = f64::max(there.volts, back.volts);
        found.number(format!("bridge {} breaks away", bridge + 1), *volts, "V");
        found.push(Finding::new(
            format!("bridge {}", bridge + 1),
            format!(
                "moves the ring of port {}, {}, at {:.2} V and {:.2} V",
                there.port + 1,
                if there.way_rad > 0.0 {
                    "left for a positive voltage"
                } else {
                    "right for a positive voltage"
                },
                there.volts,
                -back.volts
            ),
            format!("one ring, both ways, within {MOST_V} V"),
            true,
            "",
        ));
    }
    let mut ports = known.port_of_bridge;
    ports.sort_unstable();
    found.push(Finding::new(
        "each bridge its own ring",
        format!("ports {:?}", known.port_of_bridge.map(|port| port + 1)),
        "each once",
        ports == [0, 1, 2],
        "two motors' leads are in one connector, or an encoder shows another ring",
    ));
    let unlike = volts.iter().fold(0.0, |a, b| f64::max(a, *b))
        / volts.iter().fold(f64::INFINITY, |a, b| f64::min(a, *b));
    found.push(Finding::new(
        "largest over smallest voltage to break away",
        format!("{unlike:.2}"),
        format!("under {MOST_UNLIKE}"),
        unlike < MOST_UNLIKE,
        "the one that takes most rubs: its bearing, its carriage or its guide",
    ));
    if ports == [0, 1, 2] {
        set_order(bench, known)?;
        let [ports, bridges] = [known.ports, known.bridges].map(|all| all.map(|at| at + 1));
        found.push(Finding::told(
            "pivots 1, 2, 3, to the left of each other",
            format!("ports {ports:?}, bridges {bridges:?}"),
        ));
        found.plots.push(picture(known));
    }
    Ok(())
}

struct Nudge {
    port: usize,
    way_rad: f64,
    volts: f64,
}

/// A rising voltage on one bridge, until something has moved or it is at its end.
pub(super) fn ramp(
    bench: &mut Bench<'_>,
    bridge: usize,
    volts: f64,
) -> Result<Ended, CommissionError> {
    let line = format!(
        "EXC RAMP {} {volts} {} {}",
        bridge + 1,
        SECONDS * 1e3,
        WAY_RAD * 1e3
    );
    bench.excite(&line, SECONDS)
}

fn nudge(bench: &mut Bench<'_>, bridge: usize, volts: f64) -> Result<Nudge, CommissionError> {
    let before = bench.pivots_rad()?;
    let ended = ramp(bench, bridge, volts)?;
    bench.delay(REST_S)?;
    let after = bench.pivots_rad()?;
    let ways = [0, 1, 2].map(|i| after[i] - before[i]);
    if ended.by != BY_WAY {
        return fail(
            format!("bridge {} moves nothing with {volts} V", bridge + 1),
            "its motor is not plugged in, a lead is broken, or its ring, carriage or guide is jammed: turn it by hand",
        );
    }
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| f64::total_cmp(&ways[*b].abs(), &ways[*a].abs()));
    let (most, next) = (ways[order[0]], ways[order[1]]);
    if most.abs() < LEAST_RATIO * next.abs() {
        return fail(
            format!(
                "bridge {} moves port {}'s ring by {:.2} mrad and port {}'s by {:.2} mrad",
                bridge + 1,
                order[0] + 1,
                most * 1e3,
                order[1] + 1,
                next * 1e3
            ),
            "one motor moves one ring: something is coupled that should not be, or the others are not braked",
        );
    }
    Ok(Nudge {
        port: order[0],
        way_rad: most,
        volts: volts.abs() * ended.seconds / SECONDS,
    })
}

/// Pivot 1 is bridge 1's; the others follow it to the left.
fn set_order(bench: &mut Bench<'_>, known: &mut Known) -> Result<(), CommissionError> {
    let first = known.port_of_bridge[0];
    let step = if known.ports_follow_left { 1 } else { 2 };
    known.ports = [0, 1, 2].map(|pivot| (first + pivot * step) % AXES);
    known.bridges = known.ports.map(|port| {
        known
            .port_of_bridge
            .iter()
            .position(|at| *at == port)
            .unwrap_or_default()
    });
    bench.set(&[
        (id::ENCODER_ORDER, Known::digits(&known.ports)),
        (id::BRIDGE_ORDER, Known::digits(&known.bridges)),
    ])?;
    for pivot in 0..AXES {
        let [encoder, motor] = [
            known.reversed_at_port[known.ports[pivot]],
            known.reversed_at_bridge[known.bridges[pivot]],
        ]
        .map(|reversed| f64::from(u8::from(reversed)));
        bench.set(&[
            (id::ENCODER_REVERSED + pivot as u32, encoder),
            (id::MOTOR_REVERSED + pivot as u32, motor),
        ])?;
    }
    Ok(bench.delay(0.05)?)
}
