/* Small scenes that a test makes itself, as .gltf files with everything inside:
 *
 *     gltf_writer *w = gltf_new();
 *     int grey = gltf_lambert(w, 0.5, 0);
 *     gltf_quad(w, grey, (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
 *     gltf_camera(w, (double[3]){0, 1, 0}, (double[3]){0, 0, 0}, 1e-4);
 *     const char *path = gltf_write(w, "name");            ECLAT_TEST_OUT/name.gltf; then free(w)
 *
 * Metres, radiance. A quad's front is where edge u x edge v points. Texture coordinates run 0 to 1 along u and v. */
#ifndef EC_TESTS_SUPPORT_GLTF_WRITER_H
#define EC_TESTS_SUPPORT_GLTF_WRITER_H

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct gltf_list {
    char text[65536];
    size_t used;
    int count;
} gltf_list;

typedef struct gltf_writer {
    gltf_list nodes, meshes, accessors, views, materials, cameras, lights, textures, samplers;
    uint8_t data[1 << 20];
    size_t data_used;
    char path[512];
} gltf_writer;

static inline gltf_writer *gltf_new(void)
{
    gltf_writer *w = calloc(1, sizeof *w);
    if (!w) exit(1);
    return w;
}

/* Appends a JSON value to an array; returns its index. */
__attribute__((format(printf, 2, 3))) static inline int gltf_add(gltf_list *list, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (list->count) list->text[list->used++] = ',';
    size_t room = sizeof list->text - list->used;
    int length = vsnprintf(list->text + list->used, room, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length + 2 > room) {
        fprintf(stderr, "gltf_writer.h: the scene is too large\n");
        exit(1);
    }
    list->used += (size_t)length;
    return list->count++;
}

/* Adds an accessor of `count` times `width` floats. */
static inline int gltf_floats(gltf_writer *w, const float *values, int count, int width)
{
    static const char *const types[5] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    size_t bytes = (size_t)count * (size_t)width * sizeof(float);
    if (w->data_used + bytes > sizeof w->data) exit(1);
    memcpy(w->data + w->data_used, values, bytes);
    int view = gltf_add(&w->views, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", w->data_used, bytes);
    w->data_used += bytes;
    char bounds[256] = "";
    if (width == 3) { /* POSITION requires them */
        float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
        for (int i = 0; i < 3 * count; i++) {
            lo[i % 3] = fminf(lo[i % 3], values[i]);
            hi[i % 3] = fmaxf(hi[i % 3], values[i]);
        }
        snprintf(bounds, sizeof bounds, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", lo[0], lo[1], lo[2], hi[0],
                 hi[1], hi[2]);
    }
    return gltf_add(&w->accessors, "{\"bufferView\":%d,\"componentType\":5126,\"count\":%d,\"type\":\"%s\"%s}", view, count,
                    types[width], bounds);
}

/* Vertices of separate triangles; the data of normals, coordinates and colours may be NULL. */
typedef struct gltf_mesh {
    int count;
    const float *positions, *normals, *uv, *colors;
} gltf_mesh;

static inline void gltf_triangles(gltf_writer *w, int material, const gltf_mesh *mesh)
{
    char attributes[256];
    int used = snprintf(attributes, sizeof attributes, "\"POSITION\":%d", gltf_floats(w, mesh->positions, mesh->count, 3));
    if (mesh->normals)
        used += snprintf(attributes + used, 64, ",\"NORMAL\":%d", gltf_floats(w, mesh->normals, mesh->count, 3));
    if (mesh->uv) used += snprintf(attributes + used, 64, ",\"TEXCOORD_0\":%d", gltf_floats(w, mesh->uv, mesh->count, 2));
    if (mesh->colors) snprintf(attributes + used, 64, ",\"COLOR_0\":%d", gltf_floats(w, mesh->colors, mesh->count, 4));
    int id = gltf_add(&w->meshes, "{\"primitives\":[{\"attributes\":{%s},\"material\":%d}]}", attributes, material);
    gltf_add(&w->nodes, "{\"mesh\":%d}", id);
}

/* With colours (4 a corner, corners in order: origin, +u, +u+v, +v) and normals (3 a corner) or NULL. */
static inline void gltf_quad_with(gltf_writer *w, int material, const double at[3], const double u[3], const double v[3],
                                  const float *colors, const float *normals)
{
    static const int order[6] = {0, 1, 2, 0, 2, 3}, su[4] = {0, 1, 1, 0}, sv[4] = {0, 0, 1, 1};
    float p[18], uv[12], c[24], n[18];
    for (int i = 0; i < 6; i++) {
        int corner = order[i];
        for (int k = 0; k < 3; k++) p[3 * i + k] = (float)(at[k] + su[corner] * u[k] + sv[corner] * v[k]);
        uv[2 * i] = (float)su[corner];
        uv[2 * i + 1] = (float)sv[corner];
        for (int k = 0; colors && k < 4; k++) c[4 * i + k] = colors[4 * corner + k];
        for (int k = 0; normals && k < 3; k++) n[3 * i + k] = normals[3 * corner + k];
    }
    gltf_triangles(w, material, &(gltf_mesh){6, p, normals ? n : NULL, uv, colors ? c : NULL});
}

static inline void gltf_quad(gltf_writer *w, int material, const double at[3], const double u[3], const double v[3])
{
    gltf_quad_with(w, material, at, u, v, NULL, NULL);
}

/* Pure Lambert of one grey, emitting one radiance from its front. */
static inline int gltf_lambert(gltf_writer *w, double albedo, double radiance)
{
    return gltf_add(&w->materials,
                    "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.9g,%.9g,%.9g,1],\"metallicFactor\":0},"
                    "\"emissiveFactor\":[%d,%d,%d],\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0},"
                    "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":%.9g}}}",
                    albedo, albedo, albedo, radiance > 0, radiance > 0, radiance > 0, radiance);
}

