#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/freed.h"
#include "cl/workarounds.h"
#include "ranks/ranks_internal.h"

/* The job as plain values, since all ranks run the same program on machines of one kind. The buffers follow in order. */
typedef struct sheet {
    ec_payload_head head;
    uint64_t seed;
    ec_payload_buffer buffers[EC_PAYLOAD_BUFFERS]; /* valid except for their addresses */
} sheet;

static void mix(uint64_t *hash, const char *text) /* FNV-1a */
{
    for (; *text; text++) *hash = (*hash ^ (uint8_t)*text) * 0x100000001b3;
}

/* Returns a digest of what must be the same on all ranks: for equal bits, and for the sheet to be readable. */
static uint64_t program_hash(void)
{
    uint64_t hash = 0xcbf29ce484222325 ^ sizeof(sheet);
    mix(&hash, ECLAT_VERSION);
    for (const char *const *name = ec_kernel_source_names(); *name; name++) mix(&hash, ec_kernel_source(*name));
    return hash;
}

static ec_result send_sheet(ec_ranks *r, const ec_payload *payload, uint64_t seed, ec_error *err)
{
    EC_FREED sheet *s = calloc(1, sizeof *s);
    if (!s) return ec_fail(err, "out of memory");
    s->head = payload->head;
    s->seed = seed;
    memcpy(s->buffers, payload->buffers, sizeof s->buffers);
    EC_TRY(ec_transport_spread(r->transport, s, sizeof *s, EC_BOX_SCENE, err));
    for (uint32_t i = 0; i < payload->head.buffer_count; i++)
        EC_TRY(ec_transport_spread(r->transport, (void *)payload->buffers[i].data, payload->buffers[i].bytes, EC_BOX_SCENE, err)); /* only read here */
    return EC_OK;
}

#define OTHER_PROGRAM "runs another version of eclat, whose samples would differ; install the same version everywhere"

/* A rank's answer to the job: EC_READY_*, a number, and a text. */
enum { EC_READY_RANKS };
enum { EC_READY = EC_WORD_OVER + 1, EC_READY_WITHOUT_DEVICE, EC_READY_OTHER_PROGRAM };

/* The answer of this rank and all ranks below it. */
typedef struct readiness {
    uint32_t ranks;   /* number of those with a device */
    uint32_t kind;    /* EC_READY if any has a device, EC_READY_OTHER_PROGRAM if any runs another program */
    char text[2400];  /* "host: device"; then one line for each rank without a device or with another program */
} readiness;

static void add_line(readiness *all, const char *line)
{
    size_t used = strlen(all->text);
    if (*line) snprintf(all->text + used, sizeof all->text - used, "\n%s", line);
}

static void hear(ec_ranks *r, uint32_t child, readiness *all)
{
    ec_message message;
    ec_error why;
    ec_remote *remote = &r->remotes[child];
    const int rank = r->place->first_child + (int)child;
    *remote = (ec_remote){.ranks = r, .rank = rank};
    if (ec_transport_receive(r->transport, rank, EC_BOX_WORD, NULL, NULL, &message, &why) != EC_OK) {
        char line[sizeof why.text + 64];
        snprintf(line, sizeof line, "%s; the others go on without it", why.text);
        add_line(all, line);
        return;
    }
    char none[] = "", *text = message.body ? message.body : none, *more = strchr(text, '\n');
    if (more) *more++ = 0;
    *remote = (ec_remote){.ranks = r, .rank = rank, .is_ready = message.kind == EC_READY, .ready = (uint32_t)message.numbers[EC_READY_RANKS]};
    all->ranks += remote->ready;
    snprintf(remote->name, sizeof remote->name, "rank %d on %s", rank, text);
    if (message.kind == EC_READY_OTHER_PROGRAM || (message.kind == EC_READY && all->kind == EC_READY_WITHOUT_DEVICE))
        all->kind = message.kind;
    if (more) add_line(all, more);
    free(message.body);
}

/* Passes the job on to the children, and collects their answers. Ranks that are lost do not answer. */
static void ask_below(ec_ranks *r, const ec_message *word, readiness *all)
{
    for (uint32_t i = 0; i < r->remote_count; i++) (void)ec_transport_send(r->transport, r->place->first_child + (int)i, word, NULL);
    for (uint32_t i = 0; i < r->remote_count; i++) hear(r, i, all);
}

ec_result ec_job_send(ec_ranks *r, const ec_payload *payload, uint64_t seed, const ec_log *log, ec_error *err)
{
    char text[4096];
    const int used = snprintf(text, sizeof text, "%s%s%s", r->own, r->device ? "\n" : "", r->device ? r->device : "");
    if (used >= (int)sizeof text)
        return ec_fail(err, "--device takes at most %zu characters in an MPI job", sizeof text - strlen(r->own) - 2);
    const ec_message word = {.kind = EC_WORD_JOB, .box = EC_BOX_WORD, .bytes = (uint64_t)used + 1, .body = text,
                            .numbers = {[EC_JOB_PROGRAM] = program_hash(), [EC_JOB_ROUNDS] = r->own_round}};
    readiness all = {.kind = EC_READY};
    ask_below(r, &word, &all);
    uint64_t go = all.kind != EC_READY_OTHER_PROGRAM;
    char *rest = all.text, *line;
    EC_TRY(ec_transport_spread(r->transport, &go, sizeof go, EC_BOX_SCENE, err));
    while ((line = strsep(&rest, "\n"))) {
        if (strstr(line, OTHER_PROGRAM)) return ec_fail(err, "%s", line);
        if (*line) ec_warn(log, "%s", line);
    }
    return send_sheet(r, payload, seed, err);
}

