/* OpenCL, and nothing of rendering: devices, programs with a binary cache, buffers, kernels. */
#ifndef EC_CL_CL_H
#define EC_CL_CL_H

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/fingerprint.h"

typedef struct ec_device_info {
    cl_platform_id platform;
    cl_device_id id;
    char name[256], vendor[256], version[256], driver[256], platform_name[256], platform_version[256], c_version[256];
    cl_device_type type;
    uint32_t compute_units;
    uint32_t native_float_width;   /* CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT */
    uint64_t memory_bytes, max_allocation_bytes, cache_bytes, local_bytes;
    uint64_t max_work_group_size;
    bool correctly_rounded_divide_sqrt, denormals, fma, inf_nan;
    bool subgroup_ballot;          /* cl_khr_subgroup_ballot; ec_device_joins tells whether kernels use it */
    bool available, compiler_available;
} ec_device_info;

/* Every device of every platform, in a fixed order; their index is what --device takes. malloc'ed, caller frees. No
 * device at all is a failure whose message says what to install. */
ec_result ec_devices_list(ec_device_info **devices, uint32_t *count, ec_error *err);

/* --device ID (index, or a part of the name, case ignored), else $ECLAT_DEVICE, else the first GPU, else the first CPU,
 * else the first device. id may be NULL. *why is a static text such as "first GPU". */
ec_result ec_device_choose(const ec_device_info *devices, uint32_t count, const char *id, uint32_t *index,
                           const char **why, ec_error *err);

/* Likewise for `all` (all devices that are available and have a compiler) and lists such as `0,2` or `pocl,intel`: up to `most` indices, in the order
 * given. With a `most` of 1 such a list is refused. A device may be named more than once: it has a queue for each time (ec_cl_open_beside). */
ec_result ec_device_choose_several(const ec_device_info *devices, uint32_t count, const char *id, uint32_t *indices, uint32_t most,
                                   uint32_t *chosen, const char **why, ec_error *err);

/* Lists and chooses: gives the device that id means, and its place in the list. index and why may be NULL. */
ec_result ec_device_find(const char *id, ec_device_info *device, uint32_t *index, const char **why, ec_error *err);
ec_result ec_device_find_several(const char *id, ec_device_info *devices, uint32_t *indices, uint32_t most,
                                 uint32_t *chosen, const char **why, ec_error *err); /* memory_bytes: a queue's share */

/* Says whether programs go through the binary cache. AUTO leaves the cache out for drivers that need the source:
 * cl/workarounds.c. */
typedef enum ec_cache_use { EC_CACHE_AUTO = 0, EC_CACHE_ON, EC_CACHE_OFF } ec_cache_use;

/* How many work-items one launch of a kernel may have: cl/pace.h. */
#define EC_PACES 32
typedef struct ec_pace {
    char label[40];
    uint64_t most;            /* of one launch */
    uint64_t busy;            /* work-items with something to do, since the last look … */
    double seconds, longest;  /* … the seconds they took, and the longest launch */
} ec_pace;
typedef struct ec_paces {
    double limit;             /* seconds that a launch may take; 0: no limit */
    ec_pace table[EC_PACES];
    uint32_t count;
    uint64_t launches, pieces;/* launches, and the pieces into which they were cut */
    double longest;           /* seconds of a piece */
} ec_paces;

/* A command that may still fail once it runs. There is room for those of a segment of bounces (device/wave.c): when the room is used up, the host waits. */
#define EC_LAUNCHES 192
typedef struct ec_cl_launch {
    cl_event event;
    const char *label;
    ec_pace *pace;            /* NULL: its time is not measured */
} ec_cl_launch;

/* A context and an in-order queue on one device. One thread at a time, but for ec_program_build: one thread may build
 * while another uses buffers and kernels (compiling takes long enough to hide it behind loading a scene). */
typedef struct ec_cl {
    ec_device_info info;
    cl_context context;
    cl_command_queue queue;
    uint64_t allocated_bytes, peak_allocated_bytes; /* by ec_buffer_* */
    uint64_t releases;        /* number of buffer releases, counted from 1: after one, the same handle may name another buffer */
    double build_seconds;     /* spent in clBuildProgram and cache look-ups */
    uint32_t cache_hits, cache_misses;
    const char *cache_dir;    /* NULL: the default (see ec_program_build) */
    const ec_log *log;        /* is told if compiling takes long; NULL: nobody is */
    bool keeps_programs;      /* set after ec_cl_open: programs stay built until ec_cl_close, and are found again */
    bool keeps_buffers;       /* likewise scene data stays on the device, as long as the next scene needs it too */
    struct ec_ahead *ahead;   /* cl/ahead.h; NULL: none */
    struct ec_last_build *last_build; /* device/ahead.h; NULL: none. Not owned */
    struct ec_kept_program *kept;
    uint32_t kept_count;
    uint32_t programs_found;  /* found among those kept */
    struct ec_kept_buffer *kept_buffers; /* see ec_buffer_put */
    uint32_t kept_buffer_count;
    uint64_t uploaded_bytes, found_bytes; /* by ec_buffer_put */
    ec_cache_use cache;       /* EC_CACHE_AUTO unless set after ec_cl_open */
    ec_cl_launch launches[EC_LAUNCHES]; /* those whose end has not been looked at */
    uint32_t launch_count;
    ec_paces paces;
    void *sent;               /* see ec_buffer_send */
    uint64_t sent_bytes;
} ec_cl;
ec_result ec_cl_open(const ec_device_info *info, ec_cl *cl, ec_error *err);
/* Likewise, in the context of the first of `opened` that is on the same device, if there is one: cards run commands of two queues side by side only
 * within a context. All may be closed in any order. */
