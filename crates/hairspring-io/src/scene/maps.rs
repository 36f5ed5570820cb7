//! `maps` of a `[[groom]]` and of `[builtin]`: parameters that vary over the scalp.
//!
//! ```text
//! value of a strand = low + (high − low) · map at its root     map: a texture by texture coordinates, the colors of
//!                                                              the body's vertices, or one number for each strand
//! ```

use super::{
    Reader,
    map_file::{Channel, MapFile, MapsFile},
};
use crate::{
    Place, Problem, Result, load,
    picture::Picture,
    text::{as_text, lines, remedy},
};
use glam::{Vec2, Vec3};
use hairspring::{
    body::Mesh,
    groom::{DEFAULT_RADIUS, Groom, RootBinding, StrandScale, bind_roots, cut, keep_strands, thin},
};
use toml::Spanned;

/// A map whose file has been read.
enum Source {
    Texture(Picture),
    VertexColors,
    /// Numbers, this many for each strand.
    Values(Vec<f32>, usize),
}

/// The place of a root on the body: its triangle and its barycentric coordinates.
pub(super) type OnSkin = (usize, Vec3);

/// A map that can be sampled.
pub(super) struct Map<'a> {
    source: Source,
    channel: Channel,
    range: [f32; 2],
    mesh: Option<&'a Mesh>,
}

impl Map<'_> {
    /// Color of the map at strand `s`, 0 to 1; for a list of numbers, those of the strand.
    fn color(&self, s: usize, uv: Option<Vec2>, place: Option<OnSkin>) -> Vec3 {
        match &self.source {
            Source::Texture(picture) => {
                let uv = uv.or_else(|| blend(&self.mesh?.uvs, self.mesh?, place?));
                uv.map_or(Vec3::ZERO, |uv| picture.at(uv))
            }
            Source::VertexColors => {
                let color = || blend(&self.mesh?.colors, self.mesh?, place?);
                color().unwrap_or_default()
            }
            Source::Values(values, each) => {
                let own = |k: usize| values.get(s * each + k.min(each - 1)).copied().unwrap_or_default();
                Vec3::new(own(0), own(1), own(2))
            }
        }
    }

    /// Value of the parameter at strand `s`.
    fn value(&self, s: usize, uv: Option<Vec2>, place: Option<OnSkin>) -> f32 {
        let color = self.color(s, uv, place);
        let part = match self.channel {
            Channel::Gray => color.element_sum() / 3.0,
            Channel::Red => color.x,
            Channel::Green => color.y,
            Channel::Blue => color.z,
        };
        self.range[0] + (self.range[1] - self.range[0]) * part
    }

    /// Direction in which hair leaves the skin at strand `s`, from the `normal` there.
    pub(super) fn direction(&self, s: usize, place: OnSkin, normal: Vec3) -> Vec3 {
        let color = self.color(s, None, Some(place));
        let lean = match &self.source {
            Source::Values(..) => color,
            _ => {
                // 0.5 is no lean. Data in 8 bits has no exact middle.
                let [across, up] =
                    [color.x, color.y].map(|c| 2.0 * c - 1.0).map(|c| if c.abs() < 0.01 { 0.0 } else { c });
                let [u, v] = self.mesh.map_or([Vec3::ZERO; 2], |mesh| texture_axes(mesh, place.0));
                u * across + v * up
            }
        };
        let lean = lean - normal * normal.dot(lean).min(0.0);
        let share = (lean.length() * self.range[1]).clamp(0.0, 1.0);
        let flat = lean.try_normalize().unwrap_or(normal);
        (normal * (1.0 - share) + flat * share).try_normalize().unwrap_or(normal)
    }
}

