#include "cli/help.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 119, ITEM_TEXT = 1024, LIST_TEXT = 4096 };

/* Tells whether a word stays on the line of the next one: no line ends within "(default: X" or "--option VALUE". */
static bool stays_with_next(const char *word, int size)
{
    if (!word[size]) return false;
    return !strncmp(word, "(default: ", 10) || (!strncmp(word, "--", 2) && word[size + 1] >= 'A' && word[size + 1] <= 'Z');
}

/* Writes words of text from column `at` on, and in further lines from column `indent` on. */
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

static void plain_usage(FILE *to, const eclat_command *page)
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

static int by_name(const void *a, const void *b) { return strcmp(((const eclat_option *)a)->name, ((const eclat_option *)b)->name); }

/* Tells whether an option is only named in a list. */
static bool is_brief(const eclat_command *page, const eclat_option *row) { return (page->borrows || page->lacks) && row->is_borrowed; }

/* Puts --help and --version, which all commands have, at the end. */
int ec_help_rows(const eclat_command *page, eclat_option rows[EC_OPTIONS_MOST])
{
    int all = ec_page_options(page, rows), count = 0;
    eclat_option last = {.group_title = "Options"};
    for (int i = 0; i < all; i++) {
        if (!is_brief(page, &rows[i])) last = rows[i];
        if (!rows[i].refused) rows[count++] = rows[i];
    }
    rows[count++] = (eclat_option){.name = "help", .letter = 'h', .group = last.group, .group_title = last.group_title, .help = "show this"};
    rows[count++] = (eclat_option){.name = "version", .group = last.group, .group_title = last.group_title, .help = "print the version and how eclat was built"};
    qsort(rows, (size_t)count, sizeof *rows, by_name);
    return count;
}

void ec_help_text(const eclat_option *option, char *text, size_t size)
{
    const char *otherwise = option->otherwise;
    snprintf(text, size, otherwise ? "%s (default: %s)" : "%s", option->help, otherwise);
}

static void write_option(const eclat_option *o, const ec_help_style *style, FILE *to, int indent)
{
    char text[ITEM_TEXT], term[96], letter[8] = "    ";
    ec_help_text(o, text, sizeof text);
    if (o->letter) snprintf(letter, sizeof letter, "-%c, ", o->letter);
    snprintf(term, sizeof term, o->takes_value == 2 ? "%s--%s[=%s]" : o->metavar ? "%s--%s %s" : "%s--%s", letter, o->name, o->metavar);
    style->item(to, term, text, indent);
}

/* Returns the width of the column of options, which is wide if their names are long. */
static int indent_of(const eclat_command *page) { return strncmp(page->operands, "SCENE", 5) ? 21 : 29; }

/* Writes the options whose group has this title, and further notes on it. */
static void write_group(const eclat_command *page, const eclat_option *rows, int count, const char *title, const ec_help_style *style, FILE *to)
{
    style->heading(to, title);
    for (int i = 0; i < count; i++)
        if (!strcmp(rows[i].group_title, title) && !is_brief(page, &rows[i])) write_option(&rows[i], style, to, indent_of(page));
    for (const eclat_note *note = page->notes; note && note->heading; note++) {
        char term[64];
        if (strcmp(note->heading, title)) continue;
        snprintf(term, sizeof term, "    %s", note->term);
        style->item(to, term, note->text, indent_of(page));
    }
}

static bool is_group(const char *heading, const eclat_option *rows, int count)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(rows[i].group_title, heading)) return true;
    return false;
}

/* Writes a list of names, with metavars for options that the command has. */
static void write_list(const char *heading, const eclat_option *rows, int count, bool lacks, const ec_help_style *style, FILE *to)
{
    char text[LIST_TEXT] = "";
    size_t used = 0;
    for (int i = 0; i < count && used < sizeof text; i++) {
        if (!(lacks ? rows[i].refused != NULL : rows[i].is_borrowed)) continue;
        used += (size_t)snprintf(text + used, sizeof text - used, "%s--%s%s%s", used ? ", " : "", rows[i].name, lacks || !rows[i].metavar ? "" : " ",
                                 lacks || !rows[i].metavar ? "" : rows[i].metavar);
    }
    style->heading(to, heading);
    style->list(to, text);
}

static void write_commands(const ec_help_style *style, FILE *to)
{
    const eclat_command *pages[EC_PAGES_MOST];
    const int count = ec_pages(pages);
    style->heading(to, "Commands");
    for (int i = 0; i < count; i++) style->item(to, pages[i]->name, pages[i]->summary, indent_of(&ec_page_main));
}

/* Writes the notes that belong to no group. */
static void write_notes(const eclat_command *page, const eclat_option *rows, int count, const ec_help_style *style, FILE *to)
{
    const char *heading = "";
    for (const eclat_note *note = page->notes; note && note->heading; note++) {
        if (is_group(note->heading, rows, count)) continue;
        if (strcmp(heading, note->heading)) style->heading(to, note->heading);
        heading = note->heading;
        style->item(to, note->term, note->text, indent_of(page));
    }
}

void ec_help_write(const eclat_command *page, const ec_help_style *style, FILE *to)
{
    eclat_option rows[EC_OPTIONS_MOST], all[EC_OPTIONS_MOST];
    const int count = ec_help_rows(page, rows), all_count = ec_page_options(page, all);
    const char *title = "";
    style->usage(to, page);
    if (page->intro) style->paragraph(to, page->intro);
    if (page == &ec_page_main) write_commands(style, to);
    if (!all_count) write_group(page, rows, count, "Options", style, to);
    for (int i = 0; i < all_count; i++)
        if (!is_brief(page, &all[i]) && strcmp(title, all[i].group_title)) write_group(page, rows, count, title = all[i].group_title, style, to);
    if (page->borrows) write_list(page->borrows, rows, count, false, style, to);
    qsort(all, (size_t)all_count, sizeof *all, by_name);
    if (page->lacks) write_list(page->lacks, all, all_count, true, style, to);
    write_notes(page, rows, count, style, to);
    if (page->closing) style->paragraph(to, page->closing);
}

static void write_short(const char *before, const eclat_command *page, FILE *to)
{
    const char *options = strstr(page->operands, "[options]");
    char usage[64];
    snprintf(usage, sizeof usage, "%s %.*s", page->name, options ? (int)(options - page->operands) : (int)strlen(page->operands), page->operands);
    fprintf(to, "%s eclat %-35s %s\n", before, usage, page->summary);
}

void ec_help_short(FILE *to)
{
    const eclat_command *pages[EC_PAGES_MOST], *render = ec_page_find("render");
    const int count = ec_pages(pages);
    write_short("Usage:", render, to);
    for (int i = 0; i < count; i++)
        if (pages[i] != render) write_short("      ", pages[i], to);
    fprintf(to, "       eclat %-35s %s\n", "--help", "show more help");
}

void ec_help_plain(const eclat_command *page, FILE *to)
{
    static const ec_help_style plain = {plain_usage, plain_heading, plain_paragraph, plain_item, plain_list};
    eclat_note key;
    ec_help_write(page, &plain, to);
    if (strcmp(page->name, "view")) return;
    for (size_t i = 0; (key = eclat_view_key_at(i)).term; i++) {
        if (i == 0) plain_heading(to, key.heading);
        fprintf(to, "  %-28s %s\n", key.term, key.text);
    }
}
