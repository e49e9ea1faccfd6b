//! Models of parks: files as the format has them, ground as large as the park,
//! solids that are seen from outside, objects where they stand.
#![cfg(feature = "gltf")]

mod common;

use park_grammar::scene::Ground;
use park_grammar::{gltf, library, Scene};
use serde_json::Value;

use common::{park_with_mesh, size};

const RULES: &str = "grammar 1
param Oak = Object(radius = 0.5, spread = 4 m, height = 14 m, colour = \"#8a9a3f\")
param Post = Object(radius = 0.2, height = 1)
param Stone = Object(radius = 1, mesh = \"stone.obj\")
Region -> Grid(2, 2) { Quarter } { Gravel } { Circle(4) Paving Fountain }
Quarter -> Place((0.3, 0.3)) { Circle(3) Water }
    Sweep(OUTER: 0.5) { Hedge } Distribute(INNER: 1, 6) { Bench } Scatter(20) { Tree | Oak | Stone | Post }
";

const STONE: &str = "v 1 0 0\nv -1 0 1\nv -1 0 -1\nv 0 1.5 0\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";

fn park(x: f64, y: f64) -> Scene {
    park_with_mesh(RULES, STONE, x, y)
}

/// A file taken apart.
struct Model {
    json: Value,
    bytes: Vec<u8>,
}

impl Model {
    /// Reads a file, and sees that its chunks fill it.
    fn read(file: &[u8]) -> Self {
        let word = |at: usize| {
            u32::from_le_bytes(file[at..at + 4].try_into().expect("four bytes")) as usize
        };
        assert_eq!(
            (&file[..4], word(4), word(8)),
            (&b"glTF"[..], 2, file.len())
        );
        let end = 20 + word(12);
        assert_eq!(&file[16..20], b"JSON");
        let json = serde_json::from_slice(&file[20..end]).expect("JSON");
        let bytes = if end < file.len() {
            assert_eq!(&file[end + 4..end + 8], b"BIN\0");
            assert_eq!(end + 8 + word(end), file.len());
            file[end + 8..].to_vec()
        } else {
            Vec::new()
        };
        assert_eq!(file.len() % 4, 0);
        Self { json, bytes }
    }

    fn list(&self, name: &str) -> &[Value] {
        self.json[name].as_array().map_or(&[], Vec::as_slice)
    }

    /// The four-byte numbers of an accessor, which must lie in its view, and that
    /// in the buffer.
    fn numbers(&self, accessor: &Value) -> Vec<[u8; 4]> {
        let accessor = &self.list("accessors")[count(accessor)];
        let view = &self.list("bufferViews")[count(&accessor["bufferView"])];
        let parts = if accessor["type"] == "VEC3" { 3 } else { 1 };
        let (start, length) = (count(&view["byteOffset"]), count(&view["byteLength"]));
        assert_eq!(length, 4 * parts * count(&accessor["count"]));
        assert!(start % 4 == 0 && start + length <= count(&self.json["buffers"][0]["byteLength"]));
        let bytes = self.bytes[start..start + length].chunks_exact(4);
        bytes.map(|c| c.try_into().expect("four bytes")).collect()
    }

    fn vectors(&self, accessor: &Value) -> Vec<[f64; 3]> {
        let numbers = self.numbers(accessor);
        let floats: Vec<f64> = numbers
            .into_iter()
            .map(|b| f64::from(f32::from_le_bytes(b)))
            .collect();
        floats.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
    }

    /// The triangles of a primitive, with the normals of their first corners.
    fn triangles(&self, primitive: &Value) -> Vec<([[f64; 3]; 3], [f64; 3])> {
        let positions = self.vectors(&primitive["attributes"]["POSITION"]);
        let normals = self.vectors(&primitive["attributes"]["NORMAL"]);
        assert_eq!(positions.len(), normals.len());
        let indices: Vec<usize> = self
            .numbers(&primitive["indices"])
            .into_iter()
            .map(|b| u32::from_le_bytes(b) as usize)
            .collect();
        let triangles = indices.chunks_exact(3);
        triangles
            .map(|t| ([0, 1, 2].map(|k| positions[t[k]]), normals[t[0]]))
            .collect()
    }

    fn mesh(&self, name: &str) -> &Value {
        let found = self.list("meshes").iter().find(|m| m["name"] == name);
        found.unwrap_or_else(|| panic!("a mesh of {name}"))
    }

    fn mesh_triangles(&self, name: &str) -> Vec<([[f64; 3]; 3], [f64; 3])> {
        let primitives = self.mesh(name)["primitives"].as_array();
        let primitives = primitives.expect("primitives").iter();
        primitives.flat_map(|p| self.triangles(p)).collect()
    }
}

fn count(value: &Value) -> usize {
    usize::try_from(value.as_u64().expect("a number")).expect("small")
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ]
}

fn dot(u: [f64; 3], v: [f64; 3]) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    cross(minus(b, a), minus(c, a))
}

