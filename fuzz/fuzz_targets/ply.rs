#![no_main]
//! `hairspring_io::ply::parse` on any bytes.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = hairspring_io::ply::parse(data);
});
