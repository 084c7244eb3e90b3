/* Begins and ends a session. */
#include <math.h>
#include <stdlib.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "base/clock.h"
#include "jobs/defaults.h"
#include "jobs/option.h"
#include "live/shared.h"

_Static_assert((int)ECLAT_RASTER == EC_INTEGRATOR_RASTER && (int)ECLAT_LIGHT == EC_INTEGRATOR_LIGHT && (int)ECLAT_INTEGRATOR_COUNT == EC_INTEGRATOR_COUNT, "one order of integrators");
_Static_assert((int)ECLAT_TONEMAP_NONE == EC_TONEMAP_NONE && (int)ECLAT_TONEMAP_AGX == EC_TONEMAP_AGX && (int)ECLAT_TONEMAP_COUNT == EC_TONEMAP_COUNT,
               "one order of tone curves");

/* Fills in what the request alone tells, before a scene is loaded. */
static void start(ec_live *live)
{
    ec_render_request *request = &live->request;
    const ec_render_options *o = &request->options;
    live->asked.view = (eclat_view_request){.camera = -1, .env_degrees = request->env_degrees, .exposure = request->exposure.stops, .without = o->without,
                                    .is_denoised = o->denoise != EC_DENOISER_NONE, .tonemap = (eclat_tonemap)request->tonemap, .integrator = (eclat_integrator)o->integrator,
                                    .second_integrator = ECLAT_RASTER, .x = UINT32_MAX, .y = UINT32_MAX};
    live->asked.serial = 1;
    live->facts = (eclat_facts){.width = o->width, .height = o->height, .scene = request->scene, .device = live->device.name};
    live->status.under = live->status.picked = (eclat_probe){.x = UINT32_MAX, .y = UINT32_MAX, .material = -1, .node = -1};
    live->status.error = live->status.error_bound = INFINITY;
    live->status.seconds_left = -1;
    request->env_degrees = 0;
    request->default_height = EC_LIVE_HEIGHT;
}

static ec_result start_threads(ec_live *live, ec_error *err)
{
    void *(*const work[EC_LIVE_THREADS])(void *) = {ec_live_loader, ec_live_renderer, ec_live_watcher};
    start(live);
    if (live->leave < 0) return ec_fail(err, "no file descriptor left for a live session");
    for (; live->threads < EC_LIVE_THREADS; live->threads++)
        if (pthread_create(&live->thread[live->threads], NULL, work[live->threads], live) != 0)
            return ec_fail(err, "no thread left for a live session; end other programs, or raise `ulimit -u`");
    return EC_OK;
}

static ec_result check(ec_live *live, const char *against, ec_error *err)
{
    if (live->request.exposure.is_auto) return ec_usage(err, "--exposure auto: keys set the exposure of a window; give a number of stops");
    EC_TRY(ec_render_check_files(&live->request, err));
    EC_TRY(ec_device_find(live->request.device, &live->device, &live->device_index, &live->device_why, err));
    return against ? ec_image_read_rgb(against, &live->against_width, &live->against_height, &live->against, err) : EC_OK;
}

ec_result ec_live_open(ec_live *live, const char *against, ec_error *err)
{
    live->start = ec_now();
    live->files = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    live->leave = eventfd(0, EFD_CLOEXEC);
    pthread_mutex_init(&live->lock, NULL);
    pthread_cond_init(&live->changed, NULL);
    ec_result result = check(live, against, err);
    if (result == EC_OK) result = start_threads(live, err);
    if (result != EC_OK) ec_live_close(live);
    return result;
}

/* Ends each thread once it has finished what it is doing. */
void ec_live_close(ec_live *live)
{
    pthread_mutex_lock(&live->lock);
    live->quit = true;
    ec_live_wake(live);
    pthread_mutex_unlock(&live->lock);
    if (live->leave >= 0) eventfd_write(live->leave, 1);
    while (live->threads) pthread_join(live->thread[--live->threads], NULL);
    if (live->files >= 0) close(live->files);
    if (live->leave >= 0) close(live->leave);
    for (int i = 0; i < ECLAT_SHOWN_COUNT; i++) {
        ec_live_setup_free(live, live->incoming[i]);
        free(live->shown[i].written.rgb);
        free(live->shown[i].ready.rgb);
        free(live->shown[i].taken.rgb);
    }
    ec_live_scene_release(live, live->scene);
    free(live->against);
    pthread_cond_destroy(&live->changed);
    pthread_mutex_destroy(&live->lock);
}
