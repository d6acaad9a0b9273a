//! Rotation without end.

use tests::Bench;

/// Forty turns and back, or as many as `TURNS` says (120 at most): nothing that counts turns may lose one, or a fraction of one.
#[test]
fn turns_come_back_to_the_same_counts() {
    const TURN: i64 = 1 << 32;
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("MOV X 7 Y -5 W 33"), "0");
    bench.settle();
    let pivots = |bench: &Bench| bench.sample().pivot_setpoints.map(|angle| angle.units());
    let start = pivots(&bench);
    let most = std::env::var("TURNS").map_or(40, |turns| turns.parse().unwrap());
    for (target, turns) in [(33 + 360 * most, most), (33, 0)] {
        assert_eq!(bench.error_after(&format!("MOV W {target}")), "0");
        bench.forget_errors();
        bench.run_until("its turns", |bench| {
            bench.sample().setpoint.position[2] == target * TURN / 360
        });
        bench.settle();
        assert_eq!(
            pivots(&bench),
            start.map(|units| units + turns * TURN),
            "{turns} turns"
        );
        // The machine has been there.
        let truth = bench.rig.front.stage.plant.pose()[2].to_degrees();
        assert!((truth - target as f64).abs() < 7.6e-6, "{truth} deg");
        let told = bench.value("POS? W") - target as f64;
        assert!(told.abs() < 7.6e-6, "{told}");
    }
}
