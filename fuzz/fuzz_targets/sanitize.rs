#![no_main]
//! A groom read from any bytes is valid after `sanitize`, and a second call finds nothing to repair.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    if let Ok(mut groom) = hairspring_io::usc::parse(data) {
        hairspring::groom::sanitize(&mut groom);
        assert!(groom.points.iter().all(|p| p.is_finite()));
        assert_eq!(hairspring::groom::sanitize(&mut groom).total(), 0);
    }
});