/* Six quads that face outwards. */
static inline void gltf_box(gltf_writer *w, int material, const double lo[3], const double hi[3])
{
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        double u[3] = {0}, v[3] = {0}, at[3] = {lo[0], lo[1], lo[2]};
        u[a] = hi[a] - lo[a], v[b] = hi[b] - lo[b];
        gltf_quad(w, material, at, v, u);
        at[k] = hi[k];
        gltf_quad(w, material, at, u, v);
    }
}

/* KHR_materials_transmission, _ior and _volume. ior 0: thin-walled, of index 1.5. */
typedef struct gltf_glass {
    double base, roughness, transmission, ior;
    double attenuation[3], distance; /* distance 0: clear */
} gltf_glass;

static inline int gltf_add_glass(gltf_writer *w, const gltf_glass *g)
{
    char volume[256] = "";
    int used = g->ior > 0 ? snprintf(volume, sizeof volume, ",\"KHR_materials_volume\":{\"thicknessFactor\":1") : 0;
    if (g->ior > 0 && g->distance > 0)
        used += snprintf(volume + used, sizeof volume - (size_t)used, ",\"attenuationDistance\":%.9g,\"attenuationColor\":[%.9g,%.9g,%.9g]",
                         g->distance, g->attenuation[0], g->attenuation[1], g->attenuation[2]);
    if (g->ior > 0) snprintf(volume + used, sizeof volume - (size_t)used, "}");
    return gltf_add(&w->materials,
                    "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.9g,%.9g,%.9g,1],\"metallicFactor\":0,\"roughnessFactor\":%.9g},"
                    "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":%.9g},\"KHR_materials_ior\":{\"ior\":%.9g}%s}}",
                    g->base, g->base, g->base, g->roughness, g->transmission, g->ior > 0 ? g->ior : 1.5, volume);
}

