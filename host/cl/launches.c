/* Watches for commands that fail as they run. An in-order queue goes on after one, and not every driver lets the next call that blocks fail: without
 * a look at the events the picture would be made of what a buffer held before. */
#include "cl/pace.h"

ec_result ec_cl_launched(ec_cl *cl, cl_event event, const char *label, ec_pace *pace, ec_error *err)
{
    ec_result result = cl->launch_count == EC_LAUNCHES ? ec_cl_landed(cl, err) : EC_OK;
    if (result == EC_OK) cl->launches[cl->launch_count++] = (ec_cl_launch){event, label, pace};
    else clReleaseEvent(event);
    return result;
}

/* Returns the time a command took, by the device's own clock. */
static double seconds_of(cl_event event)
{
    cl_ulong start = 0, end = 0;
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, NULL);
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL);
    return end > start ? 1e-9 * (double)(end - start) : 0;
}

ec_result ec_cl_landed(ec_cl *cl, ec_error *err)
{
    const char *culprit = NULL; /* the first that failed: later ones may fail because of it */
    cl_int why = CL_SUCCESS, waited = CL_SUCCESS;
    if (cl->launch_count) waited = clWaitForEvents(1, &cl->launches[cl->launch_count - 1].event);
    for (uint32_t i = 0; i < cl->launch_count; i++) {
        cl_int status = CL_COMPLETE, code;
        code = clGetEventInfo(cl->launches[i].event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, NULL);
        if (!culprit && (code != CL_SUCCESS || status < 0)) {
            culprit = cl->launches[i].label;
            why = code != CL_SUCCESS ? code : status;
        }
        if (cl->launches[i].pace && status == CL_COMPLETE) ec_pace_took(cl, cl->launches[i].pace, seconds_of(cl->launches[i].event));
    }
    ec_pace_learn(cl);
    ec_cl_forget_launches(cl);
    return culprit ? ec_cl_check(why, "running a kernel", culprit, err)
                   : ec_cl_check(waited, "clWaitForEvents", cl->info.name, err);
}

void ec_cl_forget_launches(ec_cl *cl)
{
    while (cl->launch_count) clReleaseEvent(cl->launches[--cl->launch_count].event);
}