impl Reader<'_> {
    /// Opens the map `name` of `groom`, which has `strands` strands.
    fn map<'m>(
        &mut self,
        name: &str,
        named: &Spanned<MapFile>,
        strands: usize,
        mesh: Option<&'m Mesh>,
    ) -> Result<Map<'m>> {
        let (near, file) = (named.span().start, named.get_ref());
        let each = if name == "comb" { 3 } else { 1 };
        let source = if let Some(texture) = &file.texture {
            let path = self.resolve(texture);
            let data = self.named(load::bytes_of(&path), texture, "map")?;
            Source::Texture(Picture::parse(&data).map_err(|p| p.in_file(&path))?)
        } else if let Some(values) = &file.values {
            let path = self.resolve(values);
            let data = self.named(load::bytes_of(&path), values, "map")?;
            Source::Values(numbers(&data, strands, each).map_err(|p| p.in_file(&path))?, each)
        } else {
            if mesh.is_none_or(|mesh| mesh.colors.is_empty()) {
                let text = format!("the map `{name}` needs a [body] whose vertices have colors");
                return Err(self.wrong(near, name, text));
            }
            Source::VertexColors
        };
        Ok(Map { source, channel: file.channel, range: [file.low, file.high], mesh })
    }

    /// Opens the map of the direction of grown hair.
    pub(super) fn comb_map<'m>(
        &mut self,
        maps: &MapsFile,
        strands: usize,
        mesh: &'m Mesh,
    ) -> Result<Option<Map<'m>>> {
        let Some(named) = &maps.comb else { return Ok(None) };
        let map = self.map("comb", named, strands, Some(mesh))?;
        if !matches!(map.source, Source::Values(..)) && mesh.uvs.is_empty() {
            let text = "the map `comb` needs a [body] with texture coordinates, which give its directions; or `values` of three numbers for each strand";
            return Err(self.wrong(named.span().start, "comb", text.into()));
        }
        Ok(Some(map))
    }

    /// Applies the maps of a groom, except that of its direction.
    pub(super) fn apply_maps(
        &mut self,
        maps: &MapsFile,
        groom: &mut Groom,
        mesh: Option<&Mesh>,
    ) -> Result<()> {
        let named: Vec<_> = maps
            .all()
            .into_iter()
            .filter_map(|(name, map)| map.as_ref().map(|map| (name, map)))
            .filter(|(name, _)| *name != "comb")
            .collect();
        if named.is_empty() {
            return Ok(());
        }
        let strands = groom.strand_count();
        let roots = mesh.map(|mesh| roots_on(groom, mesh));
        let place = |s: usize| {
            let root = roots.as_ref()?.get(s)?;
            Some((root.triangle as usize, root.barycentric))
        };
        for (name, map_file) in named {
            let near = map_file.span().start;
            let map = self.map(name, map_file, strands, mesh)?;
            let no_uvs = groom.root_uvs.is_empty() && mesh.is_none_or(|mesh| mesh.uvs.is_empty());
            if matches!(map.source, Source::Texture(_)) && no_uvs {
                let text = format!(
                    "the map `{name}` needs texture coordinates: of the groom's roots, or of a [body]; use `values` without them"
                );
                return Err(self.wrong(near, name, text));
            }
            let values: Vec<f32> =
                (0..strands).map(|s| map.value(s, groom.root_uvs.get(s).copied(), place(s))).collect();
            if let Some(s) = values.iter().position(|v| !(v.is_finite() && *v >= 0.0)) {
                let text = format!("the map `{name}` is {} at strand {s}; it must be 0 or more", values[s]);
                return Err(self.wrong(near, name, text));
            }
            match name {
                "length" => cut(groom, &values),
                "density" => thin(groom, &values),
                "radius" if values.contains(&0.0) => {
                    let text = "the map `radius` is 0 at a strand; it must be above 0".into();
                    return Err(self.wrong(near, name, text));
                }
                "radius" => scale_radii(groom, &values),
                _ => scale(groom, name, &values),
            }
        }
        if maps.length.is_some() {
            let lengths: Vec<f32> = (0..groom.strand_count()).map(|s| groom.strand_length(s)).collect();
            keep_strands(groom, |s| lengths[s] > 0.0);
        }
        if groom.strand_count() == 0 && strands > 0 {
            let near = maps.density.as_ref().or(maps.length.as_ref()).map_or(0, |m| m.span().start);
            return Err(self.wrong(near, "maps", "the maps leave no strand of the groom".into()));
        }
        Ok(())
    }
}

