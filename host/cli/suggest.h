/* Suggests the name that was probably meant. */
#ifndef EC_CLI_SUGGEST_H
#define EC_CLI_SUGGEST_H

/* Returns the nearest of names by edit distance; NULL if none is near enough. */
const char *ec_suggest(const char *typed, const char *const *names, int count);

#endif
