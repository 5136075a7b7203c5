"""Small pieces of HTML."""

import base64
import hashlib
from html import escape


def number(value, digits=4):
    if isinstance(value, str):
        return escape(value)
    if value is None:
        return "–"
    return f"{value:.{digits}g}" if abs(value) < 1000 else f"{value:.0f}"


def table(heads, rows, caption="", first_is_head=True, kind=""):
    """rows: of cells that are HTML already."""
    head = "".join(f'<th scope="col">{each}</th>' for each in heads)
    lines = []
    for row in rows:
        first = f'<th scope="row">{row[0]}</th>' if first_is_head else f"<td>{row[0]}</td>"
        lines.append("<tr>" + first + "".join(f"<td>{cell}</td>" for cell in row[1:]) + "</tr>")
    text = f"<caption>{escape(caption)}</caption>" if caption else ""
    return (f'<div class="scrolls" tabindex="0" role="region" aria-label="{escape(caption or "table")}">'
            f'<table class="{kind}">{text}<thead><tr>{head}</tr></thead>'
            f'<tbody>{"".join(lines)}</tbody></table></div>')


def section(identifier, title, body, level=2):
    return (f'<section id="{identifier}" aria-labelledby="{identifier}-title">'
            f'<h{level} id="{identifier}-title">{escape(title)}</h{level}>{body}</section>')


def numbers_of(chart):
    """The numbers of a plot as a table: what is drawn, for readers who do not see it."""
    rows = []
    for series in chart.series:
        values = ", ".join(f"{number(x)}: {number(y)}" for x, y in zip(series["x"], series["y"]))
        title = chart.axes[series["panel"]].get_title() if len(chart.axes) > 1 else ""
        rows.append((escape(series["label"]), escape(title), values))
    return table(("line", "panel", "numbers"), rows, f"Numbers of {chart.title}")


def figure(chart):
    files = sorted({series["source"]["file"] for series in chart.series if series["source"]})
    links = ", ".join(f'<a href="data/{name}">{name}</a>' for name in files)
    beside = f" Data: {links}." if links else ""
    name = escape(chart.title)
    body = (f'<figure><div class="plot" tabindex="0" role="region" aria-label="{name}">'
            f'<div role="img" aria-label="Plot; its numbers are in the table below">'
            f"{chart.svg()}</div></div><figcaption>{escape(chart.caption)}{beside}</figcaption></figure>"
            f"<details><summary>Numbers</summary>{numbers_of(chart)}</details>")
    return section(chart.key, chart.title, body, 3)


def digest(text):
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"


def document(title, style, script, body):
    """A page that runs and loads nothing but what is in it and images beside it."""
    policy = (f"default-src 'none'; img-src 'self' file:; style-src {digest(style)}; "
              f"script-src {digest(script)}; base-uri 'none'; form-action 'none'")
    return (f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
            f'<meta name="viewport" content="width=device-width, initial-scale=1">'
            f'<meta name="color-scheme" content="light dark">'
            f"<title>{escape(title)}</title><style>{style}</style></head>\n<body>{body}\n"
            f"<script>{script}</script></body></html>\n")
