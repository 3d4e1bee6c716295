//! MTL, the material library of OBJ.

use crate::folder::Folder;
use crate::model::{Material, Texture};
use crate::notes::Notes;
use crate::number::{parse_f64, push_f64};
use crate::text::normalized;

/// Libraries larger than this are not loaded.
const MAX_BYTES: u64 = 64 << 20;

/// Reads every library that the folder has. What is missing or broken there costs looks, not the mesh: it is noted.
pub(super) fn load<'a>(
    references: impl Iterator<Item = &'a String>,
    folder: &Folder,
    notes: &mut Notes,
) -> Vec<Material> {
    let mut materials = vec![];
    let mut seen: Vec<&str> = vec![];
    for reference in references {
        // Names may hold blanks, and one statement may list several files: the whole is tried first.
        let whole = [reference.as_str()];
        let parts: Vec<&str> =
            if folder.find(reference).is_ok() { whole.to_vec() } else { reference.split_whitespace().collect() };
        for part in parts {
            if seen.contains(&part) {
                continue;
            }
            seen.push(part);
            let found = folder.find(part).and_then(|path| {
                let small = path.metadata().is_ok_and(|m| m.len() <= MAX_BYTES);
                let bytes = small.then(|| std::fs::read(&path).ok()).flatten();
                bytes.ok_or("the file cannot be read")
            });
            match found {
                Ok(bytes) => parse(&bytes, folder, &mut materials),
                Err(reason) => notes.add(&format!("material libraries not loaded ({reason})"), 1, None),
            }
        }
    }
    materials
}

fn parse(bytes: &[u8], folder: &Folder, materials: &mut Vec<Material>) {
    for line in normalized(bytes).split(|&b| b == b'\n') {
        let line = line.trim_ascii();
        let keyword = line.split(u8::is_ascii_whitespace).next().unwrap_or_default();
        let rest = line[keyword.len()..].trim_ascii();
        if keyword == b"newmtl" {
            let name = String::from_utf8_lossy(rest).into_owned();
            materials.push(Material { name, ..Material::default() });
            continue;
        }
        let Some(material) = materials.last_mut() else { continue };
        let mut numbers = rest.split(u8::is_ascii_whitespace).filter(|t| !t.is_empty()).map(parse_f64);
        let mut share = || numbers.next().flatten().filter(|x| x.is_finite()).map(|x| x.clamp(0.0, 1.0));
        match keyword {
            b"Kd" => {
                if let Some(r) = share() {
                    let g = share();
                    let b = share();
                    material.base_color[..3].copy_from_slice(&[r, g.unwrap_or(r), b.unwrap_or(r)]);
                }
            }
            b"d" => material.base_color[3] = share().unwrap_or(1.0),
            b"Tr" => material.base_color[3] = 1.0 - share().unwrap_or(0.0),
            b"Pm" => material.metallic = share().unwrap_or(0.0),
            b"Pr" => material.roughness = share().unwrap_or(1.0),
            b"map_Kd" => {
                let name = picture_name(&String::from_utf8_lossy(rest));
                let source = folder.texture(&name);
                material.texture = (!name.is_empty()).then_some(Texture { name, source });
            }
            _ => {}
        }
    }
}

/// The file name behind a texture statement's options.
fn picture_name(statement: &str) -> String {
    let mut words: Vec<&str> = statement.split_whitespace().collect();
    if !statement.starts_with('-') {
        return statement.to_owned();
    }
    while let Some(option) = words.first().filter(|w| w.starts_with('-')) {
        let most = match *option {
            "-o" | "-s" | "-t" => 3,
            "-mm" => 2,
            _ => 1,
        };
        // Triples may be cut short after the first number.
        let numeric = words[1..].iter().take(most).take_while(|w| parse_f64(w.as_bytes()).is_some()).count();
        let values = if most == 1 { 1 } else { numeric };
        words.drain(..(1 + values).min(words.len()));
    }
    words.join(" ")
}

/// A library of `materials` whose pictures are called `pictures[i]` beside it.
pub(super) fn encode(materials: &[Material], names: &[String], pictures: &[Option<String>]) -> Vec<u8> {
    let mut out = vec![];
    for ((material, name), picture) in materials.iter().zip(names).zip(pictures) {
        if name.is_empty() {
            continue;
        }
        out.extend_from_slice(b"newmtl ");
        out.extend_from_slice(name.as_bytes());
        let [r, g, b, a] = material.base_color;
        for (keyword, values) in
            [("Kd", &[r, g, b][..]), ("d", &[a]), ("Pm", &[material.metallic]), ("Pr", &[material.roughness])]
        {
            out.push(b'\n');
            out.extend_from_slice(keyword.as_bytes());
            for &x in values {
                out.push(b' ');
                push_f64(&mut out, x);
            }
        }
        if let Some(picture) = picture {
            out.extend_from_slice(b"\nmap_Kd ");
            out.extend_from_slice(picture.as_bytes());
        }
        out.extend_from_slice(b"\n\n");
    }
    out
}
