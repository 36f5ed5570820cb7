//! Promise: strands without points, without a finite point, or far from all others are reported as what they are, and a
//! groom that has nothing else is refused.

use glam::Vec3;
use hairspring::groom::Groom;
use hairspring_io::{ErrorKind, Loaded, ReadOptions, Result, read_groom};
use std::fs;

/// Reads strands from a `.data` file in meters.
fn read(strands: &[Vec<Vec3>]) -> Result<Loaded<Groom>> {
    let mut bytes = (strands.len() as i32).to_le_bytes().to_vec();
    for strand in strands {
        bytes.extend((strand.len() as i32).to_le_bytes());
        bytes.extend(strand.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.data");
    fs::write(&path, bytes).unwrap();
    read_groom(&path, &ReadOptions { scale: Some(1.0), up: None })
}

/// Strands of 20 cm.
fn strands(count: usize) -> Vec<Vec<Vec3>> {
    let at = |s: usize, k: usize| Vec3::new(0.01 * s as f32, 1.6 + 0.02 * k as f32, 0.0);
    (0..count).map(|s| (0..11).map(|k| at(s, k)).collect()).collect()
}

#[test]
fn a_groom_without_a_finite_point_is_refused() {
    for strand in [vec![Vec3::NAN; 8], vec![Vec3::INFINITY; 3], vec![]] {
        let error = read(&[strand.clone(), strand]).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Malformed);
        assert!(error.to_string().contains("no strand has a finite point; export"), "{error}");
    }
}

#[test]
fn a_strand_without_points_is_not_one_without_finite_points() {
    let mut all = strands(6);
    all[2].clear();
    all[4].fill(Vec3::NAN);
    all[5].fill(Vec3::NAN);
    let loaded = read(&all).unwrap();
    assert_eq!(loaded.repairs.empty_strands, 3);
    assert_eq!(loaded.notes.len(), 2, "{:?}", loaded.notes);
    assert!(
        loaded.notes[0].starts_with("1 strands have no points; each is now a stub"),
        "{:?}",
        loaded.notes
    );
    assert!(loaded.notes[1].starts_with("2 strands have no finite point; each"), "{:?}", loaded.notes);
}

#[test]
fn a_few_strands_far_from_all_others_do_not_reject_the_groom() {
    for (count, far) in [(121, vec![120]), (40, vec![0, 7, 9])] {
        for distance in [1e4, 1e6, 1e20] {
            let mut all = strands(count);
            far.iter().for_each(|s: &usize| all[*s].iter_mut().for_each(|p| p.x += distance));
            let loaded = read(&all).unwrap();
            let part = format!(
                "{} strands, the first of them strand {}, are far from all others",
                far.len(),
                far[0]
            );
            assert_eq!(loaded.notes.len(), 1, "{:?}", loaded.notes);
            assert!(loaded.notes[0].starts_with(&part) && loaded.notes[0].ends_with("remove them"), "{part}");
            let (lo, hi) = loaded.value.bounds().unwrap();
            assert!((hi - lo).max_element() < 2.0, "{lo} {hi}");
        }
    }
    // A groom that is far as a whole has another remedy, and so have two grooms of one file.
    let moved = |share: usize| {
        let mut all = strands(40);
        all.iter_mut().take(share).flatten().for_each(|p| p.x += 1e5);
        read(&all).unwrap_err().to_string()
    };
    for share in [40, 20] {
        assert!(moved(share).contains("move the scene nearer to the origin"), "{}", moved(share));
    }
}
