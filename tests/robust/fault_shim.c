/* LD_PRELOADed into eclat: makes one OpenCL call, file call or allocation of eclat's own fail, and counts all calls. Environment variables:
 *   FAULT_CALL=clCreateBuffer   the call; FAULT_AT=3: its third use (1 if not given)
 *   FAULT_CODE=-5               the result: an OpenCL code, or an errno for file calls; default CL_OUT_OF_RESOURCES, ENOSPC
 *   FAULT_SIGNAL=9              instead: the process gets this signal, and the call goes on once the signal is delivered
 *   FAULT_HANG=FILE             instead: the call never returns, as with a device that hangs; FILE is made first
 *   FAULT_PAUSE=5               instead: from that call on, each call takes so many milliseconds longer, as with a slow device
 *   FAULT_DEVICE=1              counts only calls on the second context that was made
 *   FAULT_LOST=1                from then on every OpenCL call fails, as with a lost device
 *   FAULT_STATUS=-5             for clGetEventInfo: the call succeeds and reports that the command failed
 *   FAULT_MEMORY=BYTES          limit of all buffers; above it FAULT_CALL (creation, or the first use) always fails
 *   FAULT_GROUP=N               largest work-group, for every kernel
 *   FAULT_ROUNDS=0              the device does not claim to round division and square root correctly
 *   FAULT_LOG=TEXT              the compiler's log
 *   FAULT_PLATFORM=TEXT         the platform's version; without PoCL's name in it, eclat uses a kernel cache of its own
 *   FAULT_EXTENSIONS=TEXT       names of the extensions that the device says it has
 *   FAULT_FOLDER=PATH           counts only file calls below this folder
 *   FAULT_NO_TMPFILE=1          files without names cannot be made there
 *   FAULT_COUNTS=FILE           gets a line "call count" for each call that was made
 *   FAULT_LAUNCHES=FILE         gets a line "program kernel work-items" for each launch */
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <sched.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define CALLS(X)                                                                                                                   \
    X(clGetPlatformIDs) X(clGetPlatformInfo) X(clGetDeviceIDs) X(clGetDeviceInfo) X(clCreateContext) X(clCreateCommandQueue)       \
    X(clCreateBuffer) X(clCreateProgramWithSource) X(clCreateProgramWithBinary) X(clBuildProgram) X(clGetProgramBuildInfo)         \
    X(clGetProgramInfo) X(clCreateKernel) X(clSetKernelArg) X(clEnqueueNDRangeKernel) X(clEnqueueReadBuffer)                       \
    X(clEnqueueWriteBuffer) X(clEnqueueFillBuffer) X(clEnqueueMapBuffer) X(clEnqueueUnmapMemObject) X(clFinish) X(clWaitForEvents) X(clGetEventInfo)                                \
    X(write) X(pwrite) X(fsync) X(linkat) X(rename) X(open) X(close)                                                               \
    X(malloc) /* and calloc, realloc, ... */
enum call {
#define NAME(name) CALL_##name,
    CALLS(NAME)
#undef NAME
    CALL_COUNT
};
#define NAME(name) #name,
static const char *const names[] = {CALLS(NAME)};
#undef NAME
static unsigned counts[CALL_COUNT];
static size_t allocated;
static bool lost;

/* The number of the context of a thread's last call: each device is used by a thread of its own. */
static cl_context contexts[16];
static unsigned context_count;
static __thread unsigned here;

static void on_context(cl_context context)
{
    for (unsigned i = 0; i < context_count; i++)
        if (contexts[i] == context) here = i;
}

static void on_queue(cl_command_queue queue)
{
    cl_context context = NULL;
    clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof context, &context, NULL);
    on_context(context);
}

static long number(const char *variable, long otherwise)
{
    const char *text = getenv(variable);
    return text ? atol(text) : otherwise;
}

__attribute__((destructor)) static void tell(void)
{
    const char *path = getenv("FAULT_COUNTS");
    FILE *file = path ? fopen(path, "w") : NULL;
    for (int i = 0; file && i < CALL_COUNT; i++)
        if (counts[i]) fprintf(file, "%s %u\n", names[i], counts[i]);
    if (file) fclose(file);
}

static bool is_chosen_device(void)
{
    return !getenv("FAULT_DEVICE") || (unsigned)number("FAULT_DEVICE", 0) == here;
}

static void send_signal(int which)
{
    sigset_t pending;
    kill(getpid(), which);
    while (sigpending(&pending) == 0 && sigismember(&pending, which) > 0) sched_yield(); /* another thread takes the signal */
}

static void hang(const char *path)
{
    FILE *file = fopen(path, "w");
    if (file) fclose(file);
    for (;;) pause();
}

