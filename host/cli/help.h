/* What help, the man page and completion say of each command. */
#ifndef EC_CLI_HELP_H
#define EC_CLI_HELP_H

#include <stdio.h>

#include "jobs/option_parser.h"

/* A term and what it means, below a heading: that of a group of options, or one of its own. */
typedef struct ec_help_note {
    const char *heading, *term, *text;
} ec_help_note;

typedef struct ec_help_page {
    const char *name;           /* "": of the program itself */
    const char *operands;
    const char *summary;
    const char *intro;
    int (*rows)(ec_option *rows); /* its options; NULL: none but --help and --version */
    const char *borrows;        /* heading of a bare list of the options that it has from `render`; NULL: they are told like its own */
    const char *lacks;          /* instead: heading of a list of those that it does not take */
    const ec_help_note *notes;  /* a NULL heading ends them */
    const char *closing;        /* after all; NULL: nothing */
    const char *const *words;   /* operands to choose from, NULL-terminated; NULL: files */
    int indent;                 /* column where texts begin */
} ec_help_page;

extern const ec_help_page ec_help_main, ec_help_pages[]; /* commands by name */
extern const int ec_help_page_count;
extern const char *const ec_group_titles[EC_GROUP_COUNT];
extern const char *const ec_shell_names[]; /* that completion is for, NULL-terminated */

/* How a page is set. */
typedef struct ec_help_style {
    void (*usage)(FILE *to, const ec_help_page *page);
    void (*heading)(FILE *to, const char *text);
    void (*paragraph)(FILE *to, const char *text);
    void (*item)(FILE *to, const char *term, const char *text, int indent);
    void (*list)(FILE *to, const char *text); /* below a heading */
} ec_help_style;
void ec_help_write(const ec_help_page *page, const ec_help_style *style, FILE *to);

/* Its options and --help and --version; those that it refuses are left out. Returns their number. */
int ec_help_rows(const ec_help_page *page, ec_option rows[EC_OPTIONS_MAX + 2]);

/* Help and default in one text. */
void ec_help_text(const ec_option *option, char *text, size_t size);

void ec_help_short(FILE *to);              /* a line a command */
void ec_help_manual(FILE *to);             /* eclat.1, for man */
void ec_help_completion(const char *shell, FILE *to); /* one of ec_shell_names */

#endif
