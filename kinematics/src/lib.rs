#![no_std]
#![forbid(unsafe_code)]
//! Kinematics of a planar XY-Theta stage: three pivots run independently on one circular track and carry a platform
//! through three linear guides set in a symmetric "Y". All three together turn the platform without end.
//!
//! No heap, no `std`, no I/O, no panics: bad input is an error that says what is bad. Generic over the number type: the
//! position equations ([`inverse()`], [`direct()`]) need a [`Scalar`], which may be fixed-point, those of a built machine a
//! [`CorrectedScalar`]; everything else a [`Real`].
//!
//! | file | what is in it |
//! |---|---|
//! | [`mod@inverse`] | pose to pivots and guides |
//! | [`mod@direct`] | pivots to pose, with rates |
//! | [`rates`] | twist and acceleration to those of the pivots |
//! | [`mod@jacobian`] | the Jacobian, its inverse, dexterity |
//! | [`mod@feasibility`] | whether a pose keeps to the mechanism's limits, and by how much |
//! | [`geometry`] | sizes of the mechanism, and what follows from them |
//! | [`coefficients`], [`corrections`] | what a built machine is off the drawing, and what may be corrected |
//! | [`line`](mod@line), [`guide_error`] | the numbers of a pivot that have a closed form |
//! | [`curves`], [`series`] | encoder, runout and straightness of a pivot, and their exact series |
//! | [`mod@corrected_inverse`], [`mod@corrected_direct`], [`corrected_rates`] | the same of a built machine: pose to encoders, back, and rates |
//! | [`guide`], [`pose`] | a guide; pose, twist, acceleration |
//! | [`angle`] | multi-turn angles without rounding |
//! | [`scalar`], [`corrected_scalar`], `float` | what a number type must do; `f32` and `f64` |
//!
//! # Frames and symbols
//!
//! ```text
//!                   y
//!                   |
//!               . - o - .  pivot 2        o  pivot i at angle phi_i on the track, radius R = 1
//!           .       |       .             C  platform centre (x, y), where the three guides meet
//!         .      guide 2      .           O  centre of the track, origin of the base frame
//!        .          |          .
//!       .           C           . --- x   Drawn at x = y = theta = 0, C on O: phi_i = theta_i =
//!       .        /     \        .         -30, 90 and 210 deg, every rho_i = 1.
//!        .    /           \    .
//!         o  guide 3 guide 1  o
//!  pivot 3  .               .  pivot 1
//!               . - . - .
//! ```
//!
//! The base frame is fixed, with its origin in O; angles count counter-clockwise from its x axis. The platform frame has
//! its origin in C and its x' axis at theta; guide 2 is its y' axis. Guide i points outwards at
//! `theta_i = theta - 30 deg + 120 deg (i - 1)`. Lengths are in track radii; angles are multi-turn.
//!
//! | symbol | meaning |
//! |---|---|
//! | rho_i | distance from C to pivot i along guide i, positive: [`Guide::rho`] |
//! | d_i = y cos theta_i - x sin theta_i | offset of guide line i from O, equal to sin(phi_i - theta_i) |
//! | c_i = sqrt(1 - d_i^2) | cos(phi_i - theta_i) |
//! | q_i = x cos theta_i + y sin theta_i | projection of C on guide i; rho_i = c_i - q_i |
//! | epsilon, L, delta | a guide's start and length, the carriages' smallest separation: [`Geometry`] |
//!
//! # Equations
//!
//! - Inverse position: `phi_i = theta_i + asin(d_i)`. The other root, `180 deg + theta_i - asin(d_i)`, has rho_i < 0.
//! - Rate: `c_i phi_i' = -sin theta_i x' + cos theta_i y' + rho_i theta'`, in the paper's letters `Lambda phi' = Z X'`,
//!   so `J = Lambda^-1 Z`. The theta_i are 120 deg apart, so the directions sum to zero and J^-1 has a closed form.
//! - Acceleration: `phi_i'' = theta'' + (d_i'' + alpha_i'^2 d_i) / c_i` with `alpha_i' = d_i' / c_i`,
//!   `d_i' = y' cos theta_i - x' sin theta_i - theta' q_i` and
//!   `d_i'' = y'' cos theta_i - x'' sin theta_i - theta'' q_i - 2 theta' (x' cos theta_i + y' sin theta_i) - theta'^2 d_i`.
//! - Direct position: the paper intersects two Fermat lines (eq. 10) and takes theta from one of them (eq. 13). The
//!   same point without special cases is a discrete Fourier transform of the pivots. With `z_i = exp(j phi_i)` and
//!   `w = exp(j 120 deg)`: `S0 = z1 + z2 + z3`, `S1 = z1 + conj(w) z2 + w z3`, `S2 = z1 + w z2 + conj(w) z3`. Since
//!   `z_i = C + rho_i exp(j theta_i)`, `S1 = (rho_1 + rho_2 + rho_3) exp(j theta_1)`: with the direction `u = S1 / |S1|`,
//!   `theta = arg(u) + 30 deg` and `C = (S0 - u^2 conj(S2)) / 3`. The three rho_i are the inverse transform of |S1|,
//!   `u conj(S2)` and its conjugate. Singular only at S1 = 0; inside the track `|S1| >= sqrt(3)`.
//! - The turn of theta: phi_1 lies within 90 deg of theta_1, so theta is the solution nearest to `phi_1 + 30 deg`.
//! - A built machine: the same with each pivot's own ring and guide, [`corrected_inverse()`], and what its encoder reads there,
//!   `m_i = psi_i + z_i + E_i(psi_i)`. Back by Newton's method, [`corrected_direct()`].
//! - Dexterity (Fig. 5): `xi = 1 / (|J| |J^-1|)`, `|J| = sqrt(tr(J J^T) / 3)`.
//!
//! # Where the source paper is wrong or unclear
//!
//! The equations are those of the public study of this mechanism's kinematics, apart from these. Each was measured.
//!
//! | paper | what holds, and what this crate does |
//! |---|---|
//! | eq. 10, E printed as diag(-1, 1) | E is the quarter turn [[0, -1], [1, 0]]; with the printed one the direct solution of (0.3, -0.2, 0.7 rad) is (1.95, -2.01) |
//! | eq. 13, theta = atan2(y - y_O2, x - x_O2) - 90 deg | off by 180 deg: atan2(y_O2 - y, x_O2 - x) - 90 deg, O2 being pivot 2 |
//! | optimum guide length 1 - epsilon | 2 (1 - epsilon): for C at distance r the rho_i sweep [1 - r, 1 + r] over all orientations |
//! | dexterity at r = 0.8 "about 0.79" | depends on the direction: 0.7757 to 0.8956; 0.9487 = 3 / sqrt(10) at the centre holds |
//! | pivots taken as points | two close up to 120 deg - 2 asin(r sqrt(3) / 2): 57.4 deg at r = 0.6, 32.3 deg at 0.8, 9.3 deg at 0.95. Carriages have width: [`Geometry::usable_radius`] is min(1 - epsilon, epsilon + L - 1, sin(60 deg - delta / 2) / sin(60 deg)) |
//! | (not said) | worst pivot rate per platform speed is 1 / sqrt(1 - r^2), 1.67 at 0.8 and 3.2 at 0.95, per rotation 1 + r: pivot speed, not dexterity, sets the usable radius |
//!
//! # Valid ranges
//!
//! Positions hold anywhere strictly inside the track and at any number of turns; `f64` to 1e-14 at r <= 0.8 (pivots beyond 1
//! rad: relative to their size), `f32` to 3e-6 within a few turns. Errors grow as 1 / sqrt(1 - r^2) towards the track.
//! Floats in radians lose digits with every turn, `f32` soon: an [`Angle`] does not, and neither does a [`Scalar`] that has
//! it as its angle.

