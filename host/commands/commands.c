#include <stdlib.h>
#include <string.h>

#include "commands/command.h"

const ec_command *const ec_commands[] = {&ec_cmd_compare, &ec_cmd_cost,     &ec_cmd_devices, &ec_cmd_info, &ec_cmd_merge,
                                         &ec_cmd_mix,     &ec_cmd_render,   &ec_cmd_selftest, &ec_cmd_view, NULL};

const char *const ec_group_titles[EC_GROUP_COUNT] = {
    [EC_GROUP_OPTIONS] = "Options",
    [EC_GROUP_STUDY] = "Study",
    [EC_GROUP_SCENE] = "Scene",
    [EC_GROUP_PICTURE] = "Picture",
    [EC_GROUP_LIMITS] = EC_TITLE_LIMITS,
    [EC_GROUP_ANIMATION] = "Animation: one picture per frame; limits apply to each",
    [EC_GROUP_SERIES] = "Several pictures: of several SCENEs, or of a file of scenarios; limits apply to each",
    [EC_GROUP_RESUME] = EC_TITLE_RESUME,
    [EC_GROUP_TRANSPORT] = "Light transport",
    [EC_GROUP_DEVICE] = "Device",
    [EC_GROUP_MEASURE] = "Reproduce and measure",
    [EC_GROUP_RESULTS] = "Results: a table on standard output, and on request",
    [EC_GROUP_MESSAGES] = "Messages",
};

const ec_command *ec_command_find(const char *name)
{
    for (const ec_command *const *c = ec_commands; *c; c++)
        if (!strcmp((*c)->told.name, name)) return *c;
    return NULL;
}
