/* Changes of the wish by keys, mouse and scripts. Knows no window. */
#ifndef EC_VIEW_INPUT_H
#define EC_VIEW_INPUT_H

#include <eclat/eclat.h>
#include <stdbool.h>

#include "view/keys.h"

typedef enum ec_view_layout { EC_LAYOUT_ONE, EC_LAYOUT_WIPE, EC_LAYOUT_BESIDE, EC_LAYOUT_COUNT } ec_view_layout;
typedef enum ec_view_lines { EC_LINES_ALL, EC_LINES_ONE, EC_LINES_NONE, EC_LINES_COUNT } ec_view_lines;

typedef struct ec_view_input {
    eclat_live *live;        /* is told of saves at once: they are of what is wished then */
    eclat_wish wish, first;  /* first: as the options have it. The viewpoint is that of the scene's camera where none was moved */
    eclat_facts facts;
    ec_view_layout layout;
    eclat_second second;     /* in the layouts that show it */
    bool has_file;           /* ECLAT_SECOND_FILE is one */
    ec_view_lines lines;     /* over the picture */
    bool help, effects;      /* lists that are open */
    uint32_t effects_page;
    bool fullscreen, quit;   /* asked for */
    uint32_t saves;
    eclat_probe under, selected; /* the cursor's, and that of the click; node >= 0: there is one */
    bool moved;              /* since the window looked last */
} ec_view_input;

/* New facts: of a first or another scene. */
void ec_view_input_learn(ec_view_input *input, const eclat_facts *facts);

void ec_view_input_do(ec_view_input *input, ec_view_action action);
/* A character or a name of keys.h; where the list of effects is open a digit is its. */
void ec_view_input_key(ec_view_input *input, const char *name);
bool ec_view_input_knows(const char *name);

typedef enum ec_view_drag { EC_DRAG_ORBIT, EC_DRAG_PAN, EC_DRAG_DOLLY, EC_DRAG_LOOK } ec_view_drag;
/* dx, dy: heights of the picture, to the right and down. */
void ec_view_input_drag(ec_view_input *input, ec_view_drag drag, double dx, double dy);
/* Directions from -1 to 1, for so many seconds. */
void ec_view_input_fly(ec_view_input *input, double forward, double right, double up, double seconds);

#endif
