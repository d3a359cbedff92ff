"""The page of the window: its widgets and what they show. It has no logic of its own; actions are those of `Window`."""

from __future__ import annotations

from typing import Any

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import client, html, vtk
from trame.widgets import vuetify3 as v

from .view import NONE

STATE: dict[str, Any] = {
    "trame__title": "Bedload", "selected": "", "nodes": [], "fields": [], "additions": [], "root_additions": [],
    "form_title": "", "file": "", "changed": False, "can_undo": False, "can_redo": False, "text": "", "problem": "",
    "problem_line": 0, "problem_here": False, "warnings": [], "stale": False, "all_keys": False, "out": "",
    "mode": "case", "panel": "check", "check_rows": [], "check_words": "", "checking": False,
    "run_state": "", "run_words": "", "run_part": 0, "ask_run": False, "run_out": "", "can_restart": False,
    "run_error": "", "allow_changes": False,
    "run_after_save": False, "times": [], "frame": 0, "results": "", "filming": 0,
    "colour_fluid": NONE, "colour_grains": NONE, "colours_fluid": [], "colours_grains": [], "cut": "", "cut_at": 0.5,
    "hide_walls": False, "tables": [], "table": "", "all_columns": [], "columns": [], "chart": "",
    "browse": "", "browse_at": "", "browse_up": "", "browse_items": [], "browse_name": "", "message": "",
    "message_seen": False, "mesh": None,
}
COLOURS = {"primary": "#1f5c7a", "secondary": "#c98b45", "error": "#b3362f", "background": "#eef2f5",
           "surface": "#ffffff"}
THEME = {"defaults": {"VBtn": {"class": "text-none"}},
         "theme": {"defaultTheme": "bedload", "themes": {"bedload": {"dark": False, "colors": COLOURS}}}}
STYLE = """
html { overflow: hidden; font-size: 15px; }
.bl-page { display: grid; grid-template-columns: 218px 372px minmax(0, 1fr); height: calc(100vh - 48px); }
.bl-column { background: #fff; border-right: 1px solid #d9e1e7; overflow-y: auto; min-height: 0; }
.bl-right { display: grid; grid-template-rows: 42px minmax(0, 1fr) auto 268px; min-height: 0; min-width: 0; }
.bl-node { display: flex; align-items: center; height: 28px; padding-right: 8px; cursor: pointer; font-size: 13.5px;
  color: #2b3a45; border-left: 3px solid transparent; user-select: none; }
.bl-node:hover { background: #f0f5f8; }
.bl-node.on { background: #e3eef4; border-left-color: #1f5c7a; font-weight: 600; }
.bl-node.wrong { color: #b3362f; }
.bl-node span { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.bl-head { font-size: 17px; font-weight: 600; color: #1f3d4f; }
.bl-field { margin-bottom: 10px; }
.bl-label { font-size: 13px; color: #2b3a45; display: flex; align-items: center; min-height: 24px; }
.bl-label b { font-weight: 600; margin-right: 6px; }
.bl-label i { font-style: normal; color: #7b8a95; }
.bl-meaning { font-size: 12px; line-height: 1.35; color: #6a7883; margin-top: 2px; }
.bl-error { font-size: 12.5px; line-height: 1.35; color: #b3362f; margin-top: 3px; }
.bl-vector { display: grid; grid-template-columns: 1fr 1fr 1fr; gap: 6px; }
.bl-field .v-field { font-size: 14px; } .bl-field .v-field__input { font-size: 14px; }
.bl-bar { display: flex; align-items: center; gap: 4px; padding: 0 8px; background: #fff;
  border-bottom: 1px solid #d9e1e7; overflow: hidden; }
.bl-bar > * { flex-shrink: 0; } .bl-bar .v-select { max-width: 172px; flex: 0 1 172px; min-width: 90px; }
.bl-bar .v-field__input { min-height: 30px; padding: 2px 0 2px 10px; font-size: 13px; }
.bl-bar .v-field { padding-inline-end: 2px; } .bl-bar .v-field__append-inner { padding-top: 3px; }
.bl-view { min-height: 0; min-width: 0; position: relative; overflow: hidden; }
.bl-cut { position: absolute; right: 14px; top: 8px; width: 180px; }
.bl-time { display: flex; align-items: center; gap: 12px; padding: 2px 14px; background: #fff;
  border-top: 1px solid #d9e1e7; font-size: 13px; }
.bl-panel { background: #fff; border-top: 1px solid #d9e1e7; display: grid; grid-template-rows: 36px minmax(0, 1fr);
  min-height: 0; }
.bl-scroll { overflow: auto; min-height: 0; padding: 6px 14px; }
.bl-rows { border-collapse: collapse; font-size: 13px; } .bl-rows td { padding: 2px 14px 2px 0; vertical-align: top; }
.bl-rows td:first-child { color: #6a7883; white-space: nowrap; }
.bl-rows tr.key td { font-weight: 600; color: #1f3d4f; }
.bl-text { width: 100%; height: 100%; border: 0; outline: 0; resize: none; white-space: pre; tab-size: 2;
  font: 13px/1.45 "DejaVu Sans Mono", Menlo, monospace; color: #22303a; }
.bl-curves { display: grid; grid-template-columns: 210px minmax(0, 1fr); gap: 12px; } .bl-chart { height: 186px; }
.bl-say { color: #6a7883; font-size: 13px; }
.bl-words { font-size: 13px; color: #33404a; white-space: nowrap; overflow: hidden; text-overflow: ellipsis; }
"""
SMALL = {"density": "compact", "hide_details": True, "variant": "outlined"}


