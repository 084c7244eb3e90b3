/* What the header of an EXR file says, for those who have read its pixels with ec_exr_read. */
#ifndef EC_IMAGE_EXR_HEADER_H
#define EC_IMAGE_EXR_HEADER_H

/* The value of an attribute of type int, float or double; 0 where there is none, or no such file. */
int ec_exr_number(const char *path, const char *attribute, double *value);

/* Is this channel stored in 16 bits? */
int ec_exr_is_half(const char *path, const char *channel);

/* The value of a text attribute, malloc'ed; NULL where there is none. */
char *ec_exr_header_text(const char *path, const char *attribute);
/* ec_exr_header_text; NULL also where the file's picture is cut short. */
char *ec_exr_whole_text(const char *path, const char *attribute);

#endif
