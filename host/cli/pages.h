/* The program's commands: the jobs of the library, and two of the program's own. */
#ifndef EC_CLI_PAGES_H
#define EC_CLI_PAGES_H

#include "cli/arguments.h"

extern const eclat_command ec_page_main; /* the program itself; its name is "" */
extern const eclat_command ec_page_completion, ec_page_help;
extern const char *const ec_shell_names[]; /* supported by completion, ended by NULL */

enum { EC_PAGES_MOST = 16 };
int ec_page_names(const char *names[EC_PAGES_MOST + 1]); /* of all commands, ended by NULL; returns their number */
int ec_pages(const eclat_command *pages[EC_PAGES_MOST]); /* all commands in the order of names; returns their number */
const eclat_command *ec_page_find(const char *name);     /* NULL: there is none */

int ec_page_options(const eclat_command *page, eclat_option rows[EC_OPTIONS_MOST]); /* its options without --help and --version */

#endif