/* Counts the call; returns whether it is the one to fail. */
static bool is_due(enum call call)
{
    const char *chosen = getenv("FAULT_CALL");
    long memory = number("FAULT_MEMORY", 0), signal_number = number("FAULT_SIGNAL", 0);
    if (!is_chosen_device()) return false;
    unsigned count = __atomic_add_fetch(&counts[call], 1, __ATOMIC_RELAXED);
    if (!chosen || strcmp(chosen, names[call])) return false;
    if (memory) return allocated > (size_t)memory;
    if (getenv("FAULT_PAUSE") && count >= (unsigned)number("FAULT_AT", 1)) usleep(1000 * (unsigned)number("FAULT_PAUSE", 0));
    if (getenv("FAULT_PAUSE") || count != (unsigned)number("FAULT_AT", 1)) return false;
    if (signal_number) send_signal((int)signal_number);
    if (getenv("FAULT_HANG")) hang(getenv("FAULT_HANG"));
    return !signal_number;
}

static cl_int device_fault(enum call call)
{
    if (!is_due(call) && !(lost && is_chosen_device())) return CL_SUCCESS;
    lost = getenv("FAULT_LOST") != NULL;
    return (cl_int)number("FAULT_CODE", CL_OUT_OF_RESOURCES);
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

#define ANSWERS(name, parameters, arguments) ANSWERS_ON((void)0, name, parameters, arguments)
#define ANSWERS_ON(place, name, parameters, arguments)                                                                                       \
    cl_int name parameters                                                                                                         \
    {                                                                                                                              \
        place;                                                                                                                     \
        cl_int code = device_fault(CALL_##name);                                                                                   \
        return code ? code : REAL(name) arguments;                                                                                 \
    }
ANSWERS(clGetPlatformIDs, (cl_uint n, cl_platform_id *p, cl_uint *found), (n, p, found))
ANSWERS(clGetDeviceIDs, (cl_platform_id p, cl_device_type t, cl_uint n, cl_device_id *d, cl_uint *found), (p, t, n, d, found))
ANSWERS(clBuildProgram, (cl_program p, cl_uint n, const cl_device_id *d, const char *o, void(CL_CALLBACK *f)(cl_program, void *), void *u), (p, n, d, o, f, u))
ANSWERS(clGetProgramInfo, (cl_program p, cl_program_info i, size_t n, void *v, size_t *r), (p, i, n, v, r))
ANSWERS(clSetKernelArg, (cl_kernel k, cl_uint i, size_t n, const void *v), (k, i, n, v))

static void note_launch(cl_kernel kernel, size_t items)
{
    char name[128] = "?";
    cl_program program = NULL;
    FILE *file = getenv("FAULT_LAUNCHES") ? fopen(getenv("FAULT_LAUNCHES"), "a") : NULL;
    if (!file) return;
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof name, name, NULL);
    clGetKernelInfo(kernel, CL_KERNEL_PROGRAM, sizeof program, &program, NULL);
    fprintf(file, "%p %s %zu\n", (void *)program, name, items);
    fclose(file);
}

ANSWERS_ON(on_queue(q), clEnqueueReadBuffer, (cl_command_queue q, cl_mem m, cl_bool b, size_t o, size_t s, void *v, cl_uint n, const cl_event *w, cl_event *e), (q, m, b, o, s, v, n, w, e))
ANSWERS_ON(on_queue(q), clEnqueueWriteBuffer, (cl_command_queue q, cl_mem m, cl_bool b, size_t o, size_t s, const void *v, cl_uint n, const cl_event *w, cl_event *e), (q, m, b, o, s, v, n, w, e))
ANSWERS_ON(on_queue(q), clEnqueueFillBuffer, (cl_command_queue q, cl_mem m, const void *v, size_t vs, size_t o, size_t s, cl_uint n, const cl_event *w, cl_event *e), (q, m, v, vs, o, s, n, w, e))
ANSWERS_ON(on_queue(q), clEnqueueUnmapMemObject, (cl_command_queue q, cl_mem m, void *v, cl_uint n, const cl_event *w, cl_event *e), (q, m, v, n, w, e))
ANSWERS_ON(on_queue(q), clFinish, (cl_command_queue q), (q))
ANSWERS(clWaitForEvents, (cl_uint n, const cl_event *e), (n, e))

#define MAKES(place, type, name, parameters, arguments)                                                                                   \
    type name parameters                                                                                                           \
    {                                                                                                                              \
        place;                                                                                                                     \
        cl_int code = device_fault(CALL_##name);                                                                                   \
        if (!code) return REAL(name) arguments;                                                                                    \
        if (error) *error = code;                                                                                                  \
        return NULL;                                                                                                               \
    }
MAKES(on_context(c), cl_command_queue, clCreateCommandQueue, (cl_context c, cl_device_id d, cl_command_queue_properties p, cl_int *error), (c, d, p, error))
MAKES(on_context(c), cl_program, clCreateProgramWithSource, (cl_context c, cl_uint n, const char **s, const size_t *l, cl_int *error), (c, n, s, l, error))
MAKES(on_context(c), cl_program, clCreateProgramWithBinary, (cl_context c, cl_uint n, const cl_device_id *d, const size_t *l, const unsigned char **b, cl_int *s, cl_int *error), (c, n, d, l, b, s, error))
MAKES(on_queue(q), void *, clEnqueueMapBuffer, (cl_command_queue q, cl_mem m, cl_bool b, cl_map_flags f, size_t o, size_t s, cl_uint n, const cl_event *w, cl_event *e, cl_int *error), (q, m, b, f, o, s, n, w, e, error))
MAKES((void)0, cl_kernel, clCreateKernel, (cl_program p, const char *n, cl_int *error), (p, n, error))

cl_context clCreateContext(const cl_context_properties *p, cl_uint n, const cl_device_id *d, void(CL_CALLBACK *f)(const char *, const void *, size_t, void *), void *u, cl_int *error)
{
    here = context_count;
    cl_int code = device_fault(CALL_clCreateContext);
    cl_context made = code ? NULL : REAL(clCreateContext)(p, n, d, f, u, error);
    if (code && error) *error = code;
    if (context_count < sizeof contexts / sizeof *contexts) contexts[context_count++] = made;
    return made;
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *error)
{
    on_context(context);
    allocated += size;
    cl_int code = device_fault(CALL_clCreateBuffer);
    if (!code) return REAL(clCreateBuffer)(context, flags, size, host, error);
    allocated -= size;
    *error = code;
    return NULL;
}

cl_int clReleaseMemObject(cl_mem buffer)
{
    size_t size = 0;
    clGetMemObjectInfo(buffer, CL_MEM_SIZE, sizeof size, &size, NULL);
    allocated -= size;
    return REAL(clReleaseMemObject)(buffer);
}

cl_int clGetEventInfo(cl_event event, cl_event_info what, size_t size, void *value, size_t *length)
{
    cl_int code = device_fault(CALL_clGetEventInfo);
    if (!code) return REAL(clGetEventInfo)(event, what, size, value, length);
    if (!getenv("FAULT_STATUS")) return code;
    *(cl_int *)value = (cl_int)number("FAULT_STATUS", 0);
    return CL_SUCCESS;
}

/* Limits the work-group size, as some graphics cards do. */
cl_int clEnqueueNDRangeKernel(cl_command_queue q, cl_kernel k, cl_uint d, const size_t *o, const size_t *g, const size_t *l, cl_uint n, const cl_event *w, cl_event *e)
{
    const size_t most = (size_t)number("FAULT_GROUP", 0);
    on_queue(q);
    note_launch(k, *g);
    cl_int code = device_fault(CALL_clEnqueueNDRangeKernel);
    if (!code && most && l && *l > most) code = CL_INVALID_WORK_GROUP_SIZE;
    return code ? code : REAL(clEnqueueNDRangeKernel)(q, k, d, o, g, l, n, w, e);
}

cl_int clGetKernelWorkGroupInfo(cl_kernel k, cl_device_id d, cl_kernel_work_group_info what, size_t size, void *value, size_t *length)
{
    const size_t most = (size_t)number("FAULT_GROUP", 0);
    cl_int code = REAL(clGetKernelWorkGroupInfo)(k, d, what, size, value, length);
    if (!code && most && what == CL_KERNEL_WORK_GROUP_SIZE && value) *(size_t *)value = most;
    return code;
}

/* Returns a text in place of the driver's. */
static cl_int say(const char *text, size_t size, void *value, size_t *length)
{
    if (length) *length = strlen(text) + 1;
    if (value && size <= strlen(text)) return CL_INVALID_VALUE;
    if (value) strcpy(value, text);
    return CL_SUCCESS;
}

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void *value, size_t *length)
{
    cl_int code = device_fault(CALL_clGetDeviceInfo);
    if (!code && what == CL_DEVICE_EXTENSIONS && getenv("FAULT_EXTENSIONS")) return say(getenv("FAULT_EXTENSIONS"), size, value, length);
    if (!code) code = REAL(clGetDeviceInfo)(device, what, size, value, length);
    if (!code && value && what == CL_DEVICE_SINGLE_FP_CONFIG && !number("FAULT_ROUNDS", 1))
        *(cl_device_fp_config *)value &= ~(cl_device_fp_config)CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    return code;
}

cl_int clGetProgramBuildInfo(cl_program program, cl_device_id device, cl_program_build_info what, size_t size, void *value, size_t *length)
{
    cl_int code = device_fault(CALL_clGetProgramBuildInfo);
    if (code) return code;
    if (what == CL_PROGRAM_BUILD_LOG && getenv("FAULT_LOG")) return say(getenv("FAULT_LOG"), size, value, length);
    return REAL(clGetProgramBuildInfo)(program, device, what, size, value, length);
}

cl_int clGetPlatformInfo(cl_platform_id platform, cl_platform_info what, size_t size, void *value, size_t *length)
{
    cl_int code = device_fault(CALL_clGetPlatformInfo);
    if (code) return code;
    if (what == CL_PLATFORM_VERSION && getenv("FAULT_PLATFORM")) return say(getenv("FAULT_PLATFORM"), size, value, length);
    return REAL(clGetPlatformInfo)(platform, what, size, value, length);
}

/* Files. */
static bool is_below(const char *path)
{
    const char *folder = getenv("FAULT_FOLDER");
    return folder && !strncmp(path, folder, strlen(folder));
}

static bool is_open_below(int fd)
{
    char link[64], path[4096];
    int saved = errno;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, path, sizeof path - 1);
    errno = saved;
    path[length > 0 ? length : 0] = 0;
    return is_below(path);
}

