/* Writes shell completion of commands, options and their values from the tables of options. */
#include <stdbool.h>
#include <string.h>

#include "cli/help.h"

/* Tells whether a value is completed by files. Others are completed from a list, or not at all. */
static bool is_file(const eclat_option *option) { return option->metavar && !strncmp(option->metavar, "FILE", 4); }

static void put_words(FILE *to, const char *const *words)
{
    for (; *words; words++) fprintf(to, "%s%s", *words, words[1] ? " " : "");
}

/* Writes the operands to choose from; returns false if there are none. */
static bool put_operands(FILE *to, const eclat_command *page, const char *before, const char *after)
{
    const char *names[EC_PAGES_MOST + 1];
    if (page != &ec_page_help && page != &ec_page_completion) return false;
    ec_page_names(names);
    fputs(before, to);
    put_words(to, page == &ec_page_help ? names : ec_shell_names);
    fputs(after, to);
    return true;
}

static bool has_files(const eclat_command *page) { return *page->operands != '['; }

/* Writes the case of each option with a value: `files` for a file, `words` for one of a list, otherwise nothing. */
static void bash_values(const eclat_option *rows, int count, FILE *to)
{
    for (int i = 0; i < count; i++) {
        if (!rows[i].metavar) continue;
        fprintf(to, "            --%s=", rows[i].name);
        if (rows[i].takes_value != 2) fprintf(to, "|--%s", rows[i].name);
        if (rows[i].letter) fprintf(to, "|-%c", rows[i].letter);
        fputs(is_file(&rows[i]) ? ") files=1" : ") words=\"", to);
        if (!is_file(&rows[i]) && rows[i].choices) put_words(to, rows[i].choices);
        fputs(is_file(&rows[i]) ? " ;;\n" : "\" value=1 ;;\n", to);
    }
}

static void bash_command(const eclat_command *page, FILE *to)
{
    eclat_option rows[EC_OPTIONS_MOST];
    int count = ec_help_rows(page, rows);
    fprintf(to, "    %s)\n        case \"$prev\" in\n", page->name);
    bash_values(rows, count, to);
    fputs("            *) options=\"", to);
    for (int i = 0; i < count; i++) fprintf(to, "%s--%s%s", i ? " " : "", rows[i].name, rows[i].takes_value == 2 ? "=" : "");
    fputs("\"\n                ", to);
    if (!put_operands(to, page, "words=\"", "\" ;;\n")) fputs(has_files(page) ? "files=1 ;;\n" : ";;\n", to);
    fputs("        esac ;;\n", to);
}

static void bash(FILE *to)
{
    const eclat_command *pages[EC_PAGES_MOST];
    const char *names[EC_PAGES_MOST + 1];
    const int count = ec_pages(pages);
    fputs("# Completion of eclat for bash, as `eclat completion bash` prints it.\n"
          "_eclat() {\n"
          "    local cur=\"${COMP_WORDS[COMP_CWORD]}\" prev=\"${COMP_WORDS[COMP_CWORD-1]}\" words= options= files= value=\n"
          "    COMPREPLY=()\n"
          "    if [ \"$cur\" = = ]; then cur= prev=\"$prev=\"\n" /* bash treats --name=value as three words */
          "    elif [ \"$prev\" = = ]; then prev=\"${COMP_WORDS[COMP_CWORD-2]}=\"; fi\n"
          "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
          "        mapfile -t COMPREPLY < <(compgen -W \"", to);
    ec_page_names(names);
    put_words(to, names);
    fputs(" --help --version\" -- \"$cur\")\n"
          "        return\n"
          "    fi\n"
          "    case \"${COMP_WORDS[1]}\" in\n", to);
    for (int i = 0; i < count; i++) bash_command(pages[i], to);
    fputs("    esac\n"
          "    case \"$cur\" in\n"
          "    -*) [ -n \"$value\" ] || words=\"$options\" files= ;;\n"
          "    esac\n"
          "    [ -z \"$words\" ] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n"
          "    [ -z \"$files\" ] || mapfile -t -O \"${#COMPREPLY[@]}\" COMPREPLY < <(compgen -f -- \"$cur\")\n"
          "    case \"${COMPREPLY[0]}\" in *=) compopt -o nospace 2>/dev/null ;; esac\n"
          "}\n"
          "complete -o filenames -F _eclat eclat\n", to);
}

/* Writes text within '...[text]', escaping zsh's brackets, colons and quotes. */
static void zsh_text(FILE *to, const char *text)
{
    for (; *text; text++) {
        if (strchr("[]:\\", *text)) fputc('\\', to);
        fputs(*text == '\'' ? "'\\''" : (const char[]){*text, 0}, to);
    }
}

