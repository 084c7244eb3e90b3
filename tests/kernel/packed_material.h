/* A surface as numbers, for run_chi2.cl and its users. Directions are local; wo is in the plane of x and z. */
#ifndef EC_TESTS_KERNEL_PACKED_MATERIAL_H
#define EC_TESTS_KERNEL_PACKED_MATERIAL_H

enum packed_field {
    PACKED_BASE, /* 3 */
    PACKED_F0 = 3,
    PACKED_F90,
    PACKED_METALLIC,
    PACKED_ALPHA,
    PACKED_COSINE, /* direction wo */
    PACKED_TRANSMISSION,
    PACKED_ETA, /* 1: thin */
    PACKED_COAT,
    PACKED_COAT_ALPHA,
    PACKED_COAT_TILT, /* sine of the angle of the coat's normal, in the plane of wo */
    PACKED_SHEEN, /* 3 */
    PACKED_SHEEN_ROUGHNESS = PACKED_SHEEN + 3,
    PACKED_STRETCH, /* minus 1 */
    PACKED_TURN,    /* rotation of wo's plane from the direction of the stretch, in turns, 0 to 1 */
    PACKED_FILM,    /* weight, index, nanometres */
    PACKED_DIFFUSE_TRANSMISSION = PACKED_FILM + 3, /* share, colour */
    PACKED_FIELDS = PACKED_DIFFUSE_TRANSMISSION + 4
};

#endif
