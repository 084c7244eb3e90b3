/* Camera moves, as users of glTF viewers know them. Pure: from a viewpoint to the next. */
#ifndef EC_VIEW_ORBIT_H
#define EC_VIEW_ORBIT_H

#include <eclat/eclat.h>

/* The up that a camera turns about: +y where it has no roll, else its own. */
void ec_orbit_settle(eclat_viewpoint *v);

/* Around the target by angles in radians: yaw > 0 moves the eye to the right, pitch > 0 up. Never over a pole. */
void ec_orbit_turn(eclat_viewpoint *v, double yaw, double pitch);

/* Turns the head: the target moves around the eye; yaw > 0 looks to the right, pitch > 0 up. */
void ec_orbit_look(eclat_viewpoint *v, double yaw, double pitch);

/* Eye and target sideways and upwards, in heights of the picture at the target. */
void ec_orbit_pan(eclat_viewpoint *v, double right, double up);

/* The eye comes nearer to the target: its distance times factor. Parallel rays show less instead. */
void ec_orbit_dolly(eclat_viewpoint *v, double factor);

/* Eye and target move by metres along the camera's axes. */
void ec_orbit_fly(eclat_viewpoint *v, double forward, double right, double up);

/* The target becomes `center`, from the same direction; a sphere of that radius just fits a picture of that aspect (width / height). */
void ec_orbit_frame(eclat_viewpoint *v, const double center[3], double radius, double aspect);

double ec_orbit_distance(const eclat_viewpoint *v);

#endif
