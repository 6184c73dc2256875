#!/usr/bin/env python3
"""Prints the polynomial of ltcArc in render/shaders/ltc.glsl: h / sin h, h = 0 to 90 degrees, in u = 1 - cos h,
1 at u = 0, with the least largest relative error (Remez). Argument: its degree (default 8)."""
import math
import sys
from fractions import Fraction


def value(u):
    h = 2.0 * math.asin(math.sqrt(0.5 * u))
    return h / math.sin(h) if h > 0.0 else 1.0


def solve(rows):
    """Gauss in fractions: the last column is the right side."""
    rows = [[Fraction(v) for v in row] for row in rows]
    n = len(rows)
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(n):
            if r != i:
                factor = rows[r][i] / rows[i][i]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    return [float(rows[i][n] / rows[i][i]) for i in range(n)]


def error(coefficients, u):
    p = 0.0
    for c in reversed(coefficients):
        p = (p + c) * u
    return (1.0 + p) / value(u) - 1.0


def fit(degree):
    # as many points as coefficients and the error's height; none at 0, where the error is 0
    points = [0.5 - 0.5 * math.cos(math.pi * (i + 1) / (degree + 1)) for i in range(degree + 1)]
    grid = [0.5 - 0.5 * math.cos(math.pi * i / 6000) for i in range(1, 6001)]
    while True:
        rows = [[u ** (k + 1) for k in range(degree)] + [(-1) ** i * value(u), value(u) - 1.0]
                for i, u in enumerate(points)]
        *coefficients, height = solve(rows)
        errors = [error(coefficients, u) for u in grid]
        worst = max(map(abs, errors))
        if worst < 1.001 * abs(height):
            return coefficients, worst
        # the extremum of each stretch of one sign; the outermost, near 0, is left out where there is one more
        extrema = [0]
        for i in range(1, len(grid)):
            if (errors[i] > 0.0) != (errors[extrema[-1]] > 0.0):
                extrema.append(i)
            elif abs(errors[i]) > abs(errors[extrema[-1]]):
                extrema[-1] = i
        points = [grid[i] for i in extrema[-(degree + 1):]]


coefficients, worst = fit(int(sys.argv[1]) if len(sys.argv) > 1 else 8)
print("1", *(f"{c:+.9g} u^{k + 1}" for k, c in enumerate(coefficients)))
print(f"largest relative error {worst:.2g}")
