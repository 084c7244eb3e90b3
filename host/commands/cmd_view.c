/* eclat view SCENE: a window that shows the render; it saves what `eclat render` would have written. */

#include "commands/command.h"

#define REQUEST ec_view_options

static const ec_option own[] = {
    {.name = "against", .metavar = "FILE.exr", EC_STORED(TEXT, against), .help = "picture to compare with the rendered one (V and Tab)"},
    {.name = "script", .metavar = "FILE", EC_STORED(TEXT, script),
     .help = "move the camera and press keys as a script says, then close; the script orbit turns once around. Lines: turn YAW PITCH SECONDS (degrees), "
             "pan RIGHT UP SECONDS (picture heights), dolly FACTOR SECONDS, wait SECONDS, settle (until the limit is met), key NAME (e, E, 1, Tab, Save, ...; "
             "after X digits switch effects), quit. 0 SECONDS means at once"},
    {.name = "stats", EC_STORED(FLAG, stats), .help = "report at the end the time to the first picture, and frame times while the camera moved"},
};

static int list_rows(ec_option rows[EC_OPTIONS_MAX])
{
    int count = 0;
    for (; count < (int)(sizeof own / sizeof own[0]); count++) rows[count] = own[count];
    for (int i = 0; i < ec_render_row_count && count < EC_OPTIONS_MAX; i++) {
        rows[count] = ec_render_rows[i];
        rows[count].uses |= EC_OPTION_BORROWED;
        if (ec_render_rows[i].not_in_window) rows[count].set = ec_render_refuse_live;
        count++;
    }
    ec_option *size = &rows[ec_options_find(rows, count, "size") - rows];
    size->group = EC_GROUP_OPTIONS;
    size->uses &= ~(uint32_t)EC_OPTION_BORROWED;
    size->help = "size of the window when it opens, in pixels";
    size->otherwise = EC_TEXT(EC_LIVE_HEIGHT) " high";
    return count;
}

/* Run by the library, since the window is a client of the public header (lib/eclat_view.c). */
const ec_command ec_cmd_view = {
    .told = {.name = "view", .operands = "SCENE [options]", .summary = "show a scene in a window while it renders",
             .intro = "Opens a window that shows a glTF 2.0 scene as it renders: rasterised at once, then path traced, coarsely while the camera moves and ever finer once it "
                       "rests. S saves what eclat render would have written and prints the command that renders the same picture again, bit for bit. When a file of the "
                       "scene changes, it is loaded again.",
             .lacks = "All options of eclat render, except",
             .closing = "Limits (--spp, --error, --time) count from the moment the camera comes to rest; when one is reached, the window sleeps."},
    .rows = list_rows, .size = sizeof(ec_view_options), .start = ec_render_request_start, .is_interactive = true,
};
