#include <stdlib.h>

#include "commands/command.h"

ec_result ec_call_scene(const ec_call *call, const char *command, const char **scene, ec_error *err)
{
    if (call->input_count < 1 || !*call->inputs[0])
        return ec_usage(err, "%s needs a SCENE (.gltf or .glb); see 'eclat %s --help'", command, command);
    if (call->input_count > 1) return ec_usage(err, "one scene at a time: '%s' is one operand too many", call->inputs[1]);
    *scene = call->inputs[0];
    return EC_OK;
}

void ec_call_free(ec_call *call)
{
    ec_merged_free(&call->merged);
    ec_mix_free(&call->mix);
    ec_render_job_free(&call->render);
    ec_words_free(&call->words);
    ec_given_free(&call->given);
    while (call->input_count) free(call->inputs[--call->input_count]);
    free(call->inputs);
    free(call->request);
}
