#!/usr/bin/env python3
"""Compares a run with what its case expects.

    compare.py CASE RUN_DIR

CASE is a case folder with an expect.toml, or such a file itself. Prints one line per check and
exits with 1 if one failed, with 2 if it cannot be evaluated. A [[check]] has a `name`, a `kind`
and, if it is only a plausibility check, `advice = true`: missing it is shown but does not fail.
docs/report.md describes the other tables of such a file, for tools/validate.

A series over time is `data = "probes/front.csv"` with `column`, one name or several whose values are added, or
`data = "fluid.vtkhdf"` with `field` (or "position"), `component` (omit for the magnitude) and `reduce` = "mean"
(default), "max", "min", "mean_square", "deviation" (standard deviation) or a fraction of 1 (0.99: what 99 % of the
particles do not exceed). `factor` multiplies it, `time_factor` its time; `from_start = true`
subtracts its first value.

kind       keys                                            passes if
curve      reference (CSV), reference_x, reference_y,      RMS and largest error against the reference
           where, time_range, value_range, shift = [lo,    points are at most `rms` and `max`, after the
           hi], relative, scale, rms, max                  best constant delay of the series in `shift`;
                                                           errors are relative, or in units of `scale`
profile    data, field, component, along (0 1 2), time,    same, for the particles of the frame at `time`
           reference..., relative, scale, rms, max         over their coordinate `along`
value      series; statistic = final, mean, max, min,      low <= value <= high
           slope (1/s, by least squares) or first_above
           (time when it passes `threshold`);
           time_range; low, high
decay      series; time_range, value_range; rate,          fitted exponential rate (1/s; below 0: growth)
           tolerance                                       is within `tolerance` (relative) of `rate`
below      series; other_data, other_column; slack         series <= other + slack at all times
falls      series; time_range; slack                       series never rises by more than `slack`
"""

import sys
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from frames import FileError, Frames, Table


@dataclass
class Drawing:
    """What a check looked at, as (x, y) curves; those of a profile as points.

    expected: what it was compared with; band: x, lowest and highest y that pass, infinite where there is no bound;
    spans: (first, last) along x that the value has to lie in; log: whether y has a logarithmic axis.
    """

    found: tuple
    expected: tuple | None = None
    band: tuple | None = None
    mark: tuple | None = None  # the number or the fit that counts, as a line or a point
    spans: list = field(default_factory=list)
    points: bool = False
    log: bool = False
    across: str = ""  # what x is


@dataclass
class Result:
    """used: fraction of the tolerance that is taken up, above 1 if missed; error: distance from the reference in its
    own units or relative, as the check has it; both None where there is none."""

    passed: bool
    text: str
    used: float | None = None
    error: float | None = None
    drawing: Drawing | None = None


