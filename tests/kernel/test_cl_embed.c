/* tier: quick */
/* tools/embed_kernels.py: it inlines includes, removes comments, keeps lines and includes headers once; mistakes are reported; and the
 * sources that it embedded here. */
#include <sys/stat.h>
#include <unistd.h>

#include "cl/cl.h"
#include "support/test.h"

static char root[4096], output[1 << 16];

static void put(const char *name, const char *text)
{
    char path[4400];
    snprintf(path, sizeof path, "%s/%s", root, name);
    FILE *file = fopen(path, "w");
    CHECK_MSG(file, "%s", path);
    if (!file) return;
    fputs(text, file);
    fclose(file);
}

/* Runs the tool on files of `root`; `output` then has its stdout and stderr. */
static int embed(const char *arguments)
{
    char command[9000];
    snprintf(command, sizeof command, "cd '%s' && python3 '%s/tools/embed_kernels.py' --root kernels %s 2>&1", root,
             ECLAT_SOURCE_DIR, arguments);
    FILE *pipe = popen(command, "r");
    if (!pipe) return -1;
    output[fread(output, 1, sizeof output - 1, pipe)] = 0;
    return pclose(pipe);
}

static int times(const char *text)
{
    int count = 0;
    for (const char *at = output; (at = strstr(at, text)); at++) count++;
    return count;
}

static void make_kernels(void)
{
    char command[9000];
    snprintf(command, sizeof command, "mkdir -p '%s/kernels/lib' '%s/kernels/stages'", root, root);
    CHECK(system(command) == 0);
    put("kernels/lib/a.h", "/* a */\n#ifndef A_H\n#define A_H\n#include \"b.h\" /* beside */\nint a;\n#endif\n");
    put("kernels/lib/b.h", "#ifndef B_H\n#define B_H\nint b;\n#ifdef HOST\n#include <stdint.h>\n#endif\n#endif\n");
    put("kernels/lib/fields.h", "FIELD(x)\n"); /* no guard: a list that is included several times */
    put("kernels/stages/good.cl", "#include \"lib/a.h\"\n// #include \"lib/none.h\"\n  #  include \"lib/b.h\"\n"
                                  "#include \"lib/fields.h\"\n#include \"lib/fields.h\"\n"
                                  "\"trigraph ?\?= \\\\ \xc3\xa9\"\nlast\n"
                                  "/*\n#include \"lib/none.h\"\n*/\n");
    put("kernels/stages/either.cl", "#ifdef X\n#include \"lib/b.h\"\n#endif\n#include \"lib/b.h\"\n");
    put("kernels/stages/missing.cl", "\n\n#include \"lib/none.h\"\n");
    put("kernels/stages/once.cl", "\n#pragma once\n");
    put("kernels/stages/ring.cl", "#include \"ring.cl\"\n");
}

static void text_is_flattened(void)
{
    CHECK(embed("--stdout kernels/stages/good.cl") == 0);
    CHECK(strstr(output, "#pragma OPENCL FP_CONTRACT OFF\n#line 1 \"kernels/stages/good.cl\"\n") == output);
    CHECK(times("int a;") == 1 && times("int b;") == 1 && times("FIELD(x)") == 2);
    CHECK(strstr(output, "#line 1 \"kernels/lib/b.h\" /* once */\n#ifndef B_H\n"));
    CHECK(strstr(output, "#line 5 \"kernels/lib/a.h\"\nint a;\n"));
    CHECK(strstr(output, "#line 2 \"kernels/stages/good.cl\"\n\n\n"));
    CHECK(strstr(output, "#line 6 \"kernels/stages/good.cl\"\n\"trigraph ?\?= \\\\ \xc3\xa9\"\nlast\n\n\n\n"));
    CHECK(times("beside") == 0 && times("none.h") == 0); /* comments */
    CHECK(strstr(output, "#error \"<stdint.h> in a kernel"));
    CHECK(times("#include") == 0); /* PoCL preprocesses a source that contains this word */
}

/* The first text may be missing from what is compiled; the second must be there. */
static void condition_keeps_both(void)
{
    CHECK(embed("--stdout kernels/stages/either.cl") == 0);
    CHECK(times("int b;") == 2 && times("#ifndef B_H") == 2 && times("/* once */") == 1);
}

static void mistakes_are_named(void)
{
    CHECK(embed("--stdout kernels/stages/missing.cl") != 0);
    CHECK_MSG(strcmp(output, "embed_kernels.py: kernels/stages/missing.cl:3: \"lib/none.h\" is neither beside this "
                             "file nor under kernels/\n") == 0, "%s", output);
    CHECK(embed("--stdout kernels/stages/ring.cl") != 0 && strstr(output, "includes itself"));
    CHECK(embed("--stdout kernels/stages/once.cl") != 0 && strstr(output, "kernels/stages/once.cl:2: #pragma once"));
    CHECK(embed("--stdout kernels/stages/nowhere.cl") != 0 && strstr(output, "kernels/stages/nowhere.cl"));
    CHECK(!strstr(output, "Traceback"));
}

