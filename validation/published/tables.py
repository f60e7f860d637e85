"""Rows of Markdown tables, and numbers in them."""


def number(value):
    return f"{value:.2e}" if value < 1e-3 else f"{value:.3g}"


def line(cells):
    return f"| {' | '.join(cells)} |\n"


def head(cells):
    return line(cells) + line(["---"] * len(cells))
