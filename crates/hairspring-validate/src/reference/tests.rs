//! Tests of the references against the tables of the literature, to their printed digits.

use super::{
    beam, bisect,
    catenary::catenary,
    chain,
    column::column,
    cylinder, elastica,
    elastica::cantilever,
    elliptic::complete,
    helix::{compliance_along, end_compliance},
    integrate, pendulum, ring, stability,
};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Asserts that `value` rounds to `printed`, a number in decimal notation.
#[track_caller]
fn prints(value: f64, printed: &str) {
    let digits = printed.split_once('.').map_or(0, |(_, d)| d.len()) as i32;
    let printed: f64 = printed.parse().unwrap();
    // Half a unit of the last digit with a small margin, because a table may have been rounded twice.
    assert!((value - printed).abs() <= 0.51 * 10f64.powi(-digits), "{value} instead of {printed}");
}

#[test]
fn heavy_cantilever() {
    for (gamma, drop, reach, ratio) in [
        (1.0, ".12347", ".99125", ".12456"),
        (10.0, ".70020", ".65635", "1.0668"),
        (100.0, ".93752", ".15922", "5.8881"),
    ] {
        let found = cantilever(gamma, 0.0);
        prints(found.drop, drop);
        prints(found.reach, reach);
        prints(found.drop / found.reach, ratio);
    }
    // Both limits.
    let slope = |gamma: f64| {
        let found = cantilever(gamma, 0.0);
        found.drop / found.reach
    };
    assert!((slope(1e-3) / (1e-3 / 8.0) - 1.0).abs() < 1e-5);
    assert!((slope(1e5) / (1e5f64 / 2.0).sqrt() - 1.0).abs() < 0.01);
}

#[test]
fn dead_load_at_the_tip() {
    for (alpha, angle, down, inward) in [
        (1.0, ".46135", ".30172", ".05643"),
        (5.0, "1.21537", ".71379", ".38763"),
        (10.0, "1.43029", ".81061", ".55500"),
    ] {
        let found = cantilever(0.0, alpha);
        prints(found.tip_angle, angle);
        prints(found.drop, down);
        prints(1.0 - found.reach, inward);
    }
}

/// Compares two independent solvers: shooting from the tip, and Newton steps on segments.
#[test]
fn the_plane_shape_is_the_elastica() {
    let strand =
        stability::Strand { clamp: FRAC_PI_2, in_plane: 1.0, out_of_plane: 1.0, twist: 1.0, curvature: 0.0 };
    for (weight, tip) in [(1.0, 0.0), (30.0, 0.0), (0.0, 5.0), (7.0, 3.0)] {
        let want = cantilever(weight, tip).tip_angle;
        let tip_angle =
            |n| FRAC_PI_2 - stability::plane_shape(&strand, stability::Load { weight, tip }, n)[n];
        let (first, second): (f64, f64) = (tip_angle(500), tip_angle(1000));
        let limit = second + (second - first) / 3.0;
        assert!((limit - want).abs() < 1e-6, "{limit} instead of {want}");
    }
}

#[test]
fn a_curl_under_its_own_weight() {
    // The table prints .667 for an isotropic fiber's 2/3 (ν = ½); .667 itself gives 119.8.
    let isotropic = 2.0 / 3.0;
    let gamma = |ratio, curl| stability::curl_threshold(curl, ratio).unwrap();
    prints(gamma(isotropic, 8.0), "119.9");
    prints(gamma(0.458, 8.0), "208.8");
    // The table's .2392 and .4088 are 0.04 % above the values of both solutions here, for every tight curl.
    for (ratio, table, found) in [(isotropic, 0.2392, 0.239123), (0.458, 0.4088, 0.408619)] {
        for curl in [15.0, 24.0] {
            let scaled = gamma(ratio, curl) / f64::powi(curl, 3);
            assert!((scaled - found).abs() < 2e-6 && (scaled / table - 1.0).abs() < 5e-4, "{scaled}");
        }
        assert!(leaves_plane(found * 0.9999 * 15f64.powi(3), 15.0, ratio));
        assert!(!leaves_plane(found * 1.0001 * 15f64.powi(3), 15.0, ratio));
    }
}