#[test]
fn a_file_is_as_the_format_has_it() {
    let model = Model::read(&gltf::glb(&park(0.0, 0.0)));
    assert_eq!(model.json["asset"]["version"], "2.0");
    let nodes = model.list("nodes").len();
    let root = count(&model.json["scenes"][0]["nodes"][0]);
    let children = model.list("nodes")[root]["children"].as_array();
    let children = children.expect("children");
    assert_eq!(children.len(), nodes - 1);
    assert!(children
        .iter()
        .all(|k| count(k) < nodes && count(k) != root));
    for node in model.list("nodes").iter().filter(|n| n["name"] != "Park") {
        assert!(count(&node["mesh"]) < model.list("meshes").len());
    }
    for mesh in model.list("meshes") {
        for primitive in mesh["primitives"].as_array().expect("primitives") {
            assert!(count(&primitive["material"]) < model.list("materials").len());
            let accessor = &model.list("accessors")[count(&primitive["attributes"]["POSITION"])];
            let positions = model.vectors(&primitive["attributes"]["POSITION"]);
            for k in 0..3 {
                let all = positions.iter().map(|p| p[k]);
                let low = all.clone().fold(f64::INFINITY, f64::min);
                assert_eq!(accessor["min"][k].as_f64(), Some(low));
                assert_eq!(accessor["max"][k].as_f64(), Some(all.fold(-1e9, f64::max)));
            }
            for (triangle, given) in model.triangles(primitive) {
                let is = normal(triangle);
                let size = dot(is, is).sqrt();
                assert!((dot(given, given) - 1.0).abs() < 1e-5);
                assert!(dot(is, given) > 0.99 * size, "wound as its normal says");
            }
        }
    }
}

#[test]
fn the_ground_is_the_park() {
    let scene = park(0.0, 0.0);
    let model = Model::read(&gltf::glb(&scene));
    let mut area = 0.0;
    for (triangle, given) in model.mesh_triangles("Ground") {
        assert_eq!(given, [0.0, 1.0, 0.0]);
        area += 0.5 * normal(triangle)[1];
    }
    // Single precision: 7 digits of 40 m, along some hundred metres.
    assert!((area - 4800.0).abs() < 1e-2, "{area}");
    let names: Vec<&str> = model
        .list("materials")
        .iter()
        .filter_map(|m| m["name"].as_str())
        .collect();
    for name in ["Lawn", "Water", "Gravel", "Paving"] {
        assert!(names.contains(&name), "{name}");
    }
}

/// Footprints times heights: all walls and roofs look outwards.
#[test]
fn hedges_have_their_volume() {
    let scene = park(0.0, 0.0);
    let model = Model::read(&gltf::glb(&scene));
    let must: f64 = scene
        .volumes
        .iter()
        .map(|v| v.height * size(&v.polygon))
        .sum();
    // The floor is left out: from a point of it, it would add nothing.
    let is: f64 = model
        .mesh_triangles("Volumes")
        .iter()
        .map(|([a, b, c], _)| dot(*a, cross(*b, *c)) / 6.0)
        .sum();
    assert!(
        must > 1.0 && (is - must).abs() < 1e-3 * must,
        "{is} for {must}"
    );
}

