/* Shows a moment of an animation by changing the document: the value of each channel at that time is written where it points to, before nodes,
 * meshes, materials, lights and cameras are read. KHR_animation_pointer thus needs only the resolution of its pointers. */
#include "gltf/gltf_schema.h"
#include "gltf/gltf_shim.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

extern "C" {
#include "gltf/gltf_keyframes.h"
}

namespace eclat {

using nlohmann::json;
using path = std::vector<std::string>;

/* Splits a JSON pointer into its parts; ~1 stands for a slash and ~0 for a tilde. */
static path split(const std::string &pointer)
{
    path parts;
    for (size_t i = 0; i < pointer.size(); i++) {
        char c = pointer[i];
        if (c == '/') {
            parts.emplace_back();
            continue;
        }
        if (parts.empty()) return {};
        if (c == '~' && i + 1 < pointer.size()) c = pointer[++i] == '1' ? '/' : '~';
        parts.back() += c;
    }
    return parts;
}

/* Tells whether a pointer leads to what is read after animation; the rest of the tree has already been converted. */
static bool may_move(const path &to)
{
    if (to.size() < 3) return false;
    if (to[0] == "extensions") return to.size() >= 5 && to[1] == "KHR_lights_punctual" && to[2] == "lights";
    if (std::any_of(to.begin(), to.end(), [](const std::string &part) { return part.find('/') != std::string::npos; })) return false;
    return to[0] == "nodes" || to[0] == "materials" || to[0] == "cameras" || (to[0] == "meshes" && to[2] == "weights");
}

static const json *element(const json &array, const std::string &name)
{
    bool number = !name.empty() && name.size() < 10 && name.find_first_not_of("0123456789") == std::string::npos;
    size_t i = number ? std::stoul(name) : array.size();
    return i < array.size() ? &array[i] : nullptr;
}

static const field *find_field(const schema &shape, const std::string &name)
{
    for (const field &f : shape)
        if (!name.empty() && name == f.name) return &f;
    return nullptr;
}

/* Tells whether the path of some member leads through that object. */
static bool has_within(const schema &shape, const std::string &object)
{
    return std::any_of(shape.begin(), shape.end(),
                       [&](const field &f) { return std::strncmp(f.name, object.c_str(), object.size()) == 0; });
}

/* Tells whether an object may be missing from the file because all of its members have defaults. One that names a texture or belongs to an extension
 * may not. */
static bool has_defaults(const path &to, size_t i, const schema &shape)
{
    if (to[i] == "extensions" || to[i - 1] == "extensions") return false;
    return std::none_of(shape.begin(), shape.end(), [](const field &f) { return f.required; });
}

/* Finds the field that a pointer leads to; nullptr if there is none that may be written. */
static const field *find_target(const json &root, const path &to)
{
    if (!may_move(to)) return nullptr;
    const schema *shape = &document_schema;
    const json *at = &root; /* nullptr: only defaults from here on */
    std::string inner;      /* path within the shape */
    for (size_t i = 0; i < to.size(); i++) {
        bool last = i + 1 == to.size();
        const field *f = find_field(*shape, inner += to[i]);
        at = at && at->contains(to[i]) ? &(*at)[to[i]] : nullptr;
        if (!f) {
            const bool said = at || !(to[i] == "extensions" || to[i - 1] == "extensions");
            if (last || !said || !has_within(*shape, inner += '/')) return nullptr;
            continue;
        }
        if (f->type == kind::number || f->type == kind::flag) return last ? f : nullptr;
        if (f->type == kind::numbers) { /* all of them, or a single weight */
            bool one = i + 2 == to.size() && to[i] == "weights" && at && element(*at, to[i + 1]);
            return last || one ? f : nullptr;
        }
        bool object = f->type == kind::object;
        if (last || !(object || f->type == kind::objects)) return nullptr;
        if (object ? !at && !has_defaults(to, i, f->members) : !at || !(at = element(*at, to[++i]))) return nullptr;
        shape = &f->members;
        inner.clear();
    }
    return nullptr;
}

/* Writes the value of a field that find_target has found. */
static void write(json &root, const path &to, const json &value)
{
    const std::string &last = to.back();
    bool places = to[0] == "nodes" && (last == "translation" || last == "rotation" || last == "scale");
    json *at = &root;
    for (const std::string &name : to) {
        if (places && &name == &last) at->erase("matrix");
        at = at->is_array() ? &(*at)[std::stoul(name)] : &(*at)[name];
    }
    *at = value;
}

static ec_gltf_keyframes convert_keyframes(const json &sampler)
{
    std::string interpolation = sampler.value("interpolation", "LINEAR");
    return {sampler["input"], sampler["output"],
            interpolation == "STEP" ? EC_STEP : interpolation == "CUBICSPLINE" ? EC_CUBICSPLINE : EC_LINEAR};
}

static json sample(ec_gltf *gltf, const json &sampler, const path &to, kind type, const ec_scene_choice *choice,
                   const std::string &where)
{
    ec_error err;
    ec_gltf_numbers numbers = {nullptr, 0};
    ec_gltf_keyframes keyframes = convert_keyframes(sampler);
    bool rotation = to[0] == "nodes" && to.back() == "rotation";
    ec_result result = ec_gltf_keyframes_sample(gltf, &keyframes, rotation, choice->at, where.c_str(), &numbers, &err);
    std::unique_ptr<double, void (*)(void *)> owned(numbers.values, free);
    if (result != EC_OK) throw bad_file(err.text);
    if (gltf->blurs) gltf->shutter_keys = std::max(gltf->shutter_keys, ec_gltf_keyframes_between(gltf, &keyframes, choice->opens, choice->closes));
    if (numbers.count == 1 && type == kind::flag) return numbers.values[0] != 0;
    if (numbers.count == 1 && to.back() != "weights") return numbers.values[0];
    return std::vector<double>(numbers.values, numbers.values + numbers.count);
}

/* Returns the pointer of a channel's target; empty if it has none, which glTF allows. */
static std::string pointer_of(const json &target)
{
    const json *extension = find_extension(target, "KHR_animation_pointer");
    if (extension) return (*extension)["pointer"];
    if (!target.contains("node")) return "";
    return "/nodes/" + std::to_string(target["node"].get<int>()) + "/" + target["path"].get<std::string>();
}

static bool apply(json &root, const json &animation, const std::string &name, const ec_scene_choice *choice,
                  ec_gltf *gltf, const ec_log *log)
{
    bool more = false;
    const json &channels = animation["channels"], &samplers = animation["samplers"];
    for (size_t i = 0; i < channels.size(); i++) {
        std::string where = name + ".channels[" + std::to_string(i) + "]", pointer = pointer_of(channels[i]["target"]);
        size_t sampler = channels[i]["sampler"];
        if (pointer.empty()) continue;
        if (sampler >= samplers.size())
            throw bad_file(where + ".sampler is " + std::to_string(sampler) + " but there are " +
                           std::to_string(samplers.size()));
        path to = split(pointer);
        const field *target = find_target(root, to);
        if (!target) {
            ec_warn(log, "%s: %s animates %s, which is not supported; it is left out", gltf->path, where.c_str(),
                    shortened(printable(pointer), 200).c_str());
            continue;
        }
        write(root, to, sample(gltf, samplers[sampler], to, target->type, choice, where));
        if (to[0] == "nodes")
            gltf->animated[std::stoul(to[1])] = true;
        else
            more |= to[0] != "meshes";
    }
    return more;
}

static void list_animations(const json &root, ec_scene_contents &contents)
{
    const json &animations = list_of(root, "animations"), &accessors = list_of(root, "accessors");
    list_names(animations, &contents.animations);
    contents.seconds = make_array<double>(animations.size());
    for (size_t i = 0; i < animations.size(); i++) {
        double &seconds = contents.seconds[i] = 0;
        for (const json &sampler : animations[i]["samplers"]) {
            const json &most = list_of(accessors[sampler["input"].get<size_t>()], "max");
            bool known = most.is_array() && most.size() == 1 && most[0].is_number();
            seconds = known ? std::fmax(seconds, most[0].get<double>()) : std::nan("");
            if (!known) break;
        }
    }
}

std::vector<uint32_t> choose_animations(const json &root, const ec_scene_choice *choice, ec_gltf *gltf, const ec_log *log)
{
    ec_scene_names &names = gltf->contents.animations;
    list_animations(root, gltf->contents);
    if (!choice->animated) {
        if (names.count)
            ec_note(log, "%s: %u animation%s: shown as stored; --at SECONDS chooses a moment", gltf->path, names.count,
                    names.count > 1 ? "s" : "");
        return {};
    }
    if (!names.count) throw bad_file("the file has no animation; leave out --at, --animation, --frames and --shutter");
    gltf->animated = make_array<bool>(list_of(root, "nodes").size());
    gltf->blurs = choice->shutter;
    bool all = choice->animation && std::string(choice->animation) == "all";
    uint32_t one = choice->animation && !all ? find_choice(&names, "animation", choice->animation) : 0;
    std::vector<uint32_t> chosen;
    for (uint32_t i = 0; i < names.count; i++)
        if (all || i == one) chosen.push_back(i);
    return chosen;
}

bool apply_moment(json &root, const std::vector<uint32_t> &animations, const ec_scene_choice *choice, ec_gltf *gltf, const ec_log *log)
{
    bool more = false;
    for (uint32_t i : animations) { /* the animations themselves do not move: what is written is elsewhere in the tree */
        const json &animation = root["animations"][i];
        more |= apply(root, animation, "animations[" + std::to_string(i) + "]", choice, gltf, log);
    }
    return more;
}

} // namespace eclat
