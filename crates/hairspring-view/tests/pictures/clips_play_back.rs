//! Promise: a clip opens in every player and shows the rendered frames.
//!
//! A demuxer and a decoder that share no code with the muxer read the file back. Frame count, rate,
//! duration and size must equal those requested. The index must precede the data, because a browser starts
//! to play before it has the whole file. Every second must begin with a key frame, for seeking. Decoded
//! frames must look like the pushed ones.

use hairspring_view::{ClipWriter, Image, OutputError};
use openh264::{decoder::Decoder, formats::YUVSource};
use std::io::Cursor;

const FPS: f64 = 24.0;
const FRAMES: u32 = 50;

/// A smooth colored pattern that moves.
fn picture(width: u32, height: u32, frame: u32) -> Image {
    let mut image = Image::new(width, height);
    for (i, p) in image.rgb.chunks_mut(3).enumerate() {
        let (x, y) = (i as f32 % width as f32, (i as u32 / width) as f32);
        let wave = |k: f32, s: f32| (127.0 + 90.0 * ((x * k + y * s + frame as f32 * 0.2).sin())) as u8;
        p.copy_from_slice(&[wave(0.05, 0.02), wave(0.03, -0.04), wave(-0.02, 0.06)]);
    }
    image
}

fn psnr(a: &[u8], b: &[u8]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| (*a as f64 - *b as f64).powi(2)).sum();
    10.0 * (255.0f64.powi(2) / (sum / a.len() as f64)).log10()
}

/// A sample in Annex B format, preceded by the parameter sets.
fn annex_b(sample: &[u8], track: &mp4::Mp4Track, first: bool) -> Vec<u8> {
    let mut out = Vec::new();
    let mut unit = |bytes: &[u8]| {
        out.extend_from_slice(&[0, 0, 0, 1]);
        out.extend_from_slice(bytes);
    };
    if first {
        unit(track.sequence_parameter_set().unwrap());
        unit(track.picture_parameter_set().unwrap());
    }
    let mut rest = sample;
    while rest.len() > 4 {
        let n = u32::from_be_bytes(rest[..4].try_into().unwrap()) as usize;
        unit(&rest[4..4 + n]);
        rest = &rest[4 + n..];
    }
    out
}

#[test]
fn clip_has_the_requested_frames_size_and_rate() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("clip.mp4");
    // An odd size. Video needs even sizes, so one column and one row are added.
    let (w, h) = (239, 161);
    let mut clip = ClipWriter::create(&path, w, h, FPS).unwrap();
    for f in 0..FRAMES {
        clip.push(&picture(w, h, f)).unwrap();
    }
    clip.finish().unwrap();

    let bytes = std::fs::read(&path).unwrap();
    let at = |name: &[u8]| bytes.windows(4).position(|w| w == name).unwrap();
    assert!(at(b"moov") < at(b"mdat"), "the index must come first");
    let size = bytes.len() as u64;
    let mut reader = mp4::Mp4Reader::read_header(Cursor::new(bytes), size).unwrap();
    let id = *reader.tracks().keys().next().unwrap();
    let track = &reader.tracks()[&id];
    assert_eq!((track.width(), track.height()), (240, 162));
    assert_eq!(track.sample_count(), FRAMES);
    assert!((track.frame_rate() - FPS).abs() < 0.01, "{} frames a second", track.frame_rate());
    let seconds = track.duration().as_secs_f64();
    assert!((seconds - FRAMES as f64 / FPS).abs() < 2e-3, "the clip lasts {seconds} s");

    let mut decoder = Decoder::new().unwrap();
    let mut shown = 0;
    for f in 0..FRAMES {
        let sample = reader.read_sample(id, f + 1).unwrap().unwrap();
        if f % FPS as u32 == 0 {
            assert!(sample.is_sync, "frame {f} is not a key frame");
        }
        let bytes = annex_b(&sample.bytes, &reader.tracks()[&id], f == 0);
        if let Some(yuv) = decoder.decode(&bytes).unwrap() {
            // Compares luma only: BT.709 luma of the picture, for the columns of the picture.
            let want = picture(w, h, f);
            let (mut got, mut luma) = (Vec::new(), Vec::new());
            for (i, p) in want.rgb.chunks(3).enumerate() {
                let (x, y) = (i % w as usize, i / w as usize);
                let gray = 0.2126 * p[0] as f64 + 0.7152 * p[1] as f64 + 0.0722 * p[2] as f64;
                luma.push((16.0 + gray * 219.0 / 255.0).round() as u8);
                got.push(yuv.y()[y * yuv.strides().0 + x]);
            }
            assert!(psnr(&luma, &got) > 34.0, "frame {f}: {:.1} dB", psnr(&luma, &got));
            shown += 1;
        }
    }
    assert_eq!(shown, FRAMES);
}

#[test]
fn an_interrupted_clip_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("clip.mp4");
    std::fs::write(&path, "an older clip").unwrap();
    let mut clip = ClipWriter::create(&path, 64, 64, FPS).unwrap();
    clip.push(&picture(64, 64, 0)).unwrap();
    drop(clip);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "an older clip");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn invalid_requests_have_clear_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("clip.mp4");
    let message = |r: Result<ClipWriter, OutputError>| r.err().expect("an error").to_string();
    assert!(message(ClipWriter::create(&path, 8000, 64, FPS)).contains("8000×64"));
    assert!(
        message(ClipWriter::create(&path, 64, 64, f64::NAN)).contains("the rate is NaN frames per second")
    );
    assert!(
        message(ClipWriter::create(&folder.path().join("no/clip.mp4"), 64, 64, FPS))
            .contains("folder exists")
    );
    let mut clip = ClipWriter::create(&path, 64, 64, FPS).unwrap();
    assert!(clip.push(&picture(32, 64, 0)).unwrap_err().to_string().contains("32×64"));
    assert!(clip.finish().unwrap_err().to_string().contains("no frame"));
    assert!(!path.exists());
}
