/* Writes the man page for groff's man macros. */
#include <ctype.h>
#include <stdbool.h>
#include <string.h>

#include "cli/help.h"

/* Writes text for groff: hyphens become minus signs, backslashes are shown, and no line starts with a control character. */
static void put(FILE *to, const char *text)
{
    if (*text == '.' || *text == '\'') fputs("\\&", to);
    for (; *text; text++) {
        if (*text == '-') fputs("\\-", to);
        else if (*text == '\\') fputs("\\e", to);
        else fputc(*text, to);
    }
}

/* Writes a term in bold, with values of options in italics. */
static void put_term(FILE *to, const char *term)
{
    const bool is_option = *term == '-';
    while (*term) {
        size_t size = strcspn(term, " ");
        char word[96];
        snprintf(word, sizeof word, "%.*s", (int)size, term);
        fputs(*word == '-' || !is_option ? "\\fB" : "\\fI", to);
        put(to, word);
        fputs("\\fR", to);
        term += size;
        if (*term) fputc(' ', to);
        while (*term == ' ') term++;
    }
    fputc('\n', to);
}

static void man_usage(FILE *to, const eclat_command *page)
{
    fprintf(to, ".B eclat%s%s\n.I ", *page->name ? " " : "", page->name);
    put(to, page->operands);
    fputs(*page->name ? "\n" : "\n.SH DESCRIPTION\n", to);
}

static void man_heading(FILE *to, const char *text)
{
    fputs(".SS \"", to);
    put(to, text);
    fputs("\"\n", to);
}

static void man_paragraph(FILE *to, const char *text)
{
    fputs(".PP\n", to);
    put(to, text);
    fputc('\n', to);
}

static void man_list(FILE *to, const char *text)
{
    put(to, text);
    fputc('\n', to);
}

static void man_item(FILE *to, const char *term, const char *text, int indent)
{
    (void)indent;
    fputs(".TP\n", to);
    put_term(to, term + strspn(term, " "));
    put(to, text);
    fputc('\n', to);
}

void ec_help_manual(FILE *to)
{
    static const ec_help_style man = {man_usage, man_heading, man_paragraph, man_item, man_list};
    fputs(".TH ECLAT 1 \"\" \"eclat " EC_VERSION "\" \"User Commands\"\n.SH NAME\neclat \\- ", to);
    put(to, ec_page_main.summary);
    fputs("\n.SH SYNOPSIS\n", to);
    ec_help_write(&ec_page_main, &man, to);
    const eclat_command *pages[EC_PAGES_MOST];
    const int count = ec_pages(pages);
    for (int i = 0; i < count; i++) {
        fputs(".SH \"ECLAT ", to);
        for (const char *c = pages[i]->name; *c; c++) fputc(toupper((unsigned char)*c), to);
        fputs("\"\n", to);
        ec_help_write(pages[i], &man, to);
    }
}
