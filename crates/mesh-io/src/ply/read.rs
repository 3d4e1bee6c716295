//! Reads the body of a PLY file.

use super::body::{BinaryBody, Body, TextBody};
use super::header::{Element, Encoding, Header, Property, Scalar, parse};
use crate::error::{Fault, Spot};
use crate::folder::Folder;
use crate::model::{Material, Materials, Model, Texture};
use crate::notes::Notes;
use crate::soup::Soup;
use crate::text::{Cursor, normalized};
use glam::DVec3;
use mesh_core::FaceMap;

/// Reads any PLY file with a vertex element. Vertices keep their order and number. O(n).
pub(crate) fn read(bytes: &[u8], folder: &Folder, notes: &mut Notes) -> Result<Model, Fault> {
    let header = parse(bytes)?;
    let body = &bytes[header.end..];
    match header.encoding {
        Encoding::Text => {
            let text = normalized(body);
            read_body(&header, &mut TextBody { cursor: Cursor::new(&text, header.end) }, folder, notes)
        }
        Encoding::LittleEndian | Encoding::BigEndian => {
            let big_endian = header.encoding == Encoding::BigEndian;
            read_body(&header, &mut BinaryBody { bytes, at: header.end, big_endian }, folder, notes)
        }
    }
}

/// Everything a body gives that a model can hold.
#[derive(Default)]
struct Contents {
    soup: Soup,
    sizes: Vec<u32>,
    spots: Vec<Spot>,
    normals: Vec<DVec3>,
    uvs: Vec<[f64; 2]>,
    colors: Vec<[f64; 4]>,
    /// Texture coordinates of face corners; empty, or as long as the soup's corners.
    corner_uvs: Vec<[f64; 2]>,
    face_colors: Vec<[f64; 4]>,
}

fn read_body<B: Body>(header: &Header, body: &mut B, folder: &Folder, notes: &mut Notes) -> Result<Model, Fault> {
    let mut contents = Contents::default();
    // Corners can only be checked once the vertices are known, which may come later.
    for element in &header.elements {
        let least: usize = element.properties.iter().map(|p| p.length.unwrap_or(p.item).size()).sum();
        if least == 0 || element.count == 0 {
            continue;
        }
        let room = body.room(Scalar::U8);
        let most = if header.encoding == Encoding::Text { room / element.properties.len() } else { room / least };
        if element.count > most {
            let Element { name, count, .. } = element;
            return Err(body.fault(format!("the header promises {count} `{name}` elements, at most {most} can follow")));
        }
        match element.name.as_str() {
            "vertex" => contents.vertices(element, body, notes)?,
            "face" => contents.faces(element, body, notes)?,
            "tristrips" => contents.strips(element, body, notes)?,
            name => {
                notes.add(&format!("`{name}` elements passed over"), element.count, Some(body.spot()));
                Contents::others(element, body, notes)?;
            }
        }
    }
    contents.into_model(header, folder, notes)
}

/// Column of each wanted property, or `None`.
fn columns<const N: usize>(element: &Element, names: [&[&str]; N]) -> [Option<usize>; N] {
    names.map(|alternatives| {
        let plain = |p: &Property| p.length.is_none() && alternatives.iter().any(|a| p.name.eq_ignore_ascii_case(a));
        element.properties.iter().position(plain)
    })
}

const COLORS: [&[&str]; 4] = [
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
];

/// Reads one row: plain numbers into `row`, lists handed to `list` with their property's index.
fn read_row<B: Body>(
    element: &Element,
    body: &mut B,
    row: &mut [f64],
    mut list: impl FnMut(usize, &mut B, usize) -> Result<(), Fault>,
) -> Result<(), Fault> {
    for (column, property) in element.properties.iter().enumerate() {
        match property.length {
            None => row[column] = body.scalar(property.item, &property.name)?,
            Some(length) => {
                let count = body.scalar(length, &property.name)?;
                let room = body.room(property.item);
                if !(count >= 0.0 && count.fract() == 0.0 && count <= room as f64) {
                    let name = &property.name;
                    return Err(body.fault(format!("a list `{name}` of {count} numbers; at most {room} can follow")));
                }
                list(column, body, count as usize)?;
            }
        }
    }
    Ok(())
}

fn skip_list<B: Body>(element: &Element, column: usize, body: &mut B, count: usize) -> Result<(), Fault> {
    let Property { item, name, .. } = &element.properties[column];
    (0..count).try_for_each(|_| body.scalar(*item, name).map(|_| ()))
}

