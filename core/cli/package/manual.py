"""The manual page freeplay(1), made from what the program says of its commands and options.

usage: manual.py PROGRAM FILE
"""
import re
import subprocess
import sys

COMMON = "Options of every command"

END = r"""
.SH EXIT STATUS
0: done. 1: a mistake of the program. 2: options or words. 3: a model or another input. 4: numerical failure. 5: a plugin.
6: a file cannot be read or written. 7: a comparison finds differences. 130: interrupted.
.SH ENVIRONMENT
.TP
.B FREEPLAY_PLUGIN_PATH
Folders with plugins, divided by colons; those of the installation come after them.
.TP
.B FREEPLAY_THREADS
How many processors it may use; all that it finds without.
.TP
.B NO_COLOR
Any value: messages without colour.
.SH FILES
.TP
.I results/NAME
What a run of the model NAME writes.
.TP
.I /usr/share/doc/freeplay/examples
Mechanisms to start from; \fBfreeplay init\fR writes copies.
"""


def help_of(program, *words):
    return subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout


def parts_of(text):
    """Of a help text: what it is about, its usage, and by heading the pairs of a word and its meaning."""
    about, _, rest = text.partition("\nUsage: ")
    usage, _, rest = rest.partition("\n")
    parts = {}
    for heading, lines in re.findall(r"^(\S[^\n]*):\n((?:  [^\n]*\n)+)", rest, re.M):
        pairs = re.findall(r"^  (\S[^\n]*?)(?:  +|\n {20,})(\S[^\n]*)$", lines, re.M)
        if len(re.findall(r"^  \S", lines, re.M)) != len(pairs):
            raise ValueError("a help of another form:\n" + lines)
        parts[heading] = pairs
    return about, usage, parts


def plain(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"`([^`]*)`", r"\\fB\1\\fR", text)


def list_of(pairs):
    return "".join(".TP\n\\fB%s\\fR\n%s\n" % (plain(word), plain(meaning)) for word, meaning in pairs if "--help" not in word)


def commands_of(program, words=()):
    """Each command with its parts, each followed by those within it."""
    parts = parts_of(help_of(program, *words))
    yield words, parts
    for word, _ in parts[2].get("Subcommands", ()):
        yield from commands_of(program, (*words, word))


def page(program):
    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.split()[1]
    commands = list(commands_of(program))
    about, _, parts = commands[0][1]
    out = ['.TH FREEPLAY 1 "" "freeplay %s" "User Commands"\n.SH NAME\nfreeplay \\- mechanisms whose joints have clearance\n' % version,
           ".SH SYNOPSIS\n.B freeplay\n.I COMMAND\n[\\fIOPTION\\fR]...\n.SH DESCRIPTION\n%s\n.SH COMMANDS\n" % plain(about)]
    for words, (about, usage, own) in commands[1:]:
        out.append(".SS %s\n%s.\n" % (plain(usage), plain(about)))
        for heading, pairs in own.items():
            if heading not in (COMMON, "Subcommands"):
                out.append(list_of(pairs))
    options = ".SH OPTIONS\n%s.SH OPTIONS OF EVERY COMMAND\n%s" % (list_of(parts["Options"]), list_of(parts[COMMON]))
    return "".join(out) + options + END.lstrip("\n")


if __name__ == "__main__":
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(page(sys.argv[1]))