static void zsh_option(const eclat_option *o, FILE *to)
{
    char text[1024];
    ec_help_text(o, text, sizeof text);
    for (int form = o->letter ? 0 : 1; form < 2; form++) {
        if (form == 0) fprintf(to, "            '%s-%c%s[", o->repeats ? "*" : "", o->letter, o->metavar ? "+" : "");
        else fprintf(to, "            '%s--%s%s[", o->repeats ? "*" : "", o->name, o->takes_value == 2 ? "=-" : o->metavar ? "=" : "");
        zsh_text(to, text);
        fputc(']', to);
        if (o->metavar) {
            fputs(o->takes_value == 2 ? "::" : ":", to);
            zsh_text(to, o->metavar);
            fputc(':', to);
            if (o->choices) fputc('(', to), put_words(to, o->choices), fputc(')', to);
            else if (is_file(o)) fputs("_files", to);
        }
        fputs("' \\\n", to);
    }
}

static void zsh(FILE *to)
{
    const eclat_command *pages[EC_PAGES_MOST];
    const int page_count = ec_pages(pages);
    fputs("#compdef eclat\n"
          "# Completion of eclat for zsh, as `eclat completion zsh` prints it.\n"
          "_eclat() {\n"
          "    local -a commands=(\n", to);
    for (int i = 0; i < page_count; i++) {
        fprintf(to, "        '%s:", pages[i]->name);
        zsh_text(to, pages[i]->summary);
        fputs("'\n", to);
    }
    fputs("    )\n"
          "    if (( CURRENT == 2 )); then\n"
          "        _describe command commands\n"
          "        return\n"
          "    fi\n"
          "    local command=$words[2]\n"
          "    shift words\n"
          "    (( CURRENT-- ))\n"
          "    case $command in\n", to);
    for (int i = 0; i < page_count; i++) {
        eclat_option rows[EC_OPTIONS_MOST];
        int count = ec_help_rows(pages[i], rows);
        fprintf(to, "    %s)\n        _arguments -s \\\n", pages[i]->name);
        for (int k = 0; k < count; k++) zsh_option(&rows[k], to);
        fputs("            '*:operand:", to);
        if (!put_operands(to, pages[i], "(", ")' ;;\n")) fputs(has_files(pages[i]) ? "_files' ;;\n" : "' ;;\n", to);
    }
    fputs("    esac\n"
          "}\n"
          "_eclat \"$@\"\n", to);
}

/* Writes text within '...', escaping fish's quotes and backslashes. */
static void fish_text(FILE *to, const char *text)
{
    for (; *text; text++) {
        if (strchr("'\\", *text)) fputc('\\', to);
        fputc(*text, to);
    }
}

/* -r: takes a value; -f: which is not a file. If a value may follow only after =, fish offers it with the plain option. */
static void fish_option(const eclat_command *page, const eclat_option *o, FILE *to)
{
    char text[1024];
    ec_help_text(o, text, sizeof text);
    fprintf(to, "complete -c eclat -n '__eclat_is %s' -l %s", page->name, o->name);
    if (o->letter) fprintf(to, " -s %c", o->letter);
    if (o->metavar) fputs(o->takes_value == 2 ? " -f" : is_file(o) ? " -r -F" : " -x", to);
    if (o->choices) fputs(" -a '", to), put_words(to, o->choices), fputc('\'', to);
    fputs(" -d '", to);
    fish_text(to, text);
    fputs("'\n", to);
}

static void fish(FILE *to)
{
    const eclat_command *pages[EC_PAGES_MOST];
    const int page_count = ec_pages(pages);
    fputs("# Completion of eclat for fish, as `eclat completion fish` prints it.\n"
          "function __eclat_is_first\n"
          "    test (count (commandline -opc)) -eq 1\n"
          "end\n"
          "function __eclat_is -a command\n"
          "    set -l words (commandline -opc)\n"
          "    test (count $words) -ge 2; and test $words[2] = $command\n"
          "end\n"
          "complete -c eclat -n __eclat_is_first -f -l help -s h -d 'show this'\n"
          "complete -c eclat -n __eclat_is_first -f -l version -d 'print the version and how eclat was built'\n", to);
    for (int i = 0; i < page_count; i++) {
        eclat_option rows[EC_OPTIONS_MOST];
        const int count = ec_help_rows(pages[i], rows);
        char before[96];
        fprintf(to, "complete -c eclat -n __eclat_is_first -f -a %s -d '", pages[i]->name);
        fish_text(to, pages[i]->summary);
        fputs("'\n", to);
        snprintf(before, sizeof before, "complete -c eclat -n '__eclat_is %s' -f -a '", pages[i]->name);
        if (!put_operands(to, pages[i], before, "'\n") && !has_files(pages[i]))
            fprintf(to, "complete -c eclat -n '__eclat_is %s' -f\n", pages[i]->name);
        for (int k = 0; k < count; k++) fish_option(pages[i], &rows[k], to);
    }
}

void ec_help_completion(const char *shell, FILE *to)
{
    if (!strcmp(shell, "zsh")) zsh(to);
    else if (!strcmp(shell, "fish")) fish(to);
    else bash(to);
}
