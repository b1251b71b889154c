"""How a facet answers to light: glTF 2.0's materials (appendix B), direct light and the sky.

Parts of a footprint are shaded where they are found, so this is a leaf that the methods call and not a stage with
buffers of its own. All vectors are unit vectors in world space; E points to the viewer, L to the light.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import callee, kernel, leaf
from renderer.tables import DIRECTIONAL, GLOSS_LEVELS, IRRADIANCE, Lighting, Surroundings

Vector = tuple[float, float, float]


@leaf
def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@leaf
def unit(a: Vector) -> Vector:
    length = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    return (a[0] / length, a[1] / length, a[2] / length) if length > 0.0 else (0.0, 0.0, 1.0)


@leaf
def normal_to_world(frame: np.void, n: Vector) -> Vector:
    """A normal of pattern space (a covector) in the world: by the inverse transpose of the frame's axes."""
    d = frame.dual
    return unit(
        (
            n[0] * d[0, 0] + n[1] * d[1, 0] + n[2] * d[2, 0],
            n[0] * d[0, 1] + n[1] * d[1, 1] + n[2] * d[2, 1],
            n[0] * d[0, 2] + n[1] * d[1, 2] + n[2] * d[2, 2],
        )
    )


@leaf
def to_world(frame: np.void, p: float, q: float, w: float) -> Vector:
    """A point of pattern space in the world."""
    a, dp, dq = frame.axes, p - frame.pq[0], q - frame.pq[1]
    return (
        frame.origin[0] + a[0, 0] * dp + a[0, 1] * dq + a[0, 2] * w,
        frame.origin[1] + a[1, 0] * dp + a[1, 1] * dq + a[1, 2] * w,
        frame.origin[2] + a[2, 0] * dp + a[2, 1] * dq + a[2, 2] * w,
    )


@leaf
def direction_to_pattern(frame: np.void, v: Vector) -> Vector:
    """A world vector in pattern space."""
    d = frame.dual
    return (
        d[0, 0] * v[0] + d[0, 1] * v[1] + d[0, 2] * v[2],
        d[1, 0] * v[0] + d[1, 1] * v[1] + d[1, 2] * v[2],
        d[2, 0] * v[0] + d[2, 1] * v[1] + d[2, 2] * v[2],
    )


@leaf
def light_to_pattern(frame: np.void, light: np.void) -> tuple[float, float, float, float]:
    """The light as a homogeneous point (D_p, D_q, D_w, h) of pattern space: h = 1 a point, h = 0 a direction."""
    v = light.vector
    if light.kind == DIRECTIONAL:
        d = direction_to_pattern(frame, (v[0], v[1], v[2]))
        return d[0], d[1], d[2], 0.0
    o = frame.origin
    d = direction_to_pattern(frame, (v[0] - o[0], v[1] - o[1], v[2] - o[2]))
    return d[0] + frame.pq[0], d[1] + frame.pq[1], d[2], 1.0


@leaf
def reflect(material: np.void, n: Vector, e: Vector, to_light: Vector) -> Vector:
    """BRDF times the cosine to the light, RGB: GGX with Smith's height-correlated masking over Lambert.

    The dielectric is mixed of both by Schlick's Fresnel term, the metal is GGX with its base colour as reflectance.
    An ideal mirror (alpha 0) has no answer to a light without extent, but its diffuse part has.
    """
    nl, ne = dot(n, to_light), dot(n, e)
    if nl <= 0.0 or ne <= 0.0:
        return 0.0, 0.0, 0.0
    base = material.base_color
    diffuse = (1.0 - material.metallic) * (1.0 - material.transmission) * nl / math.pi
    if material.metallic == 0.0 and material.f90 == 0.0:
        return diffuse * base[0], diffuse * base[1], diffuse * base[2]
    h = unit((to_light[0] + e[0], to_light[1] + e[1], to_light[2] + e[2]))
    nh, eh = dot(n, h), min(max(dot(e, h), 0.0), 1.0)
    schlick = (1.0 - eh) ** 5
    fresnel = material.f0 + (material.f90 - material.f0) * schlick
    gloss = 0.0
    if material.alpha > 0.0:
        a2 = material.alpha * material.alpha
        t = nh * nh * (a2 - 1.0) + 1.0
        smith = nl * math.sqrt(ne * ne * (1.0 - a2) + a2) + ne * math.sqrt(nl * nl * (1.0 - a2) + a2)
        gloss = a2 / (math.pi * t * t) * 0.5 / smith * nl
    diffuse *= 1.0 - fresnel
    dielectric = (1.0 - material.metallic) * fresnel * gloss
    metal = material.metallic * gloss
    return (
        diffuse * base[0] + dielectric + metal * (base[0] + (1.0 - base[0]) * schlick),
        diffuse * base[1] + dielectric + metal * (base[1] + (1.0 - base[1]) * schlick),
        diffuse * base[2] + dielectric + metal * (base[2] + (1.0 - base[2]) * schlick),
    )


