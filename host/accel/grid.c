/* Builds the uniform grid: about `density` times as many cells as references, near cubes. Which references each cell holds is found in two parallel
 * passes, one that counts and one that fills. */
#include <math.h>

#include "accel/accel_internal.h"
#include "accel/build_internal.h"
#include "accel/leaf.h"
#include "base/freed.h"

#define CELLS_AXIS_MOST 2048u /* a multiple of 4 */
#define CELLS_MOST (1u << 28) /* counting what each holds takes 4 bytes on the host */
/* Entries a reference on average before the grid is made coarser: large triangles lie in thousands of small cells. */
#define ENTRIES_MOST 64u
#define ENTRIES_ALL_MOST (UINT32_MAX - 1u) /* what the kernels can number */

typedef struct grid {
    const ec_ref *refs;
    uint32_t ref_count, cells[3], threads;
    float *planes[3]; /* cells + 1 each, ascending */
    double per_unit[3];
    ec_box bounds;
} grid;

/* Chooses the numbers of cells: as many cubes as wanted, if no axis were shorter than a cube; axes that are get the fewest cells and the others the
 * rest. */
static void choose_cells(grid *g, double wanted)
{
    int taken[3] = {0};
    double extent[3], edge = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        extent[axis] = (double)g->bounds.hi[axis] - g->bounds.lo[axis];
        taken[axis] = extent[axis] <= 0.0;
    }
    for (int again = 1; again;) {
        double log_volume = 0.0, axes = 0.0;
        for (int axis = 0; axis < 3; axis++)
            if (!taken[axis]) log_volume += log(extent[axis]), axes += 1.0;
        edge = axes > 0.0 ? exp((log_volume - log(fmax(wanted, 1.0))) / axes) : 1.0;
        again = 0;
        for (int axis = 0; axis < 3; axis++)
            if (!taken[axis] && extent[axis] < edge) taken[axis] = again = 1;
    }
    for (int axis = 0; axis < 3; axis++) {
        double cells = taken[axis] ? 4.0 : 4.0 * round(0.25 * extent[axis] / edge);
        g->cells[axis] = (uint32_t)fmin(fmax(cells, 4.0), CELLS_AXIS_MOST);
    }
}

static uint64_t cell_count(const grid *g) { return (uint64_t)g->cells[0] * g->cells[1] * g->cells[2]; }

static void place_planes(grid *g, float *planes)
{
    for (int axis = 0; axis < 3; axis++) {
        uint32_t n = g->cells[axis];
        double lo = g->bounds.lo[axis], extent = (double)g->bounds.hi[axis] - lo;
        for (uint32_t i = 0; i <= n; i++) planes[i] = (float)(lo + extent * i / n);
        planes[n] = g->bounds.hi[axis];
        g->planes[axis] = planes;
        g->per_unit[axis] = extent > 0.0 ? n / extent : 0.0;
        planes += n + 1;
    }
}

/* Finds the cells that [lo, hi] needs: from the last one that begins no later than lo to the first one that ends no earlier than hi. */
static void range_of(const grid *g, int axis, float lo, float hi, uint32_t range[2])
{
    const float *planes = g->planes[axis];
    uint32_t last = g->cells[axis] - 1;
    double guess = ((double)lo - planes[0]) * g->per_unit[axis], guess_end = ((double)hi - planes[0]) * g->per_unit[axis];
    uint32_t i = (uint32_t)fmin(fmax(guess, 0.0), last), k = (uint32_t)fmin(fmax(guess_end, 0.0), last);
    while (i > 0 && planes[i] > lo) i--;
    while (i < last && planes[i + 1] <= lo) i++;
    while (k < last && planes[k + 1] < hi) k++;
    while (k > 0 && planes[k] >= hi) k--;
    range[0] = i;
    range[1] = k > i ? k : i;
}

typedef struct cell_box {
    uint32_t at[3][2];
} cell_box;

static cell_box cells_of(const grid *g, const ec_ref *ref)
{
    cell_box box;
    for (int axis = 0; axis < 3; axis++) range_of(g, axis, ref->box.lo[axis], ref->box.hi[axis], box.at[axis]);
    return box;
}

