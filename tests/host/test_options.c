/* tier: quick */
/* The table of options of `eclat render` is complete, and agrees with the values that setters accept and with the settings in reports. */
#include <ctype.h>

#include "jobs/render_request.h"
#include "report/settings.h"
#include "support/test.h"

static bool is_among(const char *word, const char *text)
{
    size_t size = strlen(word);
    for (const char *at = text; (at = strstr(at, word)); at++)
        if ((at == text || !isalnum((unsigned char)at[-1])) && !isalnum((unsigned char)at[size])) return true;
    return false;
}

static void check_words(const ec_option *o)
{
    const char *said[] = {o->help, o->otherwise ? o->otherwise : o->help};
    for (int i = 0; i < 2; i++) {
        size_t size = strlen(said[i]);
        CHECK_MSG(size > 0 && !strchr(said[i], '\n') && !strstr(said[i], "  "), "--%s", o->name);
        CHECK_MSG(said[i][size - 1] != '.' && said[i][size - 1] != ' ', "--%s ends with a stop", o->name);
    }
}

/* The message lists all words that the option accepts, and it accepts no other. */
static void check_choices(const ec_option *o)
{
    ec_render_request request = {0};
    ec_error err;
    for (const char *const *word = o->choices; word && *word; word++) {
        CHECK_MSG(is_among(*word, o->help) || is_among(*word, o->otherwise), "--%s: help does not know %s", o->name, *word);
        CHECK_MSG(ec_option_store(o, &request, *word, &err) == EC_OK, "--%s does not take %s", o->name, *word);
    }
    if (o->choices) CHECK_MSG(ec_option_store(o, &request, "no-such-choice", &err) == EC_USAGE, "--%s takes anything", o->name);
}

static void check_row(const ec_option *o)
{
    CHECK_MSG((o->set || o->kind) && o->help, "--%s", o->name);
    CHECK_MSG(o->group > EC_GROUP_OPTIONS && o->group < EC_GROUP_COUNT, "--%s is in no group", o->name);
    CHECK_MSG(o->metavar || (!o->choices && !o->value_optional && !o->otherwise), "--%s: values of a flag", o->name);
    CHECK_MSG(!o->metavar || isupper((unsigned char)*o->metavar) || *o->metavar == 'W', "--%s %s", o->name, o->metavar);
    CHECK_MSG(ec_render_row(o->name) == o, "--%s is there twice", o->name);
    for (int i = 0; o->letter && i < ec_render_row_count; i++)
        CHECK_MSG(&ec_render_rows[i] == o || ec_render_rows[i].letter != o->letter, "-%c is there twice", o->letter);
    CHECK_MSG(!(o->uses & EC_OPTION_SEQUENCE) || o->uses & EC_OPTION_NO_IDENTITY, "--%s: frames of one sequence would differ by it", o->name);
    check_words(o);
    check_choices(o);
}

static const ec_setting *find_setting(const char *option)
{
    for (int i = 0; i < ec_setting_count; i++)
        if (!strcmp(ec_settings[i].option, option)) return &ec_settings[i];
    return NULL;
}

/* Tells whether some value of the option changes a render request. */
static bool changes_options(const ec_option *o)
{
    static const char *const values[] = {NULL, "3", "0.5", "7x5", "1:2", "a.exr", "1,2,3", "1,2,3,4", "on", "off", "lights", "punctual-lights"};
    for (size_t i = 0; i < sizeof values / sizeof values[0] + 16; i++) {
        const size_t fixed = sizeof values / sizeof values[0];
        const char *value = i < fixed ? values[i] : NULL;
        if (i >= fixed) {
            for (size_t k = 0; o->choices && k <= i - fixed; k++)
                if (!(value = o->choices[k])) break;
        }
        if (!value && (o->metavar && !o->value_optional)) continue;
        ec_render_request before, after;
        ec_error err;
        memset(&before, 0, sizeof before);
        after = before;
        if (ec_option_store(o, &after, value, &err) == EC_OK && memcmp(&before.options, &after.options, sizeof before.options)) return true;
    }
    return false;
}

/* Options that change samples have a trait. Limits change the number of samples; all others leave the image as it is. */
static void check_settings(void)
{
    int found = 0;
    for (int i = 0; i < ec_setting_count; i++) {
        const ec_option *row = ec_render_row(ec_settings[i].option);
        CHECK_MSG(row != NULL, "no option is called %s", ec_settings[i].option);
        CHECK_MSG(find_setting(ec_settings[i].option) == &ec_settings[i], "%s is there twice", ec_settings[i].option);
        if (row) CHECK_MSG((ec_settings[i].identity == EC_NOT_IDENTITY) == !!(row->uses & EC_OPTION_NO_IDENTITY), "--%s: part of an identity or not?", row->name);
        CHECK_MSG(!ec_settings[i].json == !ec_settings[i].exr, "--%s is told in JSON or EXR alone", ec_settings[i].option);
        CHECK(!ec_settings[i].exr || !strncmp(ec_settings[i].exr, "eclat.", 6));
    }
    for (int i = 0; i < ec_render_row_count; i++) {
        const ec_option *o = &ec_render_rows[i];
        if (!changes_options(o) || o->uses & EC_OPTION_NO_IDENTITY || o->group == EC_GROUP_LIMITS) continue;
        CHECK_MSG(find_setting(o->name) != NULL, "no setting tells --%s", o->name);
        found++;
    }
    CHECK_MSG(found >= 15, "only %d options change what is rendered", found);
}

static void check_trait(const char *option, const ec_render_options *options, const char *expected)
{
    char text[512];
    ec_setting_trait(find_setting(option), options, text, sizeof text);
    CHECK_MSG(!strcmp(text, expected), "--%s is %s, not %s", option, text, expected);
}

int main(void)
{
    for (int i = 0; i < ec_render_row_count; i++) check_row(&ec_render_rows[i]);
    check_settings();

    /* Traits of existing slices must not change. */
    ec_render_options o = {.width = 7, .height = 5, .cutoff = 0.25, .seed = UINT64_MAX};
    check_trait("size", &o, "7x5");
    check_trait("seed", &o, "18446744073709551615");
    check_trait("replicates", &o, "4");
    check_trait("adaptive", &o, "off");
    check_trait("max-depth", &o, "inf");
    check_trait("rr", &o, "auto");
    check_trait("clamp", &o, "off");
    check_trait("filter-width", &o, "1.5");
    check_trait("fstop", &o, "0");
    check_trait("cutoff", &o, "0");
    check_trait("screen-window", &o, "whole");
    check_trait("without", &o, "nothing");
    o.integrator = EC_INTEGRATOR_WHITTED;
    o.clamp = 0.1;
    check_trait("cutoff", &o, "0.25");
    check_trait("clamp", &o, "0.10000000000000001");
    o.denoise = EC_DENOISER_OIDN;
    check_trait("replicates", &o, "8");
    TEST_END();
}
