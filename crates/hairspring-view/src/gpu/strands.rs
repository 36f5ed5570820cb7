//! The frame's strands on the GPU. Moving data is sent every frame, static data only when it has changed.

use super::{
    Gpu,
    memory::{Generation, Store},
};
use crate::frame::HairDraw;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use wgpu::{BindingResource, BufferUsages};

/// `Strand` of the shaders.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Strand {
    first: u32,
    slot: u32,
    count: u32,
    number: u32,
    style: u32,
    colored: u32,
}

/// A fingerprint of an array: its address, its length, and a hash of some of its values.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Print {
    place: usize,
    len: usize,
    some: u64,
}

impl Print {
    /// Hashes 512 evenly spaced values. This detects another array at the same address, but not a change of a
    /// single value.
    pub fn of<T: Pod>(values: &[T]) -> Self {
        let mut some = 0xcbf2_9ce4_8422_2325u64;
        for value in values.iter().step_by(values.len() / 512 + 1).chain(values.last()) {
            for byte in bytemuck::bytes_of(value) {
                some = (some ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
            }
        }
        Self { place: values.as_ptr() as usize, len: values.len(), some }
    }
}

/// The styles whose points all fit, with the index of each style's first point.
pub(super) fn fitting<'a>(
    gpu: &Gpu,
    hair: &'a [HairDraw<'a>],
) -> impl Iterator<Item = (usize, &'a HairDraw<'a>)> {
    let (most, mut end) = (gpu.most_points(), 0);
    hair.iter().map_while(move |h| {
        let first = end;
        end += h.points.len();
        (end <= most).then_some((first, h))
    })
}

/// The strands of a frame.
pub(super) struct Strands {
    pub strands: Store,
    /// Strand of each slot. Every strand has one slot for each of its points.
    pub owners: Store,
    pub points: Store,
    pub radii: Store,
    pub colors: Store,
    pub styles: Store,
    /// Number of slots, and number of points.
    pub slots: usize,
    pub count: usize,
    /// Number of strands that did not fit.
    pub left_out: usize,
    /// What was sent last: offsets, radii and colors of each style, and its number of points.
    sent: Vec<(Print, Print, Print, usize)>,
}

impl Strands {
    pub fn new(gpu: &Gpu) -> Self {
        let store = |label| Store::new(gpu, label, BufferUsages::STORAGE);
        Self {
            strands: store("strands"),
            owners: store("owners"),
            points: Store::new(gpu, "points", BufferUsages::STORAGE | BufferUsages::COPY_SRC),
            radii: store("radii"),
            colors: store("colors"),
            styles: store("styles"),
            slots: 0,
            count: 0,
            left_out: 0,
            sent: Vec::new(),
        }
    }

    /// Marks everything as not sent, so that it is sent again.
    pub fn forget(&mut self) {
        self.sent.clear();
    }

    /// The bindings of `wgsl/strands.wgsl`.
    pub fn bindings(&self) -> [(u32, BindingResource<'_>); 5] {
        let Self { strands, owners, points, radii, styles, .. } = self;
        [(1, strands.all()), (2, owners.all()), (3, points.all()), (4, radii.all()), (5, styles.all())]
    }

    /// Sends a frame's strands.
    pub fn send(&mut self, gpu: &Gpu, hair: &[HairDraw], generation: &mut Generation) {
        let print =
            |h: &HairDraw| (Print::of(h.offsets), Print::of(h.radii), Print::of(h.colors), h.points.len());
        let now: Vec<_> = hair.iter().map(print).collect();
        if now != self.sent {
            self.send_what_stays(gpu, hair, generation);
            self.sent = now;
        }
        for (first, h) in fitting(gpu, hair).filter(|(_, h)| h.followed().is_none()) {
            self.points.write(gpu, size_of::<Vec3>() * first, h.points);
        }
    }

    fn send_what_stays(&mut self, gpu: &Gpu, hair: &[HairDraw], generation: &mut Generation) {
        let most = gpu.most_points();
        let (mut strands, mut owners) = (Vec::new(), Vec::new());
        let (mut radii, mut colors) = (Vec::new(), Vec::new());
        let colored = hair.iter().any(|h| !h.colors.is_empty());
        let mut end = 0;
        for (style, (first, h)) in fitting(gpu, hair).enumerate() {
            for s in 0..h.strand_count() {
                let range = h.range(s);
                if range.is_empty() || owners.len() + range.len() > most {
                    continue;
                }
                owners.resize(owners.len() + range.len(), strands.len() as u32);
                strands.push(Strand {
                    first: (first + range.start) as u32,
                    slot: (owners.len() - range.len()) as u32,
                    count: range.len() as u32,
                    number: s as u32,
                    style: style as u32,
                    colored: (h.colors.len() >= range.end) as u32,
                });
            }
            end = first + h.points.len();
            radii.extend_from_slice(&h.radii[..h.radii.len().min(h.points.len())]);
            radii.resize(end, 0.0);
            if colored {
                colors.extend_from_slice(&h.colors[..h.colors.len().min(h.points.len())]);
                colors.resize(end, Vec3::ZERO);
            }
        }
        let all: usize =
            hair.iter().map(|h| (0..h.strand_count()).filter(|s| !h.range(*s).is_empty()).count()).sum();
        self.left_out = all - strands.len();
        (self.slots, self.count) = (owners.len(), end);
        self.strands.fill(gpu, &strands, generation);
        self.owners.fill(gpu, &owners, generation);
        self.radii.fill(gpu, &radii, generation);
        self.colors.fill(gpu, &colors, generation);
        self.points.fit(gpu, size_of::<Vec3>() * end, generation);
    }
}
