//! Logs as arrays: MATLAB's `.mat` and NumPy's files.
//!
//! They are written here byte by byte, and by NumPy itself if Python has it.

#[path = "common/drive.rs"]
mod drive;

use std::{fs, path::Path, process::Command};

use drive::info;
use overact_logs::read;
use overact_logs::{Error, Gain, Log, Mapping, Time};

/// A mapping of one drive at 10 Hz.
fn mapping(position: &str, torque: &str) -> Mapping {
    Mapping {
        time: Time::Frequency(10.0),
        positions: vec![position.to_owned()],
        torques: vec![torque.to_owned()],
        ..Mapping::for_robot(&info())
    }
}

/// Reads a file with this name and content.
fn log(name: &str, content: &[u8], mapping: &Mapping) -> Result<Log, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    fs::write(&path, content).expect("written");
    let prefix = format!("{}/", folder.path().display());
    read(&path, mapping, false).map_err(|error: Error| error.to_string().replace(&prefix, ""))
}

fn numbers(log: Result<Log, String>) -> (Vec<f64>, Vec<f64>) {
    log.and_then(|log| log.load().map_err(|error| error.to_string()))
        .unwrap_or_else(|error| panic!("{error}"))
}

/// An element of a `.mat` file.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = kind.to_le_bytes().to_vec();
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// Header of an array of a `.mat` file.
fn start(class: u8, name: &str, (rows, columns): (i32, i32)) -> Vec<u8> {
    let flags = [u32::from(class).to_le_bytes(), [0; 4]].concat();
    let size = [rows.to_le_bytes(), columns.to_le_bytes()].concat();
    [
        element(6, &flags),
        element(5, &size),
        element(1, name.as_bytes()),
    ]
    .concat()
}

/// A matrix of a `.mat` file, with column-major values.
fn matrix(name: &str, size: (i32, i32), values: &[f64]) -> Vec<u8> {
    let values: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    element(14, &[start(6, name, size), element(9, &values)].concat())
}

/// A structure of a `.mat` file.
fn structure(name: &str, fields: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut data = start(2, name, (1, 1));
    // The length of field names is a small element.
    data.extend([5, 0, 4, 0, 8, 0, 0, 0]);
    let mut names = Vec::new();
    for (field, _) in fields {
        names.extend(field.as_bytes());
        names.resize(names.len().next_multiple_of(8), 0);
    }
    data.extend(element(1, &names));
    fields.iter().for_each(|(_, field)| data.extend(field));
    element(14, &data)
}

/// A `.mat` file of arrays.
fn mat(arrays: &[Vec<u8>]) -> Vec<u8> {
    let mut file = b"MATLAB 5.0 MAT-file, written by a test".to_vec();
    file.resize(124, b' ');
    file.extend(b"\x00\x01IM");
    file.extend(arrays.concat());
    file
}

/// A `.npy` file.
fn npy(kind: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}");
    header.push_str(&" ".repeat(63 - (10 + header.len()) % 64));
    header.push('\n');
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.bytes());
    file.extend(data);
    file
}

