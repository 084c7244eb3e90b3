/* Keeps things on a device as long as it is open, for renders that follow one another: programs, and buffers that no kernel writes. */
#include "cl/kept.h"

#include <stdlib.h>
#include <string.h>

struct ec_kept_program {
    ec_cache_key key;
    cl_program program;
};

cl_program ec_kept_find(const ec_cl *cl, const ec_cache_key *key)
{
    for (uint32_t i = 0; i < cl->kept_count; i++)
        if (!memcmp(&cl->kept[i].key, key, sizeof *key)) return cl->kept[i].program;
    return NULL;
}

void ec_kept_add(ec_cl *cl, const ec_cache_key *key, cl_program program)
{
    ec_kept_program *grown = realloc(cl->kept, (cl->kept_count + 1) * sizeof *grown);
    if (!grown) return;
    cl->kept = grown;
    if (clRetainProgram(program) == CL_SUCCESS) cl->kept[cl->kept_count++] = (ec_kept_program){*key, program};
}

void ec_kept_release(ec_cl *cl)
{
    for (uint32_t i = 0; i < cl->kept_count; i++) clReleaseProgram(cl->kept[i].program);
    free(cl->kept);
    cl->kept = NULL;
    cl->kept_count = 0;
}

ec_fingerprint ec_buffer_key(const char *label, uint64_t bytes, uint64_t slack, const void *data)
{
    ec_fingerprint key = ec_fingerprint_add((ec_fingerprint){{slack}}, label, strlen(label));
    return ec_fingerprint_add(key, data, bytes);
}

static void drop(ec_cl *cl, uint32_t i)
{
    cl_mem buffer = cl->kept_buffers[i].buffer;
    cl->kept_buffers[i] = cl->kept_buffers[--cl->kept_buffer_count];
    ec_buffer_release(cl, &buffer);
}

void ec_buffers_keep_only(ec_cl *cl, const ec_fingerprint *keys, uint32_t count)
{
    for (uint32_t i = cl->kept_buffer_count; i-- > 0;) {
        uint32_t k = 0;
        while (k < count && !ec_fingerprint_is(keys[k], cl->kept_buffers[i].key)) k++;
        if (k == count) drop(cl, i);
    }
}

static ec_result upload(ec_cl *cl, const char *label, uint64_t bytes, uint64_t slack, const void *data, cl_mem *buffer,
                        ec_error *err)
{
    EC_TRY(ec_buffer_create(cl, label, bytes + slack, slack ? NULL : data, buffer, err));
    cl->uploaded_bytes += bytes;
    return slack ? ec_buffer_write(cl, *buffer, 0, bytes, data, err) : EC_OK;
}

ec_result ec_buffer_put(ec_cl *cl, const char *label, uint64_t bytes, uint64_t slack, const void *data,
                        const ec_fingerprint *key, cl_mem *buffer, ec_error *err)
{
    if (!key) return upload(cl, label, bytes, slack, data, buffer, err);
    for (uint32_t i = 0; i < cl->kept_buffer_count; i++) {
        if (!ec_fingerprint_is(*key, cl->kept_buffers[i].key)) continue;
        EC_TRY(ec_cl_check(clRetainMemObject(cl->kept_buffers[i].buffer), "clRetainMemObject", label, err));
        *buffer = cl->kept_buffers[i].buffer;
        cl->found_bytes += bytes;
        return EC_OK;
    }
    EC_TRY(upload(cl, label, bytes, slack, data, buffer, err));
    ec_kept_buffer *grown = realloc(cl->kept_buffers, (cl->kept_buffer_count + 1) * sizeof *grown);
    if (!grown) return EC_OK; /* it is just not kept */
    cl->kept_buffers = grown;
    if (clRetainMemObject(*buffer) == CL_SUCCESS) cl->kept_buffers[cl->kept_buffer_count++] = (ec_kept_buffer){*key, *buffer};
    return EC_OK;
}

void ec_kept_buffers_release(ec_cl *cl)
{
    ec_buffers_keep_only(cl, NULL, 0);
    free(cl->kept_buffers);
    cl->kept_buffers = NULL;
}
