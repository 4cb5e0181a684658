# SPDX-License-Identifier: Apache-2.0
"""Normal maps with other data beside the normals."""

from __future__ import annotations

from typing import Any

import numpy as np


class NormalMap(np.ndarray):
    """An array (height, width, 3) of normals, with other data beside them.

    `blue`, `alpha` and `length` are arrays (height, width) of numbers from 0 to 1, or None: heights, occlusion,
    roughness or a mask, as NormalMap of tex/types.h describes them. Every verb that takes a map also
    takes a NormalMap; its result carries whatever extra data the verb preserves. Maps without other data are plain
    arrays.

        n = tex.NormalMap(normals, alpha=heights)
        tex.pack(tex.build_mip_chain(n), "rgba8")

    NormalMap(n) keeps the data of n, unless others are given; None leaves them out. Copies and pickles have the data;
    what numpy's other functions make of it (n[::2], -n) has none. Nothing is copied if the layout allows it.
    """

    blue: np.ndarray | None
    alpha: np.ndarray | None
    length: np.ndarray | None

    def __new__(cls, n: Any, **data: Any) -> NormalMap:
        unknown = set(data) - {"blue", "alpha", "length"}
        if unknown:
            raise TypeError(f"NormalMap() got an unexpected argument '{min(unknown)}'")
        normals = np.asarray(n)
        if normals.ndim != 3 or normals.shape[2] != 3:
            raise ValueError(f"n: expected an array of shape (height, width, 3), got {normals.shape}")
        self = normals.view(cls)
        for name in ("blue", "alpha", "length"):
            plane = data.get(name, None if name in data else getattr(n, name, None))
            if plane is not None:
                plane = np.asarray(plane)
                if plane.shape != normals.shape[:2]:
                    raise ValueError(f"{name}: expected an array of shape {normals.shape[:2]}, got {plane.shape}")
            setattr(self, name, plane)
        return self

    def __array_finalize__(self, source: Any) -> None:
        # Of a part or a mirror image of the map, the data would be wrong.
        self.blue = self.alpha = self.length = None

    @property
    def others(self) -> dict[str, np.ndarray]:
        """The data that there are, by their names."""
        named = {name: getattr(self, name) for name in ("blue", "alpha", "length")}
        return {name: plane for name, plane in named.items() if plane is not None}

    def copy(self, order: Any = "C") -> NormalMap:
        others = {name: plane.copy() for name, plane in self.others.items()}
        return NormalMap(np.array(self, order=order), **others)

    def __copy__(self) -> NormalMap:
        return self.copy("K")

    def __deepcopy__(self, memo: Any) -> NormalMap:
        return self.copy("K")

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (np.array(self), self.others)


def _restored(normals: np.ndarray, others: dict[str, np.ndarray]) -> NormalMap:
    return NormalMap(normals, **others)
