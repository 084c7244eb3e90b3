/* Resolves a band of rows, hashes it and hands it to every file, with all threads. A pixel's interval depends on rows around it, so that the last
 * SEAM rows wait for the rows below. With them, SEAM + REACH rows of the film are kept, as those above are looked at too. */
#include "jobs/write_rows.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "film/interval.h"

enum { CHUNKS_A_THREAD = 4, SEAM = EC_EXR_ROWS, REACH = EC_INTERVAL_REACH, WAITING = SEAM + REACH, AROUND = SEAM + 2 * REACH };

struct ec_row_writer {
    ec_outputs *outputs;
    ec_exr_rows *exr[EC_OUTPUTS_MAX]; /* NULL: not an EXR, or it failed */
    void *pixels[EC_OUTPUTS_MAX];     /* writer of the output's format; NULL likewise */
    ec_error why;                     /* the first failure; empty: none */
    uint32_t width, height, replicates;
    ec_rare rare;
    double limit;
    uint32_t band_rows;               /* a multiple of SEAM */
    uint32_t come, written;           /* rows received, rows written */
    ec_film waiting, around;          /* the last rows received, at most WAITING; room for what a band looks at */
    ec_picture band;
    ec_pixel *rooms;                  /* for ec_film_resolve_rows, one per thread */
    ec_channel_list channels;         /* those in the EXRs' header */
    ec_channel_set wanted;
    bool wide_errors;                 /* halves cannot hold these standard errors */
    ec_exr_part part;
    void *bytes;                      /* the band in the format of other files */
    ec_picture_style style;           /* that of the beginning; its texts belong to the caller */
    ec_hash hash;
    ec_error_sums sums;
    ec_cut_sums cut;
    uint64_t heavy;
};

static void abort_pixels(ec_row_writer *w, int i)
{
    if (w->pixels[i]) ec_output_format(&w->outputs->file[i])->abort(w->pixels[i]);
    w->pixels[i] = NULL;
}

static void fail_file(ec_row_writer *w, int i, const ec_error *why)
{
    if (!*w->why.text) w->why = *why;
    ec_exr_rows_abort(w->exr[i]);
    abort_pixels(w, i);
    w->exr[i] = NULL;
}

static bool any_left(const ec_row_writer *w)
{
    for (int i = 0; i < w->outputs->count; i++)
        if (w->exr[i] || w->pixels[i]) return true;
    return false;
}

static ec_result fail_without_files(const ec_row_writer *w, ec_error *err)
{
    if (any_left(w)) return EC_OK;
    if (err) *err = w->why;
    return EC_FAILED;
}

/* Tells whether standard errors need floats. Halves have 11 significant bits from 2^-14 on, and steps of 2^-24 below; typical errors should have 11
 * bits. The first rows have to decide. */
static bool are_errors_wide(const ec_error_sums *sums, uint64_t pixels)
{
    const double most = 65504, typical = sqrt(sums->s2 / (double)pixels);
    return sums->largest > most * most || (typical > 0 && typical < 0x1p-14);
}

static void list_channels(const ec_row_writer *w, ec_channel_list *channels)
{
    ec_picture_channels(&w->band, channels);
    ec_channels_choose(channels, w->wanted, w->wide_errors);
}

static ec_result create(ec_row_writer *w, const ec_film *film, const ec_error_sums *sums, ec_error *err)
{
    const uint32_t rows = w->height < w->band_rows ? w->height : w->band_rows;
    const bool with_intervals = w->wanted & ec_channels_of(EC_PLANE_LOW) || w->wanted & ec_channels_of(EC_PLANE_HIGH);
    EC_TRY(ec_picture_create(&w->band, film, rows, ec_film_replicates(film) >= 2, with_intervals, film->limit > 0, err));
    w->rooms = malloc((size_t)omp_get_max_threads() * ec_resolve_room(w->width, SEAM) * sizeof *w->rooms);
    if (!w->rooms) return ec_fail(err, "out of memory for a row of pictures %u pixels wide", w->width);
    ec_picture_turn_to(&w->band, film, 0);
    if (sums) w->sums = *sums;
    else ec_film_sum_errors(film, &w->sums);
    w->wide_errors = are_errors_wide(&w->sums, (uint64_t)film->width * film->height);
    list_channels(w, &w->channels);
    w->bytes = malloc((size_t)w->width * rows * 12); /* enough for floats, the largest */
    return w->bytes ? EC_OK : ec_fail(err, "out of memory for a row of pictures %u pixels wide", w->width);
}

