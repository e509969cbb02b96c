"""Spelling of the pages: British English, and the words of words.txt beside this file.

Code, links and comments are left out, and words with digits. A name that pages need goes into words.txt.
"""
import os
import re
import subprocess

from sources import ROOT, Finding, files

WORDS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "words.txt")
NOT_PROSE = re.compile(r"^```.*?^```|`[^`\n]*`|<!--.*?-->|\]\([^)]*\)|https?://\S+", re.S | re.M)
WORD = re.compile(r"[A-Za-z\u00c0-\u017f']+")


def pages():
    top = [name for name in sorted(os.listdir(ROOT)) if name.endswith(".md")]
    return top + sorted(files(("docs",), ".md"))


def prose(text):
    """The text with what is no prose blanked out, line by line as before."""
    text = NOT_PROSE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    return re.sub(r"\S*\d\S*|'s\b", lambda match: " " * len(match[0]), text)


def unknown(text):
    """Words that neither dictionary has."""
    done = subprocess.run(["hunspell", "-d", "en_GB", "-p", WORDS, "-l"], input=text, capture_output=True, text=True,
                          env={**os.environ, "LC_ALL": "C.UTF-8"})
    if done.returncode != 0:
        raise SystemExit("hunspell: " + done.stderr.strip())
    return {word.strip("'") for word in done.stdout.split()}


def findings():
    texts = {}
    for page in pages():
        with open(os.path.join(ROOT, page), encoding="utf-8") as file:
            texts[page] = prose(file.read())
    bad = unknown("\n".join(texts.values()))
    found = [Finding(page, number, "'%s' is in no dictionary" % word) for page, text in texts.items()
             for number, line in enumerate(text.splitlines(), 1)
             for word in map(lambda word: word.strip("'"), WORD.findall(line)) if word in bad]
    return "%d pages" % len(texts), found
