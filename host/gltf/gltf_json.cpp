/* Reads the container of a glTF file: .glb or JSON text, told apart by content. Checks lengths and the depth of the JSON. */
#include "gltf/gltf_shim.h"

#include <cstring>

namespace eclat {

/* Deeper than any real file; keeps recursion over the tree within the stack. */
static const int max_json_depth = 64;

static void check_depth(const char *text, size_t length)
{
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < length; i++) {
        char c = text[i];
        if (in_string) {
            if (c == '\\') i++;
            else if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > max_json_depth)
                throw bad_file("the JSON is nested more than " + std::to_string(max_json_depth) +
                               " deep, which no glTF needs");
        } else if (c == '}' || c == ']') {
            depth--;
        }
    }
}

static nlohmann::json parse_json(const char *text, size_t length)
{
    check_depth(text, length);
    nlohmann::json root;
    try {
        root = nlohmann::json::parse(text, text + length);
    } catch (const nlohmann::json::exception &e) {
        std::string reason = e.what(); /* "[json.exception.parse_error.101] parse error at line 3, ...: ..." */
        size_t start = reason.find("] ");
        throw bad_file("not valid JSON: " + (start == std::string::npos ? reason : reason.substr(start + 2)));
    }
    if (!root.is_object()) throw bad_file("the JSON is not an object; is this a glTF file?");
    return root;
}

static uint32_t load_word(const uint8_t *p)
{
    return uint32_t(p[0]) | uint32_t(p[1]) << 8 | uint32_t(p[2]) << 16 | uint32_t(p[3]) << 24;
}

static container parse_glb(const uint8_t *bytes, uint64_t length)
{
    const uint32_t json_type = 0x4E4F534A, bin_type = 0x004E4942;
    if (length < 20) throw bad_file("truncated .glb: only " + std::to_string(length) + " bytes");
    uint32_t version = load_word(bytes + 4), total = load_word(bytes + 8);
    if (version != 2) throw bad_file("this .glb has container version " + std::to_string(version) + ", not 2");
    if (total > length)
        throw bad_file("truncated .glb: its header promises " + std::to_string(total) + " bytes, the file has " +
                       std::to_string(length));
    uint64_t json_length = load_word(bytes + 12);
    if (total < 20 || load_word(bytes + 16) != json_type || json_length > total - 20)
        throw bad_file("broken .glb: the first chunk is not JSON that fits the file");
    container c = {parse_json(reinterpret_cast<const char *>(bytes + 20), json_length), nullptr, 0};
    uint64_t next = 20 + ((json_length + 3) & ~uint64_t(3));
    if (next >= total) return c;
    if (total - next < 8) throw bad_file("broken .glb: the second chunk has no header");
    uint64_t chunk_length = load_word(bytes + next);
    if (chunk_length > total - next - 8)
        throw bad_file("truncated .glb: its binary chunk promises " + std::to_string(chunk_length) + " bytes, " +
                       std::to_string(total - next - 8) + " are there");
    if (load_word(bytes + next + 4) == bin_type) {
        c.chunk = bytes + next + 8;
        c.chunk_length = chunk_length;
    }
    return c;
}

container parse_container(const uint8_t *bytes, uint64_t length)
{
    if (!length) throw bad_file("the file is empty");
    if (length >= 4 && !memcmp(bytes, "glTF", 4)) return parse_glb(bytes, length);
    return {parse_json(reinterpret_cast<const char *>(bytes), length), nullptr, 0};
}

} // namespace eclat

extern "C" void ec_gltf_tree_free(ec_gltf *gltf)
{
    delete static_cast<eclat::posable *>(gltf->tree);
    gltf->tree = nullptr;
}