/// Jacobi's condition by shooting, independent of the reference. Two solutions leave the free tip without
/// moment, (w₁, w₃) = (1, 0) and (0, 1). They are parallel at the clamp where the planar shape loses its
/// stability.
fn leaves_plane(gamma: f64, curl: f64, ratio: f64) -> bool {
    let field = |u: f64, y: &[f64; 10]| {
        let (sin, cos) = y[0].sin_cos();
        let (k, f) = (-y[1], gamma * u);
        let m = k - curl;
        let mut out = [0.0; 10];
        (out[0], out[1]) = (y[1], f * sin);
        for at in [2, 6] {
            let [w1, w3, p1, p3] = [y[at], y[at + 1], y[at + 2], y[at + 3]];
            let (d1, d3) = (p1 + 0.5 * m * w3, (p3 - 0.5 * m * w1) / ratio);
            out[at] = k * w3 - d1;
            out[at + 1] = -k * w1 - d3;
            out[at + 2] = ratio * k * d3 - 0.5 * m * (d3 - k * w1) - f * (cos * w1 + 0.5 * sin * w3);
            out[at + 3] = 0.5 * m * (d1 + k * w3) - k * d1 - 0.5 * f * sin * w1;
        }
        out
    };
    let shoot = |tip: f64| {
        integrate([tip, -curl, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0], 20_000, field, |y| y[0].abs() > 7.0)
    };
    // With too small a tip angle, the solution falls past the vertical; with too large a one, it does not
    // reach it.
    let tip = bisect(0.5, 3.0, |tip| shoot(tip)[0]);
    let y = shoot(tip);
    y[2] * y[7] - y[3] * y[6] < 0.0
}

#[test]
fn standing_and_lying_strands() {
    prints(stability::greenhill(), "7.8373");
    // A thin blade, whose in-plane bending is negligible.
    let blade = |weight, tip| {
        let strand = stability::Strand { in_plane: 1e6, ..stability::flat(1.0, 1e6, 0.5) };
        stability::lateral(&strand, weight, tip).unwrap() / 0.5f64.sqrt()
    };
    prints(blade(1.0, 0.0), "12.854");
    prints(blade(0.0, 1.0), "4.0126");
}

/// The response of an upright strand to a sideways load has its pole where the second variation has its zero.
#[test]
fn the_standing_strand_buckles_at_greenhills_value() {
    let critical = stability::greenhill();
    let (below, above) =
        (elastica::standing_deflection(critical * 0.999), elastica::standing_deflection(critical * 1.001));
    assert!(below > 100.0 && above < -100.0, "{below}, {above}");
}

#[test]
fn a_twisted_ring() {
    for ratio in [0.458, 1.0, 1.5] {
        let want = TAU * 3f64.sqrt() / ratio;
        assert!((ring::writhing_twist(ratio) - want).abs() < 1e-12 * want);
    }
}

#[test]
fn swings_and_vibrations() {
    for (lambda, printed) in chain::modes(3).into_iter().zip(["1.2024", "2.7600", "4.3269"]) {
        prints(lambda.sqrt(), printed);
    }
    for (beta, printed) in beam::modes(3).into_iter().zip(["1.87510", "4.69409", "7.85476"]) {
        prints(beta, printed);
        // The shape has neither moment nor shear at the free end.
        let (h, at) = (1e-3, |s| beam::shape(beta, s));
        let curvature = (at(1.0) - 2.0 * at(1.0 - h) + at(1.0 - 2.0 * h)) / (h * h);
        assert!(at(0.0).abs() < 1e-12 && curvature.abs() < 1e-2 * beta * beta, "{curvature}");
    }
    prints(pendulum::period_ratio(PI / 6.0), "1.01741");
    prints(pendulum::period_ratio(FRAC_PI_2), "1.18034");
}

#[test]
fn hanging_between_two_supports() {
    for (length, sag, tension) in [(1.25, ".33180", ".60364"), (2.0, ".79639", ".51301")] {
        let found = catenary(length);
        prints(found.sag, sag);
        prints(found.end_tension, tension);
    }
}

