/* tier: quick */
/* Texts are cut between characters of one to four bytes, and contain nothing that a terminal interprets. */
#include "base/error.h"
#include "base/text.h"
#include "support/test.h"

static char said[4096];
static void keep(void *user, ec_severity severity, const char *text)
{
    (void)user, (void)severity;
    snprintf(said, sizeof said, "%s", text);
}

int main(void)
{
    static const char text[] = "aé€😀b"; /* ends at 1, 3, 6, 10, 11 */
    static const int ends[13] = {0, 1, 1, 3, 3, 3, 6, 6, 6, 6, 10, 11, 11};
    char out[32], half[8];
    for (int most = 0; most < 13; most++) {
        CHECK_MSG(ec_text_cut(text, most) == ends[most], "%d bytes of at most %d", ec_text_cut(text, most), most);
        snprintf(half, most < 8 ? (size_t)most + 1 : sizeof half, "%s", text); /* a text that was cut before */
        CHECK(ec_text_cut(half, 8) == ends[most < 7 ? most : 7]);
    }
    snprintf(out, sizeof out, "%.*s", EC_CUT(text, 5));
    CHECK(!strcmp(out, "aé"));
    CHECK(ec_text_cut("", 5) == 0 && ec_text_cut("\x80\x80\x80\x80\x80\x80", 5) == 5); /* not UTF-8: unchanged */
    ec_error err;
    char many[3001] = "";
    for (int i = 0; i < 1500; i++) strcat(many, "é");
    ec_fail(&err, "%s", many);
    CHECK(strlen(err.text) == 2046);
    ec_fail(&err, "%.100s", many);
    ec_fail_more(&err, "%s", many);
    CHECK(strlen(err.text) == 2046);
    ec_log log = {keep, NULL};
    ec_warn(&log, "%s", many);
    CHECK(strlen(said) == 2046);
    /* In names and messages, characters that terminals interpret are replaced; visible ones stay. */
    char name[64] = "a\x1b[2J\n\xe2\x80\xae" "b\x7f\xc2\x9b" "é€😀\t\xe2\x81\xa9";
    ec_text_clean(name);
    CHECK_MSG(!strcmp(name, "a?[2J??b??é€😀\t?"), "%s", name);
    ec_fail(&err, "%s: cannot open", "x\r\ny");
    CHECK_MSG(!strcmp(err.text, "x??y: cannot open"), "%s", err.text);
    ec_fail(&err, "the compiler says:%s", "\n  error: no"); /* line breaks stay */
    CHECK(strchr(err.text, '\n') != NULL);
    TEST_END();
}