/// Multiplies a parameter of the material for each strand.
fn scale(groom: &mut Groom, name: &str, values: &[f32]) {
    groom.scales.resize(groom.strand_count(), StrandScale::default());
    for (scale, value) in groom.scales.iter_mut().zip(values) {
        let of = match name {
            "bend" => &mut scale.bend,
            "damping" => &mut scale.damping,
            "drag" => &mut scale.drag,
            "friction" => &mut scale.friction,
            "charge" => &mut scale.charge,
            "flatness" => &mut scale.flatness,
            "tether" => &mut scale.tether,
            _ => &mut scale.global_shape,
        };
        *of *= value;
    }
}

/// Multiplies the radii: those of the groom, and that of a material, which replaces them.
fn scale_radii(groom: &mut Groom, values: &[f32]) {
    groom.scales.resize(groom.strand_count(), StrandScale::default());
    for (s, value) in values.iter().enumerate() {
        groom.scales[s].radius *= value;
        let points = groom.range(s);
        groom.radii[points].iter_mut().for_each(|radius| *radius *= value);
    }
}

/// The places of all roots on a mesh.
fn roots_on(groom: &Groom, mesh: &Mesh) -> Vec<RootBinding> {
    if !groom.roots.is_empty() {
        return groom.roots.clone();
    }
    let mut only =
        Groom::from_strands((0..groom.strand_count()).map(|s| [groom.strand(s)[0]]), DEFAULT_RADIUS);
    bind_roots(&mut only, mesh);
    only.roots
}

/// The value at a place between those of the vertices; `None` for a mesh without values.
fn blend<T: Copy + Default + std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>>(
    values: &[T],
    mesh: &Mesh,
    (triangle, weights): OnSkin,
) -> Option<T> {
    let corners = mesh.triangles[triangle].map(|v| values.get(v as usize).copied());
    let [a, b, c] = [corners[0]?, corners[1]?, corners[2]?];
    Some(a * weights.x + b * weights.y + c * weights.z)
}

/// Unit vectors on a triangle along which the texture coordinates u and v grow; 0 where they do not.
fn texture_axes(mesh: &Mesh, triangle: usize) -> [Vec3; 2] {
    let [a, b, c] = mesh.corners(triangle);
    let [p, q, r] = mesh.triangles[triangle].map(|v| mesh.uvs.get(v as usize).copied().unwrap_or_default());
    let (e, f) = (b - a, c - a);
    let (g, h) = (q - p, r - p);
    let turn = g.perp_dot(h).signum();
    [(e * h.y - f * g.y) * turn, (f * g.x - e * h.x) * turn].map(Vec3::normalize_or_zero)
}

/// Reads `each` numbers for each of `strands`, separated by spaces, commas or lines.
fn numbers(data: &[u8], strands: usize, each: usize) -> std::result::Result<Vec<f32>, Problem> {
    let text = as_text(data);
    let mut values = Vec::new();
    for (k, line) in lines(&text).enumerate() {
        for word in line.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty()) {
            let number = word.parse::<f32>().ok().filter(|number| number.is_finite());
            values.push(number.ok_or_else(|| {
                Problem::new(
                    Place::Line(k + 1),
                    format!("expected a number, but found {word:?}{}", remedy(word)),
                )
            })?);
        }
    }
    if values.len() != strands * each {
        let (found, of) = (values.len(), if each == 1 { "one" } else { "three" });
        let text = format!("expected {} numbers, {of} for each strand, but found {found}", strands * each);
        return Err(Problem::whole(text));
    }
    Ok(values)
}