#[test]
fn objects_stand_where_they_are_and_face_their_way() {
    let (x, y) = (4e5, 6.7e6);
    let scene = park(x, y);
    let model = Model::read(&gltf::glb(&scene));
    let origin = &model
        .list("nodes")
        .iter()
        .find(|n| n["name"] == "Park")
        .expect("a root")["extras"]["origin_m"];
    assert_eq!(origin, &serde_json::json!([x + 40.0, y + 30.0]));
    let nodes = model
        .list("nodes")
        .iter()
        .filter(|n| n["translation"].is_array());
    let nodes: Vec<&Value> = nodes.collect();
    assert_eq!(nodes.len(), scene.objects.len());
    for (object, node) in scene.objects.iter().zip(nodes) {
        assert_eq!(node["name"], object.name.as_str());
        let at = |k: usize| node["translation"][k].as_f64().expect("a number");
        assert!((at(0) - (object.at.x - x - 40.0)).abs() < 1e-3);
        assert!((at(2) + (object.at.y - y - 30.0)).abs() < 1e-3 && at(1) == 0.0);
        // East turned by the quaternion (0, s, 0, c).
        let part = |k: usize| node["rotation"][k].as_f64();
        let (s, c) = (part(1).unwrap_or(0.0), part(3).unwrap_or(1.0));
        let east = [1.0 - 2.0 * s * s, -2.0 * s * c];
        let must = [object.facing.cos(), -object.facing.sin()];
        assert!((east[0] - must[0]).abs() < 1e-5 && (east[1] - must[1]).abs() < 1e-5);
    }
}

/// Every thing of the library has a shape of its own, as wide and as high as it
/// says, and to be seen from outside.
#[test]
fn things_are_solid() {
    for thing in &library::THINGS {
        let mut scene = park(0.0, 0.0);
        scene.volumes.clear();
        scene.objects.truncate(1);
        let object = &mut scene.objects[0];
        object.name = thing.name.to_owned();
        (object.radius, object.spread, object.height) = (thing.radius, thing.spread, thing.height);
        object.ground = Ground::Region;
        let model = Model::read(&gltf::glb(&scene));
        let triangles = model.mesh_triangles(thing.name);
        let points = || triangles.iter().flat_map(|(t, _)| t);
        let high = points().map(|p| p[1]).fold(0.0, f64::max);
        let wide = points().map(|p| p[0].hypot(p[2])).fold(0.0, f64::max);
        let most = thing.height.max(0.15) * 1.02;
        assert!(
            high <= most && high >= 0.9 * thing.height,
            "{} is {high} high",
            thing.name
        );
        assert!(
            wide <= 1.08 * thing.spread && wide > 0.5 * thing.spread,
            "{} is {wide} wide",
            thing.name
        );
        assert!(
            points().all(|p| p[1] >= 0.0),
            "{} is below ground",
            thing.name
        );
        let volume: f64 = triangles
            .iter()
            .map(|([a, b, c], _)| dot(*a, cross(*b, *c)) / 6.0)
            .sum();
        assert!(volume > 0.0, "{}: {volume}", thing.name);
        assert!(
            triangles.len() > 20 && triangles.len() < 600,
            "{}",
            thing.name
        );
    }
}

#[test]
fn own_kinds_have_their_meshes() {
    let model = Model::read(&gltf::glb(&park(0.0, 0.0)));
    let stone = model.mesh_triangles("Stone");
    assert_eq!(stone.len(), 3);
    let high = stone
        .iter()
        .flat_map(|(t, _)| t)
        .map(|p| p[1])
        .fold(0.0, f64::max);
    assert_eq!(high, 1.5);
    let material = &model.mesh("Stone")["primitives"][0]["material"];
    assert_eq!(
        model.list("materials")[count(material)]["doubleSided"],
        true
    );
    assert!(model.mesh_triangles("Oak").len() > 100 && model.mesh_triangles("Post").len() > 20);
}

#[test]
fn the_same_park_is_the_same_file() {
    assert!(gltf::glb(&park(0.0, 0.0)) == gltf::glb(&park(0.0, 0.0)));
}

#[test]
fn nothing_is_a_file_too() {
    let model = Model::read(&gltf::glb(&Scene::default()));
    assert!(model.bytes.is_empty() && model.list("meshes").is_empty());
    assert!(model.json.get("buffers").is_none());
    assert!(model.list("nodes")[0].get("children").is_none());
}
