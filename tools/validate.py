#!/usr/bin/env python3
"""Runs the cases of cases/ and writes a report of what they prove.

    validate [--quick | --full] [--only NAME ...] [--backend cpu|cuda] [--out DIR] [--program PATH]

Every expect*.toml of a case folder is an entry: it names the case file, what it proves and the checks. --quick takes
those that a CPU gets through, --full all of them. NAME is a folder, or one entry of it: taylor_green/re100. Writes
DIR/report.html, one page with everything in it, and DIR/report.md; results lie in DIR/runs. A case that DIR holds
with the same program, files and settings is not run again. Exits with 1 if a case could not be run, with 0 else,
whether references were met or not: the report says so.
"""

import argparse
import base64
import hashlib
import html
import io
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

from compare import Check, Result, expectations  # noqa: E402
from runs import finish, start_case, summary_of  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
DONE = (0, 3, 4)  # exit codes of the program that the same case will have again
BROKEN = {3: "the simulation failed", 4: "more was lost than run.max_lost allows"}
COLUMNS = ("case", "proves", "picture", "closest to or furthest beyond its tolerance", "held", "verdict", "run time",
           "particles", "device", "precision", "commit")
BLUE, BAND, MARK = "#1e6fb8", "#cfe6cf", "#c2410c"
KEYS = {"check", "key", "set", "prepare", "quick", "full"}  # of [convergence]


@dataclass
class Entry:
    """One expect file and the case that it is about."""

    path: Path
    cases: Path

    def __post_init__(self):
        self.header = expectations(self.path)
        self.folder = self.path.parent
        stem = self.path.stem.removeprefix("expect").removeprefix("_")
        self.name = f"{self.folder.relative_to(self.cases)}{'/' + stem if stem else ''}"
        self.case = self.folder / self.header.get("case", f"{stem or 'case'}.toml")
        plan = self.header.get("convergence")
        if plan is not None:
            for key in plan:
                if key not in KEYS:
                    raise SystemExit(f"{self.path}: [convergence] has no '{key}', only {', '.join(sorted(KEYS))}")
            if plan.get("check") not in [spec.get("name") for spec in self.header["check"]]:
                raise SystemExit(f"{self.path}: convergence.check: unknown check '{plan.get('check')}'")
            if not plan.get("quick"):
                raise SystemExit(f"{self.path}: convergence.quick is missing: the values of the key")

    def run_name(self):
        """Of the run; entries that look at the same run have the same."""
        return self.name if "set" in self.header else str(self.case.relative_to(self.cases).with_suffix(""))

    def chosen(self, options):
        if options.only:
            return any(name in (self.name, str(self.folder.relative_to(self.cases))) for name in options.only)
        return options.full or self.header.get("quick", False)


@dataclass
class Outcome:
    """What became of one run."""

    folder: Path
    stamp: dict
    message: str = ""  # why there is nothing to compare; empty if there is

    def summary(self):
        return summary_of(self.folder)

    def seconds(self):
        return self.summary().get("wall_time", {}).get("value")


@dataclass
class Row:
    """An entry with its results."""

    entry: Entry
    run: Outcome = None
    results: list = field(default_factory=list)  # (Check, Result)
    levels: list = field(default_factory=list)  # (value, error or None, Outcome)
    picture: Path = None
    message: str = ""
    section: list = None  # of the page

    def verdict(self):
        if self.message:
            return "not run"
        if any(not result.passed and not check.spec.get("advice") for check, result in self.results):
            return "miss"
        return "calibrated" if "calibrated" in self.entry.header else "pass"

    def merit(self):
        """The check that uses most of its tolerance, those that miss first."""
        if self.message:
            return self.message
        weight = lambda pair: (not pair[1].passed and not pair[0].spec.get("advice"), pair[1].used or 0)  # noqa: E731
        check, result = max(self.results, key=weight)
        return f"{check.name}: {result.text}"

    def held(self):
        required = [result.passed for check, result in self.results if not check.spec.get("advice")]
        return f"{sum(required)} of {len(required)}"

    def order(self):
        """Observed order of convergence over all levels by least squares; None with fewer than two errors."""
        known = [(value, error) for value, error, _ in self.levels if error]
        return float(np.polyfit(*np.log(np.transpose(known)), 1)[0]) if len(known) > 1 else None