fn doubles(values: &[f64]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

/// A zip archive of stored members.
fn zip(members: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (mut file, mut list) = (Vec::new(), Vec::new());
    for (name, content) in members {
        let sizes = [(content.len() as u32).to_le_bytes(); 2].concat();
        let name_size = (name.len() as u16).to_le_bytes();
        let start = file.len() as u32;
        file.extend([&b"PK\x03\x04"[..], &[0; 14], &sizes, &name_size, &[0; 2]].concat());
        file.extend([name.as_bytes(), content].concat());
        list.extend([&b"PK\x01\x02"[..], &[0; 16], &sizes, &name_size, &[0; 12]].concat());
        list.extend([&start.to_le_bytes()[..], name.as_bytes()].concat());
    }
    let count = (members.len() as u16).to_le_bytes();
    let (start, size) = (file.len() as u32, list.len() as u32);
    file.extend(&list);
    file.extend([&b"PK\x05\x06"[..], &[0; 4], &count, &count].concat());
    file.extend([size.to_le_bytes(), start.to_le_bytes()].concat());
    file.extend([0; 2]);
    file
}

/// Counts of encoders are often integers of 32 bits.
#[test]
fn matlab_integers_are_read() {
    let integers = |name: &str, values: [i32; 3]| {
        let values: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        element(14, &[start(12, name, (3, 1)), element(5, &values)].concat())
    };
    let file = mat(&[
        integers("q", [-1, 2, 70_000]),
        matrix("i", (3, 1), &[0.5, 0.25, 0.125]),
        structure("s", &[("q", integers("", [4, -5, 6]))]),
    ]);
    let torques = vec![0.5, 0.25, 0.125];
    assert_eq!(
        numbers(log("a.mat", &file, &mapping("q", "i"))),
        (vec![-1.0, 2.0, 70_000.0], torques.clone())
    );
    assert_eq!(
        numbers(log("a.mat", &file, &mapping("s.q", "i"))),
        (vec![4.0, -5.0, 6.0], torques)
    );
}

#[test]
fn matlab_4_files_are_rejected_with_the_reason() {
    let header = [0_u32, 3, 1, 0, 2].map(u32::to_le_bytes).concat();
    let file = [header, b"q\0".to_vec(), doubles(&[1.0, 2.0, 3.0])].concat();
    let message = log("a.mat", &file, &mapping("q", "q")).expect_err("an old file");
    assert!(message.contains("MATLAB's version 4"), "{message}");
    assert!(message.contains("save(..., '-v7')"), "{message}");
}

#[test]
fn matlab_matrices_and_structures_are_read() {
    let q = [1.0, 2.0, 3.0, 10.0, 20.0, 30.0];
    let file = mat(&[
        matrix("q", (3, 2), &q),
        matrix("wide", (2, 3), &[1.0, 10.0, 2.0, 20.0, 3.0, 30.0]),
        matrix("gain", (1, 1), &[2.0]),
        structure(
            "run",
            &[
                ("i", matrix("", (3, 1), &[0.5, 0.25, 0.125])),
                ("arm", structure("", &[("q", matrix("", (3, 2), &q))])),
            ],
        ),
    ]);
    let first = vec![1.0, 2.0, 3.0];
    let second = vec![10.0, 20.0, 30.0];
    let pair =
        |position: &str, torque: &str| numbers(log("a.mat", &file, &mapping(position, torque)));
    assert_eq!(pair("q(:,1)", "q(:, 2)"), (first.clone(), second.clone()));
    assert_eq!(
        pair("wide(1,:)", "wide(2,:)"),
        (first.clone(), second.clone())
    );
    assert_eq!(
        pair("run.arm.q(:,1)", "run.i"),
        (first.clone(), vec![0.5, 0.25, 0.125])
    );
    assert_eq!(pair("q(:,1)", "run.i * gain").1, [1.0, 0.5, 0.25]);
    let gained = Mapping {
        torque_gain: vec![Gain::Variable(String::from("gain"))],
        ..mapping("$1", "run.i")
    };
    assert_eq!(
        numbers(log("a.txt", &file, &gained)),
        (first, vec![1.0, 0.5, 0.25])
    );
    assert_eq!(
        log("a.mat", &file, &mapping("q", "run.j")).expect_err("missing"),
        "a.mat: there are no variables `q`, `run.j`; the file has `q`, `wide`, `gain`, `run.i`, `run.arm.q`\n  \
         help: name the columns of a matrix one by one, `q(:,1)` is the first"
    );
    // A truncated file is refused, or lacks the requested columns.
    for length in (0..file.len()).step_by(7) {
        assert!(
            log(
                "a.mat",
                &file[..length],
                &mapping("q(:,1)", "run.arm.q(:,2)")
            )
            .is_err()
        );
    }
}

#[test]
fn numpy_arrays_are_read() {
    let rows = doubles(&[1.0, 10.0, 2.0, 20.0, 3.0, 30.0]);
    let expected = (vec![1.0, 2.0, 3.0], vec![10.0, 20.0, 30.0]);
    let numbered = mapping("$1", "$2");
    let file = npy("<f8", "False", "(3, 2)", &rows);
    assert_eq!(numbers(log("a.npy", &file, &numbered)), expected);
    let columns = doubles(&[1.0, 2.0, 3.0, 10.0, 20.0, 30.0]);
    let by_columns = npy("<f8", "True", "(3, 2)", &columns);
    assert_eq!(numbers(log("a.npy", &by_columns, &numbered)), expected);
    let big = npy(
        ">i2",
        "False",
        "(3, 2)",
        &[0, 1, 0, 10, 0, 2, 0, 20, 0, 3, 0, 30],
    );
    assert_eq!(numbers(log("a.npy", &big, &numbered)), expected);
    let archive = zip(&[
        (
            "q.npy",
            npy(
                "<i4",
                "False",
                "(3,)",
                &[1, 0, 0, 0, 2, 0, 0, 0, 253, 255, 255, 255],
            ),
        ),
        (
            "tau.npy",
            npy(
                "<f4",
                "False",
                "(3, 1)",
                &[0, 0, 128, 63, 0, 0, 0, 64, 0, 0, 64, 64],
            ),
        ),
        ("names.npy", npy("<U3", "False", "(3,)", &[0; 36])),
        ("gain.npy", npy("<f8", "False", "()", &doubles(&[2.0]))),
    ]);
    let (q, tau) = numbers(log("a.npz", &archive, &mapping("q", "gain*tau")));
    assert_eq!((q, tau), (vec![1.0, 2.0, -3.0], vec![2.0, 4.0, 6.0]));
    for length in 0..file.len() {
        assert!(
            log("a.npy", &file[..length], &numbered).is_err(),
            "{length}"
        );
    }
    for length in (0..archive.len()).step_by(5) {
        assert!(
            log("a.npz", &archive[..length], &mapping("q", "tau")).is_err(),
            "{length}"
        );
    }
}

#[test]
fn non_numeric_numpy_arrays_are_rejected_by_name() {
    let refused = |file: &[u8]| log("a.npz", file, &mapping("q", "tau")).expect_err("an error");
    assert_eq!(
        refused(&npy("<U3", "False", "(1,)", &[0; 12])),
        "a.npz: the file is NumPy's, but its elements are not supported numbers (`<U3`)\n  \
         help: write it again with `numpy.save`, an array of numbers, samples x columns"
    );
    assert_eq!(
        refused(&npy("<f8", "False", "(2, 2, 2)", &[0; 64])),
        "a.npz: the file is NumPy's, but the array has 3 dimensions\n  \
         help: write it again with `numpy.save`, an array of numbers, samples x columns"
    );
    assert_eq!(
        refused(&npy("<f8", "False", "(4000000000, 4000000000)", &[0; 64])),
        "a.npz: the file is NumPy's, but it is truncated\n  \
         help: write it again with `numpy.save`, an array of numbers, samples x columns"
    );
    assert_eq!(
        refused(&zip(&[("xl/workbook.xml", b"<x/>".to_vec())])),
        "a.npz: the file is a zip archive, but not one of NumPy's (`.npz`)\n  help: unpack it; export a \
         spreadsheet as CSV"
    );
    let names = zip(&[("names.npy", npy("<U3", "False", "(1,)", &[0; 12]))]);
    assert_eq!(
        refused(&names),
        "a.npz: no array of the file can be read: `names`: its elements are not supported numbers (`<U3`)\n  \
         help: write it again with `numpy.savez`, arrays of numbers, samples x columns"
    );
}

/// Files that NumPy writes, compressed or not.
const SCRIPT: &str = "
import numpy, sys
t = numpy.arange(1000) / 10
q = numpy.stack([t, t**2, numpy.sin(t)], axis=1)
numpy.savez(sys.argv[1] + '/plain.npz', q=q, tau=(10*t).astype('float32'))
numpy.savez_compressed(sys.argv[1] + '/packed.npz', q=numpy.asfortranarray(q), tau=(10*t).astype('int16'))
numpy.savetxt(sys.argv[1] + '/text.txt', numpy.column_stack([q, 10*t]), header='t q2 q3 tau')
";

#[test]
fn files_written_by_numpy_have_the_same_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let python = Command::new("python3")
        .arg("-c")
        .arg(SCRIPT)
        .arg(folder.path())
        .output();
    if !python.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: there is no Python with NumPy here");
        return;
    }
    let from = |name: &str, mapping: &Mapping| {
        let log = read(&folder.path().join(name), mapping, false);
        numbers(log.map_err(|error| error.to_string()))
    };
    let expected: Vec<f64> = (0..1000).map(|k| (f64::from(k) / 10.0).powi(2)).collect();
    for (name, mapping) in [
        ("plain.npz", mapping("q(:,2)", "tau")),
        ("packed.npz", mapping("q(:,2)", "tau")),
        ("text.txt", mapping("q2", "tau")),
    ] {
        let (positions, torques) = from(name, &mapping);
        assert_eq!(positions, expected, "{name}");
        assert_eq!((torques.len(), torques[999]), (1000, 999.0), "{name}");
    }
    assert!(Path::new(folder.path()).exists());
}

