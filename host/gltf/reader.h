/* A glTF file becomes a scene. */
#ifndef EC_GLTF_READER_H
#define EC_GLTF_READER_H

#include "scene/scene.h"

/* Reads .gltf or .glb. On failure *scene is NULL and err says what, where and how to mend it. Adds a framing camera where
 * there is none (noted in log). Environment and light fall-backs are the caller's (see ec_scene_set_environment,
 * ec_scene_find_light in host/pack). Owned by the caller: ec_scene_free. */
ec_result ec_scene_load(const char *path, ec_scene **scene, const ec_log *log, ec_error *err);
ec_result ec_scene_load_choice(const char *path, const ec_scene_choice *choice, ec_scene **scene, const ec_log *log, ec_error *err);

/* The files that it is read from, whether they are there or not: itself first, then the buffers and images that it
 * names. Of a broken one what can be told. */
typedef struct ec_scene_files {
    char **paths; /* owned */
    uint32_t count;
} ec_scene_files;
void ec_scene_files_list(const char *scene, ec_scene_files *files);
void ec_scene_files_free(ec_scene_files *files);

/* A file of which many moments are shown, or one many times: read and decoded once. choice: a frame; its moment is the first one shown. */
typedef struct ec_animation ec_animation;
ec_result ec_animation_open(const char *path, const ec_scene_choice *choice, ec_animation **animation,
                            const ec_log *log, ec_error *err);
void ec_animation_close(ec_animation *animation); /* after its scenes; NULL is fine */
/* The scene at choice->at, or over its shutter; all else of choice as when it was opened. Pixels of images are lent by the animation. A
 * light that the file has all around is in the first scene only, which may lend it to the others. */
ec_result ec_animation_show(ec_animation *animation, const ec_scene_choice *choice, ec_scene **scene, const ec_log *log,
                            ec_error *err);
/* Before the first scene: where all of it is from the beginning of the animation to its end, for the scenes' spans. */
ec_result ec_animation_find_span(ec_animation *animation, const ec_scene_choice *choice, ec_error *err);
/* SHA-256 over all files that it is made of, whether they are shown or not: in hexadecimal. */
void ec_animation_digest(const ec_animation *animation, char digest[65]);

#endif
