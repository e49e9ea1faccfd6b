//! Parks as models: glTF 2.0, to be walked through.
//!
//! [`glb`] writes a scene as one binary file. Metres, y up, x to the east and z to
//! the south, around the middle of the park; where that lies stands in the `extras`
//! of the root node as `origin_m`. Ground is a mesh with a primitive for each
//! material; hedges and walls are a mesh for each kind; each kind of object is a
//! mesh of its own, and each object a node with its place and turn. A grammar's own
//! kind has the mesh that it brought.

mod buffer;
mod ground;
mod model;
mod solid;

use std::collections::BTreeMap;

use geo_types::Coord;
use serde_json::{json, Map, Value};

use crate::library;
use crate::scene::{Kind, Object, Scene};
use buffer::Buffer;
use solid::Solid;

/// The colour of what the library does not know.
const PLAIN: &str = "#9a958a";

/// The scene as a binary glTF file.
///
/// # Examples
///
/// ```
/// use park_grammar::geo_types::polygon;
/// use park_grammar::{gltf, DeriveOptions, Grammar};
///
/// let square = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 40.), (x: 0., y: 40.)];
/// let grammar = Grammar::new("grammar 1\nRegion -> Lawn Scatter(9) { Tree } Sweep(ALL) { Hedge }")?;
/// let park = grammar.derive(&square, &DeriveOptions::default())?;
/// let file = gltf::glb(&park);
/// assert!(file.starts_with(b"glTF\x02\0\0\0"));
/// # Ok::<(), park_grammar::ParkError>(())
/// ```
#[must_use]
pub fn glb(scene: &Scene) -> Vec<u8> {
    let (low, high) = scene.extent();
    let origin = (low + high) / 2.0;
    let mut document = Document::default();
    let mut children = Vec::new();
    let solids = [
        ("Ground", ground::ground(scene, origin)),
        ("Volumes", ground::volumes(scene, origin)),
    ];
    for (name, solid) in solids {
        if let Some(mesh) = document.mesh(name, &solid) {
            children.push(document.node(json!({ "name": name, "mesh": mesh })));
        }
    }
    let mut meshes: BTreeMap<&str, Option<usize>> = BTreeMap::new();
    for object in &scene.objects {
        let mesh = *meshes
            .entry(&object.name)
            .or_insert_with(|| document.mesh(&object.name, &shape(scene, object)));
        if let Some(mesh) = mesh {
            children.push(document.node(pose(object, origin, mesh)));
        }
    }
    let mut root = json!({ "name": "Park", "extras": { "origin_m": [origin.x, origin.y] } });
    if !children.is_empty() {
        root["children"] = json!(children);
    }
    let root = document.node(root);
    document.finish(root)
}

/// The shape of an object: the mesh of its kind, or one made for what it is.
fn shape(scene: &Scene, object: &Object) -> Solid {
    let kind = scene.kinds.iter().find(|kind| kind.name == object.name);
    match kind {
        Some(Kind {
            mesh: Some(mesh),
            colour,
            ..
        }) => Solid::of_mesh(mesh, colour),
        Some(kind) => model::unknown(object, &kind.colour),
        None => model::thing(object).unwrap_or_else(|| {
            let known = library::thing_named(&object.name).map(|t| t.colour);
            model::unknown(object, known.unwrap_or(PLAIN))
        }),
    }
}

fn pose(object: &Object, origin: Coord<f64>, mesh: usize) -> Value {
    let at = object.at - origin;
    // Millimetres, and turns as fine as that at ten metres.
    let fine = |x: f64, parts: f64| (x * parts).round() / parts;
    let [x, z] = [at.x, -at.y].map(|x| fine(x, 1e3));
    let mut node = json!({ "name": object.name, "mesh": mesh, "translation": [x, 0.0, z] });
    let half = object.facing / 2.0;
    let turn = [half.sin(), half.cos()].map(|x| fine(x, 1e7));
    if turn[0] != 0.0 {
        node["rotation"] = json!([0.0, turn[0], 0.0, turn[1]]);
    }
    node
}

