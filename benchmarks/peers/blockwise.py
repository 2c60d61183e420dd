"""The same identification in a fast NumPy version: CasADi's C code for the regressor, and decimation by groups.

The response of a low-pass filter run forwards and backwards is a sum over its poles of a causal and an
anticausal part. For a group of samples between two that are kept, only products with powers of the poles are
needed. They are one matrix product for all groups and columns, then a recursion over groups, which are 50
times fewer than samples. The boundary treatment is that of SciPy's `sosfiltfilt`.
"""

import ctypes
import subprocess

import numpy as np
from scipy import signal

from .casadi_peer import c_code
from .identification import DECIMATION, DECIMATION_ORDER, RIPPLE, Pipeline
from .timing import BUILD, NATIVE, write

LOOP = """
void all(long samples, const double **inputs, const long *lengths, long count, double *output, long width) {
    const double *at[16];
    for (long k = 0; k < count; k++) at[k] = inputs[k];
    for (long sample = 0; sample < samples; sample++) {
        model(at, output + sample * width);
        for (long k = 0; k < count; k++) at[k] += lengths[k];
    }
}
"""


class Decimation:
    """Low-pass filter of the decimation by its poles, one of each pair."""

    def __init__(self, factor):
        self.factor = factor
        sections = signal.cheby1(DECIMATION_ORDER, RIPPLE, 0.8 / factor, output="sos")
        b, a = sections[:, :3], sections[:, 4:]
        p = self.poles = -0.5 * a[:, 0] + 1j * np.sqrt(a[:, 1] - 0.25 * a[:, 0] ** 2)
        above = lambda z: np.prod([[s @ [1.0, 1.0 / x, 1.0 / x**2] for s in b] for x in z], axis=1)  # noqa: E731
        pairs = lambda z: np.array([(1.0 - p / x) * (1.0 - p.conj() / x) for x in z])  # noqa: E731
        self.mirrored = above(1.0 / p) / pairs(1.0 / p).prod(axis=1)
        below = pairs(p)
        np.fill_diagonal(below, 1.0 - p.conj() / p)
        self.forward = above(p) / below.prod(axis=1)
        self.shares = self.forward * self.mirrored
        self.constant = np.prod(b[:, 2] / a[:, 1])
        self.direct = np.prod(b[:, 0]) * self.constant
        # F, then R, real and imaginary parts.
        powers = p[:, None] ** np.arange(factor)
        both = np.concatenate([powers, powers[:, ::-1]])
        self.weights = np.concatenate([both.real, both.imag])

    def apply(self, rows):
        """Decimated rows, samples x columns."""
        p, n = self.poles[:, None], self.factor
        padding = 3 * DECIMATION_ORDER
        first = (len(rows) - 1) % n
        start = np.concatenate([2.0 * rows[0] - rows[padding:0:-1], rows[:first]])
        end = np.concatenate([rows[-1:], 2.0 * rows[-1] - rows[-2 : -2 - padding : -1]])
        groups = rows[first:-1].reshape(-1, n, rows.shape[1])
        sums = self.weights @ groups
        ahead, behind = self.split(sums)
        before = start[0] * p / (1.0 - p)
        for row in start:
            before = p * (before + row)
        causal = np.empty((len(groups) + 1, *before.shape), complex)
        causal[0] = before
        power = self.poles**n
        for k, pole in enumerate(power):
            initial = (pole * before[k])[None]
            causal[1:, k] = signal.lfilter([1.0], [1.0, -pole], self.poles[k] * behind[:, k], axis=0, zi=initial)[0]
        future = self.future(causal[-1], end)
        anticausal = np.empty_like(causal)
        anticausal[-1] = future
        for k, pole in enumerate(power):
            initial = (pole * future[k])[None]
            anticausal[-2::-1, k] = signal.lfilter([1.0], [1.0, -pole], ahead[::-1, k], axis=0, zi=initial)[0]
        kept = np.einsum("k,gkc->gc", 2.0 * self.shares, causal + anticausal).real
        return kept + self.direct * rows[first::n]

    def split(self, sums):
        """F and R of each group, groups x poles x columns."""
        count = len(self.poles)
        whole = sums[:, : 2 * count] + 1j * sums[:, 2 * count :]
        return whole[:, :count], whole[:, count:]

    def future(self, causal, end):
        """Anticausal sums from the last kept sample on, over the remaining rows and the reflection."""
        p, share = self.poles[:, None], self.forward[:, None]
        state, behind, power = causal, 0.0, np.ones_like(p)
        for row in end:
            state = state + row
            value = self.constant * row + 2.0 * (share * state).sum(axis=0).real
            state = p * state
            behind, power = behind + power * value, power * p
        behind = behind + power * value / (1.0 - p)
        own = share * causal
        decay = [own[k] / (1.0 - p * q) + own[k].conj() / (1.0 - p * q.conj()) for k, q in enumerate(self.poles)]
        return (behind - sum(decay)) / self.mirrored[:, None]


class Blockwise(Pipeline):
    """Rows of samples, as C code writes them."""

    def __init__(self, function, log):
        super().__init__(function, log)
        folder = BUILD / "c" / "identification"
        write(folder / "model.c", c_code(self.function) + LOOP)
        library = folder / "model.so"
        subprocess.run([NATIVE.compiler, *NATIVE.flags, "-shared", "-fPIC", "-o", library, folder / "model.c", "-lm"], check=True)
        self.library = ctypes.CDLL(library)
        self.decimation = Decimation(DECIMATION)

    def lines(self, pose, twist, acceleration):
        """Samples x rows x (columns + 1), Y last."""
        samples, count = pose.shape[1], len(self.names)
        given = {"pose": pose, "twist": twist, "acceleration": acceleration}
        given["joints"] = np.array(self.joints(pose))
        inputs = [np.ascontiguousarray(given[name].T) for name in self.inputs]
        found = np.empty((samples, self.rows, self.width))
        pointers = (ctypes.c_void_p * len(inputs))(*[own.ctypes.data for own in inputs])
        lengths = (ctypes.c_long * len(inputs))(*[own.shape[1] for own in inputs])
        output = ctypes.c_void_p(found.ctypes.data)
        width = ctypes.c_long(self.rows * self.width)
        self.library.all(ctypes.c_long(samples), pointers, lengths, ctypes.c_long(len(inputs)), output, width)
        y = np.einsum("srk,ks->sr", found[:, :, self.offsets], self.torques)
        if self.width > count:
            # Columns that only project the torques are not needed.
            found[:, :, count] = y
            return found[:, :, : count + 1]
        return np.concatenate([found, y[:, :, None]], axis=2)

    def decimated(self, lines):
        rows = np.ascontiguousarray(lines).reshape(len(lines), -1)
        kept = self.decimation.apply(rows)
        return kept.reshape(len(kept), self.rows, -1).transpose(1, 2, 0)
