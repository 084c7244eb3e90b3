/* Pictures to files a band of rows at a time, from the top, as the film's rows come: no plane is as large as the picture. */
#ifndef EC_JOBS_WRITE_ROWS_H
#define EC_JOBS_WRITE_ROWS_H

#include "jobs/hash.h"
#include "jobs/write_outputs.h"
#include "film/clamp.h"

typedef struct ec_row_writer ec_row_writer;

/* Begins with the rows of `film`, the first ones: what they have, an error and first-hit features perhaps, all have; and where their standard
 * errors do not fit into half floats, all errors are floats. sums: of a film that is all of the picture; NULL: not known. The style's attributes
 * are those of the beginning; they may become longer or shorter by `room` bytes (image.h). outputs must live as long.
 * A file that cannot be written does not keep the others from being written: what failed first is told at the end. */
ec_result ec_row_writer_open(ec_row_writer **writer, ec_outputs *outputs, const ec_film *film, const ec_error_sums *sums, uint32_t height,
                             const ec_picture_style *style, uint32_t room, ec_error *err);

/* The next rows, a multiple of EC_EXR_ROWS or up to the last. Fails where no file is left that could be written. */
ec_result ec_row_writer_put(ec_row_writer *writer, const ec_film *film, ec_error *err);

/* How many have come so far. */
uint32_t ec_row_writer_rows(const ec_row_writer *writer);

/* What came of them. Where rows are missing no error of the image is known. */
typedef struct ec_rows_told {
    uint32_t rows, replicates;
    uint64_t heavy;           /* pixels, known once they are written: in the end all */
    ec_film_error error;
    ec_clamp_error clamp;
    char sha256[EC_HASH_SIZE];
} ec_rows_told;

/* No more rows: those that are missing are black, without samples, and nothing is known of them. */
ec_result ec_row_writer_finish(ec_row_writer *writer, ec_rows_told *told, ec_error *err);

/* After that: attributes of the end, for the EXRs; files get their names, and their paths become absolute. Frees the writer. */
ec_result ec_row_writer_close(ec_row_writer *writer, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err);

void ec_row_writer_abort(ec_row_writer *writer); /* leaves nothing; frees; NULL is fine */

#endif
