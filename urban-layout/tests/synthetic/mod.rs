//! A small town on curved streets that keeps every law by construction.
//!
//! Blocks of 18 x 30 m parcels stand on a grid of parameters (u, v), streets of
//! 15 m between them; a gentle wave bends the grid. All tiles take their
//! vertices from the same points, so that they tile the site exactly.

#![allow(dead_code, reason = "each test binary uses its own part")]

use std::collections::BTreeMap;

use urban_layout::geo_types::{Coord, LineString, MultiPolygon, Polygon};
use urban_layout::layout::{
    measure_parcel, Block, Junction, Layout, Lineage, ParcelInfo, Street, Tile, TileKind,
};
use urban_layout::site::{Element, ElementKind, GivenRoad, RoadClass, Site};

const STREET: f64 = 15.0;
const WIDE: f64 = 18.0;
const DEEP: f64 = 30.0;

/// Size and bend of a town.
#[derive(Clone, Debug)]
pub(crate) struct Town {
    /// Parcels along a row of one block.
    pub(crate) parcels: usize,
    /// Columns of blocks.
    pub(crate) columns: usize,
    /// Streets along u; the rows of parcels are twice as many.
    pub(crate) streets: usize,
    /// Height of the wave, metres.
    pub(crate) wave: f64,
}

impl Default for Town {
    fn default() -> Self {
        Self {
            parcels: 7,
            columns: 3,
            streets: 3,
            wave: 14.0,
        }
    }
}

impl Town {
    /// Width of one block.
    fn block(&self) -> f64 {
        self.parcels as f64 * WIDE
    }

    /// Left edge of a column.
    fn left(&self, column: usize) -> f64 {
        column as f64 * (self.block() + STREET)
    }

    /// Lower edge of a row of parcels: single rows at the rims, rows in pairs
    /// back to back inside.
    fn low(&self, row: usize) -> f64 {
        row as f64 * DEEP + row.div_ceil(2) as f64 * STREET
    }

    /// Where a point of the grid is, in metres of some far projection.
    fn place(&self, u: f64, v: f64) -> Coord<f64> {
        let y = v + self.wave * (u / 110.0).sin();
        Coord {
            x: 500_000.0 + u,
            y: 6_700_000.0 + y,
        }
    }

    /// u of every vertex along a column's rows.
    fn stations(&self, column: usize) -> Vec<f64> {
        (0..=self.parcels)
            .map(|k| self.left(column) + k as f64 * WIDE)
            .collect()
    }

    /// The site and its layout. The site has an outside street at the west end
    /// of the lowest street, a given collector along the lowest street, and a
    /// lake and a park in the middle column.
    pub(crate) fn build(&self) -> (Site, Layout) {
        let rows = 2 * self.streets;
        let all: Vec<f64> = (0..self.columns).flat_map(|c| self.stations(c)).collect();
        let top = self.low(rows - 1) + DEEP;
        let line = |v: f64| all.iter().map(|u| self.place(*u, v)).collect::<Vec<_>>();
        let right = self.left(self.columns - 1) + self.block();
        let mut outline = line(0.0);
        let levels: Vec<f64> = (0..rows)
            .flat_map(|r| [self.low(r), self.low(r) + DEEP])
            .collect();
        outline.extend(
            levels[1..levels.len() - 1]
                .iter()
                .map(|v| self.place(right, *v)),
        );
        outline.extend(line(top).into_iter().rev());
        outline.extend(
            levels[1..levels.len() - 1]
                .iter()
                .rev()
                .map(|v| self.place(0.0, *v)),
        );
        let outline = LineString::new(outline);
        let mut site = Site::from_polygon(&Polygon::new(outline, vec![])).expect("a valid outline");
        site.name = Some("synthetic_town".to_owned());
        let layout = self.fill(&mut site);
        (site, layout)
    }