impl Contents {
    fn vertices<B: Body>(&mut self, element: &Element, body: &mut B, notes: &mut Notes) -> Result<(), Fault> {
        let [Some(x), Some(y), Some(z)] = columns(element, [&["x"], &["y"], &["z"]]) else {
            return Err(body.fault("the vertices have no x, y and z".into()));
        };
        let normal = columns(element, [&["nx"], &["ny"], &["nz"]]);
        let uv = columns(element, [&["s", "u", "texture_u", "tex_u"], &["t", "v", "texture_v", "tex_v"]]);
        let color = columns(element, COLORS);
        let full = color.map(|c| c.map_or(1.0, |c| element.properties[c].item.full()));
        let mut row = vec![0.0; element.properties.len()];
        let before = self.soup.positions.len();
        // An element of vertices before this one may have had other attributes.
        if let [Some(_), Some(_), Some(_)] = normal {
            self.normals.resize(before, DVec3::NAN);
        }
        if let [Some(_), Some(_)] = uv {
            self.uvs.resize(before, [f64::NAN; 2]);
        }
        if let [Some(_), Some(_), Some(_), _] = color {
            self.colors.resize(before, [f64::NAN; 4]);
        }
        self.soup.positions.reserve(element.count);
        for index in 0..element.count {
            body.begin_row(element, index)?;
            let spot = body.spot();
            read_row(element, body, &mut row, |c, body, n| skip_list(element, c, body, n))?;
            body.end_row(notes);
            let p = DVec3::new(row[x], row[y], row[z]);
            if !p.is_finite() {
                let reason = format!("a coordinate of vertex {index} is not finite");
                return Err(Fault { at: Some(spot), reason });
            }
            self.soup.positions.push(p);
            if let [Some(x), Some(y), Some(z)] = normal {
                let n = DVec3::new(row[x], row[y], row[z]);
                self.normals.push(if n.is_finite() { n } else { DVec3::NAN });
            }
            if let [Some(u), Some(v)] = uv {
                let uv = [row[u], row[v]];
                self.uvs.push(if uv.iter().all(|x| x.is_finite()) { uv } else { [f64::NAN; 2] });
            }
            if let [Some(_), Some(_), Some(_), _] = color {
                self.colors.push(rgba(&row, color, full));
            }
        }
        Ok(())
    }

    fn faces<B: Body>(&mut self, element: &Element, body: &mut B, notes: &mut Notes) -> Result<(), Fault> {
        let named = |names: &[&str]| {
            element.properties.iter().position(|p| p.length.is_some() && names.contains(&p.name.as_str()))
        };
        let mut lists = element.properties.iter().enumerate().filter(|(_, p)| p.length.is_some());
        let corners = named(&["vertex_indices", "vertex_index"]).or(lists.next().map(|(i, _)| i));
        let texcoords = named(&["texcoord"]);
        let color = columns(element, COLORS);
        let full = color.map(|c| c.map_or(1.0, |c| element.properties[c].item.full()));
        if corners.is_none() {
            notes.add("faces without corners passed over", element.count, Some(body.spot()));
        }
        let mut row = vec![0.0; element.properties.len()];
        let mut uvs: Vec<f64> = vec![];
        for index in 0..element.count {
            body.begin_row(element, index)?;
            let spot = body.spot();
            uvs.clear();
            let soup = &mut self.soup;
            let first = soup.corners.len();
            read_row(element, body, &mut row, |column, body, count| {
                let Property { item, name, .. } = &element.properties[column];
                if Some(column) == corners {
                    for _ in 0..count {
                        soup.corners.push(vertex(body.scalar(*item, name)?, body)?);
                    }
                } else if Some(column) == texcoords {
                    for _ in 0..count {
                        uvs.push(body.scalar(*item, name)?);
                    }
                } else {
                    skip_list(element, column, body, count)?;
                }
                Ok(())
            })?;
            body.end_row(notes);
            if corners.is_none() {
                continue;
            }
            let size = self.soup.corners.len() - first;
            self.sizes.push(size as u32);
            self.spots.push(spot);
            if uvs.len() >= 2 * size && size > 0 {
                self.corner_uvs.resize(first, [f64::NAN; 2]);
                self.corner_uvs.extend(uvs[..2 * size].chunks_exact(2).map(|c| [c[0], c[1]]));
            }
            if let [Some(_), Some(_), Some(_), _] = color {
                self.face_colors.resize(self.sizes.len() - 1, [f64::NAN; 4]);
                self.face_colors.push(rgba(&row, color, full));
            }
        }
        Ok(())
    }

