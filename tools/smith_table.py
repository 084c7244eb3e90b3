#!/usr/bin/env python3
"""usage: tools/smith_table.py
Prints the table in docs/materials.md that compares two forms of Smith's masking on a white microfacet surface, by quadrature over visible normals
(Heitz 2018). The figure is the share of uniform white light that is reflected with height-correlated masking, which eclat uses. In brackets is how
much less the product in appendix B of glTF's specification reflects."""
import math

ROUGHNESS, COSINES, STEPS = (0.25, 0.5, 0.75, 1.0), (1, 0.7, 0.5, 0.3, 0.1, 0.03), 400


def smith(cosine, alpha):
    """Returns Heitz's Lambda (2014): masking is 1 / (1 + this)."""
    return 0.5 * (math.sqrt(1 + alpha * alpha * (1 - cosine * cosine) / (cosine * cosine)) - 1)


def returned(cosine, alpha):
    """Returns the share that is reflected: (height-correlated, product)."""
    view = (math.sqrt(1 - cosine * cosine), 0.0, cosine)
    length = math.hypot(alpha * view[0], view[2])
    warped = (alpha * view[0] / length, 0.0, view[2] / length)
    across, own, both, product = (-warped[2], 0.0, warped[0]), smith(cosine, alpha), 0.0, 0.0
    for i in range(STEPS):
        for j in range(STEPS):
            radius, around = math.sqrt((i + 0.5) / STEPS), 2 * math.pi * (j + 0.5) / STEPS
            y, x, half = radius * math.cos(around), radius * math.sin(around), 0.5 * (1 + warped[2])
            x = (1 - half) * math.sqrt(1 - y * y) + half * x
            up = math.sqrt(max(0.0, 1 - x * x - y * y))
            normal = (alpha * (x * across[0] + up * warped[0]), alpha * y, max(0.0, x * across[2] + up * warped[2]))
            size = math.sqrt(sum(n * n for n in normal))
            facing = sum(v * n for v, n in zip(view, normal)) / size
            light = 2 * facing * normal[2] / size - view[2]
            if light > 0:
                other = smith(light, alpha)
                both += (1 + own) / (1 + own + other)
                product += 1 / (1 + other)
    return both / STEPS ** 2, product / STEPS ** 2


def main():
    print("| roughness | " + " | ".join(f"cosine {cosine:g}" for cosine in COSINES) + " |\n|" + "---|" * (len(COSINES) + 1))
    for roughness in ROUGHNESS:
        cells = []
        for cosine in COSINES:
            both, product = returned(cosine, roughness * roughness)
            cells.append(f"{100 * both:.1f}\u00a0% (−{100 * (1 - product / both):.1f}\u00a0%)")
        print(f"| {roughness:g} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