def build(window: Any) -> None:
    """Builds the page of a window."""
    with VAppLayout(window.server, vuetify_config=THEME) as layout:
        client.Style(STYLE)
        _bar(window)
        with v.VMain():
            with html.Div(classes="bl-page"):
                _tree(window)
                _form(window)
                with html.Div(classes="bl-right"):
                    _view_bar(window)
                    with html.Div(classes="bl-view"):
                        view = vtk.VtkRemoteView(window.view.plotter.ren_win, interactive_ratio=1,
                                                 interactive_quality=70, still_quality=92)
                        v.VSlider(v_if="cut", v_model=("cut_at",),
                                  min=0, max=1, step=0.02, density="compact", hide_details=True, thumb_size=14,
                                  color="primary", classes="bl-cut")
                    window.server.controller.view_update = view.update
                    _time(window)
                    _panel(window)
        _dialogs(window)
    window.layout = layout


def _bar(window: Any) -> None:
    with v.VAppBar(height=48, color="primary", flat=True):
        html.Div("Bedload", style="font-weight: 700; font-size: 18px; padding: 0 14px; letter-spacing: .3px;")
        html.Div("{{ file }}{{ changed ? ' *' : '' }}", classes="text-body-2", style="opacity: .9;", id="file")
        v.VSpacer()
        _button("New", "mdi-file-plus-outline", window.new)
        _button("Open", "mdi-folder-open-outline", (window.browse, "['open']"))
        _button("Save", "mdi-content-save-outline", window.save)
        _button("Save as", "mdi-content-save-edit-outline", (window.browse, "['save']"))
        v.VDivider(vertical=True, classes="mx-2", opacity=0.4)
        _button("Undo", "mdi-undo", window.undo, disabled=("!can_undo",))
        _button("Redo", "mdi-redo", window.redo, disabled=("!can_redo",))
        v.VDivider(vertical=True, classes="mx-2", opacity=0.4)
        _button("Results", "mdi-chart-timeline-variant", (window.browse, "['results', out || null]"))
        busy = "['starting', 'running', 'paused'].includes(run_state)"
        v.VBtn("Check", click=window.start_check, prepend_icon="mdi-check-circle-outline", variant="tonal",
               size="small", classes="mx-1", loading=("checking",), id="check")
        v.VBtn("Run", v_if=(f"!{busy}",), click=window.ask_run, prepend_icon="mdi-play", color="secondary",
               variant="flat", size="small", classes="mx-1 mr-3", id="run")
        v.VBtn("{{ run_state == 'paused' ? 'Resume' : 'Pause' }}", v_if=(busy,), click=window.pause, size="small",
               prepend_icon=("run_state == 'paused' ? 'mdi-play' : 'mdi-pause'",), variant="tonal", classes="mx-1",
               disabled=("run_state == 'starting'",), id="pause")
        v.VBtn("Stop", v_if=(busy,), click=window.stop, prepend_icon="mdi-stop", color="error", variant="flat",
               size="small", classes="mx-1 mr-3", id="stop")


