/* An identity as a text, a JSON object. */
#ifndef EC_STORE_IDENTITY_TEXT_H
#define EC_STORE_IDENTITY_TEXT_H

#include "store/identity.h"

char *ec_identity_write(const ec_identity *identity); /* malloc'ed; NULL when out of memory */
bool ec_identity_read(const char *text, ec_identity *identity); /* false: it is not an identity */

#endif
