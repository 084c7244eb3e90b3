#include "jobs/inputs.h"
#include "gltf/reader.h"

#include <sys/stat.h>
#include <unistd.h>

bool ec_same_file(const char *a, const char *b)
{
    struct stat sa, sb;
    return stat(a, &sa) == 0 && stat(b, &sb) == 0 && sa.st_dev == sb.st_dev && sa.st_ino == sb.st_ino;
}

bool ec_inputs_have(ec_inputs *inputs, const char *path)
{
    if (access(path, F_OK) != 0) return false;
    for (int i = 0; i < inputs->file_count; i++)
        if (inputs->files[i] && ec_same_file(path, inputs->files[i])) return true;
    if (inputs->scene && !inputs->of_scene.count) ec_scene_files_list(inputs->scene, &inputs->of_scene);
    for (uint32_t i = 0; i < inputs->of_scene.count; i++)
        if (ec_same_file(path, inputs->of_scene.paths[i])) return true;
    return false;
}

void ec_inputs_free(ec_inputs *inputs) { ec_scene_files_free(&inputs->of_scene); }
