/* Names of files are UTF-8. */
#ifndef EC_BASE_TEXT_H
#define EC_BASE_TEXT_H

#include <stdio.h>

/* How many bytes of a text to take, at most so many: no half of a character at the end. */
int ec_text_cut(const char *text, int most);

/* Makes a text with names in it safe for terminals and logs, in place: control characters, line breaks and what turns the direction of
 * writing become '?'. A line break that two blanks follow stays: lines of a compiler's log are set so. */
void ec_text_clean(char *text);
/* Prints a name so, between two texts. */
void ec_text_print(FILE *to, const char *before, const char *name, const char *behind);

/* For "%.*s". */
#define EC_CUT(text, most) ec_text_cut(text, most), text

#endif
