/* Handles texts with names of files, which are UTF-8. */
#ifndef EC_BASE_TEXT_H
#define EC_BASE_TEXT_H

#include <stdio.h>

/* Returns how many bytes of a text to take, at most `most`, without cutting a character in half. */
int ec_text_cut(const char *text, int most);

/* Makes a text with names safe for terminals and logs, in place: control characters, line breaks and characters that change the direction of writing
 * become '?'. A line break followed by two blanks is kept, as in lines of a compiler's log. */
void ec_text_clean(char *text);
/* Prints a name, made safe in this way, between two texts. */
void ec_text_print(FILE *to, const char *before, const char *name, const char *behind);

/* Arguments for "%.*s". */
#define EC_CUT(text, most) ec_text_cut(text, most), text

#endif