@leaf
def mirrored(material: np.void, cosine: float) -> Vector:
    """The part of radiance, RGB, that an ideal mirror sends on at this cosine to its normal; none of a rough one."""
    if material.alpha > 0.0:
        return 0.0, 0.0, 0.0
    schlick = (1.0 - min(max(cosine, 0.0), 1.0)) ** 5
    coat = (1.0 - material.metallic) * (material.f0 + (material.f90 - material.f0) * schlick)
    base, m = material.base_color, material.metallic
    return (
        coat + m * (base[0] + (1.0 - base[0]) * schlick),
        coat + m * (base[1] + (1.0 - base[1]) * schlick),
        coat + m * (base[2] + (1.0 - base[2]) * schlick),
    )


@leaf
def has_picture(lighting: Lighting) -> bool:
    """Whether the sky differs from direction to direction."""
    return len(lighting.surroundings.tables) > 0


@callee
def looked_up(surroundings: Surroundings, table: int, direction: Vector) -> Vector:
    """What a table of the surroundings has in a world direction, bilinearly between the middles of its texels.

    Beyond a pole the row goes on with itself, half around.
    """
    t = surroundings.tables
    row, height, width = t[table, 0], t[table, 1], t[table, 2]
    x = math.atan2(direction[0], direction[1]) / (2.0 * math.pi) + surroundings.turn
    x = (x - math.floor(x)) * width - 0.5
    y = math.acos(min(max(direction[2], -1.0), 1.0)) / math.pi * height - 0.5
    i, j = math.floor(x), math.floor(y)
    x, y = x - i, y - j
    red = green = blue = 0.0
    for k in range(4):
        column, line = i + (k & 1), j + (k >> 1)
        if line < 0 or line >= height:
            column += width // 2
            line = min(max(line, 0), height - 1)
        weight = (x if k & 1 else 1.0 - x) * (y if k & 2 else 1.0 - y) * surroundings.scale
        texel = surroundings.texels[row + line * width + column % width]
        red, green, blue = red + weight * texel[0], green + weight * texel[1], blue + weight * texel[2]
    return red, green, blue


@leaf
def sky_from(lighting: Lighting, direction: Vector) -> Vector:
    """Radiance of the sky in a world direction."""
    sky = lighting.sky
    red, green, blue = sky[0], sky[1], sky[2]
    if has_picture(lighting):
        more = looked_up(lighting.surroundings, 0, direction)
        red, green, blue = red + more[0], green + more[1], blue + more[2]
    return red, green, blue


@leaf
def sky_over(lighting: Lighting, n: Vector) -> Vector:
    """Radiance of a white matt surface turned to n, by all of the sky."""
    sky = lighting.sky
    red, green, blue = sky[0], sky[1], sky[2]
    if has_picture(lighting):
        more = looked_up(lighting.surroundings, IRRADIANCE, n)
        red, green, blue = red + more[0], green + more[1], blue + more[2]
    return red, green, blue


@leaf
def between(albedo: NDArray[np.float64], cosine: float, roughness: float, column: int) -> float:
    """A column of the table of `gloss_albedo`, bilinearly."""
    last = albedo.shape[0] - 1
    x, y = min(max(cosine, 0.0), 1.0) * last, roughness * last
    i, j = min(int(x), last - 1), min(int(y), last - 1)
    x -= i
    y -= j
    return (
        (1.0 - x) * ((1.0 - y) * albedo[i, j, column] + y * albedo[i, j + 1, column])
        + x * ((1.0 - y) * albedo[i + 1, j, column] + y * albedo[i + 1, j + 1, column])
    )  # fmt: skip


