/* Writes pictures a band of rows at a time, from the top, as the film's rows come: no plane is as large as the picture. */
#ifndef EC_JOBS_WRITE_ROWS_H
#define EC_JOBS_WRITE_ROWS_H

#include "jobs/hash.h"
#include "jobs/write_outputs.h"
#include "film/clamp.h"

typedef struct ec_row_writer ec_row_writer;

/* Opens the files with the first rows, `film`. They decide for all rows whether there are an error and first-hit features, and whether standard
 * errors are floats because some do not fit into halves. sums: of the film, if it is the whole picture; NULL: unknown. The style's attributes are
 * those known at the beginning; they may change their length by `room` bytes (image.h). outputs must live as long. A file that cannot be written does
 * not stop the others; the first failure is reported at the end. */
ec_result ec_row_writer_open(ec_row_writer **writer, ec_outputs *outputs, const ec_film *film, const ec_error_sums *sums, uint32_t height,
                             const ec_picture_style *style, uint32_t room, ec_error *err);

/* Writes the next rows, a multiple of EC_EXR_ROWS or up to the last. Fails if no file is left that can be written. */
ec_result ec_row_writer_put(ec_row_writer *writer, const ec_film *film, ec_error *err);

/* Returns the number of rows so far. */
uint32_t ec_row_writer_rows(const ec_row_writer *writer);

/* The result of writing. If rows are missing, no error of the image is known. */
typedef struct ec_rows_told {
    uint32_t rows, replicates;
    uint64_t heavy;           /* number of pixels, counted as they are written */
    ec_film_error error;
    ec_clamp_error clamp;
    char sha256[EC_HASH_SIZE];
} ec_rows_told;

/* Ends the rows: missing ones are black and have no samples, and nothing is known of them. */
ec_result ec_row_writer_finish(ec_row_writer *writer, ec_rows_told *told, ec_error *err);

/* To be called after finish: adds the final attributes to the EXRs, gives the files their names, and makes their paths absolute. Frees the writer. */
ec_result ec_row_writer_close(ec_row_writer *writer, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err);

void ec_row_writer_abort(ec_row_writer *writer); /* removes the files and frees the writer; NULL is fine */

#endif
