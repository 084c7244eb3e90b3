#include "cli/help.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "view/view.h"

enum { WIDTH = 119, ITEM_TEXT = 1024, LIST_TEXT = 4096 };

/* No line ends within "(default: X" or "--option VALUE". */
static bool stays_with_next(const char *word, int size)
{
    if (!word[size]) return false;
    return !strncmp(word, "(default: ", 10) || (!strncmp(word, "--", 2) && word[size + 1] >= 'A' && word[size + 1] <= 'Z');
}

/* Words of text from column `at` on, below one another from column `indent`. */
static void wrap(FILE *to, const char *text, int at, int indent)
{
    bool is_first = true;
    while (*text) {
        int size = (int)strcspn(text, " ");
        if (stays_with_next(text, size)) size += 1 + (int)strcspn(text + size + 1, " ");
        if (!is_first && at + 1 + size > WIDTH) {
            fprintf(to, "\n%*s", indent, "");
            at = indent;
        } else if (!is_first) {
            fputc(' ', to);
            at++;
        }
        fprintf(to, "%.*s", size, text);
        at += size;
        text += size + strspn(text + size, " ");
        is_first = false;
    }
    fputc('\n', to);
}

static void plain_usage(FILE *to, const ec_help_page *page)
{
    fprintf(to, "Usage: eclat%s%s %s\n", *page->name ? " " : "", page->name, page->operands);
}

static void plain_heading(FILE *to, const char *text) { fprintf(to, "\n%s\n", text); }

static void plain_paragraph(FILE *to, const char *text)
{
    fputc('\n', to);
    wrap(to, text, 0, 0);
}

static void plain_list(FILE *to, const char *text)
{
    fputs("  ", to);
    wrap(to, text, 2, 2);
}

static void plain_item(FILE *to, const char *term, const char *text, int indent)
{
    int used = fprintf(to, "  %s", term);
    if (used >= indent) fprintf(to, "\n%*s", indent, "");
    else fprintf(to, "%*s", indent - used, "");
    wrap(to, text, indent, indent);
}

static const ec_help_style plain = {plain_usage, plain_heading, plain_paragraph, plain_item, plain_list};

static int by_name(const void *a, const void *b) { return strcmp(((const ec_option *)a)->name, ((const ec_option *)b)->name); }

/* In a list of names alone. */
static bool is_brief(const ec_help_page *page, const ec_option *row) { return (page->borrows || page->lacks) && row->uses & EC_OPTION_BORROWED; }

int ec_help_rows(const ec_help_page *page, ec_option rows[EC_OPTIONS_MAX + 2])
{
    int all = page->rows ? page->rows(rows) : 0, count = 0;
    ec_option_group last = EC_GROUP_OPTIONS;
    for (int i = 0; i < all; i++) {
        if (rows[i].group == EC_GROUP_MESSAGES && !is_brief(page, &rows[i])) last = EC_GROUP_MESSAGES;
        if (!(page->lacks && rows[i].not_in_window)) rows[count++] = rows[i];
    }
    rows[count++] = (ec_option){.name = "help", .letter = 'h', .group = last, .help = "show this"};
    rows[count++] = (ec_option){.name = "version", .group = last, .help = "print the version"};
    qsort(rows, (size_t)count, sizeof *rows, by_name);
    return count;
}

void ec_help_text(const ec_option *option, char *text, size_t size)
{
    const char *otherwise = option->otherwise;
    snprintf(text, size, otherwise ? "%s (default: %s)" : "%s", option->help, otherwise);
}

static void write_option(const ec_option *o, const ec_help_style *style, FILE *to, int indent)
{
    char text[ITEM_TEXT], term[96], letter[8] = "    ";
    ec_help_text(o, text, sizeof text);
    if (o->letter) snprintf(letter, sizeof letter, "-%c, ", o->letter);
    snprintf(term, sizeof term, o->value_optional ? "%s--%s[=%s]" : o->metavar ? "%s--%s %s" : "%s--%s", letter, o->name, o->metavar);
    style->item(to, term, text, indent);
}

