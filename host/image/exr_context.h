/* For those who read: an OpenEXRCore context that keeps its first message instead of printing it. */
#ifndef EC_IMAGE_EXR_CONTEXT_H
#define EC_IMAGE_EXR_CONTEXT_H

#include <openexr.h>
#include <stdio.h>

typedef struct ec_exr_stream {
    char message[512]; /* the library's first complaint */
} ec_exr_stream;

/* The library's callback. Its first message names the cause; later ones are consequences. */
static inline void ec_exr_keep_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    ec_exr_stream *stream = user;
    if (stream->message[0]) return;
    snprintf(stream->message, sizeof stream->message, "%s", message);
    for (char *c = stream->message; *c; c++)
        if (*c == '\n' || *c == '\r') *c = ' ';
}

static inline const char *ec_exr_reason(const ec_exr_stream *stream, exr_result_t code)
{
    return stream->message[0] ? stream->message : exr_get_default_error_message(code);
}

#endif