class Check:
    """One [[check]], evaluated on one run."""

    def __init__(self, spec, case_dir, run_dir):
        self.spec, self.case_dir, self.run_dir = dict(spec), case_dir, run_dir
        self.name = self.spec.get("name", "unnamed")
        self.across = "time [s]"

    def evaluate(self):
        kinds = {"curve": self.curve, "profile": self.profile, "value": self.value, "decay": self.decay,
                 "below": self.below, "falls": self.falls}
        kind = self.need("kind")
        if kind not in kinds:
            raise SystemExit(f"{self.name}: kind = '{kind}' must be one of {', '.join(kinds)}")
        result = kinds[kind]()
        if result.drawing and not result.drawing.across:
            result.drawing.across = self.across
        return result

    def need(self, key):
        if key not in self.spec:
            raise SystemExit(f"{self.name}: '{key}' is missing")
        return self.spec[key]

    # ---- data ----

    def series(self, prefix=""):
        """Times and values of the run, in the units of the check."""
        data = self.need(prefix + "data")
        if data.endswith(".csv"):
            table = Table(self.run_dir / data)
            names = self.need(prefix + "column")
            names = [names] if isinstance(names, str) else names
            self.across = table.header[0] if "time_factor" not in self.spec else "time, dimensionless"
            t, y = table.column(table.header[0]), sum(table.column(name) for name in names)
        else:
            frames = Frames(self.run_dir / data)
            pick = self.reduction()
            t = np.array(frames.times)
            y = np.array([pick(self.field(frames, k)) for k in range(len(t))])
        if len(t) == 0:
            raise SystemExit(f"{self.name}: {data} has no values")
        if self.spec.get("from_start", False):
            y = y - y[0]
        return t * self.spec.get("time_factor", 1.0), y * self.spec.get("factor", 1.0)

    def reduction(self):
        """What makes one number of all particles' values."""
        reduce = {"mean": np.mean, "max": np.max, "min": np.min, "mean_square": lambda v: np.mean(v * v),
                  "deviation": np.std}
        how = self.spec.get("reduce", "mean")
        if isinstance(how, (int, float)) and 0 <= how <= 1:
            return lambda v: np.quantile(v, how)
        if how not in reduce:
            known = ", ".join(reduce)
            raise SystemExit(f"{self.name}: reduce = '{how}' must be one of {known} or a number within 0..1")
        return reduce[how]

    def field(self, frames, k):
        name = self.need("field")
        values = frames.position(k) if name == "position" else frames.get(k, name)
        if values is None:
            raise SystemExit(f"{frames.path}: has no field '{self.spec['field']}', only {', '.join(frames.names())}")
        if values.ndim == 1:
            return values
        component = self.spec.get("component")
        return np.linalg.norm(values, axis=1) if component is None else values[:, component]

    def reference(self):
        table = Table(self.case_dir / self.need("reference")).where(self.spec.get("where", {}))
        x, y = table.column(self.need("reference_x")), table.column(self.need("reference_y"))
        order = np.argsort(x, kind="stable")
        return x[order], y[order]

    def window(self, t):
        low, high = self.spec.get("time_range", (-np.inf, np.inf))
        return (t >= low) & (t <= high)

    # ---- kinds ----

    def curve(self):
        t, y = self.series()
        x, expected = self.reference()
        low, high = self.spec.get("value_range", (-np.inf, np.inf))
        used = self.window(x) & (expected >= low) & (expected <= high)
        first, last = self.spec.get("shift", (0.0, 0.0))
        x, expected = x[used], expected[used]
        if len(x) == 0:
            raise SystemExit(f"{self.name}: no reference points in time_range and value_range")
        if x[-1] > t[-1] + first:
            return Result(False, f"the run ends at {t[-1]:.4g}, the reference at {x[-1]:.4g}")
        best = None
        drawn = Drawing((t, y), (x, expected), self.around(x, expected))
        for shift in np.linspace(first, last, 401 if last > first else 1):
            error = self.errors(np.interp(x - shift, t, y), expected)
            rms = np.sqrt(np.mean(error**2))
            if best is None or rms < best[0]:
                best = rms, np.max(np.abs(error)), shift
        delay = f", delay {best[2]:.3g}" if last > first else ""
        drawn.found = t + best[2], y
        return self.judge(best[0], best[1], f", {len(x)} points{delay}", drawn)

    def profile(self):
        frames = Frames(self.run_dir / self.need("data"))
        k = frames.nearest(self.need("time"))
        place = frames.position(k)[:, self.need("along")]
        x, y = self.reference()
        found = self.field(frames, k) * self.spec.get("factor", 1.0)
        error = self.errors(found, np.interp(place, x, y))
        rms, largest = np.sqrt(np.mean(error**2)), np.max(np.abs(error))
        along = f"{'xyz'[self.spec['along']]} [m]"
        drawn = Drawing((place, found), (x, y), self.around(x, y), points=True, across=along)
        return self.judge(rms, largest, f" at t = {frames.times[k]:.4g} s", drawn)

    def errors(self, found, expected):
        if self.spec.get("relative", False):
            return found / expected - 1
        return (found - expected) / self.spec.get("scale", 1.0)

    def around(self, x, expected):
        """Band of the largest error that passes about a reference, or of the RMS error where that alone counts."""
        bound = self.spec.get("max", self.spec.get("rms", np.inf))
        slack = bound * (np.abs(expected) if self.spec.get("relative", False) else self.spec.get("scale", 1.0))
        return x, expected - slack, expected + slack

    def judge(self, rms, largest, remark, drawn):
        bounds = [(rms, "RMS", self.spec.get("rms")), (largest, "largest", self.spec.get("max"))]
        if all(bound is None for _, _, bound in bounds):
            raise SystemExit(f"{self.name}: needs 'rms' or 'max'")
        text = ", ".join(f"{what} {100 * e:.2f} % (<= {100 * b:g})" for e, what, b in bounds if b is not None)
        used = max(e / b for e, _, b in bounds if b)
        return Result(all(b is None or e <= b for e, _, b in bounds), text + remark, used, rms, drawn)

    def value(self):
        t, y = self.series()
        drawn = Drawing((t, y))
        t, y = t[self.window(t)], y[self.window(t)]
        if len(t) == 0:
            return Result(False, "no values in time_range", drawing=drawn)
        low, high = self.spec.get("low", -np.inf), self.spec.get("high", np.inf)
        if np.isinf(low) and np.isinf(high):
            raise SystemExit(f"{self.name}: needs 'low' or 'high'")
        statistic = self.spec.get("statistic", "final")
        if statistic == "first_above":
            threshold = self.need("threshold")
            drawn.expected, drawn.spans = (t[[0, -1]], [threshold, threshold]), [(low, high)]
            above = np.flatnonzero(y > threshold)
            if len(above) == 0:
                return Result(False, f"never above {threshold:g}, at most {y.max():.5g}", drawing=drawn)
            found = t[above[0]]
            drawn.mark = [found], [threshold]
        elif statistic == "slope":
            if len(t) < 2:
                return Result(False, "only one value to fit", drawing=drawn)
            found = np.polyfit(t, y, 1)[0]
            away = t - t.mean()
            drawn.mark = t, y.mean() + found * away
            drawn.band = t, *np.sort(y.mean() + np.outer([low, high], away), axis=0)
        else:
            found = {"final": y[-1], "mean": y.mean(), "max": y.max(), "min": y.min()}[statistic]
            ends = t[[0, -1]] if len(t) > 1 and statistic != "final" else drawn.found[0][[0, -1]]
            drawn.band, drawn.mark = (ends, np.full(2, low), np.full(2, high)), (ends, np.full(2, found))
        middle, half = (low + high) / 2, (high - low) / 2
        if not np.isfinite(half):  # one bound: how much of it is there
            bound = high if np.isfinite(high) else low
            used = found / bound if bound > 0 and found > 0 else None
            used = 1 / used if used and bound == low else used
        else:
            used = abs(found - middle) / half if half > 0 else None
        exact = self.spec.get("exact")
        error = abs(found / exact - 1) if exact else None
        return Result(bool(low <= found <= high), f"{statistic} {found:.6g} (within {low:g} .. {high:g})", used, error,
                      drawn)

    def decay(self):
        t, y = self.series()
        low, high = self.spec.get("value_range", (0.0, np.inf))
        drawn = Drawing((t[y > 0], y[y > 0]), log=True)
        late = np.flatnonzero(y > high)  # beyond the range for the first time
        used = self.window(t) & (y > low) & (np.arange(len(t)) < (late[0] if len(late) else len(t)))
        if used.sum() < 3:
            return Result(False, f"only {used.sum()} values to fit, at most {y.max():.4g}", drawing=drawn)
        rate, tolerance = self.need("rate"), self.need("tolerance")
        t, level = t[used], np.log(y[used])
        found = -np.polyfit(t, level, 1)[0]
        away = t - t[0]
        drawn.mark = t, np.exp(level.mean() - found * (t - t.mean()))
        drawn.expected = t, np.exp(level[0] - rate * away)
        drawn.band = t, *(np.exp(level[0] - rate * away + sign * abs(rate) * tolerance * away) for sign in (-1, 1))
        error = abs(found / rate - 1)
        text = (f"rate {found:.5g} 1/s against {rate:.5g} ({100 * (found / rate - 1):+.2f} %, "
                f"within {100 * tolerance:g})")
        return Result(bool(error <= tolerance), text, error / tolerance, error, drawn)

    def below(self):
        t, y = self.series()
        other_t, other = self.series("other_")
        excess = y - np.interp(t, other_t, other)
        used = self.window(t)
        k = np.argmax(np.where(used, excess, -np.inf))
        slack = self.spec.get("slack", 0.0)
        text = f"at most {excess[k]:.4g} above (<= {slack:g}), at t = {t[k]:.4g}"
        drawn = Drawing((t, y), (other_t, other), (other_t, np.full(len(other), -np.inf), other + slack))
        return Result(bool(excess[k] <= slack), text, max(excess[k], 0) / slack if slack > 0 else None, drawing=drawn)

    def falls(self):
        t, y = self.series()
        t, y = t[self.window(t)], y[self.window(t)]
        if len(t) < 2:
            return Result(False, "fewer than two values in time_range")
        least = np.minimum.accumulate(y)
        rise = y - least
        k, slack = int(np.argmax(rise)), self.spec.get("slack", 0.0)
        drawn = Drawing((t, y), band=(t, np.full(len(t), -np.inf), least + slack))
        return Result(bool(rise[k] <= slack), f"rises by at most {rise[k]:.4g} (<= {slack:g}), at t = {t[k]:.4g}; "
                      f"from {y[0]:.6g} to {y[-1]:.6g}", rise[k] / slack if slack > 0 else None, drawing=drawn)


