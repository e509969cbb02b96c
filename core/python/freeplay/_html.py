"""What a notebook shows of models, results and tables: no network, no script."""
from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

MOST_ROWS = 20
MOST_TEXT = 3_000_000  # of a page
count = itertools.count(1)


def drawing(svg: str) -> str:
    """An SVG picture whose ids no other one in the notebook has."""
    prefix = f"freeplay{next(count)}-"
    picture = svg[svg.index("<svg"):]
    picture = re.sub(r"<metadata>.*?</metadata>", "", picture, flags=re.S)
    picture = re.sub(r'\bid="([^"]+)"', rf'id="{prefix}\1"', picture)
    return re.sub(r'(url\(#|href="#)', rf"\g<1>{prefix}", picture)


def escape(text: str) -> str:
    """Text as HTML shows it, in attributes too."""
    for mark, word in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;"), ("'", "&#x27;")):
        text = text.replace(mark, word)
    return text


def frame(document: str, most: int) -> str:
    """A page of its own in the page, whose scripts see nothing of it; nothing where it takes more than `most` characters."""
    text = escape(document)
    shown = f'<iframe sandbox="allow-scripts" srcdoc="{text}" style="width: 100%; height: 40em; border: 0"></iframe>'
    return shown if document and len(shown) <= most else ""


def number(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}" if value == value else ""
    return str(value)


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    def line(tag: str, cells: Iterable[Any]) -> str:
        return "<tr>" + "".join(f"<{tag}>{escape(number(cell))}</{tag}>" for cell in cells) + "</tr>"
    body = "".join(line("td", row) for row in rows)
    return f"<table><thead>{line('th', head)}</thead><tbody>{body}</tbody></table>" if head else f"<table><tbody>{body}</tbody></table>"


def pairs(facts: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Those that are one word or number."""
    return [(name.replace("_", " "), value) for name, value in facts.items() if isinstance(value, (str, int, float))]


def page(title: str, *parts: str) -> str:
    return f"<div><p><b>{escape(title)}</b></p>" + "".join(parts) + "</div>"


def joints(summary: Mapping[str, Any]) -> str:
    rows = [(name, *("-" if joint.get(key) is None else joint[key] for key in ("max_force", "max_delta", "contacts")))
            for name, joint in (summary.get("joints") or {}).items()]
    return table(("joint", "largest force [N]", "largest penetration [m]", "contacts"), rows) if rows else ""
