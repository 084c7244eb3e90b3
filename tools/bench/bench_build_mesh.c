/* Triangles for bench_build: the traversal sketch's room of bumpy spheres, and just enough OBJ and PLY. */
#include "bench_build_mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct growing {
    bench_mesh *mesh;
    uint32_t vertex_capacity, triangle_capacity;
} growing;

static void add_vertex(growing *g, float x, float y, float z)
{
    bench_mesh *m = g->mesh;
    if (m->vertex_count == g->vertex_capacity) {
        g->vertex_capacity = 2 * g->vertex_capacity + 1024;
        m->positions = realloc(m->positions, g->vertex_capacity * 12ull);
    }
    float *p = m->positions + 3 * (size_t)m->vertex_count++;
    p[0] = x, p[1] = y, p[2] = z;
}

static void add_triangle(growing *g, uint32_t a, uint32_t b, uint32_t c)
{
    bench_mesh *m = g->mesh;
    if (m->triangle_count == g->triangle_capacity) {
        g->triangle_capacity = 2 * g->triangle_capacity + 1024;
        m->indices = realloc(m->indices, g->triangle_capacity * 12ull);
    }
    uint32_t *i = m->indices + 3 * (size_t)m->triangle_count++;
    i[0] = a, i[1] = b, i[2] = c;
}

static float random_float(void)
{
    static uint32_t state = 1;
    state ^= state << 13, state ^= state >> 17, state ^= state << 5;
    return (float)(state >> 8) * (1.0f / 16777216.0f);
}

static void add_room(growing *g)
{
    static const float wall[6][4][3] = {
        {{-10, -2, -10}, {10, -2, -10}, {10, -2, 10}, {-10, -2, 10}},
        {{-10, 10, -10}, {10, 10, -10}, {10, 10, 10}, {-10, 10, 10}},
        {{-10, -2, -10}, {-10, 10, -10}, {10, 10, -10}, {10, -2, -10}},
        {{-10, -2, 10}, {-10, 10, 10}, {10, 10, 10}, {10, -2, 10}},
        {{-10, -2, -10}, {-10, -2, 10}, {-10, 10, 10}, {-10, 10, -10}},
        {{10, -2, -10}, {10, -2, 10}, {10, 10, 10}, {10, 10, -10}}};
    for (int w = 0; w < 6; w++) {
        uint32_t first = g->mesh->vertex_count;
        for (int k = 0; k < 4; k++) add_vertex(g, wall[w][k][0], wall[w][k][1], wall[w][k][2]);
        add_triangle(g, first, first + 1, first + 2);
        add_triangle(g, first, first + 2, first + 3);
    }
}

static void add_bumpy_sphere(growing *g)
{
    const int columns = 160, rows = 120;
    const float pi = 3.14159265f;
    float x = random_float() * 16 - 8, y = random_float() * 10 - 2, z = random_float() * 16 - 8;
    float radius = 0.5f + random_float();
    uint32_t first = g->mesh->vertex_count;
    for (int j = 0; j <= rows; j++)
        for (int i = 0; i <= columns; i++) {
            float theta = pi * j / rows, phi = 2 * pi * i / columns;
            float r = radius * (1 + 0.05f * sinf(9 * theta) * sinf(11 * phi) + 0.01f * random_float());
            add_vertex(g, x + r * sinf(theta) * cosf(phi), y + r * cosf(theta), z + r * sinf(theta) * sinf(phi));
        }
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++) {
            uint32_t a = first + j * (columns + 1) + i, below = a + columns + 1;
            add_triangle(g, a, a + 1, below);
            add_triangle(g, a + 1, below + 1, below);
        }
}

static void read_obj(FILE *file, growing *g)
{
    char line[4096];
    while (fgets(line, sizeof line, file)) {
        float x, y, z;
        if (sscanf(line, "v %f %f %f", &x, &y, &z) == 3) add_vertex(g, x, y, z);
        if (line[0] != 'f' || line[1] != ' ') continue;
        uint32_t corner[64], count = 0;
        for (char *word = strtok(line + 2, " \r\n"); word && count < 64; word = strtok(NULL, " \r\n")) {
            long index = atol(word);
            corner[count++] = (uint32_t)(index < 0 ? index + (long)g->mesh->vertex_count : index - 1);
        }
        for (uint32_t k = 2; k < count; k++) add_triangle(g, corner[0], corner[k - 1], corner[k]);
    }
}

static int read_ply(FILE *file, growing *g)
{
    char line[256];
    uint32_t vertices = 0, faces = 0, floats = 0, in_vertex = 0;
    while (fgets(line, sizeof line, file) && strncmp(line, "end_header", 10)) {
        if (sscanf(line, "element vertex %u", &vertices) == 1) in_vertex = 1;
        else if (sscanf(line, "element face %u", &faces) == 1) in_vertex = 0;
        else if (in_vertex && !strncmp(line, "property float", 14)) floats++;
        else if (in_vertex && !strncmp(line, "property", 8)) return 0;
        else if (!strncmp(line, "format", 6) && !strstr(line, "binary_little_endian")) return 0;
    }
    for (uint32_t i = 0; i < vertices; i++) {
        float values[32];
        if (floats < 3 || floats > 32 || fread(values, 4, floats, file) != floats) return 0;
        add_vertex(g, values[0], values[1], values[2]);
    }
    for (uint32_t i = 0; i < faces; i++) {
        uint32_t corner[3];
        if (fgetc(file) != 3 || fread(corner, 4, 3, file) != 3) return 0;
        add_triangle(g, corner[0], corner[1], corner[2]);
    }
    return 1;
}

static int indices_are_valid(const bench_mesh *mesh)
{
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        if (mesh->indices[i] >= mesh->vertex_count) return 0;
    return 1;
}

int bench_mesh_open(const char *what, bench_mesh *mesh)
{
    memset(mesh, 0, sizeof *mesh);
    growing g = {.mesh = mesh};
    const char *suffix = strrchr(what, '.');
    if (!suffix) {
        int spheres = atoi(what);
        add_room(&g);
        for (int i = 0; i < spheres; i++) add_bumpy_sphere(&g);
        return 1;
    }
    FILE *file = fopen(what, "rb");
    if (!file) return 0;
    int read = 1;
    if (!strcmp(suffix, ".ply")) read = read_ply(file, &g);
    else read_obj(file, &g);
    fclose(file);
    return read && mesh->triangle_count && indices_are_valid(mesh);
}

void bench_mesh_free(bench_mesh *mesh)
{
    free(mesh->positions);
    free(mesh->indices);
    memset(mesh, 0, sizeof *mesh);
}
