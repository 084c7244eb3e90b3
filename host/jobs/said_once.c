#include "jobs/said_once.h"

#include <stdbool.h>

/* FNV-1a. Where more is said than is remembered, it is said again. */
static bool was_said(ec_said_once *s, const char *text)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (; *text; text++) hash = (hash ^ (unsigned char)*text) * UINT64_C(0x100000001b3);
    for (int i = 0; i < s->count; i++)
        if (s->said[i] == hash) return true;
    if (s->count < (int)(sizeof s->said / sizeof *s->said)) s->said[s->count++] = hash;
    return false;
}

static void write_log(void *user, ec_severity severity, const char *text)
{
    ec_said_once *s = user;
    const bool may_repeat = severity == EC_STATUS || severity == EC_FAILURE;
    if (s->log.write && (may_repeat || !was_said(s, text))) s->log.write(s->log.user, severity, text);
}

ec_log ec_said_once_log(ec_said_once *said) { return (ec_log){.write = write_log, .user = said}; }
