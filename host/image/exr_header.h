/* Reads the header of an EXR file whose pixels are read with ec_exr_read. */
#ifndef EC_IMAGE_EXR_HEADER_H
#define EC_IMAGE_EXR_HEADER_H

/* Gets the value of an attribute of type int, float or double. Returns 0 if there is none, or no such file. */
int ec_exr_number(const char *path, const char *attribute, double *value);

/* Tells whether a channel is stored in 16 bits. */
int ec_exr_is_half(const char *path, const char *channel);

/* Returns the value of a text attribute, malloc'ed; NULL if there is none. */
char *ec_exr_header_text(const char *path, const char *attribute);
/* Like ec_exr_header_text, but also NULL if the file is truncated. */
char *ec_exr_whole_text(const char *path, const char *attribute);

#endif
