"""Elements of SVG figures for results/, in the colours of softland's own charts."""
import bisect

INK, MUTED, GRID = "#1b1f24", "#5f6b76", "#e4e7ea"
COLOURS = ("#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6dcd59", "#b4de2c", "#fde725")  # of a map
NOTHING = "#c3c9cf"
PENS = (("#0072b2", ""), ("#d55e00", "7 2.5"), ("#009e73", "2.5 2.5"), ("#cc79a7", "10 3 2 3"))  # colour, dashes
BOLD = ' font-weight="600"'


def words(x, y, text, size=12, anchor="start", colour=MUTED, more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" fill="{colour}"{more}>{text}</text>'


def line(x1, y1, x2, y2, colour=GRID, more=""):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}"{more}/>'


def tiles(left, top, right, bottom, columns, rows, colours):
    """Returns a map of coloured cells, one path for each colour; colours[row][column], with the first row at the bottom."""
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


def heat_map(values, bounds, unit, title, box, across, up, missing):
    """Returns a map of values[row][column], with the first row at the bottom and None for a missing value. `bounds` separate the colours. An axis is
    a tuple of its two ends, its ticks and its label. `missing` is the legend of None, empty if None does not occur."""
    left, top, right, bottom = box
    colour = lambda v: NOTHING if v is None else COLOURS[bisect.bisect_right(bounds, v)]
    out = [words(left, top - 12, title, 13, colour=INK, more=BOLD)]
    out += tiles(left, top, right, bottom, len(values[0]), len(values), [[colour(v) for v in row] for row in values])
    out.append(f'<rect x="{left}" y="{top}" width="{right - left}" height="{bottom - top}" fill="none" stroke="{MUTED}"/>')
    for tick in across[2]:
        x = left + (right - left) * (tick - across[0]) / (across[1] - across[0])
        out += [line(x, bottom, x, bottom + 4, MUTED), words(x, bottom + 17, f"{tick:g}", 11, "middle")]
    for tick in up[2]:
        y = bottom - (bottom - top) * (tick - up[0]) / (up[1] - up[0])
        out += [line(left - 4, y, left, y, MUTED), words(left - 8, y + 4, f"{tick:g}", 11, "end")]
    out.append(words((left + right) / 2, bottom + 34, across[3], 12, "middle"))
    out.append(f'<text x="{left - 40}" y="{(top + bottom) / 2}" font-size="12" text-anchor="middle" fill="{MUTED}" '
               f'transform="rotate(-90 {left - 40} {(top + bottom) / 2})">{up[3]}</text>')
    size = (right - left) / (len(bounds) + 1)
    for k, shade in enumerate(COLOURS[:len(bounds) + 1]):
        out.append(f'<rect x="{left + k * size:.1f}" y="{bottom + 48}" width="{size:.1f}" height="12" fill="{shade}"/>')
        if k:
            out.append(words(left + k * size, bottom + 74, f"{bounds[k - 1]:g}", 10, "middle"))
    out.append(words(right + 6, bottom + 58, unit, 11))
    if missing:
        out += [f'<rect x="{left}" y="{bottom + 84}" width="22" height="11" fill="{NOTHING}"/>', words(left + 28, bottom + 93, missing, 11)]
    return out


def drawing(width, height, headline, explanation, parts):
    """Returns the document: the lines of the headline and of the subtitle, and the elements below them."""
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
