"""Pages of the site that are made as it is built (mkdocs hook): keys and commands from the program, the READMEs of the
cases, the record of speed, the change log, the C++ library (`docs_library`). The program is that of $BEDLOAD, by
default build/cpu/bedload."""

import json
import os
import posixpath
import re
import subprocess
from pathlib import Path

from docs_library import library_page
from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = os.environ.get("BEDLOAD", ROOT / "build/cpu/bedload")
COMMANDS = ["run", "viscometer", "check", "list", "info", "convert", "bench", "schema", "completion", "man"]
# Files outside docs/ as pages, pictures and films of the site.
PAGES = {f"cases/{path.parent.name}/README.md": f"cases/{path.parent.name}.md"
         for path in sorted(ROOT.glob("cases/*/README.md"))}
PAGES |= {"tests/bench/README.md": "speed.md", "CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md",
          "kernels/references.md": "references.md"}
PICTURES = {str(path.relative_to(ROOT)): str(path.relative_to(ROOT)) for path in sorted(ROOT.glob("cases/*/*"))
            if path.suffix in (".png", ".mp4")}


def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], check=True, capture_output=True, text=True).stdout


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("_", "\\_")


def keys_page():
    out = ["# Keys of a case", "",
           "Generated from the program; `bedload list` prints the same, `bedload list --json` for programs.",
           "Numbers are in the given unit; a value in quotes may have another unit of the same kind: `\"2.7 mm\"`. **Bold**",
           "keys are required wherever their table is used, others marked *required* if the chosen kind needs them. `[]`",
           "marks lists of tables, written `[[...]]`; in `--set` replace it by the index of the entry, from 0."]
    section = None
    for row in json.loads(program("list", "--json")):
        table, _, name = row["path"].rpartition(".")
        if table != section:
            section = table
            title = f"`{table}`" if table else "Top level"
            out += ["", f"## {title}", "", "| key | unit | default | allowed | meaning |", "|---|---|---|---|---|"]
        key = f"**`{name}`**" if row["required"] else f"`{name}`"
        choices = [f"<br>`{c['name']}`: {cell(c['meaning'])}" for c in row["choices"] if c["meaning"]]
        default = row["default"] if row["default"] == "required" else f"`{row['default']}`"
        allowed = "" if choices else cell(row["allowed"])
        out.append(f"| {key} | {row['unit']} | {default} | {allowed} | {cell(row['meaning'])}{''.join(choices)} |")
    return "\n".join(out) + "\n"


def words_page():
    out = ["# Words of other programs", "",
           "Generated from the program: `bedload list words`, or `bedload list TimeMax` for one. Case, `_` and `-` are",
           "ignored."]
    program_of = None
    for word in json.loads(program("list", "words", "--json")):
        if word["program"] != program_of:
            program_of = word["program"]
            out += ["", f"## {program_of or 'General terms'}", "", "| there | here | |", "|---|---|---|"]
        keys = ", ".join(f"`{key}`" for key in word["keys"])
        within = ", ".join(f"`{table}`" for table in word["within"])
        there = f"`{word['name']}`" + (f" in {within}" if within else "")
        out.append(f"| {there} | {keys or '-'} | {cell(word['note'])} |")
    return "\n".join(out) + "\n"


def commands_page():
    out = ["# Commands", "", "What `--help` of each prints; `bedload man | man -l -` shows all of it as a manual page.", ""]
    for command in COMMANDS:
        out += [f"## bedload {command}", "", "```text", program(command, "--help").strip(), "```", ""]
    return "\n".join(out)


def on_config(config):
    for entry in config.nav:
        if isinstance(entry, dict) and "Validation" in entry:
            entry["Validation"] += [page for page in PAGES.values() if page.startswith("cases/")]
    return config


def on_files(files, config):
    files.append(File.generated(config, "keys.md", content=keys_page()))
    files.append(File.generated(config, "commands.md", content=commands_page()))
    files.append(File.generated(config, "words.md", content=words_page()))
    files.append(File.generated(config, "library.md", content=library_page()))
    for source, place in (PAGES | PICTURES).items():
        files.append(File.generated(config, place, abs_src_path=str(ROOT / source)))
    return files


def on_page_markdown(markdown, page, config, files):
    """Links to files outside docs/, as they are seen in the repository, become links to their pages."""
    here = page.file.src_uri
    source = next((s for s, p in PAGES.items() if p == here), f"docs/{here}")

    def link(match):
        target, anchor = match[1], match[2] or ""
        path = posixpath.normpath(posixpath.join(posixpath.dirname(source), target))
        place = (PAGES | PICTURES).get(path) or (path.removeprefix("docs/") if path.startswith("docs/") else None)
        return f"]({posixpath.relpath(place, posixpath.dirname(here) or '.')}{anchor})" if place else match[0]

    return re.sub(r"\]\(([^)#:\s]+\.(?:md|png|mp4))(#[^)\s]*)?\)", link, markdown)


