"""The order in which the codec `packed` has vertices, and their neighbours in it (section 10)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from .reading import demand


def read_order(rows) -> tuple[list[int], list[tuple[int, int, int]]]:
    """Vertices in coding order, and the places of their neighbours; the number of vertices: missing."""
    count, missing, vertices, near = len(rows), 2**32 - 1, [], []
    taken = bytearray(count)
    for place, row in enumerate(rows):
        vertex, *others = map(int, row)
        demand(vertex < count and not taken[vertex], "the order is none of the vertices")
        demand(all(n < place or n == missing for n in others), "a neighbour does not come before")
        taken[vertex] = 1
        vertices.append(vertex)
        near.append(tuple(count if n == missing else n for n in others))
    return vertices, near


def grid_order(cloths: Iterable[Mapping[str, Any]], count: int) -> tuple[list[int], list[tuple[int, int, int]]]:
    near = []
    for cloth in cloths:
        first, vertices = cloth["first_vertex"], cloth["vertices"]
        columns = cloth.get("columns", 0)
        grid = first == len(near) and cloth.get("rows", 0) * columns == vertices
        demand(grid, "a cloth without an order is no grid")
        for i in range(vertices):
            at, left, above = first + i, i % columns > 0, i >= columns
            if left and above:
                near.append((at - 1, at - columns, at - columns - 1))
            else:
                near.append((at - 1 if left else at - columns if above else count, count, count))
    demand(len(near) == count, "the cloths are not all of the mesh")
    return list(range(count)), near
