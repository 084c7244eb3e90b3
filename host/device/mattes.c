#include "device/mattes.h"

#include <stdlib.h>

#include "device/adaptive.h"

static ec_result no_memory(ec_error *err) { return ec_fail(err, "out of memory for cryptomatte; leave it out, or give a smaller --wave"); }

ec_result ec_mattes_read(ec_mattes *mattes, const ec_pipeline *p, bool is_list, uint32_t first, uint32_t count, ec_error *err)
{
    const ec_params *params = &p->params;
    const uint64_t samples = (uint64_t)count * params->batch, begin = 12ull * params->wave * params->layer_ids;
    const uint32_t rows_before = params->film_row * params->width;
    if (samples > mattes->room) {
        free(mattes->nodes);
        mattes->nodes = malloc(2 * samples * sizeof *mattes->nodes);
        mattes->room = mattes->nodes ? samples : 0;
        if (!mattes->nodes) return no_memory(err);
    }
    float *materials = mattes->nodes + mattes->room;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_RADIANCE], begin, 4 * samples, mattes->nodes, err));
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_RADIANCE], begin + 4ull * params->wave, 4 * samples, materials, err));
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t s = (uint64_t)i * params->batch;
        const uint32_t position = is_list ? first + i : ec_pixel_place(params, rows_before + first + i) - rows_before;
        if (!ec_matte_log_samples(&mattes->met, position, mattes->nodes + s, materials + s, params->batch)) return no_memory(err);
    }
    return EC_OK;
}

ec_result ec_mattes_tell(ec_mattes *mattes, ec_matte_log *log, ec_error *err)
{
    const bool told = ec_matte_log_add(log, mattes->met.entries, mattes->met.count);
    mattes->met.count = 0;
    return told ? EC_OK : no_memory(err);
}

void ec_mattes_free(ec_mattes *mattes)
{
    free(mattes->nodes);
    free(mattes->met.entries);
    *mattes = (ec_mattes){0};
}