static uint64_t entry_count(const grid *g)
{
    uint64_t sum = 0;
#pragma omp parallel for num_threads(g->threads) reduction(+ : sum)
    for (uint32_t i = 0; i < g->ref_count; i++) {
        cell_box b = cells_of(g, &g->refs[i]);
        sum += (uint64_t)(b.at[0][1] - b.at[0][0] + 1) * (b.at[1][1] - b.at[1][0] + 1) * (b.at[2][1] - b.at[2][0] + 1);
    }
    return sum;
}

/* Returns a cell's number; cells are numbered block by block. */
static size_t cell_index(const grid *g, uint32_t x, uint32_t y, uint32_t z)
{
    size_t block = x / 4 + (size_t)(g->cells[0] / 4) * (y / 4 + (size_t)(g->cells[1] / 4) * (z / 4));
    return 64 * block + (x % 4 + 4 * (y % 4) + 16 * (z % 4));
}

/* Counts the cells' entries or, if `entries` is not NULL, fills them in: counts[c] is then the place behind cell c's entries, and moves to their first. */
static void deal(const grid *g, uint32_t *counts, uint32_t *entries)
{
#pragma omp parallel for num_threads(g->threads) schedule(dynamic, 1024)
    for (uint32_t i = 0; i < g->ref_count; i++) {
        cell_box b = cells_of(g, &g->refs[i]);
        for (uint32_t z = b.at[2][0]; z <= b.at[2][1]; z++)
            for (uint32_t y = b.at[1][0]; y <= b.at[1][1]; y++)
                for (uint32_t x = b.at[0][0]; x <= b.at[0][1]; x++) {
                    uint32_t *count = &counts[cell_index(g, x, y, z)];
                    if (entries) entries[__atomic_sub_fetch(count, 1, __ATOMIC_RELAXED)] = i;
                    else __atomic_add_fetch(count, 1, __ATOMIC_RELAXED);
                }
    }
}

