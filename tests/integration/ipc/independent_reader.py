#!/usr/bin/env python3
"""Reads a living segment knowing nothing but the tables of docs/segment.md, and checks it against the test publisher.

    independent_reader.py SEGMENT docs/segment.md

Standard library and numpy only. Prints one line of JSON with what it found; exits with 1 and a sentence when a promise of the
document does not hold.
"""
import json
import mmap
import os
import re
import sys
import time

import numpy as np

BASIC = {"u8": "u1", "u32": "u4", "i64": "i8", "u64": "u8", "f32": "f4", "f64": "f8"}


def structures(document):
    """Every table "### `name` (size bytes)" as a numpy type."""
    types, text = {}, open(document, encoding="utf-8").read()
    tables = re.findall(r"^### `(ls_\w+)` \((\d+) bytes\)\n(.*?)(?=^#|\Z)", text, re.S | re.M)
    waiting = [(name, int(size), body) for name, size, body in tables]
    while waiting:
        name, size, body = waiting.pop(0)
        rows = re.findall(r"^\| (\d+) \| (\w+)(?:\[(\d+)\])? \| `(\w+)` \|", body, re.M)
        if any(kind not in BASIC and kind != "char" and kind not in types for _, kind, _, _ in rows):
            waiting.append((name, size, body))  # needs a structure that comes later
            continue
        formats = []
        for _, kind, count, _ in rows:
            if kind == "char":
                formats.append("S" + count)
            else:
                base = types.get(kind) if kind in types else np.dtype("=" + BASIC[kind])
                formats.append((base, (int(count),)) if count else base)
        types[name] = np.dtype({"names": [row[3] for row in rows], "formats": formats,
                                "offsets": [int(row[0]) for row in rows], "itemsize": size})
    return types


def need(condition, sentence):
    if not condition:
        sys.exit("independent_reader: " + sentence)


class Segment:
    def __init__(self, name, types):
        self.types = types
        descriptor = os.open("/dev/shm/" + name, os.O_RDONLY)
        size = os.fstat(descriptor).st_size
        self.map = mmap.mmap(descriptor, size, prot=mmap.PROT_READ)
        os.close(descriptor)
        self.bytes = np.frombuffer(self.map, np.uint8)
        self.header = self.at(0, "ls_header")
        need(self.bytes[:8].tobytes() == b"LINESCOP", "no segment")
        need(self.header["endian_mark"] == 0x01020304 and self.header["layout_major"] == 1, "not this layout")
        need(self.header["total_bytes"] == size, "another size than its header says")
        used = self.header["sections"][: self.header["section_count"]]
        self.sections = {int(s["kind"]): s.copy() for s in used}

    def at(self, offset, name):
        return self.bytes[offset: offset + self.types[name].itemsize].view(self.types[name])[0]

    def ring_head(self, kind, ring=0):
        s = self.sections[kind]
        return int(self.at(int(s["offset"] + s["ring_bytes"] * ring), "ls_ring")["head"])

    def ring_place(self, kind, index, ring=0):
        s = self.sections[kind]
        return int(s["offset"] + s["ring_bytes"] * ring) + 64 + int(s["record_bytes"]) * (index % int(s["record_count"]))

    def newest(self, kind, name, ring=0):
        """The ring rule: copy, then look at head again. (record, bytes of the slot) or None."""
        for _ in range(100):
            head = self.ring_head(kind, ring)
            if head == 0:
                return None
            place = self.ring_place(kind, head - 1, ring)
            slot = self.bytes[place: place + int(self.sections[kind]["record_bytes"])].copy()
            if self.ring_head(kind, ring) - (head - 1) < int(self.sections[kind]["record_count"]):
                record = slot[: self.types[name].itemsize].view(self.types[name])[0]
                need(record["index"] == head - 1, "a record does not carry its own number")
                return record, slot
        sys.exit("independent_reader: overtaken a hundred times")

    def scan(self):
        """The scan rule: (generation, lines, points) as a whole."""
        lines, points = self.sections[7], self.sections[8]
        for _ in range(100):
            before = int(self.header["published"])
            count = before & 0xFFFFFFFF
            begin = int(lines["offset"])
            records = self.bytes[begin: begin + count * int(lines["record_bytes"])].copy()
            records = records.reshape(count, int(lines["record_bytes"]))[:, :self.types["ls_line_record"].itemsize]
            records = np.ascontiguousarray(records).view(self.types["ls_line_record"]).reshape(count)
            begin = int(points["offset"])
            used = int((records["first_point"] + records["point_count"] + 1).max()) if count else 0
            data = self.bytes[begin: begin + used * 20].copy()
            if int(self.header["published"]) >> 32 == before >> 32:
                return before >> 32, records, data
        sys.exit("independent_reader: the scan changed a hundred times")


def checksum(words):
    with np.errstate(over="ignore"):
        start, n = np.uint64(0x9E3779B97F4A7C15), len(words)
        a = start + words.sum(dtype=np.uint64)
        b = np.uint64(n) * start + (words * np.arange(n, 0, -1, dtype=np.uint64)).sum(dtype=np.uint64)
        return (a ^ ((b << np.uint64(32)) | (b >> np.uint64(32)))) | np.uint64(1)


