/* MurmurHash3_x86_32 (Appleby, public domain): the hash that Cryptomatte uses for names. Neither for secrets nor for fingerprints of files. */
#ifndef EC_BASE_MURMUR_H
#define EC_BASE_MURMUR_H

#include <stddef.h>
#include <stdint.h>

uint32_t ec_murmur3(const void *bytes, size_t size, uint32_t seed);

#endif
