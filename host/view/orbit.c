#include "view/orbit.h"

#include <math.h>
#include <string.h>

#define NEAREST_POLE 0.01 /* radians */
static const double half_turn = 3.14159265358979323846;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Leaves a vector without length unchanged. */
static void normalize(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int k = 0; k < 3 && length > 0; k++) v[k] /= length;
}

/* Unit vectors right, upright and forward, as in ec_camera_look. */
typedef struct axes {
    double right[3], up[3], forward[3];
} axes;

static axes axes_of(const eclat_viewpoint *v)
{
    axes a;
    double up[3];
    memcpy(up, v->up, sizeof up);
    normalize(up);
    for (int k = 0; k < 3; k++) a.forward[k] = v->target[k] - v->eye[k];
    normalize(a.forward);
    cross(a.forward, up, a.right);
    if (dot(a.right, a.right) < 1e-12) { /* looking along the pole, any direction will do */
        const double other[3] = {fabs(up[0]) < 0.9, fabs(up[0]) >= 0.9, 0};
        cross(up, other, a.right);
    }
    normalize(a.right);
    cross(a.right, a.forward, a.up);
    return a;
}

/* Rotates v about a unit axis (Rodrigues). */
static void rotate(double v[3], const double axis[3], double angle)
{
    double c = cos(angle), s = sin(angle), along = dot(v, axis), side[3];
    cross(axis, v, side);
    for (int k = 0; k < 3; k++) v[k] = v[k] * c + side[k] * s + axis[k] * along * (1 - c);
}

/* Turns a direction of view: yaw about the pole to the right, pitch up, short of the poles. */
static void turn_direction(const eclat_viewpoint *v, double d[3], double yaw, double pitch)
{
    axes a = axes_of(v);
    double pole[3], length = sqrt(dot(d, d));
    memcpy(pole, v->up, sizeof pole);
    normalize(pole);
    double sine = dot(d, pole) / (length > 0 ? length : 1), height = asin(fmin(fmax(sine, -1), 1));
    double most = 0.5 * half_turn - NEAREST_POLE;
    double wanted = fmin(fmax(height + pitch, -most), most);
    if (fabs(height) > most && fabs(height + pitch) > fabs(height)) wanted = height; /* it stays where it was put */
    rotate(d, a.right, wanted - height);
    rotate(d, pole, -yaw);
}

double ec_orbit_distance(const eclat_viewpoint *v)
{
    double d[3];
    for (int k = 0; k < 3; k++) d[k] = v->target[k] - v->eye[k];
    return sqrt(dot(d, d));
}

void ec_orbit_settle(eclat_viewpoint *v)
{
    axes a = axes_of(v);
    if (fabs(a.right[1]) < 1e-4 && a.up[1] > 0) memcpy(v->up, (double[3]){0, 1, 0}, sizeof v->up);
}

void ec_orbit_turn(eclat_viewpoint *v, double yaw, double pitch)
{
    double d[3];
    for (int k = 0; k < 3; k++) d[k] = v->target[k] - v->eye[k];
    turn_direction(v, d, -yaw, -pitch);
    for (int k = 0; k < 3; k++) v->eye[k] = v->target[k] - d[k];
}

void ec_orbit_look(eclat_viewpoint *v, double yaw, double pitch)
{
    double d[3];
    for (int k = 0; k < 3; k++) d[k] = v->target[k] - v->eye[k];
    turn_direction(v, d, yaw, pitch);
    for (int k = 0; k < 3; k++) v->target[k] = v->eye[k] + d[k];
}

static double picture_height(const eclat_viewpoint *v)
{
    return v->fov > 0 ? 2 * ec_orbit_distance(v) * tan(0.5 * v->fov * half_turn / 180) : v->tall;
}

void ec_orbit_fly(eclat_viewpoint *v, double forward, double right, double up)
{
    axes a = axes_of(v);
    for (int k = 0; k < 3; k++) {
        double step = forward * a.forward[k] + right * a.right[k] + up * a.up[k];
        v->eye[k] += step;
        v->target[k] += step;
    }
}

void ec_orbit_pan(eclat_viewpoint *v, double right, double up)
{
    double height = picture_height(v);
    ec_orbit_fly(v, 0, right * height, up * height);
}

void ec_orbit_dolly(eclat_viewpoint *v, double factor)
{
    if (v->fov <= 0) v->tall *= factor;
    else
        for (int k = 0; k < 3; k++) v->eye[k] = v->target[k] + (v->eye[k] - v->target[k]) * factor;
}

void ec_orbit_frame(eclat_viewpoint *v, const double center[3], double radius, double aspect)
{
    axes a = axes_of(v);
    double narrow = fmin(aspect, 1), distance = fmax(ec_orbit_distance(v), 2 * radius);
    if (v->fov <= 0) v->tall = 2 * radius / narrow;
    else distance = radius / sin(atan(tan(0.5 * v->fov * half_turn / 180) * narrow));
    for (int k = 0; k < 3; k++) {
        v->target[k] = center[k];
        v->eye[k] = center[k] - distance * a.forward[k];
    }
}
