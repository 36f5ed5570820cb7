//! Strands as a table of points: text with one point a line, and the names of the columns in the first line.
//!
//! ```text
//! strand,x,y,z,radius
//! 0,0.0,0.1,0.0,0.00004
//! 0,0.0,0.11,0.0,0.00003
//! 1,0.01,0.1,0.0,0.00004
//! ```
//!
//! `strand` (or `curve`, `id`), `x`, `y` and `z` are required; `radius` or `width`, and `r`, `g`, `b` (linear, 0 to 1) are optional.
//! The first point of a strand may give attributes of the whole strand: `group`, `guide` (0 or 1), `u` and `v` of the root,
//! `density` (the share of the strands around it that is kept), and the factors `stiffness`, `damping`, `drag`, `friction`,
//! `charge`, `flatness` and `tether` of the material. Other columns are ignored with a note. Columns are separated by commas, semicolons or
//! tabs; a cell in quotation marks may contain them. The points of a strand are consecutive, root first.

use crate::{
    Place, Problem,
    strand_attributes::{GROUP, NUMBERS, StrandAttributes},
    strands::Read,
    text::{as_text, name, remedy},
    units::FileUnits,
};
use glam::Vec3;
use hairspring::groom::Groom;
use std::collections::HashSet;

/// Reads a table of points, in its own units.
///
/// # Errors
/// Returns an error for a missing column, a line with another number of columns, or text that is not a number.
///
/// ```
/// let groom = hairspring_io::csv::parse(b"strand,x,y,z\n0,0,0,0\n0,0,0.1,0\n7,1,0,0\n7,1,0.1,0\n")?;
/// assert_eq!(groom.offsets, [0, 2, 4]);
/// # Ok::<(), hairspring_io::Problem>(())
/// ```
pub fn parse(data: &[u8]) -> Result<Groom, Problem> {
    read(data).map(Read::in_file_units)
}

/// The columns of a table, by their index.
struct Columns {
    strand: usize,
    position: [usize; 3],
    /// Column of the radius, and its factor: 0.5 for a width.
    radius: Option<(usize, f32)>,
    color: Option<[usize; 3]>,
    /// Columns of the attributes of whole strands, by their index in [`NUMBERS`].
    numbers: Vec<(usize, usize)>,
    group: Option<usize>,
    count: usize,
}

