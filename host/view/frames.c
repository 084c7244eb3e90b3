#include "view/frames.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

void ec_frames_add(ec_frames *f, double now, int moving, uint64_t pictures)
{
    if (!f->seconds) f->seconds = malloc(EC_FRAMES_MOST * sizeof *f->seconds);
    if (moving && f->last > 0 && f->seconds && f->count < EC_FRAMES_MOST) {
        f->seconds[f->count++] = now - f->last;
        f->pictures += pictures - f->first_picture;
    }
    f->first_picture = pictures;
    f->last = moving ? now : 0;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

void ec_frames_print(const ec_frames *f, double first_light, FILE *to)
{
    if (first_light > 0) fprintf(to, "first light  %.3f s\n", first_light);
    else fprintf(to, "first light  none\n");
    if (f->count < 2) {
        fprintf(to, "frames       no camera move\n");
        return;
    }
    double *sorted = malloc(f->count * sizeof *sorted), sum = 0;
    if (!sorted) return;
    memcpy(sorted, f->seconds, f->count * sizeof *sorted);
    qsort(sorted, f->count, sizeof *sorted, compare);
    for (uint32_t i = 0; i < f->count; i++) sum += sorted[i];
    fprintf(to, "frames       %u in %.2f s of camera moves, median %.1f ms, 95 %% under %.1f ms, worst %.1f ms\n", f->count, sum,
            1e3 * sorted[f->count / 2], 1e3 * sorted[(uint32_t)(0.95 * (f->count - 1))], 1e3 * sorted[f->count - 1]);
    fprintf(to, "pictures     %" PRIu64 " of them new, %.1f a second\n", f->pictures, (double)f->pictures / sum);
    free(sorted);
}

void ec_frames_free(ec_frames *f)
{
    free(f->seconds);
    *f = (ec_frames){0};
}
