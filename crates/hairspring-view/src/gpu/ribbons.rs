//! Hair on the card: points are placed and lit, pieces sorted and drawn.

use super::{
    Gpu,
    constants::{BATCH, MAX_PIECES, PHASES, POINTS, RIBBON, SORT, SURVEY},
    memory::{Bound, Generation, Kernel, Numbers, Store, groups},
    picture::{LIGHT, pipeline},
    renderer::Job,
    surfaces::Surfaces,
    volume::Volume,
};
use crate::{hair::ribbon::DEPTHS, tile::PATCH};
use wgpu::{
    BindingResource, BlendComponent, BlendFactor, BlendOperation, BlendState, BufferUsages, TextureView,
};

/// Most pieces of a frame: 64 MiB of them, and what the numbers of slots leave room for.
const MOST: usize = 1 << 24;
/// Depths that pieces are sorted by.
const KEYS: usize = DEPTHS as usize + 1;

/// The shaders of hair, and what they work out.
pub(super) struct Ribbons {
    place: Kernel,
    count: Kernel,
    scan: Kernel,
    scatter: Kernel,
    tidy: Kernel,
    draw: wgpu::RenderPipeline,
    survey: Kernel,
    bound: Vec<Bound>,
    numbers: Numbers,
    patches: Store,
    dots: Store,
    lights: Store,
    plans: Store,
    counts: Store,
    starts: Store,
    pieces: Store,
    drawing: Store,
    corners: Store,
}

/// Most pieces that each of a frame's segments may be drawn as.
pub(super) fn most_pieces(slots: usize) -> f32 {
    ((MOST / slots.max(1)) as f32).clamp(1.0, MAX_PIECES)
}

impl Ribbons {
    pub fn new(gpu: &Gpu) -> Self {
        let (points, sort, ribbon) = (POINTS.module(gpu), SORT.module(gpu), RIBBON.module(gpu));
        let store = |label, usage| Store::new(gpu, label, usage);
        // Two triangles a piece.
        let mut corners = store("corners", BufferUsages::INDEX);
        let quads = (0..BATCH as u16).flat_map(|k| [0, 1, 2, 2, 1, 3].map(|i| 4 * k + i));
        corners.fill(gpu, &quads.collect::<Vec<u16>>(), &mut Generation::default());
        // Under what lies there: as much is added as still shows through.
        let part = |src_factor, dst_factor| BlendComponent {
            src_factor,
            dst_factor,
            operation: BlendOperation::Add,
        };
        let under = BlendState {
            color: part(BlendFactor::DstAlpha, BlendFactor::One),
            alpha: part(BlendFactor::Zero, BlendFactor::OneMinusSrcAlpha),
        };
        let target = Some(wgpu::ColorTargetState {
            format: LIGHT,
            blend: Some(under),
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
            survey: Kernel::new(gpu, &SURVEY.module(gpu), "survey"),
            bound: (0..PHASES).map(|_| Bound::default()).collect(),
            numbers: Numbers::new(gpu, PHASES),
            patches: store("patches", BufferUsages::STORAGE),
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

    /// Makes room for points, and for a picture of some size [pixels].
    pub fn fit(&mut self, gpu: &Gpu, slots: usize, size: [u32; 2], generation: &mut Generation) {
        let [across, down] = size.map(|n| (n as usize).div_ceil(PATCH));
        self.patches.fit(gpu, 8 * across * down, generation);
        self.dots.fit(gpu, 16 * slots, generation);
        self.lights.fit(gpu, 4 * slots, generation);
        self.plans.fit(gpu, 4 * slots, generation);
        self.pieces.fit(gpu, 4 * slots * most_pieces(slots) as usize, generation);
    }

    /// Places, lights and sorts.
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
        let entries = [
            frame.clone(),
            (1, strands.strands.all()),
            (2, strands.owners.all()),
            (3, strands.points.all()),
            (4, strands.radii.all()),
            (5, strands.styles.all()),
            (6, strands.colors.all()),
            (7, self.dots.all()),
            (8, self.lights.all()),
            (10, BindingResource::TextureView(&volume.light)),
            (12, BindingResource::Sampler(&surfaces.sampler)),
            (13, BindingResource::TextureView(&surfaces.heights)),
        ];
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

    /// Draws.
    pub fn record(&mut self, job: &Job, encoder: &mut wgpu::CommandEncoder) {
        let Job { gpu, generation, uniforms, targets, .. } = *job;
        let [across, down] = targets.size.map(|n| n.div_ceil(PATCH as u32).div_ceil(8));
        Self::record_none(job, encoder);
        for phase in 0..PHASES {
            let entries = [
                (0, uniforms.all()),
                (1, BindingResource::TextureView(&targets.before)),
                (2, BindingResource::TextureView(&targets.place)),
                (3, self.patches.all()),
            ];
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.survey.run(gpu, generation, &mut pass, &entries, [across, down, 1]);
            drop(pass);
            let entries = [
                (0, uniforms.all()),
                (1, self.dots.all()),
                (2, self.lights.all()),
                (3, self.pieces.all()),
                (4, self.starts.all()),
                (5, BindingResource::TextureView(&targets.place)),
                (6, self.patches.all()),
                (7, self.numbers.get(phase)),
            ];
            let layout = self.draw.get_bind_group_layout(0);
            let group = self.bound[phase as usize].group(gpu, generation, layout, &entries);
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("ribbons"),
                color_attachments: &[keep(&targets.before), keep(&targets.behind)],
                ..Default::default()
            });
            pass.set_pipeline(&self.draw);
            pass.set_bind_group(0, group, &[]);
            pass.set_index_buffer(self.corners.buffer().slice(..), wgpu::IndexFormat::Uint16);
            pass.draw_indexed_indirect(self.drawing.buffer(), 0);
        }
    }

    /// Leaves the picture without hair: everything shows through.
    pub fn record_none(job: &Job, encoder: &mut wgpu::CommandEncoder) {
        let clear = |view| {
            let mut target = keep(view);
            if let Some(target) = &mut target {
                target.ops.load = wgpu::LoadOp::Clear(wgpu::Color { a: 1.0, ..wgpu::Color::TRANSPARENT });
            }
            target
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("no ribbons"),
            color_attachments: &[clear(&job.targets.before), clear(&job.targets.behind)],
            ..Default::default()
        });
    }
}

/// A target that is drawn on.
fn keep(view: &TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
    })
}