def _button(words: str, icon: str, click: Any, **more: Any) -> None:
    with v.VBtn(icon=True, size="small", click=click, id=words.lower().replace(" ", "_"), **more):
        v.VIcon(icon)
        v.VTooltip(words, activator="parent", location="bottom")


def _tree(window: Any) -> None:
    with html.Div(classes="bl-column", style="padding: 6px 0;"):
        with html.Div(v_for="n in nodes", key="n.path", click=(window.select, "[n.path]"), id=("'node ' + n.path",),
                      classes=("'bl-node' + (n.path == selected ? ' on' : '') + (n.wrong ? ' wrong' : '')",),
                      style=("{paddingLeft: (8 + 14 * n.depth) + 'px'}",)):
            v.VIcon("{{ n.icon }}", size=16, classes="mr-2", style="opacity: .75;")
            html.Span("{{ n.title }}")
            v.VSpacer()
            v.VIcon("mdi-alert-circle", v_if="n.wrong", size=15, color="error")
        with html.Div(classes="pa-2 pt-3"):
            with v.VMenu(max_height=460):
                with v.Template(v_slot_activator="{ props }"):
                    v.VBtn("Add", v_bind="props", prepend_icon="mdi-plus", size="small", variant="tonal",
                           color="primary", block=True, id="add")
                with v.VList(density="compact"):
                    _addition(window, "root_additions")


def _addition(window: Any, names: str) -> None:
    v.VListItem(v_for=f"a in {names}", key="a.path", title=("a.title",), prepend_icon=("a.icon",),
                click=(window.add, "[a.path, a.is_list]"), id=("'add ' + a.path",))


def _form(window: Any) -> None:
    with html.Div(classes="bl-column", style="padding: 12px 16px; background: #fbfcfd;", id="form"):
        with html.Div(classes="d-flex align-center mb-2"):
            html.Div("{{ form_title }}", classes="bl-head")
            v.VSpacer()
            with v.VBtn(v_if="selected", icon=True, size="x-small", variant="text", click=(window.remove, "[selected]"),
                        id="remove"):
                v.VIcon("mdi-delete-outline", size=20)
                v.VTooltip("Remove from the case", activator="parent", location="bottom")
        with html.Div(v_if="additions.length", classes="mb-3"):
            v.VChip("{{ a.title }}", v_for="a in additions", key="a.path", prepend_icon="mdi-plus", size="small",
                    classes="mr-1 mb-1", color="primary", variant="tonal", click=(window.add, "[a.path, a.is_list]"),
                    id=("'add ' + a.path",))
        with html.Div(v_if="problem && !problem_here", classes="bl-error mb-3", style="cursor: pointer;",
                      click=window.show_problem, id="problem"):
            v.VIcon("mdi-alert-circle", size=16, classes="mr-1")
            html.Span("{{ problem_line ? 'Line ' + problem_line + ': ' : '' }}{{ problem }}")
        with html.Div(v_if="nodes.length == 1", classes="bl-say mb-3"):
            html.Span("An empty case. Add what it needs: a domain; shapes, walls, fluid and grains; time and output. "
                      "Every field has its meaning, unit and default.")
        with html.Div(v_for="f in fields", key="f.path", classes="bl-field", id=("'field ' + f.path",),
                      v_show="f.given || f.required || f.error || all_keys || fields.length < 6"):
            _field(window)
        with html.Div(v_if="fields.length >= 6 && fields.some((f) => !f.given && !f.required)", classes="mt-1"):
            v.VBtn("{{ all_keys ? 'Fewer keys' : 'All keys (' + fields.length + ')' }}", size="small", variant="text",
                   color="primary", click="all_keys = !all_keys", id="all_keys",
                   prepend_icon=("all_keys ? 'mdi-chevron-up' : 'mdi-chevron-down'",))
        with html.Div(v_if="selected == 'shape' || selected == ''", classes="mt-4"):
            v.VFileInput(v_model=("mesh", None), label="Drop a mesh here: STL, OBJ or PLY",
                         accept=".stl,.obj,.ply,.asc",
                         prepend_icon="", prepend_inner_icon="mdi-vector-triangle", id="mesh", **SMALL)


