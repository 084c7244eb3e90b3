/* The table by which directions are guided (kernels/lib/guide.h), in words. First a tree of boxes, two words a node. Of a box that is halved: where,
 * and 4 times the node of its lower half, plus the axis (the upper half's node is the next one). Of another: the share of directions that are guided
 * there, and 4 times the word where its quadtree begins, plus EC_GUIDE_LEAF.
 * Then quadtrees, eight words a node: for each quarter its share of the node's light, and the word where its own node begins, 0 for none. Quarters
 * are numbered x + 2 y, with x, y = 1 for the upper half. */
#ifndef EC_SHARED_GUIDE_H
#define EC_SHARED_GUIDE_H

#define EC_GUIDE_BOX_WORDS 2u
#define EC_GUIDE_SQUARE_WORDS 8u
#define EC_GUIDE_LEAF 3u /* in place of an axis */
#define EC_GUIDE_ALPHA 0.25f /* lobes narrower than that are left to the BSDF */

/* A vertex of a light path, in words from (vertex * paths + path) * EC_PHOTON_WORDS on. Flux 0: the vertex does not count. */
#define EC_PHOTON_VERTICES 8u
enum ec_photon_word { EC_PHOTON_X, EC_PHOTON_Y, EC_PHOTON_Z, EC_PHOTON_DX, EC_PHOTON_DY, EC_PHOTON_DZ, EC_PHOTON_FLUX, EC_PHOTON_WORDS = 8 };

#endif