pub(crate) fn read(data: &[u8]) -> Result<Read, Problem> {
    let mut text = as_text(data);
    // The library counts lines that end in LF only.
    if text.contains('\r') {
        text = text.replace("\r\n", "\n").replace('\r', "\n").into();
    }
    let header = text.lines().find(|line| !line.trim().is_empty());
    let header = header.ok_or_else(|| Problem::whole("the table is empty"))?;
    let separator = [b',', b';', b'\t'].into_iter().find(|s| header.as_bytes().contains(s)).unwrap_or(b',');
    let mut table = ::csv::ReaderBuilder::new();
    table.delimiter(separator).has_headers(false).flexible(true);
    let mut rows = table.from_reader(text.as_bytes()).into_records();
    let mut line = LineOfRow { text: text.as_bytes(), at: 0, line: 1 };
    let mut notes = Vec::new();
    let first = rows.next().ok_or_else(|| Problem::whole("the table is empty"))?;
    let columns = columns(&cells(&first.map_err(|error| Problem::whole(error.to_string()))?), &mut notes)?;
    let mut groom = Groom { offsets: vec![0], ..Groom::default() };
    let (mut radii, mut last, mut attributes) = (Vec::new(), None, StrandAttributes::default());
    let (mut begun, mut open_rows) = (HashSet::new(), 0usize);
    for row in rows {
        let row = row.map_err(|error| Problem::whole(error.to_string()))?;
        let number = line.of(&row);
        let wrong = |text: String| Problem::new(Place::Line(number), text);
        let mut cells = cells(&row);
        if cells == [""] {
            continue;
        }
        if cells.len() == columns.count + 1 && cells.last() == Some(&"") {
            open_rows += 1;
            cells.pop();
        }
        if cells.len() != columns.count {
            let hint = if cells.len() > columns.count { "; write numbers with decimal points" } else { "" };
            return Err(wrong(format!(
                "the line has {} columns, and the first line names {}{hint}",
                cells.len(),
                columns.count
            )));
        }
        let cell = |k: usize| {
            let number = cells[k].parse::<f32>().ok();
            number.ok_or_else(|| {
                let hint = remedy(cells[k]);
                wrong(format!("expected a number in column {}, but found {:?}{hint}", k + 1, cells[k]))
            })
        };
        let vector = |k: [usize; 3]| Ok::<_, Problem>(Vec3::new(cell(k[0])?, cell(k[1])?, cell(k[2])?));
        let strand = cells[columns.strand];
        if last.as_deref().is_some_and(|last| last != strand) {
            groom.offsets.push(groom.points.len() as u32);
        }
        if last.as_deref() != Some(strand) {
            if !begun.insert(strand.to_owned()) {
                return Err(wrong(format!(
                    "strand {} begins again; keep the lines of a strand together",
                    name(strand)
                )));
            }
            for (attribute, k) in &columns.numbers {
                let value = cell(*k)?;
                let (valid, expected) = match NUMBERS[*attribute] {
                    "u" | "v" => (true, "finite"),
                    "density" => ((0.0..=1.0).contains(&value), "0 to 1"),
                    _ => (value >= 0.0, "0 or more"),
                };
                if !(value.is_finite() && valid) {
                    let text = format!("`{}` is {}; it must be {expected}", NUMBERS[*attribute], cells[*k]);
                    return Err(wrong(text));
                }
                attributes.numbers[*attribute].push(value);
            }
            if let Some(k) = columns.group {
                let group = attributes.groups.index(&name(cells[k]));
                attributes.groups.of_strands.push(group);
            }
        }
        if last.as_deref() != Some(strand) {
            last = Some(strand.to_owned());
        }
        groom.points.push(vector(columns.position)?);
        if let Some((k, factor)) = columns.radius {
            radii.push(factor * cell(k)?);
        }
        if let Some(k) = columns.color {
            groom.colors.push(vector(k)?);
        }
    }
    if last.is_some() {
        groom.offsets.push(groom.points.len() as u32);
    }
    if open_rows > 0 {
        notes.push(format!(
            "{open_rows} lines end in `{}`, which makes an empty column that is ignored",
            char::from(separator).escape_default()
        ));
    }
    let radii = columns.radius.map(|_| radii);
    let mut read = Read { groom, radii, true_radii: false, units: FileUnits::default(), notes };
    attributes.apply(&mut read)?;
    Ok(read)
}

/// The line where a row begins, counted from 1. The library takes empty lines before a row for part of it.
struct LineOfRow<'a> {
    text: &'a [u8],
    /// Begin of the last row [bytes], and its line.
    at: usize,
    line: usize,
}

impl LineOfRow<'_> {
    /// Returns the line of the next row.
    fn of(&mut self, row: &::csv::StringRecord) -> usize {
        let start = row.position().map_or(self.at, |place| place.byte() as usize);
        let is_empty = |byte: &&u8| **byte == b'\n';
        let start = start + self.text[start..].iter().take_while(is_empty).count();
        self.line += self.text[self.at..start].iter().filter(is_empty).count();
        self.at = start;
        self.line
    }
}

/// The cells of a row, without spaces around them, and without quotation marks that follow a space.
fn cells(row: &::csv::StringRecord) -> Vec<&str> {
    let bare = |cell: &'_ str| cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).is_some();
    row.iter().map(str::trim).map(|cell| if bare(cell) { &cell[1..cell.len() - 1] } else { cell }).collect()
}

