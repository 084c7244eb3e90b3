#!/usr/bin/env python3
"""usage: tools/docs_tables.py [--check]
Writes the tables of docs/*.md that lie between `<!-- generated from data/NAME.json -->` and `<!-- end -->`, from docs/data/NAME.json. The
programs of tools/bench write that file with --table. With --check it changes nothing, names tables that are out of date, and exits with 1 if
there are any."""
import json
import pathlib
import re
import sys

DOCS = pathlib.Path(__file__).resolve().parent.parent / "docs"
BLOCK = re.compile(r"(<!-- generated from (data/[\w-]+\.json) -->\n).*?(<!-- end -->)", re.S)


def markdown(data):
    """Returns the table, and a line that says where it is from."""
    lines = ["| " + " | ".join(row).replace(" %", "\u00a0%") + " |" for row in [data["columns"], ["---"] * len(data["columns"]), *data["rows"]]]
    source = f"`{data['command']}`: " if data["command"] else ""
    return "\n".join([*lines, "", f"{source}{data['setting']}. Recorded {data['date']}, commit {data['commit']}.", ""])


def filled(text):
    def block(match):
        with open(DOCS / match[2], encoding="utf-8") as file:
            return f"{match[1]}\n{markdown(json.load(file))}\n{match[3]}"
    return BLOCK.sub(block, text)


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    stale = []
    for page in sorted(DOCS.glob("*.md")):
        text = page.read_text(encoding="utf-8")
        new = filled(text)
        if new != text:
            stale.append(page.name)
            if not check:
                page.write_text(new, encoding="utf-8")
    if check and stale:
        sys.exit(f"stale tables in {', '.join(stale)}; run tools/docs_tables.py")


if __name__ == "__main__":
    main()
