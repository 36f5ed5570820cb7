#![no_main]
//! `hairspring_io::pc2::parse` on any bytes.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = hairspring_io::pc2::parse(data);
});
