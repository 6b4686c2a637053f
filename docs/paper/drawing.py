"""Pictures and charts of docs/paper.md: grey PNG of images, SVG of curves. No library beyond numpy."""

import struct
import zlib

import numpy as np


def stretched(image, low, high, softness=0.1):
    """Image in 0..255: asinh between two levels."""
    share = np.clip((image - low) / (high - low), 0, 1)
    return np.round(255 * np.arcsinh(share / softness) / np.arcsinh(1 / softness)).astype(np.uint8)


def write_png(path, grey):
    """Writes rows x columns of bytes; the same bytes for the same picture."""
    rows, columns = grey.shape

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + row.tobytes() for row in np.ascontiguousarray(grey))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))


def binned(image, side):
    """Means of squares of pixels; what is left over at the edges is cut off."""
    rows, columns = image.shape[0] // side, image.shape[1] // side
    return image[: rows * side, : columns * side].reshape(rows, side, columns, side).mean(axis=(1, 3))


def side_by_side(pictures, gap=8):
    rows = max(p.shape[0] for p in pictures)
    padded = [np.pad(p, ((0, rows - p.shape[0]), (0, gap)), constant_values=255) for p in pictures]
    return np.concatenate(padded, axis=1)[:, :-gap]


COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")


def svg_chart(lines, x_label, y_label, bands=(), marks=(), logarithmic=(False, False), width=760, height=430):
    """Curves {name: (x, y)}; `bands`: shaded ranges of x; `marks`: (x, y, text)."""
    left, right, top, bottom = 70, 20, 20, 55
    scale = [np.log10 if log else (lambda v: np.asarray(v, float)) for log in logarithmic]
    xs = np.concatenate([np.asarray(x, float) for x, _ in lines.values()])
    ys = np.concatenate([np.asarray(y, float) for _, y in lines.values()])
    x_range = [scale[0](xs.min()), scale[0](xs.max())]
    y_range = [scale[1](ys.min()), scale[1](ys.max())]
    y_range = [y_range[0] - 0.04 * (y_range[1] - y_range[0]), y_range[1] + 0.06 * (y_range[1] - y_range[0])]

    def at(x, y):
        u = (scale[0](x) - x_range[0]) / (x_range[1] - x_range[0])
        v = (scale[1](y) - y_range[0]) / (y_range[1] - y_range[0])
        return left + u * (width - left - right), height - bottom - v * (height - top - bottom)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for low, high in bands:
        a, b = at(low, 10 ** y_range[0] if logarithmic[1] else y_range[0])[0], at(high, 10 ** y_range[0] if logarithmic[1] else y_range[0])[0]
        out.append(f'<rect x="{a:.1f}" y="{top}" width="{b - a:.1f}" height="{height - top - bottom}" fill="#dddddd"/>')
    for axis, (low, high), log in ((0, x_range, logarithmic[0]), (1, y_range, logarithmic[1])):
        if log:
            ticks = [m * 10.0**k for k in range(int(np.floor(low)) - 1, int(np.ceil(high)) + 1) for m in (1, 2, 5)]
            ticks = [t for t in ticks if low - 1e-9 <= np.log10(t) <= high + 1e-9]
        else:
            step = 10 ** np.floor(np.log10((high - low) / 4))
            step *= next(m for m in (1, 2, 5, 10) if (high - low) / (m * step) <= 7)
            ticks = [k * step for k in range(int(np.ceil(low / step)), int(np.floor(high / step)) + 1)]
        for tick in ticks:
            if axis == 0:
                x, _ = at(tick, 10 ** y_range[0] if logarithmic[1] else y_range[0])
                out.append(f'<path d="M{x:.1f} {height - bottom}v5" stroke="black"/>'
                           f'<text x="{x:.1f}" y="{height - bottom + 20}" text-anchor="middle">{tick:g}</text>')
            else:
                _, y = at(10 ** x_range[0] if logarithmic[0] else x_range[0], tick)
                out.append(f'<path d="M{left} {y:.1f}h-5" stroke="black"/>'
                           f'<text x="{left - 8}" y="{y + 4:.1f}" text-anchor="end">{tick:g}</text>')
    out.append(f'<rect x="{left}" y="{top}" width="{width - left - right}" height="{height - top - bottom}" fill="none" stroke="black"/>')
    for (name, (x, y)), colour in zip(lines.items(), COLOURS):
        points = " ".join(f"{u:.1f},{v:.1f}" for u, v in (at(a, b) for a, b in zip(x, y)))
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
    for k, (name, colour) in enumerate(zip(lines, COLOURS)):
        y = top + 18 + 18 * k
        out.append(f'<path d="M{left + 12} {y - 4}h24" stroke="{colour}" stroke-width="2"/><text x="{left + 42}" y="{y}">{name}</text>')
    for x, y, text in marks:
        u, v = at(x, y)
        out.append(f'<circle cx="{u:.1f}" cy="{v:.1f}" r="4" fill="black"/><text x="{u + 8:.1f}" y="{v - 6:.1f}">{text}</text>')
    out.append(f'<text x="{(left + width - right) / 2}" y="{height - 14}" text-anchor="middle">{x_label}</text>')
    out.append(f'<text transform="translate(18 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">{y_label}</text></svg>\n')
    return "\n".join(out)


def svg_map(columns, rows, values, x_label, y_label, width=760, height=360):
    """Cells with their values, 1 light, what is far from it dark; `values[row][column]`, rows from the top."""
    left, right, top, bottom = 70, 20, 20, 55
    wide, high = (width - left - right) / len(columns), (height - top - bottom) / len(rows)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for i, row in enumerate(rows):
        for j, column in enumerate(columns):
            value = values[i][j]
            light = round(255 * max(0.25, 1 - 0.5 * abs(np.log(value))))
            x, y = left + j * wide, top + i * high
            out.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{wide:.1f}" height="{high:.1f}" fill="rgb({light},{light},255)"/>'
                       f'<text x="{x + wide / 2:.1f}" y="{y + high / 2 + 4:.1f}" text-anchor="middle" '
                       f'fill="{"white" if light < 130 else "black"}">{value:.2f}</text>')
        out.append(f'<text x="{left - 8}" y="{top + (i + 0.5) * high + 4:.1f}" text-anchor="end">{row:g}</text>')
    for j, column in enumerate(columns):
        out.append(f'<text x="{left + (j + 0.5) * wide:.1f}" y="{height - bottom + 18}" text-anchor="middle">{column:g}</text>')
    out.append(f'<text x="{(left + width - right) / 2}" y="{height - 14}" text-anchor="middle">{x_label}</text>')
    out.append(f'<text transform="translate(18 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">{y_label}</text></svg>\n')
    return "\n".join(out)