static bool file_fault(bool counts_here, enum call call)
{
    if (!counts_here || !is_due(call)) return false;
    errno = (int)number("FAULT_CODE", ENOSPC);
    return true;
}

ssize_t write(int fd, const void *from, size_t size)
{
    return file_fault(is_open_below(fd), CALL_write) ? -1 : REAL(write)(fd, from, size);
}

ssize_t pwrite(int fd, const void *from, size_t size, off_t at)
{
    return file_fault(is_open_below(fd), CALL_pwrite) ? -1 : REAL(pwrite)(fd, from, size, at);
}

int fsync(int fd)
{
    return file_fault(is_open_below(fd), CALL_fsync) ? -1 : REAL(fsync)(fd);
}

int close(int fd) /* closes the file in any case, as Linux does */
{
    bool fails = file_fault(is_open_below(fd), CALL_close);
    int saved = errno, result = REAL(close)(fd);
    if (fails) errno = saved;
    return fails ? -1 : result;
}

int linkat(int from, const char *old, int to, const char *name, int flags)
{
    return file_fault(is_below(name), CALL_linkat) ? -1 : REAL(linkat)(from, old, to, name, flags);
}

int rename(const char *old, const char *name)
{
    return file_fault(is_below(name), CALL_rename) ? -1 : REAL(rename)(old, name);
}

