// Which points belong to which strand: `gpu/strands.rs` writes it.

struct Strand {
    /// Number of its first point among all styles' points.
    first: u32,
    /// Its first slot.
    slot: u32,
    /// Its points.
    count: u32,
    /// Its number in its style.
    number: u32,
    style: u32,
    /// 1: its points have colors of their own.
    colored: u32,
}

@group(0) @binding(1) var<storage, read> strands: array<Strand>;
/// Strand of each slot.
@group(0) @binding(2) var<storage, read> owners: array<u32>;
/// Three numbers a point [m].
@group(0) @binding(3) var<storage, read> points: array<f32>;
@group(0) @binding(4) var<storage, read> radii: array<f32>;
@group(0) @binding(5) var<storage, read> styles: array<Style>;

fn point(i: u32) -> vec3f {
    return vec3f(points[3u * i], points[3u * i + 1u], points[3u * i + 2u]);
}