/* Resolves SEAM rows per thread in turn; the film is only read. */
static void fill_band(ec_row_writer *w, const ec_film *film, uint32_t first, uint32_t rows)
{
    uint64_t heavy = 0;
    w->band.height = rows;
    ec_picture_turn_to(&w->band, film, first);
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : heavy) if ((uint64_t)w->width * rows > 1 << 14)
    for (uint32_t k = 0; k < rows; k += SEAM) {
        const uint32_t count = rows - k < SEAM ? rows - k : SEAM;
        ec_picture part = ec_picture_rows(&w->band, k, count);
        part.room = w->rooms + (size_t)omp_get_thread_num() * ec_resolve_room(w->width, SEAM);
        ec_picture_fill(&part, film, first + k, count);
        heavy += part.heavy_count;
    }
    w->band.heavy_count = heavy;
}

typedef struct hash_task {
    ec_hash *hash;
    const float *rgb;
    uint64_t pixels;
} hash_task;

/* Hashes in a thread beside the files, since a hash cannot be divided among threads. */
static void *hash_band(void *user)
{
    const hash_task *task = user;
    ec_hash_add(task->hash, task->rgb, task->pixels);
    return NULL;
}

/* Writes the band to all files. */
static void write_band(ec_row_writer *w)
{
    const uint32_t rows = w->band.height;
    const uint64_t pixels = (uint64_t)w->width * rows;
    ec_channel_list channels;
    list_channels(w, &channels);
    const ec_exr_part part = {.channels = channels.list, .channel_count = channels.count};
    hash_task task = {&w->hash, w->band.rgb, pixels};
    pthread_t hasher;
    const bool is_beside = pthread_create(&hasher, NULL, hash_band, &task) == 0;
    if (!is_beside) hash_band(&task);
    w->heavy += w->band.heavy_count;
    w->band.first = w->written;
    w->written += rows;
    for (int i = 0; i < w->outputs->count; i++) {
        ec_error why = {0};
        if (w->exr[i] && ec_exr_rows_put(w->exr[i], &part, rows, &why) != EC_OK) fail_file(w, i, &why);
        if (!w->pixels[i]) continue;
        const ec_format *format = ec_output_format(&w->outputs->file[i]);
        const ec_raster raster = ec_picture_raster(format, &w->style, w->width, w->height);
        ec_picture_pixels(&w->band, &w->style, &raster, w->bytes);
        if (format->put(w->pixels[i], w->bytes, rows, &why) != EC_OK) fail_file(w, i, &why);
    }
    if (is_beside) pthread_join(hasher, NULL);
}

static uint32_t first_waiting(const ec_row_writer *w) { return w->come < WAITING ? 0 : w->come - WAITING; }

/* Copies rows [from, to) of the picture to the beginning of `to_film`, from those that wait and from `film`, which follows them (NULL: nothing does). */
static void gather(const ec_row_writer *w, const ec_film *film, uint32_t from, uint32_t to, ec_film *to_film)
{
    uint32_t seam = to < w->come ? to : w->come < from ? from : w->come;
    if (from < seam) ec_film_copy_rows(to_film, 0, &w->waiting, from - first_waiting(w), seam - from);
    if (seam < to) ec_film_copy_rows(to_film, seam - from, film, seam - w->come, to - seam);
}

/* Fills the band from a film that begins at row `first_row` of the picture. */
static void fill_band_from(ec_row_writer *w, const ec_film *film, uint32_t first_row, uint32_t first, uint32_t rows)
{
    ec_rare rare = w->rare;
    ec_film here = *film;
    rare.row = first_row;
    here.rare = rare.count ? &rare : NULL;
    fill_band(w, &here, first, rows);
}

