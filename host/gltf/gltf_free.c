/* Frees a glTF document, also one that is only half built. */
#include "gltf/gltf.h"

#include <stdlib.h>

static void free_mesh(ec_gltf_mesh *mesh)
{
    for (uint32_t i = 0; mesh->primitives && i < mesh->primitive_count; i++) {
        free(mesh->primitives[i].targets);
        free(mesh->primitives[i].joints);
        free(mesh->primitives[i].weights);
        free(mesh->primitives[i].draco);
    }
    free(mesh->name);
    free(mesh->weights);
    free(mesh->primitives);
}

static void free_nodes(ec_gltf *g)
{
    for (uint32_t i = 0; i < g->node_count; i++) {
        free(g->nodes[i].name);
        free(g->nodes[i].children);
        free(g->nodes[i].weights);
    }
    free(g->nodes);
    g->nodes = NULL;
    g->node_count = 0;
}

void ec_gltf_unpose(ec_gltf *g)
{
    free_nodes(g);
    while (g->accessor_count > g->stored_accessors) free(g->accessors[--g->accessor_count].owned);
    while (g->mesh_count > g->stored_meshes) free_mesh(&g->meshes[--g->mesh_count]);
    for (uint32_t i = 0; i < g->mesh_count; i++)
        for (uint32_t k = 0; k < g->meshes[i].primitive_count; k++) /* what alpha hid may be visible now */
            g->meshes[i].primitives[k].drawn = g->meshes[i].primitives[k].triangle_count > 0;
}

void ec_gltf_free_looks(ec_gltf *g)
{
    for (uint32_t i = 0; g->materials && i < g->material_count; i++) free(g->materials[i].name);
    for (uint32_t i = 0; i < g->camera_count; i++) free(g->cameras[i].name);
    free(g->textures);
    free(g->materials);
    free(g->cameras);
    free(g->lights);
    g->textures = NULL;
    g->materials = NULL;
    g->cameras = NULL;
    g->lights = NULL;
    g->texture_count = g->material_count = g->camera_count = g->light_count = 0;
}

static void free_geometry(ec_gltf *g)
{
    for (uint32_t i = 0; i < g->buffer_count; i++) free(g->buffers[i].owned);
    for (uint32_t i = 0; i < g->view_count; i++) free(g->views[i].owned);
    for (uint32_t i = 0; i < g->accessor_count; i++) free(g->accessors[i].owned);
    for (uint32_t i = 0; i < g->mesh_count; i++) free_mesh(&g->meshes[i]);
    for (uint32_t i = 0; i < g->skin_count; i++) free(g->skins[i].joints);
    free_nodes(g);
    free(g->file);
    free(g->buffers);
    free(g->views);
    free(g->accessors);
    free(g->meshes);
    free(g->skins);
    free(g->roots);
    free(g->animated);
    free(g->sources);
}

void ec_gltf_free(ec_gltf *g)
{
    if (!g) return;
    free_geometry(g);
    for (uint32_t i = 0; i < g->image_count; i++) {
        free(g->images[i].name);
        free(g->images[i].uri);
    }
    for (uint32_t i = 0; i < g->decoded_count; i++) ec_image_free(&g->decoded[i]);
    free(g->decoded);
    free(g->images);
    ec_gltf_free_looks(g);
    if (g->tree) ec_gltf_tree_free(g);
    ec_scene_contents_free(&g->contents);
    free(g->folder);
    free(g);
}
