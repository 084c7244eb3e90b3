/* Reads a glTF file into a scene. */
#ifndef EC_GLTF_READER_H
#define EC_GLTF_READER_H

#include "scene/scene.h"

/* Reads a .gltf or .glb. On failure *scene is NULL, and err says what is wrong, where, and how to mend it. Adds a framing camera if there is none
 * (noted in log). The caller frees the scene with ec_scene_free, and provides fallbacks for environment and lights (see ec_scene_set_environment, and
 * ec_scene_find_light in host/pack). */
ec_result ec_scene_load(const char *path, ec_scene **scene, const ec_log *log, ec_error *err);
ec_result ec_scene_load_choice(const char *path, const ec_scene_choice *choice, ec_scene **scene, const ec_log *log, ec_error *err);

/* Lists the files that a scene is read from, whether they exist or not: first itself, then the buffers and images that it names. For a broken file,
 * as many as can be found. */
typedef struct ec_scene_files {
    char **paths; /* owned */
    uint32_t count;
} ec_scene_files;
void ec_scene_files_list(const char *scene, ec_scene_files *files);
void ec_scene_files_free(ec_scene_files *files);

/* A file shown at many moments, or many times at one: it is read and decoded once. choice: that of a frame, with the first moment to be shown. */
typedef struct ec_animation ec_animation;
ec_result ec_animation_open(const char *path, const ec_scene_choice *choice, ec_animation **animation,
                            const ec_log *log, ec_error *err);
void ec_animation_close(ec_animation *animation); /* after its scenes are freed; NULL is fine */
/* Makes the scene at choice->at, or over its shutter; otherwise choice must be the one given on opening. The animation lends its images to the scene.
 * An environment of the file is in the first scene only, whose owner may lend it to the others. */
ec_result ec_animation_show(ec_animation *animation, const ec_scene_choice *choice, ec_scene **scene, const ec_log *log,
                            ec_error *err);
/* Finds the box that holds everything from the beginning of the animation to its end, for the scenes' spans. To be called before the first scene. */
ec_result ec_animation_find_span(ec_animation *animation, const ec_scene_choice *choice, ec_error *err);
/* Writes the SHA-256 over all files of the document, whether shown or not, in hexadecimal. */
void ec_animation_digest(const ec_animation *animation, char digest[65]);

#endif
