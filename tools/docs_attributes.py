"""Comments "#: ..." behind attributes as their documentation: an extension of Griffe, which reads Python for
mkdocstrings."""

import griffe


class AttributeComments(griffe.Extension):
    def on_attribute_instance(self, *, attr, **_):
        if attr.docstring or not attr.lineno:
            return
        text = attr.lines_collection[attr.filepath][attr.lineno - 1].partition("#:")[2].strip()
        if text:
            attr.docstring = griffe.Docstring(text, parent=attr)
