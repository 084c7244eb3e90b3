/* The identity of a job: all that its samples depend on, in words. */
#ifndef EC_STORE_IDENTITY_H
#define EC_STORE_IDENTITY_H

#include <stdbool.h>
#include <stddef.h>

#include "render/render.h"

typedef struct ec_trait {
    char name[32], value[512];
} ec_trait;

enum { EC_TRAITS_MAX = 72 };

typedef struct ec_identity {
    ec_trait traits[EC_TRAITS_MAX];
    uint32_t count;
} ec_identity;

/* Fills in an identity. content may be NULL: then what depends on the device's data is left out. */
void ec_identity_of(const ec_render_options *options, const ec_content *content, ec_identity *identity);

/* Adds a trait; long values are cut. */
void ec_identity_add(ec_identity *identity, const char *name, const char *value);

/* Returns the value of a trait, or NULL. */
const char *ec_identity_value(const ec_identity *identity, const char *name);

/* Writes the first difference that matters, such as "--seed is 1 there and 0 here"; returns false if there is none. */
bool ec_identity_differs(const ec_identity *there, const ec_identity *here, char *text, size_t size);

#endif
