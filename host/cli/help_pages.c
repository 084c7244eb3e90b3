/* The texts of help that are not of an option. */
#include "cli/cli.h"
#include "cli/cost_request.h"
#include "cli/help.h"
#include "jobs/defaults.h"

static ec_result set_man(void *target, const char *option, const char *value, ec_error *err)
{
    (void)option, (void)value, (void)err;
    *(bool *)target = true;
    return EC_OK;
}

int ec_help_command_rows(ec_option *rows)
{
    rows[0] = (ec_option){.name = "man", .set = set_man, .help = "print the man page, as in eclat help --man | man -l -"};
    return 1;
}

#define LIMITS "When to stop: at the first limit that is reached (default: --spp " EC_TEXT(EC_DEFAULT_SPP) ")"
#define RESUME "Resume and distribute"
#define COST_UNIT "16" /* EC_COST_UNIT, which is an enumerator */

const char *const ec_group_titles[EC_GROUP_COUNT] = {
    [EC_GROUP_OPTIONS] = "Options",
    [EC_GROUP_STUDY] = "Study",
    [EC_GROUP_SCENE] = "Scene",
    [EC_GROUP_PICTURE] = "Picture",
    [EC_GROUP_LIMITS] = LIMITS,
    [EC_GROUP_ANIMATION] = "Animation: one picture per frame; limits apply to each",
    [EC_GROUP_RESUME] = RESUME,
    [EC_GROUP_TRANSPORT] = "Light transport",
    [EC_GROUP_DEVICE] = "Device",
    [EC_GROUP_MEASURE] = "Reproduce and measure",
    [EC_GROUP_RESULTS] = "Results: a table on standard output, and on request",
    [EC_GROUP_MESSAGES] = "Messages",
};

const char *const ec_shell_names[] = {"bash", "zsh", NULL};
static const char *const command_names[] = {"compare", "completion", "cost", "devices", "help", "info", "merge", "render", "selftest", "view", NULL};

static const ec_help_note of_main[] = {
    {"Exit code", "0", "success"},
    {"Exit code", "1", "failure; or compare found a difference, or a case of selftest failed"},
    {"Exit code", "2", "the command line is wrong"},
    {"Environment", "ECLAT_DEVICE", "OpenCL device to use where --device is not given"},
    {"Environment", "ECLAT_COMPILE", "when to compile kernels where --compile is not given"},
    {"Environment", "XDG_CACHE_HOME", "compiled kernels are kept in eclat/kernels below this folder (default: ~/.cache)"},
    {0}};

static const ec_help_note of_compare[] = {
    {"Exit code", "0", "the images are equal, or differ no more than noise makes two renders of one scene differ"},
    {"Exit code", "1",
     "they differ by more than noise, as at most 1 pair in 100 does by chance; where neither image has standard errors, a pixel differs by more than "
     "rounding (1e-5, or 1e-3 for half floats). Or they could not be compared: then there is an error message and nothing on standard output"},
    {"Exit code", "2", "the command line is wrong"},
    {0}};

static const ec_help_note of_cost[] = {
    {"Study", "Ctrl-C", "stop cleanly and report what is known so far (exit code 0); a second one aborts"},
    {"Columns", "ns/sample", "nanoseconds of rendering per sample of one pixel, set-up excluded"},
    {"Columns", "time", "the same as a multiple of the first row's; the two are rendered in turns"},
    {"Columns", "slope", "slope of error over samples, both as logarithms; -0.50 where samples are independent"},
    {"Columns", "variance", "variance of one sample, relative to the squared mean luminance, in pictures of " COST_UNIT " samples per pixel"},
    {"Columns", "bias",
     "the error that remains with unlimited samples. floor: it is certain; <: an upper bound; same bits: the picture equals the first row's; lacks: an "
     "unbiased rung that has not met rare light yet, so that its other figures are too good"},
    {"Columns", "efficiency", "1 / (squared error x seconds) of a picture of " COST_UNIT " samples per pixel"},
    {"Columns", "to 5 % ...", "time until the error is below this. ~: extrapolated; ?: unknown; never: this is below the floor"},
    {"Columns", "memory", "peak device memory"},
    {0}};

static const ec_help_note of_devices[] = {
    {"Environment", "ECLAT_DEVICE", "the default device: its number or part of its name"},
    {"Columns", "units", "compute units: cores or multiprocessors that work in parallel"},
    {"Columns", "lanes", "native vector width in floats, which --lanes auto uses"},
    {"Columns", "max alloc", "largest single buffer"},
    {"Columns", "exact div", "division and square root are correctly rounded"},
    {"Columns", "denormals, fma", "single-precision denormals; fused multiply-add in hardware"},
    {0}};

static const ec_help_note of_render[] = {
    {LIMITS, "Ctrl-C", "stop cleanly and write the image so far (exit code 0); a second one aborts"},
    {RESUME, "mpirun -n N eclat ...", "render one picture with several processes, one per machine (if eclat was built with MPI)"},
    {0}};

