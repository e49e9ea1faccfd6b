//! From separate rings to an exact tiling, or a refusal that says why not.

use crate::error::WarpError;
use crate::geometry::{norm, project, self_contact, signed_area, P};
use crate::hierarchy::Piece;
use crate::region::EdgeUse;
use std::collections::BTreeMap;

/// Names of points: equal coordinates have equal numbers.
struct Points {
    number: BTreeMap<(u64, u64), usize>,
}

fn bits(q: P) -> (u64, u64) {
    // Adding zero turns -0.0 into 0.0.
    ((q.x + 0.0).to_bits(), (q.y + 0.0).to_bits())
}

impl Points {
    fn id(&mut self, q: P) -> usize {
        let n = self.number.len();
        *self.number.entry(bits(q)).or_insert(n)
    }
}

/// Makes the rings share vertices: points closer than `near` become one (a
/// vertex of the region wins), and every point on an edge becomes a vertex of
/// it. Returns the region's ring with the added vertices, and its uses.
pub(crate) fn stitch(
    faces: &mut [Piece],
    region: &[P],
    uses: &[EdgeUse],
    near: f64,
) -> (Vec<P>, Vec<EdgeUse>) {
    // Distinct points, the region's first, sorted by x for the searches below.
    let mut seen = Points {
        number: BTreeMap::new(),
    };
    let mut all: Vec<P> = Vec::new();
    for &q in region
        .iter()
        .chain(faces.iter().flat_map(|f| f.ring.iter()))
    {
        if seen.id(q) == all.len() {
            all.push(q);
        }
    }
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|&i, &j| all[i].x.total_cmp(&all[j].x).then(i.cmp(&j)));
    let mut target: Vec<usize> = (0..all.len()).collect();
    for (k, &i) in order.iter().enumerate() {
        for &j in order[k + 1..]
            .iter()
            .take_while(|&&j| all[j].x - all[i].x <= near)
        {
            if (all[j].y - all[i].y).abs() <= near {
                // Lower numbers come first: the region's vertices never move.
                let (a, b) = (target[i].min(target[j]), target[i].max(target[j]));
                for t in &mut target {
                    if *t == b {
                        *t = a;
                    }
                }
            }
        }
    }
    for q in faces.iter_mut().flat_map(|f| f.ring.iter_mut()) {
        let k = seen.id(*q);
        *q = all[target[k]];
    }
    let mut kept: Vec<P> = (0..all.len())
        .filter(|&i| target[i] == i)
        .map(|i| all[i])
        .collect();
    kept.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));

    let refine = |a: P, b: P| -> Vec<P> {
        let (lo, hi) = (a.x.min(b.x) - near, a.x.max(b.x) + near);
        let start = kept.partition_point(|q| q.x < lo);
        let mut on: Vec<(f64, P)> = kept[start..]
            .iter()
            .take_while(|q| q.x <= hi)
            .filter(|&&q| q != a && q != b)
            .filter_map(|&q| {
                let (t, d2) = project(q, a, b);
                (d2 <= near * near && t > 0.0 && t < 1.0).then_some((t, q))
            })
            .collect();
        on.sort_by(|x, y| x.0.total_cmp(&y.0));
        on.into_iter().map(|e| e.1).collect()
    };
    for face in faces.iter_mut() {
        face.ring.dedup();
        while face.ring.len() > 1 && face.ring.first() == face.ring.last() {
            face.ring.pop();
        }
        let n = face.ring.len();
        let mut ring = Vec::with_capacity(n + 4);
        for i in 0..n {
            let (a, b) = (face.ring[i], face.ring[(i + 1) % n]);
            ring.push(a);
            if a != b {
                ring.extend(refine(a, b));
            }
        }
        face.ring = ring;
    }
    let mut boundary = Vec::new();
    let mut boundary_uses = Vec::new();
    for (i, &a) in region.iter().enumerate() {
        let b = region[(i + 1) % region.len()];
        let inner = refine(a, b);
        boundary_uses.extend(std::iter::repeat_n(uses[i], inner.len() + 1));
        boundary.push(a);
        boundary.extend(inner);
    }
    (boundary, boundary_uses)
}

