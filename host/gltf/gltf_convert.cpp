/* Images, and tinygltf's cameras and lights, to ours. Index ranges are known to be good. */
#include "gltf/gltf_shim.h"

#include <algorithm>
#include <cmath>

namespace eclat {

using nlohmann::json;

void convert_images(const json &list, ec_gltf *gltf)
{
    gltf->images = make_array<ec_gltf_image>(list.size());
    for (const json &in : list) {
        ec_gltf_image &out = gltf->images[gltf->image_count++];
        out.name = copy_string(in.value("name", ""));
        out.view = in.value("bufferView", -1);
        if (in.contains("uri")) out.uri = copy_bytes(in["uri"]);
    }
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
    for (size_t i = 0; i < 4; i++) out.rotation[i] = in.contains("rotation") ? in["rotation"][i].get<double>() : i == 3;
    out.size = in["specularImageSize"];
    double intensity = in.value("intensity", 1.0);
    out.intensity = std::min(std::max(intensity, 0.0), double(EC_RADIANCE_MOST));
    if (out.intensity != intensity)
        ec_warn(log, "%s: image-based light %d has intensity %g, which is taken as %g", gltf->path, out.index, intensity,
                out.intensity);
    out.used = true;
}

static const float widest_yfov = 3.0f; /* glTF only advises to stay below pi, where a picture has no plane */

void convert_cameras(const tinygltf::Model &model, ec_gltf *gltf, const ec_log *log)
{
    gltf->cameras = make_array<ec_camera>(model.cameras.size());
    for (const tinygltf::Camera &in : model.cameras) {
        ec_camera &out = gltf->cameras[gltf->camera_count++];
        out.type = in.type == "orthographic" ? EC_CAMERA_ORTHOGRAPHIC : EC_CAMERA_PERSPECTIVE;
        out.yfov = float(in.perspective.yfov);
        out.aspect = float(in.perspective.aspectRatio);
        out.xmag = float(std::fabs(in.orthographic.xmag));
        out.ymag = float(std::fabs(in.orthographic.ymag));
        out.name = copy_string(in.name);
        std::string where = "cameras[" + std::to_string(gltf->camera_count - 1) + "]";
        if (out.type == EC_CAMERA_PERSPECTIVE && !(out.yfov > 0))
            throw bad_file(where + ": yfov must be positive, not " + std::to_string(out.yfov));
        if (out.yfov > widest_yfov) {
            ec_warn(log, "%s: %s: yfov %g is taken as %g", gltf->path, where.c_str(), out.yfov, widest_yfov);
            out.yfov = widest_yfov;
        }
        if (out.type == EC_CAMERA_PERSPECTIVE && !(out.aspect >= 0))
            throw bad_file(where + ": aspectRatio must be positive, not " + std::to_string(out.aspect));
        if (out.type == EC_CAMERA_ORTHOGRAPHIC && !(out.xmag > 0 && out.ymag > 0))
            throw bad_file(where + ": xmag and ymag must not be zero");
    }
}

static const double half_pi = 1.57079632679489662;

/* Is it outside what KHR_lights_punctual allows? Colours over 1 do no harm, but intensities that floats
 * overflow by do. */
static bool is_odd(const tinygltf::Light &light)
{
    const tinygltf::SpotLight &spot = light.spot;
    bool colored = std::all_of(light.color.begin(), light.color.end(), [](double c) { return c >= 0; });
    bool cone = spot.innerConeAngle >= 0 && spot.innerConeAngle <= spot.outerConeAngle && spot.outerConeAngle <= half_pi + 1e-6;
    bool bright = light.intensity > double(EC_RADIANCE_MOST);
    return !colored || light.intensity < 0 || bright || light.range < 0 || (light.type == "spot" && !cone);
}

/* For tinygltf that is the same as none. */
static bool has_range_0(const json &root, uint32_t light)
{
    const json &in = (*find_extension(root, "KHR_lights_punctual"))["lights"][light];
    return in.value("range", 1.0) == 0;
}

void convert_lights(const tinygltf::Model &model, const json &root, ec_gltf *gltf, const ec_log *log)
{
    gltf->lights = make_array<ec_light>(model.lights.size());
    for (const tinygltf::Light &in : model.lights) {
        ec_light &out = gltf->lights[gltf->light_count++];
        out.type = in.type == "spot" ? EC_LIGHT_SPOT : in.type == "point" ? EC_LIGHT_POINT : EC_LIGHT_DIRECTIONAL;
        for (size_t i = 0; i < 3; i++) {
            double value = (in.color.size() == 3 ? in.color[i] : 1.0) * in.intensity;
            out.intensity[i] = float(std::min(std::max(value, 0.0), double(EC_RADIANCE_MOST)));
        }
        out.range = float(std::max(in.range, 0.0));
        double outer = std::min(std::max(in.spot.outerConeAngle, 0.0), half_pi);
        double inner = std::min(std::max(in.spot.innerConeAngle, 0.0), outer);
        out.cos_inner = float(std::cos(inner));
        out.cos_outer = float(std::cos(outer));
        if (is_odd(in))
            ec_warn(log, "%s: light %u has values out of KHR_lights_punctual's range; they are clamped", gltf->path, gltf->light_count - 1);
        if (has_range_0(root, gltf->light_count - 1))
            ec_warn(log, "%s: light %u has range 0, which KHR_lights_punctual does not allow; it is taken as endless", gltf->path,
                    gltf->light_count - 1);
    }
}

} // namespace eclat
