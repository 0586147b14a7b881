# SPDX-License-Identifier: GPL-3.0-or-later
"""First contact of a moving pair in rational arithmetic: an oracle that shares nothing with the library.

Two primitives touch for the first time at 0, or when a polynomial in time changes sign or touches zero: the volume of
the four points (cubic), or, for pairs that stay in one plane, an area of three of them (quadratic). At each root,
isolated to 2^-80, the squared distance is evaluated.
"""

from fractions import Fraction
from itertools import combinations, pairwise

Polynomial = list[Fraction]  # lowest power first
Vector = tuple[Fraction, Fraction, Fraction]

WIDTH = Fraction(1, 2**80)


def trim(p: Polynomial) -> Polynomial:
    while p and p[-1] == 0:
        p = p[:-1]
    return p


def add(p: Polynomial, q: Polynomial, factor: int = 1) -> Polynomial:
    size = max(len(p), len(q))
    return trim(
        [(p[k] if k < len(p) else Fraction(0)) + factor * (q[k] if k < len(q) else Fraction(0)) for k in range(size)]
    )


def multiply(p: Polynomial, q: Polynomial) -> Polynomial:
    product = [Fraction(0)] * max(len(p) + len(q) - 1, 0)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            product[i + j] += a * b
    return trim(product)


def divide(p: Polynomial, q: Polynomial) -> tuple[Polynomial, Polynomial]:
    quotient = [Fraction(0)] * max(len(p) - len(q) + 1, 0)
    while len(p) >= len(q):
        factor, shift = p[-1] / q[-1], len(p) - len(q)
        quotient[shift] = factor
        p = trim(add(p, [Fraction(0)] * shift + [factor * c for c in q], -1)[: len(p) - 1])
    return trim(quotient), p


def value(p: Polynomial, t: Fraction) -> Fraction:
    result = Fraction(0)
    for coefficient in reversed(p):
        result = result * t + coefficient
    return result


def derivative(p: Polynomial) -> Polynomial:
    return [k * c for k, c in enumerate(p)][1:]


def square_free(p: Polynomial) -> Polynomial:
    a, b = p, derivative(p)
    while b:
        a, b = b, divide(a, b)[1]
    return divide(p, a)[0]


def roots(p: Polynomial) -> list[Fraction]:
    """Roots in [0, 1] of a polynomial that is not zero, each from below by less than WIDTH."""
    return simple_roots(square_free(p)) if len(p) > 1 else []


def simple_roots(p: Polynomial) -> list[Fraction]:
    if len(p) <= 1:
        return []
    turns = [t for root in roots(derivative(p)) for t in (root, min(root + WIDTH, Fraction(1)))]
    marks = sorted({Fraction(0), Fraction(1), *turns})
    found = [mark for mark in marks if value(p, mark) == 0]
    for low, high in pairwise(marks):
        if value(p, low) * value(p, high) < 0:
            found.append(bisect(p, low, high))
    return sorted(found)


def bisect(p: Polynomial, low: Fraction, high: Fraction) -> Fraction:
    rising = value(p, low) < 0
    while high - low > WIDTH:
        middle = (low + high) / 2
        if (value(p, middle) < 0) == rising:
            low = middle
        else:
            high = middle
    return low


def subtract(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a: Vector, b: Vector) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def to_segment(p: Vector, a: Vector, b: Vector) -> Fraction:
    """Squared distance of a point and a segment."""
    along, to_point = subtract(b, a), subtract(p, a)
    length = dot(along, along)
    s = min(max(dot(along, to_point) / length, Fraction(0)), Fraction(1)) if length else Fraction(0)
    gap = tuple(to_point[k] - s * along[k] for k in range(3))
    return dot(gap, gap)


def squared_distance(kind: str, x: list[Vector]) -> Fraction:
    if kind == "vf":
        best = min(to_segment(x[0], x[a], x[b]) for a, b in ((1, 2), (2, 3), (3, 1)))
        u, v, r = subtract(x[2], x[1]), subtract(x[3], x[1]), subtract(x[0], x[1])
        normal = cross(u, v)
        size = dot(normal, normal)
        if size:
            b, c = dot(normal, cross(r, v)) / size, dot(normal, cross(u, r)) / size
            inside = b >= 0 and c >= 0 and b + c <= 1
    else:
        best = min(to_segment(x[p], x[a], x[b]) for p, a, b in ((0, 2, 3), (1, 2, 3), (2, 0, 1), (3, 0, 1)))
        u, v, r = subtract(x[1], x[0]), subtract(x[3], x[2]), subtract(x[2], x[0])
        normal = cross(u, v)
        size = dot(normal, normal)
        if size:
            s, t = dot(cross(r, v), normal) / size, dot(cross(r, u), normal) / size
            inside = 0 <= s <= 1 and 0 <= t <= 1
    return min(best, dot(normal, r) ** 2 / size) if size and inside else best


def path(start: Vector, end: Vector) -> list[Polynomial]:
    return [trim([a, b - a]) for a, b in zip(start, end, strict=True)]


def difference(p: list[Polynomial], q: list[Polynomial]) -> list[Polynomial]:
    return [add(a, b, -1) for a, b in zip(p, q, strict=True)]


def cross_paths(p: list[Polynomial], q: list[Polynomial]) -> list[Polynomial]:
    return [add(multiply(p[i], q[j]), multiply(p[j], q[i]), -1) for i, j in ((1, 2), (2, 0), (0, 1))]


def critical_polynomials(paths: list[list[Polynomial]]) -> list[Polynomial]:
    sides = [difference(paths[k], paths[0]) for k in (1, 2, 3)]
    normal = cross_paths(sides[1], sides[2])
    volume: Polynomial = []
    for k in range(3):
        volume = add(volume, multiply(sides[0][k], normal[k]))
    if volume:
        return [volume]
    areas = [
        component
        for a, b, c in combinations(range(4), 3)
        for component in cross_paths(difference(paths[b], paths[a]), difference(paths[c], paths[a]))
    ]
    distances = [component for a, b in combinations(range(4), 2) for component in difference(paths[a], paths[b])]
    return [p for p in areas + distances if p]


def first_contact(kind: str, start: list[Vector], end: list[Vector]) -> Fraction | None:
    """Time of the first contact, from below by less than WIDTH; None if there is none."""
    paths = [path(a, b) for a, b in zip(start, end, strict=True)]
    size = max(abs(c) for points in (start, end) for point in points for c in point) or Fraction(1)
    times = {Fraction(0)}
    for polynomial in critical_polynomials(paths):
        times.update(roots(polynomial))
    for time in sorted(times):
        points = [tuple(value(axis, time) for axis in p) for p in paths]
        if squared_distance(kind, points) <= (size / 2**60) ** 2:  # type: ignore[arg-type]
            return time
    return None
