/* Scenes for tests of effects: a few quads with textures of known texels. */
#ifndef EC_TESTS_SUPPORT_EFFECT_MODEL_H
#define EC_TESTS_SUPPORT_EFFECT_MODEL_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/model.h"

/* Textures that every such scene has. MIXED: texels of 0 and 255 in all channels; DEEP: the same with 16 bits; NOISE: values of 100 and
 * more. */
enum { EM_BLACK, EM_WHITE, EM_MIXED, EM_DEEP, EM_GREEN, EM_GREY, EM_NOISE, EM_TEXTURES };
enum { EM_SIDE = 4, EM_MATERIALS = 64 };

/* A model whose materials may use these textures; em_scene adds the textures. */
typedef struct effect_model {
    ec_model *model;
    ec_material materials[EM_MATERIALS];
    int32_t count;
} effect_model;

static inline effect_model em_new(void) { return (effect_model){.model = ec_model_new()}; }

static inline void em_use(ec_material *m, int slot, int texture)
{
    m->textures[slot] = (ec_texture_use){texture, 0, {1, 0, 0, 0, 1, 0}};
}

/* Pure Lambert, opaque, double-sided: needs no effects. */
static inline ec_material em_plain(void)
{
    ec_material m = ec_material_lambert(0.5, 0);
    m.double_sided = true;
    return m;
}

static inline int32_t em_material(effect_model *e, const ec_material *m)
{
    ec_material bare = e->materials[e->count++] = *m;
    for (int k = 0; k < EC_SLOT_COUNT; k++) bare.textures[k].texture = -1;
    return ec_model_material(e->model, &bare);
}

static inline void em_add_textures(ec_scene *s)
{
    free(s->images);
    free(s->textures);
    s->images = calloc(EM_TEXTURES, sizeof *s->images);
    s->textures = calloc(EM_TEXTURES, sizeof *s->textures);
    s->image_count = s->texture_count = EM_TEXTURES;
    for (uint32_t t = 0; t < EM_TEXTURES; t++) {
        ec_image *image = &s->images[t];
        const int texels = EM_SIDE * EM_SIDE;
        image->width = image->height = EM_SIDE;
        s->textures[t].image = t;
        if (t == EM_DEEP) image->rgba16 = calloc((size_t)texels * 4, 2);
        else image->rgba8 = calloc((size_t)texels * 4, 1);
        for (int i = 0; i < 4 * texels; i++) {
            bool mixed = i / 4 % 2, green = i % 4 == 1;
            int v = t == EM_WHITE || (mixed && (t == EM_MIXED || t == EM_DEEP)) || (green && t == EM_GREEN) ? 255 : t == EM_GREY ? 128 : 0;
            if (t == EM_NOISE) v = 100 + i * 37 % 156;
            if (image->rgba16) image->rgba16[i] = (uint16_t)(257 * v);
            else image->rgba8[i] = (uint8_t)v;
        }
    }
}