static ec_result receive_sheet(ec_ranks *r, ec_payload *payload, uint64_t *seed, ec_error *err)
{
    EC_FREED sheet *s = malloc(sizeof *s);
    if (!s) return ec_fail(err, "out of memory");
    EC_TRY(ec_transport_spread(r->transport, s, sizeof *s, EC_BOX_SCENE, err));
    payload->head = s->head;
    payload->head.buffer_count = 0;
    *seed = s->seed;
    for (uint32_t i = 0; i < s->head.buffer_count; i++) {
        ec_payload_buffer *b = &payload->buffers[i];
        *b = s->buffers[i];
        b->data = b->owned = malloc(b->bytes + 1);
        if (!b->owned) return ec_fail(err, "out of memory for %llu bytes of the scene's %s", (unsigned long long)b->bytes, b->label);
        payload->head.buffer_count++;
        EC_TRY(ec_transport_spread(r->transport, b->owned, b->bytes, EC_BOX_SCENE, err));
    }
    return EC_OK;
}

/* Fills in the answer of this rank alone: "host: text" and, if it cannot take part, another line for the root. */
static void describe(const ec_ranks *r, uint32_t kind, const char *text, readiness *own)
{
    char host[256] = "", line[2000];
    (void)gethostname(host, sizeof host - 1);
    own->kind = kind;
    snprintf(own->text, sizeof own->text, "%s%s%.600s", host, *text ? ": " : "", text);
    if (kind == EC_READY_WITHOUT_DEVICE)
        snprintf(line, sizeof line, "rank %d on %.900s; the others go on without it", r->place->rank, own->text);
    if (kind == EC_READY_OTHER_PROGRAM) snprintf(line, sizeof line, "rank %d on %.900s " OTHER_PROGRAM, r->place->rank, own->text);
    if (kind != EC_READY) add_line(own, line);
}

/* Adds a line for the root to warn of, if a device has other drivers than rank 0's, and one of the two is not known to round correctly. */
static void look_at_rounding(const ec_ranks *r, const ec_message *word, const char *drivers,
                             const ec_device_info *devices, uint32_t count, readiness *own)
{
    char driver[520], line[1000];
    for (uint32_t i = 0; i < count; i++) {
        ec_device_drivers(&devices[i], 1, driver, sizeof driver);
        if (strstr(drivers, driver) || (word->numbers[EC_JOB_ROUNDS] && ec_device_rounds(&devices[i]))) continue;
        snprintf(line, sizeof line, "rank %d has %s and rank 0 has %.300s; if one of these does not round division and square root correctly, the "
                                    "last bits differ from those of one device", r->place->rank, driver, drivers);
        add_line(own, line);
        return;
    }
}

/* Finds the devices. Ranks on one host divide them up if --device names several. */
static ec_result find_devices(const ec_ranks *r, const char *id, ec_device_info *devices, uint32_t *count, ec_error *err)
{
    uint32_t indices[EC_DEVICES_MOST];
    EC_TRY(ec_device_find_several(id, devices, indices, EC_DEVICES_MOST, count, NULL, err));
    ec_mpi_share_devices(r, devices, indices, count);
    return EC_OK;
}

ec_result ec_job_receive(ec_ranks *r, const ec_message *word, ec_payload *payload, uint64_t *seed, ec_device_info *devices,
                         uint32_t *count, ec_error *err)
{
    ec_error why = {0};
    readiness all = {0};
    char none[] = "", *drivers = word->body ? word->body : none, *device = strchr(drivers, '\n');
    *count = 0;
    if (device) *device++ = 0;
    if (word->numbers[EC_JOB_PROGRAM] != program_hash()) describe(r, EC_READY_OTHER_PROGRAM, "", &all);
    else if (find_devices(r, device, devices, count, &why) == EC_OK) describe(r, EC_READY, devices->name, &all);
    else describe(r, EC_READY_WITHOUT_DEVICE, why.text, &all), *count = 0;
    look_at_rounding(r, word, drivers, devices, *count, &all);
    if (device) device[-1] = '\n'; /* as it was received, for the ranks below */
    all.ranks = *count > 0;
    ask_below(r, word, &all);
    const ec_message message = {.kind = all.kind, .box = EC_BOX_WORD, .bytes = strlen(all.text) + 1, .body = all.text,
                              .numbers = {[EC_READY_RANKS] = all.ranks}};
    EC_TRY(ec_transport_send(r->transport, r->place->parent, &message, err));
    uint64_t go = 0;
    EC_TRY(ec_transport_spread(r->transport, &go, sizeof go, EC_BOX_SCENE, err));
    if (go) return receive_sheet(r, payload, seed, err);
    *count = 0; /* the root reports why, and dismisses all */
    for (uint32_t i = 0; i < r->remote_count; i++) r->remotes[i].is_ready = false;
    return EC_OK;
}
