#![no_main]
//! `hairspring_io::gltf::parse` with its morph targets, and `parse_groom`, on any bytes. The input also serves as the content of files next to it.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    if let Ok((character, _)) = hairspring_io::gltf::parse(data, &|_| Some(data.to_vec())) {
        let short = (0..character.clips.len()).filter(|clip| character.clips[*clip].frame_count() < 100);
        short.for_each(|clip| drop(character.morphed(clip)));
    }
    let _ = hairspring_io::gltf::parse_groom(data, &|_| Some(data.to_vec()));
});