ec_result ec_cl_open_beside(const ec_device_info *info, const ec_cl *opened, uint32_t count, ec_cl *cl, ec_error *err);
void ec_cl_close(ec_cl *cl);

/* One of the sources embedded at build time (kernels/stages/NAME.cl, includes flattened, #line kept). NULL if unknown. */
const char *ec_kernel_source(const char *name);
const char *const *ec_kernel_source_names(void); /* NULL-terminated, for tests and --dump-kernels */

/* Joins several sources in one text (malloc'ed): their headers' guards make each count once. names is NULL-terminated. One program for all kernels
 * that share their options halves PoCL's front end: six stages 0.7 s instead of 1.25 s. */
ec_result ec_kernel_sources_join(const char *const *names, char **joined, ec_error *err);

/* An option that makes divisions inexact too. Only to measure what exact arithmetic costs: it lets the compiler delete the tests for NaN. */
#define EC_FAST_MATH "-cl-fast-relaxed-math"

/* Builds a source with options (the arithmetic flags that every eclat kernel needs are added here: -cl-std=CL1.2 and,
 * where offered, -cl-fp32-correctly-rounded-divide-sqrt). Binaries are cached in
 * ${XDG_CACHE_HOME:-~/.cache}/eclat/kernels under SHA-256(source, options, device, driver, platform); written to a
 * temporary name and renamed; anything wrong with an entry is a miss; an unwritable cache is no error. `label` names it
 * in messages and dumps. On failure err has a line that says so and the start of the build log, errors first. With
 * ECLAT_DUMP_KERNELS=DIR the source goes to DIR/label.cl and the whole log to DIR/label.log (and the cache is not
 * read, since a binary has no log). */
ec_result ec_program_build(ec_cl *cl, const char *label, const char *source, const char *options, cl_program *program,
                           ec_error *err);
/* Likewise past all caches, and without changing anything of cl. */
ec_result ec_program_build_source(const ec_cl *cl, const char *label, const char *source, const char *options, cl_program *program, ec_error *err);

/* Creates a buffer and accounts for its bytes; over the device's limits it fails with the figures. host may be NULL, and is not needed after the
 * call. 0 bytes give a smallest buffer, so that an empty table is still an argument. */
ec_result ec_buffer_create(ec_cl *cl, const char *label, uint64_t bytes, const void *host, cl_mem *buffer, ec_error *err);
void ec_buffer_release(ec_cl *cl, cl_mem *buffer); /* sets it to NULL; NULL is fine */
/* If the device is a processor, makes a buffer of the caller's memory, which comes from ec_shared_alloc and is large enough to be worth it: no copy.
 * leave(buffer, user) is called once the buffer is gone. Returns false if no buffer was made; the memory stays the caller's then. */
bool ec_buffer_adopt(ec_cl *cl, const char *label, uint64_t bytes, void *memory, void(CL_CALLBACK *leave)(cl_mem buffer, void *user), void *user, cl_mem *buffer);
/* ec_buffer_put makes a buffer that no kernel writes: `bytes` of data, and room for `slack` more. With a key, which is that of label and data, it
 * stays on the device after its release, and is found there when the same is put again; keep_only releases all others that stay. */
ec_fingerprint ec_buffer_key(const char *label, uint64_t bytes, uint64_t slack, const void *data);
ec_result ec_buffer_put(ec_cl *cl, const char *label, uint64_t bytes, uint64_t slack, const void *data,
                        const ec_fingerprint *key, cl_mem *buffer, ec_error *err);
