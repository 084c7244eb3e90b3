#include "cli/help.h"

#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "jobs/defaults.h"
#include "view/view.h"

#define EC_TEXT_COST_UNIT "16" /* EC_COST_UNIT, which is an enumerator */

/* Of each command that renders (scene_choice.h). */
/* shutter: what --shutter does, where there is one. */
#define EC_HELP_SCENE_CHOICE(shutter) \
    "Scene: what of the file is shown\n" \
    "      --animation NAME|INDEX which animation that moment is in, or all (default: the first)\n" \
    "      --at SECONDS           this moment of it; before its first and after its last key it stands still (default: the\n" \
    "                             scene as stored)\n" \
    "      --scene NAME|INDEX     this scene (default: the file's own choice)\n" \
    shutter \
    "      --variant NAME|INDEX   with the materials of this variant (KHR_materials_variants)\n"

const char EC_HELP_SHORT[] =
    "Usage: eclat render SCENE [options]   render a glTF scene to EXR and PNG\n"
    "       eclat cost SCENE [options]     measure what buys accuracy cheapest on it\n"
    "       eclat info SCENE               say what is in it\n"
    "       eclat compare A.exr B.exr      say whether two images differ by more than noise\n"
    "       eclat merge A.exr B.exr …      make one picture of slices rendered apart\n"
    "       eclat devices                  list the OpenCL devices\n"
    "       eclat selftest                 try a device with hard cases of known answers\n"
    "       eclat view SCENE [options]     look at a scene in a window while it renders\n"
    "       eclat --help                   say more\n";

static const char help_main[] =
    "Usage: eclat COMMAND [options]\n"
    "\n"
    "eclat turns a glTF 2.0 scene into a physically based image with a stated error, on any OpenCL device.\n"
    "\n"
    "Commands\n"
    "  compare A B        measure how far image A is from image B, and whether that is more than noise\n"
    "  cost SCENE         measure which technique buys accuracy cheapest on a scene\n"
    "  devices            list every OpenCL device and say which is the default\n"
    "  help [COMMAND]     show this, or the help of a command\n"
    "  info SCENE         say what a scene holds and what rendering it takes\n"
    "  merge A B …        make one picture of slices that were rendered apart\n"
    "  render SCENE       render a scene to EXR and PNG\n"
    "  selftest           try a device and its driver with hard cases whose answers are known\n"
    "  view SCENE         look at a scene in a window while it renders\n"
    "\n"
    "Options\n"
    "  -h, --help         show this\n"
    "      --version      show the version\n"
    "\n"
    "Results go to standard output; progress, warnings and errors to standard error.\n"
    "Exit code: 0 done, 1 failed (compare: or they differ; selftest: or a case failed), 2 the command line is wrong.\n"
    "\n"
    "Environment\n"
    "  ECLAT_DEVICE       OpenCL device, as for --device, where that is not given\n"
    "  XDG_CACHE_HOME     compiled kernels are kept in eclat/kernels below it (default: ~/.cache)\n";

