#![no_main]
//! `hairspring_io::obj::parse` and `parse_groom` on any bytes.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = hairspring_io::obj::parse(data);
    let _ = hairspring_io::obj::parse_groom(data);
});
