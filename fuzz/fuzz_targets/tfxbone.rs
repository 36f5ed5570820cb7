#![no_main]
//! `hairspring_io::tfxbone::parse` on any bytes.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = hairspring_io::tfxbone::parse(data);
});
