#!/usr/bin/env python3
"""Writes kernels/lib/sheen_table.h: the share of white light that the sheen of kernels/lib/sheen.h reflects.

Quadrature in double: z = u^3 towards the horizon, azimuth denser where wi mirrors wo. The surface under the fibres gets the rest, so
interpolation must not fall below the true value. Therefore each node is raised by the largest amount missing half-way to its neighbours.
"""
import math
import os
from concurrent.futures import ProcessPoolExecutor

COSINES, ROUGHNESSES, LEAST = 64, 48, 0.07
POINTS = 80


def exponent(x, alpha):
    t = (1 - alpha) ** 2
    a, b, c, d, e = (t * p + (1 - t) * q for p, q in
                     ((25.3245, 21.5473), (3.32435, 3.82987), (0.16801, 0.19823), (-1.27393, -1.97760), (-4.85967, -4.32054)))
    return a / (1 + b * x ** c) + d * x + e


def shadowing(cosine, alpha):
    if cosine < 0.5:
        return math.exp(exponent(cosine, alpha))
    return math.exp(2 * exponent(0.5, alpha) - exponent(1 - cosine, alpha))


def albedo(cosine, alpha):
    total, sine, own = 0.0, math.sqrt(1 - cosine * cosine), 1 + shadowing(cosine, alpha)
    azimuths = []
    for j in range(POINTS):
        p = 1 - (j + 0.5) / POINTS
        azimuths.append((math.cos(math.pi * (1 - p ** 3)), 3 * p * p * math.pi / POINTS))
    for i in range(POINTS):
        u = (i + 0.5) / POINTS
        z = u ** 3
        r, ring = math.sqrt(1 - z * z), 0.0
        for c, weight in azimuths:
            sum2 = 2 + 2 * (z * cosine + r * sine * c)
            sine2 = max(1 - (z + cosine) ** 2 / sum2, 0.0)
            ring += weight * sine2 ** (0.5 / alpha)
        total += ring * 2 * 3 * u * u / POINTS / (own + shadowing(z, alpha))
    return total * (2 + 1 / alpha) / (2 * math.pi) / (4 * cosine)


def row(j):
    """Returns values at nodes and half-way between them."""
    roughness = LEAST + (1 - LEAST) * j / (2 * ROUGHNESSES - 2)
    return [albedo(max((i / (2 * COSINES - 2)) ** 2, 1e-6), roughness * roughness) for i in range(2 * COSINES - 1)]


def lifted(fine, i, j):
    """Returns node (i, j) of the coarse table."""
    def node(y, x):
        return fine[2 * y][2 * x]

    missing = 0.0
    for y in range(max(2 * j - 1, 0), min(2 * j + 2, len(fine))):
        for x in range(max(2 * i - 1, 0), min(2 * i + 2, len(fine[0]))):
            around = [node(b, a) for b in {y // 2, (y + 1) // 2} for a in {x // 2, (x + 1) // 2}]
            missing = max(missing, fine[y][x] - sum(around) / len(around))
    return node(j, i) + 1.05 * missing


def main():
    with ProcessPoolExecutor() as pool:
        fine = list(pool.map(row, range(2 * ROUGHNESSES - 1)))
    rows = [[lifted(fine, i, j) for i in range(COSINES)] for j in range(ROUGHNESSES)]
    text = "\n".join("    " + " ".join(f"{v:.5f}f," for v in r[k:k + 16]) for r in rows for k in range(0, COSINES, 16))
    path = os.path.join(os.path.dirname(__file__), "..", "kernels", "lib", "sheen_table.h")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"""/* Written by tools/sheen_table.py; do not edit. E of sheen.h: a row for each roughness, evenly from {LEAST} to 1; in it a value for each
 * cosine, whose roots go evenly from 0 to 1. */
#ifndef EC_LIB_SHEEN_TABLE_H
#define EC_LIB_SHEEN_TABLE_H

#define SHEEN_COSINES {COSINES}
#define SHEEN_ROUGHNESSES {ROUGHNESSES}
#define SHEEN_LEAST_ROUGHNESS {LEAST}f

constant float sheen_table[SHEEN_ROUGHNESSES * SHEEN_COSINES] = {{
{text}
}};

#endif
""")


if __name__ == "__main__":
    main()
