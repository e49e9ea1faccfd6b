"""Processor time of Triangle (pip install triangle numpy) on the outline of
benches/domain.rs, with the area bound that our meshes are refined to.

python3 benches/triangle_peer.py [VERTICES ...]
"""

import math
import sys
import time

import numpy as np
import triangle


def region():
    rings = []
    a = 2 * math.pi * np.arange(240) / 240
    r = 390.0 * (1.0 + 0.25 * np.sin(3 * a) + 0.08 * np.cos(7 * a))
    rings.append(np.column_stack([r * np.cos(a), r * np.sin(a)]))
    a = 2 * math.pi * np.arange(60) / 60
    rings.append(np.column_stack([60 + 80 * np.cos(a), -40 + 50 * np.sin(a)]))
    return rings


def area(ring):
    x, y = ring.T
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


rings = region()
total = area(rings[0]) - area(rings[1])
segments, start = [], 0
for ring in rings:
    n = len(ring)
    segments += [[start + k, start + (k + 1) % n] for k in range(n)]
    start += n
outline = dict(vertices=np.vstack(rings), segments=np.array(segments), holes=[[60.0, -40.0]])
print("| vertices | triangles | area bound | s |\n|---|---|---|---|")
for count in [float(w) for w in sys.argv[1:]] or [1e4, 1e5, 1e6]:
    step = math.sqrt(total / count / math.sqrt(0.75))
    # Triangle fills an area bound to about 0.6 of it on average; this one
    # gives the wanted number of vertices.
    bound = 0.75 * step * step
    flags = f"pq25a{bound:.12f}"
    best = math.inf
    for _ in range(2 if count > 3e5 else 5):
        before = time.process_time()
        mesh = triangle.triangulate(outline, flags)
        best = min(best, time.process_time() - before)
    print(f"| {len(mesh['vertices'])} | {len(mesh['triangles'])} | {bound:.4f} | {best:.4f} |")