@callee
def glossed(
    surroundings: Surroundings, albedo: NDArray[np.float64], alpha: float, n: Vector, e: Vector
) -> Vector:  # fmt: skip
    """The mean radiance of the surroundings over the lobe that GGX sends to E; the picture's part of a split sum (B.
    Karis, "Real shading in Unreal Engine 4", 2013).

    Of the lobes that are seen head on, that serves which has the same mean of its directions: their middle and their
    spread are then those of the lobe that E sees. Pictures linear in the direction are exact.
    """
    ne, roughness = min(max(dot(n, e), 0.0), 1.0), math.sqrt(alpha)
    share = between(albedo, ne, roughness, 0)
    side, up = between(albedo, ne, roughness, 2) / share, between(albedo, ne, roughness, 3) / share
    t = (e[0] - ne * n[0], e[1] - ne * n[1], e[2] - ne * n[2])
    middle = unit((side * t[0] + up * n[0], side * t[1] + up * n[1], side * t[2] + up * n[2]))
    length = math.sqrt(side * side * dot(t, t) + up * up)
    last = albedo.shape[0] - 1
    j, before, after = 0, 1.0, 1.0
    while j < last:
        j += 1
        before, after = after, albedo[last, j, 3] / albedo[last, j, 0]
        if after < length:
            break
    part = min(max((before - length) / (before - after), 0.0), 1.0) if before > after else 1.0
    y = (j - 1 + part) / last * GLOSS_LEVELS
    k = min(int(y), GLOSS_LEVELS - 1)
    y -= k
    one, two = looked_up(surroundings, k, middle), looked_up(surroundings, k + 1, middle)
    return (
        (1.0 - y) * one[0] + y * two[0],
        (1.0 - y) * one[1] + y * two[1],
        (1.0 - y) * one[2] + y * two[2],
    )  # fmt: skip


DIFFUSE, GLOSSY, MIRROR = 1, 2, 4  # bits of `answers`


@kernel
def answers(materials: NDArray[np.void], slots: NDArray[np.int32]) -> int:
    """How these rows of `materials` send light on, all together: a sum of DIFFUSE, GLOSSY and MIRROR."""
    bits = 0
    for slot in slots:
        material = materials[slot]
        if material.metallic > 0.0 or material.f90 > 0.0:
            bits |= GLOSSY if material.alpha > 0.0 else MIRROR
        base = material.base_color
        if (1.0 - material.metallic) * (1.0 - material.transmission) * max(base[0], base[1], base[2]) > 0.0:
            bits |= DIFFUSE
    return bits


@leaf
def lit_by(light: np.void, material: np.void, n: Vector, e: Vector, at: Vector) -> Vector:
    """Radiance to E that one unblocked light causes at the world point `at`."""
    v = light.vector
    if light.kind == DIRECTIONAL:
        r = reflect(material, n, e, (v[0], v[1], v[2]))
        return r[0] * light.color[0], r[1] * light.color[1], r[2] * light.color[2]
    d = (v[0] - at[0], v[1] - at[1], v[2] - at[2])
    square = dot(d, d)
    if square <= 0.0:
        return 0.0, 0.0, 0.0
    r = reflect(material, n, e, unit(d))
    return r[0] * light.color[0] / square, r[1] * light.color[1] / square, r[2] * light.color[2] / square


@leaf
def are_distant(lights: NDArray[np.void]) -> bool:
    """Whether all lights shine from one direction each."""
    distant = True
    for l in range(len(lights)):
        distant = distant and lights[l].kind == DIRECTIONAL
    return distant


@leaf
def white(lighting: Lighting, at: Vector) -> float:
    """Radiance of a white matt surface at a world point, turned to each light, under the sky: what errors are measured
    by. The mean of the channels."""
    total = (
        3.0 * lighting.left + lighting.sky[0] + lighting.sky[1] + lighting.sky[2] + 3.0 * lighting.surroundings.white
    )
    for light in lighting.lights:
        part = (light.color[0] + light.color[1] + light.color[2]) / math.pi
        if light.kind != DIRECTIONAL:
            d = (light.vector[0] - at[0], light.vector[1] - at[1], light.vector[2] - at[2])
            part /= max(dot(d, d), 1e-300)
        total += part
    return total / 3.0


