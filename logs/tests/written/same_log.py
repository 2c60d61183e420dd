"""Writes one log in every format, as its usual library does: NumPy, SciPy, PyArrow, h5py, mcap and rosbags.

pip install h5py mcap mcap-ros2-support numpy pyarrow rosbags scipy; python same_log.py FOLDER

Without a folder the files next to this one are rewritten.
"""

import os
import shutil
import sys
import tempfile
from pathlib import Path

import h5py
import mcap_ros2.writer
import numpy
import pyarrow
import pyarrow.parquet
import rosbags.rosbag2
import rosbags.typesys
import scipy.io
from mcap.writer import CompressionType

COUNT = 200
# Ten milliseconds, and a second in which wall clocks are.
STEP = 10_000_000
START = 1_700_000_000 * 1_000_000_000
NAMES = ["shoulder", "elbow"]

JOINT_STATE = """\
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


def samples(count=COUNT):
    """Numbers that are the same in every language: quotients of small whole numbers."""
    k = numpy.arange(count)
    time = k / 100
    position = numpy.column_stack([k * k / 7, (k % 13) / 3])
    velocity = numpy.column_stack([k / 9, (k % 5) / 11])
    effort = numpy.column_stack([(k % 16) / 3, -k / 17])
    return time, position, velocity, effort


def arrays(folder):
    time, position, velocity, effort = samples()
    numpy.save(folder / "same.npy", numpy.column_stack([time, position, velocity, effort]))
    named = {"t": time, "q": position, "dq": velocity, "tau": effort}
    numpy.savez_compressed(folder / "same.npz", **named)
    scipy.io.savemat(folder / "same.mat", named, do_compression=True)
    columns = {"t": time}
    for name, matrix in [("q", position), ("dq", velocity), ("tau", effort)]:
        for joint in range(2):
            columns[f"{name}{joint + 1}"] = matrix[:, joint]
    pyarrow.parquet.write_table(pyarrow.table(columns), folder / "same.parquet", compression="zstd")
    with h5py.File(folder / "same.h5", "w") as file:
        run = file.create_group("run")
        run.create_dataset("t", data=time)
        run.create_dataset("q", data=position, chunks=(64, 2), compression="gzip", shuffle=True)
        run.create_dataset("dq", data=velocity, chunks=(50, 1), fletcher32=True)
        run.create_dataset("tau", data=effort.astype(">f8"))
        file["gain"] = 2.0
        # Columns that are refused on request but may exist next to others.
        file["label"] = "a text"
        file["cube"] = numpy.zeros((2, 3, 4))
        file["table"] = numpy.zeros(COUNT, dtype=[("t", "f8"), ("q", "f8")])
        file["half"] = numpy.zeros(COUNT, dtype="f2")
        file["flags"] = time > 1
        file["short"] = time[:-1]
        file["hole"] = numpy.where(time == 0.5, numpy.nan, time)
        file["run/again"] = file["run"]
        file["lost"] = h5py.SoftLink("/nowhere")
        file["elsewhere"] = h5py.ExternalLink("other.h5", "/q")
    # As MATLAB's `save(..., '-v7.3')`: 512 bytes of its own before the file, and the sides of matrices in the
    # other order.
    path = folder / "same_v73.mat"
    with h5py.File(path, "w", userblock_size=512, libver="earliest") as file:
        for name, matrix in named.items():
            matrix = numpy.atleast_2d(matrix)
            matrix = matrix if name == "t" else matrix.T
            chunks = (1, COUNT // 2)
            dataset = file.create_dataset(name, data=matrix, chunks=chunks, compression="gzip")
            dataset.attrs["MATLAB_class"] = numpy.bytes_("double")
        file["gain"] = numpy.array([[2.0]])
        inside = file.create_group("data")
        inside["q"] = position.T
    with open(path, "r+b") as file:
        text = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Jan  1 00:00:00 2024 HDF5 schema 1.00 ."
        file.write(text.ljust(116) + bytes(8) + b"\x00\x02IM")


def small(folder):
    """Files of a few samples, in which bytes are changed."""
    time, position, _, effort = samples(12)
    with h5py.File(folder / "small.h5", "w", libver="latest") as file:
        file["t"] = time
        file.create_dataset("run/q", data=position, chunks=(5, 2), maxshape=(None, 2), compression="gzip")
        file["run/tau"] = effort
    with h5py.File(folder / "small_old.h5", "w", libver="earliest") as file:
        file["t"] = time
        file.create_dataset("run/q", data=position, chunks=(5, 1), compression="gzip", fletcher32=True)
        file["run/tau"] = effort
    mcap_file(folder / "small_lz4.mcap", CompressionType.LZ4, 512, several=False, count=12)
    mcap_file(folder / "small_zstd.mcap", CompressionType.ZSTD, 512, several=True, count=12)
    mcap_file(folder / "small_plain.mcap", CompressionType.NONE, 512, several=False, count=12)


def stamp(nanos):
    return {"sec": nanos // 1_000_000_000, "nanosec": nanos % 1_000_000_000}


def state(nanos, names, position, velocity, effort):
    return {
        "header": {"stamp": stamp(nanos), "frame_id": "base"},
        "name": names,
        "position": list(position),
        "velocity": list(velocity),
        "effort": list(effort),
    }


def mcap_file(path, compression, chunk_size, several, count=COUNT):
    """One topic with everything, or positions and efforts on topics of their own and more topics."""
    _, position, velocity, effort = samples()
    with open(path, "wb") as output:
        writer = mcap_ros2.writer.Writer(output, compression=compression, chunk_size=chunk_size)
        joints = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        text = writer.register_msgdef("std_msgs/msg/String", "string data")
        for k in range(count):
            nanos = START + STEP * k
            # Recorded some time later, by the clock of another computer.
            times = {"log_time": nanos + 3_000_000, "publish_time": nanos}
            if several:
                first = state(nanos, NAMES, position[k], velocity[k], [])
                second = state(nanos, NAMES[::-1], [], [], effort[k][::-1])
                writer.write_message("/joint_states", joints, first, **times)
                writer.write_message("/rosout", text, {"data": "message " * (k % 4)}, **times)
                writer.write_message("/torques", joints, second, **times)
            else:
                message = state(nanos, NAMES, position[k], velocity[k], effort[k])
                writer.write_message("/joint_states", joints, message, **times)
        writer.finish()


def bag(path):
    """A bag of ROS 2 as rosbags writes it."""
    _, position, velocity, effort = samples()
    store = rosbags.typesys.get_typestore(rosbags.typesys.Stores.ROS2_HUMBLE)
    kinds = store.types
    with tempfile.TemporaryDirectory() as folder:
        inside = Path(folder) / "bag"
        plugin = rosbags.rosbag2.StoragePlugin.MCAP
        with rosbags.rosbag2.Writer(inside, version=9, storage_plugin=plugin) as writer:
            kind = "sensor_msgs/msg/JointState"
            connection = writer.add_connection("/joint_states", kind, typestore=store)
            for k in range(COUNT):
                nanos = START + STEP * k
                time = kinds["builtin_interfaces/msg/Time"](**stamp(nanos))
                header = kinds["std_msgs/msg/Header"](stamp=time, frame_id="base")
                message = kinds[kind](header, NAMES, position[k], velocity[k], effort[k])
                writer.write(connection, nanos, store.serialize_cdr(message, kind))
        shutil.copy(next(inside.glob("*.mcap")), path)


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__)))
    arrays(folder)
    mcap_file(folder / "same_lz4.mcap", CompressionType.LZ4, 4096, several=False)
    mcap_file(folder / "same_zstd.mcap", CompressionType.ZSTD, 4096, several=True)
    mcap_file(folder / "same_plain.mcap", CompressionType.NONE, 4096, several=True)
    bag(folder / "same_rosbags.mcap")
    small(folder)


main()
