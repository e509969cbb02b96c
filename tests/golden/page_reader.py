"""Pages of results, read back."""
import base64
import hashlib
import html.parser
import json
import math
import struct


class Page(html.parser.HTMLParser):
    """Ids, scripts, links and the policy of a page, and its data."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.ids, self.links, self.scripts, self.tags, self.policy, self.title, self.open = set(), [], {}, set(), "", "", None
        self.feed(text)
        self.data = json.loads(self.scripts["freeplay-data"])
        self.runs = self.data["runs"]

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.tags.add(tag)
        if "id" in attributes:
            self.ids.add(attributes["id"])
        self.links += [attributes[name] for name in ("src", "href") if attributes.get(name)]
        if attributes.get("http-equiv") == "Content-Security-Policy":
            self.policy = attributes["content"]
        if tag == "script":
            self.open = attributes.get("id", "script-%d" % len(self.scripts))
            self.scripts[self.open] = ""
        elif tag == "title":
            self.open = tag

    def handle_endtag(self, tag):
        if tag in ("script", "title"):
            self.open = None

    def handle_data(self, data):
        if self.open == "title":
            self.title += data
        elif self.open:
            self.scripts[self.open] += data

    def hash_of_runs(self):
        """Of their text, which is the last of the data, on a line of its own."""
        text = self.scripts["freeplay-data"]
        begin = text.index('\n"runs":') + len('\n"runs":')
        return hashlib.sha256(text[begin : text.rindex("\n}")].encode()).hexdigest()


def numbers(text, letter):
    raw = base64.b64decode(text)
    return list(struct.unpack("<%d%s" % (len(raw) // struct.calcsize(letter), letter), raw))


def real(values):
    return [x for x in values if not math.isnan(x)]


def wanted_of(rows, buckets):
    """What stands for a channel: its rows, or minimum and maximum of each bucket."""
    if not buckets:
        return rows
    edges = [k * len(rows) // buckets for k in range(buckets + 1)]
    parts = [real(rows[edges[k] : edges[k + 1]]) or [math.nan] for k in range(buckets)]
    return [extreme(part) for part in parts for extreme in (min, max)]
