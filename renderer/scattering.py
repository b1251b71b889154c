"""Where a surface gets light from: directions drawn as a material weighs them, to both sides of a clear one (000, 6.3).

Radiance is carried divided by the square of the index of the medium it is in, which refraction leaves as it is; so
what has come out into the air again is right, and a furnace stays one. All vectors are unit vectors in world space.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import callee, leaf
from renderer.shading import Vector, between, dot, mirrored, reflect, unit

TOUCH = 1e-9
"""So far before it has left a clear body, relative to where that is in the world, light meets what the body touches."""


@leaf
def axes(n: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors across n and each other (Duff et al. 2017)."""
    sign = math.copysign(1.0, n[2])
    a = -1.0 / (sign + n[2])
    b = n[0] * n[1] * a
    return (1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]), (b, sign + n[1] * n[1] * a, -n[1])


@leaf
def matt_direction(n: Vector, u: float, v: float) -> Vector:
    """A direction by the cosine to n."""
    s, t = axes(n)
    turn = 2.0 * math.pi * v
    x, y, z = math.sqrt(u) * math.cos(turn), math.sqrt(u) * math.sin(turn), math.sqrt(max(1.0 - u, 0.0))
    return x * s[0] + y * t[0] + z * n[0], x * s[1] + y * t[1] + z * n[1], x * s[2] + y * t[2] + z * n[2]


@leaf
def seen_normal(alpha: float, n: Vector, e: Vector, u: float, v: float) -> Vector:
    """A normal of GGX as E sees them (Heitz 2018, "Sampling the GGX distribution of visible normals"): a point of the
    part of the sphere that E's mirror images fill (Dupuy and Benyoub 2023)."""
    if alpha == 0.0:
        return n
    s, t = axes(n)
    ex, ey, ez = alpha * dot(s, e), alpha * dot(t, e), dot(n, e)  # E where the surface is a hemisphere
    length = math.sqrt(ex * ex + ey * ey + ez * ez)
    ex, ey, ez = ex / length, ey / length, ez / length
    z = (1.0 - u) * (1.0 + ez) - ez
    across, turn = math.sqrt(min(max(1.0 - z * z, 0.0), 1.0)), 2.0 * math.pi * v
    hx, hy, hz = alpha * (across * math.cos(turn) + ex), alpha * (across * math.sin(turn) + ey), max(z + ez, 0.0)
    return unit(
        (hx * s[0] + hy * t[0] + hz * n[0], hx * s[1] + hy * t[1] + hz * n[1], hx * s[2] + hy * t[2] + hz * n[2])
    )


@leaf
def unmasked(alpha: float, cosine: float) -> float:
    """Smith's G1 of GGX: the part of the normals turned to a direction at this cosine that it sees."""
    return 2.0 / (1.0 + math.sqrt(1.0 + alpha * alpha * max(1.0 / (cosine * cosine) - 1.0, 0.0)))


@leaf
def mirrored_by(h: Vector, e: Vector) -> Vector:
    eh = 2.0 * dot(e, h)
    return unit((eh * h[0] - e[0], eh * h[1] - e[1], eh * h[2] - e[2]))


@leaf
def is_mirrored(material: np.void, n: Vector, e: Vector, way: Vector) -> bool:
    """Whether `scatter` has drawn the direction of an ideal mirror."""
    mirror = mirrored_by(n, e)
    return bool(material.alpha == 0.0) and mirror[0] == way[0] and mirror[1] == way[1] and mirror[2] == way[2]


@leaf
def refracted(h: Vector, e: Vector, eta: float) -> Vector:
    """Where E comes from through a facet of normal h on its side: eta is the index on this side over the other's.

    (0, 0, 0) where it is reflected totally.
    """
    eh = dot(e, h)
    square = 1.0 - eta * eta * max(1.0 - eh * eh, 0.0)
    if square <= 0.0:
        return 0.0, 0.0, 0.0
    along = eta * eh - math.sqrt(square)
    return unit((along * h[0] - eta * e[0], along * h[1] - eta * e[1], along * h[2] - eta * e[2]))


@leaf
def fresnel_within(material: np.void, cosine: float) -> float:
    """The part that the coat sends back into the body, at this cosine: Schlick's, by the angle in the air."""
    square = 1.0 - material.ior * material.ior * max(1.0 - cosine * cosine, 0.0)
    if square <= 0.0:
        return 1.0
    return float(material.f0 + (material.f90 - material.f0) * (1.0 - math.sqrt(square)) ** 5)