# ---- running ----


def digest(*parts):
    """Short name of texts and of the contents of files."""
    found = hashlib.sha256()
    for part in parts:
        found.update(part.read_bytes() if isinstance(part, Path) else str(part).encode())
        found.update(b"\0")
    return found.hexdigest()[:16]


def inputs(folder, *texts):
    """Files of a folder that the case or the expectations of a run name."""
    return sorted(p for p in folder.iterdir() if p.is_file() and any(p.name in text for text in texts))


def commit():
    """Of the sources, with a + if they have changed since; "unknown" outside a repository."""
    git = ["git", "-C", str(ROOT)]
    try:
        named = subprocess.run([*git, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True)
        changed = subprocess.run([*git, "status", "--porcelain", "--", "src", "include", "kernels", "CMakeLists.txt"],
                                 capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return named.stdout.strip() + ("+" if changed.stdout.strip() else "")


class Runner:
    """Runs cases into DIR/runs, unless they are there already."""

    def __init__(self, options):
        self.options, self.runs = options, options.out / "runs"
        self.runs.mkdir(parents=True, exist_ok=True)
        self.program, self.commit = digest(options.program), commit()

    def run(self, entry, name, settings, prepare=None):
        """Runs a case unless that has been done, then the scripts that measure it."""
        folder = self.runs / name.replace("/", "_")
        stamp_file, log_file = beside(folder, ".json"), beside(folder, ".log")
        words = json.dumps(settings), prepare or ""
        key = digest(self.program, self.options.backend, entry.case, *words,
                     *inputs(entry.folder, entry.case.read_text(), *words))
        stamp = json.loads(stamp_file.read_text()) if stamp_file.exists() else {}
        if stamp.get("key") != key or stamp["code"] not in DONE or not folder.exists():
            print(f"{name}: running", flush=True)
            stamp_file.unlink(missing_ok=True)
            with open(log_file, "w") as log:
                stamp = {"key": key, "commit": self.commit, "date": time.strftime("%Y-%m-%d"),
                         "code": self.start(entry, folder, settings, prepare, log)}
            if folder.exists():
                stamp_file.write_text(json.dumps(stamp))
        if stamp["code"]:
            code = stamp["code"]
            why = code if isinstance(code, str) else BROKEN.get(code, f"the program ended with {code}")
            return Outcome(folder, stamp, f"{why}: {last_line(log_file)}")
        for script in entry.header.get("measure", []):
            first, *others = script.split()
            with open(log_file, "a") as log:
                code = subprocess.run([sys.executable, str(entry.folder / first), str(folder), *others], stdout=log,
                                      stderr=log).returncode
            if code:
                return Outcome(folder, stamp, f"{first} ended with {code}: {last_line(log_file)}")
        return Outcome(folder, stamp)

    def start(self, entry, folder, settings, prepare, log):
        if prepare:
            folder.parent.mkdir(exist_ok=True)
            first, *others = prepare.split()
            command = [sys.executable, str(entry.folder / first), *others]
            code = subprocess.run(command, stdout=log, stderr=log).returncode
            if code:
                return f"{first} ended with {code}"
        return start_case(self.options.program, entry.case, folder, settings, "--overwrite", "--quiet", "--backend",
                          self.options.backend, command=entry.header.get("command", "run"), log=log)

    def row(self, entry):
        """All of an entry; what goes wrong ends in its message."""
        row = Row(entry)
        try:
            row.run = self.run(entry, entry.run_name(), entry.header.get("set", {}))
            row.message = row.run.message
            if not row.message:
                row.results = [evaluate(spec, entry, row.run.folder) for spec in entry.header["check"]]
            row.picture = self.picture(entry, row.run.folder)
            if "convergence" in entry.header and not self.options.no_convergence:
                row.levels = self.converge(entry)
        except (Exception, SystemExit) as error:  # one bad case must not cost the report
            row.message = row.message or f"{type(error).__name__}: {error}"
        return row

    def converge(self, entry):
        """The case at several resolutions: (value, error of the check or None, run)."""
        plan = entry.header["convergence"]
        spec = next(s for s in entry.header["check"] if s.get("name") == plan["check"])
        levels = []
        for value in plan["full" if self.options.full and "full" in plan else "quick"]:
            name = f"{entry.run_name()}_{value:g}"
            fit = {"value": f"{value:g}", "file": str(self.runs / (name.replace("/", "_") + ".particles.csv"))}
            settings = {key: v.format(**fit) if isinstance(v, str) else v for key, v in plan.get("set", {}).items()}
            settings = entry.header.get("set", {}) | settings | {plan.get("key", "fluid.dx"): value}
            prepare = plan["prepare"].format(**fit) if "prepare" in plan else None
            run = self.run(entry, name, settings, prepare)
            error = None if run.message else evaluate(spec, entry, run.folder)[1].error
            levels.append((value, error, run))
        return levels

    def picture(self, entry, folder):
        """Picture of the run, by [picture] of the entry; None if it cannot be drawn."""
        if not any((folder / f"{store}.vtkhdf").exists() for store in ("fluid", "grains")):
            return None
        out = beside(folder, ".png")
        made_of = [entry.path, beside(folder, ".json")]
        if not out.exists() or any(p.exists() and p.stat().st_mtime > out.stat().st_mtime for p in made_of):
            out.unlink(missing_ok=True)
            with open(beside(folder, ".log"), "a") as log:
                subprocess.run([sys.executable, str(ROOT / "tools" / "render.py"), str(folder), "--like",
                                str(entry.path), "--out", str(out)], stdout=log, stderr=log)
        return out if out.exists() else None


def beside(folder, ending):
    """A file of the folder's name, and an ending, beside it."""
    return folder.parent / (folder.name + ending)


def last_line(path):
    lines = [line.strip() for line in path.read_text(errors="replace").splitlines() if line.strip()]
    return lines[-1] if lines else "it printed nothing"


def evaluate(spec, entry, folder):
    check = Check(spec, entry.folder, folder)
    try:
        return check, check.evaluate()
    except (Exception, SystemExit) as error:
        return check, Result(False, f"cannot be evaluated: {error}")


# ---- drawing ----


def data_uri(image):
    """A PIL image as text that a page can hold."""
    out = io.BytesIO()
    image.convert("RGB").quantize(128, Image.Quantize.MAXCOVERAGE).save(out, "PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(out.getvalue()).decode()


def thumbnail(path):
    with Image.open(path) as image:
        small = image.convert("RGB")
    small.thumbnail((180, 120))
    return data_uri(small)


def figure_uri(figure):
    out = io.BytesIO()
    figure.savefig(out, dpi=100)
    plt.close(figure)
    return data_uri(Image.open(out))


def plot(check, drawing):
    """Result against reference and what passes, as a data URI."""
    figure, axes = plt.subplots(figsize=(4.6, 2.9), layout="constrained")
    seen = [np.asarray(part, float) for part in [drawing.found[1], *([drawing.expected[1]] if drawing.expected else []),
                                                 *(drawing.band[1:] if drawing.band else [])]]
    seen = np.concatenate([values[np.isfinite(values)] for values in seen])
    low, high = (seen.min(), seen.max()) if len(seen) else (0, 1)
    if drawing.log:
        axes.set_yscale("log")
        low, high = low / 1.2, high * 1.2
    else:
        margin = 0.08 * (high - low) or 0.1 * abs(high) or 1.0
        low, high = low - margin, high + margin
    if drawing.band:
        x, bottom, top = drawing.band
        axes.fill_between(x, np.clip(bottom, low, high), np.clip(top, low, high), color=BAND, label="passes", lw=0.8,
                          edgecolor="#8fbf8f")
    first, last = np.min(drawing.found[0]), np.max(drawing.found[0])
    for begin, end in drawing.spans:
        axes.axvspan(max(begin, first), min(end, last), color=BAND, label="passes")
    if drawing.points:
        axes.plot(*drawing.found, ".", color=BLUE, ms=2, label="Bedload")
    else:
        axes.plot(*drawing.found, color=BLUE, lw=1.2, label="Bedload")
    if drawing.expected:
        few = len(drawing.expected[0]) <= 60 and not drawing.log and len(drawing.expected[0]) > 2
        style = {"marker": "o", "ls": "", "ms": 4, "mfc": "none"} if few else {"ls": "--", "lw": 1.2}
        axes.plot(*drawing.expected, color=MARK, label="expected", **style)
    if drawing.mark:
        axes.plot(*drawing.mark, color=BLUE, lw=2.2, alpha=0.6, marker="o" if len(drawing.mark[0]) == 1 else "", ms=5,
                  label=str(check.spec.get("statistic", "fit" if drawing.log else "final")).replace("_", " "))
    axes.set_ylim(low, high)
    axes.set_xlabel(drawing.across, fontsize=8)
    axes.set_ylabel(str(check.spec.get("column", check.spec.get("field", ""))), fontsize=8)
    axes.tick_params(labelsize=8)
    axes.legend(fontsize=7, frameon=False)
    return figure_uri(figure)


def plot_levels(row):
    """Error over resolution beside slopes of 1 and 2."""
    value, error = np.transpose([(v, e) for v, e, _ in row.levels if e])
    figure, axes = plt.subplots(figsize=(4.6, 2.9), layout="constrained")
    axes.loglog(value, error, "o-", color=BLUE, label=f"Bedload, order {row.order():.2f}")
    for order, style in ((1, ":"), (2, "--")):
        axes.loglog(value, error[np.argmax(value)] * (value / value.max()) ** order, style, color="grey", lw=1,
                    label=f"order {order}")
    axes.set_xlabel(row.entry.header["convergence"].get("key", "fluid.dx"))
    axes.set_ylabel("error")
    axes.legend(fontsize=7, frameon=False)
    return figure_uri(figure)


# ---- telling ----


def span(seconds):
    """A time to read."""
    if seconds is None:
        return "-"
    minutes, rest = divmod(seconds, 60)
    return f"{seconds:.1f} s" if seconds < 60 else f"{minutes:.0f} min {rest:.0f} s" if minutes < 60 else \
        f"{minutes // 60:.0f} h {minutes % 60:.0f} min"


def facts(row):
    """(run time, particles, device, precision, commit) of a row."""
    if row.run is None or not row.run.summary():
        return ("-",) * 5
    summary = row.run.summary()
    counts = summary.get("counts", {})
    particles = " + ".join(f"{counts[name]} {name}" for name in ("fluid", "walls", "grains") if counts.get(name))
    return (span(row.run.seconds()), particles, summary["device"]["name"], summary["precision"],
            row.run.stamp.get("commit", "-"))


def orders(row):
    """(value, error, order since the level before, run time, message) of each level."""
    before = None
    for value, error, run in row.levels:
        local = None
        if before and before[1] and error:
            local = np.log(before[1] / error) / np.log(before[0] / value)
        yield value, error, local, run.seconds(), run.message
        before = value, error


def number(value, form=".3g"):
    return "-" if value is None else format(value, form)


def in_markdown(rows, title):
    cell = lambda text: str(text).replace("|", "\\|").replace("\n", " ")  # noqa: E731
    lines = [f"# {title}", "", summary_line(rows), "",
             f"| {' | '.join(COLUMNS)} |", "|" + "---|" * len(COLUMNS)]
    for row in rows:
        picture = f"[picture](runs/{row.picture.name})" if row.picture else "-"
        lines.append("| " + " | ".join(map(cell, (
            row.entry.name, row.entry.header.get("proves", "-"), picture, row.merit(), row.held(),
            f"**{row.verdict()}**" if row.verdict() in ("miss", "not run") else row.verdict(), *facts(row)))) + " |")
    lines += ["", "## All checks", "", "| case | check | found | tolerance used | |", "|---|---|---|---|---|"]
    for row in rows:
        for check, result in row.results:
            lines.append("| " + " | ".join(map(cell, (row.entry.name, check.name, result.text, used(result),
                                                      word(check, result)))) + " |")
    if any(row.levels for row in rows):
        lines += ["", "## Convergence", "", "| case | check | resolution | error | observed order | run time |",
                  "|---|---|---|---|---|---|"]
        for row in rows:
            for value, error, local, seconds, message in orders(row):
                lines.append("| " + " | ".join(map(cell, (
                    row.entry.name, row.entry.header["convergence"]["check"], f"{value:g}",
                    message or number(error, ".3e"), number(local, ".2f"), span(seconds)))) + " |")
    calibrated = [row for row in rows if "calibrated" in row.entry.header]
    if calibrated:
        lines += ["", "## Calibrated", ""]
        lines += [f"- {row.entry.name}: {row.entry.header['calibrated']}" for row in calibrated]
    return "\n".join(lines) + "\n"


def word(check, result):
    return "pass" if result.passed else "note" if check.spec.get("advice") else "MISS"


def used(result):
    return "-" if result.used is None else f"{100 * result.used:.0f} %"


def summary_line(rows):
    verdicts = [row.verdict() for row in rows]
    counts = ", ".join(f"{verdicts.count(v)} {v}" for v in ("pass", "calibrated", "miss", "not run") if v in verdicts)
    runs = {run.folder: run for row in rows for run in [row.run, *(level[2] for level in row.levels)] if run}
    total = sum(run.seconds() or 0 for run in runs.values())
    return f"{len(rows)} entries: {counts}. Computed for {span(total)}; written {time.strftime('%Y-%m-%d %H:%M')}."


STYLE = """body{font:15px/1.45 system-ui,sans-serif;max-width:1180px;margin:24px auto;padding:0 16px;color:#1c2733}
table{border-collapse:collapse;font-size:13px;margin:10px 0}td,th{border-bottom:1px solid #d8dee4;padding:4px 8px;
text-align:left;vertical-align:top}th{background:#f3f6f9}.pass{color:#19722d}.calibrated,.note{color:#8a6100}
.miss,.MISS,.not{color:#b3261e;font-weight:bold}figure{display:inline-block;margin:6px;width:460px;vertical-align:top}
figcaption{font-size:12.5px}section{border-top:2px solid #d8dee4;margin-top:28px}img{max-width:100%}
.thumb{width:120px}.picture{width:720px}h2{margin-bottom:4px}"""


def in_html(rows, title):
    e = html.escape
    out = [f"<!doctype html><html lang=en><meta charset=utf-8><title>{e(title)}</title><style>{STYLE}</style>",
           f"<h1>{e(title)}</h1><p>{e(summary_line(rows))}</p>",
           "<p>A <b>pass</b> holds every tolerance with nothing fitted to the reference; <b>calibrated</b> holds them "
           "with a coefficient that was; a <b>miss</b> does not hold one of them. Notes are plausibility bands that "
           "are missed.</p>", f"<table><tr><th>{'<th>'.join(COLUMNS)}</tr>"]
    for row in rows:
        verdict = row.verdict()
        picture = f"<img class=thumb alt='' src='{thumbnail(row.picture)}'>" if row.picture else "-"
        cells = "<td>".join(e(fact) for fact in facts(row))
        out.append(f"<tr><td><a href='#{e(row.entry.name)}'>{e(row.entry.name)}</a><td>"
                   f"{e(row.entry.header.get('proves', '-'))}<td>{picture}<td>{e(row.merit())}<td>{row.held()}"
                   f"<td class='{verdict}'>{verdict}<td>{cells}</tr>")
    out.append("</table>")
    for row in rows:
        row.section = row.section or section(row)
        out += row.section
    return "\n".join(out) + "\n"


def section(row):
    e, header = html.escape, row.entry.header
    seconds, particles, device, precision, made = facts(row)
    out = [f"<section id='{e(row.entry.name)}'><h2>{e(row.entry.name)}: <span class='{row.verdict()}'>{row.verdict()}"
           f"</span></h2><p>{e(header.get('proves', ''))}</p>",
           f"<p>{e(particles)}; {seconds} on {e(device)}, {precision} precision, commit {made}.</p>"]
    if "set" in header:
        out.append(f"<p>With {e(', '.join(f'{k} = {v}' for k, v in header['set'].items()))}.</p>")
    if "calibrated" in header:
        out.append(f"<p class=calibrated>Calibrated: {e(header['calibrated'])}</p>")
    if row.message:
        out.append(f"<p class=miss>{e(row.message)}</p>")
    if row.picture:
        out.append(f"<img class=picture alt='{e(row.entry.name)}' src='{data_uri(Image.open(row.picture))}'>")
    if row.results:
        out.append("<table><tr><th>check<th>found<th>tolerance used<th></tr>")
        out += [f"<tr><td>{e(check.name)}<td>{e(result.text)}<td>{used(result)}<td class={word(check, result)}>"
                f"{word(check, result)}</tr>" for check, result in row.results]
        out.append("</table>")
    for check, result in row.results:
        if result.drawing is not None:
            out.append(f"<figure><img alt='' src='{plot(check, result.drawing)}'><figcaption>{e(check.name)}"
                       "</figcaption></figure>")
    if row.levels:
        out.append(f"<h3>Convergence of “{e(header['convergence']['check'])}”</h3><table><tr><th>"
                   f"{e(header['convergence'].get('key', 'fluid.dx'))}<th>error<th>observed order<th>run time</tr>")
        out += [f"<tr><td>{value:g}<td>{e(message) or number(error, '.3e')}<td>{number(local, '.2f')}"
                f"<td>{span(seconds)}</tr>" for value, error, local, seconds, message in orders(row)]
        out.append(f"</table><p>Order over all: {number(row.order(), '.2f')}.</p>")
        if row.order() is not None:
            out.append(f"<figure><img alt='' src='{plot_levels(row)}'></figure>")
    return [*out, "</section>"]


def built_program():
    """The program that was built last."""
    found = [p for p in (ROOT / "build").glob("*/bedload") if p.is_file() and os.access(p, os.X_OK)]
    return max(found, key=lambda p: p.stat().st_mtime, default=None)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="validate", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--quick", action="store_true", help="the default: about twenty minutes on a CPU")
    which.add_argument("--full", action="store_true", help="all, with finer resolutions: for a GPU")
    parser.add_argument("--only", nargs="+", metavar="NAME", default=[])
    parser.add_argument("--no-convergence", action="store_true", help="each case only at its own resolution")
    parser.add_argument("--backend", choices=["auto", "cpu", "cuda"], default="auto")
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "report", metavar="DIR",
                        help="default results/report")
    parser.add_argument("--program", type=Path, metavar="PATH", help="default: the one built last in build/")
    parser.add_argument("--cases", type=Path, default=ROOT / "cases", metavar="DIR", help="default cases")
    options = parser.parse_args(arguments)
    options.program = options.program or built_program()
    if options.program is None or not options.program.is_file():
        raise SystemExit(f"--program {options.program}: no such program; build it or pass --program PATH")
    options.program, options.out = options.program.resolve(), options.out.resolve()

    entries = [Entry(path, options.cases) for path in sorted(options.cases.glob("*/expect*.toml"))]
    known = {name for entry in entries for name in (entry.name, str(entry.folder.relative_to(options.cases)))}
    for name in options.only:
        if name not in known:
            raise SystemExit(f"--only {name}: no such case; it must be one of {', '.join(sorted(known))}")
    runner, rows = Runner(options), []
    title = f"Validation of Bedload, {'full' if options.full else 'quick'} set"
    for entry in (e for e in entries if e.chosen(options)):
        rows.append(runner.row(entry))
        print(f"{entry.name}: {rows[-1].verdict()}; {rows[-1].merit()}", flush=True)
        write(options.out, rows, title)  # after each, so that a stopped report has the results so far
    if not rows:
        raise SystemExit(f"{options.cases}: no case is in this set")
    print(f"{summary_line(rows)}\n{options.out / 'report.html'}")
    return 1 if any(row.verdict() == "not run" for row in rows) else 0


def write(out, rows, title):
    (out / "report.html").write_text(in_html(rows, title))
    (out / "report.md").write_text(in_markdown(rows, title))


if __name__ == "__main__":
    finish(main)