pub mod angle;
pub mod coefficients;
pub mod corrected_direct;
pub mod corrected_inverse;
pub mod corrected_rates;
pub mod corrected_scalar;
pub mod corrections;
pub mod curves;
pub mod direct;
pub mod feasibility;
mod float;
pub mod geometry;
pub mod guide;
pub mod guide_error;
pub mod inverse;
pub mod jacobian;
pub mod line;
pub mod pose;
pub mod rates;
pub mod scalar;
pub mod series;

pub use angle::Angle;
pub use coefficients::{COEFFICIENTS, PivotCoefficients};
pub use corrected_direct::{corrected_direct, missing_rad, newton_step, refine};
pub use corrected_inverse::{CorrectedInverse, corrected_inverse};
pub use corrected_rates::{corrected_direct_rates, corrected_pivot_motion};
pub use corrected_scalar::CorrectedScalar;
pub use corrections::{CoefficientError, Corrections, check_coefficients};
pub use curves::{CurvePoint, Curves, RingErrors, Tangents};
pub use direct::{DirectError, direct, direct_rates};
pub use feasibility::{Infeasible, Margins, feasibility, margins};
pub use geometry::{
    Geometry, GeometryError, closest_separation_rad, worst_rate_per_rotation, worst_rate_per_speed,
};
pub use guide::Guide;
pub use guide_error::GuideError;
pub use inverse::{Inverse, InverseError, guides_along_axes, inverse};
pub use jacobian::{dexterity, jacobian, jacobian_inverse};
pub use line::Line;
pub use pose::{Acceleration, Pose, Twist};
pub use rates::{
    PivotMotion, in_platform_axes, pivot_accelerations, pivot_motion,
    pivot_motion_in_platform_axes, pivot_rates,
};
pub use scalar::{Real, Scalar};
pub use series::Series;