def _field(window: Any) -> None:
    with html.Div(classes="bl-label"):
        html.B("{{ f.name }}")
        html.I("{{ f.unit }}")
        html.I("{{ f.required && !f.given ? '· required' : '' }}", classes="ml-1")
        v.VSpacer()
        html.I("{{ f.allowed }}", style="font-size: 12px;")
        with v.VBtn(v_if="f.given", icon=True, size="x-small", variant="text", click=(window.reset, "[f.path]"),
                    classes="ml-1", style="margin: -4px -6px -4px 4px;"):
            v.VIcon("mdi-close", size=15)
            v.VTooltip("Default: {{ f.default }}", activator="parent", location="left")
    default = "f.required ? '' : f.default"
    v.VSelect(v_if="f.widget == 'choice'", model_value=("f.texts[0] || null",), items=("f.choices",),
              item_title="title", item_value="value", item_props=("(c) => ({subtitle: c.meaning})",),
              placeholder=(default,), persistent_placeholder=True, error=("!!f.error",), id=("f.path",),
              update_modelValue=(window.set_value, "[f.path, $event]"), **SMALL)
    v.VSwitch(v_else_if="f.widget == 'switch'", color="primary", density="compact", hide_details=True, inset=True,
              model_value=("f.given ? f.texts[0] == 'true' : f.default == 'true'",), error=("!!f.error",),
              update_modelValue=(window.set_value, "[f.path, $event]"),
              label=("f.given ? (f.texts[0] == 'true' ? 'on' : 'off') : 'default: ' + f.default",))
    with html.Div(v_else_if="f.widget == 'vector'", classes="bl-vector"):
        v.VTextField(v_for="(axis, k) in ['x', 'y', 'z']", key="axis", model_value=("f.texts[k]",),
                     prefix=("axis",), error=("!!f.error",), persistent_placeholder=True,
                     placeholder=("(f.default.startsWith('[') && f.default.match(/[^\\[\\],\\s]+/g)?.[k]) || ' '",),
                     id=("f.path + ' ' + axis",),
                     change=(window.set_text, "[f.path, $event.target.value, k]"), **SMALL)
    v.VTextField(v_else=True, model_value=("f.texts[0]",), placeholder=(default,), persistent_placeholder=True,
                 error=("!!f.error",), id=("f.path",), suffix=("f.given && /[A-Za-z]/.test(f.texts[0]) ? '' : f.unit",),
                 change=(window.set_text, "[f.path, $event.target.value]"), **SMALL)
    html.Div("{{ f.error }}", v_if="f.error", classes="bl-error")
    html.Div("{{ f.meaning }}", classes="bl-meaning")


