/* A log of which surfaces the samples of a batch meet, until the batch is in the film. Devices write it, each in a thread of its own. */
#ifndef EC_FILM_MATTE_LOG_H
#define EC_FILM_MATTE_LOG_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

/* So many samples of a position of the batch have met a node, and a material of it. Both are numbers plus 1; 0: none. */
typedef struct ec_matte_entry {
    uint32_t position, node, material, samples;
} ec_matte_entry;

typedef struct ec_matte_log {
    ec_matte_entry *entries; /* owned */
    uint64_t count, room;
    pthread_mutex_t *lock;   /* NULL: one thread alone writes */
} ec_matte_log;

/* Adds entries; returns false if there is no memory. */
bool ec_matte_log_add(ec_matte_log *log, const ec_matte_entry *entries, uint64_t count);

/* Adds the `count` samples of one position, floats that are whole numbers; those that met nothing are left out. */
bool ec_matte_log_samples(ec_matte_log *log, uint32_t position, const float *nodes, const float *materials, uint32_t count);

#endif
