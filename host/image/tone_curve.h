/* Tone curves: map linear Rec. 709 light of any brightness to what a display can show. */
#ifndef EC_IMAGE_TONE_CURVE_H
#define EC_IMAGE_TONE_CURVE_H

/* Each has an enum, a name, and a text for help. Options, reports, the library and the manual use these rows. */
#define EC_TONE_CURVES(ROW) \
    ROW(NEUTRAL, "neutral", "Khronos PBR Neutral") \
    ROW(NONE, "none", "values over 1 are cut off") \
    ROW(ACES, "aces", "Hill's fit of ACES, as ACESFilmic in three.js") \
    ROW(AGX, "agx", "AgX as in three.js") \
    ROW(FILMIC, "filmic", "Hejl and Burgess-Dawson's, as Cineon in three.js")

#define EC_TONE_CURVE_ENUM(id, name, words) EC_TONEMAP_##id,
typedef enum ec_tonemap { EC_TONE_CURVES(EC_TONE_CURVE_ENUM) EC_TONEMAP_COUNT } ec_tonemap;

#define EC_TONE_CURVE_WORDS(id, name, words) "; " name ": " words
#define EC_TONE_CURVES_HELP "tone curve of pictures for the screen" EC_TONE_CURVES(EC_TONE_CURVE_WORDS)

/* Applies a curve in place. rgb: finite, not negative, already exposed; becomes linear Rec. 709 within [0, 1]. */
void ec_tone_curve_apply(ec_tonemap curve, double rgb[3]);

#endif
