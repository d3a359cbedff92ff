"""Writes nested dicts as TOML."""

import json
import re


def value(of):
    """A value in one line."""
    if isinstance(of, bool):
        return "true" if of else "false"
    if isinstance(of, str):
        return json.dumps(of).replace("\x7f", "\\u007f")
    if isinstance(of, float):
        text = repr(of)
        return text if re.search(r"[.enai]", text) else text + ".0"
    if isinstance(of, list):
        return "[" + ", ".join(map(value, of)) + "]"
    if isinstance(of, dict):
        return "{" + ", ".join(f"{_key(k)} = {value(v)}" for k, v in of.items()) + "}"
    return str(of)


def document(table):
    """A whole file."""
    lines = []
    _table(table, "", lines)
    return "\n".join(lines).strip("\n") + "\n"


def _key(name):
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name)


def _is_list_of_tables(of):
    return isinstance(of, list) and bool(of) and all(isinstance(item, dict) for item in of)


def _table(table, path, lines):
    for key, of in table.items():
        if not isinstance(of, dict) and not _is_list_of_tables(of):
            lines.append(f"{_key(key)} = {value(of)}")
    for key, of in table.items():
        name = f"{path}.{_key(key)}" if path else _key(key)
        if isinstance(of, dict):
            nested = of and all(isinstance(v, dict) or _is_list_of_tables(v) for v in of.values())
            lines += [] if nested else ["", f"[{name}]"]
            _table(of, name, lines)
        elif _is_list_of_tables(of):
            for item in of:
                lines += ["", f"[[{name}]]"]
                _table(item, name, lines)
