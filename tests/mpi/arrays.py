"""Small .npy files without NumPy, which not every Python has: for command.sh."""
import array
import random
import struct
import sys


def save(path, descr, code, rows, values):
    text = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': ({rows}, 2), }}".ljust(117) + "\n"
    with open(path, "wb") as file:
        file.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode())
        array.array(code, values).tofile(file)


def load(path):
    with open(path, "rb") as file:
        data = file.read()
    header = data[10:128].decode()
    code = "d" if "<f8" in header else "i" if "<i4" in header else "q"
    return header, array.array(code, data[128:])


def make_points():
    random.seed(1)
    values = [random.random() for _ in range(8000)]
    save("float32.npy", "<f4", "f", 5500, values + values[:3000])
    save("none.npy", "<f8", "d", 0, [])
    save("two.npy", "<f8", "d", 2, [1.0, 2.0, 0.5, 3.0])


def make_nan():
    with open("points.npy", "rb") as file:
        data = bytearray(file.read())
    data[-8:] = struct.pack("<d", float("nan"))
    with open("nan.npy", "wb") as file:
        file.write(data)


def check_width():
    (wide_header, wide), (narrow_header, narrow) = load("wide.npy"), load("narrow.npy")
    if "<i8" not in wide_header or "<i4" not in narrow_header or list(wide) != list(narrow):
        sys.exit("the files of 32 and of 64 bits differ")


def check_areas():
    # With the least corner of their triangles: rows may be in another order.
    (header, found), (expected_header, expected) = load("a.npy"), load("areas.npy")
    corners, expected_corners = load("t.npy")[1][::3], load("expected.npy")[1][::3]
    if header != expected_header or len(found) != len(corners):
        sys.exit("the file of areas has another type or shape")
    if sorted(zip(corners, found)) != sorted(zip(expected_corners, expected)):
        sys.exit("the areas differ")


{"points": make_points, "nan": make_nan, "width": check_width, "areas": check_areas}[sys.argv[1]]()
