//! Hair on the GPU: places and lights points, and sorts and draws pieces.

use super::{
    Gpu,
    constants::{BATCH, MAX_PIECES, POINTS, RIBBON, SORT},
    memory::{Bound, Generation, Kernel, Store, groups},
    picture::{LIGHT, clear, pipeline},
    renderer::Job,
    surfaces::Surfaces,
    volume::Volume,
};
use crate::hair::ribbon::DEPTHS;
use wgpu::{BindingResource, BlendComponent, BlendFactor, BlendOperation, BlendState, BufferUsages};

/// Maximum number of pieces of a frame. They take 64 MiB, and their indices must leave room for other bits.
const MOST: usize = 1 << 24;
/// Number of sort keys for the depth of pieces.
const KEYS: usize = DEPTHS as usize + 1;

/// The shaders of hair and their buffers.
pub(super) struct Ribbons {
    place: Kernel,
    count: Kernel,
    scan: Kernel,
    scatter: Kernel,
    tidy: Kernel,
    draw: wgpu::RenderPipeline,
    bound: Bound,
    dots: Store,
    lights: Store,
    plans: Store,
    counts: Store,
    starts: Store,
    pieces: Store,
    drawing: Store,
    corners: Store,
}

/// Maximum number of pieces for each segment of a frame.
pub(super) fn most_pieces(slots: usize) -> f32 {
    ((MOST / slots.max(1)) as f32).clamp(1.0, MAX_PIECES)
}

impl Ribbons {
    pub fn new(gpu: &Gpu) -> Self {
        let (points, sort, ribbon) = (POINTS.module(gpu), SORT.module(gpu), RIBBON.module(gpu));
        let store = |label, usage| Store::new(gpu, label, usage);
        // Two triangles per piece.
        let mut corners = store("corners", BufferUsages::INDEX);
        let quads = (0..BATCH as u16).flat_map(|k| [0, 1, 2, 2, 1, 3].map(|i| 4 * k + i));
        corners.fill(gpu, &quads.collect::<Vec<u16>>(), &mut Generation::default());
        // The "over" operator.
        let over = BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::OneMinusSrcAlpha,
            operation: BlendOperation::Add,
        };
        let target = Some(wgpu::ColorTargetState {
            format: LIGHT,
            blend: Some(BlendState { color: over, alpha: over }),
            write_mask: wgpu::ColorWrites::ALL,
        });
        let targets = [target.clone(), target];
        let mut counts = store("counts", BufferUsages::STORAGE);
        let mut starts = store("starts", BufferUsages::STORAGE);
        counts.fit(gpu, 4 * KEYS, &mut Generation::default());
        starts.fit(gpu, 4 * (KEYS + 1), &mut Generation::default());
        Self {
            place: Kernel::new(gpu, &points, "place"),
            count: Kernel::new(gpu, &sort, "count"),
            scan: Kernel::new(gpu, &sort, "scan"),
            scatter: Kernel::new(gpu, &sort, "scatter"),
            tidy: Kernel::new(gpu, &sort, "tidy"),
            draw: pipeline(gpu, &ribbon, ["ribbon", "cover"], &targets, None, 1),
            bound: Bound::default(),
            dots: store("dots", BufferUsages::STORAGE),
            lights: store("lights", BufferUsages::STORAGE),
            plans: store("plans", BufferUsages::STORAGE),
            counts,
            starts,
            pieces: store("pieces", BufferUsages::STORAGE),
            drawing: store("drawing", BufferUsages::STORAGE | BufferUsages::INDIRECT),
            corners,
        }
    }

    /// Makes room for points.
    pub fn fit(&mut self, gpu: &Gpu, slots: usize, generation: &mut Generation) {
        self.dots.fit(gpu, 16 * slots, generation);
        self.lights.fit(gpu, 4 * slots, generation);
        self.plans.fit(gpu, 4 * slots, generation);
        self.pieces.fit(gpu, 4 * slots * most_pieces(slots) as usize, generation);
    }

    /// Records placing, lighting and sorting.
    pub fn record_sort(
        &mut self,
        job: &Job,
        encoder: &mut wgpu::CommandEncoder,
        volume: &Volume,
        surfaces: &Surfaces,
    ) {
        let Job { gpu, generation, uniforms, strands, .. } = *job;
        encoder.clear_buffer(self.counts.buffer(), 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let all = groups(strands.slots, 256);
        let frame = (0, uniforms.all());
        let own = [
            frame.clone(),
            (6, strands.colors.all()),
            (7, self.dots.all()),
            (8, self.lights.all()),
            (10, BindingResource::TextureView(&volume.light)),
            (12, BindingResource::Sampler(&surfaces.sampler)),
            (13, BindingResource::TextureView(&surfaces.heights)),
        ];
        let entries = [&own[..], &strands.bindings()[..]].concat();
        self.place.run(gpu, generation, &mut pass, &entries, all);
        let plans = (2, self.plans.all());
        let counts = (3, self.counts.all());
        let starts = (4, self.starts.all());
        let pieces = (5, self.pieces.all());
        let entries = [frame.clone(), (1, self.dots.all()), plans.clone(), counts.clone()];
        self.count.run(gpu, generation, &mut pass, &entries, all);
        let entries = [counts.clone(), starts.clone(), (6, self.drawing.all())];
        self.scan.run(gpu, generation, &mut pass, &entries, [1; 3]);
        let entries = [frame, plans, counts, pieces.clone()];
        self.scatter.run(gpu, generation, &mut pass, &entries, all);
        self.tidy.run(gpu, generation, &mut pass, &[starts, pieces], groups(KEYS, 256));
    }

    /// Records drawing.
    pub fn record(&mut self, job: &Job, encoder: &mut wgpu::CommandEncoder) {
        let Job { gpu, generation, uniforms, targets, .. } = *job;
        let entries = [
            (0, uniforms.all()),
            (1, self.dots.all()),
            (2, self.lights.all()),
            (3, self.pieces.all()),
            (4, self.starts.all()),
            (5, BindingResource::TextureView(&targets.place)),
        ];
        let group = self.bound.group(gpu, generation, self.draw.get_bind_group_layout(0), &entries);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ribbons"),
            color_attachments: &[clear(&targets.before), clear(&targets.behind)],
            ..Default::default()
        });
        pass.set_pipeline(&self.draw);
        pass.set_bind_group(0, group, &[]);
        pass.set_index_buffer(self.corners.buffer().slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed_indirect(self.drawing.buffer(), 0);
    }

    /// Clears the hair targets of a picture without hair.
    pub fn record_none(job: &Job, encoder: &mut wgpu::CommandEncoder) {
        let targets = job.targets;
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("no ribbons"),
            color_attachments: &[clear(&targets.before), clear(&targets.behind)],
            ..Default::default()
        });
    }
}
