/* What the functions of eclat.h share. */
#ifndef EC_LIB_INTERNAL_H
#define EC_LIB_INTERNAL_H

#include <limits.h>
#include <stdatomic.h>

#include "eclat/eclat.h"
#include "jobs/frame_job.h"
#include "jobs/listener.h"
#include "jobs/merge_job.h"
#include "jobs/render_job.h"

/* An option as it was set; both texts owned by the job. */
typedef struct ec_lib_option {
    char *name, *value; /* value NULL: none */
} ec_lib_option;

struct eclat_job {
    char *scene;
    ec_lib_option *options;
    size_t option_count;
    eclat_listener listener;
    atomic_int is_stopped;
};

/* A picture is rendered or merged. `write` puts it into files. */
struct eclat_picture {
    ec_render_job job;        /* rendered; its film is the picture */
    ec_render_request request;
    eclat_job *options;       /* a copy, whose texts the request points to. Owned */
    char **words, *command;   /* the command that renders the same; owned, as its words are */
    int word_count;
    char folder[PATH_MAX];    /* in which the job began */
    ec_merged merged;         /* or merged */
    ec_picture planes;        /* of what was rendered */
    ec_channel_list channels;
    ec_report_attributes attributes;
    ec_film_error error;
    double samples_per_pixel;
    uint32_t replicates;
    char why[2048];
    ec_result (*write)(struct eclat_picture *picture, ec_outputs *outputs, ec_error *err);
};

/* Fills in a caller's error, which may be NULL. */
eclat_result ec_lib_end(ec_result result, const ec_error *from, eclat_error *to);

/* The rows of the render command that a caller may set: NULL for others. */
const ec_option *ec_lib_find_option(const char *name);

/* What the command line would read for the job's options; list: as they were given. */
ec_result ec_lib_read_options(const eclat_job *job, ec_render_request *request, ec_given_options *list, ec_error *err);

/* A listener that passes messages and progress on to a caller's; `listener` and the flag, which may be NULL, must last. */
typedef struct ec_lib_ear {
    const eclat_listener *listener;
    atomic_int *is_stopped;
} ec_lib_ear;
ec_listener ec_lib_listener(ec_lib_ear *ear);

/* Takes planes, channels and error from what was rendered or merged. */
ec_result ec_lib_picture_finish(eclat_picture *picture, ec_error *err);

eclat_job *ec_lib_job_copy(const eclat_job *job); /* NULL: out of memory */

#endif