@callee
def scatter_within(
    material: np.void, n: Vector, e: Vector, lobe: float, u: float, v: float
) -> tuple[Vector, Vector]:  # fmt: skip
    """`scatter`, for E and n inside the body: back from its surface, or out.

    Of the dielectric the share `transmission` is clear, the rest is matt as from outside, but has no coat here.
    """
    none = (0.0, 0.0, 0.0)
    if dot(n, e) <= 0.0:
        return n, none
    base, metallic, alpha = material.base_color, material.metallic, material.alpha
    matt = (1.0 - metallic) * (1.0 - material.transmission)
    if lobe < matt:
        return matt_direction(n, u, v), (base[0], base[1], base[2])
    h = seen_normal(alpha, n, e, u, v)
    eh = min(dot(e, h), 1.0)
    if eh <= 0.0:
        return n, none
    red, green, blue = 1.0, 1.0, 1.0
    l = mirrored_by(h, e)
    if lobe < matt + metallic:
        schlick = (1.0 - eh) ** 5
        red, green = base[0] + (1.0 - base[0]) * schlick, base[1] + (1.0 - base[1]) * schlick
        blue = base[2] + (1.0 - base[2]) * schlick
    elif lobe - matt - metallic >= fresnel_within(material, eh) * (1.0 - matt - metallic):
        l = refracted(h, e, material.ior)
        red, green, blue = base[0], base[1], base[2]
        if dot(n, l) >= 0.0:
            return l, none
    if dot(n, l) == 0.0 or (dot(n, l) < 0.0 and dot(h, l) > 0.0):
        return l, none
    part = unmasked(alpha, dot(n, l))
    return l, (part * red, part * green, part * blue)


@leaf
def scatter(
    material: np.void, albedo: NDArray[np.float64], n: Vector, e: Vector, lobe: float, u: float, v: float, within: bool
) -> tuple[Vector, Vector]:
    """A direction L that `material` gets light from for E, and the weight of radiance from there, RGB.

    It is drawn, by three numbers from [0, 1), about as the material weighs directions: by the cosine, or by the normals
    that E sees of GGX, or it is the mirror's, or the refracted one, for which n.L < 0. n is on E's side; within: that
    is inside the body. The weight is BRDF times cosine over the density, 0 where L is on a side it cannot be on; its
    mean is the albedo. What a coat takes from the body's light is not what `reflect` says for each direction but its
    mean, as in `ambient`: with that no surface gives back more than it gets. Through rough facets light comes as
    Walter et al. 2007 ("Microfacet models for refraction through rough surfaces") have it. albedo: the table of
    `gloss_albedo`.
    """
    if within:
        return scatter_within(material, n, e, lobe, u, v)
    none = (0.0, 0.0, 0.0)
    ne = dot(n, e)
    if ne <= 0.0:
        return n, none
    base, metallic = material.base_color, material.metallic
    if metallic == 0.0 and material.f90 == 0.0 and material.transmission == 0.0:  # matt alone: what is below comes to
        return matt_direction(n, u, v), (base[0], base[1], base[2])
    schlick = (1.0 - min(ne, 1.0)) ** 5
    brightness = (base[0] + base[1] + base[2]) / 3.0
    coat = material.f0 + (material.f90 - material.f0) * schlick
    gloss = (1.0 - metallic) * coat + metallic * (brightness + (1.0 - brightness) * schlick)
    body = (1.0 - metallic) * (1.0 - coat) * brightness
    if gloss + body <= 0.0:
        return n, none
    glossy = gloss / (gloss + body)  # the part of the drawings that the gloss gets,
    clear = material.transmission * (1.0 - glossy)  # and what is refracted
    alpha = material.alpha
    if lobe < glossy and alpha == 0.0:
        shine = mirrored(material, ne)
        return mirrored_by(n, e), (shine[0] / glossy, shine[1] / glossy, shine[2] / glossy)
    if lobe < glossy:
        l = mirrored_by(seen_normal(alpha, n, e, u, v), e)
    elif lobe < glossy + clear:
        h = seen_normal(alpha, n, e, u, v)
        eh = min(max(dot(e, h), 0.0), 1.0)
        l = refracted(h, e, 1.0 / material.ior)
        if dot(n, l) >= 0.0:
            return l, none
        part = 1.0 - material.f0 - (material.f90 - material.f0) * (1.0 - eh) ** 5
        part *= (1.0 - metallic) * material.transmission * unmasked(alpha, dot(n, l)) / clear
        return l, (part * base[0], part * base[1], part * base[2])
    else:
        l = matt_direction(n, u, v)
    nl = dot(n, l)
    density = (1.0 - glossy - clear) * nl / math.pi
    h = unit((l[0] + e[0], l[1] + e[1], l[2] + e[2]))
    if alpha > 0.0:
        a2, nh = alpha * alpha, dot(n, h)
        spike = nh * nh * (a2 - 1.0) + 1.0
        density += glossy * a2 / (math.pi * spike * spike) * 0.5 / (ne + math.sqrt(ne * ne * (1.0 - a2) + a2))
    if nl <= 0.0 or density <= 0.0:
        return l, none
    weight = reflect(material, n, e, l)
    change = 0.0
    if metallic < 1.0 and material.f90 > 0.0:
        taken = coat
        if alpha > 0.0:
            roughness = math.sqrt(alpha)
            plain, grazing = between(albedo, ne, roughness, 0), between(albedo, ne, roughness, 1)
            taken = material.f0 * plain + (material.f90 - material.f0) * grazing
        there = material.f0 + (material.f90 - material.f0) * (1.0 - min(max(dot(e, h), 0.0), 1.0)) ** 5
        change = (1.0 - metallic) * (1.0 - material.transmission) * (there - taken) * nl / math.pi
    return l, (
        max(weight[0] + change * base[0], 0.0) / density,
        max(weight[1] + change * base[1], 0.0) / density,
        max(weight[2] + change * base[2], 0.0) / density,
    )
