/* Blocks of memory compressed by ISA-L. Its bytes may differ from one kind of processor to the next, what they hold does not. */
#ifndef EC_IMAGE_DEFLATE_H
#define EC_IMAGE_DEFLATE_H

#include <stddef.h>
#include <stdint.h>

typedef enum ec_deflate_kind {
    EC_DEFLATE_ZLIB, /* a whole zlib stream (RFC 1950) */
    EC_DEFLATE_PART, /* raw deflate (RFC 1951) that ends at a byte, where more is to follow */
    EC_DEFLATE_LAST, /* raw deflate that ends the stream */
} ec_deflate_kind;

/* For one thread at a time; some hundred KB. */
typedef struct ec_deflate ec_deflate;
ec_deflate *ec_deflate_create(void); /* NULL: no memory */
void ec_deflate_free(ec_deflate *);

/* Behind the bytes there is room for as many more, which become zeros: ISA-L looks at them. */
#define EC_DEFLATE_PAST 320

/* The size of what has been written at `to`; 0: it would take more than `most` bytes. */
size_t ec_deflate_pack(ec_deflate *, ec_deflate_kind kind, uint8_t *from, size_t bytes, uint8_t *to, size_t most);

/* As many bytes as it takes at most, whatever is packed. */
size_t ec_deflate_bound(size_t bytes);

#endif