/// Checks that the faces tile the region: every face simple with positive area,
/// every edge matched by its reverse in one other face or lying on the boundary,
/// and the boundary covered once. Returns the street frontage of each face,
/// metres: its boundary edges along a street and its edges shared with a
/// `street` face.
pub(crate) fn certify(
    template: &str,
    faces: &[Piece],
    boundary: &[P],
    uses: &[EdgeUse],
) -> Result<Vec<f64>, WarpError> {
    for (k, face) in faces.iter().enumerate() {
        let simple = face.ring.len() >= 3
            && signed_area(&face.ring) > 0.0
            && self_contact(&face.ring).is_none();
        if !simple {
            let at = face.ring.first().copied().unwrap_or_default();
            return Err(WarpError::FoldedFace {
                template: template.to_owned(),
                face: k,
                x: at.x,
                y: at.y,
            });
        }
    }
    let torn = |q: P, problem: &'static str| WarpError::NotTiled {
        template: template.to_owned(),
        x: q.x,
        y: q.y,
        problem,
    };
    let mut points = Points {
        number: BTreeMap::new(),
    };
    let mut owner: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (k, face) in faces.iter().enumerate() {
        for (i, &a) in face.ring.iter().enumerate() {
            let b = face.ring[(i + 1) % face.ring.len()];
            if owner.insert((points.id(a), points.id(b)), k).is_some() {
                return Err(torn(a, "belongs to two faces"));
            }
        }
    }
    let mut frontage = vec![0.0; faces.len()];
    let mut covered = 0;
    for (i, &a) in boundary.iter().enumerate() {
        let b = boundary[(i + 1) % boundary.len()];
        let Some(&k) = owner.get(&(points.id(a), points.id(b))) else {
            return Err(torn(a, "of the boundary belongs to no face"));
        };
        covered += 1;
        if uses[i] == EdgeUse::Street {
            frontage[k] += norm(b - a);
        }
    }
    let mut matched = 0;
    for (k, face) in faces.iter().enumerate() {
        for (i, &a) in face.ring.iter().enumerate() {
            let b = face.ring[(i + 1) % face.ring.len()];
            if let Some(&other) = owner.get(&(points.id(b), points.id(a))) {
                matched += 1;
                if faces[other].label == "street" {
                    frontage[k] += norm(b - a);
                }
            }
        }
    }
    if matched + covered != owner.len() {
        // Find the loose edge for the message.
        for face in faces {
            for (i, &a) in face.ring.iter().enumerate() {
                let b = face.ring[(i + 1) % face.ring.len()];
                let (u, v) = (points.id(a), points.id(b));
                let on_boundary = boundary.iter().enumerate().any(|(j, &q)| {
                    let r = boundary[(j + 1) % boundary.len()];
                    bits(q) == bits(a) && bits(r) == bits(b)
                });
                if !owner.contains_key(&(v, u)) && !on_boundary {
                    return Err(torn(a, "has no face on its other side"));
                }
            }
        }
        return Err(torn(boundary[0], "is matched twice"));
    }
    Ok(frontage)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::p;

    fn piece(label: &str, ring: &[(f64, f64)]) -> Piece {
        Piece {
            label: label.to_owned(),
            ring: ring.iter().map(|&(x, y)| p(x, y)).collect(),
            ideal_area: 1.0,
            mean_square: 0.0,
            access_exempt: false,
        }
    }

    const REGION: [P; 4] = [
        P { x: 0., y: 0. },
        P { x: 2., y: 0. },
        P { x: 2., y: 2. },
        P { x: 0., y: 2. },
    ];

    fn run(faces: &mut [Piece]) -> Result<Vec<f64>, WarpError> {
        let uses = [
            EdgeUse::Street,
            EdgeUse::NoStreet,
            EdgeUse::NoStreet,
            EdgeUse::NoStreet,
        ];
        let (boundary, uses) = stitch(faces, &REGION, &uses, 1e-6);
        certify("test", faces, &boundary, &uses)
    }

    fn three() -> Vec<Piece> {
        vec![
            piece("street", &[(0., 0.), (2., 0.), (2., 1.), (0., 1.)]),
            piece("parcel", &[(0., 1.), (0.7, 1.), (0.7, 2.), (0., 2.)]),
            piece("parcel", &[(0.7 + 1e-9, 1.), (2., 1.), (2., 2.), (0.7, 2.)]),
        ]
    }

    #[test]
    fn t_junctions_become_vertices_of_both_and_give_frontage() {
        let mut faces = three();
        let frontage = run(&mut faces).unwrap();
        assert_eq!(faces[0].ring.len(), 5);
        assert!(
            (frontage[0] - 2.0).abs() < 1e-6
                && (frontage[1] - 0.7).abs() < 1e-6
                && (frontage[2] - 1.3).abs() < 1e-6
        );
    }

    #[test]
    fn each_tear_is_found() {
        let torn = |faces: &mut Vec<Piece>| matches!(run(faces), Err(WarpError::NotTiled { .. }));
        let mut gap = three();
        gap.pop();
        assert!(torn(&mut gap));
        let mut overlap = three();
        overlap[1].ring[1].x = 1.0;
        overlap[1].ring[2].x = 1.0;
        assert!(torn(&mut overlap));
        let mut twice = three();
        twice.push(piece("parcel", &[(0., 1.), (0.7, 1.), (0.7, 2.), (0., 2.)]));
        assert!(torn(&mut twice));
        let mut loose = three();
        loose[1].ring[1].y = 1.2;
        assert!(torn(&mut loose));
        let mut hole = three();
        hole.push(piece("park", &[(0.2, 0.2), (0.4, 0.2), (0.4, 0.4)]));
        assert!(torn(&mut hole));
    }

    #[test]
    fn each_fold_is_found() {
        for ring in [
            vec![(0., 1.), (0.7, 2.), (0.7, 1.), (0., 2.)],
            vec![(0., 2.), (0.7, 2.), (0.7, 1.), (0., 1.)],
            vec![(0., 1.), (0.7, 1.)],
        ] {
            let mut faces = three();
            faces[1] = piece("parcel", &ring);
            assert!(
                matches!(run(&mut faces), Err(WarpError::FoldedFace { face: 1, .. })),
                "{ring:?}"
            );
        }
    }
}