static const char help_render[] =
    "Usage: eclat render SCENE [options]\n"
    "\n"
    "Renders a glTF 2.0 scene (.gltf or .glb) and states the image's error.\n"
    "\n"
    EC_HELP_SCENE_CHOICE("      --shutter A:B          all moments from A to B seconds instead of one: motion blur, in --integrator path\n")
    "\n"
    "Picture\n"
    "      --camera NAME|INDEX    look through this camera (default: the scene's first; without any, one that frames it)\n"
    "      --env FILE|R,G,B       light from all around: an equirectangular .hdr or .exr map, or one radiance\n"
    "                             (default: none; 1,1,1 where a scene has no light at all)\n"
    "      --env-rotate DEG       turn the environment by so many degrees, counter-clockwise seen from above (default: 0)\n"
    "      --env-strength S       make it S times as bright (default: 1)\n"
    "      --exposure EV          brighten the PNG by this many stops (default: 0)\n"
    "      --eye X,Y,Z            from this point, in the file's coordinates (default: the camera's)\n"
    "      --filter NAME          how samples make a pixel: box, those in it alike; blackman-harris, a smooth bell over its\n"
    "                             neighbours too, by importance sampling (default: box)\n"
    "      --filter-width W       pixels from centre to edge of blackman-harris, " EC_TEXT(EC_FILTER_WIDTH_LEAST) " to " EC_TEXT(EC_FILTER_WIDTH_MOST) " (default: 1.5)\n"
    "      --focus D              the distance in metres, along the camera's axis, at which a lens of --fstop is sharp\n"
    "      --fov DEG              angle from the picture's bottom to its top (default: the camera's)\n"
    "      --fstop N              a thin lens in place of a pinhole: its diameter is the focal length, that of a sensor 24 mm\n"
    "                             high and the camera's field of view, over N; goes with --focus (default: a pinhole)\n"
    "      --look-at X,Y,Z        towards this one (default: where the camera looks; with --eye the scene's middle)\n"
    "  -o, --output FILE          write FILE, an .exr (all data) or a .png; may be repeated\n"
    "                             (default: the scene's base name with .exr and .png, in the current directory)\n"
    "      --parallel M           parallel rays instead, M metres from bottom to top\n"
    "      --size WxH             pixels (default: " EC_TEXT(EC_DEFAULT_HEIGHT) " high, as wide as the camera's aspect ratio asks, else square)\n"
    "      --tonemap CURVE        neutral (Khronos PBR Neutral) or none, for the PNG (default: neutral)\n"
    "      --up X,Y,Z             which way is up (default: 0,1,0 with --eye or --look-at, else the camera's)\n"
    "\n"
    "When to stop: at whichever limit comes first (default: --spp " EC_TEXT(EC_DEFAULT_SPP) ")\n"
    "      --adaptive[=WHEN]      more samples where the first ones find more noise; N is then their mean. auto: with\n"
    "                             --error, where that gains 5 % (default); on, the same as --adaptive alone; off\n"
    "      --error PCT            when the 95 % bound of the image's error is under PCT per cent, as in 2 or 2%; it is looked\n"
    "                             at after 32, 64, 80, 96, 112, 128, 160 samples a pixel and so on, four times an octave\n"
    "      --spp N                after N samples a pixel (without it, --time and --error give up after " EC_TEXT(EC_SAFETY_SPP) ")\n"
    "      --time S               before S seconds of rendering; also 30s, 2m, 1h\n"
    "      Ctrl-C                 stops cleanly and writes the image so far (exit code 0); a second one aborts\n"
    "\n"
    "Animation: a picture for each of many moments; limits are those of each\n"
    "      --fps N                frame F is shown at F / N seconds of the animation, from which --shutter counts\n"
    "                             (default: " EC_TEXT(EC_DEFAULT_FPS) ")\n"
    "      --frames A:B[:STEP]    the frames from A to B, B included, or every STEP-th of them; or one, A. -o then has %d, or\n"
    "                             %04d for four digits, where the number goes (default: NAME.%04d.exr and .png). Frames\n"
    "                             that are there and of the same job are skipped\n"
    "      --overwrite            render frames again that are there and of another job, which are an error otherwise\n"
    "\n"
    "Going on and sharing out: every sample is the same whoever takes it when\n"
    "      --checkpoint FILE      write FILE.exr on the way, whole or not at all: a picture, and what --resume needs\n"
    "      --every S              so often (default: " EC_TEXT(EC_DEFAULT_EVERY) " seconds), and at the end, also after Ctrl-C\n"
    "      --plan RANKS           render no picture; measure a few batches here and print what 1 to RANKS processes of an\n"
    "                             MPI job would take, and why. RANKS,GBIT,US: with so many Gbit/s between two machines\n"
    "                             and so many microseconds a message (default: 10,50)\n"
    "      --resume FILE          go on from a checkpoint as if there had been no break; scene, options and limits are its\n"
    "                             own, but --spp, --time, --error (in all) and -o may be given anew; SCENE may be left out\n"
    "      --samples A:B          of the samples that --spp N takes in each pixel only those from A up to, not including, B:\n"
    "                             a slice, an .exr for eclat merge. Each begins and ends with a batch, as multiples of 64\n"
    "                             do, or with the job (default -o: NAME.A-B.exr)\n"
    "      mpirun -n N eclat ...  several processes, one a machine, render one picture (if eclat was built with MPI)\n"
    "\n"
    "Light transport\n"
    "      --clamp N              let the indirect light of one sample, over three segments or more, have at most N times the\n"
    "                             picture's mean luminance: fireflies go, and light with them; how much is missing is said,\n"
    "                             in all and a pixel (default: off)\n"
    "      --cutoff W             whitted: leave out branches that would add less than W of their light, 0 to 1\n"
    "                             (default: " EC_TEXT(EC_DEFAULT_CUTOFF) "; 0 follows all)\n"
    "      --integrator NAME      what makes the picture: path, the path tracer; and for comparison whitted, mirrored and\n"
    "                             refracted rays with hard shadows from the lights' centres; raster, direct light from\n"
    "                             there without shadows (default: path)\n"
    "      --light-choice NAME    which light a surface is joined to: power, bright ones more often; tree, also near ones\n"
    "                             that face it; the image is the same (default: auto, tree where they are apart)\n"
    "      --max-depth N          segments in a path: 1 emission, 2 direct light, inf (default: inf, ended by roulette;\n"
    "                             whitted: 10, at most 64)\n"
    "      --rr P                 roulette: survival probability at every surface, as in 0.8; auto, by throughput from the\n"
    "                             fifth segment on; off, with --max-depth N only (default: auto)\n"
    "      --sample NAME          what directions are sampled by: hemisphere (uniformly), bsdf, light, or mis for both of\n"
    "                             these; the image is the same, its noise is not (default: mis)\n"
    "      --sampler NAME         sobol (Owen-scrambled) or independent (default: sobol)\n"
    "      --scattering NAME      rough metal and glass: single, as glTF has it, which loses light; multiple, which gives\n"
    "                             back what facets reflect or pass on to one another (default: single)\n"
    "      --seed N               another N, another independent image; frame: with --frames the frame's number (default: 0)\n"
    "      --terminator NAME      where light grazes facets with vertex normals: geometric, they shade themselves; smooth,\n"
    "                             rays start on the smooth surface that is meant (default: geometric)\n"
    "\n"
    "Device\n"
    "      --device ID            OpenCL device: its number in `eclat devices`, or a part of its name; several: a list\n"
    "                             such as 0,2, or all\n"
    "                             (default: $ECLAT_DEVICE, else the first GPU, else the first CPU)\n"
    "      --lanes N              paths in one work-item: 1, 4, 8, 16 or auto; the image is the same (default: auto)\n"
    "      --memory SIZE          stay under this, as in 4G or 512M: a picture that does not fit is rendered in strips, one\n"
    "                             after the other, the image is the same; with --spp alone (default: what is free)\n"
    "\n"
    "Reproducing and measuring\n"
    "      --accel NAME           acceleration structure: auto, bvh8, bvh2, grid, kdtree, none or twolevel; the image is\n"
    "                             the same (default: auto, the faster of the BVHs; twolevel where meshes are kept once,\n"
    "                             which the others have written out)\n"
    "      --effects WHICH        needed, kernels for what the scene calls for; all, for every effect there is, also those\n"
    "                             that only an option asks for; the image is the same (default: needed)\n"
    "      --grid-density N       cells for every reference (triangle, or part of one) in --accel grid, " EC_TEXT(EC_GRID_DENSITY_LEAST) " to " EC_TEXT(EC_GRID_DENSITY_MOST) ";\n"
    "                             the image is the same (default: 27); fewer where these were more than 2^28 cells, or\n"
    "                             held more than 64 entries for every reference\n"
    "      --instancing WHEN      keep meshes that stand in many places once: auto, where that saves a million triangles and\n"
    "                             half of all; on, every one that stands in two; off (default: auto)\n"
    "      --replicates N         independent copies of the sample sequence, 1 to " EC_TEXT(EC_REPLICATES_MOST) ", whose spread is the error: fewer make\n"
    "                             less noise, and less sure of it; one alone knows no error (default: " EC_TEXT(EC_REPLICATES) ")\n"
    "      --wave N               paths in flight; the image is the same (default: fitted to the device)\n"
    "      --without EFFECT       leave an effect out that the scene calls for, by its name in eclat info: lights go out,\n"
    "                             textures and maps become their mean, layers go; may be repeated\n"
    "\n"
    "Messages\n"
    "  -h, --help                 show this\n"
    "      --json                 print one JSON object with everything measured instead of text\n"
    "  -q, --quiet                only warnings and errors (and what --json prints)\n"
    "  -v, --verbose              also what calls for each effect, and the kernels and buffers that it makes\n"
    "      --version              show the version\n";

