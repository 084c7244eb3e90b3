#include "image/deflate.h"

#include <isa-l/igzip_lib.h>
#include <stdlib.h>
#include <string.h>

/* Levels 1 and 2 of ISA-L 2.30 occasionally give other bytes for the same block (tests/host/test_deflate.c). docs/internals.md says what was tried. */
enum { LEVEL = 3, LEVEL_ROOM = ISAL_DEF_LVL3_DEFAULT };

struct ec_deflate {
    struct isal_zstream stream;
    uint8_t room[LEVEL_ROOM];
};

ec_deflate *ec_deflate_create(void)
{
    return calloc(1, sizeof(ec_deflate)); /* zeroed, as isal_deflate_stateless reads a field that its init does not set */
}

void ec_deflate_free(ec_deflate *d)
{
    free(d);
}

/* Clears the upper halves of x86 registers. ISA-L leaves values there, after which pow takes 12 times as long for the rest of the thread. */
static void leave_wide_registers(void)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx")) __asm__ volatile("vzeroupper");
#endif
}

size_t ec_deflate_pack(ec_deflate *d, ec_deflate_kind kind, uint8_t *from, size_t bytes, uint8_t *to, size_t most)
{
    struct isal_zstream *z = &d->stream;
    memset(from + bytes, 0, EC_DEFLATE_PAST);
    isal_deflate_stateless_init(z);
    z->gzip_flag = kind == EC_DEFLATE_ZLIB ? IGZIP_ZLIB : IGZIP_DEFLATE;
    z->level = LEVEL;
    z->level_buf = d->room;
    z->level_buf_size = LEVEL_ROOM;
    z->end_of_stream = kind != EC_DEFLATE_PART;
    z->flush = kind == EC_DEFLATE_PART ? FULL_FLUSH : NO_FLUSH;
    z->next_in = from;
    z->avail_in = (uint32_t)bytes;
    z->next_out = to;
    z->avail_out = (uint32_t)most;
    const int code = isal_deflate_stateless(z);
    leave_wide_registers();
    return code == COMP_OK ? z->total_out : 0;
}

/* Blocks stored uncompressed: five bytes for each 65 535, and the stream's frame. */
size_t ec_deflate_bound(size_t bytes)
{
    return bytes + 5 * (bytes / 65535 + 1) + 16;
}