def _view_bar(window: Any) -> None:
    with html.Div(classes="bl-bar"):
        with v.VBtnToggle(v_model=("mode",), mandatory=True, density="compact", color="primary", variant="outlined",
                          divided=True, style="height: 28px;"):
            v.VBtn("Case", value="case", size="small")
            v.VBtn("Run", value="run", size="small", disabled=("!run_state",))
            v.VBtn("Results", value="results", size="small", disabled=("!results",))
        for direction in ("3-D", "x", "y", "z"):
            v.VBtn(direction, size="small", variant="text", min_width=26, click=(window.look_from, f"['{direction}']"),
                   id=f"look_{direction}",
                   classes="text-none px-1")
        v.VSpacer()
        for store in ("fluid", "grains"):
            v.VSelect(v_model=(f"colour_{store}",), items=(f"colours_{store}",), v_if=f"colours_{store}.length",
                      item_title=(f"(name) => '{store}: ' + name",), item_value=("(name) => name",),
                      id=f"colour_{store}", **SMALL)
        v.VSelect(v_model=("cut",), style="max-width: 100px;",
                  v_if="colours_fluid.length + colours_grains.length",
                  id="cut", items=("['', 'x', 'y', 'z'].map((a) => ({title: a ? 'cut ' + a : 'no cut', value: a}))",),
                  **SMALL)
        with v.VBtn(icon=True, size="small", variant="text", click="hide_walls = !hide_walls", id="walls"):
            v.VIcon("{{ hide_walls ? 'mdi-eye-off-outline' : 'mdi-eye-outline' }}", size=20)
            v.VTooltip("Walls beside particles", activator="parent", location="bottom")
        for words, icon, click, more in (("Picture", "mdi-camera-outline", window.save_picture, {}),
                                         ("Film", "mdi-filmstrip", window.save_film, {"disabled": ("!results",)})):
            with v.VBtn(icon=True, size="small", variant="text", click=click, id=words.lower(), **more):
                v.VIcon(icon, size=20)
                v.VTooltip(words, activator="parent", location="bottom")


def _time(window: Any) -> None:
    with html.Div():
        with html.Div(v_if="mode == 'results' && times.length", classes="bl-time"):
            with v.VBtn(icon=True, size="x-small", variant="text", click="frame = Math.max(frame - 1, 0)"):
                v.VIcon("mdi-chevron-left", size=20)
            v.VSlider(v_model=("frame",), min=0, max=("times.length - 1",), step=1, density="compact",
                      hide_details=True, color="primary", thumb_size=16, id="frame")
            with v.VBtn(icon=True, size="x-small", variant="text",
                        click="frame = Math.min(frame + 1, times.length - 1)", id="next_frame"):
                v.VIcon("mdi-chevron-right", size=20)
            html.Div("{{ times[frame]?.toPrecision(4) }} s, frame {{ frame + 1 }} of {{ times.length }}",
                     style="white-space: nowrap; min-width: 150px;")
        v.VProgressLinear(v_if="filming > 0", model_value=("filming",), color="secondary", height=4)
        with html.Div(v_if="run_error", classes="bl-time", id="run_error"):
            v.VIcon("mdi-alert-circle", size=16, color="error")
            html.Div("{{ run_error }}", classes="bl-error")
            v.VSpacer()
            with v.VBtn(icon=True, size="x-small", variant="text", click="run_error = ''"):
                v.VIcon("mdi-close", size=15)
        with html.Div(v_if="mode == 'run' && run_state", classes="bl-time"):
            v.VProgressLinear(model_value=("run_part",), height=6, rounded=True, color="primary",
                              style="max-width: 260px;", indeterminate=("run_state == 'starting'",))
            html.Div("{{ run_words }}", classes="bl-words", id="run_words")


