#include "jobs/frame_share.h"

#include <stdlib.h>
#include <string.h>

void ec_frame_share_drop_environment(ec_frame_share *share)
{
    free(share->environment.rgb);
    ec_packed_map_free(&share->packed);
    share->environment = (ec_environment){0};
    share->environment_known = false;
}

void ec_frame_share_close(ec_frame_share *share)
{
    for (uint32_t i = 0; share->is_open && i < share->device_count; i++) ec_cl_close(&share->cl[i]);
    share->is_open = false;
}

void ec_frame_share_leave(ec_frame_share *share)
{
    ec_animation_close(share->animation);
    share->animation = NULL;
    ec_frame_share_drop_environment(share);
    ec_followed_free(&share->followed);
}

void ec_frame_share_free(ec_frame_share *share)
{
    ec_frame_share_leave(share);
    ec_frame_share_close(share);
    while (share->pictures.count) free(share->pictures.list[--share->pictures.count]);
    free(share->pictures.list);
}

void ec_frame_share_picture(ec_frame_share *share, const ec_outputs *outputs)
{
    int which = 0;
    for (int i = outputs->count - 1; i >= 0; i--)
        if (outputs->file[i].kind == EC_OUTPUT_PNG) which = i;
    char **longer = realloc(share->pictures.list, (share->pictures.count + 1) * sizeof *longer), *path = strdup(outputs->file[which].path);
    if (longer) share->pictures.list = longer;
    if (longer && path) longer[share->pictures.count++] = path;
    else free(path);
}
