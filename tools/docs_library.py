"""The page of the C++ library, from the comments of its headers: what a program of one's own includes."""

import itertools
import re
from pathlib import Path

import tree_sitter_cpp
from tree_sitter import Language, Parser

ROOT = Path(__file__).resolve().parents[1] / "include"
HEADERS = {
    "Cases": ["case/read.hpp", "case/config.hpp", "case/drag_table.hpp"],
    "Particles": ["geometry/setup.hpp", "host_data.hpp"],
    "Runs": ["simulation.hpp", "step_limits.hpp"],
    "Output": ["output/output.hpp"],
    "Errors": ["core/error.hpp"],
    "Tables of a case": ["domain", "shapes", "walls", "fluid", "lattice", "grains", "contact", "coupling", "motion",
                         "drive", "openings", "time", "output"],
}
HEADERS["Tables of a case"] = [f"case/config/{name}.hpp" for name in HEADERS["Tables of a case"]]
CLASSES = {"class_specifier": "class", "struct_specifier": "struct", "enum_specifier": "enum"}
PARSER = Parser(Language(tree_sitter_cpp.language()))


def text_of(node):
    return node.text.decode()


def inside(node, kinds):
    """The first node of one of these kinds, in or below a node."""
    if node.type in kinds:
        return node
    return next((found for child in node.children if (found := inside(child, kinds))), None)


def comment_text(nodes):
    """What comments say, in lines."""
    return [re.sub(r"^//[/!]?<? ?", "", text_of(node)) for node in nodes]


def prose(lines):
    """A comment as Markdown: sentences as text, indented lines as they are."""
    out = []
    for indented, group in itertools.groupby(lines, lambda line: line.startswith("  ")):
        if indented:
            out += ["", "```text", *group, "```", ""]
            continue
        parts = re.split(r"(`[^`]*`)", " ".join(group))
        out.append("".join(p if p.startswith("`") else re.sub(r"([\\<>*_\[\]|])", r"\\\1", p) for p in parts))
    return "\n".join(out)


def is_hidden(node):
    """What a reader of an interface need not see: private members, friends, comparisons, assertions."""
    return node.type in ("static_assert_declaration", "friend_declaration") or "operator==" in text_of(node)


def outline(node):
    """A declaration with its comments, without the bodies of functions and what is private."""
    cuts = []  # begin, end, whether it is the body of a function

    def visit(at):
        if at.type == "function_definition" and (body := at.child_by_field_name("body")):
            initial = next((c for c in at.children if c.type == "field_initializer_list"), body)
            cuts.append((initial.start_byte, body.end_byte, True))
            return
        private = at.parent is not None and at.parent.type == "class_specifier"
        for child in at.children:
            if child.type == "access_specifier":
                private = text_of(child) != "public"
            if child.type in "{}":
                continue
            if at.type == "field_declaration_list" and (private or is_hidden(child)):
                cuts.append((child.start_byte, child.end_byte, False))
                continue
            visit(child)

    visit(node)
    source, first = node.text, node.start_byte
    out, last = b"", first
    for begin, end, body in sorted(cuts):
        kept = source[last - first : begin - first]
        out += kept.rstrip() + b";" if body else kept
        last = end
    text = (out + source[last - first :]).decode()
    text = re.sub(r"(?m)^ *:?;?\n(?=(?: *\n)* *})", "", text)  # what is left of cut members
    return re.sub(r"\n(?: *\n)+", "\n\n", re.sub(r"(?m)[ \t]+$", "", text))


def name_of(node):
    """Kind and name of a declaration; none for what the page leaves out."""
    held = inside(node, CLASSES)
    if held is not None and held.child_by_field_name("body") is not None:
        return f"{CLASSES[held.type]} {text_of(held.child_by_field_name('name'))}"
    if (function := inside(node, {"function_declarator"})) and node.type != "using_declaration":
        return f"{text_of(function.child_by_field_name('declarator'))}()"
    return None


def entries(header):
    """Comment at the top of a header; and name, comment and code of each of its declarations."""
    tree = PARSER.parse((ROOT / "bedload" / header).read_bytes()).root_node
    top = []
    for node in tree.children:
        if node.type == "comment":
            top.append(node)
        elif top:
            break
    space = inside(tree, {"namespace_definition"}).child_by_field_name("body")
    found, comments = [], []
    for node in space.children:
        if node.type == "comment":
            if comments and node.start_point.row > comments[-1].end_point.row + 1:
                comments = []
            comments.append(node)
            continue
        about = comments if comments and node.start_point.row == comments[-1].end_point.row + 1 else []
        comments = []
        if node.type in "{};" or is_hidden(node) and not inside(node, CLASSES) or not (name := name_of(node)):
            continue
        code = outline(node) + ("" if node.type in ("declaration", "function_definition") else ";")
        found.append((name, comment_text(about), code.replace(";;", ";")))
    if not found:
        raise ValueError(f"{header}: holds nothing for the page of the library")
    return comment_text(top), found


def library_page():
    out = ["# C++ library", "",
           "Generated from the headers of `bedload::bedload`, without private members and the bodies of functions; all",
           "names are in the namespace `bedload`. [How a program uses it](howto/build.md#in-a-program-of-your-own),",
           "with an example. The members of the tables of a case are the [keys](keys.md) of a case file."]
    for group, headers in HEADERS.items():
        out += ["", f"## {group}"]
        for header in headers:
            top, found = entries(header)
            out += ["", f"### bedload/{header}", "", prose(top)]
            for name, about, code in found:
                said = [prose(about), ""] if about else []
                out += ["", f"#### `{name}`", "", *said, "```cpp", code, "```"]
    return "\n".join(out) + "\n"
