"""Profiles that overhang: which are taken, which are refused, and with what words."""

from __future__ import annotations

import pytest

from schema import PolylineProfile, internal, overhangs
from schema.overhang import MAX_FACETS, faults

Points = list[tuple[float, float]]

DOVETAIL: Points = [(-1, 0), (-2, -2), (2, -2), (1, 0)]
MUSHROOM: Points = [(-1, 0), (-1, 1), (-2, 1), (-2, 2), (2, 2), (2, 1), (1, 1), (1, 0)]
ONE_SIDED: Points = [(-1, 0), (-2, -2), (1, -2), (1, 0)]
LIPS: Points = [(-4, 0), (-3, 1), (-1, 1), (-1, 0.5), (-2, -1), (2, -1), (1, 0.5), (1, 1), (3, 1), (4, 0)]
ISLAND: Points = [
    (-4, 0), (-4, -3), (-1, -3), (-1, -1), (-2, -1), (-2, 1), (2, 1), (2, -1), (1, -1), (1, -3), (4, -3), (4, 0)
]  # fmt: skip
LEANING: Points = [(0, 0), (-1, 1), (0, 1), (1, -1), (2, 0)]


@pytest.mark.parametrize("points", [DOVETAIL, MUSHROOM, ONE_SIDED, LIPS, ISLAND, LEANING])
def test_taken(points: Points) -> None:
    assert overhangs(points)
    assert list(faults(points)) == []
    assert PolylineProfile(type="polyline", points=tuple(points)).polyline() == tuple(points)


def test_internal_facets() -> None:
    assert internal(DOVETAIL) == (0, 3)
    assert internal(MUSHROOM) == (0, 0)  # never descends: a ridge alone
    assert internal(LIPS) == (2, 7)
    assert internal(LEANING) == (2, 4)


@pytest.mark.parametrize(
    ("points", "where", "expected", "found"),
    [
        # facet 2 comes up through facet 0
        ([(0, 0), (2, -1), (1, -1), (1, 1), (3, 0)], 3, "does not meet itself", "facet 2 meets facet 0"),
        ([(0, 0), (2, -2), (1, -1), (3, 0)], 2, "does not meet itself", "facet 1 runs back along facet 0"),
        # point 3 lies on facet 0
        ([(0, 0), (2, -2), (0, -2), (1, -1), (3, 0)], 3, "does not meet itself", "facet 2 meets facet 0"),
        # the cap's rim hangs down: it would be below internal facets, and nothing would be left of it
        ([(-1, 0), (-1, 2), (-2, 1), (-2, 3), (2, 3), (2, 1), (1, 2), (1, 0)], 4, "no facet above point 1", "facet 3"),
        # it begins with a level run to the left, from whose end on all is open
        ([(-1, 0), (-1.7, 0), (-0.3, -0.2), (-1.8, -1.9), (1, 0)], 1, "external facets outside", "facet 0"),
        # a lip that leans over from outside of the groove's foot
        ([(0, 0), (2, 2), (-2, 4), (-3, -4), (8, -4), (8, 0)], 3, "no facet that crosses w = 0", "facet 2"),
        # an undercut that comes up through the plane
        ([(0, 0), (0, -2), (3, -2), (5, 2), (2, -1), (1, 0)], 3, "no facet that crosses w = 0", "facet 2 at b = 4"),
        ([(0, 0), (1, -1), (-3, -2), (-1, 0)], 3, "to the right", "-1"),
    ],
)  # fmt: skip
def test_refused(points: Points, where: int, expected: str, found: str) -> None:
    assert overhangs(points)
    one = next(faults(points))
    assert one.at[:2] == ("points", where)
    assert expected in one.expected
    assert found in one.found


def test_has_few_facets() -> None:
    """The search for facets that meet takes the square of their number."""
    saw: Points = [(0, 0), (-1, -1), *((i % 2 * 0.5, -1.0 - 0.01 * i) for i in range(MAX_FACETS)), (3, -5), (2, 0)]
    assert next(faults(saw)).at == ("points",)
