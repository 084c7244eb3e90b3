/* Compresses blocks of memory with ISA-L. The compressed bytes may differ from one kind of processor to another, but not what they decompress to. */
#ifndef EC_IMAGE_DEFLATE_H
#define EC_IMAGE_DEFLATE_H

#include <stddef.h>
#include <stdint.h>

typedef enum ec_deflate_kind {
    EC_DEFLATE_ZLIB, /* a whole zlib stream (RFC 1950) */
    EC_DEFLATE_PART, /* raw deflate (RFC 1951) that ends on a byte boundary and will be continued */
    EC_DEFLATE_LAST, /* raw deflate that ends the stream */
} ec_deflate_kind;

/* Not thread-safe: one for each thread, of some hundred KB. */
typedef struct ec_deflate ec_deflate;
ec_deflate *ec_deflate_create(void); /* NULL: out of memory */
void ec_deflate_free(ec_deflate *);

/* `from` needs room for this many more bytes, which are set to 0, as ISA-L reads them. */
#define EC_DEFLATE_PAST 320

/* Compresses to `to`. Returns the compressed size, or 0 if it would exceed `most` bytes. */
size_t ec_deflate_pack(ec_deflate *, ec_deflate_kind kind, uint8_t *from, size_t bytes, uint8_t *to, size_t most);

/* Returns the largest compressed size of any data. */
size_t ec_deflate_bound(size_t bytes);

#endif