# Keys of an expect file beside its [[check]]s, and what they may be.
HEADER = {"proves": str, "case": str, "command": str, "set": dict, "quick": bool, "measure": list, "calibrated": str,
          "convergence": dict, "picture": dict}


def expectations(path):
    """What an expect file holds: a dict with `check` and the keys of HEADER that it has."""
    try:
        with open(path, "rb") as file:
            found = tomllib.load(file)
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise SystemExit(f"{path}: {error}") from None
    for key, value in found.items():
        if key != "check" and key not in HEADER:
            raise SystemExit(f"{path}: unknown key '{key}'; it must be one of check, {', '.join(HEADER)}")
        if key != "check" and not isinstance(value, HEADER[key]):
            raise SystemExit(f"{path}: {key} must be a {HEADER[key].__name__}")
    if not found.get("check"):
        raise SystemExit(f"{path}: has no [[check]]")
    return found


def main(arguments):
    if len(arguments) != 2:
        print(__doc__.strip().splitlines()[2].strip(), file=sys.stderr)
        return 2
    case, run_dir = Path(arguments[0]), Path(arguments[1])
    path = case if case.suffix == ".toml" else case / "expect.toml"
    failed = 0
    try:
        checks = expectations(path)["check"]
        for spec in checks:
            check = Check(spec, path.parent, run_dir)
            result = check.evaluate()
            word = "pass" if result.passed else "note" if spec.get("advice") else "FAIL"
            failed += word == "FAIL"
            print(f"{word}  {check.name}: {result.text}")
    except (SystemExit, FileError) as error:
        print(error, file=sys.stderr)
        return 2
    print(f"{len(checks) - failed} of {len(checks)} as expected")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