/* Writes rows up to `end`; the film's rows follow those that wait. */
static void write_up_to(ec_row_writer *w, const ec_film *film, uint32_t end)
{
    const uint32_t all = w->come + (film ? film->height : 0);
    while (w->written < end) {
        const uint32_t first = w->written, from = first < REACH ? 0 : first - REACH, most = from < w->come ? SEAM : w->band_rows;
        const uint32_t rows = end - first < most ? end - first : most, to = all - first - rows < REACH ? all : first + rows + REACH;
        if (from >= w->come) {
            fill_band_from(w, film, w->come, first - w->come, rows);
        } else {
            gather(w, film, from, to, &w->around);
            ec_film around = w->around;
            around.height = to - from;
            fill_band_from(w, &around, from, first - from, rows);
        }
        write_band(w);
    }
}

static ec_result make_room(const ec_film *like, ec_film *film, ec_error *err)
{
    return film->width ? EC_OK : ec_film_create_like(film, like, AROUND, err);
}

/* Keeps the last rows for those that come after them. */
static ec_result keep_waiting(ec_row_writer *w, const ec_film *film, ec_error *err)
{
    const uint32_t all = w->come + film->height, from = all < WAITING ? 0 : all - WAITING;
    EC_TRY(make_room(film, &w->waiting, err));
    EC_TRY(make_room(film, &w->around, err));
    gather(w, film, from, all, &w->around);
    const ec_film other = w->waiting;
    w->waiting = w->around;
    w->around = other;
    return EC_OK;
}

/* Takes rows whose errors have been summed. */
static ec_result take(ec_row_writer *w, const ec_film *film, ec_error *err)
{
    const uint32_t all = w->come + film->height;
    ec_film_sum_cut(film, &w->cut);
    write_up_to(w, film, all == w->height ? all : all - SEAM);
    if (all < w->height) EC_TRY(keep_waiting(w, film, err));
    w->come = all;
    return fail_without_files(w, err);
}

ec_result ec_row_writer_open(ec_row_writer **made, ec_outputs *outputs, const ec_film *film, const ec_error_sums *sums, uint32_t height,
                             const ec_picture_style *style, uint32_t room, ec_error *err)
{
    ec_row_writer *w = calloc(1, sizeof *w);
    *made = NULL;
    if (!w) return ec_fail(err, "out of memory for the picture");
    w->outputs = outputs;
    w->width = film->width;
    w->height = height;
    w->band_rows = SEAM * CHUNKS_A_THREAD * (uint32_t)omp_get_max_threads();
    w->replicates = ec_film_replicates(film);
    if (film->rare) w->rare = *film->rare;
    w->limit = film->limit;
    w->wanted = style->channels;
    w->style = *style;
    ec_hash_begin(&w->hash);
    if (create(w, film, sums, err) != EC_OK) {
        ec_row_writer_abort(w);
        return EC_FAILED;
    }
    w->part = (ec_exr_part){.name = "", .channels = w->channels.list, .channel_count = w->channels.count, .attributes = style->attributes,
                            .attribute_count = style->attribute_count, .is_sealed = style->is_sealed};
    for (int i = 0; i < outputs->count; i++) {
        ec_error why = {0};
        const char *path = outputs->file[i].path;
        const ec_format *format = ec_output_format(&outputs->file[i]);
        const ec_raster raster = format ? ec_picture_raster(format, style, w->width, height) : (ec_raster){.width = 0};
        ec_result begun = format ? format->begin(&w->pixels[i], path, &raster, &style->text, &why)
                                 : ec_exr_rows_begin(&w->exr[i], path, w->width, height, &w->part, 1, room, &why);
        if (begun != EC_OK) fail_file(w, i, &why);
    }
    w->part.attributes = NULL; /* the final ones are given on closing */
    w->part.attribute_count = 0;
    if (fail_without_files(w, err) != EC_OK || take(w, film, err) != EC_OK) {
        ec_row_writer_abort(w);
        return EC_FAILED;
    }
    *made = w;
    return EC_OK;
}

