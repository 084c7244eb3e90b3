#include "cli/suggest.h"

#include <string.h>

enum { LONGEST = 40 };

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Counts insertions, deletions, replacements and swaps of neighbours (Damerau 1964, restricted form). */
static int edit_distance(const char *a, int a_size, const char *b, int b_size)
{
    int d[LONGEST + 1][LONGEST + 1];
    for (int i = 0; i <= a_size; i++) d[i][0] = i;
    for (int j = 0; j <= b_size; j++) d[0][j] = j;
    for (int i = 1; i <= a_size; i++) {
        for (int j = 1; j <= b_size; j++) {
            int same = a[i - 1] == b[j - 1];
            d[i][j] = least(least(d[i - 1][j], d[i][j - 1]) + 1, d[i - 1][j - 1] + !same);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a_size][b_size];
}

const char *ec_suggest(const char *typed, const char *const *names, int count)
{
    size_t typed_size = strlen(typed);
    if (typed_size == 0 || typed_size > LONGEST) return NULL;
    const char *nearest = NULL;
    int limit = typed_size < 4 ? 1 : 2 + (int)typed_size / 8;
    for (int i = 0; i < count; i++) {
        size_t size = strlen(names[i]);
        if (size > LONGEST) continue;
        int distance = edit_distance(typed, (int)typed_size, names[i], (int)size);
        if (distance <= limit) {
            nearest = names[i];
            limit = distance - 1;
        }
    }
    return nearest;
}