void ec_buffers_keep_only(ec_cl *cl, const ec_fingerprint *keys, uint32_t count);
ec_result ec_buffer_read(ec_cl *cl, cl_mem buffer, uint64_t offset, uint64_t bytes, void *to, ec_error *err); /* blocks */
ec_result ec_buffer_write(ec_cl *cl, cl_mem buffer, uint64_t offset, uint64_t bytes, const void *from, ec_error *err);
/* Enqueue a read or a write of a buffer's first bytes: `to` and `from` are the device's until the next call that waits. */
ec_result ec_buffer_read_later(ec_cl *cl, cl_mem buffer, uint64_t bytes, void *to, ec_error *err);
ec_result ec_buffer_write_later(ec_cl *cl, cl_mem buffer, uint64_t bytes, const void *from, ec_error *err);
/* Enqueues the write of a copy, of which there is only one: a call that waits must come before the next send. */
ec_result ec_buffer_send(ec_cl *cl, cl_mem buffer, uint64_t bytes, const void *from, ec_error *err);
/* Read or write the first bytes of rows that begin `pitch` bytes apart, to or from rows without gaps: one command for all, since each wakes the device. */
ec_result ec_buffer_read_rows(ec_cl *cl, cl_mem buffer, uint64_t pitch, uint64_t bytes, uint32_t rows, void *to, ec_error *err);
ec_result ec_buffer_write_rows(ec_cl *cl, cl_mem buffer, uint64_t pitch, uint64_t bytes, uint32_t rows, const void *from, ec_error *err);
/* Fills a range with the same four bytes, or with zeros (ec_buffer_zero): multiples of 4 bytes; enqueued. */
ec_result ec_buffer_fill(ec_cl *cl, cl_mem buffer, uint64_t offset, uint64_t bytes, const void *word, ec_error *err);
/* Maps the first `bytes` of a buffer into the host's memory until it is unmapped; until then no kernel may run that uses it. On a processor it is the
 * buffer's own memory, no copy. Waits. writes: changes go to the buffer. Unmapping sets *at to NULL; NULL is fine. */
ec_result ec_buffer_map(ec_cl *cl, cl_mem buffer, uint64_t bytes, bool writes, float **at, ec_error *err);
ec_result ec_buffer_unmap(ec_cl *cl, cl_mem buffer, float **at, ec_error *err);
ec_result ec_buffer_zero(ec_cl *cl, cl_mem buffer, uint64_t offset, uint64_t bytes, ec_error *err);

ec_result ec_kernel_create(cl_program program, const char *name, cl_kernel *kernel, ec_error *err);
/* Sets all arguments at once; the count must be the kernel's. ec_kernel_arguments(k, (ec_argument[]){EC_ARGUMENT(a), EC_ARGUMENT(b)}, 2, err), where
 * a and b are variables (cl_mem, cl_uint, structs…). */
typedef struct ec_argument {
    size_t bytes;
    const void *value;
} ec_argument;
#define EC_ARGUMENT(variable) {sizeof(variable), &(variable)}
ec_result ec_kernel_arguments(cl_kernel kernel, const ec_argument *arguments, uint32_t count, ec_error *err);
/* Launches in one dimension; global is rounded up to a multiple of local. Enqueued, not waited for: should it fail as it runs, the next
 * ec_buffer_read or ec_cl_finish says so, with the label (a text that lives as long). PoCL compiles a kernel once for each local size and once more
 * for launches of 65536 items and over: keep a kernel to one of each. */
ec_result ec_kernel_run(ec_cl *cl, const char *label, cl_kernel kernel, uint64_t global, uint32_t local, ec_error *err);
/* Likewise, in two dimensions if there is more than one row: each has `global` work-items. */
ec_result ec_kernel_run_rows(ec_cl *cl, const char *label, cl_kernel kernel, uint64_t global, uint32_t rows, uint32_t local, ec_error *err);
/* pace.c: on cards launches are cut into pieces that take no longer than half a second, to the same results. They stay small unless ec_cl_busy says
 * how many of the work-items with this label had something to do, before they run or after. */
void ec_cl_busy(ec_cl *cl, const char *label, uint64_t items);
ec_result ec_cl_finish(ec_cl *cl, ec_error *err);

/* An argument of ec_kernel_call: an array that is copied to the device and, if OUT, back (NULL makes it a NULL buffer), or a scalar. */
typedef struct ec_array {
    void *data;
    size_t bytes;
    enum { EC_ARRAY_IN, EC_ARRAY_OUT, EC_ARRAY_SCALAR } use;
} ec_array;
#define EC_IN(pointer, count) {(void *)(pointer), (size_t)(count) * sizeof *(pointer), EC_ARRAY_IN}
#define EC_OUT(pointer, count) {(void *)(pointer), (size_t)(count) * sizeof *(pointer), EC_ARRAY_OUT}
#define EC_SCALAR(variable) {(void *)&(variable), sizeof(variable), EC_ARRAY_SCALAR}
enum {
    EC_CALL_ARRAYS = 32, /* at most */
    EC_CALL_SLACK = 64   /* bytes past an array's end that lane-wide loads may read */
};
/* Runs kernel `name` once over `items` work-items and waits for it. */
ec_result ec_kernel_call(ec_cl *cl, cl_program program, const char *name, uint64_t items, uint32_t local, const ec_array *arrays,
                         uint32_t count, ec_error *err);

/* launches.c: takes over a command's event; waits for all of them and checks how they ended; drops them without either. */
ec_result ec_cl_launched(ec_cl *cl, cl_event event, const char *label, ec_pace *pace, ec_error *err);
ec_result ec_cl_landed(ec_cl *cl, ec_error *err);
void ec_cl_forget_launches(ec_cl *cl);

const char *ec_cl_error_name(cl_int code);
ec_error_kind ec_cl_error_kind(cl_int code);
/* Fails with "clEnqueueNDRangeKernel (intersect) failed: CL_OUT_OF_RESOURCES". */
ec_result ec_cl_check(cl_int code, const char *call, const char *label, ec_error *err);

#endif
