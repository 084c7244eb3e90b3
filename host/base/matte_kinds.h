/* Kinds of things that Cryptomatte distinguishes, and the number of names per pixel. */
#ifndef EC_BASE_MATTE_KINDS_H
#define EC_BASE_MATTE_KINDS_H

enum ec_matte_kind { EC_MATTE_OBJECT, EC_MATTE_MATERIAL, EC_MATTE_ASSET, EC_MATTE_KINDS };

enum { EC_MATTE_RANKS = 6 };

#endif
