#![no_main]
//! `hairspring_io::scene::check_text` on any text.
libfuzzer_sys::fuzz_target!(|text: &str| {
    let _ = hairspring_io::scene::check_text(text);
});
