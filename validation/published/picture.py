"""Predicted over measured, a row a test, with what the laboratories' specimens scatter."""

import math

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"]
SHAPES = ["circle", "square", "triangle", "diamond", "cross"]
LEFT, RIGHT, TOP, STEP, WIDTH = 330.0, 30.0, 74.0, 34.0, 860.0
LOW, HIGH = 0.05, 20.0
TICKS = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20]


def across(ratio):
    ratio = min(max(ratio, LOW), HIGH)
    return LEFT + (WIDTH - LEFT - RIGHT) * math.log(ratio / LOW) / math.log(HIGH / LOW)


def marker(shape, x, y, colour, title):
    r = 5.5
    body = {
        "circle": f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r}"/>',
        "square": f'<rect x="{x - r:.1f}" y="{y - r:.1f}" width="{2 * r}" height="{2 * r}"/>',
        "triangle": f'<path d="M{x:.1f} {y - 6:.1f}l6 11h-12z"/>',
        "diamond": f'<path d="M{x:.1f} {y - 7:.1f}l7 7l-7 7l-7-7z"/>',
        "cross": f'<path d="M{x - 5:.1f} {y - 5:.1f}l10 10m0-10l-10 10" fill="none" stroke="{colour}" stroke-width="3"/>',
    }[shape]
    return f'<g fill="{colour}" fill-opacity="0.85"><title>{title}</title>{body}</g>\n'


def tests(rows, said):
    """Each test with the knee that it is predicted with, if it is one of a knee."""
    for test, row in rows.items():
        for knee, by_law in said.items():
            if test in next(iter(by_law.values())):
                is_of_knee = test not in ("pins", "ball", "random")
                if is_of_knee or knee == "generic":
                    yield test, row, knee, is_of_knee


def svg(rows, said, words):
    all_tests = list(tests(rows, said))
    height = TOP + STEP * len(all_tests) + 46
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:.0f} {height:.0f}" role="img" '
        'font-family="system-ui, sans-serif" font-size="13" fill="#1a1a1a">\n'
        "<title>Predicted over measured wear, by law</title>\n"
        f'<rect width="{WIDTH:.0f}" height="{height:.0f}" fill="#ffffff"/>\n'
    )
    text += key(words)
    bottom = TOP + STEP * len(all_tests)
    for tick in TICKS:
        strong = ' stroke="#1a1a1a"' if tick == 1 else ' stroke="#dddddd"'
        text += f'<path d="M{across(tick):.1f} {TOP - 8:.1f}V{bottom:.1f}"{strong}/>\n'
        text += f'<text x="{across(tick):.1f}" y="{bottom + 18:.1f}" text-anchor="middle">{tick:g}</text>\n'
    text += f'<text x="{across(1):.1f}" y="{bottom + 38:.1f}" text-anchor="middle">predicted over measured</text>\n'
    for place, (test, row, knee, is_of_knee) in enumerate(all_tests):
        y = TOP + STEP * (place + 0.5)
        text += label(row, knee if is_of_knee else "", y) + band(row, y)
        for number, word in enumerate(words):
            ratio = said[knee][word][test] / row["value"]
            text += marker(SHAPES[number], across(ratio), y, COLOURS[number], f"{word}: {ratio:.3g} times")
    return text + "</svg>\n"


def key(words):
    text, x = "", 16.0
    for number, word in enumerate(words):
        text += marker(SHAPES[number], x, 22.0, COLOURS[number], word)
        text += f'<text x="{x + 12:.1f}" y="26.5">{word}</text>\n'
        x += 42.0 + 7.5 * len(word)
    text += f'<rect x="{x:.1f}" y="15" width="26" height="14" fill="#bbbbbb" fill-opacity="0.55"/>\n'
    return text + f'<text x="{x + 34:.1f}" y="26.5">one standard deviation</text>\n'


def label(row, knee, y):
    what = row["what"] + (f", {knee}" if knee else "")
    what = what.replace("&", "&amp;")
    return f'<text x="{LEFT - 14:.1f}" y="{y + 4:.1f}" text-anchor="end" font-size="11.5">{what}</text>\n'


def band(row, y):
    if row["scatter"] is None:
        return ""
    low, high = across(1.0 - row["scatter"]), across(1.0 + row["scatter"])
    return f'<rect x="{low:.1f}" y="{y - 12:.1f}" width="{high - low:.1f}" height="24" fill="#bbbbbb" fill-opacity="0.55"/>\n'
