/* Moves of the camera, as users of glTF viewers know them. Pure functions of a viewpoint. */
#ifndef EC_VIEW_ORBIT_H
#define EC_VIEW_ORBIT_H

#include <eclat/eclat.h>

/* Sets the up direction about which a camera turns: +y if it has no roll, otherwise its own. */
void ec_orbit_settle(eclat_viewpoint *v);

/* Turns around the target by angles in radians: yaw > 0 moves the eye to the right, pitch > 0 up. Stops short of the poles. */
void ec_orbit_turn(eclat_viewpoint *v, double yaw, double pitch);

/* Turns the view: the target moves around the eye; yaw > 0 looks to the right, pitch > 0 up. */
void ec_orbit_look(eclat_viewpoint *v, double yaw, double pitch);

/* Moves eye and target sideways and upwards, in heights of the picture at the target. */
void ec_orbit_pan(eclat_viewpoint *v, double right, double up);

/* Multiplies the distance of the eye to the target by factor. With parallel rays, the height of the picture. */
void ec_orbit_dolly(eclat_viewpoint *v, double factor);

/* Moves eye and target by metres along the camera's axes. */
void ec_orbit_fly(eclat_viewpoint *v, double forward, double right, double up);

/* Sets the target to `center`, keeping the direction, so that a sphere of this radius just fits a picture of this aspect (width / height). */
void ec_orbit_frame(eclat_viewpoint *v, const double center[3], double radius, double aspect);

double ec_orbit_distance(const eclat_viewpoint *v);

#endif
