#include "film/tail.h"

void ec_tail_add(ec_tail *t, double value)
{
    if (!(value > 0) || (t->count == EC_TAIL_FEW && value <= t->largest[EC_TAIL_FEW - 1])) return;
    uint32_t i = t->count < EC_TAIL_FEW ? t->count++ : EC_TAIL_FEW - 1;
    for (; i > 0 && t->largest[i - 1] < value; i--) t->largest[i] = t->largest[i - 1];
    t->largest[i] = value;
}

void ec_tail_join(ec_tail *into, const ec_tail *next)
{
    for (uint32_t i = 0; i < next->count; i++) ec_tail_add(into, next->largest[i]);
}
