/* Writes help, man page and completion from the tables of commands and options. */
#ifndef EC_CLI_HELP_H
#define EC_CLI_HELP_H

#include <stdio.h>

#include "cli/pages.h"

/* How the parts of a page are formatted. */
typedef struct ec_help_style {
    void (*usage)(FILE *to, const eclat_command *page);
    void (*heading)(FILE *to, const char *text);
    void (*paragraph)(FILE *to, const char *text);
    void (*item)(FILE *to, const char *term, const char *text, int indent);
    void (*list)(FILE *to, const char *text); /* below a heading */
} ec_help_style;
void ec_help_write(const eclat_command *page, const ec_help_style *style, FILE *to);

/* Lists the command's options, and --help and --version, by name; those that it refuses are left out. Returns their number. */
int ec_help_rows(const eclat_command *page, eclat_option rows[EC_OPTIONS_MOST]);

/* Combines help and default in one text. */
void ec_help_text(const eclat_option *option, char *text, size_t size);

void ec_help_plain(const eclat_command *page, FILE *to);
void ec_help_short(FILE *to);              /* one line per command */
void ec_help_manual(FILE *to);             /* eclat.1, for man */
void ec_help_completion(const char *shell, FILE *to); /* one of ec_shell_names */

#endif
