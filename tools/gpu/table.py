"""Figures of one kernel on one target, and the table of many."""

HEADS = ["target", "kernel", "registers", "spilled", "private", "occupancy", "code", "seconds", "of"]


class Row:
    """Registers and bytes are per work-item. occupancy: from 0 to 1. lane_atomics: number of atomic operations in the code that each lane does for
    itself. None: not known."""

    def __init__(self, target, kernel, source, **numbers):
        self.target, self.kernel, self.source = target, kernel, source
        self.numbers = dict.fromkeys(["registers", "spill_bytes", "private_bytes", "occupancy", "code_bytes", "lane_atomics", "compile_seconds"], None)
        self.numbers.update(numbers)

    def as_json(self):
        return {"target": self.target, "kernel": self.kernel, **self.numbers, "of": self.source.label}

    def cells(self):
        def text(name, form="{}"):
            return "-" if self.numbers[name] is None else form.format(self.numbers[name])
        return [self.target, self.kernel, text("registers"), text("spill_bytes"), text("private_bytes"), text("occupancy", "{:.0%}"),
                text("code_bytes"), text("compile_seconds", "{:.1f}"), self.source.label]


def of(rows):
    cells = [HEADS] + [row.cells() for row in rows]
    widths = [max(len(row[i]) for row in cells) for i in range(len(HEADS))]
    left = (0, 1, len(HEADS) - 1)
    return "\n".join("  ".join(cell.ljust(width) if i in left else cell.rjust(width)
                               for i, (cell, width) in enumerate(zip(row, widths))).rstrip() for row in cells)