    fn fill(&self, site: &mut Site) -> Layout {
        let mut layout = Layout {
            site: MultiPolygon::new(site.parts.clone()),
            seed: 7,
            ..Layout::default()
        };
        let frame = site.frame;
        let at = |u: f64, v: f64| frame.to_local(self.place(u, v));
        let mut id = 100..;
        let mut next = || id.next().unwrap_or(0);
        let rows = 2 * self.streets;
        let middle = self.columns / 2;
        let lineage = |split: String| Lineage {
            split,
            by: "streamline".to_owned(),
            field: Some("distance".to_owned()),
            scores: Some([0.1, 0.25, 0.0, 1.0]),
            energy: None,
            seed: 7,
        };
        // Rows back to back share one block; the first and the last are alone.
        for column in 0..self.columns {
            let stations = self.stations(column);
            let mut row = 0;
            while row < rows {
                let double = row > 0 && row + 1 < rows;
                let high = if double { row + 1 } else { row };
                let (low, top) = (self.low(row), self.low(high) + DEEP);
                let block = next();
                let kind = match (column == middle, row) {
                    (true, 1) => Some(TileKind::Lake),
                    (true, 3) => Some(TileKind::Park),
                    (true, 5) => Some(TileKind::Commercial),
                    _ => None,
                };
                let ring = outline(&stations, &[low, self.low(row) + DEEP, top], &at);
                layout.blocks.push(Block {
                    id: block,
                    polygon: ring.clone(),
                    lineage: lineage(format!("0.{column}.{row}")),
                });
                if let Some(kind) = kind {
                    let given = kind == TileKind::Lake;
                    if given {
                        site.elements.push(Element {
                            kind: ElementKind::Lake,
                            polygon: ring.clone(),
                            label: None,
                            feature: 1,
                        });
                    }
                    layout.tiles.push(Tile {
                        id: next(),
                        kind,
                        polygon: ring,
                        label: (kind == TileKind::Park).then(|| "Common".to_owned()),
                        parcel: None,
                        lineage: None,
                        given,
                    });
                } else {
                    for r in row..=high {
                        for pair in stations.windows(2) {
                            let (v, w) = (self.low(r), self.low(r) + DEEP);
                            let corners = [
                                at(pair[0], v),
                                at(pair[1], v),
                                at(pair[1], w),
                                at(pair[0], w),
                            ];
                            layout.tiles.push(parcel(next(), block, corners));
                        }
                    }
                }
                row = high + 1;
            }
        }
        self.streets(site, &mut layout, &mut next);
        self.pave(&mut layout, &at, next());
        layout
    }

    /// Centrelines: along u between all columns, along v between all rows.
    fn streets(&self, site: &mut Site, layout: &mut Layout, next: &mut impl FnMut() -> u64) {
        let frame = site.frame;
        let at = |u: f64, v: f64| frame.to_local(self.place(u, v));
        let mut nodes: BTreeMap<(i64, i64), u64> = BTreeMap::new();
        let mut lines: Vec<(Vec<Coord<f64>>, RoadClass, bool)> = Vec::new();
        let rows = 2 * self.streets;
        let right = self.left(self.columns - 1) + self.block();
        let crossings: Vec<f64> = (1..self.columns)
            .map(|c| self.left(c) - STREET / 2.0)
            .collect();
        for street in 0..self.streets {
            let v = self.low(2 * street + 1) - STREET / 2.0;
            let mut cuts = vec![0.0];
            cuts.extend(&crossings);
            cuts.push(right);
            for pair in cuts.windows(2) {
                let mut us = vec![pair[0]];
                us.extend(
                    (0..self.columns)
                        .flat_map(|c| self.stations(c))
                        .filter(|u| *u > pair[0] && *u < pair[1]),
                );
                us.push(pair[1]);
                let class = if street == 0 {
                    RoadClass::Collector
                } else {
                    RoadClass::Local
                };
                lines.push((
                    us.into_iter().map(|u| at(u, v)).collect(),
                    class,
                    street == 0,
                ));
            }
        }
        for u in crossings {
            let mut vs = vec![0.0];
            vs.extend((0..self.streets).map(|s| self.low(2 * s + 1) - STREET / 2.0));
            vs.push(self.low(rows - 1) + DEEP);
            for pair in vs.windows(2) {
                // The site's rim is straight between stations, the wave is not.
                let end = |v: f64| {
                    let (left, right) = (at(u - STREET / 2.0, v), at(u + STREET / 2.0, v));
                    let rim = Coord {
                        x: (left.x + right.x) / 2.0,
                        y: (left.y + right.y) / 2.0,
                    };
                    if v == 0.0 || v == self.low(rows - 1) + DEEP {
                        rim
                    } else {
                        at(u, v)
                    }
                };
                lines.push((vec![end(pair[0]), end(pair[1])], RoadClass::Local, false));
            }
        }
        let mut given = Vec::new();
        for (line, class, is_given) in lines {
            let mut node = |c: Coord<f64>| {
                let key = ((c.x * 100.0).round() as i64, (c.y * 100.0).round() as i64);
                let found = *nodes.entry(key).or_insert_with(&mut *next);
                match layout.junctions.iter_mut().find(|j| j.id == found) {
                    Some(j) => j.degree += 1,
                    None => layout.junctions.push(Junction {
                        id: found,
                        at: c,
                        degree: 1,
                    }),
                }
                found
            };
            let (from, to) = (node(line[0]), node(line[line.len() - 1]));
            if is_given {
                given.extend(line.iter().copied());
            }
            layout.streets.push(Street {
                id: next(),
                line: LineString::new(line),
                class,
                width: STREET,
                from,
                to,
                given: is_given,
                name: is_given.then(|| "Mill Street".to_owned()),
                lineage: None,
            });
        }
        given.dedup();
        let road = |line: Vec<Coord<f64>>, feature| GivenRoad {
            line: LineString::new(line),
            class: RoadClass::Collector,
            width: STREET,
            name: Some("Mill Street".to_owned()),
            feature,
        };
        let west = given[0];
        site.roads.push(road(given, 2));
        site.outside_streets.push(road(
            vec![
                west,
                Coord {
                    x: west.x - 80.0,
                    y: west.y - 10.0,
                },
            ],
            3,
        ));
    }

