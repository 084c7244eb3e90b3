#include "jobs/command_line.h"

#include <stdlib.h>
#include <string.h>

static int is_plain(const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./,:@%";
    return *word && word[strspn(word, plain)] == '\0';
}

/* 'it'\''s': all is literal within single quotes but the quote itself. */
static char *put_quoted(char *to, const char *word)
{
    *to++ = '\'';
    for (; *word; word++) {
        if (*word == '\'') {
            memcpy(to, "'\\'", 3);
            to += 3;
        }
        *to++ = *word;
    }
    *to++ = '\'';
    return to;
}

char *ec_command_line(int argc, char **argv)
{
    size_t room = 1;
    for (int i = 0; i < argc; i++) room += 4 * strlen(argv[i]) + 3;
    char *line = malloc(room);
    if (!line) return NULL;
    char *to = line;
    for (int i = 0; i < argc; i++) {
        if (i) *to++ = ' ';
        if (is_plain(argv[i])) {
            size_t size = strlen(argv[i]);
            memcpy(to, argv[i], size);
            to += size;
        } else {
            to = put_quoted(to, argv[i]);
        }
    }
    *to = '\0';
    return line;
}
