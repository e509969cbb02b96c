"""Columns that line up: the first one left, the others right unless they are words."""


def table(heading, rows):
    cells = [[str(cell) for cell in row] for row in [heading, *rows]]
    widths = [max(len(row[i]) for row in cells) for i in range(len(heading))]
    words = [any(char.isalpha() and char not in "eE" for row in cells[1:] for char in row[i]) for i in range(len(heading))]
    return "\n".join("  " + "  ".join(
        cell.ljust(width) if left or i == 0 else cell.rjust(width)
        for i, (cell, width, left) in enumerate(zip(row, widths, words))).rstrip() for row in cells)
