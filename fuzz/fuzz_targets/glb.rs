#![no_main]
//! `hairspring_io::gltf::parse` on any bytes; files beside it are the input itself.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = hairspring_io::gltf::parse(data, &|_| Some(data.to_vec()));
});
