//! The binary part of a file: numbers, and what they are.

use std::collections::BTreeMap;

use serde_json::{json, Value};

/// Triangles with the normals of their corners; corners that are alike are one.
#[derive(Clone, Debug, Default)]
pub(super) struct Surface {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    indices: Vec<u32>,
    known: BTreeMap<[u32; 6], u32>,
}

impl Surface {
    pub(super) fn corner(&mut self, position: [f32; 3], normal: [f32; 3]) {
        let [a, b, c] = position.map(f32::to_bits);
        let [d, e, f] = normal.map(f32::to_bits);
        let next = self.positions.len() as u32;
        let index = *self.known.entry([a, b, c, d, e, f]).or_insert(next);
        if index == next {
            self.positions.push(position);
            self.normals.push(normal);
        }
        self.indices.push(index);
    }
}

/// The buffer with its views and accessors.
#[derive(Debug, Default)]
pub(super) struct Buffer {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

/// Numbers of glTF: kinds of component, and what views are for.
const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

impl Buffer {
    /// The accessors of positions, normals and indices.
    pub(super) fn surface(&mut self, surface: &Surface) -> [usize; 3] {
        let mut low = [f32::INFINITY; 3];
        let mut high = [f32::NEG_INFINITY; 3];
        for p in &surface.positions {
            for k in 0..3 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let vectors = |all: &[[f32; 3]]| -> Vec<u8> {
            all.iter().flatten().flat_map(|x| x.to_le_bytes()).collect()
        };
        let positions = self.accessor(
            &vectors(&surface.positions),
            VERTICES,
            json!({
                "componentType": FLOAT, "type": "VEC3", "count": surface.positions.len(),
                "min": low, "max": high,
            }),
        );
        let normals = self.accessor(
            &vectors(&surface.normals),
            VERTICES,
            json!({ "componentType": FLOAT, "type": "VEC3", "count": surface.normals.len() }),
        );
        let indices: Vec<u8> = surface
            .indices
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let indices = self.accessor(
            &indices,
            INDICES,
            json!({ "componentType": UNSIGNED, "type": "SCALAR", "count": surface.indices.len() }),
        );
        [positions, normals, indices]
    }

    fn accessor(&mut self, bytes: &[u8], target: u32, mut accessor: Value) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target,
        }));
        self.bytes.extend(bytes);
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}
