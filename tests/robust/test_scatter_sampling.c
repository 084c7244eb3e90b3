/* tier: full */
/* Checks that directions are sampled with the density of the BSDF, and that weights carry the right amount of light. */
#include <stdlib.h>

#include "robust/cases.h"
#include "robust/scatter.h"

typedef struct sampled {
    const char *name;
    ec_scatter_material material;
    double cosine;
} sampled;

/* Rough metal; a coat at a grazing angle; glass from outside, and from inside where it partly reflects totally; a thin pane that transmits
 * half of the light in it. */
static const sampled surfaces[] = {
    {"metal", {1, 1, 1, 0.5, 0, 1, false, 0}, 0.5},
    {"coat", {0.8, 0.04, 0, 0.3, 0, 1, false, 0}, 0.1},
    {"glass", {1, 0.04, 0, 0.5, 1, 1.5, false, 0}, 0.7},
    {"from inside glass", {1, 0.04, 0, 0.4, 1, 1 / 1.5, false, 0}, 0.5},
    {"pane", {0.8, 0.04, 0, 0.5, 0.5, 1, false, 0}, 0.3},
};
enum { SURFACES = sizeof surfaces / sizeof surfaces[0] };

typedef struct cells {
    uint32_t bands, sectors, points; /* bins of z from -1 to 1, of azimuth; points of either in a cell's integral */
    double *mass;                    /* for each cell, and for samples without a direction */
    double *found;                   /* samples in each cell */
} cells;

static uint32_t cell_count(const cells *c) { return c->bands * c->sectors + 1; }

static void set_items(ec_scatter_run *run, const sampled *s)
{
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        ec_scatter_set(run, i, &s->material);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, s->cosine, 0);
    }
}

/* Integrates the density over each cell with points x points midpoints. */
static ec_result integrate(ec_selftest *t, ec_scatter_run *run, cells *c, ec_error *err)
{
    uint32_t side_z = c->bands * c->points, side_phi = c->sectors * c->points, left = cell_count(c) - 1;
    double area = 4 * EC_PI_DOUBLE / side_z / side_phi;
    c->mass[left] = 1;
    for (uint32_t first = 0; first < side_z * side_phi; first += EC_SCATTER_N) {
        for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
            uint32_t p = first + i;
            double z = 2 * (p / side_phi % side_z + 0.5) / side_z - 1;
            ec_scatter_put_direction(run, EC_SCATTER_W, i, z, 2 * EC_PI_DOUBLE * (p % side_phi + 0.5) / side_phi);
        }
        EC_TRY(ec_scatter_go(t, run, err));
        for (uint32_t i = 0; i < EC_SCATTER_N && first + i < side_z * side_phi; i++) {
            uint32_t p = first + i;
            double mass = area * ec_scatter_got(run, EC_SCATTER_PDF, i);
            c->mass[p / side_phi / c->points * c->sectors + p % side_phi / c->points] += mass;
            c->mass[left] -= mass;
        }
    }
    return EC_OK;
}

static ec_result draw(ec_selftest *t, ec_scatter_run *run, cells *c, uint32_t runs, ec_error *err)
{
    uint64_t random = 1;
    for (uint32_t r = 0; r < runs; r++) {
        for (uint32_t i = 0; i < EC_SCATTER_N; i++)
            for (int k = 0; k < 3; k++) ec_scatter_put(run, EC_SCATTER_W + k, i, (double)(ec_random_bits(&random) >> 40) * EC_U);
        EC_TRY(ec_scatter_go(t, run, err));
        for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
            double w[3];
            ec_scatter_got3(run, EC_SCATTER_WI, i, w);
            double azimuth = atan2(w[1], w[0]) / (2 * EC_PI_DOUBLE), band = (w[2] + 1) / 2 * c->bands;
            uint32_t sector = (uint32_t)fmin((azimuth < 0 ? azimuth + 1 : azimuth) * c->sectors, c->sectors - 1);
            bool lost = ec_scatter_got(run, EC_SCATTER_WI_PDF, i) == 0;
            c->found[lost ? cell_count(c) - 1 : (uint32_t)fmin(fmax(band, 0), c->bands - 1) * c->sectors + sector]++;
        }
    }
    return EC_OK;
}

/* The RMS difference between samples and density, relative to the density: (chi^2 - its mean) / N estimates its square (Pearson). The
 * tolerance is reached by chance once in 1000 (Wilson, Hilferty 1931). Cells that expect fewer than 5 count as one. */
static ec_result compare(ec_selftest *t, const char *name, const cells *c, double n, ec_error *err)
{
    double chi2 = 0, degrees = -1, pooled = 0, pooled_found = 0;
    for (uint32_t i = 0; i < cell_count(c); i++) {
        double expected = n * c->mass[i];
        if (expected >= 5) chi2 += pow(c->found[i] - expected, 2) / expected, degrees++;
        else pooled += expected, pooled_found += c->found[i];
    }
    if (pooled >= 5) chi2 += pow(pooled_found - pooled, 2) / pooled, degrees++;
    else if (pooled_found > 30) chi2 = INFINITY; /* cells where almost none should be */
    double most = degrees * pow(1 - 2 / (9 * degrees) + 3.09 * sqrt(2 / (9 * degrees)), 3);
    return ec_selftest_value(t, name, 0, sqrt(fmax(chi2 - degrees, 0) / n), sqrt(sqrt(2 * degrees) / n),
                             sqrt((most - degrees) / n), err);
}

static ec_result chi_square_case(ec_selftest *t, ec_error *err)
{
    ec_scatter_run run;
    cells c = {.bands = 48, .sectors = 48, .points = 14};
    const uint32_t runs = 128;
    EC_TRY(ec_scatter_open(t, &run, err));
    c.mass = malloc(cell_count(&c) * sizeof *c.mass);
    c.found = malloc(cell_count(&c) * sizeof *c.found);
    ec_result result = c.mass && c.found ? EC_OK : ec_fail(err, "out of memory for %u cells", cell_count(&c));
    for (int s = 0; s < SURFACES && result == EC_OK; s++) {
        for (uint32_t i = 0; i < cell_count(&c); i++) c.mass[i] = c.found[i] = 0;
        set_items(&run, &surfaces[s]);
        result = integrate(t, &run, &c, err);
        if (result == EC_OK) result = draw(t, &run, &c, runs, err);
        if (result == EC_OK) result = compare(t, surfaces[s].name, &c, (double)runs * EC_SCATTER_N, err);
    }
    free(c.mass);
    free(c.found);
    ec_scatter_close(&run);
    return result;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/chi-square", false, chi_square_case, "sampled otherwise than divided by"},
    };
    return RUN_CASES(cases);
}
