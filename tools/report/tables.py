# SPDX-License-Identifier: Apache-2.0
"""Tables of light, references, and the figures that judge one by the other (as city/light/error_metrics does)."""
import numpy as np

COLOURS = ("r", "g", "b")
QUANTITIES = ("E_sun", "E_sky", "E_indirect")


def read_csv(path):
    """Columns of numbers by name; a leading line that begins with # is left out."""
    with open(path, encoding="utf-8") as file:
        line = file.readline()
        while line.startswith("#"):
            line = file.readline()
        names = line.strip().split(",")
        values = np.loadtxt(file, delimiter=",", ndmin=2)
    return dict(zip(names, values.T))


class Light:
    """Irradiance of patches or faces, W/m2: `area` (n), and per quantity an array (n, 3) of linear r, g, b; `error` has
    the standard errors of those that are known (else 0)."""

    def __init__(self, area):
        self.area = area
        self.value = {q: np.zeros((len(area), 3)) for q in QUANTITIES}
        self.error = {q: np.zeros((len(area), 3)) for q in QUANTITIES}
        self.sum_error = None   # of the sum, where it is known: a path that meets the sky meets no wall, so errors offset

    def total(self):
        independent = np.sqrt(sum(e ** 2 for e in self.error.values()))
        return sum(self.value.values()), independent if self.sum_error is None else self.sum_error

    def get(self, quantity):
        return self.total() if quantity == "E_total" else (self.value[quantity], self.error[quantity])

    def plus(self, other):
        result = Light(self.area)
        for q in QUANTITIES:
            result.value[q] = self.value[q] + other.value[q]
            result.error[q] = np.hypot(self.error[q], other.error[q])
        result.sum_error = np.hypot(self.total()[1], other.total()[1])
        return result

    def by_face(self, face, count):
        """Area means over the faces that the patches come from."""
        area = np.bincount(face, self.area, count)

        def mean(values):
            return np.stack([np.bincount(face, self.area * v, count) / area for v in values.T], axis=1)

        def mean_error(errors):
            return np.stack([np.sqrt(np.bincount(face, (self.area * e) ** 2, count)) / area for e in errors.T], axis=1)

        result = Light(area)
        for q in QUANTITIES:
            result.value[q], result.error[q] = mean(self.value[q]), mean_error(self.error[q])
        if self.sum_error is not None:
            result.sum_error = mean_error(self.sum_error)
        return result


def read_light(path):
    """A table of heliopolis-render --table or of heliopolis-bake reference."""
    columns = read_csv(path)
    light = Light(columns["area"])
    for q in QUANTITIES:
        light.value[q] = np.stack([columns[f"{q}_{c}"] for c in COLOURS], axis=1)
        if f"{q}_se_r" in columns:
            light.error[q] = np.stack([columns[f"{q}_se_{c}"] for c in COLOURS], axis=1)
    if "E_total_se_r" in columns:
        light.sum_error = np.stack([columns[f"E_total_se_{c}"] for c in COLOURS], axis=1)
    return light


def judge(result, reference, quantity):
    """rms, bias, P95 and maximum as fractions of the reference's mean, averaged over r, g, b; the reference's noise is
    subtracted from rms. rms_low and rms_high: what one standard error of the noise's own scatter does to rms."""
    value, _ = result.get(quantity)
    truth, error = reference.get(quantity)
    area = reference.area
    whole = area.sum()
    figures = {name: 0.0 for name in ("mean", "rms", "rms_low", "rms_high", "bias", "bias_se", "p95", "max", "noise")}
    for c in range(3):
        d, variance = value[:, c] - truth[:, c], error[:, c] ** 2
        mean = (area * truth[:, c]).sum() / whole
        if mean <= 0:
            return None
        excess = d ** 2 - variance
        square = (area * excess).sum() / whole
        # Variance of d^2 for d = difference + noise: 2 se^4 + 4 difference^2 se^2.
        scatter = np.sqrt((area ** 2 * (2 * variance ** 2 + 4 * np.maximum(excess, 0) * variance)).sum()) / whole
        order = np.argsort(np.abs(d))
        reached = np.searchsorted(np.cumsum(area[order]), 0.95 * whole)
        for name, figure in (("mean", mean), ("rms", np.sqrt(max(square, 0)) / mean),
                             ("rms_low", np.sqrt(max(square - scatter, 0)) / mean),
                             ("rms_high", np.sqrt(max(square + scatter, 0)) / mean),
                             ("bias", (area * d).sum() / whole / mean),
                             ("bias_se", np.sqrt((area ** 2 * variance).sum()) / whole / mean),
                             ("p95", np.abs(d[order[min(reached, len(order) - 1)]]) / mean),
                             ("max", np.abs(d).max() / mean),
                             ("noise", np.sqrt((area * variance).sum() / whole) / mean)):
            figures[name] += float(figure) / 3
    return figures
