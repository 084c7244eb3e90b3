#include "image/tone_curve.h"

#include <math.h>

static double cut(double x) { return fmin(fmax(x, 0), 1); }

static void multiply(const double m[3][3], double rgb[3])
{
    const double r = rgb[0], g = rgb[1], b = rgb[2];
    for (int c = 0; c < 3; c++) rgb[c] = m[c][0] * r + m[c][1] * g + m[c][2] * b;
}

/* Khronos PBR Neutral, https://github.com/KhronosGroup/ToneMapping/tree/main/PBR_Neutral; symbols as in its specification. */
static void pbr_neutral(double rgb[3])
{
    const double F90 = 0.04, Ks = 0.8 - F90, Kd = 0.15;
    double x = fmin(rgb[0], fmin(rgb[1], rgb[2]));
    double f = x <= 2 * F90 ? x - x * x / (4 * F90) : F90;
    for (int c = 0; c < 3; c++) rgb[c] -= f;
    double p = fmax(rgb[0], fmax(rgb[1], rgb[2]));
    if (p <= Ks) return;
    double pn = 1 - (1 - Ks) * (1 - Ks) / (p + 1 - 2 * Ks);
    double g = 1 / (Kd * (p - pn) + 1);
    for (int c = 0; c < 3; c++) rgb[c] = rgb[c] * (pn / p) * g + pn * (1 - g);
}

/* Stephen Hill's fit of ACES' reference and sRGB output transforms (BakingLab, 2016), 1 / 0.6 times as bright as there, like three.js. */
static void aces(double rgb[3])
{
    static const double in[3][3] = {{0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}};
    static const double out[3][3] = {{1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}};
    multiply(in, rgb);
    for (int c = 0; c < 3; c++) {
        const double v = rgb[c] / 0.6;
        rgb[c] = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    multiply(out, rgb);
}

/* Troy Sobotka's AgX in Rec. 2020, with Wrensch's polynomial for its sigmoid (2023) and the matrices of Filament and three.js (Rec. 709 to 2020:
 * ITU-R BT.2407, four digits). */
static void agx(double rgb[3])
{
    static const double to_2020[3][3] = {{0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0113}, {0.0164, 0.0880, 0.8956}};
    static const double to_709[3][3] = {{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}};
    static const double inset[3][3] = {{0.856627153315983, 0.0951212405381588, 0.0482516061458583},
                                       {0.137318972929847, 0.761241990602591, 0.101439036467562},
                                       {0.11189821299995, 0.0767994186031903, 0.811302368396859}};
    static const double outset[3][3] = {{1.1271005818144368, -0.11060664309660323, -0.016493938717834573},
                                        {-0.1413297634984383, 1.157823702216272, -0.016493938717834257},
                                        {-0.14132976349843826, -0.11060664309660294, 1.2519364065950405}};
    static const double sigmoid[] = {15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232};
    const double darkest = -12.47393, brightest = 4.026069; /* log2: 10 stops below 0.18 and 6.5 above */
    multiply(to_2020, rgb);
    multiply(inset, rgb);
    for (int c = 0; c < 3; c++) {
        const double x = cut((log2(fmax(rgb[c], 1e-10)) - darkest) / (brightest - darkest));
        rgb[c] = 0;
        for (int k = 0; k < 7; k++) rgb[c] = rgb[c] * x + sigmoid[k];
    }
    multiply(outset, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = pow(fmax(rgb[c], 0), 2.2);
    multiply(to_709, rgb);
}

/* The curve of Jim Hejl and Richard Burgess-Dawson (Hable, "Filmic Tonemapping Operators", 2010), which includes a display gamma of 2.2. */
static void filmic(double rgb[3])
{
    for (int c = 0; c < 3; c++) {
        const double x = fmax(rgb[c] - 0.004, 0);
        rgb[c] = pow(x * (6.2 * x + 0.5) / (x * (6.2 * x + 1.7) + 0.06), 2.2);
    }
}

void ec_tone_curve_apply(ec_tonemap curve, double rgb[3])
{
    static void (*const curves[EC_TONEMAP_COUNT])(double[3]) = {
        [EC_TONEMAP_NEUTRAL] = pbr_neutral, [EC_TONEMAP_ACES] = aces, [EC_TONEMAP_AGX] = agx, [EC_TONEMAP_FILMIC] = filmic};
    if (curves[curve]) curves[curve](rgb);
    for (int c = 0; c < 3; c++) rgb[c] = cut(rgb[c]);
}
