//! The scene played by one integrator: figures of every frame, and pictures at the same moments.

use super::BOUND;
use crate::{
    console::Progress,
    fault::Fault,
    picture::{Setup, Studio, View},
};
use hairspring_scene::stage::Stage;
use hairspring_view::encode_png;

/// Number of pictures of each method, evenly spaced, the last one at the end.
pub const MOMENTS: u32 = 4;

/// Width and height of a picture [pixels].
const SIZE: (u32, u32) = (320, 320);

/// The results of playing the scene.
pub struct Played {
    /// Strands that became non-finite and were reset, summed over all frames.
    pub reset_strands: usize,
    /// Mean of |ℓ/L − 1| over segments and frames [1]; infinite if it was in any frame.
    pub stretch_mean: f64,
    /// The maximum over all frames [1].
    pub stretch_max: f64,
    /// Time [s] and maximum stretch [1] of each frame.
    pub stretch: Vec<[f64; 2]>,
    /// Wall time × threads / (points × substeps), for the median frame [ns].
    pub ns: f64,
    /// The pictures, if they were requested.
    pub shots: Vec<Shot>,
}

/// One picture.
pub struct Shot {
    /// Time [s].
    pub time: f64,
    /// The picture as a PNG file.
    pub png: Vec<u8>,
    /// Strands that were reset in this frame.
    pub reset_strands: usize,
}

/// Plays `frames` frames of 1/60 s; takes pictures if `draw` is set.
pub fn play(mut stage: Stage, frames: u32, draw: bool, progress: &mut Progress) -> Result<Played, Fault> {
    let view = View { size: SIZE, ..View::default() };
    let mut studio = if draw { Some(Studio::new(&view, &mut stage, Setup::PLAIN)?) } else { None };
    let mut times = Vec::with_capacity(frames as usize);
    let (mut reset_strands, mut sum, mut worst) = (0, 0.0, 0.0f64);
    let mut stretch = Vec::with_capacity(frames as usize);
    let mut shots = Vec::new();
    let mut substeps = 0;
    for frame in 1..=frames {
        let report = stage.step(1.0 / 60.0);
        let time = f64::from(frame) / 60.0;
        times.push(report.simulate.as_secs_f64());
        substeps = report.step.substeps;
        reset_strands += report.step.reset_strands;
        let measure = stage.measure();
        // A strand that was reset had an infinite stretch before.
        let broken = report.step.reset_strands > 0;
        let [mean, most] = match broken {
            true => [f64::INFINITY; 2],
            false => [measure.stretch_mean, measure.stretch_max],
        };
        sum += mean;
        worst = worst.max(most);
        stretch.push([time, most]);
        // Frames n/4, 2n/4, … n.
        let moments = |f: u32| u64::from(f) * u64::from(MOMENTS) / u64::from(frames);
        let due = moments(frame) > moments(frame - 1);
        if let Some(studio) = studio.as_mut().filter(|_| !due) {
            studio.pass(&stage);
        }
        if let Some(studio) = studio.as_mut().filter(|_| due) {
            let mut png = Vec::new();
            encode_png(&mut png, &studio.draw(&stage)?.0.image())
                .map_err(|e| Fault::Unwritable(format!("a picture could not be encoded: {e}")))?;
            shots.push(Shot { time, png, reset_strands: report.step.reset_strands });
        }
        progress.step(|| {
            let name = stage.scene().solver.integrator.name();
            let lost = if broken || most > BOUND { ", lost" } else { "" };
            format!("{name}, frame {frame}: worst stretch {:.3} %{lost}", most * 1e2)
        });
    }
    times.sort_by(f64::total_cmp);
    let work = stage.simulated_points().0 as f64 * f64::from(substeps);
    let ns = times[times.len() / 2] * 1e9 * rayon::current_num_threads() as f64 / work;
    let stretch_mean = sum / f64::from(frames);
    Ok(Played { reset_strands, stretch_mean, stretch_max: worst, stretch, ns, shots })
}
