/* Checks a JSON tree against the schema: types, required members, ranges and index ranges. */
#include "gltf/gltf_schema.h"
#include "gltf/gltf_shim.h"

#include <cmath>
#include <cstring>
#include <sstream>

namespace eclat {

using nlohmann::json;

class checker {
  public:
    checker(json &document_root, const char *file, const ec_log *warnings)
        : root(document_root), path(file), log(warnings)
    {
    }

    void check_object(json &value, const schema &shape, const std::string &where)
    {
        if (!value.is_object()) fail(where, "must be an object");
        for (const field &f : shape) {
            if (f.type == kind::dictionary) {
                for (auto &item : value.items()) check_index(item.value(), f.detail, join(where, item.key()));
                continue;
            }
            if (const char *slash = std::strchr(f.name, '/')) {
                check_inside(value, f, std::string(f.name, slash), slash + 1, where);
                continue;
            }
            auto found = value.find(f.name);
            if (found == value.end()) {
                if (f.required) fail(join(where, f.name), "is missing");
            } else if (!check_value(*found, f, join(where, f.name))) {
                value.erase(found);
            }
        }
    }

  private:
    json &root;
    const char *path;
    const ec_log *log;

    /* Checks a member of a member, given by its path. */
    void check_inside(json &value, const field &f, const std::string &outer, const char *rest, const std::string &where)
    {
        auto found = value.find(outer);
        if (found == value.end()) return;
        field inner = f;
        inner.name = rest;
        check_object(*found, {inner}, join(where, outer));
    }

    [[noreturn]] static void fail(const std::string &where, const std::string &what)
    {
        throw bad_file((where.empty() ? std::string("the document") : where) + " " + what);
    }
    static std::string join(const std::string &where, const std::string &name)
    {
        return where.empty() ? name : where + "." + name;
    }
    static std::string item(const std::string &where, size_t i) { return where + "[" + std::to_string(i) + "]"; }

    /* Returns false if the value is to be removed, so that its default applies. */
    bool check_value(json &value, const field &f, const std::string &where)
    {
        switch (f.type) {
        case kind::index: check_index(value, f.detail, where); break;
        case kind::count: check_count(value, f.low, f.high, where); break;
        case kind::number: check_number(value, where); break;
        case kind::text: check_text(value, where); break;
        case kind::flag:
            if (!value.is_boolean()) fail(where, "must be true or false");
            break;
        case kind::choice: return check_choice(value, f, where);
        case kind::accessor_type: /* an unknown type is an error only when it is read, like a matrix */
            if (!is_among(value, f.detail)) value = "MAT2";
            break;
        case kind::object: check_object(value, f.members, where); break;
        default: check_array(value, f, where);
        }
        return true;
    }

    void check_array(json &value, const field &f, const std::string &where)
    {
        const bool of_rows = f.type == kind::index_rows || f.type == kind::number_rows;
        const field row = {f.name, f.type == kind::index_rows ? kind::indices : kind::numbers, false, f.detail, f.low};
        if (!value.is_array()) fail(where, "must be an array");
        if (of_rows) check_row_count(value, f, where);
        else if (f.low > 0 && double(value.size()) != f.low)
            fail(where, "must have " + std::to_string(int(f.low)) + (f.type == kind::indices ? " indices" : " numbers") + ", not " +
                            std::to_string(value.size()));
        if (double(value.size()) > int_count) fail(where, "has too many elements");
        for (size_t i = 0; i < value.size(); i++) {
            switch (f.type) {
            case kind::indices: check_index(value[i], f.detail, item(where, i)); break;
            case kind::numbers: check_number(value[i], item(where, i)); break;
            case kind::texts: check_text(value[i], item(where, i)); break;
            case kind::index_rows:
            case kind::number_rows: check_array(value[i], row, item(where, i)); break;
            default: check_object(value[i], f.members, item(where, i));
            }
        }
    }

    static void check_row_count(const json &value, const field &f, const std::string &where)
    {
        if (f.high > 0 && double(value.size()) != f.high)
            fail(where, "must have " + std::to_string(int(f.high)) + " arrays, not " + std::to_string(value.size()));
        if (value.empty()) fail(where, "is empty");
    }

    void check_number(json &value, const std::string &where)
    {
        if (!value.is_number()) fail(where, "must be a number");
        if (!std::isfinite(float(value.get<double>()))) fail(where, "is too large: " + value.dump());
        value = value.get<double>(); /* also if it was written without a decimal point */
    }

