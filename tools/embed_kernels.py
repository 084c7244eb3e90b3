#!/usr/bin/env python3
"""Flattens kernel sources and writes them as C strings.

An #include "x" is looked for beside the including file, then under --root. #line directives keep the real file and line
in compiler messages. Comments are removed, since a driver reads the source again in every run. host/cl/sources_join.c may also remove
a header marked "/* once */" that the same program has already. Every unit starts with FP_CONTRACT OFF: contraction opens cracks.
"""
import argparse
import os
import re
import sys

PRELUDE = "#pragma OPENCL FP_CONTRACT OFF\n"
QUOTED = re.compile(r'\s*#\s*include\s+"([^"]+)"')
ANGLED = re.compile(r"\s*#\s*include\s+<([^>]+)>")
COMMENT_OR_STRING = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.S)


class EmbedError(Exception):
    pass


def without_comments(text):
    """Returns the text with comments blanked out and all lines kept, so that directives in comments are ignored."""
    def blank(match):
        found = match.group(0)
        return found if found.startswith('"') else re.sub(r"[^\n]", " ", found)
    return COMMENT_OR_STRING.sub(blank, text)


def has_guard(directives):
    """Tells whether #ifndef X and #define X are the first two directives."""
    first = [line.split() for line in directives if line.lstrip().startswith("#")][:2]
    return len(first) == 2 and first[0][0] == "#ifndef" and first[1][:2] == ["#define", first[0][1]]


class Flattener:
    def __init__(self, root):
        self.root = os.path.abspath(root)
        self.repository = os.path.dirname(self.root)
        self.dependencies = []

    def unit(self, path, without=()):
        """Returns the text of one source; headers in `without` count as included already."""
        self.once = set(without)
        self.out = [PRELUDE]
        self.file(os.path.abspath(path), [], conditional=False)
        return "".join(self.out)

    def name(self, path):
        return os.path.relpath(path, self.repository).replace(os.sep, "/")

    def file(self, path, stack, conditional):
        name = self.name(path)
        if path in stack:
            raise EmbedError(f"{name}: includes itself: " + " -> ".join(self.name(p) for p in stack + [path]))
        if path not in self.dependencies:
            self.dependencies.append(path)
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise EmbedError(f"{name}: cannot be read: {error}")
        plain = without_comments(text).split("\n")
        if plain[-1] == "":
            plain.pop()
        guarded = has_guard(plain)
        # Repeats of a guarded header are left out here to keep units short, but only if its first copy is certainly
        # compiled. Within an #if the compiler must decide; the guards, which stay in the text, let it.
        if guarded and not conditional:
            self.once.add(path)
        self.line(1, name, " /* once */" if guarded and not conditional else "")
        depth = -1 if guarded else 0
        for number, directive in enumerate(plain, 1):
            if re.match(r"\s*#\s*if", directive):
                depth += 1
            elif re.match(r"\s*#\s*endif", directive):
                depth -= 1
            quoted, angled = QUOTED.match(directive), ANGLED.match(directive)
            if re.match(r"\s*#\s*pragma\s+once", directive):
                raise EmbedError(f"{name}:{number}: #pragma once: use #ifndef, #define, #endif, which all compilers know")
            if quoted:
                self.include(quoted.group(1), path, number, stack, conditional or depth > 0)
            elif angled:
                # Such includes are for the C side of a shared header. PoCL is slower with a source that contains the word: it preprocesses it.
                self.out.append(f'#error "<{angled.group(1)}> in a kernel: there are no system headers"\n')
            else:
                self.out.append(directive.strip().replace("#include", "# include") + "\n")

    def include(self, wanted, includer, number, stack, conditional):
        for folder in (os.path.dirname(includer), self.root):
            path = os.path.normpath(os.path.join(folder, wanted))
            if os.path.isfile(path):
                break
        else:
            raise EmbedError(f'{self.name(includer)}:{number}: "{wanted}" is neither beside this file nor under '
                             f"{self.name(self.root)}/")
        if path in self.once:
            self.out.append("\n")
            return
        self.file(path, stack + [includer], conditional)
        self.line(number + 1, self.name(includer))

    def line(self, number, name, mark=""):
        self.out.append(f'#line {number} "{name}"{mark}\n')


def c_string(text):
    """Returns one literal per line. Question marks are escaped against trigraphs; bytes that are not ASCII are octal."""
    literals = []
    for line in text.splitlines(keepends=True):
        body = ""
        for byte in line.encode("utf-8"):
            if byte == 10:
                body += "\\n"
            elif byte in b'"\\?':
                body += "\\" + chr(byte)
            elif 32 <= byte < 127:
                body += chr(byte)
            else:
                body += f"\\{byte:03o}"
        literals.append(f'    "{body}"')
    return "\n".join(literals)


def c_file(units):
    parts = ["/* Written by tools/embed_kernels.py; do not edit. */\n#include <string.h>\n\n#include \"cl/cl.h\"\n"]
    for name, text in units:
        parts.append(f"\nstatic const char source_{name}[] =\n{c_string(text)};\n")
    names = "".join(f'"{name}", ' for name, _ in units)
    sources = "".join(f"source_{name}, " for name, _ in units)
    parts.append(f"""
static const char *const names[] = {{{names}NULL}};
static const char *const sources[] = {{{sources}NULL}};

const char *const *ec_kernel_source_names(void) {{ return names; }}

const char *ec_kernel_source(const char *name) {{
    for (size_t i = 0; names[i]; i++)
        if (strcmp(names[i], name) == 0) return sources[i];
    return NULL;
}}
""")
    return "".join(parts)


def write_if_changed(path, text):
    """Leaves an unchanged file and its time stamp alone, so that nothing is compiled again."""
    try:
        with open(path, encoding="utf-8") as file:
            if file.read() == text:
                return
    except OSError:
        pass
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(description="Flatten kernel sources and embed them in C.")
    parser.add_argument("--root", default=os.path.join(here, "..", "kernels"), help="folder of the kernels")
    target = parser.add_mutually_exclusive_group(required=True)
    target.add_argument("--output", metavar="FILE", help="write a C file with every source")
    target.add_argument("--stdout", action="store_true", help="print the flattened text of one source")
    parser.add_argument("sources", nargs="*", help=".cl files; the name of a source is its file's name")
    arguments = parser.parse_args()
    flattener = Flattener(arguments.root)
    try:
        units = []
        for path in sorted(arguments.sources, key=os.path.basename):
            name = os.path.splitext(os.path.basename(path))[0]
            if not name.isidentifier() or name in [other for other, _ in units]:
                raise EmbedError(f"{flattener.name(path)}: the file's name must be an identifier and its own")
            units.append((name, flattener.unit(path)))
        if arguments.stdout:
            if len(units) != 1:
                raise EmbedError("--stdout takes one source")
            sys.stdout.write(units[0][1])
        else:
            write_if_changed(arguments.output, c_file(units))
    except EmbedError as error:
        sys.exit(f"embed_kernels.py: {error}")


if __name__ == "__main__":
    main()
