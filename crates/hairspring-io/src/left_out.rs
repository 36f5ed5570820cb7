//! What the reader of `.obj` files leaves out, for its notes.

/// What corners lack whose texture coordinate is not defined.
pub(crate) const UNMAPPED: &str =
    "corners name texture coordinates, but the file defines none before them (`vt`); they are read without";

/// Files that the file refers to.
pub(crate) const CALLS: &str =
    "other files are named by `call` and are not read; export everything to one file";

/// What a mesh of the file lacks.
#[derive(Default)]
pub(crate) struct LeftOut {
    /// Faces of fewer than three different corners.
    pub faces: usize,
    /// Large polygons that are not convex.
    pub concave: usize,
    pub lines: usize,
    pub points: usize,
    /// Other files that it refers to.
    pub calls: usize,
    /// Free-form curves and surfaces.
    pub surfaces: usize,
    /// Corners with the number of a texture coordinate, before any is defined.
    pub unmapped: usize,
    /// Vertices without a color, if others have one.
    pub uncolored: usize,
}

impl LeftOut {
    /// The sentence for a file without triangles.
    pub fn instead_of_faces(&self) -> &'static str {
        if self.surfaces > 0 {
            "the file has free-form surfaces but no faces, so it is no mesh; export it as polygons"
        } else if self.lines > 0 {
            "the file has polylines but no faces, so it is no mesh; name it as a groom, or export faces"
        } else {
            "the file has no faces, so it is no mesh; export it as .obj with faces"
        }
    }

    pub fn notes(&self) -> Vec<String> {
        let counts = [
            (self.faces, "faces have fewer than three different corners and are left out; clean up the mesh"),
            (
                self.concave,
                "polygons of many corners are not convex, and may overlap; triangulate them before the export",
            ),
            (self.lines, "polylines are no surface and are left out; name the file as a groom to read them"),
            (self.points, "points (`p`) are no surface and are left out"),
            (self.calls, CALLS),
            (self.surfaces, "free-form curves and surfaces are left out; export them as polygons"),
            (self.unmapped, UNMAPPED),
            (self.uncolored, "vertices have no color, but others do; they are black"),
        ];
        let some = counts.into_iter().filter(|(count, _)| *count > 0);
        some.map(|(count, text)| format!("{count} {text}")).collect()
    }
}
