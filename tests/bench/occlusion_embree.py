#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""occlusion_embree.py BUILD: occlusion from horizons and from rays beside that of Embree, of the same heights as a mesh.

Embree 3 (Debian's libembree3-3) traces rays in directions weighted by the cosine with a normal: that of the bake, or
that of one of the six triangles that meet in a texel. The mesh goes on beyond the border as the heights do. Needs
numpy. The meshes, and transfer-normals on them, are those of occlusion_mesh.py.
"""

import ctypes
import os
import sys
import tempfile

import numpy as np

import occlusion_mesh as mesh

SIDE, MARGIN = mesh.SIDE, mesh.MARGIN
AROUND = 160  # texels of the mesh around the field
STRATA = int(os.environ.get("STRATA", "40"))  # rays of a texel: so many squared
TRIANGLES, INDEX, VERTEX, UINT3, FLOAT3, ROBUST = 0, 0, 1, 0x5003, 0x9003, 4  # rtcore.h of 3.13
RAY = np.dtype([("org", "f4", 3), ("near", "f4"), ("dir", "f4", 3), ("time", "f4"), ("far", "f4"), ("mask", "u4"),
                ("id", "u4"), ("flags", "u4")])


class Context(ctypes.Structure):
    _fields_ = [("flags", ctypes.c_int), ("filter", ctypes.c_void_p), ("instance", ctypes.c_uint),
                ("reserved", ctypes.c_float * 8)]


class Scene:
    """Triangles over a grid of heights; the diagonal goes from the upper left to the lower right."""

    def __init__(self, heights: np.ndarray) -> None:
        self.library = ctypes.CDLL("libembree3.so.3")
        for name in ("rtcNewDevice", "rtcNewScene", "rtcNewGeometry", "rtcSetNewGeometryBuffer"):
            getattr(self.library, name).restype = ctypes.c_void_p
        pointer = ctypes.c_void_p
        device = pointer(self.library.rtcNewDevice(b""))
        self.scene = pointer(self.library.rtcNewScene(device))
        self.library.rtcSetSceneFlags(self.scene, ROBUST)
        geometry = pointer(self.library.rtcNewGeometry(device, TRIANGLES))
        rows, columns = heights.shape
        j, i = np.mgrid[0:rows, 0:columns]
        vertices = np.stack([i, -j, heights], -1).reshape(-1, 3).astype("f4")
        a = (j * columns + i)[:-1, :-1].ravel()
        corners = np.stack([a, a + columns, a + columns + 1, a, a + columns + 1, a + 1], -1).reshape(-1, 3).astype("u4")
        for kind, form, values in ((VERTEX, FLOAT3, vertices), (INDEX, UINT3, corners)):
            place = self.library.rtcSetNewGeometryBuffer(geometry, kind, 0, form, ctypes.c_size_t(12),
                                                         ctypes.c_size_t(len(values)))
            ctypes.memmove(place, values.ctypes.data, values.nbytes)
        self.library.rtcCommitGeometry(geometry)
        self.library.rtcAttachGeometry(self.scene, geometry)
        self.library.rtcCommitScene(self.scene)

    def open_share(self, origins: np.ndarray, normals: np.ndarray, seed: int) -> np.ndarray:
        """The share of rays that reach the sky; none does below the level, as the ground goes on there."""
        random = np.random.default_rng(seed)
        count = STRATA * STRATA
        v, u = np.divmod(np.arange(count), STRATA)
        result = np.empty(len(origins))
        context = Context(0, None, 0xFFFFFFFF)
        for k, (origin, n) in enumerate(zip(origins, normals)):
            radius = np.sqrt((u + random.random(count)) / STRATA)
            angle = 2 * np.pi * (v + random.random(count)) / STRATA
            x, y, z = radius * np.cos(angle), radius * np.sin(angle), np.sqrt(np.maximum(0, 1 - radius**2))
            t = np.cross(n, [0, 1, 0] if abs(n[1]) < 0.7 else [1, 0, 0])
            t /= np.linalg.norm(t)
            rays = np.zeros(count, RAY)
            rays["dir"] = np.outer(x, t) + np.outer(y, np.cross(n, t)) + np.outer(z, n)
            rays["org"] = origin
            rays["near"], rays["far"], rays["mask"] = 1e-4, np.inf, 0xFFFFFFFF
            self.library.rtcOccluded1M(self.scene, ctypes.byref(context), ctypes.c_void_p(rays.ctypes.data),
                                       ctypes.c_uint(count), ctypes.c_size_t(RAY.itemsize))
            result[k] = np.mean((rays["far"] > 0) & (rays["dir"][:, 2] > 0))
        return result


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def triangle_normals(h: np.ndarray) -> list[np.ndarray]:
    """Those of the six triangles that meet in each texel, from slopes to neighbours; h has one more on each side."""
    c = h[1:-1, 1:-1]
    right, left, up, down = h[1:-1, 2:] - c, c - h[1:-1, :-2], h[:-2, 1:-1] - c, c - h[2:, 1:-1]
    corner_d, corner_u = h[2:, 2:], h[:-2, :-2]  # along the diagonal
    pairs = [(right, h[1:-1, 2:] - corner_d), (corner_d - h[2:, 1:-1], down), (left, down), (left, h[:-2, :-2] - h[1:-1, :-2]),
             (h[:-2, 1:-1] - corner_u, up), (right, up)]
    return [unit(np.stack([-p, -q, np.ones_like(p)], -1)) for p, q in pairs]


def row(name: str, a: np.ndarray, b: np.ndarray) -> str:
    gap = np.abs(a - b)
    return f"{name}: {gap.mean():.4f}, {np.mean(a - b):+.4f}, {np.quantile(gap, 0.99):.3f}"


def main() -> None:
    build = os.path.abspath(sys.argv[1])
    inside = slice(MARGIN, SIDE - MARGIN, 2)
    print("| heights | beside Embree: mean difference, signed, 99 % within |\n|---|---|")
    for name, height in mesh.FIELDS.items():
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            horizons, rays = mesh.both(build, height)
            os.chdir("/")
        heights = np.array([[height(i, j) for i in range(SIDE)] for j in range(SIDE)], dtype="f4")
        field = np.pad(heights, AROUND, mode="edge")
        scene = Scene(field)
        i, j = np.meshgrid(np.arange(SIDE)[inside], np.arange(SIDE)[inside])
        places = np.stack([i + AROUND, -(j + AROUND), heights[inside, inside]], -1).reshape(-1, 3)
        places[:, 2] += 1e-3
        near = np.pad(heights, 1, mode="edge").astype("f8")
        p, q = (near[1:-1, 2:] - near[1:-1, :-2]) / 2, (near[:-2, 1:-1] - near[2:, 1:-1]) / 2
        baked = unit(np.stack([-p, -q, np.ones_like(p)], -1))
        of_bake = scene.open_share(places, baked[inside, inside].reshape(-1, 3), 1)
        own = np.array(horizons).reshape(SIDE, SIDE)[inside, inside].ravel()
        theirs = np.array(rays).reshape(SIDE, SIDE)[inside, inside].ravel()
        of_triangles = np.array([scene.open_share(places, n[inside, inside].reshape(-1, 3), 2)
                                 for n in triangle_normals(near)])
        nearest = of_triangles[np.abs(of_triangles - theirs).argmin(0), np.arange(len(theirs))]
        print(f"| {name} | " + "; ".join([
            row("horizons, normals of the bake", own, of_bake),
            row("rays of transfer-normals, normals of the bake", theirs, of_bake),
            row("the same, nearest of six triangles", theirs, nearest),
            row("horizons, nearest of six triangles", own, of_triangles[np.abs(of_triangles - own).argmin(0), np.arange(len(own))]),
            row("one triangle, normals of the bake", of_triangles[0], of_bake),
        ]) + " |")


if __name__ == "__main__":
    main()
