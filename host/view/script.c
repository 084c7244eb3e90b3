#include "view/script.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/view.h"

static const struct {
    const char *verb;
    int numbers; /* numbers after it; -1: a key */
} verbs[] = {{"turn", 3}, {"pan", 3}, {"dolly", 2}, {"wait", 1}, {"settle", 0}, {"key", -1}, {"quit", 0}};

static bool read_step(const char *line, ec_script_step *step)
{
    double n[3] = {0, 0, 0};
    char rest[8];
    *step = (ec_script_step){.seconds = 0};
    if (sscanf(line, "%15s", step->verb) != 1) return false;
    for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
        if (strcmp(verbs[i].verb, step->verb)) continue;
        if (verbs[i].numbers < 0) return sscanf(line, "%*s %15s %7s", step->key, rest) == 1 && ec_view_input_knows(step->key);
        if (sscanf(line, "%*s %lf %lf %lf", &n[0], &n[1], &n[2]) != verbs[i].numbers && verbs[i].numbers > 0) return false;
        step->seconds = verbs[i].numbers ? n[verbs[i].numbers - 1] : 0;
        step->a = verbs[i].numbers > 1 ? n[0] : 0;
        step->b = verbs[i].numbers > 2 ? n[1] : 0;
        return step->seconds >= 0 && step->seconds < 1e6 && isfinite(step->a) && isfinite(step->b) &&
               (strcmp(step->verb, "dolly") || step->a > 0);
    }
    return false;
}

eclat_result ec_script_read(ec_script *s, const char *name, eclat_error *err)
{
    char *line = NULL;
    size_t room = 0;
    *s = (ec_script){.count = 0};
    if (!strcmp(name, "orbit")) {
        s->steps[s->count++] = (ec_script_step){.verb = "turn", .a = 360, .seconds = 6};
        return ECLAT_OK;
    }
    FILE *file = fopen(name, "r");
    if (!file) return ec_view_fail(err, "cannot read the script '%s': %s", name, strerror(errno));
    eclat_result result = ECLAT_OK;
    for (int number = 1; result == ECLAT_OK && getline(&line, &room, file) >= 0; number++) {
        line[strcspn(line, "#\n")] = 0;
        if (!line[strspn(line, " \t\r")]) continue;
        if (s->count == EC_SCRIPT_STEPS) result = ec_view_fail(err, "%s:%d: more than %d steps", name, number, EC_SCRIPT_STEPS);
        else if (!read_step(line, &s->steps[s->count]))
            result = ec_view_fail(err, "%s:%d: '%.200s' is not a step; see 'eclat view --help'", name, number, line);
        else s->count++;
    }
    if (result == ECLAT_OK && ferror(file)) result = ec_view_fail(err, "cannot read the script '%s': %s", name, strerror(errno));
    free(line);
    fclose(file);
    return result;
}

/* Does a share of a move. */
static void do_part(const ec_script_step *step, ec_view_input *in, double share)
{
    if (!strcmp(step->verb, "turn")) ec_view_input_drag(in, EC_DRAG_ORBIT, -step->a / 180 * share, step->b / 180 * share);
    if (!strcmp(step->verb, "pan")) ec_view_input_drag(in, EC_DRAG_PAN, -step->a * share, step->b * share);
    if (!strcmp(step->verb, "dolly")) ec_view_input_drag(in, EC_DRAG_DOLLY, 0, log(step->a) / 3 * share);
}

/* Runs a step that takes no time; returns whether it is over. */
static bool is_over(const ec_script_step *step, ec_view_input *in, const eclat_status *status)
{
    if (!strcmp(step->verb, "settle")) return status->is_settled;
    if (!strcmp(step->verb, "quit")) in->quit = in->saves == status->saves;
    if (!strcmp(step->verb, "key")) ec_view_input_key(in, step->key);
    do_part(step, in, 1);
    return strcmp(step->verb, "quit") || in->quit;
}

void ec_script_run(ec_script *s, ec_view_input *in, const eclat_status *status, double seconds)
{
    s->moves = false;
    if (!status->pictures) return; /* there is nothing to see yet */
    if (s->at == s->count) {
        in->quit = in->saves == status->saves;
        return;
    }
    const ec_script_step *step = &s->steps[s->at];
    if (step->seconds > 0) {
        double take = fmin(seconds, step->seconds - s->done);
        do_part(step, in, take / step->seconds);
        s->moves = step->a != 0 || step->b != 0;
        s->done += take;
        if (s->done < step->seconds - 1e-9) return;
    } else if (!is_over(step, in, status)) {
        return;
    }
    s->at++; /* its effect is known in the next frame */
    s->done = 0;
}