static const char help_cost[] =
    "Usage: eclat cost SCENE [options]\n"
    "\n"
    "Renders a glTF 2.0 scene as eclat render does by default, and again with one thing changed or left out: integrator,\n"
    "sampling, random numbers, roulette, how often rough surfaces scatter, a clamp, arithmetic, each effect of the scene,\n"
    "accelerator, lanes. For each of these rungs it prints time per sample, noise, bias against a reference, and the time\n"
    "to a given error.\n"
    "\n"
    "Study\n"
    "      --budget S             time for all of it, the reference included; also 40s, 2m, 1h (default: 2m). A kernel that\n"
    "                             is being compiled at its end is finished. Compiled ones are kept for the next study\n"
    "      --reference FILE       compare with this .exr instead of a picture that is rendered first, for a third of the\n"
    "                             budget; its standard errors, if it has them, are taken for its uncertainty\n"
    "      --seed N               another N, another independent study (default: 0)\n"
    "      Ctrl-C                 stops cleanly and reports what is known so far (exit code 0); a second one aborts\n"
    "\n"
    EC_HELP_SCENE_CHOICE("")
    "\n"
    "Picture\n"
    "      --camera NAME|INDEX    look through this camera (default: the scene's first; without any, one that frames it)\n"
    "      --env FILE|R,G,B       light from all around, as for eclat render\n"
    "      --size WxH             pixels (default: the reference's, else " EC_TEXT(EC_COST_HEIGHT) " high, as wide as the camera's aspect ratio asks)\n"
    "\n"
    "Device\n"
    "      --device ID            OpenCL device (default: as for eclat render)\n"
    "\n"
    "Results: a table on standard output, and on request\n"
    "  -o, --output FILE          write FILE.html, one page with charts, tables and pictures that opens without a network\n"
    "      --json FILE            write every figure to FILE; - prints them instead of the table\n"
    "  -h, --help                 show this\n"
    "  -q, --quiet                only warnings and errors\n"
    "      --version              show the version\n"
    "\n"
    "Columns\n"
    "  ns/sample                  nanoseconds of rendering for one sample of one pixel, set-up left out\n"
    "  time                       the same as a multiple of the first row's, both rendered in turns\n"
    "  slope                      of error over samples, in logarithms; -0.50 where samples are independent\n"
    "  variance                   of one sample, relative to the mean luminance squared, in pictures of " EC_TEXT_COST_UNIT " samples\n"
    "  bias                       the error that remains with endless samples: floor, if it is certain; < its bound, if not;\n"
    "                             same bits: the picture is that of the first row; lacks: an unbiased rung that has not\n"
    "                             met rare light yet, so that its other figures are too good\n"
    "  efficiency                 1 / (squared error x seconds) of a picture of " EC_TEXT_COST_UNIT " samples a pixel\n"
    "  to 5 % ...                 time until the error is under this; ~ extrapolated, ? not known, never under the floor\n"
    "  memory                     of the device, at the peak\n"
    "Best in bold, or with an asterisk where the output is no terminal; rungs that leave something out do not compete.\n";

