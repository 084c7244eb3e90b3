/* A closed room with a lamp, a block and a ball, at any place and of any size: pictures and hits must not depend on those. Inside
 * host/selftest only. */
#ifndef EC_SELFTEST_ROOM_H
#define EC_SELFTEST_ROOM_H

#include "scene/scene.h"
#include "selftest/cases.h"

typedef struct ec_room {
    double scale;          /* of the coordinates in the file; 0 counts as 1 */
    double offset;         /* added to all of them */
    double matrix[16];     /* of the node they stand below; only its linear part may turn, mirror or keep */
    bool has_matrix;
} ec_room;

/* In its own frame the room reaches from -1 to 1, wherever it stands. */
ec_result ec_room_scene(const ec_room *room, ec_scene **scene, ec_error *err);
/* What scale and matrix make of a point or direction of that frame. */
void ec_room_moved(const ec_room *room, const double p[3], double moved[3]);

#endif
