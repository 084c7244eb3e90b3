#include "image/gather.h"

#include <stdlib.h>
#include <string.h>

#include "base/atomic_file.h"

typedef struct gathered {
    ec_encode *encode;
    ec_atomic_file file;
    const char *path; /* the caller's */
    ec_raster of;
    uint8_t *pixels;
    size_t filled;    /* bytes */
} gathered;

ec_result ec_gather_begin(ec_encode *encode, void **made, const char *path, const ec_raster *of, ec_error *err)
{
    gathered *g = calloc(1, sizeof *g);
    *made = NULL;
    if (!g) return ec_fail(err, "out of memory for '%s'", path);
    *g = (gathered){.encode = encode, .file.fd = -1, .path = path, .of = *of};
    g->pixels = malloc((size_t)of->width * of->height * ec_raster_pixel_bytes(of));
    const ec_result result = g->pixels ? ec_atomic_open(&g->file, path, err) : ec_fail(err, "out of memory for '%s'", path);
    if (result == EC_OK) *made = g;
    else ec_gather_abort(g);
    return result;
}

ec_result ec_gather_put(void *rows, const void *pixels, uint32_t count, ec_error *err)
{
    gathered *g = rows;
    const size_t size = (size_t)g->of.width * count * ec_raster_pixel_bytes(&g->of);
    (void)err;
    memcpy(g->pixels + g->filled, pixels, size);
    g->filled += size;
    return EC_OK;
}

static ec_result finish(gathered *g, ec_error *err)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    const char *why = g->encode(&g->of, g->pixels, &bytes, &size);
    ec_result result = why ? ec_fail(err, "cannot write '%s': %s", g->path, why) : ec_atomic_append(&g->file, bytes, size, err);
    free(bytes);
    return result == EC_OK ? ec_atomic_commit(&g->file, err) : result;
}

ec_result ec_gather_end(void *rows, ec_error *err)
{
    const ec_result result = finish(rows, err);
    ec_gather_abort(rows);
    return result;
}

void ec_gather_abort(void *rows)
{
    gathered *g = rows;
    if (!g) return;
    ec_atomic_abort(&g->file);
    free(g->pixels);
    free(g);
}