/// The document as far as it is written.
#[derive(Debug, Default)]
struct Document {
    buffer: Buffer,
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    /// The number of each paint among the materials.
    paints: BTreeMap<solid::Paint, usize>,
}

impl Document {
    fn node(&mut self, node: Value) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// A mesh with a primitive for each colour; `None` if there is nothing of it.
    fn mesh(&mut self, name: &str, solid: &Solid) -> Option<usize> {
        let mut primitives = Vec::new();
        for (paint, surface) in solid.surfaces() {
            let material = self.material(&paint);
            let [positions, normals, indices] = self.buffer.surface(surface);
            primitives.push(json!({
                "attributes": { "POSITION": positions, "NORMAL": normals },
                "indices": indices,
                "material": material,
            }));
        }
        if primitives.is_empty() {
            return None;
        }
        self.meshes
            .push(json!({ "name": name, "primitives": primitives }));
        Some(self.meshes.len() - 1)
    }

    fn material(&mut self, paint: &solid::Paint) -> usize {
        if let Some(&known) = self.paints.get(paint) {
            return known;
        }
        let wet = paint.name == Some("Water");
        let [r, g, b] = linear(&paint.colour);
        let mut material = json!({
            "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": if wet { 0.1 } else { 0.95 },
            },
        });
        if let Some(name) = paint.name {
            material["name"] = json!(name);
        }
        if paint.thin {
            material["doubleSided"] = json!(true);
        }
        self.materials.push(material);
        let number = self.materials.len() - 1;
        self.paints.insert(paint.clone(), number);
        number
    }

    /// Header, JSON and buffer, each padded to four bytes.
    fn finish(self, root: usize) -> Vec<u8> {
        let mut all = Map::new();
        let generator = concat!("park-grammar ", env!("CARGO_PKG_VERSION"));
        all.insert(
            "asset".to_owned(),
            json!({ "version": "2.0", "generator": generator }),
        );
        all.insert("scene".to_owned(), json!(0));
        all.insert("scenes".to_owned(), json!([{ "nodes": [root] }]));
        // Lists may not be empty.
        let lists = [
            ("nodes", self.nodes),
            ("meshes", self.meshes),
            ("materials", self.materials),
            ("accessors", self.buffer.accessors),
            ("bufferViews", self.buffer.views),
        ];
        for (name, list) in lists {
            if !list.is_empty() {
                all.insert(name.to_owned(), Value::Array(list));
            }
        }
        let mut bytes = self.buffer.bytes;
        if !bytes.is_empty() {
            all.insert("buffers".to_owned(), json!([{ "byteLength": bytes.len() }]));
        }
        let mut text = Value::Object(all).to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let mut chunks = vec![(*b"JSON", text)];
        if !bytes.is_empty() {
            chunks.push((*b"BIN\0", bytes));
        }
        let whole = 12 + chunks.iter().map(|(_, data)| 8 + data.len()).sum::<usize>();
        let mut out = Vec::with_capacity(whole);
        let number = |out: &mut Vec<u8>, n: usize| {
            // A file of four gigabytes would hold a park of half a continent.
            out.extend(u32::try_from(n).unwrap_or(u32::MAX).to_le_bytes());
        };
        out.extend(b"glTF");
        number(&mut out, 2);
        number(&mut out, whole);
        for (kind, data) in chunks {
            number(&mut out, data.len());
            out.extend(kind);
            out.extend(data);
        }
        out
    }
}

/// A colour `#rrggbb` as shares of light, as glTF has them.
fn linear(colour: &str) -> [f64; 3] {
    crate::picture::parts(colour).map(|part| {
        let x = part / 255.0;
        let light = if x <= 0.04045 {
            x / 12.92
        } else {
            ((x + 0.055) / 1.055).powf(2.4)
        };
        (light * 1e5).round() / 1e5
    })
}