    /// Triangle strips: every further index makes a triangle with the two before it; −1 starts a new strip.
    fn strips<B: Body>(&mut self, element: &Element, body: &mut B, notes: &mut Notes) -> Result<(), Fault> {
        let mut row = vec![0.0; element.properties.len()];
        for index in 0..element.count {
            body.begin_row(element, index)?;
            let spot = body.spot();
            let (soup, sizes, spots) = (&mut self.soup, &mut self.sizes, &mut self.spots);
            read_row(element, body, &mut row, |column, body, count| {
                let Property { item, name, .. } = &element.properties[column];
                let (mut strip, mut odd) = ([None, None], false);
                for _ in 0..count {
                    let value = body.scalar(*item, name)?;
                    if value < 0.0 || value == f64::from(u32::MAX) {
                        (strip, odd) = ([None, None], false);
                        continue;
                    }
                    let c = vertex(value, body)?;
                    if let [Some(a), Some(b)] = strip {
                        soup.corners.extend(if odd { [b, a, c] } else { [a, b, c] });
                        sizes.push(3);
                        spots.push(spot);
                        odd = !odd;
                    }
                    strip = [strip[1], Some(c)];
                }
                Ok(())
            })?;
            body.end_row(notes);
        }
        Ok(())
    }

    fn others<B: Body>(element: &Element, body: &mut B, notes: &mut Notes) -> Result<(), Fault> {
        let mut row = vec![0.0; element.properties.len()];
        for index in 0..element.count {
            body.begin_row(element, index)?;
            read_row(element, body, &mut row, |c, body, n| skip_list(element, c, body, n))?;
            body.end_row(notes);
        }
        Ok(())
    }

    fn into_model(mut self, header: &Header, folder: &Folder, notes: &mut Notes) -> Result<Model, Fault> {
        let count = self.soup.positions.len();
        if let Some(corner) = self.soup.corners.iter().position(|&v| v as usize >= count) {
            let mut end = 0;
            let face = self.sizes.iter().position(|&n| {
                end += n as usize;
                corner < end
            });
            let reason = format!("a face names vertex {} of {count} (counted from 0)", self.soup.corners[corner]);
            return Err(Fault { at: face.map(|f| self.spots[f]), reason });
        }
        if !self.normals.is_empty() {
            self.normals.resize(count, DVec3::NAN);
        }
        if !self.uvs.is_empty() {
            self.uvs.resize(count, [f64::NAN; 2]);
        }
        if !self.colors.is_empty() {
            self.colors.resize(count, [f64::NAN; 4]);
        }
        if !self.corner_uvs.is_empty() {
            self.corner_uvs.resize(self.soup.corners.len(), [f64::NAN; 2]);
        }
        if !self.face_colors.is_empty() {
            self.face_colors.resize(self.sizes.len(), [f64::NAN; 4]);
        }
        self.soup.sizes = self.sizes.iter().any(|&n| n != 3).then_some(self.sizes);
        let cut = self.soup.triangulate(notes, |i| Some(self.spots[i]))?;
        let corners = cut.mesh.faces.as_flattened();
        let at_corners = |values: &[[f64; 2]]| corners.iter().map(|v| values[v.index()]).collect::<Vec<_>>();
        let uvs = if self.corner_uvs.is_empty() {
            (!self.uvs.is_empty()).then(|| at_corners(&self.uvs))
        } else {
            Some(cut.gather_corners(|i| self.corner_uvs[i]))
        };
        let normals =
            (!self.normals.is_empty()).then(|| corners.iter().map(|v| self.normals[v.index()]).collect::<Vec<_>>());
        let colors: Option<Vec<[f64; 4]>> = if !self.colors.is_empty() {
            notes.add("face colours not kept beside vertex colours", self.face_colors.len(), None);
            Some(corners.iter().map(|v| self.colors[v.index()]).collect())
        } else if self.face_colors.is_empty() {
            None
        } else {
            Some(cut.gather_faces(&self.face_colors).into_iter().flat_map(|c| [c; 3]).collect())
        };
        let materials = header.texture.as_ref().map(|name| {
            let texture = Texture { name: name.clone(), source: folder.texture(name) };
            let material = Material { name: "texture".into(), texture: Some(texture), ..Material::default() };
            Materials { of_face: FaceMap::filled(cut.mesh.faces.len(), 0), list: vec![material] }
        });
        Ok(Model {
            uvs: uvs.map(Into::into),
            normals: normals.map(Into::into),
            colors: colors.map(Into::into),
            materials,
            polygons: cut.polygons,
            mesh: cut.mesh,
            ..Model::default()
        })
    }
}

fn vertex<B: Body>(value: f64, body: &B) -> Result<u32, Fault> {
    let index = value as u32;
    if f64::from(index) == value && index < u32::MAX {
        return Ok(index);
    }
    Err(body.fault(format!("{value} is not a vertex number")))
}

fn rgba(row: &[f64], columns: [Option<usize>; 4], full: [f64; 4]) -> [f64; 4] {
    let component = |i: usize| columns[i].map_or(1.0, |c| row[c] / full[i]);
    let color = [component(0), component(1), component(2), component(3)];
    if color.iter().all(|x| x.is_finite()) { color } else { [f64::NAN; 4] }
}