def own_points(record, raw, points, types):
    """The points of a line and its filling point, after the checksum was found to hold."""
    count, first = int(record["point_count"]), int(record["first_point"])
    need(first % 2 == 0, "a line does not begin at an even point")
    padded = points[first * 20: (first + (count + 1) // 2 * 2) * 20]
    words = np.concatenate([np.frombuffer(raw[:312], np.uint64), padded.view(np.uint64)])
    need(checksum(words) == record["checksum"], f"line {record['serial']}: checksum")
    both = padded.view(types["ls_point"])
    return both[:count], both[count:]


def check_line(record, raw, points, types):
    """Against the checksum, and against what the publisher makes up from the serial."""
    serial, count = int(record["serial"]), int(record["point_count"])
    own, filling = own_points(record, raw, points, types)
    need(count == 1 + serial * 7919 % 640, f"line {serial}: number of points")
    i = np.arange(count, dtype=np.float32)
    s = np.float32(serial % 65536)
    need((own["position"] == np.stack([np.full(count, s), i, s - i], 1)).all(), f"line {serial}: positions")
    need((own["intensity"] == (serial + np.arange(count)) % 256).all(), f"line {serial}: intensities")
    need((own["standard_deviation"] == 0.25 * i).all(), f"line {serial}: deviations")
    if count % 2 == 1:
        need(np.isnan(filling["position"]).all(), f"line {serial}: filling point")
    poses = record["poses"]
    need((poses[0]["position"] == [serial, 1, 2]).all() and (poses[2]["position"] == [5, 6, serial]).all(), f"line {serial}: poses")
    need((poses[1]["quaternion"] == [0, 1, 0, 0]).all() and poses[2]["state"] == 2, f"line {serial}: rotation or state")


def check_picture(segment):
    record, slot = segment.newest(9, "ls_picture_record")
    frame = int(record["frame"])
    need((record["width"], record["height"], record["stride"], record["format"]) == (160, 120, 480, 2), "shape of the picture")
    samples = slot[120: 120 + 16 * int(record["sample_count"])].view(segment.types["ls_line_sample"])
    need(len(samples) == 1 and samples[0]["v"] == frame % 1000 and samples[0]["u"] == 1.5, "line in the picture")
    begin = 120 + 16 * int(segment.header["picture_samples"])
    pixels = slot[begin: begin + 480 * 120]
    need((pixels == frame // 16 % 256).all(), "pixels of the picture")
    return int(record["index"]) + 1


def check_poses(segment):
    for station in range(8):
        record, _ = segment.newest(5, "ls_pose_record", station)
        n = int(record["frame_count"])
        need((record["position"] == [n, station, -n]).all() and record["station"] == station, f"pose of station {station}")
        need((record["quaternion"] == [1, 0, 0, 0]).all() and record["state"] == 0, f"rotation of station {station}")
        need(abs(time.monotonic_ns() - int(record["time_ns"])) < 5e9, f"time of station {station}")
    return int(segment.ring_head(5, 0))


def text(segment, which):
    record, slot = segment.newest(4, "ls_text_record", which)
    return slot[32: 32 + int(record["text_bytes"])].tobytes().decode()


def counters(segment):
    s = segment.sections[11]
    kind = segment.types["ls_counter"]
    used = int(segment.header["counter_count"])
    table = segment.bytes[int(s["offset"]): int(s["offset"]) + used * kind.itemsize].copy().view(kind)
    return {row["name"].decode(): int(row["value"]) for row in table}


def main(name, document):
    types = structures(document)
    segment = Segment(name, types)
    beats = int(segment.header["heartbeat_count"])
    checked = generations = 0
    last = None
    end = time.monotonic() + 1.0
    while time.monotonic() < end or checked < 100:
        generation, records, points = segment.scan()
        generations += generation != last
        last = generation
        for record in records[-20:]:
            check_line(record, record.tobytes(), points, types)
            checked += 1
        pictures, poses = check_picture(segment), check_poses(segment)
    state, _ = segment.newest(1, "ls_state_record")
    sensor, _ = segment.newest(2, "ls_sensor_record", 0)
    need(state["state"] == 2 and state["reason"] == b"made-up lines", "state")
    need(sensor["name"] == b"endoscope" and sensor["role"] == 1 and sensor["nominal_hz"] == 240, "status of the endoscope's sensor")
    need(text(segment, 0) == "[camera]\nwidth = 160\n" and text(segment, 1) == "%YAML:1.0\n", "texts")
    need(int(segment.header["heartbeat_count"]) > beats, "the heart does not beat")
    counted = counters(segment)
    need(counted["lines_offered"] >= counted["lines_published"] > 0, "counters")
    print(json.dumps({"lines_checked": checked, "generations": int(generations), "pictures": pictures, "poses": poses}))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
