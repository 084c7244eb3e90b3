/* A clear sky: sunlight scattered once by air and haze (Nishita et al. 1993), and further scattering as if it were isotropic (Hillaire 2020, "A
 * Scalable and Production Ready Sky and Atmosphere Rendering Technique"), whose coefficients are used, in linear Rec. 709. Units are kilometres;
 * positions are given by their distance r from the Earth's centre, directions by cosines: mu to the zenith, mu_s of the sun's direction, nu between
 * the two. */
#include <math.h>
#include <string.h>

#include "scene/built_in.h"

#define PI 3.14159265358979323846
#define GROUND 6360.0
#define TOP 6460.0
#define OBSERVER (GROUND + 0.05)
#define ALBEDO 0.3        /* of the ground */
#define SUN_RADIUS 0.0087 /* radians, the smallest that a map 1024 wide can show: 1.9 times the sun's own */
#define HAZE 0.8          /* g of the phase function */
/* Irradiance of the sun above the air, white: it gives, with the sky's, pi on the ground if the sun is at the zenith. */
#define SUN 3.318

enum { STEPS = 32, SUN_STEPS = 16, HEIGHTS = 12, SUNS = 32, ROWS = 96, COLUMNS = 64 };

static const double air[3] = {0.005802, 0.013558, 0.033100}, ozone[3] = {0.000650, 0.001881, 0.000085};
static const double haze = 0.003996, haze_absorbs = 0.004400;

/* By height and the sun's elevation: radiance of light scattered twice or more, for a sun of irradiance 1. */
typedef struct multiple {
    double radiance[HEIGHTS][SUNS][3];
} multiple;

static void densities(double r, double density[3])
{
    const double h = r - GROUND;
    density[0] = exp(-h / 8);
    density[1] = exp(-h / 1.2);
    density[2] = fmax(1 - fabs(h - 25) / 15, 0);
}

static double extinction(const double density[3], int c) { return air[c] * density[0] + (haze + haze_absorbs) * density[1] + ozone[c] * density[2]; }

static double at_distance(double r, double mu, double t) { return sqrt(r * r + t * t + 2 * r * t * mu); }

/* Returns the distance to a sphere around the Earth's centre; negative: the ray misses it. */
static double to_sphere(double r, double mu, double radius, bool far_side)
{
    const double root = radius * radius - r * r * (1 - mu * mu);
    return root < 0 ? -1 : -r * mu + (far_side ? sqrt(root) : -sqrt(root));
}

static bool meets_ground(double r, double mu) { return mu < 0 && to_sphere(r, mu, GROUND, false) >= 0; }

/* Computes the transmittance towards the sun; steps grow, as the air thins. */
static void transmittance(double r, double mu, double t[3])
{
    double depth[3] = {0}, density[3];
    const double all = to_sphere(r, mu, TOP, true);
    for (int i = 0; i < SUN_STEPS && !meets_ground(r, mu); i++) {
        const double from = all * i * i / (SUN_STEPS * SUN_STEPS), to = all * (i + 1) * (i + 1) / (SUN_STEPS * SUN_STEPS);
        densities(at_distance(r, mu, (from + to) / 2), density);
        for (int c = 0; c < 3; c++) depth[c] += extinction(density, c) * (to - from);
    }
    for (int c = 0; c < 3; c++) t[c] = meets_ground(r, mu) ? 0 : exp(-depth[c]);
}

static double height_at(int i) { return (TOP - GROUND) * i * i / ((HEIGHTS - 1) * (HEIGHTS - 1)); }
static double sun_at(int k) { return -0.25 + 1.25 * k / (SUNS - 1); }