ec_result ec_row_writer_put(ec_row_writer *w, const ec_film *film, ec_error *err)
{
    ec_film_sum_errors(film, &w->sums);
    return take(w, film, err);
}

uint32_t ec_row_writer_rows(const ec_row_writer *w) { return w->come; }

/* Fills the band with unknown pixels: an error of 0 in a heavy pixel is a lower bound. */
static void blank_band(ec_row_writer *w, uint32_t rows, const float *no_features)
{
    const size_t pixels = (size_t)w->width * rows;
    ec_picture *b = &w->band;
    b->height = rows;
    b->aov = no_features;
    memset(b->rgb, 0, pixels * 12);
    memset(b->constants, 0, pixels * 8);
    if (b->clamped) memset(b->clamped, 0, pixels * 8);
    if (b->layer_values) memset(b->layer_values, 0, pixels * 4 * EC_LAYER_PLANES * b->layers.count);
    for (uint32_t k = 0; k < EC_MATTE_KINDS; k++)
        if (b->mattes[k]) memset(b->mattes[k], 0, pixels * 4 * EC_MATTE_FLOATS);
    if (!b->heavy) return;
    memset(b->stderr_rgb, 0, pixels * 12);
    memset(b->stderr_y, 0, pixels * 4);
    if (b->low) memset(b->low, 0, pixels * 12);
    for (size_t i = 0; b->high && i < 3 * pixels; i++) b->high[i] = FLT_MAX;
    for (size_t i = 0; i < pixels; i++) b->heavy[i] = 1;
    b->heavy_count = pixels;
}

ec_result ec_row_writer_finish(ec_row_writer *w, ec_rows_told *told, ec_error *err)
{
    const bool is_whole = w->come == w->height;
    float *no_features = NULL;
    write_up_to(w, NULL, w->come);
    if (!is_whole && w->band.aov && !(no_features = calloc((size_t)w->width * w->band_rows, EC_FILM_FEATURES * sizeof *no_features)))
        return ec_fail(err, "out of memory for rows of a picture");
    while (w->written < w->height) {
        blank_band(w, w->height - w->written < w->band_rows ? w->height - w->written : w->band_rows, no_features);
        write_band(w);
    }
    free(no_features);
    *told = (ec_rows_told){.rows = w->come, .replicates = w->replicates, .heavy = w->heavy};
    told->error = ec_film_error_of(&w->sums, (double)w->width * w->height, w->replicates, &w->rare, w->limit);
    if (!is_whole) told->error.error = told->error.error_bound = told->error.relmse = INFINITY;
    told->clamp = ec_clamp_error_of(&w->cut, &told->error, (double)w->width * w->height);
    ec_hash_end(&w->hash, told->sha256);
    return EC_OK;
}

ec_result ec_row_writer_close(ec_row_writer *w, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err)
{
    for (int i = 0; i < w->outputs->count; i++) {
        ec_error why = {0};
        ec_result ended = w->exr[i] ? ec_exr_rows_end(w->exr[i], attributes, attribute_count, &why)
                          : w->pixels[i] ? ec_output_format(&w->outputs->file[i])->end(w->pixels[i], &why) : EC_OK;
        bool had = w->exr[i] || w->pixels[i];
        w->exr[i] = NULL;
        w->pixels[i] = NULL;
        if (ended != EC_OK) fail_file(w, i, &why);
        else if (had) ec_output_settle(&w->outputs->file[i]);
    }
    ec_result result = *w->why.text ? EC_FAILED : EC_OK;
    if (result != EC_OK && err) *err = w->why;
    ec_row_writer_abort(w);
    return result;
}

void ec_row_writer_abort(ec_row_writer *w)
{
    if (!w) return;
    for (int i = 0; i < w->outputs->count; i++) {
        ec_exr_rows_abort(w->exr[i]);
        abort_pixels(w, i);
    }
    ec_film_destroy(&w->waiting);
    ec_film_destroy(&w->around);
    ec_picture_free(&w->band);
    free(w->rooms);
    free(w->bytes);
    free(w);
}
