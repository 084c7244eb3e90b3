/* Names of files are UTF-8. */
#ifndef EC_BASE_TEXT_H
#define EC_BASE_TEXT_H

/* How many bytes of a text to take, at most so many: no half of a character at the end. */
int ec_text_cut(const char *text, int most);

/* For "%.*s". */
#define EC_CUT(text, most) ec_text_cut(text, most), text

#endif
