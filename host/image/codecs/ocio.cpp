/* Applies views of OpenColorIO, and catches its exceptions. */
#include <OpenColorIO/OpenColorIO.h>

#include <cstring>
#include <string>

extern "C" {
#include "image/ocio.h"
}

namespace OCIO = OCIO_NAMESPACE;

struct ec_ocio {
    OCIO::ConstCPUProcessorRcPtr processor;
};

extern "C" const bool ec_has_ocio = true;

/* Names of linear Rec. 709 in the configs of ACES 1.2, of ACES 1.3 and 2, of Blender, and in the old ones of Sony Pictures. */
static const char *const linear_names[] = {"lin_rec709_scene", "lin_rec709", "lin_srgb", "Linear Rec.709 (sRGB)", "Linear Rec.709",
                                           "Utility - Linear - sRGB", "Utility - Linear - Rec.709", "Linear", "lnf"};

static std::string listed(int count, const char *(OCIO::Config::*name)(int) const, const OCIO::Config &config)
{
    std::string all;
    for (int i = 0; i < count && all.size() < 300; i++) all += (i ? ", " : "") + std::string((config.*name)(i));
    return all;
}

static bool has_display(const OCIO::Config &config, const char *display)
{
    for (int i = 0; i < config.getNumDisplays(); i++)
        if (!std::strcmp(config.getDisplay(i), display)) return true;
    return false;
}

static bool has_view(const OCIO::Config &config, const char *display, const char *view)
{
    for (int i = 0; i < config.getNumViews(display); i++)
        if (!std::strcmp(config.getView(display, i), view)) return true;
    return false;
}

static std::string views_of(const OCIO::Config &config, const char *display)
{
    std::string all;
    for (int i = 0; i < config.getNumViews(display) && all.size() < 300; i++) all += (i ? ", " : "") + std::string(config.getView(display, i));
    return all;
}

static const char *linear_of(const OCIO::Config &config)
{
    for (const char *name : linear_names)
        if (config.getColorSpace(name)) return name;
    return nullptr;
}

static ec_result make(const ec_ocio_choice *c, ec_ocio *ocio, ec_error *err)
{
    const OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(c->config);
    const char *display = c->display ? c->display : config->getDefaultDisplay();
    if (!has_display(*config, display))
        return ec_fail(err, "--ocio-display: '%.200s' has no display '%.100s'; it has %s", c->config, display, listed(config->getNumDisplays(), &OCIO::Config::getDisplay, *config).c_str());
    const char *view = c->view ? c->view : config->getDefaultView(display);
    if (!has_view(*config, display, view))
        return ec_fail(err, "--ocio-view: the display '%.100s' of '%.200s' has no view '%.100s'; it has %s", display, c->config, view, views_of(*config, display).c_str());
    const char *space = c->space ? c->space : linear_of(*config);
    if (!space)
        return ec_fail(err, "--ocio: '%.200s' has no colour space with a usual name for linear Rec. 709, which pictures are in; name that space with --ocio-space", c->config);
    if (!config->getColorSpace(space))
        return ec_fail(err, "--ocio-space: '%.200s' has no colour space '%.100s'; it has %s", c->config, space,
                       listed(config->getNumColorSpaces(), &OCIO::Config::getColorSpaceNameByIndex, *config).c_str());
    ocio->processor = config->getProcessor(space, display, view, OCIO::TRANSFORM_DIR_FORWARD)->getDefaultCPUProcessor();
    return EC_OK;
}

extern "C" ec_result ec_ocio_open(const ec_ocio_choice *choice, ec_ocio **made, ec_error *err)
{
    ec_ocio *ocio = new ec_ocio;
    ec_result result;
    *made = nullptr;
    OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
    try {
        result = make(choice, ocio, err);
    } catch (const std::exception &why) {
        std::string line = why.what();
        for (char &c : line)
            if (c == '\n') c = ' ';
        result = ec_fail(err, "--ocio '%.200s': %.400s", choice->config, line.c_str());
    }
    if (result == EC_OK) *made = ocio;
    else delete ocio;
    return result;
}

extern "C" void ec_ocio_show(const ec_ocio *ocio, float *rgb, uint64_t pixels)
{
    OCIO::PackedImageDesc image(rgb, (long)pixels, 1, 3);
    ocio->processor->apply(image);
}

extern "C" void ec_ocio_close(ec_ocio *ocio) { delete ocio; }