static const char help_info[] =
    "Usage: eclat info SCENE [options]\n"
    "\n"
    "Says what a glTF scene holds: geometry, materials, lights, cameras, extensions used and not supported, the effects it\n"
    "calls for and why, the memory it will take, and how good its bounding-volume hierarchy is.\n"
    "\n"
    "Options\n"
    "      --accel NAME   also build this acceleration structure (bvh2, bvh8, grid, kdtree, none, twolevel, or all),\n"
    "                     send rays through it, and say what both cost\n"
    "      --animation NAME|INDEX, --at SECONDS, --scene NAME|INDEX, --shutter A:B, --variant NAME|INDEX\n"
    "                     what of the file is shown, as for eclat render\n"
    "      --device ID    where the rays are traced (default: as for eclat render)\n"
    "      --effects WHICH, --env FILE|R,G,B, --env-rotate DEG, --env-strength S, --filter NAME, --filter-width W,\n"
    "      --focus D, --fstop N, --instancing WHEN, --integrator NAME, --light-choice NAME, --sample NAME, --sampler NAME,\n"
    "      --scattering NAME, --terminator NAME, --without EFFECT\n"
    "                     as for eclat render: what such a render calls for, and why\n"
    "      --grid-density N\n"
    "                     with --accel grid or all: cells for every reference, as for eclat render (default: 27)\n"
    "  -h, --help         show this\n"
    "      --json         print one JSON object instead of text\n"
    "  -q, --quiet        no notes; warnings and errors only, beside the result\n"
    "      --version      show the version\n";

