"""The part of a pixel's square that lies on one side of a line."""

from __future__ import annotations

from renderer.kernel import leaf


@leaf
def share(a: float, b: float, c: float) -> float:
    """Area of {(u, v) in [0, 1]^2 : a u + b v + c >= 0}, in closed form.

    Mirroring the square turns any line into one with a >= b >= 0 without changing the area, which then depends on the
    line's value at the centre alone: nothing, a triangle, a trapezoid, or the rest of a triangle.
    """
    middle = c + 0.5 * (a + b)
    a, b = abs(a), abs(b)
    if a < b:
        a, b = b, a
    corner = 0.5 * (a + b) - abs(middle)  # how far the line keeps inside the farthest corner
    if corner <= 0.0:
        return 1.0 if middle >= 0.0 else 0.0
    if corner >= b:
        return 0.5 + middle / a
    triangle = corner * corner / (2.0 * a * b)
    return 1.0 - triangle if middle >= 0.0 else triangle
