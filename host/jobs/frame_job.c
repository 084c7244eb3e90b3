#include "jobs/frame_job.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "base/sha256.h"
#include "jobs/given.h"
#include "image/exr_header.h"
#include "image/seal.h"
#include "device/content.h"
#include "scene/built_in.h"
#include "store/identity_text.h"

static void put(ec_identity *identity, const char *name, const char *value, bool repeats)
{
    for (uint32_t i = 0; i < identity->count; i++) { /* a repeated option keeps all values if `repeats`, otherwise the last */
        ec_trait *trait = &identity->traits[i];
        size_t used = strlen(trait->value);
        if (strcmp(trait->name, name)) continue;
        if (!repeats) snprintf(trait->value, sizeof trait->value, "%s", value);
        else snprintf(trait->value + used, sizeof trait->value - used, ", %s", value);
        return;
    }
    if (identity->count == EC_TRAITS_MAX) return;
    ec_trait *trait = &identity->traits[identity->count++];
    snprintf(trait->name, sizeof trait->name, "%s", name);
    snprintf(trait->value, sizeof trait->value, "%s", value);
}

static void add(ec_identity *identity, const char *name, const char *value) { put(identity, name, value, false); }

/* Adds a file that an option names by its content, not by its name. */
static ec_result add_file(ec_identity *identity, const char *option, const char *environment, ec_error *err)
{
    char hex[EC_SHA256_TEXT], text[96];
    if (!environment) return EC_OK;
    if (ec_is_built_in(environment) || access(environment, R_OK) != 0) {
        add(identity, option, environment);
        return EC_OK;
    }
    EC_TRY(ec_image_check_regular(environment, err));
    if (!ec_sha256_file(environment, hex)) return ec_fail(err, "cannot read '%s'", environment);
    snprintf(text, sizeof text, "the file of SHA-256 %s", hex);
    add(identity, option, text);
    return EC_OK;
}

ec_result ec_frames_identify(const ec_given_options *given, const ec_render_request *request, const char *files,
                             ec_identity *identity, ec_error *err)
{
    char text[64];
    memset(identity, 0, sizeof *identity);
    add(identity, "version", ECLAT_VERSION);
    ec_content_kernels(text);
    add(identity, "kernels", text);
    add(identity, "files", files);
    EC_TRY(add_file(identity, "--env", request->environment, err));
    EC_TRY(add_file(identity, "--ocio", request->ocio.config, err));
    for (int i = 0; i < given->count; i++) {
        char name[40];
        const ec_option *row = ec_render_row(given->list[i].option);
        if (row->uses & EC_OPTION_NO_IDENTITY) continue;
        snprintf(name, sizeof name, "--%s", row->name);
        put(identity, name, given->list[i].value ? given->list[i].value : "on", row->uses & EC_OPTION_REPEATS);
    }
    return EC_OK;
}

void ec_frame_identify(const ec_identity *all, const ec_render_request *request, uint32_t frame, ec_identity *identity)
{
    char text[64];
    *identity = *all;
    if (!request->frames.given) return;
    snprintf(text, sizeof text, "%.17g s", ec_frame_moment(request, frame));
    add(identity, "moment", text);
    if (!request->orbit) return;
    snprintf(text, sizeof text, "%.17g degrees", ec_frame_turn(request, frame));
    add(identity, "turn", text);
}

char *ec_frame_command(const ec_given_options *given, const ec_render_request *request, const ec_outputs *outputs, uint32_t frame)
{
    char number[16], *line = NULL, *scene = (char *)(uintptr_t)request->scene;
    ec_given_options alone = {0};
    ec_words words = {0};
    snprintf(number, sizeof number, "%u", frame);
    ec_result result = ec_given_add_all(&alone, given, ec_render_rows, ec_render_row_count, EC_OPTION_SEQUENCE, NULL);
    if (result == EC_OK && request->frames.given) result = ec_given_add(&alone, "frames", number, NULL);
    for (int i = 0; result == EC_OK && i < outputs->count; i++) result = ec_given_add(&alone, "output", outputs->file[i].path, NULL);
    if (result == EC_OK) result = ec_words_make(&words, "render", &scene, 1, &alone, ec_render_rows, ec_render_row_count, NULL);
    if (result == EC_OK) line = ec_command_line(words.count, words.list);
    ec_words_free(&words);
    ec_given_free(&alone);
    return line;
}

static ec_frame_state look_at(const ec_output *output, const ec_identity *identity, char *difference, size_t size)
{
    ec_error why;
    if (access(output->path, F_OK) != 0) return EC_FRAME_MISSING;
    if (ec_image_check_regular(output->path, &why) != EC_OK) {
        snprintf(difference, size, "%s", why.text);
        return EC_FRAME_OTHER;
    }
    ec_identity there;
    char what[1200];
    bool is_whole = false;
    char *text = output->kind == EC_OUTPUT_EXR ? ec_exr_header_text(output->path, EC_FRAME_ATTRIBUTE)
                                               : ec_png_text_of(output->path, EC_FRAME_ATTRIBUTE, &is_whole);
    bool is_frame = text && ec_identity_read(text, &there);
    free(text);
    if (is_frame && !ec_identity_differs(&there, identity, what, sizeof what)) {
        if (output->kind == EC_OUTPUT_EXR) is_whole = ec_seal_check(output->path, NULL) == EC_OK;
        if (!is_whole) snprintf(difference, size, "'%s' is damaged", output->path);
        return is_whole ? EC_FRAME_DONE : EC_FRAME_DAMAGED;
    }
    if (!is_frame) snprintf(what, sizeof what, "it is not a frame of a sequence, or is damaged");
    snprintf(difference, size, "'%s' already exists: %s", output->path, what);
    return EC_FRAME_OTHER;
}

ec_frame_state ec_frame_look(const ec_outputs *outputs, const ec_identity *identity, char *difference, size_t size)
{
    ec_frame_state state = EC_FRAME_DONE;
    for (int i = 0; i < outputs->count && state != EC_FRAME_OTHER; i++) {
        ec_frame_state one = look_at(&outputs->file[i], identity, difference, size);
        if (one > state) state = one;
    }
    return state;
}