static const char help_compare[] =
    "Usage: eclat compare A.exr B.exr [options]\n"
    "\n"
    "Measures how far image A is from the reference B: root-mean-square error relative to B's mean luminance (what a\n"
    "render's stated error estimates), RMSE, relMSE, MAPE, PSNR. Where an image has standard errors (channels stderr.R, .G,\n"
    ".B), tests whether the two differ by more than noise: in the mean, in blocks of 8x8 pixels, in single values, and in\n"
    "the share of outlying ones. Reads the EXR files of other renderers too: R, G and B, float or half.\n"
    "\n"
    "Options\n"
    "      --diff FILE    write a map of the error relative to B, a .png: black 0.1 % or less, pale yellow 100 % or more\n"
    "  -h, --help         show this\n"
    "      --json         print one JSON object instead of text\n"
    "  -q, --quiet        print nothing, for the exit code alone\n"
    "      --version      show the version\n"
    "\n"
    "Exit code\n"
    "  0                  equal, or no more different than noise makes two renders of one scene\n"
    "  1                  they differ by more than noise, as at most 1 pair in 100 does by chance; where neither has standard\n"
    "                     errors, they differ in a pixel by more than rounding (1e-5, or 1e-3 of half floats). Or they\n"
    "                     could not be compared: then there is an error message, and nothing on standard output\n"
    "  2                  the command line is wrong\n";

static const char help_merge[] =
    "Usage: eclat merge A.exr [B.exr …] -o ALL.exr [options]\n"
    "\n"
    "Makes one picture of slices that eclat render --samples wrote, or of checkpoints: in any order the same bits as one\n"
    "render of all their samples. Slices of other scenes, options or versions, or with samples in common, are refused.\n"
    "\n"
    "Options\n"
    "      --exposure EV  of the PNG, as for eclat render (default: 0)\n"
    "  -h, --help         show this\n"
    "      --json         print one JSON object instead of text\n"
    "  -o, --output FILE  write FILE, an .exr (all data, and sums: it may be merged again) or a .png; may be repeated\n"
    "      --partial      write the picture even where samples are missing\n"
    "  -q, --quiet        only warnings and errors\n"
    "      --tonemap CURVE\n"
    "                     of the PNG, as for eclat render (default: neutral)\n"
    "      --version      show the version\n";

static const char help_devices[] =
    "Usage: eclat devices [options]\n"
    "\n"
    "Lists every OpenCL device with what matters here; * marks the one that a render takes by default.\n"
    "\n"
    "Options\n"
    "  -h, --help         show this\n"
    "      --json         print one JSON object instead of a table\n"
    "      --version      show the version\n"
    "\n"
    "Environment\n"
    "  ECLAT_DEVICE       the default device: its number or a part of its name\n"
    "\n"
    "Columns\n"
    "  units              compute units: cores or multiprocessors that work at the same time\n"
    "  lanes              native vector width in floats, which --lanes auto takes\n"
    "  max alloc          largest single buffer\n"
    "  exact div          division and square root are correctly rounded\n"
    "  denormals, fma     single-precision denormals; fused multiply-add in hardware\n";

