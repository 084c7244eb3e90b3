/* The table that directions are guided by (kernels/lib/guide.h), in words. First a tree of boxes, two words a node: where a box is halved, and
 * 4 * its lower half's node + axis, the upper half's being the next one; or, where it is not, the share of directions that are guided
 * there, and 4 * the word that its quadtree begins with + EC_GUIDE_LEAF.
 * Then quadtrees, eight words a node: for each quarter its share of all light, and where its own node begins, 0 for none. Quarter x + 2 y: x,
 * y = 1 for the upper half. */
#ifndef EC_SHARED_GUIDE_H
#define EC_SHARED_GUIDE_H

#define EC_GUIDE_BOX_WORDS 2u
#define EC_GUIDE_SQUARE_WORDS 8u
#define EC_GUIDE_LEAF 3u /* in place of an axis */
#define EC_GUIDE_ALPHA 0.25f /* lobes narrower than that are left to the BSDF */

/* What a light path met, words; it stands at (vertex * paths + path) * EC_PHOTON_WORDS. Flux 0: nothing that counts. */
#define EC_PHOTON_VERTICES 8u
enum ec_photon_word { EC_PHOTON_X, EC_PHOTON_Y, EC_PHOTON_Z, EC_PHOTON_DX, EC_PHOTON_DY, EC_PHOTON_DZ, EC_PHOTON_FLUX, EC_PHOTON_WORDS = 8 };

#endif
