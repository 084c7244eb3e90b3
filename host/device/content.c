/* Digests of the buffers as they are planned, so that a new one is included without a line here. Acceleration structures, lanes and waves are left
 * out: they make no difference to a sample. */
#include "device/content.h"

#include <string.h>
#include <sys/types.h>

#include "base/sha256.h"
#include "device/light_share.h"
#include "device/pipeline.h"

static void add(ec_sha256 *digests, ec_content_id id, const void *bytes, uint64_t size)
{
    ec_sha256_add(&digests[id], &size, sizeof size);
    ec_sha256_add(&digests[id], bytes, (size_t)size);
}

static ec_content_id group_of(ec_arg arg)
{
    switch (arg) {
    case EC_ARG_MATERIALS: return EC_CONTENT_MATERIALS;
    case EC_ARG_TEXTURE_TABLE:
    case EC_ARG_TEXELS:
    case EC_ARG_SRGB: return EC_CONTENT_TEXTURES;
    case EC_ARG_LIGHT_TABLE:
    case EC_ARG_LIGHT_SHARES:
    case EC_ARG_LIGHT_TREE:
    case EC_ARG_LIGHT_TRAILS:
    case EC_ARG_LAMP_PARTS: return EC_CONTENT_LIGHTS;
    case EC_ARG_ENVIRONMENT_TEXELS:
    case EC_ARG_ENVIRONMENT_TABLE: return EC_CONTENT_ENVIRONMENT;
    default: return EC_CONTENT_GEOMETRY;
    }
}

static void add_buffers(ec_sha256 *digests, const ec_scene *scene, const ec_pack *pack, ec_render_effects effects)
{
    ec_upload plan[EC_SCENE_BUFFERS];
    uint32_t count = ec_upload_plan(scene, pack, plan, &effects);
    for (uint32_t i = 0; i < count; i++) {
        const ec_upload *u = &plan[i];
        ec_content_id id = group_of(u->arg);
        ec_sha256_add(&digests[id], u->buffer.label, strlen(u->buffer.label));
        if (u->data) add(digests, id, u->data, u->buffer.bytes ? u->buffer.bytes - u->slack : 0);
        for (int set = 0; !u->data && u->buffer.bytes && set < 2; set++)
            add(digests, id, scene->uv[set], scene->uv[set] ? 8ull * scene->vertex_count : 0);
    }
}

/* The scene's buffers do not have these: only that of the chosen camera goes to the device. */
static void add_moving_cameras(ec_sha256 *digests, const ec_motion *motion)
{
    for (uint32_t i = 0; i < motion->camera_count * (motion->segments + 1); i++) {
        const ec_camera *c = &motion->cameras[i];
        const float *const vectors[] = {c->position, c->right, c->up, c->forward};
        for (int v = 0; v < 4; v++) add(digests, EC_CONTENT_CAMERA, vectors[v], 3 * sizeof(float));
        const float view[] = {c->yfov, c->aspect, c->xmag, c->ymag};
        add(digests, EC_CONTENT_CAMERA, view, sizeof view);
    }
}

#define TAKE(id, field) (add(digests, id, &p.field, sizeof p.field), memset(&p.field, 0, sizeof p.field))

/* Digests params: the camera's and the environment's fields one by one; all that is left is settings. */
static void add_params(ec_sha256 *digests, ec_params p)
{
    p.batch = p.first_sample = p.wave = p.part = p.film_rows = p.light_apart = 0;
    p.limit = 0; /* these follow from the other fields */
    if (p.far_numbers) ec_light_share_set(&p, 0.5);
    TAKE(EC_CONTENT_CAMERA, camera_origin);
    TAKE(EC_CONTENT_CAMERA, camera_right);
    TAKE(EC_CONTENT_CAMERA, camera_up);
    TAKE(EC_CONTENT_CAMERA, camera_forward);
    TAKE(EC_CONTENT_CAMERA, lens_right);
    TAKE(EC_CONTENT_CAMERA, lens_up);
    TAKE(EC_CONTENT_CAMERA, lens_nearness);
    TAKE(EC_CONTENT_CAMERA, orthographic);
    TAKE(EC_CONTENT_CAMERA, screen);
    TAKE(EC_CONTENT_CAMERA, film_area);
    TAKE(EC_CONTENT_CAMERA, camera_medium);
    TAKE(EC_CONTENT_ENVIRONMENT, environment);
    TAKE(EC_CONTENT_ENVIRONMENT, environment_mean);
    TAKE(EC_CONTENT_ENVIRONMENT, environment_turn);
    TAKE(EC_CONTENT_ENVIRONMENT, environment_turned);
    TAKE(EC_CONTENT_ENVIRONMENT, environment_width);
    TAKE(EC_CONTENT_ENVIRONMENT, environment_height);
    TAKE(EC_CONTENT_LIGHTS, environment_pmf);
    TAKE(EC_CONTENT_LIGHTS, light_count);
    TAKE(EC_CONTENT_LIGHTS, light_choices);
    TAKE(EC_CONTENT_LIGHTS, light_tree_numbers);
    TAKE(EC_CONTENT_LIGHTS, environment_stretch);
    TAKE(EC_CONTENT_GEOMETRY, scene_radius);
    TAKE(EC_CONTENT_GEOMETRY, scene_max);
    TAKE(EC_CONTENT_GEOMETRY, scene_centre);
    add(digests, EC_CONTENT_SETTINGS, &p, sizeof p);
}

static void add_kernels(ec_sha256 *digests)
{
    for (const char *const *name = ec_kernel_source_names(); *name; name++)
        add(digests, EC_CONTENT_KERNELS, ec_kernel_source(*name), strlen(ec_kernel_source(*name)));
}

static void write_digest(ec_sha256 *digest, char text[33])
{
    uint8_t bytes[EC_SHA256_BYTES];
    ec_sha256_end(digest, bytes);
    ec_sha256_write(bytes, 16, text);
}

void ec_payload_content(const ec_payload_head *head, const ec_scene *scene, const ec_pack *pack, ec_content *content)
{
    ec_sha256 digests[EC_CONTENT_COUNT];
    for (int i = 0; i < EC_CONTENT_COUNT; i++) ec_sha256_begin(&digests[i]);
    add_buffers(digests, scene, pack, head->effects);
    add_params(digests, head->params);
    const uint64_t called = content->called = head->effects.called.bits & ~(uint64_t)EC_FEATURE_INSTANCES; /* the same whether meshes are kept once or
                                                                                                            * written out */
    add(digests, EC_CONTENT_SETTINGS, &called, sizeof called);
    if (called & EC_FEATURE_MOTION) add_moving_cameras(digests, &scene->motion);
    add_kernels(digests);
    for (int i = 0; i < EC_CONTENT_COUNT; i++) write_digest(&digests[i], content->digest[i]);
}

void ec_content_kernels(char digest[33])
{
    ec_sha256 digests[EC_CONTENT_COUNT];
    ec_sha256_begin(&digests[EC_CONTENT_KERNELS]);
    add_kernels(digests);
    write_digest(&digests[EC_CONTENT_KERNELS], digest);
}
