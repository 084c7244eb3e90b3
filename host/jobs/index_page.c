#include "jobs/index_page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "image/exr_header.h"
#include "jobs/sheet.h"
#include "report/format.h"

static const char head[] =
    "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n<style>\n"
    ":root { color-scheme: light dark; }\n"
    "body { margin: 0 auto; max-width: 110rem; padding: 1rem; font: 16px/1.5 system-ui, sans-serif; }\n"
    "main { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(16rem, 100%), 1fr)); gap: 1.5rem 1rem; }\n"
    "figure { margin: 0; min-width: 0; overflow-wrap: anywhere; }\n"
    "img { display: block; width: 100%; aspect-ratio: 1; object-fit: contain; background: #8883; }\n"
    "figcaption b { display: block; }\n.none { aspect-ratio: 1; padding: 1rem; border: 1px dashed; overflow: auto; }\n"
    "code { font: .8rem ui-monospace, monospace; }\n</style>\n";

static void put(FILE *to, const char *before, const char *text, const char *behind)
{
    fputs(before, to);
    for (; *text; text++) {
        if (*text == '<') fputs("&lt;", to);
        else if (*text == '&') fputs("&amp;", to);
        else if (*text == '"') fputs("&quot;", to);
        else fputc(*text, to);
    }
    fputs(behind, to);
}

/* Writes a name into a URL, in which only letters, digits and these stand for themselves (RFC 3986, unreserved). */
static void put_url(FILE *to, const char *before, const char *name, const char *behind)
{
    fputs(before, to);
    for (; *name; name++) {
        const unsigned char c = (unsigned char)*name;
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_' || c == '~';
        fprintf(to, is_plain ? "%c" : "%%%02X", c);
    }
    fputs(behind, to);
}

static void put_error(FILE *to, const char *exr)
{
    double error, bound, samples, seconds;
    if (!ec_exr_number(exr, "eclat.error", &error)) fputs("error not known", to);
    else fprintf(to, "error %s", ec_percent(error).text);
    if (ec_exr_number(exr, "eclat.errorBound", &bound)) fprintf(to, ", with 95 %% confidence under %s", ec_percent(bound).text);
    else fputs(", no bound", to);
    if (ec_exr_number(exr, "eclat.samplesPerPixel", &samples) && ec_exr_number(exr, "eclat.seconds", &seconds))
        fprintf(to, "; %.0f samples a pixel in %s", samples, ec_seconds(seconds).text);
}

static void put_entry(FILE *to, const ec_entry *entry, const char *exr, bool is_there)
{
    fputs("<figure>", to);
    if (is_there) {
        put_url(to, "<a href=\"", entry->name, ".png\">");
        put_url(to, "<img loading=\"lazy\" src=\"", entry->name, ".png\"");
        put(to, " alt=\"", entry->name, "\"></a>");
    } else {
        put(to, "<div class=\"none\">", entry->why_not ? entry->why_not : "not rendered yet", "</div>");
    }
    put(to, "<figcaption><b>", entry->name, "</b>");
    if (is_there) {
        char *command = ec_exr_header_text(exr, "eclat.command");
        put_error(to, exr);
        put_url(to, " (<a href=\"", entry->name, ".exr\">EXR</a>)");
        put(to, "<details><summary>Command</summary><code>", command ? command : "", "</code></details>");
        free(command);
    }
    fputs("</figcaption></figure>\n", to);
}

ec_result ec_index_write(const char *file, const char *folder, const ec_entries *entries, ec_error *err)
{
    char *text = NULL, path[PATH_MAX + 16], exr[PATH_MAX + 16];
    size_t size = 0;
    uint32_t count = 0;
    char **pictures = calloc(entries->count + 1, sizeof *pictures);
    FILE *to = open_memstream(&text, &size);
    ec_result result = pictures && to ? EC_OK : ec_fail(err, "out of memory for an index of '%s'", folder);
    for (uint32_t i = 0; result == EC_OK && i < entries->count; i++) {
        snprintf(path, sizeof path, "%s/%s.png", folder, entries->list[i].name);
        if (access(path, R_OK) == 0 && (pictures[count] = strdup(path))) count++;
    }
    if (to) {
        fputs(head, to);
        put(to, "<title>", file, "</title>\n");
        put(to, "<h1>", file, "</h1>\n");
        fprintf(to, "<p>%u of %u pictures. Each states its error: the root-mean-square difference per pixel from the converged picture, relative to its mean "
                    "luminance.</p>\n<main>\n", count, entries->count);
        for (uint32_t i = 0; i < entries->count; i++) {
            snprintf(path, sizeof path, "%s/%s.png", folder, entries->list[i].name);
            snprintf(exr, sizeof exr, "%s/%s.exr", folder, entries->list[i].name);
            put_entry(to, &entries->list[i], exr, access(path, R_OK) == 0);
        }
        fputs("</main>\n</html>\n", to);
        if (fclose(to) != 0) result = ec_fail(err, "out of memory for an index of '%s'", folder);
    }
    snprintf(path, sizeof path, "%s/index.html", folder);
    if (result == EC_OK) result = ec_atomic_write(path, text, size, err);
    snprintf(path, sizeof path, "%s/index.png", folder);
    if (result == EC_OK) result = ec_sheet_write(path, pictures, count, err);
    for (uint32_t i = 0; i < count; i++) free(pictures[i]);
    free(pictures);
    free(text);
    return result;
}