/* A quad of 2 x 2 about the origin, facing +z, with texture coordinates. Normals and colours (4 a vertex) may be NULL. */
static inline void em_quad(effect_model *e, int32_t material, const float normals[12])
{
    static const float positions[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, uv[8] = {0, 1, 1, 1, 1, 0, 0, 0};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    ec_model_add(e->model, material, &(ec_model_mesh){.vertex_count = 4, .index_count = 6, .positions = positions, .uv = uv,
                                                   .normals = normals, .indices = indices});
}

static inline ec_scene *em_scene(effect_model *e)
{
    ec_error err = {0};
    ec_scene *scene;
    if (ec_model_scene(e->model, &scene, &err) != EC_OK) {
        fprintf(stderr, "model: %s\n", err.text);
        exit(1);
    }
    em_add_textures(scene);
    for (int32_t i = 0; i < e->count; i++) memcpy(scene->materials[i].textures, e->materials[i].textures, sizeof scene->materials[i].textures);
    return scene;
}

/* The camera moves to the right while the shutter is open. */
static inline void em_pan(ec_scene *scene)
{
    ec_camera *keys = calloc(2, sizeof *keys);
    scene->cameras[0].moves = 1;
    for (int k = 0; keys && k < 2; k++) {
        keys[k] = scene->cameras[0];
        keys[k].name = NULL;
        keys[k].position[0] += 0.2f * (float)k;
    }
    scene->motion = (ec_motion){.segments = 1, .camera_count = 1, .cameras = keys};
}

/* A scene that needs every effect that --without can leave out, each in a place of its own before a floor, so that the picture changes
 * without it: 16 squares, 4 in a row, the last with a body in a body. */
static inline ec_scene *em_everything(void)
{
    enum { SQUARES = 15 };
    static const float bent[12] = {0.6f, 0, 0.8f, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    effect_model e = em_new();
    ec_material list[SQUARES], glass = em_plain(), liquid, floor = em_plain();
    for (int i = 0; i < SQUARES; i++) {
        list[i] = em_plain();
        list[i].metallic = list[i].roughness = 0.5f;
        for (int slot = 0; slot < EC_SLOT_COUNT; slot++) em_use(&list[i], slot, EM_MIXED);
    }
    list[0].emission[0] = 1;
    list[1].specular = 1;
    list[2].transmission = list[3].transmission = list[12].transmission = 1;
    list[3].volume = list[12].volume = true;
    list[3].absorption[0] = list[3].scatter[0] = list[3].dispersion = 1;
    list[4].coat = list[4].coat_roughness = 1;
    list[5].sheen[0] = list[5].sheen_roughness = 1;
    list[6].anisotropy = 1;
    list[7].alpha_mode = EC_ALPHA_BLEND;
    list[7].base_color[3] = 0.5f;
    list[8].film = 1, list[8].film_ior = 1.3f, list[8].film_most = 400;
    list[9].diffuse_transmission = 1;
    list[10].unlit = true;
    list[11].double_sided = false; /* also seen from behind */
    for (int slot = 0; slot < EC_SLOT_COUNT; slot++) list[13].textures[slot].texture = -1;
    list[13].metallic = list[13].roughness = 0, list[13].transmission = list[13].specular = 1; /* a clear pane */
    glass.metallic = glass.roughness = 0;
    glass.specular = glass.transmission = 1;
    glass.volume = true;
    glass.ior = 1.5f;
    liquid = glass;
    liquid.ior = 1.33f;
    for (int i = 0; i < SQUARES; i++) {
        double turn = i == 11 ? -1 : 1, place[16] = {turn, 0, 0, 0, 0, 1, 0, 0, 0, 0, turn, 0, 2.5 * (i % 4), 2.5 * (i / 4), 0, 1};
        ec_model_place(e.model, place);
        em_quad(&e, em_material(&e, &list[i]), bent);
    }
    ec_model_place(e.model, NULL);
    ec_model_box(e.model, em_material(&e, &glass), (double[]){6.5, 6.5, -0.5}, (double[]){8.5, 8.5, 0.5}, false);
    ec_model_box(e.model, em_material(&e, &liquid), (double[]){7, 7, -0.3}, (double[]){8, 8, 0.3}, false);
    ec_model_quad(e.model, em_material(&e, &floor), (double[]){-3, -3, -1}, (double[]){14, 0, 0}, (double[]){0, 14, 0});
    ec_model_light(e.model, &(ec_light){.intensity = {40, 30, 20}}, (double[]){3, 3, 4}, (double[]){3, 3, 0});
    ec_model_camera(e.model, EC_CAMERA_ORTHOGRAPHIC, (double[]){3.75, 3.75, 9}, (double[]){3.75, 3.75, 0}, 5);
    ec_scene *scene = em_scene(&e);
    scene->colors = malloc(4 * (size_t)scene->vertex_count * sizeof *scene->colors);
    for (size_t i = 0; scene->colors && i < 4 * (size_t)scene->vertex_count; i++) scene->colors[i] = i % 4 == 3 ? 1 : 0.8f;
    scene->has_environment = true;
    scene->environment = (ec_environment){.width = 2, .height = 2, .rgb = calloc(12, sizeof(float)), .turned = true,
                                          .turn = {1, 0, 0, 0, 0, -1, 0, 1, 0}};
    for (int i = 0; scene->environment.rgb && i < 12; i++) scene->environment.rgb[i] = 0.1f * (float)i;
    em_pan(scene);
    return scene;
}

#endif