    void check_text(const json &value, const std::string &where)
    {
        if (!value.is_string()) fail(where, "must be a string");
    }

    void check_count(json &value, double low, double high, const std::string &where)
    {
        double n = value.is_number() ? value.get<double>() : -1;
        if (n < 0 || n != std::floor(n)) fail(where, "must be a non-negative integer");
        if (n < low || n > high) fail(where, "is out of range: " + value.dump());
        value = uint64_t(n); /* 3.0 is a legal way to write 3 */
    }

    void check_index(json &value, const char *target, const std::string &where)
    {
        check_count(value, 0, int_count, where);
        size_t size = array_size(target), i = value.get<size_t>();
        if (i >= size)
            fail(where, "is " + std::to_string(i) + " but the file has " + std::to_string(size) + " " + target);
    }

    size_t array_size(const std::string &name)
    {
        static const struct {
            const char *name, *extension, *member;
        } inside[] = {{"lights", "KHR_lights_punctual", "lights"},
                      {"image-based lights", "EXT_lights_image_based", "lights"},
                      {"variants", "KHR_materials_variants", "variants"}};
        const json *holder = &root;
        std::string member = name;
        for (auto &place : inside) {
            if (name != place.name) continue;
            for (const char *step : {"extensions", place.extension}) {
                auto found = holder->find(step);
                if (found == holder->end() || !found->is_object()) return 0;
                holder = &*found;
            }
            member = place.member;
        }
        auto found = holder->find(member);
        return found != holder->end() && found->is_array() ? found->size() : 0;
    }

    static std::string text_of(const json &value)
    {
        return value.is_string() ? value.get<std::string>() : value.dump();
    }

    static bool is_among(const json &value, const char *allowed)
    {
        std::istringstream words(allowed);
        for (std::string word, text = text_of(value); words >> word;)
            if (word == text) return true;
        return false;
    }

    bool check_choice(const json &value, const field &f, const std::string &where)
    {
        if (is_among(value, f.detail)) return true;
        std::string text = text_of(value);
        if (f.required) fail(where, "is " + text + ", not one of: " + f.detail);
        ec_warn(log, "%s: %s is %s, not one of: %s; using the default", path, printable(where).c_str(),
                shortened(printable(text), 80).c_str(), f.detail);
        return false;
    }
};

/* Tells whether a material uses a texture: each use is an object with an index, at any depth. */
static bool uses_texture(const json &value, size_t texture)
{
    if (!value.is_structured()) return false;
    for (auto &item : value.items()) {
        if (value.is_object() && item.key() == "index" && item.value() == texture) return true;
        if (item.key() != "extras" && uses_texture(item.value(), texture)) return true;
    }
    return false;
}

/* Accepts textures whose image does not exist if no material uses them: they count as textures without an image. */
static void check_sources(json &root, const char *path, const ec_log *log)
{
    const size_t images = list_of(root, "images").size(), textures = list_of(root, "textures").size();
    for (size_t i = 0; i < textures; i++) {
        json &texture = root["textures"][i];
        const size_t source = texture.value("source", size_t(0));
        if (!texture.contains("source") || source < images) continue;
        const std::string what = "textures[" + std::to_string(i) + "].source is " + std::to_string(source) + " but the file has " +
                                 std::to_string(images) + " images";
        if (uses_texture(list_of(root, "materials"), i)) throw bad_file(what);
        ec_warn(log, "%s: %s; no material uses it", path, what.c_str());
        texture.erase("source");
    }
}

void check_document(json &root, const char *path, const ec_log *log)
{
    checker(root, path, log).check_object(root, document_schema, "");
    check_sources(root, path, log);
    const json &cameras = list_of(root, "cameras"), &views = list_of(root, "bufferViews");
    for (size_t i = 0; i < cameras.size(); i++) {
        std::string type = cameras[i]["type"];
        if (!cameras[i].contains(type)) throw bad_file("cameras[" + std::to_string(i) + "]." + type + " is missing");
    }
    for (size_t i = 0; i < views.size(); i++)
        if (views[i].value("byteStride", 4) % 4)
            throw bad_file("bufferViews[" + std::to_string(i) + "].byteStride must be a multiple of 4");
}

} // namespace eclat
