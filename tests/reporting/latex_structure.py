"""A strict reader of the LaTeX that is written: whatever TeX would stumble over is an error here."""

from __future__ import annotations

import re

COMMANDS = frozenset(
    (
        *("begin", "end", "centering", "caption", "label", "small", "scriptsize", "footnotesize"),
        *("setlength", "tabcolsep", "toprule", "midrule", "bottomrule", "textbf", "textit", "parbox"),
        *("linewidth", "smallskip", "uparrow", "downarrow", "dagger", "cdot", "times", "geq", "leq"),
        *("textbackslash", "textasciicircum", "textasciitilde"),
    )
)
TOKEN = re.compile(r"\\[a-zA-Z]+|\\.|[{}$&%#_^~]|\n|.", re.DOTALL)


def check_latex(text: str) -> list[list[list[str]]]:
    """The rows of every tabular. Raises AssertionError for anything that is not well-formed."""
    body = "\n".join(line for line in text.split("\n") if not line.startswith("%"))
    assert "\n\n\\end" not in body
    tables, stack, depth, math = [], [], 0, False
    tokens = TOKEN.findall(body)
    position = 0
    row: list[str] = []
    cell = ""
    columns = 0
    while position < len(tokens):
        token = tokens[position]
        inside = stack[-1:] == ["tabular"]
        if token in ("\\begin", "\\end"):
            end = tokens.index("}", position)
            name = "".join(tokens[position + 2 : end])
            assert tokens[position + 1] == "{"
            assert not math
            if token == "\\begin":
                stack.append(name)
                position = end
                if name == "tabular":
                    columns, position = _columns(tokens, end)
                    tables.append([])
            else:
                assert stack.pop() == name
                assert name != "tabular" or not (row or cell.strip()), f"a line without end: {row} {cell}"
                position = end
            cell = ""
        elif token == "\\\\":
            assert inside, "a line ends outside of a table"
            assert depth == 0
            assert not math
            row.append(cell.strip())
            assert len(row) == columns, f"{len(row)} cells in {columns} columns: {row}"
            tables[-1].append(row)
            row, cell = [], ""
        elif token == "&":
            assert inside
            assert depth == 0
            row.append(cell.strip())
            cell = ""
        elif token == "$":
            math = not math
            cell += token
        elif token in ("{", "}"):
            depth += 1 if token == "{" else -1
            assert depth >= 0
            cell += token
        elif token.startswith("\\"):
            name = token[1:]
            assert name in COMMANDS or name in "%#_&$\\{}", f"unknown command {token}"
            cell += "" if name in ("toprule", "midrule", "bottomrule") else token
        else:
            assert token not in "%#_~", f"{token} is not escaped: {cell}"
            assert token != "^" or math, "^ is for mathematics"
            cell += token
        position += 1
    assert not stack
    assert depth == 0
    assert not math
    return tables


def _columns(tokens: list[str], start: int) -> tuple[int, int]:
    """How many columns the table has, and where their description ends."""
    assert tokens[start + 1] == "{"
    depth, position, told = 0, start + 1, ""
    while True:
        depth += {"{": 1, "}": -1}.get(tokens[position], 0)
        told += tokens[position]
        if depth == 0:
            break
        position += 1
    plain = re.sub(r"@\{\}|p\{[^}]*\}", lambda it: "p" if it[0].startswith("p") else "", told)
    return len(re.findall("[lrp]", plain)), position