fn columns(header: &[&str], notes: &mut Vec<String>) -> Result<Columns, Problem> {
    let names: Vec<String> = header.iter().map(|name| name.to_ascii_lowercase()).collect();
    let find = |wanted: &[&str]| names.iter().position(|name| wanted.contains(&name.as_str()));
    let required = |wanted: &[&str]| {
        find(wanted).ok_or_else(|| {
            let text =
                format!("the first line names no column `{}`; it must name strand, x, y and z", wanted[0]);
            Problem::new(Place::Line(1), text)
        })
    };
    let color = [find(&["r"]), find(&["g"]), find(&["b"])];
    let radius = find(&["radius"]).map(|k| (k, 1.0)).or_else(|| find(&["width"]).map(|k| (k, 0.5)));
    let columns = Columns {
        strand: required(&["strand", "curve", "id"])?,
        position: [required(&["x"])?, required(&["y"])?, required(&["z"])?],
        radius,
        color: if let [Some(r), Some(g), Some(b)] = color { Some([r, g, b]) } else { None },
        numbers: (NUMBERS.iter().enumerate())
            .filter(|(_, name)| {
                !["u", "v"].contains(name) || (find(&["u"]).is_some() && find(&["v"]).is_some())
            })
            .filter_map(|(a, name)| Some((a, find(&[name])?)))
            .collect(),
        group: find(&[GROUP]),
        count: names.len(),
    };
    let used = |k: usize| {
        k == columns.strand
            || columns.position.contains(&k)
            || columns.radius.is_some_and(|(r, _)| r == k)
            || columns.color.is_some_and(|c| c.contains(&k))
            || columns.numbers.iter().any(|(_, column)| *column == k)
            || columns.group == Some(k)
    };
    let ignored: Vec<&str> =
        (0..names.len()).filter(|k| !used(*k) && !names[*k].is_empty()).map(|k| names[k].as_str()).collect();
    if !ignored.is_empty() {
        notes.push(format!("ignored columns: {}", ignored.join(", ")));
    }
    Ok(columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_strand_must_be_together() {
        let table = |strands: [&str; 3]| strands.map(|s| format!("{s},0,0,0\n")).concat();
        let parse = |strands| read(format!("strand,x,y,z\n{}", table(strands)).as_bytes());
        assert!(parse(["0", "0", "1"]).is_ok());
        // Quotation marks and the line ends of old spreadsheets do not matter.
        let table = "\"strand\",\"x\",\"y\",\"z\",\"u\"\r\"0\",\"1\",\"2\",\"3\",\"0\"\r0,4,5,6,0\r";
        let quoted = super::read(table.as_bytes()).unwrap();
        assert_eq!(quoted.groom.points, [Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0)]);
        assert_eq!(quoted.notes, ["ignored columns: u"]);
        // Nor do separators inside of quotation marks, or empty lines.
        let table = "strand,x,y,z,group\n\n\"a,b\",1,2,3,\"left, \"\"long\"\"\"\n   \n\"a,b\",4,5,6,\n";
        let quoted = super::read(table.as_bytes()).unwrap();
        assert_eq!((quoted.groom.strand_count(), quoted.groom.points.len()), (1, 2));
        assert_eq!(quoted.groom.group_names, ["left, \"long\""]);
        let open = super::read(b"strand,x,y,z\n\"a,1,2,3\na,4,5,6\n").err().unwrap().to_string();
        assert!(open.contains("line 2: the line has 1 columns"), "{open}");
        let error = parse(["0", "1", "0"]).err().unwrap().to_string();
        assert!(error.contains("line 4: strand 0 begins again"), "{error}");
    }

    #[test]
    fn tables_are_read_with_any_separator_and_order() {
        let read =
            read(b"\xEF\xBB\xBFid;z;y;x;width;age\n a;1;2;3;0.0001;9\na;1;2;4;0.0002;9\nb;0;0;0;0.0001;9\n")
                .unwrap();
        assert_eq!(read.groom.offsets, [0, 2, 3]);
        assert_eq!(read.groom.points[0], Vec3::new(3.0, 2.0, 1.0));
        assert_eq!(read.radii.unwrap(), [0.00005, 0.0001, 0.00005]);
        assert_eq!(read.notes, ["ignored columns: age"]);
    }

    #[test]
    fn strands_have_the_attributes_of_their_first_point() {
        let table = "strand,x,y,z,radius,group,guide,stiffness,friction,density,u,v\n\
                     a,0,0,0,1e-5,top,1,2,0.5,1,0.25,0.75\na,0,1,0,2e-5,top,1,9,9,9,9,9\n\
                     b,1,0,0,3e-5,side,0,3,1,1,0.5,0.5\nb,1,1,0,4e-5,,,0,0,0,0,0\n\
                     c,2,0,0,5e-5,top,0,4,1,0,1,1\nc,2,1,0,6e-5,top,0,4,1,0,1,1\n";
        // The cells of later points may be anything, also empty.
        let read = read(table.as_bytes()).unwrap();
        let groom = &read.groom;
        assert_eq!(
            (groom.strand_count(), groom.groups.as_slice()),
            (2, &[0, 1][..]),
            "the last one has density 0"
        );
        assert_eq!(
            (groom.group_names.as_slice(), read.notes.len()),
            (&["top".to_owned(), "side".into()][..], 1)
        );
        assert_eq!(read.notes, ["density keeps 2 of 3 strands"]);
        assert_eq!([0, 1].map(|s| (groom.scale(s).bend, groom.scale(s).friction)), [(2.0, 0.5), (3.0, 1.0)]);
        assert_eq!(groom.root_uvs, [glam::Vec2::new(0.25, 0.75), glam::Vec2::splat(0.5)]);
        assert_eq!(groom.guides.iter().map(|g| g.guides[0]).collect::<Vec<_>>(), [0, 0]);
        assert_eq!(read.radii.unwrap(), [1e-5, 2e-5, 3e-5, 4e-5]);
    }

    #[test]
    fn guides_have_finite_weights_whatever_the_points_are() {
        for x in ["nan", "inf", "-3e38", "1"] {
            let strand = |name: &str, x: &str, guide: u8| {
                (0..3).map(|k| format!("{name},{x},{k},0,{guide}\n")).collect::<String>()
            };
            let table = format!(
                "strand,x,y,z,guide\n{}{}{}",
                strand("a", x, 1),
                strand("b", x, 0),
                strand("c", "2", 0)
            );
            let groom = parse(table.as_bytes()).unwrap();
            assert!(groom.guides.iter().all(|g| (g.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6), "{x}");
        }
    }

    #[test]
    fn a_separator_at_the_end_of_lines_makes_no_column() {
        let read = super::read(b"strand,x,y,z\n0,1,2,3,\n0,4,5,6,\n").unwrap();
        assert_eq!(read.groom.points, [Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0)]);
        assert_eq!(read.notes, ["2 lines end in `,`, which makes an empty column that is ignored"]);
        let read = super::read(b"strand,x,y,z,\n0,1,2,3,\n").unwrap();
        assert_eq!((read.groom.points.len(), read.notes.len()), (1, 0));
    }

    #[test]
    fn errors_name_the_line_and_the_column() {
        let error = |text: &str| parse(text.as_bytes()).unwrap_err().to_string();
        assert!(error("strand,x,y\n").contains("no column `z`"));
        assert!(error("strand,x,y,z\n0,1,2\n").contains("3 columns"));
        assert!(error("strand,x,y,z\n0,1,2,a\n").contains("column 4"));
        assert!(error("").contains("empty"));
        let comma = error("strand;x;y;z\n0;1,5;2;3\n");
        assert!(comma.contains("line 2") && comma.ends_with("found \"1,5\"; use decimal points"), "{comma}");
        let split = error("strand,x,y,z\n0,0,000,0,100,0,000\n");
        assert!(split.contains("has 7 columns") && split.ends_with("decimal points"), "{split}");
        let none = error("strand,x,y,z,density\n0,1,2,3,0\n0,1,2,4,0\n1,1,2,3,0\n");
        assert_eq!(none, "density keeps none of the 2 strands; raise it above 0");
        assert!(
            error("strand,x,y,z,drag\n0,1,2,3,-1\n").contains("line 2: `drag` is -1; it must be 0 or more")
        );
    }
}
