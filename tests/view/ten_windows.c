/* Opens and closes a window ten times in one process: under ASan, LSan and UBSan, so that whatever a window leaves behind is named.
 * Usage: ten_windows SCENE SCRIPT. test_view.py runs it. */
#include <stdio.h>

#include "view/view.h"
#include "gltf/reader.h"

static ec_result load(void *user, ec_scene **scene, ec_render_options *options, ec_error *err)
{
    EC_TRY(ec_scene_load(user, scene, NULL, err));
    options->camera = (*scene)->default_camera;
    options->width = 64;
    options->height = 48;
    return EC_OK;
}

static ec_result save(void *user, const ec_view_shot *shot, char *told, size_t size, ec_error *err)
{
    (void)user, (void)err;
    snprintf(told, size, "%u batches", shot->film->batch_count);
    return EC_OK;
}

int main(int argc, char **argv)
{
    ec_error err = {0};
    ec_view_request request = {.scene = argc > 2 ? argv[1] : "", .script = argc > 2 ? argv[2] : "", .user = argc > 2 ? argv[1] : "",
                               .options = {.spp = 4, .replicates = 2, .lanes = 4}, .stop = -1, .load = load, .save = save};
    if (ec_device_find(NULL, &request.device, NULL, NULL, &err) != EC_OK) return fprintf(stderr, "%s\n", err.text), 1;
    for (int i = 0; i < 10; i++)
        if (ec_view_run(&request, &err) != EC_OK) return fprintf(stderr, "window %d: %s\n", i, err.text), 1;
    puts("ten windows");
    return 0;
}
