"""Compares the estimates of a fleet by `overact-fleet` with those by pandas and NumPy, from the same factor
files.

    python fleet/compare.py FOLDER PROGRAM

FOLDER has factor files, PROGRAM is `overact-fleet`. It computes the parameters of each robot. Then every
robot is fitted twice here: by QR of its stacked factors, and by normal equations. The latter correspond to
sums of products in SQL (and, for one regressor, aggregates such as regr_slope). Row weights are those of
the first. Differences are relative to the larger of a value and its standard deviation.
"""

import io
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd

QUERY = """
    SELECT serial, p['name'] AS name, p['value'] AS value, p['deviation'] AS deviation
    FROM (SELECT serial, unnest(e['parameters']) AS p
          FROM (SELECT serial, estimate(factor) AS e FROM factors GROUP BY serial))
"""


def asked(program, folder):
    """Result of the query, its wall clock and processor seconds, and its peak memory in MB."""
    start = time.perf_counter()
    command = [program, "sql", QUERY, "--factors", folder, "--csv"]
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    clock = time.perf_counter() - start
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    rows = pd.read_csv(io.StringIO(text)).set_index(["serial", "name"])
    return rows, clock, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def decoded(record):
    """Column names and R of a record of a factor file (identification/src/factors/record.rs)."""
    columns = int.from_bytes(record[54:56], "little")
    lengths = [int.from_bytes(record[a:b], "little") for a, b in ((64, 66), (66, 68), (68, 72))]
    names_at = 72 + lengths[0] + lengths[1]
    names = record[names_at : names_at + lengths[2]].decode().split(",")
    size = columns + 1
    triangle = np.frombuffer(record[names_at + lengths[2] + 8 * size :], dtype="<f8")
    matrix = np.zeros((size, size))
    matrix[np.triu_indices(size)] = triangle
    return names, matrix


def independent(matrix, tolerance=1e-10):
    """Columns in order, without those that depend on earlier ones."""
    scaled = matrix / np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
    kept = []
    for column in range(matrix.shape[1]):
        own = scaled[:, column]
        rest = own
        if kept:
            q, _ = np.linalg.qr(scaled[:, kept])
            rest = own - q @ (q.T @ own)
        if np.linalg.norm(rest) > tolerance:
            kept.append(column)
    return kept


def fitted(group):
    """Estimates of a robot by QR and by normal equations."""
    lines, equations = {}, {}
    for line, count, record in zip(group.line, group.equations, group.factor):
        names, matrix = decoded(record)
        lines.setdefault(line, []).append(matrix)
        equations[line] = equations.get(line, 0) + count
    merged = {line: np.linalg.qr(np.vstack(own), mode="r") for line, own in lines.items()}
    kept = independent(np.vstack(list(merged.values()))[:, :-1])
    stacked, sums = [], 0.0
    for line, r in merged.items():
        own = independent(r[:, :-1][:, kept])
        picked = r[:, [kept[i] for i in own]]
        _, rest, rank, _ = np.linalg.lstsq(picked, r[:, -1], rcond=None)
        residual = r[:, -1] - picked @ np.linalg.lstsq(picked, r[:, -1], rcond=None)[0]
        weight = 1 / np.sqrt(residual @ residual / (equations[line] - len(own)))
        stacked.append(weight * r[:, kept + [r.shape[1] - 1]])
        sums = sums + weight**2 * sum(m.T @ m for m in lines[line])[np.ix_(kept + [-1], kept + [-1])]
    r = np.linalg.qr(np.vstack(stacked), mode="r")
    p = len(kept)
    by_qr = np.linalg.solve(r[:p, :p], r[:p, p])
    by_sums = np.linalg.solve(sums[:p, :p], sums[:p, p])
    return [names[i] for i in kept], by_qr, by_sums


def main(folder, program):
    own, clock, processor, memory = asked(program, folder)
    robots = own.index.get_level_values(0).nunique()
    print(f"overact-fleet: {robots} robots in {clock:.1f} s ({processor:.1f} s of processors), {memory:.0f} MB")
    start, of_start = time.perf_counter(), time.process_time()
    columns = ["serial", "kind", "content", "part", "line", "equations", "factor"]
    files = sorted(Path(folder).rglob("*.parquet"))
    rows = pd.concat(pd.read_parquet(file, columns=columns) for file in files)
    rows = rows[rows.kind == "factor"].drop_duplicates(["content", "part", "line"])
    read = time.perf_counter() - start
    found = [(serial, *fitted(group)) for serial, group in rows.groupby("serial")]
    clock, processor = time.perf_counter() - start, time.process_time() - of_start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"pandas and NumPy: {len(found)} robots, {len(rows)} rows in {clock:.1f} s ({processor:.1f} s of processors), "
        f"{read:.1f} s of them to read, {memory:.0f} MB"
    )
    by_qr, by_sums = 0.0, 0.0
    for serial, names, first, second in found:
        ours = own.loc[serial].reindex(names)
        size = np.maximum(np.abs(first), ours.deviation.to_numpy())
        by_qr = max(by_qr, np.max(np.abs(ours.value.to_numpy() - first) / size))
        by_sums = max(by_sums, np.max(np.abs(ours.value.to_numpy() - second) / size))
    print(f"largest difference: QR {by_qr:.1e}, normal equations {by_sums:.1e}")


if __name__ == "__main__":
    main(*sys.argv[1:])