static void c_file_is_the_same_text(void)
{
    char command[9000], out[4400];
    snprintf(out, sizeof out, "%s/check.c", root);
    CHECK(embed("--output first.c kernels/stages/good.cl kernels/stages/either.cl") == 0);
    CHECK(embed("--output second.c kernels/stages/either.cl kernels/stages/good.cl") == 0);
    put("check.c", "#include <stdio.h>\n#include \"cl/cl.h\"\nint main(void) {\n"
                   "    for (int i = 0; ec_kernel_source_names()[i]; i++)\n"
                   "        fprintf(stderr, \"%s \", ec_kernel_source_names()[i]);\n"
                   "    fputs(ec_kernel_source(\"good\"), stdout);\n    return ec_kernel_source(\"bad\") != NULL;\n}\n");
    snprintf(command, sizeof command, "cd '%s' && cmp first.c second.c && cc -std=c11 -Wall -Wextra -Werror -I'%s/host' "
             "first.c check.c -o check && ./check >text 2>names && [ \"$(cat names)\" = \"either good \" ] && "
             "python3 '%s/tools/embed_kernels.py' --root kernels --stdout kernels/stages/good.cl | cmp - text",
             root, ECLAT_SOURCE_DIR, ECLAT_SOURCE_DIR);
    CHECK(system(command) == 0);
}

static void every_stage_is_embedded(void)
{
    for (const char *const *name = ec_kernel_source_names(); *name; name++) {
        const char *source = ec_kernel_source(*name);
        char stage[256], lib[256], selftest[256];
        snprintf(stage, sizeof stage, "#line 1 \"kernels/stages/%s.cl\"", *name);
        snprintf(lib, sizeof lib, "#line 1 \"kernels/lib/%s.h\"", *name);
        snprintf(selftest, sizeof selftest, "#line 1 \"kernels/selftest/%s.cl\"", *name);
        CHECK_MSG(source && (strstr(source, stage) || strstr(source, lib) || strstr(source, selftest)), "%s", *name);
        CHECK_MSG(source && strncmp(source, "#pragma OPENCL FP_CONTRACT OFF\n", 31) == 0, "%s", *name);
    }
    CHECK(ec_kernel_source("no such stage") == NULL);
}

static bool is_stage(const char *name)
{
    char place[256];
    snprintf(place, sizeof place, "#line 1 \"kernels/stages/%s.cl\"", name);
    return strstr(ec_kernel_source(name), place) != NULL;
}

/* Each header comes once, and a compiler reads the same text in the whole as in the single sources. */
static void joined_stages_hold_all(void)
{
    enum { MOST = 64 };
    const char *stages[MOST + 1] = {NULL};
    char *joined = NULL, command[9000];
    size_t count = 0, bytes = 0;
    ec_error err = {0};
    snprintf(command, sizeof command, "%s/row.cl", root);
    FILE *row = fopen(command, "w");
    for (const char *const *name = ec_kernel_source_names(); row && *name && count < MOST; name++) {
        if (!is_stage(*name)) continue;
        stages[count++] = *name;
        fputs(ec_kernel_source(*name), row);
        bytes += strlen(ec_kernel_source(*name));
    }
    CHECK(row && fclose(row) == 0 && count > 5);
    CHECK_OK(ec_kernel_sources_join(stages, &joined, &err), err);
    if (!joined) return;
    CHECK_MSG(strlen(joined) < bytes / 2, "%zu of %zu bytes", strlen(joined), bytes);
    put("joined.cl", joined);
    snprintf(command, sizeof command, "cd '%s' && for f in joined row; do cc -E -P -x c -D__OPENCL_VERSION__=120 -DLANES=1 -DFEATURES=1 $f.cl >$f.i || exit 1; done; "
             "grep -q ec_shade joined.i && cmp joined.i row.i", root);
    CHECK(system(command) == 0);
    free(joined);
    CHECK(ec_kernel_sources_join((const char *const[]){"no such stage", NULL}, &joined, &err) == EC_FAILED && !joined);
    CHECK(strstr(err.text, "no such stage"));
}

int main(void)
{
    snprintf(root, sizeof root, "%s/embed-XXXXXX", ECLAT_TEST_OUT);
    if (!mkdtemp(root)) TEST_SKIP("no folder %s", root);
    make_kernels();
    text_is_flattened();
    condition_keeps_both();
    mistakes_are_named();
    c_file_is_the_same_text();
    every_stage_is_embedded();
    joined_stages_hold_all();
    char command[4200];
    snprintf(command, sizeof command, "rm -rf '%s'", root);
    if (!test_failures && system(command) != 0) printf("%s stays\n", root);
    TEST_END();
}
