//! Meshes of geoms: volume, centre and second moments, computed as in MuJoCo.
//!
//! Integrals over tetrahedra between the triangles and a point are exact for closed surfaces. The
//! kind `legacy`, MuJoCo's default, takes their volumes without sign.

use super::{Compiler, Reader, defaults::MAIN};
use crate::{
    files::{Files, is_beside},
    geometry::exact,
    xml::{Element, numbers},
};
use nalgebra::{Matrix3, Vector3};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Largest size of a mesh file, and of all together, bytes.
const MOST_BYTES: u64 = 64 << 20;

/// A mesh asset: its integrals, or the reason why they are unknown.
pub(super) type Mesh = Result<Integrals, String>;

/// Mesh assets by name.
pub(super) type Meshes = BTreeMap<String, Mesh>;

/// Integrals of unit density over a volume, or over a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Integrals {
    /// Volume, or area of a shell.
    pub(super) size: f64,
    pub(super) centre: Vector3<f64>,
    /// Inertia about the centre.
    pub(super) inertia: Matrix3<f64>,
}

/// Kinds of inertia of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Exact,
    Legacy,
    Shell,
}

/// Reads the meshes of `<asset>`; their files are relative to the folder of the model.
///
/// Files outside the folder are not read unless the options allow it.
pub(super) fn read(reader: &Reader<'_>, root: &Element, model: &Path) -> Meshes {
    let mut meshes = Meshes::new();
    let mut bytes_left = MOST_BYTES;
    for asset in root.all("asset") {
        for element in asset.all("mesh") {
            let whole = reader.defaults.apply(reader.files, element, MAIN);
            let stem = |file: &str| {
                let stem = Path::new(file).file_stem().unwrap_or_default();
                stem.to_string_lossy().into_owned()
            };
            let own = whole.get("name").map(str::to_owned);
            let name = own.or_else(|| whole.get("file").map(stem));
            let mesh = mesh(reader, &whole, model, &mut bytes_left);
            meshes.insert(name.unwrap_or_default(), mesh);
        }
    }
    meshes
}

fn mesh(reader: &Reader<'_>, element: &Element, model: &Path, bytes_left: &mut u64) -> Mesh {
    let files = reader.files;
    let kinds = ["convex", "exact", "legacy", "shell"];
    let kind = match element.keyword(files, "inertia", &kinds) {
        Some("exact") => Kind::Exact,
        Some("shell") => Kind::Shell,
        Some("convex") => return Err("the inertia of its convex hull is not computed".to_owned()),
        _ => Kind::Legacy,
    };
    if element.get("builtin").is_some() {
        return Err("built-in meshes are not computed".to_owned());
    }
    let triangles = match element.get("file") {
        Some(file) => {
            let folder = model.parent().unwrap_or(Path::new(""));
            let path = located(&reader.compiler, folder, file);
            if !reader.options.include_outside && !is_beside(model, &path) {
                return Err(format!(
                    "its file `{}` is outside the folder of the model and is not read (`--include-outside` allows it)",
                    path.display()
                ));
            }
            from_file(&path, bytes_left)?
        }
        None => inline(files, element).ok_or("it has no file, and no faces")?,
    };
    let triangles = transformed(files, element, triangles);
    integrals(&triangles, kind).ok_or_else(|| "its volume is not positive".to_owned())
}

/// Path of a mesh file.
fn located(compiler: &Compiler, folder: &Path, file: &str) -> PathBuf {
    let file = if compiler.strips_paths {
        Path::new(file).file_name().map(Path::new)
    } else {
        None
    }
    .unwrap_or(Path::new(file));
    folder.join(&compiler.mesh_folder).join(file)
}

/// A triangle; its corners are counterclockwise seen from outside.
type Triangle = [Vector3<f64>; 3];

fn from_file(path: &Path, bytes_left: &mut u64) -> Result<Vec<Triangle>, String> {
    let name = path.display();
    let found = std::fs::metadata(path).ok().filter(|found| found.is_file());
    let Some(size) = found.map(|found| found.len()) else {
        return Err(format!("its file `{name}` is not found"));
    };
    if size > *bytes_left {
        return Err(format!("its file `{name}` is too large"));
    }
    *bytes_left -= size;
    let bytes = std::fs::read(path).map_err(|error| format!("`{name}` can't be read: {error}"))?;
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    let triangles = match ending.to_str() {
        Some("stl") => binary_stl(&bytes),
        Some("obj") => obj(&String::from_utf8_lossy(&bytes)),
        _ => return Err(format!("`{name}` is neither STL nor OBJ")),
    };
    triangles.ok_or_else(|| format!("`{name}` is not a valid binary STL or OBJ file"))
}

/// Triangles of a binary STL file.
fn binary_stl(bytes: &[u8]) -> Option<Vec<Triangle>> {
    let count = u32::from_le_bytes(bytes.get(80..84)?.try_into().ok()?);
    let body = bytes.get(84..)?;
    if body.len() as u64 != 50 * u64::from(count) {
        return None;
    }
    let number = |at: &[u8]| {
        let value = f64::from(f32::from_le_bytes(at.try_into().ok()?));
        value.is_finite().then_some(value)
    };
    let corner = |at: &[u8]| {
        let mut own = at.chunks_exact(4).map(number);
        Some(Vector3::new(own.next()??, own.next()??, own.next()??))
    };
    let triangle = |facet: &[u8]| {
        let mut own = facet[12..48].chunks_exact(12).map(corner);
        Some([own.next()??, own.next()??, own.next()??])
    };
    body.chunks_exact(50).map(triangle).collect()
}

