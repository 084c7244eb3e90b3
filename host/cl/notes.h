/* Notes: a few bytes kept from one run to the next, beside the kernel cache; no harm is done if they are lost. */
#ifndef EC_CL_NOTES_H
#define EC_CL_NOTES_H

#include "cl/cl.h"

/* name: identifies the note, for this device; any length. Returns false if there is no whole note of that size. */
bool ec_notes_read(const ec_cl *cl, const char *name, void *bytes, size_t size);
void ec_notes_write(const ec_cl *cl, const char *name, const void *bytes, size_t size);

#endif
