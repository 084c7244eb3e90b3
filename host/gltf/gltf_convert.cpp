/* Converts images, cameras and lights from the checked JSON tree. */
#include "gltf/gltf_shim.h"

#include <algorithm>
#include <cmath>

namespace eclat {

using nlohmann::json;

void convert_images(const json &list, ec_gltf *gltf)
{
    convert_list(list, gltf->images, gltf->image_count, [](const json &in, ec_gltf_image &out) {
        out.name = copy_string(in.value("name", ""));
        out.view = in.value("bufferView", -1);
        if (in.contains("uri")) out.uri = copy_bytes(in["uri"]);
    });
}

void convert_image_light(const json &root, ec_gltf *gltf, const ec_log *log)
{
    const json &scenes = list_of(root, "scenes");
    const json *chosen = gltf->contents.scene < scenes.size() ? find_extension(scenes[gltf->contents.scene], "EXT_lights_image_based") : nullptr;
    if (!chosen) return;
    ec_gltf_image_light &out = gltf->image_light;
    out.index = (*chosen)["light"];
    const json &in = (*find_extension(root, "EXT_lights_image_based"))["lights"][size_t(out.index)];
    const json &sharpest = in["specularImages"][0];
    for (size_t i = 0; i < 6; i++) out.faces[i] = sharpest[i];
    for (size_t i = 0; i < 4; i++) out.rotation[i] = element(in, "rotation", i, i == 3);
    out.size = in["specularImageSize"];
    double intensity = in.value("intensity", 1.0);
    out.intensity = std::min(std::max(intensity, 0.0), double(EC_RADIANCE_MOST));
    if (out.intensity != intensity)
        ec_warn(log, "%s: image-based light %d has intensity %g, which is taken as %g", gltf->path, out.index, intensity,
                out.intensity);
    out.used = true;
}

static const float widest_yfov = 3.0f; /* radians; glTF only advises to stay below pi, where there is no image plane */

static const float widest_aspect = 128; /* a picture of the default height is then 65536 pixels wide */

/* Sets type and size of a camera. The schema guarantees the member that is named by the type. */
static void set_lens(const json &in, ec_camera &out)
{
    const std::string &type = in["type"].get_ref<const std::string &>();
    const json &lens = in[type];
    out.type = type == "orthographic" ? EC_CAMERA_ORTHOGRAPHIC : EC_CAMERA_PERSPECTIVE;
    out.yfov = float(lens.value("yfov", 0.0));
    out.aspect = float(lens.value("aspectRatio", 0.0));
    out.xmag = float(std::fabs(lens.value("xmag", 0.0)));
    out.ymag = float(std::fabs(lens.value("ymag", 0.0)));
}

void convert_cameras(const json &list, ec_gltf *gltf, const ec_log *log)
{
    convert_list(list, gltf->cameras, gltf->camera_count, [&](const json &in, ec_camera &out) {
        std::string where = "cameras[" + std::to_string(gltf->camera_count - 1) + "]";
        set_lens(in, out);
        out.name = copy_string(in.value("name", ""));
        if (out.type == EC_CAMERA_PERSPECTIVE && !(out.yfov > 0))
            throw bad_file(where + ": yfov must be positive, not " + std::to_string(out.yfov));
        if (out.yfov > widest_yfov) {
            ec_warn(log, "%s: %s: yfov %g is taken as %g", gltf->path, where.c_str(), out.yfov, widest_yfov);
            out.yfov = widest_yfov;
        }
        if (out.type == EC_CAMERA_PERSPECTIVE && !(out.aspect >= 0))
            throw bad_file(where + ": aspectRatio must be positive, not " + std::to_string(out.aspect));
        const json &lens = in[in["type"].get_ref<const std::string &>()];
        const bool has_aspect = out.type == EC_CAMERA_PERSPECTIVE && lens.contains("aspectRatio");
        if (has_aspect && !(out.aspect >= 1 / widest_aspect && out.aspect <= widest_aspect)) {
            ec_warn(log, "%s: %s: aspectRatio %g is out of range; it is ignored", gltf->path, where.c_str(), double(out.aspect));
            out.aspect = 0;
        }
        if (out.type == EC_CAMERA_ORTHOGRAPHIC && !(out.xmag > 0 && out.ymag > 0))
            throw bad_file(where + ": xmag and ymag must not be zero");
    });
}

static const double half_pi = 1.57079632679489662, quarter_pi = 0.7853981634; /* rounded as in tinygltf, so that pictures do not change */

/* Sets colour, intensity and cone of a light. Colours over 1 are harmless; intensities that overflow floats are not, and are reported by odd. */
static void set_light(const json &in, ec_light &out, bool &odd)
{
    const std::string &type = in["type"].get_ref<const std::string &>();
    double intensity = in.value("intensity", 1.0), range = in.value("range", 0.0), inner = 0, outer = quarter_pi;
    out.type = type == "spot" ? EC_LIGHT_SPOT : type == "point" ? EC_LIGHT_POINT : EC_LIGHT_DIRECTIONAL;
    odd = intensity < 0 || intensity > double(EC_RADIANCE_MOST) || range < 0;
    for (size_t i = 0; i < 3; i++) {
        double color = element(in, "color", i, 1);
        odd = odd || color < 0;
        out.intensity[i] = float(std::min(std::max(color * intensity, 0.0), double(EC_RADIANCE_MOST)));
    }
    if (out.type == EC_LIGHT_SPOT && in.contains("spot")) {
        inner = in["spot"].value("innerConeAngle", inner);
        outer = in["spot"].value("outerConeAngle", outer);
        odd = odd || !(inner >= 0 && inner <= outer && outer <= half_pi + 1e-6);
    }
    out.range = float(std::max(range, 0.0));
    outer = std::min(std::max(outer, 0.0), half_pi);
    out.cos_outer = float(std::cos(outer));
    out.cos_inner = float(std::cos(std::min(std::max(inner, 0.0), outer)));
}

void convert_lights(const json &root, ec_gltf *gltf, const ec_log *log)
{
    const json *extension = find_extension(root, "KHR_lights_punctual");
    if (!extension) return;
    convert_list((*extension)["lights"], gltf->lights, gltf->light_count, [&](const json &in, ec_light &out) {
        bool odd;
        const uint32_t index = gltf->light_count - 1;
        set_light(in, out, odd);
        if (odd) ec_warn(log, "%s: light %u has values out of KHR_lights_punctual's range; they are clamped", gltf->path, index);
        if (in.value("range", 1.0) == 0)
            ec_warn(log, "%s: light %u has range 0, which KHR_lights_punctual does not allow; it is taken as infinite", gltf->path, index);
    });
}

} // namespace eclat
