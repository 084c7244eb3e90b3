/* A scene and its options made ready for devices: everything that goes to one, with nothing left to be read from the scene. Made once and then only
 * read, so that any number of devices can be loaded from it, by several threads at once. */
#ifndef EC_DEVICE_PAYLOAD_H
#define EC_DEVICE_PAYLOAD_H

#include "accel/accel.h"
#include "pack/pack.h"
#include "device/insides.h"
#include "device/options.h"
#include "device/stats.h"
#include "device/stages.h"
#include "shared/params.h"

/* Devices of one kind use the same acceleration structures. */
typedef enum ec_device_kind { EC_KIND_OTHER, EC_KIND_CPU, EC_KIND_COUNT } ec_device_kind;
static inline ec_device_kind ec_device_kind_of(const ec_device_info *info)
{
    return info->type & CL_DEVICE_TYPE_CPU ? EC_KIND_CPU : EC_KIND_OTHER;
}

/* Plain values: their bytes mean the same to another process of this program. */
typedef struct ec_payload_head {
    ec_params params;                /* but for wave and part, which depend on the device */
    ec_render_effects effects;
    ec_integrator integrator;
    uint32_t replicates;             /* film/schedule.h */
    bool fast_math;
    uint32_t lanes, wave;            /* as in the options: 0 = whatever suits the device */
    ec_compile compile;
    uint32_t waves_until_fast;
    uint32_t accels[EC_KIND_COUNT];  /* 1 << which: those that devices of a kind use */
    uint32_t triangle_count;
    uint32_t bodies_too_many;        /* number of materials of bodies, if these are too many to be told apart; else 0 */
    uint32_t buffer_count;
} ec_payload_head;

typedef struct ec_payload_buffer {
    uint32_t arg;                    /* ec_arg; EC_ARG_ACCEL + k for the k-th of an accelerator's */
    uint32_t accel;                  /* of which accelerator; EC_ACCEL_COUNT: of none */
    char label[64];                  /* for messages */
    uint64_t bytes;                  /* of data … */
    uint64_t slack;                  /* … and so many more on the device, of any value */
    const void *data;
    void *owned;                     /* data, if it is to be freed, and has room for the slack; NULL: data belongs to what the payload was made of … */
    struct ec_texels *texels;        /* … or in these, of which the payload is a user */
} ec_payload_buffer;

enum { EC_PAYLOAD_BUFFERS = EC_SCENE_BUFFERS + 4 + EC_ACCEL_COUNT * EC_ACCEL_BUFFERS };

/* Not to be copied: buffers point into it. */
typedef struct ec_payload {
    ec_payload_head head;
    ec_payload_buffer buffers[EC_PAYLOAD_BUFFERS];
    ec_insides insides;              /* the media that a camera can be inside of; no device uses them */
    ec_pack pack;                    /* these three hold what buffers do not own; all zero in a payload that came from elsewhere */
    ec_scene written;
    ec_scene_view view;
} ec_payload;

/* Makes a payload for devices of these kinds (1 << ec_device_kind). The scene must stay as long as the payload does. alone: the device that gets it, if
 * there is only one, which begins to build kernels meanwhile; else NULL. stats gets what is known then: times, counts, content. The payload is to be
 * freed on failure too. */
ec_result ec_payload_make(const ec_scene *scene, const ec_render_options *options, uint32_t batch, uint32_t kinds, ec_cl *alone, ec_payload *payload,
                        ec_render_stats *stats, ec_error *err);
void ec_payload_free(ec_payload *payload); /* zero-initialised or freed is fine */
void ec_payload_buffer_free(ec_payload_buffer *buffer); /* frees what it owns; may be called twice */

/* The two steps of ec_payload_make that determine effects. The first chooses what of the scene is rendered and, in called_for, what says which effects
 * that takes: they are the payload's or the scene itself. The second packs it, and sets the head's effects; alone and batch: as above. */
ec_result ec_payload_choose(ec_payload *payload, const ec_scene **scene, const ec_scene **called_for,
                          const ec_render_options *options, ec_error *err);
ec_result ec_payload_pack(ec_payload *payload, const ec_scene *scene, const ec_scene *called_for,
                        const ec_render_options *options, ec_cl *alone, uint32_t batch, ec_error *err);

/* Adds a buffer; NULL data adds none. owned: as in ec_payload_buffer; the payload owns it from here on. */
void ec_payload_add(ec_payload *payload, uint32_t arg, const char *label, uint64_t bytes, uint64_t slack, const void *data, void *owned);

/* Builds an accelerator and adds its buffers; stats may be NULL. */
ec_result ec_payload_add_accel(ec_payload *payload, uint32_t which, ec_accel_input *input, ec_accel_stats *stats, ec_error *err);

/* camera.c: adds the keys of a moving camera; nothing for a camera that stands still */
ec_result ec_payload_add_camera(ec_payload *payload, const ec_scene *scene, const ec_render_options *options, ec_error *err);
/* upload_plan.c: adds the scene's buffers that are called for */
ec_result ec_payload_add_scene(ec_payload *payload, const ec_scene *scene, ec_pack *pack, ec_error *err);
/* content.c: fills in what is rendered; params must be complete */
void ec_payload_content(const ec_payload_head *head, const ec_scene *scene, const ec_pack *pack, ec_content *content);

#endif