static const ec_help_note of_selftest[] = {
    {"Columns", "expected", "the value from a closed form or from double precision; the measured one must lie within the tolerance of it"},
    {"Columns", "tolerance", "from the number of rounded operations, or four standard errors of what is sampled"},
    {"Columns", "digits",
     "correct decimal digits, of the 7.2 that a float has; of sampled values, those that noise does not hide; of counts (expected: none), those of the number"},
    {0}};

static const ec_help_note none[] = {{0}};

const ec_help_page ec_help_main = {
    .name = "", .operands = "COMMAND [options]", .summary = "physically based rendering of glTF scenes with a stated error", .notes = of_main, .indent = 21,
    .intro = "eclat renders a glTF 2.0 scene to a physically based image with a stated error, on any OpenCL device.",
    .closing = "Results go to standard output; progress, warnings and errors go to standard error."};

const ec_help_page ec_help_pages[] = {
    {.name = "compare", .operands = "A.exr B.exr [options]", .summary = "test whether two images differ by more than noise", .rows = ec_compare_rows,
     .notes = of_compare, .indent = 21,
     .intro = "Measures how far image A is from the reference B: root-mean-square error relative to B's mean luminance (the quantity that a render's stated error "
              "estimates), RMSE, relMSE, MAPE and PSNR. If an image has standard errors (channels stderr.R, .G, .B), tests whether the two differ by more than "
              "noise: in the mean, in blocks of 8x8 pixels, in single values, and in the share of outliers. EXR files of other renderers are read too: R, G and "
              "B, float or half."},
    {.name = "completion", .operands = "bash|zsh", .summary = "print a completion script for a shell", .notes = none, .words = ec_shell_names, .indent = 21,
     .intro = "Prints a script that completes commands, options and their values. Where eclat is installed by a package, the scripts are in place. For one bash "
              "session: source <(eclat completion bash). For zsh: eclat completion zsh > _eclat, in a folder of $fpath."},
    {.name = "cost", .operands = "SCENE [options]", .summary = "measure which technique buys accuracy cheapest on a scene", .rows = ec_cost_rows, .notes = of_cost, .indent = 29,
     .intro = "Renders a glTF 2.0 scene with the defaults of eclat render, then again with one thing changed or left out: integrator, sampling, random numbers, "
              "roulette, multiple scattering at rough surfaces, a clamp, arithmetic, each effect of the scene, acceleration structure, lanes. For each of these "
              "rungs it prints time per sample, noise, bias against a reference, and the time to a given error.",
     .closing = "The best figures are bold, or have an asterisk where the output is not a terminal; rungs that leave something out do not compete."},
    {.name = "devices", .operands = "[options]", .summary = "list the OpenCL devices and mark the default", .rows = ec_devices_rows, .notes = of_devices, .indent = 21,
     .intro = "Lists every OpenCL device with the properties that matter here; * marks the one that a render uses by default."},
    {.name = "help", .operands = "[COMMAND]", .summary = "show the help of eclat or of a command; --man: the man page", .rows = ec_help_command_rows, .notes = none, .words = command_names,
     .indent = 21, .intro = "Shows the help of eclat, or that of one command."},
    {.name = "info", .operands = "SCENE [options]", .summary = "report what a scene contains and what rendering it takes", .rows = ec_info_rows, .notes = none, .indent = 29,
     .intro = "Reports what a glTF scene contains: geometry, materials, lights, cameras, extensions used and unsupported, the effects it calls for and why, the "
              "memory it takes, and the quality of its bounding-volume hierarchy.",
     .borrows = "Options of eclat render, to report what such a render shows and calls for"},
    {.name = "merge", .operands = "A.exr [B.exr ...] -o ALL.exr [options]", .summary = "combine slices that were rendered separately", .rows = ec_merge_rows,
     .notes = none, .indent = 21,
     .intro = "Combines slices that eclat render --samples wrote, or checkpoints, into one picture. In any order, the result has the same bits as a single render of "
              "all their samples. Slices of other scenes, options or versions, and slices with samples in common, are refused."},
    {.name = "render", .operands = "SCENE [options]", .summary = "render a scene to EXR and PNG", .rows = ec_render_command_rows, .notes = of_render, .indent = 29,
     .intro = "Renders a glTF 2.0 scene (.gltf or .glb) and states the error of the image."},
    {.name = "selftest", .operands = "[options]", .summary = "test a device and its driver on hard cases with known answers", .rows = ec_selftest_rows,
     .notes = of_selftest, .indent = 21,
     .intro = "Runs hard cases with known answers on a device, to show whether its pictures, with this driver, can be trusted. Prints a row for each, the worst "
              "first; the exit code is 1 if one fails."},
    {.name = "view", .operands = "SCENE [options]", .summary = "show a scene in a window while it renders", .rows = ec_view_rows, .notes = none, .indent = 29,
     .intro = "Opens a window that shows a glTF 2.0 scene as it renders: rasterised at once, then path traced, coarsely while the camera moves and ever finer once it "
              "rests. S saves what eclat render would have written and prints the command that renders the same picture again, bit for bit. When a file of the "
              "scene changes, it is loaded again.",
     .lacks = "All options of eclat render, except",
     .closing = "Limits (--spp, --error, --time) count from the moment the camera comes to rest; when one is reached, the window sleeps."},
};
const int ec_help_page_count = sizeof ec_help_pages / sizeof ec_help_pages[0];
