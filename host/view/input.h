/* What keys, mouse and scripts do to the wish. Knows no window. */
#ifndef EC_VIEW_INPUT_H
#define EC_VIEW_INPUT_H

#include "view/keys.h"
#include "view/shared.h"

typedef struct ec_view_input {
    const ec_view_request *request;
    ec_view_wish wish, asked; /* asked: as it was at the last S */
    ec_view_facts facts;
    ec_view_layout layout;
    ec_view_lines lines;     /* over the picture */
    bool help, effects;      /* lists that are open */
    uint32_t effects_page;
    bool fullscreen, quit;   /* asked for */
    ec_view_probe under, selected; /* the cursor's, and that of the click; node >= 0: there is one */
    double moved_at;         /* ec_now of the last move */
} ec_view_input;

/* New facts: of a first or another scene. */
void ec_view_input_learn(ec_view_input *input, const ec_view_facts *facts);

void ec_view_input_do(ec_view_input *input, ec_view_action action);
/* A character or a name of keys.h; where the list of effects is open a digit is its. */
void ec_view_input_key(ec_view_input *input, const char *name);
bool ec_view_input_knows(const char *name);

typedef enum ec_view_drag { EC_DRAG_ORBIT, EC_DRAG_PAN, EC_DRAG_DOLLY, EC_DRAG_LOOK } ec_view_drag;
/* dx, dy: heights of the picture, to the right and down. */
void ec_view_input_drag(ec_view_input *input, ec_view_drag drag, double dx, double dy);
void ec_view_input_wheel(ec_view_input *input, double clicks);
/* Directions from -1 to 1, for so many seconds. */
void ec_view_input_fly(ec_view_input *input, double forward, double right, double up, double seconds);
/* Angles in radians, for scripts. */
void ec_view_input_turn(ec_view_input *input, double yaw, double pitch);

#endif