static const char help_selftest[] =
    "Usage: eclat selftest [options]\n"
    "\n"
    "Runs hard cases of known answers on a device: is a picture from it, with this driver, to be trusted? Prints a row for\n"
    "each, worst first, and ends with 1 if one fails.\n"
    "\n"
    "Options\n"
    "      --device ID    as for eclat render\n"
    "      --full         more rays and samples, every lane width and structure: some minutes on a processor\n"
    "  -h, --help         show this\n"
    "      --json         print one JSON object instead of a table\n"
    "      --lanes N      paths in one work-item: 1, 4, 8, 16 or auto\n"
    "      --only NAME    only the cases that have NAME in theirs\n"
    "  -q, --quiet        print failed rows only, and nothing if there are none\n"
    "      --version      show the version\n"
    "\n"
    "Columns\n"
    "  expected           from a closed form or from double precision; measured must come within the tolerance of it\n"
    "  tolerance          from the number of rounded operations, or four standard errors of what is sampled\n"
    "  digits             decimal digits that survived, of the 7.2 that a float has: of what is sampled those that its noise\n"
    "                     lets one see, of counts (expected: none) those of their number\n";

static const char help_view[] =
    "Usage: eclat view SCENE [options]\n"
    "\n"
    "Opens a window that shows a glTF 2.0 scene as it renders: rasterised at once, then by the path tracer, coarse while the\n"
    "camera moves and finer once it rests. S saves what eclat render would have written, and prints the command that makes\n"
    "the same picture again, bit for bit. When a file of the scene changes it is loaded again.\n"
    "\n"
    "Options: those of eclat render but --adaptive, --json, --memory, --plan, --verbose and those of checkpoints, slices\n"
    "and frames; and\n"
    "      --against FILE.exr     a picture to hold beside the one that is rendered (V and Tab)\n"
    "      --script FILE          moves the camera and presses keys by a script, then closes; orbit: once around. Lines:\n"
    "                             turn YAW PITCH SECONDS (degrees), pan RIGHT UP SECONDS (picture heights),\n"
    "                             dolly FACTOR SECONDS, wait SECONDS, settle (until the limit is met), key NAME\n"
    "                             (e, E, 1, Tab, Save, ...; after X digits switch effects), quit; 0 SECONDS: at once\n"
    "      --stats                at the end say when there was first light, and how long frames took while the camera moved\n"
    "  -h, --help                 show this\n"
    "      --size WxH             of the window at first (default: 600 high)\n"
    "      --version              show the version\n"
    "Limits (--spp, --error, --time) are counted from the moment that the camera rests; once one is met the window sleeps.\n";

void ec_print_help(const char *command)
{
    const char *text = help_main;
    if (!strcmp(command, "cost")) text = help_cost;
    if (!strcmp(command, "render")) text = help_render;
    if (!strcmp(command, "info")) text = help_info;
    if (!strcmp(command, "compare")) text = help_compare;
    if (!strcmp(command, "merge")) text = help_merge;
    if (!strcmp(command, "devices")) text = help_devices;
    if (!strcmp(command, "selftest")) text = help_selftest;
    if (!strcmp(command, "view")) text = help_view;
    fputs(text, stdout);
    const ec_view_module *window;
    if (text == help_view && ec_view_load(&window, NULL) == EC_OK) window->print_keys();
}

void ec_print_version(void)
{
    puts("eclat " ECLAT_VERSION);
}

bool ec_request_serve(ec_request request, const char *command)
{
    if (request == EC_REQUEST_HELP) ec_print_help(command);
    if (request == EC_REQUEST_VERSION) ec_print_version();
    return request != EC_REQUEST_RUN;
}
