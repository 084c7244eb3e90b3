/* Gives access to the tables of commands and their options. */
#include "lib/internal.h"

const eclat_command *eclat_command_at(size_t i)
{
    for (const ec_command *const *c = ec_commands; *c; c++)
        if (i-- == 0) return &(*c)->told;
    return NULL;
}

/* Returns row i in the order of groups, and within a group in the order of the table. */
static const ec_option *row_at(const ec_option *rows, int count, size_t i)
{
    for (int group = 0; group < EC_GROUP_COUNT; group++)
        for (int k = 0; k < count; k++)
            if (rows[k].group == (ec_option_group)group && i-- == 0) return &rows[k];
    return NULL;
}

eclat_option eclat_option_at(const char *command, size_t i)
{
    ec_option rows[EC_OPTIONS_MAX];
    const ec_command *c = ec_command_find(command);
    const ec_option *row = c ? row_at(rows, c->rows(rows), i) : NULL;
    if (!row) return (eclat_option){0};
    return (eclat_option){.name = row->name, .letter = row->letter, .takes_value = ec_option_takes_value(row), .metavar = row->metavar,
                          .help = row->help, .otherwise = row->otherwise, .choices = row->choices, .group = (int)row->group,
                          .group_title = ec_group_titles[row->group], .repeats = (row->uses & EC_OPTION_REPEATS) != 0,
                          .is_borrowed = (row->uses & EC_OPTION_BORROWED) != 0, .refused = c->told.lacks ? row->not_in_window : NULL};
}
