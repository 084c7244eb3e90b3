/* Changes the requested view by keys, mouse and scripts. Independent of the window. */
#ifndef EC_VIEW_INPUT_H
#define EC_VIEW_INPUT_H

#include <eclat/eclat.h>
#include <stdbool.h>

#include "view/keys.h"

typedef enum ec_view_layout { EC_LAYOUT_ONE, EC_LAYOUT_WIPE, EC_LAYOUT_BESIDE, EC_LAYOUT_COUNT } ec_view_layout;
typedef enum ec_view_lines { EC_LINES_ALL, EC_LINES_ONE, EC_LINES_NONE, EC_LINES_COUNT } ec_view_lines;

typedef struct ec_view_input {
    eclat_live *live;        /* to which saves are reported at once, as they belong to the view of that moment */
    eclat_view_request view, first;  /* first: that of the options. If the camera was not moved, viewpoint is that of the scene's */
    eclat_facts facts;
    ec_view_layout layout;
    eclat_second second;     /* shown in layouts with two pictures */
    bool has_file;           /* ECLAT_SECOND_FILE is available */
    ec_view_lines lines;     /* lines over the picture */
    bool help, effects;      /* these lists are open */
    uint32_t effects_page;
    bool fullscreen, quit;   /* requested */
    uint32_t saves;
    eclat_probe under, selected; /* under the cursor; at the last click, with node >= 0 if it selected one */
    bool moved;              /* since the window last looked */
} ec_view_input;

/* Takes the facts of the first or a reloaded scene. */
void ec_view_input_learn(ec_view_input *input, const eclat_facts *facts);

void ec_view_input_do(ec_view_input *input, ec_view_action action);
/* Handles a character or a name of keys.h; while the list of effects is open, digits belong to it. */
void ec_view_input_key(ec_view_input *input, const char *name);
bool ec_view_input_knows(const char *name);

typedef enum ec_view_drag { EC_DRAG_ORBIT, EC_DRAG_PAN, EC_DRAG_DOLLY, EC_DRAG_LOOK } ec_view_drag;
/* dx, dy: to the right and down, in heights of the picture. */
void ec_view_input_drag(ec_view_input *input, ec_view_drag drag, double dx, double dy);
/* Flies for `seconds`; directions are from -1 to 1. */
void ec_view_input_fly(ec_view_input *input, double forward, double right, double up, double seconds);

#endif
