#include "image/srgb.h"

#include <math.h>
#include <pthread.h>

double ec_srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

double ec_srgb_to_linear(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

static double srgb_bytes[256];

static void fill_srgb_bytes(void)
{
    for (int i = 0; i < 256; i++) srgb_bytes[i] = ec_srgb_to_linear(i / 255.0);
}

const double *ec_srgb_bytes(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, fill_srgb_bytes);
    return srgb_bytes;
}

enum { CELLS = 4096 };

struct ec_srgb_rounder {
    double first[256];        /* the least value that rounds to more than i; infinity behind the last */
    uint8_t below[CELLS + 1]; /* what a cell's lower end rounds to; a cell has at most one step, as 255 * 12.92 / CELLS < 1 */
};

static uint8_t round_by_power(double x)
{
    return (uint8_t)lrint(255 * ec_srgb_encode(x));
}

static struct ec_srgb_rounder rounder;

static void fill_rounder(void)
{
    for (int i = 0; i < 255; i++) {
        double low = 0, high = 1;
        for (double middle = 0.5; middle > low && middle < high; middle = low + (high - low) / 2)
            *(round_by_power(middle) > i ? &high : &low) = middle;
        rounder.first[i] = high;
    }
    rounder.first[255] = INFINITY;
    for (int i = 0; i <= CELLS; i++) rounder.below[i] = round_by_power(i / (double)CELLS);
}

const ec_srgb_rounder *ec_srgb_get_rounder(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, fill_rounder);
    return &rounder;
}

uint8_t ec_srgb_round(const ec_srgb_rounder *r, double linear)
{
    const uint8_t below = r->below[(int)(linear * CELLS)];
    return (uint8_t)(below + (linear >= r->first[below]));
}
