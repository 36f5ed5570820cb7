//! A clip that browsers can play: H.264 in MP4, with the index at the front so that playback starts while it
//! loads.

use super::{OutputError, beside, keep, yuv::Planes};
use crate::image::Image;
use hairspring_file::PendingFile;
use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use openh264::{
    OpenH264API,
    encoder::{
        BitRate, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, QpRange, RateControlMode,
        VuiConfig,
    },
};
use std::{
    fs::File,
    io::BufWriter,
    path::{Path, PathBuf},
};

/// Range of H.264's quantizer (0 to 51). At the lower value, hair at 1280 × 720 looks like the still; at the
/// upper one, blocks become visible.
const QUANTISER: (u8, u8) = (16, 24);
/// Target bit rate within this range, in bits per pixel: 8 Mbit/s at 1280 × 720 and 30 frames/s.
const BITS_PER_PIXEL: f64 = 0.3;

/// Writes a clip frame by frame. The file appears under its name when [`ClipWriter::finish`] returns. A
/// writer that is dropped before that leaves nothing behind. Compressed frames are kept in memory until then.
pub struct ClipWriter {
    path: PathBuf,
    temporary: PendingFile,
    size: (u32, u32),
    fps: f64,
    encoder: Encoder,
    muxer: Muxer<BufWriter<File>>,
    planes: Planes,
    bits: Vec<u8>,
    frames: u64,
}

/// Size of a clip of pictures of this size [pixels]: H.264 needs even sides.
fn extended((width, height): (u32, u32)) -> (u32, u32) {
    (width.next_multiple_of(2), height.next_multiple_of(2))
}

impl ClipWriter {
    /// Starts a clip of `width` × `height` pixels at `fps` frames per second. The size is at most 3840 × 2160
    /// or 2160 × 3840; an odd size is extended by one column or row. `fps` is above 0 and at most 240.
    ///
    /// # Errors
    /// Returns an error if the size or the rate is out of range, or if the file cannot be created.
    pub fn create(path: &Path, width: u32, height: u32, fps: f64) -> Result<Self, OutputError> {
        let wrong = |why: String| OutputError::Clip { path: path.into(), why };
        let (long, short) = (width.max(height), width.min(height));
        if short < 16 || long > 3840 || short > 2160 {
            return Err(wrong(format!(
                "the size is {width}×{height} pixels; choose one from 16×16 to 3840×2160"
            )));
        }
        if !(fps > 0.0 && fps <= 240.0) {
            return Err(wrong(format!(
                "the rate is {fps} frames per second; choose one above 0 and up to 240"
            )));
        }
        let bits = (width as f64 * height as f64 * fps * BITS_PER_PIXEL).clamp(2e5, 1e8) as u32;
        let config = EncoderConfig::new()
            .max_frame_rate(FrameRate::from_hz(fps as f32))
            .rate_control_mode(RateControlMode::Bufferbased)
            .qp(QpRange::new(QUANTISER.0, QUANTISER.1))
            .bitrate(BitRate::from_bps(bits))
            // No frame is dropped, and players can seek to any second.
            .skip_frames(false)
            .intra_frame_period(IntraFramePeriod::from_num_frames((fps.round() as u32).max(1)))
            .background_detection(false)
            .vui(VuiConfig::bt709());
        let encoder =
            Encoder::with_api_config(OpenH264API::from_source(), config).map_err(|e| wrong(e.to_string()))?;
        let temporary = beside(path)?;
        let file = temporary.reopen().map_err(|source| OutputError::File { path: path.into(), source })?;
        let (even_width, even_height) = extended((width, height));
        let muxer = MuxerBuilder::new(BufWriter::new(file))
            .video(VideoCodec::H264, even_width, even_height, fps)
            .with_fast_start(true)
            .build()
            .map_err(|e| wrong(e.to_string()))?;
        Ok(Self {
            path: path.into(),
            temporary,
            size: (width, height),
            fps,
            encoder,
            muxer,
            planes: Planes::default(),
            bits: Vec::new(),
            frames: 0,
        })
    }

    /// Returns the size of the clip [pixels]. It is that of the pictures, with an odd side extended by one.
    pub fn size(&self) -> (u32, u32) {
        extended(self.size)
    }

    /// Adds the next frame.
    ///
    /// # Errors
    /// Returns an error if the picture has a different size than the clip, or if the disk is full.
    pub fn push(&mut self, image: &Image) -> Result<(), OutputError> {
        let wrong = |why: String| OutputError::Clip { path: self.path.clone(), why };
        if (image.width, image.height) != self.size {
            let (w, h) = self.size;
            return Err(wrong(format!(
                "frame {} is {}×{} pixels in a clip of {w}×{h}; draw all frames at one size",
                self.frames, image.width, image.height
            )));
        }
        self.planes.fill(image);
        let stream = self.encoder.encode(&self.planes.slices()).map_err(|e| wrong(e.to_string()))?;
        let whole = matches!(stream.frame_type(), FrameType::IDR | FrameType::I);
        self.bits.clear();
        stream.write_vec(&mut self.bits);
        let time = self.frames as f64 / self.fps;
        self.muxer.write_video(time, &self.bits, whole).map_err(|e| wrong(e.to_string()))?;
        self.frames += 1;
        Ok(())
    }

    /// Completes the file and renames it to its final name.
    ///
    /// # Errors
    /// Returns an error if there is no frame, or if the disk is full.
    pub fn finish(mut self) -> Result<(), OutputError> {
        let wrong = |why: String| OutputError::Clip { path: self.path.clone(), why };
        if self.frames == 0 {
            return Err(wrong("no frame was drawn; choose at least one".into()));
        }
        self.muxer.finish_in_place().map_err(|e| wrong(e.to_string()))?;
        let file = self
            .muxer
            .into_writer()
            .into_inner()
            .map_err(|e| OutputError::File { path: self.path.clone(), source: e.into_error() })?;
        drop(file);
        keep(self.temporary, &self.path)
    }
}