    /// The street area: the bands along u whole, and pieces of those along v
    /// between them.
    fn pave(&self, layout: &mut Layout, at: &impl Fn(f64, f64) -> Coord<f64>, first: u64) {
        let rows = 2 * self.streets;
        let all: Vec<f64> = (0..self.columns).flat_map(|c| self.stations(c)).collect();
        let mut add = |polygon| {
            let id = first + layout.tiles.len() as u64 * 1000;
            layout.tiles.push(Tile {
                id,
                kind: TileKind::StreetArea,
                polygon,
                label: None,
                parcel: None,
                lineage: None,
                given: false,
            });
        };
        for street in 0..self.streets {
            let low = self.low(2 * street) + DEEP;
            add(outline(&all, &[low, low + STREET], at));
        }
        for column in 1..self.columns {
            let us = [self.left(column) - STREET, self.left(column)];
            let mut row = 0;
            while row < rows {
                let high = if row > 0 && row + 1 < rows {
                    row + 1
                } else {
                    row
                };
                add(outline(
                    &us,
                    &[self.low(row), self.low(row) + DEEP, self.low(high) + DEEP],
                    at,
                ));
                row = high + 1;
            }
        }
    }
}

/// The ring around a part of the grid with all its vertices.
fn outline(us: &[f64], vs: &[f64], at: &impl Fn(f64, f64) -> Coord<f64>) -> Polygon<f64> {
    let (left, right) = (us[0], us[us.len() - 1]);
    let (low, high) = (vs[0], vs[vs.len() - 1]);
    let mut ring: Vec<Coord<f64>> = us.iter().map(|u| at(*u, low)).collect();
    ring.extend(vs[1..].iter().map(|v| at(right, *v)));
    ring.extend(us.iter().rev().map(|u| at(*u, high)));
    ring.extend(vs.iter().rev().map(|v| at(left, *v)));
    ring.dedup();
    Polygon::new(LineString::new(ring), vec![])
}

fn parcel(id: u64, block: u64, corners: [Coord<f64>; 4]) -> Tile {
    let polygon = Polygon::new(LineString::new(corners.to_vec()), vec![]);
    let (corner_deviation_deg, box_ratio) = measure_parcel(&polygon);
    let info = ParcelInfo {
        block,
        template: "double-row".to_owned(),
        corner_deviation_deg,
        box_ratio,
        registration: Some(0.25),
        street_access: true,
        access_exempt: false,
        ideal_area: Some(WIDE * DEEP),
    };
    let lineage = Lineage {
        split: "0.1".to_owned(),
        by: "template".to_owned(),
        energy: Some(0.001),
        ..Lineage::default()
    };
    Tile {
        id,
        kind: TileKind::Parcel,
        polygon,
        label: None,
        parcel: Some(info),
        lineage: Some(lineage),
        given: false,
    }
}