/* A node at `at` whose -z points along `direction`; members is JSON such as "\"camera\":0". */
static inline void gltf_node_looking(gltf_writer *w, const double at[3], const double direction[3], const char *members)
{
    /* Columns: x = right, y = up, z = backwards. */
    double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    double z[3] = {-direction[0] / length, -direction[1] / length, -direction[2] / length};
    double up[3] = {fabs(z[1]) > 0.9, fabs(z[1]) <= 0.9, 0};
    double x[3] = {up[1] * z[2] - up[2] * z[1], up[2] * z[0] - up[0] * z[2], up[0] * z[1] - up[1] * z[0]};
    length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int k = 0; k < 3; k++) x[k] /= length;
    double y[3] = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
    gltf_add(&w->nodes,
             "{%s,\"matrix\":[%.17g,%.17g,%.17g,0,%.17g,%.17g,%.17g,0,%.17g,%.17g,%.17g,0,%.17g,%.17g,%.17g,1]}", members, x[0],
             x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2], at[0], at[1], at[2]);
}

static inline void gltf_camera(gltf_writer *w, const double at[3], const double target[3], double yfov)
{
    double direction[3] = {target[0] - at[0], target[1] - at[1], target[2] - at[2]};
    char member[32];
    int id = gltf_add(&w->cameras, "{\"type\":\"perspective\",\"perspective\":{\"yfov\":%.9g,\"znear\":0.0001}}", yfov);
    snprintf(member, sizeof member, "\"camera\":%d", id);
    gltf_node_looking(w, at, direction, member);
}

/* KHR_lights_punctual; json holds type, intensity and so on. */
static inline void gltf_light(gltf_writer *w, const double at[3], const double direction[3], const char *json)
{
    char member[96];
    snprintf(member, sizeof member, "\"extensions\":{\"KHR_lights_punctual\":{\"light\":%d}}", gltf_add(&w->lights, "%s", json));
    gltf_node_looking(w, at, direction, member);
}

static inline void gltf_put_base64(FILE *file, const uint8_t *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = (uint32_t)data[i] << 16 | (i + 1 < size ? data[i + 1] << 8 : 0) | (i + 2 < size ? data[i + 2] : 0);
        for (int k = 0; k < 4; k++) fputc(i + (size_t)k <= size ? digits[word >> (18 - 6 * k) & 63] : '=', file);
    }
}

static inline void gltf_put_list(FILE *file, const char *name, const gltf_list *list)
{
    if (list->count) fprintf(file, ",\n\"%s\":[%.*s]", name, (int)list->used, list->text);
}

/* The path belongs to w. */
static inline const char *gltf_write(gltf_writer *w, const char *name)
{
    snprintf(w->path, sizeof w->path, "%s/%s.gltf", ECLAT_TEST_OUT, name);
    FILE *file = fopen(w->path, "w");
    if (!file) {
        perror(w->path);
        exit(1);
    }
    fprintf(file, "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_specular\","
                  "\"KHR_materials_emissive_strength\",\"KHR_lights_punctual\",\"KHR_materials_ior\","
                  "\"KHR_materials_transmission\",\"KHR_materials_volume\"],\"scene\":0,\"scenes\":[{\"nodes\":[");
    for (int i = 0; i < w->nodes.count; i++) fprintf(file, "%s%d", i ? "," : "", i);
    fprintf(file, "]}]");
    gltf_put_list(file, "nodes", &w->nodes);
    gltf_put_list(file, "meshes", &w->meshes);
    gltf_put_list(file, "accessors", &w->accessors);
    gltf_put_list(file, "bufferViews", &w->views);
    gltf_put_list(file, "materials", &w->materials);
    gltf_put_list(file, "cameras", &w->cameras);
    gltf_put_list(file, "samplers", &w->samplers);
    gltf_put_list(file, "textures", &w->textures);
    if (w->textures.count) { /* image i is the file NAME-i.png beside the scene */
        fprintf(file, ",\n\"images\":[");
        for (int i = 0; i < w->textures.count; i++) fprintf(file, "%s{\"uri\":\"%s-%d.png\"}", i ? "," : "", name, i);
        fprintf(file, "]");
    }
    if (w->lights.count)
        fprintf(file, ",\n\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[%.*s]}}", (int)w->lights.used, w->lights.text);
    fprintf(file, ",\n\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:application/octet-stream;base64,", w->data_used);
    gltf_put_base64(file, w->data, w->data_used);
    fprintf(file, "\"}]}\n");
    if (fclose(file) != 0) exit(1);
    return w->path;
}

#endif
