#include "cli/pages.h"

#include <stdlib.h>
#include <string.h>

const char *const ec_shell_names[] = {"bash", "fish", "zsh", NULL};

static const eclat_note notes[] = {
    {"Exit code", "0", "success"},
    {"Exit code", "1", "failure; or compare found a difference, or a case of selftest failed"},
    {"Exit code", "2", "the command line is wrong"},
    {"Environment", "ECLAT_DEVICE", "OpenCL device to use where --device is not given"},
    {"Environment", "ECLAT_COMPILE", "when to compile kernels where --compile is not given"},
    {"Environment", "ECLAT_KERNELS", "folder of kernels for first renders (default: those that were compiled when eclat was built); empty: none"},
    {"Environment", "NO_COLOR", "anything: messages on a terminal are not coloured"},
    {"Environment", "XDG_CACHE_HOME", "compiled kernels are kept in eclat/kernels below this folder (default: ~/.cache)"},
    {0}};

const eclat_command ec_page_main = {
    .name = "", .operands = "COMMAND [options]", .summary = "physically based rendering of glTF scenes with a stated error", .notes = notes,
    .intro = "eclat renders a glTF 2.0 scene to a physically based image with a stated error, on any OpenCL device.",
    .closing = "Results go to standard output; progress, warnings and errors go to standard error."};

const eclat_command ec_page_completion = {
    .name = "completion", .operands = "bash|fish|zsh", .summary = "print a completion script for a shell",
    .intro = "Prints a script that completes commands, options and their values. Where eclat is installed by a package, the scripts are in place. For one bash "
             "session: source <(eclat completion bash). For one of fish: eclat completion fish | source. For zsh: eclat completion zsh > _eclat, in a folder of $fpath."};

const eclat_command ec_page_help = {
    .name = "help", .operands = "[COMMAND]", .summary = "show the help of eclat or of a command; --man: the man page",
    .intro = "Shows the help of eclat, or that of one command."};

static int by_name(const void *a, const void *b)
{
    return strcmp((*(const eclat_command *const *)a)->name, (*(const eclat_command *const *)b)->name);
}

int ec_pages(const eclat_command *pages[EC_PAGES_MOST])
{
    int count = 0;
    pages[count++] = &ec_page_completion;
    pages[count++] = &ec_page_help;
    for (size_t i = 0; count < EC_PAGES_MOST && (pages[count] = eclat_command_at(i)); i++) count++;
    qsort(pages, (size_t)count, sizeof *pages, by_name);
    return count;
}

int ec_page_names(const char *names[EC_PAGES_MOST + 1])
{
    const eclat_command *pages[EC_PAGES_MOST];
    const int count = ec_pages(pages);
    for (int i = 0; i < count; i++) names[i] = pages[i]->name;
    names[count] = NULL;
    return count;
}

const eclat_command *ec_page_find(const char *name)
{
    const eclat_command *pages[EC_PAGES_MOST];
    for (int i = ec_pages(pages); i-- > 0;)
        if (!strcmp(pages[i]->name, name)) return pages[i];
    return NULL;
}

int ec_page_options(const eclat_command *page, eclat_option rows[EC_OPTIONS_MOST])
{
    int count = 0;
    if (page == &ec_page_help)
        rows[count++] = (eclat_option){.name = "man", .help = "print the man page, as in eclat help --man | man -l -", .group_title = "Options"};
    while (count < EC_OPTIONS_MOST - 2 && (rows[count] = eclat_option_at(page->name, (size_t)count)).name) count++;
    return count;
}
