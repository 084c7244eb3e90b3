/* Fuzzes scenario files, from bytes to the render requests of their pictures. */
#include "fuzz.h"
#include "jobs/scenarios.h"

/* Applies all options of an entry together; reading has tried each of them alone. */
static void judge_entry(const ec_entry *entry)
{
    PROMISE(entry->name && *entry->name && !strchr(entry->name, '/') && entry->scene, "a picture without a name or a scene");
    if (entry->why_not) {
        PROMISE(*entry->why_not && !strchr(entry->why_not, '\n'), "more than a line: %s", entry->why_not);
        return;
    }
    ec_render_request *request = malloc(sizeof *request);
    bool given[EC_OPTIONS_MAX] = {false};
    ec_error err = {0};
    PROMISE(request, "out of memory");
    ec_render_request_start(request);
    ec_result result = ec_given_apply(&entry->given, ec_render_rows, ec_render_row_count, request, given, &err);
    PROMISE(result == EC_OK, "%s: %s", entry->name, err.text);
    PROMISE(request->outputs.count == 2, "%s: %d outputs", entry->name, (int)request->outputs.count);
    PROMISE(request->options.width > 0 && request->options.height > 0, "%s: no size", entry->name);
    fuzz_judge_result(ec_render_request_settle(request, ec_render_rows, ec_render_row_count, given, &err), &err);
    free(request);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const ec_given_options given = {0};
    ec_entries entries = {0};
    ec_error err = {0};
    ec_result result = ec_scenarios_read(fuzz_file(data, size), "out", &given, &entries, &err);
    fuzz_judge_result(result, &err);
    for (uint32_t i = 0; result == EC_OK && i < entries.count; i++) judge_entry(&entries.list[i]);
    ec_entries_free(&entries);
    return 0;
}
