//! One case in figures that can be read: `SET=c CASE=8231` in the environment.

use crate::case::Case;
use crate::motion_bench::{AXIS_UNIT, UNIT};
use firmware::motion::AxisState;

pub fn print(case: &Case) {
    let hz = case.constraints.limits.rate_hz;
    let mm = case.constraints.geometry.radius_mm;
    let each = |[x, y, turns]: [f64; 3], unit: &str| {
        let [x, y, theta] = [x * mm, y * mm, turns * 360.0];
        format!("x {x:.3}, y {y:.3} mm{unit}, theta {theta:.3} deg{unit}")
    };
    let state = case.state();
    let axes = |value: fn(&AxisState) -> f64| state.each_ref().map(value);
    println!("left at tick {} of {}", case.at, case.of.plan.ticks());
    let position = axes(|axis| axis.position as f64 / AXIS_UNIT);
    println!("  at   {}", each(position, ""));
    let velocity = axes(|axis| axis.velocity as f64 / AXIS_UNIT);
    println!("  with {}", each(velocity.map(|v| v * hz), "/s"));
    let acceleration = axes(|axis| axis.acceleration as f64 / AXIS_UNIT);
    println!("  and  {}", each(acceleration.map(|a| a * hz * hz), "/s^2"));
    println!("for    {}", each(case.to.map(|to| to as f64 / UNIT), ""));
    println!("about  {:?} track radii", case.constraints.rotation_centre);
    match case.reference_ticks() {
        Some(ticks) => println!("rsruckig: {ticks:.0} ticks"),
        None => println!("rsruckig finds nothing"),
    }
    match case.retargeted() {
        Err(no) => println!("ours: refused, {no:?}"),
        Ok(way) => {
            println!("ours: {} ticks", way.ticks(case.at));
            for step in &way.steps {
                let (left, ticks) = (step.left, step.motion.plan.ticks());
                println!(
                    "  at tick {left} of what is under way: {:?}, {ticks} ticks",
                    step.kind
                );
            }
        }
    }
}
