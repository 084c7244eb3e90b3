/* Makes one ball or capsule of flat faces, with the normals of a round one. */
#include "gltf/thicken.h"

#include <math.h>

#include "base/vec3.h"

static const double pi = 3.14159265358979323846;

/* Computes point k of ring r of the upper half of a unit ball; ring 0 is its pole. */
static void point_of(const ec_thick_mesh *m, int ring, int k, double p[3])
{
    const double down = 0.5 * pi * ring / m->rings, around = 2 * pi * k / m->sides;
    p[0] = sin(down) * cos(around);
    p[1] = sin(down) * sin(around);
    p[2] = ring == m->rings ? 0 : cos(down);
}

/* Returns half the area of the unit ball's faces. */
static double half_area(const ec_thick_mesh *m)
{
    double area = 0;
    for (int ring = 0; ring < m->rings; ring++) {
        double a[3], b[3], c[3], d[3], u[3], v[3], n[3];
        point_of(m, ring, 0, a), point_of(m, ring + 1, 0, b), point_of(m, ring + 1, 1, c), point_of(m, ring, 1, d);
        for (int k = 0; k < 3; k++) u[k] = c[k] - a[k], v[k] = d[k] - b[k];
        ec_cross(u, v, n); /* of the trapezium a, b, c, d, which is a triangle at the pole */
        area += 0.5 * m->sides * sqrt(ec_dot(n, n));
    }
    return area;
}

/* Seen from all directions, a convex body shows a quarter of its surface on average (Cauchy). */
void ec_ball_choose(ec_thick_mesh *m, double pixels)
{
    m->sides = pixels > 8 ? EC_BALL_SIDES_MOST : 8;
    m->rings = pixels > 8 ? EC_BALL_RINGS_MOST : 2;
    m->swell[0] = sqrt(2 * pi / half_area(m));
    m->swell[1] = pi / m->sides / sin(pi / m->sides);
}

uint64_t ec_ball_vertices(const ec_thick_mesh *m) { return 2 * (1 + (uint64_t)m->rings * (uint64_t)m->sides); }

/* Each half has a fan, and quads between rings; the tube has quads. */
uint64_t ec_ball_indices(const ec_thick_mesh *m) { return 6 * (uint64_t)m->sides * (2 * (uint64_t)m->rings - 1) + 6 * (uint64_t)m->sides; }

static void make_frame(const double axis[3], double u[3], double v[3])
{
    const int least = fabs(axis[0]) < fabs(axis[1]) ? (fabs(axis[0]) < fabs(axis[2]) ? 0 : 2) : fabs(axis[1]) < fabs(axis[2]) ? 1 : 2;
    const double other[3] = {least == 0, least == 1, least == 2};
    ec_cross(axis, other, u);
    ec_normalize(u);
    ec_cross(axis, u, v);
}

static void copy_stream(ec_thick_mesh *m, int stream, uint32_t vertex)
{
    const int32_t accessor = m->from->streams.of[stream];
    const uint32_t width = ec_stream_width[stream];
    float *out = m->streams[stream] + m->vertex_count * width;
    for (uint32_t k = 0; k < width; k++) out[k] = 1; /* alpha of a colour without one */
    ec_gltf_accessor_floats(&m->g->accessors[accessor], vertex, m->g->accessors[accessor].components, out);
}

static void append_vertex(ec_thick_mesh *m, const double at[3], const double normal[3], uint32_t vertex)
{
    for (int k = 0; k < 3; k++) {
        m->streams[EC_POSITION][3 * m->vertex_count + (uint64_t)k] = (float)at[k];
        m->streams[EC_NORMAL][3 * m->vertex_count + (uint64_t)k] = (float)normal[k];
    }
    for (int stream = EC_COLOR; stream < EC_STREAMS; stream++)
        if (m->streams[stream]) copy_stream(m, stream, vertex);
    m->vertex_count++;
}

static void append_triangle(ec_thick_mesh *m, uint32_t a, uint32_t b, uint32_t c, bool turned)
{
    uint32_t *out = m->indices + m->index_count;
    out[0] = a, out[1] = turned ? c : b, out[2] = turned ? b : c;
    m->index_count += 3;
}

/* Appends the quads between two rings, given by the vertex of point 0 of each. */
static void append_band(ec_thick_mesh *m, uint32_t upper, uint32_t lower, bool turned)
{
    for (int k = 0; k < m->sides; k++) {
        const uint32_t i = (uint32_t)k, next = (uint32_t)((k + 1) % m->sides);
        append_triangle(m, upper + i, lower + i, lower + next, turned);
        append_triangle(m, upper + i, lower + next, upper + next, turned);
    }
}

/* Appends half a ball; half: 0: the one towards -axis, 1: the other. Returns the first vertex of its rim. */
static uint32_t append_half(ec_thick_mesh *m, const double end[3], double radius, double axes[3][3], int half, uint32_t vertex)
{
    const uint32_t pole = (uint32_t)m->vertex_count, sides = (uint32_t)m->sides;
    for (int ring = 0; ring <= m->rings; ring++)
        for (int side = 0; side < (ring ? m->sides : 1); side++) {
            double p[3], normal[3], at[3];
            point_of(m, ring, side, p);
            if (!half) p[2] = -p[2];
            for (int k = 0; k < 3; k++) {
                normal[k] = p[0] * axes[0][k] + p[1] * axes[1][k] + p[2] * axes[2][k];
                at[k] = end[k] + radius * normal[k];
            }
            append_vertex(m, at, normal, vertex);
        }
    for (uint32_t k = 0; k < sides; k++) append_triangle(m, pole, pole + 1 + k, pole + 1 + (k + 1) % sides, !half);
    for (int ring = 1; ring < m->rings; ring++) append_band(m, pole + 1 + (uint32_t)(ring - 1) * sides, pole + 1 + (uint32_t)ring * sides, !half);
    return pole + 1 + (uint32_t)(m->rings - 1) * sides;
}

void ec_ball_append(ec_thick_mesh *m, const double ends[2][3], const double radii[2], const uint32_t vertices[2])
{
    double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; k++) axes[2][k] = ends[1][k] - ends[0][k];
    const bool is_long = ec_normalize(axes[2]);
    if (is_long) make_frame(axes[2], axes[0], axes[1]);
    else axes[2][0] = axes[2][1] = 0, axes[2][2] = 1;
    const double swell = m->swell[is_long];
    const uint32_t lower = append_half(m, ends[0], radii[0] * swell, axes, 0, vertices[0]);
    const uint32_t upper = append_half(m, ends[1], radii[1] * swell, axes, 1, vertices[1]);
    if (is_long) append_band(m, upper, lower, false);
}
