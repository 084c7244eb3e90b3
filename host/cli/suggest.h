/* The name that was probably meant. */
#ifndef EC_CLI_SUGGEST_H
#define EC_CLI_SUGGEST_H

/* Nearest of names by edit distance, or NULL when none is near enough to be worth a guess. */
const char *ec_suggest(const char *typed, const char *const *names, int count);

#endif
