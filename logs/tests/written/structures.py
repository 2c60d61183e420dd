"""Writes structures and cell arrays of MATLAB: structures.mat (version 7), structures_v73.mat (version 7.3).

pip install h5py numpy scipy; python structures.py

`out` is a "structure with time" of Simulink, `rec` a file of a dSPACE recorder, `runs` a cell array of structures.
"""

import os

import h5py
import numpy
import scipy.io

os.chdir(os.path.dirname(os.path.abspath(__file__)))

COUNT = 12
k = numpy.arange(COUNT)
time = k / 10
position = numpy.column_stack([k * k / 7, k / 3])
torque = k / 9 - 1


def array(entries):
    """An array of structures: 1 x n, each a dict with the same keys."""
    result = numpy.empty((1, len(entries)), dtype=[(key, object) for key in entries[0]])
    for place, entry in enumerate(entries):
        for key, value in entry.items():
            result[0, place][key] = value
    return result


def cells(items):
    result = numpy.empty((1, len(items)), dtype=object)
    result[0, :] = items
    return result


def signals():
    # A signal of two dimensions has the samples along the third one.
    cube = position.T[:, numpy.newaxis, :]
    return [
        {"values": position, "dimensions": 2.0, "label": "q"},
        {"values": torque[:, numpy.newaxis], "dimensions": 1.0, "label": "tau"},
        {"values": cube, "dimensions": numpy.array([[2.0, 1.0]]), "label": "cube"},
    ]


def channels():
    names = ['"Model Root"/"q"', '"Model Root"/"tau"', "same", "same"]
    data = [position[:, 1], torque, k, k]
    return [{"Name": name, "Data": own.astype(float)[numpy.newaxis, :]} for name, own in zip(names, data)]


def old():
    out = {"time": time[:, numpy.newaxis], "signals": array(signals()), "blockName": "model/Scope"}
    rec = {"X": {"Name": "time", "Data": time[numpy.newaxis, :]}, "Y": array(channels()), "Description": {"a": "b"}}
    runs = cells([{"t": time, "q": position, "tau": torque}, {"t": time, "q": 2 * position, "tau": torque}, time])
    deep = {"a": {"b": {"c": cells([{"q": position, "tau": torque}])}}}
    content = {"out": out, "rec": rec, "runs": runs, "deep": deep, "empty": array([{"q": 1.0}])[:, :0]}
    scipy.io.savemat("structures.mat", content, do_compression=True, oned_as="column")


def new():
    path = "structures_v73.mat"
    with h5py.File(path, "w", userblock_size=512, libver="earliest") as file:
        refs = file.create_group("#refs#")

        def put(group, name, value):
            """A value as MATLAB writes it."""
            if isinstance(value, dict):
                inner = group.create_group(name)
                inner.attrs["MATLAB_class"] = numpy.bytes_("struct")
                for key, own in value.items():
                    put(inner, key, own)
            elif isinstance(value, list) and isinstance(value[0], dict) and not name.startswith("runs"):
                inner = group.create_group(name)
                inner.attrs["MATLAB_class"] = numpy.bytes_("struct")
                for key in value[0]:
                    point(inner, key, [own[key] for own in value])
            elif isinstance(value, list):
                point(group, name, value).attrs["MATLAB_class"] = numpy.bytes_("cell")
            elif isinstance(value, str):
                text = numpy.frombuffer(value.encode("utf-16-le"), dtype="<u2")[:, numpy.newaxis]
                group.create_dataset(name, data=text).attrs["MATLAB_class"] = numpy.bytes_("char")
            else:
                value = numpy.atleast_2d(value)
                value = value.transpose(*reversed(range(value.ndim)))
                group.create_dataset(name, data=value).attrs["MATLAB_class"] = numpy.bytes_("double")

        def point(group, name, values):
            own = []
            for value in values:
                own.append(f"r{len(refs)}")
                put(refs, own[-1], value)
            pointers = numpy.array([[refs[name].ref] for name in own], dtype=h5py.ref_dtype)
            return group.create_dataset(name, data=pointers, dtype=h5py.ref_dtype)

        out = {"time": time[:, numpy.newaxis], "signals": signals(), "blockName": "model/Scope"}
        put(file, "out", out)
        put(file, "rec", {"X": {"Name": "time", "Data": time[numpy.newaxis, :]}, "Y": channels()})
        one = {"t": time[:, numpy.newaxis], "q": position, "tau": torque[:, numpy.newaxis]}
        put(file, "runs", [one, {**one, "q": 2 * position}, time[:, numpy.newaxis]])
        put(file, "deep", {"a": {"b": {"c": {"q": position}}}})
    with open(path, "r+b") as file:
        text = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Jan  1 00:00:00 2024 HDF5 schema 1.00 ."
        file.write(text.ljust(116) + bytes(8) + b"\x00\x02IM")


old()
new()
