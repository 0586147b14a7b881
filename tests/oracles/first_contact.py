# SPDX-License-Identifier: GPL-3.0-or-later
"""First contact of a moving pair in integer arithmetic: an oracle that shares nothing with the library.

Two primitives touch for the first time at 0, or when a polynomial in time changes sign or touches zero: the
volume of the four points (cubic), or, for pairs that stay in one plane, an area of three of them (quadratic).
At each root, isolated to 2^-160, the squared distance is compared. Doubles are integers over a common power
of two.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations, pairwise
from math import comb, gcd, lcm

Polynomial = list[int]  # lowest power first, no trailing zeros
Vector = tuple[int, int, int]

BITS = 160
WIDTH = Fraction(1, 2**BITS)
NEAR = 140
"""Primitives count as touching within 2^-NEAR of the largest coordinate, which the isolation of roots cannot tell."""


def trim(p: Polynomial) -> Polynomial:
    while p and p[-1] == 0:
        p = p[:-1]
    return p


def value(p: Polynomial, t: int) -> int:
    """Return p(t / 2^BITS) 2^(BITS degree)."""
    result, scale = 0, 1
    for coefficient in reversed(p):
        result = result * t + coefficient * scale
        scale <<= BITS
    return result


def derivative(p: Polynomial) -> Polynomial:
    return trim([k * c for k, c in enumerate(p)][1:])


def remainder(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return p modulo q, times a factor."""
    while len(p) >= len(q):
        shift, lead = len(p) - len(q), p[-1]
        p = trim([q[-1] * c - (lead * q[k - shift] if k >= shift else 0) for k, c in enumerate(p)][:-1])
    return primitive(p)