static void look_up(const multiple *m, double r, double mu_s, double l[3])
{
    const double y = sqrt(fmin(fmax((r - GROUND) / (TOP - GROUND), 0), 1)) * (HEIGHTS - 1), x = fmin(fmax((mu_s + 0.25) / 1.25, 0), 1) * (SUNS - 1);
    const int i = (int)fmin(y, HEIGHTS - 2), k = (int)fmin(x, SUNS - 2);
    const double v = y - i, u = x - k;
    for (int c = 0; c < 3; c++)
        l[c] = (1 - v) * ((1 - u) * m->radiance[i][k][c] + u * m->radiance[i][k + 1][c]) +
               v * ((1 - u) * m->radiance[i + 1][k][c] + u * m->radiance[i + 1][k + 1][c]);
}

/* Integrates along a ray. l: radiance scattered towards the eye; f: how much of a uniform radiance of 1 would be scattered into the ray. With m NULL:
 * light scattered once, isotropically, and the ground's. */
static void march(double r, double mu, double mu_s, double nu, const multiple *m, double l[3], double f[3])
{
    const bool ends = meets_ground(r, mu);
    const double all = to_sphere(r, mu, ends ? GROUND : TOP, !ends), g2 = HAZE * HAZE;
    const double by_air = m ? 3 / (16 * PI) * (1 + nu * nu) : 1 / (4 * PI);
    const double by_haze = m ? 3 / (8 * PI) * (1 - g2) * (1 + nu * nu) / ((2 + g2) * pow(1 + g2 - 2 * HAZE * nu, 1.5)) : 1 / (4 * PI); /* Cornette and Shanks */
    double through[3] = {1, 1, 1}, sun[3], more[3] = {0}, density[3];
    memset(l, 0, 3 * sizeof *l);
    memset(f, 0, 3 * sizeof *f);
    for (int i = 0; i < STEPS; i++) {
        const double from = all * i * i / (STEPS * STEPS), to = all * (i + 1) * (i + 1) / (STEPS * STEPS), t = (from + to) / 2;
        const double here = at_distance(r, mu, t), sun_here = (r * mu_s + t * nu) / here;
        densities(here, density);
        transmittance(here, sun_here, sun);
        if (m) look_up(m, here, sun_here, more);
        for (int c = 0; c < 3; c++) {
            const double e = extinction(density, c), passes = exp(-e * (to - from)), part = through[c] * (1 - passes) / e;
            const double a = air[c] * density[0], h = haze * density[1];
            l[c] += part * (sun[c] * (a * by_air + h * by_haze) + (a + h) * more[c]);
            f[c] += part * (a + h);
            through[c] *= passes;
        }
    }
    const double sun_there = (r * mu_s + all * nu) / GROUND;
    if (m || !ends || sun_there <= 0) return;
    transmittance(GROUND, sun_there, sun);
    for (int c = 0; c < 3; c++) l[c] += through[c] * sun[c] * sun_there * ALBEDO / PI;
}

/* Averages over directions; repeated scattering sums as a geometric series. */
static void fill_multiple(multiple *m)
{
    enum { UP = 8, AROUND = 4 };
#pragma omp parallel for schedule(dynamic, 1) collapse(2)
    for (int i = 0; i < HEIGHTS; i++)
        for (int k = 0; k < SUNS; k++) {
            double sum[3] = {0}, share[3] = {0}, l[3], f[3];
            const double mu_s = sun_at(k), r = fmin(GROUND + height_at(i) + 0.01, TOP - 0.01);
            for (int d = 0; d < UP * AROUND; d++) {
                const double mu = (2 * (d / AROUND) + 1.0) / UP - 1, turn = PI * (d % AROUND + 0.5) / AROUND;
                march(r, mu, mu_s, mu * mu_s + sqrt((1 - mu * mu) * (1 - mu_s * mu_s)) * cos(turn), NULL, l, f);
                for (int c = 0; c < 3; c++) sum[c] += l[c] / (UP * AROUND), share[c] += f[c] / (UP * AROUND);
            }
            for (int c = 0; c < 3; c++) m->radiance[i][k][c] = sum[c] / (1 - share[c]);
        }
}

