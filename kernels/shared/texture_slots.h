/* What a material may take from a texture. */
#ifndef EC_SHARED_TEXTURE_SLOTS_H
#define EC_SHARED_TEXTURE_SLOTS_H

/* X(NAME, is it sRGB?): a colour is, a number is not */
#define EC_SLOTS(X)                                                                                                    \
    X(BASE_COLOR, 1)         /* alpha, which is linear, is coverage */                                                 \
    X(METALLIC_ROUGHNESS, 0) /* G roughness, B metallic */                                                             \
    X(NORMAL, 0)                                                                                                       \
    X(EMISSION, 1)                                                                                                     \
    X(SPECULAR, 0)           /* A */                                                                                   \
    X(SPECULAR_COLOR, 1)                                                                                               \
    X(TRANSMISSION, 0)       /* R */                                                                                   \
    X(CLEARCOAT, 0)          /* R */                                                                                   \
    X(CLEARCOAT_ROUGHNESS, 0) /* G */                                                                                  \
    X(CLEARCOAT_NORMAL, 0)                                                                                             \
    X(SHEEN_COLOR, 1)                                                                                                  \
    X(SHEEN_ROUGHNESS, 0)    /* A */                                                                                   \
    X(ANISOTROPY, 0)         /* RG direction, B strength */                                                            \
    X(IRIDESCENCE, 0)        /* R */                                                                                   \
    X(IRIDESCENCE_THICKNESS, 0) /* G */                                                                                \
    X(DIFFUSE_TRANSMISSION, 0) /* A */                                                                                 \
    X(DIFFUSE_TRANSMISSION_COLOR, 1)

#define EC_SLOT_ENUM(name, is_srgb) EC_SLOT_##name,
enum ec_slot { EC_SLOTS(EC_SLOT_ENUM) EC_SLOT_COUNT };

#endif