def primitive(p: Polynomial) -> Polynomial:
    factor = gcd(*p) if p else 1
    return [c // factor for c in p]


def square_free(p: Polynomial) -> Polynomial:
    """Divide by the greatest common divisor with the derivative, which makes every root simple."""
    a, b = primitive(p), primitive(derivative(p))
    while b:
        a, b = b, remainder(a, b)
    quotient: Polynomial = []
    rest = primitive(p)
    factor = a[-1] ** (len(rest) - len(a) + 1)
    rest = [factor * c for c in rest]
    while len(rest) >= len(a):
        lead, shift = rest[-1] // a[-1], len(rest) - len(a)
        quotient.insert(0, lead)
        rest = [c - (lead * a[k - shift] if k >= shift else 0) for k, c in enumerate(rest)][:-1]
    return primitive(quotient)


def one_sign_in_the_unit_interval(p: Polynomial) -> bool:
    """Tell whether all Bernstein coefficients have the same sign, so that there is no root."""
    degree = len(p) - 1
    signs = {
        sum(comb(degree - i, k - i) * p[i] for i in range(k + 1)) > 0  # times comb(degree, k)
        for k in range(degree + 1)
    }
    zero = any(sum(comb(degree - i, k - i) * p[i] for i in range(k + 1)) == 0 for k in range(degree + 1))
    return len(signs) == 1 and not zero


def roots(p: Polynomial) -> list[int]:
    """Roots in [0, 1] of a nonzero polynomial, times 2^BITS, each too small by less than 1."""
    if len(p) <= 1 or one_sign_in_the_unit_interval(p):
        return []
    return simple_roots(square_free(p))


def simple_roots(p: Polynomial) -> list[int]:
    if len(p) <= 1:
        return []
    end = 1 << BITS
    turns = [t for root in roots(derivative(p)) for t in (root, min(root + 1, end))]
    marks = sorted({0, end, *turns})
    values = [value(p, mark) for mark in marks]
    found = [mark for mark, height in zip(marks, values, strict=True) if height == 0]
    for (low, at_low), (high, at_high) in pairwise(zip(marks, values, strict=True)):
        if at_low * at_high < 0:
            found.append(bisect(p, low, high, at_low < 0))
    return sorted(found)


def bisect(p: Polynomial, low: int, high: int, rising: bool) -> int:
    while high - low > 1:
        middle = (low + high) // 2
        if (value(p, middle) < 0) == rising:
            low = middle
        else:
            high = middle
    return low


def subtract(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a: Vector, b: Vector) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def to_segment(p: Vector, a: Vector, b: Vector) -> tuple[int, int]:
    """Squared distance of a point and a segment, numerator and denominator."""
    along, to_point = subtract(b, a), subtract(p, a)
    length, share = dot(along, along), dot(along, to_point)
    if share <= 0 or length == 0:
        return dot(to_point, to_point), 1
    if share >= length:
        beyond = subtract(p, b)
        return dot(beyond, beyond), 1
    return dot(to_point, to_point) * length - share * share, length


def squared_distances(kind: str, x: Sequence[Vector]) -> Iterable[tuple[int, int]]:
    """Squared distances, as numerators and denominators; the least is that of the primitives."""
    if kind == "vf":
        yield from (to_segment(x[0], x[a], x[b]) for a, b in ((1, 2), (2, 3), (3, 1)))
        u, v, r = subtract(x[2], x[1]), subtract(x[3], x[1]), subtract(x[0], x[1])
        normal = cross(u, v)
        size = dot(normal, normal)
        b, c = dot(normal, cross(r, v)), dot(normal, cross(u, r))
        inside = size > 0 and b >= 0 and c >= 0 and b + c <= size
    else:
        yield from (to_segment(x[p], x[a], x[b]) for p, a, b in ((0, 2, 3), (1, 2, 3), (2, 0, 1), (3, 0, 1)))
        u, v, r = subtract(x[1], x[0]), subtract(x[3], x[2]), subtract(x[2], x[0])
        normal = cross(u, v)
        size = dot(normal, normal)
        s, t = dot(cross(r, v), normal), dot(cross(r, u), normal)
        inside = size > 0 and 0 <= s <= size and 0 <= t <= size
    if inside:
        yield dot(normal, r) ** 2, size


def integers(points: Iterable[Iterable[Fraction | float | int]]) -> tuple[list[Vector], int]:
    """Points as integers over a common denominator."""
    exact = [[Fraction(c) for c in point] for point in points]
    scale = lcm(*(c.denominator for point in exact for c in point))
    whole = [tuple(c.numerator * (scale // c.denominator) for c in point) for point in exact]
    return whole, scale  # type: ignore[return-value]


def squared_distance(kind: str, x: Iterable[Iterable[Fraction | float | int]]) -> Fraction:
    points, scale = integers(x)
    return min(Fraction(a, b) for a, b in squared_distances(kind, points)) / scale**2


def critical_polynomials(start: Sequence[Vector], step: Sequence[Vector]) -> list[Polynomial]:
    sides = [(subtract(start[k], start[0]), subtract(step[k], step[0])) for k in (1, 2, 3)]
    normal = cross_paths(sides[1], sides[2])
    volume = [0, 0, 0, 0]
    for k in range(3):
        volume[k] += dot(sides[0][0], normal[k])
        volume[k + 1] += dot(sides[0][1], normal[k])
    if any(volume):
        return [trim(volume)]
    areas = [
        [normal[k][axis] for k in range(3)]
        for a, b, c in combinations(range(4), 3)
        for normal in [cross_paths(difference(start, step, b, a), difference(start, step, c, a))]
        for axis in range(3)
    ]
    distances = [
        [path[0][axis], path[1][axis]]
        for a, b in combinations(range(4), 2)
        for path in [difference(start, step, b, a)]
        for axis in range(3)
    ]
    return [trim(p) for p in areas + distances if any(p)]


Path = tuple[Vector, Vector]
"""Where a vector starts, and how it moves."""


def difference(start: Sequence[Vector], step: Sequence[Vector], a: int, b: int) -> Path:
    return subtract(start[a], start[b]), subtract(step[a], step[b])


def cross_paths(p: Path, q: Path) -> tuple[Vector, Vector, Vector]:
    first, second = cross(p[0], q[1]), cross(p[1], q[0])
    return cross(p[0], q[0]), (first[0] + second[0], first[1] + second[1], first[2] + second[2]), cross(p[1], q[1])


def first_contact(
    kind: str, start: Iterable[Iterable[Fraction | float | int]], end: Iterable[Iterable[Fraction | float | int]]
) -> Fraction | None:
    """Time of the first contact, too early by less than WIDTH; None if there is none."""
    points, _ = integers([*start, *end])
    first, step = points[:4], [subtract(b, a) for a, b in zip(points[:4], points[4:], strict=True)]
    size = max(abs(c) for point in points for c in point) or 1
    limit = (size << (BITS - NEAR)) ** 2
    times = {0}
    for polynomial in critical_polynomials(first, step):
        times.update(roots(polynomial))
    for time in sorted(times):
        x = [tuple((a << BITS) + time * d for a, d in zip(p, s, strict=True)) for p, s in zip(first, step, strict=True)]
        if any(a <= limit * b for a, b in squared_distances(kind, x)):  # type: ignore[arg-type]
            return Fraction(time, 1 << BITS)
    return None