def _panel(window: Any) -> None:
    with html.Div(classes="bl-panel"):
        with html.Div(classes="d-flex align-center", style="border-bottom: 1px solid #e7edf1;"):
            with v.VTabs(v_model=("panel",), density="compact", height=36, color="primary"):
                for name in ("check", "curves", "text"):
                    v.VTab(name.capitalize(), value=name, classes="text-none", id=f"tab_{name}")
            v.VSpacer()
            html.Div("{{ mode == 'results' ? results : '' }}", classes="bl-say mr-3")
        with html.Div(v_if="panel == 'check'", classes="bl-scroll", id="check_panel"):
            html.Div("The case has changed since this check.", v_if="stale", classes="bl-say mb-1",
                     style="color: #b06a1c;")
            with html.Div(v_for="w in warnings", key="w", classes="bl-say"):
                v.VIcon("mdi-alert-outline", size=16, color="warning", classes="mr-1")
                html.Span("{{ w }}")
            html.Div("{{ problem }}", v_if="problem", classes="bl-error")
            html.Div("{{ check_words }}", v_if="check_words", classes="bl-error", style="white-space: pre-wrap;")
            with html.Div(v_if="!check_rows.length && !problem && !checking && !check_words", classes="bl-say"):
                html.Span("No errors. Check places the particles and reports memory, time step and run time.")
            html.Div("Placing particles, timing the first steps ...", v_if="checking", classes="bl-say")
            with html.Table(v_if="check_rows.length", classes="bl-rows"):
                with html.Tr(v_for="(r, k) in check_rows", key="k",
                             classes=("['particles', 'memory', 'steps', 'run time'].includes(r.about) ? 'key' : ''",)):
                    html.Td("{{ r.about }}")
                    html.Td("{{ r.says }}")
        with html.Div(v_if="panel == 'curves'", classes="bl-scroll"):
            html.Div("Probes, bodies and balances of a run are drawn here.", v_if="!tables.length", classes="bl-say")
            with html.Div(v_if="tables.length", classes="bl-curves"):
                with html.Div():
                    v.VSelect(v_model=("table",), items=("tables",), label="Table", classes="mb-3 mt-1", **SMALL)
                    v.VSelect(v_model=("columns",), items=("all_columns",), label="Curves", multiple=True, **SMALL)
                html.Div(v_html=("chart",), classes="bl-chart")
        with html.Div(v_if="panel == 'text'", classes="bl-scroll", style="padding: 4px 10px;"):
            html.Textarea(classes="bl-text", id="text", change=(window.write_text, "[$event.target.value]"),
                          raw_attrs=[':value="text"', 'spellcheck="false"'])


def _dialogs(window: Any) -> None:
    with v.VDialog(model_value=("!!browse",), max_width=560, update_modelValue="browse = $event ? browse : ''"):
        with v.VCard():
            v.VCardTitle("{{ ({open: 'Open a case', save: 'Save the case as', results: 'Open results'})[browse] }}")
            v.VCardSubtitle("{{ browse_at }}", style="direction: rtl; text-align: left;")
            with v.VCardText():
                with v.VList(density="compact", style="max-height: 320px; overflow-y: auto;"):
                    v.VListItem(title="..", prepend_icon="mdi-arrow-up", click=(window.browse, "[browse, browse_up]"))
                    v.VListItem(v_for="i in browse_items", key="i.path", title=("i.name",),
                                prepend_icon=("i.run ? 'mdi-chart-timeline-variant' : i.folder ? "
                                              "'mdi-folder-outline' : 'mdi-file-document-outline'",),
                                click=(window.browse_click, "[i.path, i.folder, i.run]"))
                v.VTextField(v_if="browse == 'save'", v_model=("browse_name",), label="File name", classes="mt-2",
                             id="file_name", **SMALL)
            with v.VCardActions():
                v.VSpacer()
                v.VBtn("Cancel", click="browse = ''")
                v.VBtn("Open this folder", v_if="browse == 'results'", color="primary",
                       click=(window.chosen, "[browse_at]"))
                v.VBtn("Save", v_if="browse == 'save'", color="primary", click=(window.chosen, "[browse_name]"),
                       id="save_here")
    with v.VDialog(v_model=("ask_run",), max_width=480):
        with v.VCard():
            v.VCardTitle("There is a run already")
            with v.VCardText():
                html.Div("{{ run_out }} holds a run of this case. Restart it from its newest checkpoint, or replace "
                         "it?")
                v.VCheckbox(v_model=("allow_changes",), label="Restart also if the case has changed",
                            density="compact", hide_details=True, disabled=("!can_restart",))
            with v.VCardActions():
                v.VSpacer()
                v.VBtn("Cancel", click="ask_run = false")
                v.VBtn("Replace", color="error", click=(window.start_run, "[false, true]"), id="replace")
                v.VBtn("Restart", color="primary", disabled=("!can_restart",),
                       click=(window.start_run, "[true, false]"), id="restart")
    with v.VSnackbar(v_model=("message_seen",), timeout=6000, location="bottom start"):
        html.Span("{{ message }}")
