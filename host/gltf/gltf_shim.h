/* Shared by the C++ files of the glTF reader; C code includes gltf/gltf.h. Problems are thrown as bad_file; ec_gltf_read turns every exception into
 * an ec_error. */
#ifndef EC_GLTF_GLTF_SHIM_H
#define EC_GLTF_GLTF_SHIM_H

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <tiny_gltf.h>

extern "C" {
#include "base/text.h"
#include "gltf/gltf.h"
}

namespace eclat {

struct bad_file : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/* gltf_json.cpp: parses the bytes of a .gltf or .glb; chunk is the .glb's binary chunk, or NULL. */
struct container {
    nlohmann::json root;
    const uint8_t *chunk;
    uint64_t chunk_length;
};
container parse_container(const uint8_t *bytes, uint64_t length);

/* gltf_extensions.cpp: fails on required extensions that eclat lacks, and warns of used ones. */
void check_extensions(const nlohmann::json &root, ec_gltf *gltf, const ec_log *log);

/* gltf_check.cpp: checks types, required members, ranges and index ranges of everything that eclat reads. Repairs what glTF only warns about, such as
 * an unknown filter. */
void check_document(nlohmann::json &root, const char *path, const ec_log *log);

/* gltf_geometry.cpp: converts lists of the checked tree. */
const nlohmann::json &list_of(const nlohmann::json &object, const char *key); /* an empty list if there is none */
const nlohmann::json *find_extension(const nlohmann::json &object, const char *name);
double element(const nlohmann::json &object, const char *key, size_t i, double fallback); /* number i of an array member */
void convert_views(const nlohmann::json &list, ec_gltf *gltf);
void convert_accessors(const nlohmann::json &list, ec_gltf *gltf);
void convert_meshes(const nlohmann::json &list, ec_gltf *gltf);
void convert_weights(const nlohmann::json &list, ec_gltf *gltf); /* again, for meshes that exist */
void convert_skins(const nlohmann::json &list, ec_gltf *gltf);
void convert_nodes(const nlohmann::json &list, ec_gltf *gltf, const ec_log *log);
void set_roots(const nlohmann::json &root, ec_gltf *gltf);

/* gltf_choice.cpp: writes the chosen scene and variant into the tree, so that what follows sees a file without choices. Also lists their names. */
void list_names(const nlohmann::json &list, ec_scene_names *out);
uint32_t find_choice(const ec_scene_names *names, const char *what, const char *wanted);
void choose_scene(nlohmann::json &root, const ec_scene_choice *choice, ec_gltf *gltf);
void choose_variant(nlohmann::json &root, const ec_scene_choice *choice, ec_gltf *gltf);

/* gltf_animation.cpp: returns indices of the animations to show; empty if everything is shown as stored. */
std::vector<uint32_t> choose_animations(const nlohmann::json &root, const ec_scene_choice *choice, ec_gltf *gltf,
                                        const ec_log *log);
/* Writes a moment of them into the tree, which must be checked again afterwards. Every moment writes the same channels, so that one moment replaces
 * another. Returns true if a channel moves more than nodes and weights. */
bool apply_moment(nlohmann::json &root, const std::vector<uint32_t> &animations, const ec_scene_choice *choice,
                  ec_gltf *gltf, const ec_log *log);

/* The document of an animation, kept to write other moments into it. */
struct posable {
    nlohmann::json root;
    std::vector<uint32_t> animations;
    bool more; /* more than nodes and weights is moved */
};

/* gltf_convert.cpp */
void convert_images(const nlohmann::json &list, ec_gltf *gltf);
void convert_image_light(const nlohmann::json &root, ec_gltf *gltf, const ec_log *log); /* that of the shown scene */
void convert_cameras(const nlohmann::json &list, ec_gltf *gltf, const ec_log *log);
void convert_lights(const nlohmann::json &root, ec_gltf *gltf, const ec_log *log);

/* gltf_material.cpp */
void convert_materials(const nlohmann::json &list, ec_gltf *gltf, const ec_log *log);
void convert_textures(const nlohmann::json &root, ec_gltf *gltf);

/* Zeroed C arrays and strings, so that ec_gltf_free can free half a document. */
template <typename T> T *make_array(size_t count)
{
    T *array = static_cast<T *>(calloc(count ? count : 1, sizeof(T)));
    if (!array) throw std::bad_alloc();
    return array;
}
/* Converts a list of the document to an array: one(in, out) fills each item. The count grows with the items, so that ec_gltf_free sees those begun. */
template <typename T, typename F> void convert_list(const nlohmann::json &list, T *&array, uint32_t &count, F &&one)
{
    array = make_array<T>(list.size());
    for (const nlohmann::json &in : list) one(in, array[count++]);
}
inline char *copy_bytes(const std::string &text)
{
    char *copy = strdup(text.c_str());
    if (!copy) throw std::bad_alloc();
    return copy;
}

/* Makes text from a file safe for messages: no line breaks and no terminal escapes. */
inline std::string printable(std::string text)
{
    for (char &c : text)
        if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
    ec_text_clean(&text[0]);
    return text.c_str();
}
/* Cuts a text to at most `most` bytes. */
inline std::string shortened(const std::string &text, int most)
{
    return text.substr(0, size_t(ec_text_cut(text.c_str(), most)));
}
inline char *copy_string(const std::string &name)
{
    return name.empty() ? nullptr : copy_bytes(printable(name));
}

} // namespace eclat

#endif
