/* Keeps a job's film in a file, whole or a slice: a sealed EXR whose first part is a picture and whose others are sums, bit for bit. Renders go on
 * from it, and slices of one job are merged. The layout is in layout.h. */
#ifndef EC_STORE_STORE_H
#define EC_STORE_STORE_H

#include "image/image.h"
#include "render/course.h"
#include "store/identity.h"

/* The data of a stored file, other than the film. */
typedef struct ec_job {
    ec_identity identity;
    int argc;             /* the command that began it: "render" and its arguments */
    char **argv;
    const char *folder;   /* in which it was given */
    const char *device;   /* in words: on another, samples may differ in their last bits */
    uint32_t spp;         /* samples a pixel of the whole job; 0: not limited */
    double error_target, time_limit; /* other limits; 0: none */
    uint32_t first, end;  /* batches of the slice; end 0: none was asked for */
    uint32_t cut;         /* samples that its last batch lacks */
    bool merged;          /* from several files: no render goes on from it */
} ec_job;

typedef struct ec_stored {
    ec_job job;           /* argv, folder and device are owned */
    ec_film film;
    ec_past past;         /* allotment.weight and batch are owned */
} ec_stored;

/* Writes a file. picture: the first part. Its attributes are written too; names beginning with "eclat.state" are the file's own. */
ec_result ec_store_write(const char *path, const ec_job *job, const ec_film *film, const ec_past *past,
                         const ec_exr_part *picture, ec_error *err);

/* Reads a file. Fails with one line for whatever is not as it was written. */
ec_result ec_store_read(const char *path, ec_stored *stored, ec_error *err);
/* Reads the header alone: job, past, and of the film how many batches; *first: its first batch. Returns false if it cannot be read, for which
 * ec_store_read would give a reason. *stored is to be freed in either case. */
bool ec_store_peek(const char *path, ec_stored *stored, uint32_t *first);
void ec_stored_free(ec_stored *stored); /* zero-initialised is fine */

#endif