@leaf
def ambient(material: np.void, lighting: Lighting, albedo: NDArray[np.float64], n: Vector, e: Vector) -> Vector:
    """Radiance to E under the sky, unoccluded, and the material's own light.

    `albedo` is the table of `gloss_albedo`.
    """
    glow, base, sky = material.emissive, material.base_color, lighting.sky
    if not has_picture(lighting) and sky[0] == 0.0 and sky[1] == 0.0 and sky[2] == 0.0:
        return glow[0], glow[1], glow[2]
    body, gloss = sky_over(lighting, n), (sky[0], sky[1], sky[2])  # the sky's mean over the cosine, and over the lobe
    diffuse = (1.0 - material.metallic) * (1.0 - material.transmission)
    if material.metallic == 0.0 and material.f90 == 0.0:
        return (
            glow[0] + diffuse * base[0] * body[0],
            glow[1] + diffuse * base[1] * body[1],
            glow[2] + diffuse * base[2] * body[2],
        )
    plain = grazing = coat = 0.0
    if material.alpha == 0.0:  # the bounces see what the mirror shows
        coat = material.f0 + (material.f90 - material.f0) * (1.0 - min(max(dot(n, e), 0.0), 1.0)) ** 5
    else:
        ne, roughness = dot(n, e), math.sqrt(material.alpha)
        plain, grazing = between(albedo, ne, roughness, 0), between(albedo, ne, roughness, 1)
        if has_picture(lighting):
            more = glossed(lighting.surroundings, albedo, material.alpha, n, e)
            gloss = (sky[0] + more[0], sky[1] + more[1], sky[2] + more[2])
    dielectric = material.f0 * plain + (material.f90 - material.f0) * grazing
    # what the coat sends back does not reach the body; the Fresnel term's mean over the sky stands for it
    diffuse *= 1.0 - dielectric - coat
    dielectric *= 1.0 - material.metallic
    m = material.metallic
    return (
        glow[0] + body[0] * diffuse * base[0]
        + gloss[0] * (dielectric + m * (base[0] * plain + (1.0 - base[0]) * grazing)),
        glow[1] + body[1] * diffuse * base[1]
        + gloss[1] * (dielectric + m * (base[1] * plain + (1.0 - base[1]) * grazing)),
        glow[2] + body[2] * diffuse * base[2]
        + gloss[2] * (dielectric + m * (base[2] * plain + (1.0 - base[2]) * grazing)),
    )  # fmt: skip


@kernel
def gloss_albedo(size: int, samples: int) -> NDArray[np.float64]:
    """Share of a uniform sky that GGX sends to E, without Fresnel and weighted with Schlick's (1 - E.H)^5; and the sum
    of the directions it comes from, weighted without Fresnel: across the normal, in parts of E's, and along it.

    Shape (size, size, 4); rows the cosine to E from 0 to 1, columns the roughness from 0 to 1. Midpoints of
    `samples` by `samples` half vectors drawn as GGX distributes them: the estimator then is 2 G2/G1-like and smooth.
    """
    table = np.zeros((size, size, 4))
    for i in range(size):
        ne = min(max(i / (size - 1.0), 1e-3), 1.0 - 1e-9)
        se = math.sqrt(1.0 - ne * ne)
        for j in range(size):
            alpha = max((j / (size - 1.0)) ** 2, 1e-4)
            a2 = alpha * alpha
            for k in range(samples):
                r = (k + 0.5) / samples
                nh2 = (1.0 - r) / (1.0 + (a2 - 1.0) * r)
                nh, sh = math.sqrt(nh2), math.sqrt(max(1.0 - nh2, 0.0))
                for m in range(samples):
                    eh = se * sh * math.cos(math.pi * (m + 0.5) / samples) + ne * nh
                    nl = 2.0 * eh * nh - ne
                    if eh <= 0.0 or nl <= 0.0:
                        continue
                    smith = nl * math.sqrt(ne * ne * (1.0 - a2) + a2) + ne * math.sqrt(nl * nl * (1.0 - a2) + a2)
                    weight = 2.0 * nl * eh / (smith * nh) / (samples * samples)
                    table[i, j, 0] += weight
                    table[i, j, 1] += weight * (1.0 - eh) ** 5
                    table[i, j, 2] += weight * (2.0 * eh * sh * math.cos(math.pi * (m + 0.5) / samples) / se - 1.0)
                    table[i, j, 3] += weight * nl
    return table
