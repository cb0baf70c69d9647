"""One table in four forms: what is in the model is in each of them, and foreign text breaks none."""

from __future__ import annotations

import io
import re
from html.parser import HTMLParser

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from latex_structure import check_latex
from rich.console import Console

from adhoc.core.errors import ConfigurationError
from adhoc.reporting.rendering.html import html_document, html_table
from adhoc.reporting.rendering.latex import PAGE, latex_document, latex_table
from adhoc.reporting.rendering.markdown import markdown_document, markdown_table
from adhoc.reporting.rendering.terminal import terminal_table
from adhoc.reporting.table import Cell, Column, Document, Picture, Row, Table, plain_table

TABLE = Table(
    "joining-0",
    "Joins at step 0",
    (Column("Team", True), Column("ad hoc", True), Column("%Suc ↑"), Column("#TS ↓")),
    (
        (
            Row((Cell("LLM_based"), Cell("No ad hoc"), Cell("21.1 (-)", "[20.0, 22.2]"), Cell("453.2 (-)"))),
            Row(
                (Cell("LLM_based"), Cell("IRoT & Co"), Cell("26.3 (24.6)*", "[25.0, 27.5]", True), Cell("-3"))
            ),
        ),
        (Row((Cell("other"), Cell("in the paper"), Cell("1 (-18.8)"), Cell("")), faint=True),),
    ),
    ("below: an interval", "100% sure"),
)
SVG = '<?xml?><svg id="x"><use href="#x"/></svg>'
DOCUMENT = Document(
    "Title <of> it", (TABLE,), ("a warning",), ("a note",), (Picture("A figure", "f/a", SVG),)
)


def test_the_terminal_shows_the_first_cell_once():
    console = Console(width=100, file=io.StringIO())
    console.print(terminal_table(TABLE))
    lines = [line.strip() for line in console.file.getvalue().splitlines()]
    assert lines[0] == "Joins at step 0"
    assert [line.split()[0] for line in lines if "(" in line] == ["LLM_based", "IRoT", "other"]
    assert any("[20.0, 22.2]" in line for line in lines)
    assert lines[-2:] == ["below: an interval", "100% sure"]


def test_names_are_no_markdown():
    name = "a|b <i> [c](d) &amp; $x^2$ _e_ *f* `g`"
    text = markdown_table(plain_table("k", "title", ["name"], 1, [[[name]]]))
    assert r"a\|b \<i> \[c](d) \&amp; \$x^2$ \_e\_ \*f* \`g\`" in text
    assert "| [20.0, 56.7] |" in markdown_table(plain_table("k", "t", ["x"], 1, [[["[20.0, 56.7]"]]]))


def test_markdown_rows_can_be_searched_for():
    assert markdown_table(TABLE).splitlines() == [
        "## Joins at step 0",
        "",
        "| Team | ad hoc | %Suc ↑ | #TS ↓ |",
        "|---|---|---:|---:|",
        "| LLM_based | No ad hoc | 21.1 (-)<br>[20.0, 22.2] | 453.2 (-) |",
        "| LLM_based | IRoT & Co | **26.3 (24.6)***<br>[25.0, 27.5] | -3 |",
        "| *other* | *in the paper* | *1 (-18.8)* |  |",
        "",
        "- below: an interval",
        "- 100% sure",
    ]


def test_latex_is_well_formed_and_says_the_same():
    ((head, alone, below, irot, _, paper),) = check_latex(latex_table(TABLE))
    assert head == ["Team", "ad hoc", r"\%Suc $\uparrow$", r"\#TS $\downarrow$"]
    assert alone == [r"LLM\_based", "No ad hoc", "21.1 (-)", "453.2 (-)"]
    assert below == ["", "", r"{\scriptsize [20.0, 22.2]}", ""]
    assert irot == ["", r"IRoT \& Co", r"\textbf{26.3 (24.6)*}", "$-$3"]
    assert paper[2] == r"\textit{1 ($-$18.8)}"
    text = latex_document(DOCUMENT)
    check_latex(text)
    assert [text.count(rf"\{rule}") for rule in ("toprule", "midrule", "bottomrule")] == [1, 2, 1]
    assert text.startswith("% In the preamble: \\usepackage{booktabs}\n% Title")


