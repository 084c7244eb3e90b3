#!/usr/bin/env python3
"""Writes kernels/lib/multiscatter_table.h: the share of light that GGX microfacets lose when they scatter it only once (ggx.h, bsdf.h).

Quadrature in double over visible normals: half the azimuth, Gauss-Legendre points along the cap with its square roots taken out. A surface
must not give back more than was lost, so interpolation must stay below the true value. Therefore each node is lowered by the largest excess
between it and its neighbours, on a grid of twice the points. Needs numpy."""
import os
from concurrent.futures import ProcessPoolExecutor

import numpy as np

COSINES, ROUGHNESSES, INDICES = 24, 20, 17  # INDICES is odd: the middle one does not refract, the outermost are the two sides of a mirror
FINER = 2                                   # times as many points, at which interpolation is checked
AROUND, ALONG = 96, 96
MARGIN = 1.5, 1e-4                          # a factor on the excess found; an allowance for quadrature and rounding


def contrasts(count):
    """Returns (eta - 1) / (eta + 1) for each index, denser around 0, where nothing is refracted."""
    q = np.linspace(-1, 1, count)
    return np.sign(q) * q * q


def fresnel(c, eta):
    g2 = c * c + eta * eta - 1
    g = np.sqrt(np.maximum(g2, 0))
    f = 0.5 * ((c - g) / (c + g)) ** 2 * (1 + ((c * (c + g) - 1) / (c * (g - c) + 1 + 1e-300)) ** 2)
    return np.where(g2 > 0, np.minimum(f, 1), 1.0)


def masked(z, cosine, alpha):
    """Returns G2 / G1 of a direction at cosine z (0 below the horizon), given the other direction."""
    own, other = (np.sqrt(x * x * (1 - alpha * alpha) + alpha * alpha) for x in (cosine, np.maximum(z, 0)))
    return np.where(z > 0, z * (cosine + own) / np.maximum(z * own + cosine * other, 1e-300), 0.0)


def lost(cosine, alpha, contrast, around=AROUND, along=ALONG):
    """Returns the share of white light from this side that is neither reflected nor transmitted, for each contrast; +-1: nothing is transmitted."""
    x, w = np.polynomial.legendre.leggauss(along)
    s, w = (x + 1) / 2, w / 2
    down, w = s * s * (3 - 2 * s), w * 6 * s * (1 - s)
    phi = np.pi * (np.arange(around) + 0.5) / around
    sine = np.sqrt(1 - cosine * cosine)
    length = np.hypot(sine * alpha, cosine)
    wx, wz = sine * alpha / length, cosine / length
    down = (down * (1 + wz))[:, None]
    st = np.sqrt(np.maximum(down * (2 - down), 0))
    mx, my, mz = (st * np.cos(phi) + wx) * alpha, st * np.sin(phi) * alpha, 1 + wz - down
    length = np.sqrt(mx * mx + my * my + mz * mz)
    mx, mz = mx / length, mz / length
    om = np.maximum(mx * sine + mz * cosine, 0)
    back = masked(2 * om * mz - cosine, cosine, alpha)
    result = []
    for r in contrast:
        if abs(r) == 1:
            value = back
        else:
            eta = (1 + r) / (1 - r)
            f = fresnel(om, eta) if r else 0 * om
            g = np.sqrt(np.maximum(om * om + eta * eta - 1, 0))
            value = f * back + (1 - f) * masked(((g - om) * mz + cosine) / eta, cosine, alpha)
        result.append(1 - np.mean(value, 1) @ w)
    return result


def fine_row(arguments):
    j, cosines, contrast = arguments
    alpha = (j / (FINER * (ROUGHNESSES - 1))) ** 2
    if j == 0:
        return np.zeros((len(cosines), len(contrast)))
    return np.array([lost(c, alpha, contrast) for c in cosines])


def interpolated(coarse):
    """Returns the coarse table [roughness, cosine, index] on the fine grid, interpolated linearly along each axis."""
    for axis in range(3):
        n = coarse.shape[axis]
        x = np.arange((n - 1) * FINER + 1) / FINER
        low = np.minimum(x.astype(int), n - 2)
        shape = [1, 1, 1]
        shape[axis] = -1
        t = (x - low).reshape(shape)
        coarse = (1 - t) * np.take(coarse, low, axis) + t * np.take(coarse, low + 1, axis)
    return coarse


def lowered(fine):
    """Lowers nodes in rounds: a node at 0 can go no lower, and leaves the rest to its neighbours."""
    coarse, times = np.maximum(fine[::FINER, ::FINER, ::FINER] - MARGIN[1], 0), MARGIN[0]
    while True:
        too_much = np.maximum(interpolated(coarse) - np.maximum(fine - MARGIN[1], 0), 0)
        if too_much.max() < 1e-9:
            return coarse
        worst = np.zeros_like(coarse)
        for index in np.ndindex(coarse.shape):
            worst[index] = too_much[tuple(slice(max(i - 1, 0) * FINER, (i + 1) * FINER + 1) for i in index)].max()
        coarse = np.maximum(coarse - times * worst, 0)


def means(table):
    """Returns the cosine-weighted mean of the interpolated table over the hemisphere: linear in sqrt(cosine) between nodes."""
    x, w = np.polynomial.legendre.leggauss(4)
    n = table.shape[1] - 1
    total = np.zeros((table.shape[0], table.shape[2]))
    for i in range(n):
        for u, weight in zip((x + 1) / 2, w / 2):
            t = (i + u) / n
            total += weight / n * 4 * t ** 3 * ((1 - u) * table[:, i] + u * table[:, i + 1])
    return total


def make():
    """Returns the table [index, roughness, cosine], with the mean in the last column of each row."""
    cosines = np.maximum(np.linspace(0, 1, FINER * (COSINES - 1) + 1) ** 2, 1e-5)
    fine_contrasts = contrasts(FINER * (INDICES - 1) + 1)
    with ProcessPoolExecutor() as pool:
        fine = np.array(list(pool.map(fine_row, [(j, cosines, fine_contrasts) for j in range(FINER * (ROUGHNESSES - 1) + 1)])))
    table = np.floor(lowered(fine) * 1e5) / 1e5
    return np.concatenate([table, means(table)[:, None, :]], 1).transpose(2, 0, 1)


def main():
    table = make()
    text = "\n".join("    " + " ".join(f"{v:.5f}f," for v in row[:-1]) + f" {row[-1]:.8e}f," for side in table for row in side)
    path = os.path.join(os.path.dirname(__file__), "..", "kernels", "lib", "multiscatter_table.h")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"""/* Written by tools/multiscatter_table.py; do not edit. What multiscatter.h interpolates: for each contrast, whose signed roots go evenly
 * from -1 to 1, a row for each roughness, evenly from 0 to 1; in it a value for each cosine, whose roots go evenly from 0 to 1, and
 * behind them their mean, which stands for the integral of 2 cosine times what is interpolated. */
#ifndef EC_LIB_MULTISCATTER_TABLE_H
#define EC_LIB_MULTISCATTER_TABLE_H

#define MULTISCATTER_COSINES {COSINES}
#define MULTISCATTER_ROUGHNESSES {ROUGHNESSES}
#define MULTISCATTER_CONTRASTS {INDICES}

constant float multiscatter_table[MULTISCATTER_CONTRASTS * MULTISCATTER_ROUGHNESSES * (MULTISCATTER_COSINES + 1) + 1 /* read, times 0 */] = {{
{text}
}};

#endif
""")


if __name__ == "__main__":
    main()