static void write_group(const ec_help_page *page, const ec_option *rows, int count, ec_option_group group, const ec_help_style *style, FILE *to)
{
    bool has_any = false;
    for (int i = 0; i < count; i++) {
        if (rows[i].group != group || is_brief(page, &rows[i])) continue;
        if (!has_any) style->heading(to, ec_group_titles[group]);
        has_any = true;
        write_option(&rows[i], style, to, page->indent);
    }
    for (const ec_help_note *note = page->notes; has_any && note->heading; note++) {
        char term[64];
        if (strcmp(note->heading, ec_group_titles[group])) continue;
        snprintf(term, sizeof term, "    %s", note->term);
        style->item(to, term, note->text, page->indent);
    }
}

static bool is_group(const char *heading)
{
    for (int i = 0; i < EC_GROUP_COUNT; i++)
        if (!strcmp(ec_group_titles[i], heading)) return true;
    return false;
}

/* Names, and metavars where they are of options that the command has. */
static void write_list(const char *heading, const ec_option *rows, int count, bool lacks, const ec_help_style *style, FILE *to)
{
    char text[LIST_TEXT] = "";
    size_t used = 0;
    for (int i = 0; i < count && used < sizeof text; i++) {
        if (!(lacks ? rows[i].not_in_window != NULL : rows[i].uses & EC_OPTION_BORROWED)) continue;
        used += (size_t)snprintf(text + used, sizeof text - used, "%s--%s%s%s", used ? ", " : "", rows[i].name, lacks || !rows[i].metavar ? "" : " ",
                                 lacks || !rows[i].metavar ? "" : rows[i].metavar);
    }
    style->heading(to, heading);
    style->list(to, text);
}

void ec_help_write(const ec_help_page *page, const ec_help_style *style, FILE *to)
{
    ec_option rows[EC_OPTIONS_MAX + 2];
    int count = ec_help_rows(page, rows);
    style->usage(to, page);
    if (page->intro) style->paragraph(to, page->intro);
    if (page == &ec_help_main) {
        style->heading(to, "Commands");
        for (int i = 0; i < ec_help_page_count; i++) style->item(to, ec_help_pages[i].name, ec_help_pages[i].summary, page->indent);
    }
    for (int group = 0; group < EC_GROUP_COUNT; group++) write_group(page, rows, count, (ec_option_group)group, style, to);
    if (page->borrows) write_list(page->borrows, rows, count, false, style, to);
    if (page->lacks) {
        int all = page->rows(rows);
        qsort(rows, (size_t)all, sizeof *rows, by_name);
        write_list(page->lacks, rows, all, true, style, to);
    }
    const char *heading = "";
    for (const ec_help_note *note = page->notes; note->heading; note++) {
        if (is_group(note->heading)) continue;
        if (strcmp(heading, note->heading)) style->heading(to, note->heading);
        heading = note->heading;
        style->item(to, note->term, note->text, page->indent);
    }
    if (page->closing) style->paragraph(to, page->closing);
}

static const ec_help_page *find_page(const char *command)
{
    for (int i = 0; i < ec_help_page_count; i++)
        if (!strcmp(ec_help_pages[i].name, command)) return &ec_help_pages[i];
    return &ec_help_main;
}

static void write_short(const char *before, const ec_help_page *page, FILE *to)
{
    const char *options = strstr(page->operands, "[options]");
    char usage[64];
    snprintf(usage, sizeof usage, "%s %.*s", page->name, options ? (int)(options - page->operands) : (int)strlen(page->operands), page->operands);
    fprintf(to, "%s eclat %-35s %s\n", before, usage, page->summary);
}

void ec_help_short(FILE *to)
{
    const ec_help_page *render = find_page("render");
    write_short("Usage:", render, to);
    for (int i = 0; i < ec_help_page_count; i++)
        if (&ec_help_pages[i] != render) write_short("      ", &ec_help_pages[i], to);
    fprintf(to, "       eclat %-35s %s\n", "--help", "show more help");
}

void ec_print_help(const char *command)
{
    const ec_help_page *page = find_page(command);
    ec_help_write(page, &plain, stdout);
    const ec_view_module *window;
    if (!strcmp(page->name, "view") && ec_view_load(&window, NULL) == EC_OK) window->print_keys();
}

void ec_print_version(void)
{
    puts("eclat " ECLAT_VERSION);
}