def test_a_long_table_is_several_floats():
    rows = [[str(number), "x"] for number in range(2 * PAGE)]
    long = plain_table("long", "Long", ("a", "b"), 1, [rows[: PAGE - 9], rows[PAGE - 9 :]])
    text = latex_table(long)
    tables = check_latex(text)
    assert [row for table in tables for row in table[1:]] == rows
    assert max(map(len, tables)) <= PAGE
    assert len(tables[0]) == 1 + PAGE - 9, "a group that fits stays in one piece"
    assert r"\caption{Long (part 2 of 3)}" in text
    assert len(set(re.findall(r"\\label\{(.*?)\}", text))) == len(tables) == 3


def test_labels_of_two_reports_can_be_told_apart():
    label = r"\\label\{(.*?)\}"
    assert re.findall(label, latex_document(DOCUMENT)) == ["tab:joining-0"]
    assert re.findall(label, latex_document(DOCUMENT, "llama")) == ["tab:llama-joining-0"]
    with pytest.raises(ConfigurationError, match="label prefix 'a_b': takes letters, digits and dashes"):
        latex_document(DOCUMENT, "a_b")


def test_what_a_table_is_about_stands_once_in_its_title():
    table = TABLE.about("language model: m")
    assert table.title == "Joins at step 0; language model: m"
    assert table.about("language model: m") is table


@pytest.mark.parametrize("broken", [r"a & b \\", r"\begin{x}", "50%", r"\foo", "a_b", "$x", "{", "x^2"])
def test_the_reader_of_latex_notices_what_is_broken(broken):
    good = latex_table(TABLE)
    with pytest.raises(AssertionError):
        check_latex(good.replace(r"\bottomrule", broken + "\n\\bottomrule"))


class Page(HTMLParser):
    """Collects cells, and checks that what is opened is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open, self.cells, self.outside = [], [], []

    def handle_starttag(self, tag, attrs):
        self.outside += [value for name, value in attrs if name in ("src", "href") and value[:1] != "#"]
        if tag in ("meta", "use"):
            return
        self.open.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_endtag(self, tag):
        if tag != "use":
            assert self.open.pop() == tag

    def handle_data(self, data):
        if {"td", "th"} & set(self.open):
            self.cells[-1] += data


def test_html_is_well_formed_and_needs_nothing_else():
    page = Page()
    text = html_document(DOCUMENT)
    page.feed(text)
    assert page.open == []
    assert page.outside == []
    assert page.cells[:8] == [
        "Team", "ad hoc", "%Suc ↑", "#TS ↓", "LLM_based", "No ad hoc", "21.1 (-)[20.0, 22.2]", "453.2 (-)",
    ]  # fmt: skip
    assert 'rowspan="2">LLM_based' in text
    assert "<title>Title &lt;of&gt; it</title>" in text
    assert '<svg id="p0-x"><use href="#p0-x"/></svg>' in text
    assert "http" not in text


FOREIGN = st.text(st.characters(exclude_categories=("Cs", "Cc")), max_size=20)


@given(FOREIGN, FOREIGN, st.booleans(), st.booleans())
@example('<b>|*_`$&%#~^{}\\-7"', "[x]* <i> |", True, False)
def test_foreign_names_break_no_form(name, number, bold, faint):
    cells = (Cell(name), Cell("b", bold=bold), Cell(number, below=name, bold=bold))
    columns = (Column(name, True), Column(number, True), Column("%"))
    table = Table("t", name, columns, ((Row(cells, faint),),), (name,))
    assert all(len(row) == 3 for row in check_latex(latex_table(table))[0])
    page = Page()
    page.feed(html_table(table))
    assert page.open == []
    assert page.cells == [name, number, "%", name, "b", number + name]
    rows = [line for line in markdown_table(table).splitlines() if line.startswith("| ")]
    assert [len(re.findall(r"(?<!\\)\|", row)) for row in rows] == [4, 4]
    Console(width=60, file=io.StringIO()).print(terminal_table(table))


def test_a_markdown_report_ends_with_what_one_must_know():
    text = markdown_document(DOCUMENT)
    assert text.startswith("# Title \\<of> it\n\n## Joins at step 0\n")
    assert text.endswith("![A figure](f/a.svg)\n\n- **a warning**\n- a note\n")