/* Fills a table of the sky by elevation, denser towards the horizon, and by azimuth from the sun. */
static void fill_dome(const multiple *m, double mu_s, double dome[ROWS][COLUMNS][3])
{
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < COLUMNS; k++) {
            double f[3];
            const double mu = sin(PI / 2 * i * i / ((ROWS - 1) * (ROWS - 1))), turn = PI * k / (COLUMNS - 1);
            march(OBSERVER, mu, mu_s, mu * mu_s + sqrt((1 - mu * mu) * (1 - mu_s * mu_s)) * cos(turn), m, dome[i][k], f);
        }
}

static void look_up_dome(double dome[ROWS][COLUMNS][3], double elevation, double turn, double l[3])
{
    const double y = sqrt(fmax(elevation, 0) / (PI / 2)) * (ROWS - 1), x = turn / PI * (COLUMNS - 1);
    const int i = (int)fmin(y, ROWS - 2), k = (int)fmin(x, COLUMNS - 2);
    const double v = y - i, u = x - k;
    for (int c = 0; c < 3; c++)
        l[c] = (1 - v) * ((1 - u) * dome[i][k][c] + u * dome[i][k + 1][c]) + v * ((1 - u) * dome[i + 1][k][c] + u * dome[i + 1][k + 1][c]);
}

static void add_texel(const ec_made_map *map, uint32_t x, uint32_t y, const double l[3])
{
    for (int c = 0; c < 3; c++) map->rgb[3 * ((uint64_t)y * map->width + x) + (uint64_t)c] += (float)(SUN * l[c]);
}

/* Distributes the sun's light over the texels around it. */
static void add_sun(const ec_made_map *map, const double sun[3], const double light[3])
{
    double all = 0;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t y = 0; y < map->height; y++) {
            const double apart = PI * (y + 0.5) / map->height - acos(sun[1]);
            for (uint32_t x = 0; fabs(apart) < SUN_RADIUS && x < map->width; x++) {
                double d[3], chord = 0;
                ec_made_map_direction(map, x, y, d);
                for (int k = 0; k < 3; k++) chord += (d[k] - sun[k]) * (d[k] - sun[k]);
                const double weight = fmax(1 - chord / (SUN_RADIUS * SUN_RADIUS), 0);
                const double l[3] = {weight * light[0] / all, weight * light[1] / all, weight * light[2] / all};
                if (pass == 0) all += weight * ec_made_map_solid_angle(map, y);
                else if (weight > 0) add_texel(map, x, y, l);
            }
        }
}

void ec_sky_fill(const ec_made_map *map, double azimuth, double elevation)
{
    const double a = azimuth * PI / 180, e = elevation * PI / 180, sun[3] = {sin(a) * cos(e), sin(e), cos(a) * cos(e)};
    double dome[ROWS][COLUMNS][3], light[3], ground[3];
    multiple m;
    fill_multiple(&m);
    fill_dome(&m, sun[1], dome);
    transmittance(OBSERVER, sun[1], light);
    for (int c = 0; c < 3; c++) ground[c] = light[c] * sun[1];
    memset(map->rgb, 0, 3 * sizeof(float) * map->width * map->height);
    for (uint32_t y = 0; y < map->height; y++)
        for (uint32_t x = 0; x < map->width; x++) {
            double d[3], l[3];
            ec_made_map_direction(map, x, y, d);
            if (d[1] > 0) look_up_dome(dome, asin(d[1]), fabs(remainder(atan2(d[0], d[2]) - a, 2 * PI)), l);
            for (int c = 0; c < 3 && d[1] > 0; c++) ground[c] += l[c] * d[1] * ec_made_map_solid_angle(map, y);
            for (int c = 0; c < 3 && d[1] <= 0; c++) l[c] = ground[c] * ALBEDO / PI; /* the upper rows come first, and have filled `ground` */
            add_texel(map, x, y, l);
        }
    add_sun(map, sun, light);
}
