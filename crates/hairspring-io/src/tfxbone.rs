//! Reader for TressFX `.tfxbone`: the bones that each strand's root follows. The layout is: u32 number of
//! bones; for each bone, u32 index, u32 length of its name with the terminating zero, and the name; u32
//! number of strands; for each strand, u32 index and four pairs (u32 bone, f32 weight).

use crate::{Place, Problem, bytes::Bytes, skin::normalised};

/// Bones and weights of every root of a `.tfx` groom.
#[derive(Clone, Debug, PartialEq)]
pub struct RootBones {
    /// Names of the bones.
    pub names: Vec<String>,
    /// Four bones of each root, indices into `names`; shape `[strands]`.
    pub bones: Vec<[u16; 4]>,
    /// Their weights, summing to 1; shape `[strands]`.
    pub weights: Vec<[f32; 4]>,
}

impl RootBones {
    /// The names of the bones of root `s` that have a weight above 0.
    pub fn of(&self, s: usize) -> impl Iterator<Item = &str> {
        let pairs = self.bones[s].into_iter().zip(self.weights[s]);
        pairs.filter(|(_, w)| *w > 0.0).map(|(b, _)| self.names[b as usize].as_str())
    }
}

/// Reads a `.tfxbone` file.
///
/// # Errors
/// Returns an error for counts that the file cannot hold, indices out of order or out of range, or a
/// truncated file.
pub fn parse(data: &[u8]) -> Result<RootBones, Problem> {
    let mut bytes = Bytes::new(data);
    let bones = count(&mut bytes, "the bone count", 9, u16::MAX as usize)?;
    let mut names = Vec::with_capacity(bones);
    for i in 0..bones {
        in_order(&mut bytes, i, "bone")?;
        let length: u32 = bytes.value("the length of a bone's name")?;
        let name = bytes.take(length as usize, "a bone's name")?;
        let name = name.split(|b| *b == 0).next().unwrap_or_default();
        names.push(String::from_utf8_lossy(name).into_owned());
    }
    let strands = count(&mut bytes, "the strand count", 36, u32::MAX as usize)?;
    let mut read =
        RootBones { names, bones: Vec::with_capacity(strands), weights: Vec::with_capacity(strands) };
    for s in 0..strands {
        in_order(&mut bytes, s, "strand")?;
        let (mut of, mut weights) = ([0u16; 4], [0.0f32; 4]);
        for (b, w) in of.iter_mut().zip(&mut weights) {
            let at = bytes.at();
            let bone: u32 = bytes.value("a bone index")?;
            *w = bytes.value("a weight")?;
            if bone as usize >= bones {
                return Err(Problem::new(
                    Place::Byte(at),
                    format!("strand {s} names bone {bone}, but there are {bones}"),
                ));
            }
            *b = bone as u16;
        }
        read.bones.push(of);
        read.weights.push(normalised(weights));
    }
    Ok(read)
}

/// Reads a count of records that have at least `size` bytes each.
fn count(bytes: &mut Bytes<'_>, what: &str, size: usize, limit: usize) -> Result<usize, Problem> {
    let at = bytes.at();
    let n = bytes.value::<u32>(what)? as usize;
    if n > limit || n > bytes.remaining() / size {
        return Err(Problem::new(Place::Byte(at), format!("{what} is {n}, more than the file can hold")));
    }
    Ok(n)
}

/// Checks the index at the start of a record, which counts up.
fn in_order(bytes: &mut Bytes<'_>, i: usize, what: &str) -> Result<(), Problem> {
    let at = bytes.at();
    let found: u32 = bytes.value(&format!("the index of a {what}"))?;
    if found as usize == i {
        Ok(())
    } else {
        Err(Problem::new(
            Place::Byte(at),
            format!("expected {what} {i}, found {found}: they must be in order"),
        ))
    }
}
