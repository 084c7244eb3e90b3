/* All options of `eclat render`: how each is read, how help describes it, and which commands take it. Help, completion, man page, refusals, commands
 * that borrow options, the library and frames' identities use these rows; report/settings.c has what reports say of the values. */
#include "accel/accel.h"
#include "film/denoiser.h"
#include "jobs/defaults.h"
#include "jobs/numbers.h"
#include "jobs/render_request.h"
#include "jobs/render_setters.h"
#include "jobs/option.h"
#include "report/names.h"

#define REQUEST ec_render_request

#define OF(integrator) (1u << EC_INTEGRATOR_##integrator)
#define PATHS OF(PATH)
#define PATHS_OR_LIGHT (OF(PATH) | OF(LIGHT))
#define TRACERS (PATHS_OR_LIGHT | OF(WHITTED))

#define LASTING "a window keeps no checkpoints and renders no slices"
#define MOVING "a window shows one moment"
#define MANY "a window shows one picture"
#define TALKING "a window reports to who looks at it"

const ec_option ec_render_rows[] = {
    /* Scene */
    {.name = "animation", .metavar = "NAME|INDEX", EC_STORED(TEXT, choice.animation), EC_TOLD(choice.animated), .group = EC_GROUP_SCENE,
     .uses = EC_OPTION_INFO | EC_OPTION_COST,
     .help = "animation to play, or all, which plays all of them at once", .otherwise = "the first"},
    {.name = "at", .metavar = "SECONDS", .set = ec_set_at, .group = EC_GROUP_SCENE, .uses = EC_OPTION_INFO | EC_OPTION_COST,
     .help = "show the animation at this time; before its first keyframe and after its last one the scene stands still",
     .otherwise = "the scene as stored"},
    {.name = "follow-links", EC_STORED(FLAG, choice.follow_links), .group = EC_GROUP_SCENE, .uses = EC_OPTION_INFO | EC_OPTION_COST | EC_OPTION_NO_IDENTITY,
     .help = "read buffers and images also through symbolic links that lead out of the scene's folder"},
    {.name = "point-size", .metavar = "PIXELS", EC_RANGED(REAL, choice.point_size, EC_POINT_SIZE_LEAST, EC_POINT_SIZE_MOST), .group = EC_GROUP_SCENE,
     .uses = EC_OPTION_INFO | EC_OPTION_COST,
     .help = "width of points and lines, in pixels of a picture " EC_TEXT(EC_DEFAULT_HEIGHT) " high, where the scene's first camera sees them", .otherwise = "1"},
    {.name = "scene", .metavar = "NAME|INDEX", EC_STORED(TEXT, choice.scene), .group = EC_GROUP_SCENE, .uses = EC_OPTION_INFO | EC_OPTION_COST,
     .help = "scene of the file to render", .otherwise = "the one the file names as its default"},
    {.name = "shutter", .metavar = "A:B", .set = ec_set_shutter, .group = EC_GROUP_SCENE, .integrators = PATHS_OR_LIGHT, .uses = EC_OPTION_INFO,
     .help = "keep the shutter open from A to B seconds, for motion blur; --integrator path or light"},
    {.name = "variant", .metavar = "NAME|INDEX", EC_STORED(TEXT, choice.variant), .group = EC_GROUP_SCENE, .uses = EC_OPTION_INFO | EC_OPTION_COST,
     .help = "material variant to use (KHR_materials_variants)"},

    /* Picture */
    {.name = "background", .metavar = "WHAT", .set = ec_set_background, .group = EC_GROUP_PICTURE,
     .help = "what the camera sees where no surface is: env, the environment; transparent, stored in the alpha of a .png or .exr; blur or blur:R, the environment "
             "blurred by R degrees, " EC_TEXT(EC_BLUR) " for blur alone; white, black or RRGGBB, an sRGB colour. Blur and colours appear only in files for the screen; "
             "lighting and reflections do not change",
     .otherwise = "env", .not_in_window = "a window shows the environment"},
    {.name = "camera", .metavar = "NAME|INDEX", EC_STORED(TEXT, camera), .group = EC_GROUP_PICTURE, .uses = EC_OPTION_CAMERA | EC_OPTION_COST,
     .help = "camera to look through", .otherwise = "the scene's first; if it has none, one that frames the whole scene"},
    {.name = "channels", .metavar = "LIST", .set = ec_set_channels, .group = EC_GROUP_PICTURE,
     .help = "channels of the EXR in addition to R, G and B, separated by commas: all, default, A, samples, stderr, low95 and high95 (the interval of each "
             "pixel), heavy, clamped, denoised, best, albedo, normal, depth, direct, indirect, position, uv, motion, cryptomatte (or a part of it: CryptoObject, "
             "CryptoMaterial, CryptoAsset), or a single channel of a layer, such as stderr.Y. Slices hold all of them; uv, position, motion and cryptomatte are "
             "written only if named",
     .otherwise = "A, samples, stderr, heavy; with --clamp, clamped; with --denoise, denoised and best"},
    {.name = "light-groups", .metavar = "LIST", EC_STORED(TEXT, light_groups), .group = EC_GROUP_PICTURE, .integrators = PATHS,
     .help = "layers of the EXR for the light of each group, which add up to the picture: names of lights' nodes, of materials that emit and environment, "
             "separated by commas; NAME=A+B puts several into one, all makes one group per light. Light of no group is in the layer rest. eclat mix changes their "
             "weights",
     .not_in_window = "a window shows the sum"},
    {.name = "denoise", .metavar = "WHEN", .value_optional = true, .set = ec_set_denoise, .choices = ec_denoiser_names, .group = EC_GROUP_PICTURE,
     .integrators = PATHS_OR_LIGHT, .uses = EC_OPTION_WINDOW,
     .help = "denoise the picture, and judge the denoiser: state the error of the denoised picture, and blend it with the noisy picture, tile by tile, in favour "
             "of the one with the smaller error. The PNG shows the blend, best; the EXR keeps R, G and B as they are and has denoised, best and denoised.stderr "
             "beside them. --error is then that of best. oidn uses Intel's Open Image Denoise; atrous uses eclat's own filter on the OpenCL device; auto (the "
             "same as --denoise alone) uses oidn if it is installed, otherwise atrous",
     .otherwise = "off"},
    {.name = "env", .metavar = "FILE|R,G,B", EC_STORED(TEXT, environment), .group = EC_GROUP_PICTURE,
     .uses = EC_OPTION_INFO | EC_OPTION_COST | EC_OPTION_NO_IDENTITY,
     .help = "environment light: an equirectangular .hdr or .exr map, a constant radiance, or a name that --light takes", .otherwise = "as --light"},
    {.name = "env-rotate", .metavar = "DEG", EC_RANGED(REAL, env_degrees, -36000, 36000), EC_TOLD(adjusts_env), .group = EC_GROUP_PICTURE,
     .uses = EC_OPTION_INFO | EC_OPTION_WINDOW,
     .help = "turn the environment by this many degrees, counter-clockwise as seen from above", .otherwise = "0"},
    {.name = "env-strength", .metavar = "S", EC_RANGED(REAL, env_strength, 0, 1e30), EC_TOLD(adjusts_env), .group = EC_GROUP_PICTURE,
     .uses = EC_OPTION_INFO,
     .help = "multiply the environment's radiance by S", .otherwise = "1"},
    {.name = "exposure", .metavar = "EV|auto", EC_RANGED(EXPOSURE, exposure, -EC_EXPOSURE_MOST, EC_EXPOSURE_MOST), .group = EC_GROUP_PICTURE,
     .uses = EC_OPTION_WINDOW,
     .help = EC_EXPOSURE_HELP, .otherwise = "0"},
    {.name = "eye", .metavar = "X,Y,Z", EC_STORED(TRIPLE, look.to.eye), EC_TOLD(look.has_eye), .group = EC_GROUP_PICTURE, .uses = EC_OPTION_CAMERA,
     .help = "position of the camera, in the file's coordinates", .otherwise = "the camera's own"},
    {.name = "filter", .metavar = "NAME", EC_CHOSEN(options.filter, ec_filter_names), .group = EC_GROUP_PICTURE, .integrators = TRACERS,
     .uses = EC_OPTION_INFO,
     .help = "pixel filter: box weights all samples within a pixel equally; blackman-harris is a smooth bell that reaches into neighbouring pixels, "
             "importance sampled",
     .otherwise = "box"},
    {.name = "filter-width", .metavar = "W", EC_RANGED(REAL, options.filter_width, EC_FILTER_WIDTH_LEAST, EC_FILTER_WIDTH_MOST), .group = EC_GROUP_PICTURE,
     .integrators = TRACERS, .uses = EC_OPTION_INFO,
     .help = "radius of the blackman-harris filter in pixels, " EC_TEXT(EC_FILTER_WIDTH_LEAST) " to " EC_TEXT(EC_FILTER_WIDTH_MOST),
     .otherwise = "1.5"},
    {.name = "focus", .metavar = "D", EC_RANGED(REAL, options.focus, EC_FOCUS_LEAST, EC_FOCUS_MOST), .group = EC_GROUP_PICTURE, .integrators = TRACERS,
     .uses = EC_OPTION_INFO,
     .help = "focus distance of the lens in metres, along the camera's axis; requires --fstop"},
    {.name = "fov", .metavar = "DEG", .set = ec_set_fov, .group = EC_GROUP_PICTURE, .uses = EC_OPTION_CAMERA,
     .help = "vertical field of view in degrees", .otherwise = "the camera's own"},
    {.name = "fstop", .metavar = "N", EC_RANGED(REAL, options.fstop, EC_FSTOP_LEAST, EC_FSTOP_MOST), .group = EC_GROUP_PICTURE, .integrators = TRACERS,
     .uses = EC_OPTION_INFO,
     .help = "render with a thin lens instead of a pinhole; the diameter of its aperture is its focal length divided by N, for a sensor 24 mm high and the "
             "camera's field of view; requires --focus",
     .otherwise = "a pinhole"},
    {.name = "ground", .metavar = "KIND", .value_optional = true, .set = ec_set_ground, .choices = ec_ground_names, .group = EC_GROUP_PICTURE,
     .help = "lay a ground under the scene, at its lowest point: matte (the same as --ground alone), a grey floor; shadow, an invisible ground that shows only "
             "the shadows on it, stored in the alpha of a .png or .exr (requires --background)",
     .otherwise = "none", .not_in_window = "a window shows the scene as it is"},
    {.name = "light", .metavar = "NAME|FILE", EC_STORED(TEXT, environment), .group = EC_GROUP_PICTURE,
     .uses = EC_OPTION_INFO | EC_OPTION_COST | EC_OPTION_NO_IDENTITY,
     .help = "the same as --env. studio: grey walls and soft boxes around a subject that faces +z; sky:AZ,EL: a clear sky with its sun AZ degrees from +z "
             "towards +x and EL degrees above the horizon, 0 to 90",
     .otherwise = "none; studio if the scene has no light at all"},
    {.name = "look-at", .metavar = "X,Y,Z", EC_STORED(TRIPLE, look.to.target), EC_TOLD(look.has_target), .group = EC_GROUP_PICTURE,
     .uses = EC_OPTION_CAMERA,
     .help = "point the camera at this position", .otherwise = "where the camera looks; with --eye, the centre of the scene"},
    {.name = "output", .letter = 'o', .metavar = "FILE", EC_STORED(OUTPUT, outputs), .group = EC_GROUP_PICTURE,
     .uses = EC_OPTION_WINDOW | EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE | EC_OPTION_REPEATS | EC_OPTION_OUTPUT,
     .help = "write FILE: an .exr (linear, with errors: --channels), a .png, .jpg, .avif or .jxl for the screen, or an .hdr (linear); may be repeated. {name} "
             "stands for the scene's base name, {folder} for the name of its folder; with several scenes, use one of them",
     .otherwise = "the scene's base name with .exr and with .png, in the current directory"},
    {.name = "ocio", .metavar = "CONFIG", EC_STORED(TEXT, ocio.config), .group = EC_GROUP_PICTURE, .uses = EC_OPTION_NO_IDENTITY,
     .help = "convert pictures for the screen with a view of this OpenColorIO config, a file or a built-in one such as ocio://default, instead of --tonemap; "
             "requires a build with OpenColorIO"},
    {.name = "ocio-display", .metavar = "NAME", EC_STORED(TEXT, ocio.display), .group = EC_GROUP_PICTURE,
     .help = "display of that config", .otherwise = "the first"},
    {.name = "ocio-space", .metavar = "NAME", EC_STORED(TEXT, ocio.space), .group = EC_GROUP_PICTURE,
     .help = "the config's colour space of linear Rec. 709, in which pictures are", .otherwise = "the one with a usual name of that space"},
    {.name = "ocio-view", .metavar = "NAME", EC_STORED(TEXT, ocio.view), .group = EC_GROUP_PICTURE,
     .help = "view of that display", .otherwise = "the display's first"},
    {.name = "parallel", .metavar = "M", .set = ec_set_parallel, .group = EC_GROUP_PICTURE, .uses = EC_OPTION_CAMERA,
     .help = "orthographic projection; the picture is M metres high"},
    {.name = "png-depth", .metavar = "BITS", EC_CHOSEN(png_depth, ec_png_depths), .group = EC_GROUP_PICTURE,
     .help = "bits of each channel of a .png or .jxl: 8 or 16", .otherwise = "8"},
    {.name = "screen-window", .metavar = "L,R,B,T", .set = ec_set_screen_window, .group = EC_GROUP_PICTURE, .uses = EC_OPTION_INFO,
     .help = "show the part between left, right, bottom and top of the camera's image plane, where 0,0 is the axis and 1 is half the height of the view. For lens "
             "shift, crops, and pixels that are not square",
     .otherwise = "-A,A,-1,1 for a picture A times as wide as high"},
    {.name = "size", .metavar = "WxH", EC_STORED(SIZE, options.width), EC_TOLD(has_size), .group = EC_GROUP_PICTURE, .uses = EC_OPTION_WINDOW,
     .help = "width and height in pixels", .otherwise = EC_TEXT(EC_DEFAULT_HEIGHT) " high, and as wide as the camera's aspect ratio requires; square without one"},
    {.name = "tonemap", .metavar = "CURVE", EC_CHOSEN(tonemap, ec_tonemap_names), .group = EC_GROUP_PICTURE, .uses = EC_OPTION_WINDOW,
     .help = EC_TONE_CURVES_HELP, .otherwise = "neutral"},
    {.name = "up", .metavar = "X,Y,Z", .set = ec_set_up, .group = EC_GROUP_PICTURE, .uses = EC_OPTION_CAMERA,
     .help = "up direction of the camera", .otherwise = "0,1,0 with --eye or --look-at, else the camera's own"},

    /* When to stop */
    {.name = "adaptive", .metavar = "WHEN", .value_optional = true, .set = ec_set_adaptive, .group = EC_GROUP_LIMITS, .choices = ec_adaptive_names,
     .help = "take more samples where the first ones show more noise; the N of --spp is then the mean over all pixels. auto does so with --error where it "
             "saves at least 5 %; on, like --adaptive alone, always does; off never",
     .otherwise = "auto", .not_in_window = "a window takes as many samples in every pixel"},
    {.name = "error", .metavar = "PCT", EC_STORED(PERCENT, options.error_target), .group = EC_GROUP_LIMITS, .uses = EC_OPTION_WINDOW | EC_OPTION_LIMIT,
     .help = "stop when the 95 % bound of the image's error is below PCT per cent, as in 2 or 2%; the bound is checked after 32, 64, 80, 96, 112, 128, 160 "
             "samples per pixel and so on, four times per octave"},
    {.name = "spp", .metavar = "N", EC_RANGED(U32, options.spp, 1, EC_MAX_SPP), .group = EC_GROUP_LIMITS, .uses = EC_OPTION_WINDOW | EC_OPTION_LIMIT,
     .help = "stop after N samples per pixel; without this option, --time and --error give up after " EC_TEXT(EC_SAFETY_SPP)},
    {.name = "time", .metavar = "S", EC_STORED(SECONDS, options.time_limit), .group = EC_GROUP_LIMITS, .uses = EC_OPTION_WINDOW | EC_OPTION_LIMIT,
     .help = "stop before S seconds of rendering have passed; 30s, 2m and 1h are understood too"},

    /* Animation */
    {.name = "fps", .metavar = "N", EC_RANGED(REAL, frames.fps, EC_FPS_LEAST, EC_FPS_MOST), .group = EC_GROUP_ANIMATION, .uses = EC_OPTION_NO_IDENTITY,
     .help = "frames per second: frame F shows the animation at F / N seconds, and --shutter counts from there", .otherwise = EC_TEXT(EC_DEFAULT_FPS),
     .not_in_window = MOVING},
    {.name = "frames", .metavar = "A:B[:STEP]", .set = ec_set_frames, .group = EC_GROUP_ANIMATION,
     .uses = EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE | EC_OPTION_PART,
     .help = "render frames A to B, B included, or every STEP-th of them; A alone renders one. -o then contains %d, or %04d for four digits, in place of the "
             "frame number (default: NAME.%04d.exr and .png). Frames of the same job that already exist are skipped",
     .not_in_window = MOVING},
    {.name = "orbit", .metavar = "N", EC_RANGED(U32, orbit, 1, EC_FRAME_MOST), .group = EC_GROUP_ANIMATION, .uses = EC_OPTION_NO_IDENTITY | EC_OPTION_PART,
     .help = "turntable: frames 0 to N-1, in which the camera circles the scene once, moving to its right, about --up (0,1,0) through --look-at (the centre of "
             "the scene). Animations stand still, unless --fps is given; --frames renders some of the frames",
     .not_in_window = MOVING},
    {.name = "overwrite", EC_STORED(FLAG, overwrite), .group = EC_GROUP_ANIMATION, .uses = EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE,
     .help = "replace existing frames of a different job; without this option they are an error", .not_in_window = MOVING},

    /* Several pictures */
    {.name = "out", .metavar = "FOLDER", EC_STORED(TEXT, folder), .group = EC_GROUP_SERIES, .uses = EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE | EC_OPTION_PART,
     .help = "with --scenarios: write NAME.exr and NAME.png of each scenario into FOLDER, which is created, and index.html and index.png, which show all pictures "
             "with their errors", .not_in_window = MANY},
    {.name = "scenarios", .metavar = "FILE", EC_STORED(TEXT, scenarios), .group = EC_GROUP_SERIES,
     .uses = EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE | EC_OPTION_PART,
     .help = "render the scenarios of FILE in place of a SCENE: models, cameras, light, size and tone curve, as in the config.json of <model-viewer>'s and Khronos' "
             "fidelity tests. Options given here replace a scenario's", .not_in_window = MANY},
    {.name = "shard", .metavar = "I/N", .set = ec_set_shard, .group = EC_GROUP_SERIES, .uses = EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE | EC_OPTION_PART,
     .help = "render only every N-th picture, from the I-th on, e.g. 3/8; used to divide the work among N machines", .not_in_window = MANY},
    {.name = "sheet", .metavar = "FILE", EC_STORED(FILE, sheet), .ending = ".png", .group = EC_GROUP_SERIES,
     .uses = EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE | EC_OPTION_PART,
     .help = "write a contact sheet, a .png with small versions of all pictures in order from the top left; also for --frames", .not_in_window = MANY},

    /* Resume and distribute */
    {.name = "checkpoint", .metavar = "FILE", EC_STORED(FILE, checkpoint), .ending = ".exr", .group = EC_GROUP_RESUME, .uses = EC_OPTION_KEEPING,
     .help = "write FILE, an .exr, at intervals, atomically; it is a picture and holds all that --resume needs", .not_in_window = LASTING},
    {.name = "every", .metavar = "S", EC_STORED(SECONDS, every), .group = EC_GROUP_RESUME, .uses = EC_OPTION_KEEPING,
     .help = "seconds between checkpoints, or snapshots; one is also written at the end, and after Ctrl-C", .otherwise = EC_TEXT(EC_DEFAULT_EVERY), .not_in_window = LASTING},
    {.name = "plan", .metavar = "RANKS", .set = ec_set_plan, .group = EC_GROUP_RESUME,
     .help = "measure a few batches, predict how long 1 to RANKS processes of an MPI job would take, and print why; renders no picture. RANKS,GBIT,US "
             "assumes GBIT Gbit/s between two machines and US microseconds per message (default: 10,50)",
     .not_in_window = "a window is one process"},
    {.name = "resume", .metavar = "FILE", EC_STORED(TEXT, resume), .group = EC_GROUP_RESUME, .uses = EC_OPTION_PART | EC_OPTION_KEEPING,
     .help = "continue from a checkpoint as if the render had never stopped. Scene, options and limits come from the checkpoint; only --spp, --time, "
             "--error (each for the whole render) and -o may be given anew. SCENE may be left out",
     .not_in_window = LASTING},
    {.name = "samples", .metavar = "A:B", .set = ec_set_samples, .group = EC_GROUP_RESUME, .uses = EC_OPTION_PART,
     .help = "render a slice for eclat merge: of the N samples per pixel of --spp, only those from A up to but not including B, into an .exr. A slice "
             "begins and ends with a batch, as multiples of 64 do, or ends with the job (default -o: NAME.A-B.exr)",
     .not_in_window = LASTING},
    {.name = "snapshot", .metavar = "FILE", EC_STORED(FILE, snapshot), .ending = ".exr", .group = EC_GROUP_RESUME, .uses = EC_OPTION_KEEPING,
     .help = "write the picture so far to FILE, an .exr, every --every seconds, atomically: to be looked at while the render goes on, with its error",
     .not_in_window = "a window shows the picture while it renders"},

    /* Light transport */
    {.name = "clamp", .metavar = "N", EC_RANGED(REAL, options.clamp, EC_CLAMP_LEAST, EC_CLAMP_MOST), .group = EC_GROUP_TRANSPORT, .integrators = PATHS,
     .help = "limit the indirect light of a sample (paths of three or more segments) to N times the picture's mean luminance. This removes fireflies, and "
             "light with them; the report states how much is missing, in all and per pixel",
     .otherwise = "off"},
    {.name = "cutoff", .metavar = "W", EC_RANGED(REAL, options.cutoff, 0, 1), .group = EC_GROUP_TRANSPORT, .integrators = OF(WHITTED),
     .help = "whitted only: drop branches whose weight is below W, 0 to 1; 0 follows all", .otherwise = EC_TEXT(EC_DEFAULT_CUTOFF)},
    {.name = "fog", .metavar = "D,A,G", .set = ec_set_fog, .group = EC_GROUP_TRANSPORT, .integrators = PATHS, .uses = EC_OPTION_INFO,
     .help = "fill the scene's bounding sphere, outside of its bodies, with fog. D: extinction per metre; A: scattering albedo, 0 to 1; G: mean cosine of the "
             "scattering angle, -0.999 (back) to 0.999 (forward). For example 0.05,0.9,0.6"},
    {.name = "integrator", .metavar = "NAME", EC_CHOSEN(options.integrator, ec_integrator_names), .group = EC_GROUP_TRANSPORT,
     .uses = EC_OPTION_INFO | EC_OPTION_WINDOW,
     .help = "path is the path tracer. For comparison, light traces paths from the lights only: it finds caustics quickly, but nothing seen in mirrors or through "
             "glass; whitted traces mirrored and refracted rays, with hard shadows from the centres of lights; raster draws direct light from these centres "
             "without shadows",
     .otherwise = "path"},
    {.name = "light-choice", .metavar = "NAME", EC_CHOSEN(options.light_choice, ec_light_choice_names), .group = EC_GROUP_TRANSPORT,
     .integrators = PATHS, .uses = EC_OPTION_INFO,
     .help = "how a surface picks a light to sample: power prefers bright lights; tree also those that are near and face it; auto chooses tree if lights are far "
             "apart. The image is the same",
     .otherwise = "auto"},
    {.name = "max-depth", .metavar = "N", .set = ec_set_max_depth, .group = EC_GROUP_TRANSPORT, .integrators = TRACERS,
     .help = "maximum number of segments in a path: 1 shows emission alone, 2 adds direct light; or inf", .otherwise = "inf, ended by roulette; whitted: 10, at most 64"},
    {.name = "light-paths", .metavar = "N", .set = ec_set_light_paths, .group = EC_GROUP_TRANSPORT, .integrators = PATHS_OR_LIGHT,
     .uses = EC_OPTION_INFO,
     .help = "trace N paths from the lights for each path from the camera, towards what bends or mirrors light sharply, and weigh what both find: caustics "
             "converge many times sooner. auto estimates the best number from a few paths traced first; it may choose none, and turns on --guiding if caustics "
             "are rarely found. Only with --sample mis, and without --clamp",
     .otherwise = "auto; with --integrator light 1"},
    {.name = "guiding", EC_STORED(FLAG, options.guiding), .group = EC_GROUP_TRANSPORT, .integrators = PATHS, .uses = EC_OPTION_INFO,
     .help = "path guiding: learn from light paths where light arrives, if something refracts or mirrors it sharply, and sample those directions too: caustics, "
             "also those seen in mirrors and through glass, converge sooner. Only with --sample mis"},
    {.name = "rr", .metavar = "P", .set = ec_set_rr, .group = EC_GROUP_TRANSPORT, .integrators = PATHS_OR_LIGHT,
     .help = "Russian roulette: a survival probability at every surface, such as 0.8; auto, by the throughput after three segments; or off, which requires "
             "--max-depth N",
     .otherwise = "auto"},
    {.name = "sample", .metavar = "NAME", EC_CHOSEN(options.sample, ec_sample_names), .group = EC_GROUP_TRANSPORT, .integrators = PATHS,
     .uses = EC_OPTION_INFO,
     .help = "how directions are sampled: hemisphere (uniformly), bsdf, light, or mis, which combines bsdf and light. The image is the same, its noise is not",
     .otherwise = "mis"},
    {.name = "sampler", .metavar = "NAME", EC_CHOSEN(options.sampler, ec_sampler_names), .group = EC_GROUP_TRANSPORT, .uses = EC_OPTION_INFO,
     .help = "random numbers: sobol (Owen-scrambled) or independent", .otherwise = "sobol"},
    {.name = "scattering", .metavar = "NAME", EC_CHOSEN(options.scattering, ec_scattering_names), .group = EC_GROUP_TRANSPORT, .integrators = PATHS_OR_LIGHT,
     .uses = EC_OPTION_INFO,
     .help = "rough metal and glass: single scattering, as glTF defines it, loses light; multiple adds the light that facets reflect or transmit to one another",
     .otherwise = "single"},
    {.name = "seed", .metavar = "N", .set = ec_set_seed, .group = EC_GROUP_TRANSPORT,
     .help = "seed of the random numbers; another N gives another, independent image. With --frames, frame takes the frame number", .otherwise = "0"},
    {.name = "terminator", .metavar = "NAME", EC_CHOSEN(options.terminator, ec_terminator_names), .group = EC_GROUP_TRANSPORT, .integrators = PATHS,
     .uses = EC_OPTION_INFO,
     .help = "shadows where light grazes facets with vertex normals: geometric lets facets shadow themselves; smooth starts rays on the smooth surface that "
             "the normals describe",
     .otherwise = "geometric"},

    /* Device */
    {.name = "device", .metavar = "ID", EC_STORED(TEXT, device), .group = EC_GROUP_DEVICE, .uses = EC_OPTION_INFO | EC_OPTION_COST | EC_OPTION_NO_IDENTITY,
     .help = "OpenCL device: its number in eclat devices, or part of its name; for several, a list such as 0,2, or all; a device named twice has two command queues",
     .otherwise = "$ECLAT_DEVICE, else the first GPU, else the first CPU"},
    {.name = "compile", .metavar = "WHEN", EC_CHOSEN(options.compile, ec_compile_names), .group = EC_GROUP_DEVICE, .uses = EC_OPTION_NO_IDENTITY,
     .help = "when to compile kernels that the driver does not have yet: beside (a render begins with narrow kernels, which compile sooner), first, or narrow: "
             "use only narrow kernels, for small images; the image is the same",
     .otherwise = "auto: $ECLAT_COMPILE, else beside"},
    {.name = "lanes", .metavar = "N", EC_STORED(LANES, options.lanes), .choices = ec_lanes_names, .group = EC_GROUP_DEVICE, .uses = EC_OPTION_NO_IDENTITY,
     .help = "paths per work-item: 1, 4, 8, 16 or auto; the image is the same", .otherwise = "auto"},
    {.name = "memory", .metavar = "SIZE", EC_STORED(BYTES, options.memory), .group = EC_GROUP_DEVICE, .uses = EC_OPTION_NO_IDENTITY,
     .help = "memory limit, as in 4G or 512M. A picture that does not fit is rendered in strips, one after the other, to the same image; requires --spp as the only limit",
     .otherwise = "what is free", .not_in_window = "a window's picture is held whole"},

    /* Reproduce and measure */
    {.name = "accel", .metavar = "NAME", EC_STORED(WORD, options.accel), .choices = ec_accel_names, .group = EC_GROUP_MEASURE, .integrators = TRACERS,
     .uses = EC_OPTION_INFO | EC_OPTION_NO_IDENTITY,
     .help = "acceleration structure: auto, bvh8, bvh2, grid, kdtree, none or twolevel; the image is the same. auto takes the faster of the BVHs, or "
             "twolevel where meshes are kept once, which the others expand",
     .otherwise = "auto"},
    {.name = "effects", .metavar = "WHICH", .set = ec_set_effects, .group = EC_GROUP_MEASURE, .choices = ec_effects_names,
     .uses = EC_OPTION_INFO | EC_OPTION_NO_IDENTITY,
     .help = "effects that kernels are compiled with: needed, those the scene calls for; all, every one there is, including those only an option enables. The "
             "image is the same",
     .otherwise = "needed"},
    {.name = "grid-density", .metavar = "N", .set = ec_set_grid_density, .group = EC_GROUP_MEASURE, .integrators = TRACERS,
     .uses = EC_OPTION_INFO | EC_OPTION_NO_IDENTITY,
     .help = "cells per reference (a triangle, or part of one) in --accel grid, " EC_TEXT(EC_GRID_DENSITY_LEAST) " to " EC_TEXT(EC_GRID_DENSITY_MOST)
             "; there are fewer where that makes more than 2^28 cells, or more than 64 entries per reference. The image is the same",
     .otherwise = "27"},
    {.name = "instancing", .metavar = "WHEN", EC_CHOSEN(choice.instancing, ec_instancing_names), .group = EC_GROUP_MEASURE, .uses = EC_OPTION_INFO,
     .help = "keep meshes that appear in several places only once: auto does so where it saves a million triangles and half of all; on, for each mesh that "
             "appears twice; off, never",
     .otherwise = "auto"},
    {.name = "replicates", .metavar = "N", EC_RANGED(U32, options.replicates, 1, EC_REPLICATES_MOST), .group = EC_GROUP_MEASURE, .uses = EC_OPTION_WINDOW,
     .help = "independent copies of the sample sequence, 1 to " EC_TEXT(EC_REPLICATES_MOST) ". Their spread gives the error: fewer make less noise, but a less "
             "certain error; a single one gives none",
     .otherwise = EC_TEXT(EC_REPLICATES) ", and " EC_TEXT(EC_REPLICATES_DENOISED) " with --denoise"},
    {.name = "wave", .metavar = "N", EC_RANGED(U32, options.wave, 1, 1u << 28), .group = EC_GROUP_MEASURE, .uses = EC_OPTION_NO_IDENTITY,
     .help = "paths in flight; the image is the same", .otherwise = "fitted to the device"},
    {.name = "without", .metavar = "EFFECT", .set = ec_set_without, .group = EC_GROUP_MEASURE,
     .uses = EC_OPTION_INFO | EC_OPTION_WINDOW | EC_OPTION_REPEATS,
     .help = "disable an effect that the scene calls for, by its name in eclat info: lights go out, textures and maps become their mean, layers disappear; "
             "may be repeated"},

    /* Messages */
    {.name = "json", EC_STORED(FLAG, json), .group = EC_GROUP_MESSAGES,
     .uses = EC_OPTION_INFO | EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE,
     .help = "print one JSON object with everything measured instead of text", .not_in_window = TALKING},
    {.name = "quiet", .letter = 'q', EC_STORED(FLAG, quiet), .group = EC_GROUP_MESSAGES,
     .uses = EC_OPTION_INFO | EC_OPTION_WINDOW | EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE,
     .help = "print only warnings and errors, and what --json prints"},
    {.name = "verbose", .letter = 'v', EC_STORED(FLAG, verbose), .group = EC_GROUP_MESSAGES,
     .uses = EC_OPTION_NO_IDENTITY | EC_OPTION_SEQUENCE,
     .help = "also print what calls for each effect, and the kernels and buffers it causes", .not_in_window = TALKING},
};
_Static_assert(sizeof ec_render_rows / sizeof ec_render_rows[0] <= EC_OPTIONS_MAX, "a larger EC_OPTIONS_MAX");
const int ec_render_row_count = sizeof ec_render_rows / sizeof ec_render_rows[0];

const ec_option *ec_render_row(const char *name) { return ec_options_find(ec_render_rows, ec_render_row_count, name); }

ec_result ec_render_refuse_live(void *target, const char *option, const char *value, ec_error *err)
{
    (void)target, (void)value;
    return ec_usage(err, "--%s is for 'eclat render': %s", option, ec_render_row(option)->not_in_window);
}

int ec_render_rows_for(uint32_t use, ec_option *rows)
{
    int count = 0;
    for (int i = 0; i < ec_render_row_count; i++)
        if (ec_render_rows[i].uses & use) {
            rows[count] = ec_render_rows[i];
            rows[count++].uses |= EC_OPTION_BORROWED;
        }
    return count;
}
