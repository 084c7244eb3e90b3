#include "jobs/frame_job.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include <sha2.h>

#include "jobs/command_line.h"
#include "image/exr_header.h"
#include "image/seal.h"
#include "device/content.h"
#include "store/identity_text.h"

static ec_result note(void *target, const char *option, const char *value, ec_error *err)
{
    ec_given_options *given = target;
    if (given->count == EC_GIVEN_MAX) return ec_fail(err, "more than %d options", EC_GIVEN_MAX);
    given->list[given->count].option = option;
    given->list[given->count++].value = value;
    return EC_OK;
}

ec_result ec_given_options_read(int argc, char *const *argv, ec_given_options *given, ec_error *err)
{
    ec_option rows[EC_OPTIONS_MAX];
    ec_request asked;
    int first;
    char **words = malloc(((size_t)argc + 1) * sizeof *words); /* getopt changes their order */
    if (!words) return ec_fail(err, "out of memory");
    memcpy(words, argv, (size_t)argc * sizeof *words);
    words[argc] = NULL;
    memcpy(rows, ec_render_rows, (size_t)ec_render_row_count * sizeof *rows);
    for (int i = 0; i < ec_render_row_count; i++) rows[i].set = note;
    given->count = 0;
    ec_result result = ec_options_parse(rows, ec_render_row_count, given, argc, words, &first, NULL, &asked, err);
    free(words);
    return result;
}

static void put(ec_identity *identity, const char *name, const char *value, bool repeats)
{
    for (uint32_t i = 0; i < identity->count; i++) { /* of what may be repeated, all; else the last */
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

/* An environment in a file counts by its bytes, not by its name. */
static ec_result add_environment(ec_identity *identity, const char *environment, ec_error *err)
{
    char text[96];
    if (!environment) return EC_OK;
    if (access(environment, R_OK) != 0) {
        add(identity, "--env", environment);
        return EC_OK;
    }
    EC_TRY(ec_image_check_regular(environment, err));
    char *hex = SHA256File(environment, NULL);
    if (!hex) return ec_fail(err, "cannot read '%s'", environment);
    snprintf(text, sizeof text, "the file of SHA-256 %s", hex);
    free(hex);
    add(identity, "--env", text);
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
    EC_TRY(add_environment(identity, request->environment, err));
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
    snprintf(text, sizeof text, "%.17g s", ec_frame_seconds(&request->frames, frame));
    add(identity, "moment", text);
}

char *ec_frame_command(const ec_given_options *given, const ec_render_request *request, const ec_outputs *outputs, uint32_t frame)
{
    static char program[] = "eclat", render[] = "render", frames[] = "--frames", output[] = "-o";
    char number[16], names[EC_GIVEN_MAX][40], *words[2 * EC_GIVEN_MAX + 2 * EC_OUTPUTS_MAX + 8];
    int count = 0;
    words[count++] = program;
    words[count++] = render;
    words[count++] = (char *)(uintptr_t)request->scene;
    for (int i = 0; i < given->count; i++) {
        if (ec_render_row(given->list[i].option)->uses & EC_OPTION_SEQUENCE) continue;
        snprintf(names[i], sizeof names[i], "--%s", given->list[i].option);
        words[count++] = names[i];
        if (given->list[i].value) words[count++] = (char *)(uintptr_t)given->list[i].value;
    }
    snprintf(number, sizeof number, "%u", frame);
    words[count++] = frames;
    words[count++] = number;
    for (int i = 0; i < outputs->count; i++) {
        words[count++] = output;
        words[count++] = (char *)(uintptr_t)outputs->file[i].path;
    }
    return ec_command_line(count, words);
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
    if (!is_frame) snprintf(what, sizeof what, "it is no frame of a sequence, or damaged");
    snprintf(difference, size, "'%s' is there already: %s", output->path, what);
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