int open(const char *path, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    int mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(arguments, int) : 0;
    va_end(arguments);
    if ((flags & O_TMPFILE) == O_TMPFILE && is_below(path) && getenv("FAULT_NO_TMPFILE")) {
        errno = EOPNOTSUPP;
        return -1;
    }
    return file_fault(is_below(path), CALL_open) ? -1 : REAL(open)(path, flags, mode);
}

/* Allocations by libeclat itself; those of other libraries are not tested. */
static const char *ours, *ours_end;

static int find_ours(struct dl_phdr_info *info, size_t size, void *user)
{
    (void)size, (void)user;
    for (int i = 0; i < info->dlpi_phnum && strstr(info->dlpi_name, "/libeclat.so"); i++) {
        const ElfW(Phdr) *header = &info->dlpi_phdr[i];
        if (header->p_type != PT_LOAD || !(header->p_flags & PF_X)) continue;
        ours = (const char *)info->dlpi_addr + header->p_vaddr;
        ours_end = ours + header->p_memsz;
    }
    return 0;
}

__attribute__((constructor)) static void find_library(void) { dl_iterate_phdr(find_ours, NULL); }

static bool memory_fault(const void *caller)
{
    if ((const char *)caller < ours || (const char *)caller >= ours_end || !is_due(CALL_malloc)) return false;
    errno = ENOMEM;
    return true;
}

#define ALLOCATES(name, parameters, arguments)                                                                                     \
    void *__libc_##name parameters;                                                                                                \
    void *name parameters { return memory_fault(__builtin_return_address(0)) ? NULL : __libc_##name arguments; }
ALLOCATES(malloc, (size_t size), (size))
ALLOCATES(calloc, (size_t count, size_t size), (count, size))
ALLOCATES(realloc, (void *old, size_t size), (old, size))
