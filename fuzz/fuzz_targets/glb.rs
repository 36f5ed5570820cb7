#![no_main]
//! `hairspring_io::gltf::parse` and `parse_groom` on any bytes. The input also serves as the content of files next to it.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = hairspring_io::gltf::parse(data, &|_| Some(data.to_vec()));
    let _ = hairspring_io::gltf::parse_groom(data, &|_| Some(data.to_vec()));
});