#[test]
fn air_across_a_hair() {
    // F/L = ½ρU²d Cd of a hair of 70 µm.
    for (speed, coefficient, force) in [(0.1, "19.6", "8.3"), (1.0, "4.6", "194"), (5.0, "2.2", "2350")] {
        let cd = cylinder::drag_coefficient(speed * 70e-6 / 1.516e-5);
        // The table's drag uses Cd with three digits: one unit of the last printed digit.
        let got = 0.5 * 1.204 * speed * speed * 70e-6 * cd * 1e6;
        let (want_cd, want): (f64, f64) = (coefficient.parse().unwrap(), force.parse().unwrap());
        assert!((cd - want_cd).abs() < 0.1, "Cd {cd} instead of {want_cd}");
        assert!((got / want - 1.0).abs() < 0.02, "{got} instead of {want} µN/m");
    }
    let angle = |speed: f64| cylinder::wind_angle(speed, 70e-6, 1310.0, 9.81).to_degrees();
    assert!((angle(1.0) - 68.0).abs() < 0.5, "{}", angle(1.0));
    // Continuous and decreasing through the blend.
    let cd = |k: i32| cylinder::drag_coefficient(10f64.powf(f64::from(k) / 100.0));
    assert!((-300..300).all(|k| cd(k + 1) < cd(k) && cd(k + 1) > 0.97 * cd(k)));
}

/// Abramowitz & Stegun 1964, tables 17.1 and 17.2, by m = k².
#[test]
fn complete_elliptic_integrals() {
    for (m, first, second) in [
        (0.0, "1.570796", "1.570796"),
        (0.1, "1.612441", "1.530758"),
        (0.5, "1.854075", "1.350644"),
        (0.9, "2.578092", "1.104775"),
    ] {
        let found = complete(f64::sqrt(m));
        prints(found.0, first);
        prints(found.1, second);
    }
}

/// Timoshenko & Gere 1961, table 2-4, which is accurate to one unit of its last digit: P over Euler's load,
/// H/L and x/L, for the inclination of the free end.
#[test]
fn pressed_column() {
    for (degrees, load, height, aside) in [
        (20.0f64, 1.015, 0.970, 0.220),
        (40.0, 1.063, 0.881, 0.422),
        (60.0, 1.152, 0.741, 0.593),
        (80.0, 1.293, 0.560, 0.719),
    ] {
        let (first, second) = complete((0.5 * degrees.to_radians()).sin());
        let at = 2.0 * second / first - 1.0;
        let found = column(at);
        let euler = FRAC_PI_2 * FRAC_PI_2;
        for (value, printed) in [(at, height), (found.load / euler, load), (found.aside, aside)] {
            assert!((value - printed).abs() < 1.05e-3, "{value} instead of {printed} at {degrees}°");
        }
    }
}

/// Limits of many turns and of no turns, and quadrature.
#[test]
fn helical_spring() {
    let ratio = 0.458;
    for (turns, pitch) in [(0.7, 0.1), (2.3, 0.3), (4.0, 0.25)] {
        let along = compliance_along(glam::DVec3::Z, turns, pitch, ratio);
        assert!((along / end_compliance(turns, pitch, ratio) - 1.0).abs() < 1e-8);
    }
    assert!((end_compliance(1000.0, 0.0, ratio) - (1.5 / ratio + 0.5)).abs() < 1e-3);
    // A short arc is a cantilever, L³/3EI. A flat half ring opens by 3π/2 R³/EI where its end is pulled along
    // the diameter.
    let arc = 1e-2;
    assert!((end_compliance(arc / TAU, 0.0, ratio) / (arc * arc / 3.0) - 1.0).abs() < 1e-3);
    let opens = compliance_along(glam::DVec3::X, 0.5, 0.0, ratio) * PI;
    assert!((opens / FRAC_PI_2 - 1.0).abs() < 1e-8, "{opens}");
    let opens = compliance_along(glam::DVec3::Y, 0.5, 0.0, ratio) * PI;
    assert!((opens / (1.5 * PI) - 1.0).abs() < 1e-8, "{opens}");
}
