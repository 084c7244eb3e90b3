#include "view/keys.h"

#include <string.h>

const ec_view_key ec_view_keys[] = {
    {{NULL}, EC_DO_NOTHING, "left drag", "orbit"},
    {{NULL}, EC_DO_NOTHING, "middle drag, shift left drag", "pan"},
    {{NULL}, EC_DO_NOTHING, "wheel, ctrl left drag", "dolly"},
    {{NULL}, EC_DO_NOTHING, "right drag", "look around"},
    {{NULL}, EC_DO_NOTHING, "W A S D, arrows, PgUp PgDn", "fly while held (a tap of S saves; shift: faster)"},
    {{NULL}, EC_DO_NOTHING, "left click", "select the node under the cursor, or nothing"},
    {{"f", "F"}, EC_DO_FRAME, "F", "frame the selection, else the node under the cursor, else all"},
    {{"c", "C"}, EC_DO_CAMERA, "C", "next camera of the scene"},
    {{"r", "R"}, EC_DO_RESET, "R", "reset camera, exposure, tone mapper and environment"},
    {{"1", NULL}, EC_DO_INTEGRATOR_PATH, "1", "path tracer"},
    {{"2", NULL}, EC_DO_INTEGRATOR_WHITTED, "2", "Whitted's ray trees"},
    {{"3", NULL}, EC_DO_INTEGRATOR_RASTER, "3", "rasteriser"},
    {{"4", NULL}, EC_DO_INTEGRATOR_LIGHT, "4", "paths from the lights alone"},
    {{"E", NULL}, EC_DO_BRIGHTER, "E", "a third of a stop brighter"},
    {{"e", NULL}, EC_DO_DARKER, "e", "a third of a stop darker"},
    {{"t", "T"}, EC_DO_TONEMAP, "T", "next tone mapper"},
    {{",", NULL}, EC_DO_ENV_LEFT, ",", "turn the environment by -5 degrees"},
    {{".", NULL}, EC_DO_ENV_RIGHT, ".", "turn the environment by 5 degrees"},
    {{"x", "X"}, EC_DO_EFFECTS, "X", "effects: list; then a digit switches one off or on, 0 shows more"},
    {{"v", "V"}, EC_DO_LAYOUT, "V", "one picture, wipe at the cursor, side by side"},
    {{"Tab", NULL}, EC_DO_SECOND, "Tab", "second picture: error, samples, another rung, --against"},
    {{"g", "G"}, EC_DO_RUNG, "G", "choose that rung"},
    {{"i", "I"}, EC_DO_LINES, "I", "lines over the picture: all, the first, none"},
    {{"m", "M"}, EC_DO_MORE, "M", "more: four times the samples, half the error, four times the time"},
    {{"n", "N"}, EC_DO_DENOISE, "N", "denoised where that is nearer to the truth, or not denoised; starts over"},
    {{"Save", NULL}, EC_DO_SAVE, "S", "save, and print the command that repeats the picture"},
    {{"F5", NULL}, EC_DO_RELOAD, "F5", "load the scene again (automatic when a file changes)"},
    {{"F11", NULL}, EC_DO_FULLSCREEN, "F11", "full screen, on the monitor that the window is on"},
    {{"h", "?"}, EC_DO_HELP, "H ?", "this help"},
    {{"Escape", "q"}, EC_DO_QUIT, "Q Esc", "close"},
};
const size_t ec_view_key_count = sizeof ec_view_keys / sizeof ec_view_keys[0];

ec_view_action ec_view_action_of(const char *name)
{
    if (!strcmp(name, "H")) name = "h";
    if (!strcmp(name, "Q")) name = "q";
    for (size_t i = 0; i < ec_view_key_count; i++)
        for (int k = 0; k < 2; k++)
            if (ec_view_keys[i].names[k] && !strcmp(ec_view_keys[i].names[k], name)) return ec_view_keys[i].action;
    return EC_DO_NOTHING;
}