#[test]
fn empty_arrays_with_huge_shapes_are_rejected() {
    for (shape, order) in [
        ("(0, 1000000000000000)", "False"),
        ("(0, 1000000000000000)", "True"),
        ("(1000000000000000, 0)", "False"),
    ] {
        let file = npy("<f8", order, shape, &[]);
        assert!(
            log("a.npy", &file, &mapping("array", "array")).is_err(),
            "{shape}"
        );
    }
}

#[test]
fn archive_members_are_limited_together() {
    let member = npy("<f8", "False", "(131072,)", &doubles(&[0.0; 131_072]));
    let one = zip(&[("t.npy", member)]);
    // The archive lists the same bytes 300 times.
    let start = one
        .windows(4)
        .rposition(|bytes| bytes == b"PK\x01\x02")
        .expect("a list");
    let end = one
        .windows(4)
        .rposition(|bytes| bytes == b"PK\x05\x06")
        .expect("an end");
    let count = 300_u16;
    let mut file = one[..start].to_vec();
    file.extend(one[start..end].repeat(usize::from(count)));
    let mut tail = one[end..].to_vec();
    tail[8..10].copy_from_slice(&count.to_le_bytes());
    tail[10..12].copy_from_slice(&count.to_le_bytes());
    file.extend(tail);
    let error = log("a.npz", &file, &mapping("t", "t")).expect_err("too large");
    assert!(
        error.contains("uncompressed it has more than 256 MB"),
        "{error}"
    );
}

#[cfg(unix)]
#[test]
fn devices_are_rejected_as_logs() {
    let error = read(Path::new("/dev/zero"), &mapping("q", "tau"), false).expect_err("no file");
    assert!(error.to_string().contains("not a regular file"), "{error}");
}
