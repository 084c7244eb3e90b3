/* Reads files compressed by DWAA and DWAB, which OpenEXRCore 3.1 does not decode ("not yet implemented in C"), through the C interface of the C++
 * library. It knows only colour, as half, which is what these lossy compressions are made for. */
#include "image/exr_read_rgba.h"

#include <ImfCRgbaFile.h>
#include <string.h>

#include "base/freed.h"
#include "image/exr_input.h"

static ec_result copy_planes(const char *path, const ImfRgba *pixels, ec_exr *exr, ec_error *err)
{
    uint64_t count = (uint64_t)exr->width * exr->height;
    for (uint32_t c = 0; c < exr->channel_count; c++) {
        const char *name = exr->names[c];
        if (!name[0] || name[1] || !strchr("RGBA", name[0]))
            return ec_fail(err, "cannot read '%s': only R, G, B and A of a DWA-compressed file are read, not channel '%s'; "
                                "save it with ZIP compression", path, name);
        for (uint64_t i = 0; exr->planes[c] && i < count; i++) {
            const ImfRgba *p = &pixels[i];
            ImfHalf value = name[0] == 'R' ? p->r : name[0] == 'G' ? p->g : name[0] == 'B' ? p->b : p->a;
            exr->planes[c][i] = ImfHalfToFloat(value);
        }
    }
    return EC_OK;
}

/* Checks the header with OpenEXRCore, which compares sizes of attributes with the file's; the C++ library believes them, even gigabytes. */
static ec_result check_header(const char *path, ec_error *err)
{
    ec_exr_input in;
    exr_result_t code = ec_exr_input_open_strictly(&in, path);
    ec_result result = code == EXR_ERR_SUCCESS ? EC_OK : ec_fail(err, "cannot read '%s': %s; the file may be damaged or cut short, replace it", path, ec_exr_reason(&in, code));
    ec_exr_input_close(&in);
    return result;
}

ec_result ec_exr_read_rgba(const char *path, int32_t origin_x, int32_t origin_y, ec_exr *exr, ec_error *err)
{
    EC_TRY(check_header(path, err));
    EC_FREED ImfRgba *pixels = calloc((uint64_t)exr->width * exr->height, sizeof *pixels);
    ImfInputFile *file = pixels ? ImfOpenInputFile(path) : NULL;
    ec_result result;
    /* The library wants the address that pixel (0, 0) would have, which may lie outside the picture. */
    uintptr_t base = (uintptr_t)pixels - sizeof *pixels * ((uint64_t)((int64_t)origin_y * exr->width + origin_x));
    int last = origin_y + (int32_t)exr->height - 1;
    if (!pixels)
        result = ec_fail(err, "cannot read '%s': %u x %u pixels do not fit into memory", path, exr->width, exr->height);
    else if (!file || !ImfInputSetFrameBuffer(file, (ImfRgba *)base, 1, exr->width) ||
             !ImfInputReadPixels(file, origin_y, last))
        result = ec_fail(err, "cannot read '%s': %s; the file may be damaged or cut short, replace it", path,
                         ImfErrorMessage());
    else
        result = copy_planes(path, pixels, exr, err);
    if (file) ImfCloseInputFile(file);
    return result;
}
