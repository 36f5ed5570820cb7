//! Promise: strands in contact that overlap by more than half of their contact radius are reported with the remedy, and the
//! remedy helps.

use crate::common::{json, succeed};
use std::fmt::Write;

#[test]
fn a_bundle_that_folds_over_at_its_roots_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let mut table = String::from("strand,x,y,z\n");
    for strand in 0..60u32 {
        let (sin, cos) = (2.4 * strand as f32).sin_cos();
        let r = 0.01 * ((strand as f32 + 0.5) / 60.0).sqrt();
        for point in 0..16 {
            let (x, y, z) = (r * cos + 0.003 * point as f32, 0.012 * point as f32, r * sin);
            writeln!(table, "{strand},{x},{y},{z}").unwrap();
        }
    }
    std::fs::write(folder.path().join("bundle.csv"), table).unwrap();
    let bake = |radius: &str, options: &[&str]| {
        let scene = format!(
            "[[groom]]\nfile = \"bundle.csv\"\nscale = 1.0\nguides = \"all\"\n[solver]\nsag_free = false\n\
             [neighbours]\non = true\n{radius}"
        );
        std::fs::write(folder.path().join("bundle.toml"), scene).unwrap();
        let bake = ["bake", "bundle.toml", "-o", "f.####.hair", "--frames", "120"];
        succeed(folder.path(), &[&bake[..], options].concat())
    };
    let pressed = bake("", &[]);
    assert!(pressed.contains("a smaller neighbours.radius lets them rest"), "{pressed}");
    let thin = bake("radius = 0.0001\n", &[]);
    assert!(!thin.contains("pressed"), "{thin}");
    let overlap = |radius| json(&bake(radius, &["--json"]))["overlap_m"].as_f64().unwrap();
    assert!(overlap("") > 0.0005 && overlap("radius = 0.0001\n") < 0.0001);
}