/// Triangles of an OBJ file; polygons are split at their first corner.
fn obj(text: &str) -> Option<Vec<Triangle>> {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let own: Vec<f64> = numbers(&words.take(3).collect::<Vec<_>>().join(" "))?;
                let own: [f64; 3] = own.try_into().ok()?;
                corners.push(Vector3::from(own));
            }
            Some("f") => {
                let index = |word: &str| {
                    let first = word.split('/').next()?;
                    match first.parse::<i64>().ok()? {
                        at @ 1.. => usize::try_from(at).ok()?.checked_sub(1),
                        at => corners.len().checked_sub(usize::try_from(-at).ok()?),
                    }
                };
                let face = words.map(index).collect::<Option<Vec<usize>>>()?;
                let corner = |at: usize| corners.get(face[at]).copied();
                for at in 2..face.len() {
                    triangles.push([corner(0)?, corner(at - 1)?, corner(at)?]);
                }
            }
            _ => {}
        }
    }
    Some(triangles)
}

/// Triangles of `vertex` and `face`.
fn inline(files: &Files, element: &Element) -> Option<Vec<Triangle>> {
    let corners = element.list(files, "vertex")?;
    let faces = element.list(files, "face")?;
    let corner = |at: &f64| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let at = 3 * (*at as usize);
        let own = corners.get(at..at + 3)?;
        Some(Vector3::new(own[0], own[1], own[2]))
    };
    let triangle = |own: &[f64]| Some([corner(&own[0])?, corner(&own[1])?, corner(&own[2])?]);
    let all: Option<Vec<_>> = faces.chunks_exact(3).map(triangle).collect();
    all.filter(|all| !all.is_empty())
}

/// Applies `refpos`, `refquat` and `scale`; a mirrored mesh keeps its outside.
fn transformed(files: &Files, element: &Element, triangles: Vec<Triangle>) -> Vec<Triangle> {
    let origin = Vector3::from(element.numbers(files, "refpos").unwrap_or([0.0; 3]));
    let turn = element
        .numbers(files, "refquat")
        .and_then(exact::quaternion);
    let turn = turn.unwrap_or_default().inverse();
    let scale = Vector3::from(element.numbers(files, "scale").unwrap_or([1.0; 3]));
    let is_mirrored = scale.iter().product::<f64>() < 0.0;
    let moved = |triangle: Triangle| {
        let [a, b, c] = triangle.map(|own| (turn * (own - origin)).component_mul(&scale));
        if is_mirrored { [a, c, b] } else { [a, b, c] }
    };
    triangles.into_iter().map(moved).collect()
}

/// Integrals of a mesh; `None` if its volume or area is not positive.
fn integrals(triangles: &[Triangle], kind: Kind) -> Option<Integrals> {
    let area = |[a, b, c]: &Triangle| 0.5 * (b - a).cross(&(c - a)).norm();
    let middle = |[a, b, c]: &Triangle| (a + b + c) / 3.0;
    let surface: f64 = triangles.iter().map(area).sum();
    let weighted = triangles.iter().map(|own| middle(own) * area(own));
    let centre = weighted.sum::<Vector3<f64>>() / surface;
    if kind == Kind::Shell {
        let second = second_moment(triangles, &centre, |own| area(own) / 12.0);
        return Integrals::new(surface, centre, &second);
    }
    let volume = |from: &Vector3<f64>, own: &Triangle| {
        let [a, b, c] = own.map(|corner| corner - from);
        let signed = a.dot(&b.cross(&c)) / 6.0;
        if kind == Kind::Legacy {
            signed.abs()
        } else {
            signed
        }
    };
    let sum: f64 = triangles.iter().map(|own| volume(&centre, own)).sum();
    let moments = triangles.iter().map(|own| {
        let [a, b, c] = own.map(|corner| corner - centre);
        (a + b + c) * (0.25 * volume(&centre, own))
    });
    let centre = centre + moments.sum::<Vector3<f64>>() / sum;
    // Without signs the sum depends on the common corner; MuJoCo's is that about the centre.
    let size = triangles.iter().map(|own| volume(&centre, own)).sum();
    let second = second_moment(triangles, &centre, |own| volume(&centre, own) / 20.0);
    Integrals::new(size, centre, &second)
}

/// Sum of weight · (Σ v vᵀ + s sᵀ) over triangles with corners v about a point, and s = Σ v.
fn second_moment(
    triangles: &[Triangle],
    about: &Vector3<f64>,
    weight: impl Fn(&Triangle) -> f64,
) -> Matrix3<f64> {
    let one = |triangle: &Triangle| {
        let corners = triangle.map(|corner| corner - about);
        let sum: Vector3<f64> = corners.iter().sum();
        let squares: Matrix3<f64> = corners.iter().map(|own| own * own.transpose()).sum();
        (squares + sum * sum.transpose()) * weight(triangle)
    };
    triangles.iter().map(one).sum()
}

impl Integrals {
    fn new(size: f64, centre: Vector3<f64>, second: &Matrix3<f64>) -> Option<Self> {
        let inertia = Matrix3::identity() * second.trace() - second;
        let is_finite = inertia
            .iter()
            .chain(centre.iter())
            .all(|own| own.is_finite());
        (size > 0.0 && is_finite).then_some(Self {
            size,
            centre,
            inertia,
        })
    }
}
