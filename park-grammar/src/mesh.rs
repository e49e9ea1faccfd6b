//! Triangles of an object, read from a Wavefront OBJ file.
//!
//! Of the format vertices (`v x y z`) and faces (`f 1 2 3`, with `/` before what
//! else a corner has, and negative numbers counting from the last vertex) are
//! read; faces of more corners are cut into triangles. All else is passed by.
//! Coordinates are metres, y up, as most programs write them.

/// A surface of triangles, y up.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mesh {
    /// Positions, metres.
    pub vertices: Vec<[f64; 3]>,
    /// Vertices of each triangle, counter-clockwise from outside.
    pub triangles: Vec<[usize; 3]>,
}

/// Why a file is no mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct MeshError {
    /// Which line, from 1; the last where the whole file is meant.
    pub line: usize,
    /// What is wrong with it.
    pub what: String,
}

impl Mesh {
    /// Reads the text of an OBJ file.
    ///
    /// # Errors
    ///
    /// [`MeshError`] for a vertex that is no three finite numbers, a face with
    /// fewer than three corners or with a corner that no vertex has been given
    /// for, and a file without faces.
    ///
    /// # Examples
    ///
    /// ```
    /// use park_grammar::mesh::Mesh;
    ///
    /// let mesh = Mesh::from_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4")?;
    /// assert_eq!(mesh.triangles.len(), 2);
    /// let error = Mesh::from_obj("v 0 0 0\nf 1 2 3").unwrap_err();
    /// assert_eq!(error.to_string(), "line 2: there is no vertex 2");
    /// # Ok::<(), park_grammar::mesh::MeshError>(())
    /// ```
    pub fn from_obj(text: &str) -> Result<Self, MeshError> {
        let mut mesh = Self::default();
        let mut lines = 0;
        for (k, line) in text.lines().enumerate() {
            lines = k + 1;
            let bad = |what: String| MeshError { line: k + 1, what };
            let line = line.split('#').next().unwrap_or_default();
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => {
                    let numbers: Vec<f64> = words
                        .map_while(|word| word.parse().ok())
                        .filter(|x: &f64| x.is_finite())
                        .collect();
                    let [x, y, z, ..] = numbers[..] else {
                        return Err(bad("a vertex has three numbers".to_owned()));
                    };
                    mesh.vertices.push([x, y, z]);
                }
                Some("f") => {
                    let corners: Result<Vec<usize>, MeshError> =
                        words.map(|word| mesh.corner(word).map_err(&bad)).collect();
                    let corners = corners?;
                    if corners.len() < 3 {
                        return Err(bad("a face has three corners or more".to_owned()));
                    }
                    mesh.face(corners);
                }
                _ => {}
            }
        }
        if mesh.triangles.is_empty() {
            return Err(MeshError {
                line: lines.max(1),
                what: "the file ends without a face".to_owned(),
            });
        }
        Ok(mesh)
    }

    /// The vertex that a corner of a face names.
    fn corner(&self, word: &str) -> Result<usize, String> {
        let number = word.split('/').next().unwrap_or_default();
        let number: i64 = number
            .parse()
            .map_err(|_| format!("{word} is no corner of a face"))?;
        let count = self.vertices.len();
        let index = if number < 0 {
            usize::try_from(number.unsigned_abs())
                .ok()
                .and_then(|back| count.checked_sub(back))
        } else {
            usize::try_from(number)
                .ok()
                .and_then(|n| n.checked_sub(1))
                .filter(|&k| k < count)
        };
        index.ok_or_else(|| format!("there is no vertex {number}"))
    }

    /// Cuts a face into triangles: ears that hold no other corner, in the plane
    /// of the face (Meisters 1975).
    fn face(&mut self, mut corners: Vec<usize>) {
        let at = |k: usize| self.vertices[k];
        // Newell's normal.
        let mut normal = [0.0; 3];
        for (k, &a) in corners.iter().enumerate() {
            let (p, q) = (at(a), at(corners[(k + 1) % corners.len()]));
            for (axis, n) in normal.iter_mut().enumerate() {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                *n += (p[u] - q[u]) * (p[v] + q[v]);
            }
        }
        let turn = |a: usize, b: usize, c: usize| {
            let (p, q, r) = (at(a), at(b), at(c));
            let side = |axis: usize| {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                (q[u] - p[u]) * (r[v] - p[v]) - (q[v] - p[v]) * (r[u] - p[u])
            };
            (0..3).map(|axis| side(axis) * normal[axis]).sum::<f64>()
        };
        let mut triangles = Vec::new();
        while corners.len() > 3 {
            let n = corners.len();
            let ear = (0..n).find(|&k| {
                let (a, b, c) = (corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]);
                let others = corners.iter().filter(|&&d| d != a && d != b && d != c);
                let inside =
                    |d: usize| turn(a, b, d) >= 0.0 && turn(b, c, d) >= 0.0 && turn(c, a, d) >= 0.0;
                turn(a, b, c) > 0.0 && !others.copied().any(inside)
            });
            // A face that crosses itself has no ear: any corner will do.
            let k = ear.unwrap_or(0);
            triangles.push([corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]]);
            corners.remove(k);
        }
        if let [a, b, c] = corners[..] {
            triangles.push([a, b, c]);
        }
        self.triangles.extend(triangles);
    }

    /// How far it reaches from its upright axis.
    #[must_use]
    pub fn radius(&self) -> f64 {
        let reach = |v: &[f64; 3]| v[0].hypot(v[2]);
        self.vertices.iter().map(reach).fold(0.0, f64::max)
    }

    /// How high it rises above the ground.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.vertices.iter().map(|v| v[1]).fold(0.0, f64::max)
    }

    /// So many times as large.
    #[must_use]
    pub fn scaled(mut self, by: f64) -> Self {
        self.vertices.iter_mut().flatten().for_each(|x| *x *= by);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_are_cut_into_triangles() {
        let arrow = "v 0 0 0 # tip\nv 2 0 2\nv 0 0 1\nv -2 0 2\nvn 0 1 0\nf -4/1/1 -3//1 -2 -1\n";
        let mesh = Mesh::from_obj(arrow).expect("reads");
        // The corner that is pushed in is no ear.
        let mut all = mesh.triangles.clone();
        for triangle in &mut all {
            triangle.sort_unstable();
        }
        all.sort_unstable();
        assert_eq!(all, [[0, 1, 2], [0, 2, 3]]);
        assert!((mesh.radius() - 8_f64.sqrt()).abs() < 1e-12);
        assert_eq!(mesh.scaled(2.0).vertices[1], [4.0, 0.0, 4.0]);
    }

    #[test]
    fn faults_have_lines() {
        let error = |text: &str| Mesh::from_obj(text).expect_err("a fault").to_string();
        assert_eq!(error("v 0 0\n"), "line 1: a vertex has three numbers");
        assert_eq!(
            error("v 0 0 0\n\nf 1 1\n"),
            "line 3: a face has three corners or more"
        );
        assert_eq!(
            error("v 0 0 0\nf 1 -2 1\n"),
            "line 2: there is no vertex -2"
        );
        assert_eq!(error("v 0 0 0\nf 0 1 1\n"), "line 2: there is no vertex 0");
        assert_eq!(error("f a b c"), "line 1: a is no corner of a face");
        assert_eq!(error("v 0 0 0\n"), "line 1: the file ends without a face");
        assert_eq!(
            error("f 9223372036854775807 -9223372036854775808 1"),
            "line 1: there is no vertex 9223372036854775807"
        );
    }
}