static int ascending(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Sorts each cell's entries: threads fill in any order; sorted, the grid is the same for any number of them. starts: of the cells that hold something. */
static void sort_cells(const grid *g, const uint32_t *starts, uint32_t cells, uint32_t *entries)
{
#pragma omp parallel for num_threads(g->threads) schedule(dynamic, 4096)
    for (uint32_t c = 0; c < cells; c++) {
        uint32_t *first = entries + starts[c], count = starts[c + 1] - starts[c];
        if (count > 32) {
            qsort(first, count, sizeof *first, ascending);
            continue;
        }
        for (uint32_t i = 1; i < count; i++) {
            uint32_t entry = first[i], k = i;
            for (; k > 0 && first[k - 1] > entry; k--) first[k] = first[k - 1];
            first[k] = entry;
        }
    }
}

/* Counts a cell's entries, marks the blocks' occupied cells, and turns counts into places. Returns how many are occupied. */
static uint32_t count_cells(const grid *g, uint32_t *counts, ec_grid_block *blocks)
{
    uint64_t cells = cell_count(g);
    uint32_t sum = 0, used = 0;
    memset(counts, 0, cells * sizeof *counts);
    deal(g, counts, NULL);
    for (uint64_t c = 0; c < cells; c++) {
        ec_grid_block *block = &blocks[c / 64];
        if (c % 64 == 0) *block = (ec_grid_block){.first = used};
        if (counts[c]) block->occupied[c / 32 % 2] |= 1u << c % 32, used++;
        counts[c] = sum += counts[c];
    }
    return used;
}

/* Fills starts, one more than there are occupied cells, and the entries behind them. */
static void fill_cells(const grid *g, uint32_t *counts, const ec_grid_block *blocks, uint32_t *starts, uint32_t used,
                       uint32_t entry_count)
{
    uint64_t cells = cell_count(g);
    uint32_t *entries = starts + used + 1, next = 0;
    deal(g, counts, entries);
    for (uint64_t c = 0; c < cells; c++)
        if (blocks[c / 64].occupied[c / 32 % 2] >> c % 32 & 1) starts[next++] = counts[c];
    starts[used] = entry_count;
    sort_cells(g, starts, used, entries);
}

static void fill_triangles(const grid *g, const ec_accel_input *in, ec_tri *triangles, ec_box *boxes)
{
#pragma omp parallel for num_threads(g->threads)
    for (uint32_t i = 0; i < g->ref_count; i++) {
        triangles[i] = ec_tri_of(in->positions, in->indices, g->refs[i].triangle);
        if (boxes) boxes[i] = g->refs[i].box;
    }
}

/* Makes cells and planes, coarser until the entries take no more memory than they are worth. */
static ec_grid *make_header(grid *g, double density, uint64_t *entries, uint64_t *bytes)
{
    ec_grid *header = NULL;
    uint64_t most = (uint64_t)ENTRIES_MOST * g->ref_count;
    if (most > ENTRIES_ALL_MOST) most = ENTRIES_ALL_MOST;
    for (double wanted = fmin(density * g->ref_count, CELLS_MOST);; wanted *= 0.5) {
        choose_cells(g, wanted);
        uint32_t planes = g->cells[0] + g->cells[1] + g->cells[2] + 3;
        free(header);
        *bytes = sizeof *header + planes * sizeof(float);
        header = calloc(1, *bytes);
        if (!header) return NULL;
        place_planes(g, (float *)(header + 1));
        *entries = entry_count(g);
        if (*entries <= most || cell_count(g) <= 64) break;
    }
    for (int axis = 0; axis < 3; axis++) {
        header->blocks[axis] = g->cells[axis] / 4;
        header->per_unit[axis] = (float)fmin(0.25 * g->per_unit[axis], 3e38);
    }
    return header;
}

ec_result ec_grid_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    grid g = {0};
    EC_FREED ec_ref *refs = NULL;
    EC_TRY(ec_accel_refs(in, &refs, &g.ref_count, &g.bounds, err));
    g.refs = refs;
    g.threads = (uint32_t)ec_accel_threads(in, g.ref_count);
    uint64_t entry_count = 0, header_bytes = 0;
    EC_FREED uint32_t *counts = NULL;
    uint32_t used = 0, *starts = NULL;
    ec_grid_block *blocks = NULL;
    ec_tri *triangles = NULL;
    ec_box *boxes = NULL;
    ec_grid *header = make_header(&g, in->grid_density > 0.0f ? in->grid_density : EC_GRID_DENSITY, &entry_count, &header_bytes);
    if (header && entry_count <= ENTRIES_ALL_MOST) {
        counts = malloc(cell_count(&g) * sizeof *counts);
        blocks = ec_allocate_lines(cell_count(&g) / 64, sizeof *blocks);
        triangles = ec_allocate_lines(g.ref_count, sizeof *triangles);
        if (in->bvh.boxes) boxes = ec_allocate_lines(g.ref_count, sizeof *boxes);
    }
    if (counts && blocks) {
        header->start_count = 1 + (used = count_cells(&g, counts, blocks));
        starts = ec_allocate_lines(header->start_count + entry_count, sizeof *starts);
    }
    ec_result result = starts && triangles && (boxes || !in->bvh.boxes) ? EC_OK
        : ec_fail(err, "out of memory for a grid of %u references and %llu cells; give a smaller --grid-density or another --accel", g.ref_count,
                  (unsigned long long)(header ? cell_count(&g) : 0));
    if (result == EC_OK) {
        fill_cells(&g, counts, blocks, starts, used, (uint32_t)entry_count);
        fill_triangles(&g, in, triangles, boxes);
        if (!g.ref_count) triangles[0] = (ec_tri){0}; /* a buffer has at least one */
    }
    accel->buffers[0] = (ec_accel_buffer){"planes", header, header_bytes};
    accel->buffers[1] = (ec_accel_buffer){"cells", blocks, header ? cell_count(&g) / 64 * sizeof *blocks : 0};
    accel->buffers[2] = (ec_accel_buffer){"entries", starts, (used + 1 + entry_count) * sizeof *starts};
    accel->buffers[3] = (ec_accel_buffer){"triangles", triangles, (g.ref_count ? g.ref_count : 1) * sizeof *triangles};
    if (boxes) accel->buffers[4] = (ec_accel_buffer){"boxes", boxes, g.ref_count * sizeof *boxes};
    accel->stats = (ec_accel_stats){.nodes = header ? cell_count(&g) : 0, .leaves = used, .references = entry_count};
    return result;
}
