"""SVG of the scripts that draw for results/, in the colours of softland's own charts."""

INK, MUTED, GRID = "#1b1f24", "#5f6b76", "#e4e7ea"
PENS = (("#0072b2", ""), ("#d55e00", "7 2.5"), ("#009e73", "2.5 2.5"), ("#cc79a7", "10 3 2 3"))  # colour, dashes
BOLD = ' font-weight="600"'


def words(x, y, text, size=12, anchor="start", colour=MUTED, more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" fill="{colour}"{more}>{text}</text>'


def line(x1, y1, x2, y2, colour=GRID, more=""):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}"{more}/>'


def tiles(left, top, right, bottom, columns, rows, colours):
    """A map of coloured cells, one path for each colour; colours[row][column], the first row at the bottom."""
    wide, high = (right - left) / columns, (bottom - top) / rows
    paths = {}
    for row, line_of_colours in enumerate(colours):
        for column, colour in enumerate(line_of_colours):
            if column and line_of_colours[column - 1] == colour:
                paths[colour][-1][2] += 1
            else:
                paths.setdefault(colour, []).append([column, row, 1])
    out = []
    for colour, runs in paths.items():
        path = "".join(f"M{left + c * wide:.2f},{bottom - (r + 1) * high:.2f}h{n * wide:.2f}v{high:.2f}h{-n * wide:.2f}z" for c, r, n in runs)
        out.append(f'<path d="{path}" fill="{colour}" shape-rendering="crispEdges"/>')
    return out


def drawing(width, height, headline, explanation, parts):
    """The whole document: lines of the headline, lines that explain, and what is drawn below them."""
    y, head = 34, []
    for text in headline:
        head.append(words(22, y, text, 17, colour=INK, more=BOLD))
        y += 23
    for text in explanation:
        head.append(words(22, y, text, 13))
        y += 18
    return "\n".join([f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
                      "role=\"img\" font-family=\"system-ui, 'Segoe UI', Helvetica, Arial, sans-serif\">",
                      f"<title>{' '.join(headline)}</title>", f'<rect width="{width}" height="{height}" fill="#fff"/>', *head, *parts,
                      "</svg>"]) + "\n"
