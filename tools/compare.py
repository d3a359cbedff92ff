#!/usr/bin/env python3
"""Compares a run with what its case expects.

    compare.py CASE RUN_DIR

CASE is a case folder with an expect.toml, or such a file itself. Prints one line per check and
exits with 1 if one failed, with 2 if it cannot be evaluated. A [[check]] has a `name`, a `kind`
and, if it is only a plausibility check, `advice = true`: missing it is shown but does not fail.

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
decay      series; time_range; rate, tolerance             fitted exponential rate (1/s) is within
                                                           `tolerance` (relative) of `rate`
below      series; other_data, other_column; slack         series <= other + slack at all times
falls      series; time_range; slack                       series never rises by more than `slack`
"""

import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from frames import Frames, Table


@dataclass
class Result:
    passed: bool
    text: str


class Check:
    """One [[check]], evaluated on one run."""

    def __init__(self, spec, case_dir, run_dir):
        self.spec, self.case_dir, self.run_dir = dict(spec), case_dir, run_dir
        self.name = self.spec.get("name", "unnamed")

    def evaluate(self):
        kinds = {"curve": self.curve, "profile": self.profile, "value": self.value, "decay": self.decay,
                 "below": self.below, "falls": self.falls}
        kind = self.need("kind")
        if kind not in kinds:
            raise SystemExit(f"{self.name}: kind = '{kind}' must be one of {', '.join(kinds)}")
        return kinds[kind]()

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
            t, y = table.column(table.names[0]), sum(table.column(name) for name in names)
        else:
            frames = Frames(self.run_dir / data)
            pick = self.reduction()
            t = np.array(frames.times)
            y = np.array([pick(self.field(frames, k)) for k in range(len(t))])
        if len(t) == 0:
            raise SystemExit(f"{self.name}: {data} holds no values")
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
            raise SystemExit(f"{self.name}: reduce = '{how}' must be one of {', '.join(reduce)} or a number within 0..1")
        return reduce[how]

    def field(self, frames, k):
        name = self.need("field")
        values = frames.position(k) if name == "position" else frames.get(k, name)
        if values is None:
            raise SystemExit(f"{frames.path}: has no field '{self.spec['field']}', only {frames.fields()}")
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
        for shift in np.linspace(first, last, 401 if last > first else 1):
            error = self.errors(np.interp(x - shift, t, y), expected)
            rms = np.sqrt(np.mean(error**2))
            if best is None or rms < best[0]:
                best = rms, np.max(np.abs(error)), shift
        delay = f", delay {best[2]:.3g}" if last > first else ""
        return self.judge(best[0], best[1], f", {len(x)} points{delay}")

    def profile(self):
        frames = Frames(self.run_dir / self.need("data"))
        k = frames.nearest(self.need("time"))
        place = frames.position(k)[:, self.need("along")]
        x, y = self.reference()
        found = self.field(frames, k) * self.spec.get("factor", 1.0)
        error = self.errors(found, np.interp(place, x, y))
        rms, largest = np.sqrt(np.mean(error**2)), np.max(np.abs(error))
        return self.judge(rms, largest, f" at t = {frames.times[k]:.4g} s")

    def errors(self, found, expected):
        if self.spec.get("relative", False):
            return found / expected - 1
        return (found - expected) / self.spec.get("scale", 1.0)

    def judge(self, rms, largest, remark):
        bounds = [(rms, "RMS", self.spec.get("rms")), (largest, "largest", self.spec.get("max"))]
        if all(bound is None for _, _, bound in bounds):
            raise SystemExit(f"{self.name}: needs 'rms' or 'max'")
        text = ", ".join(f"{what} {100 * e:.2f} % (<= {100 * b:g})" for e, what, b in bounds if b is not None)
        return Result(all(b is None or e <= b for e, _, b in bounds), text + remark)

    def value(self):
        t, y = self.series()
        t, y = t[self.window(t)], y[self.window(t)]
        if len(t) == 0:
            return Result(False, "no values in time_range")
        statistic = self.spec.get("statistic", "final")
        if statistic == "first_above":
            above = np.flatnonzero(y > self.need("threshold"))
            if len(above) == 0:
                return Result(False, f"never above {self.spec['threshold']:g}, at most {y.max():.5g}")
            found = t[above[0]]
        elif statistic == "slope":
            if len(t) < 2:
                return Result(False, "only one value to fit")
            found = np.polyfit(t, y, 1)[0]
        else:
            found = {"final": y[-1], "mean": y.mean(), "max": y.max(), "min": y.min()}[statistic]
        low, high = self.spec.get("low", -np.inf), self.spec.get("high", np.inf)
        if np.isinf(low) and np.isinf(high):
            raise SystemExit(f"{self.name}: needs 'low' or 'high'")
        return Result(bool(low <= found <= high), f"{statistic} {found:.6g} (within {low:g} .. {high:g})")

    def decay(self):
        t, y = self.series()
        used = self.window(t) & (y > 0)
        if used.sum() < 3:
            return Result(False, f"only {used.sum()} values to fit")
        rate, tolerance = self.need("rate"), self.need("tolerance")
        found = -np.polyfit(t[used], np.log(y[used]), 1)[0]
        return Result(bool(abs(found / rate - 1) <= tolerance),
                      f"rate {found:.5g} 1/s against {rate:.5g} ({100 * (found / rate - 1):+.2f} %, "
                      f"within {100 * tolerance:g})")

    def below(self):
        t, y = self.series()
        other_t, other = self.series("other_")
        excess = y - np.interp(t, other_t, other)
        used = self.window(t)
        k = np.argmax(np.where(used, excess, -np.inf))
        slack = self.spec.get("slack", 0.0)
        text = f"at most {excess[k]:.4g} above (<= {slack:g}), at t = {t[k]:.4g}"
        return Result(bool(excess[k] <= slack), text)

    def falls(self):
        t, y = self.series()
        t, y = t[self.window(t)], y[self.window(t)]
        if len(t) < 2:
            return Result(False, "fewer than two values in time_range")
        rise = y - np.minimum.accumulate(y)
        k, slack = int(np.argmax(rise)), self.spec.get("slack", 0.0)
        return Result(bool(rise[k] <= slack), f"rises by at most {rise[k]:.4g} (<= {slack:g}), at t = {t[k]:.4g}; "
                                              f"from {y[0]:.6g} to {y[-1]:.6g}")


def main(arguments):
    if len(arguments) != 2:
        print(__doc__.strip().splitlines()[2].strip(), file=sys.stderr)
        return 2
    case, run_dir = Path(arguments[0]), Path(arguments[1])
    expectations = case if case.suffix == ".toml" else case / "expect.toml"
    try:
        with open(expectations, "rb") as file:
            checks = tomllib.load(file).get("check", [])
    except (OSError, tomllib.TOMLDecodeError) as error:
        print(f"{expectations}: {error}", file=sys.stderr)
        return 2
    if not checks:
        print(f"{expectations}: holds no [[check]]", file=sys.stderr)
        return 2
    failed = 0
    for spec in checks:
        check = Check(spec, expectations.parent, run_dir)
        try:
            result = check.evaluate()
        except SystemExit as error:
            print(error, file=sys.stderr)
            return 2
        word = "pass" if result.passed else "note" if spec.get("advice") else "FAIL"
        failed += word == "FAIL"
        print(f"{word}  {check.name}: {result.text}")
    print(f"{len(checks) - failed} of {len(checks)} as expected")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
