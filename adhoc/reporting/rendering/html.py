"""A whole report as one HTML page that needs nothing else."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape

from adhoc.reporting.table import Cell, Document, Picture, Row, Table

_STYLE = r"""\ :root { color-scheme: light; } body { font: 15px/1.5 system-ui, sans-serif; color: #1b1f24;
margin: 2rem auto; max-width: 72rem; padding: 0 1rem; } h1 { font-size: 1.4rem; line-height: 1.25; } h2 {
font-size: 1.1rem; margin: 2.2rem 0 .5rem; } .wide { overflow-x: auto; } table { border-collapse: collapse;
font-variant-numeric: tabular-nums; } thead th { border-top: 2px solid #1b1f24; border-bottom: 1px solid
#1b1f24; white-space: nowrap; } tbody { border-bottom: 1px solid #b9c0c8; } tbody:last-child {
border-bottom: 2px solid #1b1f24; } th, td { padding: .18rem .7rem; text-align: right; vertical-align: top;
font-weight: normal; } thead th { font-weight: 600; } td:not(.name) { white-space: nowrap; }
th.name, td.name { text-align: left; } td small {
display: block; color: #57606a; white-space: nowrap; } td b { font-weight: 700; } tr.faint td { color:
#6e4b12; font-style: italic; } .remarks, footer { color: #444c56; font-size: .87rem; max-width: 60rem; }
.remarks p { margin: .3rem 0; } .warnings { border-left: 4px solid #b35900; background: #fff6ea; padding:
.5rem 1rem; } .warnings p { margin: .2rem 0; } .pictures { display: flex; flex-wrap: wrap; gap: 1.5rem;
align-items: flex-start; } figure { margin: 0; } figure svg { max-width: 100%; height: auto; } @media print
{ body { max-width: none; } h2 { break-after: avoid; } tr { break-inside: avoid; } }
"""


def html_document(document: Document) -> str:
    """The page."""
    title = escape(document.title)
    return "\n".join(
        [
            "<!doctype html>",
            '<html lang="en">',
            f'<head><meta charset="utf-8"><title>{title}</title>',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            *([f'<meta name="generator" content="{escape(document.command)}">'] if document.command else []),
            f"<style>\n{_STYLE}</style></head>",
            f"<body>\n<h1>{title}</h1>",
            *_paragraphs("warnings", document.warnings),
            *map(html_table, document.tables),
            *_pictures(document.pictures),
            *_paragraphs("remarks", document.notes, "footer"),
            "</body>\n</html>\n",
        ]
    )


def html_table(table: Table) -> str:
    """One table under its heading."""
    names = [it.is_name for it in table.columns]
    lines = [
        f'<section id="{escape(table.key)}">',
        f"<h2>{escape(table.title)}</h2>",
        '<div class="wide"><table>',
    ]
    headings = (f'<th scope="col"{_class(it.is_name)}>{escape(it.heading)}</th>' for it in table.columns)
    lines.append(f"<thead><tr>{''.join(headings)}</tr></thead>")
    for group in table.groups:
        lines += ["<tbody>", *_rows(group, names), "</tbody>"]
    lines += ["</table></div>", *_paragraphs("remarks", table.remarks), "</section>"]
    return "\n".join(lines)


def _rows(group: tuple[Row, ...], names: list[bool]) -> Iterator[str]:
    """A first cell that repeats stands once, over all of its rows."""
    start = 0
    while start < len(group):
        first, end = group[start].cells[0], start + 1
        while end < len(group) and group[end].cells[0] == first:
            end += 1
        for number, row in enumerate(group[start:end]):
            cells = [_cell(cell, name) for cell, name in zip(row.cells[1:], names[1:])]
            if number == 0:
                cells.insert(0, _cell(first, names[0], end - start))
            yield f"<tr{' class=faint' if row.faint else ''}>{''.join(cells)}</tr>"
        start = end


def _cell(cell: Cell, is_name: bool, over: int = 1) -> str:
    text = f"<b>{escape(cell.text)}</b>" if cell.bold else escape(cell.text)
    below = f"<small>{escape(cell.below)}</small>" if cell.below else ""
    span = f' rowspan="{over}"' if over > 1 else ""
    return f"<td{_class(is_name)}{span}>{text}{below}</td>"


def _class(is_name: bool) -> str:
    return ' class="name"' if is_name else ""


def _paragraphs(kind: str, lines: tuple[str, ...], tag: str = "div") -> Iterator[str]:
    if lines:
        yield f'<{tag} class="{kind}">' + "".join(f"<p>{escape(it)}</p>" for it in lines) + f"</{tag}>"


def _pictures(pictures: tuple[Picture, ...]) -> Iterator[str]:
    if not pictures:
        return
    yield '<h2>Figures</h2>\n<div class="pictures">'
    for number, it in enumerate(pictures):
        yield f'<figure role="img" aria-label="{escape(it.title)}">{_embedded(it.svg, number)}</figure>'
    yield "</div>"


def _embedded(svg: str, number: int) -> str:
    """A picture in a page: without its XML head, its ids its own among several pictures."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r'\bid="', f'id="p{number}-', svg)
    return re.sub(r'(url\(#|href="#)', rf"\g<1>p{number}-", svg)
